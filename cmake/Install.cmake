# Install rules, the CMake package, and the Debian packages: waymark (the program), libwaymark-dev, python3-waymark.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Waymark)

# The package finds what Dependencies.cmake found, except what only the program uses.
file(STRINGS ${PROJECT_SOURCE_DIR}/cmake/Dependencies.cmake found REGEX "^find_package")
list(FILTER found EXCLUDE REGEX "CLI11|spdlog")
list(JOIN found "\n" WAYMARK_FIND_DEPENDENCIES)
string(REPLACE "find_package" "find_dependency" WAYMARK_FIND_DEPENDENCIES "${WAYMARK_FIND_DEPENDENCIES}")
string(REPLACE " REQUIRED" "" WAYMARK_FIND_DEPENDENCIES "${WAYMARK_FIND_DEPENDENCIES}")
configure_package_config_file(cmake/WaymarkConfig.cmake.in WaymarkConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(WaymarkConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT WaymarkTargets NAMESPACE Waymark:: DESTINATION ${package_dir} COMPONENT development)
export(EXPORT WaymarkTargets NAMESPACE Waymark:: FILE ${PROJECT_BINARY_DIR}/WaymarkTargets.cmake)
foreach(file Catalogue FindOpenCVParts)  # the build tree is a package, too: -DWaymark_DIR=build/release
  configure_file(cmake/${file}.cmake ${PROJECT_BINARY_DIR}/${file}.cmake COPYONLY)
endforeach()
install(CODE "set(source \"${PROJECT_SOURCE_DIR}\")
              set(stage \"${PROJECT_BINARY_DIR}/public_headers\")
              set(destination \"${CMAKE_INSTALL_INCLUDEDIR}\")" COMPONENT development)
install(SCRIPT cmake/InstallHeaders.cmake COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/WaymarkConfig.cmake ${PROJECT_BINARY_DIR}/WaymarkConfigVersion.cmake
              cmake/Catalogue.cmake cmake/FindOpenCVParts.cmake
        DESTINATION ${package_dir} COMPONENT development)

# For builds without CMake.
get_property(own_libraries GLOBAL PROPERTY WAYMARK_LIBRARIES)
list(TRANSFORM own_libraries PREPEND -l)
list(JOIN own_libraries " " own_libraries)
get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
file(RELATIVE_PATH to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" to_prefix ${to_prefix})
configure_file(cmake/waymark.pc.in waymark.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/waymark.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# apps/CMakeLists.txt makes these with the program, so that all that is installed exists once the program is built.
set(pages ${PROJECT_BINARY_DIR}/pages)
install(FILES ${pages}/waymark.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${pages}/waymark DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(FILES ${pages}/_waymark DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${pages}/waymark.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
# The plugin of QGIS, with the declarations of the commands as its fallback.
install(DIRECTORY python/qgis/waymark_qgis DESTINATION ${CMAKE_INSTALL_DATADIR}/qgis/python/plugins COMPONENT qgis
        FILES_MATCHING PATTERN "*.py" PATTERN metadata.txt PATTERN __pycache__ EXCLUDE)
install(FILES ${pages}/commands.json DESTINATION ${CMAKE_INSTALL_DATADIR}/qgis/python/plugins/waymark_qgis COMPONENT qgis)
# Each package has its licence where Debian wants it. The program brings the pages, and the samples of the tutorials.
set(doc ${CMAKE_INSTALL_DATADIR}/doc)
foreach(packed program=waymark development=libwaymark-dev qgis=qgis-plugin-waymark)
  string(REPLACE "=" ";" packed ${packed})
  list(GET packed 0 component)
  list(GET packed 1 package)
  install(FILES LICENSE DESTINATION ${doc}/${package} RENAME copyright COMPONENT ${component})
endforeach()
install(FILES NOTICE CHANGELOG.md CITATION.cff README.md DESTINATION ${doc}/waymark COMPONENT program)
install(DIRECTORY docs DESTINATION ${doc}/waymark COMPONENT program
        PATTERN Doxyfile EXCLUDE PATTERN layers.txt EXCLUDE PATTERN __pycache__ EXCLUDE)
install(DIRECTORY ros DESTINATION ${CMAKE_INSTALL_DATADIR}/waymark COMPONENT development)
install(DIRECTORY sample_data DESTINATION ${CMAKE_INSTALL_DATADIR}/waymark COMPONENT program)

execute_process(COMMAND ${PROJECT_SOURCE_DIR}/scripts/install-packages --list libraries
                OUTPUT_VARIABLE libraries OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ", " libraries "${libraries}")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Waymark developers")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development qgis)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME waymark)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "python3-waymark, qgis-plugin-waymark")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libwaymark-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${libraries}")
set(CPACK_DEBIAN_QGIS_PACKAGE_NAME qgis-plugin-waymark)
set(CPACK_DEBIAN_QGIS_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_QGIS_PACKAGE_DEPENDS "python3-qgis, python3-gdal, waymark")
if(WAYMARK_PYTHON)
  set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_BINARY_DIR}/python/PackPython.cmake)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-waymark)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  # The module is of this Python only.
  math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-geopandas, waymark")
endif()
include(CPack)

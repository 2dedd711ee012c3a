# Install rules, the CMake package, and two Debian packages: waymark (the program) and libwaymark-dev.
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
install(FILES ${PROJECT_BINARY_DIR}/WaymarkConfig.cmake ${PROJECT_BINARY_DIR}/WaymarkConfigVersion.cmake
              cmake/Catalogue.cmake cmake/FindOpenCVParts.cmake
        DESTINATION ${package_dir} COMPONENT development)

# The program writes its own man page and completion, so that they cannot disagree with it.
set(pages ${PROJECT_BINARY_DIR}/pages)
add_custom_command(OUTPUT ${pages}/waymark.1.gz ${pages}/waymark
  COMMAND waymark man > ${pages}/waymark.1
  COMMAND gzip -9nf ${pages}/waymark.1
  COMMAND waymark completion bash > ${pages}/waymark
  DEPENDS waymark VERBATIM)
file(MAKE_DIRECTORY ${pages})
add_custom_target(waymark_pages ALL DEPENDS ${pages}/waymark.1.gz)
install(FILES ${pages}/waymark.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${pages}/waymark DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
install(FILES NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

execute_process(COMMAND ${PROJECT_SOURCE_DIR}/scripts/install-packages --list libraries
                OUTPUT_VARIABLE libraries OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ", " libraries "${libraries}")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Waymark developers")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME waymark)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libwaymark-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${libraries}")
include(CPack)

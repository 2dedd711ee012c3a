# One static library per folder of docs/layers.txt: waymark_<name>, from the folder's own *.cpp and *.hpp.
#   waymark_folder(NAME geo FOLDERS . USES waymark_core PRIVATE GeographicLib::GeographicLib)
# FOLDERS: subfolders whose sources belong to it, relative to the caller. USES: public; PRIVATE: in .cpp only.
# PLAIN: it holds no computation worth -O2.
function(waymark_folder)
  cmake_parse_arguments(PARSE_ARGV 0 arg "PLAIN" "NAME" "FOLDERS;USES;PRIVATE")
  foreach(folder IN LISTS arg_FOLDERS)
    cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
    string(REGEX REPLACE "/$" "" folder ${folder})
    file(GLOB found_sources CONFIGURE_DEPENDS ${folder}/*.cpp)
    file(GLOB found_headers CONFIGURE_DEPENDS ${folder}/*.hpp)
    list(APPEND sources ${found_sources})
    foreach(header IN LISTS found_headers)
      cmake_path(REPLACE_EXTENSION header cpp OUTPUT_VARIABLE its_source)
      if(NOT its_source IN_LIST found_sources)
        list(APPEND lone_headers ${header})
      endif()
    endforeach()
  endforeach()
  if(NOT sources)  # a room that is not furnished yet
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${arg_NAME}_empty.cpp CONTENT "")
    set(sources ${CMAKE_CURRENT_BINARY_DIR}/${arg_NAME}_empty.cpp)
  endif()
  set(target waymark_${arg_NAME})
  add_library(${target} STATIC ${sources})
  add_library(Waymark::${arg_NAME} ALIAS ${target})
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(${target} PUBLIC ${arg_USES} PRIVATE ${arg_PRIVATE})
  # Not linked: an exported static library names all that it links.
  target_compile_options(${target} PRIVATE $<TARGET_PROPERTY:waymark_build_rules,INTERFACE_COMPILE_OPTIONS>
                         ${waymark_compiler_memory} ${waymark_shareable_code})
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${arg_NAME})
  # A header stands alone: its own .cpp includes it first (which the asan preset, without precompiled headers,
  # proves); a header without one is compiled by itself.
  waymark_verify_headers(${target} ${PROJECT_SOURCE_DIR} ${lone_headers})
  waymark_unity(${target})
  if(arg_PLAIN)
    waymark_plain(${target})
  elseif(fmt::fmt IN_LIST arg_PRIVATE)  # what the precompiled header was made with
    waymark_use_precompiled(${target} waymark_precompiled)
  endif()
  set_property(GLOBAL APPEND PROPERTY WAYMARK_LIBRARIES ${target})  # for pkg-config
  install(TARGETS ${target} EXPORT WaymarkTargets ARCHIVE COMPONENT development)
endfunction()

# Compiles headers by themselves in the target all_verify_interface_header_sets.
function(waymark_verify_headers TARGET FOLDER)
  add_library(${TARGET}_headers INTERFACE)
  target_sources(${TARGET}_headers INTERFACE FILE_SET HEADERS BASE_DIRS ${FOLDER} FILES ${ARGN})
  target_link_libraries(${TARGET}_headers INTERFACE ${TARGET})
  set_target_properties(${TARGET}_headers PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
endfunction()

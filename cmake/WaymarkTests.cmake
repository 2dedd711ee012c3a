# Seconds until a test is taken to hang; sanitizers take five times as long.
function(waymark_patience variable seconds)
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    math(EXPR seconds "5 * ${seconds}")
  endif()
  set(${variable} ${seconds} PARENT_SCOPE)
endfunction()

# tests/<folder>/*.cpp and, at any depth, *_test.cpp become one executable <folder>_tests whose cases ctest lists one by
# one: a target for each library, however many folders it has.
#   waymark_tests(NAME geo USES waymark_geo)
function(waymark_tests)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "NAME" "USES")
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  file(GLOB_RECURSE tests CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp)
  list(APPEND sources ${tests})
  list(REMOVE_DUPLICATES sources)
  if(NOT sources)
    return()
  endif()
  set(target ${arg_NAME}_tests)
  add_executable(${target} ${sources})
  target_link_libraries(${target} PRIVATE ${arg_USES} waymark_test_support waymark_build_rules waymark_test_options
                        GTest::gmock GTest::gtest_main)
  waymark_use_precompiled(${target} waymark_tests_precompiled)
  waymark_unity(${target})
  waymark_patience(patience 600)
  # ctest keeps the times of tests whose names have no spaces, so names are those without values of parameters.
  # The last line of a skipped test. A suite whose preparation fails skips its tests, too, and says more after it.
  gtest_discover_tests(${target} TEST_PREFIX ${arg_NAME}. DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES
                       PROPERTIES TIMEOUT ${patience} ENVIRONMENT RC_PARAMS=seed=2026
                       SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\] [^[]*$")
endfunction()

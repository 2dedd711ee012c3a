# Precompiled headers for the folders that compute, for the plain ones and for the tests: what nearly every file of ours includes, parsed once.
# Our own headers are not in it, so editing one rebuilds no more than its users. Each file still includes all it
# uses: -DWAYMARK_PRECOMPILED=OFF (as the asan preset has it) builds without.
option(WAYMARK_PRECOMPILED "Build with precompiled headers" ON)
set(standard_headers <algorithm> <array> <charconv> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional>
    <limits> <map> <memory> <mutex> <numbers> <numeric> <optional> <set> <span> <sstream> <stdexcept> <string>
    <string_view> <tuple> <unordered_map> <utility> <variant> <vector>)

function(waymark_precompile NAME)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "HEADERS;USES")
  if(WAYMARK_PRECOMPILED)
    file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/${NAME}.cpp CONTENT "")
    add_library(${NAME} OBJECT ${CMAKE_BINARY_DIR}/${NAME}.cpp)
    target_link_libraries(${NAME} PRIVATE waymark_build_rules ${arg_USES})
    target_compile_features(${NAME} PRIVATE cxx_std_20)
    target_precompile_headers(${NAME} PRIVATE ${standard_headers} ${arg_HEADERS})
  endif()
endfunction()

function(waymark_use_precompiled TARGET FROM)
  if(TARGET ${FROM})
    target_precompile_headers(${TARGET} REUSE_FROM ${FROM})
  endif()
endfunction()

waymark_precompile(waymark_precompiled HEADERS <Eigen/Dense> <fmt/format.h> USES Eigen3::Eigen fmt::fmt)
waymark_precompile(waymark_plain_precompiled HEADERS <Eigen/Dense> <fmt/format.h> <nlohmann/json.hpp>
                   USES Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json)
if(WAYMARK_PRECOMPILED)
  target_compile_options(waymark_precompiled PRIVATE ${waymark_shareable_code})
  target_compile_options(waymark_plain_precompiled PRIVATE ${waymark_shareable_code} ${waymark_plain_code})
endif()

function(waymark_plain TARGET)
  target_compile_options(${TARGET} PRIVATE ${waymark_plain_code})
  waymark_use_precompiled(${TARGET} waymark_plain_precompiled)
endfunction()

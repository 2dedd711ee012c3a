# Warnings and floating-point rules every target of ours is compiled with, and nobody who links to us.
add_library(waymark_build_rules INTERFACE)
target_compile_options(waymark_build_rules INTERFACE
  $<$<CXX_COMPILER_ID:GNU>:-Wall;-Wextra;-Wconversion;-Wshadow;-Wold-style-cast;-Werror>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-stringop-overflow>  # false alarms of g++ 12 on std::string (bug 105651)
  -ffp-contract=off)  # the same bits on a machine with and without fused multiply-add
# The libraries go into the program and into the Python module, which takes position-independent code only. Hidden
# symbols are called directly and inlined, as in an executable, so the program is not slower for it.
set(waymark_shareable_code -fPIC -fvisibility=hidden -fvisibility-inlines-hidden)
# Memory instead of time: a unit of two dozen sources spends a twelfth of its time collecting garbage otherwise.
set(waymark_compiler_memory $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-expand=200$<SEMICOLON>--param=ggc-min-heapsize=262144>)
# Folders that read, call and print rather than compute: at -O1 g++ compiles them in three quarters of the time.
set(waymark_plain_code $<$<CONFIG:Release>:-O1>)
find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()
find_program(MOLD mold)
if(MOLD)
  add_link_options(-fuse-ld=mold)
endif()

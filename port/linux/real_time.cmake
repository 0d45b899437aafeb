# crankloop_real_time: a periodic loop on Linux and the block it shares; what `crankloop live` and its controllers link.
# Included by tools/, since the program needs it, and images (crankloop_port) do not.
add_library(crankloop_real_time STATIC
  ${CMAKE_CURRENT_LIST_DIR}/periodic.cpp
  ${CMAKE_CURRENT_LIST_DIR}/real_time.cpp
  ${CMAKE_CURRENT_LIST_DIR}/shared_block.cpp)
target_include_directories(crankloop_real_time PUBLIC ${crankloop_SOURCE_DIR})  # port/linux/...
target_compile_features(crankloop_real_time PUBLIC cxx_std_17)
set_target_properties(crankloop_real_time PROPERTIES CXX_EXTENSIONS OFF)
crankloop_warnings(crankloop_real_time)

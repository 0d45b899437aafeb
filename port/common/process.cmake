# crankloop_port of a process: see port/common/machine.hpp. Its images count no instructions.
add_library(crankloop_port OBJECT ../common/process.cpp)
target_include_directories(crankloop_port PUBLIC ${crankloop_SOURCE_DIR})
target_compile_features(crankloop_port PUBLIC cxx_std_17)
crankloop_warnings(crankloop_port)

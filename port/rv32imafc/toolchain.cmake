# RV32IMAFC: 32-bit RISC-V with single-precision floating-point unit. Images run on QEMU's virt machine.
include("${CMAKE_CURRENT_LIST_DIR}/../common/bare_metal.cmake")
crankloop_bare_metal(rv32imafc riscv64-unknown-elf "-march=rv32imafc -mabi=ilp32f -mcmodel=medany --specs=picolibc.specs")
# Debian has no C++ library for bare-metal RISC-V. The library needs headers only, and those of the Arm compiler of the
# same version serve.
file(GLOB crankloop_cxx_headers /usr/include/newlib/c++/*)
if(crankloop_cxx_headers)
  string(APPEND CMAKE_CXX_FLAGS_INIT " -isystem ${crankloop_cxx_headers} -isystem ${crankloop_cxx_headers}/arm-none-eabi")
endif()
# An instruction takes 2^0 ns of the emulated time.
set(CMAKE_CROSSCOMPILING_EMULATOR
  qemu-system-riscv32 -M virt -bios none ${crankloop_qemu_arguments} -icount shift=0,sleep=off -kernel)
set(CRANKLOOP_PORT_SOFT_DOUBLE ON CACHE BOOL "Double arithmetic is software: slow")
set(CRANKLOOP_PORT_TITLE "RV32IMAFC" CACHE STRING "The processor, for people")

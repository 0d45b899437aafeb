# Cortex-R5F: Arm state, floating-point unit with double precision. Images run on a bare Cortex-R5F of QEMU with 16 MB
# of RAM at 0.
include("${CMAKE_CURRENT_LIST_DIR}/../common/bare_metal.cmake")
crankloop_bare_metal(cortex_r5f arm-none-eabi "-mcpu=cortex-r5 -marm -mfpu=vfpv3-d16 -mfloat-abi=hard")
# An instruction takes 2^0 ns of the emulated time, and the cycle counter counts nanoseconds.
set(CMAKE_CROSSCOMPILING_EMULATOR
  ${CMAKE_CURRENT_LIST_DIR}/run.sh qemu-system-arm -M none -cpu cortex-r5f -m 16M ${crankloop_qemu_arguments} -icount shift=0,sleep=off)
set(CRANKLOOP_PORT_TITLE "Cortex-R5F" CACHE STRING "The processor, for people")

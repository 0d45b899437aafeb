# What the toolchain files of the Cortex-M ports share.
#
#   crankloop_cortex_m(PORT FLAGS MACHINE)   PORT is the folder of port/, MACHINE one of QEMU's
include("${CMAKE_CURRENT_LIST_DIR}/../common/bare_metal.cmake")

macro(crankloop_cortex_m port flags machine)
  crankloop_bare_metal(${port} arm-none-eabi "${flags}")
  # An instruction takes 2^10 ns of the emulated time: the counter of port/cortex_m/machine.cpp rests on it.
  # sleep=off: waiting for an interrupt takes no time of the building machine, whose load would otherwise show.
  set(CMAKE_CROSSCOMPILING_EMULATOR
    qemu-system-arm -M ${machine} ${crankloop_qemu_arguments} -icount shift=10,sleep=off -kernel)
endmacro()

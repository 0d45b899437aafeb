# CHANGE: what the processor is and where its images run. As it stands: Cortex-M33 on QEMU's mps2-an505.
include("${CMAKE_CURRENT_LIST_DIR}/../common/bare_metal.cmake")
# CHANGE: folder of port/; prefix of the compiler; flags that say which processor and which floating-point unit.
crankloop_bare_metal(template arm-none-eabi "-mcpu=cortex-m33 -mthumb -mfpu=fpv5-sp-d16 -mfloat-abi=hard")
# CHANGE: the command that runs an image, its file put at the end: an emulator, or a script that loads a board by its
# debugger, prints what the image writes to standard error and ends with the image's status.
set(CMAKE_CROSSCOMPILING_EMULATOR
  qemu-system-arm -M mps2-an505 ${crankloop_qemu_arguments} -icount shift=10,sleep=off -kernel)
# CHANGE: leave this out where double is hardware.
set(CRANKLOOP_PORT_SOFT_DOUBLE ON CACHE BOOL "Double arithmetic is software: slow")
set(CRANKLOOP_PORT_TITLE "Cortex-M33 (port/template)" CACHE STRING "The processor, for people")

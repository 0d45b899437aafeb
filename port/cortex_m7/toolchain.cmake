# Cortex-M7: floating-point unit with double precision. Images run on QEMU's mps2-an500.
include("${CMAKE_CURRENT_LIST_DIR}/../cortex_m/toolchain.cmake")
crankloop_cortex_m(cortex_m7 "-mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard" mps2-an500)
set(CRANKLOOP_PORT_TITLE "Cortex-M7" CACHE STRING "The processor, for people")

# Cortex-M4F: single-precision floating-point unit. Images run on QEMU's mps2-an386.
include("${CMAKE_CURRENT_LIST_DIR}/../cortex_m/toolchain.cmake")
crankloop_cortex_m(cortex_m4f "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard" mps2-an386)
set(CRANKLOOP_PORT_SOFT_DOUBLE ON CACHE BOOL "Double arithmetic is software: slow")
set(CRANKLOOP_PORT_CYCLES_OF cortex-m4 CACHE STRING "The processor whose cycles tests/target/worst_tick counts")
set(CRANKLOOP_PORT_TITLE "Cortex-M4F" CACHE STRING "The processor, for people")

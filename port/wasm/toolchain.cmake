# WebAssembly by clang and wasi-libc, run by Node on the building machine. Its images are processes, as those of
# port/linux, of the interface that WASI describes.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_CXX_COMPILER clang++)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
option(CRANKLOOP_WASM_SIMD "Four floats in one register: valves and cylinders abreast" OFF)
if(CRANKLOOP_WASM_SIMD)
  set(CMAKE_CXX_FLAGS_INIT "-msimd128 -DCRANKLOOP_ABREAST=1")
endif()
# The linker's stack of 64 KiB lies above the data, which one that is too small would overwrite.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,--stack-first -Wl,-z,stack-size=1048576")
set(CMAKE_CROSSCOMPILING_EMULATOR node "${CMAKE_CURRENT_LIST_DIR}/run.mjs")
set(CMAKE_FIND_ROOT_PATH /usr/lib/wasm32-wasi)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)  # nothing of the building machine is linked
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CRANKLOOP_PORT wasm CACHE STRING "")

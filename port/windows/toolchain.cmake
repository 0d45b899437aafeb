# 64-bit Windows by MinGW-w64, run by Wine on the building machine. Its images are processes, as those of port/linux;
# they bring their run-time libraries along.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
find_program(CRANKLOOP_MINGW_CXX NAMES x86_64-w64-mingw32-g++-posix x86_64-w64-mingw32-g++ x86_64-w64-mingw32-g++-win32 REQUIRED)
string(REPLACE "g++" "gcc" mingw_c "${CRANKLOOP_MINGW_CXX}")
set(CMAKE_C_COMPILER "${mingw_c}")
set(CMAKE_CXX_COMPILER "${CRANKLOOP_MINGW_CXX}")
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_CROSSCOMPILING_EMULATOR "${CMAKE_CURRENT_LIST_DIR}/run.sh")
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)  # nothing of the building machine is linked
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CRANKLOOP_PORT windows CACHE STRING "")

/* The library's version, for C and C++ alike: a program may compare it, an FMU states it. CMakeLists.txt has it too. */
#ifndef CRANKLOOP_VERSION_H
#define CRANKLOOP_VERSION_H

#define CRANKLOOP_VERSION_MAJOR 0
#define CRANKLOOP_VERSION_MINOR 3
#define CRANKLOOP_VERSION_PATCH 0
#define CRANKLOOP_VERSION (CRANKLOOP_VERSION_MAJOR << 16 | CRANKLOOP_VERSION_MINOR << 8 | CRANKLOOP_VERSION_PATCH)

#endif

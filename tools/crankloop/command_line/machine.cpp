#include "machine.hpp"

#include <sys/utsname.h>

#include <fstream>

#ifndef CRANKLOOP_BUILD_FLAGS
#define CRANKLOOP_BUILD_FLAGS "unknown flags"
#endif

namespace crankloop::program {
namespace {

/// Where Linux tells it; Arm's does not.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

std::string architecture() {
  utsname names{};
  return ::uname(&names) == 0 ? names.machine : "unknown architecture";
}

std::string compiler() {
#if defined(__clang__)
  return "Clang " __clang_version__;
#else
  return "GCC " __VERSION__;
#endif
}

}  // namespace

std::string describe_machine() {
  return architecture() + ", " + processor() + ", " + compiler() + ", " CRANKLOOP_BUILD_FLAGS;
}

}  // namespace crankloop::program

// Which machine, compiler and flags the benchmark's figures are of.
#pragma once

#include <string>

namespace crankloop::program {

/// One line: "x86_64, AMD EPYC, GCC 12.2.0, Release -O3 -DNDEBUG".
[[nodiscard]] std::string describe_machine();

}  // namespace crankloop::program

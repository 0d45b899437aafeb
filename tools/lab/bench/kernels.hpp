// Single contestants of the benchmark without a clock, for an instruction counter: `crankloop bench --kernel NAME
// --ticks N`.
//
// What belongs here: the contestants that tests/contract/bench counts. What does not: timing, errors.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace crankloop::program::bench {

struct Kernel {
  const char* name;
  std::function<std::function<void(int ticks)>()>
      make;  ///< builds its tables; returns a function that runs a number of ticks
};

[[nodiscard]] const std::vector<Kernel>& kernels();

/// Runs a contestant; for an unknown name throws an error that lists all names.
void run_kernel(const std::string& name, int ticks);

}  // namespace crankloop::program::bench

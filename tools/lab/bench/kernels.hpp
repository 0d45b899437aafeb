// Single contestants of the benchmark without a clock, for an instruction counter: `crankloop bench --kernel NAME
// --ticks N`.
//
// What belongs here: what stands under the gate of tests/contract/bench. What does not: timing, errors.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace crankloop::program::bench {

struct Kernel {
  const char* name;
  std::function<std::function<void(int ticks)>()> make;  ///< builds its tables; what that returns runs so many ticks
};

[[nodiscard]] const std::vector<Kernel>& kernels();

/// Runs one of them; an unknown name is the user's error and names them all.
void run_kernel(const std::string& name, int ticks);

}  // namespace crankloop::program::bench

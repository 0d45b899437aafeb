// The arithmetic of the tick, as given by --real.
#pragma once

#include <string>

namespace crankloop::program {

/// Calls `run` with a zero of the type that --real names:
///
///     with_real(arguments.text("--real"), [&](auto zero) { write<decltype(zero)>(csv); });
template <class Run>
decltype(auto) with_real(const std::string& real, const Run& run) {
  return real == "float" ? run(float{}) : run(double{});
}

}  // namespace crankloop::program

// The option --load-ratio of commands that look at an engine at one load.
#pragma once

#include "arguments.hpp"
#include "engine_file/engine_file.hpp"
#include "error.hpp"

namespace crankloop::program {

inline constexpr Option kLoadRatio = number("--load-ratio", "Q", from(0).up_to(2), "0 = motored, 1 = the pressure diagram as it is", "1");

/// Refuses it where there is no pressure that it could scale.
inline void require_heat_to_scale(const Arguments& arguments, const EngineFile& engine) {
  if (arguments.has("--load-ratio") && engine.definition().pressure.source == PressureSource::none) {
    throw InputError(engine.path() + ": there is no pressure source, so --load-ratio has nothing to scale");
  }
}

}  // namespace crankloop::program

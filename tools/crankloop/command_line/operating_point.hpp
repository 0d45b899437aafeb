// Options for the operating point of an engine: speed, load, tick, valve train. Those that the file or custom answers
// may be left out.
#pragma once

#include <string>
#include <vector>

#include "../engine_file/engine_file.hpp"
#include "../files/error.hpp"
#include "../files/words.hpp"
#include "arguments.hpp"

namespace crankloop::program {

inline constexpr Option kLoadRatio =
    number("--load-ratio", "Q", from(0).up_to(2), "0 = motored, 1 = the pressure diagram as it is", "1");
inline constexpr Option kSpeed = number("--rpm", "N", from(-100000).up_to(100000),
                                        "engine speed in rpm, backwards if negative; default the file's rated_rpm");
inline constexpr Option kTick = number("--tick-us", "T", from(1).up_to(2000), "length of a tick in us", "100");
inline constexpr Option kMisfire =
    words("--misfire", "RULE", "a cylinder's misfires, by the keys of [misfire N]: 'cylinder=2 every=16'");

/// Refuses it where there is no pressure that it could scale.
inline void require_heat_to_scale(const Arguments& arguments, const EngineFile& engine) {
  if (arguments.has("--load-ratio") && engine.definition().pressure.source == PressureSource::none) {
    throw InputError(engine.path() + ": there is no pressure source, so --load-ratio has nothing to scale");
  }
}

/// Of --rpm, or rated.
inline double speed_rpm(const Arguments& arguments, const EngineFile& engine) {
  if (arguments.has("--rpm")) return arguments.number("--rpm");
  if (!engine.has("engine"))
    throw UsageError("--rpm is missing, and " + engine.path() + " has no [engine] with a rated_rpm");
  return engine.rated_rpm();
}

/// Of --train, or the only one that the file has.
inline std::string train_name(const Arguments& arguments, const EngineFile& engine) {
  if (arguments.has("--train")) return arguments.text("--train");
  if (engine.trains().size() == 1) return engine.trains()[0].name;
  std::vector<std::string> names;
  for (const TrainOfFile& train : engine.trains()) names.push_back(train.name);
  throw UsageError("--train is missing; " + engine.path() +
                   (names.empty() ? " has no valve train" : " has " + join(names)));
}

}  // namespace crankloop::program

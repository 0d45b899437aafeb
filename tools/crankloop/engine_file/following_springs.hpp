// An engine whose valve springs follow their valves, for the ready-made scenes: they step no surge.
#pragma once

#include <string>
#include <vector>

#include <crankloop/define/engine_definition.hpp>

#include "engine_file.hpp"

namespace crankloop::program {

/// Without the modes of its springs; it points to the same rows.
[[nodiscard]] inline EngineDefinition with_springs_that_follow(EngineDefinition definition) noexcept {
  for (ValveTrain& train : definition.trains) train.valve.surge_modes = 0;
  return definition;
}

/// Whether the file lets any springs surge.
[[nodiscard]] inline bool springs_surge(const EngineFile& file) noexcept {
  bool any = false;
  for (const TrainOfFile& train : file.trains()) any = any || train.definition.valve.surge_modes != 0;
  return any;
}

/// A warning for each train whose springs surge by the file.
[[nodiscard]] inline std::vector<std::string> warnings_about_springs_that_follow(const EngineFile& file) {
  std::vector<std::string> lines;
  for (const TrainOfFile& train : file.trains()) {
    if (train.definition.valve.surge_modes == 0) continue;
    lines.push_back(file.path() + ": warning: [valve " + train.name +
                    "] surge_modes: springs follow their valves in this command; `crankloop valve` and `crankloop "
                    "redline` step their surge");
  }
  return lines;
}

}  // namespace crankloop::program

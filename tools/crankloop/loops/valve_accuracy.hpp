// Whether elastic valves keep their accuracy class at a tick length and speed, and by how much they exceed it.
//
// What belongs here: ticks that turn a cam too far for the class. What does not: ticks that are refused
// (valve_tick_limit.hpp).
#pragma once

#include <string>
#include <vector>

#include "../engine_file/engine_file.hpp"
#include "valve_loop.hpp"

namespace crankloop::program {

/// Largest error of the lift in a cycle from rest, in m: compared with the same valve in ticks a sixteenth as long, for
/// 16 starts in different parts of a tick. If the motion itself amplifies errors, this is one sample of them. For
/// speeds other than 0, within one revolution per tick.
[[nodiscard]] double expected_error_m(const LoneValve& valve, double speed_rpm, double tick_s,
                                      const ValveStepping& stepping);

/// A warning if a valve is expected to exceed its class; else none.
[[nodiscard]] std::vector<std::string> beyond_class(const LoneValve& valve, double speed_rpm, double tick_s,
                                                    const ValveStepping& stepping = {});

/// Those of all trains of an engine file as ready-made scenes step them, whose springs follow their valves.
[[nodiscard]] std::vector<std::string> warnings_about_valves(const EngineFile& file, double speed_rpm, double tick_s,
                                                             const ValveStepping& stepping = {});

}  // namespace crankloop::program

// Whether elastic valves keep their accuracy class in ticks of a length at a speed, and by how much they miss it.
//
// What belongs here: ticks that turn a cam so far that its lift is not followed to the class. What does not: ticks that
// are refused (valve_tick_limit.hpp).
#pragma once

#include <string>
#include <vector>

#include "../engine_file/engine_file.hpp"
#include "valve_loop.hpp"

namespace crankloop::program {

/// By how much the lift is off at most in a cycle from rest, in m: against the same valve in ticks a sixteenth as long,
/// 16 times, beginning in different parts of a tick. Where the motion itself magnifies errors this is one sample of
/// them. For speeds other than 0, within one revolution per tick.
[[nodiscard]] double expected_error_m(const LoneValve& valve, double speed_rpm, double tick_s,
                                      const ValveStepping& stepping);

/// A warning where a valve is expected to miss its class; else none.
[[nodiscard]] std::vector<std::string> beyond_class(const LoneValve& valve, double speed_rpm, double tick_s,
                                                    const ValveStepping& stepping = {});

/// Those of all trains of an engine file.
[[nodiscard]] std::vector<std::string> warnings_about_valves(const EngineFile& file, double speed_rpm, double tick_s,
                                                             const ValveStepping& stepping = {});

}  // namespace crankloop::program

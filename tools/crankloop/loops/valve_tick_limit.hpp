// The message to a user whose tick is too long for a valve train.
//
// What belongs here: the message with the longest tick possible. What does not: the rule
// (crankloop/tabulate/valve_motion.hpp).
#pragma once

#include <string>
#include <vector>

#include <crankloop/tabulate/valve_motion.hpp>

#include "../engine_file/engine_file.hpp"

namespace crankloop::program {

/// The message for a tick that would need too many steps of this train, whose valve may be another than the file's.
[[nodiscard]] InputError tick_too_long(const EngineFile& file, const TrainOfFile& train, const Valve& valve,
                                       double tick_s, const ValveStepping& stepping);

/// The message for a refusal by tabulate: a tick too long for a train, a train's geometry with the angle, or any other
/// field of the file.
[[nodiscard]] InputError explain_tabulate(const EngineFile& file, const Status& refused, double tick_s,
                                          const ValveStepping& stepping = {});

/// Throws explain_tabulate()'s message if a tick is too long for a train of the file, or a train's geometry does not
/// close.
void require_trains(const EngineFile& file, double tick_s, const ValveStepping& stepping = {});

/// Effect of the tick's length on each train: steps of a valve in the worst tick, and the longest tick.
[[nodiscard]] std::vector<std::string> ticks_in_words(const EngineFile& file);

/// Cam degrees of a tick up to which a train's valve keeps its class, from tabulate's report; 360: always.
[[nodiscard]] double class_deg(const ValveTrain& train, double tick_s, const ValveStepping& stepping);

/// Longest tick that every train of a definition allows, at most 2 ms.
[[nodiscard]] double longest_tick_of(const EngineDefinition& definition);

}  // namespace crankloop::program

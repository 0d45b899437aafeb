// The engines of the benchmark as structs, so that the program needs no files.
//
// What belongs here: definitions. What does not: measurements. tests/tools/bench_test.cpp compares them with
// tools/engines.
#pragma once

#include <crankloop/define/engine_definition.hpp>

namespace crankloop::program::bench {

/// Lengths of the 495 diesel (tools/engines/diesel_495.ini).
[[nodiscard]] Crank diesel_495_crank();

/// The intake train of the 125 cm^3 overhead-cam engine (tools/engines/ohc_125.ini): rated at 7000 rpm, floats from
/// 8800, bounces far at 12 000.
[[nodiscard]] ValveTrain ohc_125_train();

/// Engines of 1, 4, 6, 8 or 12 cylinders of that 125, each with `trains` (0 to 4) trains that differ in phase: intake,
/// exhaust, and a second of each that opens 4 deg later. Pressures are the caller's.
[[nodiscard]] EngineDefinition engine_of(int cylinders, int trains);

/// One cylinder, one such train.
[[nodiscard]] EngineDefinition one_valve_engine();

}  // namespace crankloop::program::bench

// The signals of an engine's trigger wheels at a constant speed, as a file that viewers of logic signals open.
//
// What belongs here: the run. What does not: how its ticks become a file (signal_dump.hpp).
#pragma once

#include "../../engine_file/engine_file.hpp"
#include "../../files/output_file.hpp"
#include "../../loops/run_loop.hpp"

namespace crankloop::program {

/// Writes the levels of all wheels from phase 0 over some cycles of 720 deg, and the speed. Throws InputError for a
/// file without wheels.
void write_signals(const EngineFile& engine, const Operation& operation, int cycles, Output& out);

}  // namespace crankloop::program

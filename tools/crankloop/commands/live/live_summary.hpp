// The summary of `crankloop live`: the machine, its timing, the engine's results.
//
// What belongs here: lines and rows. What does not: measurement (live_loop.hpp).
#pragma once

#include <string>

#include "../../engine_file/engine_file.hpp"
#include "../../files/output_file.hpp"
#include "live_loop.hpp"

namespace crankloop::program {

/// What a run had beside its engine.
struct LiveExtras {
  bool shared = false;                      ///< a block that a controller could write to
  const LiveTrace* trace = nullptr;         ///< null: none
  const InputSchedule* schedule = nullptr;  ///< null: none
};

/// Lines "name = value unit", remarks after '#'. `real`: arithmetic of the tick.
[[nodiscard]] std::string live_summary(const EngineFile& file, const LiveRequest& request, const std::string& real,
                                       const LiveExtras& extras, const LiveFigures& figures);

/// CSV: a row per bucket that is not empty.
void write_live_histogram(Output& out, const LiveFigures& figures);

}  // namespace crankloop::program

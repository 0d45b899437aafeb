// What `run` prints of a run at constant speed.
//
// What belongs here: which figures, in which order, with which remark. What does not: the loop and its files (run.cpp),
// lines of the gas exchange (command_line/gas_options.hpp, loops/run_gas.hpp).
#pragma once

#include <string>
#include <vector>

#include <crankloop/tabulate/summary.hpp>

#include "../../command_line/summary.hpp"
#include "../../engine_file/engine_file.hpp"
#include "../../loops/fixed_step_loop.hpp"
#include "../../loops/run_loop.hpp"

namespace crankloop::program {

/// What the user asked for of a run at constant speed, but for the files.
struct HeldRequest {
  Operation operation;
  int cycles;
  std::string real;
  std::vector<std::string> warnings;  ///< told, for the report
};

struct HeldEngine {
  const EngineFile& file;
  const ExactEngine& exact;

  [[nodiscard]] bool has_gas() const noexcept { return exact.definition().pressure.source != PressureSource::none; }
  [[nodiscard]] bool breathes() const noexcept { return program::breathes(exact.definition()); }
};

/// `cycle` is of an engine whose pressure is a function of its angle.
[[nodiscard]] Summary summary_of(const HeldEngine& engine, const HeldRequest& request, const RunFigures& figures,
                                 const CycleSummary& cycle);

/// Last, and only where a command prints: it differs from run to run.
void add_wall_time(Summary& s, double wall_time_per_tick_ns);

}  // namespace crankloop::program

// `crankloop run FILE --free`: the engine turned by its own gas over some seconds, its figures, its ticks as CSV, its
// report, its signals.
//
// What belongs here: the request for such a run, and its results. What does not: options (run.cpp).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "../../command_line/results.hpp"
#include "../../engine_file/engine_file.hpp"
#include "../../loops/run_gas.hpp"
#include "../../report/page.hpp"
#include "free_cycles.hpp"
#include "free_energy.hpp"
#include "free_loop.hpp"
#include "free_overview.hpp"

namespace crankloop::program {

struct FreeRequest {
  FreeOperation operation;
  std::string real;  ///< "float" or "double"
  bool is_hashed = false;
  std::string command_line;           ///< for the report
  std::vector<std::string> warnings;  ///< for the report
};

/// What became of one trigger wheel's signal.
struct SignalFigures {
  std::string name;
  std::uint64_t edges = 0;
  std::uint64_t lost = 0;  ///< counted, but the scene had no room to list them
};

/// What became of one cylinder whose cycles misfire by a rule.
struct MisfireFigures {
  std::size_t cylinder = 0;  ///< from 0
  MisfireRecord counts{};
};

struct FreeFigures {
  std::uint64_t ticks = 0;
  std::uint64_t faulty_ticks = 0;
  std::uint32_t faults = 0;     ///< all fault bits that occurred
  std::uint64_t reversals = 0;  ///< of the sense of rotation
  FreeState end;
  std::string hash;                ///< of every bit that the ticks show, where it was asked for
  double largest_speed_rad_s = 0;  ///< whatever its sense
  EnergyBalance energy;
  Overview speed_rpm{0};
  std::vector<FreeCycle> cycles;  ///< the last whole ones, at most CycleRecorder::kKept
  double friction_Nm = 0;         ///< at the last cycle's mean speed, as is the load
  double load_Nm = 0;
  std::vector<SignalFigures> signals;
  std::vector<MisfireFigures> misfires;
  GasFigures gas;          ///< of an engine with gas exchange; pressures at the end
  Overview intake_kPa{0};  ///< likewise

  /// The crank reached the speed limit, which takes energy that the balance does not have.
  [[nodiscard]] bool speed_was_limited() const { return (faults & kFaultOverspeed) != 0; }
};

/// Runs, writes --csv, --report and --vcd of the results, and prints the summary. `definition` is the file's, with the
/// load it is to run with.
void run_free(const EngineFile& file, const EngineDefinition& definition, const FreeRequest& request, Results& results);

struct FreeReportInput {
  const EngineFile& file;
  const EngineDefinition& definition;
  const FreeRequest& request;
  const FreeFigures& figures;
};
[[nodiscard]] report::Page free_run_report(const FreeReportInput& input);
[[nodiscard]] report::Section trigger_signal_section(const FreeReportInput& input);  ///< where there is a whole cycle

}  // namespace crankloop::program

// The report of `crankloop run`: definition and results of one engine as a page.
//
// What belongs here: the contents of the page and their order. What does not: how they are drawn (report/), how they
// are computed (run_loop.hpp, run_trace.hpp, run_accuracy.hpp).
#pragma once

#include <string>
#include <vector>

#include <crankloop/tabulate/summary.hpp>

#include "../engine_file/engine_file.hpp"
#include "../loops/run_accuracy.hpp"
#include "../loops/run_loop.hpp"
#include "../loops/run_trace.hpp"
#include "../report/page.hpp"

namespace crankloop::program {

/// A tick of the requested run, recorded for the close-up of the fixed step.
struct CloseUpTick {
  double crank_deg;
  double torque_Nm;
  double mean_torque_Nm;
};

/// The angles that the close-up shows: 40 ticks around the largest torque; empty if ticks are too close to be
/// distinguished.
struct CloseUpWindow {
  double from_deg = 0;
  double to_deg = 0;
  [[nodiscard]] bool contains(double crank_deg) const noexcept { return crank_deg > from_deg && crank_deg <= to_deg; }
};
[[nodiscard]] CloseUpWindow close_up_window(double largest_torque_deg, double deg_per_tick) noexcept;

/// The input of the page; held by the caller.
struct ReportInput {
  const EngineFile& file;
  const ExactEngine& exact;
  const CycleSummary& summary;
  const Operation& operation;
  const RunFigures& figures;
  const Trace& trace;
  const Accuracy& accuracy;
  const std::vector<CloseUpTick>& close_up;
  std::string real;          ///< "float" or "double"
  std::string command_line;  ///< with every option filled in
  double wall_time_per_tick_ns = 0;
  std::vector<std::string> warnings;  ///< each is shown at the top of the page
};

[[nodiscard]] report::Page engine_report(const ReportInput& input);

}  // namespace crankloop::program

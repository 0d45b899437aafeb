// Curves over one cycle, recorded from the fixed-step loop at a tick short enough to draw.
//
// What belongs here: recording. What does not: drawing (engine_report.hpp), figures of a run (run_loop.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <crankloop/define/engine_definition.hpp>
#include <crankloop/tabulate/summary.hpp>

#include "run_loop.hpp"
#include "run_quantities.hpp"
#include "run_valves.hpp"

namespace crankloop::program {

struct FreeForceTrace {
  std::vector<double> up_N, lateral_N, pitch_Nm, yaw_Nm;
};

/// One valve of cylinder 1.
struct ValveTrace {
  std::array<std::vector<double>, kValveQuantities> of;
  std::vector<std::uint32_t> regime;  ///< 0 free, 1 train, 2 seat, 3 both
  ValveCycle<double> cycle{};         ///< results of the lobe in the trace

  [[nodiscard]] const std::vector<double>& operator[](ValveQuantity quantity) const noexcept {
    return of[index_of(quantity)];
  }
};

/// The gas of cylinder 1 and of the manifolds; empty vectors where the engine has no gas exchange.
struct GasTrace {
  std::array<std::vector<double>, kGasQuantities> of;
  std::array<std::vector<double>, kPorts> manifold_Pa;
  std::array<std::vector<double>, kPorts> port_Pa;  ///< at the end of cylinder 1's runner; empty without one

  [[nodiscard]] const std::vector<double>& operator[](GasQuantity quantity) const noexcept {
    return of[index_of(quantity)];
  }
};

/// One cycle, all in SI, every vector of one length: entry i stands at crank_deg[i] = i * spacing_deg of cylinder 1's
/// own crank angle (0 = its firing top dead centre), the last at 720.
struct Trace {
  double spacing_deg = 0;
  double tick_s = 0;  ///< of the loop that recorded it
  std::vector<double> crank_deg;
  std::array<std::vector<double>, kQuantities> of;      ///< cylinder 1 and its crank pin
  std::vector<std::vector<double>> cylinder_torque_Nm;  ///< per cylinder
  std::vector<double> torque_Nm;
  std::vector<double> tilting_moment_Nm;             ///< all cylinders
  std::vector<std::vector<double>> pin_load_N;       ///< per crank pin
  std::vector<std::vector<double>> journal_along_N;  ///< per main journal, in the frame that turns with the crank
  std::vector<std::vector<double>> journal_across_N;
  std::vector<std::vector<double>> journal_up_N;  ///< the same in the frame of the block
  std::vector<std::vector<double>> journal_lateral_N;
  std::vector<std::vector<double>> journal_load_N;
  FreeForceTrace first;  ///< free forces and moments of the whole engine
  FreeForceTrace second;
  FreeForceTrace rotating;
  std::vector<ValveTrace> valves;  ///< per valve train
  GasTrace gas;                    ///< of an engine with gas exchange

  [[nodiscard]] const std::vector<double>& operator[](Quantity quantity) const noexcept {
    return of[index_of(quantity)];
  }
};

/// Runs the loop at the operation's speed and load, at a tick of its own: 0.25 deg apart, or wider where that would
/// take ticks below 1 us, or every n-th of ticks of 2 ms at most, less where a valve train demands it.
template <class Real, class S = scenes::Whole>
Trace record_trace(const EngineDefinition& definition, const Operation& operation);

/// The summary that summarise() computes for an engine with a diagram, from the pressures and torques of a recorded
/// cycle.
[[nodiscard]] CycleSummary summarise(const EngineDefinition& definition, double speed_rad_s, const Trace& trace);

}  // namespace crankloop::program

// The results of a run of some cycles in the fixed-step loop.
//
// What belongs here: results updated tick by tick, so that memory does not grow with the run. What does not: the loop
// (fixed_step_loop.hpp), files (run.cpp), curves over the angle (run_trace.hpp), the exact engine (run_accuracy.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <crankloop/crankloop.hpp>

#include "fixed_step_loop.hpp"
#include "run_gas.hpp"
#include "run_quantities.hpp"
#include "run_valves.hpp"

namespace crankloop::program {

/// A value and its angle.
struct Peak {
  double value = 0;
  double at_deg = 0;
};
struct Peaks {
  Peak largest;
  Peak smallest;
  bool any = false;

  void take(double value, double at_deg) noexcept {
    if (!any || value > largest.value) largest = {value, at_deg};
    if (!any || value < smallest.value) smallest = {value, at_deg};
    any = true;
  }
};

/// Of one valve train, over all cylinders.
struct ValveFigures {
  std::array<Peaks, kValveQuantities> of;  ///< where: the cylinder's own crank angle
  ValveCycle<double> last_cycle{};         ///< the worst of the cylinders' last whole cycles
};

/// Results of the recorded cycles in SI units.
struct RunFigures {
  int cycles = 0;
  std::uint64_t ticks = 0;  ///< recorded: the number that covers the cycles
  std::uint64_t settling_ticks = 0;
  double unsettled_Pa = 0;  ///< FixedStepLoop::unsettled_Pa()
  double deg_per_tick = 0;
  double mean_torque_Nm = 0;  ///< work over the cycles divided by their angle
  double power_W = 0;         ///< indicated
  double net_mep_Pa = 0;
  Peaks torque;                       ///< at the tick; where: engine angle
  std::array<Peaks, kQuantities> of;  ///< over all cylinders; where: the cylinder's own crank angle
  Peaks journal_load;                 ///< over all main journals; where: engine angle
  std::vector<ValveFigures> valves;   ///< per valve train
  GasFigures gas;                     ///< of an engine with gas exchange
  std::uint64_t faulty_ticks = 0;
  std::uint32_t faults = 0;  ///< all fault bits that occurred
  TableReport tables;
};

template <class Real, class S = scenes::Whole>
using OnTick = typename FixedStepLoop<Real, S>::OnTick;

/// Runs `cycles` cycles from the loop's current angle and collects the results.
///
/// A cycle is in general not a whole number of ticks. The last tick then extends beyond the last cycle; the work of its
/// part inside is that of the parabola with its mean torque and the torques at both ends. Peaks are those at the ticks,
/// not between them. Throws UsageError where the run would take more than kMaxTicks.
template <class Real, class S>
RunFigures run_cycles(FixedStepLoop<Real, S>& loop, const EngineDefinition& definition, const Operation& operation,
                      int cycles, const OnTick<Real, S>& on_tick = {});

}  // namespace crankloop::program

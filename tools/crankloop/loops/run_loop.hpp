// The engine in the fixed-step loop, as firmware runs it, and the results of a run of some cycles.
//
// What belongs here: stepping at one speed, and results updated tick by tick, so that memory does not grow with the
// run. What does not: files (run.cpp), curves over the angle (run_trace.hpp), the exact engine (run_accuracy.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <crankloop/crankloop.hpp>
#include <crankloop/scenes.hpp>

#include "../engine_file/gas_order.hpp"
#include "run_gas.hpp"
#include "run_limits.hpp"
#include "run_quantities.hpp"
#include "run_valves.hpp"

namespace crankloop::program {

/// How the engine is run: speed and load are constant.
struct Operation {
  double speed_rpm = 0;
  double tick_s = 100e-6;
  double load_ratio = 1;  ///< of an engine with a diagram
  GasOrder gas{};         ///< of an engine with gas exchange

  [[nodiscard]] double speed_rad_s() const noexcept { return speed_rpm * kPi / 30; }
};

/// Engine, tables and input. After construction cycles_to_settle() have been run, which lets any state settle, and the
/// engine is at `start_deg`: a recorded run begins there for any tick length. S is Whole, or Breathing for an engine
/// with gas exchange.
template <class Real, class S = scenes::Whole>
class FixedStepLoop {
 public:
  using Engine = crankloop::Engine<Real, S>;
  /// Called after every recorded tick: its number from 1, the engine angle after it in [0, 720), and the output.
  using OnTick = std::function<void(std::uint64_t tick, double crank_deg, const WholeOutput<Real, S>& out)>;

  /// The definition is valid and has masses, and the tick suits its valve trains. Throws UsageError for a speed beyond
  /// one revolution per tick, and for a tick so short that a cycle takes more than kMaxTicks. `after_tick` is called
  /// after each tick of the settling cycle.
  FixedStepLoop(const EngineDefinition& definition, const Operation& operation, double start_deg = 0,
                const std::function<void()>& after_tick = {});

  const WholeOutput<Real, S>& step() noexcept { return engine_.step(input_); }

  [[nodiscard]] const WholeOutput<Real, S>& output() const noexcept { return engine_.output(); }
  [[nodiscard]] double crank_deg() const noexcept;  ///< engine angle, 0 to below 720
  [[nodiscard]] double deg_per_tick() const noexcept { return deg_per_tick_; }
  [[nodiscard]] double ticks_per_cycle() const noexcept { return 720 / deg_per_tick_; }
  [[nodiscard]] std::uint64_t settling_ticks() const noexcept { return settling_ticks_; }
  /// For an engine with gas exchange: change of its net mean pressure in the last settling cycle.
  [[nodiscard]] double unsettled_Pa() const noexcept { return unsettled_Pa_; }
  [[nodiscard]] const TableReport& tables() const noexcept { return report_; }

  /// Wall time of step() on this machine: the median of kBatches batches of kBatchTicks. The engine runs on meanwhile.
  [[nodiscard]] double wall_time_per_tick_ns() noexcept;
  static constexpr int kBatches = 31;
  static constexpr int kBatchTicks = 2000;

 private:
  [[nodiscard]] double cycle_mep_Pa() const noexcept;  ///< of the last whole cycle, mean over the cylinders

  // Room for the finest possible gas grid: the program has enough memory.
  using Tables = TableStorage<Real, S, kMaxGasSegments>;

  std::unique_ptr<Tables> tables_ = std::make_unique<Tables>();
  TableReport report_;
  Engine engine_;
  typename Engine::Input input_;
  double deg_per_tick_ = 0;
  std::uint64_t settling_ticks_ = 0;
  double unsettled_Pa_ = 0;
};

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

// The engine in the fixed-step loop at one speed, as firmware runs it.
//
// What belongs here: setting it up, settling, stepping. A template, so that a scene which asks for more than the
// ready-made ones (port/wasm/module) runs by the same lines. What does not: results of a run (run_loop.hpp).
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include <crankloop/crankloop.hpp>
#include <crankloop/scenes.hpp>

#include "../engine_file/following_springs.hpp"
#include "../engine_file/gas_order.hpp"
#include "../files/units.hpp"
#include "run_gas.hpp"
#include "run_limits.hpp"
#include "run_quantities.hpp"

namespace crankloop::program {

inline constexpr const char* kFewerTicks = "fewer --cycles or a higher --rpm";

/// Definition and tick are valid and the tables have room, so that a refusal here is a defect of the program.
inline void require_ok(const Status& status) {
  if (!status.ok()) throw std::logic_error(std::string(status.field) + " " + describe(status.reason));
}

[[nodiscard]] inline Phase phase_at(double engine_deg) { return Phase::from_cycles(engine_deg / 720); }

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
  [[nodiscard]] const Engine& engine() const noexcept { return engine_; }

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

template <class Real, class S>
FixedStepLoop<Real, S>::FixedStepLoop(const EngineDefinition& definition, const Operation& operation, double start_deg,
                                      const std::function<void()>& after_tick) {
  require_ok(tables_->build(with_springs_that_follow(definition), {operation.tick_s}, &report_));
  const detail::Drive<Real>& drive = *tables_->tables().drive;
  input_.speed_rad_s = static_cast<Real>(operation.speed_rad_s());
  if constexpr (detail::Needs<S>::gas) {
    tell(input_, operation.gas);
  } else {
    input_.load_ratio = static_cast<Real>(operation.load_ratio);
  }
  require_speed(operation.speed_rpm, static_cast<double>(drive.speed_limit_rad_s), operation.tick_s, definition.crank);
  const int settling_cycles = cycles_to_settle(definition);
  require_ticks(settling_cycles * 720 / (operation.speed_rad_s() * kDegPerRad * operation.tick_s), operation.tick_s,
                kFewerTicks);

  // At constant speed all ticks turn the crank equally far: one tick gives the angle.
  require_ok(engine_.init(tables_->tables()));
  engine_.step(input_);
  const Phase turned = engine_.state().phase;
  deg_per_tick_ = static_cast<double>(turned.units()) * kDegPerUnit;
  settling_ticks_ = static_cast<std::uint64_t>(std::ceil(settling_cycles * ticks_per_cycle() - kHairOfATick));
  const Phase settling{settling_ticks_ * turned.units()};
  require_ok(engine_.init(tables_->tables(), phase_at(start_deg) - settling));
  double before_Pa = 0;  // of the cycle before the last
  for (std::uint64_t i = 0; i < settling_ticks_; ++i) {
    engine_.step(input_);
    if constexpr (detail::Needs<S>::gas) {
      if (static_cast<double>(settling_ticks_ - i) >= ticks_per_cycle()) before_Pa = cycle_mep_Pa();
    }
    if (after_tick) after_tick();
  }
  if constexpr (detail::Needs<S>::gas) unsettled_Pa_ = std::fabs(cycle_mep_Pa() - before_Pa);
}

template <class Real, class S>
double FixedStepLoop<Real, S>::cycle_mep_Pa() const noexcept {
  if constexpr (detail::Needs<S>::gas) {
    return mean_cycle(engine_.output().gas_cycle, engine_.tables()->drive->cylinders).net_mep_Pa;
  } else {
    return 0;
  }
}

template <class Real, class S>
double FixedStepLoop<Real, S>::crank_deg() const noexcept {
  const double deg = static_cast<double>(engine_.state().phase.units()) * kDegPerUnit;
  return deg < 720 ? deg : 0;  // the last 2^10 units round up to 720
}

}  // namespace crankloop::program

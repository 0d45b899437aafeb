// Evaluates the tick at one angle, as the fixed-step loop would, without running a loop.
#pragma once

#include <memory>

#include <crankloop/crankloop.hpp>
#include <crankloop/scenes.hpp>

#include "../files/error.hpp"
#include "../files/units.hpp"
#include "run_limits.hpp"

namespace crankloop::program {

/// Tables and engine of scenes::Whole. The engine is started one tick before the angle and stepped onto it.
template <class Real>
class TickProbe {
 public:
  explicit TickProbe(const EngineDefinition& definition)
      : tables_{std::make_unique<TableStorage<Real, scenes::Whole>>()}, crank_{definition.crank} {
    EngineDefinition without_valves = definition;  // their motion depends on time, not only on the angle
    without_valves.train_count = 0;
    without_valves.trigger_count = 0;  // a wheel may turn with a valve train's cam
    const Status status = tables_->build(without_valves, {kTick_s});
    if (!status.ok()) throw InputError(std::string(status.field) + " " + describe(status.reason));
  }

  /// Output at an engine angle of 0 to 720 deg.
  const typename Engine<Real, scenes::Whole>::Output& at(double engine_deg, double speed_rad_s, double load_ratio = 1) {
    const Real speed = static_cast<Real>(speed_rad_s);
    const Phase step = Phase::from_cycles(speed * tables_->tables().drive->cycles_per_tick_per_rad_s);
    const Phase here = Phase::from_cycles(engine_deg < 720 ? engine_deg / 720 : engine_deg / 720 - 1);
    const Status status = engine_.init(tables_->tables(), here - step);
    if (!status.ok()) throw InputError(std::string(status.field) + " " + describe(status.reason));
    typename Engine<Real, scenes::Whole>::Input input;
    input.speed_rad_s = speed;
    input.load_ratio = static_cast<Real>(load_ratio);
    const auto& output = engine_.step(input);
    if (output.faults != 0) refuse_speed(speed_rad_s);
    return output;
  }

 private:
  static constexpr double kTick_s = 10e-6;

  /// The other inputs are in range, so the speed is not: beyond max_rpm, or one revolution in a tick.
  [[noreturn]] void refuse_speed(double speed_rad_s) const {
    require_speed(speed_rad_s / kRad_sPerRpm, static_cast<double>(tables_->tables().drive->speed_limit_rad_s), kTick_s,
                  crank_);
    throw UsageError("the speed is beyond the engine's max_rpm, or one revolution in 10 us");
  }

  std::unique_ptr<TableStorage<Real, scenes::Whole>> tables_;
  Crank crank_;
  Engine<Real, scenes::Whole> engine_;
};

/// The angles 0, step, 2 step ... and `last` itself.
template <class Visit>
void for_each_angle(double step_deg, double last_deg, const Visit& visit) {
  const double hair = step_deg * 1e-9;
  for (long i = 0; static_cast<double>(i) * step_deg < last_deg - hair; ++i) visit(static_cast<double>(i) * step_deg);
  visit(last_deg);
}

}  // namespace crankloop::program

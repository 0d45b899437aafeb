// Whole engines under the benchmark: the library's in any scene, and the plain one, at constant speed and given
// pressures.
//
// What belongs here: construction, steps, errors of their outputs. What does not: the comparison (tick.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <crankloop/tabulate/mechanism.hpp>

#include "baseline.hpp"
#include "motion_methods.hpp"
#include "scenes.hpp"
#include "true_lift.hpp"
#include "valve_methods.hpp"

namespace crankloop::program::bench {

/// How an engine is run.
struct Operation {
  double engine_rpm;
  double tick_s = 20e-6;
  ValveStepping stepping{};

  [[nodiscard]] int ticks_per_cycle() const noexcept { return static_cast<int>(120 / engine_rpm / tick_s + 0.5); }
};

/// Different for each cylinder, so that no two torques cancel.
[[nodiscard]] inline double pressure_Pa(int cylinder) noexcept { return 1.5e5 + 1e5 * cylinder; }

/// Outputs of an engine of either kind.
class OutputCheck {
 public:
  OutputCheck(const EngineDefinition& definition, double engine_rpm);

  /// Records the errors of a tick's outputs.
  void torque(std::uint64_t phase, double torque_Nm) noexcept;
  void lift(std::uint64_t phase, int cylinder, int train, double lift_m) noexcept;

  [[nodiscard]] double largest_lift_error_um() const noexcept { return lift_error_m_ * 1e6; }
  /// Relative to the largest torque of one cylinder, because torques of several may cancel.
  [[nodiscard]] double largest_torque_error() const noexcept { return torque_error_Nm_ / largest_torque_Nm_; }

 private:
  const EngineDefinition& definition_;
  double speed_rad_s_;
  const TrueLift& truth_;  ///< of all trains: they differ in phase only
  double lift_error_m_ = 0;
  double torque_error_Nm_ = 0;
  double largest_torque_Nm_ = 0;  ///< of a cylinder
};

/// The library in a scene.
template <class Real, class S>
class LibraryEngine {
 public:
  LibraryEngine(const EngineDefinition& definition, const Operation& operation)
      : tables_{std::make_unique<TableStorage<Real, S>>()} {
    if (!tables_->build(definition, {operation.tick_s, operation.stepping}).ok() ||
        !engine_.init(tables_->tables()).ok()) {
      throw std::logic_error("the benchmark's engine was refused");
    }
    input_.speed_rad_s = static_cast<Real>(rad_s_of(operation.engine_rpm));
    for (int k = 0; k < definition.layout.cylinders; ++k) input_.pressure_Pa[k] = static_cast<Real>(pressure_Pa(k));
  }
  void tick() noexcept { engine_.step(input_); }

  void check(const EngineDefinition& definition, OutputCheck& check) const noexcept {
    const auto& out = engine_.output();
    const std::uint64_t phase = engine_.state().phase.units();
    check.torque(phase, static_cast<double>(out.torque_Nm));
    if constexpr (S::valves != ValveModel::none) {
      for (int k = 0; k < definition.layout.cylinders; ++k) {
        for (int t = 0; t < definition.train_count; ++t)
          check.lift(phase, k, t, static_cast<double>(out.valve[t][k].lift_m));
      }
    }
  }

 private:
  std::unique_ptr<TableStorage<Real, S>> tables_;
  Engine<Real, S> engine_;
  typename Engine<Real, S>::Input input_;
};

[[nodiscard]] PlainEngineData plain_data(const EngineDefinition& definition, const Operation& operation);

/// The plain engine with the same interface.
template <class Real>
class PlainEngineRun {
 public:
  PlainEngineRun(std::unique_ptr<PlainEngine<Real>> engine, int cylinders) : engine_{std::move(engine)} {
    for (int k = 0; k < cylinders; ++k) pressure_Pa_[static_cast<std::size_t>(k)] = static_cast<Real>(pressure_Pa(k));
  }
  void tick() noexcept { engine_->step(pressure_Pa_.data()); }

  void check(const EngineDefinition& definition, OutputCheck& check) const noexcept {
    check.torque(engine_->phase, static_cast<double>(engine_->torque_Nm));
    for (int k = 0; k < definition.layout.cylinders; ++k) {
      for (int t = 0; t < definition.train_count; ++t) {
        check.lift(
            engine_->phase, k, t,
            static_cast<double>(engine_->valves[static_cast<std::size_t>(k * definition.train_count + t)].lift_m));
      }
    }
  }

 private:
  std::unique_ptr<PlainEngine<Real>> engine_;
  std::array<Real, kMaxCylinders> pressure_Pa_{};
};

}  // namespace crankloop::program::bench

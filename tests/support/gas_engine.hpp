// Scenes of the engine that breathes, and a rig that runs them.
#pragma once

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/step.hpp>

#include "support/engines.hpp"
#include "support/running.hpp"
#include "support/status.hpp"
#include "support/units.hpp"

namespace crankloop::support {

struct BreathingFour : Scene {
  static constexpr Count cylinders = exactly<4>;
  static constexpr Count trains = exactly<2>;
  static constexpr PressureGiven pressure = PressureGiven::by_gas;
  static constexpr Manifold manifold = Manifold::throttle;
  static constexpr Combustion combustion = Combustion::by_input;
  static constexpr ValveModel valves = ValveModel::following;
  static constexpr bool gas_results = true;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
};
struct ElasticBreathingFour : BreathingFour {
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_gas = true;
};
/// A cylinder between two manifolds that are given.
struct GivenCylinder : Scene {
  static constexpr Count cylinders = exactly<1>;
  static constexpr Count trains = exactly<2>;
  static constexpr PressureGiven pressure = PressureGiven::by_gas;
  static constexpr Combustion combustion = Combustion::by_table;
  static constexpr ValveModel valves = ValveModel::following;
  static constexpr bool gas_results = true;
};
/// A cylinder whose crank and manifolds a test holds in its hands.
struct MeasuredCylinder : Scene {
  static constexpr Count cylinders = exactly<1>;
  static constexpr Count trains = exactly<2>;
  static constexpr CrankGiven crank = CrankGiven::phase;
  static constexpr PressureGiven pressure = PressureGiven::by_gas;
  static constexpr Combustion combustion = Combustion::by_input;
  static constexpr bool cylinder_cut = true;
  static constexpr ValveModel valves = ValveModel::following;
  static constexpr bool gas_results = true;
};

[[nodiscard]] inline double rad_s(double rpm) { return rpm * kPi / 30; }

/// One cylinder of the four.
[[nodiscard]] inline EngineDefinition one_of_four_2000() {
  EngineDefinition engine = four_2000();
  engine.layout = {};
  engine.layout.cylinders = 1;
  return engine;
}
/// Valves that let nothing through, walls that take nothing: a spring.
[[nodiscard]] inline EngineDefinition sealed(EngineDefinition engine) {
  engine.gas.wall_heat_ratio = 0;
  for (PortOfTrain& port : engine.gas.ports) {
    for (double& flow : port.flow_ratio) flow = 0;
  }
  return engine;
}

/// An engine with its tables.
template <class Real, class S>
struct Breathing {
  TableStorage<Real, S> storage;
  Engine<Real, S> engine;
  Input<Real, S> in;

  explicit Breathing(const EngineDefinition& definition, double tick_s, Phase start = {}) {
    EXPECT_TRUE(accepted(storage.build(definition, {tick_s, {}})));
    EXPECT_TRUE(accepted(engine.init(storage.tables(), start)));
    if constexpr (detail::Needs<S>::burn_input) {
      for (Real& fuel : in.fuel_kg) fuel = static_cast<Real>(definition.gas.fuel_kg);
    }
  }
  const Output<Real, S>& step() { return engine.step(in); }
};

/// MeasuredCylinder, tick by tick from angle to angle: 0 = firing, on and on beyond 720.
template <class Real>
struct MeasuredRun : Breathing<Real, MeasuredCylinder> {
  static constexpr double kTick_s = 100e-6;
  double deg;  ///< where it stands

  /// Filled from the intake manifold where the crank stands; `prepare(in)` before that.
  template <class Prepare>
  MeasuredRun(const EngineDefinition& definition, double start_deg, const Prepare& prepare, double tick_s = kTick_s)
      : Breathing<Real, MeasuredCylinder>(definition, tick_s), deg{start_deg} {
    prepare(this->in);
    (void)to(start_deg);
  }
  MeasuredRun(const EngineDefinition& definition, double start_deg)
      : MeasuredRun(definition, start_deg, [](auto&) {}) {}

  /// In one tick.
  const Output<Real, MeasuredCylinder>& to(double to_deg) {
    deg = to_deg;
    this->in.crank = tick_test::phase_at_deg(static_cast<long double>(to_deg));
    return this->step();
  }
  /// In equal ticks of about `per_tick_deg`, each shown to `see`; no fault in any.
  template <class See>
  void turn(double to_deg, double per_tick_deg, const See& see) {
    const double from_deg = deg;
    const long ticks = std::lround(std::fabs(to_deg - from_deg) / per_tick_deg);
    for (long i = 1; i <= ticks; ++i) {
      const auto& out = to(from_deg + (to_deg - from_deg) * static_cast<double>(i) / static_cast<double>(ticks));
      ASSERT_EQ(out.faults, 0u) << deg;
      see(out);
    }
  }
  void turn(double to_deg, double per_tick_deg = 1) {
    turn(to_deg, per_tick_deg, [](const auto&) {});
  }
  [[nodiscard]] double mass_kg() const { return static_cast<double>(this->engine.output().cylinder_gas[0].mass_kg); }
};

}  // namespace crankloop::support

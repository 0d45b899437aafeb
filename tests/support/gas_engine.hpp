// Scenes of the engine that breathes, and a rig that runs them.
#pragma once

#include <memory>

#include <gtest/gtest.h>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/step.hpp>

#include "support/four_2000.hpp"
#include "support/status.hpp"

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
  static constexpr bool valve_gas = true;
};

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

}  // namespace crankloop::support

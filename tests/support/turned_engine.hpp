// An engine whose crank is turned by forces, with tables of its own: what the tests of crank dynamics run.
#pragma once

#include <cstdint>
#include <memory>

#include <gtest/gtest.h>

#include <crankloop/tabulate/tabulate.hpp>

#include "support/running.hpp"
#include "support/scenes.hpp"
#include "support/status.hpp"

namespace crankloop::tick_test {

/// Fails the test when tables or engine are refused.
template <class Real, class S>
class Turned {
 public:
  using Input = typename Engine<Real, S>::Input;

  explicit Turned(const EngineDefinition& definition, double tick_s = 100e-6, double speed_rad_s = 0,
                  Phase start = Phase{}) {
    EXPECT_TRUE(accepted(storage_->build(definition, {tick_s})));
    EXPECT_TRUE(accepted(engine.init(storage_->tables(), start)));
    if (speed_rad_s != 0) {
      EXPECT_TRUE(accepted(engine.restore(turning_at<Real, S>(engine.state(), static_cast<Real>(speed_rad_s)))));
    }
  }

  /// Steps, and counts the angle turned.
  const typename Engine<Real, S>::Output& step(const Input& in) {
    const Phase before = engine.state().phase;
    const auto& out = engine.step(in);
    angle_rad += turned_rad(before, engine.state().phase);
    return out;
  }

  Engine<Real, S> engine;
  long double angle_rad = 0;

 private:
  std::unique_ptr<TableStorage<Real, S>> storage_ = std::make_unique<TableStorage<Real, S>>();
};

}  // namespace crankloop::tick_test

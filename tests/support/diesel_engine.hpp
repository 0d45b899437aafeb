// The 495's tables, scenes to run on them, and how its engine is driven: what the engine's tests share.
#pragma once

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "support/both_reals.hpp"
#include "support/running.hpp"
#include "support/status.hpp"
#include "support/test_engines.hpp"

namespace crankloop::tick_test {

constexpr double kTick_s = 100e-6;
constexpr PressureGiven kByTable = PressureGiven::by_table;
constexpr PressureGiven kByInput = PressureGiven::by_input;

using Everything = Asking<kAllGroups, kByTable, true>;
using EverythingByInput = Asking<kAllGroups, kByInput>;
using EverythingByPhase = Asking<kAllGroups, kByTable, true, CrankGiven::phase>;
using EverythingOfFour = Asking<kAllGroups, kByTable, true, CrankGiven::speed, 4>;
using TorqueOfFour = Asking<kTorque | kMeanTorque, kByTable, false, CrankGiven::speed, 4>;

template <class Real>
class DieselEngine : public ::testing::Test {
 protected:
  /// The 495's tables, built once for all tests of a scalar.
  static const FullTables<Real>& diesel() {
    static const std::unique_ptr<FullTables<Real>> tables = [] {
      auto built = std::make_unique<FullTables<Real>>();
      EXPECT_TRUE(accepted(built->build(diesel_495(), kTick_s)));
      return built;
    }();
    return *tables;
  }
};

/// Speed, load and pressures that vary slowly.
template <class Real, class S>
typename Engine<Real, S>::Input drive_of(int tick) {
  typename Engine<Real, S>::Input in;
  in.speed_rad_s = static_cast<Real>(180 + 30 * std::sin(0.01 * tick));
  if constexpr (detail::Needs<S>::load) in.load_ratio = static_cast<Real>(0.5 + 0.4 * std::sin(0.003 * tick));
  if constexpr (detail::Needs<S>::input_pressure) {
    int k = 0;
    for (Real& pressure : in.pressure_Pa) pressure = static_cast<Real>(1e5 + 4e4 * (tick * ++k % 97));
  }
  return in;
}

}  // namespace crankloop::tick_test

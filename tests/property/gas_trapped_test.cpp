// What a cycle of gas says of its charge and its exhaust.
#include <cmath>

#include <gtest/gtest.h>

#include "support/both_reals.hpp"
#include "support/gas_engine.hpp"

namespace crankloop::gas_trapped_test {
namespace {

using support::Breathing;
using support::BreathingFour;
using support::four_2000;
using tick_test::RealName;

const double kSpeed_rad_s = 2000 * std::acos(-1.0) / 30;  // 600 ticks a cycle of 100 us

template <class Real>
class GasCycleSays : public ::testing::Test {};
TYPED_TEST_SUITE(GasCycleSays, tick_test::BothReals, RealName);

/// Cycle by cycle of cylinder 1: calls `each` after each tick, then `done`.
template <class Real, class Run, class Each, class Done>
void watch(Run& run, int cycles, const Each& each, const Done& done) {
  Real before{};
  for (int tick = 0; tick < 600 * cycles; ++tick) {
    const auto& out = run.step();
    each(out.cylinder_gas[0]);
    if (out.gas_cycle[0].net_mep_Pa != before) done(out.gas_cycle[0]), before = out.gas_cycle[0].net_mep_Pa;
  }
}

/// The mean temperature of what flowed out, weighed by its mass, tick by tick; wide open, and behind a closed throttle,
/// where more flows back in than comes from the intake.
TYPED_TEST(GasCycleSays, HowHotItsExhaustIsByWhatFlowsOut) {
  using Real = TypeParam;
  for (const double throttle : {1.0, 0.0}) {
    Breathing<Real, BreathingFour> run(four_2000(), 100e-6);
    run.in.speed_rad_s = static_cast<Real>(kSpeed_rad_s);
    run.in.throttle_ratio = static_cast<Real>(throttle);
    double out_kg = 0, out_kgK = 0, in_kg = 0, before_K = 300;
    int compared = 0;
    watch<Real>(
        run, 12,
        [&](const CylinderGasOutput<Real>& gas) {
          const double kg = -static_cast<double>(gas.flow_kg_s[kExhaust]) * 100e-6,
                       now_K = static_cast<double>(gas.temperature_K);
          if (kg > 0) out_kg += kg, out_kgK += kg * (before_K + now_K) / 2;
          if (kg < 0) in_kg -= kg;
          before_K = now_K;
        },
        [&](const GasCycle<Real>& cycle) {
          if (compared > 0) {
            EXPECT_NEAR(static_cast<double>(cycle.exhaust_K), out_kgK / out_kg, 0.015 * out_kgK / out_kg) << throttle;
          }
          if (compared > 4 && throttle == 0) {
            EXPECT_GT(in_kg, 0.3 * out_kg);
          }
          ++compared, out_kg = out_kgK = in_kg = 0;
        });
    EXPECT_GT(compared, 8);
  }
}

/// An intake that shuts 60 deg before firing dead centre, where fuel burns from 80 deg before it.
TYPED_TEST(GasCycleSays, WhatWasTrappedBeforeItsFuelBurnedOrNothing) {
  using Real = TypeParam;
  for (const double full_lift_deg : {470.0, 532.0}) {
    EngineDefinition definition = four_2000();
    definition.trains[0].cam.full_lift_deg = full_lift_deg;
    Breathing<Real, BreathingFour> run(definition, 100e-6);
    run.in.speed_rad_s = static_cast<Real>(kSpeed_rad_s);
    for (Real& start_deg : run.in.burn_start_deg) start_deg = Real{-80};
    for (int tick = 0; tick < 600 * 4; ++tick) run.step();
    const auto& cycle = run.engine.output().gas_cycle[0];
    EXPECT_EQ(cycle.trapped_kg > 0, full_lift_deg < 500);
    EXPECT_EQ(cycle.trapped_air_kg > 0, full_lift_deg < 500);
    EXPECT_LT(static_cast<double>(cycle.residual_ratio), 0.2);
  }
}

}  // namespace
}  // namespace crankloop::gas_trapped_test

// Valves of a crank that turns already when its engine starts: they move as those of an engine that has been turning.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include <crankloop/scenes.hpp>

#include "support/both_reals.hpp"
#include "support/engines.hpp"
#include "support/running.hpp"
#include "support/test_valves.hpp"

namespace crankloop::valve_start_test {
namespace {

using namespace valve_test;
using tick_test::Turned;

constexpr double kUm = 1e-6;

/// Its crank turned by forces, of which there are none.
struct OneValveOnACoastingCrank : OneValve {
  static constexpr CrankGiven crank = CrankGiven::torque;
};

EngineDefinition coasting_125() {
  EngineDefinition engine = engine_with(ohc_125_train());
  engine.masses.crank_inertia_kg_m2 = 1e5;  // holds its speed to some parts in 1e9
  return engine;
}

template <class Real>
class ValveStart : public testing::Test {};
TYPED_TEST_SUITE(ValveStart, tick_test::BothReals, tick_test::RealName);

/// The largest difference of the lift, from a start at 3000 rpm or so until 40 cam degrees on, from that of the same
/// valve turned at this speed for the three cycles before.
template <class Real>
double apart_after_start_m(double rpm, double start_deg, double tick_s) {
  const double speed = rad_s_of_rpm(rpm);
  const double tick_deg = rpm * 6 * tick_s;
  const int before = static_cast<int>(std::round(3 * 720 / std::fabs(tick_deg)));
  Rig<Real> turning(ohc_125_train(), {tick_s, {}}, start_deg - before * tick_deg);
  for (int i = 0; i < before; ++i) turning.step(speed);
  Turned<Real, OneValveOnACoastingCrank> starting(coasting_125(), tick_s, speed, turning.engine().state().phase);
  double worst_m = 0;
  for (int i = 0; i < static_cast<int>(80 / std::fabs(tick_deg)); ++i) {
    const Real has_been = turning.step(speed).valve[0][0].lift_m;
    const auto& out = starting.step({});
    EXPECT_EQ(out.faults, 0u);
    worst_m = std::max(worst_m, static_cast<double>(std::fabs(out.valve[0][0].lift_m - has_been)));
  }
  return worst_m;
}

TYPED_TEST(ValveStart, CarriesAValveAsIfItsCamHadBeenTurning) {
  // From the opening flank, past full lift, from the closing flank, backwards. What is left is the vibration that the
  // cam's jerk makes in a train that has been turning.
  for (const double start_deg : {380.0, 410.0, 450.0, 490.0}) {
    const double slow_m = apart_after_start_m<TypeParam>(1500, start_deg, 20e-6);
    const double fast_m = apart_after_start_m<TypeParam>(3000, start_deg, 20e-6);
    const double back_m = apart_after_start_m<TypeParam>(-3000, start_deg, 20e-6);
    std::printf("[ figures  ] from %.0f deg: %.2f um at 1500 rpm, %.2f at 3000, %.2f at -3000\n", start_deg,
                slow_m / kUm, fast_m / kUm, back_m / kUm);
    EXPECT_LT(slow_m, 0.1 * kUm);
    EXPECT_LT(fast_m, 0.2 * kUm);
    EXPECT_LT(back_m, 0.2 * kUm);
  }
}

TYPED_TEST(ValveStart, LetsAValveFlyThatNoTrainWouldCarry) {
  // 14 000 rpm at full lift: the train cannot pull the valve back so fast.
  Turned<TypeParam, OneValveOnACoastingCrank> starting(coasting_125(), 20e-6, rad_s_of_rpm(14000), phase_at(450));
  EXPECT_EQ(starting.engine.state().valve_regime[0], 0u);
  EXPECT_NEAR(static_cast<double>(starting.engine.state().valve_lift_m[0]), lift_of(ohc_125_train()).largest_lift_m(),
              10 * kUm);
}

TYPED_TEST(ValveStart, IsThatOfAStandingEngineWhereItsCrankStands) {
  Turned<TypeParam, OneValveOnACoastingCrank> starting(coasting_125(), 20e-6, 0, phase_at(420));
  ASSERT_TRUE(accepted(starting.engine.restore(turning_at(starting.engine.state(), TypeParam{0}))));
  const TypeParam lift_m = starting.engine.state().valve_lift_m[0];
  EXPECT_GT(lift_m, TypeParam(1e-3));
  for (int i = 0; i < 100; ++i)
    EXPECT_NEAR(static_cast<double>(starting.step({}).valve[0][0].lift_m), static_cast<double>(lift_m), 1e-3 * kUm);
}

TYPED_TEST(ValveStart, IsWorkedOutOnceHoweverOftenItsStateIsRestored) {
  Turned<TypeParam, OneValveOnACoastingCrank> starting(coasting_125(), 20e-6, rad_s_of_rpm(3000), phase_at(400));
  const auto first = starting.engine.state();
  ASSERT_TRUE(accepted(starting.engine.restore(first)));
  EXPECT_EQ(starting.engine.state().valve_lift_m[0], first.valve_lift_m[0]);
  EXPECT_EQ(starting.engine.state().valve_velocity_m_s[0], first.valve_velocity_m_s[0]);
}

TYPED_TEST(ValveStart, IsThatOfTheSpeedGivenLast) {
  for (const double rpm : {3000.0, -1500.0, 0.0}) {
    Turned<TypeParam, OneValveOnACoastingCrank> once(coasting_125(), 20e-6, rad_s_of_rpm(rpm), phase_at(400)),
        twice(coasting_125(), 20e-6, rad_s_of_rpm(9000), phase_at(400));
    const auto speed = static_cast<TypeParam>(rad_s_of_rpm(rpm));
    ASSERT_TRUE(accepted(twice.engine.restore(turning_at(twice.engine.state(), speed))));
    EXPECT_EQ(twice.engine.state().valve_velocity_m_s[0], once.engine.state().valve_velocity_m_s[0]) << rpm;
    for (int i = 0; i < 100; ++i) EXPECT_EQ(twice.step({}).valve[0][0].lift_m, once.step({}).valve[0][0].lift_m) << rpm;
  }
}

TEST(ValveStartOfTheFour2000, ExceedsNoEventBudget) {
  const EngineDefinition engine_2000 = support::four_2000();
  for (const double tick_s : {1e-6, 2e-6, 20e-6, 100e-6}) {
    for (const double rpm : {1000.0, 3000.0, 6000.0, -3000.0}) {
      for (int start_deg = 0; start_deg < 720; start_deg += 180) {
        Turned<float, scenes::BreathingFree> engine(engine_2000, tick_s, rad_s_of_rpm(rpm), phase_at(start_deg));
        Turned<float, scenes::BreathingFree>::Input in;
        in.throttle_ratio = 1;
        for (int i = 0; i < 20; ++i)
          EXPECT_EQ(engine.step(in).faults, 0u)
              << rpm << " rpm from " << start_deg << " deg, tick " << i << " of " << tick_s * 1e6 << " us";
      }
    }
  }
}

}  // namespace
}  // namespace crankloop::valve_start_test

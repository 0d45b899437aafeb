// Where a valve is put before its first tick, and after a jump: where the forces balance.
#include <crankloop/tabulate/valve_motion.hpp>

#include <gtest/gtest.h>

#include "support/status.hpp"
#include "support/test_valves.hpp"

namespace crankloop::valve_equilibrium_test {

using namespace detail;
namespace {

using namespace valve_test;
using support::Random;

TEST(ValveEquilibrium, OnASoftSeatUnderALiftedCamIsWhereTheForcesBalance) {
  // A train 3e8 times as stiff as the seat: the seat's share of the lift is below float's rounding of it. Taken for
  // closed, the valve was thrown off at 2350 m/s.
  ValveTrain train = ohc_125_train();
  train.valve.train_N_m = 4.5e10;
  train.valve.seat_N_m = 150;
  train.valve.spring_preload_N = 50;
  ValveMotion<double> motion{};
  ASSERT_TRUE(accepted(motion_of(body_of(train), 20e-6, {}, motion)));
  const ValveMotion<float> in_float = rounded(motion);
  for (const float lift_m : {1e-7F, 1e-4F, 1e-3F, 8e-3F}) {
    const detail::ValveInRegime<float> placed = detail::in_equilibrium(in_float, lift_m, 0.0F);
    EXPECT_NE(placed.regime & kTrainOn, 0u) << lift_m;
    EXPECT_NEAR(placed.state.lift_m, lift_m, 1e-6F * lift_m) << "the train gives way by less than a millionth";
  }
  const detail::ValveInRegime<float> closed = detail::in_equilibrium(in_float, -1e-6F, 0.0F);
  EXPECT_EQ(closed.regime, kSeatOn);
  EXPECT_EQ(closed.state.lift_m, 0);
}

TEST(ValveEquilibrium, HasNoNetForceWhateverPresses) {
  Random random;
  const ValveBody<double> b = body_of(ohc_125_train());
  const ValveMotion<double> motion = motion_for(b, 20e-6);
  int seen[4] = {};
  for (int draw = 0; draw < 2000; ++draw) {
    const double lift_m = random.coin() ? random.between(-50e-6, 50e-6) : random.between(0, 8e-3);
    const double gas_N = random.coin() ? 0 : random.between(-400, 4000);
    const detail::ValveInRegime<double> placed = detail::in_equilibrium(motion, lift_m, gas_N);
    const detail::GasForce<double> gas{gas_N, gas_N};
    ++seen[placed.regime];
    const double compression_m = lift_m - placed.state.lift_m;
    EXPECT_NEAR(detail::acceleration(motion.fine[placed.regime].acceleration, placed.state, compression_m, 0.0, gas), 0,
                1e-4)
        << random.trace(draw);
    EXPECT_EQ(detail::required_contacts(motion, placed.state, Lift<double>{lift_m, 0}, 0.0), placed.regime)
        << random.trace(draw);
  }
  for (const int n : seen) EXPECT_GT(n, 10);
  // Without a spring, sucked open: nothing holds it, so it is put where no valve gets, and not beyond.
  ValveBody<double> springless = b;
  springless.spring_N_m = 0;
  const detail::ValveInRegime<double> open = detail::in_equilibrium(motion_for(springless, 20e-6), -50e-6, -400.0);
  EXPECT_EQ(open.state.lift_m, 1);
  EXPECT_EQ(open.regime, 0u);
}

}  // namespace
}  // namespace crankloop::valve_equilibrium_test

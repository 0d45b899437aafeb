// The static redline against elastic valves whose train hardly bends: they leave it just above, and not below.
#include <crankloop/tabulate/spring_margin.hpp>

#include <gtest/gtest.h>

#include "support/test_valves.hpp"

namespace crankloop::static_redline_test {
namespace {

using support::Random;
using valve_test::body_of;
using valve_test::lift_of;

/// Without lash nothing strikes the valve, and without damping only the spring slows it down: what is left of the
/// elastic train is a few newtons of vibration.
ValveTrain hardly_elastic(ValveTrain train) {
  train.rocker.clearance_m = 0;
  train.valve.train_N_m = 1e9;
  train.valve.train_damping_ratio = 0;
  train.valve.guide_damping_ratio = 0;
  return train;
}

/// Of the second cycle from rest.
std::uint32_t separations_at(const ValveTrain& train, double crank_rad_s) {
  valve_test::Rig<double> rig(train, {5e-6, {}}, train.cam.full_lift_deg + 360);
  const int ticks = 2 * rig.ticks_per_cycle(crank_rad_s);
  for (int i = 0; i < ticks; ++i) rig.step(crank_rad_s);
  return rig.engine().output().valve_cycle[0][0].separations;
}

void expect_separation_from(const ValveTrain& train) {
  const StaticRedline redline = static_redline(lift_of(train), body_of(train));
  ASSERT_GT(redline.crank_rad_s, 0);
  for (const double ratio : {0.6, 0.8, 0.9, 0.95, 0.98})
    EXPECT_EQ(separations_at(train, ratio * redline.crank_rad_s), 0u) << ratio;
  for (const double ratio : {1.02, 1.05}) EXPECT_GT(separations_at(train, ratio * redline.crank_rad_s), 0u) << ratio;
}

TEST(StaticRedline, IsWhereTheStiffTrainOfThe125LetsItsValveGo) {
  expect_separation_from(hardly_elastic(support::ohc_125_train()));
}

TEST(StaticRedline, IsWhereAStiffTrainOfAnyDesignLetsItsValveGo) {
  Random random;
  for (int trains = 0; trains < 6;) {
    ValveTrain train = support::ohc_125_train();
    train.cam = support::random_cam(random);
    train.cam.full_lift_deg = 450;
    train.rocker = support::random_rocker(random);
    ValveLift lift;
    if (!lift.init(train.cam, train.rocker).ok()) continue;
    SCOPED_TRACE(random.trace(trains++));
    expect_separation_from(hardly_elastic(train));
  }
}

}  // namespace
}  // namespace crankloop::static_redline_test

// What a definition amounts to at one speed, where it is at its limits: refused ones, and an engine that takes work.
#include <crankloop/tabulate/summary.hpp>

#include <gtest/gtest.h>

#include "support/status.hpp"
#include "support/test_engines.hpp"
#include "support/units.hpp"

namespace crankloop {
namespace {

using support::refuses;
using tick_test::diesel_495;
using tick_test::single_495;

TEST(ExactEngine, RefusesWhatItsDefinitionAndItsDiagramRefuse) {
  ExactEngine exact;
  EngineDefinition engine = single_495();
  engine.crank.bore_m = 0;
  EXPECT_TRUE(refuses(exact.init(engine), Reason::not_positive, "crank.bore_m"));
  engine = single_495();
  engine.pressure.wiebe.net_mep_Pa = -50e3;  // a motored cylinder loses less
  EXPECT_TRUE(refuses(exact.init(engine), Reason::no_solution, "pressure.wiebe.net_mep_Pa"));
}

TEST(CycleSummary, OfAnEngineThatPumpsHasANegativeMeanAndFluctuatesByIt) {
  EngineDefinition engine = single_495();
  engine.pressure.wiebe.heat_given = true;
  engine.pressure.wiebe.heat_J = 0;
  engine.pressure.wiebe.exhaust_Pa = 300e3;
  ExactEngine exact;
  ASSERT_TRUE(accepted(exact.init(engine)));
  const CycleSummary s = summarise(exact, 200);
  EXPECT_LT(s.mean_torque_Nm, -5);
  EXPECT_DOUBLE_EQ(s.fluctuation_ratio, (s.largest_torque_Nm - s.smallest_torque_Nm) / s.mean_torque_Nm);
}

TEST(BrakeFigures, AreTheIndicatedOnesLessWhatFrictionTakesOverTheCycle) {
  // 100 kPa, 200 Pa s/rad and 1 Pa s^2/rad^2 are 130 kPa at 100 rad/s either way round; over a cycle of 4 pi they take
  // that times the swept volume.
  EngineDefinition engine = diesel_495();
  engine.friction = {100e3, 200, 1};
  const double swept_m3 = 4 * (support::kPi / 4 * 0.095 * 0.095 * 0.115);
  const double friction_Nm = 130e3 * swept_m3 / (4 * support::kPi);
  const BrakeFigures forward = brake_figures(engine, 200, 100);
  EXPECT_NEAR(forward.friction_mep_Pa, 130e3, 1e-9);
  EXPECT_NEAR(forward.torque_Nm, 200 - friction_Nm, 1e-9);
  EXPECT_NEAR(forward.power_W, 100 * (200 - friction_Nm), 1e-7);
  EXPECT_NEAR(forward.efficiency_ratio, 1 - friction_Nm / 200, 1e-12);
  const BrakeFigures backward = brake_figures(engine, -200, -100);
  EXPECT_NEAR(backward.friction_mep_Pa, 130e3, 1e-9);
  EXPECT_NEAR(backward.torque_Nm, -forward.torque_Nm, 1e-9);
  EXPECT_NEAR(backward.power_W, forward.power_W, 1e-7);
  EXPECT_EQ(brake_figures(engine, -50, 100).efficiency_ratio, 0) << "an engine that is turned";
}

}  // namespace
}  // namespace crankloop

// What a definition amounts to at one speed, where it is at its limits: refused ones, and an engine that takes work.
#include <crankloop/tabulate/summary.hpp>

#include <gtest/gtest.h>

#include "support/status.hpp"
#include "support/test_engines.hpp"

namespace crankloop {
namespace {

using support::refuses;
using tick_test::single_495;

TEST(ExactEngine, RefusesWhatItsDefinitionAndItsDiagramRefuse) {
  ExactEngine exact;
  EngineDefinition engine = single_495();
  engine.crank.bore_m = 0;
  EXPECT_TRUE(refuses(exact.init(engine), Reason::not_positive, "crank.bore"));
  engine = single_495();
  engine.pressure.wiebe.net_mep_Pa = -50e3;  // a motored cylinder loses less
  EXPECT_TRUE(refuses(exact.init(engine), Reason::no_solution, "pressure.net_mep"));
}

TEST(CycleSummary, OfAnEngineThatPumpsHasANegativeMeanAndFluctuatesByIt) {
  EngineDefinition engine = single_495();
  engine.pressure.wiebe.heat_given = true;
  engine.pressure.wiebe.heat_J = 0;
  engine.pressure.wiebe.exhaust_Pa = 300e3;
  ExactEngine exact;
  ASSERT_TRUE(exact.init(engine).ok());
  const CycleSummary s = summarise(exact, 200);
  EXPECT_LT(s.mean_torque_Nm, -5);
  EXPECT_DOUBLE_EQ(s.fluctuation_ratio, (s.largest_torque_Nm - s.smallest_torque_Nm) / s.mean_torque_Nm);
}

}  // namespace
}  // namespace crankloop

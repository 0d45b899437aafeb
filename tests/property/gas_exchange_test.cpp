// An engine that exchanges gas, in what the accuracy of docs/model.md does not measure: against its differential
// equations with a part-open throttle, small manifolds and a crank that turns backwards, and long ticks against short.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "support/both_reals.hpp"
#include "support/gas_engine.hpp"
#include "support/gas_reference.hpp"

namespace crankloop::gas_exchange_test {
namespace {

using detail::GasCylinders;
using support::Breathing;
using support::BreathingFour;
using support::ElasticBreathingFour;
using support::four_2000;
using support::GasReference;
using support::rad_s;
using tick_test::RealName;

template <class Real>
class GasExchange : public ::testing::Test {};
TYPED_TEST_SUITE(GasExchange, tick_test::BothReals, RealName);

// ---- against the differential equations -----------------------------------------------------------------------------

struct Motion {
  const char* what;
  double rpm, throttle_ratio, throttle_m2, manifold_m3, fuel_kg;
  double low_Pa, of_peak;  ///< what pressures may be off: below 3 bar and in manifolds, and above
};

template <class Real>
void follow(const Motion& motion) {
  constexpr int kTick_us = 10;
  EngineDefinition definition = four_2000();
  definition.gas.intake_m3 = definition.gas.exhaust_m3 = motion.manifold_m3;
  definition.gas.fuel_kg = motion.fuel_kg;
  const auto run = std::make_unique<Breathing<Real, BreathingFour>>(definition, kTick_us * 1e-6);
  run->in.speed_rad_s = static_cast<Real>(rad_s(motion.rpm));
  run->in.throttle_ratio = static_cast<Real>(motion.throttle_ratio);
  GasReference reference(definition, static_cast<double>(run->in.speed_rad_s), motion.throttle_m2);
  double low_Pa = 0, high = 0;
  for (long tick = std::lround(1.5 * 120e6 / std::fabs(motion.rpm) / kTick_us); tick > 0; --tick) {
    const auto& out = run->step();
    ASSERT_EQ(out.faults, 0u) << motion.what;
    for (int i = 0; i < kTick_us / 5; ++i) reference.step(5e-6);
    for (std::size_t k = 0; k < 4; ++k) {
      const double exact_Pa = reference.pressure(k);
      const double error_Pa = std::fabs(static_cast<double>(out.cylinder_gas[k].pressure_Pa) - exact_Pa);
      if (exact_Pa < 3e5) low_Pa = std::fmax(low_Pa, error_Pa);
      high = std::fmax(high, error_Pa / std::fmax(exact_Pa, 20e5));
    }
    low_Pa = std::fmax(low_Pa, std::fabs(static_cast<double>(out.manifold[0].pressure_Pa) - reference.intake_Pa()));
    low_Pa = std::fmax(low_Pa, std::fabs(static_cast<double>(out.manifold[1].pressure_Pa) - reference.exhaust_gas().p));
  }
  EXPECT_LT(low_Pa, motion.low_Pa) << motion.what;
  EXPECT_LT(high, motion.of_peak) << motion.what;
}

TYPED_TEST(GasExchange, FollowsItsEquationsHoweverItTurns) {
  const double part_m2 = 12e-6 + 0.18 * 1588e-6;  // at 0.35
  const Motion motions[] = {{"part-open throttle", 3000, 0.35, part_m2, 3e-3, 20e-6, 80, 1e-4},
                            {"backwards", -3000, 1, 1600e-6, 3e-3, 0, 80, 1e-4},
                            {"backwards, part-open throttle", -1500, 0.35, part_m2, 2e-3, 0, 80, 1e-4},
                            {"rich, part-open throttle", 3000, 0.35, part_m2, 3e-3, 60e-6, 150, 1e-4},
                            {"small manifolds", 3000, 1, 1600e-6, 0.3e-3, 20e-6, 540, 6e-4}};
  for (const Motion& motion : motions) follow<TypeParam>(motion);
}

/// One long tick, in which pressures could meet: what a cylinder takes of a manifold no larger than itself it must not
/// take as if that stayed as it is.
TYPED_TEST(GasExchange, ReckonsWithWhatItTakesOfASmallManifold) {
  using Real = TypeParam;
  EngineDefinition definition = four_2000();
  definition.gas.intake_m3 = 0.3e-3;
  Breathing<Real, BreathingFour> run(definition, 1e-3, tick_test::phase_at_deg(470));  // one intake is open
  run.in.throttle_ratio = Real{0};
  (void)run.step();
  auto state = run.engine.state();
  for (Real* number :
       {&state.cylinder_gas.mass_kg[0], &state.cylinder_gas.energy_J[0], &state.cylinder_gas.pressure_Pa[0]})
    *number *= Real{0.75};
  ASSERT_TRUE(accepted(run.engine.restore(state)));
  const auto& out = run.step();
  const double cylinder_Pa = static_cast<double>(out.cylinder_gas[0].pressure_Pa),
               manifold_Pa = static_cast<double>(out.manifold[kIntake].pressure_Pa);
  EXPECT_GT(cylinder_Pa, 80e3);
  EXPECT_LT(cylinder_Pa, 95e3);
  EXPECT_LT(std::fabs(manifold_Pa - cylinder_Pa), 10e3);
}

/// Where a leap ends behind an open valve, gas flows through all of that from the first tick on.
TYPED_TEST(GasExchange, FlowsFromTheFirstTickAfterALeap) {
  using Real = TypeParam;
  EngineDefinition definition = support::one_of_four_2000();
  definition.gas.wall_heat_ratio = 0;
  support::MeasuredRun<Real> run(definition, 0, [](auto& in) { in.exhaust_Pa = Real{60e3}; });
  EXPECT_EQ(run.to(300).faults, std::uint32_t{kFaultPhaseJump});  // exhaust open
  const GasReference reference(definition, 0, 1);
  const double area_m2 = reference.area_of(1, 300);
  EXPECT_GT(area_m2, 3e-4);
  const double flow_kg_s = -static_cast<double>(run.to(300).cylinder_gas[0].flow_kg_s[kExhaust]);
  // The pressure falls by a few hundredths in the tick, which flow at the begin does not know.
  const double at_begin_kg_s = area_m2 * support::ellipse(100e3, 60e3, 298.15);
  EXPECT_LT(flow_kg_s, at_begin_kg_s);
  EXPECT_GT(flow_kg_s, 0.9 * at_begin_kg_s);
}

TYPED_TEST(GasExchange, LeavesElasticValvesInPeaceWhereNothingMoves) {  // from the first tick on
  using Real = TypeParam;
  Breathing<Real, ElasticBreathingFour> run(support::sealed(four_2000()), 50e-6, tick_test::phase_at_deg(20));
  for (int tick = 0; tick < 100; ++tick) {
    const auto& out = run.step();
    for (std::size_t t = 0; t < 2; ++t) {
      ASSERT_NEAR(static_cast<double>(out.valve[t][0].lift_m), 0, 1e-9) << tick;
      ASSERT_NEAR(static_cast<double>(out.valve[t][0].velocity_m_s), 0, 1e-6) << tick;
    }
  }
}

// ---- long ticks -----------------------------------------------------------------------------------------------------

/// Largest differences of what two runs show.
struct Apart {
  double pressure_Pa = 0, mass_kg = 0, flow_kg_s = 0, wall_W = 0, outside_kg_s = 0, torque_Nm = 0;

  void see(double& worst, double a, double b) { worst = std::fmax(worst, std::fabs(a - b)); }
};

/// The means over several ticks of what one tick shows as a mean.
struct Means {
  double flow_kg_s[4][kPorts] = {}, wall_W[4] = {}, throttle_kg_s = 0, outlet_kg_s = 0, torque_Nm = 0;

  template <class Out>
  void add(const Out& out, double share) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t port = 0; port < kPorts; ++port)
        flow_kg_s[k][port] += share * static_cast<double>(out.cylinder_gas[k].flow_kg_s[port]);
      wall_W[k] += share * static_cast<double>(out.cylinder_gas[k].wall_heat_W);
    }
    throttle_kg_s += share * static_cast<double>(out.throttle_kg_s);
    outlet_kg_s += share * static_cast<double>(out.outlet_kg_s);
    torque_Nm += share * static_cast<double>(out.mean_torque_Nm);
  }
};

/// Tables of an engine whose ticks have no more steps than that.
template <class Real, class S>
struct LimitedSteps {
  GasCylinders<Real> cylinders;
  Tables<Real, S> tables;

  LimitedSteps(const Tables<Real, S>& from, int max_steps) : cylinders{*from.gas_cylinders}, tables{from} {
    if (max_steps > 0) cylinders.max_steps = static_cast<std::uint32_t>(max_steps);
    tables.gas_cylinders = &cylinders;
  }
};

/// Two cycles in ticks of `deg`, against as many short ticks as each has steps. `limited`: to that number, and the
/// short ones to one.
template <class Real, class S>
[[nodiscard]] Apart whole_and_parts(double rpm, int parts, double deg, bool limited = false) {
  const double tick_s = deg / 6 / std::fabs(rpm);
  const auto make = [rpm](double s) {
    auto run = std::make_unique<Breathing<Real, S>>(four_2000(), s);
    run->in.speed_rad_s = static_cast<Real>(rad_s(rpm)), run->in.throttle_ratio = Real{0.75};
    return run;
  };
  const auto whole = make(tick_s), part = make(tick_s / parts);
  const LimitedSteps<Real, S> whole_tables(whole->storage.tables(), limited ? parts : 0);
  const LimitedSteps<Real, S> part_tables(part->storage.tables(), limited ? 1 : 0);
  EXPECT_TRUE(accepted(whole->engine.init(whole_tables.tables)));
  EXPECT_TRUE(accepted(part->engine.init(part_tables.tables)));
  for (int tick = 0; tick < 800; ++tick) (void)part->step();
  auto state = part->engine.state();  // both go on from there, however valves stood at first
  state.fingerprint = whole->engine.state().fingerprint;
  EXPECT_TRUE(accepted(whole->engine.restore(state)));
  Apart apart;
  for (double turned_deg = 0; turned_deg < 1440; turned_deg += deg) {
    Means means;
    for (int i = 0; i < parts; ++i) {
      const auto& one = part->step();
      EXPECT_EQ(one.faults, 0u);
      means.add(one, 1.0 / parts);
    }
    const auto& out = whole->step();
    EXPECT_EQ(out.faults, 0u);
    Means long_tick;
    long_tick.add(out, 1);
    const auto& end = part->engine.output();
    for (std::size_t k = 0; k < 4; ++k) {
      const auto &a = out.cylinder_gas[k], &b = end.cylinder_gas[k];
      apart.see(apart.pressure_Pa, static_cast<double>(a.pressure_Pa), static_cast<double>(b.pressure_Pa));
      apart.see(apart.mass_kg, static_cast<double>(a.mass_kg), static_cast<double>(b.mass_kg));
      for (std::size_t port = 0; port < kPorts; ++port)
        apart.see(apart.flow_kg_s, long_tick.flow_kg_s[k][port], means.flow_kg_s[k][port]);
      apart.see(apart.wall_W, long_tick.wall_W[k], means.wall_W[k]);
    }
    for (int port = 0; port < kPorts; ++port)
      apart.see(apart.pressure_Pa, static_cast<double>(out.manifold[port].pressure_Pa),
                static_cast<double>(end.manifold[port].pressure_Pa));
    apart.see(apart.outside_kg_s, long_tick.throttle_kg_s, means.throttle_kg_s);
    apart.see(apart.outside_kg_s, long_tick.outlet_kg_s, means.outlet_kg_s);
    apart.see(apart.torque_Nm, long_tick.torque_Nm, means.torque_Nm);
  }
  return apart;
}

TYPED_TEST(GasExchange, CutsLongTicksIntoStepsOfShortOnes) {  // steps of at most 5 deg: then both do the very same
  using Real = TypeParam;
  const double rounding = sizeof(Real) == 4 ? 1e-5 : 1e-9;
  const auto expect_same = [rounding](double rpm, int parts, double deg) {
    const Apart apart = whole_and_parts<Real, BreathingFour>(rpm, parts, deg);
    EXPECT_LT(apart.pressure_Pa, 50e5 * rounding) << deg;
    EXPECT_LT(apart.mass_kg, 5e-4 * rounding) << deg;
    EXPECT_LT(apart.flow_kg_s, 0.5 * rounding) << deg;
    EXPECT_LT(apart.wall_W, 1e5 * rounding) << deg;
    EXPECT_LT(apart.outside_kg_s, 0.1 * rounding) << deg;
    EXPECT_LT(apart.torque_Nm, 500 * rounding) << deg;
  };
  for (int parts = 2; parts <= 8; ++parts)
    expect_same(6000, parts, 5 * parts - 0.6), expect_same(6000, parts, 5 * parts - 4.4);
  expect_same(-6000, 6, 29);
}

TYPED_TEST(GasExchange, CutsTicksIntoNoMoreStepsThanTheirTablesSay) {  // whatever turned them further than they know
  const double rounding = sizeof(TypeParam) == 4 ? 1e-5 : 1e-9;
  for (const int parts : {1, 2, 3, 7}) {
    const Apart apart = whole_and_parts<TypeParam, BreathingFour>(6000, parts, 5 * parts + 2, true);
    EXPECT_LT(apart.pressure_Pa, 50e5 * rounding) << parts;
    EXPECT_LT(apart.mass_kg, 5e-4 * rounding) << parts;
    EXPECT_LT(apart.flow_kg_s, 0.5 * rounding) << parts;
  }
}

TYPED_TEST(GasExchange, CutsLongTicksOfElasticValves) {  // what valves are off their cams goes in a straight line
  const Apart apart = whole_and_parts<TypeParam, ElasticBreathingFour>(5000, 4, 19);
  EXPECT_LT(apart.pressure_Pa, 3500);  // of 50 bar; 1740
  EXPECT_LT(apart.mass_kg, 3e-6);
}

}  // namespace
}  // namespace crankloop::gas_exchange_test

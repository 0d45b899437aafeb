// docs/contract.md "Inputs of a step", of an engine that breathes: ranges of throttle and manifolds, what holds until
// an input is good, and what a throttle lets through. Fuel and burn: gas_burn_test.cpp.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/both_reals.hpp"
#include "support/gas_engine.hpp"
#include "support/gas_equations.hpp"

namespace crankloop::gas_inputs_test {
namespace {

using support::Breathing;
using support::BreathingFour;
using support::four_2000;
using support::MeasuredRun;
using tick_test::RealName;

template <class Real>
class GasInputs : public ::testing::Test {};
TYPED_TEST_SUITE(GasInputs, tick_test::BothReals, RealName);

template <class Real>
[[nodiscard]] Real next_to(Real x, double towards) {
  return std::nextafter(x, static_cast<Real>(towards));
}

// ---- ranges ---------------------------------------------------------------------------------------------------------

TYPED_TEST(GasInputs, TakesAThrottleFromClosedToWideOpen) {
  using Real = TypeParam;
  const Breathing<Real, BreathingFour> start(four_2000(), 50e-6);
  EXPECT_EQ(start.engine.state().throttle_ratio, Real{1}) << "until an input says otherwise";
  Breathing<Real, BreathingFour> run(four_2000(), 50e-6);
  Real last = 1;
  for (const Real x : {Real{0}, Real{1.5}, Real{0.25}, next_to(Real{0}, -1), Real{1}, next_to(Real{1}, 2),
                       std::numeric_limits<Real>::quiet_NaN(), Real{0.5}, Real{-1}}) {
    run.in.throttle_ratio = x;
    const bool good = x >= 0 && x <= 1;
    if (good) last = x;
    EXPECT_EQ(run.step().faults, good ? 0u : std::uint32_t{kFaultManifold}) << x;
    EXPECT_EQ(run.engine.state().throttle_ratio, last) << x;
  }
}

/// One of the four inputs that say what is in the manifolds.
template <class Real>
struct OfManifold {
  Real group::GivenManifoldInput<Real>::*input;
  int port;
  bool temperature;
  double least, most, at_start;
};

TYPED_TEST(GasInputs, TakesManifoldsWithinTheirRanges) {
  using Real = TypeParam;
  using In = group::GivenManifoldInput<Real>;
  EngineDefinition definition = support::one_of_four_2000();
  definition.gas.ambient_Pa = 95e3, definition.gas.ambient_K = 280, definition.gas.exhaust_K = 700;
  const OfManifold<Real> all[] = {{&In::intake_Pa, kIntake, false, 1e3, 1e7, 95e3},
                                  {&In::intake_K, kIntake, true, 150, 3000, 280},
                                  {&In::exhaust_Pa, kExhaust, false, 1e3, 1e7, 95e3},
                                  {&In::exhaust_K, kExhaust, true, 150, 3000, 700}};
  for (const OfManifold<Real>& one : all) {
    const Real least = static_cast<Real>(one.least), most = static_cast<Real>(one.most);
    for (const Real x : {least, most, next_to(least, 0), next_to(most, 1e9), Real{-1}, Real{0},
                         std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity()}) {
      const bool good = x >= least && x <= most;
      MeasuredRun<Real> run(definition, 0, [&](auto& in) { in.*one.input = x; });
      EXPECT_EQ(run.engine.output().faults, good ? 0u : std::uint32_t{kFaultManifold}) << x;
      const auto& given = run.engine.state().given_gas[one.port];
      EXPECT_EQ(one.temperature ? given.temperature_K : given.pressure_Pa, good ? x : static_cast<Real>(one.at_start));
      run.in.*one.input = static_cast<Real>(one.most / 2);
      EXPECT_EQ(run.to(0).faults, 0u);
      run.in.*one.input = x;
      EXPECT_EQ(run.to(0).faults, good ? 0u : std::uint32_t{kFaultManifold}) << x;
      EXPECT_EQ(one.temperature ? given.temperature_K : given.pressure_Pa, good ? x : static_cast<Real>(one.most / 2));
    }
  }
}

TYPED_TEST(GasInputs, FillsCylindersFromTheIntakeThatIsGiven) {
  using Real = TypeParam;
  for (const double deg : {0.0, 180.0}) {
    MeasuredRun<Real> run(support::one_of_four_2000(), deg, [](auto& in) {
      in.intake_Pa = Real{61e3}, in.intake_K = Real{333};
      in.exhaust_Pa = Real{123e3}, in.exhaust_K = Real{888};
    });
    const auto& gas = run.engine.output().cylinder_gas[0];
    EXPECT_NEAR(static_cast<double>(gas.pressure_Pa), 61e3, 0.05);
    EXPECT_NEAR(static_cast<double>(gas.temperature_K), 333, 3e-4);
    EXPECT_EQ(gas.burned_ratio, Real{0});
    const double swept_m3 = support::kPi / 4 * 0.086 * 0.086 * 0.086, clearance_m3 = swept_m3 / 9.5;
    const double volume_m3 = clearance_m3 + (deg > 0 ? swept_m3 : 0);
    EXPECT_NEAR(run.mass_kg() / (61e3 * volume_m3 / (support::kGasR * 333)), 1, 1e-6);
  }
}

// ---- what is outside the manifolds ----------------------------------------------------------------------------------

struct WithBoundaries : BreathingFour {
  static constexpr bool boundaries = true;
};

/// One of the inputs that say what is outside.
template <class Real>
struct OfBoundary {
  Real group::BoundaryInput<Real>::*input;
  int port;
  bool temperature;
  double least, most, as_defined;
};

TYPED_TEST(GasInputs, TakesBoundariesWithinTheirRangesAndThoseOfTheDefinitionForZero) {
  using Real = TypeParam;
  using In = group::BoundaryInput<Real>;
  EngineDefinition definition = four_2000();
  definition.gas.ambient_Pa = 95e3, definition.gas.ambient_K = 280, definition.gas.back_Pa = 104e3;
  const OfBoundary<Real> all[] = {{&In::ambient_Pa, kIntake, false, 1e3, 1e7, 95e3},
                                  {&In::ambient_K, kIntake, true, 150, 3000, 280},
                                  {&In::back_Pa, kExhaust, false, 1e3, 1e7, 104e3}};
  for (const OfBoundary<Real>& one : all) {
    Breathing<Real, WithBoundaries> run(definition, 50e-6);
    const auto& given = run.engine.state().given_gas[one.port];
    const auto taken = [&] { return one.temperature ? given.temperature_K : given.pressure_Pa; };
    const Real least = static_cast<Real>(one.least), most = static_cast<Real>(one.most);
    Real last = static_cast<Real>(one.as_defined);
    EXPECT_EQ(taken(), last);
    for (const Real x : {Real{0}, least, next_to(least, 0), most, next_to(most, 1e9), Real{-1}, Real{0}, Real{2000},
                         std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity()}) {
      run.in.*one.input = x;
      const bool good = x == 0 || (x >= least && x <= most);
      if (good) last = x == 0 ? static_cast<Real>(one.as_defined) : x;
      EXPECT_EQ(run.step().faults, good ? 0u : std::uint32_t{kFaultManifold}) << x;
      EXPECT_EQ(taken(), last) << x;
    }
  }
}

/// The same engine, defined at the boundaries that the other is given.
TYPED_TEST(GasInputs, BreathesFromItsBoundariesAsAnEngineThatIsDefinedThere) {
  using Real = TypeParam;
  EngineDefinition there = four_2000();
  there.gas.ambient_Pa = 160e3, there.gas.ambient_K = 330, there.gas.back_Pa = 120e3;
  Breathing<Real, BreathingFour> defined(there, 100e-6);
  Breathing<Real, WithBoundaries> given(four_2000(), 100e-6);
  given.in.ambient_Pa = Real{160e3}, given.in.ambient_K = Real{330}, given.in.back_Pa = Real{120e3};
  defined.in.speed_rad_s = given.in.speed_rad_s = Real{300};
  for (int tick = 0; tick < 6000; ++tick) (void)defined.step(), (void)given.step();  // 14 cycles
  const auto& wanted = defined.engine.output();
  const auto& out = given.engine.output();
  EXPECT_EQ(out.faults, 0u);
  for (int port = 0; port < kPorts; ++port) {
    const double wanted_Pa = static_cast<double>(wanted.manifold[port].pressure_Pa);
    EXPECT_NEAR(static_cast<double>(out.manifold[port].pressure_Pa), wanted_Pa, 1e-4 * wanted_Pa) << port;
    EXPECT_GT(wanted_Pa, port == kIntake ? 140e3 : 120e3) << port;
  }
  const auto charge_kg = [](const auto& of) { return static_cast<double>(of.gas_cycle[2].trapped_air_kg); };
  EXPECT_NEAR(charge_kg(out) / charge_kg(wanted), 1, 1e-4);
  Breathing<Real, BreathingFour> sea_level(four_2000(), 100e-6);
  sea_level.in.speed_rad_s = Real{300};
  for (int tick = 0; tick < 6000; ++tick) (void)sea_level.step();
  EXPECT_GT(charge_kg(out) / charge_kg(sea_level.engine.output()), 1.35);
}

// ---- the throttle ---------------------------------------------------------------------------------------------------

/// A manifold filled anew.
template <class Real>
void fill_manifold(Breathing<Real, BreathingFour>& run, int port, double pressure_Pa, double temperature_K,
                   double burned_ratio) {
  const auto& gas = four_2000().gas;
  const double volume_m3 = port == kIntake ? gas.intake_m3 : gas.exhaust_m3;
  const support::GasVolume filled = support::gas_filled(pressure_Pa, temperature_K, burned_ratio, volume_m3);
  const auto real = [](double x) { return static_cast<Real>(x); };
  auto state = run.engine.state();
  state.manifold[port].contents = {real(filled.m), 0, real(filled.u), 0, real(filled.b), 0};
  state.manifold[port].point = {real(pressure_Pa), real(temperature_K), real(burned_ratio),
                                real(support::kGasR / (support::gas_a(burned_ratio) + support::kGasB * temperature_K))};
  ASSERT_TRUE(accepted(run.engine.restore(state)));
}

/// Area of the sample's throttle: straight lines through 0:0, 0.2:0.06, 0.5:0.3, 1:1 between closed and open.
[[nodiscard]] double throttle_m2(double ratio) {
  const double share = ratio < 0.2   ? ratio / 0.2 * 0.06
                       : ratio < 0.5 ? 0.06 + (ratio - 0.2) / 0.3 * 0.24
                                     : 0.3 + (ratio - 0.5) / 0.5 * 0.7;
  return 12e-6 + share * (1600e-6 - 12e-6);
}

TYPED_TEST(GasInputs, ChokesItsThrottleAtAnyOpening) {  // then flow is area, pressure and temperature before it alone
  using Real = TypeParam;
  EngineDefinition definition = four_2000();
  definition.gas.ambient_Pa = 96e3, definition.gas.ambient_K = 310;
  for (const double ratio : {0.0, 0.004, 0.1, 0.2, 0.35, 0.355, 0.5, 0.75, 0.996, 1.0}) {
    Breathing<Real, BreathingFour> run(definition, 50e-6);
    run.in.throttle_ratio = static_cast<Real>(ratio);
    fill_manifold(run, kIntake, 20e3, 300, 0);
    const double wanted_kg_s = throttle_m2(ratio) * support::saint_venant(96e3, 20e3, 310);
    EXPECT_NEAR(static_cast<double>(run.step().throttle_kg_s) / wanted_kg_s, 1, 2e-6) << ratio;
    // Over a tick of eight steps it is the mean over all.
    run.in.speed_rad_s = static_cast<Real>(36 * support::kRadPerDeg / 50e-6);
    fill_manifold(run, kIntake, 10e3, 300, 0);
    EXPECT_NEAR(static_cast<double>(run.step().throttle_kg_s) / wanted_kg_s, 1, 2e-6) << ratio << ", in eight steps";
  }
}

/// What an orifice makes of a volume in a time, by Euler's method in 20 000 steps.
[[nodiscard]] support::GasVolume after(support::GasVolume gas, double volume_m3, double area_m2,
                                       const support::GasSeen& outside, double time_s) {
  constexpr int kSteps = 20'000;
  for (int i = 0; i < kSteps; ++i) {
    support::GasVolume change{0, 0, 0}, lost{0, 0, 0};
    (void)support::gas_flow(support::OrificeLaw::ellipse, area_m2, outside, support::gas_seen(gas, volume_m3), lost,
                            change);
    const double h = time_s / kSteps;
    gas.m += h * change.m, gas.u += h * change.u, gas.b += h * change.b;
  }
  return gas;
}

TYPED_TEST(GasInputs, FillsAndEmptiesItsManifoldsFromOutside) {  // a crank that stands, valves shut
  using Real = TypeParam;
  const auto& gas = four_2000().gas;
  struct Case {
    int port;
    support::GasSeen gas;
  };
  const Case cases[] = {{kIntake, {30e3, 350, 0.25}},    {kIntake, {80e3, 290, 0}},     {kIntake, {180e3, 400, 0.5}},
                        {kExhaust, {500e3, 1200, 0.75}}, {kExhaust, {130e3, 600, 0.5}}, {kExhaust, {60e3, 900, 0.5}}};
  EngineDefinition definition = support::sealed(four_2000());
  const support::GasSeen outside{gas.ambient_Pa, gas.ambient_K, 0};  // behind the outlet too: nothing flowed out
  for (const Case& one : cases) {
    const bool intake = one.port == kIntake;
    const double volume_m3 = intake ? gas.intake_m3 : gas.exhaust_m3;
    for (const double time_s : {0.4e-3, 2e-3}) {
      const support::GasVolume exact = after(support::gas_filled(one.gas.p, one.gas.t, one.gas.x, volume_m3), volume_m3,
                                             intake ? throttle_m2(0.6) : gas.outlet_m2, outside, time_s);
      const support::GasSeen wanted = support::gas_seen(exact, volume_m3);
      Breathing<Real, BreathingFour> run(definition, 10e-6);
      run.in.throttle_ratio = static_cast<Real>(0.6);
      fill_manifold(run, one.port, one.gas.p, one.gas.t, one.gas.x);
      double out_kg = 0;
      for (long n = std::lround(time_s / 10e-6); n > 0; --n) {
        const auto& out = run.step();
        out_kg += 10e-6 * static_cast<double>(intake ? -out.throttle_kg_s : out.outlet_kg_s);
      }
      const double from_kg = one.gas.p * volume_m3 / (support::kGasR * one.gas.t);
      EXPECT_NEAR(out_kg, from_kg - static_cast<double>(run.engine.state().manifold[one.port].contents.mass_kg),
                  1e-6 * from_kg);
      const auto& now = run.engine.output().manifold[one.port];
      // Implicit throughout, so of first order: 10 us are 0.2 % of the five milliseconds that the outlet needs.
      const double moved_Pa = std::fabs(wanted.p - one.gas.p);
      EXPECT_NEAR(static_cast<double>(now.pressure_Pa), wanted.p, 4e-3 * moved_Pa) << one.port << " " << one.gas.p;
      EXPECT_NEAR(static_cast<double>(now.temperature_K), wanted.t, 4e-3 * std::fabs(wanted.t - one.gas.t) + 0.02)
          << one.port << " " << one.gas.p;
      EXPECT_NEAR(static_cast<double>(now.burned_ratio), wanted.x, 4e-3 * std::fabs(wanted.x - one.gas.x) + 1e-6)
          << one.port << " " << one.gas.p;
    }
  }
}

}  // namespace
}  // namespace crankloop::gas_inputs_test

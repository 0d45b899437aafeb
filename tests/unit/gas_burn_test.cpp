// What burns in a cylinder, and when: a sealed one, whose mass grows by the fuel that has burned.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/both_reals.hpp"
#include "support/gas_engine.hpp"
#include "support/gas_equations.hpp"

namespace crankloop::gas_burn_test {
namespace {

using support::MeasuredRun;
using tick_test::RealName;

template <class Real>
class GasBurn : public ::testing::Test {};
TYPED_TEST_SUITE(GasBurn, tick_test::BothReals, RealName);

constexpr double kRounding_kg = 2e-10;  // of half a gram in float, a few times

[[nodiscard]] EngineDefinition sealed_one() { return support::sealed(support::one_of_four_2000()); }

template <class Real>
void give_fuel(MeasuredRun<Real>& run, double fuel_kg) {
  run.in.fuel_kg[0] = static_cast<Real>(fuel_kg);
}

// ---- taken once, at the latch ---------------------------------------------------------------------------------------

TYPED_TEST(GasBurn, TakesItsFuelInATickThatEndsAtTheLatch) {  // -90 deg: a number that a phase has exactly
  MeasuredRun<TypeParam> run(sealed_one(), 625);
  const double before_kg = run.mass_kg();
  give_fuel(run, 20e-6);
  (void)run.to(630);
  give_fuel(run, 5e-6);
  run.turn(820);
  EXPECT_NEAR(run.mass_kg() - before_kg, 20e-6, kRounding_kg);
}

TYPED_TEST(GasBurn, TakesItsFuelWhereItsDefinitionHasTheLatch) {
  EngineDefinition definition = sealed_one();
  definition.gas.latch_deg = -150;
  MeasuredRun<TypeParam> run(definition, 560);
  const double before_kg = run.mass_kg();
  const auto asks = [&run](double from_deg, double fuel_kg) {
    run.turn(from_deg);
    give_fuel(run, fuel_kg);
  };
  asks(569, 5e-6), asks(569.5, 20e-6), asks(570.5, 7e-6), asks(820, 0);
  EXPECT_NEAR(run.mass_kg() - before_kg, 20e-6, kRounding_kg);
}

TYPED_TEST(GasBurn, BurnsNothingInACycleThatItEntersAtTheLatchOrBehind) {
  for (const double start_deg : {630.0, 640.0}) {
    MeasuredRun<TypeParam> run(sealed_one(), start_deg);
    const double before_kg = run.mass_kg();
    give_fuel(run, 10e-6);
    run.turn(1340);
    EXPECT_NEAR(run.mass_kg(), before_kg, kRounding_kg);
    run.turn(1540);
    EXPECT_NEAR(run.mass_kg() - before_kg, 10e-6, kRounding_kg);
  }
}

TYPED_TEST(GasBurn, KeepsItsFuelWhereItTurnsBackOverTheLatch) {
  MeasuredRun<TypeParam> run(sealed_one(), 600);
  const double before_kg = run.mass_kg();
  give_fuel(run, 20e-6);
  run.turn(640);
  give_fuel(run, 5e-6);
  run.turn(610);
  EXPECT_NEAR(run.mass_kg(), before_kg, kRounding_kg);
  run.turn(820);
  EXPECT_NEAR(run.mass_kg() - before_kg, 20e-6, kRounding_kg);
}

TYPED_TEST(GasBurn, LosesTheFuelOfACycleThatItTurnsBackOutOf) {
  MeasuredRun<TypeParam> run(sealed_one(), 600);
  const double before_kg = run.mass_kg();
  give_fuel(run, 20e-6);
  run.turn(640);
  run.turn(300);  // over 360, where cycles end: 300 deg of the cycle before is behind any burn
  EXPECT_NEAR(run.mass_kg(), before_kg, kRounding_kg);
  give_fuel(run, 5e-6);
  run.turn(820);
  EXPECT_NEAR(run.mass_kg() - before_kg, 5e-6, kRounding_kg);
}

TYPED_TEST(GasBurn, BurnsEachCyclesFuelOnceWhereItTurnsBackInTheBurn) {
  MeasuredRun<TypeParam> run(sealed_one(), 600);
  double before_kg = run.mass_kg();
  const double start_kg = before_kg;
  const auto grows = [&](const auto&) {
    ASSERT_GE(run.mass_kg(), before_kg - kRounding_kg);
    before_kg = run.mass_kg();
  };
  give_fuel(run, 10e-6);
  run.turn(715, 1, grows);
  const double half_kg = before_kg;
  run.turn(690, 1, grows);
  EXPECT_NEAR(before_kg, half_kg, kRounding_kg);
  run.turn(740, 1, grows), run.turn(715, 1, grows), run.turn(900, 1, grows), run.turn(700, 1, grows);
  EXPECT_NEAR(before_kg - start_kg, 10e-6, kRounding_kg);
  run.turn(1540, 1, grows);
  EXPECT_NEAR(before_kg - start_kg, 20e-6, kRounding_kg);
}

TYPED_TEST(GasBurn, BurnsNoFuelOfBeforeALeap) {
  MeasuredRun<TypeParam> run(sealed_one(), 600);
  run.turn(640);
  EXPECT_EQ(run.to(920).faults, std::uint32_t{kFaultPhaseJump});  // to 200 deg of the next cycle
  const double filled_kg = run.mass_kg();
  run.turn(1050);
  EXPECT_NEAR(run.mass_kg(), filled_kg, kRounding_kg);
}

// ---- how it burns ---------------------------------------------------------------------------------------------------

/// Share that has burned at each degree, against `exact(deg)`.
template <class Real, class Exact>
void expect_shares(MeasuredRun<Real>& run, double fuel_kg, const Exact& exact) {
  give_fuel(run, fuel_kg);
  run.turn(632);
  const double before_kg = run.mass_kg();
  // A straight line between 512 rows is off by 1/8 of the second derivative, of 30, over 512^2; float by its rounding.
  run.turn(880, 1, [&](const auto&) {
    EXPECT_NEAR((run.mass_kg() - before_kg) / fuel_kg, exact(run.deg - 720), 3e-5) << run.deg - 720;
  });
}

TYPED_TEST(GasBurn, FollowsTheLawsOfItsDefinition) {
  EngineDefinition definition = sealed_one();
  definition.gas.wiebe_m = 1.5;
  MeasuredRun<TypeParam> one(definition, 600);
  expect_shares(one, 20e-6, [](double deg) { return support::wiebe((deg + 18) / 50, 1.5); });

  definition.gas.second_ratio = 0.4, definition.gas.second_m = 1, definition.gas.second_duration_ratio = 2.5;
  MeasuredRun<TypeParam> two(definition, 600);
  two.in.burn_start_deg[0] = -10, two.in.burn_duration_deg[0] = 40;
  expect_shares(two, 20e-6, [](double deg) {
    return 0.6 * support::wiebe((deg + 10) / 40, 1.5) + 0.4 * support::wiebe((deg + 10) / 100, 1);
  });

  definition.gas.second_duration_ratio = 0.5;  // the first law is then the longer one
  MeasuredRun<TypeParam> short_second(definition, 600);
  expect_shares(short_second, 20e-6, [](double deg) {
    return 0.6 * support::wiebe((deg + 18) / 50, 1.5) + 0.4 * support::wiebe((deg + 18) / 25, 1);
  });
}

TYPED_TEST(GasBurn, BurnsNoMoreThanThereIsAirFor) {
  EngineDefinition definition = sealed_one();
  definition.gas.air_fuel_ratio = 15;
  for (const double rich : {1.0, 1.25, 2.0, 4.0, 20.0}) {
    MeasuredRun<TypeParam> run(definition, 200);  // from the cycle's begin at 360 on, its results are shown
    run.turn(600);
    const double air_kg = run.mass_kg();  // all of it
    const double asked_kg = rich * air_kg / 15, counts_kg = std::fmin(rich, 4) * air_kg / 15;
    give_fuel(run, asked_kg);
    run.turn(1090);
    const auto& cycle = run.engine.output().gas_cycle[0];
    EXPECT_NEAR(run.mass_kg() - air_kg, counts_kg, 2 * kRounding_kg);
    EXPECT_NEAR(static_cast<double>(run.engine.output().cylinder_gas[0].burned_ratio), 1, 1e-6);
    EXPECT_NEAR(static_cast<double>(cycle.excess_air_ratio), 1 / rich, 1e-6);
    EXPECT_NEAR(static_cast<double>(cycle.fuel_kg), counts_kg, 1e-6 * counts_kg);
    const double heat_J = air_kg / 15 * 0.97 * 43e6;
    EXPECT_NEAR(static_cast<double>(cycle.heat_J), heat_J, 2e-6 * heat_J);
    EXPECT_NEAR(static_cast<double>(cycle.energy_defect_J), 0, 1e-6 * heat_J);
    run.turn(1810);  // the next cycle has no air
    EXPECT_NEAR(static_cast<double>(run.engine.output().gas_cycle[0].excess_air_ratio), 0, 1e-6);
    EXPECT_NEAR(run.mass_kg() - air_kg, counts_kg, 2 * kRounding_kg);
  }
}

TYPED_TEST(GasBurn, BurnsNothingInACycleThatIsCutWhereItTakesItsFuel) {
  MeasuredRun<TypeParam> run(sealed_one(), 200);
  run.turn(620);
  const double before_kg = run.mass_kg();
  run.in.cut_cylinders = 1;
  run.turn(640);
  run.in.cut_cylinders = 0;
  run.turn(1090);
  EXPECT_NEAR(run.mass_kg(), before_kg, kRounding_kg);
  EXPECT_EQ(run.engine.output().gas_cycle[0].excess_air_ratio, TypeParam{0});
  EXPECT_EQ(run.engine.output().gas_cycle[0].fuel_kg, TypeParam{0});
  run.in.cut_cylinders = 2;  // of another cylinder
  run.turn(1540);
  EXPECT_NEAR(run.mass_kg() - before_kg, 30e-6, kRounding_kg);
}

// ---- what is asked for ----------------------------------------------------------------------------------------------

/// What a cycle is asked for, and whether that is good.
struct Asked {
  double fuel_kg, start_deg, duration_deg;
  bool good;
};

/// A cycle that is asked for something bad burns as the last good one: in the first cycle as defined.
template <class Real>
void expect_answers(const EngineDefinition& definition, const Asked& asked) {
  MeasuredRun<Real> run(definition, 625), defined(definition, 625);
  const bool bad_fuel = !(asked.fuel_kg >= 0 && asked.fuel_kg <= 0.01);
  run.in.fuel_kg[0] = static_cast<Real>(asked.fuel_kg);
  run.in.burn_start_deg[0] = static_cast<Real>(asked.start_deg);
  run.in.burn_duration_deg[0] = static_cast<Real>(asked.duration_deg);
  if (asked.good) defined.in = run.in;
  if (!bad_fuel) defined.in.fuel_kg[0] = run.in.fuel_kg[0];
  const double before_kg = run.mass_kg();
  EXPECT_EQ(run.to(635).faults, asked.good ? 0u : std::uint32_t{kFaultBurn})
      << asked.fuel_kg << " kg from " << asked.start_deg << " over " << asked.duration_deg;
  EXPECT_EQ(defined.to(635).faults, 0u);
  for (double deg = 640; deg <= 880; deg += 5) {
    ASSERT_EQ(run.to(deg).cylinder_gas[0].mass_kg, defined.to(deg).cylinder_gas[0].mass_kg)
        << asked.fuel_kg << " kg from " << asked.start_deg << " over " << asked.duration_deg << " at " << deg;
  }
  const double fuel_kg = bad_fuel ? definition.gas.fuel_kg : asked.fuel_kg;
  EXPECT_NEAR(run.mass_kg() - before_kg, std::fmin(fuel_kg, 4 * before_kg / 14.6), 2 * kRounding_kg);
}

TYPED_TEST(GasBurn, KeepsTheRangesOfFuelAndBurn) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const Asked all[] = {{0, -18, 50, true},         {0.01, -18, 50, true},       {-0.0, -18, 50, true},
                       {-1e-9, -18, 50, false},    {0.010001, -18, 50, false},  {nan, -18, 50, false},
                       {infinity, -18, 50, false}, {20e-6, -90, 5, true},       {20e-6, 60, 5, true},
                       {20e-6, -90.01, 50, false}, {20e-6, 60.01, 50, false},   {20e-6, nan, 50, false},
                       {20e-6, -90, 150, true},    {20e-6, -90, 150.01, false}, {20e-6, -18, 4.99, false},
                       {20e-6, -18, nan, false},   {20e-6, 60, 90, true},       {20e-6, 60, 90.1, false}};
  for (const Asked& asked : all) expect_answers<TypeParam>(sealed_one(), asked);
}

TYPED_TEST(GasBurn, RefusesASecondLawThatBurnsBeyond150Deg) {
  EngineDefinition definition = sealed_one();
  definition.gas.second_ratio = 0.3, definition.gas.second_duration_ratio = 3;
  for (const Asked& asked : {Asked{20e-6, 0, 50, true}, Asked{20e-6, 0.1, 50, false}, Asked{20e-6, 0, 50.1, false}})
    expect_answers<TypeParam>(definition, asked);
  definition.gas.second_duration_ratio = 0.5;
  for (const Asked& asked : {Asked{20e-6, 60, 90, true}, Asked{20e-6, 60, 90.1, false}})
    expect_answers<TypeParam>(definition, asked);
}

TYPED_TEST(GasBurn, GoesOnAsTheLastGoodCycleWasAsked) {
  MeasuredRun<TypeParam> run(sealed_one(), 600);
  const double before_kg = run.mass_kg();
  give_fuel(run, 7e-6);
  run.turn(1300);
  give_fuel(run, -1);
  run.turn(1345);
  EXPECT_EQ(run.to(1355).faults, std::uint32_t{kFaultBurn});
  run.turn(1540);
  EXPECT_NEAR(run.mass_kg() - before_kg, 14e-6, kRounding_kg);
}

// ---- fuel by air ----------------------------------------------------------------------------------------------------

/// Fuel that burned in the cycle after the next latch, of a cylinder that holds `air_kg` of it.
TYPED_TEST(GasBurn, TakesItsFuelByTheAirThatIsThere) {
  using Real = TypeParam;
  for (const double lambda : {0.8, 1.0, 1.25, 3.0}) {
    MeasuredRun<Real> run(sealed_one(), 200);
    run.turn(620);
    const double air_kg = run.mass_kg();
    run.in.excess_air_ratio[0] = static_cast<Real>(lambda);  // and 30 mg, which do not count then
    run.turn(640);
    run.in.excess_air_ratio[0] = Real{50};  // comes too late
    run.turn(1090);
    const auto& cycle = run.engine.output().gas_cycle[0];
    EXPECT_NEAR(static_cast<double>(cycle.excess_air_ratio), lambda, 1e-6 * lambda);
    EXPECT_NEAR(run.mass_kg() - air_kg, air_kg / 14.6 / lambda, kRounding_kg) << lambda;
    // Half of the air is left where it was twice what was asked for; the next cycle takes its fuel by that.
    run.in.excess_air_ratio[0] = static_cast<Real>(lambda);
    const double left_kg = air_kg * (1 - 1 / std::fmax(lambda, 1)), before_kg = run.mass_kg();
    run.turn(1540);
    EXPECT_NEAR(run.mass_kg() - before_kg, left_kg / 14.6 / lambda, 2 * kRounding_kg) << lambda;
  }
}

TYPED_TEST(GasBurn, TakesItsFuelByTheAirThatItsDefinitionAsksFor) {
  EngineDefinition definition = sealed_one();
  definition.gas.excess_air_ratio = 1.5;  // and fuel_kg stays at its default, which is not read then
  MeasuredRun<TypeParam> run(definition, 600);
  const double air_kg = run.mass_kg();
  run.in.excess_air_ratio[0] = TypeParam{-1};  // bad: as defined
  run.turn(625);
  EXPECT_EQ(run.to(635).faults, std::uint32_t{kFaultBurn});
  run.turn(820);
  EXPECT_NEAR(run.mass_kg() - air_kg, air_kg / 14.6 / 1.5, kRounding_kg);
}

TYPED_TEST(GasBurn, KeepsTheRangesOfFuelByAir) {
  using Real = TypeParam;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    double fuel_kg, excess_air_ratio;
    bool good;
  };
  for (const Case& asked : {Case{0, 100, true}, Case{0, 100.1, false}, Case{0, -0.1, false}, Case{0, nan, false},
                            Case{30e-6, 2, true}, Case{1e-6, 0, true}, Case{0, 1e-30, true}, Case{0, 0, true}}) {
    MeasuredRun<Real> run(sealed_one(), 600);
    give_fuel(run, 0);
    run.in.excess_air_ratio[0] = Real{4};
    run.turn(820);  // a cycle whose lambda holds where the next one's is bad
    const double before_kg = run.mass_kg();
    run.turn(1340);
    give_fuel(run, asked.fuel_kg);
    run.in.excess_air_ratio[0] = static_cast<Real>(asked.excess_air_ratio);
    EXPECT_EQ(run.to(1355).faults, asked.good ? 0u : std::uint32_t{kFaultBurn})
        << asked.fuel_kg << " " << asked.excess_air_ratio;
    run.turn(1540);
    const double air_kg = before_kg / (1 + 1 / 14.6 / 4) * (1 - 1.0 / 4);  // what the first cycle left
    const double lambda = asked.good ? asked.excess_air_ratio : 4;
    const double wanted_kg = lambda > 0 ? air_kg / 14.6 / std::fmax(lambda, kLeastBurning_ratio) : asked.fuel_kg;
    EXPECT_NEAR(run.mass_kg() - before_kg, wanted_kg, 2 * kRounding_kg)
        << asked.fuel_kg << " " << asked.excess_air_ratio;
  }
}

}  // namespace
}  // namespace crankloop::gas_burn_test

// What set-up makes of an engine's gas: walls, ports, manifolds and combustion against the closed forms of
// docs/model.md "Gas", worked out here with the standard library.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <memory>

#include <crankloop/tabulate/tabulate.hpp>

#include "support/both_reals.hpp"
#include "support/engines.hpp"
#include "support/gas_bench.hpp"
#include "support/gas_equations.hpp"
#include "support/status.hpp"
#include "support/units.hpp"

namespace crankloop::gas_tables_test {

using namespace detail;
namespace {

using support::gas_energy;
using support::kGasR;
using support::kPi;
using tick_test::BothReals;
using tick_test::RealName;

/// The gas sections of an engine.
template <class Real>
struct GasSections {
  GasCylinders<Real> cylinders;
  GasManifolds<Real> manifolds;
  GasPortCurve<Real> ports[kMaxTrains];
  BurnTable<Real> burn;
  GasCrevice<Real> crevice;
  GasRunners<Real> runners;
  ChargeBurnTable<Real> charge_burn;
  KnockTable<Real> knock;
  WarmWallsTable<Real> warm_walls;
};

template <class Real>
class GasTablesOf : public ::testing::Test {
 protected:
  static std::unique_ptr<GasSections<Real>> filled(const EngineDefinition& engine,
                                                   const TickOptions& options = {100e-6, {}}) {
    auto sections = std::make_unique<GasSections<Real>>();
    std::memset(static_cast<void*>(sections.get()), 0xA5, sizeof *sections);
    TableTargets<Real> targets;
    targets.gas_cylinders = &sections->cylinders;
    targets.gas_manifolds = &sections->manifolds;
    targets.gas_ports = sections->ports;
    targets.burn = &sections->burn;
    targets.gas_crevice = &sections->crevice;
    targets.gas_runners = &sections->runners;
    targets.charge_burn = &sections->charge_burn;
    targets.knock = &sections->knock;
    targets.gas_walls = &sections->warm_walls;
    EXPECT_TRUE(accepted(tabulate(engine, options, targets)));
    return sections;
  }
  /// To rounding: once into Real, and some operations in double before.
  static void expect_is(Real table, double formula) {
    const double rounding = (sizeof(Real) == 4 ? 6e-8 : 0) + 1e-14;
    EXPECT_NEAR(static_cast<double>(table), formula, rounding * std::fabs(formula));
  }
};
TYPED_TEST_SUITE(GasTablesOf, BothReals, RealName);

TYPED_TEST(GasTablesOf, TheCylindersHaveTheirVolumesAndWalls) {
  EngineDefinition engine = support::four_2000();
  engine.pressure.crankcase_Pa = 97e3;
  engine.gas.wall_K = 411;
  engine.gas.wall_heat_ratio = 1.7;
  engine.gas.ambient_Pa = 93e3, engine.gas.ambient_K = 281, engine.gas.exhaust_K = 655;
  const auto tables = this->filled(engine);
  const auto& c = tables->cylinders;
  const double area_m2 = kPi / 4 * 0.086 * 0.086;
  const double swept_m3 = area_m2 * 0.086;
  this->expect_is(c.walls.heat_factor, 130e-4 * 1.7);
  this->expect_is(c.walls.area_m2, 2 * area_m2);
  this->expect_is(c.walls.area_per_m3, 4 / 0.086);
  this->expect_is(c.walls.temperature_K, 411);
  this->expect_is(c.walls.piston_m, 0.086 / kPi);  // two strokes a turn
  this->expect_is(c.clearance_m3, swept_m3 / 9.5);
  this->expect_is(c.bore_area_m2, area_m2);
  this->expect_is(c.crankcase_Pa, 97e3);
  this->expect_is(c.least_kg_m3, 97e3 / (kGasR * 300) / 1000);
  this->expect_is(c.per_swept_m3, 1 / swept_m3);
  this->expect_is(c.per_full_charge, 1 / (93e3 / (kGasR * 281) * swept_m3));
  this->expect_is(c.ambient_Pa, 93e3);
  this->expect_is(c.ambient_K, 281);
  this->expect_is(c.exhaust_K, 655);
}

TYPED_TEST(GasTablesOf, CrevicesHoldGasAtTheWallsTemperatureAndLeakAsAnOrifice) {
  EngineDefinition engine = support::four_2000();
  engine.pressure.crankcase_Pa = 97e3;
  engine.gas.wall_K = 411;
  const auto none = this->filled(engine);
  EXPECT_EQ(none->crevice.in_use, 0u);
  EXPECT_EQ(none->cylinders.parts, 0u);
  engine.gas.crevice.volume_ratio = 0.015, engine.gas.crevice.blow_by_m2 = 0.1e-6;
  const auto tables = this->filled(engine);
  const auto& c = tables->crevice;
  EXPECT_EQ(c.in_use, 1u);
  EXPECT_EQ(tables->cylinders.parts, std::uint32_t{kGasCrevice});
  this->expect_is(c.kg_per_Pa, 0.015 * kPi / 4 * 0.086 * 0.086 * 0.086 / 9.5 / (kGasR * 411));
  this->expect_is(c.wall_K, 411);
  this->expect_is(c.specific_work_J_kg, kGasR * 411);
  this->expect_is(c.energy_J_kg, gas_energy(411, 0));
  this->expect_is(c.burned_more_J_kg, 93.0 * 411);
  this->expect_is(c.leak_kg_s_Pa, 0.1e-6 * support::kChokedPsi / std::sqrt(kGasR * 411));
  this->expect_is(c.crankcase_Pa, 97e3);
  engine.gas.crevice.volume_ratio = 0;  // a leak alone
  EXPECT_EQ(this->filled(engine)->crevice.in_use, 1u);
}

TYPED_TEST(GasTablesOf, RunnersHaveAPortOfFourOverPiSquaredOfTheirVolumeAndLeaveTheRestToALargeManifold) {
  EngineDefinition engine = support::four_2000();
  const auto none = this->filled(engine);
  EXPECT_EQ(none->runners.of[kIntake].area_m2, 0);
  EXPECT_EQ(none->cylinders.parts, 0u);
  engine.gas.intake_runner = {0.35, 0.038, 0.8};
  const auto tables = this->filled(engine);
  const auto& runner = tables->runners.of[kIntake];
  const double area_m2 = kPi / 4 * 0.038 * 0.038, share = 4 / (kPi * kPi);
  EXPECT_EQ(tables->cylinders.parts, std::uint32_t{kGasRunners});
  EXPECT_EQ(tables->runners.of[kExhaust].area_m2, 0);
  this->expect_is(runner.area_m2, area_m2);
  this->expect_is(runner.area_per_length_m, area_m2 / 0.35);
  this->expect_is(runner.loss_per_m4, 0.8 / (2 * area_m2 * area_m2));
  this->expect_is(runner.per_volume_m3, 1 / (share * area_m2 * 0.35));
  this->expect_is(runner.least_kg, 100e3 / (kGasR * 300) / 1000 * share * area_m2 * 0.35);
  this->expect_is(tables->manifolds.per_volume_m3[kIntake], 1 / (3e-3 + 4 * (1 - share) * area_m2 * 0.35));
  this->expect_is(tables->manifolds.per_volume_m3[kExhaust], 1 / 2.5e-3);
  engine.gas.intake_m3 = 4.99 * area_m2 * 0.35;  // too small: nothing is added
  this->expect_is(this->filled(engine)->manifolds.per_volume_m3[kIntake], 1 / engine.gas.intake_m3);
}

TYPED_TEST(GasTablesOf, WallsThatWarmUpHaveTheirCapacityAndConductances) {
  EngineDefinition engine = support::four_2000();
  EXPECT_EQ(this->filled(engine)->warm_walls.capacity_J_K, 0);
  engine.gas.walls = {1500, 25, 360, 2, 9, 0};
  const auto tables = this->filled(engine);
  EXPECT_EQ(tables->cylinders.parts, std::uint32_t{kGasWalls});
  this->expect_is(tables->warm_walls.capacity_J_K, 1500);
  this->expect_is(tables->warm_walls.to_coolant_W_K, 25);
  this->expect_is(tables->warm_walls.coolant_K, 360);
  this->expect_is(tables->warm_walls.port_W_K[kIntake], 2);
  this->expect_is(tables->warm_walls.port_W_K[kExhaust], 9);
  this->expect_is(tables->warm_walls.behind_K, engine.gas.ambient_K);
  EXPECT_EQ(tables->warm_walls.of_ports, 1u);
  engine.gas.walls.manifold_K = 340;
  this->expect_is(this->filled(engine)->warm_walls.behind_K, 340);
}

/// So many that 5 MW/m2 on twice the bore's area change no temperature by more than 0.05 K, at most 32.
TYPED_TEST(GasTablesOf, WallsChangeEveryFewTicks) {
  EngineDefinition engine = support::four_2000();
  const double most_W = 5e6 * 2 * kPi / 4 * 0.086 * 0.086, tick_s = 100e-6;
  const auto ticks = [&](double capacity_J_K, double to_coolant_W_K) {
    engine.gas.walls = {capacity_J_K, to_coolant_W_K, 360, 0, 0, 0};
    return this->filled(engine)->warm_walls.ticks;
  };
  EXPECT_EQ(ticks(0, 20), 32u);
  EXPECT_EQ(ticks(1e6, 20), 32u);
  EXPECT_EQ(ticks(4.001 * tick_s * most_W / 0.05, 20), 4u);
  EXPECT_EQ(ticks(3.999 * tick_s * most_W / 0.05, 20), 2u);
  EXPECT_EQ(ticks(2, 20), 1u);
  EXPECT_EQ(ticks(1e4, 0.999e-3 * 1e4 / (8 * tick_s)), 8u);
  EXPECT_EQ(ticks(1e4, 1.001e-3 * 1e4 / (8 * tick_s)), 4u);
  EXPECT_EQ(this->filled(engine)->warm_walls.of_ports, 0u);
}

TYPED_TEST(GasTablesOf, KnockHasItsOctaneNumber) {
  EngineDefinition engine = support::four_2000();
  EXPECT_EQ(this->filled(engine)->knock.in_use, 0u);
  engine.gas.octane_number = 87;
  const auto tables = this->filled(engine);
  EXPECT_EQ(tables->knock.in_use, 1u);
  EXPECT_EQ(tables->cylinders.parts, 0u);
  this->expect_is(tables->knock.hot_K, 3800 / std::log(2.0));
  this->expect_is(tables->knock.rate, -std::log2(support::knock_delay_s(87, 1, 1e300)));
}

TYPED_TEST(GasTablesOf, ABurnByChargeHasItsStateOfReference) {
  EngineDefinition engine = support::four_2000();
  EXPECT_EQ(this->filled(engine)->charge_burn.in_use, 0u);
  engine.gas.charge_burn = {true, 7, 300, 700, 2e6, 0.1, 1.1};
  const auto tables = this->filled(engine);
  const double flame_m_s = support::flame_m_s({2e6, 700, 0.1}, 1.1);
  EXPECT_EQ(tables->cylinders.parts, std::uint32_t{kGasChargeBurn});
  EXPECT_EQ(tables->charge_burn.in_use, 1u);
  this->expect_is(tables->charge_burn.spark_to_start_deg, 7);
  this->expect_is(tables->charge_burn.reference, std::log2(std::cbrt(flame_m_s * flame_m_s / 300)));
  engine.gas.charge_burn.reference_burned_ratio = 0;
  this->expect_is(this->filled(engine)->charge_burn.reference,
                  std::log2(std::cbrt(std::pow(support::flame_m_s({2e6, 700, 0}, 1.1), 2) / 300)));
}

/// 6 deg per 1000 rpm and millisecond, in steps of 5; without a highest speed 100 000 rpm or a revolution.
TYPED_TEST(GasTablesOf, ATickHasNoMoreStepsThanItsHighestSpeedNeeds) {
  const struct {
    double rpm, tick_s;
    std::uint32_t steps;
  } cases[] = {{9000, 20e-6, 1}, {8300, 100e-6, 1}, {8400, 100e-6, 2}, {9000, 500e-6, 6},
               {9000, 1e-3, 8},  {0, 20e-6, 3},     {0, 40e-6, 5},     {0, 2e-3, 8}};
  EngineDefinition engine = support::four_2000();
  for (const auto& at : cases) {
    engine.crank.max_speed_rad_s = at.rpm * kPi / 30;
    EXPECT_EQ(this->filled(engine, {at.tick_s, {}})->cylinders.max_steps, at.steps) << at.rpm << ", " << at.tick_s;
  }
  EXPECT_EQ(this->filled(engine, {500e-6, {}, 4000 * kPi / 30})->cylinders.max_steps, 3u) << "12 deg";
  engine.crank.max_speed_rad_s = 1000 * kPi / 30;  // 0.6 deg, but a small manifold
  engine.gas.exhaust_m3 = 100e-6;
  const auto tables = this->filled(engine);
  EXPECT_GT(tables->manifolds.parts, 1u);
  EXPECT_EQ(tables->cylinders.max_steps, tables->manifolds.parts);
}

TYPED_TEST(GasTablesOf, PortsOpenByStraightLinesBetweenTheirRowsForEveryValve) {
  EngineDefinition engine = support::four_2000();
  engine.trains[1].valve.per_cylinder = 3;
  PortOfTrain& port = engine.gas.ports[1];
  const double lifts[] = {0, 0.1, 0.15, 0.3};
  const double flows[] = {0, 0.4, 0.45, 0.6};
  port.flow_count = 4;
  for (int i = 0; i < 4; ++i) port.flow_lift_ratio[i] = lifts[i], port.flow_ratio[i] = flows[i];
  const auto tables = this->filled(engine);
  const auto& curve = tables->ports[1];
  EXPECT_EQ(curve.port, 1u);
  EXPECT_EQ(tables->ports[0].port, 0u);
  this->expect_is(curve.per_step_m, 1 / (0.028 / 80));
  this->expect_is(tables->ports[0].per_step_m, 1 / (0.033 / 80));
  const double seats_m2 = 3 * kPi / 4 * 0.028 * 0.028;
  const struct {
    int step;  // of 1/80 of the seat's diameter
    double flow_ratio;
  } places[] = {{0, 0},     {2, 0.1},    {4, 0.2},  {8, 0.4},  {10, 0.425},
                {12, 0.45}, {18, 0.525}, {24, 0.6}, {25, 0.6}, {40, 0.6}};
  for (const auto& at : places) this->expect_is(curve.area_m2[at.step], seats_m2 * at.flow_ratio);
  this->expect_is(tables->ports[0].area_m2[20], 2 * kPi / 4 * 0.033 * 0.033 * 0.52);  // the usual curve, at a quarter
}

TYPED_TEST(GasTablesOf, ManifoldsAndThrottleAreThoseOfTheDefinition) {
  using Real = TypeParam;
  EngineDefinition engine = support::four_2000();
  Gas& gas = engine.gas;
  gas.intake_m3 = 2.5e-3, gas.exhaust_m3 = 1.25e-3;
  gas.throttle_m2 = 1500e-6, gas.throttle_closed_m2 = 100e-6;
  gas.outlet_m2 = 900e-6;
  gas.ambient_Pa = 93e3, gas.back_Pa = 111e3, gas.ambient_K = 281, gas.exhaust_K = 655;
  engine.pressure.crankcase_Pa = 97e3;
  const auto tables = this->filled(engine);
  const auto& m = tables->manifolds;
  const double least_kg_m3 = 97e3 / (kGasR * 300) / 1000;
  this->expect_is(m.per_volume_m3[kIntake], 400);
  this->expect_is(m.per_volume_m3[kExhaust], 800);
  this->expect_is(m.least_kg[kIntake], 2.5e-3 * least_kg_m3);
  this->expect_is(m.least_kg[kExhaust], 1.25e-3 * least_kg_m3);
  const double pressures_Pa[] = {93e3, 111e3};
  for (int i = 0; i < kPorts; ++i) {
    const auto& outside = m.outside[i];
    this->expect_is(outside.pressure_Pa, pressures_Pa[i]);
    // Choked flow of an ideal gas whose specific heats have the ratio 1.36 (Saint-Venant).
    this->expect_is(outside.choked_per_Pa, support::saint_venant(1, 0, 281));
    this->expect_is(outside.specific_work_J_kg, kGasR * 281);
    this->expect_is(outside.enthalpy_J_kg, gas_energy(281, 0) + kGasR * 281);  // air on both sides, at first
    EXPECT_EQ(outside.burned_ratio, Real{0});
    EXPECT_EQ(outside.response_Pa_kg, Real{0}) << "so much gas that its pressure stays";
    this->expect_is(outside.end_Pa, pressures_Pa[i]);
    EXPECT_EQ(outside.as_was_Pa, Real{0});
  }
  EXPECT_EQ(m.parts, 1u) << "no small manifold";
  this->expect_is(m.outlet_m2, 900e-6);
  const struct {
    int percent;
    double share;  // of the way from closed to open, by the usual curve 0:0, 0.2:0.06, 0.5:0.3, 1:1
  } throttle[] = {{0, 0}, {10, 0.03}, {20, 0.06}, {35, 0.18}, {50, 0.3}, {75, 0.65}, {99, 0.986}, {100, 1}};
  for (const auto& at : throttle) this->expect_is(m.throttle_m2[at.percent], 100e-6 + at.share * 1400e-6);
}

TYPED_TEST(GasTablesOf, ABurnReleasesItsHeatByTwoLawsFromOneStart) {
  using Real = TypeParam;
  EngineDefinition engine = support::four_2000();
  Gas& gas = engine.gas;
  gas.fuel_kg = 21e-6, gas.heating_value_J_kg = 41e6, gas.combustion_efficiency = 0.95, gas.air_fuel_ratio = 15;
  gas.latch_deg = -135, gas.burn_start_deg = -7, gas.burn_duration_deg = 40;
  gas.wiebe_m = 0.5, gas.second_m = 1.5, gas.second_ratio = 0.7;
  for (const double longer : {2.5, 0.4}) {
    gas.second_duration_ratio = longer;
    const double span = std::fmax(longer, 1);
    const auto tables = this->filled(engine);
    const auto& b = tables->burn;
    EXPECT_EQ(b.latch_phase, std::uint64_t{0xD000'0000'0000'0000}) << "585 of 720 deg, thirteen sixteenths";
    this->expect_is(b.heat_J_kg, 0.95 * 41e6);
    this->expect_is(b.energy_J_kg, 0.95 * 41e6 + 16 * gas_energy(298.15, 1) - 15 * gas_energy(298.15, 0));
    this->expect_is(b.burned_kg_kg, 16);
    this->expect_is(b.air_fuel_ratio, 15);
    this->expect_is(b.per_air_fuel_ratio, 1.0 / 15);
    this->expect_is(b.span_ratio, span);
    this->expect_is(b.fuel_kg, 21e-6);
    this->expect_is(b.burn_start_deg, -7);
    this->expect_is(b.burn_duration_deg, 40);
    EXPECT_EQ(b.burnt[0], Real{0});
    EXPECT_EQ(b.burnt[kBurnSteps], Real{1});
    for (int i = 1; i < kBurnSteps; ++i) {
      // 99.9 % of a law's fuel at its end, scaled to all of it.
      const auto law = [](double s, double m) {
        return s >= 1 ? 1 : (1 - std::exp(-6.908 * std::pow(s, m + 1))) / (1 - std::exp(-6.908));
      };
      const double s = span * i / kBurnSteps;
      EXPECT_NEAR(static_cast<double>(b.burnt[i]), 0.3 * law(s, 0.5) + 0.7 * law(s / longer, 1.5), 1e-7) << i;
    }
  }
  // With one law alone the second has no part in it.
  gas.second_ratio = 0, gas.second_duration_ratio = 2.5;
  EXPECT_EQ(this->filled(engine)->burn.span_ratio, Real{1});
}

TYPED_TEST(GasTablesOf, AnEngineWithADiagramIsEmpty) {
  using Real = TypeParam;
  EngineDefinition engine = support::four_2000();
  engine.pressure.source = PressureSource::none;
  const auto tables = this->filled(engine);
  EXPECT_EQ(tables->cylinders.bore_area_m2, Real{0});
  EXPECT_EQ(tables->cylinders.walls.heat_factor, Real{0});
  EXPECT_EQ(tables->manifolds.throttle_m2[kThrottleSteps], Real{0});
  EXPECT_EQ(tables->manifolds.outside[kExhaust].pressure_Pa, Real{0});
  EXPECT_EQ(tables->manifolds.parts, 0u);
  EXPECT_EQ(tables->ports[1].area_m2[kFlowSteps], Real{0});
  EXPECT_EQ(tables->burn.burnt[kBurnSteps], Real{0});
}

}  // namespace
}  // namespace crankloop::gas_tables_test

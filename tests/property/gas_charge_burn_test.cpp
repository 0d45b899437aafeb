// Burn by charge: the law and its facts, an engine that burns by it against the differential equations, saved states.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/tick/gas/octaves.hpp>
#include <crankloop/tick/state/saved_state.hpp>

#include "support/both_reals.hpp"
#include "support/breathing_ode.hpp"
#include "support/gas_engine.hpp"
#include "support/random.hpp"
#include "support/status.hpp"

namespace crankloop::gas_charge_burn_test {
namespace {

using support::Breathing;
using support::BreathingOde;
using support::flame_m_s;
using support::GasSeen;
using support::kPi;
using support::rad_s;
using tick_test::RealName;

constexpr GasSeen kIn{100e3, 298, 0}, kOut{102e3, 900, 1};

struct Cylinder : support::GivenCylinder {
  static constexpr bool charge_burn = true;
};
struct ByInput : Cylinder {
  static constexpr Combustion combustion = Combustion::by_input;
};
struct Plain : Cylinder {
  static constexpr bool charge_burn = false;
};

[[nodiscard]] EngineDefinition by_charge(double fuel_kg = 32e-6) {
  EngineDefinition engine = support::one_of_four_2000();
  engine.gas.fuel_kg = fuel_kg;
  engine.gas.charge_burn.in_use = true;
  return engine;
}

template <class Real, class S = Cylinder>
[[nodiscard]] std::unique_ptr<Breathing<Real, S>> breathing(const EngineDefinition& definition, double tick_s,
                                                            double rpm) {
  return support::breathing_between<Real, S>(definition, tick_s, rad_s(rpm), kIn, kOut);
}

template <class Real>
class GasChargeBurn : public ::testing::Test {};
TYPED_TEST_SUITE(GasChargeBurn, tick_test::BothReals, RealName);

// ---- the law --------------------------------------------------------------------------------------------------------

TYPED_TEST(GasChargeBurn, HasPowersOfAnyExponent) {
  using Real = TypeParam;
  const double tolerance = sizeof(Real) == 4 ? 3e-7 : 1e-8;
  for (double x = 1e-18; x < 1e18; x *= 1.0137) {
    const Real real = static_cast<Real>(x);
    const double exact = std::log2(static_cast<double>(real));
    ASSERT_NEAR(static_cast<double>(detail::octaves_of(real)), exact, tolerance * std::fmax(1, std::fabs(exact))) << x;
  }
  EXPECT_EQ(detail::octaves_of(Real{1}), Real{0});
  for (double y = -119.9; y < 119.9; y += 0.0173) {
    const Real real = static_cast<Real>(y);
    const double exact = std::exp2(static_cast<double>(real));
    ASSERT_NEAR(static_cast<double>(detail::power_of_2(real)), exact, tolerance * exact) << y;
  }
  EXPECT_EQ(detail::power_of_2(Real{0}), Real{1});
  EXPECT_EQ(detail::power_of_2(Real{1000}), detail::power_of_2(Real{120}));
  EXPECT_EQ(detail::power_of_2(static_cast<Real>(NAN)), detail::power_of_2(Real{-120}));
}

struct Case {
  double rpm, kelvin, pressure_Pa, burned_ratio, lambda, factor;
};
constexpr Case kCases[] = {
    {2000, 650, 1300e3, 0.05, 1, 1},           {1000, 650, 1300e3, 0.05, 1, 0.794},
    {6000, 650, 1300e3, 0.05, 1, 1.442},       {2000, 650, 1300e3, 0.15, 1, 1.324},
    {2000, 650, 1300e3, 0.25, 1, 1.951},       {2000, 650, 1300e3, 0.05, 1.25, 1.244},
    {2000, 650, 1300e3, 0.05, 1 / 1.2, 0.918}, {2000, 640, 500e3, 0.15, 1, 1.178},
};

TYPED_TEST(GasChargeBurn, LastsAsItsLawSays) {
  using Real = TypeParam;
  EXPECT_NEAR(flame_m_s({101325, 298, 0}, 1), 0.2808, 5e-5);
  EXPECT_NEAR(flame_m_s({1300e3, 650, 0.05}, 1), 0.6749, 5e-5);
  const auto run = breathing<Real>(by_charge(), 100e-6, 1000);
  const auto& table = *run->storage.tables().charge_burn;
  const auto ratio = [&table](const Case& c) {
    const auto real = [](double x) { return static_cast<Real>(x); };
    return static_cast<double>(detail::burn_ratio<Real>(
        table, {real(c.kelvin), real(c.pressure_Pa), real(c.burned_ratio), real(c.lambda)}, real(rad_s(c.rpm))));
  };
  for (const Case& c : kCases)
    EXPECT_NEAR(ratio(c), c.factor, 6e-4) << c.rpm << " " << c.burned_ratio << " " << c.lambda;
  support::Random random(36);
  for (int i = 0; i < 2000; ++i) {
    const Case c{random.between(100, 9000), random.between(300, 1200), random.between(20e3, 1e7),
                 random.between(0, 0.4),    random.between(0.5, 2.5),  0};
    const double exact =
        std::cbrt(c.rpm / 2000) * std::pow(flame_m_s({1300e3, 650, 0.05}, 1) /
                                               flame_m_s({c.pressure_Pa, c.kelvin, std::fmin(0.3, c.burned_ratio)},
                                                         std::fmin(1 / 0.7, std::fmax(1 / 1.4, c.lambda))),
                                           2.0 / 3);
    EXPECT_NEAR(ratio(c), std::fmin(3, std::fmax(0.5, exact)), sizeof(Real) == 4 ? 1e-5 : 5e-6);
  }
  EXPECT_EQ(ratio({0, 650, 1300e3, 0.05, 1, 0}), 0.5);  // at standstill, backwards
  EXPECT_EQ(ratio({-2000, 650, 1300e3, 0.05, 1, 0}), ratio({2000, 650, 1300e3, 0.05, 1, 0}));
}

// ---- an engine ------------------------------------------------------------------------------------------------------

/// Largest error of the pressure over the peak, of which at most twice may be reached, and of the duration; three
/// cycles from rest.
struct Accuracy {
  double rpm, tick_s, of_peak, duration_ratio;
  double excess_air_ratio = 0;  ///< 0: 32 mg of fuel, which is lean
};
constexpr Accuracy kMeasured[] = {
    {1000, 20e-6, 8.5e-6, 8e-6},
    {1000, 100e-6, 5.9e-5, 4e-5},
    {3000, 20e-6, 6.1e-5, 4.8e-5},
    {3000, 50e-6, 1.5e-4, 1.6e-4},  // 2.1e-4 of the peak; 3e-4 are asked
    {3000, 100e-6, 5.5e-4, 3.2e-4},
    {6000, 20e-6, 1.2e-4, 1e-4},
    {6000, 50e-6, 3e-4, 3.1e-4},  // 5.8e-4; 6e-4 are asked
    {6000, 100e-6, 1.7e-3, 1e-3},
    // Fuel by air.
    {3000, 50e-6, 1.5e-4, 2.1e-4, 1},
    {6000, 50e-6, 3e-4, 4.8e-4, 1},
};

TYPED_TEST(GasChargeBurn, FollowsItsDifferentialEquations) {
  using Real = TypeParam;
  for (const Accuracy& asked : kMeasured) {
    EngineDefinition definition = by_charge();
    Gas& gas = definition.gas;
    gas.excess_air_ratio = asked.excess_air_ratio;
    const auto run = breathing<Real>(definition, asked.tick_s, asked.rpm);
    const auto w = static_cast<double>(run->in.speed_rad_s);
    BreathingOde exact(definition, w, kIn, kOut, {gas.fuel_kg, 0});
    const double cycle_s = 4 * kPi / w;
    double peak_Pa = 0, worst_Pa = 0, worst_deg = 0, duration_deg = 0, lambda = 0;
    int events = 0;
    const long ticks = std::lround(3.2 * cycle_s / asked.tick_s);
    for (long i = 1; i <= ticks; ++i) {
      const double time_s = static_cast<double>(i) * asked.tick_s;
      const double latch_s = (events / 2 + 1 - 90.0 / 720) * cycle_s;
      const double start_s = (events / 2 + 1 + gas.burn_start_deg / 720) * cycle_s;
      if (events % 2 == 0 && time_s >= latch_s) {
        exact.run_to(latch_s), ++events;
        const GasSeen at = exact.cylinder();
        const double air_kg = exact.mass_kg() * (1 - at.x);
        if (asked.excess_air_ratio > 0) exact.take_fuel(air_kg / (gas.air_fuel_ratio * asked.excess_air_ratio));
        lambda = asked.excess_air_ratio > 0 ? asked.excess_air_ratio : air_kg / (gas.air_fuel_ratio * gas.fuel_kg);
      } else if (events % 2 == 1 && time_s >= start_s) {
        exact.run_to(start_s), ++events;
        const GasSeen at = exact.cylinder();
        duration_deg = gas.burn_duration_deg * std::cbrt(asked.rpm / 2000) *
                       std::pow(flame_m_s({1300e3, 650, 0.05}, 1) / flame_m_s(at, lambda), 2.0 / 3);
        exact.burn_over(duration_deg);
      }
      exact.run_to(time_s);
      const auto& out = run->step();
      ASSERT_EQ(out.faults, 0u);
      const double exact_Pa = exact.cylinder().p;
      peak_Pa = std::fmax(peak_Pa, exact_Pa);
      worst_Pa = std::fmax(worst_Pa, std::fabs(static_cast<double>(out.cylinder_gas[0].pressure_Pa) - exact_Pa));
      const auto& burn = out.cycle_burn[0];
      if (events % 2 == 0 && std::fabs(std::fmod(time_s, cycle_s) - 0.7 * cycle_s) < 0.1 * cycle_s &&
          burn.duration_deg > 0) {
        EXPECT_NEAR(static_cast<double>(burn.start_deg), gas.burn_start_deg, 1e-5);
        worst_deg = std::fmax(worst_deg, std::fabs(static_cast<double>(burn.duration_deg) - duration_deg));
      }
    }
    EXPECT_EQ(events, 6);
    const auto where = ::testing::Message()
                       << asked.rpm << " rpm, " << asked.tick_s << " s: " << duration_deg << " deg";
    EXPECT_LT(worst_Pa / peak_Pa, 2 * asked.of_peak) << where;
    EXPECT_LT(worst_deg / duration_deg, 2 * asked.duration_ratio) << where;
  }
}

/// From the spark to the burn's start it takes as much longer as the burn before did.
TYPED_TEST(GasChargeBurn, StartsAfterTheSparkByTheBurnBefore) {
  using Real = TypeParam;
  EngineDefinition definition = by_charge();
  definition.gas.charge_burn.spark_to_start_deg = 12, definition.gas.burn_start_deg = -30;
  const auto run = breathing<Real>(definition, 50e-6, 4500);
  double ratio = 1;
  int burns = 0;
  Real last_Pa{};
  for (int tick = 0; tick < 6 * 534; ++tick) {
    const auto& out = run->step();
    if (out.gas_cycle[0].net_mep_Pa == last_Pa) continue;
    last_Pa = out.gas_cycle[0].net_mep_Pa;
    const auto& burn = out.cycle_burn[0];
    if (burn.duration_deg == 0) continue;
    EXPECT_NEAR(static_cast<double>(burn.start_deg), -30 + 12 * ratio, 1e-4);
    ratio = static_cast<double>(burn.duration_deg) / definition.gas.burn_duration_deg, ++burns;
    EXPECT_GT(ratio, 1.15);
  }
  EXPECT_GT(burns, 3);
}

/// A burn that would end later ends there, and one that has the spark too late starts where half of it fits.
TYPED_TEST(GasChargeBurn, EndsInTime) {
  using Real = TypeParam;
  EngineDefinition definition = by_charge();
  definition.gas.burn_duration_deg = 88, definition.gas.burn_start_deg = 60;
  definition.gas.charge_burn.spark_to_start_deg = 40, definition.gas.charge_burn.reference_rad_s = rad_s(200);
  const auto run = breathing<Real>(definition, 50e-6, 6000);
  for (int tick = 0; tick < 5 * 400; ++tick) ASSERT_EQ(run->step().faults, 0u);
  const auto& burn = run->engine.output().cycle_burn[0];
  EXPECT_NEAR(static_cast<double>(burn.start_deg), 150 - 44, 2e-3);
  EXPECT_NEAR(static_cast<double>(burn.duration_deg), 44, 1e-3);
  const auto& cycle = run->engine.output().gas_cycle[0];
  EXPECT_NEAR(static_cast<double>(cycle.fuel_kg), definition.gas.fuel_kg, 1e-6 * definition.gas.fuel_kg);
}

/// A cylinder that has a burn as `change` leaves it, from half a turn before firing dead centre to its cycle's end.
template <class Real, class Change>
[[nodiscard]] auto burn_of_changed(const Change& change, double& burnt_kg) {
  const auto run = breathing<Real>(by_charge(), 50e-6, 2000);
  const auto deg = [&run] { return static_cast<double>(tick_test::deg_of(run->engine.state().phase)); };
  for (int tick = 0; tick < 2500; ++tick) (void)run->step();  // two cycles
  while (deg() < 600 || deg() > 602) (void)run->step();
  auto state = run->engine.state();
  change(state.burn[0], state.charge_burn[0]);
  EXPECT_TRUE(accepted(run->engine.restore(state)));
  while (deg() > 359 || deg() < 357) EXPECT_EQ(run->step().faults, 0u);
  for (int tick = 0; tick < 10; ++tick) (void)run->step();
  burnt_kg = static_cast<double>(run->engine.output().gas_cycle[0].fuel_kg);
  return run->engine.output().cycle_burn[0];
}

/// Of a saved state, whose burn may be due as late as burns may end: then it lasts 1 deg.
TYPED_TEST(GasChargeBurn, LastsADegreeWhereItIsDueAtTheLatest) {
  using Real = TypeParam;
  double burnt_kg = 0;
  const auto burn = burn_of_changed<Real>(
      [](auto& of_cylinder, auto& start) {
        of_cylinder.taken = 1, of_cylinder.fuel_kg = static_cast<Real>(20e-6);
        of_cylinder.excess_air_ratio = static_cast<Real>(1.5), of_cylinder.burnt_ratio = Real{0};
        of_cylinder.start_deg = Real{150}, of_cylinder.duration_deg = Real{50}, start.due = 1;
      },
      burnt_kg);
  EXPECT_EQ(burn.start_deg, Real{150});
  EXPECT_NEAR(static_cast<double>(burn.duration_deg), 1, 1e-6);
  EXPECT_NEAR(burnt_kg, 20e-6, 1e-11);
}

/// Of a saved state whose burn has no duration.
TYPED_TEST(GasChargeBurn, ShowsNothingOfACycleWhoseBurnHasNoDuration) {
  using Real = TypeParam;
  double burnt_kg = 0;
  const auto burn = burn_of_changed<Real>(
      [](auto& of_cylinder, auto& start) {
        of_cylinder.taken = 1, of_cylinder.fuel_kg = static_cast<Real>(20e-6), of_cylinder.burnt_ratio = Real{0};
        of_cylinder.excess_air_ratio = static_cast<Real>(1.5), of_cylinder.per_deg = Real{0}, start.due = 0;
      },
      burnt_kg);
  EXPECT_EQ(burn.start_deg, Real{0});
  EXPECT_EQ(burn.duration_deg, Real{0});
  EXPECT_EQ(burnt_kg, 0);
}

/// Without speed there is no time for heat to the walls, on no way and on any: the very gas of the cylinder.
TYPED_TEST(GasChargeBurn, BeginsWithTheGasAsItIsWhereTheCrankStands) {
  using Real = TypeParam;
  const auto run = breathing<Real>(by_charge(), 50e-6, 3000);
  while (tick_test::deg_of(run->engine.state().phase) < 700) (void)run->step();
  run->in.speed_rad_s = Real{0};
  (void)run->step();
  const auto& state = run->engine.state();
  ASSERT_EQ(state.speed_rad_s, Real{0});
  const auto deg = static_cast<Real>(tick_test::deg_of(state.phase) - 720);
  const double hot_K = static_cast<double>(state.cylinder_gas.temperature_K[0]);
  EXPECT_GT(hot_K, 550);
  for (const double on_deg : {0.0, 3.0}) {
    const auto charge = detail::charge_at(run->storage.tables(), state, 0, deg, static_cast<Real>(on_deg));
    EXPECT_NEAR(static_cast<double>(charge.temperature_K), hot_K, 1e-5 * hot_K);
    EXPECT_NEAR(static_cast<double>(charge.pressure_Pa / state.cylinder_gas.pressure_Pa[0]), 1, 1e-4);
  }
}

// ---- scenes ---------------------------------------------------------------------------------------------------------

TYPED_TEST(GasChargeBurn, ChangesNoBitWhereTheEngineHasNone) {
  using Real = TypeParam;
  EngineDefinition definition = by_charge();
  definition.gas.charge_burn.in_use = false;
  const auto with = breathing<Real>(definition, 50e-6, 4000);
  const auto without = breathing<Real, Plain>(definition, 50e-6, 4000);
  EXPECT_EQ(with->storage.tables().drive->fingerprint, without->storage.tables().drive->fingerprint);
  for (int tick = 0; tick < 2000; ++tick) {
    const auto& a = with->step();
    const auto& b = without->step();
    ASSERT_EQ(std::memcmp(&a.cylinder_gas[0], &b.cylinder_gas[0], sizeof a.cylinder_gas[0]), 0) << tick;
    ASSERT_EQ(std::memcmp(&a.gas_cycle[0], &b.gas_cycle[0], sizeof a.gas_cycle[0]), 0) << tick;
  }
}

struct Motored : Plain {
  static constexpr Combustion combustion = Combustion::none;
};

TEST(GasChargeBurnDefinition, IsRefusedBeyondItsLimits) {
  EngineDefinition engine = by_charge();
  engine.gas.charge_burn.reference_Pa = 1e8;
  EXPECT_TRUE(accepted(validate(engine)));
  engine.gas.charge_burn.reference_Pa = 1e8 + 0.5;
  EXPECT_TRUE(support::refuses(validate(engine), Reason::out_of_range, "charge_burn.reference_Pa"));
}

TEST(GasChargeBurnScene, IsDemandedByADefinitionThatBurnsByCharge) {
  TableStorage<float, Plain> storage;
  ASSERT_TRUE(accepted(storage.build(by_charge(), {100e-6, {}})));
  Engine<float, Plain> engine;
  EXPECT_TRUE(support::refuses(engine.init(storage.tables()), Reason::inconsistent, "scene.charge_burn"));
  TableStorage<float, Motored> motored;
  ASSERT_TRUE(accepted(motored.build(by_charge(), {100e-6, {}})));
  Engine<float, Motored> turned;
  EXPECT_TRUE(accepted(turned.init(motored.tables())));
}

TEST(GasChargeBurnScene, CostsNoByteOfStateAndOutputWhereItIsNotAskedFor) {
  EXPECT_EQ(sizeof(State<float, Cylinder>) - sizeof(State<float, Plain>), 4 * sizeof(float));
  EXPECT_EQ(sizeof(Output<float, Cylinder>) - sizeof(Output<float, Plain>), 2 * sizeof(float));
}

struct Four : ByInput {
  static constexpr Count cylinders = exactly<4>;
};

/// Each cylinder its own spark, fuel and burn, as by itself.
TYPED_TEST(GasChargeBurn, HasACylinderAbreastAsByItself) {
  using Real = TypeParam;
  EngineDefinition definition = support::four_2000();
  definition.gas.charge_burn.in_use = true, definition.gas.charge_burn.spark_to_start_deg = 6;
  const auto four = breathing<Real, Four>(definition, 50e-6, 4000);
  for (std::size_t k = 0; k < 4; ++k) {
    four->in.fuel_kg[k] = static_cast<Real>((20 + 4 * static_cast<double>(k)) * 1e-6);
    four->in.burn_start_deg[k] = static_cast<Real>(-30 + 3 * static_cast<double>(k)),
    four->in.burn_duration_deg[k] = 50;
  }
  std::vector<std::unique_ptr<Breathing<Real, ByInput>>> each;
  for (std::size_t k = 0; k < 4; ++k) {
    EngineDefinition one = definition;
    one.layout = {};
    one.layout.cylinders = 1, one.layout.firing_deg[0] = definition.layout.firing_deg[k];
    each.push_back(breathing<Real, ByInput>(one, 50e-6, 4000));
    each[k]->in.fuel_kg[0] = four->in.fuel_kg[k];
    each[k]->in.burn_start_deg[0] = four->in.burn_start_deg[k], each[k]->in.burn_duration_deg[0] = 50;
  }
  for (int tick = 0; tick < 2400; ++tick) {
    const auto& out = four->step();
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& one = each[k]->step();
      ASSERT_EQ(std::memcmp(&out.cylinder_gas[k], &one.cylinder_gas[0], sizeof one.cylinder_gas[0]), 0) << tick;
      ASSERT_EQ(std::memcmp(&out.cycle_burn[k], &one.cycle_burn[0], sizeof one.cycle_burn[0]), 0) << tick;
    }
  }
  EXPECT_NE(four->engine.output().cycle_burn[0].duration_deg, four->engine.output().cycle_burn[3].duration_deg);
}

TYPED_TEST(GasChargeBurn, GoesOnFromASavedState) {
  using Real = TypeParam;
  EngineDefinition definition = by_charge();
  definition.gas.charge_burn.spark_to_start_deg = 8;
  const auto run = breathing<Real>(definition, 50e-6, 4000);
  for (int tick = 0; tick < 1500; ++tick) (void)run->step();
  for (int at = 0; at < 60; ++at) {  // over a spark, a start and a burn
    std::vector<unsigned char> bytes(kSavedStateBytes<Real, Cylinder>);
    ASSERT_TRUE(accepted(save_state(run->engine, bytes.data(), bytes.size())));
    const auto other = breathing<Real>(definition, 50e-6, 4000);
    ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), other->engine)));
    for (int tick = 0; tick < 12; ++tick) {
      const auto& a = run->step();
      const auto& b = other->step();
      ASSERT_EQ(std::memcmp(&a.cylinder_gas[0], &b.cylinder_gas[0], sizeof a.cylinder_gas[0]), 0) << at << " " << tick;
    }
  }
  auto state = run->engine.state();
  state.charge_burn[0].ratio = static_cast<Real>(3.1);
  std::vector<unsigned char> bytes(kSavedStateBytes<Real, Cylinder>);
  ASSERT_TRUE(accepted(run->engine.restore(state)));
  ASSERT_TRUE(accepted(save_state(run->engine, bytes.data(), bytes.size())));
  EXPECT_TRUE(
      support::refuses(load_state(bytes.data(), bytes.size(), run->engine), Reason::out_of_range, "state.charge_burn"));
}

TYPED_TEST(GasChargeBurn, StaysANumberWhateverComesIn) {  // CRANKLOOP_LONG_TESTS=1: 20 000 engines
  using Real = TypeParam;
  support::Random random(36);
  const int trials = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 20'000 : 300;
  const auto wide = [&random](double least, double most) {
    return least * std::pow(most / least, random.between(0, 1));
  };
  for (int trial = 0; trial < trials; ++trial) {
    EngineDefinition definition = by_charge(wide(1e-9, 0.01));
    ChargeBurn& burn = definition.gas.charge_burn;
    burn = {true,
            random.between(0, 40),
            wide(1, 10500),
            wide(300, 1500),
            wide(1e4, 1e8),
            random.between(0, 0.3),
            random.between(0.72, 1.42)};
    definition.crank.compression_ratio = wide(1.01, 100);
    const double scale = wide(0.05, 10);
    for (double* length : {&definition.crank.bore_m, &definition.crank.crank_radius_m, &definition.crank.rod_length_m})
      *length *= scale;
    const auto run = breathing<Real, ByInput>(definition, wide(1e-6, 2e-3), 0);
    run->in.intake_Pa = static_cast<Real>(wide(1e3, 1e7)), run->in.intake_K = static_cast<Real>(wide(150, 3000));
    for (int tick = 0; tick < 300; ++tick) {
      if (tick % 10 == 0) {
        run->in.speed_rad_s = static_cast<Real>(random.between(-3000, 3000));
        run->in.burn_start_deg[0] = static_cast<Real>(random.between(-100, 70));
        run->in.burn_duration_deg[0] = static_cast<Real>(random.between(0, 160));
        run->in.excess_air_ratio[0] = static_cast<Real>(random.coin() ? wide(0.01, 100) : 0);
      }
      const auto& out = run->step();
      const auto& gas = out.cylinder_gas[0];
      ASSERT_TRUE(std::isfinite(gas.pressure_Pa) && gas.pressure_Pa > 0) << trial << " " << tick;
      ASSERT_TRUE(std::isfinite(out.cycle_burn[0].duration_deg)) << trial;
      ASSERT_LE(out.cycle_burn[0].duration_deg, Real{301}) << trial;
      ASSERT_LE(out.gas_cycle[0].fuel_kg, run->engine.state().burn[0].asked_kg + static_cast<Real>(0.0100001)) << trial;
    }
    std::vector<unsigned char> bytes(kSavedStateBytes<Real, ByInput>);  // what a run writes, a load takes
    ASSERT_TRUE(accepted(save_state(run->engine, bytes.data(), bytes.size())));
    ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), run->engine))) << trial;
  }
}

}  // namespace
}  // namespace crankloop::gas_charge_burn_test

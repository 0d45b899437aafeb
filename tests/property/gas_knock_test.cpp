// Knock: its law and facts, an engine against the differential equations, saved states.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/tick/gas/knock.hpp>
#include <crankloop/tick/state/saved_state.hpp>

#include "support/both_reals.hpp"
#include "support/breathing_ode.hpp"
#include "support/gas_engine.hpp"
#include "support/random.hpp"
#include "support/status.hpp"

namespace crankloop::gas_knock_test {
namespace {

using support::Breathing;
using support::BreathingOde;
using support::GasSeen;
using support::kGasB;
using support::kGasR;
using support::knock_delay_s;
using support::kPi;
using support::rad_s;
using tick_test::RealName;

constexpr GasSeen kIn{100e3, 298, 0}, kOut{102e3, 900, 1};

struct Cylinder : support::GivenCylinder {
  static constexpr Combustion combustion = Combustion::by_input;
  static constexpr bool cylinder_cut = true;
  static constexpr bool knock = true;
};
struct Plain : Cylinder {
  static constexpr bool knock = false;
};
struct Four : Cylinder {
  static constexpr Count cylinders = exactly<4>;
};

[[nodiscard]] EngineDefinition with_octane(double octane_number, double fuel_kg = 32e-6) {
  EngineDefinition engine = support::one_of_four_2000();
  engine.gas.fuel_kg = fuel_kg, engine.gas.octane_number = octane_number;
  return engine;
}

template <class Real, class S = Cylinder>
[[nodiscard]] std::unique_ptr<Breathing<Real, S>> breathing(const EngineDefinition& definition, double tick_s,
                                                            double rpm) {
  auto run = support::breathing_between<Real, S>(definition, tick_s, rad_s(rpm), kIn, kOut);
  for (std::size_t k = 0; k < S::cylinders.capacity; ++k) {
    run->in.burn_start_deg[k] = static_cast<Real>(definition.gas.burn_start_deg);
    run->in.burn_duration_deg[k] = static_cast<Real>(definition.gas.burn_duration_deg);
  }
  return run;
}

template <class Real>
class GasKnock : public ::testing::Test {};
TYPED_TEST_SUITE(GasKnock, tick_test::BothReals, RealName);

// ---- the law --------------------------------------------------------------------------------------------------------

TYPED_TEST(GasKnock, HasTheDelaysOfItsLaw) {
  using Real = TypeParam;
  EXPECT_NEAR(knock_delay_s(95, 40 * 101325, 900), 1.9137e-3, 1e-7);
  EXPECT_NEAR(knock_delay_s(95, 20 * 101325, 800), 10.540e-3, 1e-6);
  EXPECT_NEAR(knock_delay_s(80, 30 * 101325, 850), 2.2297e-3, 1e-7);
  for (const double octane : {60.0, 80.0, 95.0, 120.0}) {
    const auto run = breathing<Real>(with_octane(octane), 100e-6, 1000);
    const auto& table = *run->storage.tables().knock;
    EXPECT_EQ(table.in_use, 1u);
    for (double bar = 5; bar < 200; bar *= 1.3) {
      for (double kelvin = 500; kelvin < 1400; kelvin += 50) {
        detail::KnockRecord<Real> knock{};
        knock.pressure_Pa = static_cast<Real>(bar * 1e5), knock.unburned_K = static_cast<Real>(kelvin);
        detail::CylinderBurn<Real> burn{};
        burn.fuel_kg = Real{1}, burn.start_deg = -90, burn.burnt_ratio = static_cast<Real>(0.5);
        EXPECT_TRUE(
            detail::step_knock(knock, table, burn, static_cast<Real>(bar * 1e5), static_cast<Real>(1e-5), {0, 1000}));
        const double exact = 1e-5 / knock_delay_s(octane, bar * 1e5, kelvin);
        EXPECT_NEAR(static_cast<double>(knock.integral_ratio), exact, exact * (sizeof(Real) == 4 ? 1e-5 : 1e-7));
        EXPECT_NEAR(static_cast<double>(knock.unburned_K), kelvin, 1e-12 * kelvin);
      }
    }
  }
}

/// 650 K from 13 to 60 bar of air: exact by a ln T + b T = R ln p + const.
TYPED_TEST(GasKnock, CompressesUnburnedGasWithoutHeat) {
  using Real = TypeParam;
  const auto error_K = [](int steps) {
    detail::KnockRecord<Real> knock{};
    knock.unburned_K = Real{650}, knock.pressure_Pa = Real{1300000};
    for (int i = 1; i <= steps; ++i) {
      const auto to_Pa = static_cast<Real>(13e5 * std::pow(60.0 / 13, static_cast<double>(i) / steps));
      (void)detail::compress_unburned(knock, to_Pa);
      knock.pressure_Pa = to_Pa;
    }
    double exact_K = 900;
    for (int i = 0; i < 50; ++i) {
      const double off =
          (646 + kGasR) * std::log(exact_K / 650) + kGasB * (exact_K - 650) - kGasR * std::log(60.0 / 13);
      exact_K -= off / ((646 + kGasR) / exact_K + kGasB);
    }
    EXPECT_NEAR(exact_K, 969.955, 1e-3);
    return std::fabs(static_cast<double>(knock.unburned_K) - exact_K);
  };
  EXPECT_LT(error_K(20), 0.03);
  EXPECT_LT(error_K(200), sizeof(Real) == 4 ? 5e-3 : 3e-4);
}

/// From leaps of the pressure for which the step would have 8100 K and 55 K.
TYPED_TEST(GasKnock, HoldsUnburnedGasToTemperaturesThatAGasMayHave) {
  using Real = TypeParam;
  struct Leap {
    double from_K, from_Pa, to_Pa, to_K;
  };
  for (const Leap& leap : {Leap{5500, 1e5, 1e12, 6000}, Leap{150, 1e7, 1e-6, 100}}) {
    detail::KnockRecord<Real> knock{};
    knock.unburned_K = static_cast<Real>(leap.from_K), knock.pressure_Pa = static_cast<Real>(leap.from_Pa);
    const Real mean_K = detail::compress_unburned(knock, static_cast<Real>(leap.to_Pa));
    EXPECT_EQ(knock.unburned_K, static_cast<Real>(leap.to_K));
    EXPECT_EQ(mean_K, static_cast<Real>((leap.from_K + leap.to_K) / 2));
  }
}

/// Records of saved states: a burn that has ended adds nothing, and no integral exceeds the limit of its field.
TYPED_TEST(GasKnock, AddsNothingBehindTheBurnsEndAndStaysWithinItsLimit) {
  using Real = TypeParam;
  const auto run = breathing<Real>(with_octane(60), 100e-6, 1000);
  const auto& table = *run->storage.tables().knock;
  const auto real = [](double x) { return static_cast<Real>(x); };
  detail::KnockRecord<Real> knock{};
  knock.pressure_Pa = real(100e5), knock.unburned_K = Real{1200}, knock.integral_ratio = real(0.5);
  knock.burnt_ratio = real(0.97), knock.passes_deg = Real{7};
  detail::CylinderBurn<Real> burn{};
  burn.fuel_kg = Real{1}, burn.start_deg = -90;
  for (const double burnt : {0.97, 0.96}) {
    burn.burnt_ratio = real(burnt);
    EXPECT_FALSE(detail::step_knock(knock, table, burn, real(100e5), real(1e-5), {0, 1000})) << burnt;
    EXPECT_EQ(knock.integral_ratio, real(0.5)) << burnt;
    EXPECT_EQ(knock.passes_deg, Real{7}) << burnt;
  }
  knock.integral_ratio = real(1e6), knock.burnt_ratio = burn.burnt_ratio = real(0.5);
  EXPECT_LT(knock_delay_s(60, 100e5, 1200), 1e-3);
  EXPECT_TRUE(detail::step_knock(knock, table, burn, real(100e5), real(2e-3), {0, 1000}));
  EXPECT_EQ(knock.integral_ratio, real(1e6));
}

/// A saved state may say that a burn goes on whose start is still ahead: the step counts as one in the burn, as a
/// whole, and the place where the integral passes 1 is in it.
TYPED_TEST(GasKnock, CountsAWholeStepWhereItsRecordIsAheadOfTheBurnsStart) {
  using Real = TypeParam;
  const auto run = breathing<Real>(with_octane(95), 100e-6, 1000);
  const auto real = [](double x) { return static_cast<Real>(x); };
  detail::CylinderBurn<Real> burn{};
  burn.fuel_kg = Real{1};
  const double delay_s = knock_delay_s(95, 40e5, 900);
  for (const double start_deg : {0.0, 10.0}) {
    detail::KnockRecord<Real> knock{};
    knock.pressure_Pa = real(40e5), knock.unburned_K = Real{900}, knock.integral_ratio = real(0.9);
    burn.start_deg = real(start_deg);
    const std::int64_t turned = std::int64_t{1} << 56;  // 2.8 deg, up to firing dead centre
    EXPECT_TRUE(
        detail::step_knock(knock, *run->storage.tables().knock, burn, real(40e5), real(delay_s / 4), {0, turned}));
    EXPECT_NEAR(static_cast<double>(knock.integral_ratio), 1.15, 1e-5);
    EXPECT_NEAR(static_cast<double>(knock.passes_deg), -720.0 / 256 * (1 - 0.1 / 0.25), 1e-3);
  }
}

/// The reference by itself: 800 J without mass and ON 95, to the burn's end (another implementation's figures).
TEST(BreathingOde, HasTheFactsOfKnock) {
  constexpr struct { double rpm, integral; } kFacts[] = {{1000, 3.46}, {2000, 1.83}, {4000, 0.99}};
  for (const auto& fact : kFacts) {
    const EngineDefinition definition = with_octane(95);
    BreathingOde exact(definition, rad_s(fact.rpm), kIn, {102e3, 900, 0}, {0, 800});
    const double cycle_s = 120 / fact.rpm;
    exact.run_to((6 - 18.0 / 720) * cycle_s);
    exact.begin_knock();
    exact.run_to((6 + 32.0 / 720) * cycle_s);
    EXPECT_NEAR(exact.knock_integral(), fact.integral, 6e-3) << fact.rpm;
  }
}

// ---- an engine ------------------------------------------------------------------------------------------------------

/// Errors measured, of which at most twice may be reached: of the integral, and of the angle where it passes 1.
struct Accuracy {
  double rpm, tick_s, of_integral, deg;
};
constexpr Accuracy kMeasured[] = {
    {1000, 20e-6, 9.9e-6, 3.8e-4}, {1000, 100e-6, 3.6e-4, 2.6e-3}, {3000, 20e-6, 1.2e-5, 5e-4},
    {3000, 50e-6, 3.3e-4, 6.6e-3}, {3000, 100e-6, 1.9e-3, 3.2e-2}, {6000, 20e-6, 1.8e-4, 1.8e-3},
    {6000, 50e-6, 1.8e-3, 1.5e-3}, {6000, 100e-6, 2.7e-4, 6.8e-3},
};

TYPED_TEST(GasKnock, FollowsItsDifferentialEquations) {
  using Real = TypeParam;
  for (const Accuracy& asked : kMeasured) {
    const EngineDefinition definition = with_octane(75);
    const Gas& gas = definition.gas;
    const auto run = breathing<Real>(definition, asked.tick_s, asked.rpm);
    const auto w = static_cast<double>(run->in.speed_rad_s), cycle_s = 4 * kPi / w;
    BreathingOde exact(definition, w, kIn, kOut, {gas.fuel_kg, 0});
    // Its burned fraction is 0.95 at:
    double s = 0.5;
    for (int i = 0; i < 60; ++i) s -= (support::wiebe(s, gas.wiebe_m) - 0.95) / support::wiebe_slope(s, gas.wiebe_m);
    exact.run_to((2 + gas.burn_start_deg / 720) * cycle_s);
    exact.begin_knock();
    double passes_deg = 0;
    for (double deg = gas.burn_start_deg; deg < gas.burn_start_deg + s * gas.burn_duration_deg;) {
      const double before = exact.knock_integral();
      const double next = std::fmin(deg + 0.05, gas.burn_start_deg + s * gas.burn_duration_deg);
      exact.run_to((2 + next / 720) * cycle_s);
      const double after = exact.knock_integral();
      if (before < 1 && after >= 1) passes_deg = deg + (next - deg) * (1 - before) / (after - before);
      deg = next;
    }
    for (long i = std::lround(2.6 * cycle_s / asked.tick_s); i > 0; --i) ASSERT_EQ(run->step().faults, 0u);
    const double integral = static_cast<double>(run->engine.output().knock_integral[0]);
    const double deg = static_cast<double>(run->engine.output().knock_deg[0]);
    const auto where = ::testing::Message()
                       << asked.rpm << " rpm, " << asked.tick_s << " s, " << integral << " " << deg;
    EXPECT_LT(std::fabs(integral / exact.knock_integral() - 1), 2 * asked.of_integral) << where;
    if (passes_deg == 0) {
      EXPECT_EQ(deg, 0) << where;
    } else {
      EXPECT_LT(std::fabs(deg - passes_deg), 2 * asked.deg) << where;
    }
  }
}

TYPED_TEST(GasKnock, GrowsWithSparkAndFallsWithOctaneAndIsNoneWithoutABurn) {
  using Real = TypeParam;
  const auto knock = [](double octane, double start_deg, bool cut) {
    EngineDefinition definition = with_octane(octane);
    definition.gas.burn_start_deg = start_deg;
    const auto run = breathing<Real>(definition, 100e-6, 2000);
    run->in.cut_cylinders = cut ? 1 : 0;
    for (int tick = 0; tick < 2000; ++tick) (void)run->step();
    return static_cast<double>(run->engine.output().knock_integral[0]);
  };
  const double at_95 = knock(95, -18, false);
  EXPECT_GT(at_95, 0.5);
  EXPECT_GT(knock(95, -28, false), 1.2 * at_95);
  EXPECT_NEAR(knock(80, -18, false), at_95 * std::pow(95.0 / 80, 3.402), 1e-4 * at_95);
  EXPECT_EQ(knock(95, -18, true), 0);
  EXPECT_EQ(knock(0, -18, false), 0);  // no octane number
}

// ---- scenes ---------------------------------------------------------------------------------------------------------

TYPED_TEST(GasKnock, ChangesNoBitOfTheGas) {
  using Real = TypeParam;
  for (const double octane : {0.0, 90.0}) {
    const auto with = breathing<Real>(with_octane(octane), 50e-6, 4000);
    const auto without = breathing<Real, Plain>(with_octane(octane), 50e-6, 4000);
    EXPECT_EQ(with->storage.tables().drive->fingerprint, without->storage.tables().drive->fingerprint);
    for (int tick = 0; tick < 2000; ++tick) {
      const auto& a = with->step();
      const auto& b = without->step();
      ASSERT_EQ(std::memcmp(&a.cylinder_gas[0], &b.cylinder_gas[0], sizeof a.cylinder_gas[0]), 0) << tick;
      ASSERT_EQ(std::memcmp(&a.gas_cycle[0], &b.gas_cycle[0], sizeof a.gas_cycle[0]), 0) << tick;
    }
    EXPECT_EQ(with->engine.output().knock_integral[0] > 0, octane > 0);
  }
}

TEST(GasKnockScene, CostsNoByteOfStateAndOutputWhereItIsNotAskedFor) {
  EXPECT_EQ(sizeof(State<float, Cylinder>) - sizeof(State<float, Plain>), 8 * sizeof(float));
  EXPECT_EQ(sizeof(Output<float, Cylinder>) - sizeof(Output<float, Plain>), 2 * sizeof(float));
}

TYPED_TEST(GasKnock, HasACylinderAbreastAsByItself) {
  using Real = TypeParam;
  EngineDefinition definition = support::four_2000();
  definition.gas.octane_number = 70;
  const auto four = breathing<Real, Four>(definition, 50e-6, 4000);
  std::vector<std::unique_ptr<Breathing<Real, Cylinder>>> each;
  for (std::size_t k = 0; k < 4; ++k) {
    four->in.fuel_kg[k] = static_cast<Real>((20 + 4 * static_cast<double>(k)) * 1e-6);
    four->in.burn_start_deg[k] = static_cast<Real>(-30 + 3 * static_cast<double>(k));
    EngineDefinition one = definition;
    one.layout = {};
    one.layout.cylinders = 1, one.layout.firing_deg[0] = definition.layout.firing_deg[k];
    each.push_back(breathing<Real>(one, 50e-6, 4000));
    each[k]->in.fuel_kg[0] = four->in.fuel_kg[k], each[k]->in.burn_start_deg[0] = four->in.burn_start_deg[k];
  }
  for (int tick = 0; tick < 2400; ++tick) {
    const auto& out = four->step();
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& one = each[k]->step();
      ASSERT_EQ(out.knock_integral[k], one.knock_integral[0]) << tick;
      ASSERT_EQ(out.knock_deg[k], one.knock_deg[0]) << tick;
    }
  }
  EXPECT_GT(four->engine.output().knock_integral[0], Real{1});
  EXPECT_NE(four->engine.output().knock_deg[0], Real{0});
}

TYPED_TEST(GasKnock, GoesOnFromASavedState) {
  using Real = TypeParam;
  const auto run = breathing<Real>(with_octane(80), 50e-6, 4000);
  for (int tick = 0; tick < 1500; ++tick) (void)run->step();
  std::vector<unsigned char> bytes(kSavedStateBytes<Real, Cylinder>);
  for (int at = 0; at < 60; ++at) {
    ASSERT_TRUE(accepted(save_state(run->engine, bytes.data(), bytes.size())));
    const auto other = breathing<Real>(with_octane(80), 50e-6, 4000);
    ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), other->engine)));
    for (int tick = 0; tick < 11; ++tick) (void)run->step(), (void)other->step();
    ASSERT_EQ(std::memcmp(&run->engine.state().knock, &other->engine.state().knock, sizeof run->engine.state().knock),
              0);
  }
  auto state = run->engine.state();
  state.knock_due = 2;
  ASSERT_TRUE(accepted(run->engine.restore(state)));
  ASSERT_TRUE(accepted(save_state(run->engine, bytes.data(), bytes.size())));
  EXPECT_TRUE(
      support::refuses(load_state(bytes.data(), bytes.size(), run->engine), Reason::out_of_range, "state.knock"));
}

TYPED_TEST(GasKnock, StaysANumberWhateverComesIn) {  // CRANKLOOP_LONG_TESTS=1: 20 000 engines
  using Real = TypeParam;
  support::Random random(37);
  const int trials = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 20'000 : 300;
  const auto wide = [&random](double least, double most) {
    return least * std::pow(most / least, random.between(0, 1));
  };
  for (int trial = 0; trial < trials; ++trial) {
    EngineDefinition definition = with_octane(random.between(60, 120), wide(1e-9, 0.01));
    definition.crank.compression_ratio = wide(1.01, 100);
    const double scale = wide(0.05, 10);
    for (double* length : {&definition.crank.bore_m, &definition.crank.crank_radius_m, &definition.crank.rod_length_m})
      *length *= scale;
    const auto run = breathing<Real>(definition, wide(1e-6, 2e-3), 0);
    run->in.intake_Pa = static_cast<Real>(wide(1e3, 1e7)), run->in.intake_K = static_cast<Real>(wide(150, 3000));
    for (int tick = 0; tick < 300; ++tick) {
      if (tick % 10 == 0) run->in.speed_rad_s = static_cast<Real>(random.between(-3000, 3000));
      const auto& out = run->step();
      ASSERT_GE(out.knock_integral[0], Real{0}) << trial << " " << tick;
      ASSERT_LE(out.knock_integral[0], static_cast<Real>(1e6)) << trial << " " << tick;
      ASSERT_GE(out.knock_deg[0], Real{-720}) << trial << " " << tick;
      ASSERT_LE(out.knock_deg[0], Real{720}) << trial << " " << tick;
    }
    std::vector<unsigned char> bytes(kSavedStateBytes<Real, Cylinder>);  // what a run writes, a load takes
    ASSERT_TRUE(accepted(save_state(run->engine, bytes.data(), bytes.size())));
    ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), run->engine))) << trial;
  }
}

}  // namespace
}  // namespace crankloop::gas_knock_test

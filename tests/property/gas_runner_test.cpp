// Runners: against the differential equations in continuous time, closed forms, the books.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/tick/state/saved_state.hpp>

#include "support/both_reals.hpp"
#include "support/breathing_ode.hpp"
#include "support/gas_engine.hpp"
#include "support/random.hpp"
#include "support/status.hpp"

namespace crankloop::gas_runner_test {
namespace {

using support::Breathing;
using support::BreathingOde;
using support::GasSeen;
using support::kGasR;
using support::kPi;
using support::rad_s;
using tick_test::RealName;

constexpr double kSwept_m3 = kPi / 4 * 0.086 * 0.086 * 0.086;
constexpr GasSeen kIn{100e3, 298.15, 0};

struct Cylinder : support::GivenCylinder {
  static constexpr bool crevice = true;
  static constexpr bool runners = true;
};

/// Of the prototype's figures: intake 350 x 38 mm, exhaust 500 x 36 mm, zeta 0.8, crevices and blow-by.
[[nodiscard]] EngineDefinition tuned(double fuel_kg = 0) {
  EngineDefinition engine = support::one_of_four_2000();
  engine.gas.crevice.volume_ratio = 0.015, engine.gas.crevice.blow_by_m2 = 0.1e-6;
  engine.gas.intake_runner = {0.35, 0.038, 0.8};
  engine.gas.exhaust_runner = {0.5, 0.036, 0.8};
  engine.gas.fuel_kg = fuel_kg;
  return engine;
}

template <class Real, class S = Cylinder>
[[nodiscard]] std::unique_ptr<Breathing<Real, S>> breathing(const EngineDefinition& definition, double tick_s,
                                                            double rpm, const GasSeen& exhaust) {
  return support::breathing_between<Real, S>(definition, tick_s, rad_s(rpm), kIn, exhaust);
}

template <class Real>
class GasRunners : public ::testing::Test {};
TYPED_TEST_SUITE(GasRunners, tick_test::BothReals, RealName);

// ---- against the differential equations -----------------------------------------------------------------------------

/// Measured, of which at most twice may be reached: the fourth cycle from rest.
struct Accuracy {
  double rpm, fuel_kg;
  double of_peak[3];  ///< largest error of the pressure, at 20, 50 and 100 us
  double port_Pa[3];  ///< of that at the intake port
};
constexpr double kTicks_s[] = {20e-6, 50e-6, 100e-6};
constexpr Accuracy kMeasured[] = {
    {800, 0, {1.7e-5, 2.8e-5, 4.3e-5}, {7, 41, 165}},         {800, 20e-6, {3.1e-5, 7.9e-5, 1.5e-4}, {61, 153, 308}},
    {1300, 0, {8.1e-5, 7e-5, 1.6e-4}, {16, 103, 456}},        {1300, 20e-6, {2.8e-5, 6.2e-5, 1.2e-4}, {31, 108, 440}},
    {3000, 0, {1.3e-4, 1.3e-4, 3.2e-4}, {33, 82, 641}},       {3000, 20e-6, {8.4e-5, 1.7e-4, 1.9e-4}, {30, 150, 640}},
    {6000, 20e-6, {1.7e-4, 3.8e-4, 7.0e-4}, {125, 218, 451}},
};

TYPED_TEST(GasRunners, FollowTheirDifferentialEquations) {
  using Real = TypeParam;
  for (const Accuracy& asked : kMeasured) {
    const EngineDefinition definition = tuned(asked.fuel_kg);
    const GasSeen exhaust{102e3, asked.fuel_kg > 0 ? 900.0 : 320.0, 1};
    for (std::size_t at = 0; at < 3; ++at) {
      const double tick_s = kTicks_s[at];
      const auto run = breathing<Real>(definition, tick_s, asked.rpm, exhaust);
      BreathingOde exact(definition, static_cast<double>(run->in.speed_rad_s), kIn, exhaust, {asked.fuel_kg, 0});
      double peak_Pa = 0, worst_Pa = 0, port_Pa = 0, in_kg = 0, exact_kg = 0;
      const long ticks = std::lround(4 * 120 / asked.rpm / tick_s);
      for (long i = 1; i <= ticks; ++i) {
        const auto& out = run->step();
        exact.run_to(static_cast<double>(i) * tick_s);
        ASSERT_EQ(out.faults, 0u);
        const double exact_Pa = exact.cylinder().p;
        peak_Pa = std::fmax(peak_Pa, exact_Pa);
        if (i <= ticks / 4 * 3) {
          exact_kg = exact.intake_kg();
          continue;
        }
        const auto off = [](Real x, double exactly) { return std::fabs(static_cast<double>(x) - exactly); };
        worst_Pa = std::fmax(worst_Pa, off(out.cylinder_gas[0].pressure_Pa, exact_Pa));
        port_Pa = std::fmax(port_Pa, off(out.runner[0].port_pressure_Pa[kIntake], exact.port(0).p));
        in_kg += static_cast<double>(out.cylinder_gas[0].flow_kg_s[kIntake]) * tick_s;
      }
      exact_kg = exact.intake_kg() - exact_kg;
      const auto where = ::testing::Message() << asked.rpm << " rpm, " << asked.fuel_kg << " kg, " << tick_s << " s";
      EXPECT_LT(worst_Pa / peak_Pa, 2 * asked.of_peak[at]) << where;
      EXPECT_LT(port_Pa, 2 * asked.port_Pa[at]) << where;
      EXPECT_NEAR(in_kg, exact_kg, 1e-3 * exact_kg) << where;
    }
  }
}

// ---- closed forms ---------------------------------------------------------------------------------------------------

/// A pipe of one runner shut at its port swings as a quarter wave, f = a / (4 l).
struct Swing {
  double length_m, tick_s;
  double frequency, decay;  ///< over a / (4 l), and of the swing per period, as a prototype has them
};
constexpr Swing kSwings[] = {{0.3, 20e-6, 0.9998, 0.9998},
                             {0.3, 50e-6, 0.9992, 0.9994},
                             {0.3, 100e-6, 0.9972, 0.997},
                             {0.3, 500e-6, 0.936, 0.73},
                             {0.1, 100e-6, 0.976, 0.925}};

TYPED_TEST(GasRunners, SwingAsAQuarterWaveWhereTheValveIsShut) {
  using Real = TypeParam;
  for (const Swing& swing : kSwings) {
    EngineDefinition definition = support::sealed(support::one_of_four_2000());
    definition.gas.intake_runner = {swing.length_m, 0.035, 0};
    const auto run = breathing<Real>(definition, swing.tick_s, 0, GasSeen{102e3, 320, 1});
    for (int i = 0; i < 3; ++i) (void)run->step();
    auto state = run->engine.state();
    auto& runner = state.runner[kIntake][0];
    const double kelvin = 298.15, volume_m3 = 4 / (kPi * kPi) * definition.gas.intake_runner.volume_m3();
    runner.contents = detail::contents_of(static_cast<Real>(100.1e3), static_cast<Real>(kelvin), Real{0},
                                          static_cast<Real>(volume_m3));
    runner.point = detail::point_of(runner.contents, static_cast<Real>(1 / volume_m3));
    runner.flow_kg_s = runner.flow_rest_kg_s = Real{0};
    ASSERT_TRUE(accepted(run->engine.restore(state)));
    const double sound_m_s = std::sqrt(kGasR * kelvin * (1 + kGasR / (support::gas_a(0) + support::kGasB * kelvin)));
    std::vector<double> crossings, peaks;
    double before_Pa = 100, peak_Pa = 0;
    for (int i = 1; crossings.size() < 21 && i < 100'000; ++i) {
      const double now_Pa = static_cast<double>(run->step().runner[0].port_pressure_Pa[kIntake]) - 100e3;
      peak_Pa = std::fmax(peak_Pa, std::fabs(now_Pa));
      if (now_Pa * before_Pa < 0) {
        crossings.push_back((i - now_Pa / (now_Pa - before_Pa)) * swing.tick_s);
        peaks.push_back(peak_Pa), peak_Pa = 0;
      }
      before_Pa = now_Pa;
    }
    ASSERT_EQ(crossings.size(), 21u);
    const double hertz = 10 / (crossings.back() - crossings.front());
    const double decay = std::pow(peaks.back() / peaks[2], 2.0 / static_cast<double>(peaks.size() - 3));
    EXPECT_NEAR(hertz / (sound_m_s / (4 * swing.length_m)), swing.frequency, 1e-3) << swing.length_m << swing.tick_s;
    EXPECT_NEAR(decay, swing.decay, 0.012) << swing.length_m << swing.tick_s;
  }
}

/// What a lump of 4/pi^2 of the pipe does to the frequency of a pipe with a volume behind it, kl tan(kl) = A l / V.
TEST(RunnerLump, HasTheFirstFrequencyOfThePipeWithinThreePercent) {
  const double kShare = 4 / (kPi * kPi);
  for (const double ratio : {0.001, 0.1, 0.5, 1.0, 2.0, 5.0, 50.0}) {  // V / (A l)
    double low = 0, high = kPi / 2;
    for (int i = 0; i < 200; ++i) {
      const double middle = (low + high) / 2;
      (middle * std::sin(middle) * ratio > std::cos(middle) ? high : low) = middle;
    }
    const double lump = std::sqrt(1 / (ratio + kShare));
    EXPECT_LT(lump, low * 1.0001) << ratio;
    EXPECT_GT(lump, low * 0.975) << ratio;
  }
}

/// Charge over speed of three intake runners, fired, from another implementation of the same lump: its highest charge
/// and where (a pipe of 12 cells has 1.023 at 5200, 1.087 at 4800, 1.125 at 3800 rpm).
struct Hump {
  double length_m, diameter_m, charge, rpm;
};
constexpr Hump kHumps[] = {{0.25, 0.038, 1.031, 5200}, {0.4, 0.038, 1.094, 4800}, {0.6, 0.036, 1.137, 3800}};

TEST(GasRunnersOfFloat, FillTheCylinderBestWhereTheyAreTuned) {
  for (const Hump& hump : kHumps) {
    EngineDefinition definition = tuned(19.2e-6);
    definition.gas.intake_runner = {hump.length_m, hump.diameter_m, 0.8};
    definition.gas.exhaust_runner = {};
    double best = 0, best_rpm = 0;
    for (double rpm = hump.rpm - 800; rpm <= hump.rpm + 800; rpm += 200) {
      const auto run = breathing<float>(definition, 50e-6, rpm, GasSeen{102e3, 900, 1});
      for (long i = std::lround(9 * 120 / rpm / 50e-6); i > 0; --i) (void)run->step();
      const double charge = static_cast<double>(run->engine.output().gas_cycle[0].volumetric_efficiency);
      if (charge > best) best = charge, best_rpm = rpm;
    }
    EXPECT_NEAR(best, hump.charge, 0.01) << hump.length_m;
    EXPECT_NEAR(best_rpm, hump.rpm, 200) << hump.length_m;
  }
}

/// Of 20 mm without loss a runner does next to nothing.
TEST(GasRunnersOfFloat, ChangeLittleWhereTheyAreShort) {
  const struct {
    double rpm, without, by;
  } cases[] = {{1000, 0.8925, -0.004}, {3000, 0.9239, -0.003}, {6000, 0.9127, 0.005}};
  for (const auto& at : cases) {
    const auto charge = [&](bool runner) {
      EngineDefinition definition = tuned(19.2e-6);
      definition.gas.exhaust_runner = {};
      definition.gas.intake_runner = runner ? Runner{0.02, 0.038, 0} : Runner{};
      const auto run = breathing<float>(definition, 20e-6, at.rpm, GasSeen{102e3, 900, 1});
      for (long i = std::lround(9 * 120 / at.rpm / 20e-6); i > 0; --i) (void)run->step();
      return static_cast<double>(run->engine.output().gas_cycle[0].volumetric_efficiency);
    };
    const double without = charge(false);
    EXPECT_NEAR(without, at.without, 0.01) << at.rpm;
    EXPECT_NEAR(charge(true) / without - 1, at.by, 0.004) << at.rpm;
  }
}

// ---- books ----------------------------------------------------------------------------------------------------------

struct Four : Cylinder {
  static constexpr Count cylinders = exactly<4>;
  static constexpr Manifold manifold = Manifold::throttle;
};

[[nodiscard]] EngineDefinition tuned_four() {
  EngineDefinition engine = support::four_2000();
  engine.gas = tuned(30e-6).gas;
  return engine;
}

TYPED_TEST(GasRunners, KeepTheirBooks) {
  using Real = TypeParam;
  constexpr double kTick_s = 0x1p-15;  // 31 us: then a mean flow over the tick has the very bits of the mass
  const auto run = std::make_unique<Breathing<Real, Four>>(tuned_four(), kTick_s);
  const auto held_kg = [&run] {
    const auto& state = run->engine.state();
    double kg = 0;
    const auto add = [&kg](Real x, Real rest) { kg += static_cast<double>(x) + static_cast<double>(rest); };
    for (std::size_t k = 0; k < 4; ++k) {
      add(state.cylinder_gas.mass_kg[k], state.cylinder_gas.mass_rest_kg[k]);
      add(state.crevice_gas.mass_kg[k], Real{0});
      for (const auto& of_port : state.runner) add(of_port[k].contents.mass_kg, of_port[k].contents.mass_rest_kg);
    }
    for (const auto& manifold : state.manifold) add(manifold.contents.mass_kg, manifold.contents.mass_rest_kg);
    return kg;
  };
  const double before_kg = held_kg();
  double came_kg = 0, flowed_kg = 0, fuel_kg = 0, heat_J = 0, defect_J = 0;
  Real last_Pa[4] = {};
  double last_fuel_kg[4] = {};
  for (int tick = 0; tick < 200'000; ++tick) {
    run->in.speed_rad_s = static_cast<Real>(rad_s(tick % 50'000 < 1000 ? -300 : 2500 + 2000 * std::sin(tick * 1e-4)));
    run->in.throttle_ratio = static_cast<Real>(0.25 * (tick / 20'000 % 5));
    const auto& out = run->step();
    ASSERT_EQ(out.faults, 0u) << tick;
    const double in_kg = static_cast<double>(out.throttle_kg_s) * kTick_s;
    came_kg += in_kg - static_cast<double>(out.outlet_kg_s) * kTick_s, flowed_kg += std::fabs(in_kg);
    for (std::size_t k = 0; k < 4; ++k) {
      came_kg -= static_cast<double>(out.crevice[k].blow_by_kg_s) * kTick_s;
      const double burnt_kg = static_cast<double>(run->engine.state().gas_record[k].fuel_kg);
      fuel_kg += std::fmax(0, burnt_kg - last_fuel_kg[k]), last_fuel_kg[k] = burnt_kg;
      const auto& cycle = out.gas_cycle[k];
      if (cycle.net_mep_Pa == last_Pa[k]) continue;
      last_Pa[k] = cycle.net_mep_Pa;
      heat_J += static_cast<double>(cycle.heat_J);
      defect_J += std::fabs(static_cast<double>(cycle.energy_defect_J));
    }
  }
  const bool single = sizeof(Real) == 4;
  EXPECT_GT(flowed_kg, 0.1);
  EXPECT_NEAR(held_kg() - before_kg, came_kg + fuel_kg, flowed_kg * (single ? 1e-7 : 1e-13));
  EXPECT_LT(defect_J, heat_J * (single ? 1e-8 : 1e-13));
}

/// Nothing burns, no wall takes heat, next to nothing comes from outside: what the pistons do is what the gas loses.
TYPED_TEST(GasRunners, LoseNoEnergyToNowhere) {
  using Real = TypeParam;
  EngineDefinition definition = tuned_four();
  definition.gas.crevice.volume_ratio = definition.gas.crevice.blow_by_m2 = 0;
  definition.gas.wall_heat_ratio = 0, definition.gas.fuel_kg = 0;
  definition.gas.throttle_m2 = definition.gas.throttle_closed_m2 = definition.gas.outlet_m2 = 1e-9;
  const auto run = std::make_unique<Breathing<Real, Four>>(definition, 50e-6);
  run->in.speed_rad_s = static_cast<Real>(rad_s(2500));
  const auto held_J = [&run] {
    const auto& state = run->engine.state();
    double J = 0;
    const auto add = [&J](Real x, Real rest) { J += static_cast<double>(x) + static_cast<double>(rest); };
    for (std::size_t k = 0; k < 4; ++k) {
      add(state.cylinder_gas.energy_J[k], state.cylinder_gas.energy_rest_J[k]);
      for (const auto& of_port : state.runner) add(of_port[k].contents.energy_J, of_port[k].contents.energy_rest_J);
    }
    for (const auto& manifold : state.manifold) add(manifold.contents.energy_J, manifold.contents.energy_rest_J);
    return J;
  };
  // By each cylinder's work of a tick: that of its record, which a cycle's end puts to 0 after it was shown.
  double work_J = 0, largest_J = 0, last_J[4] = {};
  Real last_Pa[4] = {};
  double begin_J = 0;
  for (int tick = 0; tick < 4000; ++tick) {
    const auto& out = run->step();
    ASSERT_EQ(out.faults, 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      const double now_J = static_cast<double>(run->engine.state().gas_record[k].work_J);
      const Real mep_Pa = out.gas_cycle[k].net_mep_Pa;
      work_J += now_J - last_J[k];
      if (mep_Pa != last_Pa[k]) work_J += static_cast<double>(mep_Pa) * kSwept_m3;
      last_J[k] = now_J, last_Pa[k] = mep_Pa;
    }
    const double in_J = static_cast<double>(out.throttle_kg_s) * 50e-6 * support::gas_enthalpy(298.15, 0);
    const double exhaust_K = static_cast<double>(out.manifold[kExhaust].temperature_K);
    work_J += static_cast<double>(out.outlet_kg_s) * 50e-6 * support::gas_enthalpy(exhaust_K, 0) - in_J;
    if (tick == 1000) begin_J = held_J(), work_J = 0;  // by now each has a record from a cycle's begin
    largest_J = std::fmax(largest_J, std::fabs(work_J));
  }
  EXPECT_GT(largest_J, 100);
  EXPECT_NEAR(begin_J - held_J(), work_J, sizeof(Real) == 4 ? 5e-3 : 1e-4);
}

// ---- scenes ---------------------------------------------------------------------------------------------------------

struct Plain : Cylinder {
  static constexpr bool runners = false;
};

TYPED_TEST(GasRunners, ChangeNoBitWhereTheEngineHasNone) {
  using Real = TypeParam;
  EngineDefinition definition = tuned(30e-6);
  definition.gas.intake_runner = definition.gas.exhaust_runner = {};
  const auto with = breathing<Real>(definition, 50e-6, 4000, GasSeen{102e3, 900, 1});
  const auto without = breathing<Real, Plain>(definition, 50e-6, 4000, GasSeen{102e3, 900, 1});
  EXPECT_EQ(with->storage.tables().drive->fingerprint, without->storage.tables().drive->fingerprint);
  for (int tick = 0; tick < 2000; ++tick) {
    const auto& a = with->step();
    const auto& b = without->step();
    ASSERT_EQ(std::memcmp(&a.cylinder_gas[0], &b.cylinder_gas[0], sizeof a.cylinder_gas[0]), 0) << tick;
    ASSERT_EQ(std::memcmp(&a.gas_cycle[0], &b.gas_cycle[0], sizeof a.gas_cycle[0]), 0) << tick;
    ASSERT_EQ(a.runner[0].flow_kg_s[kIntake], Real{0});
  }
}

TEST(GasRunnerScene, IsDemandedByADefinitionThatHasOne) {
  for (int port = 0; port < kPorts; ++port) {
    EngineDefinition definition = tuned();
    (port == kIntake ? definition.gas.exhaust_runner : definition.gas.intake_runner) = {};
    TableStorage<float, Plain> storage;
    ASSERT_TRUE(accepted(storage.build(definition, {100e-6, {}})));
    Engine<float, Plain> engine;
    EXPECT_TRUE(support::refuses(engine.init(storage.tables()), Reason::inconsistent, "scene.runners"));
  }
}

struct FourGiven : Cylinder {
  static constexpr Count cylinders = exactly<4>;
};

TYPED_TEST(GasRunners, HaveACylinderAbreastAsByItself) {  // in float four go abreast where the processor can
  using Real = TypeParam;
  const auto four = breathing<Real, FourGiven>(tuned_four(), 100e-6, 3500, GasSeen{102e3, 900, 1});
  const auto one = breathing<Real>(tuned(30e-6), 100e-6, 3500, GasSeen{102e3, 900, 1});
  for (int tick = 0; tick < 1500; ++tick) {
    const auto& a = four->step();
    const auto& b = one->step();
    ASSERT_EQ(std::memcmp(&a.cylinder_gas[0], &b.cylinder_gas[0], sizeof a.cylinder_gas[0]), 0) << tick;
    ASSERT_EQ(std::memcmp(&a.runner[0], &b.runner[0], sizeof a.runner[0]), 0) << tick;
    ASSERT_EQ(std::memcmp(&a.gas_cycle[0], &b.gas_cycle[0], sizeof a.gas_cycle[0]), 0) << tick;
  }
}

TYPED_TEST(GasRunners, GoOnFromTheirSavedState) {
  using Real = TypeParam;
  const auto run = std::make_unique<Breathing<Real, Four>>(tuned_four(), 50e-6);
  run->in.speed_rad_s = static_cast<Real>(rad_s(2500));
  for (int tick = 0; tick < 1950; ++tick) (void)run->step();
  std::vector<unsigned char> bytes(kSavedStateBytes<Real, Four>);
  ASSERT_TRUE(accepted(save_state(run->engine, bytes.data(), bytes.size())));
  const auto other = std::make_unique<Breathing<Real, Four>>(tuned_four(), 50e-6);
  other->in.speed_rad_s = run->in.speed_rad_s;
  ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), other->engine)));
  for (int tick = 0; tick < 1000; ++tick) {
    const auto& a = run->step();
    const auto& b = other->step();
    ASSERT_EQ(std::memcmp(&a.runner, &b.runner, sizeof a.runner), 0) << tick;
    ASSERT_EQ(std::memcmp(&a.cylinder_gas, &b.cylinder_gas, sizeof a.cylinder_gas), 0) << tick;
  }
  auto forged = run->engine.state();
  forged.runner[kExhaust][2].contents.mass_kg *= 2;
  ASSERT_TRUE(accepted(other->engine.restore(forged)));
  ASSERT_TRUE(accepted(save_state(other->engine, bytes.data(), bytes.size())));
  EXPECT_TRUE(support::refuses(load_state(bytes.data(), bytes.size(), run->engine), Reason::inconsistent, "state.gas"));
}

TYPED_TEST(GasRunners, StandStillAtEqualPressures) {
  using Real = TypeParam;
  EngineDefinition definition = tuned_four();
  definition.gas.crevice.volume_ratio = definition.gas.crevice.blow_by_m2 = 0;
  definition.gas.wall_heat_ratio = 0;
  const auto run = std::make_unique<Breathing<Real, Four>>(definition, 100e-6);
  for (int tick = 0; tick < 100'000; ++tick) {
    const auto& out = run->step();
    for (const auto& runner : out.runner) {
      for (const Real pressure_Pa : runner.port_pressure_Pa)
        ASSERT_NEAR(static_cast<double>(pressure_Pa), 100e3, 0.1) << tick;
      for (const Real flow : runner.flow_kg_s) ASSERT_NEAR(static_cast<double>(flow), 0, 1e-6) << tick;
    }
  }
}

struct Measured : support::MeasuredCylinder {
  static constexpr Manifold manifold = Manifold::throttle;
  static constexpr bool runners = true;
};

/// Where a measured crank jumps, runners are filled anew as their manifolds are, and nothing moves in them.
TYPED_TEST(GasRunners, AreFilledAnewAndAtRestWhereTheCrankJumps) {
  using Real = TypeParam;
  EngineDefinition definition = tuned();
  definition.gas.crevice.volume_ratio = definition.gas.crevice.blow_by_m2 = 0;
  const auto run = std::make_unique<Breathing<Real, Measured>>(definition, 100e-6);
  run->in.throttle_ratio = static_cast<Real>(0.3);
  const auto to = [&run](double deg) -> const auto& {
    run->in.crank = tick_test::phase_at_deg(static_cast<long double>(deg));
    return run->step();
  };
  double deg = 0;
  (void)to(deg);
  for (int tick = 0; tick < 1190; ++tick) ASSERT_EQ(to(deg += 2).faults, 0u) << tick;
  const auto& out = run->engine.output();
  for (int port = 0; port < kPorts; ++port)
    EXPECT_GT(std::fabs(out.runner[0].flow_kg_s[port]), static_cast<Real>(1e-4)) << port;
  EXPECT_EQ(to(deg + 200).faults, std::uint32_t{kFaultPhaseJump});
  for (int port = 0; port < kPorts; ++port) {
    EXPECT_EQ(out.runner[0].flow_kg_s[port], Real{0});
    EXPECT_EQ(out.runner[0].port_pressure_Pa[port], run->engine.state().manifold[port].point.pressure_Pa);
    EXPECT_NEAR(static_cast<double>(out.runner[0].port_pressure_Pa[port] / out.manifold[port].pressure_Pa), 1, 1e-2);
  }
}

/// Manifolds of any size behind runners settle.
TYPED_TEST(GasRunners, SettleWithManifoldsOfAnySize) {
  using Real = TypeParam;
  for (const double volume_m3 : {3e-3, 1e-3, 5e-4, 2e-4}) {
    EngineDefinition definition = tuned_four();
    definition.gas.intake_m3 = definition.gas.exhaust_m3 = volume_m3;
    definition.gas.wall_heat_ratio = 0, definition.gas.fuel_kg = 0;
    definition.gas.crevice.volume_ratio = definition.gas.crevice.blow_by_m2 = 0;
    const auto run = std::make_unique<Breathing<Real, Four>>(definition, 100e-6);
    run->in.speed_rad_s = static_cast<Real>(rad_s(3000));
    for (int tick = 0; tick < 3000; ++tick) {
      const auto& out = run->step();
      ASSERT_EQ(out.faults, 0u) << volume_m3 << " " << tick;
    }
    run->in.speed_rad_s = Real{0};
    double largest_Pa[2] =
        {};  // off ambient pressure within the first tenth of a second, and the last: damped by the square of the flow
    for (int tick = 0; tick < 20'000; ++tick) {
      const auto& out = run->step();
      for (const auto& runner : out.runner) {
        for (const Real pressure_Pa : runner.port_pressure_Pa) {
          const double off_Pa = std::fabs(static_cast<double>(pressure_Pa) - 100e3);
          if (tick < 1000) largest_Pa[0] = std::fmax(largest_Pa[0], off_Pa);
          if (tick >= 19'000) largest_Pa[1] = std::fmax(largest_Pa[1], off_Pa);
        }
      }
    }
    EXPECT_LT(largest_Pa[1], 0.15 * largest_Pa[0]) << volume_m3;  // runners of several ports against one another
  }
}

/// Any engine, any input: a number comes out.
TYPED_TEST(GasRunners, StayNumbersWhateverComesIn) {  // CRANKLOOP_LONG_TESTS=1: 20 000 engines
  using Real = TypeParam;
  support::Random random(3411);
  const int trials = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 20'000 : 200;
  const auto wide = [&random](double least, double most) {
    return least * std::pow(most / least, random.between(0, 1));
  };
  const auto runner = [&] { return Runner{wide(0.02, 3), wide(0.005, 0.2), random.coin() ? 0 : wide(0.01, 10)}; };
  for (int trial = 0; trial < trials; ++trial) {
    EngineDefinition definition = tuned_four();
    Gas& gas = definition.gas;
    gas.crevice.volume_ratio = random.coin() ? wide(1e-6, 0.1) : 0,
    gas.crevice.blow_by_m2 = random.coin() ? wide(1e-12, 5e-6) : 0;
    gas.fuel_kg = random.coin() ? wide(1e-9, 0.01) : 0;
    if (random.coin()) gas.intake_runner = runner();
    gas.exhaust_runner = random.coin() ? runner() : Runner{};
    gas.intake_m3 = wide(3e-4, 100), gas.exhaust_m3 = wide(3e-4, 100);
    gas.ambient_Pa = wide(1e3, 1e7), gas.back_Pa = wide(1e3, 1e7), gas.ambient_K = wide(150, 3000);
    definition.crank.compression_ratio = wide(1.01, 100);
    const double scale = wide(0.05, 3);
    for (double* length : {&definition.crank.bore_m, &definition.crank.crank_radius_m, &definition.crank.rod_length_m})
      *length *= scale;
    const auto run = std::make_unique<Breathing<Real, Four>>(definition, wide(1e-6, 1e-3));
    for (int tick = 0; tick < 300; ++tick) {
      if (tick % 10 == 0) run->in.speed_rad_s = static_cast<Real>(random.between(-1000, 1000));
      run->in.throttle_ratio = static_cast<Real>(random.between(0, 1));
      const auto& out = run->step();
      for (std::size_t k = 0; k < 4; ++k) {
        ASSERT_TRUE(std::isfinite(out.cylinder_gas[k].pressure_Pa) && out.cylinder_gas[k].pressure_Pa > 0)
            << trial << " " << tick;
        for (int port = 0; port < kPorts; ++port) {
          ASSERT_TRUE(std::isfinite(out.runner[k].port_pressure_Pa[port]) && out.runner[k].port_pressure_Pa[port] > 0)
              << trial << " " << tick;
          ASSERT_TRUE(std::isfinite(out.runner[k].flow_kg_s[port])) << trial << " " << tick;
        }
      }
    }
    std::vector<unsigned char> bytes(kSavedStateBytes<Real, Four>);  // what a run writes, a load takes
    ASSERT_TRUE(accepted(save_state(run->engine, bytes.data(), bytes.size())));
    ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), run->engine))) << trial;
  }
}

}  // namespace
}  // namespace crankloop::gas_runner_test

// Walls that warm up, heat of manifolds and runners: closed forms, the differential equations, the books.
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

namespace crankloop::gas_walls_test {
namespace {

using support::Breathing;
using support::BreathingOde;
using support::GasSeen;
using support::kPi;
using support::rad_s;
using tick_test::RealName;

constexpr GasSeen kIn{100e3, 298, 0}, kOut{102e3, 900, 1};

/// Everything of gas.
struct Cylinder : support::GivenCylinder {
  static constexpr bool crevice = true;
  static constexpr bool runners = true;
  static constexpr bool walls = true;
  static constexpr bool charge_burn = true;
  static constexpr bool knock = true;
};
struct Plain : Cylinder {
  static constexpr bool walls = false;
};
struct Throttled : Cylinder {
  static constexpr Manifold manifold = Manifold::throttle;
};
struct Four : Cylinder {
  static constexpr Count cylinders = exactly<4>;
};

[[nodiscard]] EngineDefinition with_walls(const Walls& walls, double fuel_kg = 0) {
  EngineDefinition engine = support::one_of_four_2000();
  engine.gas.fuel_kg = fuel_kg, engine.gas.walls = walls;
  return engine;
}
/// With crevices, blow-by and runners.
[[nodiscard]] EngineDefinition with_everything(const Walls& walls, double fuel_kg) {
  EngineDefinition engine = with_walls(walls, fuel_kg);
  engine.gas.crevice = {0.015, 0.1e-6};
  engine.gas.intake_runner = {0.35, 0.038, 0.8}, engine.gas.exhaust_runner = {0.5, 0.036, 0.8};
  engine.gas.octane_number = 95;
  return engine;
}

template <class Real, class S = Cylinder>
[[nodiscard]] std::unique_ptr<Breathing<Real, S>> breathing(const EngineDefinition& definition, double tick_s,
                                                            double rpm, const GasSeen& exhaust = kOut) {
  if constexpr (detail::Needs<S>::given_gas) {
    return support::breathing_between<Real, S>(definition, tick_s, rad_s(rpm), kIn, exhaust);
  } else {
    auto run = std::make_unique<Breathing<Real, S>>(definition, tick_s);
    run->in.speed_rad_s = static_cast<Real>(rad_s(rpm)), run->in.throttle_ratio = Real{1};
    return run;
  }
}
template <class Real>
[[nodiscard]] double wide(Real x) {
  return static_cast<double>(x);
}
/// Of the first cylinder's walls.
template <class Run>
[[nodiscard]] double wall_K(const Run& run) {
  return wide(run.engine.state().wall_K[0]);
}
/// That they have and that their temperature does not show yet.
template <class Run>
[[nodiscard]] double waiting_J(const Run& run) {
  return wide(run.engine.state().wall_heat_J[0]);
}

template <class Real>
class GasWarmWalls : public ::testing::Test {};
TYPED_TEST_SUITE(GasWarmWalls, tick_test::BothReals, RealName);

// ---- closed forms ---------------------------------------------------------------------------------------------------

/// 1500 J/K, 20 W/K, 2000 W from 350 K on to a coolant of 90 C: exp(-t / 75 s) to 463.15 K.
TYPED_TEST(GasWarmWalls, WarmUpInTheirOwnTime) {
  using Real = TypeParam;
  const auto warmed_K = [](double tick_s, double time_s) {
    detail::WarmWallsTable<Real> table{};
    table.capacity_J_K = Real{1500}, table.to_coolant_W_K = Real{20}, table.coolant_K = static_cast<Real>(363.15);
    Real kelvin{350}, heat_J{};
    for (long i = std::lround(time_s / tick_s); i > 0; --i) {
      heat_J += static_cast<Real>(2000 * tick_s);
      EXPECT_TRUE(detail::step_walls<Real>(kelvin, heat_J, table, Real{0}, static_cast<Real>(tick_s)));
    }
    return wide(kelvin);
  };
  EXPECT_NEAR(463.15 - 113.15 * std::exp(-200.0 / 75), 455.288, 1e-3);
  EXPECT_NEAR(warmed_K(1e-3, 200), 455.288, 1e-3);
  EXPECT_NEAR(warmed_K(20e-6, 75), 463.15 - 113.15 * std::exp(-1.0), 1e-3);  // 3e-5 K a tick
  EXPECT_NEAR(warmed_K(1e-3, 1500), 463.15, 1e-3);
  EXPECT_NEAR(warmed_K(1000, 1e6), 463.15, 1e-3);  // bounded for any step
}

/// A closed engine at standstill: gas and walls come to the coolant's temperature.
TYPED_TEST(GasWarmWalls, ComeToTheCoolantsTemperature) {
  using Real = TypeParam;
  EngineDefinition definition = support::sealed(with_walls({20, 5, 350, 0, 0, 0}));
  definition.gas.wall_heat_ratio = 3, definition.gas.wall_K = 450;
  const auto run = breathing<Real>(definition, 1e-3, 0);
  double last_K = 450;
  for (int second = 0; second < 80; ++second) {
    for (int tick = 0; tick < 1000; ++tick) ASSERT_EQ(run->step().faults, 0u);
    ASSERT_LE(wall_K(*run), last_K + 1e-3);
    last_K = wall_K(*run);
  }
  EXPECT_NEAR(last_K, 350, 2e-3);
  EXPECT_NEAR(wide(run->engine.output().cylinder_gas[0].temperature_K), 350, 0.1);
}

TYPED_TEST(GasWarmWalls, TakeTheHeatOfAPort) {
  using Real = TypeParam;
  const auto after_K = [](double from_K, double to_K, double wall_W_K, double step_s, int steps) {
    const auto per_volume_m3 = static_cast<Real>(1 / 200e-6);
    auto gas = detail::contents_of(Real{100000}, static_cast<Real>(from_K), Real{0}, Real{1} / per_volume_m3);
    auto point = detail::point_of(gas, per_volume_m3);
    for (int i = 0; i < steps; ++i)
      (void)detail::lose_heat(gas, point, per_volume_m3, static_cast<Real>(wall_W_K), static_cast<Real>(to_K),
                              static_cast<Real>(step_s));
    return wide(point.temperature_K);
  };
  // m (a + b T) dT/dt = -g (T - T_a), in small steps by the midpoint rule.
  const double kg = 100e3 * 200e-6 / (support::kGasR * 800);
  const auto slope = [kg](double k) { return -3 / (kg * (646 + support::kGasB * k)) * (k - 300); };
  double exact_K = 800;
  for (int i = 0; i < 20'000; ++i) exact_K += 1e-6 * slope(exact_K + 0.5e-6 * slope(exact_K));
  EXPECT_NEAR(after_K(800, 300, 3, 20e-6, 1000), exact_K, 0.2);
  EXPECT_NEAR(after_K(800, 300, 3, 200e-6, 100), exact_K, 2);
  EXPECT_NEAR(after_K(800, 300, 1e5, 10, 1), 300, 0.01);
  EXPECT_NEAR(after_K(280, 400, 1e5, 10, 1), 400, 0.01);  // hot walls warm a cold charge
  EXPECT_NEAR(after_K(400, 400, 10, 1e-3, 100), 400, 1e-3);
}

// ---- against the differential equations -----------------------------------------------------------------------------

/// Measured, of which at most twice may be reached: the pressure's largest error over the peak, that of the walls'
/// temperature; in the fourth cycle from rest, 20 J/K.
struct Accuracy {
  double rpm, tick_s, of_peak, wall_K;
};
constexpr Accuracy kMeasured[] = {
    {1300, 20e-6, 1.2e-4, 0.03}, {1300, 50e-6, 3.0e-4, 0.03},  {3000, 20e-6, 4.3e-5, 0.02},
    {3000, 50e-6, 1.0e-4, 0.02}, {3000, 100e-6, 1.9e-4, 0.02}, {6000, 20e-6, 1.9e-4, 0.03},
    {6000, 50e-6, 4.3e-4, 0.03}, {6000, 100e-6, 8.0e-4, 0.03},
};

TYPED_TEST(GasWarmWalls, FollowTheirDifferentialEquations) {
  using Real = TypeParam;
  for (const Accuracy& asked : kMeasured) {
    const EngineDefinition definition = with_everything({20, 5, 350, 2, 8, 330}, 20e-6);
    const auto run = breathing<Real>(definition, asked.tick_s, asked.rpm);
    BreathingOde exact(definition, wide(run->in.speed_rad_s), kIn, kOut, {definition.gas.fuel_kg, 0});
    double peak_Pa = 0, worst_Pa = 0, worst_K = 0, most_K = 0, least_K = 1000;
    const long cycle = std::lround(120 / asked.rpm / asked.tick_s), ticks = 4 * cycle;
    for (long i = 1; i <= ticks; ++i) {
      const auto& out = run->step();
      exact.run_to(static_cast<double>(i) * asked.tick_s);
      ASSERT_EQ(out.faults, 0u);
      if (i < 3 * cycle) continue;
      const double exact_Pa = exact.cylinder().p, kelvin = exact.wall_K();
      peak_Pa = std::fmax(peak_Pa, exact_Pa);
      worst_Pa = std::fmax(worst_Pa, std::fabs(wide(out.cylinder_gas[0].pressure_Pa) - exact_Pa));
      worst_K = std::fmax(worst_K, std::fabs(wide(out.wall_K[0]) - kelvin));
      most_K = std::fmax(most_K, kelvin), least_K = std::fmin(least_K, kelvin);
    }
    const auto where = ::testing::Message() << asked.rpm << " rpm, " << asked.tick_s << " s";
    EXPECT_GT(most_K - least_K, 5) << where;
    EXPECT_LT(worst_Pa / peak_Pa, 2 * asked.of_peak) << where;
    EXPECT_LT(worst_K, 2 * asked.wall_K) << where;
  }
}

// ---- the books ------------------------------------------------------------------------------------------------------

/// With everything on, behind a throttle: mass of all gas, energy of the cylinder, heat of its walls.
TYPED_TEST(GasWarmWalls, KeepTheBooksWithEverythingOn) {
  using Real = TypeParam;
  constexpr double kTick_s = 0x1p-15;  // then a mean over the tick has the very bits of the sum
  const Walls walls{200, 20, 363.15, 2, 8, 330};
  EngineDefinition definition = with_everything(walls, 30e-6);
  definition.gas.charge_burn.in_use = true;
  const auto run = breathing<Real, Throttled>(definition, kTick_s, 3000);
  run->in.throttle_ratio = static_cast<Real>(0.7);
  const auto held_kg = [&run] {
    const auto& s = run->engine.state();
    const auto of = [](const detail::GasContents<Real>& c) { return wide(c.mass_kg) + wide(c.mass_rest_kg); };
    double kg = of(s.cylinder_gas.template at<Real>(0).contents) + wide(s.crevice_gas.mass_kg[0]);
    for (const auto& manifold : s.manifold) kg += of(manifold.contents);
    for (const auto& of_port : s.runner) kg += of(of_port[0].contents);
    return kg;
  };
  const double begin_kg = held_kg(), begin_K = wall_K(*run);
  double came_kg = 0, flowed_kg = 0, fuel_kg = 0, wall_J = 0, port_J = 0, coolant_J = 0, defect_J = 0, heat_J = 0;
  Real last_Pa{};
  for (int tick = 0; tick < 100 * 1311; ++tick) {
    const auto& out = run->step();
    ASSERT_EQ(out.faults, 0u) << tick;
    const double in_kg = wide(out.throttle_kg_s) * kTick_s, out_kg = wide(out.outlet_kg_s) * kTick_s;
    came_kg += in_kg - out_kg - wide(out.crevice[0].blow_by_kg_s) * kTick_s;
    flowed_kg += std::fabs(in_kg) + std::fabs(out_kg);
    wall_J += wide(out.cylinder_gas[0].wall_heat_W) * kTick_s;
    for (const Real heat_W : out.port_heat_W) port_J += wide(heat_W) * kTick_s;
    coolant_J += kTick_s * walls.to_coolant_W_K * (wall_K(*run) - walls.coolant_K);
    const auto& cycle = out.gas_cycle[0];
    if (cycle.net_mep_Pa == last_Pa) continue;
    last_Pa = cycle.net_mep_Pa;
    fuel_kg += wide(cycle.fuel_kg), heat_J += wide(cycle.heat_J), defect_J += std::fabs(wide(cycle.energy_defect_J));
  }
  const bool single = sizeof(Real) == 4;
  fuel_kg += wide(run->engine.state().gas_record[0].fuel_kg);
  EXPECT_GT(flowed_kg, 0.08);
  EXPECT_NEAR(held_kg() - begin_kg, came_kg + fuel_kg, flowed_kg * (single ? 1e-7 : 1e-13));
  EXPECT_LT(defect_J, heat_J * (single ? 1e-8 : 1e-14));
  EXPECT_GT(std::fabs(port_J), 100);
  const double risen_K = wall_K(*run) - begin_K;
  EXPECT_GT(risen_K, 5);
  EXPECT_NEAR(walls.capacity_J_K * risen_K + waiting_J(*run), wall_J - coolant_J,
              1e-4 * wall_J);  // but for the gas in crevices
}

/// Heavy walls change their temperature every 32 ticks; the heat of the ticks between waits, none is lost.
TYPED_TEST(GasWarmWalls, ChangeEveryFewTicksAndLoseNoHeat) {
  using Real = TypeParam;
  constexpr double kTick_s = 0x1p-15, kCapacity_J_K = 1500;
  const auto run = breathing<Real>(with_walls({kCapacity_J_K, 0, 363.15, 0, 0, 0}, 30e-6), kTick_s, 4000);
  const double begin_K = wall_K(*run);
  double gave_J = 0, last_K = begin_K;
  int changes = 0;
  constexpr int kTicks = 32 * 300;
  for (int tick = 0; tick < kTicks; ++tick) {
    const auto& out = run->step();
    ASSERT_EQ(out.faults, 0u);
    gave_J += wide(out.cylinder_gas[0].wall_heat_W) * kTick_s;
    const double now_K = wide(out.wall_K[0]);
    ASSERT_LT(std::fabs(now_K - last_K), 0.05) << tick;
    changes += now_K != last_K;
    last_K = now_K;
  }
  EXPECT_LE(changes, kTicks / 32);
  EXPECT_GT(changes, kTicks / 32 - 30);  // the least heat is less than a float of its temperature
  EXPECT_GT(gave_J, 1000);
  EXPECT_NEAR(kCapacity_J_K * (last_K - begin_K) + waiting_J(*run), gave_J,
              gave_J * (sizeof(Real) == 4 ? 3e-7 : 1e-13));
}

/// A sealed cylinder with crevices, turned: what the piston brings in, gas, walls and coolant have, to rounding.
TYPED_TEST(GasWarmWalls, LoseNoEnergyToNowhere) {
  using Real = TypeParam;
  EngineDefinition definition = support::sealed(with_walls({100, 10, 350, 0, 0, 0}));
  definition.gas.crevice = {0.05, 0}, definition.gas.wall_heat_ratio = 2;
  constexpr double kTick_s = 0x1p-14, kSwept_m3 = kPi / 4 * 0.086 * 0.086 * 0.086;
  const auto run = breathing<Real>(definition, kTick_s, 1500);
  const auto held_J = [&run] {  // of air alone
    const auto& s = run->engine.state();
    const double kelvin = wall_K(*run);
    return wide(s.cylinder_gas.energy_J[0]) + wide(s.cylinder_gas.energy_rest_J[0]) + 100 * (kelvin - 400) +
           waiting_J(*run) + wide(s.crevice_gas.mass_kg[0]) * support::gas_energy(kelvin, 0);
  };
  double begin_J = 0, coolant_J = 0;
  Real last_Pa{};
  int cycles = 0;
  for (int tick = 0; tick < 8 * 1311; ++tick) {
    const auto& out = run->step();
    coolant_J += kTick_s * 10 * (wall_K(*run) - 350);
    const Real mep_Pa = out.gas_cycle[0].net_mep_Pa;
    if (mep_Pa == last_Pa) continue;
    if (cycles++ > 0) {
      EXPECT_NEAR(begin_J - held_J(), wide(mep_Pa) * kSwept_m3 + coolant_J, sizeof(Real) == 4 ? 1e-3 : 1e-7) << tick;
      EXPECT_GT(std::fabs(coolant_J), 10);
    }
    begin_J = held_J(), coolant_J = 0, last_Pa = mep_Pa;
  }
  EXPECT_GT(cycles, 6);
}

TYPED_TEST(GasWarmWalls, CoolTheExhaustAndWarmTheCharge) {
  using Real = TypeParam;
  const auto run_with = [](double intake_W_K, double exhaust_W_K, double manifold_K) {
    const EngineDefinition definition = with_walls({0, 20, 363.15, intake_W_K, exhaust_W_K, manifold_K}, 30e-6);
    const auto run = breathing<Real, Throttled>(definition, 50e-6, 3000);
    double sums[6] = {};  // over the last five cycles: heat, temperature of each side; charge
    for (int tick = 0; tick < 60 * 800; ++tick) {
      const auto& out = run->step();
      if (tick < 55 * 800) continue;
      for (std::size_t port = 0; port < 2; ++port) {
        sums[port] += wide(out.port_heat_W[port]) / 4000;
        sums[2 + port] += wide(out.manifold[port].temperature_K) / 4000;
      }
      sums[4] += wide(out.gas_cycle[0].volumetric_efficiency) / 4000;
    }
    return std::vector<double>(sums, sums + 5);
  };
  const auto none = run_with(0, 0, 0), walled = run_with(3, 10, 360);
  EXPECT_EQ(none[0], 0);
  EXPECT_EQ(none[1], 0);
  EXPECT_NEAR(walled[0], 3 * (walled[2] - 360), 0.5);
  EXPECT_NEAR(walled[1], 10 * (walled[3] - 360), 10);
  EXPECT_GT(walled[2], none[2] + 3);
  EXPECT_LT(walled[3], none[3] - 30);
  EXPECT_LT(walled[4], none[4] - 0.005);
}

// ---- scenes ---------------------------------------------------------------------------------------------------------

TYPED_TEST(GasWarmWalls, ChangeNoBitWhereTheEngineHasNone) {
  using Real = TypeParam;
  const EngineDefinition definition = with_everything({}, 30e-6);
  const auto with = breathing<Real>(definition, 50e-6, 4000);
  const auto without = breathing<Real, Plain>(definition, 50e-6, 4000);
  EXPECT_EQ(with->storage.tables().drive->fingerprint, without->storage.tables().drive->fingerprint);
  for (int tick = 0; tick < 2000; ++tick) {
    const auto& a = with->step();
    const auto& b = without->step();
    ASSERT_EQ(std::memcmp(&a.cylinder_gas[0], &b.cylinder_gas[0], sizeof a.cylinder_gas[0]), 0) << tick;
    ASSERT_EQ(std::memcmp(&a.crevice[0], &b.crevice[0], sizeof a.crevice[0]), 0) << tick;
    ASSERT_EQ(std::memcmp(&a.runner[0], &b.runner[0], sizeof a.runner[0]), 0) << tick;
    ASSERT_EQ(std::memcmp(&a.gas_cycle[0], &b.gas_cycle[0], sizeof a.gas_cycle[0]), 0) << tick;
  }
  EXPECT_EQ(with->engine.output().wall_K[0], static_cast<Real>(423.15));
}

TEST(GasWarmWallsScene, IsDemandedByADefinitionThatHasThem) {
  const Walls asked[] = {{1, 20, 363.15, 0, 0, 0}, {0, 20, 363.15, 1, 0, 0}, {0, 20, 363.15, 0, 1, 0}};
  for (const Walls& walls : asked) {
    TableStorage<float, Plain> storage;
    ASSERT_TRUE(accepted(storage.build(with_walls(walls), {100e-6, {}})));
    Engine<float, Plain> engine;
    EXPECT_TRUE(support::refuses(engine.init(storage.tables()), Reason::inconsistent, "scene.walls"));
  }
}

TEST(GasWarmWallsScene, CostsNoByteOfStateAndOutputWhereItIsNotAskedFor) {
  EXPECT_EQ(sizeof(State<float, Cylinder>) - sizeof(State<float, Plain>), 2 * 2 * sizeof(float));
  EXPECT_EQ(sizeof(Output<float, Cylinder>) - sizeof(Output<float, Plain>), 3 * sizeof(float));
}

TYPED_TEST(GasWarmWalls, HaveACylinderAbreastAsByItself) {
  using Real = TypeParam;
  const EngineDefinition single = with_everything({50, 20, 363.15, 2, 8, 330}, 30e-6);
  EngineDefinition definition = support::four_2000();
  definition.gas = single.gas;
  const auto four = breathing<Real, Four>(definition, 100e-6, 3500);
  const auto one = breathing<Real>(single, 100e-6, 3500);
  for (int tick = 0; tick < 1500; ++tick) {
    const auto& a = four->step();
    const auto& b = one->step();
    ASSERT_EQ(std::memcmp(&a.cylinder_gas[0], &b.cylinder_gas[0], sizeof a.cylinder_gas[0]), 0) << tick;
    ASSERT_EQ(a.wall_K[0], b.wall_K[0]) << tick;
    ASSERT_EQ(a.knock_integral[0], b.knock_integral[0]) << tick;
  }
}

TYPED_TEST(GasWarmWalls, GoOnFromASavedState) {
  using Real = TypeParam;
  const EngineDefinition definition = with_everything({50, 20, 363.15, 2, 8, 330}, 30e-6);
  const auto run = breathing<Real>(definition, 50e-6, 2500);
  for (int tick = 0; tick < 1950; ++tick) (void)run->step();
  std::vector<unsigned char> bytes(kSavedStateBytes<Real, Cylinder>);
  ASSERT_TRUE(accepted(save_state(run->engine, bytes.data(), bytes.size())));
  const auto other = breathing<Real>(definition, 50e-6, 2500);
  ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), other->engine)));
  for (int tick = 0; tick < 1000; ++tick) {
    const auto& a = run->step();
    const auto& b = other->step();
    ASSERT_EQ(std::memcmp(&a.cylinder_gas[0], &b.cylinder_gas[0], sizeof a.cylinder_gas[0]), 0) << tick;
    ASSERT_EQ(a.wall_K[0], b.wall_K[0]) << tick;
  }
  auto forged = run->engine.state();
  forged.wall_K[0] = Real{50};
  ASSERT_TRUE(accepted(other->engine.restore(forged)));
  ASSERT_TRUE(accepted(save_state(other->engine, bytes.data(), bytes.size())));
  EXPECT_TRUE(
      support::refuses(load_state(bytes.data(), bytes.size(), run->engine), Reason::out_of_range, "state.walls"));
}

TYPED_TEST(GasWarmWalls, StayNumbersWhateverComesIn) {  // CRANKLOOP_LONG_TESTS=1: 20 000 engines
  using Real = TypeParam;
  support::Random random(38);
  const int trials = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 20'000 : 300;
  const auto log_of = [&random](double least, double most) {
    return least * std::pow(most / least, random.between(0, 1));
  };
  for (int trial = 0; trial < trials; ++trial) {
    const auto or_none = [&](double least, double most) { return random.coin() ? log_of(least, most) : 0; };
    EngineDefinition definition = with_everything({or_none(1, 1e6), log_of(1e-3, 1e5), log_of(150, 2000),
                                                   or_none(1e-3, 1e5), or_none(1e-3, 1e5), or_none(150, 3000)},
                                                  or_none(1e-9, 0.01));
    if (random.coin()) definition.gas.intake_runner = definition.gas.exhaust_runner = {};
    if (random.coin()) definition.gas.crevice = {};
    definition.gas.charge_burn.in_use = random.coin();
    definition.crank.compression_ratio = log_of(1.01, 100);
    const double scale = log_of(0.05, 10);
    for (double* length : {&definition.crank.bore_m, &definition.crank.crank_radius_m, &definition.crank.rod_length_m})
      *length *= scale;
    definition.gas.wall_K = log_of(150, 2000);
    const auto run =
        breathing<Real>(definition, log_of(1e-6, 2e-3), 0, GasSeen{log_of(1e3, 1e7), log_of(150, 3000), 1});
    run->in.intake_Pa = static_cast<Real>(log_of(1e3, 1e7)), run->in.intake_K = static_cast<Real>(log_of(150, 3000));
    for (int tick = 0; tick < 300; ++tick) {
      if (tick % 10 == 0) run->in.speed_rad_s = static_cast<Real>(random.between(-3000, 3000));
      const auto& out = run->step();
      ASSERT_TRUE(std::isfinite(out.cylinder_gas[0].pressure_Pa) && out.cylinder_gas[0].pressure_Pa > 0) << trial;
      ASSERT_GE(out.wall_K[0], Real{100}) << trial << " " << tick;
      ASSERT_LE(out.wall_K[0], Real{6000}) << trial << " " << tick;
      ASSERT_TRUE(std::isfinite(out.port_heat_W[kIntake]) && std::isfinite(out.port_heat_W[kExhaust])) << trial;
    }
    std::vector<unsigned char> bytes(kSavedStateBytes<Real, Cylinder>);  // what a run writes, a load takes
    ASSERT_TRUE(accepted(save_state(run->engine, bytes.data(), bytes.size())));
    ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), run->engine))) << trial;
  }
}

}  // namespace
}  // namespace crankloop::gas_walls_test

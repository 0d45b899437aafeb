// Crevices and blow-by: against the differential equations in continuous time, closed forms, the books.
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

namespace crankloop::gas_crevice_test {
namespace {

using support::Breathing;
using support::BreathingOde;
using support::GasSeen;
using support::kGasR;
using support::kPi;
using support::rad_s;
using tick_test::RealName;

constexpr double kSwept_m3 = kPi / 4 * 0.086 * 0.086 * 0.086;
constexpr GasSeen kIn{100e3, 298, 0};

struct Cylinder : support::GivenCylinder {
  static constexpr bool crevice = true;
};

/// The engine of the facts.
[[nodiscard]] EngineDefinition engine_with(double crevice_ratio, double blow_by_mm2, double fuel_kg = 0) {
  EngineDefinition engine = support::one_of_four_2000();
  engine.gas.crevice.volume_ratio = crevice_ratio, engine.gas.crevice.blow_by_m2 = blow_by_mm2 * 1e-6;
  engine.gas.fuel_kg = fuel_kg;
  return engine;
}

template <class Real, class S = Cylinder>
[[nodiscard]] std::unique_ptr<Breathing<Real, S>> breathing(const EngineDefinition& definition, double tick_s,
                                                            double rpm, const GasSeen& exhaust) {
  return support::breathing_between<Real, S>(definition, tick_s, rad_s(rpm), kIn, exhaust);
}

template <class Real>
class GasCrevice : public ::testing::Test {};
TYPED_TEST_SUITE(GasCrevice, tick_test::BothReals, RealName);

// ---- against the differential equations -----------------------------------------------------------------------------

/// Measured, of which at most twice may be reached; share 0.015 and 0.1 mm2, three cycles from rest.
struct Accuracy {
  double rpm, fuel_kg;
  double of_peak[3];  ///< largest error of the pressure, at 20, 50 and 100 us
};
constexpr double kTicks_s[] = {20e-6, 50e-6, 100e-6};
constexpr Accuracy kMeasured[] = {
    {800, 0, {4.9e-6, 8.4e-6, 1.5e-5}},  {800, 20e-6, {9.5e-6, 1.5e-5, 3.6e-5}},
    {3000, 0, {2.1e-5, 6.6e-5, 1.1e-4}}, {3000, 20e-6, {1.7e-5, 5.2e-5, 1.7e-4}},
    {6000, 0, {6.9e-5, 4.8e-4, 5.7e-4}}, {6000, 20e-6, {2.8e-5, 1.5e-4, 5.2e-4}},
};

TYPED_TEST(GasCrevice, FollowsItsDifferentialEquations) {
  using Real = TypeParam;
  for (const Accuracy& asked : kMeasured) {
    const EngineDefinition definition = engine_with(0.015, 0.1, asked.fuel_kg);
    const GasSeen exhaust{102e3, asked.fuel_kg > 0 ? 900.0 : 320.0, 1};
    for (std::size_t at = 0; at < 3; ++at) {
      const double tick_s = kTicks_s[at];
      const auto run = breathing<Real>(definition, tick_s, asked.rpm, exhaust);
      BreathingOde exact(definition, static_cast<double>(run->in.speed_rad_s), kIn, exhaust, {asked.fuel_kg, 0});
      double peak_Pa = 0, worst_Pa = 0, wall_heat_J = 0, blow_by_kg = 0;
      const long ticks = std::lround(3 * 120 / asked.rpm / tick_s);
      for (long i = 1; i <= ticks; ++i) {
        const auto& out = run->step();
        exact.run_to(static_cast<double>(i) * tick_s);
        ASSERT_EQ(out.faults, 0u);
        const double exact_Pa = exact.cylinder().p;
        peak_Pa = std::fmax(peak_Pa, exact_Pa);
        worst_Pa = std::fmax(worst_Pa, std::fabs(static_cast<double>(out.cylinder_gas[0].pressure_Pa) - exact_Pa));
        wall_heat_J += static_cast<double>(out.cylinder_gas[0].wall_heat_W) * tick_s;
        blow_by_kg += static_cast<double>(out.crevice[0].blow_by_kg_s) * tick_s;
      }
      const auto where = ::testing::Message() << asked.rpm << " rpm, " << asked.fuel_kg << " kg, " << tick_s << " s";
      const auto& crevice = run->engine.state().crevice_gas;
      EXPECT_LT(worst_Pa / peak_Pa, 2 * asked.of_peak[at]) << where;
      EXPECT_NEAR(blow_by_kg, exact.blow_by_kg(), 6e-3 * exact.blow_by_kg()) << where;
      EXPECT_NEAR(wall_heat_J, exact.wall_heat_J(), 2e-3 * exact.wall_heat_J()) << where;
      EXPECT_NEAR(static_cast<double>(crevice.mass_kg[0]), exact.crevice_kg(), 6e-3 * exact.crevice_kg()) << where;
      EXPECT_NEAR(static_cast<double>(crevice.burned_kg[0]), exact.crevice_burned_kg(),
                  3e-2 * exact.crevice_burned_kg())
          << where;
    }
  }
}

/// Figures of another implementation (docs/model.md "Crevices and blow-by"): gross work over the swept volume, peak and
/// its angle, blow-by of a cycle.
struct Fact {
  double rpm, crevice_ratio, blow_by_mm2;
  double gross_kPa, peak_kPa, peak_deg, blow_by_mg;
};
constexpr Fact kFacts[] = {
    {800, 0, 0, -27.64, 2265.5, -0.58, 0},      {800, 0.01, 0, -28.59, 2216.8, -0.58, 0},
    {800, 0.02, 0, -29.44, 2170.4, -0.58, 0},   {800, 0, 0.1, -31.38, 2247.6, -0.67, 6.7},
    {800, 0, 0.3, -38.65, 2212.3, -0.86, 19.7}, {2000, 0, 0, -19.96, 2364.6, -0.48, 0},
    {2000, 0.01, 0, -21.24, 2313.0, -0.48, 0},  {2000, 0.02, 0, -22.39, 2264.0, -0.48, 0},
    {2000, 0, 0.1, -21.59, 2357.0, -0.48, 2.8}, {2000, 0, 0.3, -24.83, 2341.8, -0.48, 8.4},
};

TYPED_TEST(GasCrevice, TakesPeakAndWorkAsAnotherImplementationHasIt) {
  using Real = TypeParam;
  for (const Fact& fact : kFacts) {
    const auto run =
        breathing<Real>(engine_with(fact.crevice_ratio, fact.blow_by_mm2), 20e-6, fact.rpm, GasSeen{102e3, 320, 1});
    for (long i = std::lround(6 * 120 / fact.rpm / 20e-6); i > 0; --i) (void)run->step();
    const auto& cycle = run->engine.output().gas_cycle[0];
    const auto where = ::testing::Message() << fact.rpm << " rpm, " << fact.crevice_ratio << ", " << fact.blow_by_mm2;
    EXPECT_NEAR(static_cast<double>(cycle.net_mep_Pa - cycle.pumping_mep_Pa) / 1e3, fact.gross_kPa, 0.25) << where;
    EXPECT_NEAR(static_cast<double>(cycle.peak_Pa) / 1e3, fact.peak_kPa, 2e-3 * fact.peak_kPa) << where;
    EXPECT_NEAR(static_cast<double>(cycle.peak_deg), fact.peak_deg, 0.025) << where;
    EXPECT_NEAR(static_cast<double>(run->engine.output().cycle_blow_by_kg[0]) * 1e6, fact.blow_by_mg, 0.06) << where;
  }
}

/// The reference by itself, on fired cycles of 800 J without mass.
TEST(BreathingOde, HasTheFactsOfFiredCycles) {
  constexpr Fact kFired[] = {{2000, 0, 0, 744.1, 5038, 11.5, 0},
                             {2000, 0.01, 0, 730.0, 4904, 11.6, 0},
                             {2000, 0.02, 0, 716.6, 4778, 11.8, 0},
                             {2000, 0, 0.1, 737.0, 5021, 11.5, 5.5},
                             {2000, 0, 0.3, 723.1, 4988, 11.4, 16.2}};
  for (const Fact& fact : kFired) {
    BreathingOde exact(engine_with(fact.crevice_ratio, fact.blow_by_mm2), rad_s(fact.rpm), kIn, {102e3, 900, 0},
                       {0, 800});
    const double cycle_s = 120 / fact.rpm;
    exact.run_to(4.75 * cycle_s);
    const double work_J = exact.work_J(), blow_by_kg = exact.blow_by_kg();
    double peak_Pa = 0;
    for (int i = 0; i <= 1800; ++i) {
      exact.run_to((4.75 + i / 3600.0) * cycle_s);
      peak_Pa = std::fmax(peak_Pa, exact.cylinder().p);
    }
    EXPECT_NEAR((exact.work_J() - work_J) / kSwept_m3 / 1e3, fact.gross_kPa, 0.2) << fact.crevice_ratio;
    EXPECT_NEAR(peak_Pa / 1e3, fact.peak_kPa, 2) << fact.crevice_ratio;
    exact.run_to(5.75 * cycle_s);
    EXPECT_NEAR((exact.blow_by_kg() - blow_by_kg) * 1e6, fact.blow_by_mg, 0.06) << fact.blow_by_mm2;
  }
}

// ---- closed forms and books -----------------------------------------------------------------------------------------

TYPED_TEST(GasCrevice, LeaksAsAChokedOrificeAndEndsAtTheCrankcasesPressure) {
  using Real = TypeParam;
  EngineDefinition definition = support::sealed(engine_with(0, 0.1));
  definition.gas.wall_heat_ratio = 10;  // nearly isothermal
  const double volume_m3 = kSwept_m3 / 9.5;
  const double time_s = volume_m3 / (0.1e-6 * support::kChokedPsi * std::sqrt(kGasR * 423.15));
  EXPECT_NEAR(time_s * 58e-6 / volume_m3, 2.46, 0.01);
  const auto run = breathing<Real>(definition, 1e-3, 0, GasSeen{102e3, 320, 1});
  auto state = run->engine.state();
  auto gas = state.cylinder_gas.template at<Real>(0);
  gas.contents = detail::contents_of(Real{1e6}, static_cast<Real>(423.15), Real{0}, gas.volume_m3);
  gas.point = detail::point_of(gas.contents, 1 / gas.volume_m3);
  gas.wall_heat_W = Real{0};
  state.cylinder_gas.put(0, gas);
  ASSERT_TRUE(accepted(run->engine.restore(state)));
  for (int tick = 1; tick <= 3000; ++tick) {
    const double now_Pa = static_cast<double>(run->step().cylinder_gas[0].pressure_Pa);
    ASSERT_NEAR(now_Pa, 1e6 * std::exp(-tick * 1e-3 / time_s), 3e-3 * now_Pa) << tick;
  }
  for (int tick = 0; tick < 40'000; ++tick) (void)run->step();
  const auto& out = run->engine.output();
  EXPECT_NEAR(static_cast<double>(out.cylinder_gas[0].pressure_Pa), 100e3, 1);
  EXPECT_NEAR(static_cast<double>(out.crevice[0].blow_by_kg_s), 0, 1e-11);
}

TYPED_TEST(GasCrevice, KeepsItsBooks) {
  using Real = TypeParam;
  constexpr double kTick_s = 0x1p-15;  // 31 us: then a mean flow over the tick has the very bits of the mass
  const auto run = breathing<Real>(engine_with(0.02, 0.3, 20e-6), kTick_s, 3000, GasSeen{102e3, 900, 1});
  const auto held_kg = [&run] {
    const auto& state = run->engine.state();
    const auto& gas = state.cylinder_gas;
    const auto& crevice = state.crevice_gas;
    return static_cast<double>(gas.mass_kg[0]) + static_cast<double>(gas.mass_rest_kg[0]) +
           static_cast<double>(crevice.mass_kg[0]);
  };
  const double before_kg = held_kg();
  double came_kg = 0, flowed_kg = 0, fuel_kg = 0, heat_J = 0, defect_J = 0, crevice_burned_kg = 0;
  Real last_Pa{};
  for (int tick = 0; tick < 100 * 1311; ++tick) {
    const auto& out = run->step();
    ASSERT_EQ(out.faults, 0u);
    for (const Real flow : out.cylinder_gas[0].flow_kg_s) {
      came_kg += static_cast<double>(flow) * kTick_s, flowed_kg += std::fabs(static_cast<double>(flow)) * kTick_s;
    }
    came_kg -= static_cast<double>(out.crevice[0].blow_by_kg_s) * kTick_s;
    const auto& crevice = run->engine.state().crevice_gas;
    crevice_burned_kg = static_cast<double>(crevice.burned_kg[0]);
    ASSERT_GE(static_cast<double>(crevice.mass_kg[0]), 0);
    ASSERT_GE(crevice_burned_kg, -1e-12);
    ASSERT_LE(crevice_burned_kg, static_cast<double>(crevice.mass_kg[0]) * (1 + 1e-6));
    const auto& cycle = out.gas_cycle[0];
    if (cycle.net_mep_Pa == last_Pa) continue;
    last_Pa = cycle.net_mep_Pa;
    fuel_kg += static_cast<double>(cycle.fuel_kg), heat_J += static_cast<double>(cycle.heat_J);
    defect_J += std::fabs(static_cast<double>(cycle.energy_defect_J));
  }
  // The cycle in progress has not burned: it stands at firing dead centre or before.
  const bool single = sizeof(Real) == 4;
  fuel_kg += static_cast<double>(run->engine.state().gas_record[0].fuel_kg);
  EXPECT_GT(flowed_kg, 0.1);
  EXPECT_NEAR(held_kg() - before_kg, came_kg + fuel_kg, flowed_kg * (single ? 2e-8 : 1e-14));
  EXPECT_LT(defect_J, heat_J * (single ? 1e-8 : 1e-14));
}

/// A sealed cylinder with adiabatic walls: what its work, its leak and its crevices' walls take is what it loses.
TYPED_TEST(GasCrevice, LosesNoEnergyToNowhere) {
  using Real = TypeParam;
  EngineDefinition definition = support::sealed(engine_with(0.05, 0.3));
  definition.gas.wall_K = 400;
  const auto run = breathing<Real>(definition, 50e-6, 2000, GasSeen{102e3, 320, 1});
  const auto held_J = [&run] {  // of air alone
    const auto& state = run->engine.state();
    const auto& gas = state.cylinder_gas;
    const auto& crevice = state.crevice_gas;
    return static_cast<double>(gas.energy_J[0]) + static_cast<double>(gas.energy_rest_J[0]) +
           static_cast<double>(crevice.mass_kg[0]) * support::gas_energy(400, 0);
  };
  // From the end of one cycle to that of the next.
  double begin_J = 0, wall_J = 0, leak_J = 0;
  Real last_Pa{};
  int cycles = 0;
  for (int tick = 0; tick < 6 * 1200; ++tick) {
    const auto& out = run->step();
    wall_J += static_cast<double>(out.cylinder_gas[0].wall_heat_W) * 50e-6;
    leak_J += static_cast<double>(out.crevice[0].blow_by_kg_s) * 50e-6 * support::gas_enthalpy(400, 0);
    const Real mep_Pa = out.gas_cycle[0].net_mep_Pa;
    if (mep_Pa == last_Pa) continue;
    const double lost_J = static_cast<double>(mep_Pa) * kSwept_m3 + wall_J + leak_J;
    if (cycles++ > 0) {
      EXPECT_GT(std::fabs(leak_J), 0.5);
      EXPECT_NEAR(begin_J - held_J(), lost_J, sizeof(Real) == 4 ? 2e-3 : 1e-10) << tick;
    }
    begin_J = held_J(), wall_J = leak_J = 0, last_Pa = mep_Pa;
  }
  EXPECT_GT(cycles, 4);
}

// ---- scenes ---------------------------------------------------------------------------------------------------------

struct Plain : Cylinder {
  static constexpr bool crevice = false;
};

TYPED_TEST(GasCrevice, ShowsWhatItHoldsWithALeakAndWithout) {
  using Real = TypeParam;
  const double per_Pa = 0.02 * kSwept_m3 / 9.5 / (kGasR * 423.15);  // V_cr / (R T_w)
  for (const double leak_mm2 : {0.0, 0.1}) {
    const auto run = breathing<Real>(engine_with(0.02, leak_mm2), 50e-6, 3000, GasSeen{102e3, 900, 1});
    int closed = 0;
    for (int tick = 0; tick < 1600; ++tick) {
      const auto& out = run->step();
      const auto& state = run->engine.state();
      ASSERT_EQ(out.crevice[0].mass_kg, state.crevice_gas.mass_kg[0]) << leak_mm2 << ", " << tick;
      if (state.cylinder_gas.area_m2[kIntake][0] + state.cylinder_gas.area_m2[kExhaust][0] > 0) continue;
      const double expected_kg = per_Pa * static_cast<double>(out.cylinder_gas[0].pressure_Pa);
      ASSERT_NEAR(static_cast<double>(out.crevice[0].mass_kg), expected_kg, 0.02 * expected_kg)
          << leak_mm2 << ", " << tick;
      ++closed;
    }
    EXPECT_GT(closed, 500);
  }
}

TYPED_TEST(GasCrevice, ChangesNoBitWhereTheEngineHasNone) {
  using Real = TypeParam;
  const EngineDefinition definition = engine_with(0, 0, 30e-6);
  const auto with = breathing<Real>(definition, 50e-6, 4000, GasSeen{102e3, 900, 1});
  const auto without = breathing<Real, Plain>(definition, 50e-6, 4000, GasSeen{102e3, 900, 1});
  EXPECT_EQ(with->storage.tables().drive->fingerprint, without->storage.tables().drive->fingerprint);
  for (int tick = 0; tick < 2000; ++tick) {
    const auto& a = with->step();
    const auto& b = without->step();
    ASSERT_EQ(std::memcmp(&a.cylinder_gas[0], &b.cylinder_gas[0], sizeof a.cylinder_gas[0]), 0) << tick;
    ASSERT_EQ(std::memcmp(&a.gas_cycle[0], &b.gas_cycle[0], sizeof a.gas_cycle[0]), 0) << tick;
    ASSERT_EQ(a.crevice[0].mass_kg, Real{0});
    ASSERT_EQ(a.crevice[0].blow_by_kg_s, Real{0});
  }
}

TEST(GasCreviceScene, IsDemandedByADefinitionThatHasOne) {
  for (const EngineDefinition& definition : {engine_with(0.01, 0), engine_with(0, 0.1)}) {
    TableStorage<float, Plain> storage;
    ASSERT_TRUE(accepted(storage.build(definition, {100e-6, {}})));
    Engine<float, Plain> engine;
    EXPECT_TRUE(support::refuses(engine.init(storage.tables()), Reason::inconsistent, "scene.crevice"));
  }
}

TEST(GasCreviceScene, CostsNoByteOfStateAndOutputWhereItIsNotAskedFor) {
  EXPECT_EQ(sizeof(State<float, Cylinder>) - sizeof(State<float, Plain>), 2 * 3 * sizeof(float));  // two lanes
  EXPECT_EQ(sizeof(Output<float, Cylinder>) - sizeof(Output<float, Plain>), 3 * sizeof(float));
}

struct Four : Cylinder {
  static constexpr Count cylinders = exactly<4>;
};

TYPED_TEST(GasCrevice, HasACylinderAbreastAsByItself) {  // in float four go abreast where the processor can
  using Real = TypeParam;
  EngineDefinition definition = support::four_2000();
  const EngineDefinition single = engine_with(0.02, 0.2, 25e-6);
  definition.gas = single.gas;
  const auto four = breathing<Real, Four>(definition, 100e-6, 3500, GasSeen{102e3, 900, 1});
  const auto one = breathing<Real>(single, 100e-6, 3500, GasSeen{102e3, 900, 1});
  for (int tick = 0; tick < 1500; ++tick) {
    const auto& a = four->step();
    const auto& b = one->step();
    ASSERT_EQ(std::memcmp(&a.cylinder_gas[0], &b.cylinder_gas[0], sizeof a.cylinder_gas[0]), 0) << tick;
    ASSERT_EQ(std::memcmp(&a.crevice[0], &b.crevice[0], sizeof a.crevice[0]), 0) << tick;
    ASSERT_EQ(std::memcmp(&a.gas_cycle[0], &b.gas_cycle[0], sizeof a.gas_cycle[0]), 0) << tick;
    ASSERT_EQ(a.cycle_blow_by_kg[0], b.cycle_blow_by_kg[0]) << tick;
  }
}

TYPED_TEST(GasCrevice, GoesOnFromItsSavedState) {
  using Real = TypeParam;
  const EngineDefinition definition = engine_with(0.02, 0.2, 25e-6);
  const auto run = breathing<Real>(definition, 50e-6, 2500, GasSeen{102e3, 900, 1});
  for (int tick = 0; tick < 1950; ++tick) (void)run->step();  // in mid-burn
  std::vector<unsigned char> bytes(kSavedStateBytes<Real, Cylinder>);
  ASSERT_TRUE(accepted(save_state(run->engine, bytes.data(), bytes.size())));
  const auto other = breathing<Real>(definition, 50e-6, 2500, GasSeen{102e3, 900, 1});
  ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), other->engine)));
  for (int tick = 0; tick < 1000; ++tick) {
    const auto& a = run->step();
    const auto& b = other->step();
    ASSERT_EQ(a.cylinder_gas[0].pressure_Pa, b.cylinder_gas[0].pressure_Pa) << tick;
    ASSERT_EQ(std::memcmp(&a.crevice[0], &b.crevice[0], sizeof a.crevice[0]), 0) << tick;
  }
  auto forged = run->engine.state();
  forged.crevice_gas.burned_kg[0] = 2 * forged.crevice_gas.mass_kg[0] + forged.cylinder_gas.mass_kg[0];
  ASSERT_TRUE(accepted(other->engine.restore(forged)));
  ASSERT_TRUE(accepted(save_state(other->engine, bytes.data(), bytes.size())));
  EXPECT_TRUE(support::refuses(load_state(bytes.data(), bytes.size(), run->engine), Reason::inconsistent, "state.gas"));
}

/// Gas that leaves takes its share of what burned with it: so the share that stays is what it was, however little that
/// is.
TYPED_TEST(GasCrevice, KeepsItsShareOfBurnedGasWhileItEmpties) {
  using Real = TypeParam;
  for (const double blow_by_mm2 : {0.0, 0.1}) {
    for (const double share : {0.1, 0.7, 1.0}) {
      const auto run = breathing<Real>(engine_with(1e-5, blow_by_mm2), 20e-6, 0, GasSeen{102e3, 900, 1});
      (void)run->step();
      auto state = run->engine.state();
      state.crevice_gas.mass_kg[0] = 20 * state.cylinder_gas.mass_kg[0];
      state.crevice_gas.burned_kg[0] = static_cast<Real>(share) * state.crevice_gas.mass_kg[0];
      ASSERT_TRUE(accepted(run->engine.restore(state)));
      (void)run->step();
      const auto& left = run->engine.state().crevice_gas;
      ASSERT_LT(left.mass_kg[0], static_cast<Real>(1e-4) * state.crevice_gas.mass_kg[0]);  // all but empty
      EXPECT_NEAR(left.burned_kg[0] / left.mass_kg[0], share, 2e-6) << blow_by_mm2;
    }
  }
}

/// Any engine, any input: a number comes out, and a crevice never holds less than nothing.
TYPED_TEST(GasCrevice, StaysANumberWhateverComesIn) {  // CRANKLOOP_LONG_TESTS=1: 20 000 engines
  using Real = TypeParam;
  support::Random random(34);
  const int trials = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 20'000 : 300;
  const auto wide = [&random](double least, double most) {
    return least * std::pow(most / least, random.between(0, 1));
  };
  for (int trial = 0; trial < trials; ++trial) {
    EngineDefinition definition = engine_with(random.coin() ? wide(1e-6, 0.1) : 0, random.coin() ? wide(1e-6, 5) : 0,
                                              random.coin() ? wide(1e-9, 0.01) : 0);
    definition.crank.compression_ratio = wide(1.01, 100);
    const double scale = wide(0.05, 10);
    for (double* length : {&definition.crank.bore_m, &definition.crank.crank_radius_m, &definition.crank.rod_length_m})
      *length *= scale;
    definition.gas.wall_K = wide(150, 2000);
    definition.pressure.crankcase_Pa = wide(5e4, 5e5);
    const auto run = breathing<Real>(definition, wide(1e-6, 2e-3), 0, GasSeen{wide(1e3, 1e7), wide(150, 3000), 1});
    run->in.intake_Pa = static_cast<Real>(wide(1e3, 1e7)), run->in.intake_K = static_cast<Real>(wide(150, 3000));
    for (int tick = 0; tick < 300; ++tick) {
      if (tick % 10 == 0) run->in.speed_rad_s = static_cast<Real>(random.between(-3000, 3000));
      const auto& out = run->step();
      const auto& gas = out.cylinder_gas[0];
      const auto& crevice = run->engine.state().crevice_gas;
      ASSERT_TRUE(std::isfinite(gas.pressure_Pa) && gas.pressure_Pa > 0) << trial << " " << tick;
      ASSERT_TRUE(std::isfinite(gas.wall_heat_W) && std::isfinite(out.crevice[0].blow_by_kg_s)) << trial;
      ASSERT_GE(crevice.mass_kg[0], -static_cast<Real>(1e-6) * gas.mass_kg) << trial << " " << tick;
      ASSERT_LE(crevice.mass_kg[0], 100 * gas.mass_kg) << trial << " " << tick;
      ASSERT_GE(crevice.burned_kg[0], -static_cast<Real>(1e-6) * gas.mass_kg) << trial << " " << tick;
      ASSERT_LE(crevice.burned_kg[0], crevice.mass_kg[0] + static_cast<Real>(1e-6) * gas.mass_kg)
          << trial << " " << tick;
    }
    std::vector<unsigned char> bytes(kSavedStateBytes<Real, Cylinder>);  // what a run writes, a load takes
    ASSERT_TRUE(accepted(save_state(run->engine, bytes.data(), bytes.size())));
    ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), run->engine))) << trial;
  }
}

struct OfAMeasuredCrank : Cylinder {
  static constexpr CrankGiven crank = CrankGiven::phase;
};

TYPED_TEST(GasCrevice, IsFilledAnewWhereTheCrankJumps) {
  using Real = TypeParam;
  Breathing<Real, OfAMeasuredCrank> run(engine_with(0.02, 0.1, 20e-6), 50e-6);
  for (int i = 0; i < 1000; ++i) run.in.crank += Phase{std::uint64_t{1} << 53}, run.step();
  run.in.crank += Phase{std::uint64_t{3} << 61};
  const auto& out = run.step();
  EXPECT_NE(out.faults & kFaultPhaseJump, 0u);
  const double held_kg =
      0.02 * kSwept_m3 / 9.5 / (kGasR * 423.15) * static_cast<double>(out.cylinder_gas[0].pressure_Pa);
  EXPECT_NEAR(static_cast<double>(out.crevice[0].mass_kg), held_kg, 1e-5 * held_kg);
}

}  // namespace
}  // namespace crankloop::gas_crevice_test

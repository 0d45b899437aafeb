// A crank that is turned by forces, piece by piece: starter, standstill, stall and reversal, what the other groups say
// of it, cut cylinders, and any input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include <crankloop/scenes.hpp>
#include <crankloop/tabulate/summary.hpp>
#include <crankloop/tick/state/saved_state.hpp>

#include "support/engines.hpp"
#include "support/output_fields.hpp"
#include "support/random.hpp"
#include "support/running.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"
#include "support/tick_oracle.hpp"
#include "support/work_oracle.hpp"

namespace crankloop::crank_step_test {

using namespace detail;
namespace {

using namespace tick_test;
using support::Random;

using Fired = TurnedByForces<>;
using GivenPressure = TurnedByForces<PressureGiven::by_input>;
using NoGas = TurnedByForces<PressureGiven::none>;

/// The 495 with friction, a driven machine and a starter.
EngineDefinition free_diesel() {
  EngineDefinition engine = diesel_495();
  engine.friction = {110e3, 250, 0.4};
  engine.machine.inertia_kg_m2 = 0.05;
  engine.starter = {420, 40};
  return engine;
}

template <class Real>
class CrankStep : public ::testing::Test {};
TYPED_TEST_SUITE(CrankStep, BothReals, RealName);

// ---- start, run, stop -----------------------------------------------------------------------------------------------

TYPED_TEST(CrankStep, StarterTurnsTheEngineItFiresRunsAndComesToRest) {
  using Real = TypeParam;
  Turned<Real, Fired> run(free_diesel());
  typename Turned<Real, Fired>::Input in;
  in.load_ratio = 0;
  in.starter = 1;
  for (int i = 0; i < 5000; ++i) run.step(in);
  const long double begin_rad = run.angle_rad;
  for (int i = 0; i < 5000; ++i) ASSERT_GT(run.step(in).speed_rad_s, Real{5}) << i;  // over every compression
  const auto mean_rad_s = static_cast<double>((run.angle_rad - begin_rad) / 0.5L);
  std::printf("cranking at %.1f rad/s\n", mean_rad_s);
  EXPECT_GT(mean_rad_s, 10);
  EXPECT_LT(mean_rad_s, 40);  // the starter's no-load speed
  in.load_ratio = static_cast<Real>(0.6);
  for (int i = 0; i < 5000; ++i) run.step(in);
  EXPECT_GT(run.engine.output().speed_rad_s, Real{60});
  EXPECT_EQ(run.engine.output().starter_Nm, Real{0});  // it free-wheels
  in.starter = 0;
  in.load_ratio = 0;
  int ticks = 0;
  while (run.engine.output().speed_rad_s != Real{0} || run.engine.output().acceleration_rad_s2 != Real{0}) {
    run.step(in);
    ASSERT_LT(++ticks, 200000);
  }
  const Phase stands = run.engine.state().phase;
  for (int i = 0; i < 100000; ++i) run.step(in);
  EXPECT_EQ(run.engine.state().phase.units(), stands.units());
  EXPECT_EQ(run.engine.output().speed_rad_s, Real{0});
  EXPECT_EQ(run.engine.output().faults, 0u);
}

TYPED_TEST(CrankStep, AtStandstillFrictionHoldsWhatItCanToTheLastBit) {
  using Real = TypeParam;
  EngineDefinition engine = without_gas(single_495());
  engine.machine.constant_Nm = 30;
  Turned<Real, NoGas> run(engine, 100e-6, 0, phase_at_deg(37));
  typename Turned<Real, NoGas>::Input in;
  for (const double push_Nm : {29.0, -29.0, 30.0, -30.0}) {
    in.external_torque_Nm = static_cast<Real>(push_Nm);
    for (int i = 0; i < 1000; ++i) run.step(in);
    EXPECT_EQ(run.angle_rad, 0.0L) << push_Nm;
    EXPECT_EQ(run.engine.output().friction_Nm, -in.external_torque_Nm);
    EXPECT_EQ(run.engine.output().acceleration_rad_s2, Real{0});
  }
  // One part in a thousand more, and it goes the way it is pushed, with what friction leaves.
  in.external_torque_Nm = static_cast<Real>(30.03);
  const double inertia = 0.45 + 1.382 * 0.0575 * 0.0575 +
                         1.315 * std::pow(static_cast<double>(oracle_pose_at_deg(engine.crank, 37).slope_m), 2) -
                         0.0042 * std::pow(static_cast<double>(oracle_pose_at_deg(engine.crank, 37).rod_slope), 2);
  EXPECT_NEAR(static_cast<double>(run.step(in).acceleration_rad_s2), -0.03 / inertia, 1e-4);
  for (int i = 0; i < 1000; ++i) run.step(in);
  EXPECT_LT(run.angle_rad, 0.0L);
  EXPECT_EQ(run.engine.output().friction_Nm, Real{-30});
}

TYPED_TEST(CrankStep, AnEngineThatDiesBeforeCompressionSwingsBack) {
  using Real = TypeParam;
  EngineDefinition engine = single_495();
  engine.machine.constant_Nm = 2;
  Turned<Real, Fired> run(engine, 100e-6, 10, phase_at_deg(560));
  typename Turned<Real, Fired>::Input in;
  in.load_ratio = 0;
  double farthest = 0, least_speed = 0;
  for (int i = 0; i < 30000; ++i) {
    least_speed = std::min(least_speed, static_cast<double>(run.step(in).speed_rad_s));
    farthest = std::max(farthest, static_cast<double>(run.angle_rad));
  }
  EXPECT_LT(farthest, 160 * kPi / 180);  // never over top dead centre
  EXPECT_LT(least_speed, -1);
  for (int i = 0; i < 200000; ++i) run.step(in);
  EXPECT_EQ(run.engine.output().speed_rad_s, Real{0});
}

TYPED_TEST(CrankStep, TooHighASpeedIsHeldAndFlagged) {
  using Real = TypeParam;
  Turned<Real, Fired> run(free_diesel(), 1e-3);
  typename Turned<Real, Fired>::Input in;
  in.external_torque_Nm = static_cast<Real>(-1e6);
  for (int i = 0; i < 100; ++i) run.step(in);
  EXPECT_EQ(run.engine.output().faults, std::uint32_t{kFaultOverspeed});
  const Real limit = run.engine.tables()->drive->speed_limit_rad_s;
  EXPECT_LE(run.engine.output().speed_rad_s, limit);
  EXPECT_GT(run.engine.output().speed_rad_s, limit * static_cast<Real>(0.99));
  in.external_torque_Nm = 0;
  in.load_ratio = 0;
  for (int i = 0; i < 100; ++i) run.step(in);
  EXPECT_EQ(run.engine.output().faults, 0u);
}

TYPED_TEST(CrankStep, ABadLoadIsTheLastGoodOne) {
  using Real = TypeParam;
  Turned<Real, Fired> good(free_diesel(), 100e-6, 100);
  Turned<Real, Fired> bad(free_diesel(), 100e-6, 100);
  typename Turned<Real, Fired>::Input in;
  in.external_torque_Nm = 40;
  good.step(in), bad.step(in);
  constexpr Real kBeyond = static_cast<Real>(1.001e8);
  for (const Real load :
       {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity(), -kBeyond, kBeyond}) {
    good.step(in);
    auto wrong = in;
    wrong.external_torque_Nm = load;
    EXPECT_EQ(bad.step(wrong).faults, std::uint32_t{kFaultExternalTorque});
    EXPECT_EQ(bad.engine.output().speed_rad_s, good.engine.output().speed_rad_s);
  }
}

TEST(CrankStepInit, RefusesACrankWithoutInertia) {
  EngineDefinition engine = without_gas(single_495());
  engine.masses = {1, 0, 0, 0, 0, 0};
  TableStorage<double, NoGas> storage;
  ASSERT_TRUE(accepted(storage.build(engine, {100e-6})));
  Engine<double, NoGas> turned;
  EXPECT_EQ(turned.init(storage.tables()).reason, Reason::not_positive);
  engine.masses.crank_inertia_kg_m2 = 0.01;
  ASSERT_TRUE(accepted(storage.build(engine, {100e-6})));
  EXPECT_TRUE(accepted(turned.init(storage.tables())));
}

TEST(CrankStepInit, RefusesACrankThatIsLighterAtADeadCentreThanAThousandthOfItsMost) {
  // A kilogram on the piston pin, and nothing else but the crank: J_eff = J + 1 kg s'^2, s' = dx/da from the places of
  // the pin. An offset puts the dead centre, where s' is 0, at a whole degree of the scan.
  for (const double dead_centre_deg : {0, 1, 7, -1, -7}) {
    const double offset_m = (0.0575 + 0.210) * std::sin(dead_centre_deg * kPi / 180);
    const auto pin_m = [&](double rad) {
      return 0.0575 * std::cos(rad) + std::sqrt(0.210 * 0.210 - std::pow(0.0575 * std::sin(rad) - offset_m, 2));
    };
    double piston_kg_m2 = 0;
    for (int i = 0; i < 36000; ++i) {
      const double rad = i * (kPi / 18000);
      piston_kg_m2 = std::max(piston_kg_m2, std::pow((pin_m(rad + 1e-6) - pin_m(rad - 1e-6)) / 2e-6, 2));
    }
    const auto answer_at = [&](double ratio) {
      EngineDefinition engine = without_gas(single_495());
      engine.crank.pin_offset_m = offset_m;
      engine.masses = {1, 0, 0, 0, 0, ratio / (1 - ratio) * piston_kg_m2};
      TableStorage<double, NoGas> storage;
      EXPECT_TRUE(accepted(storage.build(engine, {100e-6})));
      Engine<double, NoGas> turned;
      return turned.init(storage.tables());
    };
    // Its most is found at whole degrees: within half a degree of the true one, where s' has lost less than 1e-4 of
    // itself.
    EXPECT_TRUE(accepted(answer_at(1.001e-3))) << dead_centre_deg;
    EXPECT_TRUE(support::refuses(answer_at(0.999e-3), Reason::not_positive, "masses.crank_inertia_kg_m2"))
        << dead_centre_deg;
  }
}

TEST(CrankStepTables, FingerprintKnowsFrictionLoadAndStarterButOnlyWhereThereAreAny) {
  const auto fingerprint_of = [](const EngineDefinition& engine) {
    Drive<float> drive{};
    TableTargets<float> targets;
    targets.drive = &drive;
    EXPECT_TRUE(accepted(tabulate(engine, {100e-6}, targets)));
    return drive.fingerprint;
  };
  const EngineDefinition bare = diesel_495();
  std::vector<std::uint64_t> seen{fingerprint_of(bare)};
  for (int which = 0; which < 4; ++which) {
    EngineDefinition engine = bare;
    if (which == 0) engine.friction.linear_Pa_s = 1;
    if (which == 1) engine.machine.linear_Nm_s = 1;
    if (which == 2) engine.machine.inertia_kg_m2 = 1;
    if (which == 3) engine.starter = {1, 1};
    const std::uint64_t one = fingerprint_of(engine);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), one), 0) << which;
    seen.push_back(one);
  }
  // That engines without have the fingerprint they always had: the golden runs of an engine like the 495.
}

// ---- what the other groups say --------------------------------------------------------------------------------------

TEST(CrankStepGroups, MotionsAreDerivativesOfOneAnotherAndForcesGoWithThem) {
  EngineDefinition engine = free_diesel();
  engine.masses.crank_inertia_kg_m2 = 0.02;  // so that the speed changes a lot
  engine.starter = {50, 400};
  constexpr double kTick_s = 10e-6;
  Turned<double, Fired> run(engine, kTick_s, 100);
  typename Turned<double, Fired>::Input in;
  in.external_torque_Nm = 20;
  in.starter = 1;
  const Body<double> body = body_of(engine);
  Output<double, Fired> before{}, now{};
  double most = 0, most_rod = 0, most_crank = 0, largest = 0, least_starter_Nm = 50;
  for (int i = 0; i < 4000; ++i) {
    const Output<double, Fired> after = run.step(in);
    if (i > 2) {
      EXPECT_NEAR(now.mean_torque_Nm, (before.torque_Nm + now.torque_Nm) / 2,
                  0.2);  // of some 1000 Nm, over a tenth of a degree
      double inertia = 0.02 + 0.05 + 4 * 1.382 * 0.0575 * 0.0575;
      double rods_Nm = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        most = std::max(most, std::fabs((after.velocity_m_s[k] - before.velocity_m_s[k]) / (2 * kTick_s) -
                                        now.acceleration_m_s2[k]));
        largest = std::max(largest, std::fabs(now.acceleration_m_s2[k]));
        const double rod_rad_s2 = (after.rod_speed_rad_s[k] - before.rod_speed_rad_s[k]) / (2 * kTick_s);
        most_rod = std::max(most_rod, std::fabs(rod_rad_s2 - now.rod_acceleration_rad_s2[k]));
        const CylinderForces<double>& f = now.cylinder[k];
        EXPECT_NEAR(f.inertia_force_N, -body.reciprocating_kg * now.acceleration_m_s2[k],
                    1e-6 + 1e-9 * std::fabs(f.inertia_force_N));
        // Power into the crank is that of the gas less what the masses take.
        const double couple_Nm = body.rod_inertia_correction_kg_m2 * now.rod_acceleration_rad_s2[k];
        const double power_W = f.total_force_N * now.velocity_m_s[k] - couple_Nm * now.rod_speed_rad_s[k];
        EXPECT_NEAR(f.torque_Nm * now.speed_rad_s, power_W, 1e-5 * (1 + std::fabs(power_W)));
        const OraclePose p =
            oracle_pose(engine.crank, (deg_of(now.crank) - wide(engine.layout.firing_deg[k])) * kWidePi / 180);
        inertia += static_cast<double>(wide(body.reciprocating_kg) * p.slope_m * p.slope_m +
                                       wide(body.rod_inertia_correction_kg_m2) * p.rod_slope * p.rod_slope);
        rods_Nm += f.torque_Nm;
      }
      most_crank = std::max(
          most_crank, std::fabs((after.speed_rad_s - before.speed_rad_s) / (2 * kTick_s) - now.acceleration_rad_s2));
      EXPECT_NEAR(inertia * now.acceleration_rad_s2,
                  now.torque_Nm + now.starter_Nm - now.friction_Nm - in.external_torque_Nm, 1e-4);
      // What the rods give the crank accelerates the crankshaft itself.
      EXPECT_NEAR((0.07 + 4 * 1.382 * 0.0575 * 0.0575) * now.acceleration_rad_s2,
                  rods_Nm + now.starter_Nm - now.friction_Nm - in.external_torque_Nm, 0.02);
      least_starter_Nm = std::min(least_starter_Nm, now.starter_Nm);
    }
    before = now;
    now = after;
  }
  std::printf("differences of speeds: crank within %.2g rad/s2, pistons %.2g of %.0f m/s2, rods %.2g rad/s2\n",
              most_crank, most, largest, most_rod);
  EXPECT_LT(
      most_crank,
      2);  // of 12 000; the central difference's own error is the third derivative's, and that of pressures' kinks
  EXPECT_LT(most, 0.5);
  EXPECT_LT(most_rod, 5);
  EXPECT_GT(least_starter_Nm, 10);
}

TEST(CrankStepGroups, GivenPressuresTurnItAsTheTableDoes) {
  constexpr double kTick_s = 20e-6;
  const EngineDefinition engine = free_diesel();
  IndicatorDiagram diagram;
  ASSERT_TRUE(accepted(diagram.init(engine.crank, engine.pressure)));
  Turned<double, Fired> by_table(engine, kTick_s, 150);
  Turned<double, GivenPressure> by_input(engine, kTick_s, 150);
  for (int i = 0; i < 10000; ++i) {
    by_table.step({});
    // Pressures at the end of the tick: where the crank will be, by its speed.
    const double speed = by_input.engine.state().speed_rad_s;
    const double deg = static_cast<double>(deg_of(by_input.engine.state().phase)) + speed * kTick_s * 180 / kPi;
    typename Turned<double, GivenPressure>::Input given;
    for (std::size_t k = 0; k < 4; ++k)
      given.pressure_Pa[k] = diagram.full_Pa(std::fmod(deg - engine.layout.firing_deg[k] + 720, 720));
    by_input.step(given);
  }
  const double speed = by_table.engine.output().speed_rad_s;
  std::printf("after 0.2 s: %.4f rad/s by table, %.4f by the same pressures given\n", speed,
              by_input.engine.output().speed_rad_s);
  EXPECT_NEAR(by_input.engine.output().speed_rad_s, speed, 0.05);
}

/// Its valves, on a crank that is measured.
template <CrankGiven Given>
struct WithValves : valve_test::OneValve {
  static constexpr CrankGiven crank = Given;
  static constexpr bool rod_inertia = true;
};

TYPED_TEST(CrankStep, ValvesMoveAsOnAMeasuredCrank) {
  using Real = TypeParam;
  using Turning = WithValves<CrankGiven::torque>;
  using Measured = WithValves<CrankGiven::phase>;
  EngineDefinition engine = valve_test::engine_with(valve_test::ohc_125_train());
  engine.machine = {1, 0.01, 0, 0};
  Turned<Real, Turning> turned(engine, 50e-6, 900);
  TableStorage<Real, Measured> tables;
  ASSERT_TRUE(accepted(tables.build(engine, {50e-6})));
  Engine<Real, Measured> measured;
  ASSERT_TRUE(accepted(measured.init(tables.tables())));
  typename Engine<Real, Measured>::Input at{};
  measured.step(at);
  Real highest = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto& out = turned.step({});
    at.crank = out.crank;
    const auto& there = measured.step(at);
    ASSERT_EQ(std::memcmp(&out.valve[0][0], &there.valve[0][0], sizeof out.valve[0][0]), 0) << i;
    highest = std::max(highest, out.valve[0][0].lift_m);
  }
  EXPECT_GT(highest, static_cast<Real>(7e-3));
}

// ---- cylinders that do not fire -------------------------------------------------------------------------------------

TYPED_TEST(CrankStep, ACutCylinderHasTheMotoredPressureAndItsTorque) {
  using Real = TypeParam;
  const EngineDefinition engine = uneven_v4();
  TableStorage<Real, CutAtSpeed> tables;
  TableStorage<Real, CutAtSpeedWithForces> tables_with_forces;
  ASSERT_TRUE(accepted(tables.build(engine, {100e-6})));
  ASSERT_TRUE(accepted(tables_with_forces.build(engine, {100e-6})));
  Engine<Real, CutAtSpeed> by_curves;
  Engine<Real, CutAtSpeedWithForces> by_forces;
  ASSERT_TRUE(accepted(by_curves.init(tables.tables())));
  ASSERT_TRUE(accepted(by_forces.init(tables_with_forces.tables())));
  ExactEngine exact;
  ASSERT_TRUE(accepted(exact.init(engine)));
  Random random;
  const double scale_Nm = WorkOracle(engine, 1).gas_torque_scale_Nm();
  for (int i = 0; i < 5000; ++i) {
    typename Engine<Real, CutAtSpeed>::Input in;
    in.speed_rad_s = 200;
    in.load_ratio = static_cast<Real>(random.between(0, 2));
    in.cut_cylinders = static_cast<std::uint32_t>(random.bits());  // bits beyond the fourth mean nothing
    typename Engine<Real, CutAtSpeedWithForces>::Input same;
    same.speed_rad_s = in.speed_rad_s, same.load_ratio = in.load_ratio, same.cut_cylinders = in.cut_cylinders;
    const auto curves = static_cast<double>(by_curves.step(in).torque_Nm);
    by_forces.step(same);
    const auto deg = static_cast<double>(deg_of(by_curves.state().phase));
    double expected = 0;
    for (int k = 0; k < 4; ++k) {
      expected += exact.forces(k, deg, 200, (in.cut_cylinders >> k & 1u) != 0 ? 0 : static_cast<double>(in.load_ratio))
                      .torque_Nm;
    }
    ASSERT_NEAR(curves, expected, 5e-5 * scale_Nm) << random.trace(i);
    ASSERT_NEAR(static_cast<double>(by_forces.output().torque_Nm), expected, 5e-5 * scale_Nm) << random.trace(i);
  }
}

TYPED_TEST(CrankStep, AChangingCutLeavesNoJumpInTheWork) {
  using Real = TypeParam;
  const EngineDefinition engine = diesel_495();
  constexpr double kSpeed_rad_s = 150;
  constexpr double kLoad_ratio = 0.8;
  TableStorage<Real, CutAtSpeed> tables;
  ASSERT_TRUE(accepted(tables.build(engine, {100e-6})));
  Engine<Real, CutAtSpeed> run;
  ASSERT_TRUE(accepted(run.init(tables.tables())));
  const EngineDefinition one = with_cylinders(single_495(), {0});
  const WorkOracle motored(one, 0), fired(one, kLoad_ratio);
  const double scale_Nm = fired.gas_torque_scale_Nm();
  const auto work_J = [&](const WorkOracle& gas, int k, long double from_deg, long double to_deg) {
    const auto own = [&](long double deg) {
      const long double since = deg - wide(engine.layout.firing_deg[static_cast<std::size_t>(k)]);
      const long double cycles = std::floor(since / 720);
      return gas.gas_J(since - 720 * cycles) + cycles * wide(gas.cycle_J());
    };
    return static_cast<double>(own(to_deg) - own(from_deg));
  };
  Random random;
  double worst_Nm = 0;
  for (int i = 0; i < 3000; ++i) {
    const Phase before = run.state().phase;
    typename Engine<Real, CutAtSpeed>::Input in;
    in.speed_rad_s = static_cast<Real>(random.coin() ? kSpeed_rad_s : -kSpeed_rad_s);
    in.load_ratio = static_cast<Real>(kLoad_ratio);
    in.cut_cylinders = static_cast<std::uint32_t>(random.whole(0, 15));
    const auto mean_Nm = static_cast<double>(run.step(in).mean_torque_Nm);
    const long double turned = turned_rad(before, run.state().phase);
    const long double from_deg = deg_of(before), to_deg = from_deg + turned * 180 / kWidePi;
    double expected_J = kSpeed_rad_s * kSpeed_rad_s * static_cast<double>(fired.masses_kg_m2(0));
    for (int k = 0; k < 4; ++k) {
      const WorkOracle& gas = (in.cut_cylinders >> k & 1u) != 0 ? motored : fired;
      const long double firing = wide(engine.layout.firing_deg[static_cast<std::size_t>(k)]);
      expected_J += work_J(gas, k, from_deg, to_deg) + kSpeed_rad_s * kSpeed_rad_s *
                                                           static_cast<double>(fired.masses_kg_m2(to_deg - firing) -
                                                                               fired.masses_kg_m2(from_deg - firing));
    }
    worst_Nm = std::max(worst_Nm, std::fabs(mean_Nm - expected_J / static_cast<double>(turned)));
  }
  std::printf("mean torque with a changing cut: within %.1e of the scale\n", worst_Nm / scale_Nm);
  EXPECT_LT(worst_Nm, 5e-5 * scale_Nm);
}

// ---- float, saved bytes, any input ----------------------------------------------------------------------------------

TEST(CrankStepFloat, StaysWithDoubleThroughAStartAndARun) {
  Turned<double, Fired> in_double(free_diesel());
  Turned<float, Fired> in_float(free_diesel());
  double worst_ratio = 0;
  for (int i = 0; i < 50000; ++i) {
    const double load_ratio = i < 3000 ? 0 : 0.45 + 0.2 * std::sin(i * 1e-3);
    typename Turned<double, Fired>::Input in;
    typename Turned<float, Fired>::Input in_f;
    in.load_ratio = load_ratio, in_f.load_ratio = static_cast<float>(load_ratio);
    in.starter = in_f.starter = i < 8000 ? 1 : 0;
    const double speed = in_double.step(in).speed_rad_s;
    const auto speed_f = static_cast<double>(in_float.step(in_f).speed_rad_s);
    if (speed > 20) worst_ratio = std::max(worst_ratio, std::fabs(speed_f / speed - 1));
  }
  const double apart_rad = static_cast<double>(in_float.angle_rad - in_double.angle_rad);
  std::printf("float against double over 5 s: speed within %.1e, angle within %.1e of %.0f rad\n", worst_ratio,
              apart_rad, static_cast<double>(in_double.angle_rad));
  EXPECT_LT(worst_ratio, 5e-6);
  EXPECT_LT(std::fabs(apart_rad), 1e-6 * static_cast<double>(in_double.angle_rad));
}

TYPED_TEST(CrankStep, GoesOnFromSavedBytesWithTheSameBits) {
  using Real = TypeParam;
  Turned<Real, Fired> first(free_diesel(), 100e-6, 100);
  Turned<Real, Fired> second(free_diesel());
  typename Turned<Real, Fired>::Input in;
  in.external_torque_Nm = 17;
  for (int i = 0; i < 777; ++i) first.step(in);
  std::vector<unsigned char> bytes(kSavedStateBytes<Real, Fired>);
  ASSERT_TRUE(accepted(save_state(first.engine, bytes.data(), bytes.size())));
  ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), second.engine)));
  for (int i = 0; i < 777; ++i) {
    const auto& a = first.step(in);
    const auto& b = second.step(in);
    ASSERT_EQ(a.speed_rad_s, b.speed_rad_s);
    ASSERT_EQ(a.mean_torque_Nm, b.mean_torque_Nm);
    ASSERT_EQ(a.crank.units(), b.crank.units());
  }
}

/// Bits as they come, or numbers that mean something.
template <class Real>
Real any_number(Random& random) {
  Real x;
  const std::uint64_t bits = random.bits();
  std::memcpy(&x, &bits, sizeof x);
  return random.whole(0, 3) == 0 ? x : static_cast<Real>(random.between(-1, 1) * std::pow(10.0, random.whole(-3, 8)));
}

template <class Real, class S>
void survives_anything(const EngineDefinition& engine, double tick_s, int ticks, const char* name,
                       bool overspeeds = true) {
  Turned<Real, S> run(engine, tick_s);
  const auto limit = static_cast<double>(run.engine.tables()->drive->speed_limit_rad_s);
  Random random;
  std::uint32_t seen = 0;
  int bad = 0;
  for (int i = 0; i < ticks; ++i) {
    typename Turned<Real, S>::Input in;
    in.external_torque_Nm = any_number<Real>(random);
    in.starter = static_cast<std::uint32_t>(random.bits());
    if constexpr (Needs<S>::load)
      in.load_ratio = random.coin() ? static_cast<Real>(random.between(0, 2)) : any_number<Real>(random);
    if constexpr (Needs<S>::cut) in.cut_cylinders = static_cast<std::uint32_t>(random.bits());
    if constexpr (Needs<S>::input_pressure) {
      for (Real& pressure : in.pressure_Pa) pressure = any_number<Real>(random);
    }
    const auto& out = run.engine.step(in);
    seen |= out.faults;
    support::each_output(
        out, support::Used{static_cast<std::size_t>(engine.layout.cylinders), 0, 0},
        [&](const char*, std::size_t, auto x) { bad += std::isfinite(static_cast<double>(x)) ? 0 : 1; });
    ASSERT_EQ(bad, 0) << name << ", " << random.trace(i);
    ASSERT_LE(std::fabs(static_cast<double>(out.speed_rad_s)), limit * 1.0000001) << name << ", " << random.trace(i);
    const auto& state = run.engine.state();
    ASSERT_NEAR(static_cast<double>(state.reduced_speed * state.per_root_inertia), static_cast<double>(out.speed_rad_s),
                1e-5 * limit)
        << name << ", " << random.trace(i);
  }
  EXPECT_NE(seen & kFaultExternalTorque, 0u) << name;
  EXPECT_EQ((seen & kFaultOverspeed) != 0, overspeeds) << name;
}

/// As extreme as a definition may be.
EngineDefinition extreme(bool heavy) {
  EngineDefinition engine = diesel_495();
  if (heavy) {
    engine.crank = {2, 2, 4.1, 0, 20};
    engine.masses = {1e4, 1e4, 1e4, 1e6, 1e4, 1e6};
    engine.friction = {1e7, 1e6, 1e6};
    engine.machine = {1e7, 1e6, 1e6, 1e6};
  } else {
    engine.crank = {0.001, 1e-4, 3e-4, 0, 20};
    engine.masses = {1e-4, 0, 0, 0, 0, 1.1e-9};
    engine.machine = {0, 0, 1e6, 0};
  }
  engine.starter = {1e7, 1e-9};
  return engine;
}

TYPED_TEST(CrankStep, AnyInputGivesFiniteOutputsWithinTheSpeedLimit) {
  using Real = TypeParam;
  survives_anything<Real, Fired>(free_diesel(), 100e-6, 1'000'000, "free diesel");
  survives_anything<Real, GivenPressure>(free_diesel(), 2e-3, 100'000, "given pressure");
  survives_anything<Real, Fired>(extreme(true), 2e-3, 100'000, "heavy", false);  // its friction holds it
  survives_anything<Real, GivenPressure>(extreme(true), 2e-3, 100'000, "heavy, given pressure", false);
  survives_anything<Real, Fired>(extreme(false), 1e-6, 100'000, "light");
  survives_anything<Real, GivenPressure>(extreme(false), 2e-3, 100'000, "light, given pressure");
}

TYPED_TEST(CrankStep, TurnsTheShortestRodThatIsAcceptedWithFiniteNumbersThroughEveryDegree) {
  using Real = TypeParam;
  for (const double offset_m : {0.0, 0.010, -0.010}) {
    EngineDefinition engine = without_gas(free_diesel());
    engine.crank.pin_offset_m = offset_m;
    engine.masses.rod_inertia_correction_kg_m2 = 0;  // a rod so short cannot have less than two masses have
    const auto storage = std::make_unique<TableStorage<Real, NoGas>>();
    engine.crank.rod_length_m = std::nextafter(engine.crank.crank_radius_m + std::fabs(offset_m), 1);
    EXPECT_EQ(storage->build(engine, {100e-6}).reason, Reason::rod_too_short) << offset_m;
    engine.crank.rod_length_m = std::nextafter(engine.crank.least_rod_length_m(), 1);
    ASSERT_TRUE(accepted(storage->build(engine, {100e-6})));
    for (int degree = 0; degree < 360; ++degree) {
      Engine<Real, NoGas> free;
      ASSERT_TRUE(accepted(free.init(storage->tables(), phase_at_deg(degree))));
      typename Engine<Real, NoGas>::Input in;
      in.starter = 1;
      for (int i = 0; i < 100; ++i) {
        const auto& out = free.step(in);
        ASSERT_TRUE(std::isfinite(out.speed_rad_s) && std::isfinite(out.torque_Nm) && std::isfinite(out.mean_torque_Nm))
            << degree << " " << i;
        for (const Real acceleration : out.acceleration_m_s2)
          ASSERT_TRUE(std::isfinite(acceleration)) << degree << " " << i;
      }
      ASSERT_GT(free.output().speed_rad_s, Real{0}) << degree;
    }
  }
}

TEST(CrankTables, AreRefusedWhereOneThatTheSceneReadsIsMissing) {
  using S = scenes::FreeRunning;
  const auto storage = std::make_unique<TableStorage<float, S>>();
  ASSERT_TRUE(accepted(storage->build(free_diesel(), {100e-6})));
  const auto refused_without = [&](auto take) {
    auto tables = storage->tables();
    take(tables);
    Engine<float, S> engine;
    const Status status = engine.init(tables);
    return status.reason == Reason::missing_table;
  };
  EXPECT_FALSE(refused_without([](auto&) {}));
  EXPECT_TRUE(refused_without([](auto& t) { t.crank_dynamics = nullptr; }));
  EXPECT_TRUE(refused_without([](auto& t) { t.cut_grid = nullptr; }));
  EXPECT_TRUE(refused_without([](auto& t) { t.cut_torque = nullptr; }));
  EXPECT_TRUE(refused_without([](auto& t) { t.triggers = nullptr; }));
  EXPECT_TRUE(refused_without([](auto& t) { t.drive = nullptr; }));
}

}  // namespace
}  // namespace crankloop::crank_step_test

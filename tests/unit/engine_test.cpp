// The engine as its user meets it: what init refuses, what bad input does, snapshots, neighbours, sizes; and its forces
// against exact ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <crankloop/tabulate/summary.hpp>

#include "support/output_numbers.hpp"
#include "support/random.hpp"
#include "support/test_engines.hpp"
#include "support/test_scenes.hpp"
#include "support/tick_oracle.hpp"

namespace crankloop {
namespace {

using namespace tick_test;
using support::Random;

constexpr double kTick_s = 100e-6;
constexpr PressureGiven kByTable = PressureGiven::by_table;
constexpr PressureGiven kByInput = PressureGiven::by_input;

using Everything = Asking<kAllGroups, kByTable, true>;
using EverythingByInput = Asking<kAllGroups, kByInput>;
using EverythingByPhase = Asking<kAllGroups, kByTable, true, CrankGiven::phase>;
using EverythingOfFour = Asking<kAllGroups, kByTable, true, CrankGiven::speed, 4>;
using TorqueOfFour = Asking<kTorque | kMeanTorque, kByTable, false, CrankGiven::speed, 4>;

template <class Real>
class EngineOf : public ::testing::Test {
 protected:
  /// The 495's tables, built once for all tests of a scalar.
  static const FullTables<Real>& diesel() {
    static const std::unique_ptr<FullTables<Real>> tables = [] {
      auto built = std::make_unique<FullTables<Real>>();
      EXPECT_TRUE(built->build(diesel_495(), kTick_s).ok());
      return built;
    }();
    return *tables;
  }
};
TYPED_TEST_SUITE(EngineOf, BothReals, RealName);

template <class Real>
constexpr Real kNaN = std::numeric_limits<Real>::quiet_NaN();
template <class Real>
constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

// ---- before init, and what init refuses -----------------------------------------------------------------------------

TYPED_TEST(EngineOf, DefaultConstructedAnswersZerosAndNotReadyHoweverOftenItIsStepped) {
  using Real = TypeParam;
  static Engine<Real, EverythingByInput> engine;  // constant-initialised
  auto in = at_speed<Engine<Real, EverythingByInput>>(200);
  for (Real& pressure : in.pressure_Pa) pressure = static_cast<Real>(5e6);
  for (int tick = 0; tick < 3; ++tick) {
    const auto& out = engine.step(in);
    EXPECT_EQ(out.faults, kFaultNotReady);
    EXPECT_TRUE(all_zero(all_numbers<Real>(out)));
  }
  EXPECT_EQ(engine.state().ticks, 0u);
  EXPECT_EQ(engine.restore(engine.state()).reason, Reason::missing_table);
}

TYPED_TEST(EngineOf, StartsWithoutFaultsAtRestAtTheGivenPhase) {
  using Real = TypeParam;
  const Phase start = phase_at_deg(77.5L);
  Running<Real, Everything> run(this->diesel(), start);
  EXPECT_EQ(run.engine.output().faults, 0u);
  EXPECT_EQ(run.engine.state().phase.units(), start.units());
  const auto& out = run.engine.step({});
  EXPECT_EQ(out.faults, 0u);
  EXPECT_EQ(run.engine.state().phase.units(), start.units());
  EXPECT_NEAR(static_cast<double>(out.displacement_m[0]),
              static_cast<double>(oracle_pose(single_495().crank, 77.5L * kPi_ld / 180).displacement_m), 3e-8);
}

/// Drops one section; true where the scene needs it and so init must refuse.
template <class Real, class S>
std::vector<std::pair<std::string, bool>> init_with_one_section_missing(const Sections<Real>& whole) {
  using N = Needs<S>;
  struct Missing {
    const char* name;
    bool needed;
    void (*drop)(Sections<Real>&);
  };
  const Missing sections[] = {
      {"drive", true, [](Sections<Real>& s) { s.drive = nullptr; }},
      {"body", N::body, [](Sections<Real>& s) { s.body = nullptr; }},
      {"stroke", N::stroke, [](Sections<Real>& s) { s.stroke = nullptr; }},
      {"acceleration", N::acceleration, [](Sections<Real>& s) { s.acceleration = nullptr; }},
      {"rod_tilt", N::rod_tilt, [](Sections<Real>& s) { s.rod_tilt = nullptr; }},
      {"radial", N::rod_tilt, [](Sections<Real>& s) { s.radial = nullptr; }},
      {"rod_angle", N::rod_angle, [](Sections<Real>& s) { s.rod_angle = nullptr; }},
      {"rod_curvature", N::rod_curvature, [](Sections<Real>& s) { s.rod_curvature = nullptr; }},
      {"inertia_torque", N::inertia_torque, [](Sections<Real>& s) { s.inertia_torque = nullptr; }},
      {"gas_grid", N::gas_grid, [](Sections<Real>& s) { s.gas_grid = nullptr; }},
      {"pressure_full", N::gas_pressure && !N::load, [](Sections<Real>& s) { s.pressure_full = nullptr; }},
      {"pressure_motored", N::gas_pressure && N::load, [](Sections<Real>& s) { s.pressure_motored = nullptr; }},
      {"pressure_heat", N::gas_pressure && N::load, [](Sections<Real>& s) { s.pressure_heat = nullptr; }},
      {"gas_torque_full", N::gas_torque && !N::load, [](Sections<Real>& s) { s.gas_torque_full = nullptr; }},
      {"gas_torque_motored", N::gas_torque && N::load, [](Sections<Real>& s) { s.gas_torque_motored = nullptr; }},
      {"gas_torque_heat", N::gas_torque && N::load, [](Sections<Real>& s) { s.gas_torque_heat = nullptr; }},
      {"bearings", S::bearing_loads, [](Sections<Real>& s) { s.bearings = nullptr; }},
      {"balance", S::free_forces, [](Sections<Real>& s) { s.balance = nullptr; }},
  };
  std::vector<std::pair<std::string, bool>> wrong;
  for (const Missing& missing : sections) {
    Sections<Real> s = whole;
    missing.drop(s);
    const Tables<Real, S> complete(whole);
    const Tables<Real, S> tables(s);
    Engine<Real, S> engine;
    EXPECT_TRUE(engine.init(complete).ok());
    const Status status = engine.init(tables);
    const bool refused = status.reason == Reason::missing_table;
    if (refused != missing.needed) wrong.emplace_back(missing.name, refused);
    // A refusal leaves no engine behind, not even the one there was.
    const auto faults = engine.step({}).faults;
    EXPECT_EQ(faults == kFaultNotReady, refused) << missing.name;
  }
  return wrong;
}

TYPED_TEST(EngineOf, InitRefusesEverySectionThatIsMissingAndMissesNoneItDoesNotNeed) {
  using Real = TypeParam;
  using Wrong = std::vector<std::pair<std::string, bool>>;
  const Sections<Real>& s = this->diesel().sections();
  EXPECT_EQ((init_with_one_section_missing<Real, Everything>(s)), Wrong{});
  EXPECT_EQ((init_with_one_section_missing<Real, EverythingByInput>(s)), Wrong{});
  EXPECT_EQ((init_with_one_section_missing<Real, Asking<kAllGroups>>(s)), Wrong{});
  EXPECT_EQ((init_with_one_section_missing<Real, TorqueOfFour>(s)), Wrong{});
  EXPECT_EQ((init_with_one_section_missing<Real, Asking<kKinematics>>(s)), Wrong{});
  EXPECT_EQ((init_with_one_section_missing<Real, Asking<kRodMotion, PressureGiven::none>>(s)), Wrong{});
  EXPECT_EQ((init_with_one_section_missing<Real, Asking<kMeanTorque, kByInput>>(s)), Wrong{});
  EXPECT_EQ((init_with_one_section_missing<Real, Asking<kTorque, kByTable, true>>(s)), Wrong{});
}

TYPED_TEST(EngineOf, ASceneOfFreeForcesAloneStartsAndSteps) {
  using Real = TypeParam;
  FullTables<Real> tables;
  ASSERT_TRUE(tables.build(with_cylinders(single_495(), {0, 120, 240, 375, 480, 600}), kTick_s).ok());
  Running<Real, Asking<kFreeForces, PressureGiven::none>> alone(tables);
  Running<Real, Asking<kFreeForces | kTorque, PressureGiven::none>> accompanied(tables);
  for (int tick = 0; tick < 100; ++tick) {
    const auto& out = alone.engine.step(at_speed<Engine<Real, Asking<kFreeForces, PressureGiven::none>>>(300));
    const auto& other =
        accompanied.engine.step(at_speed<Engine<Real, Asking<kFreeForces | kTorque, PressureGiven::none>>>(300));
    ASSERT_TRUE(same_bits(numbers<kFreeForces>(out, in_use(tables)), numbers<kFreeForces>(other, in_use(tables))));
  }
}

TYPED_TEST(EngineOf, ASceneThatAsksForNothingStillCountsTheAngle) {
  using Real = TypeParam;
  using Nothing = Asking<0, PressureGiven::none>;
  Running<Real, Nothing> run(this->diesel());
  EXPECT_EQ(run.engine.step(at_speed<Engine<Real, Nothing>>(100)).faults, 0u);
  EXPECT_GT(run.engine.state().phase.units(), 0u);
}

template <class Real, std::uint32_t Cylinders, bool Exact>
struct Counting : Scene {
  static constexpr Count cylinders{Cylinders, Exact};
  static constexpr bool kinematics = true;
  static constexpr bool torque = true;
  static constexpr bool rod_inertia = true;
};
template <class Real, std::uint32_t Cylinders, bool Exact>
Status init_of(const FullTables<Real>& full) {
  using S = Counting<Real, Cylinders, Exact>;
  const Tables<Real, S> tables(full.sections());
  Engine<Real, S> engine;
  return engine.init(tables);
}

TYPED_TEST(EngineOf, InitTakesExactlyItsCylindersOrUpToItsCapacity) {
  using Real = TypeParam;
  FullTables<Real> three;
  FullTables<Real> sixteen;
  ASSERT_TRUE(three.build(with_cylinders(single_495(), {0, 240, 480}), kTick_s).ok());
  ASSERT_TRUE(sixteen.build(with_cylinders(single_495(), std::vector<double>(16, 0.0)), kTick_s).ok());
  const FullTables<Real>& four = this->diesel();
  EXPECT_TRUE((init_of<Real, 4, true>(four)).ok());
  EXPECT_EQ((init_of<Real, 4, true>(three)).reason, Reason::out_of_range);
  EXPECT_EQ((init_of<Real, 3, true>(four)).reason, Reason::out_of_range);
  EXPECT_EQ((init_of<Real, 1, true>(four)).reason, Reason::out_of_range);
  EXPECT_TRUE((init_of<Real, 4, false>(three)).ok());
  EXPECT_TRUE((init_of<Real, 4, false>(four)).ok());
  EXPECT_EQ((init_of<Real, 3, false>(four)).reason, Reason::out_of_range);
  EXPECT_TRUE((init_of<Real, 16, false>(sixteen)).ok());
  EXPECT_TRUE((init_of<Real, 16, true>(sixteen)).ok());
  EXPECT_EQ((init_of<Real, 15, false>(sixteen)).reason, Reason::out_of_range);
  EXPECT_STREQ((init_of<Real, 15, false>(sixteen)).field, "tables.cylinders");
}

struct ForcesWithoutRodInertia : Scene {
  static constexpr auto cylinders = up_to<16>;
  static constexpr bool forces = true;
};
TYPED_TEST(EngineOf, InitRefusesToLeaveOutARodInertiaThatTheEngineHas) {
  using Real = TypeParam;
  const Tables<Real, ForcesWithoutRodInertia> with_inertia(this->diesel().sections());
  Engine<Real, ForcesWithoutRodInertia> engine;
  const Status status = engine.init(with_inertia);
  EXPECT_EQ(status.reason, Reason::inconsistent);
  EXPECT_STREQ(status.field, "scene.rod_inertia");
  EngineDefinition two_mass = diesel_495();
  two_mass.masses.rod_inertia_correction_kg_m2 = 0;
  FullTables<Real> tables;
  ASSERT_TRUE(tables.build(two_mass, kTick_s).ok());
  const Tables<Real, ForcesWithoutRodInertia> without(tables.sections());
  EXPECT_TRUE(engine.init(without).ok());
}

// ---- bad input ------------------------------------------------------------------------------------------------------

TYPED_TEST(EngineOf, AnyBadSpeedOrLoadIsReplacedByTheLastGoodOneAndFlaggedForThatTickOnly) {
  using Real = TypeParam;
  const Real limit = this->diesel().drive().speed_limit_rad_s;
  const Real bad_speeds[] = {kNaN<Real>,
                             -kNaN<Real>,
                             kInfinity<Real>,
                             -kInfinity<Real>,
                             std::numeric_limits<Real>::max(),
                             std::numeric_limits<Real>::lowest(),
                             std::nextafter(limit, kInfinity<Real>),
                             -std::nextafter(limit, kInfinity<Real>)};
  const Real bad_loads[] = {kNaN<Real>,
                            kInfinity<Real>,
                            -kInfinity<Real>,
                            std::nextafter(Real{2}, Real{3}),
                            -std::numeric_limits<Real>::denorm_min(),
                            Real{-1}};
  for (int which = 0; which < 2; ++which) {
    const bool speed_is_bad = which == 0;
    for (const Real bad : speed_is_bad ? std::vector<Real>(std::begin(bad_speeds), std::end(bad_speeds))
                                       : std::vector<Real>(std::begin(bad_loads), std::end(bad_loads))) {
      Running<Real, Everything> hurt(this->diesel(), phase_at_deg(11));
      Running<Real, Everything> sound(this->diesel(), phase_at_deg(11));
      typename Engine<Real, Everything>::Input in;
      in.speed_rad_s = Real{210};
      in.load_ratio = static_cast<Real>(0.625);
      for (int tick = 0; tick < 8; ++tick) {
        auto given = in;
        const bool now = tick >= 3 && tick < 5;
        if (now && speed_is_bad) given.speed_rad_s = bad;
        if (now && !speed_is_bad) given.load_ratio = bad;
        const auto& out = hurt.engine.step(given);
        const auto& want = sound.engine.step(in);
        ASSERT_EQ(out.faults, now ? (speed_is_bad ? kFaultSpeed : kFaultLoadRatio) : 0u)
            << "input " << bad << ", tick " << tick;
        ASSERT_TRUE(same_bits(all_numbers<Real>(out), all_numbers<Real>(want))) << "input " << bad << ", tick " << tick;
      }
    }
  }
}

TYPED_TEST(EngineOf, ABadFirstInputFindsAnEngineAtRestAtFullLoad) {
  using Real = TypeParam;
  Running<Real, Everything> hurt(this->diesel(), phase_at_deg(30));
  Running<Real, Everything> sound(this->diesel(), phase_at_deg(30));
  typename Engine<Real, Everything>::Input in;
  in.speed_rad_s = kNaN<Real>;
  in.load_ratio = kNaN<Real>;
  const auto& out = hurt.engine.step(in);
  EXPECT_EQ(out.faults, std::uint32_t{kFaultSpeed} | std::uint32_t{kFaultLoadRatio});
  EXPECT_TRUE(same_bits(all_numbers<Real>(out), all_numbers<Real>(sound.engine.step({}))));
}

TYPED_TEST(EngineOf, TheSpeedLimitItselfIsGoodInBothDirectionsAndTurnsTheCrankItsWay) {
  using Real = TypeParam;
  for (const double tick_s : {100e-6, 2e-3}) {
    FullTables<Real> tables;
    ASSERT_TRUE(tables.build(diesel_495(), tick_s).ok());
    const Real limit = tables.drive().speed_limit_rad_s;
    for (const Real speed : {limit, -limit}) {
      Running<Real, Everything> run(tables);
      typename Engine<Real, Everything>::Input in;
      in.speed_rad_s = speed;
      EXPECT_EQ(run.engine.step(in).faults, 0u);
      EXPECT_EQ(run.engine.state().phase.template signed_cycles<double>() > 0, speed > Real{0}) << tick_s;
      EXPECT_TRUE(all_finite(all_numbers<Real>(run.engine.output())));
    }
  }
}

TYPED_TEST(EngineOf, ABadPressureFallsBackForItsOwnCylinderOnly) {
  using Real = TypeParam;
  const Real bad_pressures[] = {kNaN<Real>,
                                kInfinity<Real>,
                                -kInfinity<Real>,
                                Real{-1},
                                -std::numeric_limits<Real>::denorm_min(),
                                std::nextafter(static_cast<Real>(1e8), kInfinity<Real>),
                                std::numeric_limits<Real>::max()};
  for (const Real bad : bad_pressures) {
    for (std::size_t cylinder = 0; cylinder < 4; ++cylinder) {
      Running<Real, EverythingByInput> hurt(this->diesel());
      Running<Real, EverythingByInput> sound(this->diesel());
      auto in = at_speed<Engine<Real, EverythingByInput>>(150);
      for (int tick = 0; tick < 6; ++tick) {
        for (std::size_t k = 0; k < 4; ++k) in.pressure_Pa[k] = static_cast<Real>(1e5) * static_cast<Real>(1 + k);
        auto given = in;
        // The others go on changing; the hurt one's last good pressure is what it was.
        for (std::size_t k = 0; k < 4; ++k) {
          if (k != cylinder)
            given.pressure_Pa[k] = in.pressure_Pa[k] = in.pressure_Pa[k] + Real{1000} * static_cast<Real>(tick);
        }
        if (tick == 3) given.pressure_Pa[cylinder] = bad;
        const auto& out = hurt.engine.step(given);
        const auto& want = sound.engine.step(in);
        ASSERT_EQ(out.faults, tick == 3 ? kFaultPressure : 0u) << bad << " in cylinder " << cylinder;
        ASSERT_TRUE(same_bits(all_numbers<Real>(out), all_numbers<Real>(want)))
            << bad << " in cylinder " << cylinder << ", tick " << tick;
      }
    }
  }
}

TYPED_TEST(EngineOf, PressuresOfCylindersThatTheEngineDoesNotHaveAreNotLookedAt) {
  using Real = TypeParam;
  Running<Real, EverythingByInput> run(this->diesel());
  typename Engine<Real, EverythingByInput>::Input in;
  for (std::size_t k = 4; k < 16; ++k) in.pressure_Pa[k] = kNaN<Real>;
  EXPECT_EQ(run.engine.step(in).faults, 0u);
  EXPECT_TRUE(all_finite(all_numbers<Real>(run.engine.output())));
}

TYPED_TEST(EngineOf, TheLimitsOfLoadAndPressureAreGoodAndSoIsMinusZero) {
  using Real = TypeParam;
  Running<Real, Everything> by_load(this->diesel());
  typename Engine<Real, Everything>::Input in;
  for (const Real load : {Real{0}, -Real{0}, Real{2}, std::numeric_limits<Real>::denorm_min()}) {
    in.load_ratio = load;
    for (const Real speed :
         {Real{0}, -Real{0}, std::numeric_limits<Real>::denorm_min(), -std::numeric_limits<Real>::min()}) {
      in.speed_rad_s = speed;
      EXPECT_EQ(by_load.engine.step(in).faults, 0u);
      EXPECT_EQ(by_load.engine.state().phase.units(), 0u) << "speed " << speed;
      EXPECT_TRUE(all_finite(all_numbers<Real>(by_load.engine.output())));
    }
  }
  Running<Real, EverythingByInput> by_input(this->diesel());
  typename Engine<Real, EverythingByInput>::Input pressures;
  for (const Real pressure : {Real{0}, -Real{0}, static_cast<Real>(1e8)}) {
    for (Real& p : pressures.pressure_Pa) p = pressure;
    EXPECT_EQ(by_input.engine.step(pressures).faults, 0u);
  }
}

template <class Real>
Real any_bits(Random& random) {
  // A third ordinary numbers, a third of any size, a third any bits: NaNs, infinities and subnormal numbers among them.
  switch (random.whole(0, 2)) {
    case 0:
      return static_cast<Real>(random.between(-1000, 1000));
    case 1:
      return static_cast<Real>(std::ldexp(random.between(-1, 1), random.whole(-120, 120)));
    default:
      break;
  }
  using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
  const auto bits = static_cast<Bits>(random.bits());
  Real x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

TYPED_TEST(EngineOf, WhateverBitsComeInTheOutputIsFiniteAndOnlyKnownFaultsAreRaised) {
  using Real = TypeParam;
  Random random;
  FullTables<Real> tables;
  ASSERT_TRUE(tables.build(uneven_v4(), kTick_s).ok());
  Running<Real, Everything> by_speed(tables);
  Running<Real, EverythingByInput> by_input(tables);
  Running<Real, EverythingByPhase> by_phase(tables);
  for (int draw = 0; draw < 20'000; ++draw) {
    typename Engine<Real, Everything>::Input in;
    in.speed_rad_s = any_bits<Real>(random);
    in.load_ratio = any_bits<Real>(random);
    const auto& out = by_speed.engine.step(in);
    ASSERT_TRUE(all_finite(all_numbers<Real>(out)))
        << random.trace(draw) << ", speed " << in.speed_rad_s << ", load " << in.load_ratio;
    ASSERT_EQ(out.faults & ~(std::uint32_t{kFaultSpeed} | std::uint32_t{kFaultLoadRatio}), 0u);

    typename Engine<Real, EverythingByInput>::Input pressures;
    pressures.speed_rad_s = any_bits<Real>(random);
    for (Real& p : pressures.pressure_Pa) p = any_bits<Real>(random);
    const auto& out_2 = by_input.engine.step(pressures);
    ASSERT_TRUE(all_finite(all_numbers<Real>(out_2))) << random.trace(draw);
    ASSERT_EQ(out_2.faults & ~(std::uint32_t{kFaultSpeed} | std::uint32_t{kFaultPressure}), 0u);

    typename Engine<Real, EverythingByPhase>::Input phase;
    phase.crank = Phase{random.bits() >> random.whole(0, 60)};
    phase.load_ratio = any_bits<Real>(random);
    const auto& out_3 = by_phase.engine.step(phase);
    ASSERT_TRUE(all_finite(all_numbers<Real>(out_3))) << random.trace(draw);
    ASSERT_EQ(out_3.faults & ~(std::uint32_t{kFaultPhaseJump} | std::uint32_t{kFaultLoadRatio}), 0u);
  }
}

TYPED_TEST(EngineOf, TheLargestEngineThatADefinitionAllowsStaysFiniteAtItsSpeedLimit) {
  using Real = TypeParam;
  EngineDefinition giant = with_cylinders(single_495(), std::vector<double>(16, 0.0));
  giant.crank = {2, 2, 10, -2, 100};
  giant.masses = {9.9e3, 50, 1e4, 1e6, 1e4, 1e6};
  giant.layout.pin.fill(0);
  giant.layout.position_m.fill(0);
  giant.pressure = Pressure{};
  for (const double tick_s : {1e-6, 2e-3}) {
    FullTables<Real> tables;
    const Status status = tables.build(giant, tick_s);
    ASSERT_TRUE(status.ok()) << status.field << " " << describe(status.reason);
    Running<Real, EverythingByInput> run(tables);
    typename Engine<Real, EverythingByInput>::Input in;
    for (Real& p : in.pressure_Pa) p = static_cast<Real>(1e8);
    for (int tick = 0; tick < 2000; ++tick) {
      in.speed_rad_s = (tick % 3 == 0 ? Real{-1} : Real{1}) * tables.drive().speed_limit_rad_s;
      ASSERT_EQ(run.engine.step(in).faults, 0u);
      ASSERT_TRUE(all_finite(all_numbers<Real>(run.engine.output()))) << "tick " << tick;
    }
  }
}

// ---- rotation -------------------------------------------------------------------------------------------------------

TYPED_TEST(EngineOf, TurningBackwardsRetracesTheSamePositionsPressuresAndForces) {
  using Real = TypeParam;
  Running<Real, Everything> run(this->diesel(), phase_at_deg(3));
  const InUse use = in_use(this->diesel());
  std::vector<std::vector<Real>> forces;
  std::vector<std::vector<Real>> motion;
  for (int tick = 0; tick < 1000; ++tick) {
    const auto& out = run.engine.step(at_speed<Engine<Real, Everything>>(190));
    forces.push_back(numbers<kForces | kBearingLoads | kFreeForces | kTorque>(out, use));
    motion.push_back(numbers<kKinematics | kRodMotion>(out, use));
  }
  const std::size_t n = use.cylinders;
  for (std::size_t tick = 998; tick < 999; --tick) {
    const auto& out = run.engine.step(at_speed<Engine<Real, Everything>>(-190));
    ASSERT_TRUE(same_bits(numbers<kForces | kBearingLoads | kFreeForces | kTorque>(out, use), forces[tick])) << tick;
    const std::vector<Real> now = numbers<kKinematics | kRodMotion>(out, use);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const bool speed = i / n == 1 || i / n == 4;  // velocity, rod speed
      ASSERT_EQ(now[i], speed ? -motion[tick][i] : motion[tick][i]) << "tick " << tick << ", number " << i;
    }
  }
  EXPECT_EQ(run.engine.state().phase.units(), (phase_at_deg(3) + (run.engine.state().phase - phase_at_deg(3))).units());
}

TYPED_TEST(EngineOf, AtStandstillNothingMovesAndOnlyGasPushes) {
  using Real = TypeParam;
  Running<Real, Everything> run(this->diesel(), phase_at_deg(400));
  run.engine.step(at_speed<Engine<Real, Everything>>(200));
  run.engine.step({});
  run.engine.step({});  // the first tick at rest still averages with the torque of the masses before
  const std::vector<Real> first = all_numbers<Real>(run.engine.output());
  for (int tick = 0; tick < 100; ++tick) run.engine.step({});
  EXPECT_TRUE(same_bits(all_numbers<Real>(run.engine.output()), first));
  const auto& out = run.engine.output();
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(out.velocity_m_s[k], Real{0});
    EXPECT_EQ(out.acceleration_m_s2[k], Real{0});
    EXPECT_EQ(out.cylinder[k].inertia_force_N, Real{0});
    EXPECT_EQ(out.cylinder[k].total_force_N, out.cylinder[k].gas_force_N);
  }
  EXPECT_EQ(out.first.up_N, Real{0});
}

TYPED_TEST(EngineOf, AtAConstantSpeedTheCrankIsWhereSpeedTimesTimeSays) {
  using Real = TypeParam;
  Running<Real, Asking<kKinematics>> run(this->diesel());
  const double speed = 209.4395;
  const auto in = at_speed<Engine<Real, Asking<kKinematics>>>(speed);
  constexpr int kTicks = 1'000'000;  // 100 s, 3333 revolutions
  for (int tick = 0; tick < kTicks; ++tick) run.engine.step(in);
  // The increment is rounded once, in Real: 1e6 ticks later the angle is off by that rounding and by nothing else.
  const double turned_cycles = static_cast<double>(in.speed_rad_s) * kTick_s * kTicks / (4 * kPi);
  const double expected = turned_cycles - std::floor(turned_cycles);
  double off = std::fabs(static_cast<double>(run.engine.state().phase.units()) * 0x1p-64 - expected);
  off = std::min(off, 1 - off);
  EXPECT_LE(off, turned_cycles * 2 * static_cast<double>(std::numeric_limits<Real>::epsilon()));
}

// ---- a measured angle -----------------------------------------------------------------------------------------------

TYPED_TEST(EngineOf, GivenAPhaseWorksOutTheSpeedFromTheIncrementAlsoAcross720AndBackwards) {
  using Real = TypeParam;
  using InputOf = Engine<Real, EverythingByPhase>;
  const Phase start = phase_at_deg(719.5L);
  for (const double step_deg : {0.3, -0.3, 5.0, -5.0, 1e-5, -1e-5}) {
    Running<Real, EverythingByPhase> run(this->diesel(), start);
    long double at = 719.5L;
    for (int tick = 0; tick < 400; ++tick) {
      at += static_cast<long double>(step_deg);
      const auto& out = run.engine.step(at_phase<InputOf>(phase_at_deg(at - 720 * std::floor(at / 720))));
      ASSERT_EQ(out.faults, 0u) << step_deg << ", tick " << tick;
      if (tick == 0) continue;  // a first angle says nothing of the speed
      const double want = step_deg * kPi / 180 / kTick_s;
      ASSERT_NEAR(static_cast<double>(run.engine.state().speed_rad_s), want,
                  std::fabs(want) * (4 * static_cast<double>(std::numeric_limits<Real>::epsilon()) + 1e-12) + 1e-9)
          << step_deg << ", tick " << tick;
    }
  }
}

TYPED_TEST(EngineOf, GivenAPhaseAnswersTheSameAsGivenTheSpeedThatLeadsThere) {
  using Real = TypeParam;
  Running<Real, Everything> by_speed(this->diesel());
  Running<Real, EverythingByPhase> by_phase(this->diesel());
  const InUse use = in_use(this->diesel());
  for (int tick = 0; tick < 2000; ++tick) {
    by_speed.engine.step(at_speed<Engine<Real, Everything>>(157));
    by_phase.engine.step(at_phase<Engine<Real, EverythingByPhase>>(by_speed.engine.state().phase));
    // Same place, so the same bits of all that does not depend on speed; the speed itself is rounded twice more.
    const auto& a = by_speed.engine.output();
    const auto& b = by_phase.engine.output();
    for (std::size_t k = 0; k < use.cylinders; ++k) {
      ASSERT_EQ(a.displacement_m[k], b.displacement_m[k]);
      ASSERT_EQ(a.cylinder[k].pressure_Pa, b.cylinder[k].pressure_Pa);
      ASSERT_EQ(a.rod_angle_rad[k], b.rod_angle_rad[k]);
    }
    if (tick == 0) continue;  // a first angle says nothing of the speed
    const auto torque = static_cast<double>(a.torque_Nm);
    ASSERT_NEAR(static_cast<double>(b.torque_Nm), torque,
                4000 * 8 * static_cast<double>(std::numeric_limits<Real>::epsilon()))
        << tick;
    ASSERT_NEAR(static_cast<double>(b.mean_torque_Nm), static_cast<double>(a.mean_torque_Nm),
                4000 * 32 * static_cast<double>(std::numeric_limits<Real>::epsilon()))
        << tick;
  }
}

TYPED_TEST(EngineOf, AfterAPhaseJumpTheFaultIsRaisedOnceTheSpeedIsTheLastGoodOneAndMeanTorqueIsTheTicksOwn) {
  using Real = TypeParam;
  using E = Engine<Real, EverythingByPhase>;
  for (const long double jump_deg : {90.0L, 200.0L, 360.0L, 500.0L, 650.0L}) {
    Running<Real, EverythingByPhase> run(this->diesel(), phase_at_deg(20));
    Phase at = phase_at_deg(20);
    for (int tick = 0; tick < 10; ++tick) run.engine.step(at_phase<E>(at += phase_at_deg(1.25L)));
    const Real speed = run.engine.state().speed_rad_s;
    const auto& out = run.engine.step(at_phase<E>(at += phase_at_deg(jump_deg)));
    EXPECT_EQ(out.faults, kFaultPhaseJump) << static_cast<double>(jump_deg);
    EXPECT_EQ(run.engine.state().speed_rad_s, speed);
    EXPECT_EQ(run.engine.state().phase.units(), at.units());
    EXPECT_EQ(out.mean_torque_Nm, out.torque_Nm) << "after a jump of " << static_cast<double>(jump_deg) << " deg";
    EXPECT_TRUE(all_finite(all_numbers<Real>(out)));
    const auto& next = run.engine.step(at_phase<E>(at += phase_at_deg(1.25L)));
    EXPECT_EQ(next.faults, 0u);
    EXPECT_NEAR(static_cast<double>(run.engine.state().speed_rad_s), static_cast<double>(speed), 1e-3);
  }
}

TYPED_TEST(EngineOf, TheFirstMeasuredPhaseIsNoFaultAndNoSpeedWhereverItIs) {
  using Real = TypeParam;
  using E = Engine<Real, EverythingByPhase>;
  for (const long double first_deg : {0.0L, 10.0L, 59.0L, 100.0L, 360.0L, 700.0L}) {
    Running<Real, EverythingByPhase> run(this->diesel());
    const auto& out = run.engine.step(at_phase<E>(phase_at_deg(first_deg)));
    EXPECT_EQ(out.faults, 0u);
    EXPECT_EQ(run.engine.state().speed_rad_s, Real{0});
    EXPECT_EQ(out.mean_torque_Nm, out.torque_Nm);
    EXPECT_EQ(run.engine.step(at_phase<E>(phase_at_deg(first_deg + 1))).faults, 0u);
    EXPECT_NEAR(static_cast<double>(run.engine.state().speed_rad_s), kPi / 180 / kTick_s, 1e-3);
  }
}

// ---- snapshots, neighbours ------------------------------------------------------------------------------------------

template <class Real, class S>
typename Engine<Real, S>::Input drive_of(int tick) {
  typename Engine<Real, S>::Input in;
  in.speed_rad_s = static_cast<Real>(180 + 30 * std::sin(0.01 * tick));
  if constexpr (Needs<S>::load) in.load_ratio = static_cast<Real>(0.5 + 0.4 * std::sin(0.003 * tick));
  if constexpr (Needs<S>::input_pressure) {
    int k = 0;
    for (Real& pressure : in.pressure_Pa) pressure = static_cast<Real>(1e5 + 4e4 * (tick * ++k % 97));
  }
  return in;
}

template <class Real, class S>
void expect_snapshot_to_go_on_with_the_same_bits(const FullTables<Real>& tables) {
  Running<Real, S> run(tables, phase_at_deg(5));
  for (int tick = 0; tick < 333; ++tick) run.engine.step(drive_of<Real, S>(tick));
  const auto snapshot = run.engine.state();  // assignment is all it takes
  std::vector<std::vector<Real>> first;
  for (int tick = 333; tick < 700; ++tick) first.push_back(all_numbers<Real>(run.engine.step(drive_of<Real, S>(tick))));

  const std::vector<Real> last = all_numbers<Real>(run.engine.output());
  ASSERT_TRUE(run.engine.restore(snapshot).ok());
  EXPECT_TRUE(same_bits(all_numbers<Real>(run.engine.output()), last));  // until the next step
  Running<Real, S> fresh(tables, phase_at_deg(300));
  ASSERT_TRUE(fresh.engine.restore(snapshot).ok());
  Engine<Real, S> copy = run.engine;
  for (int tick = 333; tick < 700; ++tick) {
    const auto in = drive_of<Real, S>(tick);
    const std::vector<Real>& want = first[static_cast<std::size_t>(tick - 333)];
    ASSERT_TRUE(same_bits(all_numbers<Real>(run.engine.step(in)), want)) << "same engine, tick " << tick;
    ASSERT_TRUE(same_bits(all_numbers<Real>(fresh.engine.step(in)), want)) << "other engine, tick " << tick;
    ASSERT_TRUE(same_bits(all_numbers<Real>(copy.step(in)), want)) << "copied engine, tick " << tick;
  }
}

TYPED_TEST(EngineOf, GoesOnFromASnapshotWithTheSameBitsInTheSameAnotherOrACopiedEngine) {
  using Real = TypeParam;
  expect_snapshot_to_go_on_with_the_same_bits<Real, Everything>(this->diesel());
  expect_snapshot_to_go_on_with_the_same_bits<Real, EverythingByInput>(this->diesel());
  expect_snapshot_to_go_on_with_the_same_bits<Real, TorqueOfFour>(this->diesel());
  expect_snapshot_to_go_on_with_the_same_bits<Real, Asking<kMeanTorque, kByInput>>(this->diesel());
}

TYPED_TEST(EngineOf, RefusesASnapshotOfOtherTablesAndKeepsItsOwnState) {
  using Real = TypeParam;
  EngineDefinition heavier = diesel_495();
  heavier.masses.piston_kg = std::nextafter(heavier.masses.piston_kg, 1.0);
  EngineDefinition other_order = diesel_495();
  std::swap(other_order.layout.firing_deg[1], other_order.layout.firing_deg[2]);
  EngineDefinition more_heat = diesel_495();
  more_heat.pressure.wiebe.net_mep_Pa += 1;
  struct Case {
    const char* what;
    EngineDefinition engine;
    double tick_s;
    int gas_capacity;
  };
  for (const Case& c :
       {Case{"a heavier piston", heavier, kTick_s, kFinestGrid},
        Case{"another firing order", other_order, kTick_s, kFinestGrid},
        Case{"more heat", more_heat, kTick_s, kFinestGrid}, Case{"another tick", diesel_495(), 99e-6, kFinestGrid},
        Case{"a coarser gas grid", diesel_495(), kTick_s, 720}}) {
    FullTables<Real> tables;
    ASSERT_TRUE(tables.build(c.engine, c.tick_s, c.gas_capacity).ok());
    Running<Real, Everything> other(tables, phase_at_deg(100));
    Running<Real, Everything> own(this->diesel(), phase_at_deg(50));
    other.engine.step(at_speed<Engine<Real, Everything>>(100));
    const Status status = own.engine.restore(other.engine.state());
    EXPECT_EQ(status.reason, Reason::other_tables) << c.what;
    EXPECT_STREQ(status.field, "state.fingerprint") << c.what;
    EXPECT_EQ(own.engine.state().phase.units(), phase_at_deg(50).units()) << c.what;
  }
  // The same definition tabulated anew is the same tables.
  FullTables<Real> again;
  ASSERT_TRUE(again.build(diesel_495(), kTick_s).ok());
  Running<Real, Everything> twin(again, phase_at_deg(100));
  Running<Real, Everything> own(this->diesel());
  EXPECT_TRUE(own.engine.restore(twin.engine.state()).ok());
}

TYPED_TEST(EngineOf, TwoEnginesSideBySideDoNotKnowOfEachOther) {
  using Real = TypeParam;
  Running<Real, Everything> alone(this->diesel());
  Running<Real, Everything> first(this->diesel());
  Running<Real, Everything> second(this->diesel(), phase_at_deg(200));
  for (int tick = 0; tick < 500; ++tick) {
    const auto in = drive_of<Real, Everything>(tick);
    const std::vector<Real> want = all_numbers<Real>(alone.engine.step(in));
    const auto& out = first.engine.step(in);
    second.engine.step(at_speed<Engine<Real, Everything>>(tick % 7 == 0 ? std::nan("") : -400.0));
    ASSERT_TRUE(same_bits(all_numbers<Real>(out), want)) << tick;
  }
}

TYPED_TEST(EngineOf, ExactlyFourAndUpToSixteenAnswerTheSameBitsAndTheUnusedPlacesStayZero) {
  using Real = TypeParam;
  Running<Real, Everything> up_to_sixteen(this->diesel(), phase_at_deg(1));
  Running<Real, EverythingOfFour> exactly_four(this->diesel(), phase_at_deg(1));
  const InUse use = in_use(this->diesel());
  for (int tick = 0; tick < 1500; ++tick) {
    const auto& wide = up_to_sixteen.engine.step(drive_of<Real, Everything>(tick));
    const auto& narrow = exactly_four.engine.step(drive_of<Real, EverythingOfFour>(tick));
    ASSERT_TRUE(same_bits(numbers<kAllGroups>(wide, use), numbers<kAllGroups>(narrow, use))) << tick;
    for (std::size_t k = 4; k < 16; ++k) {
      ASSERT_EQ(wide.displacement_m[k], Real{0});
      ASSERT_EQ(wide.cylinder[k].torque_Nm, Real{0});
      ASSERT_EQ(wide.pin_load_N[k], Real{0});
      ASSERT_EQ(wide.journal_load_N[k + 1], Real{0});
    }
  }
}

TYPED_TEST(EngineOf, CylindersAtTheSameCrankAngleShareTheirLookUps) {
  using Real = TypeParam;
  EXPECT_EQ(this->diesel().drive().mechanisms, 2u);
  const auto mechanisms = [](const std::vector<double>& firing_deg) {
    FullTables<Real> tables;
    EXPECT_TRUE(tables.build(without_gas(with_cylinders(single_495(), firing_deg)), kTick_s).ok());
    return tables.drive().mechanisms;
  };
  EXPECT_EQ(mechanisms({0}), 1u);
  EXPECT_EQ(mechanisms({0, 360}), 1u);  // a parallel twin
  EXPECT_EQ(mechanisms({360, 0}), 1u);
  EXPECT_EQ(mechanisms({0, 240, 480}), 3u);                          // a three
  EXPECT_EQ(mechanisms({0, 480, 240, 600, 120, 360}), 3u);           // an inline six
  EXPECT_EQ(mechanisms({0, 90, 270, 180, 630, 540, 450, 360}), 4u);  // a cross-plane V8
  EXPECT_EQ(mechanisms({0, 144, 288, 432, 576}), 5u);                // a five
  EXPECT_EQ(mechanisms(std::vector<double>(16, 15.5)), 1u);
  EXPECT_EQ(mechanisms({719.9999999999, 0}), 2u);
}

/// Each cylinder against a one-cylinder engine that stands where the cylinder stands.
template <class Real>
void expect_cylinders_as_if_alone(const EngineDefinition& engine) {
  EngineDefinition one = with_cylinders(engine, {0});
  FullTables<Real> together;
  FullTables<Real> alone;
  ASSERT_TRUE(together.build(engine, kTick_s).ok());
  ASSERT_TRUE(alone.build(one, kTick_s).ok());
  const Drive<Real>& drive = together.drive();
  Running<Real, Everything> all(together);
  std::vector<std::unique_ptr<Running<Real, Everything>>> single;
  for (std::size_t k = 0; k < drive.cylinders; ++k) {
    const Phase firing{drive.firing_phase[drive.mechanism_of[k]] +
                       (drive.turn_of[k] != 0 ? std::uint64_t{1} << 63 : 0)};
    const long double off = turned_rad(phase_at_deg(static_cast<long double>(engine.layout.firing_deg[k])), firing);
    ASSERT_LE(std::fabs(off), 2e-11L) << "cylinder " << k << " fires elsewhere";
    single.push_back(std::make_unique<Running<Real, Everything>>(alone, Phase{} - firing));
  }
  const InUse one_in_use = in_use(alone);
  for (int tick = 0; tick < 1200; ++tick) {
    const auto in = drive_of<Real, Everything>(3 * tick);
    const auto& out = all.engine.step(in);
    long double torque = 0;
    long double mean = 0;
    long double size = 1;
    for (std::size_t k = 0; k < drive.cylinders; ++k) {
      const auto& own = single[k]->engine.step(in);
      ASSERT_EQ(out.displacement_m[k], own.displacement_m[0]) << "cylinder " << k << ", tick " << tick;
      ASSERT_EQ(out.velocity_m_s[k], own.velocity_m_s[0]);
      ASSERT_EQ(out.acceleration_m_s2[k], own.acceleration_m_s2[0]);
      ASSERT_EQ(out.rod_angle_rad[k], own.rod_angle_rad[0]);
      ASSERT_EQ(out.rod_speed_rad_s[k], own.rod_speed_rad_s[0]);
      ASSERT_EQ(out.rod_acceleration_rad_s2[k], own.rod_acceleration_rad_s2[0]);
      const auto forces = numbers<kForces>(own, one_in_use);
      std::vector<Real> in_company = numbers<kForces>(out, InUse{drive.cylinders, 0});
      ASSERT_EQ(std::memcmp(in_company.data() + 10 * k, forces.data(), 10 * sizeof(Real)), 0)
          << "cylinder " << k << ", tick " << tick;
      torque += static_cast<long double>(own.torque_Nm);
      mean += static_cast<long double>(own.mean_torque_Nm);
      size += std::fabs(static_cast<long double>(own.torque_Nm));
    }
    const double rounding = static_cast<double>(size) * 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());
    ASSERT_NEAR(static_cast<double>(out.torque_Nm), static_cast<double>(torque), rounding) << tick;
    // The first tick's mean is a trapezoid where it crawls; later it is a difference of work, right to 1e-6 or 1e-10 of
    // the torques.
    ASSERT_NEAR(static_cast<double>(out.mean_torque_Nm), static_cast<double>(mean),
                static_cast<double>(size) * (sizeof(Real) == 4 ? 3e-6 : 1e-10) + 0.003)
        << tick;
  }
}

TYPED_TEST(EngineOf, EveryCylinderAnswersAsIfItWereAlone) {
  using Real = TypeParam;
  expect_cylinders_as_if_alone<Real>(diesel_495());
  expect_cylinders_as_if_alone<Real>(uneven_v4());
  expect_cylinders_as_if_alone<Real>(with_cylinders(single_495(), {0, 480, 240, 600, 120, 360}));
  expect_cylinders_as_if_alone<Real>(with_cylinders(single_495(), {3.7, 719.99, 360.3, 0.3, 363.7, 100}));
}

TYPED_TEST(EngineOf, TablesBuiltForASceneAloneAnswerTheSameBitsAsAllSections) {
  using Real = TypeParam;
  static TableStorage<Real, EverythingOfFour, 14'400> storage;
  ASSERT_TRUE(storage.build(diesel_495(), {kTick_s}).ok());
  Engine<Real, EverythingOfFour> engine;
  ASSERT_TRUE(engine.init(storage.tables()).ok());
  Running<Real, EverythingOfFour> full(this->diesel());
  for (int tick = 0; tick < 500; ++tick) {
    const auto in = drive_of<Real, EverythingOfFour>(tick);
    ASSERT_TRUE(same_bits(all_numbers<Real>(engine.step(in)), all_numbers<Real>(full.engine.step(in)))) << tick;
  }
  EngineDefinition bad = diesel_495();
  bad.crank.rod_length_m = 0.01;
  EXPECT_EQ(storage.build(bad, {kTick_s}).reason, Reason::rod_too_short);
  EXPECT_EQ(engine.init(storage.tables()).reason, Reason::missing_table);
  EXPECT_EQ(engine.step({}).faults, kFaultNotReady);
}

// ---- forces against exact ones --------------------------------------------------------------------------------------

/// The tick's forces against ExactEngine at the same angle and speed. `gas_error_Pa` is what the tables' pressure may
/// be off by.
template <class Real>
void expect_exact_forces(const EngineDefinition& engine, double gas_error_Pa, const char* what) {
  using S = Asking<kForces | kTorque>;
  ExactEngine exact;
  ASSERT_TRUE(exact.init(engine).ok());
  FullTables<Real> tables;
  ASSERT_TRUE(tables.build(engine, kTick_s).ok());
  Random random;
  const Crank& crank = engine.crank;
  const double area = kPi / 4 * crank.bore_m * crank.bore_m;
  const double r = crank.crank_radius_m;
  // Kinematics to 4e-7 or 2e-9 (tick_kinematics_test), and a few roundings of each product.
  const double relative = sizeof(Real) == 4 ? 1.2e-6 : 4e-9;
  Running<Real, S> run(tables);
  for (int draw = 0; draw < 3000; ++draw) {
    const double speed = random.between(-600, 600);
    run.engine.step(at_speed<Engine<Real, S>>(speed));
    const auto& out = run.engine.output();
    const auto deg = static_cast<double>(deg_of(run.engine.state().phase));
    const auto w = static_cast<double>(run.engine.state().speed_rad_s);
    const double inertia = engine.masses.reciprocating_kg() * r * w * w * 1.6;
    const double couple = std::fabs(engine.masses.rod_inertia_correction_kg_m2) * 0.6 * w * w / crank.rod_length_m;
    double torque = 0;
    double torque_tolerance = 0;
    for (int k = 0; k < engine.layout.cylinders; ++k) {
      const CylinderForces<double> want = exact.forces(k, deg, w);
      const CylinderForces<Real>& got = out.cylinder[k];
      const double gas = std::max(want.pressure_Pa, 1e5) * area;
      const double tolerance = gas_error_Pa * area + relative * (gas + inertia + couple);
      const auto near = [&](Real value, double exact_value, double allowed, const char* name) {
        ASSERT_NEAR(static_cast<double>(value), exact_value, allowed)
            << what << ", " << name << " of cylinder " << k << " at " << deg << " deg, " << w << " rad/s, "
            << random.trace(draw);
      };
      near(got.pressure_Pa, want.pressure_Pa, gas_error_Pa + relative * std::max(want.pressure_Pa, 1e5), "pressure");
      near(got.gas_force_N, want.gas_force_N, gas_error_Pa * area + relative * gas, "gas force");
      near(got.inertia_force_N, want.inertia_force_N, relative * inertia, "inertia force");
      near(got.total_force_N, want.total_force_N, tolerance, "total force");
      near(got.side_force_N, want.side_force_N, tolerance, "side force");
      near(got.rod_force_N, want.rod_force_N, 1.2 * tolerance, "rod force");
      near(got.radial_force_N, want.radial_force_N, 1.2 * tolerance, "radial force");
      near(got.tangential_force_N, want.tangential_force_N, 1.2 * tolerance, "tangential force");
      near(got.torque_Nm, want.torque_Nm, 1.2 * tolerance * r, "torque");
      near(got.tilting_moment_Nm, want.tilting_moment_Nm, tolerance * (r + crank.rod_length_m), "tilting moment");
      torque += want.torque_Nm;
      torque_tolerance += 1.2 * tolerance * r;
    }
    ASSERT_NEAR(static_cast<double>(out.torque_Nm), torque, torque_tolerance) << what << " at " << deg << " deg";
    ASSERT_NEAR(static_cast<double>(out.torque_Nm), exact.torque_Nm(deg, w), torque_tolerance)
        << what << " at " << deg << " deg";
  }
}

TYPED_TEST(EngineOf, ForcesAreTheExactOnesToTheTablesAccuracy) {
  using Real = TypeParam;
  const double peak_Pa = 70e5;
  expect_exact_forces<Real>(diesel_495(), 1.2e-5 * peak_Pa, "495");
  expect_exact_forces<Real>(uneven_v4(), 1.2e-5 * peak_Pa, "uneven V4");
  expect_exact_forces<Real>(without_gas(diesel_495()), 0, "495 without gas");
  EngineDefinition far_off = without_gas(uneven_v4());
  far_off.crank.pin_offset_m = -0.2 * far_off.crank.crank_radius_m;
  far_off.crank.rod_length_m = far_off.crank.crank_radius_m / 0.45;
  far_off.masses.rod_inertia_correction_kg_m2 = 0.02;
  expect_exact_forces<Real>(far_off, 0, "short rod, offset");
}

TYPED_TEST(EngineOf, TorqueReadFromCurvesIsTheSumOfTheForcesTorques) {
  using Real = TypeParam;
  for (const EngineDefinition& engine : {diesel_495(), uneven_v4(), without_gas(uneven_v4())}) {
    FullTables<Real> tables;
    ASSERT_TRUE(tables.build(engine, kTick_s).ok());
    Running<Real, Asking<kTorque, kByTable, true>> by_curve(tables);
    Running<Real, Asking<kTorque | kForces, kByTable, true>> by_forces(tables);
    const double area = kPi / 4 * 0.095 * 0.095;
    for (int tick = 0; tick < 3000; ++tick) {
      const auto in = drive_of<Real, Asking<kTorque, kByTable, true>>(tick);
      typename Engine<Real, Asking<kTorque | kForces, kByTable, true>>::Input same;
      same.speed_rad_s = in.speed_rad_s;
      same.load_ratio = in.load_ratio;
      const auto curve = static_cast<double>(by_curve.engine.step(in).torque_Nm);
      const auto forces = static_cast<double>(by_forces.engine.step(same).torque_Nm);
      // Two fits of the same: pressure to 1e-5 of its peak each (motored and heat), inertia to 3e-6 of m r^2 w^2
      // (tick_kinematics_test).
      const auto w = static_cast<double>(in.speed_rad_s);
      const double tolerance =
          4 * 0.0575 * (3e-5 * 70e5 * area) + 4 * (sizeof(Real) == 4 ? 3e-6 : 1e-8) * 1.32 * 0.0575 * 0.0575 * w * w;
      ASSERT_NEAR(curve, forces, tolerance) << tick;
    }
  }
}

// ---- sizes and promises of the types --------------------------------------------------------------------------------

template <class Real, class S, class E = Engine<Real, S>>
constexpr bool kKeepsItsPromises = std::is_trivially_copyable_v<typename E::State>&& std::is_trivially_copyable_v<E>&&
    std::is_nothrow_default_constructible_v<E>&& noexcept(std::declval<E&>().step({})) && noexcept(
        std::declval<E&>().init(
            std::declval<const Tables<Real, S>&>(),
            Phase{})) && noexcept(std::declval<E&>()
                                      .restore(std::declval<
                                               const typename E::
                                                   State&>())) && noexcept(std::declval<E&>()
                                                                               .state()) && noexcept(std::declval<E&>()
                                                                                                         .output());

static_assert(kKeepsItsPromises<float, Everything> && kKeepsItsPromises<double, Everything>);
static_assert(kKeepsItsPromises<float, EverythingByInput> && kKeepsItsPromises<double, EverythingByPhase>);
static_assert(kKeepsItsPromises<float, TorqueOfFour> && kKeepsItsPromises<double, TorqueOfFour>);

/// Bytes that the members of a state need: fingerprint, phase, ticks, speed, load; pressures; work.
template <class Real, class S>
constexpr std::size_t state_bytes() {
  using N = Needs<S>;
  std::size_t bytes = 24 + 2 * sizeof(Real);
  const std::size_t even = (S::cylinders.capacity + 1) / 2 * 2;
  if (N::input_pressure) bytes += even * sizeof(Real);
  if (S::mean_torque) {
    const std::size_t integrals = 1 + (N::load ? 2 : 1) + (N::input_pressure ? S::cylinders.capacity : 1);
    bytes += (integrals * 2 + 2) * sizeof(Real);
  }
  return bytes;
}

template <class Real, std::uint32_t N>
constexpr bool kStatesWithoutPadding =
    sizeof(State<Real, Asking<kTorque, kByTable, false, CrankGiven::speed, N>>) ==
        state_bytes<Real, Asking<kTorque, kByTable, false, CrankGiven::speed, N>>() &&
    sizeof(State<Real, Asking<kAllGroups, kByTable, true, CrankGiven::speed, N>>) ==
        state_bytes<Real, Asking<kAllGroups, kByTable, true, CrankGiven::speed, N>>() &&
    sizeof(State<Real, Asking<kMeanTorque, kByInput, false, CrankGiven::phase, N>>) ==
        state_bytes<Real, Asking<kMeanTorque, kByInput, false, CrankGiven::phase, N>>() &&
    sizeof(State<Real, Asking<kForces, kByInput, false, CrankGiven::speed, N>>) ==
        state_bytes<Real, Asking<kForces, kByInput, false, CrankGiven::speed, N>>() &&
    sizeof(State<Real, Asking<kFreeForces, PressureGiven::none, false, CrankGiven::speed, N>>) ==
        state_bytes<Real, Asking<kFreeForces, PressureGiven::none, false, CrankGiven::speed, N>>();
static_assert(kStatesWithoutPadding<float, 1> && kStatesWithoutPadding<double, 1>);
static_assert(kStatesWithoutPadding<float, 3> && kStatesWithoutPadding<double, 3>);
static_assert(kStatesWithoutPadding<float, 4> && kStatesWithoutPadding<double, 4>);
static_assert(kStatesWithoutPadding<float, 15> && kStatesWithoutPadding<double, 15>);
static_assert(kStatesWithoutPadding<float, 16> && kStatesWithoutPadding<double, 16>);

TEST(EngineSize, OfAFourCylinderTorqueEngineInFloatFitsIn128Bytes) {
  using TorqueAlone = Asking<kTorque, kByTable, false, CrankGiven::speed, 4>;
  EXPECT_LE(sizeof(Engine<float, TorqueAlone>), 128u);
  EXPECT_LE(sizeof(Engine<float, TorqueOfFour>), 128u);
  // What a scene leaves out takes no room: tables, state, a torque and the faults.
  EXPECT_EQ(sizeof(Output<float, TorqueAlone>), 8u);
  EXPECT_EQ(sizeof(Output<float, TorqueOfFour>), 12u);
  EXPECT_EQ(sizeof(Engine<float, TorqueAlone>), sizeof(void*) + sizeof(State<float, TorqueAlone>) + 8u);
  EXPECT_EQ(sizeof(Input<float, TorqueOfFour>), 4u);
  EXPECT_EQ(sizeof(Output<float, Asking<0, PressureGiven::none>>), 4u);
}

}  // namespace
}  // namespace crankloop

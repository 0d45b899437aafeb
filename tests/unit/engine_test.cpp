// The engine as its user meets it: what init refuses, what bad input does, how the crank turns, a measured angle.
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
#include <vector>

#include "support/kept_engines.hpp"
#include "support/output_numbers.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/tick_oracle.hpp"

namespace crankloop::engine_test {

using namespace detail;
namespace {

using namespace tick_test;
using support::Random;

template <class Real>
class EngineOf : public DieselEngine<Real> {};
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
              static_cast<double>(oracle_pose(single_495().crank, 77.5L * kWidePi / 180).displacement_m), 3e-8);
}

/// Drops one section after the other; answers where a refusal was wrong, or wanting.
template <class Real, class S>
std::vector<std::pair<std::string, bool>> init_with_one_section_missing(const Sections<Real>& whole) {
  std::vector<std::pair<std::string, bool>> wrong;
  sections([&](auto section) {
    if constexpr (section.kRead) {
      Sections<Real> s = whole;
      section.in(s) = nullptr;
      const Tables<Real, S> complete(whole);
      const Tables<Real, S> tables(s);
      Engine<Real, S> engine;
      EXPECT_TRUE(accepted(engine.init(complete)));
      const Status status = engine.init(tables);
      const bool refused = status.reason == Reason::missing_table;
      if (refused != section.template needed<S>()) wrong.emplace_back(section.kName, refused);
      // A refusal leaves no engine behind, not even the one there was.
      const auto faults = engine.step({}).faults;
      EXPECT_EQ(faults == kFaultNotReady, refused) << section.kName;
    }
  });
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
  ASSERT_TRUE(accepted(tables.build(with_cylinders(single_495(), {0, 120, 240, 375, 480, 600}), kTick_s)));
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
Status init_of(const FullTables<Real>& full) {
  using S = Pistons<Cylinders, Exact>;
  const Tables<Real, S> tables(full.sections());
  Engine<Real, S> engine;
  return engine.init(tables);
}

TYPED_TEST(EngineOf, InitTakesExactlyItsCylindersOrUpToItsCapacity) {
  using Real = TypeParam;
  FullTables<Real> three;
  FullTables<Real> sixteen;
  ASSERT_TRUE(accepted(three.build(with_cylinders(single_495(), {0, 240, 480}), kTick_s)));
  ASSERT_TRUE(accepted(sixteen.build(with_cylinders(single_495(), std::vector<double>(16, 0.0)), kTick_s)));
  const FullTables<Real>& four = this->diesel();
  EXPECT_TRUE(accepted(init_of<Real, 4, true>(four)));
  EXPECT_EQ((init_of<Real, 4, true>(three)).reason, Reason::out_of_range);
  EXPECT_EQ((init_of<Real, 3, true>(four)).reason, Reason::out_of_range);
  EXPECT_EQ((init_of<Real, 1, true>(four)).reason, Reason::out_of_range);
  EXPECT_TRUE(accepted(init_of<Real, 4, false>(three)));
  EXPECT_TRUE(accepted(init_of<Real, 4, false>(four)));
  EXPECT_EQ((init_of<Real, 3, false>(four)).reason, Reason::out_of_range);
  EXPECT_TRUE(accepted(init_of<Real, 16, false>(sixteen)));
  EXPECT_TRUE(accepted(init_of<Real, 16, true>(sixteen)));
  EXPECT_EQ((init_of<Real, 15, false>(sixteen)).reason, Reason::out_of_range);
  EXPECT_STREQ((init_of<Real, 15, false>(sixteen)).field, "tables.cylinders");
}

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
  ASSERT_TRUE(accepted(tables.build(two_mass, kTick_s)));
  const Tables<Real, ForcesWithoutRodInertia> without(tables.sections());
  EXPECT_TRUE(accepted(engine.init(without)));
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
    ASSERT_TRUE(accepted(tables.build(diesel_495(), tick_s)));
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

/// A bad input's tick would turn the crank by it.
TYPED_TEST(EngineOf, AStateBeyondTheSpeedLimitIsRefused) {
  using Real = TypeParam;
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(diesel_495(), 100e-6)));
  Running<Real, Everything> run(tables);
  const Real limit = tables.drive().speed_limit_rad_s;
  auto state = run.engine.state();
  for (const Real good : {limit, -limit}) {
    state.speed_rad_s = good;
    EXPECT_TRUE(accepted(run.engine.restore(state)));
  }
  for (const Real bad : {std::nextafter(limit, 2 * limit), -2 * limit, std::numeric_limits<Real>::quiet_NaN()}) {
    state.speed_rad_s = bad;
    EXPECT_TRUE(support::refuses(run.engine.restore(state), Reason::out_of_range, "state.speed_rad_s")) << bad;
  }
}

TYPED_TEST(EngineOf, ASpeedBeyondTheEnginesMaximumIsABadInput) {
  using Real = TypeParam;
  EngineDefinition engine = diesel_495();
  engine.crank.max_speed_rad_s = 300;
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(engine, kTick_s)));
  Running<Real, Everything> run(tables);
  typename Engine<Real, Everything>::Input in;
  in.speed_rad_s = Real{-300};
  EXPECT_EQ(run.engine.step(in).faults, 0u);
  in.speed_rad_s = static_cast<Real>(300.001);
  EXPECT_EQ(run.engine.step(in).faults, kFaultSpeed);
}

TYPED_TEST(EngineOf, TheTickAndTheOptionsOrTheEngineLimitTheSpeed) {
  using Real = TypeParam;
  EngineDefinition engine = diesel_495();
  const auto limit_rad_s = [&engine](double tick_s, double option_rad_s) {
    const auto tables = std::make_unique<TableStorage<Real, Everything>>();
    TickOptions options{tick_s};
    options.max_speed_rad_s = option_rad_s;
    EXPECT_TRUE(accepted(tables->build(engine, options)));
    return static_cast<double>(tables->tables().drive->speed_limit_rad_s);
  };
  const double by_tick_rad_s = limit_rad_s(2e-3, 0);
  EXPECT_NEAR(by_tick_rad_s, 2 * kPi / 2e-3, 1);
  EXPECT_EQ(limit_rad_s(2e-3, 5000), by_tick_rad_s) << "a tick never turns the crank by more than a revolution";
  EXPECT_NEAR(limit_rad_s(2e-3, 800), 800, 1e-3);
  engine.crank.max_speed_rad_s = 300;
  EXPECT_NEAR(limit_rad_s(2e-3, 0), 300, 1e-3);
  EXPECT_NEAR(limit_rad_s(2e-3, 800), 800, 1e-3) << "options come first";
  for (const double bad_rad_s : {-1.0, 10473.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto tables = std::make_unique<TableStorage<Real, Everything>>();
    TickOptions options{1e-3};
    options.max_speed_rad_s = bad_rad_s;
    EXPECT_TRUE(support::refuses(tables->build(engine, options), Reason::out_of_range, "options.max_speed_rad_s"))
        << bad_rad_s;
  }
}

TYPED_TEST(EngineOf, TheEnginesMaximumIsAGoodInputHoweverItIsRounded) {
  using Real = TypeParam;
  EngineDefinition engine = diesel_495();
  for (double rpm = 7100; rpm < 9500; rpm += 100) {
    engine.crank.max_speed_rad_s = rpm * kPi / 30;
    FullTables<Real> tables;
    ASSERT_TRUE(accepted(tables.build(engine, kTick_s)));
    Running<Real, Everything> run(tables);
    typename Engine<Real, Everything>::Input in;
    in.speed_rad_s = static_cast<Real>(std::nextafter(static_cast<float>(rpm * (kPi / 30)), 1e9F));
    EXPECT_EQ(run.engine.step(in).faults, 0u) << rpm;
  }
}

TYPED_TEST(EngineOf, TablesForAnotherMaximumSpeedHaveAnotherFingerprint) {
  using Real = TypeParam;
  EngineDefinition engine = diesel_495();
  FullTables<Real> any, limited;
  ASSERT_TRUE(accepted(any.build(engine, kTick_s)));
  engine.crank.max_speed_rad_s = 300;
  ASSERT_TRUE(accepted(limited.build(engine, kTick_s)));
  EXPECT_NE(any.drive().fingerprint, limited.drive().fingerprint);
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
  ASSERT_TRUE(accepted(tables.build(uneven_v4(), kTick_s)));
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
    ASSERT_TRUE(accepted(tables.build(giant, tick_s)));
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

}  // namespace
}  // namespace crankloop::engine_test

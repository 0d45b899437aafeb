// Misfires come when the rule says, are counted, and take from the crank the work that their heat would have done.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/scenes.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tick/crank/misfire.hpp>
#include <crankloop/tick/state/saved_state.hpp>
#include <crankloop/tick/step.hpp>

#include "support/both_reals.hpp"
#include "support/engines.hpp"
#include "support/gas_engine.hpp"
#include "support/output_fields.hpp"
#include "support/status.hpp"

namespace crankloop::misfire_test {
namespace {

using detail::MisfireRule;
using support::diesel_495;
using support::four_2000;
using tick_test::RealName;

constexpr double kPi = 3.14159265358979323846;
constexpr support::Used kAll{4, 4, 2};

// ---- the rules ------------------------------------------------------------------------------------------------------

/// The rule of a cylinder, as tables have it.
[[nodiscard]] MisfireRule<double> rule_of(const Misfire& misfire, std::uint32_t cylinder = 0) {
  EngineDefinition engine = diesel_495();
  engine.misfires[cylinder] = misfire;
  MisfireRule<double> rules[kMaxCylinders];
  TableTargets<double> targets;
  targets.misfires = rules;
  EXPECT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
  return rules[cylinder];
}
[[nodiscard]] Misfire some_of(MisfirePattern pattern, int misfires, int of) {
  Misfire misfire;
  misfire.pattern = pattern, misfire.misfires = misfires, misfire.of = of;
  return misfire;
}
[[nodiscard]] Misfire at_random(double ratio, int seed = 1) {
  Misfire misfire;
  misfire.pattern = MisfirePattern::random, misfire.random_ratio = ratio, misfire.seed = seed;
  return misfire;
}
[[nodiscard]] Misfire listed(const std::vector<int>& cycles) {
  Misfire misfire;
  misfire.pattern = MisfirePattern::listed, misfire.cycle_count = static_cast<int>(cycles.size());
  std::copy(cycles.begin(), cycles.end(), misfire.cycles);
  return misfire;
}

/// Which of the first cycles misfire.
[[nodiscard]] std::vector<bool> played(const MisfireRule<double>& rule, int cycles) {
  MisfireRecord record{};
  record.random = rule.seed;
  std::vector<bool> misfires;
  for (int i = 0; i < cycles; ++i) misfires.push_back(detail::begin_cycle(rule, record) < 1);
  return misfires;
}
[[nodiscard]] std::vector<int> numbers_of(const std::vector<bool>& misfires) {
  std::vector<int> numbers;
  for (std::size_t i = 0; i < misfires.size(); ++i)
    if (misfires[i]) numbers.push_back(static_cast<int>(i) + 1);
  return numbers;
}

TEST(MisfireRules, EverySixteenthIsThe16thThe32ndAndSoOn) {
  EXPECT_EQ(numbers_of(played(rule_of(some_of(MisfirePattern::spread, 1, 16)), 50)), (std::vector<int>{16, 32, 48}));
  EXPECT_TRUE(numbers_of(played(rule_of({}), 50)).empty());
}

TEST(MisfireRules, NOfMAreNInAnyMCyclesInARowAndNeverTwoMoreApartThanTheMean) {
  for (const auto& [n, m] : {std::pair{1, 1}, {0, 5}, {3, 10}, {7, 10}, {5, 16}, {99, 100}, {20001, 65535}}) {
    const std::vector<bool> misfires = played(rule_of(some_of(MisfirePattern::spread, n, m)), 3 * m);
    int in_window = static_cast<int>(std::count(misfires.begin(), misfires.begin() + m, true));
    EXPECT_EQ(in_window, n) << n << " of " << m;
    for (std::size_t i = 0; i + static_cast<std::size_t>(m) < misfires.size(); ++i) {
      in_window += int{misfires[i + static_cast<std::size_t>(m)]} - int{misfires[i]};
      ASSERT_EQ(in_window, n) << n << " of " << m << " from cycle " << i + 1;
    }
    const std::vector<int> numbers = numbers_of(misfires);
    for (std::size_t i = 1; i < numbers.size(); ++i) {
      const int apart = numbers[i] - numbers[i - 1];
      ASSERT_LE(std::abs(apart * n - m), n) << n << " of " << m << " at cycle " << numbers[i];
    }
  }
}

TEST(MisfireRules, ABurstEndsEveryPeriod) {
  EXPECT_EQ(numbers_of(played(rule_of(some_of(MisfirePattern::burst, 3, 10)), 25)),
            (std::vector<int>{8, 9, 10, 18, 19, 20}));
}

TEST(MisfireRules, AListNamesItsCyclesAndNoOthers) {
  const std::vector<int> cycles{1, 2, 7, 100, 101, 4000};
  EXPECT_EQ(numbers_of(played(rule_of(listed(cycles)), 5000)), cycles);
}

TEST(MisfireRules, TheRandomNumbersAreMarsagliasXorshift32) {
  std::uint32_t random = 2463534242u;  // the seed of his paper, and what his program prints
  EXPECT_EQ(detail::next_random(random), 723471715u);
  EXPECT_EQ(detail::next_random(random), 2497366906u);
  EXPECT_EQ(detail::next_random(random), 2064144800u);
}

TEST(MisfireRules, ARandomShareIsWithinFourSigmaWhateverTheSeedAndTheCylinder) {
  constexpr int kCycles = 100'000;
  std::set<std::vector<int>> sequences;
  for (const double p : {0.001, 0.03, 0.5, 0.9}) {
    for (const int seed : {0, 1, 2, 2147483647}) {
      for (const std::uint32_t cylinder : {0u, 3u}) {
        const std::vector<int> numbers = numbers_of(played(rule_of(at_random(p, seed), cylinder), kCycles));
        EXPECT_NEAR(static_cast<double>(numbers.size()), p * kCycles, 4 * std::sqrt(p * (1 - p) * kCycles))
            << "p " << p << ", seed " << seed << ", cylinder " << cylinder;
        EXPECT_TRUE(sequences.insert(numbers).second) << "two draw the same numbers: seed " << seed;
      }
    }
  }
  EXPECT_EQ(numbers_of(played(rule_of(at_random(0)), kCycles)).size(), 0u);
  EXPECT_EQ(numbers_of(played(rule_of(at_random(1)), kCycles)).size(), std::size_t{kCycles});
}

/// Seed and cylinder together are mixed by a bijection, so one pair of them gives 0, and xorshift32 of 0 is 0: a
/// cylinder that drew it would misfire in every cycle.
TEST(MisfireRules, NoSeedHasAllCyclesMisfire) {
  EngineDefinition engine = diesel_495();
  engine.layout = {};
  engine.layout.cylinders = 8;
  constexpr std::uint32_t kCylinder = 7;
  constexpr int kSeed = 102533220;  // 16 seed + cylinder = 2^32 less the mixer's addend, 0x9E3779B9
  static_assert(std::uint32_t{kSeed} * 16u + kCylinder + 0x9E3779B9u == 0);
  engine.misfires[kCylinder] = at_random(0.25, kSeed);
  MisfireRule<double> rules[kMaxCylinders];
  TableTargets<double> targets;
  targets.misfires = rules;
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
  EXPECT_NEAR(static_cast<double>(numbers_of(played(rules[kCylinder], 100'000)).size()), 25'000, 4 * 137);
}

TEST(MisfireRules, WithoutASeedAreThoseOfSeedOne) {
  Misfire seedless;
  seedless.pattern = MisfirePattern::random, seedless.random_ratio = 0.5;
  EXPECT_EQ(played(rule_of(seedless), 100), played(rule_of(at_random(0.5, 1)), 100));
  EXPECT_NE(played(rule_of(seedless), 100), played(rule_of(at_random(0.5, 0)), 100));
}

TEST(MisfireRules, WindowsCountTheLast100And500Cycles) {
  const MisfireRule<double> rule = rule_of(at_random(0.3));
  const std::vector<bool> all = played(rule, 3000);
  MisfireRecord record{};
  record.random = rule.seed;
  for (std::size_t i = 0; i < all.size(); ++i) {
    (void)detail::begin_cycle(rule, record);
    const auto in_last = [&](std::size_t window) {
      const std::size_t from = i + 1 > window ? i + 1 - window : 0;
      return static_cast<std::uint32_t>(std::count(all.begin() + static_cast<std::ptrdiff_t>(from),
                                                   all.begin() + static_cast<std::ptrdiff_t>(i) + 1, true));
    };
    ASSERT_EQ(record.cycles, i + 1);
    ASSERT_EQ(record.misfires, in_last(all.size()));
    ASSERT_EQ(record.in_200_turns, in_last(100)) << "cycle " << i + 1;
    ASSERT_EQ(record.in_1000_turns, in_last(500)) << "cycle " << i + 1;
  }
}

TEST(MisfireRules, WhatNoCylinderCanDoIsRefusedByName) {
  const auto refusal = [](const Misfire& misfire) { return validate(misfire); };
  EXPECT_TRUE(
      support::refuses(refusal(some_of(MisfirePattern::spread, 3, 2)), Reason::inconsistent, "misfire.misfires"));
  EXPECT_TRUE(support::refuses(refusal(some_of(MisfirePattern::spread, -1, 2)), Reason::negative, "misfire.misfires"));
  EXPECT_TRUE(support::refuses(refusal(some_of(MisfirePattern::burst, 0, 65536)), Reason::out_of_range, "misfire.of"));
  EXPECT_TRUE(support::refuses(refusal(some_of(MisfirePattern::burst, 0, 0)), Reason::out_of_range, "misfire.of"));
  EXPECT_TRUE(support::refuses(refusal(at_random(1.1)), Reason::out_of_range, "misfire.random_ratio"));
  EXPECT_TRUE(support::refuses(refusal(at_random(std::nan(""))), Reason::not_finite, "misfire.random_ratio"));
  EXPECT_TRUE(support::refuses(refusal(at_random(0.1, -1)), Reason::negative, "misfire.seed"));
  EXPECT_TRUE(support::refuses(refusal(listed({})), Reason::out_of_range, "misfire.cycle_count"));
  EXPECT_TRUE(support::refuses(refusal(listed({0})), Reason::not_positive, "misfire.cycles", 0));
  EXPECT_TRUE(support::refuses(refusal(listed({4, 4})), Reason::not_increasing, "misfire.cycles", 1));
  Misfire burning = some_of(MisfirePattern::spread, 1, 2);
  burning.burning_ratio = 1;
  EXPECT_TRUE(support::refuses(refusal(burning), Reason::out_of_range, "misfire.burning_ratio"));
  Misfire unknown;
  unknown.pattern = static_cast<MisfirePattern>(9);
  EXPECT_TRUE(support::refuses(refusal(unknown), Reason::out_of_range, "misfire.pattern"));
  EngineDefinition engine = diesel_495();
  engine.misfires[2] = at_random(2);
  const Status status = validate(engine);
  EXPECT_TRUE(support::refuses(status, Reason::out_of_range, "misfire.random_ratio", 2));
}

// ---- under a diagram ------------------------------------------------------------------------------------------------

struct Diagram : Scene {
  static constexpr Count cylinders = exactly<4>;
  static constexpr PressureGiven pressure = PressureGiven::by_table;
  static constexpr bool load_ratio = true;
  static constexpr bool rod_inertia = true;
  static constexpr bool forces = true;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
  static constexpr bool misfire = true;
};
struct TorqueAlone : Diagram {
  static constexpr bool forces = false;
};
struct Measured : TorqueAlone {
  static constexpr CrankGiven crank = CrankGiven::phase;
};
struct Free : TorqueAlone {
  static constexpr CrankGiven crank = CrankGiven::torque;
};
template <class S>
struct Healthy : S {
  static constexpr bool misfire = false;
};

template <class Real, class S>
struct Rig {
  TableStorage<Real, S, kMaxGasSegments> storage;
  Engine<Real, S> engine;
  Input<Real, S> in;

  Rig(const EngineDefinition& definition, double tick_s) {
    EXPECT_TRUE(accepted(storage.build(definition, {tick_s, {}})));
    EXPECT_TRUE(accepted(engine.init(storage.tables())));
  }
  const Output<Real, S>& step() { return engine.step(in); }
};
template <class Real, class S>
[[nodiscard]] std::unique_ptr<Rig<Real, S>> rig(const EngineDefinition& definition, double tick_s, double rad_s = 0) {
  auto made = std::make_unique<Rig<Real, S>>(definition, tick_s);
  if constexpr (S::crank == CrankGiven::speed) made->in.speed_rad_s = static_cast<Real>(rad_s);
  return made;
}

template <class Real>
class MisfireOf : public ::testing::Test {};
TYPED_TEST_SUITE(MisfireOf, tick_test::BothReals, RealName);

TYPED_TEST(MisfireOf, ACountThatItsHistoryDoesNotHaveIsRefusedByVerify) {
  using Real = TypeParam;
  EngineDefinition engine = diesel_495();
  engine.misfires[1] = some_of(MisfirePattern::spread, 1, 4);
  const auto run = rig<Real, TorqueAlone>(engine, 100e-6, 2000 * kPi / 30);
  for (int tick = 0; tick < 5000; ++tick) run->step();
  EXPECT_TRUE(accepted(verify(run->engine)));
  auto state = run->engine.state();
  state.misfire[1].in_200_turns ^= 4;
  ASSERT_TRUE(accepted(run->engine.restore(state)));
  EXPECT_TRUE(support::refuses(verify(run->engine), Reason::inconsistent, "state.misfire"));
}

TYPED_TEST(MisfireOf, EachCycleOfEachCylinderIsCountedOnceFromItsFuelOn) {
  using Real = TypeParam;
  for (EngineDefinition engine : {diesel_495(), support::with_cylinders(support::single_495(), {0, 520, 200, 350})}) {
    engine.misfires[1] = some_of(MisfirePattern::spread, 1, 4);
    const auto run = rig<Real, TorqueAlone>(engine, 100e-6, 2000 * kPi / 30);  // 1.2 deg a tick
    const long double per_tick_deg = 1.2L;
    for (int tick = 1; tick <= 24'000; ++tick) {  // 40 cycles
      run->step();
      for (std::size_t k = 0; k < 4; ++k) {
        // From 0 on a cylinder that fires at f takes fuel at f - 90 deg, and again after each cycle.
        const long double turned = per_tick_deg * tick,
                          first = std::fmod(static_cast<long double>(engine.layout.firing_deg[k]) + 630, 720.0L);
        if (std::fabs(std::fmod(turned - first + 720, 720.0L)) < 0.01L) continue;  // either side by rounding
        const auto expected = turned < first ? 0u : static_cast<std::uint32_t>((turned - first) / 720) + 1;
        ASSERT_EQ(run->engine.state().misfire[k].cycles, expected) << "tick " << tick << ", cylinder " << k + 1;
        ASSERT_EQ(run->engine.state().misfire[k].misfires, k == 1 ? expected / 4 : 0u);
      }
    }
  }
}

TYPED_TEST(MisfireOf, ACycleHasMotoredPressureOrItsShareOfTheHeatBetweenTwoBegins) {
  using Real = TypeParam;
  for (const double share : {0.0, 0.25}) {
    EngineDefinition engine = diesel_495();
    engine.misfires[2] = some_of(MisfirePattern::spread, 1, 2);
    engine.misfires[2].burning_ratio = share;
    constexpr double kTick_s = 100e-6, kRad_s = 1500 * kPi / 30;
    const auto run = rig<Real, Diagram>(engine, kTick_s, kRad_s);
    const auto full = rig<Real, Healthy<Diagram>>(engine, kTick_s, kRad_s);
    const auto motored = rig<Real, Healthy<Diagram>>(engine, kTick_s, kRad_s);
    motored->in.load_ratio = 0;
    double largest_Pa = 0;
    for (int tick = 0; tick < 5 * 800; ++tick) {
      const auto& out = run->step();
      const auto &fired = full->step(), &cold = motored->step();
      double torque_Nm = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const double burns =
            k == 2 && run->engine.state().misfire[2].cycles % 2 == 0 && run->engine.state().misfire[2].cycles > 0
                ? share
                : 1;
        const auto cold_Pa = static_cast<double>(cold.cylinder[k].pressure_Pa);
        const auto fired_Pa = static_cast<double>(fired.cylinder[k].pressure_Pa);
        const double expected_Pa = cold_Pa + burns * (fired_Pa - cold_Pa);
        largest_Pa = std::max(largest_Pa, fired_Pa);
        ASSERT_NEAR(static_cast<double>(out.cylinder[k].pressure_Pa), expected_Pa, sizeof(Real) == 4 ? 8 : 1e-6)
            << "tick " << tick << ", cylinder " << k + 1;
        torque_Nm += static_cast<double>(out.cylinder[k].torque_Nm);
      }
      ASSERT_NEAR(static_cast<double>(out.torque_Nm), torque_Nm, sizeof(Real) == 4 ? 1e-3 : 1e-9);
    }
    EXPECT_GT(largest_Pa, 5e6);
  }
}

TYPED_TEST(MisfireOf, TorqueByCurvesIsThatOfTheForces) {
  using Real = TypeParam;
  EngineDefinition engine = diesel_495();
  engine.misfires[0] = some_of(MisfirePattern::spread, 2, 3);
  engine.misfires[0].burning_ratio = 0.4;
  engine.misfires[3] = some_of(MisfirePattern::burst, 2, 5);
  const auto curves = rig<Real, TorqueAlone>(engine, 100e-6, 150);
  const auto forces = rig<Real, Diagram>(engine, 100e-6, 150);
  double work_J = 0, trapezia_J = 0, last_Nm = 0, largest_Nm = 0;
  for (int tick = 0; tick < 8000; ++tick) {
    const auto& out = curves->step();
    const auto torque_Nm = static_cast<double>(forces->step().torque_Nm);
    ASSERT_NEAR(static_cast<double>(out.torque_Nm), torque_Nm, 0.05) << "tick " << tick;  // of 1 kNm, by the tables
    work_J += static_cast<double>(out.mean_torque_Nm) * 150 * 100e-6;
    trapezia_J += (torque_Nm + last_Nm) / 2 * 150 * 100e-6;
    last_Nm = torque_Nm;
    largest_Nm = std::max(largest_Nm, torque_Nm);
  }
  EXPECT_GT(largest_Nm, 300);
  EXPECT_NEAR(work_J, trapezia_J, 2e-4 * std::fabs(work_J) + 0.5);  // the mean torque has the same misfires
}

TYPED_TEST(MisfireOf, ASceneWithoutRulesHasTheBitsOfOneThatDoesNotAsk) {
  using Real = TypeParam;
  const auto same = [](auto& asking, auto& other, double tick_s) {
    for (int tick = 0; tick < 4000; ++tick) {
      if constexpr (std::is_same_v<std::decay_t<decltype(asking.in)>, Input<Real, Free>>) {
        asking.in.external_torque_Nm = other.in.external_torque_Nm = static_cast<Real>(tick < 2000 ? -80 : 40);
      }
      const auto& a = asking.step();
      const auto& b = other.step();
      std::vector<std::uint64_t> bits;
      support::each_output(a, kAll, [&](const char*, std::size_t, auto x) { bits.push_back(detail::word_of(x)); });
      std::size_t i = 0;
      support::each_output(b, kAll, [&](const char* name, std::size_t, auto x) {
        ASSERT_EQ(bits.at(i++), detail::word_of(x)) << name << " in tick " << tick << " of " << tick_s << " s";
      });
    }
  };
  const auto forces = rig<Real, Diagram>(diesel_495(), 100e-6, 200);
  const auto forces_alone = rig<Real, Healthy<Diagram>>(diesel_495(), 100e-6, 200);
  same(*forces, *forces_alone, 100e-6);
  const auto free = rig<Real, Free>(diesel_495(), 100e-6);
  const auto free_alone = rig<Real, Healthy<Free>>(diesel_495(), 100e-6);
  same(*free, *free_alone, 100e-6);
}

TEST(Misfire, ACrankThatTurnsBackOverABeginAndForwardAgainBeginsOneCycle) {
  EngineDefinition engine = diesel_495();
  const auto run = rig<double, Measured>(engine, 100e-6);
  const auto to = [&run](double deg) {
    run->in.crank = tick_test::phase_at_deg(static_cast<long double>(deg));
    run->step();
    return run->engine.state().misfire[0].cycles;
  };
  EXPECT_EQ(to(600), 0u);
  EXPECT_EQ(to(629), 0u);
  EXPECT_EQ(to(631), 1u);
  EXPECT_EQ(to(600), 1u);
  EXPECT_EQ(to(640), 1u);  // the same cycle
  EXPECT_EQ(to(370), 1u);
  EXPECT_EQ(to(350), 1u);  // back over its end at 360: in the cycle before
  EXPECT_EQ(to(610), 1u);
  EXPECT_EQ(to(650), 2u);  // and into another
  EXPECT_EQ(to(240 + 720), 2u);
  EXPECT_EQ(to(100), 2u);  // 140 deg back
  EXPECT_EQ(to(250), 2u);
}

TEST(Misfire, AJumpOfTheMeasuredAngleBeginsNoCycle) {
  const auto run = rig<double, Measured>(diesel_495(), 100e-6);
  run->in.crank = tick_test::phase_at_deg(600);
  run->step();
  run->in.crank = tick_test::phase_at_deg(660);
  run->step();
  EXPECT_EQ(run->engine.state().misfire[0].cycles, 1u);
  const std::uint32_t before = run->engine.state().misfire[2].cycles;
  run->in.crank = tick_test::phase_at_deg(660 + 340);  // backwards 380 deg, or forwards 340: within a turn of the limit
  run->step();
  const bool jumped = (run->engine.output().faults & kFaultPhaseJump) != 0;
  EXPECT_EQ(run->engine.state().misfire[2].cycles != before, !jumped);
}

// ---- the crank ------------------------------------------------------------------------------------------------------

/// J_eff of all cylinders from the exact mechanism.
[[nodiscard]] double inertia_kg_m2(const EngineDefinition& engine, double crank_deg) {
  const Masses& m = engine.masses;
  double sum = m.crank_inertia_kg_m2 + engine.machine.inertia_kg_m2;
  for (std::size_t k = 0; k < static_cast<std::size_t>(engine.layout.cylinders); ++k) {
    const Pose<double> p = exact_pose(engine.crank, (crank_deg - engine.layout.firing_deg[k]) * kPi / 180);
    sum += m.rod_big_end_kg * engine.crank.crank_radius_m * engine.crank.crank_radius_m +
           m.reciprocating_kg() * p.slope_m * p.slope_m + m.rod_inertia_correction_kg_m2 * p.rod_slope * p.rod_slope;
  }
  return sum;
}

/// Kinetic energy where the crank passes an angle, by the speeds of the ticks around it.
template <class Run>
[[nodiscard]] double energy_at(Run& run, const EngineDefinition& engine, double stop_deg) {
  double deg = 0, last_deg = 0, last_w2 = 0;
  Phase phase = run.engine.state().phase;
  for (;;) {
    const auto w = static_cast<double>(run.engine.state().speed_rad_s);
    last_deg = deg, last_w2 = w * w;
    run.step();
    deg += (run.engine.state().phase - phase).template signed_cycles<double>() * 720;
    phase = run.engine.state().phase;
    if (deg >= stop_deg) break;
  }
  const auto w = static_cast<double>(run.engine.state().speed_rad_s);
  // Energies are linear between the ticks, to second order.
  const double before_J = last_w2 / 2 * inertia_kg_m2(engine, last_deg),
               after_J = w * w / 2 * inertia_kg_m2(engine, deg);
  return before_J + (after_J - before_J) * (stop_deg - last_deg) / (deg - last_deg);
}

TYPED_TEST(MisfireOf, TheMissingWorkIsTheDifferenceOfKineticEnergiesAtEqualAngles) {
  using Real = TypeParam;
  const EngineDefinition healthy = diesel_495();
  for (const double share : {0.0, 0.6}) {
    EngineDefinition engine = healthy;
    engine.misfires[1] = listed({2});
    engine.misfires[1].burning_ratio = share;
    constexpr double kTick_s = 50e-6;
    const auto misfiring = rig<Real, Free>(engine, kTick_s), firing = rig<Real, Free>(healthy, kTick_s);
    for (auto* run : {misfiring.get(), firing.get()}) {
      run->in.load_ratio = static_cast<Real>(0.7);
      EXPECT_TRUE(run->engine.restore(turning_at<Real, Free>(run->engine.state(), Real{100})).ok());
    }
    // Cylinder 2 fires at 540 deg: its second cycle takes its fuel at 1170 and is over at 1440 + 180.
    const double missing_J = energy_at(*firing, engine, 1620) - energy_at(*misfiring, engine, 1620);
    EXPECT_EQ(misfiring->engine.state().misfire[1].misfires, 1u);

    // What its heat does, by the diagram and the exact piston.
    IndicatorDiagram diagram;
    ASSERT_TRUE(diagram.init(engine.crank, engine.pressure).ok());
    const double area_m2 = kPi / 4 * engine.crank.bore_m * engine.crank.bore_m;
    double heat_J = 0;
    constexpr int kSteps = 72'000;
    for (int i = 0; i < kSteps; ++i) {
      const double at_deg = 720.0 * (i + 0.5) / kSteps;
      const double heat_Pa = diagram.pressures(at_deg).heat_Pa;
      heat_J += heat_Pa * area_m2 * exact_pose(engine.crank, at_deg * kPi / 180).slope_m * (4 * kPi / kSteps);
    }
    const double expected_J = (1 - share) * 0.7 * heat_J;
    std::printf("%.1f burns: %.2f J of heat's work are missing, of %.2f J expected\n", share, missing_J, expected_J);
    EXPECT_NEAR(missing_J, expected_J, 0.02 * expected_J);
    EXPECT_GT(expected_J, 100);
  }
}

// ---- gas ------------------------------------------------------------------------------------------------------------

struct GasFree : support::BreathingFour {
  static constexpr CrankGiven crank = CrankGiven::torque;
  static constexpr bool misfire = true;
  static constexpr bool cylinder_cut = true;
};

TYPED_TEST(MisfireOf, OfGasTheFuelThatDoesNotBurnIsMissingAndItsWorkOnTheCrank) {
  using Real = TypeParam;
  const EngineDefinition healthy = four_2000();
  for (const double share : {0.0, 0.5}) {
    EngineDefinition engine = healthy;
    engine.misfires[2] = listed({3});
    engine.misfires[2].burning_ratio = share;
    constexpr double kTick_s = 50e-6;
    const auto misfiring = rig<Real, GasFree>(engine, kTick_s), firing = rig<Real, GasFree>(healthy, kTick_s);
    const double firing_deg = engine.layout.firing_deg[2];
    double energy_J[2], work_J[2] = {}, fuel_kg[2] = {};
    int which = 0;
    for (auto* run : {misfiring.get(), firing.get()}) {
      for (Real& fuel : run->in.fuel_kg) fuel = static_cast<Real>(25e-6);
      run->in.throttle_ratio = Real{1};
      EXPECT_TRUE(run->engine.restore(turning_at<Real, GasFree>(run->engine.state(), Real{250})).ok());
      (void)energy_at(*run, engine, firing_deg + 2 * 720 - 92);
      double last_Pa = 0, last_m3 = 0;
      const double from_deg = firing_deg + 2 * 720 - 92;
      double deg = from_deg;
      Phase phase = run->engine.state().phase;
      // To 130 deg after its dead centre, before its exhaust opens.
      while (deg < from_deg + 222) {
        run->step();
        deg += (run->engine.state().phase - phase).template signed_cycles<double>() * 720;
        phase = run->engine.state().phase;
        const auto& gas = run->engine.state().cylinder_gas;
        const auto pressure_Pa = static_cast<double>(gas.pressure_Pa[2]),
                   volume_m3 = static_cast<double>(gas.volume_m3[2]);
        if (last_m3 > 0) work_J[which] += (pressure_Pa + last_Pa) / 2 * (volume_m3 - last_m3);
        last_Pa = pressure_Pa, last_m3 = volume_m3;
      }
      const auto w = static_cast<double>(run->engine.state().speed_rad_s);
      energy_J[which] = w * w / 2 * inertia_kg_m2(engine, phase.template signed_cycles<double>() * 720);
      // The angle goes a little beyond: what the torque does there is the same to second order.
      energy_J[which] -= static_cast<double>(run->engine.output().torque_Nm) * (deg - from_deg - 222) * kPi / 180;
      (void)energy_at(*run, engine, 420 - 222 + 92);  // to its cycle's end
      fuel_kg[which] = static_cast<double>(run->engine.output().gas_cycle[2].fuel_kg);
      ++which;
    }
    EXPECT_EQ(misfiring->engine.state().misfire[2].misfires, 1u);
    EXPECT_EQ(misfiring->engine.state().misfire[2].cycles, firing->engine.state().misfire[2].cycles);
    EXPECT_NEAR(fuel_kg[0], share * fuel_kg[1], 1e-5 * fuel_kg[1]);
    EXPECT_NEAR(fuel_kg[1], 25e-6, 1e-9);
    const double missing_J = energy_J[1] - energy_J[0], expected_J = work_J[1] - work_J[0];
    std::printf("%.1f burns: the crank lacks %.2f J, the gas did %.2f J less\n", share, missing_J, expected_J);
    EXPECT_NEAR(missing_J, expected_J, 0.02 * expected_J);
    EXPECT_GT(expected_J, 100);
  }
}

TEST(Misfire, OfGasCountsAreExactAndACutCycleIsNoMisfire) {
  EngineDefinition engine = four_2000();
  engine.misfires[0] = some_of(MisfirePattern::spread, 2, 5);
  engine.misfires[3] = at_random(0.4, 9);
  const auto run = rig<float, GasFree>(engine, 100e-6);
  run->in.external_torque_Nm = 0;
  for (float& fuel : run->in.fuel_kg) fuel = 20e-6F;
  EXPECT_TRUE(run->engine.restore(turning_at<float, GasFree>(run->engine.state(), 300)).ok());
  run->in.cut_cylinders = 1u << 1;
  for (int tick = 0; tick < 40'000; ++tick) run->step();
  const auto& records = run->engine.state().misfire;
  EXPECT_GT(records[0].cycles, 90u);
  EXPECT_EQ(records[0].misfires, records[0].cycles / 5 * 2 + (records[0].cycles % 5 >= 3) + 0u);
  EXPECT_EQ(records[1].misfires, 0u);
  EXPECT_NEAR(records[3].misfires, 0.4 * records[3].cycles, 4 * std::sqrt(0.24 * records[3].cycles));
  EXPECT_EQ(static_cast<double>(run->engine.output().gas_cycle[1].fuel_kg), 0);
}

// ---- saved states ---------------------------------------------------------------------------------------------------

TYPED_TEST(MisfireOf, ARestoredRunRepeatsItsRandomMisfires) {
  using Real = TypeParam;
  using S = scenes::FreeRunning;
  EngineDefinition engine = diesel_495();
  for (Misfire& misfire : engine.misfires) misfire = at_random(0.4);
  const auto first = rig<Real, S>(engine, 100e-6), second = rig<Real, S>(engine, 100e-6);
  EXPECT_TRUE(first->engine.restore(turning_at<Real, S>(first->engine.state(), Real{200})).ok());
  for (int tick = 0; tick < 7777; ++tick) first->step();
  std::vector<unsigned char> bytes(kSavedStateBytes<Real, S>);
  ASSERT_TRUE(save_state(first->engine, bytes.data(), bytes.size()).ok());
  ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), second->engine)));
  const std::uint32_t before = first->engine.state().misfire[0].misfires;
  for (int tick = 0; tick < 7777; ++tick) first->step(), second->step();
  EXPECT_GT(first->engine.state().misfire[0].misfires, before);
  EXPECT_EQ(std::memcmp(&first->engine.state(), &second->engine.state(), sizeof first->engine.state()), 0);
}

TEST(Misfire, ARestoredStateLacksTheHeatThatItsSharesSay) {
  const auto run = rig<float, Free>(diesel_495(), 100e-6), whole = rig<float, Free>(diesel_495(), 100e-6);
  auto state = turning_at<float, Free>(run->engine.state(), 200);
  ASSERT_TRUE(whole->engine.restore(state).ok());
  state.burning_ratio[0] = 0;  // of the cylinder that fires; what follows from it is left as it was
  ASSERT_EQ(state.lacking_heat, 0u);
  ASSERT_TRUE(run->engine.restore(state).ok());
  EXPECT_EQ(run->engine.state().lacking_heat, 1u);
  bool lacks = false;
  for (int tick = 0; tick < 2000; ++tick) lacks = run->step().torque_Nm < whole->step().torque_Nm - 1 || lacks;
  EXPECT_TRUE(lacks);
  EXPECT_EQ(run->engine.state().lacking_heat, 0u);  // the next cycle has no rule
}

TEST(Misfire, AForgedStateIsRefusedOrStepped) {
  const auto run = rig<float, Free>(diesel_495(), 100e-6);
  std::vector<unsigned char> bytes(kSavedStateBytes<float, Free>);
  const auto load_forged = [&](auto forge) {
    auto state = run->engine.state();
    forge(state);
    EXPECT_TRUE(run->engine.restore(state).ok());  // a snapshot within the program is trusted
    EXPECT_TRUE(save_state(run->engine, bytes.data(), bytes.size()).ok());
    return load_state(bytes.data(), bytes.size(), run->engine);
  };
  using State = State<float, Free>;
  const auto& good = run->engine.state();
  const State kept = good;
  // Counts follow from the history, whatever it is.
  EXPECT_TRUE(accepted(load_forged([](State& s) {
    s.misfire[2].cycles = 700, s.misfire[2].in_200_turns = 77;
    s.misfire[2].history[699 / 32 % 16] = 1u << (699 % 32), s.misfire[2].history[240 / 32] = 1u << (240 % 32);
    s.misfire[2].history[190 / 32] |= 1u << (190 % 32);
  })));
  EXPECT_EQ(good.misfire[2].in_200_turns, 1u);   // cycles 600 to 699
  EXPECT_EQ(good.misfire[2].in_1000_turns, 2u);  // 200 to 699: 190, which is 702 too, is not among them
  ASSERT_TRUE(run->engine.restore(kept).ok());
  EXPECT_TRUE(
      support::refuses(load_forged([](State& s) { s.misfire[0].taken = 2; }), Reason::out_of_range, "state.misfire"));
  ASSERT_TRUE(run->engine.restore(kept).ok());
  EXPECT_TRUE(support::refuses(load_forged([](State& s) { s.burning_ratio[3] = 1.5F; }), Reason::out_of_range,
                               "state.misfire"));
  ASSERT_TRUE(run->engine.restore(kept).ok());

  // All ones: counts run around, no output is other than finite, no index leaves its table.
  EngineDefinition engine = diesel_495();
  engine.misfires[0] = listed({1, 2, 3}), engine.misfires[1] = at_random(0.5);
  engine.misfires[2] = some_of(MisfirePattern::spread, 65535, 65535),
  engine.misfires[3] = some_of(MisfirePattern::burst, 7, 9);
  const auto wild = rig<float, Free>(engine, 100e-6);
  auto state = turning_at<float, Free>(wild->engine.state(), 300);
  for (MisfireRecord& record : state.misfire) {
    std::memset(&record, 0xFF, sizeof record);
    record.random = 0;
  }
  ASSERT_TRUE(wild->engine.restore(state).ok());
  for (int tick = 0; tick < 20'000; ++tick) {
    const auto& out = wild->step();
    ASSERT_TRUE(std::isfinite(out.torque_Nm) && std::isfinite(out.speed_rad_s));
  }
  EXPECT_LT(wild->engine.state().misfire[2].cycles, 1000u);  // went around
}

}  // namespace
}  // namespace crankloop::misfire_test

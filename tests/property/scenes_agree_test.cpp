// A scene that leaves outputs out gives the same bits in what it keeps: for every subset of the output groups, for
// engines of 1 to 8 cylinders, even and uneven firing, exact and up-to counts, pressures from tables, with load, from
// outside or none.
//
// One rule has a reason of its own: with forces asked for, the torque at the tick is their sum, without them it is read
// from curves. So scenes with forces are compared among themselves, and scenes without.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "support/output_numbers.hpp"
#include "support/test_engines.hpp"
#include "support/test_scenes.hpp"

namespace crankloop {
namespace {

using namespace tick_test;

constexpr double kTick_s = 200e-6;
constexpr int kTicks = 330;

struct Named {
  std::string name;
  EngineDefinition engine;
};
std::vector<Named> engines() {
  const EngineDefinition one = single_495();
  EngineDefinition v8 = with_cylinders(one, {0, 90, 270, 180, 630, 540, 450, 360});
  return {{"one cylinder", one},
          {"three", with_cylinders(one, {0, 240, 480})},
          {"the 495", diesel_495()},
          {"uneven V4", uneven_v4()},
          {"inline six", with_cylinders(one, {0, 480, 240, 600, 120, 360})},
          {"cross-plane eight", v8},
          {"six that fire at odd angles", with_cylinders(one, {3.7, 719.99, 360.3, 0.3, 363.7, 100})}};
}

/// An engine's life in a test: it speeds up and slows down, crawls, stands, turns back; load and pressures vary; some
/// inputs are bad.
template <class Real, class S>
typename Engine<Real, S>::Input input_at(int tick) {
  typename Engine<Real, S>::Input in;
  const double crawl[] = {0, 0.001, -0.002, 0.5, 4, -7};
  const double speed = tick % 60 < 54 ? 150 + 1.1 * (tick % 97) : crawl[tick % 6];
  in.speed_rad_s = static_cast<Real>(tick > 280 ? -speed : speed);
  if (tick % 71 == 70) in.speed_rad_s = static_cast<Real>(1e30);
  if constexpr (Needs<S>::load) {
    in.load_ratio = static_cast<Real>(0.02 * (tick % 53));
    if (tick % 83 == 82) in.load_ratio = static_cast<Real>(-5);
  }
  if constexpr (Needs<S>::input_pressure) {
    for (std::uint32_t k = 0; k < S::cylinders.capacity; ++k)
      in.pressure_Pa[k] = static_cast<Real>(1e5 + 3e4 * ((tick + 31 * static_cast<int>(k)) % 89));
    if (tick % 91 == 90) in.pressure_Pa[0] = static_cast<Real>(-1);
  }
  return in;
}

template <class Real>
struct Tick {
  std::vector<Real> numbers;
  std::uint32_t faults;
};

template <unsigned Wanted, class Real, class S>
std::vector<Tick<Real>> life_of(const FullTables<Real>& tables) {
  Running<Real, S> run(tables, phase_at_deg(33));
  const InUse use = in_use(tables);
  std::vector<Tick<Real>> ticks;
  for (int tick = 0; tick < kTicks; ++tick) {
    const auto& out = run.engine.step(input_at<Real, S>(tick));
    ticks.push_back({numbers<Wanted>(out, use), out.faults});
  }
  return ticks;
}

constexpr unsigned kWithoutForces = kAllGroups & ~(unsigned{kForces} | unsigned{kBearingLoads});
/// Bearing loads are made from forces.
constexpr bool allowed(unsigned groups) { return (groups & kBearingLoads) == 0 || (groups & kForces) != 0; }

/// A bad load ratio is no fault of a scene in which nothing depends on it, nor is a bad pressure.
template <class S>
constexpr std::uint32_t kFaultsOf = std::uint32_t{kFaultSpeed} | (Needs<S>::load ? kFaultLoadRatio : 0u) |
                                    (Needs<S>::input_pressure ? kFaultPressure : 0u);

/// Runs the scene that asks for `Groups` against the numbers of the same groups from the scene that asks for all.
template <unsigned Groups, PressureGiven Source, bool ByLoad, class Real>
void expect_subset_to_agree(const FullTables<Real>& tables, const std::string& name) {
  if constexpr (allowed(Groups)) {
    using Subset = Asking<Groups, Source, ByLoad>;
    using Whole = Asking<((Groups & kForces) != 0 ? unsigned{kAllGroups} : kWithoutForces), Source, ByLoad>;
    const auto want = life_of<Groups, Real, Whole>(tables);
    const auto got = life_of<kAllGroups, Real, Subset>(tables);
    for (std::size_t tick = 0; tick < want.size(); ++tick) {
      ASSERT_TRUE(same_bits(got[tick].numbers, want[tick].numbers))
          << name << ", groups " << Groups << ", tick " << tick;
      ASSERT_EQ(got[tick].faults, want[tick].faults & kFaultsOf<Subset>)
          << name << ", groups " << Groups << ", tick " << tick;
    }
  }
}
template <PressureGiven Source, bool ByLoad, class Real, unsigned... Groups>
void expect_subsets_to_agree(const FullTables<Real>& tables, const std::string& name,
                             std::integer_sequence<unsigned, Groups...>) {
  (expect_subset_to_agree<Groups, Source, ByLoad>(tables, name), ...);
}

template <class Real>
class ScenesAgree : public ::testing::Test {};
TYPED_TEST_SUITE(ScenesAgree, BothReals, RealName);

TEST(ScenesAgreeInFloat, EverySubsetOfTheOutputGroupsWithPressureFromTables) {
  for (const Named& n : engines()) {
    FullTables<float> tables;
    ASSERT_TRUE(tables.build(n.engine, kTick_s, 1500).ok()) << n.name;
    expect_subsets_to_agree<PressureGiven::by_table, false>(tables, n.name,
                                                            std::make_integer_sequence<unsigned, kAllGroups + 1>{});
  }
}

/// What scalar and pressure change is torque and forces: each of them alone, in pairs, and with the rest. (All subsets
/// of all would be the same code compiled five hundred times.)
using TorqueAndForces =
    std::integer_sequence<unsigned, kTorque, kMeanTorque, kForces, kForces | kTorque, kForces | kMeanTorque,
                          kForces | kBearingLoads, kKinematics | kMeanTorque, kAllGroups & ~kMeanTorque,
                          kAllGroups & ~kTorque, kFreeForces | kRodMotion>;

TYPED_TEST(ScenesAgree, TheSubsetsOfTorqueAndForcesWithAnyPressure) {
  using Real = TypeParam;
  for (const Named& n : engines()) {
    FullTables<Real> tables;
    ASSERT_TRUE(tables.build(n.engine, kTick_s, 1500).ok()) << n.name;
    expect_subsets_to_agree<PressureGiven::by_table, false>(tables, n.name + " by table", TorqueAndForces{});
    expect_subsets_to_agree<PressureGiven::by_table, true>(tables, n.name + " by load", TorqueAndForces{});
    expect_subsets_to_agree<PressureGiven::by_input, false>(tables, n.name + " by input", TorqueAndForces{});
    expect_subsets_to_agree<PressureGiven::none, false>(tables, n.name + " without gas", TorqueAndForces{});
  }
}

TYPED_TEST(ScenesAgree, WithAndWithoutForcesInAllThatDoesNotComeFromThem) {
  using Real = TypeParam;
  for (const Named& n : engines()) {
    FullTables<Real> tables;
    ASSERT_TRUE(tables.build(n.engine, kTick_s, 1500).ok()) << n.name;
    constexpr unsigned kApart = kKinematics | kRodMotion | kFreeForces;
    const auto with = life_of<kApart, Real, Asking<kAllGroups>>(tables);
    const auto without = life_of<kApart, Real, Asking<kWithoutForces>>(tables);
    for (std::size_t tick = 0; tick < with.size(); ++tick) {
      ASSERT_TRUE(same_bits(with[tick].numbers, without[tick].numbers)) << n.name << ", tick " << tick;
    }
  }
}

/// The scene for exactly N cylinders, loops unrolled, against the one for up to sixteen.
template <std::uint32_t N, class Real>
void expect_exact_count_to_agree(const std::vector<double>& firing_deg) {
  FullTables<Real> tables;
  ASSERT_TRUE(tables.build(with_cylinders(single_495(), firing_deg), kTick_s, 1500).ok());
  const auto compare = [&](const auto& exact, const auto& up_to) {
    for (std::size_t tick = 0; tick < exact.size(); ++tick) {
      ASSERT_TRUE(same_bits(exact[tick].numbers, up_to[tick].numbers)) << N << " cylinders, tick " << tick;
      ASSERT_EQ(exact[tick].faults, up_to[tick].faults) << N << " cylinders, tick " << tick;
    }
  };
  constexpr auto kSpeed = CrankGiven::speed;
  compare(life_of<kAllGroups, Real, Asking<kAllGroups, PressureGiven::by_table, false, kSpeed, N>>(tables),
          life_of<kAllGroups, Real, Asking<kAllGroups>>(tables));
  compare(life_of<kAllGroups, Real, Asking<kTorque | kMeanTorque, PressureGiven::by_table, true, kSpeed, N>>(tables),
          life_of<kAllGroups, Real, Asking<kTorque | kMeanTorque, PressureGiven::by_table, true>>(tables));
  compare(life_of<kAllGroups, Real, Asking<kTorque | kMeanTorque | kForces, PressureGiven::by_input, false, kSpeed, N>>(
              tables),
          life_of<kAllGroups, Real, Asking<kTorque | kMeanTorque | kForces, PressureGiven::by_input>>(tables));
}

TYPED_TEST(ScenesAgree, ExactlyNCylindersWithUpToSixteen) {
  using Real = TypeParam;
  expect_exact_count_to_agree<1, Real>({0});
  expect_exact_count_to_agree<3, Real>({0, 480, 240});
  expect_exact_count_to_agree<4, Real>({0, 540, 180, 360});
  expect_exact_count_to_agree<4, Real>({0, 90, 450, 360.5});
  expect_exact_count_to_agree<6, Real>({0, 480, 240, 600, 120, 360});
  expect_exact_count_to_agree<8, Real>({0, 90, 270, 180, 630, 540, 450, 360});
}

}  // namespace
}  // namespace crankloop

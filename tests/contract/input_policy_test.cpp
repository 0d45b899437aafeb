// docs/contract.md "Inputs of a step", of an engine with elastic valves: each input's range to the last bit, what a bad
// one is replaced by, the way back, and counters and speeds at their ends.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <crankloop/tick/state/saved_state.hpp>

#include "support/both_reals.hpp"
#include "support/kept_engines.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/units.hpp"

namespace crankloop::input_policy_test {
namespace {

using namespace tick_test;
using support::Random;

template <class Real>
class InputPolicy : public ::testing::Test {};
TYPED_TEST_SUITE(InputPolicy, BothReals, RealName);

template <class Real>
std::vector<Real> no_numbers() {
  using Limits = std::numeric_limits<Real>;
  return {Limits::quiet_NaN(), -Limits::quiet_NaN(), Limits::signaling_NaN(), Limits::infinity(), -Limits::infinity()};
}

/// What is good up to its last bit, and what is bad from the next one on.
template <class Real>
struct Range {
  const char* name;
  Real least, most;
  Fault fault;
  std::uint32_t place;  ///< cylinder or train, where there are several
};

template <class Real, class S>
void set(typename Engine<Real, S>::Input& in, const Range<Real>& range, Real x) {
  if (range.fault == kFaultCamPhase) in.cam_phase_deg[range.place] = x;
  if constexpr (S::crank == CrankGiven::speed) {
    if (range.fault == kFaultSpeed) in.speed_rad_s = x;
    if (range.fault == kFaultLoadRatio) in.load_ratio = x;
  } else {
    if (range.fault == kFaultPressure) in.pressure_Pa[range.place] = x;
  }
}

/// An engine that is given x answers as one that is given what stands for it, and says so for that tick only.
template <class Real, class S>
void expect_stands_for(const Range<Real>& range, Real x, Real stands_for, std::uint32_t faults) {
  const auto given = started_four<Real, S>(phase_at_deg(40));
  const auto meant = started_four<Real, S>(phase_at_deg(40));
  typename Engine<Real, S>::Input in;
  if constexpr (S::crank == CrankGiven::speed) in.speed_rad_s = Real{300};
  for (int tick = 0; tick < 6; ++tick) {
    if constexpr (S::crank == CrankGiven::phase) in.crank = phase_at_deg(40 + 0.9L * tick);
    const Real good = (range.least + range.most) / 2;
    const bool now = tick == 3;
    set<Real, S>(in, range, now ? x : good);
    const auto& out = given->step(in);
    set<Real, S>(in, range, now ? stands_for : good);
    const auto& want = meant->step(in);
    EXPECT_EQ(out.faults, now ? faults : 0u) << range.name << " = " << x << ", tick " << tick;
    EXPECT_EQ(bits_now(out), bits_now(want)) << range.name << " = " << x << ", tick " << tick;
  }
}

template <class Real, class S>
void expect_range(const Range<Real>& range) {
  constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
  const Real good = (range.least + range.most) / 2;
  for (const Real x : {range.least, range.most, Real{0}, -Real{0}}) expect_stands_for<Real, S>(range, x, x, 0);
  std::vector<Real> bad = no_numbers<Real>();
  bad.push_back(std::nextafter(range.least, -kInfinity));
  bad.push_back(std::nextafter(range.most, kInfinity));
  for (const Real x : bad) expect_stands_for<Real, S>(range, x, good, range.fault);
}

TYPED_TEST(InputPolicy, KeepsEveryRangeOfItsTableToTheLastBit) {
  using Real = TypeParam;
  const Real limit = tables_of_four<Real, FourWithValves>().tables().drive->speed_limit_rad_s;
  expect_range<Real, FourWithValves>({"speed_rad_s", -limit, limit, kFaultSpeed, 0});
  expect_range<Real, FourWithValves>({"load_ratio", 0, 2, kFaultLoadRatio, 0});
  for (std::uint32_t train = 0; train < 2; ++train) {
    expect_range<Real, FourWithValves>({"cam_phase_deg", -180, 180, kFaultCamPhase, train});
  }
  for (std::uint32_t k = 0; k < 4; ++k) {
    expect_range<Real, MeasuredFourWithValves>({"pressure_Pa", 0, static_cast<Real>(1e8), kFaultPressure, k});
  }
}

TYPED_TEST(InputPolicy, TakesAStepOfTheCrankUpToTheSpeedLimitAndBeyondItForAJump) {
  using Real = TypeParam;
  const auto& drive = *tables_of_four<Real, MeasuredFourWithValves>().tables().drive;
  // The limit as an angle of the tick, 50 us: less than half a cycle, so that it has a sign.
  const long double limit_deg = static_cast<long double>(drive.speed_limit_rad_s) * 50e-6L * 180 / support::kWidePi;
  for (const long double sign : {1.0L, -1.0L}) {
    for (const long double part : {0.999999L, 1.000001L}) {
      const auto engine = started_four<Real, MeasuredFourWithValves>();
      typename Engine<Real, MeasuredFourWithValves>::Input in;
      in.crank = phase_at_deg(300);
      engine->step(in);
      in.crank = phase_at_deg(300 + sign * part * limit_deg);
      EXPECT_EQ(engine->step(in).faults, part > 1 ? std::uint32_t{kFaultPhaseJump} : 0u)
          << static_cast<double>(sign * part);
      EXPECT_EQ(engine->state().phase.units(), in.crank.units()) << "the new angle is taken";
      EXPECT_EQ(engine->step(in).faults, 0u);
    }
  }
}

TYPED_TEST(InputPolicy, IsBackOnTheCurveOneCycleAfterTheLastBadInput) {
  // A crank that turns evenly at 6000 rpm; for a cycle pressures, cam targets and the crank itself are anything.
  using Real = TypeParam;
  using S = MeasuredFourWithValves;
  Random random;
  constexpr std::uint32_t kTicksPerCycle = 400;
  for (int draw = 0; draw < 10; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const auto hurt = started_four<Real, S>();
    const auto sound = started_four<Real, S>();
    typename Engine<Real, S>::Input in;
    for (Real& p : in.pressure_Pa) p = static_cast<Real>(1.2e5);
    std::uint32_t faults = 0;
    std::uint32_t differing = 0;
    for (std::uint32_t tick = 0; tick < 4 * kTicksPerCycle; ++tick) {
      in.crank += Phase{~std::uint64_t{0} / kTicksPerCycle};
      auto given = in;
      const bool bad = tick >= kTicksPerCycle && tick < 2 * kTicksPerCycle && random.whole(0, 3) == 0;
      if (bad) {
        for (Real& p : given.pressure_Pa) p = no_numbers<Real>()[static_cast<std::size_t>(random.whole(0, 4))];
        for (Real& deg : given.cam_phase_deg) deg = static_cast<Real>(random.coin() ? 1e9 : -200);
        if (random.coin()) given.crank = Phase{random.bits()};
      }
      const auto& out = hurt->step(given);
      faults |= out.faults;
      ASSERT_TRUE(is_finite(out));
      const std::vector<std::uint64_t> want = bits_now(sound->step(in));
      if (bits_now(out) != want) {
        ++differing;
        ASSERT_LE(tick, 3 * kTicksPerCycle) << "still off its curve more than a cycle after the last bad input";
      }
    }
    EXPECT_EQ(faults & ~std::uint32_t{kFaultEventBudget},
              std::uint32_t{kFaultPressure} | std::uint32_t{kFaultCamPhase} | std::uint32_t{kFaultPhaseJump});
    EXPECT_GT(differing, 20u) << "or nothing was hurt";
  }
}

TYPED_TEST(InputPolicy, CountsTicksPast2To32AndBeyond2To64WithoutNoticing) {
  using Real = TypeParam;
  using S = FourWithValves;
  for (const std::uint64_t count :
       {(std::uint64_t{1} << 32) - 3, (std::uint64_t{1} << 53) - 3, ~std::uint64_t{0} - 3}) {
    const auto aged = started_four<Real, S>(phase_at_deg(10));
    const auto young = started_four<Real, S>(phase_at_deg(10));
    typename Engine<Real, S>::Input in;
    in.speed_rad_s = Real{600};
    for (int tick = 0; tick < 50; ++tick) aged->step(in), young->step(in);
    State<Real, S> state = aged->state();
    state.ticks = count;
    ASSERT_TRUE(accepted(aged->restore(state)));
    for (std::uint64_t tick = 1; tick < 10; ++tick) {
      EXPECT_EQ(bits_now(aged->step(in)), bits_now(young->step(in)));
      EXPECT_EQ(aged->state().ticks, count + tick);
    }
    std::vector<unsigned char> bytes(kSavedStateBytes<Real, S>);
    ASSERT_TRUE(accepted(save_state(*aged, bytes.data(), bytes.size())));
    ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), *young)));
    EXPECT_EQ(young->state().ticks, count + 9);
  }
}

TYPED_TEST(InputPolicy, TurnsAtAnySpeedFromAMillionthRpmBothWaysByTheAngleThatSpeedTimesTimeIs) {
  using Real = TypeParam;
  using S = FourWithValves;
  constexpr int kTicks = 2000;
  for (double rpm = 1e-6; rpm < 30'001; rpm *= std::sqrt(10.0)) {
    for (const double sign : {1.0, -1.0}) {
      const auto engine = started_four<Real, S>(phase_at_deg(100));
      typename Engine<Real, S>::Input in;
      in.speed_rad_s = static_cast<Real>(sign * rpm * support::kPi / 30);
      std::uint64_t before = engine->state().phase.units();
      long double turned_units = 0;
      for (int tick = 0; tick < kTicks; ++tick) {
        ASSERT_TRUE(is_finite(engine->step(in))) << rpm;
        ASSERT_EQ(engine->output().faults & ~std::uint32_t{kFaultEventBudget}, 0u) << rpm;
        const std::uint64_t now = engine->state().phase.units();
        turned_units += static_cast<long double>(static_cast<std::int64_t>(now - before));
        before = now;
      }
      const long double per_rad = 18446744073709551616.0L / 12.566370614359172953850573533118L;
      const long double want = wide(in.speed_rad_s) * 50e-6L * kTicks * per_rad;
      // Each tick: a product of two rounded factors, and up to 3 units lost to the integer (phase.hpp).
      const long double allowed = 3 * wide(std::numeric_limits<Real>::epsilon()) * std::fabs(want) + 4.0L * kTicks;
      EXPECT_LE(std::fabs(turned_units - want), allowed) << sign * rpm << " rpm";
    }
  }
}

TYPED_TEST(InputPolicy, StandsAtZeroOfEitherSign) {
  using Real = TypeParam;
  using S = FourWithValves;
  for (const long double start_deg : {0.0L, 100.0L, 450.0L, 610.0L}) {
    const auto plus = started_four<Real, S>(phase_at_deg(start_deg));
    const auto minus = started_four<Real, S>(phase_at_deg(start_deg));
    typename Engine<Real, S>::Input in;
    for (int tick = 0; tick < 100; ++tick) {
      in.speed_rad_s = Real{0};
      const auto& out = plus->step(in);
      in.speed_rad_s = -Real{0};
      const auto& out_minus = minus->step(in);
      EXPECT_EQ(out.faults | out_minus.faults, 0u);
      EXPECT_EQ(plus->state().phase.units(), minus->state().phase.units());
      for (std::uint32_t t = 0; t < 2; ++t) {
        for (std::uint32_t k = 0; k < 4; ++k) {
          EXPECT_EQ(out.valve[t][k].lift_m, out_minus.valve[t][k].lift_m);
          EXPECT_EQ(out.valve[t][k].velocity_m_s, out_minus.valve[t][k].velocity_m_s);
        }
      }
      EXPECT_EQ(out.torque_Nm, out_minus.torque_Nm);
      EXPECT_EQ(out.mean_torque_Nm, out_minus.mean_torque_Nm);
    }
  }
}

}  // namespace
}  // namespace crankloop::input_policy_test

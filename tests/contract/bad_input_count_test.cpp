// docs/contract.md "Recovery": a scene that asks for bad_input_count has ticks with bad inputs counted, and their kinds
// kept, in its state; nothing else changes.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

#include <crankloop/tick/state/saved_state.hpp>

#include "support/both_reals.hpp"
#include "support/kept_engines.hpp"
#include "support/random.hpp"
#include "support/status.hpp"

namespace crankloop::bad_input_count_test {
namespace {

using namespace tick_test;
using support::Random;

static_assert(sizeof(State<float, CountingFour>) == sizeof(State<float, FourWithValves>) + 8);
static_assert(sizeof(State<double, CountingFour>) == sizeof(State<double, FourWithValves>) + 8);

template <class Real>
class BadInputCount : public ::testing::Test {
 protected:
  static constexpr Real kNoNumber = std::numeric_limits<Real>::quiet_NaN();
};
TYPED_TEST_SUITE(BadInputCount, BothReals, RealName);

template <class Real, class S>
typename Engine<Real, S>::Input at_speed(Real speed_rad_s) {
  typename Engine<Real, S>::Input in;
  in.speed_rad_s = speed_rad_s;
  return in;
}

TYPED_TEST(BadInputCount, CountsEachTickWithABadInputOnceAndChangesNoOutput) {
  using Real = TypeParam;
  Random random;
  SCOPED_TRACE(random.trace(0));
  const auto counting = started_four<Real, CountingFour>(phase_at_deg(40));
  const auto plain = started_four<Real, FourWithValves>(phase_at_deg(40));
  std::uint32_t bad_ticks = 0;
  std::uint32_t kinds = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    auto in = at_speed<Real, CountingFour>(static_cast<Real>(random.between(-100, 700)));
    in.load_ratio = static_cast<Real>(random.between(0, 2));
    std::uint32_t bad = 0;
    // Rare ones last, so that kinds come in one after another.
    if (random.whole(0, 9) == 0) in.load_ratio = static_cast<Real>(2.5), bad |= kFaultLoadRatio;
    if (random.whole(0, 9) == 0 && tick > 500) in.cam_phase_deg[1] = this->kNoNumber, bad |= kFaultCamPhase;
    if (random.whole(0, 9) == 0 && tick > 1000) in.speed_rad_s = this->kNoNumber, bad |= kFaultSpeed;
    bad_ticks += bad != 0 ? 1 : 0;
    kinds |= bad;
    typename Engine<Real, FourWithValves>::Input same;
    same.speed_rad_s = in.speed_rad_s;
    same.load_ratio = in.load_ratio;
    for (std::uint32_t t = 0; t < 2; ++t) same.cam_phase_deg[t] = in.cam_phase_deg[t];
    const auto& out = counting->step(in);
    const auto& want = plain->step(same);
    ASSERT_EQ(out.faults, want.faults);
    ASSERT_EQ(bits_now(out), bits_now(want));
    ASSERT_EQ(counting->state().bad_input_ticks, bad_ticks) << "tick " << tick;
    ASSERT_EQ(counting->state().bad_input_kinds, kinds) << "tick " << tick;
  }
  EXPECT_EQ(kinds, std::uint32_t{kFaultLoadRatio} | std::uint32_t{kFaultCamPhase} | std::uint32_t{kFaultSpeed});
}

TYPED_TEST(BadInputCount, CountsBadPressuresAndJumpsOfAMeasuredCrankButNotItsFirstAngle) {
  using Real = TypeParam;
  const auto engine = started_four<Real, CountingMeasuredFour>();
  typename Engine<Real, CountingMeasuredFour>::Input in;
  for (Real& p : in.pressure_Pa) p = static_cast<Real>(1.2e5);
  const auto expect = [&](std::uint32_t ticks, std::uint32_t kinds) {
    engine->step(in);
    EXPECT_EQ(engine->state().bad_input_ticks, ticks);
    EXPECT_EQ(engine->state().bad_input_kinds, kinds);
  };
  in.crank = phase_at_deg(300);
  expect(0, 0);
  in.crank = phase_at_deg(301);
  for (Real& p : in.pressure_Pa) p = this->kNoNumber;
  expect(1, kFaultPressure);
  for (Real& p : in.pressure_Pa) p = static_cast<Real>(1.2e5);
  expect(1, kFaultPressure);
  in.crank = phase_at_deg(30);
  expect(2, std::uint32_t{kFaultPressure} | std::uint32_t{kFaultPhaseJump});
}

TYPED_TEST(BadInputCount, StaysAtItsLargestValue) {
  using Real = TypeParam;
  const auto engine = started_four<Real, CountingFour>();
  auto state = engine->state();
  state.bad_input_ticks = ~std::uint32_t{0} - 1;
  ASSERT_TRUE(accepted(engine->restore(state)));
  for (int tick = 0; tick < 3; ++tick) {
    engine->step(at_speed<Real, CountingFour>(this->kNoNumber));
    EXPECT_EQ(engine->state().bad_input_ticks, ~std::uint32_t{0});
  }
}

TYPED_TEST(BadInputCount, GoesOnFromASnapshotAndFromBytesAndBeginsAnewWithInit) {
  using Real = TypeParam;
  const auto engine = started_four<Real, CountingFour>();
  for (int tick = 0; tick < 5; ++tick) engine->step(at_speed<Real, CountingFour>(this->kNoNumber));
  const auto snapshot = engine->state();
  std::vector<unsigned char> bytes(kSavedStateBytes<Real, CountingFour>);
  ASSERT_TRUE(accepted(save_state(*engine, bytes.data(), bytes.size())));
  ASSERT_TRUE(accepted(engine->init(*engine->tables())));
  EXPECT_EQ(engine->state().bad_input_ticks, 0u);
  EXPECT_EQ(engine->state().bad_input_kinds, 0u);
  for (const bool from_bytes : {false, true}) {
    ASSERT_TRUE(accepted(from_bytes ? load_state(bytes.data(), bytes.size(), *engine) : engine->restore(snapshot)));
    EXPECT_EQ(engine->state().bad_input_ticks, 5u);
    engine->step(at_speed<Real, CountingFour>(this->kNoNumber));
    EXPECT_EQ(engine->state().bad_input_ticks, 6u);
    EXPECT_EQ(engine->state().bad_input_kinds, std::uint32_t{kFaultSpeed});
  }
}

}  // namespace
}  // namespace crankloop::bad_input_count_test

// A scene that shows its valves' motion alone takes short cuts for those at rest, carried by their train or settling; a scene that watches
// forces and records takes none. Both move their valves to the same bits: at ticks of one whole step and of many, at speeds from
// standstill to a lobe in a tick, and through jumps of the crank.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <memory>

#include "support/both_reals.hpp"
#include "support/four_with_valves.hpp"
#include "support/random.hpp"

namespace crankloop {
namespace {

using namespace tick_test;
using support::Random;

struct Unwatched : MeasuredFourWithValves {
  static constexpr bool valve_results = false;
  static constexpr bool valve_forces = false;
};

template <class Real>
class ValvePaths : public ::testing::Test {};
TYPED_TEST_SUITE(ValvePaths, BothReals, RealName);

template <class Real, class S>
struct Rig {
  explicit Rig(double tick_s) {
    EXPECT_TRUE(tables.build(four_with_valves(), {tick_s, {}}).ok());
    EXPECT_TRUE(engine.init(tables.tables()).ok());
  }
  TableStorage<Real, S> tables;
  Engine<Real, S> engine;
};

template <class Real>
bool same_bits(Real a, Real b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TYPED_TEST(ValvePaths, AllLeadToTheSameMotion) {
  using Real = TypeParam;
  using Watched = MeasuredFourWithValves;
  Random random;
  int moving = 0;
  for (const double tick_s : {20e-6, 250e-6, 2e-3}) {
    const auto watched = std::make_unique<Rig<Real, Watched>>(tick_s);
    const auto unwatched = std::make_unique<Rig<Real, Unwatched>>(tick_s);
    const double limit_deg_per_tick = static_cast<double>(watched->tables.tables().drive->speed_limit_rad_s) * tick_s * 180 / 3.14159265358979;
    typename Engine<Real, Watched>::Input in;
    typename Engine<Real, Unwatched>::Input same;
    double deg_per_tick = 0;
    for (int tick = 0; tick < 6000; ++tick) {
      if (tick % 500 == 0) deg_per_tick = random.between(-1, 1) * limit_deg_per_tick * (random.coin() ? 1 : 0.05);
      in.crank += Phase{static_cast<std::uint64_t>(static_cast<std::int64_t>(deg_per_tick / 720 * 0x1p64))};
      if (random.whole(0, 299) == 0) in.crank = Phase{random.bits()};
      for (Real& p : in.pressure_Pa) p = static_cast<Real>(1.5e5);
      same.crank = in.crank;
      std::memcpy(same.pressure_Pa, in.pressure_Pa, sizeof in.pressure_Pa);
      const auto& want = watched->engine.step(in);
      const auto& out = unwatched->engine.step(same);
      ASSERT_EQ(out.faults, want.faults);
      for (int t = 0; t < 2; ++t) {
        for (int k = 0; k < 4; ++k) {
          ASSERT_TRUE(same_bits(out.valve[t][k].lift_m, want.valve[t][k].lift_m) && same_bits(out.valve[t][k].velocity_m_s, want.valve[t][k].velocity_m_s))
              << random.trace(tick) << ", tick of " << tick_s * 1e6 << " us, train " << t << ", cylinder " << k << ": " << out.valve[t][k].lift_m
              << " m for " << want.valve[t][k].lift_m;
          moving += want.valve[t][k].lift_m > static_cast<Real>(1e-4) ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(moving, 5000) << "or nothing happened";
}

}  // namespace
}  // namespace crankloop

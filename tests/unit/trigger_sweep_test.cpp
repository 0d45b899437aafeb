// One tick of a trigger wheel where its numbers are at an end: levels of inverted wheels, an edge at the very end of a
// tick or at the crank's turning point, a list that is exactly full, a leap under a moving phaser.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/tick/step.hpp>

#include "support/both_reals.hpp"
#include "support/engines.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"
#include "support/trigger_wheels.hpp"
#include "support/units.hpp"

namespace crankloop::trigger_sweep_test {
namespace {

using namespace tick_test;
using support::Random;

/// The signal of a drawn wheel at a crank angle: 1 on a tooth, inverted 0.
std::uint32_t drawn_level(const DrawnWheel& wheel, double crank_deg) {
  const double turn_deg = wheel.turn_deg();
  double on_wheel = std::fmod(crank_deg - wheel.definition.first_tooth_deg, turn_deg);
  if (on_wheel < 0) on_wheel += turn_deg;
  const double place = on_wheel / turn_deg * static_cast<double>(wheel.places.size());
  const auto at = static_cast<std::size_t>(place);
  const bool on_tooth = wheel.places[at] == 'x' && place - static_cast<double>(at) < wheel.definition.tooth_ratio;
  return on_tooth != wheel.definition.inverted ? 1 : 0;
}

template <class Real>
class TriggerSweep : public ::testing::Test {};
TYPED_TEST_SUITE(TriggerSweep, BothReals, RealName);

TYPED_TEST(TriggerSweep, HasTheDrawnLevelOfUprightAndInvertedWheelsAfterEveryTickAndEveryEdge) {
  using Real = TypeParam;
  std::vector<DrawnWheel> wheels = drawn_wheels();
  for (std::size_t i = 3; i < wheels.size(); i += 2) wheels[i].definition.inverted = true;
  const auto storage = std::make_unique<TableStorage<Real, MeasuredWheels>>();
  ASSERT_TRUE(accepted(storage->build(with_wheels(diesel_495(), wheels), {100e-6, {}})));
  for (const double deg_per_tick : {0.73, -0.73, 31.3, -31.3}) {
    Engine<Real, MeasuredWheels> engine;
    ASSERT_TRUE(accepted(engine.init(storage->tables(), phase_at_deg(11))));
    std::vector<int> edges(wheels.size());
    double crank_deg = 11.137;  // and on: on no edge of any wheel
    for (int tick = 0; tick < 1500; ++tick, crank_deg += deg_per_tick) {
      typename Engine<Real, MeasuredWheels>::Input in;
      in.crank = phase_at_deg(static_cast<long double>(crank_deg - 720 * std::floor(crank_deg / 720)));
      const auto& out = engine.step(in);
      for (std::size_t w = 0; w < wheels.size(); ++w) {
        const auto& signal = out.trigger[w];
        ASSERT_EQ(signal.level, drawn_level(wheels[w], crank_deg)) << wheels[w].name << ", tick " << tick;
        for (std::uint32_t e = 0; e < signal.edge_count; ++e) {
          const std::uint32_t to_come = signal.edge_count - 1 - e;  // levels alternate up to the one at the end
          ASSERT_EQ(signal.edge[e].level, signal.level ^ (to_come & 1u)) << wheels[w].name << ", tick " << tick;
        }
        edges[w] += static_cast<int>(signal.edge_count);
      }
    }
    for (std::size_t w = 0; w < wheels.size(); ++w) EXPECT_GT(edges[w], 0) << wheels[w].name;
  }
}

/// A wheel of one tooth, from 0 to half of its turn, that no crank drives.
struct HalfMoon {
  HalfMoon() {
    EngineDefinition engine = diesel_495();
    engine.triggers[engine.trigger_count++] = toothed(TriggerShaft::crank, 1, {}, 0);
    EXPECT_TRUE(accepted(storage->build(engine, {1e-3, {}})));
  }
  [[nodiscard]] const detail::TriggerTrack& track() const { return storage->tables().triggers->wheel[0]; }
  std::unique_ptr<TableStorage<double, OneWheel>> storage = std::make_unique<TableStorage<double, OneWheel>>();
};
constexpr std::uint64_t kHalfTurn = std::uint64_t{1} << 63;

std::uint64_t turns(double x) { return static_cast<std::uint64_t>(x * 0x1p63) * 2; }

TYPED_TEST(TriggerSweep, ListsAnEdgeAtItsVeryEndNoLaterThanItsEnd) {
  // To the tooth's end and not a unit further, faster or slower on the way: the root of the motion rounds to beyond 1.
  using Real = TypeParam;
  const HalfMoon wheel;
  Random random;
  constexpr Real kTick_s = static_cast<Real>(1e-3);
  for (int draw = 0; draw < 2000; ++draw) {
    const double turned = random.between(0.01, 0.49);
    const double bend = turned * random.between(-0.99, 0.99);
    TriggerSignal<Real, OneWheel> signal{};
    detail::TriggerTick<Real, OneWheel> tick(wheel.track(), kTick_s, signal);
    tick.turn({kHalfTurn - turns(turned), turns(turned), true}, static_cast<Real>(bend));
    ASSERT_EQ(signal.edge_count, 1u) << random.trace(draw);
    ASSERT_LE(signal.edge[0].time_s, kTick_s) << random.trace(draw);
    // A root loses half its digits where the crank all but stops; these keep off that.
    ASSERT_NEAR(static_cast<double>(signal.edge[0].time_s), 1e-3, 1e-3 * 5e-5) << random.trace(draw);
  }
}

TYPED_TEST(TriggerSweep, ListsAnEdgeAtTheTurningPointWhenTheCrankTurnsRound) {
  // Out to the tooth's end, where the crank turns round, and back; the tick ends on the tooth. Rounding puts the edge
  // just within reach or just beyond it: it is listed going out and coming back, in this order, or not at all.
  using Real = TypeParam;
  const HalfMoon wheel;
  Random random;
  int listed = 0;
  for (int draw = 0; draw < 4000; ++draw) {
    const double slope = random.between(0.1, 0.9);
    const double middle = random.between(0.4, 0.6);  // part of the tick in which it turns round
    const auto bend = static_cast<Real>(-slope / (2 * middle));
    const double turned = slope + static_cast<double>(bend);
    const double reach = -slope * slope / (4 * static_cast<double>(bend));
    const double rounding = sizeof(Real) == 4 ? 0x1p-25 : 0x1p-54;
    const double begin = 0.5 - reach + static_cast<double>(random.whole(-4, 4)) * rounding;
    TriggerSignal<Real, BentSpeed> signal{};
    detail::TriggerTick<Real, BentSpeed> tick(wheel.track(), Real{1}, signal);
    tick.turn({turns(begin), turns(std::fabs(turned)), turned > 0}, bend);
    ASSERT_EQ(signal.level, 1u) << "back on the tooth";
    ASSERT_TRUE(signal.edge_count == 0 || signal.edge_count == 2) << random.trace(draw) << ' ' << signal.edge_count;
    if (signal.edge_count == 0) continue;
    ++listed;
    ASSERT_EQ(signal.edge[0].level, 0u);
    ASSERT_EQ(signal.edge[1].level, 1u);
    // A time t from there the crank is bend t^2 away: 1e-7 turns are 1e-3 of the tick.
    ASSERT_NEAR(static_cast<double>(signal.edge[0].time_s), middle, 3e-3) << random.trace(draw);
    ASSERT_NEAR(static_cast<double>(signal.edge[1].time_s), middle, 3e-3) << random.trace(draw);
    ASSERT_GE(signal.edge[1].time_s, signal.edge[0].time_s) << random.trace(draw);
  }
  EXPECT_GT(listed, 500) << "or none was within reach";
}

TYPED_TEST(TriggerSweep, ReachesItsTurningPointWhenItTurnsRound) {
  // d = slope s + bend s^2 with bend < 0 turns round at s = -slope / (2 bend), at d = -slope^2 / (4 bend). What lies a
  // rounding beyond it is reached there too.
  using Real = TypeParam;
  for (const double slope : {0.05, 0.3, 0.9}) {
    for (const double bend : {-0.1, -0.45, -0.9}) {
      const detail::BentPace<Real> pace{Real{0}, static_cast<Real>(slope), static_cast<Real>(bend)};
      const double farthest = -slope * slope / (4 * bend);
      for (const double beyond : {1e-6, 1e-5}) {
        const double s = static_cast<double>(pace.ratio_at(static_cast<Real>(farthest * (1 + beyond))));
        EXPECT_NEAR(s / (-slope / (2 * bend)), 1, 1e-4) << slope << ' ' << bend;
      }
    }
  }
  // Coming back it sets off from there: the edge that stands there is passed at once.
  const detail::BentPace<Real> back{static_cast<Real>(0.25), Real{0}, static_cast<Real>(0.5)};
  EXPECT_EQ(back.ratio_at(Real{0}), static_cast<Real>(0.25));
}

TYPED_TEST(TriggerSweep, IsNoFaultWhenItsListIsExactlyFull) {
  // A tooth every 6 deg, 3 deg wide. From 1.5 deg on, 9 deg pass three edges, at 3, 6 and 9 deg; 12 deg pass a fourth.
  using Real = TypeParam;
  static_assert(DrivenWheels::trigger_edges == 3);
  EngineDefinition definition = diesel_495();
  definition.triggers[definition.trigger_count++] = toothed(TriggerShaft::crank, 60, {}, 0);
  const auto storage = std::make_unique<TableStorage<Real, DrivenWheels>>();
  ASSERT_TRUE(accepted(storage->build(definition, {1e-3, {}})));
  for (const bool overfull : {false, true}) {
    Engine<Real, DrivenWheels> engine;
    ASSERT_TRUE(accepted(engine.init(storage->tables(), phase_at_deg(1.5L))));
    typename Engine<Real, DrivenWheels>::Input in;
    in.speed_rad_s = static_cast<Real>((overfull ? 12 : 9) * 1000 * support::kPi / 180);
    const auto& out = engine.step(in);
    EXPECT_EQ(out.trigger[0].edge_count, overfull ? 4u : 3u);
    EXPECT_EQ(out.faults, overfull ? std::uint32_t{kFaultTriggerEdges} : 0u);
  }
}

/// A measured crank and a phaser.
struct PhasedMeasuredWheel : PhasedWheels {
  static constexpr CrankGiven crank = CrankGiven::phase;
  static constexpr Count triggers = exactly<1>;
};

TYPED_TEST(TriggerSweep, LeapsToTheLevelOfWhereCrankAndPhaserStandWhenTheTickEnds) {
  // The cam's tooth from 100 to 460 deg, and a phaser that goes 10 deg later per tick: 20 deg after two ticks, 30 after
  // three. A leap of the crank ends just beyond the tooth's begin or end as it then stands.
  using Real = TypeParam;
  EngineDefinition definition = single_495();
  definition.train_count = 1;
  definition.trains[0] = valve_test::ohc_125_train();
  definition.trains[0].cam.phase_rate_deg_s = 1e5;
  definition.trigger_count = 1;
  definition.triggers[0] = toothed(TriggerShaft::cam, 1, {}, 100);
  definition.triggers[0].train = 0;
  const auto storage = std::make_unique<TableStorage<Real, PhasedMeasuredWheel>>();
  ASSERT_TRUE(accepted(storage->build(definition, {100e-6, {}})));
  for (const double edge_deg : {130.0, 490.0}) {
    for (const double beyond_deg : {-5.0, 5.0}) {
      Engine<Real, PhasedMeasuredWheel> engine;
      const double from_deg = edge_deg < 300 ? 600 : 200;
      ASSERT_TRUE(accepted(engine.init(storage->tables(), phase_at_deg(static_cast<long double>(from_deg)))));
      typename Engine<Real, PhasedMeasuredWheel>::Input in;
      in.cam_phase_deg[0] = 50;
      in.crank = phase_at_deg(static_cast<long double>(from_deg));
      engine.step(in);
      engine.step(in);
      in.crank = phase_at_deg(static_cast<long double>(edge_deg + beyond_deg));
      const auto& out = engine.step(in);
      EXPECT_EQ(out.faults, kFaultPhaseJump);
      EXPECT_EQ(out.trigger[0].edge_count, 0u);
      EXPECT_EQ(out.trigger[0].level, (edge_deg < 300) == (beyond_deg > 0) ? 1u : 0u) << edge_deg << ' ' << beyond_deg;
    }
  }
}

}  // namespace
}  // namespace crankloop::trigger_sweep_test

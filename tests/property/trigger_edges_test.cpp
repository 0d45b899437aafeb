// Edges of trigger wheels over any motion: none lost, none twice, each at its time. The crank is driven by random
// speeds that change evenly within a tick, through standstill and back, at angles that only integers know: the
// reference counts edges over the whole way in 128 bits.
//
// CRANKLOOP_LONG_TESTS=1 in the environment: 10^8 ticks instead of 10^6, both scalars together.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/step.hpp>

#include "support/both_reals.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"
#include "support/trigger_wheels.hpp"

namespace crankloop::trigger_edges_test {

using namespace detail;
namespace {

using namespace tick_test;
using support::Random;
__extension__ typedef __int128 Wide;

constexpr long double kCycle = 18446744073709551616.0L;  ///< phase units

int ticks_to_run() { return std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 50'000'000 : 500'000; }

static_assert(Needs<BentSpeed>::crank_dynamics);

/// A wheel's unwrapped angle, in 2^-64 turns of the wheel: rises without end.
struct Unwrapped {
  const TriggerTrack* track;
  Wide at;

  /// Edges at or below an angle, from wheel angle 0 on.
  [[nodiscard]] long long edges_up_to(Wide angle) const {
    const Wide turn = Wide{1} << 64;
    Wide turns = angle / turn;
    Wide rest = angle % turn;
    if (rest < 0) rest += turn, --turns;
    const std::uint32_t* end = track->edges + track->edge_count;
    const auto in_turn =
        std::upper_bound(track->edges, end, static_cast<std::uint32_t>(static_cast<std::uint64_t>(rest) >> 32)) -
        track->edges;
    return static_cast<long long>(turns) * track->edge_count + in_turn;
  }
  /// The angle of the edge that is the n-th of that count.
  [[nodiscard]] Wide angle_of(long long n) const {
    const long long per_turn = track->edge_count;
    long long turn = (n - 1) / per_turn;
    long long edge = (n - 1) % per_turn;
    if (edge < 0) edge += per_turn, --turn;
    return Wide{turn} * (Wide{1} << 64) + (Wide{track->edges[edge]} << 32);
  }
};

/// A tick of the crank, as the dynamics would tell it.
struct Move {
  std::int64_t turned;  ///< phase units
  double bend_cycles;
  std::int64_t cam_move;  ///< phase units
};

/// From one speed to another; often through standstill, at times so slowly that a tick is but some units.
Move random_move(Random& random, double& speed_cycles, std::int64_t& cam, double most_cycles) {
  double next = random.between(-most_cycles, most_cycles);
  if (random.whole(0, 3) == 0) next = -speed_cycles * random.between(0, 2);
  if (random.whole(0, 9) == 0) next *= 1e-9;
  if (random.whole(0, 19) == 0) next = speed_cycles;
  if (random.whole(0, 19) == 0) next = 0;
  next = std::clamp(next, -most_cycles, most_cycles);
  Move move{};
  const double turned_cycles = (speed_cycles + next) / 2;
  move.turned = static_cast<std::int64_t>(turned_cycles * 0x1p64);
  move.bend_cycles = (next - speed_cycles) / 2;
  speed_cycles = next;
  if (random.coin()) {
    const std::int64_t target = static_cast<std::int64_t>(random.between(-0.25, 0.25) * 0x1p64);
    const std::int64_t most = std::int64_t{1} << random.whole(40, 60);
    move.cam_move = std::clamp(target - cam, -most, most);
    cam += move.cam_move;
  }
  return move;
}

/// Angles, in turns of the wheel, of listed times from the edges they stand for.
struct Accuracy {
  double largest_turns = 0;
  long long edges = 0;
  long long turned_round = 0;
};

/// Checks a tick's list against the path: the edges out to the turning point and back again, in this order and no
/// others.
template <class Real>
void check_tick(const TriggerSignal<Real, BentSpeed>& signal, const Unwrapped& wheel, Wide to, long double bend,
                double tick_s, Accuracy& accuracy) {
  // A rounding of float is 6e-8 of up to two turns of slope, and there are four on the way: slope, root, quotient,
  // time. Found: 1.9e-7.
  const long double tolerance = sizeof(Real) == 4 ? 5e-7L : 1e-12L;
  const long double turned = static_cast<long double>(to - wheel.at) / kCycle;
  const long double slope = turned - bend;
  const long double slope_at_end = turned + bend;
  const bool turns_round = slope * slope_at_end < 0;
  const long double since = turns_round ? -slope / (2 * bend) : 1;
  const long double reach = since * (slope + bend * since);
  const int outward = reach < 0 || (reach == 0 && turned < 0) ? -1 : 1;

  const long long from_count = wheel.edges_up_to(wheel.at);
  const long long net = (wheel.edges_up_to(to) - from_count) * outward;  // edges passed outward less those passed back
  const long long all = signal.edge_count;
  ASSERT_EQ((all + net) % 2, 0);
  const long long out = (all + net) / 2;
  const long long back = all - out;
  ASSERT_GE(out, 0);
  ASSERT_GE(back, 0);
  ASSERT_TRUE(turns_round || back == 0);
  accuracy.turned_round += back > 0 ? 1 : 0;

  // Outward, the edges after the start; the last lies within reach and the next does not.
  const auto edge_out = [&](long long i) {
    return outward > 0 ? wheel.angle_of(from_count + 1 + i) : wheel.angle_of(from_count - i);
  };
  const auto turns_to = [&](Wide angle) { return static_cast<long double>(angle - wheel.at) / kCycle; };
  if (out > 0) {
    ASSERT_LE(turns_to(edge_out(out - 1)) * outward, reach * outward + tolerance);
  }
  ASSERT_GE(turns_to(edge_out(out)) * outward, reach * outward - tolerance);

  std::uint32_t level = detail::level_beyond(*wheel.track, static_cast<std::uint32_t>((from_count - 1) & 1));
  long double latest = 0;
  for (long long i = 0; i < all; ++i) {
    const auto& edge = signal.edge[i];
    ASSERT_EQ(edge.level, level ^ 1u) << "levels alternate";
    level = edge.level;
    const long double s = static_cast<long double>(edge.time_s) / static_cast<long double>(static_cast<Real>(tick_s));
    ASSERT_GE(s, latest);
    ASSERT_LE(s, 1);
    latest = s;
    const long double there = s * (slope + bend * s);
    const long double off = std::fabs(there - turns_to(edge_out(i < out ? i : 2 * out - 1 - i)));
    ASSERT_LE(off, tolerance) << "edge " << i << " of " << all << ", s " << static_cast<double>(s);
    // On the right leg, but for the turning point itself, where the angle hardly changes with time.
    if (turns_round) {
      const long double beyond = (i < out ? s - since : since - s);
      if (beyond > 0) {
        ASSERT_LE(std::fabs(bend) * beyond * beyond, tolerance);
      }
    }
    accuracy.largest_turns = std::max(accuracy.largest_turns, static_cast<double>(off));
  }
  ASSERT_EQ(signal.level, level);
  accuracy.edges += all;
}

template <class Real>
class TriggerEdges : public ::testing::Test {};
TYPED_TEST_SUITE(TriggerEdges, BothReals, RealName);

TYPED_TEST(TriggerEdges, AreNeitherLostNorDoubledThroughSpeedsReversalsAndPhasers) {
  using Real = TypeParam;
  Random random;
  const double tick_s = 100e-6;
  EngineDefinition engine = with_wheels(valve_test::engine_with(valve_test::ohc_125_train()), drawn_wheels());
  for (int i : {5, 7}) engine.triggers[i].train = 0;  // two of the three cams have a phaser
  const auto storage = std::make_unique<TableStorage<Real, BentSpeed>>();
  ASSERT_TRUE(accepted(storage->build(engine, {tick_s, {}})));
  Tables<Real, BentSpeed> tables = storage->tables();
  TriggerTrack tracks[kMaxTriggerWheels];
  for (std::uint32_t w = 0; w < tables.triggers->count; ++w) {
    tracks[w] = tables.triggers->wheel[w];
    tracks[w].max_edges = tracks[w].edge_count;  // the crank goes further here than it could in a tick of 100 us
  }
  const TriggerWheels all_wheels{tracks, tables.triggers->count};
  tables.triggers = &all_wheels;
  State<Real, BentSpeed> state;
  auto out = std::make_unique<Output<Real, BentSpeed>>();

  Unwrapped wheels[kMaxTriggerWheels] = {};
  Accuracy accuracy;
  double speed = 0;
  std::int64_t cam = 0;
  const int ticks = ticks_to_run();
  const double limit = 0.4999;
  double most = limit;
  for (int i = 0; i < ticks; ++i) {
    if (i % 1024 == 0) {  // a fresh start, now and then right on an edge or at the ends of the 64 bits
      state.phase = Phase{random.bits()};
      if (random.whole(0, 3) == 0) state.phase = Phase{random.coin() ? 0 : ~std::uint64_t{0}};
      state.cam_phase[0] = 0;
      cam = 0;
      speed = 0;
      most = limit * std::pow(10, random.between(-5, 0));
      for (std::uint32_t w = 0; w < tables.triggers->count; ++w) {
        const TriggerTrack& track = tables.triggers->wheel[w];
        if (w == static_cast<std::uint32_t>(random.whole(0, 31))) {
          state.phase =
              Phase{track.starts +
                    (std::uint64_t{
                         track.edges[static_cast<std::size_t>(random.whole(0, static_cast<int>(track.edge_count) - 1))]}
                     << (32 - track.on_crank))};
        }
      }
      for (std::uint32_t w = 0; w < tables.triggers->count; ++w) {
        const TriggerTrack& track = tables.triggers->wheel[w];
        wheels[w] = {&track, static_cast<Wide>(
                                 static_cast<std::uint64_t>((state.phase.units() - track.starts) << track.on_crank))};
      }
    }
    const Move move = random_move(random, speed, cam, most);
    const auto bend = static_cast<Real>(move.bend_cycles);
    detail::BeforeTick<Real, BentSpeed> before;
    before.keep(state);
    const detail::CrankPath<Real> path{state.phase, Phase{static_cast<std::uint64_t>(move.turned)}, false, bend};
    state.phase += path.turned;
    state.cam_phase[0] += static_cast<std::uint64_t>(move.cam_move);
    ASSERT_EQ((detail::TriggersStep<Real, BentSpeed>{tables, state, *out, path, before}.run()), 0u);

    for (std::uint32_t w = 0; w < tables.triggers->count; ++w) {
      const TriggerTrack& track = tables.triggers->wheel[w];
      const Wide gone = Wide{move.turned} - (track.train == kNoTrain ? 0 : Wide{move.cam_move});
      const Wide to = wheels[w].at + gone * (track.on_crank != 0 ? 2 : 1);
      const long double bend_turns = static_cast<long double>(bend) * (track.on_crank != 0 ? 2 : 1);
      ASSERT_NO_FATAL_FAILURE(check_tick(out->trigger[w], wheels[w], to, bend_turns, tick_s, accuracy))
          << random.trace(i) << ", wheel " << w << ", turned " << move.turned << ", bend " << static_cast<double>(bend)
          << ", cam " << move.cam_move;
      wheels[w].at = to;
    }
  }
  std::printf(
      "[ figures  ] %d ticks of %u wheels: %lld edges, some of them on the way back in %lld ticks of a wheel; largest "
      "error %.2g turns\n",
      ticks, tables.triggers->count, accuracy.edges, accuracy.turned_round, accuracy.largest_turns);
  EXPECT_GT(accuracy.edges, ticks);
  EXPECT_GT(accuracy.turned_round, ticks / 100);
  EXPECT_LT(accuracy.largest_turns, 1e-6);
}

}  // namespace
}  // namespace crankloop::trigger_edges_test

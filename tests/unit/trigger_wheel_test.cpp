// Trigger wheels: what a definition may hold, where the edges are, and what a tick tells of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/step.hpp>

#include "support/both_reals.hpp"
#include "support/engines.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"
#include "support/trigger_wheels.hpp"
#include "support/units.hpp"

namespace crankloop::trigger_wheel_test {

using namespace detail;
namespace {

using support::refuses;
using namespace tick_test;

constexpr std::uint64_t kDegree =
    ~std::uint64_t{0} / 720 + 1;  ///< phase units, rounded: 16 of 2^64 are lost over a cycle

/// To an angle.
template <class Rig>
const auto& turn_to(Rig& rig, Phase crank) {
  typename decltype(rig.engine)::Input in;
  in.crank = crank;
  return rig.engine.step(in);
}

template <class Real, class S>
struct Rig {
  TableStorage<Real, S> storage;
  Engine<Real, S> engine;

  explicit Rig(const EngineDefinition& definition, double tick_s = 100e-6, Phase start = {}) {
    EXPECT_TRUE(accepted(storage.build(definition, {tick_s, {}})));
    EXPECT_TRUE(accepted(engine.init(storage.tables(), start)));
  }
};
template <class Real, class S, class... Rest>
std::unique_ptr<Rig<Real, S>> rig(const EngineDefinition& definition, Rest... rest) {
  return std::make_unique<Rig<Real, S>>(definition, rest...);
}

EngineDefinition one_wheel(const TriggerWheel& wheel) {
  EngineDefinition engine = diesel_495();
  engine.triggers[engine.trigger_count++] = wheel;
  return engine;
}

// ---- definition -----------------------------------------------------------------------------------------------------

TEST(TriggerWheelRules, AcceptTheUsualWheels) {
  for (const DrawnWheel& wheel : drawn_wheels()) EXPECT_TRUE(accepted(validate(wheel.definition))) << wheel.name;
}

TEST(TriggerWheelRules, RefuseATurnThatIsTooShortForItsTeethAndGaps) {
  constexpr auto crank = TriggerShaft::crank;
  EXPECT_TRUE(refuses(validate(toothed(crank, 0, {}, 0)), Reason::out_of_range, "trigger.places"));
  EXPECT_TRUE(refuses(validate(toothed(crank, 361, {}, 0)), Reason::out_of_range, "trigger.places"));
  EXPECT_TRUE(refuses(validate(toothed(crank, 60, {{59, 2}}, 0)), Reason::inconsistent, "trigger.gaps", 0));
  EXPECT_TRUE(
      refuses(validate(toothed(crank, 36, {{13, 2}, {16, 2}, {2, 2}}, 0)), Reason::inconsistent, "trigger.gaps", 2));
  EXPECT_TRUE(refuses(validate(toothed(crank, 60, {{0, 2}}, 0)), Reason::not_positive, "trigger.gaps", 0));
  EXPECT_TRUE(refuses(validate(toothed(crank, 60, {{58, 0}}, 0)), Reason::not_positive, "trigger.gaps", 0));
  EXPECT_TRUE(
      refuses(validate(toothed(crank, 60, {{2147483647, 2147483647}}, 0)), Reason::inconsistent, "trigger.gaps", 0));
  TriggerWheel many = toothed(crank, 60, {{58, 2}}, 0);
  many.gap_count = kMaxToothGaps + 1;
  EXPECT_TRUE(refuses(validate(many), Reason::out_of_range, "trigger.gap_count"));
}

TEST(TriggerWheelRules, RefuseAnglesAndWidthsOutOfRange) {
  constexpr auto crank = TriggerShaft::crank;
  EXPECT_TRUE(refuses(validate(toothed(crank, 60, {}, 720)), Reason::out_of_range, "trigger.first_tooth_deg"));
  EXPECT_TRUE(refuses(validate(toothed(crank, 60, {}, -1)), Reason::negative, "trigger.first_tooth_deg"));
  EXPECT_TRUE(refuses(validate(toothed(crank, 60, {}, std::nan(""))), Reason::not_finite, "trigger.first_tooth_deg"));
  EXPECT_TRUE(refuses(validate(toothed(crank, 60, {}, 0, 0.009)), Reason::out_of_range, "trigger.tooth_ratio"));
  EXPECT_TRUE(refuses(validate(toothed(crank, 60, {}, 0, 1)), Reason::out_of_range, "trigger.tooth_ratio"));
}

TEST(TriggerWheelRules, RefuseEdgesThatAreNoPairsOrDoNotRiseWithinOneTurn) {
  const auto answer = [](const std::vector<double>& edges_deg, TriggerShaft shaft = TriggerShaft::cam) {
    TriggerWheel wheel;
    wheel.shaft = shaft;
    wheel.pattern = TriggerPattern::edges;
    wheel.edges_deg = edges_deg.data();
    wheel.edge_count = static_cast<int>(edges_deg.size());
    return validate(wheel);
  };
  EXPECT_TRUE(accepted(answer({10, 20, 300, 710})));
  EXPECT_TRUE(accepted(answer({700, 730}))) << "a tooth over the top of the cycle";
  EXPECT_TRUE(accepted(answer({0, 359}, TriggerShaft::crank)));
  EXPECT_TRUE(refuses(answer({0, 360}, TriggerShaft::crank), Reason::out_of_range, "trigger.edges_deg", 1));
  EXPECT_TRUE(refuses(answer({10, 20, 30}), Reason::inconsistent, "trigger.edges_deg"));
  EXPECT_TRUE(refuses(answer({}), Reason::too_few_points, "trigger.edges_deg"));
  EXPECT_TRUE(refuses(answer(std::vector<double>(722, 1)), Reason::too_many_points, "trigger.edges_deg"));
  EXPECT_TRUE(refuses(answer({720, 730}), Reason::out_of_range, "trigger.edges_deg", 0));
  EXPECT_TRUE(refuses(answer({10, 10.0005}), Reason::not_increasing, "trigger.edges_deg", 1));
  EXPECT_TRUE(refuses(answer({10, 730}), Reason::out_of_range, "trigger.edges_deg", 1));
  EXPECT_TRUE(refuses(answer({10, std::nan("")}), Reason::not_finite, "trigger.edges_deg", 1));
}

TEST(TriggerWheelRules, RefuseAPhaserOnTheCrankOrOfATrainThatIsNotThere) {
  TriggerWheel wheel = toothed(TriggerShaft::crank, 60, {{58, 2}}, 0);
  wheel.train = 0;
  EXPECT_TRUE(refuses(validate(wheel), Reason::inconsistent, "trigger.train"));
  wheel.shaft = TriggerShaft::cam;
  EXPECT_TRUE(accepted(validate(wheel)));
  EXPECT_TRUE(refuses(validate(one_wheel(wheel)), Reason::out_of_range, "trigger.train", 0))
      << "the engine has no trains";
  EngineDefinition engine = diesel_495();
  engine.trigger_count = kMaxTriggerWheels + 1;
  EXPECT_TRUE(refuses(validate(engine), Reason::out_of_range, "trigger_count"));
}

TEST(TriggerWheelRules, RefuseNumbersThatNoWheelHas) {
  TriggerWheel wheel = toothed(TriggerShaft::cam, 4, {}, 0);
  wheel.gap_count = -1;
  EXPECT_TRUE(refuses(validate(wheel), Reason::negative, "trigger.gap_count"));
  wheel.gap_count = kMaxToothGaps + 1;
  EXPECT_TRUE(refuses(validate(wheel), Reason::out_of_range, "trigger.gap_count"));
  wheel.gap_count = 0;
  for (const int train : {-2, int{kMaxTrains}}) {
    wheel.train = train;
    EXPECT_TRUE(refuses(validate(wheel), Reason::out_of_range, "trigger.train")) << train;
  }
  wheel.train = -1;
  wheel.shaft = static_cast<TriggerShaft>(2);
  EXPECT_TRUE(refuses(validate(wheel), Reason::out_of_range, "trigger.shaft"));
  wheel.shaft = TriggerShaft::cam;
  wheel.pattern = static_cast<TriggerPattern>(2);
  EXPECT_TRUE(refuses(validate(wheel), Reason::out_of_range, "trigger.pattern"));
  wheel.pattern = TriggerPattern::edges;
  const double one_deg = 10;
  wheel.edges_deg = &one_deg;
  wheel.edge_count = 1;
  EXPECT_TRUE(refuses(validate(wheel), Reason::too_few_points, "trigger.edges_deg"));
  EXPECT_TRUE(refuses(validate(one_wheel(wheel)), Reason::too_few_points, "trigger.edges_deg", 0))
      << "of the engine's first wheel";
  EngineDefinition engine = diesel_495();
  engine.trigger_count = -1;
  EXPECT_TRUE(refuses(validate(engine), Reason::out_of_range, "trigger_count"));
}

// ---- tables ---------------------------------------------------------------------------------------------------------

/// Edges given one by one, on the crank and on a cam.
TEST(TriggerTables, HaveGivenEdgesWhereTheyStand) {
  for (const auto& [shaft, turn_deg] : {std::pair{TriggerShaft::crank, 360.0}, std::pair{TriggerShaft::cam, 720.0}}) {
    const double edges_deg[] = {90, 126, 300, 405};
    TriggerWheel wheel;
    wheel.shaft = shaft;
    wheel.pattern = TriggerPattern::edges;
    wheel.edges_deg = edges_deg;
    wheel.edge_count = 4;
    const auto rigged = rig<double, OneWheel>(one_wheel(wheel));
    const TriggerTrack& track = rigged->storage.tables().triggers->wheel[0];
    EXPECT_EQ(track.starts, std::uint64_t{1} << 61) << "90 of 720 deg";
    ASSERT_EQ(track.edge_count, 4u);
    for (std::size_t e = 0; e < 4; ++e) {
      EXPECT_NEAR(track.edges[e] * 0x1p-32 * turn_deg, edges_deg[e] - 90, 1e-6) << e;
    }
  }
}

TEST(TriggerTables, AreRefusedWithoutThemOrWithMoreThanTheSceneHasRoomFor) {
  const auto rigged = rig<double, OneWheel>(one_wheel(toothed(TriggerShaft::crank, 60, {{58, 2}}, 246)));
  auto tables = rigged->storage.tables();
  const TriggerWheels two{tables.triggers->wheel, 2};
  Engine<double, OneWheel> engine;
  tables.triggers = &two;
  EXPECT_TRUE(refuses(engine.init(tables), Reason::out_of_range, "tables.triggers"));
  tables.triggers = nullptr;
  EXPECT_TRUE(refuses(engine.init(tables), Reason::missing_table, "tables"));
}

/// Of `n` edges in a turn: the most that lie less than `width_deg` behind any of them, itself among them.
std::uint32_t most_within(const std::vector<long double>& edges_deg, long double turn_deg, long double width_deg) {
  std::ptrdiff_t most = 0;
  for (const long double top : edges_deg) {
    most = std::max(most, std::count_if(edges_deg.begin(), edges_deg.end(), [&](long double edge) {
                      return std::fmod(top - edge + turn_deg, turn_deg) < width_deg;
                    }));
  }
  return static_cast<std::uint32_t>(most);
}

TEST(TriggerTables, KnowHowManyEdgesATickPassesAtMost) {
  const std::vector<DrawnWheel> wheels = drawn_wheels();
  EngineDefinition engine = with_wheels(diesel_495(), wheels);
  for (const double rpm : {100.0, 1717.0, 5000.0, 28000.0}) {  // in 2 ms 1.2, 20.604, 60 and 336 deg
    engine.crank.max_speed_rad_s = rpm * support::kPi / 30;
    const auto rigged = rig<double, MeasuredWheels>(engine, 2e-3);
    for (std::size_t i = 0; i < wheels.size(); ++i) {
      const long double turn_deg = static_cast<long double>(wheels[i].turn_deg());
      const long double width_deg = static_cast<long double>(rpm) * 0.012L * (1 + 2e-6L);
      EXPECT_EQ(rigged->storage.tables().triggers->wheel[i].max_edges,
                most_within(wheels[i].edges_deg(), turn_deg, width_deg))
          << wheels[i].name << " at " << rpm;
    }
  }
}

/// An edge every degree of the crank; the crank turns 12.12 deg in the tick, the phaser 40.
TEST(TriggerTables, CountWhatAPhaserAddsToTheEdgesOfATick) {
  EngineDefinition engine = single_495();
  engine.crank.max_speed_rad_s = 1010 * support::kPi / 30;
  engine.train_count = 1;
  engine.trains[0] = valve_test::ohc_125_train();
  engine.trains[0].cam.phase_rate_deg_s = 2e4;
  engine.trigger_count = 1;
  engine.triggers[0] = toothed(TriggerShaft::cam, 360, {}, 0);
  for (const bool phased : {false, true}) {
    engine.triggers[0].train = phased ? 0 : -1;
    const auto rigged = rig<double, FinelyPhasedWheel>(engine, 2e-3);
    EXPECT_EQ(rigged->storage.tables().triggers->wheel[0].max_edges, phased ? 53u : 13u);
  }
}

TEST(TriggerTables, HaveTheEdgesOfTheDrawing) {
  const std::vector<DrawnWheel> wheels = drawn_wheels();
  const auto rigged = rig<double, MeasuredWheels>(with_wheels(diesel_495(), wheels));
  const TriggerWheels& tables = *rigged->storage.tables().triggers;
  ASSERT_EQ(tables.count, wheels.size());
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    SCOPED_TRACE(wheels[i].name);
    const TriggerTrack& track = tables.wheel[i];
    const std::vector<long double> edges_deg = wheels[i].edges_deg();
    ASSERT_EQ(track.edge_count, edges_deg.size());
    for (std::size_t e = 0; e < edges_deg.size(); ++e) {
      const long double units = edges_deg[e] / static_cast<long double>(wheels[i].turn_deg()) * 4294967296.0L;
      EXPECT_NEAR(static_cast<double>(static_cast<long double>(track.edges[e]) - units), 0, 0.501);
    }
  }
}

TEST(TriggerTables, FindTheEdgeBehindEveryAngle) {
  const std::vector<DrawnWheel> wheels = drawn_wheels();
  const auto rigged = rig<double, MeasuredWheels>(with_wheels(diesel_495(), wheels));
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    SCOPED_TRACE(wheels[i].name);
    const TriggerTrack& track = rigged->storage.tables().triggers->wheel[i];
    const auto by_walking = [&](std::uint32_t angle) {
      std::uint32_t edge = 0;
      while (edge + 1 < track.edge_count && track.edges[edge + 1] <= angle) ++edge;
      return edge;
    };
    for (std::uint32_t e = 0; e < track.edge_count; ++e) {
      for (const std::uint32_t angle : {track.edges[e] - 1, track.edges[e], track.edges[e] + 1}) {
        ASSERT_EQ(detail::edge_behind(track, angle), by_walking(angle)) << angle;
      }
    }
    for (std::uint64_t part = 0; part < 1024; ++part) {
      const auto angle = static_cast<std::uint32_t>(part << 22);
      ASSERT_EQ(detail::edge_behind(track, angle), by_walking(angle)) << angle;
      ASSERT_EQ(detail::edge_behind(track, angle - 1), by_walking(angle - 1)) << angle;
    }
  }
}

TEST(TriggerTables, AreRefusedWithoutRoomOrWithAnotherNumberOfWheels) {
  EngineDefinition one_cylinder = single_495();
  const auto storage = std::make_unique<TableStorage<float, TwoWheels>>();
  Engine<float, TwoWheels> engine;
  const TriggerWheel wheel = toothed(TriggerShaft::crank, 60, {{58, 2}}, 0);
  for (int wheels = 0; wheels <= 3; ++wheels) {
    one_cylinder.trigger_count = wheels;
    for (int i = 0; i < wheels; ++i) one_cylinder.triggers[i] = wheel;
    const Status built = storage->build(one_cylinder, {});
    if (wheels == 3) {
      EXPECT_TRUE(refuses(built, Reason::out_of_range, "scene.triggers"));
      continue;
    }
    ASSERT_TRUE(accepted(built));
    const Status status = engine.init(storage->tables());
    EXPECT_TRUE(wheels == 2 ? accepted(status) : refuses(status, Reason::out_of_range, "tables.triggers")) << wheels;
  }
  TableTargets<float> targets;
  TriggerWheels wheels{};
  TriggerTrack track{};
  targets.triggers = &wheels;
  EXPECT_TRUE(refuses(tabulate(one_wheel(wheel), {}, targets), Reason::missing_table, "targets.trigger_tracks"));
  targets.trigger_tracks = &track;
  EXPECT_TRUE(refuses(tabulate(one_wheel(wheel), {}, targets), Reason::missing_table, "targets.trigger_edges"));
}

// ---- one tick -------------------------------------------------------------------------------------------------------

template <class Real>
class TriggerTickOf : public ::testing::Test {};
TYPED_TEST_SUITE(TriggerTickOf, BothReals, RealName);

TYPED_TEST(TriggerTickOf, TellsWhenAToothComesAndGoes) {
  // A tooth from 6 deg on, 3 deg wide: at 1000 rpm, 6 deg per ms, it comes after 1 ms and goes after 1.5 ms.
  using Real = TypeParam;
  const auto rigged = rig<Real, DrivenWheels>(one_wheel(toothed(TriggerShaft::crank, 60, {{58, 2}}, 6)), 0.8e-3);
  typename Engine<Real, DrivenWheels>::Input in;
  in.speed_rad_s = static_cast<Real>(1000 * support::kPi / 30);
  const auto& signal = rigged->engine.output().trigger[0];

  rigged->engine.step(in);
  EXPECT_EQ(signal.level, 0u) << "in the gap";
  EXPECT_EQ(signal.edge_count, 0u);
  rigged->engine.step(in);
  EXPECT_EQ(signal.level, 0u);
  ASSERT_EQ(signal.edge_count, 2u);
  EXPECT_EQ(signal.edge[0].level, 1u);
  EXPECT_EQ(signal.edge[1].level, 0u);
  EXPECT_NEAR(static_cast<double>(signal.edge[0].time_s), 0.2e-3, 1e-9);
  EXPECT_NEAR(static_cast<double>(signal.edge[1].time_s), 0.7e-3, 1e-9);
  EXPECT_EQ(rigged->engine.output().faults, 0u);

  in.speed_rad_s = -in.speed_rad_s;  // and back the same way: what rose falls, at the mirrored time
  rigged->engine.step(in);
  EXPECT_EQ(signal.level, 0u);
  ASSERT_EQ(signal.edge_count, 2u);
  EXPECT_EQ(signal.edge[0].level, 1u);
  EXPECT_EQ(signal.edge[1].level, 0u);
  EXPECT_NEAR(static_cast<double>(signal.edge[0].time_s), 0.1e-3, 1e-9);
  EXPECT_NEAR(static_cast<double>(signal.edge[1].time_s), 0.6e-3, 1e-9);
}

TYPED_TEST(TriggerTickOf, GivesAnEdgeAtItsVeryEndToOneTickOnly) {
  // Edges exactly where ticks meet, in both directions, at both ends of the 64 bits.
  using Real = TypeParam;
  TriggerWheel wheel = toothed(TriggerShaft::cam, 4, {}, 0);  // edges every 90 deg: 2^61 units each
  const auto rigged = rig<Real, MeasuredWheels>(one_wheel(wheel));
  auto& engine = rigged->engine;
  const auto& signal = engine.output().trigger[0];
  const std::uint64_t eighth = std::uint64_t{1} << 61;
  const auto go = [&](std::uint64_t to) { turn_to(*rigged, Phase{to}); };
  go(0);
  EXPECT_EQ(signal.level, 1u) << "the tooth begins at 0";
  EXPECT_EQ(signal.edge_count, 0u) << "the first measured angle tells no edge";
  go(eighth / 2);
  EXPECT_EQ(signal.edge_count, 0u);
  go(eighth);
  ASSERT_EQ(signal.edge_count, 1u);
  EXPECT_EQ(signal.level, 0u);
  EXPECT_EQ(signal.edge[0].time_s, static_cast<Real>(100e-6)) << "at the very end";
  go(eighth + 5);
  EXPECT_EQ(signal.edge_count, 0u);
  go(eighth);
  EXPECT_EQ(signal.edge_count, 0u) << "back to it, not yet below";
  EXPECT_EQ(signal.level, 0u);
  go(eighth - 1);
  ASSERT_EQ(signal.edge_count, 1u);
  EXPECT_EQ(signal.edge[0].time_s, Real{0}) << "it left at once";
  EXPECT_EQ(signal.edge[0].level, 1u);
  EXPECT_EQ(signal.level, 1u);
  go(eighth - 1);
  EXPECT_EQ(signal.edge_count, 0u) << "standing still";
  go(eighth / 2);
  go(0);
  EXPECT_EQ(signal.edge_count, 0u);
  go(~std::uint64_t{0});
  ASSERT_EQ(signal.edge_count, 1u);
  EXPECT_EQ(signal.level, 0u);
  go(0);
  ASSERT_EQ(signal.edge_count, 1u);
  EXPECT_EQ(signal.level, 1u);
  EXPECT_EQ(engine.output().faults, 0u);
}

TYPED_TEST(TriggerTickOf, ListsTheFirstEdgesAndCountsAllWhereThereAreMoreThanRoom) {
  using Real = TypeParam;
  const auto rigged = rig<Real, DrivenWheels>(one_wheel(toothed(TriggerShaft::crank, 360, {}, 0)), 1e-3);
  typename Engine<Real, DrivenWheels>::Input in;
  in.speed_rad_s =
      static_cast<Real>(2000 * support::kPi / 30);  // 12 deg in a tick: 24 edges, give or take the one at its end
  const auto& out = rigged->engine.step(in);
  EXPECT_EQ(out.faults, kFaultTriggerEdges);
  EXPECT_NEAR(out.trigger[0].edge_count, 24, 1);
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(out.trigger[0].edge[i].level, i % 2);
    EXPECT_NEAR(static_cast<double>(out.trigger[0].edge[i].time_s), 1e-3 * (i + 1) / 24, 1e-9);
  }
  in.speed_rad_s = static_cast<Real>(-100 * support::kPi / 30);  // 0.6 deg: one edge, or two
  EXPECT_EQ(rigged->engine.step(in).faults, 0u) << "the next tick knows nothing of it";
}

/// 1.32 deg with an edge every half, and tables that know of one.
TYPED_TEST(TriggerTickOf, ListsNoMoreEdgesThanItsTablesSay) {
  using Real = TypeParam;
  const auto rigged = rig<Real, DrivenWheels>(one_wheel(toothed(TriggerShaft::crank, 360, {}, 0)), 1e-3);
  auto tables = rigged->storage.tables();
  TriggerTrack track = tables.triggers->wheel[0];
  track.max_edges = 1;
  const TriggerWheels wheels{&track, 1};
  tables.triggers = &wheels;
  ASSERT_TRUE(accepted(rigged->engine.init(tables, Phase{kDegree / 4})));
  typename Engine<Real, DrivenWheels>::Input in;
  in.speed_rad_s = static_cast<Real>(220 * support::kPi / 30);
  const auto& out = rigged->engine.step(in);
  EXPECT_EQ(out.faults, kFaultTriggerEdges);
  EXPECT_EQ(out.trigger[0].edge_count, 3u);  // at 0.5, 1 and 1.5 deg: as many as the scene has room for
  EXPECT_NEAR(static_cast<double>(out.trigger[0].edge[0].time_s), 1e-3 * 0.25 / 1.32, 1e-9);
  EXPECT_EQ(out.trigger[0].edge[1].time_s, Real{0}) << "not listed";
}

TYPED_TEST(TriggerTickOf, TellsTheLevelButNoEdgesOfALeap) {
  using Real = TypeParam;
  const auto rigged = rig<Real, MeasuredWheels>(one_wheel(toothed(TriggerShaft::cam, 1, {}, 0)));
  auto& engine = rigged->engine;
  turn_to(*rigged, Phase{10 * kDegree});
  EXPECT_EQ(engine.output().trigger[0].level, 1u);
  turn_to(*rigged, Phase{370 * kDegree});  // a whole crank turn in a tick: no crankshaft can
  EXPECT_EQ(engine.output().faults, kFaultPhaseJump);
  EXPECT_EQ(engine.output().trigger[0].edge_count, 0u);
  EXPECT_EQ(engine.output().trigger[0].level, 0u);
}

TYPED_TEST(TriggerTickOf, HasTheToothCountOfEveryWheelAtEverySpeedAndTick) {
  // A cycle of 720 deg in as many ticks as speed and tick give, both ways: every tooth of the drawing comes and goes,
  // twice on the crank. Where that is more ticks than one likes to wait for, as many cycles' parts: the count is then
  // held against the angle.
  using Real = TypeParam;
  const std::vector<DrawnWheel> wheels = drawn_wheels();
  const bool long_test = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr;
  const std::uint64_t most_ticks = long_test ? 200'000'000 : 60'000;
  const EngineDefinition definition = with_wheels(diesel_495(), wheels);
  for (const double tick_us : {1, 10, 100, 1000, 2000}) {
    const auto rigged = rig<Real, MeasuredWheels>(definition, tick_us * 1e-6);
    for (const double rpm : {1.0, 20.0, 700.0, 6000.0, 20000.0}) {
      const auto ticks = static_cast<std::uint64_t>(120 / rpm / (tick_us * 1e-6) + 0.5);
      const std::uint64_t part = ~std::uint64_t{0} / ticks;
      const std::uint64_t to_run = ticks < most_ticks ? ticks : most_ticks;
      for (const bool forward : {true, false}) {
        SCOPED_TRACE(testing::Message() << rpm << " rpm, " << tick_us << " us, " << (forward ? "forward" : "backward"));
        auto& engine = rigged->engine;
        const Phase start{to_run < ticks ? 355 * kDegree : 0};
        ASSERT_TRUE(accepted(engine.init(rigged->storage.tables(), start)));
        turn_to(*rigged, start);
        std::uint32_t rises[kMaxTriggerWheels] = {};
        std::uint32_t falls[kMaxTriggerWheels] = {};
        std::uint64_t gone = 0;
        for (std::uint64_t i = 1; i <= to_run; ++i) {
          gone = i == ticks ? 0 : i * part;  // to the last unit once round
          const auto& out = turn_to(*rigged, forward ? start + Phase{gone} : start - Phase{gone});
          ASSERT_EQ(out.faults, 0u);
          for (std::size_t w = 0; w < wheels.size(); ++w) {
            for (std::uint32_t e = 0; e < out.trigger[w].edge_count; ++e)
              ++(out.trigger[w].edge[e].level == 1 ? rises : falls)[w];
          }
        }
        for (std::size_t w = 0; w < wheels.size(); ++w) {
          if (to_run == ticks) {
            const auto teeth =
                static_cast<std::uint32_t>(wheels[w].edges_deg().size() / 2 * (wheels[w].turn_deg() == 360 ? 2 : 1));
            EXPECT_EQ(rises[w], teeth) << wheels[w].name;
            EXPECT_EQ(falls[w], teeth) << wheels[w].name;
            continue;
          }
          const long double from_deg = 355 - static_cast<long double>(wheels[w].definition.first_tooth_deg);
          const long double gone_deg = static_cast<long double>(gone) / 18446744073709551616.0L * 720;
          const long double low_deg = forward ? from_deg : from_deg - gone_deg;
          std::uint32_t edges = 0;
          for (int turn = -3; turn <= 3; ++turn) {
            for (const long double edge_deg : wheels[w].edges_deg()) {
              const long double at_deg = edge_deg + turn * static_cast<long double>(wheels[w].turn_deg());
              if (at_deg > low_deg && at_deg <= low_deg + gone_deg) ++edges;
            }
          }
          EXPECT_EQ(rises[w] + falls[w], edges) << wheels[w].name;
        }
      }
    }
  }
}

// ---- phased cams ----------------------------------------------------------------------------------------------------

TYPED_TEST(TriggerTickOf, MovesAWheelWithThePhaserOfItsCam) {
  // The crank stands, the phaser moves the cam 0.2 deg later per tick: the tooth edge that the cam had just passed
  // comes back. A wheel on the same cam without a phaser stays.
  using Real = TypeParam;
  EngineDefinition engine = single_495();
  engine.train_count = 1;
  engine.trains[0] = valve_test::ohc_125_train();
  engine.trains[0].cam.phase_rate_deg_s = 2000;
  engine.trigger_count = 2;
  engine.triggers[0] = engine.triggers[1] = toothed(TriggerShaft::cam, 1, {}, 100);
  engine.triggers[0].train = 0;
  const auto rigged = rig<Real, PhasedWheels>(engine, 100e-6, Phase{100 * kDegree + kDegree / 20});
  typename Engine<Real, PhasedWheels>::Input in;
  in.speed_rad_s = 0;
  in.cam_phase_deg[0] = 10;
  const auto& out = rigged->engine.step(in);
  EXPECT_EQ(out.faults, 0u);
  ASSERT_EQ(out.trigger[0].edge_count, 1u);
  EXPECT_EQ(out.trigger[0].edge[0].level, 0u) << "back over the rising edge";
  EXPECT_NEAR(static_cast<double>(out.trigger[0].edge[0].time_s), 0.05 / 2000, 1e-9);
  EXPECT_EQ(out.trigger[0].level, 0u);
  EXPECT_EQ(out.trigger[1].edge_count, 0u);
  EXPECT_EQ(out.trigger[1].level, 1u);

  // The crank follows at half the phaser's rate: the wheel still goes back.
  in.speed_rad_s = static_cast<Real>(1000 * support::kPi / 180);
  rigged->engine.step(in);
  EXPECT_EQ(out.trigger[0].edge_count, 0u);
  EXPECT_EQ(out.trigger[0].level, 0u);
  // At twice of it the crank overtakes: 0.15 + 0.1 deg behind, 0.2 deg gained per tick. In the second tick, after a
  // quarter.
  in.speed_rad_s = static_cast<Real>(4000 * support::kPi / 180);
  rigged->engine.step(in);
  EXPECT_EQ(out.trigger[0].edge_count, 0u);
  rigged->engine.step(in);
  ASSERT_EQ(out.trigger[0].edge_count, 1u);
  EXPECT_EQ(out.trigger[0].edge[0].level, 1u);
  EXPECT_NEAR(static_cast<double>(out.trigger[0].edge[0].time_s), 25e-6, 1e-9);
}

TYPED_TEST(TriggerTickOf, KeepsCountWhereCrankAndPhaserGoTogetherFurtherThanASignedPhaseHolds) {
  // 0.4999 cycles of crank forward and 200 deg of phaser back in one tick of 2 ms: 560 deg on a cam wheel with an edge
  // every degree.
  using Real = TypeParam;
  EngineDefinition engine = single_495();
  engine.train_count = 1;
  engine.trains[0] = valve_test::ohc_125_train();
  engine.trains[0].cam.phase_rate_deg_s = 1e5;
  engine.trigger_count = 1;
  engine.triggers[0] = toothed(TriggerShaft::cam, 360, {}, 0);
  engine.triggers[0].train = 0;
  for (const bool forward : {true, false}) {
    const auto rigged = rig<Real, FinelyPhasedWheel>(engine, 2e-3, Phase{kDegree / 2});
    typename Engine<Real, FinelyPhasedWheel>::Input in;
    in.cam_phase_deg[0] = forward ? Real{100} : Real{-100};
    for (int i = 0; i < 3; ++i)
      rigged->engine.step(in);  // the phaser out to one side, and back past the middle with the crank
    in.cam_phase_deg[0] = -in.cam_phase_deg[0];
    const Real limit = rigged->storage.tables().drive->speed_limit_rad_s;
    in.speed_rad_s = forward ? limit : -limit;
    const auto& out = rigged->engine.step(in);
    EXPECT_EQ(out.faults, 0u);
    const double gone_deg = 0.4999 * 720 + 200;
    EXPECT_NEAR(out.trigger[0].edge_count, gone_deg, 1);
    for (std::uint32_t e = 0; e < out.trigger[0].edge_count; ++e) {
      const double degrees = static_cast<double>(out.trigger[0].edge[e].time_s) / 2e-3 * gone_deg;
      EXPECT_NEAR(degrees, e + 0.5, 0.02);
    }
  }
}

}  // namespace
}  // namespace crankloop::trigger_wheel_test

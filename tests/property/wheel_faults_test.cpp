// Faults of trigger wheels: what a controller sees is the wheel drawn anew with its fault, every change of level has
// its edge, and the healthy signal beside it keeps its bits.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/state/saved_state.hpp>
#include <crankloop/tick/step.hpp>

#include "support/both_reals.hpp"
#include "support/engines.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/trigger_wheels.hpp"

namespace crankloop::wheel_faults_test {
namespace {

using support::refuses;
using tick_test::RealName;
using tick_test::toothed;

constexpr double kPi = 3.14159265358979323846;
constexpr double kTick_s = 100e-6, kRad_s = 200, kPerTick_deg = kRad_s * kTick_s * 180 / kPi;

struct Turned : Scene {
  static constexpr Count cylinders = exactly<4>;
  static constexpr Count triggers = exactly<2>;
  static constexpr std::uint32_t wheel_faults = 4;
};
struct Measured : Turned {
  static constexpr CrankGiven crank = CrankGiven::phase;
};
struct Free : Turned {
  static constexpr CrankGiven crank = CrankGiven::torque;
  static constexpr bool rod_inertia = true;
  static constexpr std::uint32_t trigger_edges = 32;
};
struct FreeHealthy : Free {
  static constexpr std::uint32_t wheel_faults = 0;
};
struct OneFault : Turned {
  static constexpr std::uint32_t wheel_faults = 1;
};
struct OneEdge : Turned {
  static constexpr std::uint32_t trigger_edges = 1;
};

/// A crank wheel of 60-2 and a cam wheel of 4-1.
[[nodiscard]] EngineDefinition with_two_wheels() {
  EngineDefinition engine = support::diesel_495();
  engine.trigger_count = 2;
  engine.triggers[0] = toothed(TriggerShaft::crank, 60, {{58, 2}}, 246);
  engine.triggers[1] = toothed(TriggerShaft::cam, 4, {{3, 1}}, 500, 0.25);
  return engine;
}
[[nodiscard]] WheelFault fault_of(int wheel) {
  WheelFault fault;
  fault.wheel = wheel;
  fault.end_s = 1e6;
  return fault;
}

template <class Real, class S>
struct Rig {
  TableStorage<Real, S> storage;
  Engine<Real, S> engine;
  Input<Real, S> in;

  Rig(const EngineDefinition& definition, double tick_s = kTick_s) {
    EXPECT_TRUE(accepted(storage.build(definition, {tick_s, {}})));
    EXPECT_TRUE(accepted(engine.init(storage.tables())));
    if constexpr (S::crank == CrankGiven::speed) in.speed_rad_s = static_cast<Real>(kRad_s);
  }
  const Output<Real, S>& step() { return engine.step(in); }
};
template <class Real, class S>
[[nodiscard]] std::unique_ptr<Rig<Real, S>> rig(const EngineDefinition& definition) {
  return std::make_unique<Rig<Real, S>>(definition);
}

struct Edge {
  double deg;  ///< turned since the start
  std::uint32_t level;
};

/// The edges of a wheel's faulty signal over some ticks at constant speed.
template <class Real>
[[nodiscard]] std::vector<Edge> edges_seen(const EngineDefinition& engine, std::size_t wheel, int ticks = 4000) {
  const auto run = rig<Real, Turned>(engine);
  std::vector<Edge> edges;
  for (int tick = 0; tick < ticks; ++tick) {
    const auto& signal = run->step().faulty_trigger[wheel];
    for (std::uint32_t e = 0; e < signal.edge_count; ++e)
      edges.push_back(
          {(tick + static_cast<double>(signal.edge[e].time_s) / kTick_s) * kPerTick_deg, signal.edge[e].level});
  }
  return edges;
}

/// A wheel drawn: rise and fall of each tooth in crank degrees of the engine's cycle.
struct Drawn {
  double turn_deg;
  std::vector<std::pair<double, double>> teeth_deg;

  explicit Drawn(const TriggerWheel& wheel) : turn_deg{wheel.shaft == TriggerShaft::crank ? 360.0 : 720.0} {
    int place = 0;
    const double per_place_deg = turn_deg / wheel.places;
    const auto teeth = [&](int count) {
      for (; count > 0; --count, ++place)
        teeth_deg.emplace_back(wheel.first_tooth_deg + place * per_place_deg,
                               wheel.first_tooth_deg + (place + wheel.tooth_ratio) * per_place_deg);
    };
    for (int gap = 0; gap < wheel.gap_count; ++gap) teeth(wheel.gaps[gap].teeth), place += wheel.gaps[gap].missing;
    teeth(wheel.places - place);
  }
  /// As the crank turns forward from 0.
  [[nodiscard]] std::vector<Edge> edges(double until_deg) const {
    std::vector<Edge> all;
    for (const auto& [rise_deg, fall_deg] : teeth_deg) {
      for (const auto& [deg, level] : {std::pair{rise_deg, 1u}, {fall_deg, 0u}}) {
        for (double at = std::fmod(deg, turn_deg) - turn_deg; at <= until_deg; at += turn_deg)
          if (at > 0) all.push_back({at, level});
      }
    }
    std::sort(all.begin(), all.end(), [](const Edge& a, const Edge& b) { return a.deg < b.deg; });
    return all;
  }
};

template <class Real>
void expect_drawn(const EngineDefinition& engine, std::size_t wheel, const Drawn& drawn) {
  constexpr int kTicks = 4000;
  const std::vector<Edge> seen = edges_seen<Real>(engine, wheel, kTicks);
  const std::vector<Edge> expected = drawn.edges(kTicks * kPerTick_deg);
  ASSERT_NEAR(static_cast<double>(seen.size()), static_cast<double>(expected.size()), 1);  // the last, by rounding
  const std::size_t all = std::min(seen.size(), expected.size());
  ASSERT_GT(all, 12u);
  for (std::size_t e = 0; e < all; ++e) {
    ASSERT_NEAR(seen[e].deg, expected[e].deg, sizeof(Real) == 4 ? 2e-3 : 2e-6) << "edge " << e;
    ASSERT_EQ(seen[e].level, expected[e].level) << "edge " << e;
  }
}

template <class Real>
class WheelFaultsOf : public ::testing::Test {};
TYPED_TEST_SUITE(WheelFaultsOf, tick_test::BothReals, RealName);

TYPED_TEST(WheelFaultsOf, AMissingToothIsMissingWhicheverItIs) {
  for (const int tooth : {1, 30, 58}) {
    EngineDefinition engine = with_two_wheels();
    engine.wheel_fault_count = 1;
    engine.wheel_faults[0] = fault_of(0);
    engine.wheel_faults[0].missing_tooth = tooth;
    Drawn drawn(engine.triggers[0]);
    drawn.teeth_deg.erase(drawn.teeth_deg.begin() + tooth - 1);
    expect_drawn<TypeParam>(engine, 0, drawn);
  }
}

TYPED_TEST(WheelFaultsOf, AnExtraToothStandsWhereItIsPut) {
  EngineDefinition engine = with_two_wheels();
  engine.wheel_fault_count = 2;
  engine.wheel_faults[0] = fault_of(0);
  engine.wheel_faults[0].extra_tooth_deg = 58 * 6 + 1.5, engine.wheel_faults[0].extra_width_deg = 2;
  engine.wheel_faults[1] = fault_of(1);
  engine.wheel_faults[1].extra_tooth_deg = 600, engine.wheel_faults[1].extra_width_deg = 100;
  Drawn crank(engine.triggers[0]), cam(engine.triggers[1]);
  crank.teeth_deg.emplace_back(246 + 349.5, 246 + 351.5);
  cam.teeth_deg.emplace_back(500 + 600, 500 + 700);
  expect_drawn<TypeParam>(engine, 0, crank);
  expect_drawn<TypeParam>(engine, 1, cam);
}

TYPED_TEST(WheelFaultsOf, AMovedToothMovesAndNoOther) {
  for (const int tooth : {1, 58}) {
    for (const double moved_deg : {-1.25, 2.5}) {
      EngineDefinition engine = with_two_wheels();
      engine.wheel_fault_count = 1;
      engine.wheel_faults[0] = fault_of(0);
      engine.wheel_faults[0].moved_tooth = tooth, engine.wheel_faults[0].moved_deg = moved_deg;
      Drawn drawn(engine.triggers[0]);
      auto& moved = drawn.teeth_deg[static_cast<std::size_t>(tooth - 1)];
      moved.first += moved_deg, moved.second += moved_deg;
      expect_drawn<TypeParam>(engine, 0, drawn);
    }
  }
}

TYPED_TEST(WheelFaultsOf, RunOutShiftsEachEdgeByASineOfTheWheelsAngle) {
  for (const std::size_t wheel : {0u, 1u}) {
    EngineDefinition engine = with_two_wheels();
    engine.wheel_fault_count = 1;
    WheelFault& fault = engine.wheel_faults[0] = fault_of(static_cast<int>(wheel));
    fault.runout_deg = 1.5, fault.runout_at_deg = 75;
    Drawn drawn(engine.triggers[wheel]);
    const double first_deg = engine.triggers[wheel].first_tooth_deg;
    for (auto& [rise_deg, fall_deg] : drawn.teeth_deg) {
      for (double* deg : {&rise_deg, &fall_deg})
        *deg += 1.5 * std::sin((*deg - first_deg) / drawn.turn_deg * 2 * kPi - 75 * kPi / 180);
    }
    expect_drawn<TypeParam>(engine, wheel, drawn);
  }
}

TYPED_TEST(WheelFaultsOf, AStretchedChainMakesTheCamsEdgesLate) {
  for (const double late_deg : {8.0, -3.5}) {
    EngineDefinition engine = with_two_wheels();
    engine.wheel_fault_count = 1;
    engine.wheel_faults[0] = fault_of(1);
    engine.wheel_faults[0].late_deg = late_deg;
    Drawn drawn(engine.triggers[1]);
    for (auto& tooth : drawn.teeth_deg) tooth.first += late_deg, tooth.second += late_deg;
    expect_drawn<TypeParam>(engine, 1, drawn);
    expect_drawn<TypeParam>(engine, 0, Drawn(engine.triggers[0]));  // the other wheel is as it was
  }
}

TYPED_TEST(WheelFaultsOf, ASwappedWireInvertsTheSignal) {
  EngineDefinition engine = with_two_wheels();
  engine.wheel_fault_count = 1;
  engine.wheel_faults[0] = fault_of(0);
  engine.wheel_faults[0].inverted = true;
  const auto run = rig<TypeParam, Turned>(engine);
  for (int tick = 0; tick < 3000; ++tick) {
    const auto& out = run->step();
    const auto &wrong = out.faulty_trigger[0], &right = out.trigger[0];
    ASSERT_EQ(wrong.level, right.level ^ 1u);
    ASSERT_EQ(wrong.edge_count, right.edge_count);
    for (std::uint32_t e = 0; e < right.edge_count; ++e) {
      ASSERT_EQ(wrong.edge[e].time_s, right.edge[e].time_s);
      ASSERT_EQ(wrong.edge[e].level, right.edge[e].level ^ 1u);
    }
  }
}

/// A tick whose faulty signal goes on from the last: each edge to the other level, in order of time.
template <class Real, class S>
void expect_joined(const TriggerSignal<Real, S>& signal, std::uint32_t& level, int tick) {
  ASSERT_LE(signal.edge_count, S::trigger_edges);
  Real last_s{0};
  for (std::uint32_t e = 0; e < signal.edge_count; ++e) {
    level ^= 1u;
    ASSERT_EQ(signal.edge[e].level, level) << "tick " << tick << ", edge " << e;
    ASSERT_GE(signal.edge[e].time_s, last_s) << "tick " << tick << ", edge " << e;
    last_s = signal.edge[e].time_s;
  }
  ASSERT_LE(last_s, static_cast<Real>(kTick_s) * (1 + 4 * std::numeric_limits<Real>::epsilon())) << "tick " << tick;
  ASSERT_EQ(signal.level, level) << "tick " << tick;
}

TYPED_TEST(WheelFaultsOf, AStuckSignalHasOneEdgeAtItsBeginAndOneAtItsEndWhereTheLevelChanges) {
  using Real = TypeParam;
  for (const StuckSignal stuck : {StuckSignal::low, StuckSignal::high}) {
    EngineDefinition engine = with_two_wheels();
    engine.wheel_fault_count = 1;
    WheelFault& fault = engine.wheel_faults[0] = fault_of(0);
    fault.stuck = stuck, fault.start_s = 0.05, fault.end_s = 0.08;
    const auto run = rig<Real, Turned>(engine);
    std::uint32_t level = 0;
    int edges_while_on = 0;
    for (int tick = 0; tick < 1500; ++tick) {
      const auto& out = run->step();
      if (tick == 0) level = out.faulty_trigger[0].level ^ (out.faulty_trigger[0].edge_count & 1u);
      expect_joined<Real, Turned>(out.faulty_trigger[0], level, tick);
      const bool on = tick >= 500 && tick < 800;
      ASSERT_EQ(out.wheel_faults_on, on ? 1u : 0u) << tick;
      if (on) {
        edges_while_on += static_cast<int>(out.faulty_trigger[0].edge_count);
        ASSERT_EQ(out.faulty_trigger[0].level, stuck == StuckSignal::high ? 1u : 0u);
      } else {
        ASSERT_EQ(out.faulty_trigger[0].level, out.trigger[0].level);
        if (tick != 800) {
          ASSERT_EQ(out.faulty_trigger[0].edge_count, out.trigger[0].edge_count);
        }
      }
    }
    EXPECT_LE(edges_while_on, 1);
  }
}

TYPED_TEST(WheelFaultsOf, NoiseInvertsTheSignalForItsPulsesAtItsRate) {
  using Real = TypeParam;
  EngineDefinition engine = with_two_wheels();
  engine.wheel_fault_count = 1;
  WheelFault& fault = engine.wheel_faults[0] = fault_of(0);
  fault.noise_Hz = 400, fault.noise_pulse_s = 15e-6;
  const auto run = rig<Real, Turned>(engine);
  constexpr int kTicks = 100'000;
  int pulses = 0;
  std::uint32_t level = 0;
  for (int tick = 0; tick < kTicks; ++tick) {
    const auto& out = run->step();
    if (tick == 0) level = out.faulty_trigger[0].level ^ (out.faulty_trigger[0].edge_count & 1u);
    expect_joined<Real, Turned>(out.faulty_trigger[0], level, tick);
    // Where the two signals differ, by walking both lists of edges.
    const auto &noisy = out.faulty_trigger[0], &clean = out.trigger[0];
    ASSERT_TRUE(noisy.edge_count == clean.edge_count || noisy.edge_count == clean.edge_count + 2);
    ASSERT_EQ(noisy.level, clean.level);
    if (noisy.edge_count == clean.edge_count) continue;
    ++pulses;
    std::vector<double> times_s;
    for (std::uint32_t e = 0; e < noisy.edge_count; ++e) times_s.push_back(static_cast<double>(noisy.edge[e].time_s));
    for (std::uint32_t e = 0; e < clean.edge_count; ++e) {
      const auto same = std::find(times_s.begin(), times_s.end(), static_cast<double>(clean.edge[e].time_s));
      ASSERT_NE(same, times_s.end());
      times_s.erase(same);
    }
    ASSERT_EQ(times_s.size(), 2u);
    ASSERT_NEAR(times_s[1] - times_s[0], 15e-6, 1e-10);
  }
  const double expected = 400 * kTick_s * kTicks, p = 400 * kTick_s;
  EXPECT_NEAR(pulses, expected, 4 * std::sqrt(expected * (1 - p)));
}

TEST(WheelFaults, OfSeveralTheFirstShowsAndAnInputBitSwitchesThem) {
  EngineDefinition engine = with_two_wheels();
  engine.wheel_fault_count = 3;
  WheelFault& low = engine.wheel_faults[0] = fault_of(0);
  low.end_s = 0, low.input_bit = 3, low.stuck = StuckSignal::low;
  WheelFault& high = engine.wheel_faults[1] = fault_of(0);
  high.end_s = 0, high.input_bit = 5, high.stuck = StuckSignal::high;
  WheelFault& cam = engine.wheel_faults[2] = fault_of(1);
  cam.end_s = 0, cam.input_bit = 5, cam.inverted = true;
  const auto run = rig<double, Turned>(engine);
  const auto after = [&run](std::uint32_t mask) {
    run->in.wheel_faults = mask;
    for (int tick = 0; tick < 33; ++tick) run->step();
    return run->engine.output().wheel_faults_on;
  };
  EXPECT_EQ(after(0), 0u);
  EXPECT_EQ(after(1u << 5), 6u);
  EXPECT_EQ(run->engine.output().faulty_trigger[0].level, 1u);
  EXPECT_EQ(after(1u << 5 | 1u << 3), 7u);
  EXPECT_EQ(run->engine.output().faulty_trigger[0].level, 0u);
  EXPECT_EQ(run->engine.output().faulty_trigger[1].level, run->engine.output().trigger[1].level ^ 1u);
  EXPECT_EQ(after(~0u << 6), 0u);
}

/// A fault that comes or goes in the tick of a jump changes the level, and has no edge: nobody knows when.
TEST(WheelFaults, ThatComeAndGoWhereTheMeasuredAngleJumpsHaveNoEdge) {
  EngineDefinition engine = with_two_wheels();
  engine.wheel_fault_count = 1;
  engine.wheel_faults[0] = fault_of(0);
  engine.wheel_faults[0].end_s = 0, engine.wheel_faults[0].input_bit = 2, engine.wheel_faults[0].inverted = true;
  const auto run = rig<double, Measured>(engine);
  std::uint32_t level = 0;
  for (int tick = 0; tick < 400; ++tick) {
    const bool changes = tick % 40 == 20, jumps = changes && tick % 80 == 20;
    if (changes) run->in.wheel_faults ^= 1u << 2;
    run->in.crank += Phase::from_cycles(jumps ? 0.3 : 1e-5);
    const auto& out = run->step();
    const auto& seen = out.faulty_trigger[0];
    ASSERT_EQ(out.faults, jumps ? std::uint32_t{kFaultPhaseJump} : 0u) << tick;
    ASSERT_EQ(seen.level, out.trigger[0].level ^ (run->in.wheel_faults != 0 ? 1u : 0u)) << tick;
    if (jumps) {
      ASSERT_EQ(seen.edge_count, 0u) << tick;
    } else if (tick > 0) {
      ASSERT_EQ((level ^ seen.edge_count) & 1u, seen.level) << tick;
      if (changes) {
        ASSERT_GE(seen.edge_count, 1u) << tick;
        ASSERT_EQ(seen.edge[0].time_s, 0) << tick;
      }
    }
    level = seen.level;
  }
}

/// Faults of every kind, on at random.
[[nodiscard]] EngineDefinition with_many_faults() {
  EngineDefinition engine = with_two_wheels();
  engine.wheel_fault_count = 4;
  for (int i = 0; i < 4; ++i) {
    WheelFault& fault = engine.wheel_faults[i] = fault_of(i < 3 ? 0 : 1);
    fault.end_s = 0, fault.input_bit = i;
  }
  engine.wheel_faults[0].missing_tooth = 3, engine.wheel_faults[0].inverted = true;
  engine.wheel_faults[1].runout_deg = 1.4, engine.wheel_faults[1].noise_Hz = 3000;
  engine.wheel_faults[1].noise_pulse_s = 20e-6;
  engine.wheel_faults[2].stuck = StuckSignal::high, engine.wheel_faults[2].noise_Hz = 5000;
  engine.wheel_faults[2].noise_pulse_s = 50e-6;
  engine.wheel_faults[3].late_deg = 12, engine.wheel_faults[3].noise_Hz = 1000;
  engine.wheel_faults[3].noise_pulse_s = 1e-6;
  return engine;
}

TYPED_TEST(WheelFaultsOf, EveryChangeOfLevelHasItsEdgeThroughStandstillAndBackAndTheHealthySignalKeepsItsBits) {
  using Real = TypeParam;
  support::Random random;
  const EngineDefinition engine = with_many_faults();
  const auto run = rig<Real, Free>(engine);
  const auto healthy = rig<Real, FreeHealthy>(with_two_wheels());
  std::uint32_t level[2] = {};
  int edges = 0;
  for (int tick = 0; tick < 60'000; ++tick) {
    if (tick % 7 == 0) run->in.wheel_faults = static_cast<std::uint32_t>(random.whole(0, 15));
    if (tick % 500 == 0) {
      run->in.external_torque_Nm = healthy->in.external_torque_Nm = static_cast<Real>(random.whole(-900, 900));
    }
    const auto& out = run->step();
    const auto& right = healthy->step();
    for (std::size_t w = 0; w < 2; ++w) {
      if (tick == 0) level[w] = out.faulty_trigger[w].level ^ (out.faulty_trigger[w].edge_count & 1u);
      expect_joined<Real, Free>(out.faulty_trigger[w], level[w], tick);
      if (::testing::Test::HasFatalFailure()) return;
      edges += static_cast<int>(out.faulty_trigger[w].edge_count);
      ASSERT_EQ(out.trigger[w].level, right.trigger[w].level);
      ASSERT_EQ(out.trigger[w].edge_count, right.trigger[w].edge_count);
      for (std::uint32_t e = 0; e < right.trigger[w].edge_count; ++e) {
        ASSERT_EQ(out.trigger[w].edge[e].time_s, right.trigger[w].edge[e].time_s);
        ASSERT_EQ(out.trigger[w].edge[e].level, right.trigger[w].edge[e].level);
      }
    }
  }
  EXPECT_GT(edges, 10'000);
}

TYPED_TEST(WheelFaultsOf, ARestoredRunRepeatsItsNoise) {
  using Real = TypeParam;
  const EngineDefinition engine = with_many_faults();
  const auto first = rig<Real, Free>(engine), second = rig<Real, Free>(engine);
  first->in.external_torque_Nm = second->in.external_torque_Nm = -200;
  first->in.wheel_faults = second->in.wheel_faults = 14;
  for (int tick = 0; tick < 3000; ++tick) first->step();
  std::vector<unsigned char> bytes(kSavedStateBytes<Real, Free>);
  ASSERT_TRUE(accepted(save_state(first->engine, bytes.data(), bytes.size())));
  ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), second->engine)));
  for (int tick = 0; tick < 3000; ++tick) {
    const auto &a = first->step().faulty_trigger[1], &b = second->step().faulty_trigger[1];
    ASSERT_EQ(a.edge_count, b.edge_count);
    for (std::uint32_t e = 0; e < a.edge_count; ++e) ASSERT_EQ(a.edge[e].time_s, b.edge[e].time_s);
  }
  EXPECT_EQ(std::memcmp(&first->engine.state(), &second->engine.state(), sizeof first->engine.state()), 0);
}

TEST(WheelFaults, MoreEdgesThanThereIsRoomForAreCountedAndTold) {
  EngineDefinition engine = with_two_wheels();
  engine.wheel_fault_count = 1;
  WheelFault& fault = engine.wheel_faults[0] = fault_of(0);
  fault.noise_Hz = 10'000, fault.noise_pulse_s = 20e-6;  // in each tick
  const auto run = rig<float, OneEdge>(engine);
  std::uint32_t last = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    const auto& out = run->step();
    const auto& signal = out.faulty_trigger[0];
    ASSERT_GE(signal.edge_count, 2u);
    ASSERT_NE(out.faults & kFaultTriggerEdges, 0u);
    ASSERT_EQ(signal.level, out.trigger[0].level);
    if (tick > 0) {
      ASSERT_EQ(signal.level, last ^ (signal.edge_count & 1u));
    }
    last = signal.level;
  }
}

TEST(WheelFaults, AnExtraToothOnAWheelOfAsManyEdgesAsThereIsRoomForIsRefused) {
  EngineDefinition engine = with_two_wheels();
  engine.triggers[0] = toothed(TriggerShaft::crank, kMaxTriggerEdges / 2, {}, 0);
  engine.wheel_fault_count = 1;
  WheelFault& fault = engine.wheel_faults[0] = fault_of(0);
  fault.extra_tooth_deg = 0.7, fault.extra_width_deg = 0.1;  // in the space behind the first tooth
  TableStorage<float, Turned> storage;
  EXPECT_TRUE(refuses(storage.build(engine, {kTick_s, {}}), Reason::too_many_points, "fault.extra_tooth_deg", 0));
  fault.missing_tooth = 1;  // makes room
  EXPECT_TRUE(accepted(storage.build(engine, {kTick_s, {}})));
}

TEST(WheelFaults, MoreThanTheSceneHasRoomForAreRefusedByBuildAndByInit) {
  EngineDefinition engine = with_two_wheels();
  engine.wheel_fault_count = 2;
  engine.wheel_faults[0] = engine.wheel_faults[1] = fault_of(0);
  engine.wheel_faults[0].inverted = engine.wheel_faults[1].inverted = true;
  const auto storage = std::make_unique<TableStorage<float, OneFault>>();
  EXPECT_TRUE(refuses(storage->build(engine, {kTick_s, {}}), Reason::out_of_range, "scene.wheel_faults"));
  engine.wheel_fault_count = 1;
  ASSERT_TRUE(accepted(storage->build(engine, {kTick_s, {}})));
  auto tables = storage->tables();
  auto rules = *tables.wheel_faults;
  rules.count = 2;
  tables.wheel_faults = &rules;
  const auto run = std::make_unique<Engine<float, OneFault>>();
  EXPECT_TRUE(refuses(run->init(tables), Reason::out_of_range, "tables.wheel_faults"));
}

TEST(WheelFaults, WhatNoWheelCanHaveIsRefusedByName) {
  const auto refusal = [](auto change) {
    EngineDefinition engine = with_two_wheels();
    engine.wheel_fault_count = 1;
    engine.wheel_faults[0] = fault_of(0);
    change(engine.wheel_faults[0]);
    TableStorage<float, Turned> storage;
    return storage.build(engine, {kTick_s, {}});
  };
  using Fault = WheelFault;
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.wheel = 2; }), Reason::out_of_range, "fault.wheel", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.wheel = -1; }), Reason::negative, "fault.wheel", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.end_s = 0; }), Reason::inconsistent, "fault.end_s", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.start_s = std::nan(""); }), Reason::not_finite, "fault.start_s", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.input_bit = 32; }), Reason::out_of_range, "fault.input_bit", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.missing_tooth = 59; }), Reason::out_of_range, "fault.missing_tooth", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.moved_tooth = 59; }), Reason::out_of_range, "fault.moved_tooth", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.moved_tooth = f.missing_tooth = 5; }), Reason::inconsistent,
                      "fault.moved_tooth", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.moved_tooth = 5, f.moved_deg = 3; }), Reason::inconsistent,
                      "fault.moved_deg", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.extra_tooth_deg = 1, f.extra_width_deg = 1; }), Reason::inconsistent,
                      "fault.extra_width_deg", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.runout_deg = 80; }), Reason::inconsistent, "fault.runout_deg", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.noise_Hz = 100; }), Reason::not_positive, "fault.noise_pulse_s", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.noise_Hz = 100, f.noise_pulse_s = 60e-6; }), Reason::out_of_range,
                      "fault.noise_pulse_s", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.noise_Hz = 10'001, f.noise_pulse_s = 1e-6; }), Reason::out_of_range,
                      "fault.noise_Hz", 0));
  EXPECT_TRUE(refuses(refusal([](Fault& f) { f.stuck = static_cast<StuckSignal>(7); }), Reason::out_of_range,
                      "fault.stuck", 0));

  EngineDefinition single = with_two_wheels();
  single.triggers[0] = toothed(TriggerShaft::crank, 1, {}, 0);
  single.wheel_fault_count = 1;
  single.wheel_faults[0] = fault_of(0);
  single.wheel_faults[0].missing_tooth = 1;
  TableStorage<float, Turned> storage;
  EXPECT_TRUE(refuses(storage.build(single, {kTick_s, {}}), Reason::too_few_points, "fault.missing_tooth", 0));
  EngineDefinition many = with_two_wheels();
  many.wheel_fault_count = 5;
  for (int i = 0; i < 5; ++i) many.wheel_faults[i] = fault_of(0);
  EXPECT_TRUE(refuses(storage.build(many, {kTick_s, {}}), Reason::out_of_range, "scene.wheel_faults"));
  many.wheel_fault_count = kMaxWheelFaults + 1;
  EXPECT_TRUE(refuses(validate(many), Reason::out_of_range, "wheel_fault_count"));
}

}  // namespace
}  // namespace crankloop::wheel_faults_test

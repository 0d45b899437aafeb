// The scenes of `live` ask for more than the ready-made free ones, which gives the same bits in what both have; the
// block's signals are what the engine's own outputs and diagrams say.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/crankloop.hpp>
#include <crankloop/tabulate/summary.hpp>

#include "crankloop/commands/live/live_edges.hpp"
#include "crankloop/commands/live/live_loop.hpp"
#include "crankloop/commands/live/live_scenes.hpp"
#include "crankloop/commands/live/live_signals.hpp"
#include "crankloop/engine_file/gas_order.hpp"
#include "crankloop/loops/scene_inputs.hpp"

namespace crankloop::program::live_scenes_test {
namespace {

EngineFile sample(const std::string& name) {
  return read_engine_file(CRANKLOOP_SOURCE_DIR "/tools/engines/" + name + ".ini", {});
}

template <class Real, class S>
struct Bench {
  Bench(const EngineFile& file, double tick_s) : Bench(file.definition(), tick_s) {}
  Bench(const EngineDefinition& definition, double tick_s) {
    EXPECT_TRUE(tables->build(definition, {tick_s}).ok());
    EXPECT_TRUE(engine.init(tables->tables()).ok());
    EXPECT_TRUE(engine.restore(turning_at(engine.state(), static_cast<Real>(120))).ok());
    shape = detail::shape_of<Real, S>(tables->tables());
    if constexpr (detail::Needs<S>::gas) {
      GasOrder order = gas_order(definition.gas);
      order.throttle_ratio = 0.3;
      tell(input, order);
    } else {
      input.load_ratio = static_cast<Real>(0.4);
    }
  }
  std::unique_ptr<TableStorage<Real, S, kMaxGasSegments>> tables =
      std::make_unique<TableStorage<Real, S, kMaxGasSegments>>();
  Engine<Real, S> engine;
  typename Engine<Real, S>::Input input;
  detail::EngineShape shape;
};

template <class Value>
bool same_bits(const Value& a, const Value& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

template <class Real, class Lean, class Rich>
void expect_same_bits(const std::string& engine, double tick_s) {
  const EngineFile file = sample(engine);
  Bench<Real, Lean> lean(file, tick_s);
  Bench<Real, Rich> rich(file, tick_s);
  for (int tick = 0; tick < 4000; ++tick) {
    lean.input.external_torque_Nm = rich.input.external_torque_Nm = static_cast<Real>(tick < 2000 ? 15 : -15);
    lean.input.cut_cylinders = rich.input.cut_cylinders = tick > 1000 && tick < 3000 ? 2 : 0;
    const auto& a = lean.engine.step(lean.input);
    const auto& b = rich.engine.step(rich.input);
    ASSERT_EQ(a.crank.units(), b.crank.units()) << tick;
    ASSERT_TRUE(same_bits(a.speed_rad_s, b.speed_rad_s) && same_bits(a.torque_Nm, b.torque_Nm) &&
                same_bits(a.mean_torque_Nm, b.mean_torque_Nm) &&
                same_bits(a.acceleration_rad_s2, b.acceleration_rad_s2))
        << tick;
    ASSERT_EQ(a.faults, b.faults) << tick;
    for (std::uint32_t w = 0; w < lean.shape.wheels; ++w) {
      ASSERT_EQ(a.trigger[w].edge_count, b.trigger[w].edge_count);
      ASSERT_EQ(a.trigger[w].level, b.trigger[w].level);
      for (std::uint32_t e = 0; e < listed_edges(a.trigger[w]); ++e)
        ASSERT_TRUE(same_bits(a.trigger[w].edge[e].time_s, b.trigger[w].edge[e].time_s)) << tick;
    }
  }
}

TEST(LiveScenes, RunAsTheReadyMadeOnesDo) {
  for (const double tick_s : {1e-3, 1e-4}) {
    expect_same_bits<float, scenes::FreeRunning, LiveRunning>("diesel_495", tick_s);
    expect_same_bits<double, scenes::FreeRunning, LiveRunning>("diesel_495", tick_s);
  }
  expect_same_bits<float, scenes::BreathingFree, LiveBreathing>("four_2000", 2e-4);
  expect_same_bits<double, scenes::BreathingFree, LiveBreathing>("four_2000", 2e-4);
}

TEST(LiveSignals, ShowWhichWheelsAreFaultyAndTheEdgesThatAControllerSees) {
  EngineDefinition definition = sample("diesel_495").definition();
  definition.wheel_fault_count = 2;
  definition.wheel_faults[0].wheel = 1, definition.wheel_faults[0].input_bit = 5;
  definition.wheel_faults[0].inverted = true;
  definition.wheel_faults[1].wheel = 0, definition.wheel_faults[1].input_bit = 3;
  definition.wheel_faults[1].stuck = StuckSignal::low;
  Bench<float, LiveRunning> bench(definition, 1e-4);
  const std::vector<std::string> names = signal_names<float, LiveRunning>(bench.shape);
  int healthy_high = 0, edges_of_crank = 0, healthy_edges = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    bench.input.wheel_faults = 1u << 3;
    const auto& out = bench.engine.step(bench.input);
    port::LiveNumbers numbers{};
    write_signals(out, bench.engine.state(), bench.shape, numbers);
    std::map<std::string, double> shown;
    for (std::size_t i = 0; i < names.size(); ++i) shown[names[i]] = numbers[i];
    ASSERT_EQ(shown.at("wheel_faults_on"), 2);
    ASSERT_EQ(shown.at("faulty_trigger[1].level"), 0);
    ASSERT_EQ(shown.at("faulty_trigger[2].level"), shown.at("trigger[2].level"));
    healthy_high += shown.at("trigger[1].level") == 1 ? 1 : 0;
    each_edge_by_time(out.faulty_trigger, bench.shape.wheels, 100'000,
                      [&](std::int64_t, std::uint32_t wheel, std::uint32_t) { edges_of_crank += wheel == 0 ? 1 : 0; });
    each_edge_by_time(out.trigger, bench.shape.wheels, 100'000,
                      [&](std::int64_t, std::uint32_t wheel, std::uint32_t) { healthy_edges += wheel == 0 ? 1 : 0; });
  }
  EXPECT_GT(healthy_high, 500);
  EXPECT_GT(healthy_edges, 200);
  EXPECT_LE(edges_of_crank, 1);  // where it fell to the level at which it is stuck
}

/// docs/feed_a_controller.md states them, and what follows from them.
TEST(SampleEngines, HaveTheWheelsThatTheControllersPageStates) {
  for (const char* name :
       {"diesel_495", "diesel_495_gas", "four_2000", "four_2000_runners", "ohc_125", "ohc_125_gas"}) {
    SCOPED_TRACE(name);
    const EngineDefinition engine = sample(name).definition();
    ASSERT_EQ(engine.trigger_count, 2);
    const TriggerWheel &crank = engine.triggers[0], &cam = engine.triggers[1];
    EXPECT_TRUE(crank.shaft == TriggerShaft::crank && crank.places == 60 && crank.gap_count == 1);
    EXPECT_TRUE(crank.gaps[0].teeth == 58 && crank.gaps[0].missing == 2);
    EXPECT_TRUE(!crank.inverted && !cam.inverted);
    EXPECT_EQ(crank.first_tooth_deg, 246);
    EXPECT_EQ(crank.tooth_ratio * 360 / crank.places, 3);  // a tooth's end after its begin
    EXPECT_TRUE(cam.shaft == TriggerShaft::cam && cam.places == 1 && cam.tooth_ratio == 0.5);
    const double rises_deg = cam.first_tooth_deg;  // high for 360 from here
    EXPECT_EQ(rises_deg, 720 - 180);
    EXPECT_EQ(246 + 360 - rises_deg, 66);          // tooth 1 before firing: 114 deg before 720
    EXPECT_EQ(246 - (rises_deg + 360 - 720), 66);  // the other one, in the low half
  }
}

TEST(LiveSignals, SayWhatTheDiagramAndTheCamsSay) {
  const EngineFile file = sample("diesel_495");
  ExactEngine exact;
  ASSERT_TRUE(exact.init(file.definition()).ok());
  Bench<double, LiveRunning> bench(file, 1e-3);
  const std::vector<std::string> names = signal_names<double, LiveRunning>(bench.shape);
  const auto at = [&names](const std::string& name) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == name) return i;
    }
    ADD_FAILURE() << name;
    return std::size_t{0};
  };
  double largest_lift_m = 0;
  for (int tick = 0; tick < 400; ++tick) {
    const auto& out = bench.engine.step(bench.input);
    port::LiveNumbers numbers{};
    write_signals(out, bench.engine.state(), bench.shape, numbers);
    const double crank_deg = numbers[at("crank_deg")];
    ASSERT_NEAR(crank_deg, static_cast<double>(out.crank.units()) * kDegPerUnit, 1e-9);
    ASSERT_EQ(numbers[at("cam_deg")], crank_deg / 2);
    ASSERT_EQ(numbers[at("trigger[1].level")], out.trigger[0].level);
    for (std::size_t k = 0; k < 2; ++k) {
      const double exact_Pa = exact.forces(static_cast<int>(k), crank_deg, 0, 0.4).pressure_Pa;
      ASSERT_NEAR(numbers[at("cylinder[" + std::to_string(k + 1) + "].pressure_Pa")], exact_Pa, 20e3) << crank_deg;
    }
    largest_lift_m = std::max(largest_lift_m, numbers[at("valve[1,1].lift_m")]);
  }
  EXPECT_GT(largest_lift_m, 5e-3);
  EXPECT_LT(largest_lift_m, 15e-3);
}

TEST(LiveSignals, FollowAPhaserToItsTarget) {
  const EngineFile file = sample("four_2000");
  EngineDefinition definition = file.definition();
  definition.trains[0].cam.phase_rate_deg_s = 100;
  Bench<double, LiveBreathing> bench(definition, 2e-4);
  bench.input.cam_phase_deg[0] = bench.input.cam_phase_deg[1] = -10;
  for (int tick = 0; tick < 10000; ++tick) bench.engine.step(bench.input);
  port::LiveNumbers numbers{};
  write_signals(bench.engine.output(), bench.engine.state(), bench.shape, numbers);
  const std::vector<std::string> names = signal_names<double, LiveBreathing>(bench.shape);
  std::map<std::string, double> shown;
  for (std::size_t i = 0; i < names.size(); ++i) shown[names[i]] = numbers[i];
  EXPECT_NEAR(shown.at("cam_phase_deg[1]"), -10, 1e-9);
  EXPECT_EQ(shown.at("cam_phase_deg[2]"), 0) << "a fixed cam";
  EXPECT_EQ(shown.at("intake.pressure_Pa"), bench.engine.output().manifold[kIntake].pressure_Pa);
  EXPECT_EQ(shown.size(), names.size()) << "no name twice";
}

TEST(LiveEdges, AreOfAllWheelsInTheOrderOfTime) {
  struct Edge {
    double time_s;
    std::uint32_t level;
  };
  struct Wheel {
    std::uint32_t edge_count = 0;
    Edge edge[3];
  };
  struct {
    Wheel trigger[3];
  } out;
  out.trigger[0] = {3, {{1e-4, 1}, {3e-4, 0}, {3e-4, 1}}};
  out.trigger[1] = {5, {{0, 0}, {3e-4, 1}, {9e-4, 0}}};  // two more than there is room for
  out.trigger[2] = {1, {{1.0000004e-3, 1}, {}, {}}};     // of float: a hair beyond the tick
  std::string seen;
  const std::uint64_t unlisted =
      each_edge_by_time(out.trigger, 3, 1'000'000, [&](std::int64_t time_ns, std::uint32_t wheel, std::uint32_t level) {
        seen += std::to_string(time_ns) + ":" + std::to_string(wheel) + (level != 0 ? "+ " : "- ");
      });
  EXPECT_EQ(seen, "0:1- 100000:0+ 300000:0- 300000:0+ 300000:1+ 900000:1- 1000000:2+ ");
  EXPECT_EQ(unlisted, 2u);
}

TEST(LiveEdges, HaveRoomInTheRingForASecondAtFullSpeed) {
  const EngineFile file = sample("four_2000");  // 60-2 and half a moon up to 9000 rpm
  EXPECT_EQ(usual_ring_edges(file.definition(), file.triggers().size(), 2e-4, 1e-4), 32768u);  // of 150 * (116 + 1)
  EXPECT_EQ(usual_ring_edges(file.definition(), file.triggers().size(), 2e-4, 1), 65536u) << "a second of lead";
  EXPECT_EQ(usual_ring_edges(file.definition(), 0, 2e-4, 0), 0u);
}

}  // namespace
}  // namespace crankloop::program::live_scenes_test

// The generated C interfaces against the C++ engines they are made of: every group, bit for bit.
#include <cstddef>
#include <cstdio>
#include <cstring>

#include "all_of_it.h"
#include "all_of_it.hpp"
#include "sensor.h"
#include "sensor.hpp"
#include "torque_only.h"
#include "torque_only.hpp"
#include "turned.h"
#include "turned.hpp"

static int bad = 0;

template <class C, class Cpp>
static void expect_same(const char* what, int tick, const C* c, const Cpp& cpp) {
  static_assert(sizeof(C) == sizeof(Cpp));
  if (std::memcmp(c, &cpp, sizeof cpp) != 0 && bad++ < 10) std::printf("tick %d: other %s\n", tick, what);
}
static void expect(const char* what, bool is_so) {
  if (!is_so && bad++ < 10) std::printf("not so: %s\n", what);
}

int main() {
  using namespace crankloop;
  using Real = all_of_it::Real;
  using S = all_of_it::Scene;
  static_assert(sizeof(all_of_it_engine) == sizeof(all_of_it::Engine), "the exact size");
  static_assert(sizeof(torque_only_engine) == sizeof(torque_only::Engine), "the exact size");

  {  // Nothing is written through a null pointer, nor read.
    all_of_it_engine none{};
    const all_of_it_input any = all_of_it_default_input();
    unsigned char bytes[all_of_it_SAVED_BYTES];
    all_of_it_init(nullptr, 0);
    expect("null is not ready", all_of_it_step(nullptr, &any) == kFaultNotReady && all_of_it_step(&none, nullptr) == kFaultNotReady);
    expect("null has no numbers", all_of_it_phase(nullptr) == 0 && all_of_it_torque_Nm(nullptr) == 0 && all_of_it_mean_torque_Nm(nullptr) == 0);
    expect("null has no groups", all_of_it_get_forces(nullptr) == nullptr && all_of_it_get_valves(nullptr) == nullptr);
    expect("null is not saved", all_of_it_save(nullptr, bytes, sizeof bytes).reason == CRANKLOOP_NULL_POINTER &&
                                    all_of_it_save(&none, nullptr, sizeof bytes).reason == CRANKLOOP_NULL_POINTER);
    expect("null is not loaded", all_of_it_load(nullptr, bytes, sizeof bytes).reason == CRANKLOOP_NULL_POINTER &&
                                     all_of_it_load(&none, nullptr, sizeof bytes).reason == CRANKLOOP_NULL_POINTER);
    turned_turn_at(nullptr, 100);
  }

  all_of_it_engine engine{};
  all_of_it_init(&engine, 77);
  all_of_it::Engine cpp{Phase{77}};
  all_of_it_input in = all_of_it_default_input();
  all_of_it::Input cpp_in;
  long edges = 0;
  for (int tick = 0; tick < 1500; ++tick) {
    in.speed_rad_s = cpp_in.speed_rad_s = 420 - 0.5 * tick;
    in.load_ratio = cpp_in.load_ratio = tick % 5 * 0.25;
    in.cam_phase_deg[1] = cpp_in.cam_phase_deg[1] = 0;
    const auto& out = cpp.step(cpp_in);
    expect("the same faults", all_of_it_step(&engine, &in) == out.faults);
    const double torque_Nm = all_of_it_torque_Nm(&engine);
    const double mean_torque_Nm = all_of_it_mean_torque_Nm(&engine);
    expect_same("torque", tick, &torque_Nm, out.torque_Nm);
    expect_same("mean torque", tick, &mean_torque_Nm, out.mean_torque_Nm);
    expect_same("kinematics", tick, all_of_it_get_kinematics(&engine), static_cast<const Kinematics<Real, S>&>(out));
    expect_same("rod motion", tick, all_of_it_get_rod_motion(&engine), static_cast<const RodMotion<Real, S>&>(out));
    expect_same("forces", tick, all_of_it_get_forces(&engine), static_cast<const Forces<Real, S>&>(out));
    expect_same("bearing loads", tick, all_of_it_get_bearing_loads(&engine), static_cast<const BearingLoads<Real, S>&>(out));
    expect_same("free forces", tick, all_of_it_get_free_forces(&engine), static_cast<const FreeForces<Real>&>(out));
    expect_same("valves", tick, all_of_it_get_valves(&engine), static_cast<const Valves<Real, S>&>(out));
    const all_of_it_valve_forces& forces = *all_of_it_get_valve_forces(&engine);
    for (int t = 0; t < 2; ++t) {
      for (int k = 0; k < 4; ++k) {  // without the padding behind the regime, which nobody promises
        const all_of_it_valve_force& one = forces.valve_forces[t][k];
        const ValveForcesOutput<Real>& other = out.valve_forces[t][k];
        expect("the same valve forces", std::memcmp(&one, &other, offsetof(all_of_it_valve_force, regime)) == 0 && one.regime == other.regime);
      }
    }
    expect_same("valve results", tick, all_of_it_get_valve_results(&engine), static_cast<const ValveResults<Real, S>&>(out));
    const all_of_it_triggers& triggers = *all_of_it_get_triggers(&engine);
    for (int w = 0; w < 2; ++w) {  // likewise
      const TriggerSignal<Real, S>& signal = out.trigger[w];
      expect("the same trigger level", triggers.trigger[w].level == signal.level);
      expect("the same trigger edges", triggers.trigger[w].edge_count == signal.edge_count);
      for (std::uint32_t e = 0; e < signal.edge_count && e < S::trigger_edges; ++e) {
        const all_of_it_trigger_edge& edge = triggers.trigger[w].edge[e];
        expect("the same trigger edge", edge.time_s == signal.edge[e].time_s && edge.level == signal.edge[e].level);
        ++edges;
      }
    }
    expect("the same phase", all_of_it_phase(&engine) == cpp.state().phase.units());
  }
  expect("no bad input was counted", all_of_it_bad_input_ticks(&engine) == 0 && all_of_it_bad_input_kinds(&engine) == 0);
  all_of_it_input bad_in = in;
  bad_in.load_ratio = -1;
  for (int tick = 0; tick < 3; ++tick) all_of_it_step(&engine, &bad_in);
  expect("three bad inputs were counted", all_of_it_bad_input_ticks(&engine) == 3);
  expect("of one kind", all_of_it_bad_input_kinds(&engine) == CRANKLOOP_FAULT_LOAD_RATIO);

  expect("there were trigger edges", edges > 100);

  // Snapshot by copy, and bytes.
  unsigned char bytes[all_of_it_SAVED_BYTES];
  expect("it saves", all_of_it_save(&engine, bytes, sizeof bytes).reason == CRANKLOOP_OK);
  const all_of_it_engine copy = engine;
  for (int tick = 0; tick < 100; ++tick) all_of_it_step(&engine, &in);
  const double then_Nm = all_of_it_torque_Nm(&engine);
  expect("it loads", all_of_it_load(&engine, bytes, sizeof bytes).reason == CRANKLOOP_OK);
  for (int tick = 0; tick < 100; ++tick) all_of_it_step(&engine, &in);
  expect("it goes on from bytes", all_of_it_torque_Nm(&engine) == then_Nm);
  engine = copy;
  for (int tick = 0; tick < 100; ++tick) all_of_it_step(&engine, &in);
  expect("it goes on from a copy", all_of_it_torque_Nm(&engine) == then_Nm);
  bytes[99] ^= 1;
  expect("it refuses damage", all_of_it_load(&engine, bytes, sizeof bytes).reason == CRANKLOOP_DAMAGED);

  sensor_engine measured{};
  sensor_init(&measured, 0);
  sensor::Engine cpp_measured;
  sensor_input measured_in = sensor_default_input();
  sensor::Input cpp_measured_in;
  for (int tick = 0; tick < 500; ++tick) {
    measured_in.crank_phase += std::uint64_t{1} << 55;
    cpp_measured_in.crank = Phase{measured_in.crank_phase};
    for (int k = 0; k < 6; ++k) measured_in.pressure_Pa[k] = cpp_measured_in.pressure_Pa[k] = static_cast<float>(1e5 + 1000 * (tick * (k + 1) % 97));
    const auto& out = cpp_measured.step(cpp_measured_in);
    expect("the same faults of the sensor", sensor_step(&measured, &measured_in) == out.faults && out.faults == 0);
    const float mean_torque_Nm = sensor_mean_torque_Nm(&measured);
    expect_same("mean torque of the sensor", tick, &mean_torque_Nm, out.mean_torque_Nm);
  }
  turned_engine by_forces{};
  turned_init(&by_forces, 0);
  turned_turn_at(&by_forces, 30);
  turned::Engine cpp_by_forces;
  expect("it takes its own state", cpp_by_forces.restore(turning_at<turned::Real, turned::Scene>(cpp_by_forces.state(), 30)).ok());
  turned_input turned_in = turned_default_input();
  turned::Input cpp_turned_in;
  for (int tick = 0; tick < 2000; ++tick) {
    turned_in.load_Nm = cpp_turned_in.load_Nm = static_cast<float>(tick % 40);
    turned_in.starter = cpp_turned_in.starter = tick < 500 ? 1 : 0;
    turned_in.cut_cylinders = cpp_turned_in.cut_cylinders = tick > 1000 ? 2 : 0;
    const auto& out = cpp_by_forces.step(cpp_turned_in);
    expect("the same faults of the turned one", turned_step(&by_forces, &turned_in) == out.faults && out.faults == 0);
    const turned_crank_motion& motion = *turned_get_crank_motion(&by_forces);
    expect("the same motion", motion.crank_phase == out.crank.units() && motion.speed_rad_s == out.speed_rad_s &&
                                  motion.acceleration_rad_s2 == out.acceleration_rad_s2 && motion.friction_Nm == out.friction_Nm);
    expect("the same torques", turned_torque_Nm(&by_forces) == out.torque_Nm && turned_starter_Nm(&by_forces) == out.starter_Nm);
  }
  expect("it runs", turned_get_crank_motion(&by_forces)->speed_rad_s > 60);
  std::printf("%d bad\n", bad);
  return bad == 0 ? 0 : 1;
}

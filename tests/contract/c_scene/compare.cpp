// The C interfaces of a product's own scenes against the C++ engines they are made of: every output, bit for bit.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string_view>

#include <crankloop/variables.hpp>

#include "all_of_it.h"
#include "all_of_it.hpp"
#include "breathes.h"
#include "breathes.hpp"
#include "sensor.h"
#include "sensor.hpp"
#include "torque_only.h"
#include "torque_only.hpp"
#include "turned.h"
#include "turned.hpp"

using namespace crankloop;

static int bad = 0;

static void expect(const char* what, bool is_so) {
  if (!is_so && bad++ < 10) std::printf("not so: %s\n", what);
}
static bool ok(const crankloop_status& status) { return status.reason == CRANKLOOP_OK; }

/// Of a C output: bit for bit the variables of the list, in its order, each where C has its member: first those that
/// the state alone knows, then the others.
template <class S, class Real, class COutput>
static void expect_same(const char* what, const COutput& c, const Engine<Real, S>& cpp) {
  const detail::EngineShape largest{S::cylinders.capacity, S::trains.capacity, S::triggers.capacity, 1};
  std::size_t at = 0;
  const auto align_to = [&at](std::size_t bytes) { at = (at + bytes - 1) / bytes * bytes; };
  std::string_view record;
  std::uint32_t index = 0;
  for (const bool of_state : {true, false}) {
    const auto compare = [&](const detail::Variable& variable, const auto& value, bool is_of_state) {
      if (is_of_state != of_state) return;
      const std::string_view name = variable.name;
      const std::string_view part = name.substr(0, name.find('.'));
      if (part.size() < name.size() && (part != record || variable.first != index))
        align_to(alignof(Real));  // it has one
      record = part, index = variable.first;
      align_to(alignof(decltype(value)));
      if (std::memcmp(reinterpret_cast<const char*>(&c) + at, &value, sizeof value) != 0 && bad++ < 10)
        std::printf("%s: other %s\n", what, variable.name);
      at += sizeof value;
    };
    const auto* state = reinterpret_cast<const char*>(&cpp.state());
    detail::each_output<S>(
        [&](const detail::Variable& variable, const auto& value) {
          const auto offset = reinterpret_cast<const char*>(&value) - state;
          compare(variable, value, offset >= 0 && offset < static_cast<std::ptrdiff_t>(sizeof cpp.state()));
        },
        cpp.state(), cpp.output(), largest);
    detail::each_event<S>([&](const detail::Variable& variable, const auto& value) { compare(variable, value, false); },
                          cpp.output(), largest);
  }
  align_to(alignof(COutput));
  expect("the list has all of the struct", at == sizeof c);
}

static void misuse() {
  all_of_it_engine none{};
  all_of_it_engine engine{};
  all_of_it_input any;
  all_of_it_output out;
  unsigned char bytes[all_of_it_SAVED_BYTES];
  const auto is = [](const crankloop_status& status, int reason) { return status.reason == reason; };
  expect("defaults", ok(all_of_it_input_defaults(&any, sizeof any)) && any.load_ratio == 1);
  expect("null has no defaults", is(all_of_it_input_defaults(nullptr, 9), CRANKLOOP_NULL_POINTER));
  expect("null is not created", is(all_of_it_create(nullptr, sizeof engine, 0), CRANKLOOP_NULL_POINTER));
  expect("nor in too little room", is(all_of_it_create(&engine, sizeof engine - 1, 0), CRANKLOOP_WRONG_SIZE));
  expect("null is not ready", all_of_it_step(nullptr, &any, sizeof any) == kFaultNotReady);
  expect("zero is not ready", all_of_it_step(&none, &any, sizeof any) == kFaultNotReady);
  expect("zero is not read", is(all_of_it_read(&none, &out, sizeof out), CRANKLOOP_NOT_CREATED));
  expect("null is not read", is(all_of_it_read(nullptr, &out, sizeof out), CRANKLOOP_NULL_POINTER));
  expect("null is not saved", is(all_of_it_save(nullptr, bytes, sizeof bytes), CRANKLOOP_NULL_POINTER));
  expect("null is not loaded", is(all_of_it_load(nullptr, bytes, sizeof bytes), CRANKLOOP_NULL_POINTER));
  expect("null does not turn", is(turned_turn_at(nullptr, 100), CRANKLOOP_NULL_POINTER));
  std::memset(&engine, 0x5A, sizeof engine);
  expect("noise is not ready", all_of_it_step(&engine, &any, sizeof any) == kFaultNotReady);
  expect("it is created over noise", ok(all_of_it_create(&engine, sizeof engine, 0)));
  expect("once", is(all_of_it_create(&engine, sizeof engine, 0), CRANKLOOP_ALREADY_CREATED));
  expect("null is not stepped with", all_of_it_step(&engine, nullptr, sizeof any) == kFaultNotReady);
  expect("null is not read to", is(all_of_it_read(&engine, nullptr, sizeof out), CRANKLOOP_NULL_POINTER));
  expect("null is not saved to", is(all_of_it_save(&engine, nullptr, sizeof bytes), CRANKLOOP_NULL_POINTER));
  expect("it is discarded", ok(all_of_it_discard(&engine)) && is(all_of_it_reset(&engine, 0), CRANKLOOP_NOT_CREATED));
}

static void all_outputs() {
  all_of_it_engine engine{};
  expect("it is created", ok(all_of_it_create(&engine, sizeof engine, 77)));
  all_of_it::Engine cpp{Phase{77}};
  all_of_it_input in;
  all_of_it_output out;
  expect("it has defaults", ok(all_of_it_input_defaults(&in, sizeof in)));
  all_of_it::Input cpp_in;
  long edges = 0;
  for (int tick = 0; tick < 1500; ++tick) {
    in.speed_rad_s = cpp_in.speed_rad_s = 300 - 0.4 * tick;
    in.load_ratio = cpp_in.load_ratio = tick % 5 * 0.25;
    in.cam_phase_deg[1] = cpp_in.cam_phase_deg[1] = tick % 3;
    const auto& shown = cpp.step(cpp_in);
    expect("the same faults", all_of_it_step(&engine, &in, sizeof in) == shown.faults);
    expect("it is read", ok(all_of_it_read(&engine, &out, sizeof out)));
    expect_same("all of it", out, static_cast<const Engine<all_of_it::Real, all_of_it::Scene>&>(cpp));
    // By name, in case list and struct had the same numbers in another order.
    expect("phase", out.crank == cpp.state().phase.units());
    expect("torque", out.torque_Nm == shown.torque_Nm && out.mean_torque_Nm == shown.mean_torque_Nm);
    expect("lift", out.valve[1][2].lift_m == shown.valve[1][2].lift_m);
    expect("regime", out.valve_forces[1][3].regime == shown.valve_forces[1][3].regime);
    expect("seating", out.valve_cycle[0][3].seating_speed_m_s == shown.valve_cycle[0][3].seating_speed_m_s);
    expect("journal", out.journal_load_N[4] == shown.journal_load_N[4]);
    expect("edge", out.trigger[1].edge[2].time_s == shown.trigger[1].edge[2].time_s);
    edges += out.trigger[0].edge_count;
  }
  expect("there were trigger edges", edges > 100);
  expect("no bad input was counted", out.bad_input_ticks == 0 && out.bad_input_kinds == 0);
  all_of_it_input bad_in = in;
  bad_in.load_ratio = -1;
  for (int tick = 0; tick < 3; ++tick) all_of_it_step(&engine, &bad_in, sizeof bad_in);
  expect("it is read again", ok(all_of_it_read(&engine, &out, sizeof out)));
  expect("three bad inputs were counted", out.bad_input_ticks == 3);
  expect("of one kind", out.bad_input_kinds == CRANKLOOP_FAULT_LOAD_RATIO);

  // Snapshot by copy, and bytes.
  const auto torque_after_100 = [&] {
    for (int tick = 0; tick < 100; ++tick) all_of_it_step(&engine, &in, sizeof in);
    expect("it is read later", ok(all_of_it_read(&engine, &out, sizeof out)));
    return out.torque_Nm;
  };
  unsigned char bytes[all_of_it_SAVED_BYTES];
  expect("it saves", ok(all_of_it_save(&engine, bytes, sizeof bytes)));
  const all_of_it_engine copy = engine;
  const double then_Nm = torque_after_100();
  expect("it loads", ok(all_of_it_load(&engine, bytes, sizeof bytes)));
  expect("it goes on from bytes", torque_after_100() == then_Nm);
  engine = copy;
  expect("it goes on from a copy", torque_after_100() == then_Nm);
  bytes[99] ^= 1;
  expect("it refuses damage", all_of_it_load(&engine, bytes, sizeof bytes).reason == CRANKLOOP_DAMAGED);

  // In columns.
  engine = copy;
  double speed = in.speed_rad_s, load = in.load_ratio, cam = in.cam_phase_deg[1], torque[100], edge[100];
  crankloop_column columns[] = {{"speed_rad_s", &speed, 1, 0, nullptr, 0, 0},
                                {"load_ratio", &load, 1, 0, nullptr, 0, 0},
                                {"cam_phase_deg[2]", &cam, 1, 0, nullptr, 0, 0},
                                {"torque_Nm", torque, 100, 1, nullptr, 0, 0},
                                {"trigger[1].edge_count", edge, 100, 1, nullptr, 0, 0}};
  std::uint32_t faults = 1;
  expect("it steps many", ok(all_of_it_step_many(&engine, 100, columns, 5, &faults)) && faults == 0);
  expect("and gets there", torque[99] == then_Nm);
}

static void measured_inputs() {
  sensor_engine engine{};
  expect("the sensor is created", ok(sensor_create(&engine, sizeof engine, 0)));
  sensor::Engine cpp;
  sensor_input in;
  expect("the sensor has defaults", ok(sensor_input_defaults(&in, sizeof in)));
  sensor::Input cpp_in;
  for (int tick = 0; tick < 500; ++tick) {
    in.crank += std::uint64_t{1} << 55;
    cpp_in.crank = Phase{in.crank};
    for (int k = 0; k < 6; ++k)
      in.pressure_Pa[k] = cpp_in.pressure_Pa[k] = static_cast<float>(1e5 + 1000 * (tick * (k + 1) % 97));
    const auto& shown = cpp.step(cpp_in);
    expect("the same faults of the sensor", sensor_step(&engine, &in, sizeof in) == shown.faults && shown.faults == 0);
    sensor_output out;
    expect("the sensor is read", ok(sensor_read(&engine, &out, sizeof out)));
    expect("mean torque of the sensor", out.mean_torque_Nm == shown.mean_torque_Nm);
  }
}

static void forces() {
  turned_engine engine{};
  expect("the turned one is created", ok(turned_create(&engine, sizeof engine, 0)) && ok(turned_turn_at(&engine, 30)));
  turned::Engine cpp;
  expect("it takes its own state", cpp.restore(turning_at<turned::Real, turned::Scene>(cpp.state(), 30)).ok());
  turned_input in;
  turned_output out;
  expect("the turned one has defaults", ok(turned_input_defaults(&in, sizeof in)));
  turned::Input cpp_in;
  for (int tick = 0; tick < 2000; ++tick) {
    in.external_torque_Nm = cpp_in.external_torque_Nm = static_cast<float>(tick % 40);
    in.starter = cpp_in.starter = tick < 500 ? 1 : 0;
    in.cut_cylinders = cpp_in.cut_cylinders = tick > 1000 ? 2 : 0;
    const auto& shown = cpp.step(cpp_in);
    expect("the same faults of the turned one",
           turned_step(&engine, &in, sizeof in) == shown.faults && shown.faults == 0);
    expect("the turned one is read", ok(turned_read(&engine, &out, sizeof out)));
    expect_same("turned", out, static_cast<const Engine<turned::Real, turned::Scene>&>(cpp));
    expect("the same motion", out.crank == shown.crank.units() && out.speed_rad_s == shown.speed_rad_s &&
                                  out.friction_Nm == shown.friction_Nm && out.starter_Nm == shown.starter_Nm);
  }
  expect("it runs", out.speed_rad_s > 60);
}

/// Started, fired and throttled: its inputs are the list's, its results are those of whole cycles, its bytes have the
/// gas.
static void gas() {
  breathes_engine engine{};
  expect("the one that breathes is created", ok(breathes_create(&engine, sizeof engine, 0)));
  breathes::Engine cpp;
  breathes_input in;
  breathes_output out;
  expect("it has defaults too", ok(breathes_input_defaults(&in, sizeof in)) && in.throttle_ratio == 1);
  breathes::Input cpp_in;
  const auto step = [&](int tick) {
    in.starter = cpp_in.starter = tick < 5000 ? 1 : 0;
    in.throttle_ratio = cpp_in.throttle_ratio = tick < 8000 ? 0.3F : 0.1F;
    for (int k = 0; k < 4; ++k) {
      in.fuel_kg[k] = cpp_in.fuel_kg[k] = 2e-5F + 1e-6F * static_cast<float>(k);
      in.burn_start_deg[k] = cpp_in.burn_start_deg[k] = static_cast<float>(-10 - k);
    }
    return breathes_step(&engine, &in, sizeof in);
  };
  for (int tick = 0; tick < 12'000; ++tick) {
    const std::uint32_t faults = step(tick);
    const auto& shown = cpp.step(cpp_in);
    expect("the same faults of the one that breathes", faults == shown.faults && faults == 0);
    expect("the one that breathes is read", ok(breathes_read(&engine, &out, sizeof out)));
    expect_same("breathes", out, static_cast<const Engine<breathes::Real, breathes::Scene>&>(cpp));
    expect("the same pressure", out.cylinder_gas[2].pressure_Pa == shown.cylinder_gas[2].pressure_Pa);
  }
  expect("it fires", out.speed_rad_s > 100 && out.gas_cycle[3].net_mep_Pa > 5e4F && out.gas_cycle[3].fuel_kg > 4e-6F);
  unsigned char bytes[breathes_SAVED_BYTES];
  expect("it saves its gas", ok(breathes_save(&engine, bytes, sizeof bytes)));
  const auto after_1000 = [&] {
    for (int tick = 12'000; tick < 13'000; ++tick) (void)step(tick);
    expect("it is read once more", ok(breathes_read(&engine, &out, sizeof out)));
    return out;
  };
  const breathes_output then = after_1000();
  expect("it loads its gas", ok(breathes_load(&engine, bytes, sizeof bytes)));
  const breathes_output again = after_1000();
  expect("it goes on as it did", again.cylinder_gas[1].pressure_Pa == then.cylinder_gas[1].pressure_Pa &&
                                     again.crank == then.crank && again.torque_Nm == then.torque_Nm);
}

int main() {
  static_assert(sizeof(all_of_it_engine) == sizeof(all_of_it::Engine), "the exact size");
  static_assert(sizeof(torque_only_engine) == sizeof(torque_only::Engine), "the exact size");
  misuse();
  all_outputs();
  measured_inputs();
  forces();
  gas();
  std::printf("%d bad\n", bad);
  return bad == 0 ? 0 : 1;
}

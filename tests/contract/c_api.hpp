// The ready-made engines of the C interface by one name each, and what their tests share.
#pragma once

#include <crankloop/crankloop_free_d.h>
#include <crankloop/crankloop_free_f.h>
#include <crankloop/crankloop_whole_d.h>
#include <crankloop/crankloop_whole_f.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/crankloop.hpp>

#include "port/c/definition.hpp"

namespace crankloop::c_api {

/// The C names of one engine.
#define CRANKLOOP_C_API(Api, NAME, AReal, AScene)                  \
  struct Api {                                                     \
    using Real = AReal;                                            \
    using Scene = scenes::AScene;                                  \
    using Tables = NAME##_tables;                                  \
    using Engine = NAME##_engine;                                  \
    using Input = NAME##_input;                                    \
    using Output = NAME##_output;                                  \
    static constexpr const char* kName = #NAME;                    \
    static constexpr std::size_t kSavedBytes = NAME##_SAVED_BYTES; \
    static constexpr auto tables_size = NAME##_tables_size;        \
    static constexpr auto tables_create = NAME##_tables_create;    \
    static constexpr auto tables_discard = NAME##_tables_discard;  \
    static constexpr auto engine_size = NAME##_engine_size;        \
    static constexpr auto create = NAME##_create;                  \
    static constexpr auto discard = NAME##_discard;                \
    static constexpr auto reset = NAME##_reset;                    \
    static constexpr auto input_defaults = NAME##_input_defaults;  \
    static constexpr auto step = NAME##_step;                      \
    static constexpr auto read = NAME##_read;                      \
    static constexpr auto step_many = NAME##_step_many;            \
    static constexpr auto save = NAME##_save;                      \
    static constexpr auto load = NAME##_load;                      \
  }
CRANKLOOP_C_API(WholeFloat, crankloop_whole_f, float, Whole);
CRANKLOOP_C_API(WholeDouble, crankloop_whole_d, double, Whole);
CRANKLOOP_C_API(FreeFloat, crankloop_free_f, float, FreeRunning);
CRANKLOOP_C_API(FreeDouble, crankloop_free_d, double, FreeRunning);
#undef CRANKLOOP_C_API
using AllApis = ::testing::Types<WholeFloat, WholeDouble, FreeFloat, FreeDouble>;

struct ApiName {
  template <class Api>
  static std::string GetName(int) {
    return Api::kName;
  }
};

inline crankloop_status turn_at(crankloop_free_f_engine* engine, double speed_rad_s) {
  return crankloop_free_f_turn_at(engine, static_cast<float>(speed_rad_s));
}
inline crankloop_status turn_at(crankloop_free_d_engine* engine, double speed_rad_s) {
  return crankloop_free_d_turn_at(engine, speed_rad_s);
}

inline testing::AssertionResult answers(const crankloop_status& status, int reason, const char* field = "") {
  if (status.reason == reason && std::string(status.field) == field) return testing::AssertionSuccess();
  char text[120];
  crankloop_status_text(status, text, sizeof text);
  return testing::AssertionFailure() << "got \"" << text << "\", want " << field << " " << crankloop_describe(reason);
}
inline testing::AssertionResult ok(const crankloop_status& status) { return answers(status, CRANKLOOP_OK); }

/// The engine of c_interface/diesel_495.c, as C++ writes it; with friction, a starter and two trigger wheels.
inline ValveTrain train_495(double half_angle_deg, double full_lift_deg, double valve_kg) {
  ValveTrain train;
  train.cam.max_lift_m = 7.2e-3;
  train.cam.half_angle_deg = half_angle_deg;
  for (const double p : {2.0, 6.0, 10.0, 14.0}) train.cam.exponents[train.cam.exponent_count++] = p;
  train.cam.full_lift_deg = full_lift_deg;
  train.rocker.kind = RockerKind::ratio;
  train.rocker.ratio = 1.5;
  train.rocker.base_circle_m = 16e-3;
  train.rocker.clearance_m = 0.3e-3;
  train.valve.valve_kg = valve_kg;
  train.valve.spring_kg = 0.090;
  train.valve.spring_N_m = 25e3;
  train.valve.spring_preload_N = 320;
  train.valve.train_N_m = 7e6;
  train.valve.train_damping_ratio = 0.08;
  train.valve.guide_damping_ratio = 0.003;
  train.valve.seat_N_m = 5e7;
  train.valve.seat_damping_ratio = 0.1;
  return train;
}
inline EngineDefinition diesel_495() {
  EngineDefinition diesel;
  diesel.crank = {0.095, 0.0575, 0.210, 0, 19};
  diesel.masses.piston_kg = 0.810;
  diesel.masses.rod_small_end_kg = 0.505;
  diesel.masses.rod_big_end_kg = 1.382;
  diesel.masses.crank_inertia_kg_m2 = 0.5;
  const int order[] = {1, 3, 4, 2};
  EXPECT_TRUE(set_firing_order(order, 4, diesel.layout).ok());
  for (std::size_t k = 0; k < 4; ++k) diesel.layout.position_m[k] = 0.120 * static_cast<double>(k);
  diesel.pressure.source = PressureSource::wiebe;
  diesel.pressure.wiebe.net_mep_Pa = 809.7e3;
  diesel.train_count = 2;
  diesel.trains[0] = train_495(78, 466, 0.480);
  diesel.trains[1] = train_495(80, 266, 0.470);
  diesel.friction.constant_Pa = 90e3;
  diesel.machine.quadratic_Nm_s2 = 0.004;
  diesel.starter = {420, 40};
  static const double kHalfMoon_deg[] = {180, 540};
  diesel.trigger_count = 2;
  diesel.triggers[0].places = 60;
  diesel.triggers[0].gap_count = 1;
  diesel.triggers[0].gaps[0] = {58, 2};
  diesel.triggers[0].first_tooth_deg = 246;
  diesel.triggers[1].shaft = TriggerShaft::cam;
  diesel.triggers[1].pattern = TriggerPattern::edges;
  diesel.triggers[1].edges_deg = kHalfMoon_deg;
  diesel.triggers[1].edge_count = 2;
  return diesel;
}

/// Tables, engines and inputs of one C engine. Tables lie on the heap, zero as they must be.
template <class Api>
class CEngine : public ::testing::Test {
 protected:
  static std::unique_ptr<typename Api::Tables> new_tables(const EngineDefinition& definition) {
    auto tables = std::make_unique<typename Api::Tables>();
    const crankloop_definition c_definition = c::as_c(definition);
    const crankloop_options options = default_options();
    EXPECT_TRUE(ok(Api::tables_create(tables.get(), sizeof *tables, &c_definition, sizeof c_definition, &options,
                                      sizeof options)));
    return tables;
  }
  static std::unique_ptr<typename Api::Engine> new_engine(const typename Api::Tables& tables, std::uint64_t phase = 0) {
    auto engine = std::make_unique<typename Api::Engine>();
    EXPECT_TRUE(ok(Api::create(engine.get(), sizeof *engine, &tables, phase)));
    return engine;
  }
  static crankloop_options default_options() {
    crankloop_options options{};
    EXPECT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
    return options;
  }
  static typename Api::Input default_input() {
    typename Api::Input in;
    EXPECT_TRUE(ok(Api::input_defaults(&in, sizeof in)));
    return in;
  }
  /// What makes an engine turn: its speed, or the starter.
  static typename Api::Input turning_input(double speed_rad_s = 300) {
    typename Api::Input in = default_input();
    if constexpr (kSpeedGiven) {
      in.speed_rad_s = static_cast<typename Api::Real>(speed_rad_s);
    } else {
      in.starter = 1;
    }
    return in;
  }
  static typename Api::Output output(const typename Api::Engine& engine) {
    typename Api::Output out{};
    EXPECT_TRUE(ok(Api::read(&engine, &out, sizeof out)));
    return out;
  }
  static typename Api::Real torque(const typename Api::Engine& engine) { return output(engine).torque_Nm; }

  static constexpr bool kSpeedGiven = Api::Scene::crank == CrankGiven::speed;
};

}  // namespace crankloop::c_api

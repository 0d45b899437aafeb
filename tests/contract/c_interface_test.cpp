// The C interface does what the C++ engine does, bit for bit, refuses misuse with a status, and takes structs of older and newer versions.
#include <crankloop/crankloop.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <crankloop/crankloop.hpp>

#include "c/arguments.hpp"

namespace crankloop {
namespace {

using scenes::Whole;

/// The engine of c_interface/diesel_495.c, as C++ writes it.
ValveTrain train_495(double half_angle_deg, double full_lift_deg, double valve_kg) {
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
EngineDefinition diesel_495() {
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
  return diesel;
}

testing::AssertionResult answers(const crankloop_status& status, int reason, const char* field = "") {
  if (status.reason == reason && std::string(status.field) == field) return testing::AssertionSuccess();
  char text[120];
  crankloop_status_text(status, text, sizeof text);
  return testing::AssertionFailure() << "got \"" << text << "\", want " << field << " " << crankloop_describe(reason);
}
testing::AssertionResult ok(const crankloop_status& status) { return answers(status, CRANKLOOP_OK); }

/// The C names of one scalar.
struct InFloat {
  using Real = float;
  using Tables = crankloop_f_tables;
  using Engine = crankloop_f_engine;
  using Input = crankloop_f_input;
  using Torque = crankloop_f_torque;
  using Kinematics = crankloop_f_kinematics;
  using RodMotion = crankloop_f_rod_motion;
  using Forces = crankloop_f_forces;
  using BearingLoads = crankloop_f_bearing_loads;
  using FreeForces = crankloop_f_free_forces;
  using Valves = crankloop_f_valves;
  using ValveForces = crankloop_f_valve_forces;
  using ValveResults = crankloop_f_valve_results;
  using BadInputs = crankloop_f_bad_inputs;
  using Snapshot = crankloop_f_snapshot;
  static constexpr std::size_t kSavedBytes = CRANKLOOP_F_SAVED_BYTES;
  static constexpr auto tables_create = crankloop_f_tables_create;
  static constexpr auto tables_discard = crankloop_f_tables_discard;
  static constexpr auto engine_create = crankloop_f_engine_create;
  static constexpr auto engine_discard = crankloop_f_engine_discard;
  static constexpr auto engine_reset = crankloop_f_engine_reset;
  static constexpr auto input_defaults = crankloop_f_input_defaults;
  static constexpr auto step = crankloop_f_step;
  static constexpr auto phase = crankloop_f_phase;
  static constexpr auto read_torque = crankloop_f_read_torque;
  static constexpr auto read_kinematics = crankloop_f_read_kinematics;
  static constexpr auto read_rod_motion = crankloop_f_read_rod_motion;
  static constexpr auto read_forces = crankloop_f_read_forces;
  static constexpr auto read_bearing_loads = crankloop_f_read_bearing_loads;
  static constexpr auto read_free_forces = crankloop_f_read_free_forces;
  static constexpr auto read_valves = crankloop_f_read_valves;
  static constexpr auto read_valve_forces = crankloop_f_read_valve_forces;
  static constexpr auto read_valve_results = crankloop_f_read_valve_results;
  static constexpr auto read_bad_inputs = crankloop_f_read_bad_inputs;
  static constexpr auto take = crankloop_f_take;
  static constexpr auto restore = crankloop_f_restore;
  static constexpr auto save = crankloop_f_save;
  static constexpr auto load = crankloop_f_load;
};
struct InDouble {
  using Real = double;
  using Tables = crankloop_d_tables;
  using Engine = crankloop_d_engine;
  using Input = crankloop_d_input;
  using Torque = crankloop_d_torque;
  using Kinematics = crankloop_d_kinematics;
  using RodMotion = crankloop_d_rod_motion;
  using Forces = crankloop_d_forces;
  using BearingLoads = crankloop_d_bearing_loads;
  using FreeForces = crankloop_d_free_forces;
  using Valves = crankloop_d_valves;
  using ValveForces = crankloop_d_valve_forces;
  using ValveResults = crankloop_d_valve_results;
  using BadInputs = crankloop_d_bad_inputs;
  using Snapshot = crankloop_d_snapshot;
  static constexpr std::size_t kSavedBytes = CRANKLOOP_D_SAVED_BYTES;
  static constexpr auto tables_create = crankloop_d_tables_create;
  static constexpr auto tables_discard = crankloop_d_tables_discard;
  static constexpr auto engine_create = crankloop_d_engine_create;
  static constexpr auto engine_discard = crankloop_d_engine_discard;
  static constexpr auto engine_reset = crankloop_d_engine_reset;
  static constexpr auto input_defaults = crankloop_d_input_defaults;
  static constexpr auto step = crankloop_d_step;
  static constexpr auto phase = crankloop_d_phase;
  static constexpr auto read_torque = crankloop_d_read_torque;
  static constexpr auto read_kinematics = crankloop_d_read_kinematics;
  static constexpr auto read_rod_motion = crankloop_d_read_rod_motion;
  static constexpr auto read_forces = crankloop_d_read_forces;
  static constexpr auto read_bearing_loads = crankloop_d_read_bearing_loads;
  static constexpr auto read_free_forces = crankloop_d_read_free_forces;
  static constexpr auto read_valves = crankloop_d_read_valves;
  static constexpr auto read_valve_forces = crankloop_d_read_valve_forces;
  static constexpr auto read_valve_results = crankloop_d_read_valve_results;
  static constexpr auto read_bad_inputs = crankloop_d_read_bad_inputs;
  static constexpr auto take = crankloop_d_take;
  static constexpr auto restore = crankloop_d_restore;
  static constexpr auto save = crankloop_d_save;
  static constexpr auto load = crankloop_d_load;
};
template <class Api>
class CInterface : public ::testing::Test {
 protected:
  /// Tables on the heap, zero as they must be.
  static std::unique_ptr<typename Api::Tables> new_tables(const EngineDefinition& definition) {
    auto tables = std::make_unique<typename Api::Tables>();
    const crankloop_definition c_definition = c::as_c(definition);
    crankloop_options options{};
    EXPECT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
    EXPECT_TRUE(ok(Api::tables_create(tables.get(), sizeof *tables, &c_definition, sizeof c_definition, &options, sizeof options)));
    return tables;
  }
  static std::unique_ptr<typename Api::Engine> new_engine(const typename Api::Tables& tables, std::uint64_t phase = 0) {
    auto engine = std::make_unique<typename Api::Engine>();
    EXPECT_TRUE(ok(Api::engine_create(engine.get(), sizeof *engine, &tables, phase)));
    return engine;
  }
  static typename Api::Input at_speed(double speed_rad_s) {
    typename Api::Input in;
    EXPECT_TRUE(ok(Api::input_defaults(&in, sizeof in)));
    in.speed_rad_s = static_cast<typename Api::Real>(speed_rad_s);
    return in;
  }
  static typename Api::Real torque(const typename Api::Engine& engine) {
    typename Api::Torque out{};
    EXPECT_TRUE(ok(Api::read_torque(&engine, &out, sizeof out)));
    return out.torque_Nm;
  }
};
struct ApiName {
  template <class Api>
  static std::string GetName(int) {
    return sizeof(typename Api::Real) == 4 ? "Float" : "Double";
  }
};
using BothApis = ::testing::Types<InFloat, InDouble>;
TYPED_TEST_SUITE(CInterface, BothApis, ApiName);

template <class To, class From>
[[nodiscard]] bool same_bytes(const To& a, const From& b) {
  static_assert(sizeof a == sizeof b);
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Of valve forces what lies before the padding: in double four bytes stand behind `regime`, and nobody promises what they are.
template <class To, class From>
[[nodiscard]] bool same_valve_forces(const To& a, const From& b) {
  static_assert(sizeof a.valve_forces == sizeof b.valve_forces);
  bool same = true;
  for (int t = 0; t < kMaxTrains; ++t) {
    for (int k = 0; k < kMaxCylinders; ++k) {
      const auto& one = a.valve_forces[t][k];
      const auto& other = b.valve_forces[t][k];
      same = same && std::memcmp(&one, &other, offsetof(std::decay_t<decltype(one)>, regime)) == 0 && one.regime == other.regime;
    }
  }
  return same;
}

TYPED_TEST(CInterface, GivesEveryGroupAsTheCppEngineDoes) {
  using Api = TypeParam;
  using Real = typename Api::Real;
  EngineDefinition definition = diesel_495();
  definition.trains[0].cam.phase_rate_deg_s = 200;
  definition.masses.rod_inertia_correction_kg_m2 = -0.004;
  const auto tables = this->new_tables(definition);
  const auto engine = this->new_engine(*tables, 1234567);
  auto storage = std::make_unique<TableStorage<Real, Whole>>();
  ASSERT_TRUE(storage->build(definition, {}).ok());
  auto cpp = std::make_unique<Engine<Real, Whole>>();
  ASSERT_TRUE(cpp->init(storage->tables(), Phase{1234567}).ok());
  for (int tick = 0; tick < 1500; ++tick) {
    typename Api::Input in = this->at_speed(400 - tick * 0.5);
    in.load_ratio = static_cast<Real>(tick % 7) / 5;
    in.cam_phase_deg[0] = Real{-20};
    if (tick == 100) in.speed_rad_s = static_cast<Real>(1e9);
    Input<Real, Whole> cpp_in;
    cpp_in.speed_rad_s = in.speed_rad_s;
    cpp_in.load_ratio = in.load_ratio;
    cpp_in.cam_phase_deg[0] = in.cam_phase_deg[0];
    const auto& out = cpp->step(cpp_in);
    ASSERT_EQ(Api::step(engine.get(), &in, sizeof in), out.faults);
    ASSERT_EQ(Api::phase(engine.get()), cpp->state().phase.units());
    typename Api::Torque torque;
    typename Api::Kinematics kinematics;
    typename Api::RodMotion rod_motion;
    typename Api::Forces forces;
    typename Api::BearingLoads bearing_loads;
    typename Api::FreeForces free_forces;
    typename Api::Valves valves;
    typename Api::ValveForces valve_forces;
    typename Api::ValveResults valve_results;
    ASSERT_TRUE(ok(Api::read_torque(engine.get(), &torque, sizeof torque)));
    ASSERT_TRUE(ok(Api::read_kinematics(engine.get(), &kinematics, sizeof kinematics)));
    ASSERT_TRUE(ok(Api::read_rod_motion(engine.get(), &rod_motion, sizeof rod_motion)));
    ASSERT_TRUE(ok(Api::read_forces(engine.get(), &forces, sizeof forces)));
    ASSERT_TRUE(ok(Api::read_bearing_loads(engine.get(), &bearing_loads, sizeof bearing_loads)));
    ASSERT_TRUE(ok(Api::read_free_forces(engine.get(), &free_forces, sizeof free_forces)));
    ASSERT_TRUE(ok(Api::read_valves(engine.get(), &valves, sizeof valves)));
    ASSERT_TRUE(ok(Api::read_valve_forces(engine.get(), &valve_forces, sizeof valve_forces)));
    ASSERT_TRUE(ok(Api::read_valve_results(engine.get(), &valve_results, sizeof valve_results)));
    ASSERT_TRUE(same_bytes(torque.torque_Nm, out.torque_Nm) && same_bytes(torque.mean_torque_Nm, out.mean_torque_Nm)) << tick;
    ASSERT_TRUE(same_bytes(kinematics, static_cast<const Kinematics<Real, Whole>&>(out))) << tick;
    ASSERT_TRUE(same_bytes(rod_motion, static_cast<const RodMotion<Real, Whole>&>(out))) << tick;
    ASSERT_TRUE(same_bytes(forces, static_cast<const Forces<Real, Whole>&>(out))) << tick;
    ASSERT_TRUE(same_bytes(bearing_loads, static_cast<const BearingLoads<Real, Whole>&>(out))) << tick;
    ASSERT_TRUE(same_bytes(free_forces, static_cast<const FreeForces<Real>&>(out))) << tick;
    ASSERT_TRUE(same_bytes(valves, static_cast<const Valves<Real, Whole>&>(out))) << tick;
    ASSERT_TRUE(same_valve_forces(valve_forces, out)) << tick;
    ASSERT_TRUE(same_bytes(valve_results, static_cast<const ValveResults<Real, Whole>&>(out))) << tick;
    // By name, in case both sides have the same bytes in another order.
    ASSERT_EQ(kinematics.acceleration_m_s2[3], out.acceleration_m_s2[3]);
    ASSERT_EQ(forces.cylinder[1].tilting_moment_Nm, out.cylinder[1].tilting_moment_Nm);
    ASSERT_EQ(bearing_loads.journal_load_N[4], out.journal_load_N[4]);
    ASSERT_EQ(free_forces.second.up_N, out.second.up_N);
    ASSERT_EQ(valves.valve[1][2].lift_m, out.valve[1][2].lift_m);
    ASSERT_EQ(valve_forces.valve_forces[1][2].regime, out.valve_forces[1][2].regime);
    ASSERT_EQ(valve_results.valve_cycle[0][3].seating_speed_m_s, out.valve_cycle[0][3].seating_speed_m_s);
  }
}

TEST(CProgram, InC99PrintsTheTorqueOfTheCppEngineBitForBit) {
  std::FILE* program = popen("'" CRANKLOOP_C_PROGRAM "'", "r");
  ASSERT_NE(program, nullptr);
  auto float_tables = std::make_unique<TableStorage<float, Whole>>();
  auto double_tables = std::make_unique<TableStorage<double, Whole>>();
  ASSERT_TRUE(float_tables->build(diesel_495(), {}).ok());
  ASSERT_TRUE(double_tables->build(diesel_495(), {}).ok());
  auto in_float = std::make_unique<Engine<float, Whole>>();
  auto in_double = std::make_unique<Engine<double, Whole>>();
  ASSERT_TRUE(in_float->init(float_tables->tables()).ok());
  ASSERT_TRUE(in_double->init(double_tables->tables()).ok());
  int ticks = 0;
  for (double read[4]; std::fscanf(program, "%la %la %la %la", &read[0], &read[1], &read[2], &read[3]) == 4; ++ticks) {
    Input<float, Whole> float_in;
    Input<double, Whole> double_in;
    float_in.speed_rad_s = 209.5F;
    double_in.speed_rad_s = 209.5;
    const auto& f = in_float->step(float_in);
    const auto& d = in_double->step(double_in);
    const double expected[] = {static_cast<double>(f.torque_Nm), static_cast<double>(f.mean_torque_Nm), d.torque_Nm, d.mean_torque_Nm};
    for (int i = 0; i < 4; ++i) ASSERT_EQ(read[i], expected[i]) << "tick " << ticks;
  }
  EXPECT_EQ(pclose(program), 0);
  EXPECT_EQ(ticks, 600);
}

// ---- definitions -----------------------------------------------------------------------------------------------------------------

/// Of the bytes of a default object, those whose change `shows` does not see: padding.
template <class T, class Shows>
int blind_bytes(const T& object, const Shows& shows) {
  int blind = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    T changed;
    std::memcpy(&changed, &object, sizeof changed);
    reinterpret_cast<unsigned char*>(&changed)[i] ^= 1u;
    if (!shows(changed)) ++blind;
  }
  return blind;
}

constexpr bool kUsual64Bits = sizeof(void*) == 8 && alignof(double) == 8;

TEST(CDefinition, PassesEveryFieldOnToCpp) {
  const crankloop_definition usual = c::as_c(EngineDefinition{});
  const int blind = blind_bytes(usual, [&](const crankloop_definition& changed) {
    EngineDefinition cpp;
    if (!c::from_c(changed, cpp).ok()) return true;
    const crankloop_definition back = c::as_c(cpp);
    return std::memcmp(&back, &usual, sizeof back) != 0;
  });
  // Behind cylinders, heat_given, train_count and in each train behind point_count and per_cylinder: 4 bytes.
  if (kUsual64Bits) {
    EXPECT_EQ(blind, 4 + 4 + 4 + CRANKLOOP_MOST_TRAINS * (4 + 4));
  }
}

TEST(CDefinition, KeepsItsLayoutWhereAFiringOrderIsRefusedAndGrowsWithoutHarmToOlderPrograms) {
  crankloop_definition definition;
  ASSERT_TRUE(ok(crankloop_definition_defaults(&definition, sizeof definition)));
  const std::int32_t twice[] = {1, 1};
  EXPECT_TRUE(answers(crankloop_set_firing_order(&definition, sizeof definition, twice, 2), CRANKLOOP_NOT_A_PERMUTATION, "layout.firing_order"));
  const std::int32_t too_many[kMaxCylinders + 1] = {1, 2, 3};
  EXPECT_FALSE(ok(crankloop_set_firing_order(&definition, sizeof definition, too_many, kMaxCylinders + 1)));
  EXPECT_EQ(definition.layout.cylinders, 1);
  // A program whose struct ends behind the layout.
  const std::int32_t order[] = {2, 1};
  definition.pressure.crankcase_Pa = -77;
  ASSERT_TRUE(ok(crankloop_set_firing_order(&definition, offsetof(crankloop_definition, pressure), order, 2)));
  EXPECT_EQ(definition.layout.cylinders, 2);
  EXPECT_EQ(definition.pressure.crankcase_Pa, -77) << "not written";
  const std::int32_t three[] = {1, 3, 2};
  ASSERT_TRUE(ok(crankloop_set_firing_order(&definition, sizeof definition, three, 3)));
  EXPECT_EQ(definition.layout.cylinders, 3);
  EXPECT_EQ(definition.pressure.crankcase_Pa, -77) << "as it was";
}

TEST(CDefinition, NamesTheFirstOfTwoNumbersThatNameNoEnumerator) {
  crankloop_definition definition;
  ASSERT_TRUE(ok(crankloop_definition_defaults(&definition, sizeof definition)));
  definition.pressure.source = 99;
  definition.trains[0].cam.source = -1;
  crankloop_options options;
  ASSERT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
  const auto tables = std::make_unique<crankloop_f_tables>();
  EXPECT_TRUE(answers(crankloop_f_tables_create(tables.get(), sizeof *tables, &definition, sizeof definition, &options, sizeof options),
                      CRANKLOOP_OUT_OF_RANGE, "pressure.source"));
}

TEST(CDefinition, HasTheDefaultsOfCpp) {
  crankloop_definition definition;
  std::memset(&definition, 0xEE, sizeof definition);
  ASSERT_TRUE(ok(crankloop_definition_defaults(&definition, sizeof definition)));
  EXPECT_EQ(definition.layout.cylinders, 1);
  EXPECT_EQ(definition.layout.pin[15], 15);
  EXPECT_EQ(definition.pressure.source, CRANKLOOP_PRESSURE_NONE);
  EXPECT_EQ(definition.pressure.wiebe.compression_exponent, WiebeDiagram{}.compression_exponent);
  EXPECT_EQ(definition.trains[3].rocker.ratio, 1);
  EXPECT_EQ(definition.pressure.points, nullptr);
  crankloop_options options;
  std::memset(&options, 0xEE, sizeof options);
  ASSERT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
  EXPECT_EQ(options.tick_s, TickOptions{}.tick_s);
  EXPECT_EQ(options.valve_accuracy_m, ValveStepping{}.accuracy_m);
}

TYPED_TEST(CInterface, RefusesABadDefinitionWithTheFieldToBlame) {
  using Api = TypeParam;
  auto tables = std::make_unique<typename Api::Tables>();
  crankloop_options options;
  ASSERT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
  const auto create = [&](const crankloop_definition& d) {
    return Api::tables_create(tables.get(), sizeof *tables, &d, sizeof d, &options, sizeof options);
  };
  const crankloop_definition good = c::as_c(diesel_495());
  crankloop_definition bad = good;
  bad.crank.rod_length_m = 0.05;
  EXPECT_TRUE(answers(create(bad), CRANKLOOP_ROD_TOO_SHORT, "crank.rod_length"));
  bad = good;
  bad.layout.firing_deg[2] = 720;
  const crankloop_status status = create(bad);
  EXPECT_TRUE(answers(status, CRANKLOOP_OUT_OF_RANGE, "layout.firing_angles"));
  EXPECT_EQ(status.index, 2);
  // Enumerators that C++ does not have.
  for (const int source : {-1, 4, 256 + CRANKLOOP_PRESSURE_WIEBE}) {
    bad = good;
    bad.pressure.source = source;
    EXPECT_TRUE(answers(create(bad), CRANKLOOP_OUT_OF_RANGE, "pressure.source")) << source;
  }
  bad = good;
  std::vector<crankloop_diagram_point> far;
  for (int deg = 0; deg < 720; deg += 10) far.push_back({1e12 + deg, 1e5});
  bad.pressure.source = CRANKLOOP_PRESSURE_ANGLE_TABLE;
  bad.pressure.points = far.data();
  bad.pressure.point_count = static_cast<std::int32_t>(far.size());
  EXPECT_TRUE(answers(create(bad), CRANKLOOP_OUT_OF_RANGE, "pressure.file"));
  bad = good;
  bad.pressure.source = CRANKLOOP_PRESSURE_WIEBE;
  bad.pressure.wiebe.heat_given = 1;
  bad.pressure.wiebe.heat_J = 1e9;
  EXPECT_TRUE(answers(create(bad), CRANKLOOP_PRESSURE_TOO_HIGH, "pressure.heat"));
  bad = good;
  bad.trains[1].rocker.kind = 2;
  EXPECT_TRUE(answers(create(bad), CRANKLOOP_OUT_OF_RANGE, "rocker.kind"));
  options.valve_integrator = 2;
  EXPECT_TRUE(answers(create(good), CRANKLOOP_OUT_OF_RANGE, "tick.integrator"));
  ASSERT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
  // After all that, the same memory is good for good tables.
  EXPECT_TRUE(ok(create(good)));
}

TYPED_TEST(CInterface, ReadsNoRowsThatNoSourceUses) {
  using Api = TypeParam;
  crankloop_definition definition = c::as_c(diesel_495());
  definition.pressure.source = CRANKLOOP_PRESSURE_NONE;
  definition.pressure.point_count = 8;  // and no rows
  definition.trains[0].cam.point_count = 8;
  auto tables = std::make_unique<typename Api::Tables>();
  crankloop_options options;
  ASSERT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
  EXPECT_TRUE(ok(Api::tables_create(tables.get(), sizeof *tables, &definition, sizeof definition, &options, sizeof options)));
}

TYPED_TEST(CInterface, ReadsRowsOfADiagramAndOfACam) {
  using Api = TypeParam;
  std::vector<crankloop_diagram_point> rows;
  for (int deg = 0; deg < 720; deg += 10) rows.push_back({1.0 * deg, 1e5 + (deg < 180 ? 180.0 - deg : deg > 540 ? deg - 540.0 : 0.0) * 2e4});
  std::vector<crankloop_cam_point> cam;
  for (int deg = -60; deg <= 60; deg += 2) cam.push_back({1.0 * deg, 2.5e-3 * (1 - deg * deg / 3600.0) * (1 - deg * deg / 3600.0) * (1 - deg * deg / 3600.0)});
  crankloop_definition definition = c::as_c(diesel_495());
  definition.pressure.source = CRANKLOOP_PRESSURE_ANGLE_TABLE;
  definition.pressure.points = rows.data();
  definition.pressure.point_count = static_cast<std::int32_t>(rows.size());
  definition.trains[0].cam.source = CRANKLOOP_CAM_TABLE;
  definition.trains[0].cam.points = cam.data();
  definition.trains[0].cam.point_count = static_cast<std::int32_t>(cam.size());
  definition.trains[0].cam.smoothing_m = 2e-6;
  auto tables = std::make_unique<typename Api::Tables>();
  crankloop_options options;
  ASSERT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
  ASSERT_TRUE(ok(Api::tables_create(tables.get(), sizeof *tables, &definition, sizeof definition, &options, sizeof options)));
  const auto engine = this->new_engine(*tables);
  const auto in = this->at_speed(0);
  ASSERT_EQ(Api::step(engine.get(), &in, sizeof in), 0u);
  typename Api::Forces forces;
  ASSERT_TRUE(ok(Api::read_forces(engine.get(), &forces, sizeof forces)));
  EXPECT_NEAR(static_cast<double>(forces.cylinder[0].pressure_Pa), 1e5 + 180 * 2e4, 100);  // the row at 0 deg; 1e-5 of the peak, float
}

// ---- structs of other versions ----------------------------------------------------------------------------------------------------

TYPED_TEST(CInterface, TakesStructsOfOlderProgramsWithDefaultsForWhatTheyLack) {
  using Api = TypeParam;
  using Real = typename Api::Real;
  const auto tables = this->new_tables(diesel_495());
  const auto older = this->new_engine(*tables);
  const auto today = this->new_engine(*tables);
  auto in = this->at_speed(200);
  auto only_speed = in;
  only_speed.load_ratio = Real{-7};  // beyond the older program's struct: not read
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(Api::step(older.get(), &only_speed, sizeof only_speed.speed_rad_s), 0u);
    ASSERT_EQ(Api::step(today.get(), &in, sizeof in), 0u);
  }
  EXPECT_EQ(this->torque(*older), this->torque(*today));

  // A definition that ends before the valve trains has none.
  crankloop_definition definition = c::as_c(diesel_495());
  auto without = std::make_unique<typename Api::Tables>();
  crankloop_options options;
  ASSERT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
  options.valve_integrator = 99;  // beyond what is passed, too
  ASSERT_TRUE(ok(Api::tables_create(without.get(), sizeof *without, &definition, offsetof(crankloop_definition, train_count), &options, sizeof options.tick_s)));
  const auto engine = this->new_engine(*without);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(Api::step(engine.get(), &in, sizeof in), 0u);
  EXPECT_EQ(this->torque(*engine), this->torque(*today));
  typename Api::Valves valves;
  ASSERT_TRUE(ok(Api::read_valves(engine.get(), &valves, sizeof valves)));
  for (const auto& train : valves.valve) {
    for (const auto& valve : train) EXPECT_EQ(valve.theoretical_lift_m, Real{0});
  }
}

TYPED_TEST(CInterface, WritesNoMoreThanAnOlderProgramsStructHasRoomFor) {
  using Api = TypeParam;
  using Real = typename Api::Real;
  const auto tables = this->new_tables(diesel_495());
  const auto engine = this->new_engine(*tables);
  const auto in = this->at_speed(200);
  for (int i = 0; i < 30; ++i) Api::step(engine.get(), &in, sizeof in);
  typename Api::Torque both;
  ASSERT_TRUE(ok(Api::read_torque(engine.get(), &both, sizeof both)));
  typename Api::Torque older{Real{-1}, Real{-2}};
  ASSERT_TRUE(ok(Api::read_torque(engine.get(), &older, sizeof older.torque_Nm)));
  EXPECT_EQ(older.torque_Nm, both.torque_Nm);
  EXPECT_EQ(older.mean_torque_Nm, Real{-2});
}

TYPED_TEST(CInterface, TakesStructsOfNewerProgramsThatDoNotUseWhatIsNew) {
  using Api = TypeParam;
  using Real = typename Api::Real;
  const auto tables = this->new_tables(diesel_495());
  const auto engine = this->new_engine(*tables);
  struct NewerInput {
    typename Api::Input known;
    Real unknown;
  } in{this->at_speed(200), Real{0}};
  EXPECT_EQ(Api::step(engine.get(), &in.known, sizeof in), 0u);
  in.unknown = Real{1};
  const std::uint64_t before = Api::phase(engine.get());
  EXPECT_EQ(Api::step(engine.get(), &in.known, sizeof in), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});
  EXPECT_EQ(Api::phase(engine.get()), before);
  struct NewerTorque {
    typename Api::Torque known;
    Real unknown;
  } out{{}, Real{5}};
  ASSERT_TRUE(ok(Api::read_torque(engine.get(), &out.known, sizeof out)));
  EXPECT_EQ(out.known.torque_Nm, this->torque(*engine));
  EXPECT_EQ(out.unknown, Real{0});

  struct NewerDefinition {
    crankloop_definition known;
    double unknown;
  } definition{c::as_c(diesel_495()), 1};
  crankloop_options options;
  ASSERT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
  auto more = std::make_unique<typename Api::Tables>();
  EXPECT_TRUE(answers(Api::tables_create(more.get(), sizeof *more, &definition.known, sizeof definition, &options, sizeof options),
                      CRANKLOOP_WRONG_SIZE, "definition"));
}

// ---- misuse -----------------------------------------------------------------------------------------------------------------------

TYPED_TEST(CInterface, RefusesMisuseWithAStatus) {
  using Api = TypeParam;
  const crankloop_definition definition = c::as_c(diesel_495());
  crankloop_options options;
  ASSERT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
  const auto create = [&](typename Api::Tables* tables, std::size_t size) {
    return Api::tables_create(tables, size, &definition, sizeof definition, &options, sizeof options);
  };
  auto tables = std::make_unique<typename Api::Tables>();
  auto engine = std::make_unique<typename Api::Engine>();
  auto in = this->at_speed(100);
  typename Api::Torque out;
  typename Api::Snapshot snapshot;

  // Null.
  EXPECT_TRUE(answers(create(nullptr, sizeof *tables), CRANKLOOP_NULL_POINTER, "tables"));
  EXPECT_TRUE(answers(Api::tables_create(tables.get(), sizeof *tables, nullptr, sizeof definition, &options, sizeof options), CRANKLOOP_NULL_POINTER, "definition"));
  EXPECT_TRUE(answers(Api::tables_create(tables.get(), sizeof *tables, &definition, sizeof definition, nullptr, 0), CRANKLOOP_NULL_POINTER, "options"));
  EXPECT_TRUE(answers(Api::engine_create(engine.get(), sizeof *engine, nullptr, 0), CRANKLOOP_NULL_POINTER, "tables"));
  EXPECT_TRUE(answers(Api::read_torque(nullptr, &out, sizeof out), CRANKLOOP_NULL_POINTER, "engine"));
  EXPECT_TRUE(answers(Api::input_defaults(nullptr, sizeof in), CRANKLOOP_NULL_POINTER, "out"));
  EXPECT_TRUE(answers(crankloop_set_firing_order(nullptr, 0, nullptr, 4), CRANKLOOP_NULL_POINTER, "order"));
  const std::int32_t order[] = {1, 3, 4, 2};
  EXPECT_TRUE(answers(crankloop_set_firing_order(nullptr, 0, order, 4), CRANKLOOP_NULL_POINTER, "definition"));
  EXPECT_EQ(Api::step(nullptr, &in, sizeof in), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});
  EXPECT_EQ(Api::phase(nullptr), 0u);

  // Not created.
  EXPECT_TRUE(answers(Api::engine_create(engine.get(), sizeof *engine, tables.get(), 0), CRANKLOOP_NOT_CREATED, "tables"));
  EXPECT_TRUE(answers(Api::tables_discard(tables.get()), CRANKLOOP_NOT_CREATED, "tables"));
  EXPECT_TRUE(answers(Api::engine_reset(engine.get(), 0), CRANKLOOP_NOT_CREATED, "engine"));
  EXPECT_TRUE(answers(Api::take(engine.get(), &snapshot, sizeof snapshot), CRANKLOOP_NOT_CREATED, "engine"));
  EXPECT_TRUE(answers(Api::restore(engine.get(), &snapshot, sizeof snapshot), CRANKLOOP_NOT_CREATED, "engine"));
  std::vector<unsigned char> saved(Api::kSavedBytes);
  EXPECT_TRUE(answers(Api::save(engine.get(), saved.data(), saved.size()), CRANKLOOP_NOT_CREATED, "engine"));
  EXPECT_TRUE(answers(Api::load(engine.get(), saved.data(), saved.size()), CRANKLOOP_NOT_CREATED, "engine"));
  EXPECT_TRUE(answers(Api::engine_discard(engine.get()), CRANKLOOP_NOT_CREATED, "engine"));
  typename Api::Kinematics kinematics;
  EXPECT_TRUE(answers(Api::read_kinematics(engine.get(), &kinematics, sizeof kinematics), CRANKLOOP_NOT_CREATED, "engine"));
  EXPECT_EQ(Api::step(engine.get(), &in, sizeof in), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});

  // Too small, not aligned.
  EXPECT_TRUE(answers(create(tables.get(), 1000), CRANKLOOP_WRONG_SIZE, "tables"));
  auto bytes = std::make_unique<unsigned char[]>(sizeof(typename Api::Tables) + 8);
  EXPECT_TRUE(answers(create(reinterpret_cast<typename Api::Tables*>(bytes.get() + 4), sizeof *tables), CRANKLOOP_MISALIGNED, "tables"));
  EXPECT_TRUE(answers(Api::tables_discard(reinterpret_cast<typename Api::Tables*>(bytes.get() + 4)), CRANKLOOP_MISALIGNED, "tables"));
  ASSERT_TRUE(ok(create(tables.get(), sizeof *tables)));
  EXPECT_TRUE(answers(Api::engine_create(engine.get(), 100, tables.get(), 0), CRANKLOOP_WRONG_SIZE, "engine"));

  // Twice.
  EXPECT_TRUE(answers(create(tables.get(), sizeof *tables), CRANKLOOP_ALREADY_CREATED, "tables"));
  ASSERT_TRUE(ok(Api::engine_create(engine.get(), sizeof *engine, tables.get(), 0)));
  EXPECT_TRUE(answers(Api::engine_create(engine.get(), sizeof *engine, tables.get(), 0), CRANKLOOP_ALREADY_CREATED, "engine"));

  // With an engine: null again, too little room.
  EXPECT_EQ(Api::step(engine.get(), nullptr, 0), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});
  EXPECT_TRUE(answers(Api::read_torque(engine.get(), nullptr, sizeof out), CRANKLOOP_NULL_POINTER, "out"));
  EXPECT_TRUE(answers(Api::take(engine.get(), nullptr, sizeof snapshot), CRANKLOOP_NULL_POINTER, "snapshot"));
  EXPECT_TRUE(answers(Api::take(engine.get(), &snapshot, 16), CRANKLOOP_WRONG_SIZE, "snapshot"));
  EXPECT_TRUE(answers(Api::restore(engine.get(), &snapshot, 16), CRANKLOOP_WRONG_SIZE, "snapshot"));
  EXPECT_TRUE(answers(Api::restore(engine.get(), nullptr, sizeof snapshot), CRANKLOOP_NULL_POINTER, "snapshot"));
  EXPECT_TRUE(answers(Api::save(engine.get(), bytes.get(), Api::kSavedBytes - 1), CRANKLOOP_WRONG_SIZE, "state.size"));
  EXPECT_TRUE(answers(Api::load(engine.get(), nullptr, Api::kSavedBytes), CRANKLOOP_NULL_POINTER, "bytes"));
  std::memset(&snapshot, 0, sizeof snapshot);
  EXPECT_TRUE(answers(Api::restore(engine.get(), &snapshot, sizeof snapshot), CRANKLOOP_OTHER_TABLES, "state.fingerprint"));

  // The tables are taken away, and others put in their place.
  ASSERT_TRUE(ok(Api::tables_discard(tables.get())));
  EXPECT_EQ(Api::step(engine.get(), &in, sizeof in), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});
  EXPECT_TRUE(answers(Api::read_torque(engine.get(), &out, sizeof out), CRANKLOOP_NOT_CREATED, "tables"));
  options.tick_s = 50e-6;
  ASSERT_TRUE(ok(create(tables.get(), sizeof *tables)));
  EXPECT_EQ(Api::step(engine.get(), &in, sizeof in), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});
  EXPECT_TRUE(answers(Api::read_torque(engine.get(), &out, sizeof out), CRANKLOOP_OTHER_TABLES, "tables"));
  ASSERT_TRUE(ok(Api::engine_reset(engine.get(), 0)));
  EXPECT_EQ(Api::step(engine.get(), &in, sizeof in), 0u);
  ASSERT_TRUE(ok(Api::engine_discard(engine.get())));
  EXPECT_EQ(Api::step(engine.get(), &in, sizeof in), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});
}

/// Every call with each of its pointers null in turn, whatever room it is said to have.
TYPED_TEST(CInterface, WritesNothingThroughANullPointer) {
  using Api = TypeParam;
  constexpr std::size_t kRoom = 1 << 20;
  const auto tables = this->new_tables(diesel_495());
  const auto engine = this->new_engine(*tables);
  const auto in = this->at_speed(100);
  ASSERT_EQ(Api::step(engine.get(), &in, sizeof in), 0u);
  const auto is_null = [](const crankloop_status& status) { return status.reason == CRANKLOOP_NULL_POINTER; };
  EXPECT_TRUE(is_null(crankloop_definition_defaults(nullptr, kRoom)));
  EXPECT_TRUE(is_null(crankloop_options_defaults(nullptr, kRoom)));
  EXPECT_TRUE(is_null(crankloop_set_firing_order(nullptr, kRoom, nullptr, 4)));
  EXPECT_TRUE(is_null(crankloop_share_pins_by_position(nullptr, kRoom)));
  crankloop_definition definition;
  ASSERT_TRUE(ok(crankloop_definition_defaults(&definition, sizeof definition)));
  EXPECT_TRUE(is_null(crankloop_set_firing_order(&definition, sizeof definition, nullptr, 4)));

  crankloop_options options;
  ASSERT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
  auto free_tables = std::make_unique<typename Api::Tables>();
  auto free_engine = std::make_unique<typename Api::Engine>();
  EXPECT_TRUE(is_null(Api::tables_create(nullptr, kRoom, &definition, sizeof definition, &options, sizeof options)));
  EXPECT_TRUE(is_null(Api::tables_create(free_tables.get(), sizeof *free_tables, nullptr, kRoom, &options, sizeof options)));
  EXPECT_TRUE(is_null(Api::tables_create(free_tables.get(), sizeof *free_tables, &definition, sizeof definition, nullptr, kRoom)));
  EXPECT_TRUE(is_null(Api::tables_discard(nullptr)));
  EXPECT_TRUE(is_null(Api::engine_create(nullptr, kRoom, tables.get(), 0)));
  EXPECT_TRUE(is_null(Api::engine_create(free_engine.get(), sizeof *free_engine, nullptr, 0)));
  EXPECT_TRUE(is_null(Api::engine_discard(nullptr)));
  EXPECT_TRUE(is_null(Api::engine_reset(nullptr, 0)));
  EXPECT_TRUE(is_null(Api::input_defaults(nullptr, kRoom)));
  EXPECT_EQ(Api::step(nullptr, &in, sizeof in), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});
  EXPECT_EQ(Api::step(engine.get(), nullptr, kRoom), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});
  EXPECT_EQ(Api::phase(nullptr), 0u);

  const auto reads = [&](auto read, auto* none) {
    std::remove_pointer_t<decltype(none)> out;
    EXPECT_TRUE(is_null(read(nullptr, &out, sizeof out)));
    EXPECT_TRUE(is_null(read(engine.get(), none, kRoom)));
  };
  reads(Api::read_torque, static_cast<typename Api::Torque*>(nullptr));
  reads(Api::read_kinematics, static_cast<typename Api::Kinematics*>(nullptr));
  reads(Api::read_rod_motion, static_cast<typename Api::RodMotion*>(nullptr));
  reads(Api::read_forces, static_cast<typename Api::Forces*>(nullptr));
  reads(Api::read_bearing_loads, static_cast<typename Api::BearingLoads*>(nullptr));
  reads(Api::read_free_forces, static_cast<typename Api::FreeForces*>(nullptr));
  reads(Api::read_valves, static_cast<typename Api::Valves*>(nullptr));
  reads(Api::read_valve_forces, static_cast<typename Api::ValveForces*>(nullptr));
  reads(Api::read_valve_results, static_cast<typename Api::ValveResults*>(nullptr));
  reads(Api::read_bad_inputs, static_cast<typename Api::BadInputs*>(nullptr));

  typename Api::Snapshot snapshot;
  std::vector<unsigned char> bytes(Api::kSavedBytes);
  EXPECT_TRUE(is_null(Api::take(nullptr, &snapshot, sizeof snapshot)));
  EXPECT_TRUE(is_null(Api::take(engine.get(), nullptr, kRoom)));
  EXPECT_TRUE(is_null(Api::restore(nullptr, &snapshot, sizeof snapshot)));
  EXPECT_TRUE(is_null(Api::restore(engine.get(), nullptr, kRoom)));
  EXPECT_TRUE(is_null(Api::save(nullptr, bytes.data(), bytes.size())));
  EXPECT_TRUE(is_null(Api::save(engine.get(), nullptr, kRoom)));
  EXPECT_TRUE(is_null(Api::load(nullptr, bytes.data(), bytes.size())));
  EXPECT_TRUE(is_null(Api::load(engine.get(), nullptr, Api::kSavedBytes)));
  EXPECT_EQ(Api::step(engine.get(), &in, sizeof in), 0u) << "and the engine goes on";
}

TYPED_TEST(CInterface, RefusesASnapshotThatIsNotAligned) {
  using Api = TypeParam;
  const auto tables = this->new_tables(diesel_495());
  const auto engine = this->new_engine(*tables);
  auto bytes = std::make_unique<unsigned char[]>(sizeof(typename Api::Snapshot) + 8);
  auto* askew = reinterpret_cast<typename Api::Snapshot*>(bytes.get() + 4);
  EXPECT_TRUE(answers(Api::take(engine.get(), askew, sizeof *askew), CRANKLOOP_MISALIGNED, "snapshot"));
  EXPECT_TRUE(answers(Api::restore(engine.get(), askew, sizeof *askew), CRANKLOOP_MISALIGNED, "snapshot"));
}

// ---- state ------------------------------------------------------------------------------------------------------------------------

TYPED_TEST(CInterface, CountsTicksWithBadInputs) {
  using Api = TypeParam;
  const auto tables = this->new_tables(diesel_495());
  const auto engine = this->new_engine(*tables);
  typename Api::BadInputs bad{};
  for (const bool again : {false, true}) {
    for (const double speed : {300.0, 1e9, 300.0, -1e9}) {
      const auto in = this->at_speed(speed);
      Api::step(engine.get(), &in, sizeof in);
    }
    auto in = this->at_speed(300);
    in.load_ratio = 3;
    Api::step(engine.get(), &in, sizeof in);
    ASSERT_TRUE(ok(Api::read_bad_inputs(engine.get(), &bad, sizeof bad)));
    EXPECT_EQ(bad.ticks, 3u);
    EXPECT_EQ(bad.kinds, std::uint32_t{CRANKLOOP_FAULT_SPEED | CRANKLOOP_FAULT_LOAD_RATIO});
    if (again) continue;
    ASSERT_TRUE(ok(Api::engine_reset(engine.get(), 0)));
    ASSERT_TRUE(ok(Api::read_bad_inputs(engine.get(), &bad, sizeof bad)));
    EXPECT_EQ(bad.ticks | bad.kinds, 0u);
  }
  EXPECT_TRUE(answers(Api::read_bad_inputs(nullptr, &bad, sizeof bad), CRANKLOOP_NULL_POINTER, "engine"));
}

TYPED_TEST(CInterface, RunsSideBySideAndGoesOnFromSnapshotsAndBytesWithTheSameBits) {
  using Api = TypeParam;
  const auto tables = this->new_tables(diesel_495());
  const auto one = this->new_engine(*tables);
  const auto other = this->new_engine(*tables, 99);
  const auto third = this->new_engine(*tables, 77);
  auto in = this->at_speed(300);
  for (int i = 0; i < 123; ++i) {
    Api::step(one.get(), &in, sizeof in);
    if (i % 3 == 0) Api::step(other.get(), &in, sizeof in);
  }
  typename Api::Snapshot snapshot;
  std::vector<unsigned char> bytes(Api::kSavedBytes);
  ASSERT_TRUE(ok(Api::take(one.get(), &snapshot, sizeof snapshot)));
  ASSERT_TRUE(ok(Api::save(one.get(), bytes.data(), bytes.size())));
  ASSERT_TRUE(ok(Api::restore(other.get(), &snapshot, sizeof snapshot)));
  ASSERT_TRUE(ok(Api::load(third.get(), bytes.data(), bytes.size())));
  typename Api::Engine copy = *one;
  for (int i = 0; i < 200; ++i) {
    in.speed_rad_s -= 1;
    for (auto* engine : {one.get(), other.get(), third.get(), &copy}) ASSERT_EQ(Api::step(engine, &in, sizeof in), 0u);
    ASSERT_EQ(this->torque(*one), this->torque(*other));
    ASSERT_EQ(this->torque(*one), this->torque(*third));
    ASSERT_EQ(this->torque(*one), this->torque(copy));
    ASSERT_EQ(Api::phase(one.get()), Api::phase(other.get()));
  }
  bytes[1000] ^= 4u;
  EXPECT_TRUE(answers(Api::load(third.get(), bytes.data(), bytes.size()), CRANKLOOP_DAMAGED, "state"));
  ASSERT_TRUE(ok(Api::engine_reset(one.get(), 5)));
  EXPECT_EQ(Api::phase(one.get()), 5u);
}

// ---- words ------------------------------------------------------------------------------------------------------------------------

TEST(CStatus, IsToldInWordsCutToTheRoomThereIs) {
  const crankloop_status status{CRANKLOOP_OUT_OF_RANGE, 12, "layout.firing_angles"};
  const std::string whole = "layout.firing_angles[12] is out of range";
  for (std::size_t room = 1; room < whole.size() + 3; ++room) {
    std::vector<char> text(room, '?');
    EXPECT_EQ(crankloop_status_text(status, text.data(), room), whole.size());
    EXPECT_EQ(std::string(text.data()), whole.substr(0, room - 1));
  }
  EXPECT_EQ(crankloop_status_text(status, nullptr, 0), whole.size());
  for (const std::size_t room : {std::size_t{1}, std::size_t{80}, SIZE_MAX}) {
    EXPECT_EQ(crankloop_status_text(status, nullptr, room), whole.size()) << "nowhere to put it, whatever the room";
  }
  const auto text_of = [](std::int32_t index, const char* field) {
    char text[80];
    crankloop_status_text({CRANKLOOP_NEGATIVE, index, field}, text, sizeof text);
    return std::string(text);
  };
  EXPECT_EQ(text_of(-1, "masses.piston"), "masses.piston must not be negative");
  EXPECT_EQ(text_of(0, "masses.piston"), "masses.piston[0] must not be negative");
  EXPECT_EQ(text_of(-1, nullptr), "must not be negative");
  EXPECT_EQ(text_of(-1, ""), "must not be negative");
  EXPECT_STREQ(crankloop_describe(CRANKLOOP_ROD_TOO_SHORT), describe(Reason::rod_too_short));
  EXPECT_STREQ(crankloop_describe(CRANKLOOP_OK), "ok");
  EXPECT_STREQ(crankloop_describe(-1), "unknown reason");
  EXPECT_STREQ(crankloop_describe(CRANKLOOP_ALREADY_CREATED + 1), "unknown reason");
  EXPECT_STRNE(crankloop_describe(CRANKLOOP_ALREADY_CREATED), "unknown reason");
}

TEST(CVersion, IsThatOfTheHeader) { EXPECT_EQ(crankloop_version(), std::uint32_t{CRANKLOOP_VERSION}); }

TEST(CFaults, AreThoseOfCpp) {
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_NOT_READY}, std::uint32_t{kFaultNotReady});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_SPEED}, std::uint32_t{kFaultSpeed});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_LOAD_RATIO}, std::uint32_t{kFaultLoadRatio});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_PRESSURE}, std::uint32_t{kFaultPressure});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_PHASE_JUMP}, std::uint32_t{kFaultPhaseJump});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_CAM_PHASE}, std::uint32_t{kFaultCamPhase});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_EVENT_BUDGET}, std::uint32_t{kFaultEventBudget});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_LOAD}, std::uint32_t{kFaultLoad});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_OVERSPEED}, std::uint32_t{kFaultOverspeed});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_TRIGGER_EDGES}, std::uint32_t{kFaultTriggerEdges});
}

}  // namespace
}  // namespace crankloop

// The ready-made engines of the C interface do what the C++ engines do, bit for bit, go on from copies and bytes, and
// take structs of older and newer versions.
#include "c_api.hpp"

#include <cstdio>
#include <cstring>
#include <limits>

namespace crankloop::c_api::c_engine_test {
namespace {

TYPED_TEST_SUITE(CEngine, AllApis, ApiName);

/// Every member of a C struct that C++ has by the same name, compared by that name.
#define SAME(member) ASSERT_EQ(c.member, cpp.member) << #member << ", tick " << tick

template <class C, class Cpp>
void expect_same_whole(const C& c, const Cpp& cpp, int tick) {
  SAME(torque_Nm);
  SAME(mean_torque_Nm);
  for (int k = 0; k < 4; ++k) {
    SAME(displacement_m[k]);
    SAME(velocity_m_s[k]);
    SAME(acceleration_m_s2[k]);
    SAME(rod_angle_rad[k]);
    SAME(rod_speed_rad_s[k]);
    SAME(rod_acceleration_rad_s2[k]);
    SAME(cylinder[k].pressure_Pa);
    SAME(cylinder[k].gas_force_N);
    SAME(cylinder[k].inertia_force_N);
    SAME(cylinder[k].total_force_N);
    SAME(cylinder[k].side_force_N);
    SAME(cylinder[k].rod_force_N);
    SAME(cylinder[k].radial_force_N);
    SAME(cylinder[k].tangential_force_N);
    SAME(cylinder[k].torque_Nm);
    SAME(cylinder[k].tilting_moment_Nm);
    SAME(pin_radial_N[k]);
    SAME(pin_tangential_N[k]);
    SAME(pin_load_N[k]);
    for (int t = 0; t < 2; ++t) {
      SAME(valve[t][k].theoretical_lift_m);
      SAME(valve[t][k].lift_m);
      SAME(valve[t][k].velocity_m_s);
      SAME(valve[t][k].acceleration_m_s2);
      SAME(valve_forces[t][k].train_N);
      SAME(valve_forces[t][k].seat_N);
      SAME(valve_forces[t][k].tip_N);
      SAME(valve_forces[t][k].cam_N);
      SAME(valve_forces[t][k].train_compression_m);
      SAME(valve_forces[t][k].regime);
      SAME(valve_cycle[t][k].largest_lift_m);
      SAME(valve_cycle[t][k].largest_speed_m_s);
      SAME(valve_cycle[t][k].largest_acceleration_m_s2);
      SAME(valve_cycle[t][k].opening_delay_deg);
      SAME(valve_cycle[t][k].separation_clearance_m);
      SAME(valve_cycle[t][k].separation_start_deg);
      SAME(valve_cycle[t][k].separation_duration_deg);
      SAME(valve_cycle[t][k].seating_speed_m_s);
      SAME(valve_cycle[t][k].bounce_height_m);
      SAME(valve_cycle[t][k].separations);
      SAME(valve_cycle[t][k].bounces);
      SAME(valve_cycle[t][k].contact_changes);
      SAME(valve_cycle[t][k].off_seat_at_end);
    }
  }
  for (int j = 0; j < 5; ++j) {
    SAME(journal_along_N[j]);
    SAME(journal_across_N[j]);
    SAME(journal_load_N[j]);
  }
  SAME(first.up_N);
  SAME(first.yaw_Nm);
  SAME(second.up_N);
  SAME(second.pitch_Nm);
  SAME(rotating.lateral_N);
  SAME(rotating.yaw_Nm);
}

template <class C, class Cpp>
void expect_same_free(const C& c, const Cpp& cpp, int tick) {
  ASSERT_EQ(c.crank, cpp.crank.units()) << tick;
  SAME(speed_rad_s);
  SAME(acceleration_rad_s2);
  SAME(friction_Nm);
  SAME(starter_Nm);
  SAME(torque_Nm);
  SAME(mean_torque_Nm);
  for (int w = 0; w < 2; ++w) {
    SAME(trigger[w].level);
    SAME(trigger[w].edge_count);
    for (std::uint32_t e = 0; e < cpp.trigger[w].edge_count; ++e) {
      SAME(trigger[w].edge[e].time_s);
      SAME(trigger[w].edge[e].level);
    }
  }
}
#undef SAME

/// An engine of C and one of C++, started alike.
template <class Api>
struct Pair {
  using Real = typename Api::Real;
  using S = typename Api::Scene;
  std::unique_ptr<TableStorage<Real, S>> storage = std::make_unique<TableStorage<Real, S>>();
  std::unique_ptr<Engine<Real, S>> cpp = std::make_unique<Engine<Real, S>>();

  explicit Pair(const EngineDefinition& definition, std::uint64_t phase) {
    EXPECT_TRUE(storage->build(definition, {}).ok());
    EXPECT_TRUE(cpp->init(storage->tables(), Phase{phase}).ok());
  }
};

template <class Api>
class CWhole : public CEngine<Api> {};
using WholeApis = ::testing::Types<WholeFloat, WholeDouble>;
TYPED_TEST_SUITE(CWhole, WholeApis, ApiName);

TYPED_TEST(CWhole, GivesEveryOutputAsTheCppEngineDoes) {
  using Api = TypeParam;
  using Real = typename Api::Real;
  EngineDefinition definition = diesel_495();
  definition.trains[0].cam.phase_rate_deg_s = 200;
  definition.masses.rod_inertia_correction_kg_m2 = -0.004;
  const auto tables = this->new_tables(definition);
  const auto engine = this->new_engine(*tables, 1234567);
  const Pair<Api> pair(definition, 1234567);
  std::uint32_t bad_ticks = 0;
  for (int tick = 0; tick < 1500; ++tick) {
    typename Api::Input in = this->turning_input(400 - tick * 0.5);
    in.load_ratio = static_cast<Real>(tick % 7) / 5;
    in.cam_phase_deg[0] = Real{-20};
    if (tick == 100) in.speed_rad_s = static_cast<Real>(1e9);
    Input<Real, scenes::Whole> cpp_in;
    cpp_in.speed_rad_s = in.speed_rad_s;
    cpp_in.load_ratio = in.load_ratio;
    cpp_in.cam_phase_deg[0] = in.cam_phase_deg[0];
    const auto& out = pair.cpp->step(cpp_in);
    ASSERT_EQ(Api::step(engine.get(), &in, sizeof in), out.faults);
    if (out.faults != 0) ++bad_ticks;
    const typename Api::Output c = this->output(*engine);
    ASSERT_EQ(c.crank, pair.cpp->state().phase.units());
    ASSERT_EQ(c.bad_input_ticks, bad_ticks);
    ASSERT_EQ(c.bad_input_kinds, bad_ticks > 0 ? std::uint32_t{CRANKLOOP_FAULT_SPEED} : 0u);
    expect_same_whole(c, out, tick);
    if (this->HasFatalFailure()) return;
  }
  EXPECT_EQ(bad_ticks, 1u);
}

template <class Api>
class CFreeRunning : public CEngine<Api> {};
using FreeApis = ::testing::Types<FreeFloat, FreeDouble>;
TYPED_TEST_SUITE(CFreeRunning, FreeApis, ApiName);

TYPED_TEST(CFreeRunning, StartsFiresAndShowsItsTriggerEdgesAsTheCppEngineDoes) {
  using Api = TypeParam;
  using Real = typename Api::Real;
  const EngineDefinition definition = diesel_495();
  const auto tables = this->new_tables(definition);
  const auto engine = this->new_engine(*tables, 99);
  const Pair<Api> pair(definition, 99);
  std::uint32_t edges = 0;
  for (int tick = 0; tick < 12000; ++tick) {
    typename Api::Input in = this->default_input();
    in.starter = tick < 8000 ? 1 : 0;
    in.load_ratio = static_cast<Real>(tick % 5) / 4;
    in.external_torque_Nm = static_cast<Real>(tick % 40);
    in.cut_cylinders = tick > 10000 ? 2 : 0;
    Input<Real, scenes::FreeRunning> cpp_in;
    cpp_in.starter = in.starter;
    cpp_in.load_ratio = in.load_ratio;
    cpp_in.external_torque_Nm = in.external_torque_Nm;
    cpp_in.cut_cylinders = in.cut_cylinders;
    const auto& out = pair.cpp->step(cpp_in);
    ASSERT_EQ(Api::step(engine.get(), &in, sizeof in), out.faults);
    const typename Api::Output c = this->output(*engine);
    expect_same_free(c, out, tick);
    if (this->HasFatalFailure()) return;
    edges += c.trigger[0].edge_count;
  }
  // Each of the 58 teeth has two edges.
  const double turns = static_cast<double>(edges) / (2 * 58);
  EXPECT_GT(turns, 5);
  EXPECT_GT(this->output(*engine).speed_rad_s, Real{40}) << "faster than the starter turns it: it fires";
}

TYPED_TEST(CFreeRunning, GoesOnAtAnySpeedWithinItsLimit) {
  using Api = TypeParam;
  const auto tables = this->new_tables(diesel_495());
  const auto engine = this->new_engine(*tables);
  ASSERT_TRUE(ok(turn_at(engine.get(), 150)));
  auto in = this->default_input();
  ASSERT_EQ(Api::step(engine.get(), &in, sizeof in), 0u);
  EXPECT_NEAR(static_cast<double>(this->output(*engine).speed_rad_s), 150, 1);  // 100 us at some 1000 rad/s^2
  const auto before = this->output(*engine);
  for (const double speed :
       {1e9, -1e9, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(answers(turn_at(engine.get(), speed), CRANKLOOP_OUT_OF_RANGE, "speed_rad_s"));
  }
  EXPECT_TRUE(answers(turn_at(static_cast<typename Api::Engine*>(nullptr), 1), CRANKLOOP_NULL_POINTER, "engine"));
  EXPECT_EQ(this->output(*engine).speed_rad_s, before.speed_rad_s);
}

TEST(CProgram, InC99PrintsTheTorqueOfTheCppEngineBitForBit) {
  std::FILE* program = popen("'" CRANKLOOP_C_PROGRAM "'", "r");
  ASSERT_NE(program, nullptr);
  const Pair<WholeFloat> in_float(diesel_495(), 0);
  const Pair<WholeDouble> in_double(diesel_495(), 0);
  int ticks = 0;
  for (double read[4]; std::fscanf(program, "%la %la %la %la", &read[0], &read[1], &read[2], &read[3]) == 4; ++ticks) {
    Input<float, scenes::Whole> float_in;
    Input<double, scenes::Whole> double_in;
    float_in.speed_rad_s = 209.5F;
    double_in.speed_rad_s = 209.5;
    const auto& f = in_float.cpp->step(float_in);
    const auto& d = in_double.cpp->step(double_in);
    const double expected[] = {static_cast<double>(f.torque_Nm), static_cast<double>(f.mean_torque_Nm), d.torque_Nm,
                               d.mean_torque_Nm};
    for (int i = 0; i < 4; ++i) ASSERT_EQ(read[i], expected[i]) << "tick " << ticks;
  }
  EXPECT_EQ(pclose(program), 0);
  EXPECT_EQ(ticks, 600);
}

// ---- structs of other versions --------------------------------------------------------------------------------------

TYPED_TEST(CWhole, TakesStructsOfOlderProgramsWithDefaultsForWhatTheyLack) {
  using Api = TypeParam;
  using Real = typename Api::Real;
  const auto tables = this->new_tables(diesel_495());
  const auto older = this->new_engine(*tables);
  const auto today = this->new_engine(*tables);
  auto in = this->turning_input(200);
  auto only_speed = in;
  only_speed.load_ratio = Real{-7};  // beyond the older program's struct: not read
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(Api::step(older.get(), &only_speed, sizeof only_speed.speed_rad_s), 0u);
    ASSERT_EQ(Api::step(today.get(), &in, sizeof in), 0u);
  }
  EXPECT_EQ(this->torque(*older), this->torque(*today));

  // A definition that ends before the valve trains has none.
  const crankloop_definition definition = c::as_c(diesel_495());
  auto without = std::make_unique<typename Api::Tables>();
  crankloop_options options = this->default_options();
  options.valve_integrator = 99;  // beyond what is passed, too
  ASSERT_TRUE(ok(Api::tables_create(without.get(), sizeof *without, &definition,
                                    offsetof(crankloop_definition, train_count), &options, sizeof options.tick_s)));
  const auto engine = this->new_engine(*without);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(Api::step(engine.get(), &in, sizeof in), 0u);
  EXPECT_EQ(this->torque(*engine), this->torque(*today));
  const auto out = this->output(*engine);
  for (const auto& train : out.valve) {
    for (const auto& valve : train) EXPECT_EQ(valve.theoretical_lift_m, Real{0});
  }
}

TYPED_TEST(CEngine, WritesNoMoreThanAnOlderProgramsStructHasRoomFor) {
  using Api = TypeParam;
  const auto tables = this->new_tables(diesel_495());
  const auto engine = this->new_engine(*tables, 5);
  const auto in = this->turning_input();
  for (int i = 0; i < 30; ++i) Api::step(engine.get(), &in, sizeof in);
  const auto all = this->output(*engine);
  ASSERT_NE(all.crank, 5u);
  const auto bytes_of = [](auto& out) { return reinterpret_cast<unsigned char*>(&out); };
  for (const std::size_t size :
       {std::size_t{0}, sizeof all.crank, offsetof(typename Api::Output, torque_Nm), sizeof all}) {
    typename Api::Output older;
    std::memset(&older, 0xEE, sizeof older);
    ASSERT_TRUE(ok(Api::read(engine.get(), &older, size)));
    auto expected = all;
    std::memset(bytes_of(expected) + size, 0xEE, sizeof expected - size);
    EXPECT_EQ(std::memcmp(&older, &expected, sizeof older), 0) << size;
  }
}

TYPED_TEST(CEngine, TakesStructsOfNewerProgramsThatDoNotUseWhatIsNew) {
  using Api = TypeParam;
  using Real = typename Api::Real;
  const auto tables = this->new_tables(diesel_495());
  const auto engine = this->new_engine(*tables);
  struct NewerInput {
    typename Api::Input known;
    Real unknown;
  };
  std::unique_ptr<NewerInput> in(new NewerInput());
  in->known = this->turning_input();
  EXPECT_EQ(Api::step(engine.get(), &in->known, sizeof *in), 0u);
  in->unknown = Real{1};
  const std::uint64_t before = this->output(*engine).crank;
  EXPECT_EQ(Api::step(engine.get(), &in->known, sizeof *in), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});
  EXPECT_EQ(this->output(*engine).crank, before);
  struct NewerOutput {
    typename Api::Output known;
    Real unknown;
  };
  std::unique_ptr<NewerOutput> out(new NewerOutput());
  out->unknown = Real{5};
  ASSERT_TRUE(ok(Api::read(engine.get(), &out->known, sizeof *out)));
  EXPECT_EQ(out->known.torque_Nm, this->torque(*engine));
  EXPECT_EQ(out->unknown, Real{0});
  auto* unknown = reinterpret_cast<unsigned char*>(&out->unknown);
  unknown[0] = unknown[1] = 5;
  ASSERT_TRUE(ok(Api::read(engine.get(), &out->known, sizeof out->known + 1)));
  EXPECT_EQ(unknown[0], 0);
  EXPECT_EQ(unknown[1], 5) << "behind the struct";

  struct NewerDefinition {
    crankloop_definition known;
    double unknown;
  } definition{c::as_c(diesel_495()), 1};
  const crankloop_options options = this->default_options();
  auto more = std::make_unique<typename Api::Tables>();
  EXPECT_TRUE(answers(
      Api::tables_create(more.get(), sizeof *more, &definition.known, sizeof definition, &options, sizeof options),
      CRANKLOOP_WRONG_SIZE, "definition"));
}

TYPED_TEST(CEngine, TellsItsSizesToLanguagesWithoutItsHeader) {
  using Api = TypeParam;
  EXPECT_EQ(Api::tables_size(), sizeof(typename Api::Tables));
  EXPECT_EQ(Api::engine_size(), sizeof(typename Api::Engine));
}

// ---- state ----------------------------------------------------------------------------------------------------------

TYPED_TEST(CEngine, RunsSideBySideAndGoesOnFromCopiesAndBytesWithTheSameBits) {
  using Api = TypeParam;
  const auto tables = this->new_tables(diesel_495());
  const auto one = this->new_engine(*tables);
  const auto other = this->new_engine(*tables, 99);
  const auto in = this->turning_input();
  for (int i = 0; i < 123; ++i) {
    Api::step(one.get(), &in, sizeof in);
    if (i % 3 == 0) Api::step(other.get(), &in, sizeof in);
  }
  std::vector<unsigned char> bytes(Api::kSavedBytes);
  ASSERT_TRUE(ok(Api::save(one.get(), bytes.data(), bytes.size())));
  ASSERT_TRUE(ok(Api::load(other.get(), bytes.data(), bytes.size())));
  typename Api::Engine copy = *one;
  for (int i = 0; i < 200; ++i) {
    for (auto* engine : {one.get(), other.get(), &copy}) ASSERT_EQ(Api::step(engine, &in, sizeof in), 0u);
    ASSERT_EQ(this->torque(*one), this->torque(*other));
    ASSERT_EQ(this->torque(*one), this->torque(copy));
    ASSERT_EQ(this->output(*one).crank, this->output(*other).crank);
  }
  bytes[100] ^= 4u;
  EXPECT_TRUE(answers(Api::load(other.get(), bytes.data(), bytes.size()), CRANKLOOP_DAMAGED, "state"));
  ASSERT_TRUE(ok(Api::reset(one.get(), 5)));
  EXPECT_EQ(this->output(*one).crank, 5u);
}

TYPED_TEST(CWhole, CountsTicksWithBadInputsSinceItsReset) {
  using Api = TypeParam;
  const auto tables = this->new_tables(diesel_495());
  const auto engine = this->new_engine(*tables);
  for (const bool again : {false, true}) {
    for (const double speed : {300.0, 1e9, 300.0, -1e9}) {
      const auto in = this->turning_input(speed);
      Api::step(engine.get(), &in, sizeof in);
    }
    auto in = this->turning_input();
    in.load_ratio = 3;
    Api::step(engine.get(), &in, sizeof in);
    EXPECT_EQ(this->output(*engine).bad_input_ticks, 3u);
    EXPECT_EQ(this->output(*engine).bad_input_kinds, std::uint32_t{CRANKLOOP_FAULT_SPEED | CRANKLOOP_FAULT_LOAD_RATIO});
    if (again) continue;
    ASSERT_TRUE(ok(Api::reset(engine.get(), 0)));
    EXPECT_EQ(this->output(*engine).bad_input_ticks | this->output(*engine).bad_input_kinds, 0u);
  }
}

}  // namespace
}  // namespace crankloop::c_api::c_engine_test

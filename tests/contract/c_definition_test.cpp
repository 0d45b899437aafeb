// Definitions that C writes: every field arrives in C++, refusals name the field, and are told in words.
#include "c_api.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "support/limit_definitions.hpp"
#include "support/status.hpp"

namespace crankloop::c_api::c_definition_test {
namespace {

TYPED_TEST_SUITE(CEngine, AllApis, ApiName);

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
  EngineDefinition all_read{};
  all_read.train_count = kMaxTrains;
  all_read.trigger_count = kMaxTriggerWheels;
  all_read.layout.cylinders = kMaxCylinders;
  all_read.wheel_fault_count = kMaxWheelFaults;
  all_read.pressure.source = PressureSource::gas;
  all_read.reluctor.wheel = 0;
  all_read.sensor_fault_count = kMaxSensorFaults;
  for (SensorFault& fault : all_read.sensor_faults) fault.noise = 1;
  for (ValveTrain& train : all_read.trains) train.rocker.kind = RockerKind::circular_pad;
  const crankloop_definition usual = c::as_c(all_read);
  const int blind = blind_bytes(usual, [&](const crankloop_definition& changed) {
    EngineDefinition cpp;
    if (!c::from_c(changed, cpp).ok()) return true;
    const crankloop_definition back = c::as_c(cpp);
    return std::memcmp(&back, &usual, sizeof back) != 0;
  });
  // Behind cylinders, heat_given, train_count, trigger_count, wheel_fault_count, in each train behind point_count,
  // per_cylinder and surge_modes, in each wheel behind inverted, in each misfire behind cycles, in each fault behind
  // noise_seed, in the gas behind in_use and throttle_count, in the lambda sensor behind in_use, behind
  // sensor_fault_count: 4 bytes. Of a wheel's `inverted` the three bytes above the
  // lowest tell nothing new: any number but 0 is yes; but here each byte is changed by itself.
  if (kUsual64Bits) {
    EXPECT_EQ(blind, 4 + 4 + 4 + 4 + CRANKLOOP_MAX_TRAINS * (4 + 4 + 4) + CRANKLOOP_MAX_TRIGGER_WHEELS * 4 +
                         CRANKLOOP_MAX_CYLINDERS * 4 + 4 + CRANKLOOP_MAX_WHEEL_FAULTS * 4 + 4 + 4 + 4 + 4);
  }
}

TEST(COptions, PassEachOnToCpp) {
  const crankloop_options options{50e-6, 2e-6, CRANKLOOP_INTEGRATOR_EXPONENTIAL, 77, 900};
  TickOptions cpp;
  ASSERT_TRUE(c::from_c(options, cpp).ok());
  EXPECT_EQ(cpp.tick_s, 50e-6);
  EXPECT_EQ(cpp.valves.accuracy_m, 2e-6);
  EXPECT_EQ(cpp.valves.integrator, Integrator::exponential);
  EXPECT_EQ(cpp.valves.event_budget, 77);
  EXPECT_EQ(cpp.max_speed_rad_s, 900);
  const crankloop_options back = c::as_c(cpp);
  EXPECT_EQ(std::memcmp(&back, &options, sizeof back), 0);
}

TEST(CDefinition, KeepsItsLayoutWhereAFiringOrderIsRefusedAndGrowsWithoutHarmToOlderPrograms) {
  crankloop_definition definition;
  ASSERT_TRUE(ok(crankloop_definition_defaults(&definition, sizeof definition)));
  const std::int32_t twice[] = {1, 1};
  EXPECT_TRUE(answers(crankloop_set_firing_order(&definition, sizeof definition, twice, 2), CRANKLOOP_NOT_A_PERMUTATION,
                      "order"));
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
  const auto tables = std::make_unique<crankloop_whole_f_tables>();
  EXPECT_TRUE(answers(crankloop_whole_f_tables_create(tables.get(), sizeof *tables, &definition, sizeof definition,
                                                      &options, sizeof options),
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

TYPED_TEST(CEngine, RefusesABadDefinitionWithTheFieldToBlame) {
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
  EXPECT_TRUE(answers(create(bad), CRANKLOOP_ROD_TOO_SHORT, "crank.rod_length_m"));
  bad = good;
  bad.layout.firing_deg[2] = 720;
  const crankloop_status status = create(bad);
  EXPECT_TRUE(answers(status, CRANKLOOP_OUT_OF_RANGE, "layout.firing_deg"));
  EXPECT_EQ(status.index, 2);
  // Enumerators that C++ does not have.
  for (const int source : {-1, CRANKLOOP_PRESSURE_GAS + 1, 256 + CRANKLOOP_PRESSURE_WIEBE}) {
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
  EXPECT_TRUE(answers(create(bad), CRANKLOOP_OUT_OF_RANGE, "pressure.points"));
  bad = good;
  bad.pressure.source = CRANKLOOP_PRESSURE_WIEBE;
  bad.pressure.wiebe.heat_given = 1;
  bad.pressure.wiebe.heat_J = 1e9;
  EXPECT_TRUE(answers(create(bad), CRANKLOOP_PRESSURE_TOO_HIGH, "pressure.wiebe.heat_J"));
  bad = good;
  bad.trains[1].rocker.kind = 2;
  EXPECT_TRUE(answers(create(bad), CRANKLOOP_OUT_OF_RANGE, "rocker.kind"));
  options.valve_integrator = 2;
  EXPECT_TRUE(answers(create(good), CRANKLOOP_OUT_OF_RANGE, "options.valves.integrator"));
  ASSERT_TRUE(ok(crankloop_options_defaults(&options, sizeof options)));
  // After all that, the same memory is good for good tables.
  EXPECT_TRUE(ok(create(good)));
}

TYPED_TEST(CEngine, RefusesGasExchangeWhereItHasNone) {
  using Api = TypeParam;
  auto tables = std::make_unique<typename Api::Tables>();
  const crankloop_options options = this->default_options();
  crankloop_definition breathing = c::as_c(diesel_495());
  breathing.pressure.source = CRANKLOOP_PRESSURE_GAS;
  EXPECT_TRUE(
      answers(Api::tables_create(tables.get(), sizeof *tables, &breathing, sizeof breathing, &options, sizeof options),
              CRANKLOOP_INCONSISTENT, "pressure.source"));
}

TYPED_TEST(CEngine, RefusesATrainThatIsNoneWhetherItHasValvesOrNot) {
  using Api = TypeParam;
  auto tables = std::make_unique<typename Api::Tables>();
  const crankloop_options options = this->default_options();
  const auto create = [&](const crankloop_definition& d) {
    return Api::tables_create(tables.get(), sizeof *tables, &d, sizeof d, &options, sizeof options);
  };
  for (const int count : {9, 2'000'000'000}) {
    crankloop_definition bad = c::as_c(diesel_495());
    bad.trains[1].cam.exponent_count = count;
    EXPECT_TRUE(answers(create(bad), CRANKLOOP_TOO_MANY_POINTS, "cam.exponents")) << count;
    EXPECT_EQ(create(bad).index, 1);
    bad = c::as_c(diesel_495());
    bad.trains[0].cam.source = CRANKLOOP_CAM_TABLE;
    bad.trains[0].cam.smoothing_m = 1e-6;
    bad.trains[0].cam.point_count = count;
    EXPECT_TRUE(answers(create(bad), CRANKLOOP_TOO_FEW_POINTS, "cam.points")) << "no rows, but said to be " << count;
  }
}

TEST(CDefinition, AtItsLimitsIsAnsweredAsInCppWhateverItsUnreadMemoryHolds) {
  // CRANKLOOP_LONG_TESTS=1 in the environment: 100 000 definitions.
  const int trials = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 100'000 : 1000;
  support::Random random;
  detail::Drive<double> drive{};
  TableTargets<double> targets;
  targets.drive = &drive;
  int accepted_ones = 0;
  for (int trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(random.trace(trial));
    support::LimitDefinition limit(random);
    EngineDefinition& cpp = limit.definition;
    const Status right = validate(cpp);
    const crankloop_definition whole = c::as_c(cpp);
    std::uint64_t fingerprints[2] = {};
    for (const int filling : {0x00, 0xA5}) {
      crankloop_definition in_c;
      std::memset(&in_c, filling, sizeof in_c);
      support::CopyRead copy;
      support::each_part(copy, cpp, whole, in_c);
      EngineDefinition taken;
      Status status = c::take(taken, &in_c, sizeof in_c);
      const bool enumerator = !status.ok();  // none that C++ has: C finds these first
      if (status.ok()) status = validate(taken);
      EXPECT_TRUE(status.ok() || support::is_field(status.field)) << status.field;
      EXPECT_EQ(status.ok(), right.ok()) << testing::PrintToString(status) << ", " << testing::PrintToString(right);
      if (!enumerator && !right.ok()) {
        EXPECT_TRUE(support::refuses(status, right.reason, right.field, right.index));
      }
      if (!status.ok() || cpp.pressure.source == PressureSource::wiebe) continue;  // whose heat takes milliseconds
      if (!tabulate(taken, {}, targets).ok()) continue;                            // volumes that no cylinder has
      fingerprints[filling == 0 ? 0 : 1] = drive.fingerprint;
      ++accepted_ones;
    }
    EXPECT_EQ(fingerprints[0], fingerprints[1]);
  }
  std::printf("[ figures  ] seed %llu: %d of %d definitions in C at their limits accepted\n",
              static_cast<unsigned long long>(support::test_seed()), accepted_ones / 2, trials);
  EXPECT_GE(accepted_ones, trials / 20);
}

TYPED_TEST(CEngine, ReadsNoRowsThatNoSourceUses) {
  using Api = TypeParam;
  crankloop_definition definition = c::as_c(diesel_495());
  definition.pressure.source = CRANKLOOP_PRESSURE_NONE;
  definition.pressure.point_count = 8;  // and no rows
  definition.trains[0].cam.point_count = 8;
  auto tables = std::make_unique<typename Api::Tables>();
  const crankloop_options options = this->default_options();
  EXPECT_TRUE(
      ok(Api::tables_create(tables.get(), sizeof *tables, &definition, sizeof definition, &options, sizeof options)));
}

template <class Api>
class CWholeDefinition : public CEngine<Api> {};
using WholeApis = ::testing::Types<WholeFloat, WholeDouble>;
TYPED_TEST_SUITE(CWholeDefinition, WholeApis, ApiName);

TYPED_TEST(CWholeDefinition, RefusesSpringsThatSurge) {
  using Api = TypeParam;
  EngineDefinition surging = diesel_495();
  surging.trains[1].valve.surge_modes = 2;
  const auto tables = this->new_tables(surging);
  typename Api::Engine engine{};
  EXPECT_TRUE(
      answers(Api::create(&engine, sizeof engine, tables.get(), 0), CRANKLOOP_INCONSISTENT, "scene.spring_modes"));
}

TYPED_TEST(CWholeDefinition, ReadsRowsOfADiagramAndOfACam) {
  using Api = TypeParam;
  std::vector<crankloop_diagram_point> rows;
  for (int deg = 0; deg < 720; deg += 10)
    rows.push_back({1.0 * deg, 1e5 + (deg < 180 ? 180.0 - deg : deg > 540 ? deg - 540.0 : 0.0) * 2e4});
  std::vector<crankloop_cam_point> cam;
  for (int deg = -60; deg <= 60; deg += 2)
    cam.push_back({1.0 * deg, 2.5e-3 * (1 - deg * deg / 3600.0) * (1 - deg * deg / 3600.0) * (1 - deg * deg / 3600.0)});
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
  ASSERT_TRUE(
      ok(Api::tables_create(tables.get(), sizeof *tables, &definition, sizeof definition, &options, sizeof options)));
  const auto engine = this->new_engine(*tables);
  const auto in = this->turning_input(0);
  ASSERT_EQ(Api::step(engine.get(), &in, sizeof in), 0u);
  EXPECT_NEAR(static_cast<double>(this->output(*engine).cylinder[0].pressure_Pa), 1e5 + 180 * 2e4,
              100);  // the row at 0 deg; 1e-5 of the peak, float
}

// ---- words ----------------------------------------------------------------------------------------------------------

TEST(CStatus, IsToldInWordsCutToTheRoomThereIs) {
  const crankloop_status status{CRANKLOOP_OUT_OF_RANGE, 12, "layout.firing_deg"};
  const std::string whole = "layout.firing_deg[12] is out of range";
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
  EXPECT_EQ(text_of(-1, "masses.piston_kg"), "masses.piston_kg must not be negative");
  EXPECT_EQ(text_of(0, "masses.piston_kg"), "masses.piston_kg[0] must not be negative");
  EXPECT_EQ(text_of(-1, nullptr), "must not be negative");
  EXPECT_EQ(text_of(-1, ""), "must not be negative");
  EXPECT_STREQ(crankloop_describe(CRANKLOOP_ROD_TOO_SHORT), describe(Reason::rod_too_short));
  EXPECT_STREQ(crankloop_describe(CRANKLOOP_OK), "ok");
  EXPECT_STREQ(crankloop_describe(-1), "unknown reason");
  std::int32_t reason = 0;
  for (const std::string none = "unknown reason"; describe(static_cast<Reason>(reason)) != none; ++reason)
    EXPECT_STREQ(crankloop_describe(reason), describe(static_cast<Reason>(reason))) << reason;
  EXPECT_EQ(reason, CRANKLOOP_UNSTABLE + 1);
  EXPECT_STREQ(crankloop_describe(reason), "unknown reason");
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
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_EXTERNAL_TORQUE}, std::uint32_t{kFaultExternalTorque});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_OVERSPEED}, std::uint32_t{kFaultOverspeed});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_TRIGGER_EDGES}, std::uint32_t{kFaultTriggerEdges});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_GAS}, std::uint32_t{kFaultGas});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_MANIFOLD}, std::uint32_t{kFaultManifold});
  EXPECT_EQ(std::uint32_t{CRANKLOOP_FAULT_BURN}, std::uint32_t{kFaultBurn});
  EXPECT_EQ(name_of(static_cast<Fault>(CRANKLOOP_FAULT_BURN << 1)), nullptr) << "a fault that C does not have";
}

}  // namespace
}  // namespace crankloop::c_api::c_definition_test

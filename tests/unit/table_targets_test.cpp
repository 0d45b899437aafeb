// tabulate() into sections of the caller's own: what belongs together is refused where a part is missing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>
#include <vector>

#include <crankloop/tabulate/cam_contact.hpp>
#include <crankloop/tabulate/cam_profile.hpp>
#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tabulate/valve_lift.hpp>

#include "support/both_reals.hpp"
#include "support/engines.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"
#include "support/units.hpp"
#include "tabulate/curve_fit.hpp"
#include "tabulate/gas_quantities.hpp"

namespace crankloop::table_targets_test {

using namespace detail;
namespace {

using support::refuses;
using namespace tick_test;

template <class Real>
class TableTargetsOf : public ::testing::Test {};
TYPED_TEST_SUITE(TableTargetsOf, BothReals, RealName);

/// With a cam contact that has a width and friction.
[[nodiscard]] EngineDefinition with_cam_contact() {
  EngineDefinition engine = single_495();
  engine.train_count = 1;
  engine.trains[0] = valve_test::ohc_125_train();
  engine.contacts[0].width_m = 9e-3;
  engine.contacts[0].friction_ratio = 0.1;
  return engine;
}

TYPED_TEST(TableTargetsOf, APartWithoutWhatBelongsToItAreRefusedByItsName) {
  using Real = TypeParam;
  GasGrid grid{};
  GasTorque<Real> torque{};
  Segment<Real> pressure{};
  IntegratedSegment<Real> integrated{};
  LiftCurve<Real> lift{};
  LiftSegment<Real> lift_segment{};
  Segment<Real> ratio{};
  const auto answer = [](const TableTargets<Real>& targets) { return tabulate(single_495(), {100e-6, {}}, targets); };
  using Targets = TableTargets<Real>;

  Segment<Real>* Targets::*const pressures[] = {&Targets::pressure_full, &Targets::pressure_motored,
                                                &Targets::pressure_heat};
  for (const auto one : pressures) {
    Targets targets;
    targets.*one = &pressure;
    EXPECT_TRUE(refuses(answer(targets), Reason::missing_table, "targets.gas_grid"));
    targets.gas_grid = &grid;
    targets.gas_capacity = 719;
    EXPECT_TRUE(refuses(answer(targets), Reason::out_of_range, "targets.gas_capacity"));
  }
  const struct {
    GasTorque<Real>* Targets::*torque;
    IntegratedSegment<Real>* Targets::*segments;
    const char* field;
    GasGrid* Targets::*grid = &Targets::torque_grid;
    const char* grid_field = "targets.torque_grid";
  } pairs[] = {{&Targets::gas_torque_full, &Targets::gas_full, "targets.gas_full"},
               {&Targets::gas_torque_motored, &Targets::gas_motored, "targets.gas_motored"},
               {&Targets::gas_torque_heat, &Targets::gas_heat, "targets.gas_heat"},
               {&Targets::cut_torque, &Targets::cut_heat, "targets.cut_heat", &Targets::cut_grid, "targets.cut_grid"}};
  for (const auto& pair : pairs) {
    Targets without_grid;
    without_grid.*pair.torque = &torque;
    EXPECT_TRUE(refuses(answer(without_grid), Reason::missing_table, pair.grid_field));
    Targets without_segments = without_grid;
    without_segments.*pair.grid = &grid;
    without_segments.gas_capacity = 719;
    EXPECT_TRUE(refuses(answer(without_segments), Reason::out_of_range, "targets.gas_capacity"));
    without_segments.gas_capacity = 720;
    EXPECT_TRUE(refuses(answer(without_segments), Reason::missing_table, pair.field));
    Targets without_torque;
    without_torque.*pair.segments = &integrated;
    EXPECT_TRUE(refuses(answer(without_torque), Reason::missing_table, pair.field));
  }
  Targets lifts;
  lifts.lift_curves = &lift;
  EXPECT_TRUE(refuses(answer(lifts), Reason::missing_table, "targets.lift_segments"));
  lifts.lift_segments = &lift_segment;
  EXPECT_TRUE(refuses(answer(lifts), Reason::missing_table, "targets.lift_segments"));
  lifts.lift_segments = nullptr;
  lifts.rocker_ratios = &ratio;
  EXPECT_TRUE(refuses(answer(lifts), Reason::missing_table, "targets.lift_segments"));
  CamContactCurve<Real> contact;
  CamTorqueTable<Real> cam_torque;
  Targets contacts;
  contacts.cam_torques = &cam_torque;
  EXPECT_TRUE(refuses(answer(contacts), Reason::missing_table, "targets.lift_curves"));
  contacts.lift_curves = &lift, contacts.lift_segments = &lift_segment, contacts.rocker_ratios = &ratio;
  EXPECT_TRUE(refuses(answer(contacts), Reason::missing_table, "targets.cam_sliding"));
  contacts.cam_sliding = &ratio, contacts.cam_contacts = &contact;
  EXPECT_TRUE(refuses(answer(contacts), Reason::missing_table, "targets.cam_contact_segments"));
  WheelFaultRules<Real> faults{};
  WheelFaultRule<Real> rule{};
  TriggerTrack track{};
  const auto edges = std::make_unique<std::uint32_t[]>(kMaxTriggerEdges);
  Targets of_faults;
  of_faults.wheel_faults = &faults;
  of_faults.fault_edges = edges.get(), of_faults.fault_tracks = &track, of_faults.wheel_fault_rules = &rule;
  EXPECT_TRUE(accepted(answer(of_faults)));
  for (int missing = 0; missing < 3; ++missing) {
    Targets part = of_faults;
    if (missing == 0) part.fault_edges = nullptr;
    if (missing == 1) part.fault_tracks = nullptr;
    if (missing == 2) part.wheel_fault_rules = nullptr;
    EXPECT_TRUE(refuses(answer(part), Reason::missing_table, "targets.fault_tracks")) << missing;
  }
}

TYPED_TEST(TableTargetsOf, AContactWithoutItsFrictionAreThoseThatTheyAreWithIt) {
  using Real = TypeParam;
  EngineDefinition engine = with_cam_contact();
  struct Filled {
    std::vector<CamContactSegment<Real>> contacts = std::vector<CamContactSegment<Real>>(kDegreesPerTurn);
    std::vector<Segment<Real>> sliding = std::vector<Segment<Real>>(kDegreesPerTurn);
    CamContactCurve<Real> curve{};
    CamTorqueTable<Real> torque{};
    std::uint32_t segments = 0;
  };
  const auto fill = [&engine](bool contact, bool torque) {
    Filled filled;
    LiftCurve<Real> lift{};
    const auto segments = std::make_unique<LiftSegment<Real>[]>(kDegreesPerTurn);
    const auto ratios = std::make_unique<Segment<Real>[]>(kDegreesPerTurn);
    TableTargets<Real> targets;
    targets.lift_curves = &lift, targets.lift_segments = segments.get(), targets.rocker_ratios = ratios.get();
    targets.cam_sliding = filled.sliding.data();
    if (contact) targets.cam_contacts = &filled.curve, targets.cam_contact_segments = filled.contacts.data();
    if (torque) targets.cam_torques = &filled.torque;
    EXPECT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
    filled.segments = lift.segments;
    return filled;
  };
  const Filled both = fill(true, true), contact = fill(true, false), torque = fill(false, true);
  ASSERT_GT(both.segments, 100u);
  const std::size_t rows = both.segments;
  EXPECT_EQ(std::memcmp(contact.contacts.data(), both.contacts.data(), rows * sizeof both.contacts[0]), 0);
  EXPECT_EQ(std::memcmp(contact.sliding.data(), both.sliding.data(), rows * sizeof both.sliding[0]), 0);
  EXPECT_EQ(std::memcmp(torque.sliding.data(), both.sliding.data(), rows * sizeof both.sliding[0]), 0);
  EXPECT_NE(contact.curve.at, nullptr);
  EXPECT_NE(contact.curve.sliding_m, nullptr);
  // And of a train without a width sliding is filled for nobody.
  engine.contacts[0].width_m = 0;
  const Filled none = fill(true, false);
  EXPECT_EQ(none.curve.at, nullptr);
  EXPECT_EQ(none.curve.sliding_m, nullptr);
  EXPECT_EQ(none.sliding[0].c[0], Real{0});
}

TYPED_TEST(TableTargetsOf, AnEngineThatHasEverythingFillEverySection) {
  using Real = TypeParam;
  EngineDefinition engine = with_cam_contact();
  engine.trigger_count = 1;
  engine.triggers[0].places = 60;
  engine.wheel_fault_count = 1;
  engine.wheel_faults[0].end_s = 1;
  const auto stores = std::make_unique<detail::part::Stores<Real, detail::part::RoomForAll>>();
  constexpr unsigned char kUntouched = 0xA5;
  std::memset(static_cast<void*>(stores.get()), kUntouched, sizeof *stores);
  ASSERT_TRUE(tabulate(engine, {100e-6, {}}, stores->targets()).ok());
  sections([&](auto section) {
    const auto& filled = section.in(*stores);
    constexpr std::size_t kRecord = sizeof(typename decltype(section)::template Record<Real>);
    unsigned char first[kRecord];
    std::memcpy(first, &filled, kRecord);
    EXPECT_TRUE(std::any_of(first, first + kRecord, [](unsigned char byte) { return byte != kUntouched; }))
        << section.kName;
  });
}

TYPED_TEST(TableTargetsOf, AnEngineOfAnImpossibleNumberOfTrainsAreNotFilled) {
  using Real = TypeParam;
  Drive<Real> drive{};
  TableTargets<Real> targets;
  targets.drive = &drive;
  EngineDefinition engine = single_495();
  for (const int trains : {-1, kMaxTrains + 1, 1 << 30}) {
    engine.train_count = trains;
    EXPECT_TRUE(refuses(tabulate(engine, {100e-6, {}}, targets), Reason::out_of_range, "train_count")) << trains;
  }
  EXPECT_EQ(drive.cylinders, 0u) << "nothing is written by a refusal";
}

TYPED_TEST(TableTargetsOf, WhatCannotBeTabulatedAreNotFilled) {
  using Real = TypeParam;
  Drive<Real> drive{};
  ValveMotion<Real> motion{};
  TableTargets<Real> targets;
  targets.drive = &drive;
  targets.valve_motions = &motion;
  EngineDefinition engine = single_495();
  for (const double tick_s : {0.999e-6, 2.001e-3, 0.0}) {
    EXPECT_TRUE(refuses(tabulate(engine, {tick_s, {}}, targets), Reason::out_of_range, "options.tick_s")) << tick_s;
  }
  engine.pressure.source = PressureSource::wiebe;
  engine.pressure.wiebe.net_mep_Pa = -50e3;  // a motored cylinder loses less: no heat is negative
  EXPECT_TRUE(refuses(tabulate(engine, {100e-6, {}}, targets), Reason::no_solution, "pressure.wiebe.net_mep_Pa"));
  engine = single_495();
  engine.train_count = 2;
  engine.trains[0] = engine.trains[1] = valve_test::ohc_125_train();
  engine.trains[1].valve.valve_kg = -1;
  const Status refused = tabulate(engine, {100e-6, {}}, targets);
  EXPECT_EQ(refused.reason, Reason::not_positive);
  EXPECT_EQ(refused.index, 1) << "the second train's";
  EXPECT_EQ(drive.cylinders, 0u) << "nothing is written by a refusal";
}

TYPED_TEST(TableTargetsOf, AnEngineWithoutAValveInItsSceneAreNotFilledFromATrainThatIsNone) {
  // No section of a train is built; their fingerprint is the definition's all the same.
  using Real = TypeParam;
  Drive<Real> drive{};
  TableTargets<Real> targets;
  targets.drive = &drive;
  EngineDefinition good = single_495();
  good.train_count = 2;
  good.trains[0] = good.trains[1] = valve_test::ohc_125_train();
  for (const int count : {-1, 0, 1, 9, 2'000'000'000}) {
    EngineDefinition engine = good;
    engine.trains[1].cam.exponent_count = count;
    EXPECT_TRUE(refuses(tabulate(engine, {100e-6, {}}, targets),
                        count < 2 ? Reason::too_few_points : Reason::too_many_points, "cam.exponents", 1))
        << count;
    engine = good;
    engine.trains[1].cam.source = CamSource::table;
    engine.trains[1].cam.smoothing_m = 1e-6;
    engine.trains[1].cam.point_count = count;  // and no rows
    EXPECT_TRUE(refuses(tabulate(engine, {100e-6, {}}, targets), Reason::too_few_points, "cam.points", 1)) << count;
  }
  EngineDefinition engine = good;
  engine.trains[0].valve.seat_N_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refuses(tabulate(engine, {100e-6, {}}, targets), Reason::not_finite, "valve.seat_N_m", 0));
  TickOptions options;
  options.valves.accuracy_m = 0;
  EXPECT_TRUE(refuses(tabulate(good, options, targets), Reason::out_of_range, "options.valves.accuracy_m"));
  options = {};
  options.valves.integrator = static_cast<Integrator>(2);
  EXPECT_TRUE(refuses(tabulate(good, options, targets), Reason::out_of_range, "options.valves.integrator"));
  EXPECT_EQ(drive.cylinders, 0u) << "nothing is written by a refusal";
  good.train_count = 0;
  EXPECT_TRUE(accepted(tabulate(good, options, targets))) << "without a train nothing is stepped by it";
  EXPECT_EQ(drive.cylinders, 1u);
}

TYPED_TEST(TableTargetsOf, ARockerHaveTheFingerprintOfWhatItsKindUses) {
  using Real = TypeParam;
  const auto fingerprint = [](const auto& change, RockerKind kind) {
    EngineDefinition engine = single_495();
    engine.train_count = 1;
    engine.trains[0] = valve_test::ohc_125_train();
    engine.trains[0].rocker.kind = kind;
    change(engine.trains[0].rocker);
    Drive<Real> drive{};
    TableTargets<Real> targets;
    targets.drive = &drive;
    EXPECT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
    return drive.fingerprint;
  };
  const auto nothing = [](Rocker&) {};
  const auto pad = [](Rocker& rocker) {
    rocker.pivot_to_pad_m *= 1.01, rocker.pivot_to_cam_m *= 1.01, rocker.pad_radius_m *= 1.01;
    rocker.screw_ball_m *= 1.01, rocker.stem_above_pivot_m *= 1.01, rocker.cam_turns = CamTurns::away_from_pivot;
  };
  const auto ratio = [](Rocker& rocker) { rocker.ratio = 1.01; };
  EXPECT_EQ(fingerprint(nothing, RockerKind::ratio), fingerprint(pad, RockerKind::ratio));
  EXPECT_NE(fingerprint(nothing, RockerKind::ratio), fingerprint(ratio, RockerKind::ratio));
  EXPECT_EQ(fingerprint(nothing, RockerKind::circular_pad), fingerprint(ratio, RockerKind::circular_pad));
  EXPECT_NE(fingerprint(nothing, RockerKind::circular_pad), fingerprint(pad, RockerKind::circular_pad));
}

TYPED_TEST(TableTargetsOf, AnEngineWithGasExchangeHaveAnotherFingerprintForEachNumberOfValves) {
  using Real = TypeParam;
  const auto fingerprint = [](int per_cylinder, PressureSource source) {
    EngineDefinition engine = support::four_2000();
    engine.trains[1].valve.per_cylinder = per_cylinder;
    engine.pressure.source = source;
    Drive<Real> drive{};
    TableTargets<Real> targets;
    targets.drive = &drive;
    EXPECT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
    return drive.fingerprint;
  };
  EXPECT_NE(fingerprint(1, PressureSource::gas), fingerprint(2, PressureSource::gas)) << "twice the port's area";
  EXPECT_EQ(fingerprint(1, PressureSource::none), fingerprint(2, PressureSource::none)) << "one valve stands for both";
}

TYPED_TEST(TableTargetsOf, AnEngineWhoseHeatIsGivenHaveAnotherFingerprintForEachHeat) {
  using Real = TypeParam;
  const auto fingerprint = [](bool heat_given, double heat_J) {
    EngineDefinition engine = single_495();
    engine.pressure.wiebe.heat_given = heat_given;
    engine.pressure.wiebe.heat_J = heat_J;
    Drive<Real> drive{};
    TableTargets<Real> targets;
    targets.drive = &drive;
    EXPECT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
    return drive.fingerprint;
  };
  EXPECT_NE(fingerprint(true, 900), fingerprint(true, 901));
  EXPECT_EQ(fingerprint(false, 900), fingerprint(false, 901)) << "not used, so not told apart";
}

TYPED_TEST(TableTargetsOf, AnEngineReadNoRowsThatItsSourcesDoNotUse) {
  using Real = TypeParam;
  const auto fingerprint = [](const EngineDefinition& engine) {
    Drive<Real> drive{};
    TableTargets<Real> targets;
    targets.drive = &drive;
    EXPECT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
    return drive.fingerprint;
  };
  for (const PressureSource source : {PressureSource::none, PressureSource::wiebe}) {
    EngineDefinition engine = single_495();
    engine.train_count = 1;
    engine.trains[0] = valve_test::ohc_125_train();  // a polynomial cam
    engine.trigger_count = 1;
    engine.triggers[0].places = 60;
    engine.pressure.source = source;
    const std::uint64_t without = fingerprint(engine);
    for (const int count : {8, -1, 1 << 30}) {  // left over from a table that the caller took away
      engine.pressure.point_count = count;
      engine.trains[0].cam.point_count = count;
      engine.triggers[0].edge_count = count;
      EXPECT_EQ(fingerprint(engine), without) << count;
    }
  }
}

TYPED_TEST(TableTargetsOf, ALobeAllRoundTheCamHaveASegmentForEveryDegree) {
  using Real = TypeParam;
  EngineDefinition engine = single_495();
  engine.train_count = 1;
  engine.trains[0] = valve_test::ohc_125_train();
  engine.trains[0].cam.half_angle_deg = 180;
  engine.trains[0].rocker.kind = RockerKind::ratio;
  LiftCurve<Real> lift{};
  const auto segments = std::make_unique<LiftSegment<Real>[]>(kDegreesPerTurn);
  const auto ratios = std::make_unique<Segment<Real>[]>(kDegreesPerTurn);
  TableTargets<Real> targets;
  targets.lift_curves = &lift, targets.lift_segments = segments.get(), targets.rocker_ratios = ratios.get();
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
  EXPECT_EQ(lift.segments, 360u);
}

TYPED_TEST(TableTargetsOf, ALobeNameTheDegreesThatReachAClosedValveAndOneToEitherSide) {
  using Real = TypeParam;
  EngineDefinition engine = single_495();
  engine.train_count = 1;
  engine.trains[0] = valve_test::ohc_125_train();
  for (const double clearance_m : {20e-6, 100e-6, 300e-6}) {
    engine.trains[0].rocker.clearance_m = clearance_m;
    LiftCurve<Real> curve{};
    const auto segments = std::make_unique<LiftSegment<Real>[]>(kDegreesPerTurn);
    const auto ratios = std::make_unique<Segment<Real>[]>(kDegreesPerTurn);
    TableTargets<Real> targets;
    targets.lift_curves = &curve, targets.lift_segments = segments.get(), targets.rocker_ratios = ratios.get();
    ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
    ValveLift lift;
    ASSERT_TRUE(accepted(lift.init(engine.trains[0].cam, engine.trains[0].rocker)));
    int first = -1;
    int last = -1;
    for (int i = 0; i < static_cast<int>(curve.segments) * 100; ++i) {
      const double reach_m = lift.at(lift.opens_rad() + i / 100.0 * (elementary::kPi / 180)).lift_m;
      if (reach_m <= -kLeastLash) continue;
      if (first < 0) first = i / 100;
      last = i / 100;
    }
    ASSERT_GT(first, 0);
    ASSERT_LT(last + 1, static_cast<int>(curve.segments));
    EXPECT_EQ(curve.touch_from, static_cast<std::uint32_t>(first - 1)) << clearance_m;
    EXPECT_EQ(curve.touch_degrees, static_cast<std::uint32_t>(last - first + 3)) << clearance_m;
    EXPECT_EQ(curve.skip_deg, static_cast<Real>(last - first + 3)) << clearance_m;
  }
}

TYPED_TEST(TableTargetsOf, ALobeThatNeverReachesItsValveNameNoDegree) {
  using Real = TypeParam;
  EngineDefinition engine = single_495();
  engine.train_count = 1;
  engine.trains[0] = valve_test::ohc_125_train();
  engine.trains[0].rocker.kind = RockerKind::ratio;
  engine.trains[0].rocker.clearance_m = 10e-3;  // of a lobe of 5.9 mm
  LiftCurve<Real> curve{};
  const auto segments = std::make_unique<LiftSegment<Real>[]>(kDegreesPerTurn);
  const auto ratios = std::make_unique<Segment<Real>[]>(kDegreesPerTurn);
  TableTargets<Real> targets;
  targets.lift_curves = &curve, targets.lift_segments = segments.get(), targets.rocker_ratios = ratios.get();
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
  EXPECT_EQ(curve.touch_degrees, 0u);
  EXPECT_GT(curve.skip_deg, Real{360}) << "further than any cam angle is from it";
  CamDegrees near{}, lobe{};
  near.cylinders[7] = 1;  // left over
  targets.near_cams = &near, targets.near_lobes = &lobe;
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
  const auto marked = [](const CamDegrees& of) {
    return std::accumulate(std::begin(of.cylinders), std::end(of.cylinders), 0u);
  };
  EXPECT_EQ(marked(near), 0u) << "not even one degree of margin";
  EXPECT_EQ(marked(lobe), curve.segments + 1) << "the lobe turns by all the same";
}

TYPED_TEST(TableTargetsOf, CamDegreesNameEveryPlaceWhereACamIsNearOrEndsItsCycle) {
  using Real = TypeParam;
  using detail::CamDegrees;
  EngineDefinition engine = single_495();
  engine.train_count = 1;
  engine.trains[0] = valve_test::ohc_125_train();
  support::Random random;
  for (const double clearance_m : {0.0, 20e-6, 300e-6}) {
    engine.trains[0].rocker.clearance_m = clearance_m;
    engine.trains[0].cam.full_lift_deg = random.between(0, 360);
    LiftCurve<Real> curve{};
    CamDegrees near{}, lobe{}, ends{};
    const auto segments = std::make_unique<LiftSegment<Real>[]>(kDegreesPerTurn);
    const auto ratios = std::make_unique<Segment<Real>[]>(kDegreesPerTurn);
    TableTargets<Real> targets;
    targets.near_cams = &near, targets.near_lobes = &lobe, targets.cycle_ends = &ends;
    EXPECT_TRUE(refuses(tabulate(engine, {100e-6, {}}, targets), Reason::missing_table, "targets.lift_curves"));
    targets.lift_curves = &curve, targets.lift_segments = segments.get(), targets.rocker_ratios = ratios.get();
    ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
    for (int draw = 0; draw < 100000; ++draw) {
      const std::uint64_t phase = random.bits();
      const double turned_deg = random.between(-kCycleEndMargin_deg, kCycleEndMargin_deg);
      const auto turned = static_cast<std::uint64_t>(static_cast<std::int64_t>(turned_deg / 360 * 0x1p64));
      const Cell cell = curve.cell(phase, 0);
      const std::uint32_t degree = LiftCurve<Real>::cell(phase).degree;
      const bool may_touch = cell.degree - curve.touch_from < curve.touch_degrees;
      ASSERT_GE(near.cylinders[degree], may_touch ? 1 : 0) << random.trace(draw);
      ASSERT_GE(lobe.cylinders[degree], may_touch || cell.degree < curve.segments ? 1 : 0) << random.trace(draw);
      const std::uint64_t since = phase - curve.opens[0];
      ASSERT_GE(ends.cylinders[degree], curve.passes_base_circle(since - turned, since) ? 1 : 0) << random.trace(draw);
    }
    const auto marked = [](const CamDegrees& of) {
      return std::accumulate(std::begin(of.cylinders), std::end(of.cylinders), 0u);
    };
    EXPECT_EQ(marked(near), std::min(curve.touch_degrees + 1, std::uint32_t{kDegreesPerTurn}));
    EXPECT_LE(marked(lobe), std::max(marked(near), curve.segments + 1));
    EXPECT_EQ(marked(ends), 2u * kCycleEndMargin_deg + 3);
  }
}

TYPED_TEST(TableTargetsOf, AGridThatExactlyFitsAreFilledAsWithRoomToSpare) {
  using Real = TypeParam;
  GasGrid grid{};
  const auto filled = [&grid](int capacity) {
    TableTargets<Real> targets;
    targets.gas_grid = &grid;
    targets.gas_capacity = capacity;
    TableReport report{};
    EXPECT_TRUE(accepted(tabulate(single_495(), {100e-6, {}}, targets, &report))) << capacity;
    return report;
  };
  const TableReport spare = filled(kMaxGasSegments);
  ASSERT_EQ(spare.tolerance_doublings, 0);
  ASSERT_GT(spare.gas_segments, 720) << "steeper than a segment a degree can follow";
  const TableReport fits = filled(spare.gas_segments);
  EXPECT_EQ(fits.tolerance_doublings, 0);
  EXPECT_EQ(fits.gas_segments, spare.gas_segments);
  EXPECT_EQ(fits.pressure_error_Pa, spare.pressure_error_Pa);
  EXPECT_EQ(grid.first[kDegreesPerCycle], spare.gas_segments);
  const TableReport short_of_one = filled(spare.gas_segments - 1);
  EXPECT_GT(short_of_one.tolerance_doublings, 0);
  EXPECT_LT(short_of_one.gas_segments, spare.gas_segments);
  EXPECT_GT(short_of_one.pressure_error_Pa, spare.pressure_error_Pa);
}

TYPED_TEST(TableTargetsOf, AGridAreDividedWhereOneParabolaLessWouldMissTheDiagramAndNowhereElse) {
  using Real = TypeParam;
  EngineDefinition engine = single_495();
  engine.pressure.wiebe.combustion_duration_deg = 15;  // as steep as knocking
  GasGrid grid{};
  const auto segments = std::make_unique<Segment<Real>[]>(kMaxGasSegments);
  TableTargets<Real> targets;
  targets.gas_grid = &grid;
  targets.pressure_full = segments.get();
  targets.gas_capacity = kMaxGasSegments;
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
  IndicatorDiagram diagram;
  ASSERT_TRUE(accepted(diagram.init(engine.crank, engine.pressure)));
  const double tolerance_Pa = 1e-5 * diagram.peak_Pa();
  const double rounding_Pa = (sizeof(Real) == 4 ? 1e-6 : 1e-14) * diagram.peak_Pa();
  const int divisions[] = {1, 2, 5, 10, 20};
  int divided = 0;
  for (int degree = 0; degree < kDegreesPerCycle; ++degree) {
    const int n = grid.first[degree + 1] - grid.first[degree];
    const int* const division = std::find(std::begin(divisions), std::end(divisions), n);
    ASSERT_NE(division, std::end(divisions)) << degree;
    double error_Pa = 0;
    for (int i = 0; i <= 60; ++i) {
      const double u = i / 60.0;
      const int segment = grid.first[degree] + std::min(n - 1, i * n / 60);
      error_Pa = std::max(
          error_Pa,
          std::fabs(static_cast<double>(value(segments[static_cast<std::size_t>(segment)], static_cast<Real>(u))) -
                    diagram.full_Pa(degree + u)));
    }
    // An undivided degree is judged at ten places, between which it may be a little further off.
    if (n < 20) {
      EXPECT_LE(error_Pa, 1.05 * tolerance_Pa + rounding_Pa) << degree;
    }
    if (n == 1) continue;
    ++divided;
    // Parabolas through both ends and the middle of the next coarser segments.
    const int coarser = *(division - 1);
    double missed_Pa = 0;
    for (int s = 0; s < coarser; ++s) {
      for (const auto part : {&IndicatorDiagram::full_Pa, &IndicatorDiagram::heat_Pa}) {
        const auto at = [&](double t) { return (diagram.*part)(degree + (s + t) / coarser); };
        const double rise_Pa = at(1) - at(0);
        double bulge_Pa = 4 * at(0.5) - 2 * (at(0) + at(1));
        bulge_Pa = std::clamp(bulge_Pa, -std::fabs(rise_Pa), std::fabs(rise_Pa));  // as monotone as the diagram
        for (double t = 0.05; t < 1; t += 0.05) {
          const double parabola_Pa = at(0) + rise_Pa * t + bulge_Pa * t * (1 - t);
          missed_Pa = std::max(missed_Pa, std::fabs(parabola_Pa - at(t)));
        }
      }
    }
    EXPECT_GE(missed_Pa, 0.95 * tolerance_Pa - rounding_Pa) << degree << " in " << n;
  }
  EXPECT_GE(divided, 10);
  EXPECT_LT(divided, 200) << "most of a cycle needs no division";
}

TYPED_TEST(TableTargetsOf, AnEdgeOfACamHaveTheStressOfANanometresRadius) {
  // The nose's radius of curvature is 1e-12 m where the table is read, at one of the places through which it is fitted.
  using Real = TypeParam;
  const double of_degree = node<Real>(0, 0, 1);
  EngineDefinition engine = single_495();
  engine.train_count = 1;
  ValveTrain& train = engine.trains[0] = valve_test::ohc_125_train();
  train.cam = support::polynomial_cam(8e-3, 60 + of_degree, {2, 4, 6, 8});
  CamProfile profile;
  ASSERT_TRUE(accepted(profile.init(train.cam)));
  const CamLift nose = profile.at(0);
  train.rocker = support::direct_rocker(-(nose.lift_m + nose.per_rad2_m) + 1e-12, 0.1e-3);
  train.valve.rocker_inertia_kg_m2 = 0;
  engine.contacts[0].width_m = 9e-3;
  ASSERT_TRUE(accepted(validate(engine)));
  LiftCurve<Real> lift{};
  CamContactCurve<Real> curve{};
  const auto segments = std::make_unique<LiftSegment<Real>[]>(kDegreesPerTurn);
  const auto ratios = std::make_unique<Segment<Real>[]>(kDegreesPerTurn);
  const auto sliding = std::make_unique<Segment<Real>[]>(kDegreesPerTurn);
  const auto contacts = std::make_unique<CamContactSegment<Real>[]>(kDegreesPerTurn);
  TableTargets<Real> targets;
  targets.lift_curves = &lift, targets.lift_segments = segments.get(), targets.rocker_ratios = ratios.get();
  targets.cam_contacts = &curve, targets.cam_sliding = sliding.get(), targets.cam_contact_segments = contacts.get();
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
  const double edge_Pa = hertz_contact(engine.contacts[0], 1e9, 1).largest_Pa;
  EXPECT_NEAR(static_cast<double>(value(contacts[60].stress, static_cast<Real>(of_degree))) / edge_Pa, 1, 1e-3);
  for (std::uint32_t row = 0; row < lift.segments; ++row) {
    for (const Real c : contacts[row].stress.c) ASSERT_TRUE(std::isfinite(c)) << row;
  }
}

TYPED_TEST(TableTargetsOf, ACutCylinderLacksTheTorqueOfItsOwnCycleWheneverItFires) {
  using Real = TypeParam;
  const auto torques = [](const std::vector<double>& firing_deg) {
    const auto segments = std::make_unique<IntegratedSegment<Real>[]>(kMaxGasSegments);
    GasGrid grid{};
    GasTorque<Real> torque{};
    TableTargets<Real> targets;
    targets.cut_grid = &grid;
    targets.cut_torque = &torque;
    targets.cut_heat = segments.get();
    targets.gas_capacity = kMaxGasSegments;
    EXPECT_TRUE(accepted(tabulate(with_cylinders(single_495(), firing_deg), {100e-6, {}}, targets)));
    std::vector<Real> at_degrees;
    for (int degree = 0; degree < kDegreesPerCycle; ++degree)
      at_degrees.push_back(value(segments[grid.first[degree]].slope, Real{0}));
    return at_degrees;
  };
  const std::vector<Real> alone = torques({0});
  EXPECT_EQ(torques({90, 450}), alone);
  EXPECT_GT(alone[20], Real{100}) << "Nm, soon after firing";
  EXPECT_EQ(alone[300], Real{0}) << "nothing is left of the heat in the exhaust stroke";
}

TEST(SineWithinADegree, IsThatOfTheStandardLibraryToRounding) {
  for (int i = 0; i <= 1000; ++i) {
    const double rad = i / 1000.0 * (elementary::kPi / 180);
    const elementary::SinCos found = sin_cos_within_a_degree(i / 1000.0);
    EXPECT_NEAR(found.sin, std::sin(rad), 4e-16 * rad) << i;
    EXPECT_NEAR(found.cos, std::cos(rad), 2.3e-16) << i;
  }
}

TYPED_TEST(TableTargetsOf, MotionsWithoutLiftsAreFilledAsWithThem) {
  using Real = TypeParam;
  EngineDefinition engine = single_495();
  engine.train_count = 1;
  engine.trains[0] = valve_test::ohc_125_train();
  LiftCurve<Real> lift{};
  const auto segments = std::make_unique<LiftSegment<Real>[]>(kDegreesPerTurn);
  const auto ratios = std::make_unique<Segment<Real>[]>(kDegreesPerTurn);
  ValveMotion<Real> alone{};
  ValveMotion<Real> with_lift{};
  TableTargets<Real> targets;
  targets.valve_motions = &alone;
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
  targets.valve_motions = &with_lift;
  targets.lift_curves = &lift, targets.lift_segments = segments.get(), targets.rocker_ratios = ratios.get();
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets)));
  EXPECT_GT(alone.body.mass_kg, Real{0});
  EXPECT_EQ(alone.whole[kTrainOn].lift.lift, with_lift.whole[kTrainOn].lift.lift);
  EXPECT_EQ(alone.cubic_deg, with_lift.cubic_deg);
  EXPECT_EQ(alone.widest_step_deg, with_lift.widest_step_deg);
}

TYPED_TEST(TableTargetsOf, AValveTakesNoStepOverWhichACubicWouldMissItsLift) {
  // Through lift and slope at the ends of a step the cubic misses h^4 / 384 of the fourth derivative; three times the
  // width that misses a tenth of the accuracy misses 8.1 times the accuracy, at the sharpest place of the lobe; less
  // where the derivative falls within the step.
  using Real = TypeParam;
  for (const double last_exponent : {20.0, 26.0, 40.0}) {
    EngineDefinition engine = single_495();
    engine.train_count = 1;
    engine.trains[0] = valve_test::ohc_125_train();
    engine.trains[0].cam.exponents[3] = last_exponent;
    engine.trains[0].rocker.kind = RockerKind::ratio;
    ValveMotion<Real> motion{};
    TableTargets<Real> targets;
    targets.valve_motions = &motion;
    TickOptions options;
    options.valves.accuracy_m = 0.01e-6;
    ASSERT_TRUE(accepted(tabulate(engine, options, targets)));
    ValveLift lift;
    ASSERT_TRUE(accepted(lift.init(engine.trains[0].cam, engine.trains[0].rocker)));
    const double width = static_cast<double>(motion.widest_step_deg) * support::kRadPerDeg;
    double missed_m = 0;
    for (double from = lift.opens_rad() - width; from < lift.closes_rad(); from += width / 50) {
      const LiftPose a = lift.at(from);
      const LiftPose b = lift.at(from + width);
      const double middle_m = (a.lift_m + b.lift_m) / 2 + width * (a.per_rad_m - b.per_rad_m) / 8;
      missed_m = std::max(missed_m, std::fabs(middle_m - lift.at(from + width / 2).lift_m));
    }
    EXPECT_LE(missed_m, 1.05 * 8.1 * options.valves.accuracy_m) << last_exponent;
    EXPECT_GE(missed_m, 0.6 * 8.1 * options.valves.accuracy_m) << last_exponent;
  }
}

TYPED_TEST(TableTargetsOf, ALobeThatACubicNeverMissesHaveStepsOfUpToATurn) {
  // A nanometre of lift over the whole turn: no cubic is off by the accuracy of 10 um.
  using Real = TypeParam;
  EngineDefinition engine = single_495();
  engine.train_count = 1;
  engine.trains[0] = valve_test::ohc_125_train();
  engine.trains[0].cam.half_angle_deg = 180;
  engine.trains[0].cam.max_lift_m = 1e-9;
  engine.trains[0].rocker.kind = RockerKind::ratio;
  ValveMotion<Real> motion{};
  TableTargets<Real> targets;
  targets.valve_motions = &motion;
  TickOptions options;
  options.valves.accuracy_m = 10e-6;
  ASSERT_TRUE(accepted(tabulate(engine, options, targets)));
  EXPECT_EQ(motion.cubic_deg, Real{360});
  EXPECT_EQ(motion.widest_step_deg, Real{360});
}

TYPED_TEST(TableTargetsOf, ValvesTellTheFineStepsOfTheWorstTickAndRefuseTooMany) {
  using Real = TypeParam;
  EngineDefinition engine = with_cylinders(single_495(), {0, 540, 180, 360});
  engine.train_count = 2;
  engine.trains[0] = engine.trains[1] = valve_test::ohc_125_train();
  ValveMotion<Real> motions[kMaxTrains]{};
  TableTargets<Real> targets;
  targets.valve_motions = motions;
  TableReport report;
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets, &report)));
  EXPECT_EQ(report.valve_fine_steps, 8 * 5)
      << "42 900 rad/s on the seat, 100 us: five fine steps for each of eight valves";
  EXPECT_EQ(report.event_budget, 8 * 5 + 2 * 2 * (8 * 5 + 8))
      << "every fine step, two events in each and two more of each valve";
  EXPECT_EQ(motions[1].event_budget, 232u);
  // In a fine step of the widest tick that keeps the class, the cubic through its ends misses the lift by less than
  // that, but not by far less: the bound takes the lift's largest fourth derivative for that of the whole step.
  const ValveLift lift = valve_test::lift_of(engine.trains[0]);
  const double wide_rad = report.valve_class_deg / 5 * support::kRadPerDeg;
  ASSERT_GT(report.valve_class_deg, 1);
  double missed_m = 0;
  for (double from_rad = lift.opens_rad(); from_rad + wide_rad < lift.closes_rad(); from_rad += wide_rad / 8) {
    const LiftPose from = lift.at(from_rad), middle = lift.at(from_rad + wide_rad / 2),
                   to = lift.at(from_rad + wide_rad);
    const double cubic_m = (from.lift_m + to.lift_m) / 2 + wide_rad * (from.per_rad_m - to.per_rad_m) / 8;
    missed_m = std::fmax(missed_m, std::fabs(middle.lift_m - cubic_m));
  }
  EXPECT_LT(missed_m, 0.1e-6);
  EXPECT_GT(missed_m, 0.02e-6);
  EngineDefinition valveless = engine;
  valveless.train_count = 0;
  ASSERT_TRUE(accepted(tabulate(valveless, {100e-6, {}}, targets, &report)));
  EXPECT_EQ(report.valve_fine_steps, 0);
  EXPECT_EQ(report.event_budget, 0);
  // Sixteen cylinders with four trains as stiff as a valve can be: each by itself would do, all together would take
  // some ms for a tick of 0.1 ms.
  std::vector<double> firing_deg;
  for (int k = 0; k < 16; ++k) firing_deg.push_back(45.0 * k);
  EngineDefinition many = with_cylinders(single_495(), firing_deg);
  many.train_count = 4;
  for (ValveTrain& train : many.trains) {
    train = valve_test::ohc_125_train();
    train.valve.train_N_m = 4.5e10;
  }
  EXPECT_TRUE(refuses(tabulate(many, {100e-6, {}}, targets, &report), Reason::out_of_range, "options.tick_s", 2));
  many.train_count = 2;
  EXPECT_TRUE(accepted(tabulate(many, {100e-6, {}}, targets, &report)));
}

}  // namespace
}  // namespace crankloop::table_targets_test

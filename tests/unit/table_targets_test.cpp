// tabulate() into sections of the caller's own: what belongs together is refused where a part is missing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tabulate/valve_lift.hpp>

#include "support/both_reals.hpp"
#include "support/status.hpp"
#include "support/test_engines.hpp"
#include "support/test_valves.hpp"

namespace crankloop {

using namespace detail;
namespace {

using support::refuses;
using namespace tick_test;

template <class Real>
class TableTargetsOf : public ::testing::Test {};
TYPED_TEST_SUITE(TableTargetsOf, BothReals, RealName);

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
}

TYPED_TEST(TableTargetsOf, AnEngineThatHasEverythingFillEverySection) {
  using Real = TypeParam;
  EngineDefinition engine = single_495();
  engine.train_count = 1;
  engine.trains[0] = valve_test::ohc_125_train();
  engine.trigger_count = 1;
  engine.triggers[0].places = 60;
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
  EXPECT_EQ(alone.widest_step_deg, with_lift.widest_step_deg);
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
  EXPECT_EQ(report.valve_changes, 4 + 5);
  EXPECT_EQ(motions[1].most_changes, 9u);
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
}  // namespace crankloop

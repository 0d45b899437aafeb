// tabulate() into sections of the caller's own: what belongs together is refused where a part is missing.
#include <gtest/gtest.h>

#include <memory>

#include <crankloop/tabulate/tabulate.hpp>

#include "support/both_reals.hpp"
#include "support/status.hpp"
#include "support/test_engines.hpp"

namespace crankloop {
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

  for (auto Targets::*one : {&Targets::pressure_full, &Targets::pressure_motored, &Targets::pressure_heat}) {
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

TYPED_TEST(TableTargetsOf, AnEngineOfAnImpossibleNumberOfTrainsAreNotFilled) {
  using Real = TypeParam;
  Drive<Real> drive{};
  TableTargets<Real> targets;
  targets.drive = &drive;
  EngineDefinition engine = single_495();
  for (const int trains : {-1, kMaxTrains + 1, 1 << 30}) {
    engine.train_count = trains;
    EXPECT_TRUE(refuses(tabulate(engine, {100e-6, {}}, targets), Reason::out_of_range, "trains")) << trains;
  }
  EXPECT_EQ(drive.cylinders, 0u) << "nothing is written by a refusal";
}

}  // namespace
}  // namespace crankloop

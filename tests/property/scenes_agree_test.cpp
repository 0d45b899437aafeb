// A scene that leaves outputs out gives the same bits in what it keeps: each output group alone, the pairs that share
// look-ups or sums, and all groups but one; for engines of 1 to 8 cylinders, even and uneven firing, pressures from
// tables, with load, from outside or none.
//
// One rule has a reason of its own: with forces asked for, the torque at the tick is their sum, without them it is read
// from curves. So scenes with forces are compared among themselves, and scenes without.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "support/scene_record.hpp"
#include "support/status.hpp"

namespace crankloop::scenes_agree_test {
namespace {

using namespace tick_test;

struct Named {
  std::string name;
  EngineDefinition engine;
};
std::vector<Named> engines() {
  const EngineDefinition one = single_495();
  EngineDefinition v8 = with_cylinders(one, {0, 90, 270, 180, 630, 540, 450, 360});
  return {{"one cylinder", one},
          {"three", with_cylinders(one, {0, 240, 480})},
          {"the 495", diesel_495()},
          {"uneven V4", uneven_v4()},
          {"inline six", with_cylinders(one, {0, 480, 240, 600, 120, 360})},
          {"cross-plane eight", v8},
          {"six that fire at odd angles", with_cylinders(one, {3.7, 719.99, 360.3, 0.3, 363.7, 100})}};
}

/// Bearing loads are made from forces: no scene has them without.
constexpr unsigned kWithBearings = unsigned{kForces} | kBearingLoads;
constexpr unsigned kWithoutForces = kAllGroups & ~kWithBearings;

/// Runs the scenes that ask for `Groups`, one after the other, against the ones that ask for all, with forces or
/// without.
template <class Real, PressureGiven Source, bool ByLoad, unsigned... Groups>
void expect_subsets_to_agree() {
  for (const Named& n : engines()) {
    SCOPED_TRACE(n.name);
    FullTables<Real> tables;
    ASSERT_TRUE(accepted(tables.build(n.engine, kLifeTick_s, kLifeGasSegments)));
    const Record with = record_of<Real, Asking<kAllGroups, Source, ByLoad>>(tables);
    const Record without = record_of<Real, Asking<kWithoutForces, Source, ByLoad>>(tables);
    expect_same(with, without, kKinematics | kRodMotion | kFreeForces);  // what does not come from forces
    (expect_same(record_of<Real, Asking<Groups, Source, ByLoad>>(tables), (Groups & kForces) != 0 ? with : without,
                 Groups),
     ...);
  }
}

/// What pressure and scalar change is torque and forces: each alone, and together.
template <class Real, PressureGiven Source, bool ByLoad>
void expect_torque_and_forces_to_agree() {
  expect_subsets_to_agree<Real, Source, ByLoad, kTorque, kMeanTorque, kForces, kForces | kMeanTorque>();
}

TEST(ScenesAgree, EachGroupAlone) {
  expect_subsets_to_agree<float, PressureGiven::by_table, false, kKinematics, kRodMotion, kTorque, kMeanTorque, kForces,
                          kWithBearings, kFreeForces>();
}
TEST(ScenesAgree, PairsThatShareLookUpsOrSums) {
  expect_subsets_to_agree<float, PressureGiven::by_table, false, kKinematics | kRodMotion, kKinematics | kMeanTorque,
                          kKinematics | kForces, kRodMotion | kForces, kTorque | kMeanTorque, kForces | kTorque,
                          kForces | kMeanTorque, kRodMotion | kFreeForces>();
}
TEST(ScenesAgree, AllGroupsButOne) {
  expect_subsets_to_agree<float, PressureGiven::by_table, false, kAllGroups & ~kKinematics, kAllGroups & ~kRodMotion,
                          kAllGroups & ~kTorque, kAllGroups & ~kMeanTorque, kAllGroups & ~kBearingLoads,
                          kAllGroups & ~kFreeForces>();
}
TEST(ScenesAgree, TorqueAndForcesByLoad) { expect_torque_and_forces_to_agree<float, PressureGiven::by_table, true>(); }
TEST(ScenesAgree, TorqueAndForcesByMeasuredPressure) {
  expect_torque_and_forces_to_agree<float, PressureGiven::by_input, false>();
}
TEST(ScenesAgree, TorqueAndForcesWithoutGas) { expect_torque_and_forces_to_agree<float, PressureGiven::none, false>(); }
TEST(ScenesAgree, TorqueAndForcesByLoadInDouble) {
  expect_torque_and_forces_to_agree<double, PressureGiven::by_table, true>();
}
TEST(ScenesAgree, TorqueAndForcesByMeasuredPressureInDouble) {
  expect_torque_and_forces_to_agree<double, PressureGiven::by_input, false>();
}

}  // namespace
}  // namespace crankloop::scenes_agree_test

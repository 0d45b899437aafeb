// docs/contract.md "What init refuses", and build where a scene lacks the room: each by its reason, leaving an engine
// that is not ready.
#include <gtest/gtest.h>

#include <memory>

#include "support/both_reals.hpp"
#include "support/kept_engines.hpp"
#include "support/status.hpp"

namespace crankloop::init_refusal_test {

using namespace detail;
namespace {

using namespace tick_test;
using support::refuses;

template <class Real>
class InitRefusal : public ::testing::Test {
 protected:
  using S = FourWithValves;

  InitRefusal() : tables_{tables_of_four<Real, S>().tables()}, drive_{*tables_.drive} { tables_.drive = &drive_; }

  /// Of tables that were changed: an engine that ran answers zeros afterwards.
  [[nodiscard]] Status refusal() {
    const auto engine = started_four<Real, S>();
    const Status status = engine->init(tables_);
    EXPECT_EQ(engine->tables(), nullptr);
    EXPECT_EQ(engine->step({}).faults, std::uint32_t{kFaultNotReady});
    EXPECT_EQ(engine->output().torque_Nm, Real{0});
    EXPECT_TRUE(refuses(engine->restore(engine->state()), Reason::missing_table, "tables"));
    return status;
  }

  Tables<Real, S> tables_;
  Drive<Real> drive_;
};
TYPED_TEST_SUITE(InitRefusal, BothReals, RealName);

TYPED_TEST(InitRefusal, OfASectionThatIsMissing) {
  const auto whole = this->tables_;
  this->tables_.lift_curves = nullptr;
  EXPECT_TRUE(refuses(this->refusal(), Reason::missing_table, "tables"));
  this->tables_ = whole;
  this->tables_.valve_motions = nullptr;
  EXPECT_TRUE(refuses(this->refusal(), Reason::missing_table, "tables"));
  this->tables_ = whole;
  this->tables_.drive = nullptr;
  EXPECT_TRUE(refuses(this->refusal(), Reason::missing_table, "tables"));
}

TYPED_TEST(InitRefusal, OfAnotherNumberOfCylindersOrTrains) {
  for (const std::uint32_t cylinders : {0u, 3u, 5u, ~0u}) {
    this->drive_.cylinders = cylinders;
    EXPECT_TRUE(refuses(this->refusal(), Reason::out_of_range, "tables.cylinders")) << cylinders;
  }
  this->drive_.cylinders = 4;
  for (const std::uint32_t trains : {0u, 1u, 3u}) {
    this->drive_.trains = trains;
    EXPECT_TRUE(refuses(this->refusal(), Reason::out_of_range, "tables.trains")) << trains;
  }
}

TYPED_TEST(InitRefusal, OfGasOnValveHeadsThatTheSceneLeavesOut) {
  using Real = TypeParam;
  ValveMotion<Real> motions[] = {this->tables_.valve_motions[0], this->tables_.valve_motions[1]};
  motions[1].body.head_area_m2 = static_cast<Real>(1e-4);
  this->tables_.valve_motions = motions;
  EXPECT_TRUE(refuses(this->refusal(), Reason::inconsistent, "scene.valve_gas", 1));
}

TYPED_TEST(InitRefusal, OfMoreTrainsThanTheSceneHasRoomForComesWithBuild) {
  using Real = TypeParam;
  EngineDefinition engine = four_with_valves();
  engine.train_count = 3;
  engine.trains[2] = engine.trains[1];
  const auto storage = std::make_unique<TableStorage<Real, FourWithValves>>();
  EXPECT_TRUE(refuses(storage->build(engine, {50e-6, {}}), Reason::out_of_range, "scene.trains"));
}

}  // namespace
}  // namespace crankloop::init_refusal_test

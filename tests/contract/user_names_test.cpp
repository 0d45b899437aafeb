// A user's file may open the namespace and name its scenes and things as it likes: what the tick is made of takes no
// name away.
#include <gtest/gtest.h>

#include <memory>

#include <crankloop/crankloop.hpp>
#include <crankloop/tick/step.hpp>

#include "support/engines.hpp"
#include "support/status.hpp"

using namespace crankloop;

struct Torque : Scene {
  static constexpr auto cylinders = exactly<4>;
  static constexpr auto pressure = PressureGiven::by_table;
  static constexpr bool torque = true;
};
struct Valves : Scene {
  static constexpr auto valves = ValveModel::following;
};
struct Lift {};
struct Body {};
struct Drive {};
struct Cell {};
struct Forces {};
struct Curve {};
int value(Lift) { return 1; }
int unknown(Cell) { return 2; }

TEST(UserNames, AreTheUsers) {
  const auto storage = std::make_unique<TableStorage<float, Torque>>();
  ASSERT_TRUE(accepted(storage->build(support::diesel_495(), {100e-6})));
  Engine<float, Torque> engine;
  ASSERT_TRUE(accepted(engine.init(storage->tables())));
  Engine<float, Torque>::Input input;
  input.speed_rad_s = 150;
  EXPECT_EQ(0u, engine.step(input).faults);
  EXPECT_EQ(3, value(Lift{}) + unknown(Cell{}));
  EXPECT_FALSE((std::is_same_v<Body, Drive>));
  EXPECT_TRUE((std::is_empty_v<Forces> && std::is_empty_v<Curve>));
  EXPECT_EQ(1u, Valves::trains.capacity);
}

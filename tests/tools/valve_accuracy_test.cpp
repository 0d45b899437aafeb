// Ticks that turn a cam so far that its valve misses the accuracy class: found, said, and by how much.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "crankloop/loops/valve_accuracy.hpp"
#include "crankloop/loops/valve_tick_limit.hpp"
#include "support/random.hpp"
#include "support/test_valves.hpp"
#include "support/valve_runs.hpp"

namespace crankloop::program::valve_accuracy_test {
namespace {

constexpr double kUm = 1e-6;
constexpr double kFactor = 3;
constexpr double kShare = 0.95;

/// Against the converged reference, over a cycle from rest, from twelve other places of the base circle.
double true_error_m(const LoneValve& valve, double rpm, double tick_s) {
  const ValveTrain& train = valve.definition().trains[0];
  const double speed = valve_test::rad_s_of_rpm(rpm);
  double worst_m = 0;
  for (int start = 0; start < 12; ++start) {
    const double cam_deg = -180 + (start + 0.4) / 12 * 3 * rpm * tick_s;
    valve_test::SideBySide<double> both(train, {tick_s, {}}, train.cam.full_lift_deg + 2 * cam_deg);
    worst_m = std::max(worst_m, both.worst_over(both.rig.ticks_per_cycle(speed), speed));
  }
  return worst_m;
}

TEST(ValveAccuracy, OfRandomTrainsInTicksOfManyDegreesIsExpectedWithinAFactorOfThree) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve as_given(file, "intake");
  support::Random random;
  int beyond = 0;
  int within = 0;
  for (int draw = 0; draw < 400 && beyond < 20; ++draw) {
    Valve drawn = as_given.valve();
    drawn.valve_kg = random.between(0.02, 0.2);
    drawn.train_N_m *= std::pow(10, random.between(-1, 0.5));
    drawn.seat_N_m *= std::pow(10, random.between(-1.5, 0));
    drawn.train_damping_ratio = random.between(0.02, 1);
    drawn.seat_damping_ratio = random.between(0.05, 1);
    drawn.spring_preload_N *= random.between(0.7, 3);
    const LoneValve valve = as_given.with(drawn);
    const double rpm = random.between(6000, 20000);
    const double tick_s = std::min(2e-3, random.between(10, 80) / (3 * rpm));
    if (3 * rpm * tick_s < class_deg(valve.definition().trains[0], tick_s, {})) continue;
    const double expected_m = expected_error_m(valve, rpm, tick_s, {});
    if (expected_m <= 0.1 * kUm) continue;
    const double found_m = true_error_m(valve, rpm, tick_s);
    ++beyond;
    const bool right = found_m <= kFactor * expected_m && expected_m <= kFactor * found_m;
    within += right ? 1 : 0;
    if (!right)
      std::printf("%.0f rpm, %.0f us, %.1f degrees: expected %.3g um, found %.3g um\n", rpm, tick_s * 1e6,
                  3 * rpm * tick_s, expected_m / kUm, found_m / kUm);
  }
  std::printf("[ figures  ] %d trains beyond their class, %d within a factor of %.0f\n", beyond, within, kFactor);
  EXPECT_EQ(beyond, 20);
  EXPECT_GE(within, kShare * beyond);
}

TEST(ValveAccuracy, IsNotDoubtedInUsualTicks) {
  const EngineFile file = read_engine_file(kOhc125, {});
  for (const double tick_s : {20e-6, 100e-6}) EXPECT_TRUE(warnings_about_valves(file, 9000, tick_s).empty());
  EXPECT_TRUE(warnings_about_valves(file, 0, 2e-3).empty());
}

TEST(ValveAccuracy, IsWarnedOfWithItsFigures) {
  const ChangedFile soft_train(kOhc125, "train_N_per_mm", "train_N_per_mm = 1200");
  const ChangedFile soft(soft_train.path().c_str(), "seat_N_per_mm", "seat_N_per_mm = 3000");
  const EngineFile file = read_engine_file(soft.path(), {});
  const std::vector<std::string> lines = warnings_about_valves(file, 14000, 1.5e-3);
  ASSERT_EQ(lines.size(), 1u);
  for (const char* part : {"engine.ini: warning: at 14000 rpm a tick of 1500 us", "train intake", "by 63 cam degrees",
                           " um; it keeps the class of 0.1 um up to "}) {
    EXPECT_NE(lines[0].find(part), std::string::npos) << part << " in: " << lines[0];
  }
}

}  // namespace
}  // namespace crankloop::program::valve_accuracy_test

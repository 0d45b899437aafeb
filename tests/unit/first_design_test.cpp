// Masses of a first design: docs/model.md "First-design masses", row by row.
#include <crankloop/tabulate/first_design.hpp>

#include <gtest/gtest.h>

namespace crankloop::first_design_test {
namespace {

TEST(FirstDesign, HasTheRowOfItsKindAndRatedSpeed) {
  // At a bore of 100 mm, 0.00785398 m^2, m' = 1.08 D is 108 kg/m^2.
  constexpr double kBore_m = 0.1;
  constexpr double kPerMultiple_kg = 100 * 0.785398163397e-2;
  const struct {
    EngineKind kind;
    double speed_rpm;
    Interval piston, rod, pin_share_inline, pin_share_v;
  } rows[] = {
      {EngineKind::spark_ignition, 4499, {1.08, 1.2}, {1.35, 1.45}, {0.26, 0.28}, {0.28, 0.30}},
      {EngineKind::spark_ignition, 4500, {1.2, 1.25}, {1.7, 2.0}, {0.26, 0.28}, {0.28, 0.30}},
      {EngineKind::diesel, 2999, {1.8, 2.0}, {2.1, 2.25}, {0.26, 0.30}, {0.30, 0.34}},
      {EngineKind::diesel, 3000, {1.5, 1.7}, {1.6, 1.9}, {0.22, 0.23}, {0.22, 0.23}},
      {EngineKind::tractor_diesel, 2000, {2.0, 2.2}, {2.3, 2.5}, {0.26, 0.30}, {0.30, 0.34}},
      {EngineKind::tractor_diesel, 6000, {2.0, 2.2}, {2.3, 2.5}, {0.26, 0.30}, {0.30, 0.34}},
  };
  for (const auto& row : rows) {
    const FirstDesign design = first_design(row.kind, kBore_m, row.speed_rpm);
    const auto expect = [&](const Interval& got, const Interval& want, double unit) {
      EXPECT_NEAR(got.least, want.least * unit, 1e-9) << row.speed_rpm;
      EXPECT_NEAR(got.most, want.most * unit, 1e-9) << row.speed_rpm;
    };
    expect(design.piston_kg, row.piston, kPerMultiple_kg);
    expect(design.rod_kg, row.rod, kPerMultiple_kg);
    expect(design.pin_share_inline, row.pin_share_inline, 1);
    expect(design.pin_share_v, row.pin_share_v, 1);
  }
}

}  // namespace
}  // namespace crankloop::first_design_test

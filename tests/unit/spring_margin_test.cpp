// Spring margin and static redline: against lobes whose curvature has a formula, against differences of the lift, and
// where there is none.
#include <crankloop/tabulate/spring_margin.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <vector>

#include "crankloop/engine_file/engine_file.hpp"
#include "support/measured_cam.hpp"
#include "support/test_valves.hpp"

namespace crankloop::spring_margin_test {
namespace {

using detail::ValveBody;
using support::direct_rocker;
using support::kPi;
using support::kRadPerDeg;
using support::polynomial_cam;
using support::Random;
using valve_test::body_of;
using valve_test::lift_of;

constexpr double kMaxLift_m = 6e-3;
constexpr double kHalfAngle_deg = 70;
constexpr double kHalfAngle_rad = kHalfAngle_deg * kRadPerDeg;
constexpr double kMass_kg = 0.08;
constexpr double kPreload_N = 250;

/// A train whose moving mass is kMass_kg.
ValveTrain train_of(const Cam& cam, const Rocker& rocker, double spring_N_m) {
  ValveTrain train;
  train.cam = cam;
  train.rocker = rocker;
  train.valve = support::ohc_125_valve();
  train.valve.valve_kg = 0.06;
  train.valve.spring_kg = 0.06;
  train.valve.rocker_inertia_kg_m2 = 0;
  train.valve.spring_preload_N = kPreload_N;
  train.valve.spring_N_m = spring_N_m;
  return train;
}

StaticRedline redline_of(const ValveTrain& train) { return static_redline(lift_of(train), body_of(train)); }

/// The crank turns twice as fast as the cam.
double crank_rad_s(double spring_N, double curvature_m) { return 2 * std::sqrt(spring_N / (kMass_kg * curvature_m)); }

// ---- lobes with a formula ----

TEST(StaticRedlineOf, ALobeThatCurvesMostAtItsNoseIsThere) {
  // y = y_max (1 - u^2)^2, so y'' = -4 y_max / half_angle^2 at the nose.
  for (double ratio = 0.8; ratio < 1.6; ratio += 0.01) {
    const ValveTrain train =
        train_of(polynomial_cam(kMaxLift_m, kHalfAngle_deg, {2, 4}), direct_rocker(16e-3, 0.2e-3, ratio), 30e3);
    const double lift_m = ratio * kMaxLift_m - 0.2e-3;
    const double curvature_m = ratio * 4 * kMaxLift_m / (kHalfAngle_rad * kHalfAngle_rad);
    const double expected = crank_rad_s(kPreload_N + 30e3 * lift_m, curvature_m);
    const StaticRedline found = redline_of(train);
    EXPECT_NEAR(found.crank_rad_s, expected, 1e-12 * expected) << ratio;
    EXPECT_EQ(found.cam_deg, 0) << ratio;
    EXPECT_FALSE(std::signbit(found.cam_deg)) << ratio;
  }
}

TEST(StaticRedlineOf, AFlatterNoseIsOnTheFlank) {
  // y = y_max (1 - 5/4 v + 1/4 v^5), v = u^2, so y'' = -5/2 y_max / half_angle^2 (1 - 9 v^4). Of its ratio to the
  // spring's force the derivative by v changes its sign once.
  const double spring_N_m = 60e3;
  const double stiff_N = spring_N_m * kMaxLift_m;
  const auto spring_N = [&](double v) { return kPreload_N + stiff_N * (1 - 1.25 * v + 0.25 * std::pow(v, 5)); };
  double low = 0;
  double high = std::pow(9, -0.25);
  for (int i = 0; i < 60; ++i) {
    const double v = (low + high) / 2;
    const double rise =
        -36 * v * v * v * spring_N(v) + (1 - 9 * std::pow(v, 4)) * stiff_N * 1.25 * (1 - std::pow(v, 4));
    (rise > 0 ? low : high) = v;
  }
  const double curvature_m = 2.5 * kMaxLift_m / (kHalfAngle_rad * kHalfAngle_rad) * (1 - 9 * std::pow(low, 4));
  const double expected = crank_rad_s(spring_N(low), curvature_m);
  const StaticRedline found =
      redline_of(train_of(polynomial_cam(kMaxLift_m, kHalfAngle_deg, {2, 10}), direct_rocker(16e-3, 0), spring_N_m));
  EXPECT_NEAR(found.crank_rad_s, expected, 1e-11 * expected);
  EXPECT_NEAR(found.cam_deg, -std::sqrt(low) * kHalfAngle_deg, 1e-3) << "of two alike the first, while opening";
}

TEST(StaticRedlineOf, AValveThatOpensAtTheNoseAloneIsWhereItsLashCloses) {
  // Within 0.3 of the half angle y'' hardly changes, and the spring is weakest where the valve leaves its seat.
  const double v = 0.3 * 0.3;
  const double lash_m = kMaxLift_m * (1 - 1.25 * v + 0.25 * std::pow(v, 5));
  const double curvature_m = 2.5 * kMaxLift_m / (kHalfAngle_rad * kHalfAngle_rad) * (1 - 9 * std::pow(v, 4));
  const double expected = crank_rad_s(kPreload_N, curvature_m);
  const StaticRedline found =
      redline_of(train_of(polynomial_cam(kMaxLift_m, kHalfAngle_deg, {2, 10}), direct_rocker(16e-3, lash_m), 60e3));
  EXPECT_NEAR(found.crank_rad_s, expected, 1e-6 * expected);
  EXPECT_NEAR(found.cam_deg, -0.3 * kHalfAngle_deg, 1e-5);
}

TEST(StaticRedlineOf, AValveThatHardlyOpensIsThatOfItsNose) {
  const double expected = crank_rad_s(kPreload_N, 2.5 * kMaxLift_m / (kHalfAngle_rad * kHalfAngle_rad));
  const Rocker rocker = direct_rocker(16e-3, kMaxLift_m - 1e-9);  // within 0.03 deg
  const StaticRedline found = redline_of(train_of(polynomial_cam(kMaxLift_m, kHalfAngle_deg, {2, 10}), rocker, 60e3));
  EXPECT_NEAR(found.crank_rad_s, expected, 1e-6 * expected);
  EXPECT_NEAR(found.cam_deg, 0, 0.03);
}

TEST(StaticRedlineOf, AMeasuredCycloidIsThatOfItsFormula) {
  // y = y_max (s - sin(2 pi s) / (2 pi)) over the half angle, and back: it curves down in the second half of the rise.
  constexpr double kSpring_N_m = 40e3;
  std::vector<CamPoint> points;
  const auto lift_m = [](double s) { return kMaxLift_m * (s - std::sin(2 * kPi * s) / (2 * kPi)); };
  for (int deg = -75; deg <= 75; ++deg) {
    const double s = 1 - std::abs(deg) / kHalfAngle_deg;
    points.push_back({static_cast<double>(deg), s > 0 ? lift_m(s) : 0});
  }
  Cam cam;
  cam.source = CamSource::table;
  cam.points = points.data();
  cam.point_count = static_cast<int>(points.size());
  cam.smoothing_m = 0.3e-6;
  double expected = 1e9;
  double expected_deg = 0;
  for (double s = 0.501; s < 1; s += 0.001) {
    const double curvature_m = -2 * kPi * kMaxLift_m / (kHalfAngle_rad * kHalfAngle_rad) * std::sin(2 * kPi * s);
    const double here = crank_rad_s(kPreload_N + kSpring_N_m * lift_m(s), curvature_m);
    if (here < expected) expected = here, expected_deg = (s - 1) * kHalfAngle_deg;
  }
  const StaticRedline found = redline_of(train_of(cam, direct_rocker(25e-3, 0), kSpring_N_m));
  EXPECT_NEAR(found.crank_rad_s, expected, 0.003 * expected);
  EXPECT_NEAR(std::fabs(found.cam_deg), -expected_deg, 1.5);
}

// ---- differences of the lift ----

/// The least of sqrt((P_s0 + k_s h) / (-M h'')) every `step_deg`, and at `at_deg`, with h'' by five-point differences.
struct ByDifferences {
  double least = std::numeric_limits<double>::infinity();
  double there = 0;

  ByDifferences(const ValveTrain& train, double step_deg, double at_deg) {
    const ValveLift lift = lift_of(train);
    const Valve& v = train.valve;
    const double lever_m = lift.lever_m() > 0 ? lift.lever_m() : 1;
    const double mass_kg = v.valve_kg + v.spring_kg / 3 + v.rocker_inertia_kg_m2 / (lever_m * lever_m);
    const auto crank_at = [&](double deg) {
      constexpr double h = 1.0 / 1024;
      const double rad = deg * kRadPerDeg;
      const auto y = [&](double by) { return lift.at(rad + by).lift_m; };
      const double lift_m = y(0);
      const double curvature_m = (16 * (y(h) + y(-h)) - (y(2 * h) + y(-2 * h)) - 30 * lift_m) / (12 * h * h);
      if (!(lift_m > 0 && curvature_m < 0)) return std::numeric_limits<double>::infinity();
      return 2 * std::sqrt((v.spring_preload_N + v.spring_N_m * lift_m) / (mass_kg * -curvature_m));
    };
    const double to_deg = lift.closes_rad() / kRadPerDeg;
    for (double deg = lift.opens_rad() / kRadPerDeg; deg < to_deg; deg += step_deg)
      least = std::min(least, crank_at(deg));
    there = crank_at(at_deg);
  }
};

TEST(StaticRedlineOf, EverySampleTrainIsThatOfTheLiftsDifferences) {
  int trains = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CRANKLOOP_SOURCE_DIR "/tools/engines")) {
    if (entry.path().extension() != ".ini") continue;
    const program::EngineFile file = program::read_engine_file(entry.path(), {});
    for (const program::TrainOfFile& train : file.trains()) {
      if (!train.complete()) continue;
      ++trains;
      const StaticRedline found = redline_of(train.definition);
      const ByDifferences expected(train.definition, 0.05, found.cam_deg);
      EXPECT_NEAR(found.crank_rad_s, expected.least, 3e-5 * expected.least) << entry.path() << train.name;
      EXPECT_NEAR(found.crank_rad_s, expected.there, 1e-5 * expected.there) << entry.path() << train.name;
    }
  }
  EXPECT_GE(trains, 8);
}

TEST(StaticRedlineOf, ANoisyTableIsThatOfItsSmoothCurvesDifferences) {
  // A residual hardly larger than the noise lets the noise through: the curvature has a dozen dips.
  for (const std::uint32_t seed : {1u, 2u, 3u, 4u, 5u}) {
    Random random(seed);
    support::Measured rows(support::profile_of(polynomial_cam(kMaxLift_m, kHalfAngle_deg, {2, 10, 18, 26})), -80, 80,
                           1);
    rows.off_by_up_to(2e-6, random);
    const ValveTrain train = train_of(rows.cam(2.4e-6), direct_rocker(60e-3, 0), 40e3);
    const StaticRedline found = redline_of(train);
    const ByDifferences expected(train, 0.02, found.cam_deg);
    EXPECT_NEAR(found.crank_rad_s, expected.least, 1e-4 * expected.least) << seed;
    EXPECT_NEAR(found.crank_rad_s, expected.there, 1e-4 * expected.there) << seed;
  }
}

TEST(StaticRedlineOf, RandomTrainsIsThatOfTheLiftsDifferences) {
  Random random(20);
  int trains = 0;
  while (trains < 10) {
    ValveTrain train = support::ohc_125_train();
    train.cam = support::random_cam(random);
    train.rocker = support::random_rocker(random);
    train.valve.spring_N_m = random.between(0, 100e3);
    ValveLift lift;
    if (!lift.init(train.cam, train.rocker).ok()) continue;
    ++trains;
    const StaticRedline found = redline_of(train);
    const ByDifferences expected(train, 0.1, found.cam_deg);
    EXPECT_LE(found.crank_rad_s, expected.least * (1 + 1e-6)) << trains;
    EXPECT_GE(found.crank_rad_s, expected.least * (1 - 2e-3)) << trains;
    EXPECT_NEAR(found.crank_rad_s, expected.there, 1e-5 * expected.there) << trains;
  }
}

// ---- the margin ----

TEST(SpringMargin, IsSpringForceOverWhatSlowsTheValveDown) {
  const ValveTrain train = support::ohc_125_train();
  const ValveLift lift = lift_of(train);
  const ValveBody<double> body = body_of(train);
  const StaticRedline redline = redline_of(train);
  constexpr double kCrank_rad_s = 733;  // 7000 rpm
  double least = 1e9;
  for (double deg = -90; deg < 90; deg += 0.05) {
    const LiftPose pose = lift.at(deg * kRadPerDeg);
    const double margin = spring_margin(pose, body, kCrank_rad_s);
    EXPECT_EQ(margin, spring_margin(pose, body, -kCrank_rad_s));
    if (!(pose.lift_m >= 0 && pose.per_rad2_m < 0)) {
      EXPECT_TRUE(std::isinf(margin)) << deg;
      continue;
    }
    const double deceleration_m_s2 = -pose.per_rad2_m * (kCrank_rad_s / 2) * (kCrank_rad_s / 2);
    const double spring_N = train.valve.spring_preload_N + train.valve.spring_N_m * pose.lift_m;
    EXPECT_NEAR(margin, spring_N / (body.mass_kg * deceleration_m_s2), 1e-12 * margin) << deg;
    least = std::min(least, margin);
  }
  EXPECT_NEAR(redline.margin(kCrank_rad_s), least, 1e-5 * least);
  EXPECT_EQ(redline.margin(-kCrank_rad_s), redline.margin(kCrank_rad_s));
  EXPECT_EQ(redline.margin(redline.crank_rad_s), 1);
  EXPECT_EQ(redline.margin(redline.crank_rad_s / 2), 4);
  EXPECT_NEAR(spring_margin(lift.at(redline.cam_deg * kRadPerDeg), body, redline.crank_rad_s), 1, 1e-9);
}

TEST(SpringMargin, IsInfiniteAtStandstill) {
  const ValveTrain train = support::ohc_125_train();
  EXPECT_TRUE(std::isinf(redline_of(train).margin(0)));
  EXPECT_TRUE(std::isinf(spring_margin(lift_of(train).at(0), body_of(train), 0)));
}

TEST(StaticRedlineOf, AValveThatNeverOpensIsNone) {
  const StaticRedline found =
      redline_of(train_of(polynomial_cam(kMaxLift_m, kHalfAngle_deg, {2, 10}), direct_rocker(16e-3, 6.1e-3), 60e3));
  EXPECT_EQ(found.crank_rad_s, 0);
  EXPECT_EQ(found.cam_deg, 0);
  EXPECT_TRUE(std::isinf(found.margin(1000)));
}

TEST(StaticRedlineOf, WhatWasNotAcceptedIsNone) {
  const ValveTrain train = support::ohc_125_train();
  EXPECT_EQ(static_redline(ValveLift{}, body_of(train)).crank_rad_s, 0);
  for (double ValveBody<double>::*member :
       {&ValveBody<double>::mass_kg, &ValveBody<double>::preload_N, &ValveBody<double>::spring_N_m}) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      ValveBody<double> body = body_of(train);
      body.*member = bad;
      const StaticRedline found = static_redline(lift_of(train), body);
      EXPECT_EQ(found.crank_rad_s, 0) << bad;
      EXPECT_EQ(found.cam_deg, 0) << bad;
    }
  }
}

// ---- the report of set-up ----

TEST(TableReportOfValves, HasTheLowestStaticRedlineOfAllTrains) {
  EngineDefinition engine = valve_test::engine_with(support::ohc_125_train());
  engine.train_count = 3;
  engine.trains[1] = engine.trains[2] = engine.trains[0];
  engine.trains[1].valve.spring_preload_N /= 2;
  const StaticRedline expected = redline_of(engine.trains[1]);
  ASSERT_LT(expected.crank_rad_s, redline_of(engine.trains[0]).crank_rad_s);
  detail::ValveMotion<double> motions[kMaxTrains]{};
  TableTargets<double> targets;
  targets.valve_motions = motions;
  TableReport report;
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets, &report)));
  EXPECT_EQ(report.static_redline_rad_s, expected.crank_rad_s);
  EXPECT_EQ(report.static_redline_deg, expected.cam_deg);
  EXPECT_EQ(report.static_redline_train, 1);

  engine.trains[1].cam = polynomial_cam(kMaxLift_m, kHalfAngle_deg, {2, 10});
  engine.trains[1].rocker = direct_rocker(16e-3, 6.1e-3);  // never opens
  engine.trains[1].valve.rocker_inertia_kg_m2 = 0;
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets, &report)));
  EXPECT_EQ(report.static_redline_rad_s, redline_of(engine.trains[0]).crank_rad_s);
  EXPECT_EQ(report.static_redline_train, 0) << "the first of two alike";

  engine.trains[0] = engine.trains[1];
  engine.train_count = 1;
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, targets, &report)));
  EXPECT_EQ(report.static_redline_rad_s, 0);
  EXPECT_EQ(report.static_redline_train, -1);
}

TEST(TableReportOfValves, HasNoStaticRedlineWithoutElasticValves) {
  const EngineDefinition engine = valve_test::engine_with(support::ohc_125_train());
  TableReport report;
  ASSERT_TRUE(accepted(tabulate(engine, {100e-6, {}}, TableTargets<float>{}, &report)));
  EXPECT_EQ(report.static_redline_rad_s, 0);
  EXPECT_EQ(report.static_redline_deg, 0);
  EXPECT_EQ(report.static_redline_train, -1);
}

}  // namespace
}  // namespace crankloop::spring_margin_test

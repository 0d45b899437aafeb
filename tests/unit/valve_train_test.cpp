// Definitions of a valve train: what is accepted, what is refused and by which name.
#include <crankloop/define/valve_train.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/status.hpp"
#include "support/valve_trains.hpp"

namespace crankloop::valve_train_test {
namespace {

using support::ohc_125_cam;
using support::ohc_125_rocker;
using support::refuses;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kLeastPositive = 1e-9;  // docs/contract.md: what "> 0" means, in SI units
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Valve ohc_125_valve() {
  Valve valve;
  valve.valve_kg = 0.033;
  valve.spring_kg = 0.06;
  valve.rocker_inertia_kg_m2 = 8.12e-6;
  valve.spring_N_m = 40e3;
  valve.spring_preload_N = 205.8;
  valve.train_N_m = 11765e3;
  valve.train_damping_ratio = 0.1;
  valve.guide_damping_ratio = 0.003;
  valve.seat_N_m = 1e8;
  valve.seat_damping_ratio = 0.1;
  return valve;
}

/// What a number must not be: outside (least, most], or [least, most] with `or_equal`.
template <class Part>
struct Rule {
  double Part::*member;
  const char* field;
  double least;
  bool or_equal;
  double most;
};

template <class Part>
void expect_rules(const Part& good, const std::vector<Rule<Part>>& rules) {
  ASSERT_TRUE(accepted(validate(good)));
  for (const Rule<Part>& rule : rules) {
    const auto with = [&](double value) {
      Part part = good;
      part.*rule.member = value;
      return validate(part);
    };
    for (const double bad : {kNaN, kInfinity, -kInfinity})
      EXPECT_TRUE(refuses(with(bad), Reason::not_finite, rule.field)) << bad;
    EXPECT_TRUE(refuses(with(std::nextafter(rule.most, 1e300)), Reason::out_of_range, rule.field));
    EXPECT_TRUE(accepted(with(rule.most)));
    const double below = rule.or_equal ? std::nextafter(rule.least, -1e300) : rule.least;
    const Status refused = with(below);
    EXPECT_FALSE(refused.ok()) << rule.field;
    EXPECT_STREQ(refused.field, rule.field);
    EXPECT_TRUE(accepted(with(rule.or_equal ? rule.least : std::nextafter(rule.least, 1e300))));
  }
}

TEST(CamDefinition, KeepsEveryRangeThatIsListed) {
  expect_rules<Cam>(ohc_125_cam(), {{&Cam::max_lift_m, "cam.max_lift_m", kLeastPositive, true, 0.1},
                                    {&Cam::half_angle_deg, "cam.half_angle_deg", 10, true, 180},
                                    {&Cam::full_lift_deg, "cam.full_lift_deg", 0, true, std::nextafter(720.0, 0)},
                                    {&Cam::phase_rate_deg_s, "cam.phase_rate_deg_s", 0, true, 100000}});
}

TEST(ValveTrainDefinition, RefusesNumbersThatNameNoEnumerator) {
  for (const int number : {2, 3, 255}) {
    Cam cam = ohc_125_cam();
    cam.source = static_cast<CamSource>(number);
    EXPECT_TRUE(refuses(validate(cam), Reason::out_of_range, "cam.source")) << number;
    Rocker rocker = ohc_125_rocker();
    rocker.cam_turns = static_cast<CamTurns>(number);
    EXPECT_TRUE(refuses(validate(rocker), Reason::out_of_range, "rocker.cam_turns")) << number;
    rocker = ohc_125_rocker();
    rocker.kind = static_cast<RockerKind>(number);
    EXPECT_TRUE(refuses(validate(rocker), Reason::out_of_range, "rocker.kind")) << number;
    rocker.pivot_to_pad_m = kNaN;
    rocker.ratio = kNaN;
    EXPECT_TRUE(refuses(validate(rocker), Reason::out_of_range, "rocker.kind"))
        << "nothing of an unknown kind is looked at";
  }
}

TEST(CamDefinition, NeedsTwoToEightRisingExponents) {
  Cam cam = ohc_125_cam();
  cam.exponent_count = 1;
  EXPECT_TRUE(refuses(validate(cam), Reason::too_few_points, "cam.exponents"));
  cam.exponent_count = kMaxCamExponents + 1;
  EXPECT_TRUE(refuses(validate(cam), Reason::too_many_points, "cam.exponents"));
  const struct {
    int index;
    double value;
    Reason reason;
  } bad[] = {{0, 1.99, Reason::out_of_range},
             {3, 100.1, Reason::out_of_range},
             {2, 10, Reason::not_increasing},
             {2, 10.05, Reason::not_increasing},
             {1, kNaN, Reason::not_finite}};
  for (const auto& one : bad) {
    cam = ohc_125_cam();
    cam.exponents[one.index] = one.value;
    EXPECT_TRUE(refuses(validate(cam), one.reason, "cam.exponents", one.index)) << one.value;
  }
}

TEST(CamDefinition, OfATableNamesTheRowThatIsWrong) {
  std::vector<CamPoint> points;
  for (int deg = -90; deg <= 90; ++deg) points.push_back({static_cast<double>(deg), deg * deg < 3600 ? 1e-3 : 0});
  const auto with = [&](double smoothing_m = 10e-6) {
    Cam cam;
    cam.source = CamSource::table;
    cam.points = points.data();
    cam.point_count = static_cast<int>(points.size());
    cam.smoothing_m = smoothing_m;
    return validate(cam);
  };
  ASSERT_TRUE(accepted(with()));
  EXPECT_TRUE(refuses(with(0), Reason::not_positive, "cam.smoothing_m"));
  EXPECT_TRUE(refuses(with(1.1e-3), Reason::out_of_range, "cam.smoothing_m"));
  const std::vector<CamPoint> good = points;
  points[7].lift_m = kNaN;
  EXPECT_TRUE(refuses(with(), Reason::not_finite, "cam.points", 7));
  points = good;
  points[8].cam_deg = points[7].cam_deg;
  EXPECT_TRUE(refuses(with(), Reason::not_increasing, "cam.points", 8));
  points = good;
  points[9].lift_m = 0.2;
  EXPECT_TRUE(refuses(with(), Reason::out_of_range, "cam.points", 9));
  points = good;
  points[0].cam_deg = -361;
  EXPECT_TRUE(refuses(with(), Reason::out_of_range, "cam.points", 0));
  points = good;
  points.front().cam_deg = -200;
  points.back().cam_deg = 161;
  EXPECT_TRUE(refuses(with(), Reason::out_of_range, "cam.points"));
  points.assign(good.begin(), good.begin() + 7);
  EXPECT_TRUE(refuses(with(), Reason::too_few_points, "cam.points"));
  points.assign(good.begin(), good.begin() + 8);
  EXPECT_TRUE(accepted(with()));
  for (const double end_deg : {180.0, 180.001}) {
    points = good;
    points.front().cam_deg = -180;
    points.back().cam_deg = end_deg;
    EXPECT_EQ(with().ok(), end_deg == 180) << "a turn, and not more";
  }
  points.clear();
  for (int i = 0; i <= kMaxCamPoints; ++i) points.push_back({i * 0.1, 0});
  EXPECT_TRUE(refuses(with(), Reason::too_many_points, "cam.points"));
  Cam none;
  none.source = CamSource::table;
  none.smoothing_m = 1e-6;
  none.point_count = 100;
  EXPECT_TRUE(refuses(validate(none), Reason::too_few_points, "cam.points"));
}

TEST(RockerDefinition, KeepsEveryRangeThatIsListed) {
  expect_rules<Rocker>(ohc_125_rocker(),
                       {{&Rocker::base_circle_m, "rocker.base_circle_m", kLeastPositive, true, 1},
                        {&Rocker::clearance_m, "rocker.clearance_m", 0, true, 0.01},
                        {&Rocker::pivot_to_pad_m, "rocker.pivot_to_pad_m", kLeastPositive, true, 1},
                        {&Rocker::pivot_to_cam_m, "rocker.pivot_to_cam_m", kLeastPositive, true, 1},
                        {&Rocker::pad_radius_m, "rocker.pad_radius_m", kLeastPositive, true, 10},
                        {&Rocker::pivot_to_screw_m, "rocker.pivot_to_screw_m", kLeastPositive, true, 1},
                        {&Rocker::screw_ball_m, "rocker.screw_ball_m", 0, true, 1},
                        {&Rocker::stem_above_pivot_m, "rocker.stem_above_pivot_m", -1, true, 1}});
}

TEST(RockerDefinition, OfAConstantRatioNeedsNoGeometry) {
  expect_rules<Rocker>(support::direct_rocker(15e-3, 0.1e-3, 1.4),
                       {{&Rocker::base_circle_m, "rocker.base_circle_m", kLeastPositive, true, 1},
                        {&Rocker::ratio, "rocker.ratio", kLeastPositive, true, 10},
                        {&Rocker::pivot_to_screw_m, "rocker.pivot_to_screw_m", 0, true, 1}});
  Rocker rocker = support::direct_rocker(15e-3, 0.1e-3, 1.4);
  rocker.pivot_to_screw_m = kLeastPositive / 2;  // no lever, and not none
  EXPECT_TRUE(refuses(validate(rocker), Reason::out_of_range, "rocker.pivot_to_screw_m"));
}

TEST(ValveDefinition, KeepsEveryRangeThatIsListed) {
  expect_rules<Valve>(ohc_125_valve(), {{&Valve::valve_kg, "valve.valve_kg", kLeastPositive, true, 100},
                                        {&Valve::spring_kg, "valve.spring_kg", 0, true, 100},
                                        {&Valve::rocker_inertia_kg_m2, "valve.rocker_inertia_kg_m2", 0, true, 100},
                                        {&Valve::spring_N_m, "valve.spring_N_m", 0, true, 1e9},
                                        {&Valve::spring_preload_N, "valve.spring_preload_N", kLeastPositive, true, 1e6},
                                        {&Valve::train_N_m, "valve.train_N_m", kLeastPositive, true, 1e12},
                                        {&Valve::train_damping_ratio, "valve.train_damping_ratio", 0, true, 10},
                                        {&Valve::guide_damping_ratio, "valve.guide_damping_ratio", 0, true, 10},
                                        {&Valve::seat_N_m, "valve.seat_N_m", kLeastPositive, true, 1e12},
                                        {&Valve::seat_damping_ratio, "valve.seat_damping_ratio", 0, true, 10},
                                        {&Valve::head_area_m2, "valve.head_area_m2", 0, true, 1}});
  Valve valve = ohc_125_valve();
  for (const int bad : {0, -1, 9}) {
    valve.per_cylinder = bad;
    EXPECT_TRUE(refuses(validate(valve), Reason::out_of_range, "valve.per_cylinder"));
  }
}

TEST(ValveTrainDefinition, HasNoRockerInertiaWithoutALever) {
  ValveTrain train{ohc_125_cam(), ohc_125_rocker(), ohc_125_valve()};
  EXPECT_TRUE(accepted(validate(train)));
  train.rocker = support::direct_rocker(15e-3, 0.1e-3);
  EXPECT_TRUE(refuses(validate(train), Reason::inconsistent, "valve.rocker_inertia_kg_m2"));
  train.rocker.pivot_to_screw_m = 0.03;
  EXPECT_TRUE(accepted(validate(train)));
  train.rocker.pivot_to_screw_m = 0;
  train.valve.rocker_inertia_kg_m2 = 0;
  EXPECT_TRUE(accepted(validate(train)));
  train.cam.max_lift_m = -1;
  EXPECT_TRUE(refuses(validate(train), Reason::not_positive, "cam.max_lift_m"));
}

}  // namespace
}  // namespace crankloop::valve_train_test

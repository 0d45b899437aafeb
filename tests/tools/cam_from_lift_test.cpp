// From the valve's lift back to the cam: against the forward chain, and against a body that is turned and touched.
#include "crankloop/loops/cam_from_lift.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <crankloop/tabulate/valve_lift.hpp>

#include "support/brute_force_cam.hpp"
#include "support/status.hpp"
#include "support/units.hpp"
#include "support/valve_trains.hpp"

namespace crankloop::program::cam_from_lift_test {
namespace {

using support::BruteForceCam;
using support::direct_rocker;
using support::ohc_125_cam;
using support::ohc_125_rocker;
using support::Random;

constexpr double kRoundTrip_m = 1e-10;  // 1e-7 mm

CamLift valve_of(const LiftPose& pose) { return {pose.lift_m, pose.per_rad_m, pose.per_rad2_m}; }

/// Every contact of a train leads back to the cam.
void expect_round_trip(const Cam& cam, const ValveLift& lift, const Rocker& rocker, const std::string& trace) {
  CamProfile profile;
  ASSERT_TRUE(accepted(profile.init(cam)));
  const CamFromLift inverse(rocker, lift.largest_lift_m());
  constexpr int kPlaces = 300;
  const double step_rad = (lift.closes_rad() - lift.opens_rad()) / kPlaces;
  for (int i = 0; i <= kPlaces; ++i) {
    const double cam_rad = lift.opens_rad() + i * step_rad;
    const FlatContact contact = inverse.at(cam_rad, valve_of(lift.at(cam_rad)));
    ASSERT_TRUE(contact.exists) << trace;
    const CamLift y = profile.at(contact.flat_rad);
    ASSERT_NEAR(contact.lift_m, y.lift_m, kRoundTrip_m) << trace << ", " << cam_rad << " rad";
    ASSERT_NEAR(contact.per_rad_m, y.per_rad_m, 1e-9) << trace << ", " << cam_rad << " rad";
    const double radius_m = rocker.base_circle_m + y.lift_m + y.per_rad2_m;
    ASSERT_NEAR(contact.curvature_radius_m, radius_m, 1e-7 * std::max(0.1, std::abs(radius_m))) << trace;
    ASSERT_GT(contact.flat_per_cam, 0) << trace;
  }
}

TEST(CamFromLift, OfTwoHundredRandomRockersIsTheCamThatLiftsThem) {
  Random random;
  int trains = 0;
  for (int draw = 0; trains < 200; ++draw) {
    ASSERT_LT(draw, 5000) << "most draws are refused";
    const Cam cam = support::random_cam(random);
    const Rocker rocker = support::random_rocker(random);
    ValveLift lift;
    if (!lift.init(cam, rocker).ok()) continue;
    ++trains;
    expect_round_trip(cam, lift, rocker, random.trace(draw));
    if (HasFatalFailure()) return;
  }
}

TEST(CamFromLift, OfAConstantRatioDividesByIt) {
  const Rocker rocker = direct_rocker(18e-3, 0.2e-3, 1.5);
  ValveLift lift;
  ASSERT_TRUE(accepted(lift.init(ohc_125_cam(), rocker)));
  expect_round_trip(ohc_125_cam(), lift, rocker, "ratio");
}

/// A wanted lift of a closed form: a raised cosine, squared so that it begins smoothly.
CamLift wanted(double cam_rad, double half_rad, double largest_m, double clearance_m) {
  const double total_m = largest_m + clearance_m;
  if (std::abs(cam_rad) >= half_rad) return {-clearance_m, 0, 0};
  const double k = support::kPi / half_rad;
  const double c = (1 + std::cos(k * cam_rad)) / 2;
  const double s = -k * std::sin(k * cam_rad) / 2;
  const double b = -k * k * std::cos(k * cam_rad) / 2;
  return {total_m * c * c - clearance_m, total_m * 2 * c * s, total_m * 2 * (s * s + c * b)};
}

/// The flat follower's lift at any flat angle: contacts at equal cam angles, cubics between them.
class FollowerTable {
 public:
  FollowerTable(const std::function<FlatContact(double)>& contact, double to_rad) {
    constexpr int kContacts = 4000;
    for (int i = -kContacts; i <= kContacts; ++i) contacts_.push_back(contact(i * to_rad / kContacts));
  }

  [[nodiscard]] double lift_m(double flat_rad) const {
    const auto above = std::upper_bound(contacts_.begin(), contacts_.end(), flat_rad,
                                        [](double rad, const FlatContact& c) { return rad < c.flat_rad; });
    if (above == contacts_.begin() || above == contacts_.end()) return 0;
    const FlatContact& a = above[-1];
    const FlatContact& b = *above;
    const double width = b.flat_rad - a.flat_rad;
    const double t = (flat_rad - a.flat_rad) / width;
    return (1 + 2 * t) * (1 - t) * (1 - t) * a.lift_m + t * (1 - t) * (1 - t) * width * a.per_rad_m +
           t * t * (3 - 2 * t) * b.lift_m - t * t * (1 - t) * width * b.per_rad_m;
  }

 private:
  std::vector<FlatContact> contacts_{};
};

TEST(CamFromLift, OfAWantedLiftPutsTheRockerWhereItsPadTouchesTheTurnedCam) {
  constexpr double kHalf_rad = 80 * support::kRadPerDeg;
  for (const CamTurns turns : {CamTurns::toward_pivot, CamTurns::away_from_pivot}) {
    const Rocker rocker = ohc_125_rocker(turns);
    const auto h = [&](double rad) { return wanted(rad, kHalf_rad, 7e-3, rocker.clearance_m); };
    const CamFromLift inverse(rocker, 7e-3);
    const FollowerTable follower([&](double rad) { return inverse.at(rad, h(rad)); }, 1.5 * kHalf_rad);
    const BruteForceCam body{rocker, [&](double flat_rad) { return follower.lift_m(flat_rad); }};
    const double full_lift_rad = body.turned_at_full_lift_rad();
    for (const double deg : {-70.0, -41.0, -12.5, 0.0, 25.0, 66.0}) {
      const double rad = deg * support::kRadPerDeg;
      EXPECT_NEAR(body.rocker_rad(full_lift_rad + rad), inverse.rocker_rad(h(rad).lift_m), 1e-9) << deg << " deg";
    }
  }
}

TEST(CamFromLift, FindsWhereAWantedLiftAsksForAHollowOrAnUndercutContour) {
  const Rocker rocker = ohc_125_rocker();
  const CamFromLift inverse(rocker, 10e-3);
  double least_radius_m = 1;
  double least_turning = 1;
  for (int tenth = -300; tenth <= 300; ++tenth) {
    const double rad = tenth * 0.1 * support::kRadPerDeg;
    const FlatContact contact = inverse.at(rad, wanted(rad, 30 * support::kRadPerDeg, 10e-3, rocker.clearance_m));
    if (!contact.exists) continue;
    least_turning = std::min(least_turning, contact.flat_per_cam);
    if (contact.flat_per_cam > 0) least_radius_m = std::min(least_radius_m, contact.curvature_radius_m);
  }
  EXPECT_LT(least_turning, 0);   // its flanks
  EXPECT_LT(least_radius_m, 0);  // its nose
}

TEST(CamFromLift, SaysWhereTheScrewCannotReach) {
  const CamFromLift inverse(ohc_125_rocker(), 7e-3);
  EXPECT_FALSE(inverse.at(0, {60e-3, 0, 0}).exists);
}

TEST(Contour, IsWhereFlatFollowersOfAllAnglesTouch) {
  // The envelope of the lines x cos phi + y sin phi = r_0 + y(phi), by a second line close by.
  CamProfile profile;
  ASSERT_TRUE(accepted(profile.init(ohc_125_cam())));
  constexpr double kBase_m = 12.5e-3;
  constexpr double kApart_rad = 1e-5;
  for (int deg = -90; deg <= 90; deg += 5) {
    const double a = deg * support::kRadPerDeg - kApart_rad;
    const double b = deg * support::kRadPerDeg + kApart_rad;
    const double p = kBase_m + profile.at(a).lift_m;
    const double q = kBase_m + profile.at(b).lift_m;
    const double determinant = std::sin(b - a);
    const ContourPoint point = contour_point(kBase_m, deg * support::kRadPerDeg, profile.at(deg * support::kRadPerDeg));
    EXPECT_NEAR(point.x_m, (p * std::sin(b) - q * std::sin(a)) / determinant, 1e-9) << deg;
    EXPECT_NEAR(point.y_m, (q * std::cos(a) - p * std::cos(b)) / determinant, 1e-9) << deg;
  }
}

}  // namespace
}  // namespace crankloop::program::cam_from_lift_test

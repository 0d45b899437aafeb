// Cam to rocker to valve: against a body that is turned and touched, against differences, and what a train that cannot
// work is told.
#include <crankloop/tabulate/valve_lift.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "support/brute_force_cam.hpp"
#include "support/differences.hpp"
#include "support/status.hpp"
#include "support/units.hpp"
#include "support/valve_trains.hpp"

namespace crankloop::valve_lift_test {
namespace {

using support::BruteForceCam;
using support::direct_rocker;
using support::ohc_125_cam;
using support::ohc_125_rocker;
using support::polynomial_cam;
using support::Random;
using support::refuses;
using support::slope_of;

using support::kPi;
using support::kRadPerDeg;

/// The 125's follower lift as printed in the model's description, with its own fractions.
double printed_lift_m(double phi_rad) {
  const double u = std::fabs(phi_rad) / (74 * kRadPerDeg);
  if (u >= 1) return 0;
  return 6.301099e-3 * (1 - 195.0 / 128 * std::pow(u, 2) + 117.0 / 128 * std::pow(u, 10) -
                        65.0 / 128 * std::pow(u, 18) + 15.0 / 128 * std::pow(u, 26));
}

double printed_slope_m(double phi_rad) {
  const double u = std::fabs(phi_rad) / (74 * kRadPerDeg);
  if (u >= 1) return 0;
  return std::copysign(6.301099e-3 / (74 * kRadPerDeg), phi_rad) *
         (-195.0 / 64 * u + 1170.0 / 128 * std::pow(u, 9) - 1170.0 / 128 * std::pow(u, 17) +
          390.0 / 128 * std::pow(u, 25));
}

ValveLift lift_of(const Cam& cam, const Rocker& rocker) {
  ValveLift lift;
  EXPECT_TRUE(accepted(lift.init(cam, rocker))) << "at " << lift.failed_at_deg() << " deg";
  return lift;
}

// The search of the distance's largest direction and the bisection end at rounding; what is left is a few 1e-15 rad.
constexpr double kTouch_rad = 1e-12;

class RockerOfThe125 : public testing::TestWithParam<CamTurns> {
 protected:
  const Rocker rocker = ohc_125_rocker(GetParam());
  const ValveLift lift = lift_of(ohc_125_cam(), rocker);
  const BruteForceCam body{rocker, printed_lift_m};
};

INSTANTIATE_TEST_SUITE_P(TurningEitherWay, RockerOfThe125,
                         testing::Values(CamTurns::toward_pivot, CamTurns::away_from_pivot));

TEST_P(RockerOfThe125, StandsWhereItsPadTouchesTheTurnedCam) {
  const double full_lift = body.turned_at_full_lift_rad();
  for (int deg = -180; deg <= 180; deg += 4) {
    EXPECT_NEAR(lift.at(deg * kRadPerDeg).rocker_rad, body.rocker_rad(full_lift + deg * kRadPerDeg), kTouch_rad)
        << deg << " deg";
  }
}

TEST_P(RockerOfThe125, MovesTheValveByTheRatioTimesTheContactsSpeedAlongItsNormal) {
  // The brute force tells which flat follower touches at the same point; its y' is the speed at which the cam pushes
  // there.
  const double full_lift = body.turned_at_full_lift_rad();
  for (int deg = -84; deg <= 84; deg += 4) {
    const double turned = full_lift + deg * kRadPerDeg;
    const double phi = body.touch(body.rocker_rad(turned), turned).phi_rad;
    const LiftPose pose = lift.at(deg * kRadPerDeg);
    // phi is good to about 3e-8 rad, times y'' of up to 38 mm and i of up to 1.65.
    EXPECT_NEAR(pose.per_rad_m, pose.rocker_ratio * printed_slope_m(phi), 5e-9) << deg << " deg";
  }
}

TEST_P(RockerOfThe125, PushesTheStemWithTheScrewsBall) {
  // The ball's centre stands l_b sin psi above the pivot, psi falling as the rocker swings out; under it the stem's end
  // at z while closed.
  const double rest = lift.at(kPi).rocker_rad;
  const double psi_rest = std::asin((10e-3 + 0.05e-3 + 1.65e-3) / 33.28e-3);
  for (int deg = -90; deg <= 90; deg += 3) {
    const LiftPose pose = lift.at(deg * kRadPerDeg);
    const double ball_m = 33.28e-3 * std::sin(psi_rest - (pose.rocker_rad - rest));
    EXPECT_NEAR(pose.lift_m, 1.65e-3 - (ball_m - 10e-3), 1e-16) << deg << " deg";
  }
}

TEST_P(RockerOfThe125, LiftsTheValveBy7815MicrometresAtFullLift) {
  EXPECT_NEAR(lift.largest_lift_m(), 7.815e-3, 0.0005e-3);
  for (int tenth = -1800; tenth <= 1800; ++tenth)
    EXPECT_LE(lift.at(tenth * 0.1 * kRadPerDeg).lift_m, lift.largest_lift_m());
  EXPECT_EQ(lift.at(0).lift_m, lift.largest_lift_m());
  EXPECT_NEAR(lift.at(0).per_rad_m, 0, 1e-17);
}

TEST_P(RockerOfThe125, HasRatiosFrom102To165) {
  double least = 10;
  double most = 0;
  for (int tenth = -1800; tenth <= 1800; ++tenth) {
    const double ratio = lift.at(tenth * 0.1 * kRadPerDeg).rocker_ratio;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  EXPECT_NEAR(least, 1.02, 0.005);
  EXPECT_NEAR(most, 1.65, 0.005);
}

TEST_P(RockerOfThe125, HasDerivativesThatAgreeWithDifferences) {
  // Five points h apart are off by h^4 / 30 times the fifth derivative, by 5e-16 m and 7e-13 m here, and by 1.5 / h
  // times rounding (a few 1e-18 m): 2e-13 m.
  constexpr double h = 1.0 / 32768;
  const double peak_slope_m = 0.0144;
  const double peak_curvature_m = 0.0384;
  for (double rad = -1.5; rad < 1.5; rad += 0.00173) {
    const LiftPose pose = lift.at(rad);
    EXPECT_NEAR(pose.per_rad_m, slope_of([&](double x) { return lift.at(x).lift_m; }, rad, h), 1e-10 * peak_slope_m)
        << rad;
    EXPECT_NEAR(pose.per_rad2_m, slope_of([&](double x) { return lift.at(x).per_rad_m; }, rad, h),
                1e-10 * peak_curvature_m)
        << rad;
  }
}

TEST_P(RockerOfThe125, RestsExactlyOneClearanceBelowTheValveOutsideTheLobe) {
  const double ends[] = {
      lift.opens_rad(), lift.closes_rad(), lift.opens_rad() - 0.3, lift.closes_rad() + 0.3, kPi, -kPi};
  for (const double rad : ends) {
    const LiftPose pose = lift.at(rad);
    EXPECT_EQ(pose.lift_m, -0.05e-3) << rad;
    EXPECT_EQ(pose.per_rad_m, 0) << rad;
    EXPECT_EQ(pose.per_rad2_m, 0) << rad;
  }
  EXPECT_NEAR(lift.closes_rad() - lift.opens_rad(), 148 * kRadPerDeg,
              1e-15);  // base circle at both ends: the pad's share is the same
  EXPECT_GT(lift.at(lift.opens_rad() + 0.02).lift_m, -0.05e-3);
  EXPECT_GT(lift.at(lift.closes_rad() - 0.02).lift_m, -0.05e-3);
}

TEST_P(RockerOfThe125, DoesNotMindInWhichTurnItsAngleIs) {
  for (const double rad : {-1.1, -0.4, 0.0, 0.3, 0.9, 2.5}) {
    for (const int turns : {-1000, -1, 1, 2, 1000}) {
      // A thousand turns round the angle to 1e-12 rad.
      EXPECT_NEAR(lift.at(rad + turns * 2 * kPi).lift_m, lift.at(rad).lift_m, 2e-12 * 0.0144)
          << rad << " + " << turns << " turns";
    }
  }
  for (const double nowhere : {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN(), 1e300}) {
    EXPECT_EQ(lift.at(nowhere).lift_m, -0.05e-3);
  }
}

TEST(RockerLift, OfASymmetricCamRunsBackwardsWhenTheCamTurnsTheOtherWay) {
  const ValveLift toward = lift_of(ohc_125_cam(), ohc_125_rocker(CamTurns::toward_pivot));
  const ValveLift away = lift_of(ohc_125_cam(), ohc_125_rocker(CamTurns::away_from_pivot));
  for (double rad = -3.1; rad < 3.1; rad += 0.0137) {
    EXPECT_NEAR(away.at(-rad).lift_m, toward.at(rad).lift_m, 1e-16);
    EXPECT_NEAR(away.at(-rad).per_rad_m, -toward.at(rad).per_rad_m, 1e-15);
    EXPECT_NEAR(away.at(-rad).per_rad2_m, toward.at(rad).per_rad2_m, 1e-13);
    EXPECT_NEAR(away.at(-rad).rocker_ratio, toward.at(rad).rocker_ratio, 1e-13);
  }
}

TEST(RockerLift, OfAnyTrainThatCanTurnIsThatOfTheBruteForce) {
  Random random;
  support::each_random_train(
      random, 12, [&random](const Cam& cam, const Rocker& rocker, const ValveLift& lift, const std::string& trace) {
        CamProfile profile;
        ASSERT_TRUE(accepted(profile.init(cam)));
        const BruteForceCam body{rocker, [&](double phi) { return profile.at(phi).lift_m; }};
        const double full_lift = body.turned_at_full_lift_rad();
        for (int i = 0; i < 6; ++i) {
          const double rad = random.between(lift.opens_rad(), lift.closes_rad());
          const double turned = full_lift + rad;
          const double W = body.rocker_rad(turned);
          const LiftPose pose = lift.at(rad);
          EXPECT_NEAR(pose.rocker_rad, W, kTouch_rad) << trace << ", " << rad << " rad";
          const double contact_speed = profile.at(body.touch(W, turned).phi_rad).per_rad_m;
          EXPECT_NEAR(pose.per_rad_m, pose.rocker_ratio * contact_speed, 2e-8) << trace << ", " << rad << " rad";
        }
      });
}

TEST(RockerLever, IsTheMeanOfSeatedAndFullyOpen) {
  const ValveLift lift = lift_of(ohc_125_cam(), ohc_125_rocker());
  const double psi_seated = std::asin((10e-3 + 1.65e-3) / 33.28e-3);
  const double psi_open = std::asin((10e-3 + 1.65e-3 - lift.largest_lift_m()) / 33.28e-3);
  EXPECT_NEAR(lift.lever_m(), 33.28e-3 * (std::cos(psi_seated) + std::cos(psi_open)) / 2, 1e-16);
}

// ---- constant ratio -------------------------------------------------------------------------------------------------

TEST(ConstantRatioTrain, MultipliesTheFollowersLiftAndTakesTheClearanceOff) {
  const ValveLift lift = lift_of(ohc_125_cam(), direct_rocker(18e-3, 0.2e-3, 1.5));
  for (double rad = -1.3; rad < 1.3; rad += 0.01) {
    const LiftPose pose = lift.at(rad);
    EXPECT_NEAR(pose.lift_m, 1.5 * printed_lift_m(rad) - 0.2e-3, 1e-16);
    EXPECT_NEAR(pose.per_rad_m, 1.5 * printed_slope_m(rad), 1e-15);
    EXPECT_EQ(pose.rocker_ratio, 1.5);
    EXPECT_EQ(pose.rocker_rad, 0);
  }
  EXPECT_EQ(lift.at(2).lift_m, -0.2e-3);
  EXPECT_DOUBLE_EQ(lift.opens_rad(), -74 * kRadPerDeg);
  EXPECT_EQ(lift.lever_m(), 0);
}

TEST(ConstantRatioTrain, HasTheLeverItIsGiven) {
  Rocker rocker = direct_rocker(18e-3, 0.2e-3, 1.5);
  rocker.pivot_to_screw_m = 0.03;
  EXPECT_EQ(lift_of(ohc_125_cam(), rocker).lever_m(), 0.03);
}

// ---- what cannot work -----------------------------------------------------------------------------------------------

TEST(CamOfThe125, IsNowhereSharperThan587Millimetres) {
  const ValveLift lift = lift_of(ohc_125_cam(), ohc_125_rocker());
  EXPECT_NEAR(lift.smallest_radius_m(), 5.87e-3, 0.005e-3);
  double smallest = 1;
  double at_deg = 0;
  for (double deg = -74; deg <= 74; deg += 0.01) {
    const double curvature = slope_of(printed_slope_m, deg * kRadPerDeg, 1.0 / 4096);
    const double radius = 12.5e-3 + printed_lift_m(deg * kRadPerDeg) + curvature;
    if (radius < smallest) {
      smallest = radius;
      at_deg = deg;
    }
  }
  EXPECT_NEAR(lift.smallest_radius_m(), smallest, 1e-9);
  EXPECT_NEAR(std::fabs(lift.smallest_radius_at_deg()), std::fabs(at_deg), 0.02);  // the cam is symmetric: either flank
}

TEST(ValveLift, FindsACamsSharpestPlaceOnWhicheverSideOfAnyGridItLies) {
  // The contour's radius of curvature r_0 + y + y'' of lobes of many widths, at a ten-thousandth of a degree about its
  // smallest.
  for (double half_angle_deg = 60; half_angle_deg < 90; half_angle_deg += 1.7) {
    Cam cam = ohc_125_cam();
    cam.half_angle_deg = half_angle_deg;
    const ValveLift lift = lift_of(cam, direct_rocker(30e-3, 0));
    const auto radius_m = [&](double deg) {
      const CamLift y = lift.cam().at(deg * kRadPerDeg);
      return 30e-3 + y.lift_m + y.per_rad2_m;
    };
    double sharpest_deg = 0;
    for (double deg = -half_angle_deg; deg <= 0; deg += 0.01) {
      if (radius_m(deg) < radius_m(sharpest_deg)) sharpest_deg = deg;
    }
    double smallest_m = radius_m(sharpest_deg);
    for (int i = -100; i <= 100; ++i) smallest_m = std::min(smallest_m, radius_m(sharpest_deg + 1e-4 * i));
    // Within 5e-5 deg of the true one; R'' is some metres per square radian.
    EXPECT_NEAR(lift.smallest_radius_m(), smallest_m, 1e-11) << half_angle_deg;
    EXPECT_NEAR(radius_m(lift.smallest_radius_at_deg()), smallest_m, 1e-11) << half_angle_deg;
  }
}

TEST(ValveLiftRefusal, OfAnUndercutCamNamesTheAngleOfItsSharpestPlace) {
  // The 125's contour loses 12.5 - 5.87 mm to its smallest radius of curvature: a base circle of 6.6 mm is undercut,
  // one of 6.7 is not.
  ValveLift lift;
  Rocker rocker = direct_rocker(6.6e-3, 0);
  EXPECT_TRUE(refuses(lift.init(ohc_125_cam(), rocker), Reason::inconsistent, "rocker.base_circle_m"));
  EXPECT_NEAR(std::fabs(lift.failed_at_deg()), 32.9, 0.1);
  rocker.base_circle_m = 6.7e-3;
  EXPECT_TRUE(accepted(lift.init(ohc_125_cam(), rocker)));
}

TEST(ValveLiftRefusal, OfATriangleThatTheNosePushesOpenNamesFullLift) {
  // l_a + l_c must be longer than r_0 + r_s + y_max = 48.80 mm.
  ValveLift lift;
  Rocker rocker = ohc_125_rocker();
  rocker.pivot_to_pad_m = 48.75e-3 - rocker.pivot_to_cam_m;
  EXPECT_TRUE(refuses(lift.init(ohc_125_cam(), rocker), Reason::inconsistent, "rocker.pivot_to_pad_m"));
  EXPECT_NEAR(lift.failed_at_deg(), 0, 0.01);
}

TEST(ValveLiftRefusal, OfATriangleThatDoesNotReachTheBaseCircleNamesAnAngleThere) {
  // |l_a - l_c| must be shorter than r_0 + r_s = 42.5 mm.
  ValveLift lift;
  Rocker rocker = ohc_125_rocker();
  rocker.pivot_to_pad_m = 42.6e-3 + rocker.pivot_to_cam_m;
  EXPECT_TRUE(refuses(lift.init(ohc_125_cam(), rocker), Reason::inconsistent, "rocker.pivot_to_pad_m"));
  EXPECT_NEAR(std::fabs(lift.failed_at_deg()), 74, 0.1);
}

TEST(ValveLiftRefusal, OfATrainThatJamsNamesWhereTheNormalMeetsThePivot) {
  // A pivot close to the cam: on the steep flank the contact's normal leans past it, and J' = J - gamma falls below 0.
  ValveLift lift;
  Rocker rocker = ohc_125_rocker(CamTurns::away_from_pivot);
  rocker.base_circle_m = 16.5e-3;
  rocker.pad_radius_m = 12e-3;
  rocker.pivot_to_pad_m = 42.4e-3;
  rocker.pivot_to_cam_m = 14.3e-3;
  EXPECT_TRUE(refuses(lift.init(ohc_125_cam(), rocker), Reason::inconsistent, "rocker.pivot_to_cam_m"));
  const auto pressure_angle = [&](double phi) {
    const double height = 28.5e-3 + printed_lift_m(phi);
    const double R = std::hypot(height, printed_slope_m(phi));
    return std::acos((42.4e-3 * 42.4e-3 + R * R - 14.3e-3 * 14.3e-3) / (2 * 42.4e-3 * R)) -
           std::atan(printed_slope_m(phi) / height);
  };
  const double worst = lift.failed_at_deg() * kRadPerDeg;
  EXPECT_LT(pressure_angle(worst), 0);
  for (double phi = -1.29; phi < 1.29; phi += 0.001)
    EXPECT_GE(pressure_angle(phi), pressure_angle(worst) - 1e-9) << phi;
}

TEST(ValveLiftRefusal, OfAScrewThatCannotReachTheStemNamesIt) {
  ValveLift lift;
  Rocker rocker = ohc_125_rocker();
  rocker.pivot_to_screw_m = 11.69e-3;  // rho + z + clearance = 11.70 mm
  EXPECT_TRUE(refuses(lift.init(ohc_125_cam(), rocker), Reason::inconsistent, "rocker.pivot_to_screw_m"));
  EXPECT_NEAR(lift.failed_at_deg(), -74, 1e-9);
  rocker = ohc_125_rocker();
  rocker.stem_above_pivot_m = -1;  // as far below
  EXPECT_TRUE(refuses(lift.init(ohc_125_cam(), rocker), Reason::inconsistent, "rocker.pivot_to_screw_m"));
}

TEST(ValveLiftRefusal, OfAScrewThatSwingsPastTheVerticalNamesFullLift) {
  ValveLift lift;
  Rocker rocker = ohc_125_rocker();
  rocker.stem_above_pivot_m = -42.6e-3;  // psi_0 = -78 deg, and the rocker swings by 14
  EXPECT_TRUE(refuses(lift.init(ohc_125_cam(), rocker), Reason::inconsistent, "rocker.pivot_to_screw_m"));
  EXPECT_NEAR(lift.failed_at_deg(), 0, 0.01);
}

TEST(ValveLiftRefusal, OfWhatIsNoDefinitionIsThatOfTheDefinition) {
  ValveLift lift;
  Rocker rocker = ohc_125_rocker();
  rocker.pad_radius_m = -1;
  EXPECT_TRUE(refuses(lift.init(ohc_125_cam(), rocker), Reason::not_positive, "rocker.pad_radius_m"));
  Cam cam = ohc_125_cam();
  cam.half_angle_deg = 181;
  EXPECT_TRUE(refuses(lift.init(cam, ohc_125_rocker()), Reason::out_of_range, "cam.half_angle_deg"));
}

TEST(RockerLift, OfAnyTrainThatIsAcceptedRisesAndFallsOnceWithoutAStep) {
  Random random;
  int taken = 0;
  for (int draw = 0; draw < 100; ++draw) {
    ValveLift lift;
    const Cam cam = support::random_cam(random);
    const Rocker rocker = support::random_rocker(random);
    if (!lift.init(cam, rocker).ok()) continue;
    ++taken;
    const double width = lift.closes_rad() - lift.opens_rad();
    double before = -rocker.clearance_m;
    for (int i = 1; i < 400; ++i) {
      const double rad = lift.opens_rad() + width * i / 400;
      const LiftPose pose = lift.at(rad);
      const double rise = pose.lift_m - before;
      EXPECT_LT(std::fabs(rise), 0.05 * lift.largest_lift_m()) << random.trace(draw);  // a 400th of the lobe
      EXPECT_GE(pose.per_rad_m * (rad < 0 ? 1 : -1), -1e-17) << random.trace(draw) << ", " << rad << " rad";
      EXPECT_GT(pose.rocker_ratio, 0) << random.trace(draw);
      before = pose.lift_m;
    }
  }
  EXPECT_GT(taken, 20);
}

}  // namespace
}  // namespace crankloop::valve_lift_test

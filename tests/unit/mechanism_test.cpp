// The crank mechanism's motion: against vector geometry, against differences, and every figure that the sources
// publish.
//
// Sources as in docs/model.md: [Li 2006] the published facts, [495] the diesel's sheet.
#include <crankloop/tabulate/mechanism.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/differences.hpp"
#include "support/engines.hpp"
#include "support/fourier.hpp"
#include "support/units.hpp"
#include "support/vector_geometry.hpp"

namespace crankloop::mechanism_test {

using namespace detail;
namespace {

using support::kEps;
using support::kWidePi;
using support::Random;
using support::wide;
using support::Wide;

using support::kPi;
using support::kRadPerDeg;

// A figure printed with n decimals is right to half a unit of the last one.
constexpr double kHalfOfThirdDecimal = 0.0005;
constexpr double kHalfOfFourthDecimal = 0.00005;
constexpr double kHalfOfFifthDecimal = 0.000005;
constexpr double kHalfOfTenthOfDegree = 0.05;

/// A mechanism of unit crank radius: what is computed for it is in units of r.
Crank unit_crank(double lambda, double offset_ratio = 0) {
  Crank crank;
  crank.bore_m = 1.5;
  crank.crank_radius_m = 1;
  crank.rod_length_m = 1 / lambda;
  crank.pin_offset_m = offset_ratio;
  return crank;
}

/// Rounding of a pose: each quantity is about eight operations, off by half a unit each, on terms of the stated size.
/// Every division by cos b also passes on the relative error of cos b, which is tan^2 b times that of sin b: hence the
/// powers of 1/cos b.
struct PoseRounding {
  double displacement, slope, acceleration, rod_angle, rod_slope, rod_curvature, rod_tilt, radial;

  PoseRounding(const Crank& crank, double cos_b) {
    constexpr double kOperations = 8 * kEps / 2;
    const double r = crank.crank_radius_m;
    const double lean = (r + std::fabs(crank.pin_offset_m)) / crank.rod_length_m;  // bound of |sin b|
    const double secant = 1 / cos_b;
    const double secant_cubed = secant * secant * secant;
    displacement = kOperations * (r + crank.rod_length_m) * secant;
    rod_tilt = kOperations * lean * secant_cubed;
    rod_angle = kOperations * lean * secant;
    rod_slope = kOperations * lean * secant_cubed;
    rod_curvature = kOperations * lean * secant_cubed * secant_cubed;
    slope = kOperations * r * (1 + lean * secant_cubed);
    radial = slope / r;
    acceleration = kOperations * r * (1 + lean * secant_cubed * secant_cubed);
  }
};

void expect_pose_of_vector_geometry(const Crank& crank, double a) {
  const Pose<double> pose = exact_pose(crank, a);
  const support::Motion m = support::motion_at(crank, wide(a), 1);
  const support::Vec rod = m.crank_pin - m.piston_pin;
  const PoseRounding tolerance{crank, static_cast<double>(-rod.up / support::length(rod))};
  const auto near = [](double got, Wide want, double within, const char* what) {
    EXPECT_NEAR(static_cast<double>(wide(got) - want), 0, within) << what << ": " << got;
  };
  near(pose.displacement_m, support::greatest_height(crank) - m.piston_pin.up, tolerance.displacement, "displacement");
  near(pose.slope_m, -m.piston_pin_velocity.up, tolerance.slope, "velocity");
  near(pose.acceleration_m, -m.piston_pin_acceleration.up, tolerance.acceleration, "acceleration");
  near(pose.rod_angle_rad, m.rod_lean_rad, tolerance.rod_angle, "rod angle");
  near(pose.rod_slope, -m.rod_turn_rad_s, tolerance.rod_slope, "rod speed");
  near(pose.rod_curvature, -m.rod_turn_rad_s2, tolerance.rod_curvature, "rod acceleration");
  near(pose.rod_tilt, rod.lateral / -rod.up, tolerance.rod_tilt, "tan b");
  // A rod that pushes with 1 N along the cylinder axis presses the crank pin toward the crank centre with this.
  const Wide inward = -support::dot(rod, m.crank_pin) / support::length(m.crank_pin) / -rod.up;
  near(pose.radial, inward, tolerance.radial, "cos(a + b) / cos b");
}

TEST(ExactPose, IsTheVectorGeometryOfCircleAndCylinderAxisForAnyMechanism) {
  Random random;
  for (int draw = 0; draw < 20'000; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Crank crank = support::random_crank(random);
    expect_pose_of_vector_geometry(crank, random.between(-2 * kPi, 4 * kPi));
    if (HasFailure()) return;
  }
}

TEST(ExactPose, HoldsWithTheOffsetToEitherSideAtTheQuarterTurns) {
  for (const double offset_ratio : {-0.2, -0.05, 0.0, 0.05, 0.2}) {
    for (int quarter = -2; quarter <= 6; ++quarter) {
      expect_pose_of_vector_geometry(unit_crank(0.32, offset_ratio), quarter * kPi / 2);
    }
  }
}

TEST(ExactPose, HoldsWhereTheRodIsBarelyLongEnoughToTurn) {
  Random random;
  for (int draw = 0; draw < 5'000; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    Crank crank = support::random_crank(random);
    crank.rod_length_m = (crank.crank_radius_m + std::fabs(crank.pin_offset_m)) * random.between(1.001, 1.2);
    expect_pose_of_vector_geometry(crank, random.between(0, 2 * kPi));
    if (HasFailure()) return;
  }
}

/// Bounds of a mechanism's motion in the complex strip |Im a| <= 1, where |sin a| and |cos a| stay below cosh 1.
struct StripBound {
  double displacement, slope, rod_angle, rod_slope;
  explicit StripBound(const Crank& crank) {
    const double r = crank.crank_radius_m;
    const double l = crank.rod_length_m;
    const double swing = std::cosh(1.0);
    const double sin_b = (r * swing + std::fabs(crank.pin_offset_m)) / l;
    EXPECT_LT(sin_b, 1) << "the square root has its branch point inside the strip";
    const double cos_b_least = std::sqrt(1 - sin_b * sin_b);
    const double cos_b_most = std::sqrt(1 + sin_b * sin_b);
    displacement = (r + l) + r * swing + l * cos_b_most;
    slope = r * swing * (1 + sin_b / cos_b_least);
    rod_angle = std::asin(sin_b);
    rod_slope = r / l * swing / cos_b_least;
  }
};

TEST(ExactPose, EachDerivativeIsTheDifferenceOfTheOneBefore) {
  Random random;
  for (int draw = 0; draw < 2'000; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Crank crank = support::random_crank(random);
    const double a = random.between(0, 2 * kPi);
    const Pose<double> pose = exact_pose(crank, a);
    const StripBound bound{crank};
    const PoseRounding noise{crank, std::cos(pose.rod_angle_rad)};
    const auto slope_of = [&](double Pose<double>::*quantity) {
      return support::slope_of([&](double at) { return exact_pose(crank, at).*quantity; }, a);
    };
    const auto tolerance = [](double strip_bound, double value_noise) {
      return support::slope_tolerance(strip_bound,
                                      2 * value_noise);  // twice: the noise is stated at a, not at a +- 2 h
    };
    EXPECT_NEAR(pose.slope_m, slope_of(&Pose<double>::displacement_m),
                tolerance(bound.displacement, noise.displacement));
    EXPECT_NEAR(pose.acceleration_m, slope_of(&Pose<double>::slope_m), tolerance(bound.slope, noise.slope));
    EXPECT_NEAR(pose.rod_slope, slope_of(&Pose<double>::rod_angle_rad), tolerance(bound.rod_angle, noise.rod_angle));
    EXPECT_NEAR(pose.rod_curvature, slope_of(&Pose<double>::rod_slope), tolerance(bound.rod_slope, noise.rod_slope));
    if (HasFailure()) return;
  }
}

TEST(ExactPose, MirroringTheOffsetMirrorsTheMotion) {
  Random random;
  for (int draw = 0; draw < 1'000; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Crank crank = support::random_crank(random);
    Crank mirrored = crank;
    mirrored.pin_offset_m = -crank.pin_offset_m;
    const double a = random.between(0, 2 * kPi);
    const Pose<double> one = exact_pose(crank, a);
    const Pose<double> other = exact_pose(mirrored, -a);
    EXPECT_EQ(one.displacement_m, other.displacement_m);
    EXPECT_EQ(one.slope_m, -other.slope_m);
    EXPECT_EQ(one.acceleration_m, other.acceleration_m);
    EXPECT_EQ(one.rod_angle_rad, -other.rod_angle_rad);
    EXPECT_EQ(one.rod_curvature, -other.rod_curvature);
  }
}

// ---- dead centres, stroke, mean speed, angle from displacement ------------------------------------------------------

TEST(DeadCentres, AreThePublishedOnesOfTheExampleWithTenMillimetresOfOffset) {
  Crank crank = support::diesel_495_crank();
  crank.pin_offset_m = 0.010;
  const DeadCentres found = dead_centres(crank);
  EXPECT_NEAR(found.tdc_rad / kRadPerDeg, 2.142, kHalfOfThirdDecimal);
  EXPECT_NEAR(found.bdc_rad / kRadPerDeg, 183.760, kHalfOfThirdDecimal);
  EXPECT_NEAR(found.stroke_m * 1000, 115.141, kHalfOfThirdDecimal);
}

TEST(DeadCentres, AreWhereTheRodLiesInLineWithTheCrankAndThePistonTurnsRound) {
  Random random;
  for (int draw = 0; draw < 5'000; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Crank crank = support::random_crank(random);
    const DeadCentres found = dead_centres(crank);
    const PoseRounding rounding{crank, 0.8};
    // Geometry: the greatest and the least height the piston pin can have.
    const double stroke = static_cast<double>(support::greatest_height(crank) - support::least_height(crank));
    EXPECT_NEAR(found.stroke_m, stroke, rounding.displacement);
    EXPECT_GE(found.stroke_m, 2 * crank.crank_radius_m * (1 - 4 * kEps));
    const Pose<double> top = exact_pose(crank, found.tdc_rad);
    const Pose<double> bottom = exact_pose(crank, found.bdc_rad);
    EXPECT_NEAR(top.displacement_m, 0, rounding.displacement);
    EXPECT_NEAR(bottom.displacement_m, stroke, rounding.displacement);
    // The dead-centre angle itself is off by a rounding of pi: that much of the acceleration may be left as speed.
    const double angle_rounding = 4 * kEps * kPi;
    EXPECT_NEAR(top.slope_m, 0, rounding.slope + angle_rounding * std::fabs(top.acceleration_m));
    EXPECT_NEAR(bottom.slope_m, 0, rounding.slope + angle_rounding * std::fabs(bottom.acceleration_m));
    EXPECT_GT(top.acceleration_m, 0);
    EXPECT_LT(bottom.acceleration_m, 0);
    EXPECT_LT(std::fabs(found.tdc_rad), kPi / 2);
    EXPECT_NEAR(found.bdc_rad, kPi, kPi / 2);
    for (int i = 0; i < 36; ++i) {
      const double x = exact_pose(crank, i * 10 * kRadPerDeg).displacement_m;
      EXPECT_GE(x, -rounding.displacement);
      EXPECT_LE(x, stroke + rounding.displacement);
    }
    if (HasFailure()) return;
  }
}

TEST(DeadCentres, WithoutOffsetAreZeroAndHalfATurnAndTheStrokeIsTwoRadii) {
  const DeadCentres found = dead_centres(support::diesel_495_crank());
  EXPECT_EQ(found.tdc_rad, 0);
  EXPECT_EQ(found.bdc_rad, kPi);
  EXPECT_NEAR(found.stroke_m, 0.115, 4 * kEps * 0.2675);
}

TEST(MeanPistonSpeed, IsStrokeTimesRpmPerThirtyAndTwoPerPiOfTheCrankPinSpeed) {
  const Crank crank = support::diesel_495_crank();
  const double rpm = 2000;
  const double w = rpm * 2 * kPi / 60;
  const double mean = mean_piston_speed_m_s(crank, w);
  EXPECT_NEAR(mean, 0.115 * rpm / 30, 8 * kEps * mean);
  EXPECT_NEAR(mean, 7.67, 0.005);                                                // [495]
  EXPECT_NEAR(mean / (crank.crank_radius_m * w), 0.6366, kHalfOfFourthDecimal);  // [Li 2006]
}

TEST(MeanPistonSpeed, IsTheTimeMeanOfTheSpeedOfAnyMechanism) {
  Random random;
  for (int draw = 0; draw < 20; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Crank crank = support::random_crank(random);
    // The midpoint rule over each stroke by itself, where the speed keeps its sign: off by at most h^2/24 turn
    // max|v''|, and |v''| <= 2 bound on the strip (Cauchy).
    const DeadCentres centres = dead_centres(crank);
    constexpr int kSteps = 20'000;
    Wide travelled = 0;
    const auto stroke = [&](double from, double to) {
      const double h = (to - from) / kSteps;
      for (int i = 0; i < kSteps; ++i)
        travelled += wide(std::fabs(exact_pose(crank, from + (i + 0.5) * h).slope_m) * h);
    };
    stroke(centres.tdc_rad, centres.bdc_rad);
    stroke(centres.bdc_rad, centres.tdc_rad + 2 * kPi);
    const double h = 1.1 * kPi / kSteps;
    const double tolerance = h * h / 24 * 2 * StripBound{crank}.slope;
    EXPECT_NEAR(mean_piston_speed_m_s(crank, 100), static_cast<double>(travelled) / (2 * kPi) * 100, 100 * tolerance);
  }
}

TEST(CrankAngleAt, PutsThePistonWhereItWasAskedForOnBothStrokes) {
  Random random;
  for (int draw = 0; draw < 20'000; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Crank crank = support::random_crank(random);
    const DeadCentres centres = dead_centres(crank);
    const double x = centres.stroke_m * random.between(0, 1);
    const double down = crank_angle_rad(crank, x, true);
    const double up = crank_angle_rad(crank, x, false);
    // At a dead centre the angle hangs on the square root of the displacement; the displacement it leads back to does
    // not. The triangle's cosine is off by some units, and da dx/da = d(cos) r side / l.
    const double tolerance = 2 * PoseRounding{crank, 0.8}.displacement;
    EXPECT_NEAR(exact_pose(crank, down).displacement_m, x, tolerance);
    EXPECT_NEAR(exact_pose(crank, up).displacement_m, x, tolerance);
    // sqrt(rounding): the angle's own uncertainty at a dead centre
    const double at_dead_centre = 1e-7;
    EXPECT_GE(down, centres.tdc_rad - at_dead_centre);
    EXPECT_LE(down, centres.bdc_rad + at_dead_centre);
    EXPECT_GE(up, centres.bdc_rad - at_dead_centre);
    EXPECT_LE(up, centres.tdc_rad + 2 * kPi + at_dead_centre);
    if (HasFailure()) return;
  }
}

TEST(CrankAngleUp, BringsThePistonBackToWhereItWasOnTheWayDown) {
  Random random;
  for (int draw = 0; draw < 20'000; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Crank crank = support::random_crank(random);
    const DeadCentres centres = dead_centres(crank);
    const double down = random.between(centres.tdc_rad, centres.bdc_rad);
    const double x = exact_pose(crank, down).displacement_m;
    const double up = crank_angle_up_rad(crank, down, x);
    // The angle is rounded to an ulp of a turn, with a slope of some radii, and leans by as much as the height is off.
    const double tolerance = 2 * PoseRounding{crank, 0.8}.displacement + 4 * kEps * 2 * kPi * crank.crank_radius_m;
    EXPECT_NEAR(exact_pose(crank, up).displacement_m, x, tolerance);
    EXPECT_GE(up, centres.bdc_rad - 4 * kEps);
    EXPECT_LE(up, centres.tdc_rad + 2 * kPi + 4 * kEps);
    if (HasFailure()) return;
  }
}

TEST(CrankAngleAt, AnswersTheNearerDeadCentreBeyondTheStroke) {
  Crank crank = support::diesel_495_crank();
  for (const double offset : {-0.010, 0.0, 0.010}) {
    crank.pin_offset_m = offset;
    const DeadCentres centres = dead_centres(crank);
    const double rounding = 1e-7;  // sqrt of the triangle's rounding
    EXPECT_NEAR(crank_angle_rad(crank, -0.001, true), centres.tdc_rad, rounding) << offset;
    EXPECT_NEAR(crank_angle_rad(crank, -0.001, false), centres.tdc_rad + 2 * kPi, rounding) << offset;
    EXPECT_NEAR(crank_angle_rad(crank, centres.stroke_m + 0.001, true), centres.bdc_rad, rounding) << offset;
    EXPECT_NEAR(crank_angle_rad(crank, centres.stroke_m + 0.001, false), centres.bdc_rad, rounding) << offset;
  }
}

TEST(Volumes, FollowFromBoreTrueStrokeAndCompressionRatio) {
  Crank crank = support::diesel_495_crank();
  EXPECT_NEAR(bore_area_m2(crank) * 1e4, 70.88, 0.005);  // [495], its print is damaged
  EXPECT_NEAR(swept_volume_m3(crank) * 1000, 0.8151, kHalfOfFourthDecimal);
  crank.pin_offset_m = 0.010;
  const double area = kPi * 0.0475 * 0.0475;
  const double swept = area * static_cast<double>(support::greatest_height(crank) - support::least_height(crank));
  EXPECT_NEAR(bore_area_m2(crank), area, 4 * kEps * area);
  EXPECT_NEAR(swept_volume_m3(crank), swept, 8 * kEps * swept);
  EXPECT_NEAR((swept_volume_m3(crank) + clearance_volume_m3(crank)) / clearance_volume_m3(crank), 19, 16 * kEps * 19);
}

// ---- the published facts of the second-order approximations ---------------------------------------------------------

constexpr int kFine =
    36'000;  // samples of a turn when a bound is looked for: 0.01 deg, so a flat maximum is missed by < 1e-7

TEST(SecondOrder, VelocityAtLambda032IsOffByAtMost00057OfTheCrankPinSpeed) {
  const Crank crank = unit_crank(0.32);
  double largest = 0;
  double largest_relative = 0;
  for (int i = 0; i < kFine; ++i) {
    const double a = 2 * kPi * i / kFine;
    const double exact = exact_pose(crank, a).slope_m;
    const double error = std::fabs(second_order_pose(crank, a).slope_m - exact);
    largest = std::max(largest, error);
    if (std::fabs(exact) > 1e-6) largest_relative = std::max(largest_relative, error / std::fabs(exact));
  }
  EXPECT_NEAR(largest, 0.0057, kHalfOfFourthDecimal);
  EXPECT_LT(largest_relative, 0.0083);
  EXPECT_GT(largest_relative, 0.0082);  // the published bound is not a generous one
}

TEST(SecondOrder, VelocityAtLambda032IsExactAtTheQuarterTurns) {
  const Crank crank = unit_crank(0.32);
  const double tolerance = 2 * PoseRounding{crank, 0.9}.slope;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double a = quarter * kPi / 2;
    EXPECT_NEAR(second_order_pose(crank, a).slope_m, exact_pose(crank, a).slope_m, tolerance) << quarter;
  }
}

TEST(SecondOrder, AccelerationAtLambda032IsExactAtTheDeadCentresAndNearFourOtherAngles) {
  const Crank crank = unit_crank(0.32);
  const auto error = [&](double a) {
    return second_order_pose(crank, a).acceleration_m - exact_pose(crank, a).acceleration_m;
  };
  const double tolerance = 2 * PoseRounding{crank, 0.9}.acceleration;
  EXPECT_NEAR(error(0), 0, tolerance);
  EXPECT_NEAR(error(kPi), 0, tolerance);
  for (const double published_deg : {60.5, 119.5, 240.5, 299.5}) {
    double low = (published_deg - 5) * kRadPerDeg;
    double high = (published_deg + 5) * kRadPerDeg;
    ASSERT_LT(error(low) * error(high), 0) << published_deg;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (error(low) * error(middle) <= 0 ? high : low) = middle;
    }
    EXPECT_NEAR(low / kRadPerDeg, published_deg, kHalfOfTenthOfDegree);
  }
}

TEST(SecondOrder, AccelerationAtLambda032IsWorstAtTheQuarterTurnsAndLowThereBy00178) {
  const Crank crank = unit_crank(0.32);
  for (const double a : {kPi / 2, 3 * kPi / 2}) {
    const double exact = exact_pose(crank, a).acceleration_m;
    const double low_by = std::fabs(exact) - std::fabs(second_order_pose(crank, a).acceleration_m);
    EXPECT_NEAR(low_by, 0.0178, kHalfOfFourthDecimal);
    EXPECT_NEAR(low_by / std::fabs(exact), 0.053, kHalfOfThirdDecimal);
  }
  const double at_quarter =
      std::fabs(second_order_pose(crank, kPi / 2).acceleration_m - exact_pose(crank, kPi / 2).acceleration_m);
  for (int i = 0; i < kFine; ++i) {
    const double a = 2 * kPi * i / kFine;
    EXPECT_LE(std::fabs(second_order_pose(crank, a).acceleration_m - exact_pose(crank, a).acceleration_m),
              at_quarter * (1 + 1e-12));
  }
}

TEST(SecondOrder, SpeedIsGreatestWhereThePublishedCosineSays) {
  for (const double lambda : {0.15, 0.2738, 0.32, 0.45}) {
    const Crank crank = unit_crank(lambda);
    const Extremes speed = extremes(crank, &Pose<double>::slope_m, second_order_pose);
    const double published = std::acos((std::sqrt(1 + 8 * lambda * lambda) - 1) / (4 * lambda));
    const double value = second_order_pose(crank, published).slope_m;
    EXPECT_NEAR(speed.largest.at_rad, published, 1e-7) << lambda;
    EXPECT_NEAR(speed.smallest.at_rad, 2 * kPi - published, 1e-7) << lambda;
    EXPECT_NEAR(speed.largest.value, value, 4 * kEps) << lambda;
    EXPECT_NEAR(speed.smallest.value, -value, 4 * kEps) << lambda;
  }
}

TEST(SecondOrder, AccelerationHasItsThreePublishedExtremes) {
  for (const double lambda : {0.15, 0.24, 0.26, 0.2738, 0.32, 0.45}) {
    const Crank crank = unit_crank(lambda);
    const Extremes j = extremes(crank, &Pose<double>::acceleration_m, second_order_pose);
    EXPECT_EQ(j.largest.at_rad, 0) << lambda;
    EXPECT_NEAR(j.largest.value, 1 + lambda, 4 * kEps) << lambda;
    EXPECT_NEAR(second_order_pose(crank, kPi).acceleration_m, -(1 - lambda), 4 * kEps) << lambda;
    if (lambda <= 0.25) {
      EXPECT_NEAR(j.smallest.at_rad, kPi, 1e-7) << lambda;
      EXPECT_NEAR(j.smallest.value, -(1 - lambda), 4 * kEps) << lambda;
    } else {
      const double published = std::acos(-1 / (4 * lambda));
      const double folded = std::min(j.smallest.at_rad, 2 * kPi - j.smallest.at_rad);  // there are two, mirrored
      // A flat minimum: an angle off by d changes the value by j'' d^2/2, hidden below rounding when d < sqrt(2
      // eps/j'').
      const double curvature = (16 * lambda * lambda - 1) / (4 * lambda);
      EXPECT_NEAR(folded, published, std::max(1e-7, 4 * std::sqrt(2 * kEps / curvature))) << lambda;
      EXPECT_NEAR(j.smallest.value, -(lambda + 1 / (8 * lambda)), 4 * kEps) << lambda;
    }
  }
}

TEST(ExactAcceleration, HasInnerMinimaOnlyAboveTheThreshold026376) {
  // The fourth derivative of x at 180 deg is r (1 - 4 lambda + 3 lambda^3) = r (1 - lambda)(1 - 3 lambda - 3 lambda^2),
  // from the series of cos b about it; its root is (sqrt 21 - 3)/6.
  const double threshold = (std::sqrt(21.0) - 3) / 6;
  EXPECT_NEAR(threshold, 0.26376, kHalfOfFifthDecimal);
  const auto smallest_off_bottom_deg = [](double lambda) {
    return std::fabs(extremes(unit_crank(lambda), &Pose<double>::acceleration_m).smallest.at_rad / kRadPerDeg - 180);
  };
  // At the threshold the minimum is flat to the fourth power: between 180 deg and a there is a^4/24 j'''' to find, so
  // rounding hides (24 eps)^(1/4) = 0.02 deg. The published five digits are tested from both sides.
  EXPECT_LT(smallest_off_bottom_deg(0.26375), 0.1);
  EXPECT_GT(smallest_off_bottom_deg(0.26377), 0.2);
  EXPECT_LT(smallest_off_bottom_deg(0.20), 1e-5);
  EXPECT_GT(smallest_off_bottom_deg(0.32), 20);
}

TEST(ExactAcceleration, AndItsApproximationDifferInTheirMinimaAtTheRodRatioOfThe495) {
  const Crank crank = unit_crank(0.2738);
  const Extreme approximate = extremes(crank, &Pose<double>::acceleration_m, second_order_pose).smallest;
  const Extreme exact = extremes(crank, &Pose<double>::acceleration_m).smallest;
  const auto folded_deg = [](double rad) { return std::min(rad, 2 * kPi - rad) / kRadPerDeg; };
  EXPECT_NEAR(approximate.value, -0.73034, kHalfOfFifthDecimal);
  EXPECT_NEAR(folded_deg(approximate.at_rad), 155.9, kHalfOfTenthOfDegree);
  EXPECT_NEAR(exact.value, -0.72696, kHalfOfFifthDecimal);
  EXPECT_NEAR(folded_deg(exact.at_rad), 162.7, kHalfOfTenthOfDegree);
}

TEST(RodMotion, HasItsThreePublishedExtremes) {
  for (const double lambda : {0.15, 0.2738, 0.32, 0.45}) {
    const Crank crank = unit_crank(lambda);
    const Extremes angle = extremes(crank, &Pose<double>::rod_angle_rad);
    EXPECT_NEAR(angle.largest.value, std::asin(lambda), 4 * kEps) << lambda;
    EXPECT_NEAR(angle.smallest.value, -std::asin(lambda), 4 * kEps) << lambda;
    EXPECT_NEAR(angle.largest.at_rad, kPi / 2, 1e-7) << lambda;
    EXPECT_NEAR(angle.smallest.at_rad, 3 * kPi / 2, 1e-7) << lambda;
    const Extremes speed = extremes(crank, &Pose<double>::rod_slope);
    EXPECT_NEAR(speed.largest.value, lambda, 4 * kEps) << lambda;
    EXPECT_NEAR(speed.smallest.value, -lambda, 4 * kEps) << lambda;
    EXPECT_NEAR(speed.largest.at_rad, 0, 1e-7) << lambda;
    EXPECT_NEAR(speed.smallest.at_rad, kPi, 1e-7) << lambda;
    const Extremes acceleration = extremes(crank, &Pose<double>::rod_curvature);
    const double published = lambda / std::sqrt(1 - lambda * lambda);
    EXPECT_NEAR(acceleration.smallest.value, -published, 8 * kEps) << lambda;
    EXPECT_NEAR(acceleration.largest.value, published, 8 * kEps) << lambda;
    EXPECT_NEAR(acceleration.smallest.at_rad, kPi / 2, 1e-7) << lambda;
    EXPECT_NEAR(acceleration.largest.at_rad, 3 * kPi / 2, 1e-7) << lambda;
  }
}

TEST(RodMotion, WithoutOffsetHasThePublishedClosedFormOfItsAcceleration) {
  for (const double lambda : {0.15, 0.2738, 0.45}) {
    const Crank crank = unit_crank(lambda);
    for (int degree = 0; degree < 360; ++degree) {
      const double a = degree * kRadPerDeg;
      const Pose<double> pose = exact_pose(crank, a);
      const double cos_b = std::cos(pose.rod_angle_rad);
      const double published = -lambda * (1 - lambda * lambda) * std::sin(a) / (cos_b * cos_b * cos_b);
      EXPECT_NEAR(pose.rod_curvature, published, 2 * PoseRounding(crank, cos_b).rod_curvature)
          << lambda << " at " << degree;
    }
  }
}

/// Largest difference of a quantity between the second-order and the exact pose over a turn.
double largest_error(double lambda, double Pose<double>::*quantity) {
  const Crank crank = unit_crank(lambda);
  double largest = 0;
  for (int degree = 0; degree < 360; ++degree) {
    const double a = degree * kRadPerDeg;
    largest = std::max(largest, std::fabs(second_order_pose(crank, a).*quantity - exact_pose(crank, a).*quantity));
  }
  return largest;
}

TEST(SecondOrder, EveryQuantityLosesOnlyTheOrderOfLambdaThatItsSeriesLeavesOut) {
  // Halving lambda divides the error by 2^order; the next term, two orders up, makes that 1 + O(lambda^2): at lambda
  // 0.1 within 5 %.
  const auto order_of = [](double Pose<double>::*quantity) {
    return std::log2(largest_error(0.1, quantity) / largest_error(0.05, quantity));
  };
  constexpr double kWithin = 0.05;
  EXPECT_NEAR(order_of(&Pose<double>::displacement_m), 3, kWithin);
  EXPECT_NEAR(order_of(&Pose<double>::slope_m), 3, kWithin);
  EXPECT_NEAR(order_of(&Pose<double>::acceleration_m), 3, kWithin);
  EXPECT_NEAR(order_of(&Pose<double>::rod_angle_rad), 5, kWithin);
  EXPECT_NEAR(order_of(&Pose<double>::rod_slope), 5, kWithin);
  EXPECT_NEAR(order_of(&Pose<double>::rod_curvature), 5, kWithin);
  EXPECT_NEAR(order_of(&Pose<double>::rod_tilt), 5, kWithin);
  EXPECT_NEAR(order_of(&Pose<double>::radial), 5, kWithin);
}

// ---- Fourier form ---------------------------------------------------------------------------------------------------

TEST(DisplacementSeries, IsTheFourierSeriesOfTheExactDisplacementToTheSeventhPowerOfLambda) {
  for (const double lambda : {0.05, 0.1, 0.15, 0.2738, 0.32, 0.45}) {
    const Crank crank = unit_crank(lambda);
    const auto x = [&](double a) { return exact_pose(crank, a).displacement_m; };
    // sqrt(1 - u) = 1 - sum c_k u^k with falling c_k, c_4 = 5/128; u = lambda^2 sin^2 a. The series leaves out k >= 4,
    // in all at most c_4 lambda^7/(1 - lambda^2) times the largest Fourier coefficient that sin^8 a and higher even
    // powers have: 56/128, of cos 2a.
    const double left_out = 5.0 / 128 * std::pow(lambda, 7) / (1 - lambda * lambda) * 56 / 128;
    const double rounding = 4 * kEps / lambda;
    const double tolerance = left_out + rounding;
    const DisplacementSeries series = displacement_series(lambda);
    constexpr int kSamples = 256;  // aliases come from order 250: lambda^249
    EXPECT_NEAR(series.a0, support::fourier_term(x, 0, kSamples).cosine, tolerance) << lambda;
    EXPECT_NEAR(series.a1, support::fourier_term(x, 1, kSamples).cosine, rounding) << lambda;
    EXPECT_NEAR(series.a2, support::fourier_term(x, 2, kSamples).cosine, tolerance) << lambda;
    EXPECT_NEAR(series.a4, support::fourier_term(x, 4, kSamples).cosine, tolerance) << lambda;
    EXPECT_NEAR(series.a6, support::fourier_term(x, 6, kSamples).cosine, tolerance) << lambda;
    for (const int absent : {3, 5, 7})
      EXPECT_NEAR(support::fourier_term(x, absent, kSamples).cosine, 0, rounding) << absent;
    for (int order = 1; order < 8; ++order)
      EXPECT_NEAR(support::fourier_term(x, order, kSamples).sine, 0, rounding) << order;
  }
}

TEST(DisplacementSeries, IsZeroAtTopDeadCentreAndTheStrokeAtTheBottomUpToWhatItLeavesOut) {
  for (const double lambda : {0.1, 0.2738, 0.45}) {
    const DisplacementSeries s = displacement_series(lambda);
    const double left_out = 5 * 5.0 / 128 * std::pow(lambda, 7) / (1 - lambda * lambda);
    EXPECT_NEAR(s.a0 + s.a1 + s.a2 + s.a4 + s.a6, 0, left_out) << lambda;
    EXPECT_NEAR(s.a0 - s.a1 + s.a2 + s.a4 + s.a6, 2, left_out) << lambda;
  }
}

// ---- extremes -------------------------------------------------------------------------------------------------------

TEST(Extremes, AreNotPassedByAnyAngleOfAnyMechanism) {
  Random random;
  for (int draw = 0; draw < 100; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Crank crank = support::random_crank(random);
    const PoseRounding rounding{crank, 0.8};
    const struct {
      double Pose<double>::*quantity;
      double rounding;
    } all[] = {
        {&Pose<double>::displacement_m, rounding.displacement}, {&Pose<double>::slope_m, rounding.slope},
        {&Pose<double>::acceleration_m, rounding.acceleration}, {&Pose<double>::rod_angle_rad, rounding.rod_angle},
        {&Pose<double>::rod_slope, rounding.rod_slope},         {&Pose<double>::rod_curvature, rounding.rod_curvature}};
    for (const auto& one : all) {
      const Extremes found = extremes(crank, one.quantity);
      for (const Extreme& extreme : {found.largest, found.smallest}) {
        EXPECT_GE(extreme.at_rad, 0);
        EXPECT_LT(extreme.at_rad, 2 * kPi);
        EXPECT_NEAR(extreme.value, exact_pose(crank, extreme.at_rad).*one.quantity, one.rounding);
      }
      for (int i = 0; i < 3'600; ++i) {
        const double value =
            exact_pose(crank, i * 0.1 * kRadPerDeg + random.between(0, 0.1) * kRadPerDeg).*one.quantity;
        EXPECT_LE(value, found.largest.value + one.rounding);
        EXPECT_GE(value, found.smallest.value - one.rounding);
      }
    }
    if (HasFailure()) return;
  }
}

TEST(Extremes, OfTheDisplacementAreTheDeadCentres) {
  Random random;
  for (int draw = 0; draw < 200; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Crank crank = support::random_crank(random);
    const Extremes x = extremes(crank, &Pose<double>::displacement_m);
    const DeadCentres centres = dead_centres(crank);
    const double tolerance = 1e-7;  // as mechanism.hpp states
    const double tdc = centres.tdc_rad < 0 ? centres.tdc_rad + 2 * kPi : centres.tdc_rad;
    EXPECT_NEAR(std::remainder(x.smallest.at_rad - tdc, 2 * kPi), 0, tolerance);
    EXPECT_NEAR(x.largest.at_rad, centres.bdc_rad, tolerance);
    EXPECT_NEAR(x.largest.value, centres.stroke_m, PoseRounding(crank, 0.8).displacement);
  }
}

}  // namespace
}  // namespace crankloop::mechanism_test

// The cam as the lift of a flat follower: the polynomial to its definition, measured tables to the cam that was
// measured.
#include <crankloop/tabulate/cam_profile.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "support/differences.hpp"
#include "support/measured_cam.hpp"
#include "support/status.hpp"
#include "support/units.hpp"
#include "support/valve_trains.hpp"

namespace crankloop::cam_profile_test {
namespace {

using support::Measured;
using support::ohc_125_cam;
using support::polynomial_cam;
using support::profile_of;
using support::Random;
using support::refuses;
using support::slope_of;

using support::kPi;
using support::kRadPerDeg;

// ---- polynomial -----------------------------------------------------------------------------------------------------

TEST(CamPolynomial, OfThe125HasThePrintedCoefficients) {
  const double exponents[] = {2, 10, 18, 26};
  double c[4];
  cam_coefficients(exponents, 4, c);
  EXPECT_DOUBLE_EQ(c[0], -195.0 / 128);
  EXPECT_DOUBLE_EQ(c[1], 117.0 / 128);
  EXPECT_DOUBLE_EQ(c[2], -65.0 / 128);
  EXPECT_DOUBLE_EQ(c[3], 15.0 / 128);
}

TEST(CamPolynomial, MeetsTheBaseCircleWithAsManyZeroDerivativesAsItHasExponents) {
  Random random;
  for (int draw = 0; draw < 100; ++draw) {
    const int n = random.whole(2, kMaxCamExponents);
    double p[kMaxCamExponents];
    double c[kMaxCamExponents];
    for (int i = 0; i < n; ++i) p[i] = (i == 0 ? 2 : p[i - 1]) + random.between(0.5, 9);
    cam_coefficients(p, n, c);
    for (int order = 0; order < n; ++order) {
      double sum = order == 0 ? 1 : 0;
      double size = 1;
      for (int i = 0; i < n; ++i) {
        double term = c[i];
        for (int k = 0; k < order; ++k) term *= p[i] - k;
        sum += term;
        size += std::fabs(term);
      }
      EXPECT_LE(std::fabs(sum), 1e-13 * size) << random.trace(draw) << ", " << n << " exponents, derivative " << order;
    }
  }
}

TEST(CamPolynomial, IsItsDefinition) {
  const CamProfile cam = profile_of(ohc_125_cam());
  for (double phi = -80 * kRadPerDeg; phi < 80 * kRadPerDeg; phi += 0.00731) {
    const double u = std::fabs(phi) / (74 * kRadPerDeg);
    const double y = u >= 1 ? 0
                            : 6.301099e-3 * (1 - 195.0 / 128 * std::pow(u, 2) + 117.0 / 128 * std::pow(u, 10) -
                                             65.0 / 128 * std::pow(u, 18) + 15.0 / 128 * std::pow(u, 26));
    EXPECT_NEAR(cam.at(phi).lift_m, y, 1e-17) << phi;
  }
  EXPECT_EQ(cam.largest_lift_m(), 6.301099e-3);
  EXPECT_EQ(cam.residual_m(), 0);
}

TEST(CamPolynomial, HasDerivativesThatAgreeWithDifferences) {
  const Cam cams[] = {ohc_125_cam(), polynomial_cam(8e-3, 60, {2.3, 6.1, 9.7}),
                      polynomial_cam(4e-3, 90, {3, 4, 50, 60, 100})};
  for (const Cam& cam : cams) {
    const CamProfile profile = profile_of(cam);
    for (double phi = 0.05; phi < profile.closes_rad() - 0.01; phi += 0.0037) {
      for (const double at : {phi, -phi}) {
        constexpr double h = 1.0 / 32768;  // rounding of 1e-18 m gives 5e-14, h^4 the rest
        const CamLift y = profile.at(at);
        EXPECT_NEAR(y.per_rad_m, slope_of([&](double x) { return profile.at(x).lift_m; }, at, h), 1e-12) << at;
        EXPECT_NEAR(y.per_rad2_m, slope_of([&](double x) { return profile.at(x).per_rad_m; }, at, h), 2e-11) << at;
      }
    }
  }
}

TEST(CamPolynomial, RisesOnceAndFallsOnceWhateverItsExponents) {
  // n + 1 terms have at most n positive roots (Descartes), and all of them stand at u = 1: y' has none in between.
  Random random;
  for (int draw = 0; draw < 100; ++draw) {
    const CamProfile cam = profile_of(support::random_cam(random));
    for (int i = 1; i < 200; ++i) {
      const CamLift y = cam.at(cam.closes_rad() * i / 200);
      EXPECT_GT(y.lift_m, 0) << random.trace(draw);
      EXPECT_LT(y.per_rad_m, 0) << random.trace(draw);
    }
  }
}

TEST(CamPolynomial, IsExactlyZeroFromTheEndsOfItsLobeOn) {
  const CamProfile cam = profile_of(ohc_125_cam());
  for (const double phi :
       {cam.opens_rad(), cam.closes_rad(), -2.0, 2.0, kPi, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(cam.at(phi).lift_m, 0);
    EXPECT_EQ(cam.at(phi).per_rad_m, 0);
    EXPECT_EQ(cam.at(phi).per_rad2_m, 0);
  }
}

// ---- measured tables ------------------------------------------------------------------------------------------------

/// How far a smoothed cam is from the true one, and what its second derivative does on the way.
struct Comparison {
  double lift_m = 0;           ///< largest distance
  double per_rad2_m = 0;       ///< largest distance
  double least_m = 0;          ///< smallest lift
  double most_per_rad2_m = 0;  ///< peaks of the smoothed y''
  double least_per_rad2_m = 0;
  double swing_m = 0;  ///< sum of all ups and downs of the smoothed y''

  Comparison(const CamProfile& smooth, const CamProfile& truth) {
    double before = 0;
    for (double deg = -100; deg <= 100; deg += 0.02) {
      const CamLift a = smooth.at((deg - smooth.peak_deg()) * kRadPerDeg);
      const CamLift b = truth.at(deg * kRadPerDeg);
      lift_m = std::max(lift_m, std::fabs(a.lift_m - b.lift_m));
      per_rad2_m = std::max(per_rad2_m, std::fabs(a.per_rad2_m - b.per_rad2_m));
      least_m = std::min(least_m, a.lift_m);
      most_per_rad2_m = std::max(most_per_rad2_m, a.per_rad2_m);
      least_per_rad2_m = std::min(least_per_rad2_m, a.per_rad2_m);
      swing_m += std::fabs(a.per_rad2_m - before);
      before = a.per_rad2_m;
    }
  }
};

// The 125's y'' runs from -11.5 to 37.7 mm/rad^2, at 3500 rpm of the cam up to 5070 m/s^2.
constexpr double kPeak_m = 37.714e-3;
constexpr double kNose_m = -11.509e-3;

class SmoothedCam : public testing::Test {
 protected:
  const CamProfile truth = profile_of(ohc_125_cam());
  const double swing_of_truth = Comparison(truth, truth).swing_m;
};

TEST_F(SmoothedCam, OfATableRoundedToAMicrometreIsTheMeasuredOne) {
  // A full turn, and rows that end where the lobe does.
  for (const double end_deg : {180.0, 74.0}) {
    const Measured table = Measured(truth, -end_deg, end_deg, 1).rounded_to(1e-6);
    const CamProfile smooth = profile_of(table.cam(1e-6));
    EXPECT_LE(table.residual_m(smooth), 1.000001e-6);
    EXPECT_NEAR(smooth.residual_m(), table.residual_m(smooth), 1e-12);
    const Comparison found(smooth, truth);
    EXPECT_LE(found.lift_m, 1.5e-6) << end_deg;
    EXPECT_LE(found.per_rad2_m, 0.03 * kPeak_m) << end_deg;
    EXPECT_NEAR(found.most_per_rad2_m, kPeak_m, 0.01 * kPeak_m) << end_deg;
    EXPECT_NEAR(found.least_per_rad2_m, kNose_m, 0.01 * kPeak_m) << end_deg;
    EXPECT_LE(found.swing_m, 1.1 * swing_of_truth) << end_deg;
    EXPECT_LE(std::fabs(smooth.peak_deg()), 0.05) << end_deg;
  }
}

TEST_F(SmoothedCam, OfATableWithThreeMicrometresOfNoiseHasNoSpikes) {
  // Normal noise of 3 um is smoothed to five times that (one row in two million is further off), uniform noise of +-3
  // um to twice that. The bounds are 1.2 to 2 times what 400 draws of each kind showed at most.
  Random random;
  for (int draw = 0; draw < 40; ++draw) {
    const bool normal = draw % 2 == 0;
    Measured table(truth, -180, 180, 1);
    if (normal) {
      table.off_by_normal(3e-6, random);
    } else {
      table.off_by_up_to(3e-6, random);
    }
    const double allowed = normal ? 15e-6 : 6e-6;
    const CamProfile smooth = profile_of(table.cam(allowed));
    EXPECT_LE(table.residual_m(smooth), allowed * 1.000001) << random.trace(draw);
    const Comparison found(smooth, truth);
    EXPECT_LE(found.lift_m, 1.4 * allowed) << random.trace(draw);
    EXPECT_LE(found.per_rad2_m, (normal ? 0.15 : 0.10) * kPeak_m) << random.trace(draw);
    EXPECT_NEAR(found.most_per_rad2_m, kPeak_m, (normal ? 0.08 : 0.04) * kPeak_m) << random.trace(draw);
    EXPECT_NEAR(found.least_per_rad2_m, kNose_m, 0.04 * kPeak_m) << random.trace(draw);
    EXPECT_LE(found.swing_m, 1.1 * swing_of_truth) << random.trace(draw);

    // What the rows' own second differences say, for comparison: each um of noise is up to 13 mm/rad^2 there.
    double raw = 0;
    for (std::size_t i = 1; i + 1 < table.points.size(); ++i) {
      const double second = (table.points[i - 1].lift_m - 2 * table.points[i].lift_m + table.points[i + 1].lift_m) /
                            (kRadPerDeg * kRadPerDeg);
      raw = std::max(raw, std::fabs(second - truth.at(table.points[i].cam_deg * kRadPerDeg).per_rad2_m));
    }
    EXPECT_GT(raw, 4 * found.per_rad2_m) << random.trace(draw);
  }
}

TEST_F(SmoothedCam, MeetsTheBaseCircleSoftlyAndNeverGoesBelowIt) {
  Random random;
  for (int draw = 0; draw < 20; ++draw) {
    const Measured table = Measured(truth, -180, 180, 1).off_by_up_to(3e-6, random).rounded_to(1e-6);
    const CamProfile smooth = profile_of(table.cam(random.between(4e-6, 50e-6)));
    EXPECT_GE(Comparison(smooth, truth).least_m, 0) << random.trace(draw);
    for (const double end : {smooth.opens_rad(), smooth.closes_rad()}) {
      const double into = end < 0 ? 1e-4 : -1e-4;
      // Four derivatives are zero at the end, the fifth is at most some thousand metres: y = 1e3 x^5 / 5!, y'' = 1e3
      // x^3 / 3!.
      EXPECT_LE(std::fabs(smooth.at(end + into).lift_m), 1e-18) << random.trace(draw);
      EXPECT_LE(std::fabs(smooth.at(end + into).per_rad2_m), 1e-9) << random.trace(draw);
      EXPECT_EQ(smooth.at(end - into).lift_m, 0) << random.trace(draw);
    }
  }
}

TEST_F(SmoothedCam, HasDerivativesThatAgreeWithDifferences) {
  Random random;
  const CamProfile smooth = profile_of(Measured(truth, -180, 180, 1).off_by_up_to(3e-6, random).cam(6e-6));
  for (double phi = smooth.opens_rad() - 0.01; phi < smooth.closes_rad() + 0.01; phi += 0.00137) {
    constexpr double h = 1.0 / 32768;
    EXPECT_NEAR(smooth.at(phi).per_rad_m, slope_of([&](double x) { return smooth.at(x).lift_m; }, phi, h), 1e-11)
        << random.trace(0);
    EXPECT_NEAR(smooth.at(phi).per_rad2_m, slope_of([&](double x) { return smooth.at(x).per_rad_m; }, phi, h), 1e-9)
        << random.trace(0);
  }
}

TEST_F(SmoothedCam, CountsFromItsOwnPeakWhereverTheTableBegins) {
  // The same measurement, its rows numbered from 40 to 260 deg with the peak at 150.25.
  Measured table(truth, -110.25, 109.75, 1);
  for (CamPoint& point : table.points) point.cam_deg += 150.25;
  const CamProfile smooth = profile_of(table.rounded_to(1e-6).cam(1e-6));
  EXPECT_NEAR(smooth.peak_deg(), 150.25, 0.05);
  EXPECT_NEAR(smooth.at(0).per_rad_m, 0, 1e-15);
  EXPECT_NEAR(smooth.largest_lift_m(), truth.largest_lift_m(), 1.5e-6);
  EXPECT_NEAR(smooth.at(-0.5).lift_m, truth.at(-0.5).lift_m, 1.5e-6 + 0.05 * kRadPerDeg * 9e-3);
}

TEST_F(SmoothedCam, IsTheSameHoweverFarItsRowsGoOnAlongTheBaseCircle) {
  constexpr double kSmoothing_m = 1e-6;
  double rises_deg = -80;
  while (truth.at((rises_deg + 1) * kRadPerDeg).lift_m <= kSmoothing_m)
    ++rises_deg;  // the last row that may be base circle
  const CamProfile whole = profile_of(Measured(truth, -180, 180, 1).cam(kSmoothing_m));
  EXPECT_GT(whole.opens_rad(), (rises_deg - 10) * kRadPerDeg - 1e-12)
      << "ten degrees of base circle are enough to begin in";
  for (const double beyond_deg : {11.0, 12.0, 15.0, 40.0}) {
    const CamProfile smooth =
        profile_of(Measured(truth, rises_deg - beyond_deg, beyond_deg - rises_deg, 1).cam(kSmoothing_m));
    EXPECT_EQ(smooth.opens_rad(), whole.opens_rad()) << beyond_deg;
    EXPECT_EQ(smooth.closes_rad(), whole.closes_rad()) << beyond_deg;
    for (double phi = -1.4; phi < 1.4; phi += 0.01)
      EXPECT_EQ(smooth.at(phi).lift_m, whole.at(phi).lift_m) << beyond_deg << ", " << phi;
  }
}

TEST_F(SmoothedCam, BeginsAtMostThreeSegmentsBeforeATableThatEndsAtItsFeet) {
  for (const double end_deg : {68.0, 70.0, 72.0}) {
    const Measured table(truth, -end_deg, end_deg, 1);
    const CamProfile smooth = profile_of(table.cam(100e-6));
    // 160 segments between 10 deg of margin to either side, or to the ends of the table and three segments beyond.
    const double beyond_deg = 3 * 2 * end_deg / 154;
    EXPECT_GE(smooth.opens_rad() / kRadPerDeg + smooth.peak_deg(), -end_deg - beyond_deg - 1e-9) << end_deg;
    EXPECT_LE(smooth.closes_rad() / kRadPerDeg + smooth.peak_deg(), end_deg + beyond_deg + 1e-9) << end_deg;
  }
}

TEST_F(SmoothedCam, OfFineAndOfCoarseRowsIsTheSameCam) {
  for (const double step_deg : {0.2, 0.5, 2.0, 5.0}) {
    const Measured table = Measured(truth, -180, 179.9, step_deg).rounded_to(1e-6);
    const Comparison found(profile_of(table.cam(1e-6)), truth);
    EXPECT_LE(found.lift_m, 2e-6) << step_deg;
    EXPECT_LE(found.per_rad2_m, 0.04 * kPeak_m) << step_deg;
  }
}

TEST_F(SmoothedCam, GetsStifferTheMoreResidualIsAllowed) {
  Random random;
  const Measured table = Measured(truth, -180, 180, 1).off_by_up_to(3e-6, random);
  double before = 1;
  for (const double allowed : {5e-6, 10e-6, 30e-6, 100e-6}) {
    const CamProfile smooth = profile_of(table.cam(allowed));
    EXPECT_LE(smooth.residual_m(), allowed);
    EXPECT_GT(smooth.residual_m(), 0.9 * allowed);  // what is allowed is made use of
    const double swing = Comparison(smooth, truth).swing_m;
    EXPECT_LT(swing, before) << allowed;
    before = swing;
  }
}

TEST_F(SmoothedCam, IsRefusedWhereNoSmoothLobeComesCloseEnough) {
  Random random;
  CamProfile smooth;
  const Measured noisy = Measured(truth, -180, 180, 1).off_by_up_to(3e-6, random);
  EXPECT_TRUE(refuses(smooth.init(noisy.cam(1e-6)), Reason::no_solution, "cam.smoothing_m"));
  for (const double step_deg : {0.5, 1.0}) {
    Measured misread(truth, -180, 180, step_deg);
    misread.points[misread.points.size() * 5 / 12].lift_m += 50e-6;  // one row, at -30 deg
    EXPECT_TRUE(refuses(smooth.init(misread.cam(10e-6)), Reason::no_solution, "cam.smoothing_m")) << step_deg;
  }
}

TEST_F(SmoothedCam, IsRefusedWhereTheTableDoesNotBeginOrEndOnTheBaseCircle) {
  CamProfile smooth;
  EXPECT_TRUE(refuses(smooth.init(Measured(truth, -60, 180, 1).cam(5e-6)), Reason::inconsistent, "cam.points", 0));
  EXPECT_TRUE(refuses(smooth.init(Measured(truth, -180, 60, 1).cam(5e-6)), Reason::inconsistent, "cam.points", 240));
  Measured flat(truth, 90, 180, 1);
  EXPECT_EQ(smooth.init(flat.cam(5e-6)).reason, Reason::inconsistent);
  EXPECT_TRUE(
      refuses(smooth.init(Measured(profile_of(polynomial_cam(5e-3, 180, {2, 10, 18, 26})), -180, 180, 1).cam(1e-6)),
              Reason::out_of_range, "cam.points"));
}

}  // namespace
}  // namespace crankloop::cam_profile_test

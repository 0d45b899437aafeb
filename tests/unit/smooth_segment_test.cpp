// Where in a segment of a valve's motion a contact changes: the places of a cubic against bisection, and what tells of
// a contact against what it is made of.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <crankloop/tick/valve/smooth_segment.hpp>

namespace crankloop::detail::smooth_segment_test {
namespace {

/// Where a function that rises or falls through 0 between two places does so.
template <class Function>
double bisected(double low, double high, const Function& f) {
  const bool rises = f(low) < 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    ((f(middle) < 0) == rises ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Cubics that are a contact's over a fine step: mostly a parabola, whose bend is of the size of its rise.
class Cubics {
 public:
  [[nodiscard]] Cubic<double> next() {
    Cubic<double> f(0, 0, 0, 0);
    f.c[0] = part_(random_), f.c[1] = 2 * part_(random_), f.c[2] = 2 * part_(random_), f.c[3] = 0.1 * part_(random_);
    return f;
  }

 private:
  std::mt19937 random_{20};
  std::uniform_real_distribution<double> part_{-1, 1};
};

TEST(Cubic, ReachesZeroWhereBisectionFindsIt) {
  Cubics cubics;
  double largest = 0;
  int found = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Cubic<double> f = cubics.next();
    const double to = f.at(1).value;
    if (!(f.c[0] * to < 0) || std::fabs(f.c[0]) < 0.05 || std::fabs(to) < 0.05) continue;
    const double root = bisected(0, 1, [&f](double x) { return f.at(x).value; });
    if (std::fabs(f.at(root).slope) < 1) continue;  // one that all but touches 0 is badly told
    largest = std::max(largest, std::fabs(f.root(false, to) - root));
    ++found;
  }
  EXPECT_GT(found, 4000);
  EXPECT_LT(largest, 5e-4);
}

TEST(Cubic, ComesBackToZeroWhereBisectionFindsIt) {
  Cubics cubics;
  double largest = 0;
  int found = 0;
  for (int i = 0; i < 20'000; ++i) {
    Cubic<double> f = cubics.next();
    f.c[0] = 0;
    const double to = f.at(1).value;
    if (!(f.c[1] * to < 0) || std::fabs(f.c[1]) < 0.2 || std::fabs(to) < 0.2) continue;
    const double root = bisected(1e-3, 1, [&f](double x) { return f.at(x).value; });
    largest = std::max(largest, std::fabs(f.root(true, to) - root));
    ++found;
  }
  EXPECT_GT(found, 1500);
  EXPECT_LT(largest, 0.02);
}

TEST(Cubic, TurnsWhereItsSlopeIsZero) {
  Cubics cubics;
  double largest = 0;
  int found = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Cubic<double> f = cubics.next();
    if (!(f.c[1] * f.at(1).slope < 0)) continue;
    const double turn = bisected(0, 1, [&f](double x) { return f.at(x).slope; });
    if (std::fabs(2 * f.c[2] + 6 * turn * f.c[3]) < 1) continue;
    largest = std::max(largest, std::fabs(f.extremum() - turn));
    ++found;
  }
  EXPECT_GT(found, 2000);
  EXPECT_LT(largest, 2e-3);
}

TEST(SmoothSegment, TellsOfAContactByItsForceWhereItIsAndByItsDepthWhereItIsNot) {
  const double d_s = 2e-5;
  const Contact<double> c{{-3e-6, 5e-6}, {0.3, 0.7}, {1e4, -2e4}};
  const double lag_s = 4e-6;
  const auto through = [&](const Contact<double>& of, bool is_on, double lag) {
    const Cubic<double> f = event_function(of, is_on, lag_s, d_s);
    for (int end = 0; end < 2; ++end) {
      EXPECT_NEAR(f.at(end).value, of.depth_m[end] + lag * of.speed_m_s[end], 1e-20);
      EXPECT_NEAR(f.at(end).slope, d_s * (of.speed_m_s[end] + lag * of.rate_m_s2[end]), 1e-18);
    }
  };
  through(c, true, lag_s);  // ends where its force does
  through(c, false, 0);     // begins where they meet
  Contact<double> in = c;
  in.depth_m[0] = 1e-6;
  through(in, false, lag_s);  // there already: where its force begins
}

/// A lobe of two degrees, whose lift no cubic follows.
struct Lobe {
  LiftSegment<double> at[3] = {{{1e-3, 2e-4, -3e-4, 4e-4, 5e-4, -2e-4}}, {{2e-3, -1e-4, 2e-4, -6e-4, 3e-4, 1e-4}}, {}};
  LiftCurve<double> curve{};

  Lobe() { curve.at = at, curve.segments = 2, curve.outside_m = -1e-4; }
  [[nodiscard]] static std::uint64_t phase(double deg) {
    return static_cast<std::uint64_t>(deg / 360 * 18446744073709551616.0);
  }
  [[nodiscard]] Lift<double> read(double deg) const { return curve.read(LiftCurve<double>::cell(phase(deg))); }
};

TEST(SmoothSegment, OfManyDegreesTakesWhatTheLiftInItsMiddleIsOffItsCubic) {
  const Lobe lobe;
  RegimeStep<double> regime{};
  regime.middle = {2, 5};
  Span<double, NoGasForce<double>> step{};
  step.cam.deg = 1.4;
  step.from = lobe.read(0.25), step.to = lobe.read(1.65);
  const Cubic<double> through(step.from.lift_m, 1.4 * step.from.per_deg_m, step.to.lift_m, 1.4 * step.to.per_deg_m);
  const double more_m = lobe.read(0.95).lift_m - through.at(0.5).value;
  ASSERT_GT(std::fabs(more_m), 1e-6);
  const Stepped<double> end = with_middle_of(regime, lobe.curve, step, Lobe::phase(0.95), {{1, 10}, 100});
  EXPECT_NEAR(end.state.lift_m, 1 + 2 * more_m, 1e-12);
  EXPECT_NEAR(end.state.velocity_m_s, 10 + 5 * more_m, 1e-12);
  EXPECT_NEAR(end.increment_m, 100 + 2 * more_m, 1e-12);
}

}  // namespace
}  // namespace crankloop::detail::smooth_segment_test

// A cubic between two points that never leaves their range.
#pragma once

#include <crankloop/assert.hpp>

namespace crankloop::detail {

struct Point {
  double x;
  double y;
};

/// Slope at the middle of three points: zero at a peak, else the weighted harmonic mean of both secants (Fritsch and
/// Butland, "A method for constructing local monotone piecewise cubic interpolants", SIAM J. Sci. Stat. Comput. 5
/// (1984) 300).
[[nodiscard]] inline double monotone_slope(Point a, Point b, Point c) noexcept {
  const double h0 = b.x - a.x;
  const double h1 = c.x - b.x;
  CRANKLOOP_ASSERT(h0 > 0 && h1 > 0);
  const double d0 = (b.y - a.y) / h0;
  const double d1 = (c.y - b.y) / h1;
  if (d0 * d1 <= 0) return 0;
  return 3 * (h0 + h1) / ((2 * h1 + h0) / d0 + (h1 + 2 * h0) / d1);
}

/// The cubic from p1 to p2, with p0 and p3 as their neighbours; all x rising. Its coefficients by t, the part of the
/// way.
inline void monotone_cubic(Point p0, Point p1, Point p2, Point p3, double (&c)[4]) noexcept {
  const double h = p2.x - p1.x;
  const double m1 = h * monotone_slope(p0, p1, p2);
  const double m2 = h * monotone_slope(p1, p2, p3);
  const double rise = p2.y - p1.y;
  c[0] = p1.y;
  c[1] = m1;
  c[2] = 3 * rise - 2 * m1 - m2;
  c[3] = m1 + m2 - 2 * rise;
}

[[nodiscard]] inline double cubic_value(const double (&c)[4], double t) noexcept {
  return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

}  // namespace crankloop::detail

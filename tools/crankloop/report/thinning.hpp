// Reduces the number of a line's points.
//
// What belongs here: the points that a drawing does not need. What does not: drawing (drawing.hpp).
#pragma once

#include <vector>

#include "geometry.hpp"

namespace crankloop::report {

/// A polyline with fewer points. The first and last point and the extremes of x and y stay, in order and unchanged;
/// every dropped point lies within 2 * tolerance of the new line. At most 4 points per `tolerance` of x remain for each
/// pass of the line. O(n log n) for curves, O(n^2) at worst.
///
/// First, of neighbours in one column of width `tolerance`, only the first, lowest, highest and last stay; then the
/// Douglas-Peucker algorithm drops what lies within `tolerance` of the chord.
[[nodiscard]] std::vector<Point> decimate(const std::vector<Point>& points, double tolerance);

}  // namespace crankloop::report

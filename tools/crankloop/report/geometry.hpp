// Points, boxes and segments on a drawing, in user units, y downward.
//
// What belongs here: distances and overlaps. What does not: what the boxes hold (drawing.hpp).
#pragma once

#include <vector>

namespace crankloop::report {

struct Point {
  double x = 0;
  double y = 0;
};

using Polyline = std::vector<Point>;

struct Box {
  double left;
  double top;
  double right;
  double bottom;
};

[[nodiscard]] Box grown(const Box& box, double by);
[[nodiscard]] double overlap_area(const Box& a, const Box& b);

/// Length of the part of a segment inside a box (Liang and Barsky's clipping).
[[nodiscard]] double length_inside(const Box& box, Point a, Point b);

/// Distance of a point, or of a box (0 if they intersect), from the segment a b.
[[nodiscard]] double distance(Point p, Point a, Point b);
[[nodiscard]] double distance(const Box& box, Point a, Point b);

}  // namespace crankloop::report

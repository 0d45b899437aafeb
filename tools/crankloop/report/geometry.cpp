#include "geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crankloop::report {

Box grown(const Box& box, double by) { return {box.left - by, box.top - by, box.right + by, box.bottom + by}; }

double overlap_area(const Box& a, const Box& b) {
  const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
  const double height = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
  return width > 0 && height > 0 ? width * height : 0;
}

double length_inside(const Box& box, Point a, Point b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  double enter = 0;
  double leave = 1;
  const double directions[4][2] = {
      {-dx, a.x - box.left}, {dx, box.right - a.x}, {-dy, a.y - box.top}, {dy, box.bottom - a.y}};
  for (const auto& [p, q] : directions) {
    if (p == 0) {
      if (q < 0) return 0;
      continue;
    }
    if (p < 0)
      enter = std::max(enter, q / p);
    else
      leave = std::min(leave, q / p);
  }
  return leave > enter ? (leave - enter) * std::hypot(dx, dy) : 0;
}

double distance(Point p, Point a, Point b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  const double along = squared > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0;
  return std::hypot(p.x - a.x - along * dx, p.y - a.y - along * dy);
}

double distance(const Box& box, Point a, Point b) {
  if (length_inside(box, a, b) > 0) return 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Point& p : {a, b}) {
    nearest = std::min(nearest, std::hypot(std::max({box.left - p.x, 0.0, p.x - box.right}),
                                           std::max({box.top - p.y, 0.0, p.y - box.bottom})));
  }
  for (const double x : {box.left, box.right}) {
    for (const double y : {box.top, box.bottom}) nearest = std::min(nearest, distance(Point{x, y}, a, b));
  }
  return nearest;
}

}  // namespace crankloop::report

#include "thinning.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace crankloop::report {

namespace {

/// Of each run of neighbours in one column, the first, lowest, highest and last.
std::vector<std::size_t> thin_columns(const std::vector<Point>& points, double width) {
  std::vector<std::size_t> kept;
  std::size_t first = 0;
  while (first < points.size()) {
    const double column = std::floor(points[first].x / width);
    std::size_t last = first;
    std::size_t low = first;
    std::size_t high = first;
    while (last + 1 < points.size() && std::floor(points[last + 1].x / width) == column) {
      ++last;
      if (points[last].y < points[low].y) low = last;
      if (points[last].y > points[high].y) high = last;
    }
    for (const std::size_t i : {first, std::min(low, high), std::max(low, high), last}) {
      if (kept.empty() || kept.back() < i) kept.push_back(i);
    }
    first = last + 1;
  }
  return kept;
}

}  // namespace

std::vector<Point> decimate(const std::vector<Point>& points, double tolerance) {
  if (points.size() < 3 || !(tolerance > 0)) return points;
  std::vector<std::size_t> pins{0, points.size() - 1};
  const auto by_x = [](const Point& a, const Point& b) { return a.x < b.x; };
  const auto by_y = [](const Point& a, const Point& b) { return a.y < b.y; };
  const auto index = [&](auto it) { return static_cast<std::size_t>(it - points.begin()); };
  pins.push_back(index(std::min_element(points.begin(), points.end(), by_x)));
  pins.push_back(index(std::max_element(points.begin(), points.end(), by_x)));
  pins.push_back(index(std::min_element(points.begin(), points.end(), by_y)));
  pins.push_back(index(std::max_element(points.begin(), points.end(), by_y)));

  std::vector<std::size_t> thinned = thin_columns(points, tolerance);
  thinned.insert(thinned.end(), pins.begin(), pins.end());
  for (std::vector<std::size_t>* list : {&thinned, &pins}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }

  // Douglas-Peucker between each two fixed points, with an explicit stack: noise of any length must not exhaust the
  // call stack.
  std::vector<bool> keep(thinned.size(), false);
  std::vector<std::pair<std::size_t, std::size_t>> open;
  std::size_t from = 0;
  for (std::size_t i = 0; i < thinned.size(); ++i) {
    if (!std::binary_search(pins.begin(), pins.end(), thinned[i])) continue;
    keep[i] = true;
    open.emplace_back(from, i);
    from = i;
  }
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double farthest = tolerance;
    std::size_t split = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double off = distance(points[thinned[i]], points[thinned[first]], points[thinned[last]]);
      if (off > farthest) {
        farthest = off;
        split = i;
      }
    }
    if (split == first) continue;
    keep[split] = true;
    open.emplace_back(first, split);
    open.emplace_back(split, last);
  }
  std::vector<Point> result;
  for (std::size_t i = 0; i < thinned.size(); ++i) {
    if (keep[i]) result.push_back(points[thinned[i]]);
  }
  return result;
}

}  // namespace crankloop::report

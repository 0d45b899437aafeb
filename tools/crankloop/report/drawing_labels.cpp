// Placement of labels: markers' beside their dots, names beside their curves.
#include <algorithm>
#include <cmath>
#include <limits>

#include "drawing.hpp"

namespace crankloop::report {

Box box_of(const Label& label) {
  const double width = 1.1 * text_width(label.text);  // semi-bold
  const double left = label.at.x - (label.anchor == Anchor::start    ? 0
                                    : label.anchor == Anchor::middle ? width / 2
                                                                     : width);
  return {left, label.at.y - 0.76 * kTypeSize, left + width, label.at.y + 0.24 * kTypeSize};
}

namespace {

/// Candidate points for a name along a curve: every 12 units, at most 150.
Polyline places_along(const Curve& curve) {
  double length = 0;
  for (const Polyline& line : curve.lines) {
    for (std::size_t k = 1; k < line.size(); ++k)
      length += std::hypot(line[k].x - line[k - 1].x, line[k].y - line[k - 1].y);
  }
  const double step = std::max(12.0, length / 150);
  Polyline places;
  double walked = 0;  // since the last place
  for (const Polyline& line : curve.lines) {
    for (std::size_t k = 1; k < line.size(); ++k) {
      const Point a = line[k - 1];
      const Point b = line[k];
      const double segment = std::hypot(b.x - a.x, b.y - a.y);
      for (double at = step - walked; at < segment; at += step) {
        places.push_back({a.x + at / segment * (b.x - a.x), a.y + at / segment * (b.y - a.y)});
      }
      walked = std::fmod(walked + segment, step);
    }
  }
  return places;
}

}  // namespace

/// Length of curves and zero lines, and overlap with other labels under a box, as a penalty in user units.
double Drawing::hidden_by(const Box& box) const {
  double penalty = 0;
  for (const Polyline& line : zero_lines_) penalty += length_inside(box, line[0], line[1]);
  for (const Curve& curve : curves_) {
    for (const Polyline& line : curve.lines) {
      for (std::size_t i = 1; i < line.size(); ++i) penalty += length_inside(box, line[i - 1], line[i]);
    }
    for (const Box& bar : curve.bars) penalty += overlap_area(box, bar) / 10;
  }
  for (const Box& other : taken_) penalty += overlap_area(box, other);
  return penalty;
}

double Drawing::outside_frame(const Box& box) const {
  return std::max(0.0, frame_.left + 3 - box.left) + std::max(0.0, box.right - (kWidth - 2)) +
         std::max(0.0, frame_.top + 1 - box.top) + std::max(0.0, box.bottom - frame_.bottom + 2);
}

/// Places a label around a dot, as near as curves, zero lines and other labels allow, with a thin line if it is far
/// away.
void Drawing::place_beside(Point dot, Label label) {
  Label best;
  double least = std::numeric_limits<double>::infinity();
  const bool high = dot.y < (frame_.top + frame_.bottom) / 2;
  const double beside = 0.26 * kTypeSize;
  double order = 0;
  for (double away = 10; away <= 82; away += 12) {  // farther away if lines are in the way
    const double above = -away;
    const double below = away + 0.76 * kTypeSize;
    for (const double dy : {high ? above : below, beside, high ? below : above}) {
      for (const double dx : {0.0, 6.0, -6.0, away, -away}) {
        if (dy == beside && std::abs(dx) < away) continue;
        label.at = {dot.x + dx, dot.y + dy};
        label.anchor = dx == 0 ? Anchor::middle : dx > 0 ? Anchor::start : Anchor::end;
        const Box box = box_of(label);
        const double penalty = 20 * hidden_by(grown(box, 3)) + 100 * outside_frame(box) + order++;
        if (penalty >= least) continue;
        least = penalty;
        best = label;
      }
    }
  }
  const Box box = box_of(best);
  const Point near{std::clamp(dot.x, box.left, box.right), std::clamp(dot.y, box.top, box.bottom)};
  if (std::hypot(near.x - dot.x, near.y - dot.y) > 20) leaders_.push_back({dot, near});
  taken_.push_back(box);
  labels_.push_back(best);
}

void Drawing::place_markers() {
  for (const Marker& marker : plot_.markers) {
    if (!visible(marker)) continue;
    const Point dot{to_x_(marker.x), to_y_(marker.y)};
    taken_.push_back({dot.x - 5, dot.y - 5, dot.x + 5, dot.y + 5});
  }
  for (const Marker& marker : plot_.markers) {
    if (!visible(marker) || marker.label.empty()) continue;
    place_beside({to_x_(marker.x), to_y_(marker.y)}, {{}, Anchor::start, marker.label, colour_of(marker.series)});
  }
}

/// Where a curve leaves the frame, or ends in it.
Point Drawing::end_of(const Polyline& line) const {
  Point end = line.front();
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Point a = line[k - 1];
    const Point b = line[k];
    if (b.x <= frame_.right && b.y >= frame_.top) {
      end = b;
      continue;
    }
    const double over_right = b.x > frame_.right ? (frame_.right - a.x) / (b.x - a.x) : 1;
    const double over_top = b.y < frame_.top ? (frame_.top - a.y) / (b.y - a.y) : 1;
    const double part = std::clamp(std::min(over_right, over_top), 0.0, 1.0);
    return {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)};
  }
  return end;
}

/// Places the names of a family of curves at their ends, in ink, each with a thin line to its curve: in a column beside
/// the frame if the curves end near each other, else above the ends.
void Drawing::place_ends() {
  std::vector<std::pair<Point, std::size_t>> ends;
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    if (!curves_[i].lines.empty()) ends.emplace_back(end_of(curves_[i].lines.back()), i);
  }
  const auto by_height = [](const auto& a, const auto& b) { return a.first.y < b.first.y; };
  const auto by_width = [](const auto& a, const auto& b) { return a.first.x < b.first.x; };
  if (ends_together_) {
    std::stable_sort(ends.begin(), ends.end(), by_height);
  } else {
    std::stable_sort(ends.begin(), ends.end(), by_width);
  }
  constexpr double kPitch = 22;
  double y = frame_.top;  // of the next free line of the column
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const auto& [end, i] = ends[k];
    Label label{{}, Anchor::start, curves_[i].name, 0, static_cast<int>(i)};
    if (ends_together_) {
      const double last = frame_.bottom - kPitch * static_cast<double>(ends.size() - 1 - k);
      y = std::min(std::max(y, end.y), last);
      label.at = {frame_.right + 26, y + 0.26 * kTypeSize};
      leaders_.push_back({end, {frame_.right + 22, y}});
      y += kPitch;
    } else {
      double least = std::numeric_limits<double>::infinity();
      Label best;
      double order = 0;
      for (double away = 8; away <= 112; away += 8) {
        for (const Anchor anchor : {Anchor::middle, Anchor::end, Anchor::start}) {
          label.at = {end.x, end.y - away};
          label.anchor = anchor;
          const Box box = box_of(label);
          const double penalty = 20 * hidden_by(grown(box, 2)) + 100 * outside_frame(box) + order++;
          if (penalty >= least) continue;
          least = penalty;
          best = label;
        }
      }
      label = best;
      leaders_.push_back({end, {end.x, label.at.y + 4}});
      taken_.push_back({end.x - 3, label.at.y, end.x + 3, end.y});
    }
    taken_.push_back(box_of(label));
    labels_.push_back(label);
  }
}

/// Puts every series' name where it touches no curve and is clearly nearest to its own; false if one finds no place.
bool Drawing::place_names() {
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    const Curve& curve = curves_[i];
    if (curve.name.empty()) continue;
    Label best;
    double highest = 0;
    for (const Point& place : places_along(curve)) {
      const Label candidates[] = {
          {{place.x, place.y - 8}, Anchor::middle, curve.name, curve.colour, static_cast<int>(i)},
          {{place.x, place.y + 20}, Anchor::middle, curve.name, curve.colour, static_cast<int>(i)},
          {{place.x + 9, place.y + 5}, Anchor::start, curve.name, curve.colour, static_cast<int>(i)},
          {{place.x - 9, place.y + 5}, Anchor::end, curve.name, curve.colour, static_cast<int>(i)}};
      for (const Label& candidate : candidates) {
        const double score = clarity(candidate, i);
        if (score <= highest) continue;
        highest = score;
        best = candidate;
      }
    }
    if (highest <= 0) return false;
    taken_.push_back(box_of(best));
    labels_.push_back(best);
  }
  return true;
}

/// How much nearer a name is to its own curve than to any other, in user units, at most 40; <= 0 where a name must not
/// be placed.
double Drawing::clarity(const Label& label, std::size_t own) const {
  const Box box = box_of(label);
  if (outside_frame(box) > 0) return 0;
  for (const Box& other : taken_) {
    if (overlap_area(grown(box, 4), other) > 0) return 0;
  }
  for (const Polyline& line : zero_lines_) {
    if (distance(box, line[0], line[1]) < 1) return 0;
  }
  double own_distance = 40;
  double other_distance = 40;
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    double& nearest = i == own ? own_distance : other_distance;
    for (const Polyline& line : curves_[i].lines) {
      for (std::size_t k = 1; k < line.size(); ++k) {
        const Box bounds{std::min(line[k - 1].x, line[k].x), std::min(line[k - 1].y, line[k].y),
                         std::max(line[k - 1].x, line[k].x), std::max(line[k - 1].y, line[k].y)};
        if (overlap_area(grown(box, nearest), grown(bounds, 0.01)) > 0)
          nearest = std::min(nearest, distance(box, line[k - 1], line[k]));
        if (nearest < 2) return 0;
      }
    }
    for (const Point& point : curves_[i].points) nearest = std::min(nearest, distance(box, point, point));
    if (nearest < 2) return 0;
  }
  return other_distance - own_distance - 4;
}

}  // namespace crankloop::report

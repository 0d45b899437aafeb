// Heat maps: colours in steps, contours and their values, and the key beside the frame.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "../number.hpp"
#include "drawing.hpp"

namespace crankloop::report {

namespace {

using Rgb = std::array<int, 3>;

// Viridis of Matplotlib (CC0), every ninth of it: even steps of lightness, for colour-blind readers too.
constexpr Rgb kPalette[] = {{68, 1, 84},    {72, 40, 120},  {62, 73, 137},  {49, 104, 142}, {38, 130, 142},
                            {31, 158, 137}, {53, 183, 121}, {110, 206, 88}, {181, 222, 43}, {253, 231, 37}};
constexpr double kLastColour = 9;
constexpr double kDark = 0.45;  // up to here white stands out, beyond it black

std::string list_of(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + program::brief(value);
  return text;
}

}  // namespace

std::string heat_colour(double part) {
  const double at = std::clamp(part, 0.0, 1.0) * kLastColour;
  const auto first = static_cast<std::size_t>(std::min(std::floor(at), kLastColour - 1));
  const double on = at - static_cast<double>(first);
  std::string colour = "#";
  for (std::size_t i = 0; i < 3; ++i) {
    char digits[12];
    std::snprintf(digits, sizeof digits, "%02x",
                  static_cast<unsigned>(std::lround((1 - on) * kPalette[first][i] + on * kPalette[first + 1][i])));
    colour += digits;
  }
  return colour;
}

/// Contours at round values, and between two as many steps of colour as let the values cover kHeatSteps of them.
void Drawing::make_levels() {
  Range range{kLargest, -kLargest};
  for (const double value : plot_.field.values) {
    if (std::abs(value) < kLargest) range = {std::min(range.low, value), std::max(range.high, value)};
  }
  levels_ = make_scale({}, range, 6);
  if (!(range.low < range.high)) range = levels_.range;
  const double between = levels_.ticks[1].value - levels_.ticks[0].value;
  heat_step_ = between / std::ceil(kHeatSteps * between / (range.high - range.low));
  levels_.range = {std::floor(range.low / heat_step_ + 1e-9) * heat_step_,
                   std::ceil(range.high / heat_step_ - 1e-9) * heat_step_};
  const auto beyond = [this](const Tick& tick) {
    return tick.value < levels_.range.low - heat_step_ / 2 || tick.value > levels_.range.high + heat_step_ / 2;
  };
  levels_.ticks.erase(std::remove_if(levels_.ticks.begin(), levels_.ticks.end(), beyond), levels_.ticks.end());
}

std::string Drawing::heat_at(double level) const {
  return heat_colour((level - levels_.range.low) / (levels_.range.high - levels_.range.low));
}

/// Where the field, straight between neighbours of the lattice, is at least `level`; the ends of its edge's pieces.
std::string Drawing::area_above(double level, Polyline& contour) const {
  const Field& field = plot_.field;
  std::string d;
  const auto close = [&d](const Polyline& area) {
    for (std::size_t k = 0; k < area.size(); ++k)
      d += (k == 0 ? 'M' : k == 1 ? 'L' : ' ') + coordinate(area[k].x) + ' ' + coordinate(area[k].y);
    d += 'Z';
  };
  const auto value = [&](std::size_t i, std::size_t j) { return field.values[i * field.y.size() + j]; };
  for (std::size_t j = 0; j + 1 < field.y.size(); ++j) {
    std::size_t whole = 0;  // cells before i, side by side, that lie above as a whole: one rectangle
    for (std::size_t i = 0; i < field.x.size(); ++i) {
      const auto corner = [&](std::size_t k) {
        return std::make_pair(i + (k == 1 || k == 2 ? 1 : 0), j + (k >= 2 && k < 4 ? 1 : 0));
      };
      const auto place = [&](std::pair<std::size_t, std::size_t> at) {
        return Point{to_x_(field.x[at.first]), to_y_(field.y[at.second])};
      };
      std::array<double, 5> v{};
      bool above = i + 1 < field.x.size();
      const bool inside = above;
      for (std::size_t k = 0; inside && k < 5; ++k) {
        v[k] = value(corner(k % 4).first, corner(k % 4).second);
        above = above && v[k] >= level;
      }
      if (above) {
        ++whole;
        continue;
      }
      if (whole > 0) {
        const Point from = place({i - whole, j});
        const Point to = place({i, j + 1});
        close({from, {to.x, from.y}, to, {from.x, to.y}});
      }
      whole = 0;
      if (!inside || !std::all_of(v.begin(), v.end(), [](double one) { return std::abs(one) < kLargest; })) continue;
      Polyline area;
      std::vector<std::size_t> leaves;  // where the edge of the area goes through the cell
      for (std::size_t k = 0; k < 4; ++k) {
        const Point a = place(corner(k));
        const Point b = place(corner((k + 1) % 4));
        if (v[k] >= level) area.push_back(a);
        if ((v[k] >= level) == (v[k + 1] >= level)) continue;
        if (v[k] >= level) leaves.push_back(area.size());
        const double part = (level - v[k]) / (v[k + 1] - v[k]);
        area.push_back({a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)});
      }
      if (area.empty()) continue;
      close(area);
      for (const std::size_t k : leaves) {
        contour.push_back(area[k]);
        contour.push_back(area[(k + 1) % area.size()]);
      }
    }
  }
  return d;
}

void Drawing::write_field() {
  const auto filled = [this](const std::string& d, const std::string& colour) {
    if (!d.empty()) out_ += "<path class=\"heat\" style=\"fill:" + colour + "\" d=\"" + d + "\"/>\n";
  };
  const Field& field = plot_.field;
  std::vector<double> x;
  std::vector<double> y;
  for (const double at : field.x) x.push_back(to_x_(at));
  for (const double at : field.y) y.push_back(to_y_(at));
  out_ += "<g data-field=\"" + list_of(field.values) + "\" data-at-x=\"" + list_of(x) + "\" data-at-y=\"" + list_of(y) +
          "\" data-name=\"" + escape(field.name) + "\" data-unit=\"" + escape(field.unit) + "\">\n";
  Polyline ignored;
  filled(area_above(-kLargest, ignored), heat_at(levels_.range.low + heat_step_ / 2));
  for (double level = levels_.range.low + heat_step_; level < levels_.range.high - heat_step_ / 2; level += heat_step_)
    filled(area_above(level, ignored), heat_at(level + heat_step_ / 2));
  std::string nodes;
  for (const double at_x : x) {
    for (const double at_y : y) nodes += 'M' + coordinate(at_x) + ' ' + coordinate(at_y) + "h0";
  }
  path("node", nodes);
  for (const Tick& tick : levels_.ticks) {
    Polyline contour;
    area_above(tick.value, contour);
    write_contour(tick.value, contour);
  }
  out_ += "</g>\n";
  write_heat_key();
}

/// The line, of pieces that each have two ends, and its value on it, where no other contour's value is near.
void Drawing::write_contour(double level, const Polyline& ends) {
  if (ends.empty()) return;
  std::string d;
  for (std::size_t k = 0; k < ends.size(); k += 2)
    d += 'M' + coordinate(ends[k].x) + ' ' + coordinate(ends[k].y) + 'L' + coordinate(ends[k + 1].x) + ' ' +
         coordinate(ends[k + 1].y);
  const double part = (level - levels_.range.low) / (levels_.range.high - levels_.range.low);
  const std::string shade = part < kDark ? " on-dark" : " on-light";
  path("contour" + shade, d);
  Label best;
  double farthest = 0;
  for (std::size_t k = 0; k < ends.size(); k += 2) {
    const Label label{{(ends[k].x + ends[k + 1].x) / 2, (ends[k].y + ends[k + 1].y) / 2 + 0.26 * kTypeSize},
                      Anchor::middle,
                      number_text(level),
                      0};
    const Box box = box_of(label);
    if (overlap_area(grown(box, 4), frame_) < 0.999 * overlap_area(grown(box, 4), grown(box, 4))) continue;
    double nearest = kWidth;
    for (const Box& other : taken_)
      nearest = std::min(nearest, distance(grown(box, 6), {other.left, other.top}, {other.right, other.bottom}));
    if (nearest <= farthest) continue;
    farthest = nearest;
    best = label;
  }
  if (farthest <= 0) return;
  taken_.push_back(box_of(best));
  out_ += "<text class=\"height" + shade + "\" style=\"stroke:" + heat_at(level) + "\" x=\"" + coordinate(best.at.x) +
          "\" y=\"" + coordinate(best.at.y) + "\" text-anchor=\"middle\">" + escape(best.text) + "</text>\n";
}

void Drawing::write_heat_key() {
  const Mapping to_y{levels_.range, false, frame_.bottom, frame_.top};
  const double left = frame_.right + 16;
  for (double level = levels_.range.low; level < levels_.range.high - heat_step_ / 2; level += heat_step_) {
    const double top = std::max(to_y(level + heat_step_) - 0.5, frame_.top);  // no seam to the next
    out_ += "<path class=\"heat\" style=\"fill:" + heat_at(level + heat_step_ / 2) + "\" d=\"M" + coordinate(left) +
            ' ' + coordinate(to_y(level)) + "h14V" + coordinate(top) + "h-14Z\"/>\n";
  }
  for (const Tick& tick : levels_.ticks)
    text("tick", {left + 20, to_y(tick.value) + 0.34 * kTypeSize}, Anchor::start, tick.label);
  text("axis-title", {kWidth, 16}, Anchor::end, with_unit(plot_.field.name, plot_.field.unit, levels_.exponent));
}

}  // namespace crankloop::report

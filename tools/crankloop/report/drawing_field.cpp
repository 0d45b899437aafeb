// Heat maps: colours in steps, contours and their values, and the key beside the frame.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "../files/number.hpp"
#include "drawing.hpp"

namespace crankloop::report {

namespace {

using Rgb = std::array<int, 3>;

// Viridis of Matplotlib (CC0), every ninth of it: even steps of lightness, for colour-blind readers too.
constexpr Rgb kPalette[] = {{68, 1, 84},    {72, 40, 120},  {62, 73, 137},  {49, 104, 142}, {38, 130, 142},
                            {31, 158, 137}, {53, 183, 121}, {110, 206, 88}, {181, 222, 43}, {253, 231, 37}};
constexpr double kLastColour = 9;
constexpr double kDark = 0.45;  // up to this value white text is legible, above it black

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

/// Chooses contours at round values, and the colour steps between them so that the values cover kHeatSteps steps.
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

/// The part of a lattice cell, given by its four corners and values, in which the field is at least `level`, and the
/// pieces of the contour in the cell.
Polyline Drawing::area_of_cell(double level, const HeatCell& cell, Polyline& contour) {
  Polyline area;
  std::vector<std::size_t> leaves;  // where the edge of the area enters the cell
  for (std::size_t k = 0; k < 4; ++k) {
    const HeatCorner& a = cell[k];
    const HeatCorner& b = cell[(k + 1) % 4];
    if (a.value >= level) area.push_back(a.at);
    if ((a.value >= level) == (b.value >= level)) continue;
    if (a.value >= level) leaves.push_back(area.size());
    const double part = (level - a.value) / (b.value - a.value);
    area.push_back({a.at.x + part * (b.at.x - a.at.x), a.at.y + part * (b.at.y - a.at.y)});
  }
  for (const std::size_t k : leaves) {
    contour.push_back(area[k]);
    contour.push_back(area[(k + 1) % area.size()]);
  }
  return area;
}

/// Its corners in order.
Drawing::HeatCell Drawing::heat_cell(std::size_t i, std::size_t j) const {
  const Field& field = plot_.field;
  const auto corner = [&](std::size_t x, std::size_t y) {
    return HeatCorner{{to_x_(field.x[x]), to_y_(field.y[y])}, field.values[x * field.y.size() + y]};
  };
  return {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
}

/// The area in which the field, linear between neighbours of the lattice, is at least `level`; the contour as pairs of
/// ends.
std::string Drawing::area_above(double level, Polyline& contour) const {
  std::string d;
  const auto close = [&d](const Polyline& area) {
    for (std::size_t k = 0; k < area.size(); ++k)
      d += (k == 0 ? 'M' : k == 1 ? 'L' : ' ') + coordinate(area[k].x) + ' ' + coordinate(area[k].y);
    if (!area.empty()) d += 'Z';
  };
  for (std::size_t j = 0; j + 1 < plot_.field.y.size(); ++j) {
    Polyline whole;  // cells side by side that lie above as a whole: one rectangle
    for (std::size_t i = 0; i + 1 < plot_.field.x.size(); ++i) {
      const HeatCell cell = heat_cell(i, j);
      const auto known = [](const HeatCorner& corner) { return std::abs(corner.value) < kLargest; };
      const bool drawn = std::all_of(cell.begin(), cell.end(), known);
      const Polyline area = drawn ? area_of_cell(level, cell, contour) : Polyline{};
      const auto above = [level](const HeatCorner& corner) { return corner.value >= level; };
      if (drawn && std::all_of(cell.begin(), cell.end(), above)) {
        whole = whole.empty() ? area : Polyline{whole[0], area[1], area[2], whole[3]};
        continue;
      }
      close(whole);
      whole.clear();
      close(area);
    }
    close(whole);
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

/// Draws a contour from its pieces and writes its value on it, away from other contours' values.
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
  text("axis-title", {kWidth, 17}, Anchor::end, with_unit(plot_.field.name, plot_.field.unit, levels_.exponent));
}

}  // namespace crankloop::report

// A drawing's scales, frame, legend and curves in user units.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "drawing.hpp"
#include "thinning.hpp"

namespace crankloop::report {

namespace {

constexpr double kHeight = 360;
constexpr double kTolerance = 0.1;  // of decimate(): with the rounding of coordinates, curves are true to 0.21 units
constexpr int kXIntervals = 7;
constexpr int kYIntervals = 6;
constexpr double kLegendRow = 25;

double legend_width(const Series& series) { return kSwatch + text_width(series.name) + 16; }

}  // namespace

void Drawing::make_scales() {
  Range x{kLargest, -kLargest};
  Range y = x;
  const auto include = [&](double at_x, double at_y) {
    if (!drawable(at_x, plot_.x) || !drawable(at_y, plot_.y)) return;
    x = {std::min(x.low, at_x), std::max(x.high, at_x)};
    y = {std::min(y.low, at_y), std::max(y.high, at_y)};
  };
  std::vector<double> bar_x;
  for (const Series& series : plot_.series) {
    for (std::size_t i = 0; i < size_of(series); ++i) {
      include(series.x[i], series.y[i]);
      if (is_bar(series) && drawable(series.x[i], plot_.x)) bar_x.push_back(series.x[i]);
    }
  }
  for (const Marker& marker : plot_.markers) include(marker.x, marker.y);
  if (has_field()) {
    include(plot_.field.x.front(), plot_.field.y.front());
    include(plot_.field.x.back(), plot_.field.y.back());
    make_levels();
  }

  Axis x_axis = plot_.x;
  Axis y_axis = plot_.y;
  if (!bar_x.empty()) {
    y_axis.include_zero = true;
    std::sort(bar_x.begin(), bar_x.end());
    bar_pitch_ = kLargest;
    for (std::size_t i = 1; i < bar_x.size(); ++i) {
      if (bar_x[i] > bar_x[i - 1]) bar_pitch_ = std::min(bar_pitch_, bar_x[i] - bar_x[i - 1]);
    }
    if (bar_pitch_ == kLargest) bar_pitch_ = 1;
    if (!x_axis.range && !x_axis.logarithmic) {
      x_axis.range =
          Range{std::min(x.low, bar_x.front()) - bar_pitch_ / 2, std::max(x.high, bar_x.back()) + bar_pitch_ / 2};
    }
  }
  x_ = make_scale(x_axis, x, kXIntervals);
  ends_together_ = plot_.names_at_ends && end_together();
  y_of_data_ = y_ = make_scale(y_axis, y, kYIntervals);
  empty_ = x.low > x.high;
}

bool Drawing::end_together() const {
  Range ends{kLargest, -kLargest};
  for (const Series& series : plot_.series) {
    if (series.x.empty()) continue;
    const double end = std::min(series.x.back(), x_.range.high);
    ends = {std::min(ends.low, end), std::max(ends.high, end)};
  }
  return ends.high - ends.low < (x_.range.high - x_.range.low) / 4;
}

void Drawing::make_layout(bool legend) {
  labels_.clear();
  leaders_.clear();
  taken_.clear();
  legend_.clear();
  height_ = kHeight;
  frame_ = {0, 36, 0, kHeight - 54};
  if (legend) make_legend();
  band_top_ = frame_.top;
  const bool band_names =
      std::any_of(plot_.bands.begin(), plot_.bands.end(), [](const Band& band) { return !band.label.empty(); });
  if (band_names) frame_.top += 26;
  if (frame_.bottom - frame_.top < 200) {  // a long legend increases the drawing, not compresses the curves
    height_ += 200 - (frame_.bottom - frame_.top);
    frame_.bottom = frame_.top + 200;
  }
  make_headroom();
  double widest = 0;
  for (const Tick& tick : y_.ticks) widest = std::max(widest, text_width(tick.label));
  frame_.left = plot_.y.bare ? 8 : std::max(34.0, widest + 12);
  frame_.right = kWidth - std::max(8.0, x_.ticks.empty() ? 0 : text_width(x_.ticks.back().label) / 2 + 2);
  if (ends_together_) {
    double names = 0;
    for (const Series& series : plot_.series) names = std::max(names, 1.1 * text_width(series.name));
    frame_.right = kWidth - 28 - names;
  }
  if (has_field()) {
    double key = 0;
    for (const Tick& tick : levels_.ticks) key = std::max(key, text_width(tick.label));
    frame_.right = kWidth - kHeatKey - key;
  }
  if (plot_.equal_scales) make_equal();
  to_x_ = Mapping{x_.range, plot_.x.logarithmic, frame_.left, frame_.right};
  to_y_ = Mapping{y_.range, plot_.y.logarithmic, frame_.bottom, frame_.top};
  thin_labels(x_, to_x_, Direction::across);
  thin_labels(y_, to_y_, Direction::up);
  make_zero_lines();
  make_curves();
}

/// Widens one range about its middle until a unit is as long as on the other axis.
void Drawing::make_equal() {
  if (!plot_.x.range || !plot_.y.range) return;
  const auto span = [](const Range& range) { return range.high - range.low; };
  const double width = frame_.right - frame_.left;
  const double height = frame_.bottom - frame_.top;
  const double unit = std::min(width / span(*plot_.x.range), height / span(*plot_.y.range));
  const auto widened = [](Axis axis, double length, int intervals) {
    const double middle = (axis.range->low + axis.range->high) / 2;
    axis.range = Range{middle - length / 2, middle + length / 2};
    return make_scale(axis, *axis.range, intervals);
  };
  x_ = widened(plot_.x, width / unit, kXIntervals);
  y_ = widened(plot_.y, height / unit, kYIntervals);
}

/// Zero gets a line if values have both signs, and under curves that start at zero.
void Drawing::make_zero_lines() {
  zero_lines_.clear();
  if (empty_) return;
  if (!plot_.y.logarithmic && y_.range.low <= 0 && y_.range.high > 0)
    zero_lines_.push_back({{frame_.left, to_y_(0)}, {frame_.right, to_y_(0)}});
  if (!plot_.x.logarithmic && x_.range.low < 0 && x_.range.high > 0)
    zero_lines_.push_back({{to_x_(0), frame_.top}, {to_x_(0), frame_.bottom}});
}

/// Room for a label between a marked extreme and the frame: the scale then ends there and not on a tick.
void Drawing::make_headroom() {
  y_ = y_of_data_;
  if (plot_.y.range || plot_.y.logarithmic) return;
  const double need = 35 / (frame_.bottom - frame_.top);
  Range range = y_.range;
  if (plot_.names_at_ends && !ends_together_) range.high += 0.3 * (range.high - range.low);
  for (const Marker& marker : plot_.markers) {
    if (marker.label.empty() || !visible(marker)) continue;
    const double middle = (y_.range.low + y_.range.high) / 2;
    if (marker.y > middle) range.high = std::max(range.high, (marker.y - need * range.low) / (1 - need));
    if (marker.y < middle) range.low = std::min(range.low, (marker.y - need * range.high) / (1 - need));
  }
  if (range.low == y_.range.low && range.high == y_.range.high) return;
  Axis axis = plot_.y;
  axis.range = range;
  y_ = make_scale(axis, range, kYIntervals + 2);  // ticks only inside: ask for more
}

void Drawing::make_legend() {
  // One row if it fits; else equal columns, as few as need no further row.
  std::vector<std::size_t> named;
  double row = 0;
  double pitch = 0;
  for (std::size_t i = 0; i < plot_.series.size(); ++i) {
    if (plot_.series[i].name.empty()) continue;
    const double width = legend_width(plot_.series[i]);
    named.push_back(i);
    row += width;
    pitch = std::max(pitch, width);
  }
  const double room = kWidth + 16;
  const bool one_row = row <= room;
  const auto most = std::max<std::size_t>(1, static_cast<std::size_t>(room / pitch));
  const std::size_t rows = (named.size() + most - 1) / most;
  const std::size_t columns = one_row ? named.size() : (named.size() + rows - 1) / rows;
  Point at{0, frame_.top + 8};
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (i > 0 && i % columns == 0) at = {0, at.y + kLegendRow};
    legend_.push_back({at, named[i]});
    at.x += one_row ? legend_width(plot_.series[named[i]]) : pitch;
  }
  frame_.top = at.y + 20;
}

int Drawing::colour_of(std::size_t index) const {
  const int chosen = index < plot_.series.size() ? plot_.series[index].style.colour : 0;
  return chosen >= 1 && chosen <= kColours ? chosen : static_cast<int>(index % kColours) + 1;
}

void Drawing::make_curves() {
  curves_.clear();
  std::size_t bars_before = 0;
  const auto bar_series = static_cast<std::size_t>(std::count_if(plot_.series.begin(), plot_.series.end(), is_bar));
  for (std::size_t i = 0; i < plot_.series.size(); ++i) {
    const Series& series = plot_.series[i];
    Curve curve;
    curve.name = series.name;
    curve.style = series.style;
    curve.colour = colour_of(i);
    curve.dashed = series.style.dashed || (series.style.colour == 0 && series.style.ramp == 0 && i >= kColours);
    if (is_bar(series)) {
      make_bars(series, bars_before++, bar_series, curve);
    } else {
      make_lines(series, curve);
    }
    curves_.push_back(std::move(curve));
  }
}

double Drawing::baseline() const {
  if (plot_.y.logarithmic) return frame_.bottom;
  return std::clamp(to_y_(0), frame_.top, frame_.bottom);
}

void Drawing::make_bars(const Series& series, std::size_t position, std::size_t of, Curve& curve) const {
  const double pitch = plot_.x.logarithmic ? 10 : bar_pitch_ * (to_x_.to - to_x_.from) / (x_.range.high - x_.range.low);
  const double width = 0.72 * std::min(pitch, 60.0) / static_cast<double>(of);
  for (std::size_t i = 0; i < size_of(series); ++i) {
    if (!drawable(series.x[i], plot_.x) || !drawable(series.y[i], plot_.y)) continue;
    const double left = to_x_(series.x[i]) + width * (static_cast<double>(position) - static_cast<double>(of) / 2);
    const double end = to_y_(series.y[i]);
    curve.bars.push_back({left, std::min(end, baseline()), left + width, std::max(end, baseline())});
  }
}

void Drawing::make_lines(const Series& series, Curve& curve) const {
  const bool marks = series.style.draw == Draw::points || series.style.draw == Draw::line_and_points;
  std::vector<Polyline> pieces(1);
  for (std::size_t i = 0; i < size_of(series); ++i) {
    if (!drawable(series.x[i], plot_.x) || !drawable(series.y[i], plot_.y)) {
      if (!pieces.back().empty()) pieces.emplace_back();
      continue;
    }
    const Point point{to_x_(series.x[i]), to_y_(series.y[i])};
    Polyline& piece = pieces.back();
    if (series.style.draw == Draw::step && !piece.empty()) piece.push_back({point.x, piece.back().y});
    piece.push_back(point);
  }
  if (pieces.back().empty()) pieces.pop_back();
  if (series.style.closed && pieces.size() == 1 && pieces[0].size() > 2) pieces[0].push_back(pieces[0][0]);

  std::set<std::pair<int, int>> occupied;  // by marks, in half user units: a second one there would be invisible
  for (const Polyline& piece : pieces) {
    if (!marks && piece.size() > 1) curve.lines.push_back(decimate(piece, kTolerance));
    if (series.style.draw == Draw::line_and_points && piece.size() > 1)
      curve.lines.push_back(decimate(piece, kTolerance));
    if (!marks && piece.size() > 1) continue;
    for (const Point& point : piece) {
      const auto cell = std::make_pair(static_cast<int>(2 * point.x), static_cast<int>(2 * point.y));
      if (occupied.insert(cell).second) curve.points.push_back(point);
    }
  }
}

bool Drawing::visible(const Marker& marker) const {
  if (!drawable(marker.x, plot_.x) || !drawable(marker.y, plot_.y)) return false;
  return marker.x >= x_.range.low && marker.x <= x_.range.high && marker.y >= y_.range.low && marker.y <= y_.range.high;
}

}  // namespace crankloop::report

#include "plot.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <utility>

namespace crankloop::report {
namespace {

// ---- Text ----

constexpr double kWidth = 520;  // user units
constexpr double kHeight = 350;
constexpr double kTypeSize = 17;    // the largest type in user units: what margins and label places are computed for
constexpr double kTolerance = 0.1;  // of decimate(): with the rounding of coordinates, curves are true to 0.21 units
constexpr int kXIntervals = 7;
constexpr int kYIntervals = 6;
constexpr double kLegendRow = 23;
constexpr double kSwatch = 26;  // a legend's line and the gap behind it

std::string fixed(double value, int decimals) {
  char buffer[400];  // 309 digits before the point at most
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals);
  std::string text(buffer, result.ptr);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

void trim_zeros(std::string& text) {
  if (text.find('.') == std::string::npos) return;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
}

std::string coordinate(double value) {
  std::string text = fixed(value, 2);
  trim_zeros(text);
  return text;
}

/// Digits as printed by fixed(), for the eye: U+2212 for minus, U+202F (narrow no-break space) between groups of three.
std::string typeset(const std::string& plain) {
  const std::size_t first = plain.front() == '-' ? 1 : 0;
  const std::size_t point = std::min(plain.find('.'), plain.size());
  const bool grouped = point - first > 4;
  std::string text = first == 1 ? "\u2212" : "";
  for (std::size_t i = first; i < plain.size(); ++i) {
    if (grouped && i > first && i < point && (point - i) % 3 == 0) text += "\u202F";
    text += plain[i];
  }
  return text;
}

std::string power_of_ten(int exponent) {
  static constexpr const char* kSuperscript[] = {"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                                                 "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = exponent < 0 ? "10\u207B" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) text += kSuperscript[digit - '0'];
  return text;
}

/// Width in user units at kTypeSize, by the widest of the usual system fonts (DejaVu Sans); others are up to a fifth
/// narrower.
double text_width(std::string_view text) {
  double em = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80U) continue;  // inside a UTF-8 sequence
    if (std::string_view{" .,:;|!'()[]ijlfrt"}.find(c) != std::string_view::npos)
      em += 0.36;
    else if (std::string_view{"mwMW"}.find(c) != std::string_view::npos)
      em += 0.95;
    else if (c >= 'A' && c <= 'Z')
      em += 0.72;
    else
      em += 0.635;
  }
  return em * kTypeSize;
}

std::string with_unit(const std::string& title, const std::string& unit, int exponent) {
  std::string scaled = exponent == 0 ? unit : power_of_ten(exponent) + (unit.empty() ? "" : "\u00A0" + unit);
  if (title.empty() || scaled.empty()) return title + scaled;
  return title + ", " + scaled;
}

// ---- Scales ----

constexpr double kLargest = 1e200;    // beyond it a value counts as missing, so that no difference or step overflows
constexpr double kSmallest = 1e-200;  // below it a linear axis has nothing to show but zero

bool drawable(double value, const Axis& axis) {
  return std::isfinite(value) && std::abs(value) < kLargest && (!axis.logarithmic || value > kSmallest);
}

/// 1, 2 or 5 times a power of ten, not below `step`.
double nice_step(double step) {
  const double decade = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= step * (1 - 1e-9)) return factor * decade;
  }
  return 10 * decade;
}

/// Decimals that a multiple of `step` needs: 0 for 20, 1 for 0.5, 2 for 0.25.
int decimals_of(double step) {
  int decimals = 0;
  double scaled = step;
  while (decimals < 15 && std::abs(scaled - std::round(scaled)) > 1e-6 * scaled) {
    ++decimals;
    scaled *= 10;
  }
  return decimals;
}

Scale linear_scale(const Axis& axis, Range data, int intervals) {
  const bool given = axis.range.has_value();
  Range range = given ? *axis.range : data;
  if (!(range.low <= range.high)) range = {0, 0};
  range = {std::clamp(range.low, -kLargest, kLargest), std::clamp(range.high, -kLargest, kLargest)};
  if (axis.include_zero && !given) range = {std::min(range.low, 0.0), std::max(range.high, 0.0)};
  const double size = std::max(std::abs(range.low), std::abs(range.high));
  // Rounding noise around a constant is no shape: a span below 1e-9 of the value is drawn as constant.
  if (range.high - range.low <= 1e-9 * size || size < kSmallest) {
    const double margin = size < kSmallest ? 1 : 0.1 * size;
    range = {range.low - margin, range.high + margin};
  }
  const double span = range.high - range.low;
  double step = axis.tick_step;
  if (!(step > 0) || span / step > 60 || (given && span < step)) step = nice_step(span / intervals);

  const double first = given ? std::ceil(range.low / step - 1e-9) : std::floor(range.low / step + 1e-9);
  const double last = given ? std::floor(range.high / step + 1e-9) : std::ceil(range.high / step - 1e-9);
  Scale scale;
  scale.range = given ? range : Range{first * step, last * step};

  const double largest = std::max(std::abs(scale.range.low), std::abs(scale.range.high));
  if (largest >= 1e6 || largest < 1e-3) scale.exponent = 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
  const double unit = std::pow(10.0, scale.exponent);
  const int decimals = decimals_of(step / unit);
  const int count = static_cast<int>(last - first);
  for (int i = 0; i <= count; ++i) {
    const double value = (first + i) * step;
    scale.ticks.push_back({value, typeset(fixed(value / unit, decimals))});
  }
  return scale;
}

Scale logarithmic_scale(const Axis& axis, Range data) {
  Range range = axis.range ? *axis.range : data;
  const bool given = axis.range && range.low > 0 && range.high > range.low;
  if (!(range.low > 0 && range.low <= range.high)) range = {1, 10};
  const auto decade = [](int n) { return std::pow(10.0, n); };
  int low = static_cast<int>(std::floor(std::log10(range.low) + 1e-9));
  int high = static_cast<int>(std::floor(std::log10(range.high) - 1e-9));
  if (!given) {  // round out to 1, 2 or 5 times a power of ten; a constant gets its decade
    Range rounded{decade(low), decade(high + 1)};
    for (const int factor : {2, 5}) {
      if (factor * decade(low) <= range.low * (1 + 1e-9)) rounded.low = factor * decade(low);
      if (rounded.high == decade(high + 1) && factor * decade(high) >= range.high * (1 - 1e-9))
        rounded.high = factor * decade(high);
    }
    if (rounded.high <= rounded.low || range.high <= range.low) {
      high = std::max(high, low);
      rounded = {decade(low), decade(high + 1)};
    }
    range = rounded;
  }

  Scale scale;
  scale.range = range;
  high = std::max(high, low) + 1;
  const int decades = high - low;
  const bool plain = low >= -3 && high <= 5;
  const auto label = [&](int factor, int n) {
    if (plain) return typeset(fixed(factor * decade(n), std::max(0, -n)));
    return (factor == 1 ? "" : std::to_string(factor) + "\u00B7") + power_of_ten(n);
  };
  const bool few = range.high / range.low <= 1000;
  const int stride = std::max(1, (decades + 9) / 10);
  for (int n = low; n <= high; ++n) {
    for (int factor = 1; factor <= (decades <= 8 ? 9 : 1); ++factor) {
      const double value = factor * decade(n);
      if (value < range.low * (1 - 1e-9) || value > range.high * (1 + 1e-9)) continue;
      const bool labelled = factor == 1 ? (n - low) % stride == 0 : few && (factor == 2 || factor == 5);
      scale.ticks.push_back({value, labelled ? label(factor, n) : ""});
    }
  }
  return scale;
}

/// Where a value of an axis lies on the drawing.
struct Mapping {
  Range range;
  bool logarithmic;
  double from;
  double to;

  double operator()(double value) const {
    const double low = logarithmic ? std::log10(range.low) : range.low;
    const double high = logarithmic ? std::log10(range.high) : range.high;
    const double at = ((logarithmic ? std::log10(value) : value) - low) / (high - low);
    return std::clamp(from + at * (to - from), -1e5, 1e5);  // what lies far outside a given range keeps its direction
  }
};

enum class Direction : std::uint8_t { across, up };

/// Leaves only every k-th label, k as small as keeps them apart.
void thin_labels(Scale& scale, const Mapping& map, Direction direction) {
  std::vector<Tick*> labelled;
  for (Tick& tick : scale.ticks) {
    if (!tick.label.empty()) labelled.push_back(&tick);
  }
  const auto fits = [&](std::size_t stride) {
    for (std::size_t i = stride; i < labelled.size(); i += stride) {
      const Tick& one = *labelled[i - stride];
      const Tick& next = *labelled[i];
      const double room = std::abs(map(next.value) - map(one.value));
      const double across = (text_width(one.label) + text_width(next.label) + kTypeSize) / 2;
      if (room < (direction == Direction::across ? across : kTypeSize)) return false;
    }
    return true;
  };
  std::size_t stride = 1;
  while (stride < labelled.size() && !fits(stride)) ++stride;
  for (std::size_t i = 0; i < labelled.size(); ++i) {
    if (i % stride != 0) labelled[i]->label.clear();
  }
}

// ---- Geometry of boxes and lines, for placing labels ----

struct Box {
  double left;
  double top;
  double right;
  double bottom;
};

Box grown(const Box& box, double by) { return {box.left - by, box.top - by, box.right + by, box.bottom + by}; }

double overlap_area(const Box& a, const Box& b) {
  const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
  const double height = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
  return width > 0 && height > 0 ? width * height : 0;
}

/// Length of the part of a segment inside a box (Liang and Barsky's clipping).
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

enum class Anchor : std::uint8_t { start, middle, end };

struct Label {
  Point at{};  // on the baseline
  Anchor anchor = Anchor::start;
  std::string text{};
  int colour = 0;
};

Box box_of(const Label& label) {
  const double width = 1.1 * text_width(label.text);  // semi-bold
  const double left = label.at.x - (label.anchor == Anchor::start    ? 0
                                    : label.anchor == Anchor::middle ? width / 2
                                                                     : width);
  return {left, label.at.y - 0.76 * kTypeSize, left + width, label.at.y + 0.24 * kTypeSize};
}

// ---- The drawing ----

using Polyline = std::vector<Point>;

/// What is drawn of one series, in user units.
struct Curve {
  std::string name{};
  Style style{};
  int colour = 1;
  bool dashed = false;
  std::vector<Polyline> lines{};  // thinned, one per unbroken piece
  Polyline points{};              // marks, and points that stand alone
  std::vector<Box> bars{};
};

std::size_t size_of(const Series& series) { return std::min(series.x.size(), series.y.size()); }

bool is_bar(const Series& series) { return series.style.draw == Draw::bar; }

class Drawing {
 public:
  /// Fixed: of its own size in user units, instead of its column's width.
  Drawing(const Plot& plot, bool fixed) : plot_{plot}, fixed_{fixed} {}

  Drawn draw() {
    make_scales();
    const auto named =
        std::count_if(plot_.series.begin(), plot_.series.end(), [](const Series& s) { return !s.name.empty(); });
    const bool bars = std::any_of(plot_.series.begin(), plot_.series.end(), is_bar);
    make_layout(false);
    place_markers();
    // Beside the curves is better than a legend, but only few names find a place there.
    if (named > 1 && (bars || plot_.series.size() > 6 || !place_names())) {
      make_layout(true);
      place_markers();
    }
    write();
    return {std::move(out_), kWidth, height_};
  }

 private:
  // -- Scales and layout --

  void make_scales() {
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
    y_of_data_ = y_ = make_scale(y_axis, y, kYIntervals);
    empty_ = x.low > x.high;
  }

  void make_layout(bool legend) {
    labels_.clear();
    taken_.clear();
    legend_.clear();
    height_ = kHeight;
    frame_ = {0, 31, 0, kHeight - 50};
    if (legend) make_legend();
    band_top_ = frame_.top;
    const bool band_names =
        std::any_of(plot_.bands.begin(), plot_.bands.end(), [](const Band& band) { return !band.label.empty(); });
    if (band_names) frame_.top += 24;
    if (frame_.bottom - frame_.top < 200) {  // a long legend makes the drawing higher, not the curves flatter
      height_ += 200 - (frame_.bottom - frame_.top);
      frame_.bottom = frame_.top + 200;
    }
    make_headroom();
    double widest = 0;
    for (const Tick& tick : y_.ticks) widest = std::max(widest, text_width(tick.label));
    frame_.left = std::max(34.0, widest + 12);
    frame_.right = kWidth - std::max(8.0, x_.ticks.empty() ? 0 : text_width(x_.ticks.back().label) / 2 + 2);
    to_x_ = Mapping{x_.range, plot_.x.logarithmic, frame_.left, frame_.right};
    to_y_ = Mapping{y_.range, plot_.y.logarithmic, frame_.bottom, frame_.top};
    thin_labels(x_, to_x_, Direction::across);
    thin_labels(y_, to_y_, Direction::up);
    make_curves();
  }

  /// Room for a label between a marked extreme and the frame: the scale then ends there and not on a tick.
  void make_headroom() {
    y_ = y_of_data_;
    if (plot_.y.range || plot_.y.logarithmic) return;
    const double need = 32 / (frame_.bottom - frame_.top);
    Range range = y_.range;
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

  static double legend_width(const Series& series) { return kSwatch + text_width(series.name) + 16; }

  void make_legend() {
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
    Point at{0, frame_.top + 13};
    for (std::size_t i = 0; i < named.size(); ++i) {
      if (i > 0 && i % columns == 0) at = {0, at.y + kLegendRow};
      legend_.push_back({at, named[i]});
      at.x += one_row ? legend_width(plot_.series[named[i]]) : pitch;
    }
    frame_.top = at.y + 18;
  }

  // -- Curves --

  int colour_of(std::size_t index) const {
    const int chosen = index < plot_.series.size() ? plot_.series[index].style.colour : 0;
    return chosen >= 1 && chosen <= kColours ? chosen : static_cast<int>(index % kColours) + 1;
  }

  void make_curves() {
    curves_.clear();
    std::size_t bars_before = 0;
    const auto bar_series = static_cast<std::size_t>(std::count_if(plot_.series.begin(), plot_.series.end(), is_bar));
    for (std::size_t i = 0; i < plot_.series.size(); ++i) {
      const Series& series = plot_.series[i];
      Curve curve;
      curve.name = series.name;
      curve.style = series.style;
      curve.colour = colour_of(i);
      curve.dashed = series.style.dashed || (series.style.colour == 0 && i >= kColours);
      if (is_bar(series)) {
        make_bars(series, bars_before++, bar_series, curve);
      } else {
        make_lines(series, curve);
      }
      curves_.push_back(std::move(curve));
    }
  }

  double baseline() const {
    if (plot_.y.logarithmic) return frame_.bottom;
    return std::clamp(to_y_(0), frame_.top, frame_.bottom);
  }

  void make_bars(const Series& series, std::size_t position, std::size_t of, Curve& curve) const {
    const double pitch =
        plot_.x.logarithmic ? 10 : bar_pitch_ * (to_x_.to - to_x_.from) / (x_.range.high - x_.range.low);
    const double width = 0.72 * std::min(pitch, 60.0) / static_cast<double>(of);
    for (std::size_t i = 0; i < size_of(series); ++i) {
      if (!drawable(series.x[i], plot_.x) || !drawable(series.y[i], plot_.y)) continue;
      const double left = to_x_(series.x[i]) + width * (static_cast<double>(position) - static_cast<double>(of) / 2);
      const double end = to_y_(series.y[i]);
      curve.bars.push_back({left, std::min(end, baseline()), left + width, std::max(end, baseline())});
    }
  }

  void make_lines(const Series& series, Curve& curve) const {
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

    std::set<std::pair<int, int>> occupied;  // by marks, in half user units: a second one there would not be seen
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

  // -- Labels --

  /// Length of curves and overlap with other labels under a box, as a penalty in user units.
  double hidden_by(const Box& box) const {
    double penalty = 0;
    for (const Curve& curve : curves_) {
      for (const Polyline& line : curve.lines) {
        for (std::size_t i = 1; i < line.size(); ++i) penalty += length_inside(box, line[i - 1], line[i]);
      }
      for (const Box& bar : curve.bars) penalty += overlap_area(box, bar) / 10;
    }
    for (const Box& other : taken_) penalty += overlap_area(box, other);
    return penalty;
  }

  double outside_frame(const Box& box) const {
    return std::max(0.0, frame_.left + 3 - box.left) + std::max(0.0, box.right - (kWidth - 2)) +
           std::max(0.0, frame_.top + 1 - box.top) + std::max(0.0, box.bottom - frame_.bottom + 2);
  }

  bool visible(const Marker& marker) const {
    if (!drawable(marker.x, plot_.x) || !drawable(marker.y, plot_.y)) return false;
    return marker.x >= x_.range.low && marker.x <= x_.range.high && marker.y >= y_.range.low &&
           marker.y <= y_.range.high;
  }

  /// Every marker gets its label at the best of eight places around it, good or not.
  void place_markers() {
    for (const Marker& marker : plot_.markers) {
      if (!visible(marker)) continue;
      const Point dot{to_x_(marker.x), to_y_(marker.y)};
      taken_.push_back({dot.x - 5, dot.y - 5, dot.x + 5, dot.y + 5});
    }
    for (const Marker& marker : plot_.markers) {
      if (!visible(marker) || marker.label.empty()) continue;
      const Point dot{to_x_(marker.x), to_y_(marker.y)};
      Label best;
      double least = std::numeric_limits<double>::infinity();
      const bool high = dot.y < (frame_.top + frame_.bottom) / 2;
      const double above = -10;
      const double below = 10 + 0.76 * kTypeSize;
      const double beside = 0.26 * kTypeSize;
      double order = 0;
      for (const double dy : {high ? above : below, beside, high ? below : above}) {
        for (const int side : {0, 1, -1}) {
          if (side == 0 && dy == beside) continue;
          const Anchor anchor = side == 0 ? Anchor::middle : side > 0 ? Anchor::start : Anchor::end;
          const Label label{
              {dot.x + side * (dy == beside ? 10 : 6), dot.y + dy}, anchor, marker.label, colour_of(marker.series)};
          const Box box = box_of(label);
          const double penalty = hidden_by(grown(box, 3)) + 20 * outside_frame(box) + order++;
          if (penalty < least) {
            least = penalty;
            best = label;
          }
        }
      }
      taken_.push_back(box_of(best));
      labels_.push_back(best);
    }
  }

  /// Points along a curve at which its name may stand: every 12 units, or 150 of them if it is longer than that.
  static Polyline places_along(const Curve& curve) {
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

  /// Puts every series' name where it touches no curve and is clearly nearest to its own; false if one finds no place.
  bool place_names() {
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      const Curve& curve = curves_[i];
      if (curve.name.empty()) continue;
      Label best;
      double highest = 0;
      for (const Point& place : places_along(curve)) {
        const Label candidates[] = {{{place.x, place.y - 8}, Anchor::middle, curve.name, curve.colour},
                                    {{place.x, place.y + 20}, Anchor::middle, curve.name, curve.colour},
                                    {{place.x + 9, place.y + 5}, Anchor::start, curve.name, curve.colour},
                                    {{place.x - 9, place.y + 5}, Anchor::end, curve.name, curve.colour}};
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

  /// How much nearer a name is to its own curve than to any other, in user units, at most 40; <= 0 where it must not
  /// stand.
  double clarity(const Label& label, std::size_t own) const {
    const Box box = box_of(label);
    if (outside_frame(box) > 0) return 0;
    for (const Box& other : taken_) {
      if (overlap_area(grown(box, 4), other) > 0) return 0;
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
    const double zero = plot_.y.logarithmic ? -1 : to_y_(0);
    const double crossed_zero = zero > box.top && zero < box.bottom ? 8 : 0;
    return other_distance - own_distance - 4 - crossed_zero;
  }

  // -- Output --

  void text(const char* what, Point at, Anchor anchor, const std::string& content, int colour = 0) {
    out_ += std::string{"<text class=\""} + what;
    if (colour > 0) out_ += " c" + std::to_string(colour);
    out_ += "\" x=\"" + coordinate(at.x) + "\" y=\"" + coordinate(at.y) + '"';
    if (anchor != Anchor::start) out_ += anchor == Anchor::middle ? " text-anchor=\"middle\"" : " text-anchor=\"end\"";
    out_ += '>' + escape(content) + "</text>\n";
  }

  void path(const std::string& what, const std::string& d) {
    out_ += "<path class=\"" + what + "\" d=\"" + d + "\"/>\n";
  }

  void rectangle(const std::string& what, const Box& box) {
    out_ += "<rect class=\"" + what + "\" x=\"" + coordinate(box.left) + "\" y=\"" + coordinate(box.top) +
            "\" width=\"" + coordinate(box.right - box.left) + "\" height=\"" + coordinate(box.bottom - box.top) +
            "\"/>\n";
  }

  static std::string move(double x, double y) { return 'M' + coordinate(x) + ' ' + coordinate(y); }

  static std::string path_of(const Polyline& line) {
    std::string d = move(line[0].x, line[0].y);
    for (std::size_t i = 1; i < line.size(); ++i)
      d += (i == 1 ? 'L' : ' ') + coordinate(line[i].x) + ' ' + coordinate(line[i].y);
    return d;
  }

  std::string description() const {
    const auto interval = [](Range range, const std::string& unit) {
      return "from " + format_number(range.low, 3) + " to " + format_number(range.high, 3) +
             (unit.empty() ? "" : ' ' + unit);
    };
    std::string text = plot_.y.title + " over " + plot_.x.title + ' ' + interval(x_.range, plot_.x.unit) + '.';
    for (const Series& series : plot_.series) {
      Range range{kLargest, -kLargest};
      for (std::size_t i = 0; i < size_of(series); ++i) {
        if (!drawable(series.x[i], plot_.x) || !drawable(series.y[i], plot_.y)) continue;
        range = {std::min(range.low, series.y[i]), std::max(range.high, series.y[i])};
      }
      const std::string name = series.name.empty() ? "Values" : series.name;
      text += ' ' + name + (range.low > range.high ? ": no data." : ": " + interval(range, plot_.y.unit) + '.');
    }
    return text;
  }

  void write() {
    const std::string id = escape(plot_.id);
    const bool clipped = plot_.x.range || plot_.y.range;
    // Some browsers take the size of an inner drawing from its attributes, some let the style sheet override them.
    const std::string size = "width=\"" + coordinate(kWidth) + "\" height=\"" + coordinate(height_) +
                             "\" style=\"width:" + coordinate(kWidth) + "px;height:" + coordinate(height_) + "px\" ";
    out_ = "<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + coordinate(kWidth) + ' ' +
           coordinate(height_) + "\" " + (fixed_ ? size : "") + "role=\"img\" aria-labelledby=\"" + id + "-title " +
           id + "-desc\">\n";
    out_ += "<title id=\"" + id + "-title\">" + escape(plot_.title) + "</title>\n";
    out_ += "<desc id=\"" + id + "-desc\">" + escape(description()) + "</desc>\n";
    if (clipped) {
      out_ += "<clipPath id=\"" + id + "-clip\">";
      rectangle("clip", grown(frame_, 1.5));
      out_ += "</clipPath>\n";
    }
    write_bands();
    write_axes();
    out_ += clipped ? "<g clip-path=\"url(#" + id + "-clip)\">\n" : "<g>\n";
    for (const Curve& curve : curves_) write_curve(curve);
    out_ += "</g>\n";
    for (const Marker& marker : plot_.markers) {
      if (!visible(marker)) continue;
      path("dot c" + std::to_string(colour_of(marker.series)), move(to_x_(marker.x), to_y_(marker.y)) + "h0");
    }
    if (empty_)
      text("tick", {(frame_.left + frame_.right) / 2, (frame_.top + frame_.bottom) / 2}, Anchor::middle, "no data");
    for (const Label& label : labels_) text("name", label.at, label.anchor, label.text, label.colour);
    for (const auto& [at, index] : legend_) {
      const Curve& curve = curves_[index];
      const std::string colour = " c" + std::to_string(curve.colour);
      const double middle = at.y - 0.33 * kTypeSize;
      if (curve.style.draw == Draw::bar)
        rectangle("bar" + colour, {at.x, middle - 6, at.x + 14, middle + 6});
      else if (curve.style.draw != Draw::points)
        path((curve.dashed ? "curve dashed" : "curve") + colour, move(at.x, middle) + "h20");
      if (curve.style.draw == Draw::points || curve.style.draw == Draw::line_and_points)
        path("dot" + colour, move(at.x + 10, middle) + "h0");
      text("legend", {at.x + kSwatch, at.y}, Anchor::start, curve.name);
    }
    out_ += "</svg>\n";
  }

  void write_bands() {
    int count = 0;
    for (const Band& band : plot_.bands) {
      if (!drawable(band.from, plot_.x) || !drawable(band.to, plot_.x)) continue;
      const double left = std::clamp(to_x_(band.from), frame_.left, frame_.right);
      const double right = std::clamp(to_x_(band.to), frame_.left, frame_.right);
      if (right <= left) continue;
      if (count++ % 2 == 0)
        rectangle("band", {left, band_top_, right, frame_.bottom});  // every other one: enough to tell them apart
      if (0.88 * text_width(band.label) > right - left) continue;    // its type is that much smaller
      text("band-name", {(left + right) / 2, band_top_ + 17}, Anchor::middle, band.label);
    }
  }

  void write_axes() {
    const std::string width = 'h' + coordinate(frame_.right - frame_.left);
    const std::string height = 'v' + coordinate(frame_.bottom - frame_.top);
    std::string grid;
    std::string fine;
    std::string marks;
    for (const Tick& tick : y_.ticks)
      (plot_.y.logarithmic && tick.label.empty() ? fine : grid) += move(frame_.left, to_y_(tick.value)) + width;
    for (const Tick& tick : x_.ticks) {
      const double x = to_x_(tick.value);
      (plot_.x.logarithmic && tick.label.empty() ? fine : grid) += move(x, frame_.top) + height;
      marks += move(x, frame_.bottom) + (tick.label.empty() ? "v3" : "v6");
    }
    if (!fine.empty()) path("grid fine", fine);
    path("grid", grid);
    path("axis", move(frame_.left, frame_.bottom) + width + marks);
    // Zero stands out when values of both signs are seen, and under curves that start from it.
    std::string zero;
    if (!plot_.y.logarithmic && y_.range.low <= 0 && y_.range.high > 0) zero += move(frame_.left, to_y_(0)) + width;
    if (!plot_.x.logarithmic && x_.range.low < 0 && x_.range.high > 0) zero += move(to_x_(0), frame_.top) + height;
    if (!zero.empty() && !empty_) path("zero", zero);

    for (const Tick& tick : y_.ticks) {
      if (!tick.label.empty())
        text("tick", {frame_.left - 8, to_y_(tick.value) + 0.34 * kTypeSize}, Anchor::end, tick.label);
    }
    for (const Tick& tick : x_.ticks) {
      if (!tick.label.empty()) text("tick", {to_x_(tick.value), frame_.bottom + 22}, Anchor::middle, tick.label);
    }
    text("axis-title", {0, 16}, Anchor::start, with_unit(plot_.y.title, plot_.y.unit, y_.exponent));
    text("axis-title", {frame_.right, height_ - 6}, Anchor::end, with_unit(plot_.x.title, plot_.x.unit, x_.exponent));
  }

  void write_curve(const Curve& curve) {
    const std::string colour = " c" + std::to_string(curve.colour);
    std::string d;
    std::string area;
    for (const Polyline& line : curve.lines) {
      d += path_of(line);
      if (!curve.style.filled) continue;
      area += path_of(line);
      if (!curve.style.closed)
        area += 'L' + coordinate(line.back().x) + ' ' + coordinate(baseline()) + 'H' + coordinate(line.front().x);
      area += 'Z';
    }
    std::string dots;
    for (const Point& point : curve.points) dots += move(point.x, point.y) + "h0";
    if (!area.empty()) path("area" + colour, area);
    if (!d.empty()) path((curve.dashed ? "curve dashed" : "curve") + colour, d);
    if (!dots.empty()) path("dot" + colour, dots);
    for (const Box& bar : curve.bars) rectangle("bar" + colour, bar);
  }

  struct LegendEntry {
    Point at;
    std::size_t series;
  };

  const Plot& plot_;
  const bool fixed_;
  Scale x_{};
  Scale y_{};
  Scale y_of_data_{};  // before room for labels
  bool empty_ = true;
  double bar_pitch_ = 1;  // in units of x
  double height_ = kHeight;
  double band_top_ = 0;
  Box frame_{};
  Mapping to_x_{};
  Mapping to_y_{};
  std::vector<Curve> curves_{};
  std::vector<LegendEntry> legend_{};
  std::vector<Label> labels_{};
  std::vector<Box> taken_{};
  std::string out_{};
};

// ---- Thinning ----

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

  // Douglas-Peucker between each two pins, with a stack of its own: noise of any length must not exhaust the program's.
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

Scale make_scale(const Axis& axis, Range data, int intervals) {
  return axis.logarithmic ? logarithmic_scale(axis, data) : linear_scale(axis, data, std::max(1, intervals));
}

std::string escape(std::string_view text) {
  static constexpr std::string_view kReplacement = "\uFFFD";
  std::string safe;
  std::size_t i = 0;
  while (i < text.size()) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x80U) {
      ++i;
      switch (byte) {
        case '&':
          safe += "&amp;";
          break;
        case '<':
          safe += "&lt;";
          break;
        case '>':
          safe += "&gt;";
          break;
        case '"':
          safe += "&quot;";
          break;
        case '\'':
          safe += "&#39;";
          break;
        default:
          if (byte >= 0x20U && byte != 0x7FU)
            safe += static_cast<char>(byte);
          else if (byte == '\n' || byte == '\t')
            safe += ' ';
          else
            safe += kReplacement;
      }
      continue;
    }
    // A UTF-8 sequence, by the table of RFC 3629: the second byte's bounds refuse overlong forms, surrogates, >
    // U+10FFFF.
    const std::size_t length = byte >= 0xC2U && byte <= 0xDFU   ? 2
                               : (byte & 0xF0U) == 0xE0U        ? 3
                               : byte >= 0xF0U && byte <= 0xF4U ? 4
                                                                : 0;
    const unsigned low = byte == 0xE0U ? 0xA0U : byte == 0xF0U ? 0x90U : 0x80U;
    const unsigned high = byte == 0xEDU ? 0x9FU : byte == 0xF4U ? 0x8FU : 0xBFU;
    bool valid = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; valid && k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      valid = k == 1 ? next >= low && next <= high : (next & 0xC0U) == 0x80U;
    }
    if (valid)
      safe += text.substr(i, length);
    else
      safe += kReplacement;
    i += valid ? length : 1;
  }
  return safe;
}

std::string format_number(double value, int significant_digits) {
  if (!std::isfinite(value)) return "\u2013";
  if (value == 0) return "0";
  const int digits = std::clamp(significant_digits, 1, 17);
  char buffer[40];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific, digits - 1);
  const std::string scientific(buffer, result.ptr);
  const std::size_t e = scientific.find('e');
  const int exponent = std::atoi(scientific.c_str() + e + 1);
  if (exponent < -4 || exponent >= 9) return typeset(scientific.substr(0, e)) + "\u00B7" + power_of_ten(exponent);
  return typeset(fixed(value, std::max(0, digits - 1 - exponent)));
}

std::string format_fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "\u2013";
  return typeset(fixed(value, std::clamp(decimals, 0, 17)));
}

std::vector<Marker> mark_extremes(const Plot& plot, std::size_t series, int significant_digits) {
  std::vector<Marker> markers;
  if (series >= plot.series.size()) return markers;
  const Series& of = plot.series[series];
  std::size_t low = size_of(of);
  std::size_t high = low;
  for (std::size_t i = 0; i < size_of(of); ++i) {
    if (!drawable(of.x[i], plot.x) || !drawable(of.y[i], plot.y)) continue;
    if (low == size_of(of) || of.y[i] < of.y[low]) low = i;
    if (high == size_of(of) || of.y[i] > of.y[high]) high = i;
  }
  if (low == size_of(of)) return markers;
  const auto mark = [&](std::size_t i) {
    // What is 1e-9 of the series is rounding: "0 mm at 0 deg", not 2.8e-14.
    const double noise = 1e-9 * std::max(std::abs(of.y[low]), std::abs(of.y[high]));
    const double value = std::abs(of.y[i]) <= noise ? 0 : of.y[i];
    const auto quantity = [](std::string number, const std::string& unit) {
      return unit.empty() ? number : number + ' ' + unit;
    };
    std::string at = format_number(of.x[i], significant_digits);
    trim_zeros(at);
    markers.push_back(
        {of.x[i], of.y[i],
         quantity(format_number(value, significant_digits), plot.y.unit) + " at " + quantity(at, plot.x.unit), series});
  };
  mark(high);
  if (of.y[low] < of.y[high]) mark(low);
  return markers;
}

std::string to_svg(const Plot& plot) { return Drawing(plot, false).draw().svg; }

Drawn draw(const Plot& plot) { return Drawing(plot, true).draw(); }

std::string_view plot_style() {
  return R"css(:root {
  --paper: #fdfdfb; --ink: #1c2126; --muted: #555d66; --rule: #d9dcdf;
  --grid: #e3e6e7; --axis: #7b838b; --zero: #59616a; --band: #f1f3f2; --accent: #00589b;
  --series-1: #00589b; --series-2: #b8480a; --series-3: #007a5c;
  --series-4: #b0407f; --series-5: #4a3c00; --series-6: #4f5a68;
}
@media screen and (prefers-color-scheme: dark) {
  :root {
    --paper: #14181b; --ink: #e4e7e9; --muted: #a5adb5; --rule: #353c42;
    --grid: #282e33; --axis: #7d868e; --zero: #99a2aa; --band: #1c2125; --accent: #5aabf0;
    --series-1: #4a9de8; --series-2: #f08040; --series-3: #5fdcb8;
    --series-4: #d77fc4; --series-5: #f5e58a; --series-6: #98a0a8;
  }
}
.figure { container-type: inline-size; }
.plot { display: block; width: 100%; height: auto; font-size: 16px; font-variant-numeric: tabular-nums; }
.plot text { fill: var(--muted); }
.plot .axis-title { fill: var(--ink); }
.plot .band-name { font-size: 0.88em; }
.plot .legend { fill: var(--ink); }
.plot .name {
  fill: var(--c); stroke: var(--paper); stroke-width: 4px; stroke-linejoin: round;
  paint-order: stroke; font-weight: 600;
}
.plot path { fill: none; stroke-width: 1px; vector-effect: non-scaling-stroke; }
.plot .grid { stroke: var(--grid); }
.plot .fine { stroke-opacity: 0.55; }
.plot .axis { stroke: var(--axis); }
.plot .zero { stroke: var(--zero); stroke-width: 1.25px; }
.plot .band { fill: var(--band); }
.plot .curve { stroke: var(--c); stroke-width: 2px; stroke-linejoin: round; stroke-linecap: round; }
.plot .dashed { stroke-dasharray: 6 5; }
.plot .area { fill: var(--c); fill-opacity: 0.12; }
.plot .dot { stroke: var(--c); stroke-width: 7px; stroke-linecap: round; }
.plot .bar { fill: var(--c); }
.c1 { --c: var(--series-1); } .c2 { --c: var(--series-2); } .c3 { --c: var(--series-3); }
.c4 { --c: var(--series-4); } .c5 { --c: var(--series-5); } .c6 { --c: var(--series-6); }
@container (max-width: 380px) {
  .plot { font-size: 17px; }
  .plot .curve { stroke-width: 1.75px; }
  .plot .dot { stroke-width: 6px; }
}
@container (min-width: 450px) { .plot { font-size: 14px; } }
@container (min-width: 540px) { .plot { font-size: 13px; } }
@container (min-width: 640px) { .plot { font-size: 11px; } }
)css";
}

}  // namespace crankloop::report

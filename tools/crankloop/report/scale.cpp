#include "scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "text.hpp"

namespace crankloop::report {

namespace {

constexpr double kSmallest = 1e-200;  // a smaller range is drawn as zero

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
  // A span below 1e-9 of the value is rounding noise and drawn as constant.
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
  const int count = axis.bare ? -1 : static_cast<int>(last - first);
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
  if (!given) {  // round out to 1, 2 or 5 times a power of ten; a constant gets the decade around it
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

}  // namespace

Scale make_scale(const Axis& axis, Range data, int intervals) {
  return axis.logarithmic ? logarithmic_scale(axis, data) : linear_scale(axis, data, std::max(1, intervals));
}

bool drawable(double value, const Axis& axis) {
  return std::isfinite(value) && std::abs(value) < kLargest && (!axis.logarithmic || value > kSmallest);
}

double Mapping::operator()(double value) const {
  const double low = logarithmic ? std::log10(range.low) : range.low;
  const double high = logarithmic ? std::log10(range.high) : range.high;
  const double at = ((logarithmic ? std::log10(value) : value) - low) / (high - low);
  return std::clamp(from + at * (to - from), -1e5, 1e5);  // a value far outside a given range keeps its direction
}

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

std::string with_unit(const std::string& title, const std::string& unit, int exponent) {
  std::string scaled = exponent == 0 ? unit : power_of_ten(exponent) + (unit.empty() ? "" : "\u00A0" + unit);
  if (title.empty() || scaled.empty()) return title + scaled;
  return title + ", " + scaled;
}

}  // namespace crankloop::report

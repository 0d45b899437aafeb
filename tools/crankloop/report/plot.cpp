#include "plot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drawing.hpp"

namespace crankloop::report {

Drawn Drawing::draw() {
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

}  // namespace crankloop::report

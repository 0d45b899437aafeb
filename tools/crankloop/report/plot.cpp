#include "plot.hpp"

#include <algorithm>
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
  if (plot_.names_at_ends) {
    place_ends();
    write();
    return {std::move(out_), kWidth, height_};
  }
  // Names beside the curves are better than a legend, but only few names fit there.
  if (named > 1 && (bars || plot_.series.size() > 6 || !place_names())) {
    make_layout(true);
    place_markers();
  }
  write();
  return {std::move(out_), kWidth, height_};
}

void count_from(Plot& plot, double zero, const std::string& name, int colour) {
  Series line{name, {kLargest, -kLargest}, {0, 0}, {}};
  line.style.colour = colour;
  line.style.dashed = true;
  for (Series& series : plot.series) {
    for (double& y : series.y) y -= zero;
    for (const double x : series.x) line.x = {std::min(line.x[0], x), std::max(line.x[1], x)};
  }
  for (Marker& marker : plot.markers) marker.y -= zero;
  plot.series.push_back(std::move(line));
}

std::string to_svg(const Plot& plot) { return Drawing(plot, false).draw().svg; }

Drawn draw(const Plot& plot) { return Drawing(plot, true).draw(); }

}  // namespace crankloop::report

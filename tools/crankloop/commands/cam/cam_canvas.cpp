#include "cam_canvas.hpp"

#include <algorithm>
#include <cmath>

#include "../../files/units.hpp"
#include "../../report/text.hpp"

namespace crankloop::program {
namespace {

using report::coordinate;
using report::number_text;

constexpr double kWidth = 1080;  // of the picture, as wide as two columns of plots
constexpr double kFigure = 700;  // of the drawing, left of its figures
constexpr double kHeight = 640;
constexpr double kBorder = 30;

double cross_product(const Place& a, const Place& b) { return a.x * b.y - a.y * b.x; }

std::string scale_bar(double scale) {
  const double length_mm = scale * 10 < 220 ? 10 : 5;
  const std::string y = coordinate(kHeight - 12);
  return "<path class=\"bar-of-scale\" d=\"M12 " + coordinate(kHeight - 18) + "v12M12 " + y + "h" +
         coordinate(scale * length_mm) + "m0 -6v12\"/>\n<text class=\"mark\" x=\"" +
         coordinate(24 + scale * length_mm) + "\" y=\"" + coordinate(kHeight - 6) + "\">" + number_text(length_mm) +
         " mm</text>\n";
}

std::string figures_svg(const Figures& figures) {
  std::string svg;
  double y = 70;
  for (const auto& [name, value] : figures) {
    const auto text = [&](const char* what, double at, const std::string& content) {
      svg += std::string("<text class=\"") + what + "\" x=\"" + coordinate(kFigure + 60) + "\" y=\"" + coordinate(at) +
             "\">" + report::escape(content) + "</text>\n";
    };
    text("figure-name", y, name);
    text("figure-value", y + 21, value);
    y += 58;
  }
  return svg;
}

constexpr const char* kPictureStyle = R"css(
.mech path { fill: none; stroke: var(--ink); stroke-width: 1.5px; stroke-linejoin: round; stroke-linecap: round; }
.mech .cam { fill: var(--series-1); fill-opacity: 0.16; stroke: var(--series-1); stroke-width: 3px; }
.mech .edge { stroke: var(--axis); stroke-width: 3px; }
.mech .body { fill: var(--band); stroke: none; }
.mech .screw, .mech .stem { fill: var(--paper); stroke: var(--muted); }
.mech .pin { fill: var(--paper); stroke: var(--axis); }
.mech .outline { stroke: var(--series-2); stroke-width: 2.5px; }
.mech .rubbed { stroke: var(--series-2); stroke-width: 6px; stroke-linecap: butt; }
.mech .thin { stroke: var(--series-1); stroke-width: 1.25px; }
.mech .dashes { stroke-dasharray: 7 5; }
.mech .centre { stroke: var(--muted); stroke-width: 1px; stroke-dasharray: 12 3 2 3; }
.mech .lever { stroke: var(--muted); stroke-width: 1px; }
.mech .normal { stroke: var(--series-2); stroke-width: 1px; stroke-dasharray: 12 3 2 3; }
.mech .dot { fill: var(--series-1); stroke: none; }
.mech .contact { fill: var(--series-2); stroke: var(--paper); }
.mech .bar-of-scale { stroke: var(--ink); stroke-width: 1.5px; }
.mech text { font-variant-numeric: tabular-nums; }
.mech .mark {
  fill: var(--ink); font-size: 15px; stroke: var(--paper); stroke-width: 4px; stroke-linejoin: round;
  paint-order: stroke;
}
.mech .figure-name { fill: var(--muted); font-size: 15px; }
.mech .figure-value { fill: var(--ink); font-size: 17px; font-weight: 600; }
)css";

}  // namespace

Place toward(double length, double rad) { return {length * std::cos(rad), length * std::sin(rad)}; }
double direction(const Place& a) { return std::atan2(a.y, a.x); }
double length(const Place& a) { return std::hypot(a.x, a.y); }

void add_arc(Outline& outline, const Place& centre, double radius, double from_rad, double to_rad) {
  constexpr int kParts = 96;
  for (int i = 0; i <= kParts; ++i)
    outline.push_back(centre + toward(radius, from_rad + i * (to_rad - from_rad) / kParts));
}

/// Andrew's monotone chain.
Outline around(Outline points) {
  std::sort(points.begin(), points.end(),
            [](const Place& a, const Place& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  Outline hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Place& point : points) {
      while (hull.size() >= start + 2 && cross_product(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

void Canvas::circle(const char* what, const Place& centre, double radius) {
  Outline outline;
  add_arc(outline, centre, radius, 0, 2 * kPi);
  path(what, outline, true);
}

void Canvas::cross(const Place& at, double half) {
  line("centre", at - Place{half, 0}, at + Place{half, 0});
  line("centre", at - Place{0, half}, at + Place{0, half});
}

std::string Canvas::drawing() const {
  Place low{1e9, 1e9};
  Place high{-1e9, -1e9};
  for (const Path& path : paths_) {
    for (const Place& p : path.outline) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  }
  const double scale = std::min((kFigure - 2 * kBorder) / (high.x - low.x), (kHeight - 3 * kBorder) / (high.y - low.y));
  const double left = (kFigure - scale * (low.x + high.x)) / 2;
  const double top = (kHeight - kBorder + scale * (low.y + high.y)) / 2;
  const auto at = [&](const Place& p) { return coordinate(left + scale * p.x) + ' ' + coordinate(top - scale * p.y); };
  std::string svg;
  for (const Path& path : paths_) {
    svg += "<path class=\"" + path.what + "\" d=\"M";
    for (std::size_t i = 0; i < path.outline.size(); ++i)
      svg += (i == 1 ? "L" : i > 1 ? " " : "") + at(path.outline[i]);
    svg += path.closed ? "Z\"/>\n" : "\"/>\n";
  }
  for (const Label& label : labels_) {
    svg += "<text class=\"mark\" x=\"" + coordinate(left + scale * label.at.x + label.right) + "\" y=\"" +
           coordinate(top - scale * label.at.y + label.down) + "\"" + (label.right < 0 ? " text-anchor=\"end\"" : "") +
           ">" + report::escape(label.text) + "</text>\n";
  }
  return svg + scale_bar(scale);
}

report::Picture Canvas::picture(const Figures& figures) const {
  return {"<g class=\"mech\">\n" + drawing() + figures_svg(figures) + "</g>\n", kPictureStyle, kWidth, kHeight};
}

}  // namespace crankloop::program

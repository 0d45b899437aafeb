// A plot as inline SVG: curves, loops, steps, bars and heat maps over labelled axes, from plain numbers.
//
// What belongs here: the parts of a plot, and the colours of both themes, because a colour that is legible on paper is
// not on a dark screen. What does not: engines (the caller names every quantity and its unit), pages (page.hpp), files;
// how it is drawn (drawing.hpp), scales and ticks (scale.hpp), thinning of curves (thinning.hpp).
//
// A drawing is 520 user units wide and scales with its column, 330 px on a phone and about 550 px on a desk.
// plot_style() therefore sets the type between 19 units (12 px on that phone) and 13 (14 px); margins and label places
// are computed for the largest. Equal input gives equal bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scale.hpp"
#include "text.hpp"

namespace crankloop::report {

enum class Draw : std::uint8_t { line, step, bar, points, line_and_points };

struct Style {
  Draw draw = Draw::line;
  int colour = 0;  ///< 1 to kColours; 0 = by position in the plot, dashed from the (kColours + 1)th on
  int ramp = 0;    ///< 1 to kRamp: shade of one hue and dashes instead, for curves of a rising parameter
  bool bold = false;
  bool dashed = false;
  bool closed = false;  ///< joins the last point to the first: a loop
  bool filled = false;  ///< tints the inside of a loop, or the area between an open line and zero
};

inline constexpr int kColours = 6;
inline constexpr int kRamp = 7;

/// y over x in the caller's order; x need not be monotone. A point that is not finite breaks the line.
struct Series {
  std::string name{};
  std::vector<double> x{};
  std::vector<double> y{};  ///< surplus values of the longer vector are ignored
  Style style{};
};

/// A shaded interval of x with its name above it, e.g. a stroke.
struct Band {
  double from = 0;
  double to = 0;
  std::string label{};
};

/// A dot with a label, e.g. a peak and its value; in the colour of series number `series`.
struct Marker {
  double x = 0;
  double y = 0;
  std::string label{};
  std::size_t series = 0;
};

/// A quantity over a lattice of x and y: colours in at least kHeatSteps steps, contours with their values, a key.
struct Field {
  std::string name{};
  std::string unit{};
  std::vector<double> x{};  ///< ascending, two or more
  std::vector<double> y{};
  std::vector<double> values{};  ///< x by x, each with all y; values that are not finite stay blank
};

inline constexpr int kHeatSteps = 20;

/// A colour of the heat maps, "#440154": 0 the smallest value, 1 the largest; lighter is more, in either theme.
[[nodiscard]] std::string heat_colour(double part);

struct Plot {
  std::string id{};  ///< for links; page.hpp makes it valid and unique
  std::string title{};
  std::string caption{};  ///< page.hpp prints it below the drawing
  Axis x{};
  Axis y{};
  std::vector<Series> series{};
  std::vector<Band> bands{};
  std::vector<Marker> markers{};
  bool names_at_ends = false;  ///< each series' name where its line ends, for a family of curves; else see to_svg()
  bool equal_scales = false;   ///< a unit is equally long on both axes, whose ranges are given and may be widened
  Field field{};               ///< absent without values; below the series
};

[[nodiscard]] inline Axis axis_of(const std::string& title, const std::string& unit) {
  Axis axis;
  axis.title = title;
  axis.unit = unit;
  return axis;
}

[[nodiscard]] inline Plot plot_of(const std::string& title, const Axis& x, const Axis& y) {
  Plot plot;
  plot.title = title;
  plot.x = x;
  plot.y = y;
  return plot;
}

/// The <svg> element, with <title> and a <desc> that says each series' range. Two or more named series are labelled
/// beside their curves if every name fits nearer to its own curve than to others, else in a legend.
[[nodiscard]] std::string to_svg(const Plot& plot);

/// A drawing of fixed size, for one that encloses it: sheet.hpp.
struct Drawn {
  std::string svg{};
  double width = 0;
  double height = 0;
};
[[nodiscard]] Drawn draw(const Plot& plot);

/// CSS of the drawings and the colour variables of the light and dark theme; once per page.
[[nodiscard]] std::string_view plot_style();

/// Shifts a plot down by `zero` and draws a named dashed line at the new y = 0.
void count_from(Plot& plot, double zero, const std::string& name, int colour);

}  // namespace crankloop::report

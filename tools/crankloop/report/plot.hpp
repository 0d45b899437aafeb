// A plot as inline SVG: curves, loops, steps, bars over labelled axes, from plain numbers.
//
// What belongs here: scales and ticks, thinning of curves, placing of labels, and the colours of both themes, because a
// colour that is legible on paper is not on a dark screen. What does not: engines (the caller names every quantity and
// its unit), pages (page.hpp), files.
//
// A drawing is 520 user units wide and scales with its column, 330 px on a phone and about 550 px on a desk.
// plot_style() therefore sets the type between 17 units (11 px on that phone) and 13 (14 px); margins and label places
// are computed for the largest. Every number is printed by std::to_chars: the locale does not matter, and equal input
// gives equal bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace crankloop::report {

struct Range {
  double low = 0;
  double high = 0;
};

struct Axis {
  std::string title{};
  std::string unit{};            ///< printed behind the title: "Pressure, bar"
  bool logarithmic = false;      ///< values <= 0 are then missing values
  double tick_step = 0;          ///< e.g. 90 for crank degrees; 0 = chosen as 1, 2 or 5 times a power of ten
  bool include_zero = false;     ///< bars always include it
  std::optional<Range> range{};  ///< absent = the data, rounded out to whole ticks
};

enum class Draw : std::uint8_t { line, step, bar, points, line_and_points };

struct Style {
  Draw draw = Draw::line;
  int colour = 0;  ///< 1 to kColours; 0 = by position in the plot, dashed from the (kColours + 1)th on
  bool dashed = false;
  bool closed = false;  ///< joins the last point to the first: a loop
  bool filled = false;  ///< tints the inside of a loop, or the area between an open line and zero
};

inline constexpr int kColours = 6;

/// y over x in the caller's order; x need not be monotone. A point that is not finite breaks the line.
struct Series {
  std::string name{};
  std::vector<double> x{};
  std::vector<double> y{};  ///< if lengths differ, the surplus is ignored
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

struct Plot {
  std::string id{};  ///< for links; page.hpp makes it valid and unique
  std::string title{};
  std::string caption{};  ///< page.hpp prints it below the drawing
  Axis x{};
  Axis y{};
  std::vector<Series> series{};
  std::vector<Band> bands{};
  std::vector<Marker> markers{};
};

/// The <svg> element, with <title> and a <desc> that says each series' range. Two or more named series are labelled
/// beside their curves where every name finds a free place nearer to its own curve than to others, else in a legend.
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

/// Markers "78.3 bar at 8 deg" on the largest and the smallest y of a series (one if they are equal, none if it is
/// empty).
[[nodiscard]] std::vector<Marker> mark_extremes(const Plot& plot, std::size_t series, int significant_digits = 3);

// ---- Parts, each of use and tested by itself ----

/// A tick; a mark without a number has an empty label.
struct Tick {
  double value = 0;
  std::string label{};
};

struct Scale {
  Range range{};              ///< low < high, finite; positive if logarithmic
  std::vector<Tick> ticks{};  ///< ascending, inside the range
  int exponent = 0;           ///< labels show value / 10^exponent, and the axis title says so
};

/// A scale over `data` with about `intervals` steps. Ends on ticks unless axis.range says otherwise. Any data will do:
/// an empty or constant range is widened, a tick_step that would give over 60 ticks is ignored.
[[nodiscard]] Scale make_scale(const Axis& axis, Range data, int intervals);

struct Point {
  double x = 0;
  double y = 0;
};

/// A polyline with fewer points. The first and last point and the extremes of x and y stay, in order and unchanged;
/// every dropped point lies within 2 * tolerance of what is drawn. At most 4 points per `tolerance` of x remain for
/// each time the line passes there, however many there were. O(n log n) for curves, O(n^2) at worst.
///
/// First, of neighbours in one column of width `tolerance`, only the first, lowest, highest and last stay; then the
/// Douglas-Peucker algorithm drops what lies within `tolerance` of the chord.
[[nodiscard]] std::vector<Point> decimate(const std::vector<Point>& points, double tolerance);

/// Text for element content and quoted attributes. Control characters and bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string escape(std::string_view text);

/// A number for reading: true minus sign, thin spaces from 10 000 on, powers of ten outside 1e-4 to 1e9, a dash if not
/// finite. Integer digits are never rounded away.
[[nodiscard]] std::string format_number(double value, int significant_digits);

/// The same with so many decimals, whatever the size: for a column of a table, whose decimal points then stand in line.
[[nodiscard]] std::string format_fixed(double value, int decimals);

}  // namespace crankloop::report

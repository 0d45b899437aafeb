// Scales: from the range of data to an axis with ticks and their labels.
//
// What belongs here: the numbers on an axis, and the position of a value along it. What does not: lines (drawing.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
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
  bool bare = false;             ///< no ticks: for drawings that are not graphs
  std::optional<Range> range{};  ///< absent = the data, rounded out to whole ticks
};

/// A tick; a mark without a number has an empty label.
struct Tick {
  double value = 0;
  std::string label{};
};

struct Scale {
  Range range{};              ///< low < high, finite; positive if logarithmic
  std::vector<Tick> ticks{};  ///< ascending, inside the range
  int exponent = 0;           ///< labels show value / 10^exponent; the axis title contains it
};

/// A scale over `data` with about `intervals` steps. Ends on ticks unless axis.range says otherwise. Accepts any data:
/// an empty or constant range is widened, a tick_step that would give over 60 ticks is ignored.
[[nodiscard]] Scale make_scale(const Axis& axis, Range data, int intervals);

/// A value beyond this limit counts as missing, so that no difference or step overflows.
inline constexpr double kLargest = 1e200;

/// Whether the axis can show the value.
[[nodiscard]] bool drawable(double value, const Axis& axis);

/// The position of an axis value on the drawing.
struct Mapping {
  Range range;
  bool logarithmic;
  double from;
  double to;

  [[nodiscard]] double operator()(double value) const;
};

enum class Direction : std::uint8_t { across, up };

/// Leaves only every k-th label, with the smallest k at which labels do not touch.
void thin_labels(Scale& scale, const Mapping& map, Direction direction);

/// An axis title: "Force, 10^3 N".
[[nodiscard]] std::string with_unit(const std::string& title, const std::string& unit, int exponent);

}  // namespace crankloop::report

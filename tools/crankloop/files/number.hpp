// Numbers as text: one strict reader and three writers for files, options and CSV, independent of the locale.
//
// What belongs here: digits and ranges. What does not: which key or option a number belongs to.
#pragma once

#include <string>
#include <string_view>

#include <crankloop/define/range.hpp>

namespace crankloop::program {

/// "above 0, at most 2000 mm", "0 to 100", "0 to below 720 deg"; empty for a range without limits.
[[nodiscard]] std::string describe(const Range& range, std::string_view unit);

/// A number or the reason why the text is not one, e.g. "'9,5' is not a number (the decimal sign is a point)".
struct ParsedNumber {
  double value = 0;
  std::string problem;  ///< empty: value is a finite number

  [[nodiscard]] bool ok() const noexcept { return problem.empty(); }
};

/// Decimal notation only: [+-]digits[.digits][e[+-]digits]. No blanks, hex, inf or nan. "-0" is 0.
[[nodiscard]] ParsedNumber parse_number(std::string_view text);

/// Adds the range's refusal: "-95 is out of range: above 0, at most 2000 mm".
[[nodiscard]] ParsedNumber parse_number(std::string_view text, const Range& range, std::string_view unit);

/// The fewest digits that read back as the same double. Negative zero is written as 0, here and below.
[[nodiscard]] std::string shortest(double value);

/// Converts micrometres or microseconds to SI, correctly rounded: 0.1 gives the double 0.1e-6, where 0.1 / 1e6 and 0.1
/// * 1e-6 may be its neighbour. From 1e-4 to 1e9; outside it rounds twice.
[[nodiscard]] double millionths(double value);

/// 6 significant digits: for messages with a computed number.
[[nodiscard]] std::string brief(double value);

/// The place of the last of so many significant digits: 0.01 for 1.234 and 3.
[[nodiscard]] double last_place(double value, int digits);

/// Two significant digits: of what is approximate.
[[nodiscard]] double two_digits(double value);
[[nodiscard]] std::string about(double value);

/// 12 significant digits for double and 9 for float, as in CSV files.
[[nodiscard]] std::string significant(double value);
[[nodiscard]] std::string significant(float value);

}  // namespace crankloop::program

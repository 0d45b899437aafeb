// Text on drawings and pages: numbers for reading, escaping, widths.
//
// What belongs here: formatting and width of text. What does not: the numbers on an axis (scale.hpp), positions of text
// (drawing.hpp).
//
// Every number is printed by std::to_chars: the locale does not matter, and equal input gives equal bytes.
#pragma once

#include <string>
#include <string_view>

namespace crankloop::report {

/// Text for element content and quoted attributes. Control characters and bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string escape(std::string_view text);

/// A formatted number: true minus sign, thin spaces from 10 000 on, powers of ten outside 1e-4 to 1e9, a dash if not
/// finite. Integer digits are never rounded away.
[[nodiscard]] std::string format_number(double value, int significant_digits);

/// format_number() without needless zeros: "1.25".
[[nodiscard]] std::string number_text(double value, int significant_digits = 4);

/// A number with a fixed count of decimals, so that the decimal points of a table's column are aligned.
[[nodiscard]] std::string format_fixed(double value, int decimals);

// ---- for drawings ----

/// The largest font size in user units; margins and label positions are computed for it.
inline constexpr double kTypeSize = 19;

/// Width in user units at kTypeSize, by the widest of the usual system fonts (DejaVu Sans); others are up to a fifth
/// narrower.
[[nodiscard]] double text_width(std::string_view text);

/// Plain digits with a fixed count of decimals, never "-0".
[[nodiscard]] std::string fixed(double value, int decimals);

/// At most two decimals: a hundredth of a user unit is invisible.
[[nodiscard]] std::string coordinate(double value);

/// Drops zeros at the end of decimals, and a point that then ends the number.
void trim_zeros(std::string& text);

/// Digits as printed by fixed(), formatted for reading: U+2212 for minus, U+202F (narrow no-break space) between groups
/// of three.
[[nodiscard]] std::string typeset(const std::string& plain);

/// 10 with a raised exponent.
[[nodiscard]] std::string power_of_ten(int exponent);

}  // namespace crankloop::report

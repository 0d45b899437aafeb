#include "number.hpp"

#include <cmath>

#include "decimal.hpp"
#include "words.hpp"

namespace crankloop::program {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool starts_like_infinity_or_nan(std::string_view unsigned_text) {
  std::string lower;
  for (const char c : unsigned_text.substr(0, 3))
    lower += (c >= 'A' && c <= 'Z') ? static_cast<char>(c - 'A' + 'a') : c;
  return lower == "inf" || lower == "nan";
}

std::string why_not_a_number(std::string_view text, std::string_view rest) {
  if (text.empty()) return "the value is missing";
  const std::string what = in_quotes(text) + " is not a number";
  for (const char* no_break : {"\u00A0", "\u202F"}) {
    if (text.find(no_break) != std::string_view::npos)
      return what + " (it has a no-break space, which looks like a blank)";
  }
  if (rest.empty() || rest.size() == text.size()) return what;
  if (rest[0] == ',') return what + " (the decimal sign is a point)";
  if (rest[0] == 'x' || rest[0] == 'X') return what + " (hexadecimal is not accepted)";
  return what + " (" + in_quotes(trim(rest)) + " follows it; write the number alone, without a unit)";
}

/// The %g form; no "-0".
std::string rounded(double value, int digits) { return decimal::general(value == 0 ? 0 : value, digits); }

/// As people write it: 2147483647 and 1e9, where shortest() has 2.147483647e+09 and 1e+09.
std::string as_people_write(double value) {
  const std::string text = shortest(value);
  const std::size_t exponent = text.find("e+");
  if (exponent == std::string::npos) return text;
  if (text.find('.') == std::string::npos)
    return text.substr(0, exponent) + "e" + std::to_string(std::stoi(text.substr(exponent + 2)));
  return rounded(value, 15);
}

}  // namespace

std::string describe(const Range& range, std::string_view unit) {
  const bool has_least = std::isfinite(range.least);
  const bool has_most = std::isfinite(range.most);
  const std::string least = (range.without_least ? "above "
                             : has_most          ? ""
                                                 : "at least ") +
                            as_people_write(range.least);
  const std::string joint = !has_least || range.without_least ? (range.without_most ? "below " : "at most ")
                                                              : (range.without_most ? "to below " : "to ");
  std::string words;
  if (has_least) words += least;
  if (has_most) words += (!has_least ? "" : range.without_least ? ", " : " ") + joint + as_people_write(range.most);
  if (!words.empty() && !unit.empty()) words.append(" ").append(unit);
  return words;
}

ParsedNumber parse_number(std::string_view text) {
  const bool has_sign = !text.empty() && (text[0] == '+' || text[0] == '-');
  const std::string_view digits = has_sign ? text.substr(1) : text;
  if (starts_like_infinity_or_nan(digits)) return {0, in_quotes(text) + " is not a finite number"};
  if (digits.empty() || !(is_digit(digits[0]) || digits[0] == '.')) return {0, why_not_a_number(text, text)};

  const decimal::Read read = decimal::read(digits);  // knows no sign
  const std::string_view left = digits.substr(read.size);
  if (read.size == 0 || !left.empty()) return {0, why_not_a_number(text, left)};
  if (read.out_of_range) {
    return {0, in_quotes(text) + " is too large or too small for a number (about 1e-308 to 1e308)"};
  }
  return {text[0] == '-' && read.value != 0 ? -read.value : read.value, ""};
}

ParsedNumber parse_number(std::string_view text, const Range& range, std::string_view unit) {
  ParsedNumber number = parse_number(text);
  if (number.ok() && !range.contains(number.value)) {
    number.problem = as_people_write(number.value) + " is out of range; allowed: " + describe(range, unit);
  }
  return number;
}

std::string shortest(double value) {
  const double size = std::abs(value);
  const bool reads_best_plain = value == 0 || (size >= 1e-4 && size < 1e9);  // 100000, not 1e+05
  if (value == 0) value = 0;
  return reads_best_plain ? decimal::shortest_plain(value) : decimal::shortest_with_exponent(value);
}

double millionths(double value) {
  const std::string digits = shortest(value);
  return digits.find('e') == std::string::npos ? parse_number(digits + "e-6").value : value / 1e6;
}

std::string brief(double value) { return rounded(value, 6); }

double last_place(double value, int digits) {
  double least = 1;
  for (int digit = 1; digit < digits; ++digit) least *= 10;
  const double size = std::abs(value);
  double place = 1;  // not by pow(), which would make an FMU require a newer glibc
  while (place < 1e290 && place * least * 10 <= size) place *= 10;
  while (place > 1e-290 && place * least > size) place /= 10;
  return place;
}

double two_digits(double value) {
  const double place = last_place(value, 2);
  return std::round(value / place) * place;
}

std::string about(double value) { return brief(two_digits(value)); }
std::string significant(double value) { return rounded(value, 12); }
std::string significant(float value) { return rounded(static_cast<double>(value), 9); }

}  // namespace crankloop::program

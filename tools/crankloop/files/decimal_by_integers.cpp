// By exact decimal expansions, which are rounded and compared as texts: slow, and short enough to be seen right.
#include "decimal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace crankloop::program::decimal::by_integers {
namespace {

// ---- exact digits
// ----------------------------------------------------------------------------------------------------

/// 0.DIGITS * 10^point, the first digit not '0'; no digits: zero.
struct Digits {
  std::string digits;
  int point = 0;
};

void trim(Digits& number) { number.digits.erase(number.digits.find_last_not_of('0') + 1); }

/// A whole number of any size, nine decimal digits in a word, the lowest word first.
class BigNumber {
 public:
  explicit BigNumber(std::uint64_t value) {
    for (; value > 0; value /= kBase) words_.push_back(static_cast<std::uint32_t>(value % kBase));
  }

  void multiply(std::uint32_t factor) {
    std::uint64_t carry = 0;
    for (std::uint32_t& word : words_) {
      carry += std::uint64_t{word} * factor;
      word = static_cast<std::uint32_t>(carry % kBase);
      carry /= kBase;
    }
    if (carry > 0) words_.push_back(static_cast<std::uint32_t>(carry));
  }

  /// Times base^exponent, in steps of `at_once`, whose power is below 10^9: the carry then is one word.
  void multiply_by_power(std::uint32_t base, int exponent, int at_once) {
    std::uint32_t step = 1;
    for (int i = 0; i < at_once; ++i) step *= base;
    for (; exponent >= at_once; exponent -= at_once) multiply(step);
    for (; exponent > 0; --exponent) multiply(base);
  }

  [[nodiscard]] std::string digits() const {
    std::string text = words_.empty() ? "" : std::to_string(words_.back());
    for (std::size_t i = words_.size(); i-- > 1;) {
      const std::string nine = std::to_string(words_[i - 1]);
      text.append(9 - nine.size(), '0').append(nine);
    }
    return text;
  }

 private:
  static constexpr std::uint32_t kBase = 1'000'000'000;
  std::vector<std::uint32_t> words_;
};

/// whole * 2^exponent: of a negative exponent whole * 5^-exponent, with the point moved.
Digits exact(std::uint64_t whole, int exponent) {
  const int even = whole == 0 ? 0 : [&] {  // factors of 2 that need no digit
    int zeros = 0;
    while (((whole >> zeros) & 1) == 0) ++zeros;
    return std::max(0, std::min(zeros, -exponent));
  }();
  BigNumber number(whole >> even);
  exponent += even;
  if (exponent >= 0) {
    number.multiply_by_power(2, exponent, 29);
  } else {
    number.multiply_by_power(5, -exponent, 12);
  }
  Digits result{number.digits(), 0};
  result.point = static_cast<int>(result.digits.size()) + std::min(0, exponent);
  trim(result);
  return result;
}

/// Adds one in the last place.
void increase(Digits& number) {
  std::size_t i = number.digits.size();
  while (i > 0 && number.digits[i - 1] == '9') number.digits[--i] = '0';
  if (i > 0) {
    ++number.digits[i - 1];
    return;
  }
  number.digits.insert(0, 1, '1');
  number.digits.pop_back();
  ++number.point;
}

/// Rounded to so many digits, half to even; of less than one digit zero or a one above the place.
Digits rounded(const Digits& number, int keep) {
  if (keep < 0 || number.digits.empty()) return {};
  const auto kept = static_cast<std::size_t>(keep);
  if (kept >= number.digits.size()) return number;
  const char next = number.digits[kept];
  const bool is_half = next == '5' && kept + 1 == number.digits.size();
  const bool is_odd = kept > 0 && (number.digits[kept - 1] - '0') % 2 != 0;
  const bool up = is_half ? is_odd : next >= '5';
  if (kept == 0) return up ? Digits{"1", number.point + 1} : Digits{};
  Digits result{number.digits.substr(0, kept), number.point};
  if (up) increase(result);
  trim(result);
  return result;
}

/// Sign of a - b.
int compare(const Digits& a, const Digits& b) {
  if (a.digits.empty() || b.digits.empty())
    return static_cast<int>(b.digits.empty()) - static_cast<int>(a.digits.empty());
  if (a.point != b.point) return a.point < b.point ? -1 : 1;
  const int order = a.digits.compare(b.digits);  // without zeros at their ends the longer one is larger
  return order < 0 ? -1 : order > 0 ? 1 : 0;
}

// ---- the double
// ------------------------------------------------------------------------------------------------------

/// whole * 2^exponent, and whether the next double below is only half as far as the next above.
struct Parts {
  std::uint64_t whole;
  int exponent;
  bool is_power_of_two;
};

constexpr int kLeastExponent = -1074;

std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

Parts parts_of(double magnitude) {
  const std::uint64_t bits = bits_of(magnitude);
  const auto field = static_cast<int>(bits >> 52 & 0x7FF);
  const std::uint64_t fraction = bits & 0xF'FFFF'FFFF'FFFF;
  if (field == 0) return {fraction, kLeastExponent, false};
  return {fraction | std::uint64_t{1} << 52, field - 1 + kLeastExponent, fraction == 0 && field > 1};
}

Digits exact(double magnitude) {
  const Parts parts = parts_of(magnitude);
  return exact(parts.whole, parts.exponent);
}

/// Halfway to the next double above; of the largest, halfway to where the next one would be.
Digits middle_above(double magnitude) {
  const Parts parts = parts_of(magnitude);
  return exact(2 * parts.whole + 1, parts.exponent - 1);
}
/// Halfway to the next double below; magnitude is not 0.
Digits middle_below(double magnitude) {
  const Parts parts = parts_of(magnitude);
  return parts.is_power_of_two ? exact(4 * parts.whole - 1, parts.exponent - 2)
                               : exact(2 * parts.whole - 1, parts.exponent - 1);
}
bool is_even(double magnitude) { return bits_of(magnitude) % 2 == 0; }

/// The nearest number of `keep` digits on one side: `number` cut off there, or that and one in its last place.
Digits beside(const Digits& number, std::size_t keep, bool above) {
  Digits result{number.digits.substr(0, keep), number.point};
  if (above) increase(result);
  trim(result);
  return result;
}

/// The fewest digits of any number that reads back as this double, and of those the nearest.
Digits shortest(double magnitude) {
  if (magnitude == 0) return {};
  const Digits value = exact(magnitude), low = middle_below(magnitude), high = middle_above(magnitude);
  const int border = is_even(magnitude) ? 0 : -1;  // the middle itself reads as the even one of its neighbours
  const auto reads_back = [&](const Digits& candidate) {
    return compare(low, candidate) <= border && compare(candidate, high) <= border;
  };
  for (std::size_t keep = 1; keep < value.digits.size(); ++keep) {
    const Digits nearest = rounded(value, static_cast<int>(keep));
    if (reads_back(nearest)) return nearest;
    for (const bool above : {false, true}) {  // below a power of two there is less room: the farther side may do
      const Digits candidate = beside(value, keep, above);
      if (reads_back(candidate)) return candidate;
    }
  }
  return value;
}

// ---- writing
// ---------------------------------------------------------------------------------------------------------

std::string sign_of(double value) { return std::signbit(value) ? "-" : ""; }

std::string not_finite(double value) { return sign_of(value) + (std::isnan(value) ? "nan" : "inf"); }

/// With so many decimals; the digits end before the last of them.
std::string plain(const Digits& number, int decimals) {
  std::string text = number.digits;
  int point = number.digits.empty() ? 0 : number.point;
  if (point <= 0) {
    text.insert(0, static_cast<std::size_t>(1 - point), '0');
    point = 1;
  }
  text.resize(std::max(text.size(), static_cast<std::size_t>(point)), '0');
  text.resize(static_cast<std::size_t>(point + decimals), '0');
  if (decimals > 0) text.insert(static_cast<std::size_t>(point), 1, '.');
  return text;
}

std::string exponent_text(int exponent) {
  const std::string size = std::to_string(std::abs(exponent));
  return std::string(exponent < 0 ? "e-" : "e+") + (size.size() < 2 ? "0" : "") + size;
}

int exponent_of(const Digits& number) { return number.digits.empty() ? 0 : number.point - 1; }

std::string scientific(Digits number, int decimals) {
  const int exponent = exponent_of(number);
  number.point = 1;
  return plain(number, decimals) + exponent_text(exponent);
}

int decimals_of(const Digits& number) { return std::max(0, static_cast<int>(number.digits.size()) - number.point); }

// ---- reading
// ---------------------------------------------------------------------------------------------------------

constexpr double kPowersOfTen[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr int kLargestPower = 22;         // 5^22 has 52 bits: exact
constexpr std::size_t kExactDigits = 15;  // 10^15 is below 2^53
constexpr int kFarthestPoint = 400;       // beyond it every double is 0 or infinite

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The text's digits without zeros before and behind; size: of the number's characters, 0 where there is none.
struct Scanned {
  Digits number;
  std::size_t size = 0;
};

/// The exponent's value from its characters, within what matters, and how many they are; 0: none.
std::size_t scan_exponent(std::string_view text, int& exponent) {
  if (text.empty() || (text[0] != 'e' && text[0] != 'E')) return 0;
  std::size_t i = 1;
  const bool is_negative = i < text.size() && text[i] == '-';
  if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
  const std::size_t first = i;
  int size = 0;
  for (; i < text.size() && is_digit(text[i]); ++i) size = std::min(100'000'000, size * 10 + (text[i] - '0'));
  if (i == first) return 0;
  exponent = is_negative ? -size : size;
  return i;
}

Scanned scan(std::string_view text) {
  Scanned scanned;
  std::string& digits = scanned.number.digits;
  std::size_t i = 0;
  bool any = false, after_point = false;
  int point = 0;
  for (; i < text.size() && (is_digit(text[i]) || (text[i] == '.' && !after_point)); ++i) {
    if (text[i] == '.') {
      after_point = true;
      continue;
    }
    any = true;
    const bool counts = !digits.empty() || text[i] != '0';
    if (counts) digits += text[i];
    if (counts && !after_point) ++point;
    if (!counts && after_point) --point;
  }
  if (!any) return {};
  int exponent = 0;
  i += scan_exponent(text.substr(i), exponent);
  scanned.number.point = point + exponent;
  trim(scanned.number);
  scanned.size = i;
  return scanned;
}

std::uint64_t leading(const Digits& number, std::size_t most) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < std::min(most, number.digits.size()); ++i)
    value = value * 10 + static_cast<std::uint64_t>(number.digits[i] - '0');
  return value;
}

/// value * 10^exponent, exactly where both are exact; else within a few units of the last place.
double scaled(double value, int exponent) {
  for (; exponent > kLargestPower; exponent -= kLargestPower) value *= kPowersOfTen[kLargestPower];
  if (exponent >= 0) return value * kPowersOfTen[exponent];
  const int rest = -exponent % kLargestPower;
  value /= kPowersOfTen[rest];  // the rest first: only the last step may come to numbers of fewer bits
  for (exponent += rest; exponent < 0; exponent += kLargestPower) value /= kPowersOfTen[kLargestPower];
  return value;
}

double next_above(double magnitude) {
  const std::uint64_t bits = bits_of(magnitude) + 1;
  double next = 0;
  std::memcpy(&next, &bits, sizeof next);
  return next;
}
double next_below(double magnitude) {
  const std::uint64_t bits = bits_of(magnitude) - 1;
  double next = 0;
  std::memcpy(&next, &bits, sizeof next);
  return next;
}

/// The double nearest to the digits.
double nearest(const Digits& number) {
  const std::size_t size = number.digits.size();
  const int exponent = number.point - static_cast<int>(std::min<std::size_t>(size, 19));
  if (size <= kExactDigits && std::abs(exponent) <= kLargestPower)
    return scaled(static_cast<double>(leading(number, size)), exponent);  // one rounding, the last
  constexpr double kLargest = std::numeric_limits<double>::max();
  double guess = std::min(kLargest, scaled(static_cast<double>(leading(number, 19)), exponent));
  while (guess > 0) {
    const int beyond = compare(middle_below(guess), number);
    if (beyond < 0 || (beyond == 0 && is_even(guess))) break;
    guess = next_below(guess);
  }
  while (std::isfinite(guess)) {
    const int beyond = compare(number, middle_above(guess));
    if (beyond < 0 || (beyond == 0 && is_even(guess))) break;
    guess = next_above(guess);  // of the largest: infinity
  }
  return guess;
}

}  // namespace

Read read(std::string_view text) {
  const Scanned scanned = scan(text);
  if (scanned.number.digits.empty()) return {scanned.size, 0, false};
  const int point = scanned.number.point;
  const double value = point > kFarthestPoint    ? std::numeric_limits<double>::infinity()
                       : point < -kFarthestPoint ? 0
                                                 : nearest(scanned.number);
  return {scanned.size, value, value == 0 || !std::isfinite(value)};
}

std::string shortest_plain(double value) {
  if (!std::isfinite(value)) return not_finite(value);
  const Digits number = shortest(std::fabs(value));
  return sign_of(value) + plain(number, number.digits.empty() ? 0 : decimals_of(number));
}

std::string shortest_with_exponent(double value) {
  if (!std::isfinite(value)) return not_finite(value);
  const Digits number = shortest(std::fabs(value));
  return sign_of(value) + scientific(number, std::max(0, static_cast<int>(number.digits.size()) - 1));
}

std::string general(double value, int digits) {
  if (!std::isfinite(value)) return not_finite(value);
  const Digits number = rounded(exact(std::fabs(value)), digits);
  const int exponent = exponent_of(number);
  if (exponent < -4 || exponent >= digits)
    return sign_of(value) + scientific(number, std::max(0, static_cast<int>(number.digits.size()) - 1));
  return sign_of(value) + plain(number, number.digits.empty() ? 0 : decimals_of(number));
}

}  // namespace crankloop::program::decimal::by_integers

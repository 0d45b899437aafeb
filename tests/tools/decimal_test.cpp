// Numbers as digits and back by integers, against the C++ library's <charconv>: an independent hand (Ryu and
// fast_float).
#include "crankloop/files/decimal.hpp"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <system_error>

#if defined(__cpp_lib_to_chars)

namespace crankloop::program::decimal::decimal_test {
namespace {

/// 16 000 values are a quarter of a second; CRANKLOOP_LONG_TESTS=1 takes four million.
const int kValues = std::getenv("CRANKLOOP_LONG_TESTS") == nullptr ? 16'000 : 4'000'000;

template <class... Format>
std::string by_library(double value, Format... format) {
  char text[1600];
  return {text, std::to_chars(text, text + sizeof text, value, format...).ptr};
}

void expect_same_reading(const std::string& text) {
  double value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::general);
  const Read read = by_integers::read(text);
  const bool is_number = error != std::errc::invalid_argument;
  ASSERT_EQ(read.size, is_number ? static_cast<std::size_t>(rest - text.data()) : 0) << text;
  if (!is_number) return;
  ASSERT_EQ(read.out_of_range, error == std::errc::result_out_of_range || !std::isfinite(value)) << text;
  if (!read.out_of_range) {
    ASSERT_EQ(std::memcmp(&read.value, &value, sizeof value), 0) << text;
  }
}

/// In turn: any bits, powers of two from the smallest on, few binary digits, few decimal digits.
class Doubles {
 public:
  double next() {
    for (;;) {
      const std::uint64_t bits = random_();
      double value = 0;
      switch (turn_++ % 4) {
        case 0:
          std::memcpy(&value, &bits, sizeof value);
          break;
        case 1:
          value = std::ldexp(1.0, static_cast<int>(bits % 2098) - 1074);
          break;
        case 2:
          value = std::ldexp(static_cast<double>(static_cast<std::int64_t>(bits) >> 12), -static_cast<int>(bits % 90));
          break;
        default:
          value = static_cast<double>(bits >> 44) / std::pow(10.0, static_cast<double>(bits % 9));
      }
      if (std::isfinite(value)) return value;
    }
  }
  int below(int limit) { return static_cast<int>(random_() % static_cast<std::uint64_t>(limit)); }

 private:
  std::mt19937_64 random_{20261126};
  unsigned turn_ = 0;
};

TEST(DecimalByIntegers, WritesTheDigitsOfTheLibrary) {
  Doubles doubles;
  for (int i = 0; i < kValues; ++i) {
    const double value = doubles.next();
    const double size = std::fabs(value);
    const int digits = 1 + doubles.below(17);
    ASSERT_EQ(by_integers::shortest_with_exponent(value), by_library(value, std::chars_format::scientific));
    ASSERT_EQ(by_integers::general(value, digits), by_library(value, std::chars_format::general, digits)) << digits;
    if (size == 0 || (size >= 1e-20 && size < 1e15)) {
      ASSERT_EQ(by_integers::shortest_plain(value), by_library(value, std::chars_format::fixed));
    }
  }
}

TEST(DecimalByIntegers, ReadsTheDoublesOfTheLibrary) {
  Doubles doubles;
  for (int i = 0; i < kValues; ++i) {
    const double value = std::fabs(doubles.next());
    expect_same_reading(by_library(value));
    expect_same_reading(by_library(value, std::chars_format::scientific, doubles.below(25)));
  }
}

TEST(DecimalByIntegers, ReadsTheMiddleOfTwoDoublesAsTheEvenOne) {
  Doubles doubles;
  for (int i = 0; i < kValues / 40; ++i) {
    const double value = std::fabs(doubles.next()) / 4;
    const double next = std::nextafter(value, std::numeric_limits<double>::infinity());
    if (value < 1e-290) continue;  // where a double of half the last place exists
    const double half = (next - value) / 2;
    // value + half exactly, by adding their digits
    std::string middle = by_library(value, std::chars_format::fixed, 1100);
    const std::string added = by_library(half, std::chars_format::fixed, 1100);
    int carry = 0;
    for (std::size_t k = 1; k <= middle.size(); ++k) {
      char& digit = middle[middle.size() - k];
      if (digit == '.') continue;
      const int sum = digit - '0' + (k <= added.size() ? added[added.size() - k] - '0' : 0) + carry;
      digit = static_cast<char>('0' + sum % 10), carry = sum / 10;
    }
    expect_same_reading(middle);
    expect_same_reading(middle + "000000000000000000001");
  }
}

TEST(DecimalByIntegers, KnowsTheBordersOfANumber) {
  for (const char* text : {"0",
                           "0.0",
                           "1",
                           "1.",
                           ".5",
                           ".",
                           "",
                           "x",
                           "e5",
                           "1.5e",
                           "1.5e+",
                           "1.5e-3x",
                           "1E5",
                           "5.e1",
                           "00012.50",
                           "1..2",
                           "1e400",
                           "1e-400",
                           "0e999999999999",
                           "1e-99999999999999999999",
                           "1e99999999999999999999",
                           "4.9e-324",
                           "2.4703282292062327e-324",
                           "2.4703282292062328e-324",
                           "1.7976931348623157e308",
                           "1.7976931348623158e308",
                           "1.7976931348623159e308",
                           "2.2250738585072011e-308",
                           "2.2250738585072014e-308",
                           "9007199254740993",
                           "9007199254740992.5",
                           "0.000000000000000000000000001e27",
                           "123456789012345678901234567890"})
    expect_same_reading(text);
  for (const double value : {0.0, -0.0, 1.0, 9.5, 99.5, 0.5, 1e23, 5e-324, std::numeric_limits<double>::max()}) {
    EXPECT_EQ(by_integers::shortest_with_exponent(value), by_library(value, std::chars_format::scientific));
    EXPECT_EQ(by_integers::general(value, 1), by_library(value, std::chars_format::general, 1));
  }
  EXPECT_EQ(by_integers::general(-std::numeric_limits<double>::infinity(), 6), "-inf");
}

}  // namespace
}  // namespace crankloop::program::decimal::decimal_test

#endif

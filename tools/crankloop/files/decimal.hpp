// Doubles as decimal digits and back: the same digits and the same doubles on every host.
//
// What belongs here: what <charconv> does with double, also where the C++ library has none of it (libc++ 14 reads none,
// that of Emscripten 3.1.6 neither reads nor writes any). What does not: what the program takes for a number
// (number.hpp).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace crankloop::program::decimal {

/// What reading found: the characters of the number, 0 where the text does not begin with one, and its value.
struct Read {
  std::size_t size = 0;
  double value = 0;           ///< of no use where it is out of range
  bool out_of_range = false;  ///< too large for a double, or not 0 and nearer to 0 than to the smallest one
};

/// Reads digits[.digits][e[+-]digits], or with the point first; no sign before. The nearest double, the even one of
/// two.
[[nodiscard]] Read read(std::string_view text);

/// The fewest digits that read back as the same double, of those the nearest: plainly, "100000", "0.1", for magnitudes
/// from 1e-20 to 1e15; with an exponent, "1e+05", "1.5e-07", for any. What is not finite is "inf", "-nan", here and
/// below.
[[nodiscard]] std::string shortest_plain(double value);
[[nodiscard]] std::string shortest_with_exponent(double value);

/// As printf's %.*g, with 1 to 17 digits: of the exact value, the even digit of two.
[[nodiscard]] std::string general(double value, int digits);

/// The same by integers alone, whatever the library has.
namespace by_integers {

[[nodiscard]] Read read(std::string_view text);
[[nodiscard]] std::string shortest_plain(double value);
[[nodiscard]] std::string shortest_with_exponent(double value);
[[nodiscard]] std::string general(double value, int digits);

}  // namespace by_integers
}  // namespace crankloop::program::decimal

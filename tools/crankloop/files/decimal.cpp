#include "decimal.hpp"

#include <charconv>
#include <cmath>
#include <system_error>

namespace crankloop::program::decimal {

// What a library has of <charconv> for double is faster, and gives the same.
#if defined(__cpp_lib_to_chars)
namespace {

template <class... Format>
std::string written(double value, Format... format) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value, format...).ptr};
}

}  // namespace

Read read(std::string_view text) {
  Read found;
  const auto [rest, error] =
      std::from_chars(text.data(), text.data() + text.size(), found.value, std::chars_format::general);
  if (error != std::errc::invalid_argument) found.size = static_cast<std::size_t>(rest - text.data());
  found.out_of_range = error == std::errc::result_out_of_range || !std::isfinite(found.value);
  return found;
}
std::string shortest_plain(double value) { return written(value, std::chars_format::fixed); }
std::string shortest_with_exponent(double value) { return written(value, std::chars_format::scientific); }
std::string general(double value, int digits) { return written(value, std::chars_format::general, digits); }
#else
Read read(std::string_view text) { return by_integers::read(text); }
std::string shortest_plain(double value) { return by_integers::shortest_plain(value); }
std::string shortest_with_exponent(double value) { return by_integers::shortest_with_exponent(value); }
std::string general(double value, int digits) { return by_integers::general(value, digits); }
#endif

}  // namespace crankloop::program::decimal

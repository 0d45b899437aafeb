#include "text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace crankloop::report {

std::string fixed(double value, int decimals) {
  char buffer[400];  // 309 digits before the point at most
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals);
  std::string text(buffer, result.ptr);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

void trim_zeros(std::string& text) {
  if (text.find('.') == std::string::npos) return;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
}

std::string coordinate(double value) {
  std::string text = fixed(value, 2);
  trim_zeros(text);
  return text;
}

std::string typeset(const std::string& plain) {
  const std::size_t first = plain.front() == '-' ? 1 : 0;
  const std::size_t point = std::min(plain.find('.'), plain.size());
  const bool grouped = point - first > 4;
  std::string text = first == 1 ? "\u2212" : "";
  for (std::size_t i = first; i < plain.size(); ++i) {
    if (grouped && i > first && i < point && (point - i) % 3 == 0) text += "\u202F";
    text += plain[i];
  }
  return text;
}

std::string power_of_ten(int exponent) {
  static constexpr const char* kSuperscript[] = {"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                                                 "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = exponent < 0 ? "10\u207B" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) text += kSuperscript[digit - '0'];
  return text;
}

double text_width(std::string_view text) {
  double em = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80U) continue;  // inside a UTF-8 sequence
    if (std::string_view{" .,:;|!'()[]ijlfrt"}.find(c) != std::string_view::npos)
      em += 0.36;
    else if (std::string_view{"mwMW"}.find(c) != std::string_view::npos)
      em += 0.95;
    else if (c >= 'A' && c <= 'Z')
      em += 0.72;
    else
      em += 0.635;
  }
  return em * kTypeSize;
}

std::string escape(std::string_view text) {
  static constexpr std::string_view kReplacement = "\uFFFD";
  std::string safe;
  std::size_t i = 0;
  while (i < text.size()) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x80U) {
      ++i;
      switch (byte) {
        case '&':
          safe += "&amp;";
          break;
        case '<':
          safe += "&lt;";
          break;
        case '>':
          safe += "&gt;";
          break;
        case '"':
          safe += "&quot;";
          break;
        case '\'':
          safe += "&#39;";
          break;
        default:
          if (byte >= 0x20U && byte != 0x7FU)
            safe += static_cast<char>(byte);
          else if (byte == '\n' || byte == '\t')
            safe += ' ';
          else
            safe += kReplacement;
      }
      continue;
    }
    // A UTF-8 sequence, by the table of RFC 3629: the second byte's bounds refuse overlong forms, surrogates, >
    // U+10FFFF.
    const std::size_t length = byte >= 0xC2U && byte <= 0xDFU   ? 2
                               : (byte & 0xF0U) == 0xE0U        ? 3
                               : byte >= 0xF0U && byte <= 0xF4U ? 4
                                                                : 0;
    const unsigned low = byte == 0xE0U ? 0xA0U : byte == 0xF0U ? 0x90U : 0x80U;
    const unsigned high = byte == 0xEDU ? 0x9FU : byte == 0xF4U ? 0x8FU : 0xBFU;
    bool valid = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; valid && k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      valid = k == 1 ? next >= low && next <= high : (next & 0xC0U) == 0x80U;
    }
    if (valid)
      safe += text.substr(i, length);
    else
      safe += kReplacement;
    i += valid ? length : 1;
  }
  return safe;
}

std::string format_number(double value, int significant_digits) {
  if (!std::isfinite(value)) return "\u2013";
  if (value == 0) return "0";
  const int digits = std::clamp(significant_digits, 1, 17);
  char buffer[40];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific, digits - 1);
  const std::string scientific(buffer, result.ptr);
  const std::size_t e = scientific.find('e');
  const int exponent = std::atoi(scientific.c_str() + e + 1);
  if (exponent < -4 || exponent >= 9) return typeset(scientific.substr(0, e)) + "\u00B7" + power_of_ten(exponent);
  return typeset(fixed(value, std::max(0, digits - 1 - exponent)));
}

std::string number_text(double value, int significant_digits) {
  std::string text = format_number(value, significant_digits);
  if (text.find('.') == std::string::npos || text.find("\u00B7") != std::string::npos)
    return text;  // a power of ten follows
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string format_fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "\u2013";
  return typeset(fixed(value, std::clamp(decimals, 0, 17)));
}

}  // namespace crankloop::report

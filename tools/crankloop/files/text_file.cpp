#include "text_file.hpp"

#include <algorithm>
#include <string_view>

#include "error.hpp"

namespace crankloop::program {
namespace {

/// Length of the UTF-8 character at the start of `text`; 0 if there is none, and for overlong forms, surrogates and
/// control characters (C0 but tab, DEL, C1).
std::size_t character_length(std::string_view text) {
  const auto byte = [text](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto follows = [byte](std::size_t i) { return (byte(i) & 0xC0u) == 0x80u; };
  const unsigned first = byte(0);
  if (first < 0x80u) return (first >= 0x20u && first != 0x7Fu) || first == '\t' ? 1 : 0;
  if (!follows(1)) return 0;
  if (first >= 0xC2u && first <= 0xDFu) return first == 0xC2u && byte(1) < 0xA0u ? 0 : 2;
  if (!follows(2)) return 0;
  if (first >= 0xE0u && first <= 0xEFu) {
    const bool overlong = first == 0xE0u && byte(1) < 0xA0u;
    const bool surrogate = first == 0xEDu && byte(1) >= 0xA0u;
    return overlong || surrogate ? 0 : 3;
  }
  if (!follows(3) || first < 0xF0u || first > 0xF4u) return 0;
  const bool overlong = first == 0xF0u && byte(1) < 0x90u;
  const bool beyond = first == 0xF4u && byte(1) >= 0x90u;
  return overlong || beyond ? 0 : 4;
}

std::string why_not_text(std::string_view whole, std::string_view from_bad_byte) {
  const bool utf16 = whole.substr(0, 2) == "\xFF\xFE" || whole.substr(0, 2) == "\xFE\xFF";
  if (utf16) return "not a text file in UTF-8: it looks like UTF-16";
  constexpr const char* kDigits = "0123456789ABCDEF";
  const unsigned bad = static_cast<unsigned char>(from_bad_byte[0]);
  return std::string("not a text file: it has the byte 0x") + kDigits[bad >> 4] + kDigits[bad & 15u] +
         "; allowed are plain ASCII and UTF-8, with LF or CRLF at the end of a line";
}

}  // namespace

std::string printable(const std::string& name) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string shown;
  for (std::string_view left = name; !left.empty();) {
    const std::size_t length = left[0] == '\t' ? 0 : character_length(left);
    const auto byte = static_cast<unsigned char>(left[0]);
    shown += length > 0 ? std::string(left.substr(0, length))
                        : std::string("\\x") + kDigits[byte >> 4] + kDigits[byte & 15u];
    left.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return shown;
}

std::vector<std::string> split_lines(const std::string& bytes, const std::string& path) {
  std::string_view rest = bytes;
  if (rest.substr(0, 3) == "\xEF\xBB\xBF") rest.remove_prefix(3);
  std::vector<std::string> lines;
  while (!rest.empty()) {
    const auto end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.emplace_back(line);
    for (std::string_view left = line; !left.empty();) {
      const std::size_t length = character_length(left);
      if (length == 0) throw InputError(path, static_cast<int>(lines.size()), why_not_text(bytes, left));
      left.remove_prefix(length);
    }
  }
  return lines;
}

}  // namespace crankloop::program

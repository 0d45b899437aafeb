#include "json.hpp"

namespace crankloop::page {

Json& Json::value(std::string_view text) {
  separate();
  text_ += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      text_ += '\\';
      text_ += c;
    } else if (byte < 0x20) {
      constexpr const char* kDigits = "0123456789ABCDEF";
      text_ += "\\u00";
      text_ += kDigits[byte >> 4];
      text_ += kDigits[byte & 15u];
    } else {
      text_ += c;
    }
  }
  text_ += '"';
  return *this;
}

}  // namespace crankloop::page

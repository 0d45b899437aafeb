// Texts of JSON, written piece by piece.
//
// What belongs here: commas, quotes, numbers. What does not: what the texts say.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>

#include "crankloop/files/number.hpp"

namespace crankloop::page {

/// json.open('{').key("line").value(12).close('}'). Commas come by themselves.
class Json {
 public:
  Json& open(char bracket) {
    separate();
    text_ += bracket;
    is_first_ = true;
    return *this;
  }
  Json& close(char bracket) {
    text_ += bracket;
    is_first_ = false;
    return *this;
  }
  Json& key(std::string_view name) {
    value(name);
    text_ += ':';
    is_first_ = true;
    return *this;
  }

  Json& value(std::string_view text);
  Json& value(const char* text) { return value(std::string_view(text)); }
  Json& value(const std::string& text) { return value(std::string_view(text)); }
  template <class T, std::enable_if_t<std::is_arithmetic_v<T>, int> = 0>
  Json& value(T x) {
    separate();
    if constexpr (std::is_same_v<T, bool>) {
      text_ += x ? "true" : "false";
    } else if constexpr (std::is_integral_v<T>) {
      text_ += std::to_string(x);
    } else {
      text_ += std::isfinite(x) ? program::shortest(static_cast<double>(x)) : "null";
    }
    return *this;
  }
  template <class T>
  Json& member(std::string_view name, const T& x) {
    return key(name).value(x);
  }

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  void separate() {
    if (!is_first_) text_ += ',';
    is_first_ = false;
  }

  std::string text_;
  bool is_first_ = true;
};

}  // namespace crankloop::page

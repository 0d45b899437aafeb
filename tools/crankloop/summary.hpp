// The lines that a command prints: "name = value unit  # remark".
//
// What belongs here: their look. What does not: which figures a command has, and where they go (results.hpp).
#pragma once

#include <string>
#include <type_traits>

#include "number.hpp"

namespace crankloop::program {

class Summary {
 public:
  enum class Digits {
    six,  ///< enough to read, and none of float's noise
    all,  ///< as in CSV: 12 for double, 9 for float
  };
  explicit Summary(Digits digits = Digits::six) : digits_{digits} {}

  void remark(const std::string& text) { text_ += "# " + text + "\n"; }
  void line(const std::string& name, const std::string& value, const std::string& unit = "",
            const std::string& remark = "") {
    text_ += name + " = " + value + (unit.empty() ? "" : " " + unit) + (remark.empty() ? "" : "  # " + remark) + "\n";
  }
  template <class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
  void line(const std::string& name, Number value, const std::string& unit = "", const std::string& remark = "") {
    if constexpr (std::is_integral_v<Number>) {
      line(name, std::to_string(value), unit, remark);
    } else {
      line(name, digits_ == Digits::six ? brief(static_cast<double>(value)) : significant(value), unit, remark);
    }
  }
  void text(const std::string& more) { text_ += more; }  ///< whole lines of another form

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  Digits digits_;
  std::string text_;
};

}  // namespace crankloop::program

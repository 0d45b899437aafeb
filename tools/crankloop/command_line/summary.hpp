// The lines that a command prints: "name = value unit  # remark". Numbers have 6 digits, enough to read and none of
// float's noise, and the unit stands behind them alone, not in the name too.
//
// What belongs here: their look. What does not: which figures a command has, and where they go (results.hpp).
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>

#include <crankloop/faults.hpp>

#include "../files/number.hpp"

namespace crankloop::program {

class Summary {
 public:
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
      line(name, brief(static_cast<double>(value)), unit, remark);
    }
  }
  /// Ticks with a fault, and which faults those were.
  void faulty_ticks(std::uint64_t ticks, std::uint32_t faults) {
    line("faulty_ticks", ticks, "", faults == 0 ? "" : crankloop::describe(faults).text);
  }
  void text(const std::string& more) { text_ += more; }  ///< whole lines of another form

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
};

}  // namespace crankloop::program

// The lines that a command prints: "name = value unit  # remark". Numbers have 6 digits, enough to read and none of
// float's noise, and the unit stands behind them alone, not in the name too.
//
// What belongs here: their look. What does not: which figures a command has, and where they go (results.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <crankloop/faults.hpp>

#include "../files/number.hpp"

namespace crankloop::program {

/// What a line says, with all digits: for `study`.
struct Figure {
  std::string name;
  std::string unit;                ///< also of a figure that has no number here
  std::optional<double> number{};  ///< none: a word
  std::string word{};
};

class Summary {
 public:
  void remark(const std::string& text) { text_ += "# " + text + "\n"; }
  void line(const std::string& name, const std::string& value, const std::string& unit = "",
            const std::string& remark = "") {
    print(name, value, unit, remark);
    figures_.push_back({name, unit, {}, value});
  }
  /// A figure that has no number here, such as an onset that is not reached: "name = none".
  void none(const std::string& name, const std::string& unit, const std::string& remark = "") {
    print(name, "none", "", remark);
    figures_.push_back({name, unit, {}, "none"});
  }
  template <class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
  void line(const std::string& name, Number value, const std::string& unit = "", const std::string& remark = "") {
    if constexpr (std::is_integral_v<Number>) {
      print(name, std::to_string(value), unit, remark);
    } else {
      print(name, brief(static_cast<double>(value)), unit, remark);
    }
    figures_.push_back({name, unit, static_cast<double>(value)});
  }
  /// Ticks with a fault, and which faults those were.
  void faulty_ticks(std::uint64_t ticks, std::uint32_t faults) {
    line("faulty_ticks", ticks, "", faults == 0 ? "" : crankloop::describe(faults).text);
  }
  void text(const std::string& more) { text_ += more; }  ///< whole lines of another form

  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  [[nodiscard]] const std::vector<Figure>& figures() const noexcept { return figures_; }

 private:
  void print(const std::string& name, const std::string& value, const std::string& unit, const std::string& remark) {
    text_ += name + " = " + value + (unit.empty() ? "" : " " + unit) + (remark.empty() ? "" : "  # " + remark) + "\n";
  }

  std::string text_;
  std::vector<Figure> figures_;
};

}  // namespace crankloop::program

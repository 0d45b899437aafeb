// The lines that a run prints: "name = value unit".
//
// What belongs here: their look. What does not: which figures a run has (run.cpp, free_run.cpp).
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

#include "run/run_loop.hpp"

namespace crankloop::program {

/// Six significant digits: enough to read, and none of float's noise. CSV has all there are.
inline std::string six_digits(double value) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value == 0 ? 0 : value, std::chars_format::general, 6);
  return std::string(buffer, end.ptr);
}

/// Lines "name = value unit", and remarks after '#'.
class Summary {
 public:
  void remark(const std::string& text) { text_ += "# " + text + "\n"; }
  void line(const std::string& name, double value, const std::string& unit = "", const std::string& remark = "") {
    text_ += name + " = " + six_digits(value) + (unit.empty() ? "" : " " + unit) +
             (remark.empty() ? "" : "  # " + remark) + "\n";
  }
  void count(const std::string& name, std::uint64_t value, const std::string& remark = "") {
    text_ += name + " = " + std::to_string(value) + (remark.empty() ? "" : "  # " + remark) + "\n";
  }
  void peak(const std::string& name, Peak peak, double per_si, const std::string& unit) {
    line(name, peak.value * per_si, unit);
    line(name + "_at", std::round(peak.at_deg * 1e3) / 1e3, "deg");
  }
  void peaks(const std::string& name, const Peaks& peaks, double per_si, const std::string& unit) {
    peak("largest_" + name, peaks.largest, per_si, unit);
    peak("smallest_" + name, peaks.smallest, per_si, unit);
  }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
};

}  // namespace crankloop::program

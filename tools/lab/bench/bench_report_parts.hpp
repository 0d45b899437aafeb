// Parts of the benchmark's page.
//
// What belongs here: its sections, and how a row is written. What does not: the rows (row.hpp), the page
// (bench_report.cpp).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "crankloop/report/page.hpp"
#include "row.hpp"

namespace crankloop::program::bench {

using Rows = std::vector<Row>;

[[nodiscard]] report::Axis axis(const char* title, const char* unit, bool logarithmic);

[[nodiscard]] std::string digits(double value, int count = 3);

/// Rows are in ASCII; a page uses the typographic signs.
[[nodiscard]] std::string with_signs(std::string text);
[[nodiscard]] std::string error_text(const Row& row);

/// Median and half the distance between the quartiles.
[[nodiscard]] std::string time_text(const Row& row);

[[nodiscard]] bool starts_with(const std::string& text, const std::string& start);
[[nodiscard]] Rows where(const Rows& rows, const std::function<bool(const Row&)>& wanted);

// ---- run time against error: bench_report_precision.cpp

/// Piston motion, then one valve: a plot each of float and double.
[[nodiscard]] std::vector<report::Plot> precision_plots(const Rows& rows);
[[nodiscard]] report::Section kinematics_section(const Rows& rows);
[[nodiscard]] report::Section valve_section(const Rows& rows);

// ---- whole ticks: bench_report_ticks.cpp

[[nodiscard]] report::Section tick_section(const Rows& rows);
[[nodiscard]] report::Section growth_section(const Rows& rows);
[[nodiscard]] report::Section skip_section(const Rows& rows);

}  // namespace crankloop::program::bench

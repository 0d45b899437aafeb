// The groups of the benchmark. To add one: a file with a function that returns its rows, named here and called by
// bench.cpp.
#pragma once

#include <functional>
#include <vector>

#include "race.hpp"
#include "row.hpp"

namespace crankloop::program::bench {

/// Displacement, velocity and acceleration of a piston: formulas and tables.
[[nodiscard]] std::vector<Row> kinematics_rows(const Effort& effort);

/// Speeds of the 125's valve: six gentle contact changes a cycle; ten, hard, with hops on the seat; float and high
/// bounces.
inline constexpr double kSmooth_rpm = 2000;
inline constexpr double kSwitching_rpm = 7000;
inline constexpr double kBouncing_rpm = 12000;

/// One elastic valve: methods, step lengths, speeds.
[[nodiscard]] std::vector<Row> valve_rows(const Effort& effort);

/// Speeds of whole engines: ticks of 20 us divide their cycles evenly.
inline constexpr double kIdle_rpm = 800;
inline constexpr double kRated_rpm = 6000;
inline constexpr double kRedline_rpm = 7500;

/// Whole ticks of the library and of plain code, mean, median, 99.9 % and worst; engines of 1 to 12 cylinders with 0 to
/// 4 valves each.
[[nodiscard]] std::vector<Row> tick_rows(const Effort& effort);
/// The same engine in longer ticks: the cost of sub-steps.
[[nodiscard]] std::vector<Row> growth_rows(const Effort& effort);
/// The same engine with more and more outputs: the savings of leaving some out.
[[nodiscard]] std::vector<Row> skip_rows(const Effort& effort);

/// Number of races of all groups, for the progress display.
inline constexpr int kRaces = 9;

/// Ratios of the other contestants' times and errors to the library's, each with the library's error.
[[nodiscard]] std::vector<Row> ratio_rows(const std::vector<Row>& rows);

}  // namespace crankloop::program::bench

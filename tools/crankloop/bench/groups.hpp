// The groups of the benchmark. To add one: a file with a function that returns its rows, named here and called by bench.cpp.
#pragma once

#include <functional>
#include <vector>

#include "race.hpp"
#include "row.hpp"

namespace crankloop::program::bench {

/// Displacement, velocity and acceleration of a piston: formulas and tables.
[[nodiscard]] std::vector<Row> kinematics_rows(const Effort& effort);

/// Speeds of the 125's valve: six gentle contact changes a cycle; ten, hard, with hops on the seat; float and high bounces.
inline constexpr double kSmooth_rpm = 2000;
inline constexpr double kSwitching_rpm = 7000;
inline constexpr double kBouncing_rpm = 12000;

/// One elastic valve: methods, step lengths, speeds.
[[nodiscard]] std::vector<Row> valve_rows(const Effort& effort);

}  // namespace crankloop::program::bench

// The groups of the benchmark. To add one: a file with a function that returns its rows, named here and called by bench.cpp.
#pragma once

#include <functional>
#include <vector>

#include "race.hpp"
#include "row.hpp"

namespace crankloop::program::bench {

/// Displacement, velocity and acceleration of a piston: formulas and tables.
[[nodiscard]] std::vector<Row> kinematics_rows(const Effort& effort);

}  // namespace crankloop::program::bench

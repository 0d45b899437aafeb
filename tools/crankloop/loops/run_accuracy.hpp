// Error of the fixed-step loop against the exact engine, measured for one engine, speed and arithmetic.
//
// What belongs here: the comparison. What does not: accuracy that holds for every engine (docs/model.md "Tables", the
// tests).
#pragma once

#include <array>

#include <crankloop/tabulate/summary.hpp>

#include "run_loop.hpp"
#include "run_quantities.hpp"

namespace crankloop::program {

/// Largest difference of a quantity between loop and exact engine, SI.
struct Deviation {
  double largest = 0;
  double at_deg = 0;  ///< its crank angle: of the cylinder, for the engine's torque of the engine
  double peak = 0;    ///< largest magnitude of the exact quantity, to compare with

  void take(double loop, double exact, double deg) noexcept;
  [[nodiscard]] double ratio() const noexcept { return peak > 0 ? largest / peak : 0; }
};

struct Accuracy {
  int angles = 0;  ///< compared, per cylinder
  std::array<Deviation, kQuantities> of;
  Deviation torque;
};

/// The exact output of a step at an engine angle: kinematics, rod motion, forces, torque and crank pins of every
/// cylinder. Journals, free forces and mean torque are left zero.
[[nodiscard]] WholeOutput<double> exact_output(const ExactEngine& engine, double engine_deg, double speed_rad_s,
                                               double load_ratio);

/// Runs the loop for one cycle, about 0.09 deg apart at angles spread evenly over the fraction of a degree, so that
/// neither the best nor the worst points of the tables are favoured.
template <class Real>
Accuracy measure_accuracy(const ExactEngine& engine, const Operation& operation);

}  // namespace crankloop::program

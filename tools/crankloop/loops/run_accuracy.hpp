// How far the fixed-step loop is from the exact engine: measured for the engine, speed and arithmetic at hand.
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
  double at_deg = 0;  ///< where: the cylinder's own crank angle; of the engine's torque the engine angle
  double peak = 0;    ///< largest magnitude of the exact quantity, to compare with

  void take(double loop, double exact, double deg) noexcept;
  [[nodiscard]] double ratio() const noexcept { return peak > 0 ? largest / peak : 0; }
};

struct Accuracy {
  int angles = 0;  ///< compared, per cylinder
  std::array<Deviation, kQuantities> of;
  Deviation torque;
};

/// What a step's output should be at an engine angle: kinematics, rod motion, forces, torque and crank pins of every
/// cylinder. Journals, free forces and mean torque are left zero.
[[nodiscard]] WholeOutput<double> exact_output(const ExactEngine& engine, double engine_deg, double speed_rad_s,
                                               double load_ratio);

/// Runs the loop for one cycle, about 0.09 deg apart at angles that fall evenly on all parts of a degree, so that
/// neither the best nor the worst places of the tables are favoured.
template <class Real>
Accuracy measure_accuracy(const ExactEngine& engine, const Operation& operation);

}  // namespace crankloop::program

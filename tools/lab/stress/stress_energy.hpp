// Upper bound of the energy that a train can transfer to its valve; the stress test checks it.
//
// What belongs here: the bound and its terms. What does not: the check (stress_trial.cpp).
#pragma once

#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/valve_lift.hpp>

#include "../reference/valve_reference.hpp"
#include "crankloop/files/units.hpp"

namespace crankloop::program {

/// Extremes of a train's lift curve, sampled.
struct LiftFacts {
  double largest_m = 0;
  double fastest_per_rad_m = 0;
  double variation_per_rad_m = 0;  ///< total variation of the slope over a turn

  explicit LiftFacts(const ValveLift& lift) : largest_m{lift.largest_lift_m()} {
    double before = 0;
    for (int deg = -180; deg <= 180; ++deg) {
      const double slope = lift.at(deg * kRadPerDeg).per_rad_m;
      fastest_per_rad_m = std::max(fastest_per_rad_m, std::fabs(slope));
      variation_per_rad_m += std::fabs(slope - before);
      before = slope;
    }
  }
};

/// Compares sqrt(2 E / M) of a valve with the bound.
class EnergyBound {
 public:
  EnergyBound(const valve_reference::SingleMass& mass, const LiftFacts& lift, double cam_rad_s)
      : mass_{mass},
        fastest_m_s_{lift.fastest_per_rad_m * std::fabs(cam_rad_s)},
        turned_m_s_{lift.variation_per_rad_m * std::fabs(cam_rad_s)} {
    const double train_N = mass.P + mass.k_s * lift.largest_m;
    const double at_rest_J = energy_J(lift.largest_m, 0) + train_N * train_N / (2 * mass.k);
    allowed_m_s_ = std::sqrt(2 * at_rest_J / mass.M) + fastest_m_s_ + turned_m_s_;
  }

  void tick(double y_m, double v_m_s) { reached_J_ = std::max(reached_J_, energy_J(y_m, v_m_s)); }

  /// Call at the end of a cycle: true if it kept the bound.
  bool cycle(double contact_changes) {
    allowed_m_s_ += turned_m_s_ + 2 * fastest_m_s_ * contact_changes;
    return std::sqrt(2 * reached_J_ / mass_.M) <= 2 * allowed_m_s_;
  }

 private:
  /// Kinetic energy, spring and seat; 0 for the closed valve.
  [[nodiscard]] double energy_J(double y, double v) const {
    const double sink = std::max(0.0, mass_.delta - y);
    return mass_.M * v * v / 2 + mass_.k_s * y * y / 2 + mass_.P * y +
           mass_.k_z * (sink * sink - mass_.delta * mass_.delta) / 2;
  }

  const valve_reference::SingleMass& mass_;
  double fastest_m_s_;
  double turned_m_s_;
  double allowed_m_s_ = 0;
  double reached_J_ = 0;
};

}  // namespace crankloop::program

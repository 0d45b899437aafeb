// The ripple of a free engine's speed by theory: from the harmonics of its gas torque and its inertia.
//
// What belongs here: closed forms over one cycle. What does not: any tick.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/tabulate/summary.hpp>

#include "support/both_reals.hpp"
#include "support/status.hpp"
#include "support/tick_oracle.hpp"

namespace crankloop::tick_test {

/// Of all bodies, from the mechanism's geometry.
[[nodiscard]] inline long double kinetic_J(const EngineDefinition& engine, long double engine_deg,
                                           long double speed_rad_s) {
  long double inertia = static_cast<long double>(engine.masses.crank_inertia_kg_m2 + engine.machine.inertia_kg_m2);
  for (std::size_t k = 0; k < static_cast<std::size_t>(engine.layout.cylinders); ++k) {
    const OraclePose p = oracle_pose(engine.crank, (engine_deg - wide(engine.layout.firing_deg[k])) * kWidePi / 180);
    const Masses& m = engine.masses;
    inertia += wide(m.rod_big_end_kg) * wide(engine.crank.crank_radius_m) * wide(engine.crank.crank_radius_m) +
               wide(m.reciprocating_kg()) * p.slope_m * p.slope_m +
               wide(m.rod_inertia_correction_kg_m2) * p.rod_slope * p.rod_slope;
  }
  return inertia * speed_rad_s * speed_rad_s / 2;
}

/// What a cycle's speed, sampled over the crank angle, consists of.
struct Ripple {
  double mean_rad_s = 0;
  double irregularity_ratio = 0;    ///< (largest - smallest) / mean
  double amplitude_rad_s[13] = {};  ///< of order i / 2
};

/// Of values over a cycle in equal steps of angle.
[[nodiscard]] inline Ripple ripple_of(const std::vector<double>& over_cycle) {
  Ripple r;
  const auto n = static_cast<double>(over_cycle.size());
  const auto [least, most] = std::minmax_element(over_cycle.begin(), over_cycle.end());
  for (const double x : over_cycle) r.mean_rad_s += x / n;
  r.irregularity_ratio = (*most - *least) / r.mean_rad_s;
  for (int i = 1; i < 13; ++i) {
    double cosine = 0, sine = 0, at = 0;
    for (const double x : over_cycle) {
      cosine += 2 / n * x * std::cos(2 * kPi * i * at / n);
      sine += 2 / n * x * std::sin(2 * kPi * i * at / n);
      ++at;
    }
    r.amplitude_rad_s[i] = std::hypot(cosine, sine);
  }
  return r;
}

/// An engine whose load is its mean torque.
class RippleTheory {
 public:
  static constexpr int kSamples = 1440;  ///< of a cycle

  RippleTheory(const EngineDefinition& engine, double load_ratio, std::uint32_t cut_cylinders)
      : load_ratio_{load_ratio}, cut_{cut_cylinders} {
    EXPECT_TRUE(accepted(exact_.init(engine)));
    for (int i = 0; i < kSamples; ++i) gas_Nm_.push_back(gas_torque_Nm(720.0 * i / kSamples));
    for (const double torque : gas_Nm_) mean_gas_Nm_ += torque / kSamples;
  }

  [[nodiscard]] double mean_gas_Nm() const { return mean_gas_Nm_; }

  /// From the harmonics of the gas torque and the inertia: J_eff(A) w^2 / 2 is at A = 0 that of the speed given, and
  /// then grows by the harmonics' integral.
  [[nodiscard]] Ripple by_harmonics(double speed_rad_s) const {
    constexpr int kOrders = 240;  // half orders up to 120: the gas torque is smooth beyond
    double cosine[kOrders] = {}, sine[kOrders] = {};
    for (int i = 1; i < kOrders; ++i) {
      for (int s = 0; s < kSamples; ++s) {
        const double turn = 2 * kPi * i * s / kSamples;
        cosine[i] += 2.0 / kSamples * gas_Nm_[static_cast<std::size_t>(s)] * std::cos(turn);
        sine[i] += 2.0 / kSamples * gas_Nm_[static_cast<std::size_t>(s)] * std::sin(turn);
      }
    }
    std::vector<double> speeds;
    for (int s = 0; s < kSamples; ++s) {
      double energy_J = static_cast<double>(kinetic_J(exact_.definition(), 0, wide(speed_rad_s)));
      for (int i = 1; i < kOrders; ++i) {
        const double turn = 2 * kPi * i * s / kSamples;
        energy_J += (cosine[i] * std::sin(turn) + sine[i] * (1 - std::cos(turn))) / (i / 2.0);
      }
      speeds.push_back(
          std::sqrt(energy_J / static_cast<double>(kinetic_J(exact_.definition(), 720.0L * s / kSamples, 1))));
    }
    return ripple_of(speeds);
  }

  /// The rule of thumb: T_k / (J k w) of the torque of gas and masses at constant speed w, J the mean inertia.
  [[nodiscard]] Ripple by_rule_of_thumb(double speed_rad_s) const {
    std::vector<double> torques;
    double inertia = 0;
    for (int s = 0; s < kSamples; ++s) {
      const double deg = 720.0 * s / kSamples;
      const double masses_Nm = exact_.torque_Nm(deg, speed_rad_s, 0) - exact_.torque_Nm(deg, 0, 0);
      torques.push_back(gas_Nm_[static_cast<std::size_t>(s)] + masses_Nm);
      inertia += 2 * static_cast<double>(kinetic_J(exact_.definition(), wide(deg), 1)) / kSamples;
    }
    Ripple r = ripple_of(torques);
    for (int i = 1; i < 13; ++i) r.amplitude_rad_s[i] /= inertia * i / 2.0 * speed_rad_s;
    return r;
  }

 private:
  /// By cylinder: those that are cut are motored.
  [[nodiscard]] double gas_torque_Nm(double deg) const {
    double sum = 0;
    for (int k = 0; k < exact_.definition().layout.cylinders; ++k)
      sum += exact_.forces(k, deg, 0, (cut_ >> k & 1u) != 0 ? 0 : load_ratio_).torque_Nm;
    return sum;
  }

  ExactEngine exact_;
  double load_ratio_;
  std::uint32_t cut_;
  std::vector<double> gas_Nm_;
  double mean_gas_Nm_ = 0;
};

}  // namespace crankloop::tick_test

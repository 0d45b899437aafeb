// An output's numbers in a row, group by group, so that tests compare the bits of different scenes.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <crankloop/output.hpp>

#include "support/running.hpp"

namespace crankloop::tick_test {

/// How much of an output's arrays is in use.
struct InUse {
  std::size_t cylinders;
  std::size_t pins;
};
template <class Real>
[[nodiscard]] InUse in_use(const FullTables<Real>& tables) {
  return {tables.drive().cylinders, tables.sections().bearings->pins};
}

/// The numbers of the groups in `Wanted` that scene S has. Groups are in the order of their bits.
template <unsigned Wanted, class Real, class S>
[[nodiscard]] std::vector<Real> numbers(const Output<Real, S>& out, const InUse& use) {
  std::vector<Real> all;
  const auto row = [&all](const Real* first, std::size_t n) { all.insert(all.end(), first, first + n); };
  if constexpr (S::kinematics && (Wanted & kKinematics) != 0) {
    row(out.displacement_m, use.cylinders);
    row(out.velocity_m_s, use.cylinders);
    row(out.acceleration_m_s2, use.cylinders);
  }
  if constexpr (S::rod_motion && (Wanted & kRodMotion) != 0) {
    row(out.rod_angle_rad, use.cylinders);
    row(out.rod_speed_rad_s, use.cylinders);
    row(out.rod_acceleration_rad_s2, use.cylinders);
  }
  if constexpr (S::torque && (Wanted & kTorque) != 0) all.push_back(out.torque_Nm);
  if constexpr (S::mean_torque && (Wanted & kMeanTorque) != 0) all.push_back(out.mean_torque_Nm);
  if constexpr (S::forces && (Wanted & kForces) != 0) {
    for (std::size_t k = 0; k < use.cylinders; ++k) {
      const CylinderForces<Real>& f = out.cylinder[k];
      for (const Real x : {f.pressure_Pa, f.gas_force_N, f.inertia_force_N, f.total_force_N, f.side_force_N,
                           f.rod_force_N, f.radial_force_N, f.tangential_force_N, f.torque_Nm, f.tilting_moment_Nm}) {
        all.push_back(x);
      }
    }
  }
  if constexpr (S::bearing_loads && (Wanted & kBearingLoads) != 0) {
    row(out.pin_radial_N, use.pins);
    row(out.pin_tangential_N, use.pins);
    row(out.pin_load_N, use.pins);
    row(out.journal_along_N, use.pins + 1);
    row(out.journal_across_N, use.pins + 1);
    row(out.journal_load_N, use.pins + 1);
  }
  if constexpr (S::free_forces && (Wanted & kFreeForces) != 0) {
    for (const FreeForce<Real>& f : {out.first, out.second, out.rotating}) {
      for (const Real x : {f.up_N, f.lateral_N, f.pitch_Nm, f.yaw_Nm}) all.push_back(x);
    }
  }
  return all;
}

/// Every number there is room for, in use or not.
template <class Real, class S>
[[nodiscard]] std::vector<Real> all_numbers(const Output<Real, S>& out) {
  return numbers<kAllGroups>(out, InUse{S::cylinders.capacity, S::cylinders.capacity});
}

template <class Real>
[[nodiscard]] bool same_bits(const std::vector<Real>& a, const std::vector<Real>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Real)) == 0);
}
template <class Real>
[[nodiscard]] bool all_finite(const std::vector<Real>& numbers) {
  for (const Real x : numbers) {
    if (!std::isfinite(x)) return false;
  }
  return true;
}
template <class Real>
[[nodiscard]] bool all_zero(const std::vector<Real>& numbers) {
  for (const Real x : numbers) {
    if (x < Real{0} || x > Real{0} || x != x) return false;
  }
  return true;
}

}  // namespace crankloop::tick_test

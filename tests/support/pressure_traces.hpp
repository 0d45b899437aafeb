// Cylinder pressure as an indicating system records it: a diesel's rise of 11.6 bar/deg, ringing, noise, and rows at
// any spacing.
//
// What belongs here: the smooth pressure and the rows read off it. What does not: any interpolation.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <crankloop/define/pressure.hpp>

#include "support/random.hpp"
#include "support/tick_oracle.hpp"

namespace crankloop::tick_test {

inline constexpr double kBar = 1e5;

/// A smooth trace over the cycle, firing at 0, in Pa. Polytropic compression and expansion on the 495's volumes,
/// burning as a logistic rise, a smooth blow-down, and combustion chamber resonance: 6 kHz at 2000 rpm is one
/// oscillation in 2 deg.
struct SmoothTrace {
  double burning_Pa = 45 * kBar;
  double rise_deg = 1.7438;  ///< width of the logistic; with the above the steepest rise is 11.6 bar/deg
  double ringing_Pa = 0;

  [[nodiscard]] double operator()(double deg) const {
    const double a = deg - 720 * std::floor((deg + 360) / 720);  // -360 to 360
    const auto volume = [](double at) {                          // relative to the swept volume, compression ratio 19
      const Crank crank{0.095, 0.0575, 0.210, 0.0, 19.0};
      return 1.0 / 18 + static_cast<double>(oracle_pose_at_deg(crank, at).displacement_m) / 0.115;
    };
    const double closed = 1 / (1 + std::exp(-(a + 175) / 4)) / (1 + std::exp((a - 140) / 7));
    const double compressed = 1.0 * kBar * (std::pow((19.0 / 18) / volume(a), 1.35) - 1);
    const double burnt = 1 / (1 + std::exp(-4 * (a - 4) / rise_deg / 2));
    const double expanding = burning_Pa * burnt * std::pow(volume(4) / volume(a), 1.3);
    const double rings = 1 / (1 + std::exp(-4 * (a - 6)));
    const double ring = a > 0 ? ringing_Pa * rings * std::exp(-a / 12) * std::sin(kPi * (a - 6)) : 0;
    return 1.05 * kBar + closed * (compressed + expanding + ring);
  }
};

/// Rows of a function at the given angles, each with a noise of up to +- noise_Pa.
template <class Function>
[[nodiscard]] std::vector<DiagramPoint> rows_of(const Function& pressure_Pa, const std::vector<double>& angles_deg,
                                                double noise_Pa = 0, std::uint64_t seed = 1) {
  support::Random random(seed);
  std::vector<DiagramPoint> rows;
  for (const double at : angles_deg)
    rows.push_back({at, pressure_Pa(at) + (noise_Pa > 0 ? random.between(-noise_Pa, noise_Pa) : 0)});
  return rows;
}

/// n angles that divide the cycle evenly: i * 720 / n, from `first`.
[[nodiscard]] inline std::vector<double> evenly_deg(int n, double first = 0) {
  std::vector<double> angles;
  for (int i = 0; i < n; ++i) angles.push_back(first + 720.0 * i / n);
  return angles;
}

/// The two given rows around an angle.
struct Neighbours {
  DiagramPoint before, after;

  [[nodiscard]] double lowest_Pa() const { return std::fmin(before.pressure_Pa, after.pressure_Pa); }
  [[nodiscard]] double highest_Pa() const { return std::fmax(before.pressure_Pa, after.pressure_Pa); }
  /// Straight between the two.
  [[nodiscard]] double linear_Pa(double deg) const {
    return before.pressure_Pa + (after.pressure_Pa - before.pressure_Pa) * (deg - before.at) / (after.at - before.at);
  }
};
/// `deg` is reduced to the rows' period.
[[nodiscard]] inline Neighbours neighbours_of(const std::vector<DiagramPoint>& rows, double& deg) {
  while (deg < rows.front().at) deg += 720;
  while (deg >= rows.front().at + 720) deg -= 720;
  std::size_t low = 0;
  std::size_t high = rows.size();
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (rows[middle].at <= deg ? low : high) = middle;
  }
  DiagramPoint after = low + 1 < rows.size() ? rows[low + 1] : rows.front();
  if (low + 1 == rows.size()) after.at += 720;
  return {rows[low], after};
}

}  // namespace crankloop::tick_test

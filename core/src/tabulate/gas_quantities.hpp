// The quantities that are tabulated from an indicator diagram: pressure of one cylinder, gas torque of all, at any
// angle.
//
// What belongs here: their exact values at several angles of a degree. What does not: grids and curves
// (gas_curves.cpp).
#pragma once

#include <array>
#include <cstddef>

#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>

namespace crankloop::detail {

inline constexpr int kFinest = 20;  ///< segments of a degree

/// Values of the curves that share a grid at one angle: pressures in Pa or torques in Nm, in this order everywhere.
enum Part { kFull, kMotored, kHeat };
inline constexpr int kParts = 3;
using AllParts = std::array<double, kParts>;

inline constexpr std::size_t kPressurePlaces = 5;  // of a segment: ends and quarters

/// Angles within one degree, as fractions of it, and the values there.
struct Places {
  static constexpr std::size_t kMax = kFinest * kPressurePlaces;
  std::size_t count = 0;
  double at[kMax];
  AllParts found[kMax];

  void add(double part_of_degree) noexcept { at[count++] = part_of_degree; }
};

/// By Taylor's series: the first dropped terms are below 1e-18.
[[nodiscard]] inline elementary::SinCos sin_cos_within_a_degree(double part_of_degree) noexcept {
  const double a = part_of_degree * kRadPerDegree;
  const double x = a * a;
  return {a * (1 - x / 6 * (1 - x / 20 * (1 - x / 42))), 1 - x / 2 * (1 - x / 12 * (1 - x / 30))};
}
[[nodiscard]] inline elementary::SinCos sin_cos_of_sum(const elementary::SinCos& a,
                                                       const elementary::SinCos& b) noexcept {
  return {a.sin * b.cos + a.cos * b.sin, a.cos * b.cos - a.sin * b.sin};
}

/// A cylinder's pressure over its own crank degrees.
class CylinderPressure {
 public:
  explicit CylinderPressure(const IndicatorDiagram& diagram) noexcept : diagram_{diagram} {}

  void find(int degree, Places& places) const noexcept {
    for (std::size_t i = 0; i < places.count; ++i) {
      const IndicatorDiagram::Pressures p = diagram_.pressures(degree + places.at[i]);
      places.found[i] = {p.full_Pa, p.motored_Pa, p.heat_Pa};
    }
  }
  [[nodiscard]] static int period_deg() noexcept { return kDegreesPerCycle; }

 private:
  const IndicatorDiagram& diagram_;
};

/// Gas torque of all cylinders over engine degrees.
class EngineTorque {
 public:
  EngineTorque(const EngineDefinition& engine, const IndicatorDiagram& diagram) noexcept
      : engine_{engine}, diagram_{diagram}, stroke_{engine.crank}, area_m2_{bore_area_m2(engine.crank)} {
    for (std::size_t k = 0; k < static_cast<std::size_t>(engine.layout.cylinders); ++k) {
      phases_[k] = elementary::sin_cos(-engine.layout.firing_deg[k] * kRadPerDegree);
    }
  }

  /// The outer loop is over cylinders, so that each goes through the diagram's rows in order. Addition theorems give
  /// the sines of a cylinder's angles.
  void find(int degree, Places& places) const noexcept {
    const elementary::SinCos start = elementary::sin_cos(degree * kRadPerDegree);
    elementary::SinCos engine_angles[Places::kMax];
    for (std::size_t i = 0; i < places.count; ++i) {
      engine_angles[i] = sin_cos_of_sum(start, sin_cos_within_a_degree(places.at[i]));
      places.found[i] = {};
    }
    const double back_Pa = engine_.pressure.crankcase_Pa;
    for (std::size_t k = 0; k < static_cast<std::size_t>(engine_.layout.cylinders); ++k) {
      double own_deg = degree - engine_.layout.firing_deg[k];
      if (own_deg < 0) own_deg += kDegreesPerCycle;
      for (std::size_t i = 0; i < places.count; ++i) {
        const auto [displacement_m, slope_m] = stroke_.at(sin_cos_of_sum(engine_angles[i], phases_[k]));
        const IndicatorDiagram::Pressures p = diagram_.pressures(own_deg + places.at[i], displacement_m);
        const double lever_m3 = area_m2_ * slope_m;
        AllParts& sum = places.found[i];
        sum[kFull] += (p.full_Pa - back_Pa) * lever_m3;
        sum[kMotored] += (p.motored_Pa - back_Pa) * lever_m3;
        sum[kHeat] += p.heat_Pa * lever_m3;  // the heat adds to the motored pressure
      }
    }
  }

  /// Period of the torque in whole degrees, after which the cylinders have exchanged their angles: 720 / cylinders of
  /// an evenly firing engine, if that is a whole number.
  [[nodiscard]] int period_deg() const noexcept {
    for (int deg = 1; deg < kDegreesPerCycle; ++deg) {
      if (kDegreesPerCycle % deg == 0 && repeats_after(deg)) return deg;
    }
    return kDegreesPerCycle;
  }

  /// Torque of a pressure on one piston at a lever of the crank radius.
  [[nodiscard]] double scale_Nm(double pressure_Pa) const noexcept {
    return pressure_Pa * area_m2_ * engine_.crank.crank_radius_m;
  }

 private:
  [[nodiscard]] int firing_at(double deg) const noexcept {
    int count = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(engine_.layout.cylinders); ++k)
      count += engine_.layout.firing_deg[k] == deg ? 1 : 0;
    return count;
  }
  [[nodiscard]] bool repeats_after(int deg) const noexcept {
    for (std::size_t k = 0; k < static_cast<std::size_t>(engine_.layout.cylinders); ++k) {
      const double here = engine_.layout.firing_deg[k];
      const double there = here + deg < kDegreesPerCycle ? here + deg : here + deg - kDegreesPerCycle;
      if (firing_at(there) != firing_at(here)) return false;
    }
    return true;
  }

  const EngineDefinition& engine_;
  const IndicatorDiagram& diagram_;
  ExactStroke stroke_;
  double area_m2_;
  elementary::SinCos phases_[kMaxCylinders];  ///< of each cylinder relative to the engine
};

}  // namespace crankloop::detail

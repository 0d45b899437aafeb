// Cylinder pressures made of formulas, and the tables that a measurement of them would give.
//
// What belongs here: p(a) known in closed form, sampled over angle or volume. What does not: the library's own
// diagrams.
#pragma once

#include <crankloop/define/engine_definition.hpp>

#include <cmath>
#include <vector>

#include "support/vector_geometry.hpp"

namespace crankloop::support {

/// Volume of a cylinder at its own crank angle, by vector geometry and the definition of the compression ratio.
inline double volume_m3(const Crank& crank, double crank_deg) {
  const Wide area = kWidePi / 4 * wide(crank.bore_m) * wide(crank.bore_m);
  const Wide swept = area * (greatest_height(crank) - least_height(crank));
  const Wide clearance = swept / (wide(crank.compression_ratio) - 1);
  const Wide a = wide(crank_deg) * kWidePi / 180;
  return static_cast<double>(clearance + area * (greatest_height(crank) - piston_height(crank, a)));
}
inline double swept_m3(const Crank& crank) {
  const Wide area = kWidePi / 4 * wide(crank.bore_m) * wide(crank.bore_m);
  return static_cast<double>(area * (greatest_height(crank) - least_height(crank)));
}

/// A smooth four-stroke-like pressure: a sharp hump after firing, a shallow one at gas exchange; infinitely
/// differentiable, period 720 deg.
inline double smooth_pressure_Pa(double crank_deg) {
  const double t = crank_deg * kRadPerDeg / 2;  // one period = 2 pi
  return 1e5 + 60e5 * std::exp(30 * (std::cos(t - 0.1) - 1)) + 0.2e5 * std::exp(4 * (std::cos(t - 2.2) - 1));
}

/// Rows of f over the angle, `per_degree` in every degree, closing row included.
template <class Function>
std::vector<DiagramPoint> angle_rows(const Function& f, int per_degree, double start_deg = 0) {
  std::vector<DiagramPoint> rows;
  for (int i = 0; i <= 720 * per_degree; ++i) {
    const double deg = start_deg + static_cast<double>(i) / per_degree;
    rows.push_back({deg, f(deg)});
  }
  rows.back().pressure_Pa = rows.front().pressure_Pa;
  return rows;
}

/// The rows must outlive what is made of them.
inline Pressure table_pressure(PressureSource source, const std::vector<DiagramPoint>& rows) {
  Pressure pressure;
  pressure.source = source;
  pressure.points = rows.data();
  pressure.point_count = static_cast<int>(rows.size());
  return pressure;
}
Pressure table_pressure(PressureSource, std::vector<DiagramPoint>&&) = delete;

}  // namespace crankloop::support

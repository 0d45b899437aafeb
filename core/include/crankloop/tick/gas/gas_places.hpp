// Where pistons and valves stand, as the gas sees it: volumes and port areas.
#pragma once

#include <cstdint>

#include <crankloop/tables/angle.hpp>
#include <crankloop/tables/tables.hpp>

namespace crankloop::detail {

/// A valve that is open by less is closed.
inline constexpr double kClosedLift_m = 1e-6;

/// Above a piston.
template <class Real, class S>
[[nodiscard, gnu::always_inline]] inline Real gas_volume_m3(const Tables<Real, S>& tables, std::uint64_t phase,
                                                            std::uint32_t mechanism) noexcept {
  const auto at = turn_angle_of<Real>(phase, tables.drive->firing_phase[mechanism]);
  Real displacement_m;
  if constexpr (Needs<S>::stroke) {
    displacement_m = total(integral_at(tables.stroke->at[at.degree], at.u, Real{0}), tables.stroke->quantum);
  } else {
    displacement_m = value(tables.motion->at[at.degree].displacement, at.u);
  }
  const GasCylinders<Real>& table = *tables.gas_cylinders;
  return table.clearance_m3 + table.bore_area_m2 * (displacement_m > 0 ? displacement_m : Real{0});
}

/// Effective, of all valves of a train in a cylinder.
template <class Real>
[[nodiscard]] inline Real port_area_m2(const GasPortCurve<Real>& curve, Real lift_m) noexcept {
  if (!(lift_m > static_cast<Real>(kClosedLift_m))) return Real{0};
  const Real place = lift_m * curve.per_step_m;
  if (!(place < Real{kFlowSteps})) return curve.area_m2[kFlowSteps];
  const auto row = static_cast<std::int32_t>(place);
  return curve.area_m2[row] + (curve.area_m2[row + 1] - curve.area_m2[row]) * (place - static_cast<Real>(row));
}
}  // namespace crankloop::detail

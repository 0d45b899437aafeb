// Where pistons and valves stand, as the gas sees it: volumes and port areas.
#pragma once

#include <cstdint>

#include <crankloop/state.hpp>
#include <crankloop/tables/angle.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/checked.hpp>

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

/// Of one cylinder, as they are now.
template <class Real, class S>
[[nodiscard, gnu::always_inline]] inline decltype(auto) walls_of(const Tables<Real, S>& tables,
                                                                 [[maybe_unused]] const State<Real, S>& state,
                                                                 [[maybe_unused]] std::uint32_t cylinder) noexcept {
  if constexpr (S::walls) {
    GasWalls<Real> walls = tables.gas_cylinders->walls;
    walls.temperature_K = state.wall_K[cylinder];
    return walls;
  } else {
    return (tables.gas_cylinders->walls);
  }
}

/// Effective, of all valves of a train in a cylinder that are open.
template <class Real>
[[nodiscard]] inline Real port_area_m2(const GasPortCurve<Real>& curve, Real lift_m) noexcept {
  const Real place = lift_m * curve.per_step_m;
  if (!(place < Real{kFlowSteps})) return curve.area_m2[kFlowSteps];
  const auto row = static_cast<std::int32_t>(place);
  return curve.area_m2[row] + (curve.area_m2[row + 1] - curve.area_m2[row]) * (place - static_cast<Real>(row));
}

/// Of each port of each cylinder.
template <class Real, std::uint32_t kCylinders>
struct PortAreas {
  Real of[kPorts][kCylinders];
};

/// Of the lifts that `lift_of(train, cylinder)` answers.
template <class Real, class S, class LiftOf>
inline void read_areas(const Tables<Real, S>& tables, PortAreas<Real, S::cylinders.capacity>& areas,
                       const LiftOf& lift_of) noexcept {
  for (std::uint32_t k = 0; k < S::cylinders.capacity; ++k) areas.of[kIntake][k] = areas.of[kExhaust][k] = Real{0};
  const std::uint32_t trains = S::trains.exact ? S::trains.capacity : tables.drive->trains;
  for (std::uint32_t t = 0; t < trains; ++t) {
    const GasPortCurve<Real>& curve = tables.gas_ports[t];
    Real* const of_port = areas.of[curve.port];
    for (std::uint32_t k = 0; k < count<S>(tables.drive->cylinders); ++k) {
      const Real lift_m = lift_of(t, k);
      if (lift_m > static_cast<Real>(kClosedLift_m)) of_port[k] += port_area_m2(curve, lift_m);
    }
  }
}

}  // namespace crankloop::detail

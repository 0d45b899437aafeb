// The gas of a manifold: what cylinders see of it, its exchange with the outside through the throttle or the exhaust
// system.
#pragma once

#include <crankloop/tick/gas/cylinder_gas.hpp>

namespace crankloop::detail {

/// Limit of the share by which what flows out cools the rest in a step, times the share that would flow at the pressure
/// of before. Above 1 implicit_flow()'s two formulas leave pressures between them that neither answers; at 0.8 flow is
/// at most 8 % off what it would be with all of the cooling.
template <class Real>
inline constexpr Real kMostCooling = static_cast<Real>(0.8);

/// How far its own pressure moves per kg.
template <class Real>
[[nodiscard]] inline Real response_Pa_kg(const ManifoldGas<Real>& manifold, Real per_volume_m3) noexcept {
  return pressure_of(Real{1} + manifold.point.gas_ratio, manifold.point.temperature_K, per_volume_m3);
}

/// As the far side of the ports in a step: at its start `open` cylinders of up to `most_m3` are open to it.
///
/// All see it as it stands then. One that let its own flow alone move that pressure would be wrong to first order: what
/// it takes the throttle brings meanwhile. It need not, while they together could not empty it: each brings its own
/// pressure to the manifold's, so the manifold overshoots by open most_m3 / V, and settles where that is small. Of a
/// small manifold each assumes flows through the others as in the last step, with changes like its own in them, and
/// allows for how the opening to the outside responds within the step: its stiffness is z = h k Y, Y its flow per
/// difference of pressures.
template <class Real>
[[nodiscard]] inline GasBeyond<Real> seen_from_ports(const ManifoldGas<Real>& manifold, const GasBeyond<Real>& outside,
                                                     Real area_m2, Real per_volume_m3, Real taken_kg_s, Real open,
                                                     Real most_m3, Real step_s) noexcept {
  const Real counted = open - Real{1} / (2 * most_m3 * per_volume_m3);
  GasBeyond<Real> seen = beyond(manifold.point, Real{0});
  if (!(counted > 0)) return seen;
  const bool in = outside.pressure_Pa > manifold.point.pressure_Pa;
  const Real up_Pa = in ? outside.pressure_Pa : manifold.point.pressure_Pa;
  const Real apart_Pa = outside.pressure_Pa - manifold.point.pressure_Pa;
  const Real s = magnitude(apart_Pa) / up_Pa * kPerChokedDrop<Real>;
  const Real per_Pa = area_m2 * (in ? outside.choked_per_Pa : seen.choked_per_Pa);
  const Real flow_Pa =
      s < 1 ? kPerChokedDrop<Real> * (Real{2} - s) / square_root(s * (Real{2} - s) + static_cast<Real>(4.3e-4))
            : up_Pa / magnitude(apart_Pa);
  const Real own_Pa_kg = response_Pa_kg(manifold, per_volume_m3);
  const Real z = step_s * per_Pa * flow_Pa *
                 (in ? (Real{1} + manifold.point.gas_ratio) * per_volume_m3 * outside.specific_work_J_kg : own_Pa_kg);
  const Real per_answer = Real{1} / (Real{1} + z);
  seen.response_Pa_kg = counted * own_Pa_kg * per_answer;
  const Real share = counted / open * per_answer;
  seen.end_Pa += apart_Pa * z * share;
  seen.as_was_Pa = -(step_s * taken_kg_s * own_Pa_kg) * share;
  return seen;
}

/// As the cylinders left it, which have taken some.
template <class Real>
[[nodiscard]] inline GasNear<Real> left_by_cylinders(const ManifoldGas<Real>& manifold, const GasBeyond<Real>& seen,
                                                     Real taken_kg, Real per_volume_m3) noexcept {
  const Real per_kg_Pa = response_Pa_kg(manifold, per_volume_m3);
  const Real left_Pa = seen.pressure_Pa - per_kg_Pa * taken_kg, least_Pa = seen.pressure_Pa / 4;
  return {left_Pa > least_Pa ? left_Pa : least_Pa, manifold.point.temperature_K, per_kg_Pa,
          manifold.point.gas_ratio / (Real{1} + manifold.point.gas_ratio)};
}

/// After the cylinders: an opening to the outside. Answers the mass that came in.
template <class Real>
inline Real step_manifold(ManifoldGas<Real>& manifold, const GasNear<Real>& near, const GasBeyond<Real>& seen,
                          const GasBeyond<Real>& outside, Real area_m2, Real per_volume_m3, Real least_kg, Real step_s,
                          bool& put_back) noexcept {
  const Opening<Real> opening{area_m2, area_m2, outside,
                              (Real{1} + manifold.point.gas_ratio) * per_volume_m3 * outside.specific_work_J_kg};
  GasNear<Real> bounded = near;
  const Real falls = area_m2 * seen.choked_per_Pa * step_s * near.per_kg_out_Pa;
  if (near.cooling * falls > kMostCooling<Real>) bounded.cooling = kMostCooling<Real> / falls;
  const Real mass_kg = step_s * implicit_flow(opening, bounded, outside.pressure_Pa, step_s);
  GasContents<Real>& gas = manifold.contents;
  const PortStep<Real> step =
      exchange<Real>(mass_kg, {gas.mass_kg, gas.energy_J, gas.burned_kg, seen.specific_work_J_kg}, outside);
  gas.add(step.mass_kg, step.enthalpy_J, step.burned_kg);
  manifold.point = point_of(gas, per_volume_m3);
  if (__builtin_expect(!is_well(manifold.point, gas.mass_kg, least_kg), 0))
    put_back = put_right(gas, manifold.point, per_volume_m3, least_kg) || put_back;
  return step.mass_kg;
}

}  // namespace crankloop::detail

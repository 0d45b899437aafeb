// The gas of a manifold: what cylinders see of it, its exchange with the outside through the throttle or the exhaust
// system.
#pragma once

#include <crankloop/tick/gas/cylinder_gas.hpp>

namespace crankloop::detail {

/// As the far side of the ports in a step.
template <class Real>
[[nodiscard]] inline GasBeyond<Real> seen_from_ports(const ManifoldGas<Real>& manifold, Real per_volume_m3,
                                                     Real step_s) noexcept {
  const GasPoint<Real>& at = manifold.point;
  const Real response_Pa_kg = pressure_of(Real{1} + at.gas_ratio, at.temperature_K, per_volume_m3);
  return beyond(at, response_Pa_kg, most_area_per_m3(step_s) / per_volume_m3);
}

/// After the cylinders, which have taken some: an opening to the outside. Answers the mass that came in.
template <class Real>
inline Real step_manifold(ManifoldGas<Real>& manifold, const GasBeyond<Real>& seen, Real taken_kg,
                          const GasBeyond<Real>& outside, Real area_m2, Real per_volume_m3, Real least_kg, Real step_s, bool& put_back) noexcept {
  const Real left_Pa = seen.pressure_Pa - seen.response_Pa_kg * taken_kg, least_Pa = seen.pressure_Pa / 4;
  const GasNear<Real> near{left_Pa > least_Pa ? left_Pa : least_Pa, manifold.point.temperature_K, seen.response_Pa_kg};
  const Real area = area_m2 < seen.most_area_m2 ? area_m2 : seen.most_area_m2;
  const Opening<Real> opening{area, area, outside,
                              (Real{1} + manifold.point.gas_ratio) * per_volume_m3 * outside.specific_work_J_kg};
  const Real mass_kg = step_s * implicit_flow(opening, near, outside.pressure_Pa, step_s);
  GasContents<Real>& gas = manifold.contents;
  const PortStep<Real> step =
      exchange<Real>(mass_kg, {gas.mass_kg, gas.energy_J, gas.burned_kg, seen.specific_work_J_kg}, outside);
  gas.add(step.mass_kg, step.enthalpy_J, step.burned_kg);
  manifold.point = point_of(gas, per_volume_m3);
  if (__builtin_expect(!is_well(manifold.point, gas.mass_kg, least_kg), 0))
    put_back = put_right(manifold, per_volume_m3, least_kg) || put_back;
  return step.mass_kg;
}

}  // namespace crankloop::detail

// The gas of a manifold: what cylinders see of it, its exchange with the outside through the throttle or the exhaust
// system.
#pragma once

#include <crankloop/tick/gas/cylinder_gas.hpp>

namespace crankloop::detail {

/// How far its own pressure moves per kg.
template <class Real>
[[nodiscard]] inline Real response_Pa_kg(const ManifoldGas<Real>& manifold, Real per_volume_m3) noexcept {
  return pressure_of(Real{1} + manifold.point.gas_ratio, manifold.point.temperature_K, per_volume_m3);
}

/// As the far side of the ports in a step, at whose begin `open` cylinders of up to `most_m3` see it.
///
/// All see it as it stands then. One that let its own flow alone move that pressure would be wrong to first order: what
/// it takes the throttle brings meanwhile. It need not, while they together could not empty it: each brings its own
/// pressure to the manifold's, so the manifold overshoots by open most_m3 / V, and settles where that is small. Of a
/// small manifold each reckons with a flow like its own in the others.
template <class Real>
[[nodiscard]] inline GasBeyond<Real> seen_from_ports(const ManifoldGas<Real>& manifold, Real per_volume_m3, Real open,
                                                     Real most_m3, Real step_s) noexcept {
  const Real reckons = open - Real{1} / (2 * most_m3 * per_volume_m3);
  const Real response = reckons > 0 ? reckons * response_Pa_kg(manifold, per_volume_m3) : Real{0};
  return beyond(manifold.point, response, most_area_per_m3(step_s) / per_volume_m3);
}

/// After the cylinders, which have taken some: an opening to the outside. Answers the mass that came in.
template <class Real>
inline Real step_manifold(ManifoldGas<Real>& manifold, const GasBeyond<Real>& seen, Real taken_kg,
                          const GasBeyond<Real>& outside, Real area_m2, Real per_volume_m3, Real least_kg, Real step_s,
                          bool& put_back) noexcept {
  const Real per_kg_Pa = response_Pa_kg(manifold, per_volume_m3);
  const Real left_Pa = seen.pressure_Pa - per_kg_Pa * taken_kg, least_Pa = seen.pressure_Pa / 4;
  const GasNear<Real> near{left_Pa > least_Pa ? left_Pa : least_Pa, manifold.point.temperature_K, per_kg_Pa};
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

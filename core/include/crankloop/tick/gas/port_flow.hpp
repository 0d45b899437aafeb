// What flows through one open port in a step. docs/model.md "Gas".
//
// What belongs here: one opening between a near side that answers and a far side. What does not: two ports at once
// (port_overlap.hpp), the heat that goes with the flow (cylinder_gas.hpp).
//
// For a small difference D of pressures the flow grows as sqrt(D): its slope has no bound, and an explicit step
// overshoots however short it is. Here a part theta of the step is implicit, in closed form because the orifice's flow
// is quadratic in the pressures: 1/2 for a slow pressure (second order), 1 for a fast one (no ringing).
#pragma once

#include <crankloop/tick/gas/orifice.hpp>

namespace crankloop::detail {

/// The near side as it would stand at the step's end if nothing flowed, and how far its pressure moves per kg.
template <class Real>
struct GasNear {
  Real pressure_Pa;
  Real temperature_K;
  Real per_kg_out_Pa;
};
/// Flow into the near side, kg/s, such that it is the orifice's flow at the pressures that it leads to over `time_s`.
/// Neither pressure passes the other, whatever the time.
template <class Real>
[[nodiscard]] inline Real implicit_flow(Real area_m2, const GasNear<Real>& near, Real in_Pa_kg,
                                        const GasBeyond<Real>& far, Real far_Pa, Real time_s) noexcept {
  const Real drop_Pa = far_Pa - near.pressure_Pa;
  constexpr Real kPer = kPerChokedDrop<Real>;
  if (drop_Pa > 0) {
    const Real choked = area_m2 * far.choked_per_Pa * far_Pa;
    const Real scale = kPer / far_Pa;
    const Real s = drop_Pa * scale;
    const Real q = choked * (in_Pa_kg + far.response_Pa_kg) * time_s * scale;
    if (s - q >= 1) return choked;
    const Real square = s * (Real{2} - s);
    const Real root = square_root(q * q + square);
    const Real along = q * (Real{1} - s);
    return s < 1 ? choked * square / (along + root) : choked * (root - along) / (Real{1} + q * q);
  }
  const Real d = -drop_Pa;
  if (!(d > 0)) return Real{0};
  const Real per_Pa = area_m2 * choked_per_Pa(near.temperature_K);
  const Real own = near.per_kg_out_Pa * time_s;
  const Real others = far.response_Pa_kg * time_s;
  // Flow goes with p / sqrt(T), which falls slower than p: 0.87.
  const Real choked = per_Pa * near.pressure_Pa / (Real{1} + static_cast<Real>(0.87) * per_Pa * own);
  if ((near.pressure_Pa - own * choked) * (Real{1} - kChokedDrop<Real>) >= far_Pa + others * choked) return -choked;
  // w = v times per_Pa: v^2 = D (2 P + e2 D) / x_c, D = d - k2 v. In pressures, so that no area is too small to square.
  const Real k2 = per_Pa * (own + others);
  constexpr Real e2 = Real{2} - kPer;
  const Real half = kPer * k2 * (far_Pa + e2 * d);
  const Real square = kPer * d * (2 * far_Pa + e2 * d);
  const Real inner = half * half + (Real{1} - e2 * kPer * (k2 * k2)) * square;
  const Real v = square / (half + square_root(inner > 0 ? inner : Real{0}));
  return -per_Pa * (v >= 0 && v * k2 <= d ? v : d / k2);
}

/// A port's effective areas at both ends of a step.
template <class Real>
struct PortAreas {
  Real from_m2, to_m2;

  [[nodiscard]] constexpr bool open() const noexcept { return from_m2 + to_m2 > 0; }
};

/// Into the cylinder in the step, and by how much that moves its pressure.
template <class Real>
struct PortFlow {
  Real mass_kg = 0;
  Real per_kg_Pa = 0;
};

/// The explicit part of a step: with theta, the part that is left to be implicit.
template <class Real>
[[nodiscard]] constexpr Real implicit_share(Real stiffness) noexcept {
  return (Real{3} + stiffness) / (Real{6} + stiffness);
}

/// Whether an explicit part is small enough, and does not by itself take the pressures past one another.
template <class Real>
[[nodiscard]] constexpr bool may_be_explicit(Real part_kg, Real per_kg_Pa, Real near_Pa,
                                             const GasBeyond<Real>& far) noexcept {
  const Real near_part_Pa = part_kg * per_kg_Pa;
  const Real far_part_Pa = part_kg * far.response_Pa_kg;
  const Real apart_Pa = near_Pa - far.pressure_Pa;
  const Real after_Pa = apart_Pa + (near_part_Pa + far_part_Pa);
  return apart_Pa * after_Pa >= 0 && magnitude(near_part_Pa) <= near_Pa / 4 &&
         magnitude(far_part_Pa) <= far.pressure_Pa / 4;
}

/// One port of a cylinder. `begin` is how the cylinder stood before the step, `near` as it would end.
template <class Real>
[[nodiscard, gnu::always_inline]] inline PortFlow<Real> one_port_flow(const PortAreas<Real>& area,
                                                                      const GasPoint<Real>& begin, GasNear<Real> near,
                                                                      Real in_Pa_kg, const GasBeyond<Real>& far,
                                                                      Real step_s) noexcept {
  const Orifice<Real> at = Orifice<Real>::at(begin.pressure_Pa, begin.temperature_K, far);
  Real share = Real{1};
  Real explicit_kg{};
  Real far_Pa = far.pressure_Pa;
  if (at.flow_kg_s_m2 != Real{0}) {
    const Real per_kg_Pa = at.flow_kg_s_m2 > 0 ? in_Pa_kg : near.per_kg_out_Pa;
    const Real mean_m2 = (area.from_m2 + area.to_m2) / 2;
    const Real theta = implicit_share(step_s * per_kg_Pa * mean_m2 * magnitude(at.flow_kg_s_m2) * at.share_per_Pa);
    const Real part_kg = (Real{1} - theta) * step_s * area.from_m2 * at.flow_kg_s_m2;
    if (may_be_explicit(part_kg, per_kg_Pa, near.pressure_Pa, far)) {
      share = theta;
      explicit_kg = part_kg;
      near.pressure_Pa += part_kg * per_kg_Pa;
      far_Pa -= part_kg * far.response_Pa_kg;
    }
  }
  PortFlow<Real> flow{explicit_kg, in_Pa_kg};
  if (area.to_m2 > 0) {
    const Real time_s = share * step_s;
    flow.mass_kg += time_s * implicit_flow(area.to_m2, near, in_Pa_kg, far, far_Pa, time_s);
  }
  if (!(flow.mass_kg > 0)) flow.per_kg_Pa = near.per_kg_out_Pa;
  return flow;
}

}  // namespace crankloop::detail

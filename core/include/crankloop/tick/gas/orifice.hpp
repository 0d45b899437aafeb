// Flow of gas through an opening between two pressures. docs/model.md "Gas".
//
// What belongs here: the flow at one moment. What does not: what it comes to in a step (port_flow.hpp).
//
//     w = A p1 psi / sqrt(R T1),   psi = psi_c sqrt(s (2 - s)),   s = min(1, (p1 - p2) / (x_c p1))      p1 upstream; s
//     = 1: choked
//
// The ellipse of ISO 6358 through the choked flow of Saint-Venant's formula for a ratio of specific heats g = 1.36: at
// most 0.58 % low near equal pressures, without a power, and quadratic in the pressures, which lets a step solve it.
// x_c = 1 - (2/(g+1))^(g/(g-1)), psi_c = sqrt(g) (2/(g+1))^((g+1)/(2(g-1))).
#pragma once

#include <crankloop/tables/gas_tables.hpp>
#include <crankloop/tick/gas/gas_properties.hpp>

namespace crankloop::detail {

template <class Real>
inline constexpr Real kChokedFlow = static_cast<Real>(0.6778852870696124);  ///< psi_c
template <class Real>
inline constexpr Real kChokedDrop = static_cast<Real>(0.46488669399358847);  ///< x_c
template <class Real>
inline constexpr Real kPerChokedDrop = static_cast<Real>(1 / 0.46488669399358847);

/// psi_c / sqrt(R T): choked flow per area and Pa.
template <class Real>
[[nodiscard]] inline Real choked_per_Pa(Real temperature_K) noexcept {
  return kChokedFlow<Real> / square_root(kGasConstant<Real> * temperature_K);
}

/// How far sound gets: an opening that would let a whole volume through in a step is as good as one half as large.
inline constexpr double kFlowSpeed_m_s = 1000;
template <class Real>
[[nodiscard]] constexpr Real most_area_per_m3(Real step_s) noexcept {
  return Real{2} / (static_cast<Real>(kFlowSpeed_m_s) * step_s);
}

template <class Real>
[[nodiscard]] inline GasBeyond<Real> beyond(const GasPoint<Real>& gas, Real response_Pa_kg,
                                            Real most_area_m2) noexcept {
  const Real specific_work_J_kg = kGasConstant<Real> * gas.temperature_K;
  return {gas.pressure_Pa,    choked_per_Pa(gas.temperature_K),
          specific_work_J_kg, energy_J_kg(gas.temperature_K, gas.burned_ratio) + specific_work_J_kg,
          gas.burned_ratio,   response_Pa_kg,
          most_area_m2};
}

/// Flow into the near side, and how it answers to that side's pressure.
template <class Real>
struct Orifice {
  Real flow_kg_s_m2;  ///< per area, signed
  Real share_per_Pa;  ///< by which share the flow falls per Pa that the near side comes nearer

  [[nodiscard]] static Orifice at(Real near_Pa, Real near_K, const GasBeyond<Real>& far) noexcept {
    const bool out = near_Pa > far.pressure_Pa;
    const Real up_Pa = out ? near_Pa : far.pressure_Pa;
    const Real drop_Pa = magnitude(near_Pa - far.pressure_Pa);
    const Real choked = up_Pa * (out ? choked_per_Pa(near_K) : far.choked_per_Pa);
    const Real s = drop_Pa / up_Pa * kPerChokedDrop<Real>;
    if (!(s < 1)) return {out ? -choked : choked, out ? Real{1} / near_Pa : Real{0}};
    if (!(drop_Pa > 0)) return {Real{0}, Real{0}};
    const Real left = Real{2} - s;
    const Real flow = choked * square_root(s * left);
    return {out ? -flow : flow, (Real{1} - s) / (drop_Pa * left)};
  }
};

}  // namespace crankloop::detail

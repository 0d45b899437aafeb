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

#include <type_traits>

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
template <class T>
[[nodiscard, gnu::always_inline]] inline T choked_per_Pa(const T& temperature_K) noexcept {
  using Real = NumberOf<T>;
  return kChokedFlow<Real> / square_root(kGasConstant<Real> * temperature_K);
}

/// How far sound gets: an opening that would let a whole volume through in a step is as good as one half as large.
inline constexpr double kFlowSpeed_m_s = 1000;
template <class Real>
[[nodiscard]] constexpr Real most_area_per_m3(Real step_s) noexcept {
  return Real{2} / (static_cast<Real>(kFlowSpeed_m_s) * step_s);
}

template <class T>
[[nodiscard]] inline GasBeyond<T> beyond(const GasPoint<T>& gas, T response_Pa_kg) noexcept {
  const T specific_work_J_kg = kGasConstant<NumberOf<T>> * gas.temperature_K;
  return {gas.pressure_Pa,    choked_per_Pa(gas.temperature_K),
          specific_work_J_kg, energy_J_kg(gas.temperature_K, gas.burned_ratio) + specific_work_J_kg,
          gas.burned_ratio,   response_Pa_kg,
          gas.pressure_Pa,    T{}};
}

/// As an opening has it: of lanes, each has its own.
template <class T>
using BeyondOf = std::conditional_t<kLanesIn<T> == 1, const GasBeyond<T>&, GasBeyond<T>>;

/// What is beyond one of two ports, the same for all lanes or of each.
template <class T, class Far, class Holds>
[[nodiscard, gnu::always_inline]] inline BeyondOf<T> beyond_port(const Far (&far)[kPorts],
                                                                 const Holds& exhaust) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    return far[exhaust ? kExhaust : kIntake];
  } else {
    const auto& e = far[kExhaust];
    const auto& i = far[kIntake];
    const auto of = [&exhaust](const auto& a, const auto& b) {
      if constexpr (std::is_same_v<Far, GasBeyond<T>>) {
        return pick(exhaust, a, b);
      } else {
        return pick(exhaust, spread<T>(a), spread<T>(b));
      }
    };
    return {of(e.pressure_Pa, i.pressure_Pa),
            of(e.choked_per_Pa, i.choked_per_Pa),
            of(e.specific_work_J_kg, i.specific_work_J_kg),
            of(e.enthalpy_J_kg, i.enthalpy_J_kg),
            of(e.burned_ratio, i.burned_ratio),
            of(e.response_Pa_kg, i.response_Pa_kg),
            of(e.end_Pa, i.end_Pa),
            of(e.as_was_Pa, i.as_was_Pa)};
  }
}

/// Flow into the near side at one moment, per area and signed, and its slope: by how much less flows per Pa that the
/// near side comes nearer.
template <class T>
struct Orifice {
  T flow_kg_s_m2;
  T slope_kg_s_m2_Pa;

  [[nodiscard, gnu::always_inline]] static Orifice at(const T& near_Pa, const T& near_K,
                                                      const GasBeyond<T>& far) noexcept {
    using Real = NumberOf<T>;
    return branch<T>(
        near_Pa >= far.pressure_Pa,
        [&](auto out) __attribute__((always_inline, no_sanitize("float-divide-by-zero")))->Orifice {
          const T up_Pa = pick(out, near_Pa, far.pressure_Pa);
          const T per_Pa = either<T>(
              out, [&] { return choked_per_Pa(near_K); }, [&] { return far.choked_per_Pa; });
          const T s = magnitude(near_Pa - far.pressure_Pa) / up_Pa * kPerChokedDrop<Real>;
          const T until_choked = s < Real{1} ? s : spread<T>(1);
          const T root = square_root(until_choked * (Real{2} - until_choked));
          // At equal pressures it is infinite, and a step implicit throughout: the sanitizer is told that this is
          // meant.
          const T steep = kPerChokedDrop<Real> * (Real{1} - until_choked) / root;
          const T least = where(out, spread<T>(1));  // choked flow out falls with the near pressure
          return {negative_where(out, up_Pa * per_Pa * root), per_Pa * (steep > least ? steep : least)};
        });
  }
};

}  // namespace crankloop::detail

// What the flow of a step takes along: mass, enthalpy, burned mass.
#pragma once

#include <crankloop/tick/gas/port_overlap.hpp>

namespace crankloop::detail {

/// What came through a port in a step.
template <class T>
struct PortStep {
  T mass_kg, enthalpy_J, burned_kg;  ///< into the near side

  /// From the far side.
  [[nodiscard, gnu::always_inline]] static PortStep in(const T& mass_kg, const GasBeyond<T>& far) noexcept {
    return {mass_kg, mass_kg * far.enthalpy_J_kg, mass_kg * far.burned_ratio};
  }
};

/// The gas as it flows out: what there is before it does.
template <class T>
struct FlowingGas {
  using Real = NumberOf<T>;

  T mass_kg, energy_J, burned_kg;
  T specific_work_J_kg;  ///< R T

  /// A negative mass of it, at most half. That cools what stays: (1 + r) F (1 - F/2) / (1 - (1 - r) F/2) of the energy
  /// for a share F of the mass; r = R T / e.
  [[nodiscard, gnu::always_inline]] PortStep<T> out(const T& mass_kg_in) const noexcept {
    constexpr Real kHalf = static_cast<Real>(0.5);
    const T most_kg = kHalf * mass_kg;
    const T taken_kg = -mass_kg_in <= most_kg ? -mass_kg_in : most_kg;
    const T share = taken_kg / mass_kg;
    const T half = kHalf * share;
    const T work_J = specific_work_J_kg * mass_kg;  // r U
    const T leaving_J =
        (energy_J + work_J) * energy_J * (share - share * half) / (energy_J - (energy_J - work_J) * half);
    return {-taken_kg, -leaving_J, -share * burned_kg};
  }
};

template <class T, class Holds>
[[nodiscard, gnu::always_inline]] inline PortStep<T> pick(const Holds& holds, const PortStep<T>& then,
                                                          const PortStep<T>& otherwise) noexcept {
  return {pick(holds, then.mass_kg, otherwise.mass_kg), pick(holds, then.enthalpy_J, otherwise.enthalpy_J),
          pick(holds, then.burned_kg, otherwise.burned_kg)};
}

template <class T, class Holds>
[[nodiscard, gnu::always_inline]] inline PortStep<T> where(const Holds& holds, const PortStep<T>& then) noexcept {
  return {where(holds, then.mass_kg), where(holds, then.enthalpy_J), where(holds, then.burned_kg)};
}

/// What an opening brings or takes.
template <class T>
[[nodiscard, gnu::always_inline]] inline PortStep<T> exchange(const T& mass_kg, const FlowingGas<T>& near,
                                                              const GasBeyond<T>& far) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    return mass_kg < 0 ? near.out(mass_kg) : PortStep<T>::in(mass_kg, far);
  } else {
    return pick(mass_kg < NumberOf<T>{0}, near.out(mass_kg), PortStep<T>::in(mass_kg, far));
  }
}

/// What both ports of an overlap let flow, and bring or take. Half of what flows in mixes before what flows out leaves,
/// the other half after: of second order. Kept apart: few ticks have an overlap.
template <class T>
[[gnu::noinline]] void flow_in_overlap(const Opening<T> (&at)[2], const GasPoint<T>& begin, const GasNear<T>& pressure,
                                       FlowingGas<T> near, NumberOf<T> step_s, PortFlow<T> (&flow)[2],
                                       PortStep<T> (&step)[2]) noexcept {
  using Real = NumberOf<T>;
  two_port_flow(at, begin, pressure, step_s, flow);
  constexpr Real kHalf = static_cast<Real>(0.5);
  const auto out_0 = flow[0].mass_kg < Real{0}, out_1 = flow[1].mass_kg < Real{0};
  const T out_kg = where(out_0, flow[0].mass_kg) + where(out_1, flow[1].mass_kg);
  const PortStep<T> in_0 = PortStep<T>::in(flow[0].mass_kg, at[0].far),
                    in_1 = PortStep<T>::in(flow[1].mass_kg, at[1].far);
  const auto in = [&](const T& of_0, const T& of_1) __attribute__((always_inline)) {
    return where(none_of(out_0), of_0) + where(none_of(out_1), of_1);
  };
  const T in_kg = in(in_0.mass_kg, in_1.mass_kg);
  near.mass_kg += kHalf * in_kg;
  near.energy_J += kHalf * in(in_0.enthalpy_J, in_1.enthalpy_J);
  near.burned_kg += kHalf * in(in_0.burned_kg, in_1.burned_kg);
  const T per_mass = Real{1} / near.mass_kg;
  const T e = near.energy_J * per_mass;
  const T a = heat_at_0_K(near.burned_kg * per_mass);
  const T mixed_work_J_kg =
      (Real{2} * kGasConstant<Real>)*e / (a + square_root(a * a + (Real{2} * kHeatSlope<Real>)*e));
  near.specific_work_J_kg = pick(in_kg > Real{0}, mixed_work_J_kg, near.specific_work_J_kg);
  const PortStep<T> both = near.out(out_kg);
  // Where nothing flows out its share is no number, and is not taken: the sanitizer is told that this is meant.
  const auto part = [&](const T& mass_kg) __attribute__((always_inline, no_sanitize("float-divide-by-zero")))
                        ->PortStep<T> {
    const T share = mass_kg / out_kg;
    return {share * both.mass_kg, share * both.enthalpy_J, share * both.burned_kg};
  };
  step[0] = pick(out_0, part(flow[0].mass_kg), in_0);
  step[1] = pick(out_1, part(flow[1].mass_kg), in_1);
}

}  // namespace crankloop::detail

// What flows through an opening in a step. docs/model.md "Gas".
//
// What belongs here: one opening between a near side that answers and a far side. What does not: two at once
// (port_overlap.hpp), the heat that goes with the flow (exchange.hpp).
//
// For a small difference D of pressures the flow grows as sqrt(D): its slope has no bound, and an explicit step
// overshoots however short it is. Here a part theta of the step is implicit, in closed form because the orifice's flow
// is quadratic in the pressures: 1/2 for a slow pressure (second order), 1 for a fast one (no ringing).
#pragma once

#include <crankloop/tick/gas/orifice.hpp>

namespace crankloop::detail {

/// The near side as it would stand at the step's end if nothing flowed, and how far its pressure moves per kg.
template <class T>
struct GasNear {
  T pressure_Pa;
  T temperature_K;
  T per_kg_out_Pa;
  T cooling;  ///< of the rest's temperature where some flows out, per fall of its pressure, both as shares: G / (1 + G)

  /// After a flow that moved its pressure.
  [[gnu::always_inline]] void move(const T& by_Pa) noexcept {
    temperature_K += where(by_Pa < NumberOf<T>{0}, cooling * temperature_K * (by_Pa / pressure_Pa));
    pressure_Pa += by_Pa;
  }
};

/// Effective areas at both ends of a step, what is behind, and how far the near pressure moves per kg that comes in.
template <class T>
struct Opening {
  T from_m2, to_m2;
  BeyondOf<T> far;
  T per_kg_in_Pa;
};

/// Flow into the near side, kg/s, such that it is the orifice's flow at the pressures that it leads to over `time_s`.
/// Neither pressure passes the other, whatever the time.
///
/// With w = v A psi_c / sqrt(R T1), in pressures so that no area is too small to square: choked, v is the pressure
/// upstream; else x_c v^2 = D (2 P - D / x_c), where D = d - k v is what is left of the difference and P = p1 - u v of
/// the pressure upstream.
template <class T>
[[nodiscard, gnu::always_inline]] inline T implicit_flow(const Opening<T>& at, const GasNear<T>& near, const T& far_Pa,
                                                         const T& time_s) noexcept {
  using Real = NumberOf<T>;
  constexpr Real kPer = kPerChokedDrop<Real>;
  return branch<T>(
      near.pressure_Pa >= far_Pa, [&](auto out) __attribute__((always_inline)) {
        const T d = magnitude(far_Pa - near.pressure_Pa);
        const T per_Pa = at.to_m2 * either<T>(
                                        out, [&] { return choked_per_Pa(near.temperature_K); },
                                        [&] { return at.far.choked_per_Pa; });
        const T reach = per_Pa * time_s;
        const T near_falls = reach * pick(out, near.per_kg_out_Pa, at.per_kg_in_Pa);
        const T far_falls = reach * at.far.response_Pa_kg;
        const T k = near_falls + far_falls;
        const T begin_Pa = pick(out, near.pressure_Pa, far_Pa), u = pick(out, near_falls, far_falls);
        // What flows out leaves the rest cooler, and so flows faster.
        const T cooling = where(out, near.cooling);
        const T choked_Pa = begin_Pa / (Real{1} + u - static_cast<Real>(0.5) * cooling * u);
        const auto unchoked = [&]() __attribute__((always_inline)) {
          const T e0 = Real{2} * begin_Pa - kPer * d;
          const T e1 = kPer * k - Real{2} * u;
          const T lead = kChokedDrop<Real> + k * e1;
          const T half = static_cast<Real>(0.5) * (k * e0 - d * e1);
          const T square = d * e0;
          const T inner = half * half + lead * square;
          const T root = square_root(inner > Real{0} ? inner : T{});
          T above = square, below = half + root;
          if (const auto digits_lost = half < Real{0}; any(digits_lost))
            above = pick(digits_lost, root - half, above), below = pick(digits_lost, lead, below);
          const T v = above / (below + static_cast<Real>(1e-30));
          // That is at the temperature of before: one step of Newton's method, from a slope that is the root.
          return short_cut<T>(
              none_of(out), [&] { return v; },
              [&] {
                const T cooler = kChokedDrop<Real> * cooling * u * v / begin_Pa;
                return v + cooler * (v * v) / (Real{2} * root - cooler * v + static_cast<Real>(1e-30));
              });
        };
        const T v = either<T>(
            d - k * choked_Pa >= kChokedDrop<Real> * (begin_Pa - u * choked_Pa), [&] { return choked_Pa; }, unchoked);
        return negative_where(out, per_Pa * v);
      });
}

/// What an opening gets through in a step before its implicit part does.
template <class T>
struct EarlyFlow {
  T flow_kg_s_m2;  ///< at the start of the step
  T per_kg_Pa;     ///< by which a kg of it moves the near pressure
  T stiffness;     ///< of the step

  /// `begin` is how the near side stood before the step.
  [[nodiscard, gnu::always_inline]] static EarlyFlow of(const Opening<T>& at, const GasPoint<T>& begin,
                                                        const GasNear<T>& near, NumberOf<T> step_s) noexcept {
    using Real = NumberOf<T>;
    const Orifice<T> flow = Orifice<T>::at(begin.pressure_Pa, begin.temperature_K, at.far);
    const T per_kg_Pa = pick(flow.flow_kg_s_m2 > Real{0}, at.per_kg_in_Pa, near.per_kg_out_Pa);
    const T mean_m2 = (at.from_m2 + at.to_m2) * static_cast<Real>(0.5);
    return {flow.flow_kg_s_m2, per_kg_Pa, per_kg_Pa * step_s * mean_m2 * flow.slope_kg_s_m2_Pa};
  }

  /// Whether there is flow, and a part of it is small enough and does not by itself take the pressures past one
  /// another.
  [[nodiscard, gnu::always_inline]] auto may_be(const T& part_kg, const T& near_Pa,
                                                const GasBeyond<T>& far) const noexcept {
    using Real = NumberOf<T>;
    const T near_part_Pa = part_kg * per_kg_Pa;
    const T far_part_Pa = part_kg * far.response_Pa_kg;
    const T apart_Pa = near_Pa - far.pressure_Pa;
    const T after_Pa = apart_Pa + (near_part_Pa + far_part_Pa);
    constexpr Real kMax = static_cast<Real>(0.25);
    return both_hold(
        both_hold(flow_kg_s_m2 != Real{0}, apart_Pa * after_Pa >= Real{0}),
        both_hold(magnitude(near_part_Pa) <= kMax * near_Pa, magnitude(far_part_Pa) <= kMax * far.pressure_Pa));
  }
};

/// A manifold at the end of a step in which `part_kg` of an opening flows before its implicit part. Where flows are
/// `calm`, all through other ports stay as they were, but for what this one changes, which was `as_was_kg`.
template <class T, class Holds>
[[nodiscard, gnu::always_inline]] inline T left_Pa(const GasBeyond<T>& far, const T& part_kg, const Holds& calm,
                                                   const T& as_was_kg) noexcept {
  using Real = NumberOf<T>;
  const T least_Pa = static_cast<Real>(0.25) * far.pressure_Pa, most_Pa = Real{4} * far.pressure_Pa;
  const T moved_Pa = where(calm, far.as_was_Pa + far.response_Pa_kg * as_was_kg);
  const T left = far.end_Pa + (moved_Pa - far.response_Pa_kg * part_kg);
  const T held = left > least_Pa ? left : least_Pa;
  return held < most_Pa ? held : most_Pa;
}

/// The share of a step that is explicit.
template <class T>
[[nodiscard, gnu::always_inline]] inline T explicit_share(const T& stiffness) noexcept {
  using Real = NumberOf<T>;
  return Real{3} / (Real{6} + stiffness);
}

/// Into the near side in the step, and by how much a kg moves its pressure.
template <class T>
struct PortFlow {
  T mass_kg, per_kg_Pa;

  [[nodiscard, gnu::always_inline]] static PortFlow of(const T& mass_kg, const Opening<T>& at,
                                                       const GasNear<T>& near) noexcept {
    return {mass_kg, pick(mass_kg > NumberOf<T>{0}, at.per_kg_in_Pa, near.per_kg_out_Pa)};
  }
};

/// Of one opening. `begin` is how the near side stood before the step.
template <class T>
[[nodiscard, gnu::always_inline]] inline PortFlow<T> one_port_flow(const Opening<T>& at, const GasPoint<T>& begin,
                                                                   GasNear<T> near, NumberOf<T> step_s) noexcept {
  const EarlyFlow<T> early = EarlyFlow<T>::of(at, begin, near, step_s);
  const T part_s = explicit_share(early.stiffness) * step_s;
  const T all_kg = part_s * at.from_m2 * early.flow_kg_s_m2;
  const auto may = early.may_be(all_kg, near.pressure_Pa, at.far);
  const T part_kg = where(may, all_kg);
  const T time_s = step_s - where(may, part_s);
  near.move(part_kg * early.per_kg_Pa);
  const T far_Pa = left_Pa<T>(at.far, part_kg, may, step_s * at.from_m2 * early.flow_kg_s_m2);
  return PortFlow<T>::of(part_kg + time_s * implicit_flow(at, near, far_Pa, time_s), at, near);
}

}  // namespace crankloop::detail

// One elastic valve: its step in a contact regime, the guards of that step, and which contacts its state requires.
// docs/model.md "Valve".
//
// What belongs here: what holds at one moment, and over one step without an event. What does not: a step with events
// (event_location.hpp), the valves of an engine (elastic_valves.hpp).
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/tables/lift_curve.hpp>
#include <crankloop/tables/valve_tables.hpp>
#include <crankloop/tick/lanes.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop::detail {

template <class Real>
struct ValveState {
  Real lift_m;
  Real velocity_m_s;
};

/// A valve's state and its contact regime.
template <class Real>
struct ValveInRegime {
  ValveState<Real> state;
  std::uint32_t regime;
};

/// The result of a step, and what it added to the lift before rounding: the difference of two lifts has too few bits
/// left.
template <class Number>
struct Stepped {
  ValveState<Number> state;
  Number increment_m;
};

/// How cams turn during a step.
template <class Real>
struct CamTurn {
  Real deg;  ///< with sign
  Real deg_per_s;
};

/// One of n equal parts of a phase difference; per_n_32 = 2^32 / n, rounded. By 32-bit multiplications.
[[nodiscard]] constexpr std::uint64_t part_of(std::int64_t units, std::uint32_t per_n_32) noexcept {
  const auto bits = static_cast<std::uint64_t>(units);
  const std::int64_t high = static_cast<std::int32_t>(static_cast<std::uint32_t>(bits >> 32));
  const std::uint64_t low = (bits & 0xFFFF'FFFFu) * per_n_32 >> 32;
  return static_cast<std::uint64_t>(high * static_cast<std::int64_t>(std::uint64_t{per_n_32})) + low;
}

/// Gas force on the head, toward the seat, linear over a step.
template <class Number>
struct GasForce {
  Number from_N, to_N;

  template <class Held>
  [[nodiscard]] constexpr Number rest(const ForceRow<Held>& f) const noexcept {
    return f.rest + f.gas * to_N;
  }
  template <class Held>
  [[nodiscard]] constexpr Number drive(const StepRow<Held>& row) const noexcept {
    return row.rest + row.gas * from_N + row.gas_rise * (to_N - from_N);
  }
  /// A coefficient times the force at the step's start, and times what it rises from there.
  [[nodiscard]] constexpr Number at_start(Number coefficient) const noexcept { return coefficient * from_N; }
  [[nodiscard]] constexpr Number risen(Number coefficient) const noexcept { return coefficient * (to_N - from_N); }
  /// Where it holds a closed valve at the step's end, and where at its start.
  [[nodiscard]] constexpr Number resting_m(Number per_seat_N_m) const noexcept { return -to_N * per_seat_N_m; }
  [[nodiscard]] constexpr Number rested_m(Number per_seat_N_m) const noexcept { return -from_N * per_seat_N_m; }
  /// Held as it is at the step's start.
  [[nodiscard]] constexpr GasForce before() const noexcept { return {from_N, from_N}; }
  [[nodiscard]] constexpr GasForce between(Number from, Number to) const noexcept {
    return {from_N + (to_N - from_N) * from, from_N + (to_N - from_N) * to};
  }
};

/// The gas force of a scene without gas on the heads.
template <class Number>
struct NoGasForce {
  static constexpr int from_N = 0, to_N = 0;
  template <class Held>
  [[nodiscard]] static constexpr const Held& rest(const ForceRow<Held>& f) noexcept {
    return f.rest;
  }
  template <class Held>
  [[nodiscard]] static constexpr const Held& drive(const StepRow<Held>& row) noexcept {
    return row.rest;
  }
  [[nodiscard]] static constexpr Number at_start(Number) noexcept { return Number{}; }
  [[nodiscard]] static constexpr Number risen(Number) noexcept { return Number{}; }
  [[nodiscard]] static constexpr Number resting_m(Number) noexcept { return Number{}; }
  [[nodiscard]] static constexpr NoGasForce before() noexcept { return {}; }
  [[nodiscard]] static constexpr NoGasForce between(Number, Number) noexcept { return {}; }
};

/// A step in a regime, for a cam's lift that is the cubic through its ends.
template <class Held, class Number, class Real, class Gas>
[[nodiscard]] constexpr Stepped<Number> stepped(const RegimeStep<Held>& regime, const ValveState<Number>& s,
                                                const Lift<Number>& from, const Lift<Number>& to, Real deg,
                                                const Gas& gas) noexcept {
  const Number gap = from.lift_m - s.lift_m;
  const Number rise = to.lift_m - from.lift_m;
  const Number from_slope = deg * from.per_deg_m;
  const Number to_slope = deg * to.per_deg_m;
  const auto more = [&](const StepRow<Held>& r) -> Number {
    return gas.drive(r) + r.rise * rise + (r.from * from_slope + r.to * to_slope) + r.gap * gap +
           (r.lift * s.lift_m + r.velocity * s.velocity_m_s);
  };
  const Number increment_m = more(regime.lift);
  return {{s.lift_m + increment_m, s.velocity_m_s + more(regime.velocity)}, increment_m};
}

/// Adds to a wide step what the cam's lift in its middle differs from the cubic through its ends.
template <class Held, class Number, class Real>
[[nodiscard]] constexpr Stepped<Number> with_middle(const Stepped<Number>& end, const MiddleStep<Held>& by,
                                                    const Lift<Number>& from, Number middle_m, const Lift<Number>& to,
                                                    Real deg) noexcept {
  const Number cubic_m = (to.lift_m - from.lift_m) / 2 + deg * (from.per_deg_m - to.per_deg_m) / 8;
  const Number more_m = middle_m - from.lift_m - cubic_m;
  const Number higher_m = by.lift * more_m;
  return {{end.state.lift_m + higher_m, end.state.velocity_m_s + by.velocity * more_m}, end.increment_m + higher_m};
}

/// y'' by the forces of a regime; the gas force as at the end of its step.
template <class Held, class Number, class Gas>
[[nodiscard]] constexpr Number acceleration(const ForceRow<Held>& f, const ValveState<Number>& s, Number compression_m,
                                            Number compression_speed_m_s, const Gas& gas) noexcept {
  return gas.rest(f) + f.lift * s.lift_m + f.velocity * s.velocity_m_s +
         (f.gap * compression_m + f.gap_speed * compression_speed_m_s);
}

/// Of the train on the valve; it pushes only.
template <class Real>
[[nodiscard, gnu::always_inline]] constexpr Real train_force_N(const ValveBody<Real>& b, std::uint32_t contacts,
                                                               Real compression_m,
                                                               Real compression_speed_m_s) noexcept {
  const Real force_N = b.train_N_m * compression_m + b.train_Ns_m * compression_speed_m_s;
  return (contacts & kTrainOn) != 0 && force_N > 0 ? force_N : Real{0};
}

/// A guard: it passes where the contact cannot have changed during the step.
template <class Held, class Number>
[[nodiscard]] constexpr auto passes(const ContactGuard<Held>& g, Number place_m, Number speed_m_s) noexcept {
  return g.sign * place_m - g.lag_s * magnitude(speed_m_s) > g.least_m;
}

/// Where steps started, by lane: event location goes back there if a guard fails. One array, so that a lane's numbers
/// have one address.
template <class Real, std::size_t Lanes>
struct BeforeStep {
  Real of[5 * Lanes];  ///< lifts, and from these rows on:
  static constexpr std::size_t kVelocity = Lanes, kIncrement = 2 * Lanes, kCamLift = 3 * Lanes, kCamPerDeg = 4 * Lanes;

  constexpr void keep(std::size_t lane, const ValveState<Real>& s, Real rise, const Lift<Real>& cam) noexcept {
    Real* const at = of + lane;
    at[0] = s.lift_m, at[kVelocity] = s.velocity_m_s, at[kIncrement] = rise;
    at[kCamLift] = cam.lift_m, at[kCamPerDeg] = cam.per_deg_m;
  }
  [[nodiscard]] constexpr ValveState<Real> state(std::size_t lane) const noexcept {
    return {of[lane], of[lane + kVelocity]};
  }
  [[nodiscard]] constexpr Lift<Real> cam(std::size_t lane) const noexcept {
    return {of[lane + kCamLift], of[lane + kCamPerDeg]};
  }
  [[nodiscard]] constexpr Real increment_m(std::size_t lane) const noexcept { return of[lane + kIncrement]; }
};

/// Whether a state requires the train's contact: its depth and its force are both positive.
template <class Real>
[[nodiscard]] constexpr bool requires_train(const ValveMotion<Real>& m, const ValveState<Real>& s,
                                            const Lift<Real>& lift, Real deg_per_s) noexcept {
  const Real depth_m = lift.lift_m - s.lift_m;
  return depth_m > 0 && depth_m + m.train_lag_s * (deg_per_s * lift.per_deg_m - s.velocity_m_s) > 0;
}

/// The contacts that a state requires: those whose depth and whose force are both positive.
template <class Real>
[[nodiscard]] constexpr std::uint32_t required_contacts(const ValveMotion<Real>& m, const ValveState<Real>& s,
                                                        const Lift<Real>& lift, Real deg_per_s) noexcept {
  const Real seat_m = m.body.seat_compression_m - s.lift_m;
  const bool train = requires_train(m, s, lift, deg_per_s);
  const bool seat = seat_m > 0 && seat_m - m.seat_lag_s * s.velocity_m_s > 0;
  return (train ? kTrainOn : 0u) | (seat ? kSeatOn : 0u);
}

/// No valve lifts so far: one that does is put back (put_back()).
inline constexpr double kMaxLift_m = 1;

/// A valve at rest where its cam stands. Decided by forces, at the places where a contact begins: on a soft seat a
/// difference of lifts would be less than their rounding. Without a spring the division by its rate has no meaning, and
/// is not used.
template <class Real>
[[nodiscard]] __attribute__((no_sanitize("float-divide-by-zero"))) constexpr ValveInRegime<Real> in_equilibrium(
    const ValveMotion<Real>& m, Real lift_m, Real gas_N) noexcept {
  const ValveBody<Real>& b = m.body;
  CRANKLOOP_ASSERT(b.train_N_m > 0 && b.seat_N_m > 0);
  CRANKLOOP_ASSERT(is_finite(lift_m) && is_finite(gas_N));
  const Real down_N = b.preload_N + gas_N;
  const Real just_off_N = down_N + b.spring_N_m * b.seat_compression_m;  // what holds it down where the seat ends
  const bool sucked_open = just_off_N < 0;
  const Real off_seat_m = down_N + b.spring_N_m * static_cast<Real>(kMaxLift_m) < 0 ? static_cast<Real>(kMaxLift_m)
                                                                                    : -down_N / b.spring_N_m;
  const Real alone_m = sucked_open ? off_seat_m : -gas_N * m.per_seat_N_m;
  if (!(lift_m > alone_m)) return {{alone_m, Real{0}}, sucked_open ? 0u : kSeatOn};
  if (b.train_N_m * (lift_m - b.seat_compression_m) > just_off_N) {
    return {{(b.train_N_m * lift_m - down_N) / (b.train_N_m + b.spring_N_m), Real{0}}, kTrainOn};
  }
  return {{(b.train_N_m * lift_m - gas_N) / (b.train_N_m + b.seat_N_m + b.spring_N_m), Real{0}}, kTrainOn | kSeatOn};
}

/// A valve that is nowhere, put back at rest: on its seat, or onto its cam where that stands higher.
template <class Real>
[[nodiscard]] constexpr ValveInRegime<Real> put_back(const ValveMotion<Real>& m, Real cam_lift_m) noexcept {
  CRANKLOOP_ASSERT(is_finite(cam_lift_m));
  const Real lift_m = cam_lift_m > 0 ? cam_lift_m : Real{0};
  return {{lift_m, Real{0}}, lift_m < m.body.seat_compression_m ? kSeatOn : 0u};
}

/// A valve in equilibrium whose cam turns, in the motion of one that its cam has carried for long: at the cam's speed
/// by the stiffnesses, and off its seat deflected by inertia and guide too. Where the train would have to pull, the
/// valve is free.
template <class Real>
[[nodiscard]] constexpr ValveInRegime<Real> carried_along(const ValveMotion<Real>& m, const ValveInRegime<Real>& valve,
                                                          const Lift<Real>& cam, Real per_deg2_m,
                                                          Real deg_per_s) noexcept {
  if ((valve.regime & kTrainOn) == 0) return valve;
  const ValveBody<Real>& b = m.body;
  const bool seated = (valve.regime & kSeatOn) != 0;
  const Real stiffness_N_m = b.train_N_m + b.spring_N_m + (seated ? b.seat_N_m : Real{0});
  const Real cam_m_s = deg_per_s * cam.per_deg_m;
  const Real share = b.train_N_m / stiffness_N_m;
  const Real velocity_m_s = share * cam_m_s;
  const Real back_N = b.mass_kg * share * (per_deg2_m * (deg_per_s * deg_per_s)) + b.guide_Ns_m * velocity_m_s;
  const Real lift_m = seated ? valve.state.lift_m : valve.state.lift_m - back_N / stiffness_N_m;
  const bool carried = lift_m < cam.lift_m;
  const ValveState<Real> s{carried ? lift_m : cam.lift_m, carried ? velocity_m_s : cam_m_s};
  return {s, required_contacts(m, s, cam, deg_per_s)};
}

/// A bound of the amplitude with which a valve oscillates on its seat about the place where it would rest.
template <class Real>
[[nodiscard]] constexpr Real seated_amplitude_m(const ValveMotion<Real>& m, const ValveState<Real>& s,
                                                Real resting_m) noexcept {
  return magnitude(s.lift_m - resting_m) + magnitude(s.velocity_m_s) * m.per_seat_rate_s;
}

}  // namespace crankloop::detail

// The plain step of several valves at once, one in each lane.
//
// What belongs here: what lanes need side by side, and their step. What does not: the arithmetic of a step (valve.hpp), lanes whose guards fail
// (valve_changes.hpp), which valves an engine has (valves_step.hpp).
//
// A resting valve is zeros under its regime's constants: it stays at rest, and needs no exception.
#pragma once

#include <crankloop/tick/io.hpp>
#include <crankloop/tick/lanes.hpp>
#include <crankloop/tick/valve.hpp>

#if CRANKLOOP_ABREAST
namespace crankloop::detail {

/// Lanes of a number side by side, at their first.
template <class Lanes, class Work>
[[nodiscard, gnu::always_inline]] inline RegimeStep<Lanes> regime_at(const Work& w, std::size_t first) noexcept {
  int number = 0;
  const auto next = [&] { return load<Lanes>(&w.regime[number++][first]); };
  RegimeStep<Lanes> r;
  for (StepRow<Lanes>* row : {&r.lift, &r.velocity}) {
    row->rest = next(), row->gas = next(), row->gas_rise = next(), row->gap = next(), row->rise = next();
    row->from = next(), row->to = next(), row->lift = next(), row->velocity = next();
  }
  ForceRow<Lanes>& a = r.acceleration;
  a.rest = next(), a.gas = next(), a.lift = next(), a.velocity = next(), a.gap = next(), a.gap_speed = next();
  for (ContactGuard<Lanes>* guard : {&r.train, &r.seat}) guard->sign = next(), guard->lag_s = next(), guard->least_m = next();
  r.rest_m = next(), r.rest_m_s = next();
  return r;
}

/// A lane is in this regime from now on.
template <class Work>
inline void set_regime(Work& w, std::size_t lane, const RegimeStep<float>& regime) noexcept {
  float numbers[sizeof regime / sizeof(float)];
  static_assert(sizeof numbers == sizeof regime && sizeof numbers / sizeof(float) == sizeof w.regime / sizeof w.regime[0]);
  std::memcpy(numbers, &regime, sizeof regime);
  for (std::size_t i = 0; i < sizeof numbers / sizeof(float); ++i) w.regime[i][lane] = numbers[i];
}

template <class Work>
inline void take_segment(Work& w, std::size_t lane, const LiftCurve<float>& curve, std::uint32_t degree) noexcept {
  w.degree[lane] = degree;
  if (degree >= curve.segments) {
    for (std::size_t i = 0; i < 6; ++i) w.segment[i][lane] = i == 0 ? curve.outside_m : 0.0F;
  } else {
    for (std::size_t i = 0; i < 6; ++i) w.segment[i][lane] = curve.at[degree].c[i];
  }
}

/// Where a lane's cam stands in its degree, in units of 2^-24 of it; a lane that enters another degree takes its coefficients along.
template <class Work>
[[nodiscard, gnu::always_inline]] inline std::int32_t enter(Work& w, std::size_t lane, const LiftCurve<float>& curve, std::uint64_t since_opening) noexcept {
  const std::uint64_t parts = (since_opening >> 32) * kDegreesPerTurn;  // as LiftCurve::cell
  const auto degree = static_cast<std::uint32_t>(parts >> 32);
  if (degree != w.degree[lane]) take_segment(w, lane, curve, degree);
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(parts) >> 8);
}

/// Lanes before their step, where some of them are not sure: for their look at the contacts.
template <std::size_t Room>
struct BeforeStep {
  float lift_m[Room], velocity_m_s[Room], rise_m[Room], cam_lift_m[Room], cam_per_deg_m[Room];
};

/// The plain step of a block of lanes, `into` their places in their degrees. State and output are left as if all were sure; answers a bit for each
/// that is not. `look`: some lane is looked at whatever its guards say.
template <class Lanes, class Work, class State, std::size_t Room>
[[nodiscard, gnu::always_inline]] inline std::uint32_t step_block(Work& w, State& state, std::size_t first, const std::int32_t* into, const Lanes& deg,
                                                                  const Lanes& deg_per_s, bool look, BeforeStep<Room>& before, float* shown) noexcept {
  const RegimeStep<Lanes> regime = regime_at<Lanes>(w, first);
  const ValveState<Lanes> start{load<Lanes>(&state.valve_lift_m[first]), load<Lanes>(&state.valve_velocity_m_s[first])};
  const Lift<Lanes> from{load<Lanes>(&w.cam_lift_m[first]), load<Lanes>(&w.cam_per_deg_m[first])};
  const Lanes at = whole_numbers<Lanes>(into + first) * 0x1p-24F;
  Lanes slope = load<Lanes>(&w.segment[5][first]);
  Lanes value = load<Lanes>(&w.segment[4][first]) + at * slope;
  for (int i = 3; i >= 0; --i) {  // as LiftCurve::read
    slope = value + at * slope;
    value = load<Lanes>(&w.segment[i][first]) + at * value;
  }
  const Lift<Lanes> to{value, slope};
  const Stepped<Lanes> step = stepped(regime, start, from, to, deg, NoGasForce<Lanes>{});
  const Lanes gap = to.lift_m - step.state.lift_m;
  const Lanes gap_speed = deg_per_s * to.per_deg_m - step.state.velocity_m_s;
  const auto sure = holds(regime.train, gap, gap_speed) & holds(regime.seat, load<Lanes>(&w.sink_m[first]) - step.state.lift_m, step.state.velocity_m_s);
  const auto still = (magnitude(step.state.lift_m) < regime.rest_m) & (magnitude(step.state.velocity_m_s) < regime.rest_m_s);
  const ValveState<Lanes> end{still ? Lanes{} : step.state.lift_m, still ? Lanes{} : step.state.velocity_m_s};
  store<Lanes>(&state.valve_lift_m[first], end.lift_m);
  store<Lanes>(&state.valve_velocity_m_s[first], end.velocity_m_s);
  store<Lanes>(&w.cam_lift_m[first], to.lift_m);
  store<Lanes>(&w.cam_per_deg_m[first], to.per_deg_m);
  store_lanes(to.lift_m > Lanes{} ? to.lift_m : Lanes{}, end.lift_m, end.velocity_m_s,
              acceleration(regime.acceleration, end, to.lift_m - end.lift_m, deg_per_s * to.per_deg_m - end.velocity_m_s, NoGasForce<Lanes>{}), shown);
  if (!look && all_hold(sure)) return 0;
  store<Lanes>(&before.lift_m[first], start.lift_m);
  store<Lanes>(&before.velocity_m_s[first], start.velocity_m_s);
  store<Lanes>(&before.rise_m[first], step.rise_m);
  store<Lanes>(&before.cam_lift_m[first], from.lift_m);
  store<Lanes>(&before.cam_per_deg_m[first], from.per_deg_m);
  return failing(sure);
}

}  // namespace crankloop::detail
#endif

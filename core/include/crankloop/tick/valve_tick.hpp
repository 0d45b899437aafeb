// One valve over one tick: whole steps where no contact changes, fine steps where one may, the change itself located.
//
// What belongs here: the order of a valve's tick. What does not: the physics of a step (valve.hpp), which valves an engine has
// (engine_step.hpp).
//
//     tick  |-----------------|-----------------|      `steps` whole steps, one cam look-up and one matrix each;
//                              |--|--|--|--|--|        where a gap may close or a force may end: `fine_per_step` fine ones;
//                                    |-x--|            where one does: a power series up to x, the new regime from there
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/tick/valve_results.hpp>
#include <crankloop/tick/valve_series.hpp>

namespace crankloop {

/// All that one valve train's motion reads.
template <class Real>
struct ValveMotion {
  ValveBody<Real> body;
  std::uint32_t steps;          ///< whole steps per tick
  std::uint32_t fine_per_step;
  Real per_steps;               ///< 1 / steps
  Real per_fine;                ///< 1 / fine_per_step
  Real step_s;                  ///< tick / steps
  Real fine_s;
  Real widest_step_deg;         ///< cam degrees beyond which the lift over a whole step is no quintic any more
  Real rest_m;                  ///< nearer than this to its rest, and slower than rest_m_s, a closed valve sleeps
  Real rest_m_s;
  Real quiet_m;                 ///< |y| + |v| / seat rate below this cannot lift a valve off its seat
  Real per_seat_rate_s;         ///< 1 / frequency on the seat alone
  StepMatrix<Real> whole[4];    ///< per regime
  StepMatrix<Real> fine[4];
};

/// How a cam moves during a tick.
template <class Real>
struct CamTurn {
  std::uint64_t from;    ///< phase units since the lobe opened, 2^64 = 360 cam deg, at the tick's start
  std::uint64_t to;      ///< at its end
  Real turned_deg;       ///< cam degrees between them, with sign
};

/// Contact changes that may still be located in this tick, over all valves. What exceeds it is taken at the end of its fine step.
struct EventBudget {
  std::uint32_t left;
  bool exceeded;
};

/// The start of a tick's part `i` of `n`.
template <class Real>
[[nodiscard]] constexpr std::uint64_t part_way(std::uint64_t from, std::uint64_t to, Real turned_deg, std::uint32_t i, std::uint32_t n,
                                               Real per_n) noexcept {
  if (i == n) return to;
  const Real part = static_cast<Real>(static_cast<std::int32_t>(i)) * per_n;
  return from + Phase::from_cycles(turned_deg * part * static_cast<Real>(1.0 / 360)).units();
}

namespace detail {

template <class Real>
[[nodiscard]] constexpr Real magnitude(Real x) noexcept {
  return x < 0 ? -x : x;
}

/// The least of four numbers is above `bound`.
template <class Real>
[[nodiscard]] constexpr bool all_above(const Real (&x)[4], Real bound) noexcept {
  return x[0] > bound && x[1] > bound && x[2] > bound && x[3] > bound;
}
template <class Real>
[[nodiscard]] constexpr bool all_below(const Real (&x)[4], Real bound) noexcept {
  return x[0] < bound && x[1] < bound && x[2] < bound && x[3] < bound;
}

/// Bezier ordinates of the cubic through two values and slopes (slopes times the step): the curve lies between the least and the largest.
template <class Real>
constexpr void bezier(Real from, Real slope_from, Real to, Real slope_to, Real (&ordinates)[4]) noexcept {
  constexpr Real kThird = static_cast<Real>(1.0 / 3);
  ordinates[0] = from;
  ordinates[1] = from + slope_from * kThird;
  ordinates[2] = to - slope_to * kThird;
  ordinates[3] = to;
}

/// True when no contact can change in a whole step from a to b, as far as the cubics through its ends tell, with a margin: gaps keep their
/// side, the train's force keeps its sign. The seat must be off: its own
/// vibration is faster than a whole step, and nothing could be told.
template <class Real>
[[nodiscard]] constexpr bool far_from_change(const ValveBody<Real>& body, std::uint32_t regime, ValveState<Real> a, ValveState<Real> b,
                                             const LiftStep<Real>& lift, Real step_s) noexcept {
  constexpr Real kMargin_m = static_cast<Real>(2e-6);
  Real y[4];
  bezier(a.lift_m, a.velocity_m_s * step_s, b.lift_m, b.velocity_m_s * step_s, y);
  if (!all_above(y, body.seat_sink_m + kMargin_m)) return false;
  const Real gap_a = lift.at[0] - a.lift_m;
  const Real gap_b = lift.at[1] - b.lift_m;
  const Real closing_a = lift.at[2] - a.velocity_m_s * step_s;
  const Real closing_b = lift.at[3] - b.velocity_m_s * step_s;
  Real gap[4];
  bezier(gap_a, closing_a, gap_b, closing_b, gap);
  if ((regime & kTrainOn) == 0) return all_below(gap, -kMargin_m);
  if (!all_above(gap, kMargin_m)) return false;
  // Force / k = gap + (b / k) gap'; the slope of the cubic is a quadratic, written as a cubic's ordinates too.
  const Real lag = body.train_Ns_m / (body.train_N_m * step_s);
  const Real middle = 3 * (gap_b - gap_a) - closing_a - closing_b;
  constexpr Real kThird = static_cast<Real>(1.0 / 3);
  const Real slope[4] = {closing_a, (closing_a + 2 * middle) * kThird, (2 * middle + closing_b) * kThird, closing_b};
  const Real force[4] = {gap[0] + lag * slope[0], gap[1] + lag * slope[1], gap[2] + lag * slope[2], gap[3] + lag * slope[3]};
  return all_above(force, kMargin_m);
}

}  // namespace detail

/// Advances one valve by a tick and keeps its record. O(steps * fine_per_step + events): bounded by the tables and the budget.
template <class Real, class Record>
class ValveTick {
 public:
  constexpr ValveTick(const ValveMotion<Real>& motion, const LiftCurve<Real>& curve, Real gas_N, EventBudget& budget, Record& record) noexcept
      : motion_{motion}, curve_{curve}, gas_N_{gas_N}, budget_{budget}, record_{record} {}

  /// The lift where the last advance() ended.
  [[nodiscard]] constexpr const Lift<Real>& lift() const noexcept { return lift_; }

  constexpr void advance(ValveCondition<Real>& valve, const CamTurn<Real>& cam) noexcept {
    const Cell start = LiftCurve<Real>::cell(cam.from);
    const Lift<Real> lift_at_start = curve_.read(start);
    const Cell end = LiftCurve<Real>::cell(cam.to);
    lift_ = curve_.read(end);
    // Off the lobe nothing comes: with a clearance the train does not touch, without one it touches and does not move.
    const bool off_lobe = start.degree >= curve_.segments && end.degree >= curve_.segments;
    const bool cam_is_away =
        (off_lobe || lash_open(lift_at_start, lift_)) && detail::magnitude(cam.turned_deg) < kLobeNotSkipped_deg && held_by_spring();
    if (valve.asleep != 0 && cam_is_away) return;
    if (valve.asleep != 0) {  // wake where the gas holds the valve on its seat
      valve.state = {-gas_N_ / (motion_.body.seat_N_m + motion_.body.spring_N_m), Real{0}};
      valve.asleep = 0;
    }
    const Real step_deg = cam.turned_deg * motion_.per_steps;
    Place from{cam.from, lift_at_start, degrees(start)};
    for (std::uint32_t i = 1; i <= motion_.steps; ++i) {
      const std::uint64_t next = part_way(cam.from, cam.to, cam.turned_deg, i, motion_.steps, motion_.per_steps);
      const Place to{next, curve_.read(LiftCurve<Real>::cell(next)), from.deg + step_deg};
      if (!whole_step(valve, from, to, step_deg)) fine_steps(valve, from, next, step_deg);
      from = to;
    }
    fall_asleep(valve, cam_is_away);
  }

 private:
  static constexpr Real kLeastLash_m = static_cast<Real>(1e-6);     ///< with more of it at both ends of a tick a closed valve is left alone,
  static constexpr Real kLobeNotSkipped_deg = static_cast<Real>(30);  ///< unless the tick is so long that a lobe might fit into it

  /// The cam at a step's end.
  struct Place {
    std::uint64_t phase;
    Lift<Real> lift;
    Real deg;  ///< since the start of the lobe
  };

  /// Cam degrees since the start of the lobe; negative in the half of the base circle before it.
  [[nodiscard]] constexpr Real degrees(Cell cell) const noexcept {
    const auto degree = static_cast<std::int32_t>(cell.degree);
    const bool before = 2 * degree > static_cast<std::int32_t>(curve_.segments) + kDegreesPerTurn;
    return static_cast<Real>(before ? degree - kDegreesPerTurn : degree) + fraction<Real>(cell);
  }

  [[nodiscard]] constexpr Real force_N(std::uint32_t regime) const noexcept { return constant_force_N(motion_.body, regime, gas_N_); }

  /// Suction on the head leaves the spring enough to hold the valve on its seat.
  [[nodiscard]] constexpr bool held_by_spring() const noexcept { return gas_N_ > -motion_.body.preload_N / 2; }

  [[nodiscard]] static constexpr bool lash_open(const Lift<Real>& from, const Lift<Real>& to) noexcept {
    return from.lift_m < -kLeastLash_m && to.lift_m < -kLeastLash_m;
  }

  /// A valve that only trembles on its seat, with the lash open: its vibration dies away and cannot reach a contact.
  [[nodiscard]] constexpr bool quiet(const ValveCondition<Real>& valve, const Place& from, const Place& to) const noexcept {
    if (valve.regime != kSeatOn || !lash_open(from.lift, to.lift) || !held_by_spring()) return false;
    return detail::magnitude(valve.state.lift_m) + detail::magnitude(valve.state.velocity_m_s) * motion_.per_seat_rate_s < motion_.quiet_m;
  }

  /// Takes a whole step if no contact can change in it.
  constexpr bool whole_step(ValveCondition<Real>& valve, const Place& from, const Place& to, Real step_deg) noexcept {
    if (detail::magnitude(step_deg) > motion_.widest_step_deg) return false;
    const bool on_seat = (valve.regime & kSeatOn) != 0;
    if (on_seat && !quiet(valve, from, to)) return false;
    const LiftStep<Real> lift = lift_step(from.lift, to.lift, step_deg);
    const ValveState<Real> after = stepped(motion_.whole[valve.regime], valve.state, lift, force_N(valve.regime), (valve.regime & kTrainOn) != 0);
    if (!on_seat && !detail::far_from_change(motion_.body, valve.regime, valve.state, after, lift, motion_.step_s)) return false;
    note(valve.state, after, lift, valve.regime, from.deg, to.deg, motion_.step_s);
    valve.state = after;
    return true;
  }

  constexpr void fine_steps(ValveCondition<Real>& valve, Place from, std::uint64_t end, Real step_deg) noexcept {
    const std::uint64_t begin = from.phase;
    const Real fine_deg = step_deg * motion_.per_fine;
    for (std::uint32_t i = 1; i <= motion_.fine_per_step; ++i) {
      const std::uint64_t next = part_way(begin, end, step_deg, i, motion_.fine_per_step, motion_.per_fine);
      const Place to{next, curve_.read(LiftCurve<Real>::cell(next)), from.deg + fine_deg};
      const LiftStep<Real> lift = lift_step(from.lift, to.lift, fine_deg);
      const ValveState<Real> after = stepped(motion_.fine[valve.regime], valve.state, lift, force_N(valve.regime), (valve.regime & kTrainOn) != 0);
      const std::uint32_t asked = contacts(motion_.body, after, to.lift.lift_m, lift.at[3] / motion_.fine_s).regime();
      if (asked == valve.regime) {
        note(valve.state, after, lift, valve.regime, from.deg, to.deg, motion_.fine_s);
        valve.state = after;
      } else if (budget_.left == 0) {
        budget_.exceeded = true;
        note(valve.state, after, lift, valve.regime, from.deg, to.deg, motion_.fine_s);
        record_.change(valve.regime, asked, after.velocity_m_s, to.deg);
        valve = {after, asked, 0};
      } else {
        change_contacts(valve, lift, from.deg, fine_deg);
      }
      from = to;
    }
  }

  /// The step in which a contact changes: by the series up to the change, on in the new regime, until the step's end.
  constexpr void change_contacts(ValveCondition<Real>& valve, const LiftStep<Real>& lift, Real from_deg, Real fine_deg) noexcept {
    StepSeries<Real> series(motion_.body, lift, motion_.fine_s);
    for (Real at = 0; at < 1;) {
      series.expand(at, valve.state, valve.regime, gas_N_);
      std::uint32_t changed = 0;
      const Real next = budget_.left > 0 ? series.first_change(valve.regime, changed) : Real{1};
      const ValveState<Real> after = series.state(next);
      note_part(series, valve, after, at, next, from_deg, fine_deg);
      valve.state = after;
      at = next;
      if (changed == 0) return;
      --budget_.left;
      record_.change(valve.regime, valve.regime ^ changed, after.velocity_m_s, from_deg + next * fine_deg);
      valve.regime ^= changed;
      note_part(series, valve, after, next, next, from_deg, fine_deg);  // the force of a damper begins with a jump
    }
  }

  constexpr void note(ValveState<Real> before, ValveState<Real> after, const LiftStep<Real>& lift, std::uint32_t regime, Real from_deg, Real to_deg,
                      Real step_s) noexcept {
    if constexpr (std::is_same_v<Record, NoRecord<Real>>) return;
    const Real per_s = 1 / step_s;
    const Real speed = lift.at[3] * per_s;
    record_.step({before, after, lift.at[0], lift.at[1], lift.at[2] * per_s, speed,
                  acceleration(motion_.body, regime, after, lift.at[1], speed, gas_N_), from_deg, to_deg, step_s, regime},
                 motion_.body.seat_sink_m);
  }

  constexpr void note_part(const StepSeries<Real>& series, const ValveCondition<Real>& valve, ValveState<Real> after, Real at, Real next,
                           Real from_deg, Real fine_deg) noexcept {
    if constexpr (std::is_same_v<Record, NoRecord<Real>>) return;
    const LiftNow<Real> begin = series.lift(at);
    const LiftNow<Real> end = series.lift(next);
    record_.step({valve.state, after, begin.lift_m, end.lift_m, begin.speed_m_s, end.speed_m_s,
                  acceleration(motion_.body, valve.regime, after, end.lift_m, end.speed_m_s, gas_N_), from_deg + at * fine_deg,
                  from_deg + next * fine_deg, (next - at) * motion_.fine_s, valve.regime},
                 motion_.body.seat_sink_m);
  }

  /// A closed valve that has come to rest is put exactly at rest: it costs nothing, and no denormal numbers.
  constexpr void fall_asleep(ValveCondition<Real>& valve, bool cam_is_away) noexcept {
    if (!cam_is_away || valve.regime != kSeatOn) return;
    const Real off_m = valve.state.lift_m + gas_N_ / (motion_.body.seat_N_m + motion_.body.spring_N_m);
    const Real speed_m_s = valve.state.velocity_m_s;
    if (detail::magnitude(off_m) >= motion_.rest_m || detail::magnitude(speed_m_s) >= motion_.rest_m_s) return;
    valve.state = {Real{0}, Real{0}};
    valve.asleep = 1;
  }

  const ValveMotion<Real>& motion_;
  const LiftCurve<Real>& curve_;
  Real gas_N_;
  EventBudget& budget_;
  Record& record_;
  Lift<Real> lift_{};
};

}  // namespace crankloop

// The steps of a valve's tick: how long they are, where they end, how the lift runs over them; and when a valve is at rest.
//
// What belongs here: what needs no history of the tick. What does not: the order of a tick (valve_tick.hpp), the physics of a step
// (valve.hpp).
#pragma once

#include <cstdint>

#include <crankloop/tick/valve_tables.hpp>

namespace crankloop {

/// How a train's cams move during a tick, the same for all cylinders.
template <class Real>
struct CamTurn {
  std::int64_t turned;   ///< phase units, 2^64 = 360 cam deg
  Real turned_deg;       ///< cam degrees, with sign
  Real deg_per_s;
};

/// One of n equal parts of a phase difference; per_n_32 = 2^32 / n, rounded. By 32-bit multiplications.
[[nodiscard]] constexpr std::uint64_t part_of(std::int64_t units, std::uint32_t per_n_32) noexcept {
  const auto bits = static_cast<std::uint64_t>(units);
  const std::int64_t high = static_cast<std::int32_t>(static_cast<std::uint32_t>(bits >> 32));
  const std::uint64_t low = (bits & 0xFFFF'FFFFu) * per_n_32 >> 32;
  return static_cast<std::uint64_t>(high * static_cast<std::int64_t>(std::uint64_t{per_n_32})) + low;
}

/// One tick of the valves of a train, cut into steps: made once per tick, used for each of them.
template <class Real>
class ValveSteps {
 protected:
  static constexpr Real kLeastLash_m = static_cast<Real>(kLeastLash);  ///< with more of it a closed valve is left alone

  constexpr ValveSteps(const ValveMotion<Real>& motion, const LiftCurve<Real>& curve, const CamTurn<Real>& cam) noexcept
      : motion_{motion},
        curve_{curve},
        cam_{cam},
        whole_{stride_of(motion, motion.whole, cam.turned_deg)},
        leaps_{magnitude(cam.turned_deg) >= curve.leap_deg},
        one_step_{motion.whole.parts == 1 && whole_.width != Width::too_wide} {}

  /// Where a step begins, its length in cam degrees and in seconds.
  struct Span {
    std::uint64_t from;
    Real deg;
    Real s;
    Real per_s;
  };

  /// How the lift runs over a step: a cubic through its ends, a quintic through its middle too, or neither.
  enum class Width : std::uint32_t { cubic, through_middle, too_wide };

  /// Steps of a level in this tick.
  struct Stride {
    const StepLevel<Real>& level;
    Real deg;  ///< of the cam
    Width width;
  };
  [[nodiscard]] static constexpr Stride stride_of(const ValveMotion<Real>& motion, const StepLevel<Real>& level, Real turned_deg) noexcept {
    const Real step_deg = turned_deg * level.per_parts;
    const Real deg = magnitude(step_deg);
    if (deg <= motion.short_step_deg) return {level, step_deg, Width::cubic};
    return {level, step_deg, deg <= motion.widest_step_deg ? Width::through_middle : Width::too_wide};
  }

  /// The cam's phases at the ends of a whole step.
  struct Reach {
    std::uint64_t from, to;
  };

  /// The ends of a level's steps.
  struct Parts {
    std::uint32_t count;
    std::uint64_t part;
    constexpr Parts(const StepLevel<Real>& level, const Reach& reach) noexcept
        : count{level.parts}, part{count == 1 ? 0 : part_of(static_cast<std::int64_t>(reach.to - reach.from), level.per_parts_32)} {}
    /// The end of the i-th of them, i from 1: the last ends at `to`.
    [[nodiscard]] constexpr std::uint64_t next(std::uint32_t i, std::uint64_t at, std::uint64_t to) const noexcept {
      return i == count ? to : at + part;
    }
  };

  /// The i-th whole step of a tick that ends at `to`, i from 0.
  [[nodiscard]] constexpr Reach reach_of(std::uint32_t i, std::uint64_t to) const noexcept {
    const Reach tick{to - static_cast<std::uint64_t>(cam_.turned), to};
    const Parts parts(motion_.whole, tick);
    const std::uint64_t from = tick.from + i * parts.part;
    return {from, parts.next(i + 1, from, to)};
  }

  [[nodiscard]] constexpr LiftStep<Real> between(const Lift<Real>& from, const Lift<Real>& to, Real deg) const noexcept {
    return {from.lift_m, to.lift_m, deg * from.per_deg_m, deg * to.per_deg_m};
  }

  [[nodiscard]] LiftMiddle<Real> middle(std::uint64_t from, std::uint64_t to, Real deg) const noexcept {
    const std::uint64_t half = static_cast<std::uint64_t>(static_cast<std::int64_t>(to - from) / 2);
    const Lift<Real> lift = curve_.read(LiftCurve<Real>::cell(from + half));
    return {lift.lift_m, deg * lift.per_deg_m};
  }

  /// A step that the train drives.
  template <class Gas>
  [[nodiscard]] constexpr ValveState<Real> carried(ValveState<Real> state, const Stride& stride, const LiftStep<Real>& step, std::uint64_t from,
                                                   std::uint64_t to, const Gas& gas) const noexcept {
    const StepMatrix<Real>& matrix = stride.level.matrix[kTrainOn];
    return stride.width == Width::cubic ? stepped(matrix, state, gas, step) : stepped(matrix, state, gas, step, middle_apart(from, to, stride.deg));
  }

  /// A call of its own: wide steps are seldom, and the others need not walk round this code.
  [[nodiscard, gnu::noinline]] LiftMiddle<Real> middle_apart(std::uint64_t from, std::uint64_t to, Real deg) const noexcept { return middle(from, to, deg); }

  /// One of the fine steps from one place to another.
  struct FineStep {
    Lift<Real> end;
    LiftStep<Real> lift;
    LiftMiddle<Real> middle;
    bool wide;
    Span span;
  };
  [[nodiscard]] FineStep fine_step(const Lift<Real>& begin, std::uint32_t taken, const Reach& reach) const noexcept {
    const StepLevel<Real>& level = motion_.fine;
    const Stride stride = stride_of(motion_, level, whole_.deg);
    const Parts parts(level, reach);
    const std::uint64_t at = reach.from + taken * parts.part;
    const std::uint64_t next = parts.next(taken + 1, at, reach.to);
    const bool wide = stride.width != Width::cubic;
    FineStep s{curve_.read(LiftCurve<Real>::cell(next)), {}, {}, wide, {at, stride.deg, level.step_s, level.per_step_s}};
    s.lift = between(begin, s.end, stride.deg);
    if (wide) s.middle = middle(at, next, stride.deg);
    return s;
  }

  /// A closed valve at rest: where the gas holds it on its seat.
  template <class Gas>
  [[nodiscard]] constexpr ValveState<Real> resting(const Gas& gas) const noexcept {
    return {-gas.force_N() * motion_.per_seat_N_m, Real{0}};
  }

  template <class Gas>
  [[nodiscard]] constexpr bool at_rest(ValveState<Real> s, const Gas& gas) const noexcept {
    const Real off_m = s.lift_m + gas.force_N() * motion_.per_seat_N_m;
    return magnitude(off_m) < motion_.rest_m && magnitude(s.velocity_m_s) < motion_.rest_m_s;
  }

  /// A vibration on the seat that can neither lift the valve off it nor swing it up by so much of lash. (On a soft seat that is the nearer.)
  [[nodiscard]] constexpr bool trembles(ValveState<Real> s, Real lash_m) const noexcept {
    const Real swing_m = magnitude(s.lift_m) + magnitude(s.velocity_m_s) * motion_.per_seat_rate_s;
    return swing_m < motion_.quiet_m && swing_m < lash_m;
  }

  /// A valve that only trembles on its seat, by less than the lash that is open: its vibration dies away and reaches no contact.
  template <class Gas>
  [[nodiscard]] constexpr bool quiet(const ValveCondition<Real>& valve, const Lift<Real>& to, const Gas& gas) const noexcept {
    const Real least_m = -(valve.train.lift_m > to.lift_m ? valve.train.lift_m : to.lift_m);
    return valve.regime == kSeatOn && least_m > kLeastLash_m && gas.leaves_closed(motion_.body) && trembles(valve.state, least_m);
  }

  const ValveMotion<Real>& motion_;
  const LiftCurve<Real>& curve_;
  const CamTurn<Real>& cam_;
  Stride whole_;
  bool leaps_;     ///< may pass over all of the lobe where the train touches a closed valve
  bool one_step_;  ///< the tick is one whole step, over which the lift is known
};

}  // namespace crankloop

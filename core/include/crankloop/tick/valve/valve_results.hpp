// What a valve did in a cycle: lift, float, seating, bounce. Recorded in the solver, step by step, not from the samples
// that a tick outputs.
//
// What belongs here: the record of a cycle and its rules (docs/model.md "Separation and bounce"). What does not: the
// motion (event_location.hpp).
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/scene.hpp>
#include <crankloop/tick/valve/valve.hpp>

namespace crankloop {

/// One cycle of one valve, from the middle of the base circle to the next. Angles are cam degrees since the start of
/// the lobe.
template <class Real>
struct ValveCycle {
  Real largest_lift_m;
  Real largest_speed_m_s;          ///< magnitude
  Real largest_acceleration_m_s2;  ///< magnitude
  Real opening_delay_deg;          ///< valve against theory at 0.1 mm of lift
  Real separation_clearance_m;     ///< largest y - Y while the train carries nothing before the valve seats
  Real separation_start_deg;       ///< of the separation with the largest gap
  Real separation_duration_deg;    ///< of that one
  Real seating_speed_m_s;          ///< at the first contact with the seat
  Real bounce_height_m;            ///< largest lift above the seat's contact after a lift-off from it
  std::uint32_t separations;       ///< with a gap of at least kMinSeparation_m
  std::uint32_t bounces;           ///< lift-offs that rise by at least kMinSeparation_m
  std::uint32_t contact_changes;
  std::uint32_t off_seat_at_end;  ///< 1: still off its seat in the middle of the base circle
};

namespace detail {

/// A step as the record sees it.
template <class Real>
struct ObservedStep {
  ValveState<Real> from, to;
  Real theory_from_m, theory_to_m;  ///< Y
  Real theory_speed_from_m_s, theory_speed_to_m_s;
  Real acceleration_from_m_s2, acceleration_to_m_s2;
  Real step_s;
  std::uint32_t regime;  ///< throughout the step
};

template <class Real, class S>
struct StateFields;

/// The cycle in progress.
template <class Real>
class ValveRecord {
  template <class, class>
  friend struct detail::StateFields;  // to save it: tick/state/state_fields.hpp

 public:
  static constexpr Real kMinSeparation_m = static_cast<Real>(1e-6);
  static constexpr Real kOpened_m = static_cast<Real>(0.1e-3);

  /// deg_at(fraction of the step): cam degrees since the start of the lobe. Seldom called.
  template <class DegAt>
  constexpr void step(const ObservedStep<Real>& s, Real seat_contact_m, const DegAt& deg_at) noexcept {
    const Real lift = peak(s.from.lift_m, s.from.velocity_m_s, s.to.lift_m, s.to.velocity_m_s, s.step_s);
    raise(cycle_.largest_lift_m, lift);
    raise(cycle_.largest_speed_m_s, magnitude(s.to.velocity_m_s));
    raise(cycle_.largest_acceleration_m_s2,
          magnitude(s.acceleration_from_m_s2));  // a damper's force begins with a jump
    raise(cycle_.largest_acceleration_m_s2, magnitude(s.acceleration_to_m_s2));
    record_opening(s, deg_at);
    if (s.theory_speed_from_m_s > 0 && s.theory_speed_to_m_s <= 0 && s.theory_to_m > 0) flags_ |= kClosing;
    if (stage_ == Stage::seated && (s.regime & kSeatOn) == 0) {
      raise(excursion_m_, lift - seat_contact_m);
    }
    if (stage_ == Stage::open && s.regime == 0) {
      if (!is(kSeparated)) flags_ |= kSeparated, excursion_m_ = 0, separated_at_deg_ = deg_at(Real{0});
      raise(excursion_m_, peak(s.from.lift_m - s.theory_from_m, s.from.velocity_m_s - s.theory_speed_from_m_s,
                               s.to.lift_m - s.theory_to_m, s.to.velocity_m_s - s.theory_speed_to_m_s, s.step_s));
    }
  }

  /// A step of a valve that stays on its seat, its cam on the base circle.
  constexpr void rest(const ValveState<Real>& to, Real acceleration_m_s2) noexcept {
    raise(cycle_.largest_lift_m, to.lift_m);
    raise(cycle_.largest_speed_m_s, magnitude(to.velocity_m_s));
    raise(cycle_.largest_acceleration_m_s2, magnitude(acceleration_m_s2));
  }

  /// The maxima so far.
  struct Maxima {
    Real lift_m, speed_m_s, acceleration_m_s2;
  };
  [[nodiscard]] constexpr Maxima maxima() const noexcept {
    return {cycle_.largest_lift_m, cycle_.largest_speed_m_s, cycle_.largest_acceleration_m_s2};
  }
  constexpr void set_maxima(const Maxima& x) noexcept {
    cycle_.largest_lift_m = x.lift_m, cycle_.largest_speed_m_s = x.speed_m_s;
    cycle_.largest_acceleration_m_s2 = x.acceleration_m_s2;
  }
  /// In these contacts, and while neither cam nor valve lifts so far, a step changes nothing but the maxima.
  [[nodiscard]] constexpr Real only_maxima_below_m(std::uint32_t contacts) const noexcept {
    constexpr Real kAny = static_cast<Real>(1e30);
    if (stage_ == Stage::closed) return kOpened_m;
    const bool flies = stage_ == Stage::open ? contacts == 0 : (contacts & kSeatOn) == 0;
    return flies ? -kAny : kAny;
  }

  /// An event: contacts changed at `at_deg`.
  constexpr void event(std::uint32_t before, std::uint32_t after, Real velocity_m_s, Real at_deg) noexcept {
    ++cycle_.contact_changes;
    if (is(kSeparated) && after != 0) end_separation(at_deg);
    const bool landed = (after & ~before & kSeatOn) != 0;
    if (landed && stage_ == Stage::open && is(kClosing)) {
      stage_ = Stage::seated;
      cycle_.seating_speed_m_s = -velocity_m_s;
      excursion_m_ = 0;
    } else if (landed && stage_ == Stage::seated) {
      end_hop();
    }
  }

  /// Ends the cycle and begins the next. A valve still in the air is reported as it is.
  [[nodiscard]] constexpr ValveCycle<Real> finish(Real at_deg, std::uint32_t regime) noexcept {
    if (is(kSeparated)) end_separation(at_deg);
    if (stage_ == Stage::seated) end_hop();
    cycle_.off_seat_at_end = (regime & kSeatOn) != 0 ? 0 : 1;
    const ValveCycle<Real> done = cycle_;
    *this = ValveRecord{};
    return done;
  }

 private:
  // Open from 0.1 mm of lift; seated from the first contact behind full lift: one before it ends the flight of the
  // cycle before.
  enum class Stage : std::uint32_t { closed, open, seated };

  static constexpr std::uint32_t kTheoryOpened = 1;  // the cam has passed 0.1 mm
  static constexpr std::uint32_t kSeparated = 2;
  static constexpr std::uint32_t kClosing = 4;  // the cam is behind its full lift
  [[nodiscard]] constexpr bool is(std::uint32_t flag) const noexcept { return (flags_ & flag) != 0; }

  static constexpr void raise(Real& largest, Real x) noexcept {
    if (x > largest) largest = x;
  }

  /// Largest value of a cubic through two values and slopes, as far as its slope's secant finds it.
  [[nodiscard]] static constexpr Real peak(Real from, Real slope_from, Real to, Real slope_to, Real step_s) noexcept {
    const Real larger = from > to ? from : to;
    if (!(slope_from > 0 && slope_to < 0)) return larger;
    const Real at = slope_from / (slope_from - slope_to);
    const Real rise = to - from;
    const Real a = slope_from * step_s;
    const Real b = slope_to * step_s;
    const Real inner = from + at * (a + at * ((3 * rise - 2 * a - b) + at * (a + b - 2 * rise)));
    return inner > larger ? inner : larger;
  }

  /// Part of a step after which the cubic through two values and slopes (by time) reaches kOpened_m, by bisection and a
  /// secant at last: once or twice in a cycle.
  [[nodiscard, gnu::cold, gnu::noinline]] static constexpr Real part_opened(Real from, Real slope_from, Real to,
                                                                            Real slope_to, Real step_s) noexcept {
    const Real rise = to - from;
    const Real a = slope_from * step_s;
    const Real b = slope_to * step_s;
    CRANKLOOP_ASSERT(from < kOpened_m && to >= kOpened_m);
    Real low = 0, below_m = from;
    Real high = 1, above_m = to;
    for (int i = 0; i < 7; ++i) {
      const Real at = (low + high) / 2;
      const Real y = from + at * (a + at * ((3 * rise - 2 * a - b) + at * (a + b - 2 * rise)));
      if (y < kOpened_m)
        low = at, below_m = y;
      else
        high = at, above_m = y;
    }
    return low + (high - low) * ((kOpened_m - below_m) / (above_m - below_m));
  }

  /// The valve opens where it stands at 0.1 mm or above once the cam has passed that. One that was up before its cam
  /// has no delay: it is still in the air from the cycle before.
  template <class DegAt>
  constexpr void record_opening(const ObservedStep<Real>& s, const DegAt& deg_at) noexcept {
    if (stage_ != Stage::closed) return;
    if (!is(kTheoryOpened) && s.theory_from_m < kOpened_m && s.theory_to_m >= kOpened_m) {
      flags_ |= kTheoryOpened;
      theory_opened_deg_ =
          deg_at(part_opened(s.theory_from_m, s.theory_speed_from_m_s, s.theory_to_m, s.theory_speed_to_m_s, s.step_s));
    }
    if (!is(kTheoryOpened) || s.to.lift_m < kOpened_m) return;
    stage_ = Stage::open;
    if (s.from.lift_m >= kOpened_m) return;  // it was open before its cam was: no delay
    cycle_.opening_delay_deg =
        magnitude(deg_at(part_opened(s.from.lift_m, s.from.velocity_m_s, s.to.lift_m, s.to.velocity_m_s, s.step_s)) -
                  theory_opened_deg_);
  }

  constexpr void end_separation(Real at_deg) noexcept {
    CRANKLOOP_ASSERT(is(kSeparated));
    flags_ &= ~kSeparated;
    if (excursion_m_ < kMinSeparation_m) return;
    ++cycle_.separations;
    if (excursion_m_ <= cycle_.separation_clearance_m) return;
    cycle_.separation_clearance_m = excursion_m_;
    cycle_.separation_start_deg = separated_at_deg_;
    cycle_.separation_duration_deg = magnitude(at_deg - separated_at_deg_);
  }

  constexpr void end_hop() noexcept {
    if (excursion_m_ >= kMinSeparation_m) {
      ++cycle_.bounces;
      raise(cycle_.bounce_height_m, excursion_m_);
    }
    excursion_m_ = 0;
  }

  ValveCycle<Real> cycle_{};
  Real theory_opened_deg_ = 0;
  Real separated_at_deg_ = 0;
  Real excursion_m_ = 0;  ///< largest so far: gap of the separation, or lift of the hop
  Stage stage_ = Stage::closed;
  std::uint32_t flags_ = 0;
};

/// In scenes without results.
template <class Real>
struct NoRecord {};

}  // namespace detail

namespace group {

/// Results of the last whole cycle, [train][cylinder]; zero until there is one.
template <class Real, class S>
struct ValveResults {
  ValveCycle<Real> valve_cycle[S::trains.capacity][S::cylinders.capacity];
};
template <class Real, class S>
struct ValveRecords {
  detail::ValveRecord<Real> record[S::trains.capacity][S::cylinders.capacity];
};
}  // namespace group

}  // namespace crankloop

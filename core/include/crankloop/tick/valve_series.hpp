// Where inside a step a valve's contact changes.
//
// What belongs here: the motion within one step as a power series, and the first root of its switching functions. What does not: what
// happens then (valve_tick.hpp).
#pragma once

#include <cstddef>
#include <cstdint>

#include <crankloop/tick/valve.hpp>

namespace crankloop {

/// A polynomial in the part of a step.
template <class Real, int Order>
struct StepPolynomial {
  Real c[static_cast<std::size_t>(Order) + 1];

  /// Value, slope and half the curvature at once, by the part.
  struct At {
    Real value, slope, half_curvature;
  };
  [[nodiscard]] constexpr At at(Real x) const noexcept {
    At a{c[Order], Real{0}, Real{0}};
    for (int i = Order - 1; i >= 0; --i) {
      a.half_curvature = a.slope + x * a.half_curvature;
      a.slope = a.value + x * a.slope;
      a.value = c[i] + x * a.value;
    }
    return a;
  }
};

/// The motion inside one step as a power series: exact to (w d)^n / n!, d the step, w the regime's frequency, n one more than the order. It costs more
/// than a matrix and serves any part of a step, so contact changes are located on it.
template <class Real>
class StepSeries {
 public:
  /// w d is at most 0.3 in the 0.1 um class: 0.3^7 / 7! = 4e-8 is float's rounding, 0.3^10 / 10! = 2e-12 of a step's motion is nothing.
  static constexpr int kOrder = sizeof(Real) == 4 ? 6 : 9;

  constexpr StepSeries(const ValveBody<Real>& body, const LiftWithin<Real>& lift, Real step_s, Real per_step_s) noexcept
      : body_{body}, step_s_{step_s}, per_step_s_{per_step_s}, lift_{lift} {}

  /// Expands the motion about `at` (part of the step, 0 to 1) in a regime.
  constexpr void expand(Real at, ValveState<Real> s, std::uint32_t regime, Real gas_N) noexcept {
    lift_.shift(at - at_);
    at_ = at;
    const bool train = (regime & kTrainOn) != 0;
    const bool seat = (regime & kSeatOn) != 0;
    const Real by_force = step_s_ * step_s_ * body_.per_mass;
    const Real by_speed = step_s_ * body_.per_mass;
    const Real stiffness = (body_.spring_N_m + (train ? body_.train_N_m : Real{0}) + (seat ? body_.seat_N_m : Real{0})) * by_force;
    const Real damping = (body_.guide_Ns_m + (train ? body_.train_Ns_m : Real{0}) + (seat ? body_.seat_Ns_m : Real{0})) * by_speed;
    const Real lift_stiffness = train ? body_.train_N_m * by_force : Real{0};
    const Real lift_damping = train ? body_.train_Ns_m * by_speed : Real{0};
    auto& y = motion_.c;
    y[0] = s.lift_m;
    y[1] = s.velocity_m_s * step_s_;
    for (int n = 0; n + 2 <= kOrder; ++n) {
      // A preloaded seat carries the spring's preload.
      Real drive = n == 0 ? (seat ? -gas_N : -body_.preload_N - gas_N) * by_force : Real{0};
      if (n <= LiftWithin<Real>::kDegree) drive += lift_stiffness * lift_.coefficient(n);
      if (n < LiftWithin<Real>::kDegree) drive += lift_damping * static_cast<Real>(n + 1) * lift_.coefficient(n + 1);
      y[n + 2] = (drive - stiffness * y[n] - damping * static_cast<Real>(n + 1) * y[n + 1]) *
                 (Real{1} / static_cast<Real>((n + 1) * (n + 2)));
    }
  }

  [[nodiscard]] constexpr LiftNow<Real> lift(Real at) const noexcept {
    return {lift_.value(at - at_), lift_.slope(at - at_) * per_step_s_};
  }

  [[nodiscard]] constexpr ValveState<Real> state(Real at) const noexcept {
    const auto y = motion_.at(at - at_);
    return {y.value, y.slope * per_step_s_};
  }

  /// Where `regime` ends between the expansion and 1, if it has ended by then. `changes` tells which contact changes there; 0: none does.
  [[nodiscard]] Real first_change(std::uint32_t regime, std::uint32_t& changes) const noexcept {
    changes = 0;
    Real first = 1;
    const LiftNow<Real> train = lift(1);
    std::uint32_t ended = regime ^ contacts(body_, state(1), train.lift_m, train.speed_m_s).regime();
    while (ended != 0) {  // one after the other: seldom both
      const std::uint32_t contact = unknown((ended & kTrainOn) != 0 ? kTrainOn : kSeatOn);  // one search in the code, not one for each
      ended ^= contact;
      const Real at = crossing(contact, at_, 1, (regime & contact) == 0);
      if (changes == 0 || at < first) first = at, changes = contact;
    }
    return first;
  }

 private:
  /// The switching function of a contact: the smaller of its gap's force and its whole force. It acts while that is positive.
  class Switching {
   public:
    constexpr Switching(const StepSeries& series, std::uint32_t contact) noexcept {
      const ValveBody<Real>& b = series.body_;
      const bool train = contact == kTrainOn;
      spring_N_m_ = train ? b.train_N_m : b.seat_N_m;
      damper_Ns_ = (train ? b.train_Ns_m : b.seat_Ns_m) * series.per_step_s_;
      for (int n = 0; n <= kOrder; ++n) gap_.c[n] = (train && n <= LiftWithin<Real>::kDegree ? series.lift_.coefficient(n) : Real{0}) - series.motion_.c[n];
      if (!train) gap_.c[0] += b.seat_sink_m;
    }

    struct At {
      Real force_N;
      Real slope_N;  ///< by the part of the step
    };
    [[nodiscard]] constexpr At at(Real since_expansion) const noexcept {
      const auto gap = gap_.at(since_expansion);
      const Real pressed_N = damper_Ns_ * gap.slope;
      At s{spring_N_m_ * gap.value, spring_N_m_ * gap.slope};
      if (pressed_N < 0) s.force_N += pressed_N, s.slope_N += 2 * damper_Ns_ * gap.half_curvature;
      return s;
    }

   private:
    StepPolynomial<Real, kOrder> gap_;
    Real spring_N_m_;
    Real damper_Ns_;  ///< by the part of the step
  };

  /// Root of a switching function between two places of different sign: Newton's method from the secant's root, kept between them.
  [[nodiscard]] constexpr Real crossing(std::uint32_t contact, Real from, Real to, bool rising) const noexcept {
    constexpr int kSteps = sizeof(Real) == 4 ? 3 : 4;
    const Switching switching(*this, contact);
    const Real at_from = switching.at(from - at_).force_N;
    if ((at_from > 0) == rising) return from;  // it changed by rounding, where it stands
    const Real at_to = switching.at(to - at_).force_N;
    if ((at_to > 0) != rising) return to;
    Real at = to - at_to * (to - from) / (at_to - at_from);
    for (int i = 0; i < kSteps; ++i) {
      const typename Switching::At s = switching.at(at - at_);
      ((s.force_N > 0) == rising ? to : from) = at;
      Real next = (from + to) / 2;
      if (s.slope_N != Real{0}) {
        const Real newton = at - s.force_N / s.slope_N;
        if (newton >= from && newton <= to) next = newton;
      }
      at = next;
    }
    return at;
  }

  const ValveBody<Real>& body_;
  Real step_s_;
  Real per_step_s_;
  Real at_ = 0;
  LiftWithin<Real> lift_;
  StepPolynomial<Real, kOrder> motion_{};
};

}  // namespace crankloop

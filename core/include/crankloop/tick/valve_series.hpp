// Where inside a step a valve's contact changes.
//
// What belongs here: the motion within one step as a power series, and the first root of its switching functions. What does not: what
// happens then (valve_tick.hpp).
#pragma once

#include <cstddef>
#include <cstdint>

#include <crankloop/tick/valve.hpp>

namespace crankloop {

/// A polynomial in the part of a step, value and slope (by the part) at once.
template <class Real, int Order>
struct StepPolynomial {
  Real c[static_cast<std::size_t>(Order) + 1];

  constexpr void at(Real x, Real& value, Real& slope) const noexcept {
    slope = c[Order];
    value = c[Order - 1] + x * c[Order];
    for (int i = Order - 2; i >= 0; --i) {
      slope = value + x * slope;
      value = c[i] + x * value;
    }
  }
};

/// The motion inside one step as a power series: exact to (w d)^n / n!, d the step, w the regime's frequency, n the order. It costs more
/// than a matrix and serves any part of a step, so contact changes are located on it.
template <class Real>
class StepSeries {
 public:
  /// w d is at most 0.3 in the 0.1 um class: 0.3^8 / 8! is below float's rounding, 0.3^10 / 10! of a micrometre is nothing to double.
  static constexpr int kOrder = sizeof(Real) == 4 ? 7 : 9;

  constexpr StepSeries(const ValveBody<Real>& body, const LiftWithin<Real>& lift, Real step_s) noexcept
      : body_{body}, step_s_{step_s}, per_step_s_{Real{1} / step_s}, lift_{lift} {}

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
    for (int n = 0; n <= kOrder; ++n) gap_.c[n] = (n <= LiftWithin<Real>::kDegree ? lift_.coefficient(n) : Real{0}) - y[n];
  }

  [[nodiscard]] constexpr LiftNow<Real> lift(Real at) const noexcept {
    return {lift_.value(at - at_), lift_.slope(at - at_) * per_step_s_};
  }

  [[nodiscard]] constexpr ValveState<Real> state(Real at) const noexcept {
    Real y{};
    Real slope{};
    motion_.at(at - at_, y, slope);
    return {y, slope * per_step_s_};
  }

  /// The first place after the expansion at which `regime` ends, at most 1. `changes` tells which contact changes there; 0: none does.
  [[nodiscard]] constexpr Real first_change(std::uint32_t regime, std::uint32_t& changes) const noexcept {
    changes = 0;
    Real from = at_;
    for (const Real to : {at_ + (1 - at_) * static_cast<Real>(0.5), Real{1}}) {
      Real first = to;
      for (std::uint32_t contact = kTrainOn; contact <= kSeatOn; contact += contact) {
        const Real value = switching(contact, to);
        if ((value > 0) == ((regime & contact) != 0)) continue;
        const Real at = crossing(contact, from, to, value);
        if (changes == 0 || at < first) first = at, changes = contact;
      }
      if (changes != 0) return first;
      from = to;
    }
    return 1;
  }

 private:
  /// The switching function of a contact, in N: the smaller of its gap's force and its whole force. It acts while that is positive.
  [[nodiscard]] constexpr Real switching(std::uint32_t contact, Real at) const noexcept {
    Real value{};
    Real slope{};
    if (contact == kTrainOn) {
      gap_.at(at - at_, value, slope);
      const Real damper_N = body_.train_Ns_m * (slope * per_step_s_);
      return body_.train_N_m * value + (damper_N < 0 ? damper_N : Real{0});
    }
    motion_.at(at - at_, value, slope);
    const Real damper_N = -body_.seat_Ns_m * (slope * per_step_s_);
    return body_.seat_N_m * (body_.seat_sink_m - value) + (damper_N < 0 ? damper_N : Real{0});
  }

  /// Root of a switching function between two places of different sign (regula falsi, Illinois rule): the end on the far side.
  [[nodiscard]] constexpr Real crossing(std::uint32_t contact, Real from, Real to, Real at_to) const noexcept {
    constexpr int kSteps = sizeof(Real) == 4 ? 6 : 10;
    Real at_from = switching(contact, from);
    const bool rising = at_to > 0;
    if ((at_from > 0) == rising) return from;  // it changed by rounding, where it stands
    for (int i = 0; i < kSteps; ++i) {
      const Real at = to - at_to * (to - from) / (at_to - at_from);
      const Real value = switching(contact, at);
      if ((value > 0) == rising) {
        to = at, at_to = value, at_from = at_from / 2;
      } else {
        from = at, at_from = value, at_to = at_to / 2;
      }
    }
    return to;
  }

  const ValveBody<Real>& body_;
  Real step_s_;
  Real per_step_s_;
  Real at_ = 0;
  LiftWithin<Real> lift_;
  StepPolynomial<Real, kOrder> motion_{};
  StepPolynomial<Real, kOrder> gap_{};
};

}  // namespace crankloop

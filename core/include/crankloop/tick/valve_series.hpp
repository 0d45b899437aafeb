// Where inside a step a valve's contact changes.
//
// What belongs here: the motion within one step as a power series, and the first root of its switching functions. What does not: what
// happens then (valve_tick.hpp).
#pragma once

#include <cstdint>
#include <initializer_list>

#include <crankloop/tick/valve.hpp>

namespace crankloop {

/// The motion inside one step as a power series: exact to (w d)^9 / 9!, d the step, w the regime's frequency. It costs more than a matrix
/// and serves any part of a step, so contact changes are located on it.
template <class Real>
class StepSeries {
 public:
  static constexpr int kOrder = 9;

  constexpr StepSeries(const ValveBody<Real>& body, const LiftStep<Real>& lift, Real step_s) noexcept
      : body_{body}, step_s_{step_s}, lift_{lift} {}

  /// Expands the motion about `at` (part of the step, 0 to 1) in a regime.
  constexpr void expand(Real at, ValveState<Real> s, std::uint32_t regime, Real gas_N) noexcept {
    lift_.shift(at - at_);
    at_ = at;
    const bool train = (regime & kTrainOn) != 0;
    const bool seat = (regime & kSeatOn) != 0;
    const Real per_mass = step_s_ * step_s_ / body_.mass_kg;
    const Real stiffness = (body_.spring_N_m + (train ? body_.train_N_m : Real{0}) + (seat ? body_.seat_N_m : Real{0})) * per_mass;
    const Real damping = (body_.guide_Ns_m + (train ? body_.train_Ns_m : Real{0}) + (seat ? body_.seat_Ns_m : Real{0})) * per_mass / step_s_;
    const Real lift_stiffness = train ? body_.train_N_m * per_mass : Real{0};
    const Real lift_damping = train ? body_.train_Ns_m * per_mass / step_s_ : Real{0};
    motion_[0] = s.lift_m;
    motion_[1] = s.velocity_m_s * step_s_;
    for (int n = 0; n + 2 <= kOrder; ++n) {
      Real drive = n == 0 ? constant_force_N(body_, regime, gas_N) * per_mass : Real{0};
      if (n < 6) drive += lift_stiffness * lift_.coefficient(n);
      if (n < 5) drive += lift_damping * static_cast<Real>(n + 1) * lift_.coefficient(n + 1);
      motion_[n + 2] = (drive - stiffness * motion_[n] - damping * static_cast<Real>(n + 1) * motion_[n + 1]) *
                       (Real{1} / static_cast<Real>((n + 1) * (n + 2)));
    }
  }

  [[nodiscard]] constexpr LiftNow<Real> lift(Real at) const noexcept {
    return {lift_.value(at - at_), lift_.slope(at - at_) / step_s_};
  }

  [[nodiscard]] constexpr ValveState<Real> state(Real at) const noexcept {
    const Real x = at - at_;
    Real y = motion_[kOrder];
    Real v = static_cast<Real>(kOrder) * motion_[kOrder];
    for (int n = kOrder - 1; n > 0; --n) {
      y = motion_[n] + x * y;
      v = static_cast<Real>(n) * motion_[n] + x * v;
    }
    return {motion_[0] + x * y, v / step_s_};
  }

  [[nodiscard]] constexpr Contacts<Real> contacts_at(Real at) const noexcept {
    const Real x = at - at_;
    return contacts(body_, state(at), lift_.value(x), lift_.slope(x) / step_s_);
  }

  /// The first place after the expansion at which `regime` ends, at most 1. `changes` tells which contact changes there; 0: none does.
  [[nodiscard]] constexpr Real first_change(std::uint32_t regime, std::uint32_t& changes) const noexcept {
    constexpr int kLooks = 4;
    Real from = at_;
    changes = 0;
    for (int look = 1; look <= kLooks; ++look) {
      const Real to = look == kLooks ? Real{1} : at_ + (1 - at_) * (static_cast<Real>(look) / static_cast<Real>(kLooks));
      const std::uint32_t changed = contacts_at(to).regime() ^ regime;
      if (changed != 0) {
        Real first = to;
        for (const std::uint32_t contact : {kTrainOn, kSeatOn}) {
          if ((changed & contact) == 0) continue;
          const Real at = crossing(contact, from, to);
          if (changes == 0 || at < first) first = at, changes = contact;
        }
        return first;
      }
      from = to;
    }
    return 1;
  }

 private:
  /// The switching function of a contact: the smaller of its gap, as a force, and its force term.
  [[nodiscard]] constexpr Real switching(std::uint32_t contact, Real at) const noexcept {
    const Contacts<Real> c = contacts_at(at);
    const Real gap_N = contact == kTrainOn ? body_.train_N_m * c.gap_m : body_.seat_N_m * c.sink_m;
    const Real force_N = contact == kTrainOn ? c.train_N : c.seat_N;
    return gap_N < force_N ? gap_N : force_N;
  }

  /// Root of a switching function between two places of different sign (regula falsi, Illinois rule): the end on the far side.
  [[nodiscard]] constexpr Real crossing(std::uint32_t contact, Real from, Real to) const noexcept {
    constexpr int kSteps = sizeof(Real) == 4 ? 6 : 10;
    Real at_from = switching(contact, from);
    Real at_to = switching(contact, to);
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
  Real at_ = 0;
  LiftQuintic<Real> lift_;
  Real motion_[kOrder + 1] = {};
};

}  // namespace crankloop

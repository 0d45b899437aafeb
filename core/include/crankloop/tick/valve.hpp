// One elastic valve, advanced in time: docs/model.md "Valve".
//
// What belongs here: a step in a contact regime, and which regime the contacts ask for. What does not: where in a step it changes
// (valve_series.hpp), the order of a tick (valve_tick.hpp), the matrices' making (tabulate/valve_motion.hpp).
//
//         cam, rocker                 M y'' = F_train + F_seat - k_s y - P_s0 - c y' - F_gas
//             |  Y(t)                 gap g = Y - y:        F_train = k g + b g'       while both g and it are positive, else 0
//            k, b                     sink s = delta_0 - y: F_seat = k_z s - b_z y'    likewise
//             |
//           [ M ]  y                  Each of the four regimes (train on or off, seat on or off) is linear: a whole step is one constant
//           /   \                     matrix on (y, v), the lift at both ends of the step and a constant force.
//     spring     seat k_z, b_z
#pragma once

#include <cstdint>

#include <crankloop/tick/lift_curve.hpp>

namespace crankloop {

/// Bits of a contact regime.
inline constexpr std::uint32_t kTrainOn = 1;
inline constexpr std::uint32_t kSeatOn = 2;

/// The valve's constants, per unit mass where they multiply in the equation of motion.
template <class Real>
struct ValveBody {
  Real mass_kg;            ///< M
  Real train_N_m;          ///< k
  Real train_Ns_m;         ///< b
  Real seat_N_m;           ///< k_z
  Real seat_Ns_m;          ///< b_z
  Real spring_N_m;         ///< k_s
  Real guide_Ns_m;         ///< c
  Real preload_N;          ///< P_s0
  Real seat_sink_m;        ///< delta_0 = P_s0 / k_z
  Real head_area_m2;
  Real rocker_mass_kg;     ///< I_rocker / l_v^2
};

/// What a step adds to (y, v) = this times what drives it: increments, because in float a matrix near one would lose the stiffness of a
/// short step to rounding. Lift terms are Y0, Y1, then d Y' and d^2 Y'' at both ends, d the step.
template <class Real>
struct StepMatrix {
  struct Row {
    Real y, v;        ///< of the state before
    Real force;       ///< of the constant force in N
    Real lift[6];     ///< of Y0, Y1, d Y0', d Y1', d^2 Y0'', d^2 Y1''; read in regimes with the train on
  };
  Row y;
  Row v;
};

template <class Real>
struct ValveState {
  Real lift_m;
  Real velocity_m_s;
};

/// A valve between two ticks. Asleep = closed and exactly at rest.
template <class Real>
struct ValveCondition {
  ValveState<Real> state{};
  std::uint32_t regime = kSeatOn;
  std::uint32_t asleep = 1;
};

/// Lift at both ends of a step of length d, derivatives by time multiplied by d and d^2.
template <class Real>
struct LiftStep {
  Real at[6];
};

template <class Real>
[[nodiscard]] constexpr LiftStep<Real> lift_step(const Lift<Real>& from, const Lift<Real>& to, Real cam_deg_per_step) noexcept {
  const Real q = cam_deg_per_step;
  return {{from.lift_m, to.lift_m, q * from.per_deg_m, q * to.per_deg_m, q * q * from.per_deg2_m, q * q * to.per_deg2_m}};
}

/// Train lift and its speed at one moment.
template <class Real>
struct LiftNow {
  Real lift_m;
  Real speed_m_s;
};

/// The lift within a step as the quintic through both ends; `part` of the step, 0 to 1. Slopes are by the part: d times those by time.
template <class Real>
class LiftQuintic {
 public:
  constexpr explicit LiftQuintic(const LiftStep<Real>& lift) noexcept {
    const Real(&l)[6] = lift.at;
    const Real rise = l[1] - l[0] - l[2] - l[4] / 2;
    const Real slope = l[3] - l[2] - l[4];
    const Real curvature = l[5] - l[4];
    c_[0] = l[0];
    c_[1] = l[2];
    c_[2] = l[4] / 2;
    c_[3] = 10 * rise - 4 * slope + curvature / 2;
    c_[4] = -15 * rise + 7 * slope - curvature;
    c_[5] = 6 * rise - 3 * slope + curvature / 2;
  }

  [[nodiscard]] constexpr Real value(Real part) const noexcept {
    return c_[0] + part * (c_[1] + part * (c_[2] + part * (c_[3] + part * (c_[4] + part * c_[5]))));
  }
  [[nodiscard]] constexpr Real slope(Real part) const noexcept {
    return c_[1] + part * (2 * c_[2] + part * (3 * c_[3] + part * (4 * c_[4] + part * (5 * c_[5]))));
  }
  [[nodiscard]] constexpr Real coefficient(int i) const noexcept { return c_[i]; }

  /// Moves the origin by x (repeated synthetic division).
  constexpr void shift(Real x) noexcept {
    for (int i = 0; i < 5; ++i) {
      for (int j = 4; j >= i; --j) c_[j] += x * c_[j + 1];
    }
  }

 private:
  Real c_[6] = {};
};

/// Force that does not depend on the motion: the spring's preload where the seat does not carry it, and the gas.
template <class Real>
[[nodiscard]] constexpr Real constant_force_N(const ValveBody<Real>& body, std::uint32_t regime, Real gas_N) noexcept {
  return (regime & kSeatOn) != 0 ? -gas_N : -body.preload_N - gas_N;
}

template <class Real>
[[nodiscard]] constexpr ValveState<Real> stepped(const StepMatrix<Real>& m, ValveState<Real> s, const LiftStep<Real>& lift, Real force_N,
                                                 bool train_on) noexcept {
  Real more_y = m.y.y * s.lift_m + m.y.v * s.velocity_m_s + m.y.force * force_N;
  Real more_v = m.v.y * s.lift_m + m.v.v * s.velocity_m_s + m.v.force * force_N;
  if (train_on) {
    for (int i = 0; i < 6; ++i) {
      more_y += m.y.lift[i] * lift.at[i];
      more_v += m.v.lift[i] * lift.at[i];
    }
  }
  return {s.lift_m + more_y, s.velocity_m_s + more_v};
}

/// The smaller of gap and force term of each contact: it acts while that is positive.
template <class Real>
struct Contacts {
  Real gap_m;          ///< g = Y - y
  Real train_N;        ///< k g + b g'
  Real sink_m;         ///< s = delta_0 - y
  Real seat_N;         ///< k_z s - b_z v

  [[nodiscard]] constexpr std::uint32_t regime() const noexcept {
    return (gap_m > 0 && train_N > 0 ? kTrainOn : 0u) | (sink_m > 0 && seat_N > 0 ? kSeatOn : 0u);
  }
};

template <class Real>
[[nodiscard]] constexpr Contacts<Real> contacts(const ValveBody<Real>& b, ValveState<Real> s, Real lift_m, Real lift_speed_m_s) noexcept {
  const Real gap = lift_m - s.lift_m;
  const Real sink = b.seat_sink_m - s.lift_m;
  return {gap, b.train_N_m * gap + b.train_Ns_m * (lift_speed_m_s - s.velocity_m_s), sink,
          b.seat_N_m * sink - b.seat_Ns_m * s.velocity_m_s};
}

/// The train's force in a regime: zero unless it is on.
template <class Real>
[[nodiscard]] constexpr Real train_force_N(std::uint32_t regime, const Contacts<Real>& c) noexcept {
  return (regime & kTrainOn) != 0 && c.train_N > 0 ? c.train_N : Real{0};
}
template <class Real>
[[nodiscard]] constexpr Real seat_force_N(std::uint32_t regime, const Contacts<Real>& c) noexcept {
  return (regime & kSeatOn) != 0 && c.seat_N > 0 ? c.seat_N : Real{0};
}

/// y'' from the forces.
template <class Real>
[[nodiscard]] constexpr Real acceleration(const ValveBody<Real>& b, std::uint32_t regime, ValveState<Real> s, Real lift_m, Real lift_speed_m_s,
                                          Real gas_N) noexcept {
  const Contacts<Real> c = contacts(b, s, lift_m, lift_speed_m_s);
  return (train_force_N(regime, c) + seat_force_N(regime, c) - b.spring_N_m * s.lift_m - b.preload_N - b.guide_Ns_m * s.velocity_m_s - gas_N) /
         b.mass_kg;
}

}  // namespace crankloop

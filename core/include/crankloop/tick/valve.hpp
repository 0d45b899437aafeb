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
//           /   \                     matrix on (y, v), the gap, the lift's rise and its slopes at both ends of the
//                                   step (a wide step: in its middle too), and a constant force.
//     spring     seat k_z, b_z
#pragma once

#include <cstdint>

#include <crankloop/tick/lift_curve.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop {

/// Bits of a contact regime.
inline constexpr std::uint32_t kTrainOn = 1;
inline constexpr std::uint32_t kSeatOn = 2;

/// The valve's constants.
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
  Real per_mass;           ///< 1 / M
};

/// Train lift that drives a step, at both ends; slopes by the part of the step, 0 to 1: d Y', d the step.
template <class Real>
struct LiftStep {
  Real from_m, to_m;
  Real from_slope_m, to_slope_m;
};

/// The same in the middle of a step too long for a cubic between its ends.
template <class Real>
struct LiftMiddle {
  Real at_m;
  Real slope_m;
};

/// What a step adds to (y, v) = this times what drives it: increments, because in float a matrix near one would lose the stiffness of a
/// short step to rounding; and by the gap and the lift's rise instead of the lift, because a lift times the train's stiffness is a large
/// number that the valve's own nearly cancels. A short step takes the lift as the cubic through its ends, a wide one as the quintic through
/// its ends and middle.
template <class Real>
struct StepMatrix {
  struct Row {
    Real y, v;        ///< of the state before
    Real rest;        ///< of the spring's preload, where the seat does not carry it
    Real gas;         ///< of each N of gas force
    Real gap;         ///< train on, as all below: of the gap before
    Real lift[3];     ///< short step: of the rise from its start to its end, and of the slopes there
    Real wide[5];     ///< wide step: of those three, the rise to its middle and the slope there
  };
  Row y;
  Row v;
};

template <class Real>
struct ValveState {
  Real lift_m;
  Real velocity_m_s;
};

/// Sleep of a closed valve. Asleep: exactly at rest. Settling: on its seat, the lash open, with a vibration that cannot reach a contact and
/// dies away. Neither reads the lift.
inline constexpr std::uint32_t kAwake = 0;
inline constexpr std::uint32_t kAsleep = 1;
inline constexpr std::uint32_t kSettling = 2;

/// A valve between two ticks, and the train's lift there: kept while it is awake.
template <class Real>
struct ValveCondition {
  ValveState<Real> state{};
  Lift<Real> train{};
  std::uint32_t regime = kSeatOn;
  std::uint32_t sleep = kAsleep;
};

/// Train lift and its speed at one moment.
template <class Real>
struct LiftNow {
  Real lift_m;
  Real speed_m_s;
};

/// The lift within a step as a polynomial; `part` of the step, 0 to 1. Slopes are by the part.
template <class Real>
class LiftWithin {
 public:
  static constexpr int kDegree = 5;

  /// The cubic through both ends.
  constexpr explicit LiftWithin(const LiftStep<Real>& l) noexcept {
    const Real rise = l.to_m - l.from_m;
    c_[0] = l.from_m;
    c_[1] = l.from_slope_m;
    c_[2] = 3 * rise - 2 * l.from_slope_m - l.to_slope_m;
    c_[3] = l.from_slope_m + l.to_slope_m - 2 * rise;
  }

  /// The quintic through ends and middle: the cubic, and what it misses in the middle on x^2 (1 - x)^2.
  constexpr LiftWithin(const LiftStep<Real>& l, const LiftMiddle<Real>& middle) noexcept : LiftWithin(l) {
    constexpr Real kHalf = static_cast<Real>(0.5);
    const Real missing = 16 * (middle.at_m - value(kHalf));
    const Real slope_missing = 16 * (middle.slope_m - slope(kHalf));
    const Real constant = missing - slope_missing / 2;
    c_[2] += constant;
    c_[3] += slope_missing - 2 * constant;
    c_[4] = constant - 2 * slope_missing;
    c_[5] = slope_missing;
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
    for (int i = 0; i < kDegree; ++i) {
      for (int j = kDegree - 1; j >= i; --j) c_[j] += x * c_[j + 1];
    }
  }

 private:
  Real c_[kDegree + 1] = {};
};

/// Gas force on the head, toward the seat.
template <class Real>
struct GasForce {
  Real gas_N;

  [[nodiscard]] constexpr Real force_N() const noexcept { return gas_N; }
  /// What a step adds whatever the motion: of the spring's preload, and of the gas.
  [[nodiscard]] constexpr Real drive(const typename StepMatrix<Real>::Row& row) const noexcept { return row.rest - row.gas * gas_N; }
  /// Suction leaves the spring enough to hold the valve on its seat.
  [[nodiscard]] constexpr bool leaves_closed(const ValveBody<Real>& body) const noexcept { return gas_N > -body.preload_N / 2; }
};

/// Of a scene without it.
template <class Real>
struct NoGasForce {
  [[nodiscard]] static constexpr Real force_N() noexcept { return Real{0}; }
  [[nodiscard]] static constexpr Real drive(const typename StepMatrix<Real>::Row& row) noexcept { return row.rest; }
  [[nodiscard]] static constexpr bool leaves_closed(const ValveBody<Real>&) noexcept { return true; }
};

/// A step without lift: the train off.
template <class Real, class Gas>
[[nodiscard]] constexpr ValveState<Real> stepped(const StepMatrix<Real>& m, ValveState<Real> s, const Gas& gas) noexcept {
  return {s.lift_m + (gas.drive(m.y) + m.y.y * s.lift_m + m.y.v * s.velocity_m_s),
          s.velocity_m_s + (gas.drive(m.v) + m.v.y * s.lift_m + m.v.v * s.velocity_m_s)};
}

/// A step that the train drives.
template <class Real, class Gas>
[[nodiscard]] constexpr ValveState<Real> stepped(const StepMatrix<Real>& m, ValveState<Real> s, const Gas& gas,
                                                 const LiftStep<Real>& l) noexcept {
  const Real gap = l.from_m - s.lift_m;
  const Real rise = l.to_m - l.from_m;
  const auto more = [&](const typename StepMatrix<Real>::Row& r) {
    return gas.drive(r) + r.y * s.lift_m + r.v * s.velocity_m_s + r.gap * gap + r.lift[0] * rise + r.lift[1] * l.from_slope_m +
           r.lift[2] * l.to_slope_m;
  };
  return {s.lift_m + more(m.y), s.velocity_m_s + more(m.v)};
}

/// A wide step that the train drives.
template <class Real, class Gas>
[[nodiscard]] constexpr ValveState<Real> stepped(const StepMatrix<Real>& m, ValveState<Real> s, const Gas& gas, const LiftStep<Real>& l,
                                                 const LiftMiddle<Real>& middle) noexcept {
  const Real gap = l.from_m - s.lift_m;
  const Real rise = l.to_m - l.from_m;
  const Real middle_rise = middle.at_m - l.from_m;
  const auto more = [&](const typename StepMatrix<Real>::Row& r) {
    return gas.drive(r) + r.y * s.lift_m + r.v * s.velocity_m_s + r.gap * gap + r.wide[0] * rise + r.wide[1] * l.from_slope_m +
           r.wide[2] * l.to_slope_m + r.wide[3] * middle_rise + r.wide[4] * middle.slope_m;
  };
  return {s.lift_m + more(m.y), s.velocity_m_s + more(m.v)};
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

/// The seat's part of Contacts::regime().
template <class Real>
[[nodiscard]] constexpr bool seat_acts(const ValveBody<Real>& b, ValveState<Real> s) noexcept {
  const Real sink = b.seat_sink_m - s.lift_m;
  return sink > 0 && b.seat_N_m * sink - b.seat_Ns_m * s.velocity_m_s > 0;
}

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
  Real force_N = -b.spring_N_m * s.lift_m - b.preload_N - b.guide_Ns_m * s.velocity_m_s - gas_N;
  const Contacts<Real> c = contacts(b, s, lift_m, lift_speed_m_s);
  if ((regime & kTrainOn) != 0) force_N += train_force_N(regime, c);
  if ((regime & kSeatOn) != 0) force_N += seat_force_N(regime, c);
  return force_N * b.per_mass;
}

}  // namespace crankloop

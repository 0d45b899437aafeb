// One tick of a crank that is turned by forces: docs/model.md "Crank dynamics".
//
// What belongs here: the integration of angle and speed. What does not: gas torque and its work, which come from tables
// (tick/crank/torque_step.hpp), torques of friction and starter (crank_friction.hpp, starter.hpp).
//
// The state is the reduced speed u = w sqrt(J_eff): u^2 / 2 is the kinetic energy, so work changes it without a term in
// dJ/da, and the energy balance of all but friction is kept to rounding. A tick is half of the friction, then gas, load
// and starter over the angle turned, then the other half of the friction: second order, and friction can stop the crank
// but never turn it back; where it is less than what pushes, a crank that slows down goes through standstill. The angle
// is predicted from the speed and its rate; when the tick's other end is known too, a better value is (the cubic
// through both), and what lacks is turned in the next tick: without friction the method is then of third order, at the
// price of one number.
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/crank/crank_friction.hpp>
#include <crankloop/tick/crank/starter.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop::detail {

/// What a tick has come to.
template <class Real>
struct CrankArrival {
  Real gas_work_J;           ///< over the angle turned
  Real gas_Nm;               ///< at its end, as are the next two
  Real inertia_kg_m2;        ///< J_eff
  Real inertia_slope_kg_m2;  ///< torque of masses per w^2
};

template <class Real>
class CrankStep {
 public:
  /// `gas_mean_Nm` over a cycle: where that takes work, the same cycle passed backwards would give it.
  CrankStep(const Drive<Real>& drive, const CrankDynamics<Real>& crank, group::CrankState<Real>& state,
            Real& speed_rad_s, Real gas_mean_Nm) noexcept
      : drive_{drive},
        crank_{crank},
        state_{state},
        speed_rad_s_{speed_rad_s},
        speed_before_rad_s_{speed_rad_s},
        friction_{{crank.drag_Nm, gas_mean_Nm < 0 ? crank.drag_Nm - 2 * gas_mean_Nm : crank.drag_Nm}} {}

  /// The first half: answers how far the crank turns. `gas_Nm` as it is before the tick; a scene without starter says
  /// that it is off.
  [[nodiscard]] Phase turn(Real gas_Nm, bool starter_is_on) noexcept {
    CRANKLOOP_ASSERT(is_finite(gas_Nm));
    CRANKLOOP_ASSERT(state_.per_root_inertia > 0);
    gas_before_Nm_ = gas_Nm;
    starter_ = {crank_.starter_stall_Nm, crank_.starter_slope_Nm_s, starter_is_on};
    const Real tick_s = drive_.tick_s;
    before_ = state_.reduced_speed;
    friction_s_ = tick_s;
    if (begin_with_friction(push_at_rest_Nm(gas_Nm))) {
      slow_down(tick_s / 2, Stop::may_pass);
      friction_s_ = tick_s / 2;
    }
    const Real push_Nm = gas_Nm + starter_.torque_Nm(speed_rad_s_) - state_.external_torque_Nm;
    held_ = holds(push_Nm);
    if (held_) {
      state_.lag_rad_s = Real{0};
      return Phase{};
    }
    const Real per_root = state_.per_root_inertia;
    ahead_ = state_.reduced_speed + tick_s * (push_Nm * per_root);
    start_rad_s_ = speed_rad_s_;
    start_rad_s2_ = acceleration_rad_s2(push_Nm);
    const Real gain_rad_s = start_rad_s2_ * tick_s;
    const Real share = starter_.share_of_gain(speed_rad_s_, tick_s, per_root * per_root);
    predicted_rad_s_ = held_to_limit(start_rad_s_ + gain_rad_s / 2 * share);
    mean_rad_s_ = limited(predicted_rad_s_ + state_.lag_rad_s, drive_.speed_limit_rad_s);
    CRANKLOOP_ASSERT(magnitude(mean_rad_s_) <= drive_.speed_limit_rad_s);
    return Phase::from_cycles(mean_rad_s_ * drive_.cycles_per_tick_per_rad_s);
  }

  /// In radians.
  [[nodiscard]] Real turned_rad() const noexcept { return held_ ? Real{0} : mean_rad_s_ * drive_.tick_s; }

  /// The second half: speed at the end of the tick.
  void arrive(const CrankArrival<Real>& at) noexcept {
    CRANKLOOP_ASSERT(at.inertia_kg_m2 > 0);
    const Real per_root = Real{1} / square_root(at.inertia_kg_m2);
    state_.per_root_inertia = per_root;
    state_.inertia_slope_kg_m2 = at.inertia_slope_kg_m2;
    gas_Nm_ = at.gas_Nm;
    if (held_) return;
    const Real starter_J = starter_.work_J(start_rad_s_, start_rad_s2_ * drive_.tick_s, mean_rad_s_, drive_.tick_s);
    gain(at.gas_work_J + starter_J - state_.external_torque_Nm * turned_rad());
    const Real reached_rad_s = state_.reduced_speed * per_root;
    speed_rad_s_ = held_to_limit(reached_rad_s);
    if (speed_rad_s_ != reached_rad_s) set_reduced(speed_rad_s_ / per_root);
    state_.lag_rad_s = cubic_rad_s() - predicted_rad_s_;
    if (turns_round()) {
      turn_friction_round();
    } else {
      slow_down(friction_s_, Stop::stays);
    }
    CRANKLOOP_ASSERT(is_finite(speed_rad_s_) && is_finite(state_.reduced_speed));
  }

  /// At the end of the tick. `motion` has the phase already.
  void show(group::CrankMotion<Real>& motion) const noexcept {
    const Real w = speed_rad_s_;
    const Real push_Nm = gas_Nm_ + starter_.torque_Nm(w) - state_.external_torque_Nm;
    const Sense sense = w < 0 || (w == Real{0} && push_Nm < 0) ? kBackward : kForward;
    Real friction_Nm = friction_.torque_Nm(crank_, sense, magnitude(w));
    if (holds(push_Nm)) {
      friction_Nm = push_Nm;
    } else if (sense == kBackward) {
      friction_Nm = -friction_Nm;
    }
    motion.speed_rad_s = w;
    motion.acceleration_rad_s2 = acceleration_rad_s2(push_Nm - friction_Nm);
    motion.friction_Nm = friction_Nm;
  }

  [[nodiscard]] Real starter_Nm() const noexcept { return starter_.torque_Nm(speed_rad_s_); }

  [[nodiscard]] bool overspeed() const noexcept { return overspeed_; }
  [[nodiscard]] Real gas_before_Nm() const noexcept { return gas_before_Nm_; }
  [[nodiscard]] Real speed_before_rad_s() const noexcept { return speed_before_rad_s_; }

 private:
  [[nodiscard]] static Real limited(Real x, Real most) noexcept { return x > most ? most : x < -most ? -most : x; }
  [[nodiscard]] Real held_to_limit(Real speed_rad_s) noexcept {
    const Real held = limited(speed_rad_s, drive_.speed_limit_rad_s);
    overspeed_ = overspeed_ || held != speed_rad_s;
    return held;
  }

  [[nodiscard]] bool holds(Real push_Nm) const noexcept {
    return state_.reduced_speed == Real{0} && friction_.meets(push_Nm);
  }

  /// By torques beside that of the masses.
  [[nodiscard]] Real acceleration_rad_s2(Real push_Nm) const noexcept {
    const Real net_Nm = push_Nm + state_.inertia_slope_kg_m2 * (speed_rad_s_ * speed_rad_s_);
    return limited(net_Nm * (state_.per_root_inertia * state_.per_root_inertia), crank_.most_rad_s2);
  }
  /// Mean speed of the cubic angle that has speed and acceleration of the tick's both ends, friction apart.
  [[nodiscard]] Real cubic_rad_s() const noexcept {
    const Real end_rad_s2 = acceleration_rad_s2(gas_Nm_ + starter_.torque_Nm(speed_rad_s_) - state_.external_torque_Nm);
    return (start_rad_s_ + speed_rad_s_) / 2 +
           drive_.tick_s * static_cast<Real>(1.0 / 12) * (start_rad_s2_ - end_rad_s2);
  }

  void set_reduced(Real reduced_speed) noexcept {
    state_.reduced_speed = reduced_speed;
    state_.reduced_rest = Real{0};
  }
  /// A tick's change may be less than the speed's last bit: what rounding leaves out is kept for the next.
  void add_reduced(Real change) noexcept {
    const Real with_rest = change + state_.reduced_rest;
    const Real sum = state_.reduced_speed + with_rest;
    state_.reduced_rest = with_rest - (sum - state_.reduced_speed);
    state_.reduced_speed = sum;
  }

  /// What pushes a crank that stands.
  [[nodiscard]] Real push_at_rest_Nm(Real gas_Nm) const noexcept {
    return gas_Nm + starter_.torque_Nm(Real{0}) - state_.external_torque_Nm;
  }
  /// False where it would only stop a crank that is breaking away: that has all its friction at the end.
  [[nodiscard]] bool begin_with_friction(Real push_Nm) const noexcept {
    if (before_ == Real{0}) return false;
    const Real drag_Nm = friction_.constant_Nm[sense_of(before_)];
    const bool breaks_away = before_ > 0 ? push_Nm > drag_Nm : push_Nm < -drag_Nm;
    return !breaks_away || drive_.tick_s / 2 * drag_Nm * state_.per_root_inertia < magnitude(before_);
  }

  enum class Stop : std::uint8_t { stays, may_pass };
  /// Friction for a while: du/dt = -drag / sqrt(J), the drag's slope taken half implicitly, so that it is second order
  /// and no drag, however steep, overshoots. A crank that it stops stays there, or passes through where what pushes it
  /// back is more than friction.
  void slow_down(Real time_s, Stop stop) noexcept {
    CRANKLOOP_ASSERT(time_s > 0);
    const Real speed = magnitude(speed_rad_s_);
    const Real drag = friction_.torque_Nm(crank_, sense_of(speed_rad_s_), speed);
    if (!(drag > 0)) return;
    const Real per_root = state_.per_root_inertia;
    const Real slope_Nm_s = crank_.drag_Nm_s + 2 * crank_.drag_Nm_s2 * speed;
    const Real impulse = time_s * drag * per_root / (Real{1} + time_s / 2 * slope_Nm_s * (per_root * per_root));
    const bool stops = impulse >= magnitude(state_.reduced_speed);
    if (stops && !(stop == Stop::may_pass && !friction_.meets(push_at_rest_Nm(gas_before_Nm_)))) {
      set_reduced(Real{0});
      speed_rad_s_ = Real{0};
      return;
    }
    push_reduced(state_.reduced_speed < 0 ? impulse : -impulse);
  }
  void push_reduced(Real change) noexcept {
    add_reduced(change);
    speed_rad_s_ += change * state_.per_root_inertia;
  }

  /// Whether the crank comes through standstill in this tick: what pushes it back is more than friction, and half a
  /// tick of that stops it.
  [[nodiscard]] bool turns_round() const noexcept {
    const Real back_Nm = before_ > 0 ? -push_at_rest_Nm(gas_Nm_) : push_at_rest_Nm(gas_Nm_);
    const Real left = before_ > 0 ? state_.reduced_speed : -state_.reduced_speed;
    const Sense then = sense_of(before_);
    return before_ != Real{0} && friction_.constant_Nm[kBackward] > 0 && back_Nm > friction_.constant_Nm[other(then)] &&
           left <= drive_.tick_s / 2 * friction_.constant_Nm[then] * state_.per_root_inertia;
  }
  void turn_friction_round() noexcept {
    const Real per_root = state_.per_root_inertia;
    const Real impulse_Nms = friction_.impulse_of_turning_Nms(sense_of(before_), start_rad_s_, speed_rad_s_,
                                                              per_root * per_root, drive_.tick_s);
    const Real sense = before_ > 0 ? Real{1} : Real{-1};
    const Real change = sense * (impulse_Nms * per_root);
    if (sense * (state_.reduced_speed + change) < 0) {
      push_reduced(change);
    } else {  // by rounding alone
      set_reduced(Real{0});
      speed_rad_s_ = Real{0};
    }
  }

  /// Work changes u^2 / 2. Through a reversal too; should the predicted angle be a hair beyond the one that the energy
  /// reaches, the crank stands.
  void gain(Real work_J) noexcept {
    CRANKLOOP_ASSERT(is_finite(work_J));
    const Real twice_J = 2 * work_J;
    const Real u = state_.reduced_speed;
    const Real left = u * u + twice_J;
    if (!(left > 0)) {
      set_reduced(Real{0});
      return;
    }
    const Real magnitude_after = square_root(left);
    const Real after = ahead_ < 0 ? -magnitude_after : magnitude_after;
    if (u * ahead_ > 0) {
      add_reduced(twice_J / (u + after));  // u_after - u, without cancellation
    } else {
      turn_back(u, after);
    }
  }
  /// From rest, or through standstill: where friction could hold the crank, that is as far as it goes.
  void turn_back(Real before, Real after) noexcept {
    const Real push_Nm = push_at_rest_Nm(gas_Nm_);
    set_reduced(before != Real{0} && friction_.meets(push_Nm) ? Real{0} : after);
  }

  const Drive<Real>& drive_;
  const CrankDynamics<Real>& crank_;
  group::CrankState<Real>& state_;
  Real& speed_rad_s_;
  Real speed_before_rad_s_;
  CrankFriction<Real> friction_;
  Starter<Real> starter_{};
  Real start_rad_s_{};  ///< after the first half of the friction
  Real start_rad_s2_{};
  Real predicted_rad_s_{};  ///< mean speed by the start alone
  Real mean_rad_s_{};       ///< of the angle turned
  Real ahead_{};            ///< u at the tick's end by the forces at its start: only its sign counts
  Real before_{};           ///< u at the start of the tick
  Real friction_s_{};       ///< time that is left for friction
  Real gas_before_Nm_{};
  Real gas_Nm_{};      ///< at the end of the tick
  bool held_ = false;  ///< by friction, at standstill
  bool overspeed_ = false;
};

}  // namespace crankloop::detail

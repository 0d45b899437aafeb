// Compares an engine's valve with the converged reference. Disturbed copies of the reference show how much the motion
// amplifies an error, and so how large an error may be.
//
// What belongs here: the reference, the copies, the two errors. What does not: the statement of the rule
// (stress_trial.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <crankloop/tabulate/valve_lift.hpp>
#include <crankloop/tick/valve/valve.hpp>

#include "../reference/valve_reference.hpp"
#include "crankloop/files/units.hpp"
#include "stress_case.hpp"

namespace crankloop::program {

inline constexpr int kCopies = 4;
/// Number of copies for a second comparison, if an error exceeds what kCopies allow. The engine is like one more copy;
/// with four, in ten thousand comparisons some engine deviates more than all of its copies by chance.
inline constexpr int kMoreCopies = 32;
inline constexpr double kMagnified = 3;

/// Amplitude of the vibration for which an accuracy class is made. Fourth-order Runge-Kutta with w d = x has an error
/// of x^5/120 of the amplitude per step, 2 pi x^4/120 per period, and class a has x^4 = 0.3^4 a/0.1 um: together a
/// times the amplitude / 0.24 mm.
inline constexpr double kClassAmplitude_m = 0.24e-3;

/// The reference and its disturbed copies, stepped together with an engine.
class Comparison {
 public:
  /// `fine_s` and `rounding` of the engine's steps; rounding 0 for double.
  Comparison(const StressCase& drawn, const valve_reference::SingleMass& mass, const ValveLift& lift, double cam_deg,
             double fine_s, double rounding, int copies)
      : accuracy_m_{drawn.options.valves.accuracy_m},
        runge_kutta_{drawn.options.valves.integrator == Integrator::rk4},
        tick_s_{drawn.options.tick_s},
        rounding_{rounding * std::sqrt(std::max(1.0, tick_s_ / fine_s))},
        speed_per_lift_{(mass.k + mass.k_s) / mass.M * fine_s},
        cam_deg_{cam_deg},
        draw_{drawn.own_seed} {
    const valve_reference::TurnedCam cam(lift);
    all_.assign(1 + static_cast<std::size_t>(copies), valve_reference::Reference(mass, cam));
    // At rest at the cam's angle, as the engine starts.
    const double Y = lift.at(cam_deg * kPi / 180).lift_m;
    const double open_m = (mass.k * Y - mass.P) / (mass.k + mass.k_s);
    const double pushed_m = mass.k * Y / (mass.k + mass.k_z + mass.k_s);
    for (valve_reference::Reference& one : all_) {
      if (open_m > mass.delta) {
        one.y = open_m, one.regime = kTrainOn;
        seated_ = false;
      } else if (Y > pushed_m) {
        one.y = pushed_m, one.regime = kTrainOn | kSeatOn;
      }
    }
  }

  /// Steps a tick in which the cam turns to `cam_deg`; `lift_m` is the engine's lift after it.
  void tick(double cam_deg, double lift_m, bool asleep) {
    double turned = cam_deg - cam_deg_;
    turned -= 360 * std::floor(turned / 360 + 0.5);
    const valve_reference::Reference& exact = all_[0];
    bool resting = asleep;
    double apart_m = 0;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      valve_reference::Reference& one = all_[i];
      const Touch before{one.v, one.regime, one.changes};
      if (i > 0 && starts_ && turned != 0) knock(one, kTrainOn & one.regime, before.v_m_s, turned / tick_s_);
      one.advance(tick_s_, cam_deg_, cam_deg_ + turned);
      if (i > 0) {
        apart_m = std::max(apart_m, std::fabs(one.y - exact.y));
        if (one.changes != before.changes) {
          const std::uint32_t seen = one.regime ^ before.regime;
          const std::uint32_t changed = seen != 0 ? seen : kTrainOn | kSeatOn;  // opened and closed within the tick
          knock(one, changed, std::fabs(before.v_m_s) > std::fabs(one.v) ? before.v_m_s : one.v, turned / tick_s_);
        }
        round(one);
      }
      resting = resting && std::fabs(one.y) < kForgotten_m;
    }
    starts_ = false;
    cam_deg_ = cam_deg;
    magnified_m_ = resting ? 0 : std::max(magnified_m_, apart_m);
    const bool seated = (exact.regime & kSeatOn) != 0;
    landed_ = landed_ || (seated && !seated_);
    seated_ = seated;
    const double error_m = std::fabs(lift_m - exact.y);
    of_class_ = std::max(of_class_, error_m / (accuracy_m_ + kForgotten_m));
    of_allowed_ = std::max(of_allowed_, error_m / (kMagnified * (accuracy_m_ + magnified_m_) + kForgotten_m));
  }

  /// Whether the valve returned to its seat.
  [[nodiscard]] bool landed() const { return landed_; }
  [[nodiscard]] double of_class() const { return of_class_; }
  [[nodiscard]] double of_allowed() const { return of_allowed_; }

 private:
  static constexpr double kForgotten_m = 2e-9;  ///< error when a valve is set to rest, and error of the lift's table

  struct Touch {
    double v_m_s;
    std::uint32_t regime;
    int changes;
  };

  /// Disturbs a copy by the requested accuracy, scaled up for a vibration whose amplitude follows from the speed at the
  /// contact. The start of the cam's rotation under an open valve counts as a contact too.
  void knock(valve_reference::Reference& one, std::uint32_t contacts, double v_m_s, double cam_deg_per_s) {
    if (contacts == 0) return;
    const valve_reference::SingleMass& m = one.mass();
    double amplitude_m = 0;
    if ((contacts & kTrainOn) != 0) {
      const double apart_m_s = v_m_s - one.cam(cam_deg_, cam_deg_per_s).Yd;
      amplitude_m = std::fabs(apart_m_s) / std::sqrt((m.k + m.k_s) / m.M);
    }
    if ((contacts & kSeatOn) != 0)
      amplitude_m = std::max(amplitude_m, std::fabs(v_m_s) / std::sqrt((m.k_z + m.k_s) / m.M));
    const double knock_m = accuracy_m_ * (runge_kutta_ ? std::max(1.0, amplitude_m / kClassAmplitude_m) : 1);
    one.y += draw_.one_in(2) ? knock_m : -knock_m;
  }

  /// Adds the effect of rounding lift, speed and gap times stiffness in the fine steps of a tick: a random walk.
  void round(valve_reference::Reference& one) {
    if (rounding_ == 0 || one.regime == kSeatOn) return;
    const double lift_m = rounding_ * std::fabs(one.y);
    one.y += lift_m * draw_.between(-1, 1);
    one.v += (rounding_ * std::fabs(one.v) + lift_m * speed_per_lift_) * draw_.between(-1, 1);
  }

  double accuracy_m_;
  bool runge_kutta_;
  double tick_s_;
  double rounding_;
  double speed_per_lift_;
  double cam_deg_;
  Draws draw_;
  std::vector<valve_reference::Reference> all_;  ///< the reference, then its copies
  bool starts_ = true;
  bool seated_ = true;
  bool landed_ = false;
  double magnified_m_ = 0;
  double of_class_ = 0;
  double of_allowed_ = 0;
};

}  // namespace crankloop::program

// Elastic valves under test: an engine of one cylinder that runs a train tick by tick.
//
// What belongs here: definitions, and a rig that runs them. What does not: what to expect
// (support/valve_reference.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/step.hpp>

#include "support/engines.hpp"
#include "support/running.hpp"
#include "support/status.hpp"
#include "support/units.hpp"
#include "support/valve_reference.hpp"
#include "support/valve_trains.hpp"

namespace crankloop::valve_test {

using support::kPi;
using support::kRadPerDeg;
using support::ohc_125_train;
using support::ohc_125_valve;

/// One cylinder with a train; its crank mechanism does not matter.
inline EngineDefinition engine_with(const ValveTrain& train) {
  EngineDefinition engine = support::without_gas(support::single_495());
  engine.masses.rod_inertia_correction_kg_m2 = 0;
  engine.train_count = 1;
  engine.trains[0] = train;
  return engine;
}

using tick_test::OneValve;
using tick_test::OneValveOnMeasuredCrank;
using tick_test::OneValveWithGas;
using tick_test::OneValveWithPhaser;

inline double rad_s_of_rpm(double rpm) { return rpm * kPi / 30; }

/// Largest difference of two runs sampled at the same moments.
inline double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) worst = std::max(worst, std::fabs(a[i] - b[i]));
  return worst;
}

/// The engine phase of an angle in degrees.
inline Phase phase_at(double deg) { return tick_test::phase_at_deg(static_cast<long double>(deg)); }

/// Cam angle of train 0 of cylinder 1 at an engine phase, from full lift, -180 to 180 deg.
inline double cam_deg_at(Phase engine, double full_lift_deg, std::uint64_t cam_phase = 0) {
  const auto of_cam = static_cast<std::int64_t>((engine - phase_at(full_lift_deg)).units() - cam_phase);
  return static_cast<double>(static_cast<long double>(of_cam) * (360.0L / 18446744073709551616.0L));
}

/// An engine with one valve, its tables, its tick.
template <class Real, class S = OneValve>
class Rig {
 public:
  explicit Rig(const ValveTrain& train, const TickOptions& options, double start_deg = 0)
      : Rig(engine_with(train), options, start_deg) {}

  Rig(const EngineDefinition& definition, const TickOptions& options, double start_deg = 0)
      : definition_{definition}, tick_s_{options.tick_s}, tables_{std::make_unique<TableStorage<Real, S>>()} {
    status_ = tables_->build(definition_, options);
    if (status_.ok()) status_ = engine_.init(tables_->tables(), phase_at(start_deg));
    EXPECT_TRUE(accepted(status_));
  }

  const auto& step(double speed_rad_s) {
    typename Engine<Real, S>::Input in;
    in.speed_rad_s = static_cast<Real>(speed_rad_s);
    return engine_.step(in);
  }

  [[nodiscard]] Engine<Real, S>& engine() { return engine_; }
  [[nodiscard]] const detail::ValveMotion<Real>& motion() const { return tables_->tables().valve_motions[0]; }
  [[nodiscard]] const detail::LiftCurve<Real>& curve() const { return tables_->tables().lift_curves[0]; }
  [[nodiscard]] detail::ValveState<Real> valve() const {
    return {engine_.state().valve_lift_m[0], engine_.state().valve_velocity_m_s[0]};
  }
  [[nodiscard]] std::uint32_t regime() const { return engine_.state().valve_regime[0]; }
  /// Exactly at rest on its seat.
  [[nodiscard]] bool at_rest() const {
    return valve().lift_m == 0 && valve().velocity_m_s == 0 && detail::contacts_of(regime()) == kSeatOn;
  }
  [[nodiscard]] double tick_s() const { return tick_s_; }
  [[nodiscard]] const ValveTrain& train() const { return definition_.trains[0]; }

  /// Where the cam stands now, cam degrees from full lift, -180 to 180.
  [[nodiscard]] double cam_deg() const {
    std::uint64_t moved = 0;
    if constexpr (S::cam_phasing) moved = engine_.state().cam_phase[0];
    return cam_deg_at(engine_.state().phase, train().cam.full_lift_deg, moved);
  }

  /// Ticks of a whole cam turn at this speed, rounded up.
  [[nodiscard]] int ticks_per_cycle(double speed_rad_s) const {
    return static_cast<int>(4 * kPi / (speed_rad_s < 0 ? -speed_rad_s : speed_rad_s) / tick_s_) + 1;
  }

 private:
  EngineDefinition definition_;
  double tick_s_;
  std::unique_ptr<TableStorage<Real, S>> tables_;
  Engine<Real, S> engine_;
  Status status_;
};

[[nodiscard]] inline ValveLift lift_of(const ValveTrain& train) {
  ValveLift lift;
  EXPECT_TRUE(accepted(lift.init(train.cam, train.rocker)));
  return lift;
}

/// A rig and its reference, tick by tick, from the same start at rest.
template <class Real, class S = OneValve>
class SideBySide {
 public:
  SideBySide(const ValveTrain& train, const TickOptions& options, double start_deg = 0, double finer = 1)
      : rig{train, options, start_deg},
        lift{lift_of(train)},
        reference{SingleMass(train.valve, train.rocker, lift.largest_lift_m()), TurnedCam(lift), finer},
        cam_deg_{rig.cam_deg()} {}
  SideBySide(const SideBySide&) = delete;
  SideBySide& operator=(const SideBySide&) = delete;

  /// Both advance by a tick; answers |lift - the reference's| in m.
  double step(double speed_rad_s) {
    rig.step(speed_rad_s);
    return follow();
  }

  /// The reference catches up with the rig, whose cam turned evenly over the last tick.
  double follow() {
    double turned = rig.cam_deg() - cam_deg_;
    turned -= 360 * std::floor(turned / 360 + 0.5);
    reference.advance(rig.tick_s(), cam_deg_, cam_deg_ + turned);
    cam_deg_ = rig.cam_deg();
    return std::fabs(static_cast<double>(rig.engine().output().valve[0][0].lift_m) - reference.y);
  }

  /// The largest difference over this many ticks at constant speed.
  double worst_over(int ticks, double speed_rad_s) {
    double worst = 0;
    for (int i = 0; i < ticks; ++i) worst = std::max(worst, step(speed_rad_s));
    return worst;
  }

  Rig<Real, S> rig;
  ValveLift lift;
  Reference reference;

 private:
  double cam_deg_;
};

inline detail::ValveBody<double> body_of(const ValveTrain& train) { return valve_body(train.valve, lift_of(train)); }

inline detail::ValveMotion<double> motion_for(const detail::ValveBody<double>& body, double tick_s,
                                              Integrator integrator = Integrator::rk4) {
  detail::ValveMotion<double> motion{};
  EXPECT_TRUE(accepted(motion_of(body, tick_s, {integrator, 0.1e-6}, motion)));
  return motion;
}

}  // namespace crankloop::valve_test

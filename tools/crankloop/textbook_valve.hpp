// The valve's motion as textbooks and [Li 2017, 4.9-4.13] compute it: the reference that the tick is compared with.
//
// What belongs here: classical four-stage Runge-Kutta with the cam looked up in every stage and contact tested there.
// What does not: the tick (crankloop/tick/valve_tick.hpp), which locates contact changes. This one finds them where a
// step happens to end, so its order falls from 4 to about 1 as soon as there are any.
#pragma once

#include <cstdint>

#include <crankloop/tick/lift_curve.hpp>
#include <crankloop/tick/valve_results.hpp>
#include <crankloop/tick/valve_tables.hpp>

namespace crankloop::program {

/// Phase units since the lobe opened at both ends of a tick.
struct CamSpan {
  std::uint64_t from;
  std::uint64_t to;

  /// Cam degrees between them, with sign.
  template <class Real>
  [[nodiscard]] Real turned_deg() const noexcept {
    return Phase{to - from}.template signed_cycles<Real>() * Real{kDegreesPerTurn};
  }
};

/// Advances one valve by a tick in equal steps: as many as the tick's finest, so that both can be
/// compared.
template <class Real>
class TextbookValve {
 public:
  TextbookValve(const ValveMotion<Real>& motion, const LiftCurve<Real>& curve) noexcept
      : motion_{motion}, curve_{curve} {}

  void advance(ValveCondition<Real>& valve, const CamSpan& cam, Real gas_N,
               ValveRecord<Real>& record) const noexcept {
    const std::uint32_t count = motion_.whole.parts * motion_.fine.parts;
    const Real per_count = motion_.whole.per_parts * motion_.fine.per_parts;
    const Real step_deg = cam.turned_deg<Real>() * per_count;
    const Real deg_per_s = step_deg / motion_.fine.step_s;
    const std::int64_t half_step = static_cast<std::int64_t>(cam.to - cam.from) / (2 * std::int64_t{count});
    const auto place = [&](std::uint32_t half_steps) {
      if (half_steps == 2 * count) return cam.to;
      return cam.from + static_cast<std::uint64_t>(half_step * std::int64_t{half_steps});
    };
    Real from_deg = curve_.degrees(cam.from);
    valve.sleep = kAwake;
    for (std::uint32_t i = 0; i < count; ++i) {
      const LiftNow<Real> start = lift_at(place(2 * i), deg_per_s);
      const LiftNow<Real> middle = lift_at(place(2 * i + 1), deg_per_s);
      const LiftNow<Real> end = lift_at(place(2 * i + 2), deg_per_s);
      const ValveState<Real> before = valve.state;
      valve.state = stepped(before, start, middle, end, gas_N);
      const std::uint32_t regime = regime_of(valve.state, end);
      record.step({before, valve.state, start.lift_m, end.lift_m, start.speed_m_s, end.speed_m_s,
                   acceleration(motion_.body, regime, valve.state, end.lift_m, end.speed_m_s, gas_N), from_deg,
                   from_deg + step_deg, motion_.fine.step_s, valve.regime},
                  motion_.body.seat_sink_m);
      from_deg += step_deg;
      if (regime != valve.regime) record.change(valve.regime, regime, valve.state.velocity_m_s, from_deg);
      valve.regime = regime;
    }
  }

 private:
  [[nodiscard]] LiftNow<Real> lift_at(std::uint64_t since_opening, Real deg_per_s) const noexcept {
    const Lift<Real> lift = curve_.read(LiftCurve<Real>::cell(since_opening));
    return {lift.lift_m, lift.per_deg_m * deg_per_s};
  }

  [[nodiscard]] std::uint32_t regime_of(ValveState<Real> s, LiftNow<Real> lift) const noexcept {
    return contacts(motion_.body, s, lift.lift_m, lift.speed_m_s).regime();
  }

  /// f(t, y, v) of docs/model.md "Valve": each contact acts while both its gap and its force are positive.
  [[nodiscard]] Real f(Real y, Real v, LiftNow<Real> lift, Real gas_N) const noexcept {
    const ValveState<Real> s{y, v};
    return acceleration(motion_.body, regime_of(s, lift), s, lift.lift_m, lift.speed_m_s, gas_N);
  }

  [[nodiscard]] ValveState<Real> stepped(ValveState<Real> s, LiftNow<Real> start, LiftNow<Real> middle,
                                         LiftNow<Real> end, Real gas_N) const noexcept {
    const Real d = motion_.fine.step_s;
    const Real y = s.lift_m;
    const Real v = s.velocity_m_s;
    const Real k1 = f(y, v, start, gas_N);
    const Real k2 = f(y + d / 2 * v, v + d / 2 * k1, middle, gas_N);
    const Real k3 = f(y + d / 2 * v + d * d / 4 * k1, v + d / 2 * k2, middle, gas_N);
    const Real k4 = f(y + d * v + d * d / 2 * k2, v + d * k3, end, gas_N);
    return {y + d * v + d * d / 6 * (k1 + k2 + k3), v + d / 6 * (k1 + 2 * k2 + 2 * k3 + k4)};
  }

  const ValveMotion<Real>& motion_;
  const LiftCurve<Real>& curve_;
};

}  // namespace crankloop::program

// The valve's motion as textbooks and [Li 2017, 4.9-4.13] compute it: the reference that the tick is compared with.
//
// What belongs here: classical four-stage Runge-Kutta with the cam looked up in every stage and contact tested there.
// What does not: the tick (crankloop/tick/valve/event_location.hpp), which locates contact changes. This one detects
// them only at the end of a step, so its order falls from 4 to about 1 when there are any.
#pragma once

#include <cstdint>

#include <crankloop/tables/lift_curve.hpp>
#include <crankloop/tables/valve_tables.hpp>
#include <crankloop/tick/valve/valve.hpp>
#include <crankloop/tick/valve/valve_results.hpp>

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

/// A cam's lift and its speed at one moment.
template <class Real>
struct LiftNow {
  Real lift_m;
  Real speed_m_s;
};

/// Force and depth of both contacts: a contact acts while its force and depth are positive.
template <class Real>
struct Contacts {
  Real compression_m, train_N;
  Real sink_m, seat_N;

  Contacts(const detail::ValveBody<Real>& b, const detail::ValveState<Real>& s, const LiftNow<Real>& lift) noexcept
      : compression_m{lift.lift_m - s.lift_m},
        train_N{b.train_N_m * compression_m + b.train_Ns_m * (lift.speed_m_s - s.velocity_m_s)},
        sink_m{b.seat_compression_m - s.lift_m},
        seat_N{b.seat_N_m * sink_m - b.seat_Ns_m * s.velocity_m_s} {}

  [[nodiscard]] std::uint32_t regime() const noexcept {
    return (compression_m > 0 && train_N > 0 ? kTrainOn : 0u) | (sink_m > 0 && seat_N > 0 ? kSeatOn : 0u);
  }
  [[nodiscard]] Real train_force_N() const noexcept { return (regime() & kTrainOn) != 0 ? train_N : Real{0}; }
  [[nodiscard]] Real seat_force_N() const noexcept { return (regime() & kSeatOn) != 0 ? seat_N : Real{0}; }
};

/// y'' of docs/model.md "Valve".
template <class Real>
[[nodiscard]] Real textbook_acceleration(const detail::ValveBody<Real>& b, const detail::ValveState<Real>& s,
                                         const LiftNow<Real>& lift, Real gas_N) noexcept {
  const Contacts<Real> c(b, s, lift);
  const Real held_N = b.spring_N_m * s.lift_m + b.preload_N + b.guide_Ns_m * s.velocity_m_s + gas_N;
  return (c.train_force_N() + c.seat_force_N() - held_N) * b.per_mass;
}

/// The classical four stages for y'' = f(half, y, v), where half is 0, 1 or 2 halves of the step d from its begin.
///
/// One of two independent references in this repository: this one for the tick (tests compare it with the library's
/// step), the other for the benchmark's plain code (lab/bench/plain_valve.hpp), which must not use the library.
template <class Real, class Acceleration>
[[nodiscard]] detail::ValveState<Real> textbook_step(const Acceleration& f, Real d,
                                                     const detail::ValveState<Real>& s) noexcept {
  const Real y = s.lift_m;
  const Real v = s.velocity_m_s;
  const Real k1 = f(0, y, v);
  const Real k2 = f(1, y + d / 2 * v, v + d / 2 * k1);
  const Real k3 = f(1, y + d / 2 * v + d * d / 4 * k1, v + d / 2 * k2);
  const Real k4 = f(2, y + d * v + d * d / 2 * k2, v + d * k3);
  return {y + d * v + d * d / 6 * (k1 + k2 + k3), v + d / 6 * (k1 + 2 * k2 + 2 * k3 + k4)};
}

/// Advances one valve by a tick in equal steps: three to a fine step of the tick, so that fastest rate times step is at
/// most a third.
template <class Real>
class TextbookValve {
 public:
  TextbookValve(const detail::ValveMotion<Real>& motion, const detail::LiftCurve<Real>& curve) noexcept
      : motion_{motion}, curve_{curve}, step_s_{motion.fine_step_s / static_cast<Real>(kStepsOfFineStep)} {}

  static constexpr std::uint32_t kStepsOfFineStep = 3;
  [[nodiscard]] static std::uint32_t steps(const detail::ValveMotion<Real>& motion) noexcept {
    return kStepsOfFineStep * motion.parts;
  }

  void advance(detail::ValveInRegime<Real>& valve, const CamSpan& cam, Real gas_N,
               detail::ValveRecord<Real>& record) const noexcept {
    const std::uint32_t count = steps(motion_);
    const Real step_deg = cam.turned_deg<Real>() / static_cast<Real>(count);
    const Real deg_per_s = step_deg / step_s_;
    const std::int64_t half_step = static_cast<std::int64_t>(cam.to - cam.from) / (2 * std::int64_t{count});
    const auto place = [&](std::uint32_t half_steps) {
      if (half_steps == 2 * count) return cam.to;
      return cam.from + static_cast<std::uint64_t>(half_step * std::int64_t{half_steps});
    };
    Real from_deg = curve_.degrees(cam.from);
    for (std::uint32_t i = 0; i < count; ++i) {
      const LiftNow<Real> start = lift_at(place(2 * i), deg_per_s);
      const LiftNow<Real> middle = lift_at(place(2 * i + 1), deg_per_s);
      const LiftNow<Real> end = lift_at(place(2 * i + 2), deg_per_s);
      const detail::ValveState<Real> before = valve.state;
      valve.state = stepped(before, start, middle, end, gas_N);
      const std::uint32_t regime = Contacts<Real>(motion_.body, valve.state, end).regime();
      record.step({before, valve.state, start.lift_m, end.lift_m, start.speed_m_s, end.speed_m_s,
                   textbook_acceleration(motion_.body, before, start, gas_N),
                   textbook_acceleration(motion_.body, valve.state, end, gas_N), step_s_, valve.regime},
                  motion_.body.seat_compression_m, [&](Real part) { return from_deg + part * step_deg; });
      from_deg += step_deg;
      if (regime != valve.regime) record.event(valve.regime, regime, valve.state.velocity_m_s, from_deg);
      valve.regime = regime;
    }
  }

 private:
  [[nodiscard]] LiftNow<Real> lift_at(std::uint64_t since_opening, Real deg_per_s) const noexcept {
    const detail::Lift<Real> lift = curve_.read(detail::LiftCurve<Real>::cell(since_opening));
    return {lift.lift_m, lift.per_deg_m * deg_per_s};
  }

  [[nodiscard]] detail::ValveState<Real> stepped(const detail::ValveState<Real>& s, const LiftNow<Real>& start,
                                                 const LiftNow<Real>& middle, const LiftNow<Real>& end,
                                                 Real gas_N) const noexcept {
    const LiftNow<Real>* const cam[] = {&start, &middle, &end};
    return textbook_step(
        [&](int half, Real y, Real v) {
          return textbook_acceleration(motion_.body, detail::ValveState<Real>{y, v}, *cam[half], gas_N);
        },
        step_s_, s);
  }

  const detail::ValveMotion<Real>& motion_;
  const detail::LiftCurve<Real>& curve_;
  Real step_s_;
};

}  // namespace crankloop::program

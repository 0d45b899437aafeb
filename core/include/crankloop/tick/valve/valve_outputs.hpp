// The output of an elastic valve.
#pragma once

#include <crankloop/output.hpp>
#include <crankloop/tick/valve/valve.hpp>

namespace crankloop::detail {

/// A valve's cam, train and acceleration at a tick's end.
template <class Real>
struct Moment {
  Real cam_lift_m, compression_m, compression_speed_m_s, acceleration_m_s2;
};

template <class Real>
[[gnu::always_inline]] inline void write_motion(ValveMotionOutput<Real>& shown, const ValveState<Real>& s,
                                                const Moment<Real>& at) noexcept {
  shown.theoretical_lift_m = at.cam_lift_m > 0 ? at.cam_lift_m : Real{0};
  shown.lift_m = s.lift_m;
  shown.velocity_m_s = s.velocity_m_s;
  shown.acceleration_m_s2 = at.acceleration_m_s2;
}

template <class Real>
[[gnu::always_inline]] inline void write_forces(ValveForcesOutput<Real>& shown, const ValveBody<Real>& b,
                                                const LiftCurve<Real>& curve, const ValveInRegime<Real>& valve,
                                                Cell cell, const Moment<Real>& at) noexcept {
  const auto pushing = [](bool on, Real force_N) { return on && force_N > 0 ? force_N : Real{0}; };
  const std::uint32_t contacts = contacts_of(valve.regime);
  shown.train_N =
      pushing((contacts & kTrainOn) != 0, b.train_N_m * at.compression_m + b.train_Ns_m * at.compression_speed_m_s);
  shown.seat_N = pushing((contacts & kSeatOn) != 0,
                         b.preload_N - (b.seat_N_m * valve.state.lift_m + b.seat_Ns_m * valve.state.velocity_m_s));
  shown.tip_N = shown.train_N - b.rocker_mass_kg * at.acceleration_m_s2;
  shown.cam_N = shown.train_N > 0 ? shown.train_N * curve.rocker_ratio_at(cell) : Real{0};
  shown.train_compression_m = at.compression_m;
  shown.regime = contacts;
}

}  // namespace crankloop::detail

// Which valves are active, and the lanes that they have: active valves come first, so that blocks hold no others.
//
// What belongs here: a valve's lane, and how it changes when the valve is activated or deactivated. What does not: when
// that happens (elastic_valves.hpp, plain_steps.hpp), where things lie (valve_access.hpp).
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/tick/valve/valve_access.hpp>

namespace crankloop::detail {

/// Gives a valve a lane and loads what it needs there from tables and state, except its cam's lift.
template <class Real, class S>
[[gnu::cold]] void place(ValveAccess<Real, S>& valves, std::uint32_t v, std::uint32_t lane) noexcept {
  const LiftCurve<Real>& curve = valves.tables.lift_curves[valves.train(v)];
  valves.work.curve[lane] = &curve;
#if CRANKLOOP_ABREAST
  if constexpr (ValveAccess<Real, S>::kInLanes) {
    CRANKLOOP_ASSERT(lane < kLaneRoom<S>);
    if constexpr (!S::valve_gas) valves.work.valve[lane] = v, valves.work.lane[v] = lane;
    set_cam_of_lane(valves.work, lane, curve, valves.cylinder(v)),
        set_body_of_lane(valves.work, lane, valves.motion(v));
  }
#endif
  valves.set_regime(v, valves.state.valve_regime[v]);
  valves.set_state(v, valves.state_of(v));
}

template <class Real, class S>
[[gnu::cold]] void place_all(ValveAccess<Real, S>& valves) noexcept {
  std::uint32_t next = 0;
  valves.for_each([&](std::uint32_t v) { place(valves, v, ValveAccess<Real, S>::kActiveFirst ? next++ : v); });
}

/// Exchanges the valves of two lanes.
template <class Real, class S>
[[gnu::noinline]] void swap_lanes(ValveAccess<Real, S>& valves, std::uint32_t a, std::uint32_t b) noexcept {
  if (a == b) return;
  const std::uint32_t in_a = valves.valve_in(a), in_b = valves.valve_in(b);
  const Lift<Real> cam_a = valves.cam(in_a), cam_b = valves.cam(in_b);
  place(valves, in_a, b), place(valves, in_b, a);
  valves.set_cam(in_a, cam_a), valves.set_cam(in_b, cam_b);
}

/// A valve takes part from now on.
template <class Real, class S>
void activate(ValveAccess<Real, S>& valves, std::uint32_t v) noexcept {
  CRANKLOOP_ASSERT((valves.work.active >> v & 1) == 0);
  valves.work.active |= ValveBits<S>{1} << v;
  if constexpr (ValveAccess<Real, S>::kActiveFirst) swap_lanes(valves, valves.lane_of(v), valves.work.active_lanes++);
}

/// Valves at rest whose cams are away take part no longer.
template <class Real, class S>
void deactivate(ValveAccess<Real, S>& valves, ValveBits<S> which) noexcept {
  CRANKLOOP_ASSERT((valves.work.active & which) == which);
  valves.work.active &= ~which;
  if constexpr (ValveAccess<Real, S>::kActiveFirst) {
    for (ValveBits<S> left = which; left != 0; left &= left - 1)
      swap_lanes(valves, valves.lane_of(trailing_zeros(left)), --valves.work.active_lanes);
  }
  for (CamWindow& clear : valves.work.clear) clear = {};  // to be found again in the next tick
}

}  // namespace crankloop::detail

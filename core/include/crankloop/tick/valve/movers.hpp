// Which valves move, and the lanes that they have: those that move come first, so that blocks of lanes hold no others.
//
// What belongs here: a valve's place, and how it changes when the valve comes to rest or wakes. What does not: when it
// does (elastic_valves.hpp, valve_round.hpp), where things lie (valves_at_hand.hpp).
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/tick/valve/valves_at_hand.hpp>

namespace crankloop::detail {

/// A valve to its place, with what it needs there of the tables and the state, but for its cam's lift.
template <class Real, class S>
[[gnu::cold]] void place(ValvesAtHand<Real, S>& valves, std::uint32_t v, [[maybe_unused]] std::uint32_t lane) noexcept {
  const LiftCurve<Real>& curve = valves.tables.lift_curves[valves.train(v)];
  [[maybe_unused]] const auto opens = static_cast<std::uint32_t>(curve.opens[valves.cylinder(v)] >> 32);
  if constexpr (!kMayGoAbreast<Real, S>) valves.work.valve[v].curve = &curve, valves.work.valve[v].opens = opens;
#if CRANKLOOP_ABREAST
  if constexpr (ValvesAtHand<Real, S>::kAbreast) {
    CRANKLOOP_ASSERT(lane < AbreastWork<S>::kRoom);
    if constexpr (!S::valve_gas) valves.work.valve[lane] = v, valves.work.lane[v] = lane;
    set_cam_of_lane(valves.work, lane, curve, opens), set_body_of_lane(valves.work, lane, valves.motion(v));
  }
#endif
  valves.set_regime(v, valves.state.valve_regime[v]);
  valves.set_state(v, valves.state_of(v));
}

template <class Real, class S>
[[gnu::cold]] void place_all(ValvesAtHand<Real, S>& valves) noexcept {
  std::uint32_t next = 0;
  valves.for_each([&](std::uint32_t v) { place(valves, v, ValvesAtHand<Real, S>::kMoversFirst ? next++ : v); });
}

/// Two valves change places.
template <class Real, class S>
[[gnu::noinline]] void swap_lanes(ValvesAtHand<Real, S>& valves, std::uint32_t a, std::uint32_t b) noexcept {
  if (a == b) return;
  const std::uint32_t in_a = valves.valve_in(a), in_b = valves.valve_in(b);
  const Lift<Real> cam_a = valves.cam(in_a), cam_b = valves.cam(in_b);
  place(valves, in_a, b), place(valves, in_b, a);
  valves.set_cam(in_a, cam_a), valves.set_cam(in_b, cam_b);
}

/// A valve moves from now on.
template <class Real, class S>
void set_moving(ValvesAtHand<Real, S>& valves, std::uint32_t v) noexcept {
  CRANKLOOP_ASSERT((valves.work.moving >> v & 1) == 0);
  valves.work.moving |= ValveBits<S>{1} << v;
  if constexpr (ValvesAtHand<Real, S>::kMoversFirst) swap_lanes(valves, valves.lane_of(v), valves.work.movers++);
}

/// Some are left alone: at rest, their cams away.
template <class Real, class S>
void leave_alone(ValvesAtHand<Real, S>& valves, ValveBits<S> which) noexcept {
  CRANKLOOP_ASSERT((valves.work.moving & which) == which);
  valves.work.moving &= ~which;
  if constexpr (ValvesAtHand<Real, S>::kMoversFirst) {
    for (ValveBits<S> left = which; left != 0; left &= left - 1)
      swap_lanes(valves, valves.lane_of(trailing_zeros(left)), --valves.work.movers);
  }
  for (CamWindow& clear : valves.work.clear) clear = {};  // found anew with the next tick
}

}  // namespace crankloop::detail

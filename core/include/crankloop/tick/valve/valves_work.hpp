// What a tick of elastic valves remembers beside the state, all of it worked out from that.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <crankloop/assert.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/lift_curve.hpp>
#include <crankloop/tables/valve_tables.hpp>

namespace crankloop::detail {

/// Whether a scene's valves have the layout for lanes: enough valves for a block. By processor, not by the compiler's
/// flags, for the size of an engine depends on it.
#if defined(__x86_64__) || defined(__aarch64__)
inline constexpr bool kHasLanes = true;
#else
inline constexpr bool kHasLanes = false;
#endif
template <class Real, class S>
inline constexpr bool kLaneLayout = kHasLanes && sizeof(Real) == 4 && S::trains.capacity* S::cylinders.capacity >= 4;

/// Lanes of an engine: one for each valve, in whole blocks where the layout is for vectors.
template <class S, class Real = float>
inline constexpr std::size_t kLaneRoom = kLaneLayout<Real, S> ? (group::ValvesState<float, S>::kLanes + 7) / 8 * 8
                                                              : group::ValvesState<Real, S>::kLanes;

/// What lanes need side by side of their valves' bodies, where gas or surging springs push them,
template <class S>
struct GasLanes {
  float head_area_m2[kLaneRoom<S>] = {}, per_seat_N_m[kLaneRoom<S>] = {};
};
/// and where their forces are shown;
template <class S>
struct ForceLanes {
  float train_N_m[kLaneRoom<S>] = {}, train_Ns_m[kLaneRoom<S>] = {};
  float preload_N[kLaneRoom<S>] = {}, seat_N_m[kLaneRoom<S>] = {}, seat_Ns_m[kLaneRoom<S>] = {};
  float rocker_mass_kg[kLaneRoom<S>] = {};
};
/// and of their records: the maxima, and ValveRecord::only_maxima_below_m();
template <class S>
struct RecordLanes {
  float max_lift_m[kLaneRoom<S>] = {}, max_speed_m_s[kLaneRoom<S>] = {};
  float max_acceleration_m_s2[kLaneRoom<S>] = {};
  float only_maxima_below_m[kLaneRoom<S>] = {};
};

/// and where valves come to rest: active ones come first, in any order. (Pushed ones all stay active, and a lane is a
/// valve's number.)
template <class S>
struct LanesInUse {
  float lift_m[kLaneRoom<S>] = {}, velocity_m_s[kLaneRoom<S>] = {};  ///< copies of the state
  std::uint32_t valve[kLaneRoom<S>] = {};                            ///< the valve in each lane,
  std::uint32_t lane[kLaneRoom<S>] = {};                             ///< and the lane of each valve
  std::uint32_t active_lanes = 0;                                    ///< lanes of active valves: the first ones
};

/// What vectors of lanes read besides, so that a block loads it side by side (tick/valve/valve_lanes.hpp).
template <class S>
struct alignas(16) VectorLanes : If<Needs<S>::valve_push, GasLanes<S>>,
                                 If<S::valve_forces, ForceLanes<S>>,
                                 If<S::valve_results, RecordLanes<S>>,
                                 If<!Needs<S>::valve_push, LanesInUse<S>> {
  static constexpr bool kBlocksAligned = !Needs<S>::valve_push || S::cylinders.exact || S::cylinders.capacity % 4 == 0;
  alignas(16) float constants[34][kLaneRoom<S>] = {};     ///< numbers of each lane's RegimeStep, up to decoupled_m
  const LiftSegment<float>* segments[kLaneRoom<S>] = {};  ///< of its cam's lift
  std::uint32_t degrees[kLaneRoom<S>] = {};               ///< of its lobe
  std::uint32_t opens_degree[kLaneRoom<S>] = {};          ///< of the train's cams: where its lobe begins,
  std::uint32_t opens_into[kLaneRoom<S>] = {};            ///< and where in that degree, kSignBit flipped
};

/// A bit for each valve of an engine, by its number.
template <class S>
using ValveBits = std::conditional_t<(S::trains.capacity * S::cylinders.capacity > 32), std::uint64_t, std::uint32_t>;

/// What a tick of elastic valves remembers beside the state, all of it derived from that: of each valve, by its lane.
template <class Real, class S>
struct ValvesWork : If<kLaneLayout<Real, S>, VectorLanes<S>> {
  static constexpr std::size_t kLanes = kLaneRoom<S, Real>;
  alignas(kLaneLayout<Real, S> ? 16 : alignof(Real)) Real cam_lift_m[kLanes] = {};  ///< at the tick's end,
  Real cam_per_deg_m[kLanes] = {};                                                  ///< and its slope; while active
  const LiftCurve<Real>* curve[kLanes] = {};
  const RegimeStep<Real>* regime[kLanes] = {};  ///< of its tick
  Real skip_deg = 0;                            ///< a tick that turns the cams so far may pass over some lobe;
  Real guard_range_deg = 0;  ///< it is beyond some guards' range: the lift at its ends and in its middle does not do;
  Real wide_deg = 0;         ///< it is wide: the cubic through some lift's ends does not do
  ValveBits<S> active = 0;   ///< valves that are not at rest with their cams away
  ValveBits<S> near = 0;     ///< valves whose cams are near where these cams stand,
  ValveBits<S> ending = 0;   ///< and those whose cycle may end there
  std::uint32_t degree[kCamGroups<S>] = {};  ///< of the cams that turn alike; `near` and `ending` are of these
};

template <class Real, class S>
using ValvesWorkOf = If<Needs<S>::elastic_valves, ValvesWork<Real, S>>;

}  // namespace crankloop::detail

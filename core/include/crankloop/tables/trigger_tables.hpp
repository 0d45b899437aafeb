// What a trigger wheel's signal reads, made at set-up.
//
// What belongs here: the edges of a wheel over its turn. What does not: how they are made (tabulate/), how a tick finds
// them (trigger_wheel.hpp).
#pragma once

#include <cstdint>

#include <crankloop/limits.hpp>

namespace crankloop::detail {

/// Equal parts of a wheel's turn, each with the number of edges before it: so that the search for an edge is short.
inline constexpr int kTriggerParts = 128;

inline constexpr std::uint32_t kNoTrain = ~std::uint32_t{0};

/// One wheel. Angles on it are counted from its first rising edge as the shaft turns forward, 2^32 = one turn of the
/// wheel. Edges are there up to a rounding of 1.2e-10 turns.
struct TriggerTrack {
  const std::uint32_t* edges;  ///< angles on the wheel, rising; the first is 0, and even ones rise
  std::uint32_t edge_count;    ///< even, 2 to kMaxTriggerEdges
  std::uint32_t on_crank;      ///< 1: a turn of the wheel is 360 deg; 0, on a cam: 720
  std::uint64_t starts;        ///< engine phase at which the wheel stands at its first edge, its phaser at rest
  std::uint32_t train;         ///< whose phaser moves it; kNoTrain
  std::uint32_t inverted;      ///< 1: what rises falls
  std::uint32_t max_edges;     ///< that a tick passes one way at most, at the speed limit
  std::uint16_t edges_before[kTriggerParts + 1];  ///< per part, and at the end of all
};

/// The wheels of an engine.
struct TriggerWheels {
  const TriggerTrack* wheel;
  std::uint32_t count;  ///< 0 to kMaxTriggerWheels
};

}  // namespace crankloop::detail

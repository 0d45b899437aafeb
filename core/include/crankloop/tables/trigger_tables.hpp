// Tables of trigger wheels, filled at set-up.
//
// What belongs here: the edges of a wheel over its turn. What does not: how they are computed (tabulate/), how a tick
// finds them (trigger_wheel.hpp).
#pragma once

#include <cstdint>

#include <crankloop/limits.hpp>

namespace crankloop::detail {

/// Equal parts of a wheel's turn, each with the number of edges before it: they shorten the search for an edge.
inline constexpr int kTriggerParts = 128;

inline constexpr std::uint32_t kNoTrain = ~std::uint32_t{0};

/// One wheel. Angles on it are counted from its first rising edge as the shaft turns forward, 2^32 = one turn of the
/// wheel. Edges are rounded to 1.2e-10 turns.
struct TriggerTrack {
  const std::uint32_t* edges;  ///< angles on the wheel in increasing order; the first is 0, edges with even index rise
  std::uint32_t edge_count;    ///< even, 2 to kMaxTriggerEdges
  std::uint32_t on_crank;      ///< 1: on the crankshaft, one turn is 360 crank deg; 0: on a camshaft, 720
  std::uint64_t starts;        ///< engine phase of the wheel's first edge, phaser at zero
  std::uint32_t train;         ///< the train whose phaser moves the wheel, or kNoTrain
  std::uint32_t inverted;      ///< 1: the signal is inverted
  std::uint32_t max_edges;     ///< maximum number of edges that a tick passes in one direction, at the speed limit
  std::uint16_t edges_before[kTriggerParts + 1];  ///< per part, and in total
};

/// The wheels of an engine.
struct TriggerWheels {
  const TriggerTrack* wheel;
  std::uint32_t count;  ///< 0 to kMaxTriggerWheels
};

/// A fault of a wheel. A wheel that it does not change has its healthy track once more.
template <class Real>
struct WheelFaultRule {
  const TriggerTrack* track;
  std::uint64_t from_tick;  ///< on in ticks from_tick to before until_tick, the engine's first being 0
  std::uint64_t until_tick;
  std::uint32_t wheel;
  std::uint32_t input_mask;   ///< and while a bit of these is set; 0: none
  std::uint32_t inverted;     ///< 1: the signal is, beside the track's own sense
  std::uint32_t stuck;        ///< 0 no, 1 low, 2 high
  std::uint32_t noise_below;  ///< a pulse in a tick whose number, drawn from 0 to 2^32 - 2, is less
  std::uint32_t noise_seed;   ///< never 0
  Real pulse;                 ///< its length by that of the tick, at most 1/2
};

/// The faults of an engine's wheels.
template <class Real>
struct WheelFaultRules {
  const WheelFaultRule<Real>* fault;
  std::uint32_t count;  ///< 0 to kMaxWheelFaults
};

}  // namespace crankloop::detail

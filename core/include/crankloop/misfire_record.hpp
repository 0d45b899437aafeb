// What a run remembers of a cylinder's misfires.
//
// What belongs here: counts. What does not: which cycles misfire (define/misfire.hpp), the step
// (tick/crank/misfire.hpp).
#pragma once

#include <cstdint>

namespace crankloop {

/// Windows of on-board diagnosis in cycles of a cylinder: 200 and 1000 turns.
inline constexpr std::uint32_t kCyclesIn200Turns = 100, kCyclesIn1000Turns = 500;

/// One cylinder, since `init`. Counts are of its own cycles, whatever way the crank went between them, and wrap after
/// 2^32. A cycle counts from where it takes its fuel; one that an input cuts is no misfire.
struct MisfireRecord {
  std::uint32_t history[16];    ///< bit n of 512: whether cycle n, modulo 512, misfired
  std::uint32_t cycles;         ///< all
  std::uint32_t misfires;       ///< of them
  std::uint32_t in_200_turns;   ///< of the last kCyclesIn200Turns cycles
  std::uint32_t in_1000_turns;  ///< of the last kCyclesIn1000Turns cycles
  std::uint32_t random;         ///< of xorshift32
  std::uint32_t taken;          ///< 1: this cycle was counted
};

}  // namespace crankloop

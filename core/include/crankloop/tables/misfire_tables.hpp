// The rules by which cycles misfire, filled at set-up.
//
// What belongs here: one cylinder's rule. What does not: how a cycle goes by it (tick/crank/misfire.hpp).
#pragma once

#include <cstdint>

#include <crankloop/limits.hpp>

namespace crankloop::detail {

enum : std::uint32_t { kFires, kMisfiresSpread, kMisfiresInBursts, kMisfiresAtRandom, kMisfiresListed };

template <class Real>
struct MisfireRule {
  Real burning_ratio;                       ///< share of the heat that a misfiring cycle releases
  std::uint32_t pattern;                    ///< kFires to kMisfiresListed
  std::uint32_t misfires;                   ///< of `of` cycles, up to kMaxMisfirePeriod
  std::uint32_t of;                         ///< 1 or more
  std::uint32_t below;                      ///< at random: a number drawn from 0 to 2^32 - 2 that is less
  std::uint32_t seed;                       ///< never 0
  std::uint32_t listed;                     ///< entries of `cycle`
  std::uint32_t cycle[kMaxListedMisfires];  ///< from 1, rising
};

}  // namespace crankloop::detail

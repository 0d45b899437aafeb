// Whether a cylinder's next cycle misfires, and the counts of those that did.
//
// What belongs here: one cycle of one cylinder. What does not: when a cycle takes its fuel (misfire_step.hpp,
// gas/gas_cycle.hpp).
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/misfire_record.hpp>
#include <crankloop/tables/misfire_tables.hpp>
#include <crankloop/tick/random.hpp>

namespace crankloop::detail {

/// O(log of the list).
template <class Real>
[[nodiscard]] constexpr bool is_listed(const MisfireRule<Real>& rule, std::uint32_t cycle) noexcept {
  std::uint32_t low = 0, high = rule.listed;
  while (low < high) {
    const std::uint32_t middle = (low + high) / 2;
    if (rule.cycle[middle] < cycle) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low < rule.listed && rule.cycle[low] == cycle;
}

/// Whether cycle number `cycles`, from 0, misfires. Of n in m evenly spread those in which the whole part of
/// (cycle + 1) n / m rises: n of any m in a row.
template <class Real>
[[nodiscard]] constexpr bool misfires_next(const MisfireRule<Real>& rule, std::uint32_t cycles,
                                           std::uint32_t& random) noexcept {
  switch (rule.pattern) {
    case kMisfiresSpread:
      return cycles % rule.of * rule.misfires % rule.of >= rule.of - rule.misfires;
    case kMisfiresInBursts:
      return cycles % rule.of >= rule.of - rule.misfires;
    case kMisfiresAtRandom:
      return next_random(random) - 1 < rule.below;
    case kMisfiresListed:
      return is_listed(rule, cycles + 1);
    default:
      return false;
  }
}

/// Puts a cycle's misfire in the history and the counts, in O(1): what leaves a window is the bit as many cycles ago.
constexpr void count_cycle(MisfireRecord& record, bool misfires) noexcept {
  const auto bit = [&record](std::uint32_t cycle) { return record.history[cycle / 32 % 16] >> (cycle % 32) & 1u; };
  const std::uint32_t now = record.cycles, is = misfires ? 1 : 0;
  record.in_200_turns += is - bit(now - kCyclesIn200Turns);
  record.in_1000_turns += is - bit(now - kCyclesIn1000Turns);
  std::uint32_t& word = record.history[now / 32 % 16];
  word = (word & ~(1u << (now % 32))) | is << (now % 32);
  record.misfires += is;
  ++record.cycles;
}

/// Begins a cycle; answers the share of its heat that it releases. O(1).
template <class Real>
[[nodiscard, gnu::noinline]] Real begin_cycle(const MisfireRule<Real>& rule, MisfireRecord& record) noexcept {
  const bool misfires = misfires_next(rule, record.cycles, record.random);
  count_cycle(record, misfires);
  return misfires ? rule.burning_ratio : Real{1};
}

}  // namespace crankloop::detail

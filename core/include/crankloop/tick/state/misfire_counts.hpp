// Counts of misfires that a saved state leaves out: they follow from its history.
#pragma once

#include <cstdint>

#include <crankloop/misfire_record.hpp>

namespace crankloop::detail {

[[nodiscard]] constexpr std::uint32_t misfires_in_last(const MisfireRecord& record, std::uint32_t cycles) noexcept {
  std::uint32_t sum = 0;
  for (std::uint32_t back = 1; back <= cycles; ++back) {
    const std::uint32_t cycle = record.cycles - back;
    sum += record.history[cycle / 32 % 16] >> (cycle % 32) & 1u;
  }
  return sum;
}

constexpr void recount(MisfireRecord& record) noexcept {
  record.in_200_turns = misfires_in_last(record, kCyclesIn200Turns);
  record.in_1000_turns = misfires_in_last(record, kCyclesIn1000Turns);
}

}  // namespace crankloop::detail

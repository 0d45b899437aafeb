// Counts of misfires that a saved state leaves out: they follow from its history.
#pragma once

#include <cstdint>

#include <crankloop/misfire_record.hpp>

namespace crankloop::detail {

[[nodiscard]] constexpr std::uint32_t ones_of(std::uint32_t word) noexcept {
  word -= word >> 1 & 0x5555'5555u;
  word = (word & 0x3333'3333u) + (word >> 2 & 0x3333'3333u);
  return ((word + (word >> 4)) & 0x0F0F'0F0Fu) * 0x0101'0101u >> 24;
}

/// Of a history of 16 words, a bit for each cycle; at most 512 cycles.
[[nodiscard]] constexpr std::uint32_t misfires_in_last(const MisfireRecord& record, std::uint32_t cycles) noexcept {
  std::uint32_t sum = 0;
  for (std::uint32_t back = cycles; back > 0;) {
    const std::uint32_t cycle = record.cycles - back;
    const std::uint32_t room = 32 - cycle % 32;
    const std::uint32_t taken = room < back ? room : back;
    const std::uint32_t word = record.history[cycle / 32 % 16] >> (cycle % 32);
    sum += ones_of(taken < 32 ? word & ((1u << taken) - 1) : word);
    back -= taken;
  }
  return sum;
}

constexpr void recount(MisfireRecord& record) noexcept {
  record.in_200_turns = misfires_in_last(record, kCyclesIn200Turns);
  record.in_1000_turns = misfires_in_last(record, kCyclesIn1000Turns);
}

}  // namespace crankloop::detail

// What an instruction of Thumb-2 does to the flow of a program.
//
// What belongs here: the instruction set (Armv7-M and Armv8-M, "Armv7-M Architecture Reference Manual" A6.3). What does
// not: how blocks follow each other (graph.hpp).
#pragma once

#include <cstdint>
#include <string>

#include "listing.hpp"

namespace worst_tick {

struct Flow {
  bool goes_on = true;   ///< to the next instruction
  bool jumps = false;    ///< to `target`
  bool calls = false;    ///< `target`, and comes back
  bool returns = false;  ///< to the caller
  std::uint32_t target = 0;
};

/// Whether "eq", "ne", ...
[[nodiscard]] bool is_condition(const std::string& text);

/// Refuses what it does not know where it leads: calls and jumps by registers, jump tables, traps.
[[nodiscard]] Flow flow_of(const Instruction& instruction);

}  // namespace worst_tick

// What an image asks of the machine it runs on: text out, an end, a count of instructions, the extent of its stack.
//
// What belongs here: the declarations that every folder of port/ implements, and no more than crankloop's own images
// need. What does not: anything of the library, which asks nothing of a machine; the clock and the interrupts, which
// are the application's.
#pragma once

#include <cstdint>

namespace crankloop::port {

/// Writes a zero-terminated text where a person, or ctest, reads it.
void write(const char* text) noexcept;

/// Ends the image; 0 = well.
[[noreturn]] void finish(int status) noexcept;

/// A counter that runs with the instructions, and how many it counted from one reading to a later one less than 100
/// million instructions on: exact in the emulator when that is started as the toolchain file says. The readings
/// themselves are among them, a constant that a caller measures and takes off. 0 for ever where there is no counter.
[[nodiscard]] std::uint32_t counter() noexcept;
[[nodiscard]] std::uint32_t instructions_between(std::uint32_t from, std::uint32_t to) noexcept;

/// What is left of the stack below the caller, for painting. Both null where the stack is the operating system's.
struct FreeStack {
  std::uint32_t* low;  ///< the stack must not grow below
  std::uint32_t* top;  ///< the caller's stack pointer, or a little below
};
[[nodiscard]] FreeStack free_stack() noexcept;

}  // namespace crankloop::port

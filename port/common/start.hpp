// What every bare-metal start-up does before main, once the stack and the floating-point unit are there.
//
// What belongs here: initialised data, zeroed data, constructors. What does not: what differs between processors (each
// port's start.cpp).
#pragma once

#include <cstdint>

// Set by the linker script. Functions that run constructors are addresses in a row.
extern "C" {
extern std::uint32_t crankloop_data_in_flash[];
extern std::uint32_t crankloop_data_begin[];
extern std::uint32_t crankloop_data_end[];
extern std::uint32_t crankloop_zero_begin[];
extern std::uint32_t crankloop_zero_end[];
extern void (*const crankloop_constructors_begin[])();
extern void (*const crankloop_constructors_end[])();
extern std::uint32_t crankloop_stack_low[];
}

int main();

namespace crankloop::port {

/// An engine made by crankloop_add_scene gets its tables in its constructor, so an image that leaves the last loop out
/// has engines that answer kFaultNotReady.
inline void prepare_memory() noexcept {
  const volatile std::uint32_t* from = crankloop_data_in_flash;
  for (volatile std::uint32_t* to = crankloop_data_begin; to != crankloop_data_end; ++to) *to = *from++;
  for (volatile std::uint32_t* to = crankloop_zero_begin; to != crankloop_zero_end; ++to) *to = 0;
  for (auto constructor = crankloop_constructors_begin; constructor != crankloop_constructors_end; ++constructor)
    (*constructor)();
}

}  // namespace crankloop::port

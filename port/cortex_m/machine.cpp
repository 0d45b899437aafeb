// Semihosting and the instruction counter on QEMU's Cortex-M machines.
//
// Semihosting for AArch32 and AArch64 (Arm IHI 0100): operation in r0, argument in r1, breakpoint 0xAB in Thumb code.
#include "port/common/machine.hpp"

extern "C" std::uint32_t crankloop_stack_low[];

namespace crankloop::port {
namespace {

constexpr std::uint32_t kWrite0 = 0x04;
constexpr std::uint32_t kExitExtended = 0x20;
constexpr std::uint32_t kApplicationExit = 0x20026;

void ask_host(std::uint32_t operation, const void* argument) noexcept {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

// CMSDK timer 0 of the MPS2 boards: counts down at 25 MHz. QEMU's -icount shift=10 makes an instruction take 1024 ns
// = 25.6 counts.
struct Timer {
  volatile std::uint32_t control;
  volatile std::uint32_t value;
  volatile std::uint32_t reload;
};
Timer* const timer = reinterpret_cast<Timer*>(0x40000000u);

}  // namespace

void write(const char* text) noexcept { ask_host(kWrite0, text); }

void finish(int status) noexcept {
  const std::uint32_t block[2] = {kApplicationExit, static_cast<std::uint32_t>(status)};
  ask_host(kExitExtended, block);
  for (;;) {
  }
}

std::uint32_t counter() noexcept {
  if ((timer->control & 1u) == 0) {
    timer->reload = 0xFFFFFFFFu;
    timer->value = 0xFFFFFFFFu;
    timer->control = 1;
  }
  return 0xFFFFFFFFu - timer->value;
}

std::uint32_t instructions_between(std::uint32_t from, std::uint32_t to) noexcept {
  return static_cast<std::uint32_t>((std::uint64_t{to - from} * 10 + 128) / 256);
}

FreeStack free_stack() noexcept {
  std::uint32_t here;
  asm volatile("mov %0, sp" : "=r"(here));
  return {crankloop_stack_low, reinterpret_cast<std::uint32_t*>(here)};
}

}  // namespace crankloop::port

// Semihosting and the instruction counter of a Cortex-R5F in QEMU.
//
// Semihosting for AArch32 and AArch64 (Arm IHI 0100): operation in r0, argument in r1, supervisor call 0x123456 in Arm
// code. Within supervisor mode the call overwrites lr.
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
  asm volatile("svc 0x123456" : "+r"(r0) : "r"(r1) : "memory", "lr");
}

}  // namespace

void write(const char* text) noexcept { ask_host(kWrite0, text); }

void finish(int status) noexcept {
  const std::uint32_t block[2] = {kApplicationExit, static_cast<std::uint32_t>(status)};
  ask_host(kExitExtended, block);
  for (;;) {
  }
}

// The performance monitor's cycle counter (Armv7-AR Architecture Reference Manual, C12): QEMU's counts nanoseconds of
// emulated time, and -icount shift=0 makes an instruction take one.
std::uint32_t counter() noexcept {
  std::uint32_t control;
  asm volatile("mrc p15, 0, %0, c9, c12, 0" : "=r"(control));
  if ((control & 1u) == 0) {
    asm volatile("mcr p15, 0, %0, c9, c12, 0" ::"r"(control | 5u));  // enable all, reset the cycle counter
    asm volatile("mcr p15, 0, %0, c9, c12, 1" ::"r"(0x80000000u));   // and the cycle counter itself
  }
  std::uint32_t count;
  asm volatile("mrc p15, 0, %0, c9, c13, 0" : "=r"(count)::"memory");
  return count;
}

std::uint32_t instructions_between(std::uint32_t from, std::uint32_t to) noexcept { return to - from; }

FreeStack free_stack() noexcept {
  std::uint32_t here;
  asm volatile("mov %0, sp" : "=r"(here));
  return {crankloop_stack_low, reinterpret_cast<std::uint32_t*>(here)};
}

}  // namespace crankloop::port

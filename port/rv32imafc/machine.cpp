// Semihosting and the instruction counter of RISC-V.
//
// RISC-V semihosting 0.3: operation in a0, argument in a1, and three uncompressed instructions in a row on one page.
#include "port/common/machine.hpp"

extern "C" std::uint32_t crankloop_stack_low[];

namespace crankloop::port {
namespace {

constexpr std::uint32_t kWrite0 = 0x04;
constexpr std::uint32_t kExitExtended = 0x20;
constexpr std::uint32_t kApplicationExit = 0x20026;

[[gnu::noinline]] void ask_host(std::uint32_t operation, const void* argument) noexcept {
  register std::uint32_t a0 asm("a0") = operation;
  register const void* a1 asm("a1") = argument;
  asm volatile(
      ".balign 16\n"
      ".option push\n"
      ".option norvc\n"
      "slli zero, zero, 0x1f\n"
      "ebreak\n"
      "srai zero, zero, 7\n"
      ".option pop\n"
      : "+r"(a0)
      : "r"(a1)
      : "memory");
}

}  // namespace

void write(const char* text) noexcept { ask_host(kWrite0, text); }

void finish(int status) noexcept {
  const std::uint32_t block[2] = {kApplicationExit, static_cast<std::uint32_t>(status)};
  ask_host(kExitExtended, block);
  for (;;) {
  }
}

std::uint32_t counter() noexcept {
  std::uint32_t count;
  asm volatile("csrr %0, minstret" : "=r"(count)::"memory");
  return count;
}

std::uint32_t instructions_between(std::uint32_t from, std::uint32_t to) noexcept { return to - from; }

FreeStack free_stack() noexcept {
  std::uint32_t here;
  asm volatile("mv %0, sp" : "=r"(here));
  return {crankloop_stack_low, reinterpret_cast<std::uint32_t*>(here)};
}

}  // namespace crankloop::port

// What the images ask of the machine: port/common/machine.hpp says what each function promises.
#include "port/common/machine.hpp"

extern "C" std::uint32_t crankloop_stack_low[];

namespace crankloop::port {
namespace {

// CHANGE: a way out for text and status. Semihosting works in QEMU and with every debugger; a UART does too, if a
// script on the other side looks for "N passed, M failed" and makes the exit status of it.
void ask_host(std::uint32_t operation, const void* argument) noexcept {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

// CHANGE: a free-running counter. Here CMSDK timer 0 of the board, which counts down at 20 MHz.
struct Timer {
  volatile std::uint32_t control;
  volatile std::uint32_t value;
  volatile std::uint32_t reload;
};
Timer* const timer = reinterpret_cast<Timer*>(0x50000000u);

}  // namespace

void write(const char* text) noexcept { ask_host(0x04, text); }  // SYS_WRITE0

void finish(int status) noexcept {
  const std::uint32_t block[2] = {0x20026, static_cast<std::uint32_t>(status)};  // ADP_Stopped_ApplicationExit
  ask_host(0x20, block);                                                         // SYS_EXIT_EXTENDED
  for (;;) {
  }
}

std::uint32_t counter() noexcept {
  if ((timer->control & 1u) == 0) {
    timer->reload = 0xFFFFFFFFu;
    timer->value = 0xFFFFFFFFu;
    timer->control = 1;
  }
  return 0xFFFFFFFFu - timer->value;  // upwards
}

// CHANGE: counts to instructions, or to cycles on a board (docs/measurements then says cycles). Here 1024 ns an
// instruction, 20.48 counts.
std::uint32_t instructions_between(std::uint32_t from, std::uint32_t to) noexcept {
  return static_cast<std::uint32_t>((std::uint64_t{to - from} * 25 + 256) / 512);
}

// CHANGE: how to read the stack pointer.
FreeStack free_stack() noexcept {
  std::uint32_t here;
  asm volatile("mov %0, sp" : "=r"(here));
  return {crankloop_stack_low, reinterpret_cast<std::uint32_t*>(here)};
}

}  // namespace crankloop::port

// Start-up of a RISC-V core in machine mode: trap vector, stack, floating-point unit.
//
// What belongs here: what happens between reset and main on one hart, interrupts off. What does not: a board's clocks
// and memories.
#include "port/common/start.hpp"

#include "port/common/machine.hpp"

extern "C" {

[[noreturn]] void crankloop_main();
[[noreturn]] void crankloop_fault();

// mstatus.FS = 1 (initial) turns the floating-point unit on (RISC-V privileged architecture, 3.1.6.6).
[[gnu::section(".start"), gnu::naked, gnu::used]] void crankloop_reset() {
  asm volatile(
      "la sp, crankloop_stack_top\n"
      "la t0, crankloop_trap\n"
      "csrw mtvec, t0\n"
      "li t0, 1 << 13\n"
      "csrs mstatus, t0\n"
      "csrw fcsr, zero\n"
      "j crankloop_main\n");
}

[[gnu::naked, gnu::used, gnu::aligned(4)]] void crankloop_trap() {
  asm volatile(
      "la sp, crankloop_stack_top\n"
      "j crankloop_fault\n");
}

void crankloop_main() {
  crankloop::port::prepare_memory();
  crankloop::port::finish(main());
}

void crankloop_fault() {
  crankloop::port::write("stopped by a trap that nobody handles\n");
  crankloop::port::finish(3);
}

}  // extern "C"

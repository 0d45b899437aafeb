// Start-up of a Cortex-R5F: vectors, stack, floating-point unit.
//
// What belongs here: what happens between reset and main, one core, supervisor mode, interrupts off. What does not: the
// memory protection unit, caches, tightly coupled memory: a board's own business.
#include "port/common/start.hpp"

#include "port/common/machine.hpp"

extern "C" {

[[noreturn]] void crankloop_main();
[[noreturn]] void crankloop_fault();

// Eight exceptions of Armv7-R, a branch each: reset, undefined instruction, supervisor call, prefetch abort, data
// abort, (unused), interrupt, fast interrupt.
[[gnu::section(".start"), gnu::naked, gnu::used]] void crankloop_vectors() {
  asm volatile(
      "b crankloop_reset\n"
      "b crankloop_exception\n"
      "b crankloop_exception\n"
      "b crankloop_exception\n"
      "b crankloop_exception\n"
      "b crankloop_exception\n"
      "b crankloop_exception\n"
      "b crankloop_exception\n");
}

// The coprocessor access control register grants CP10 and CP11, FPEXC.EN turns the unit on (Armv7-AR Architecture
// Reference Manual, B4.1.40 and B6.1.39).
[[gnu::naked]] void crankloop_reset() {
  asm volatile(
      "ldr sp, =crankloop_stack_top\n"
      "mrc p15, 0, r0, c1, c0, 2\n"
      "orr r0, r0, #(0xF << 20)\n"
      "mcr p15, 0, r0, c1, c0, 2\n"
      "isb\n"
      "mov r0, #(1 << 30)\n"
      "vmsr fpexc, r0\n"
      "b crankloop_main\n");
}

[[gnu::naked, gnu::used]] void crankloop_exception() {
  asm volatile(
      "ldr sp, =crankloop_stack_top\n"
      "b crankloop_fault\n");
}

void crankloop_main() {
  crankloop::port::prepare_memory();
  crankloop::port::finish(main());
}

void crankloop_fault() {
  crankloop::port::write("stopped by an exception that nobody handles\n");
  crankloop::port::finish(3);
}

}  // extern "C"

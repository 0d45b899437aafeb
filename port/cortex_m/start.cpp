// Start-up of a Cortex-M with floating-point unit: vector table and reset.
//
// What belongs here: what happens between reset and main. What does not: clocks, flash wait states, caches: a board's
// own business.
#include "port/common/start.hpp"

#include "port/common/machine.hpp"

extern "C" {

extern std::uint32_t crankloop_stack_top[];
[[noreturn]] void crankloop_reset();
void crankloop_fault();

/// Defined by an application that uses the tick interrupt.
[[gnu::weak]] void SysTick_Handler() { crankloop_fault(); }

void crankloop_fault() {
  crankloop::port::write("stopped by a fault or an interrupt that nobody handles\n");
  crankloop::port::finish(3);
}

void crankloop_reset() {
  // Coprocessor access control register: full access to CP10 and CP11, the floating-point unit (Armv7-M Architecture
  // Reference Manual, B3.2.20).
  *reinterpret_cast<volatile std::uint32_t*>(0xE000ED88u) |= 0xFu << 20;
  asm volatile("dsb\n isb" ::: "memory");
  crankloop::port::prepare_memory();
  crankloop::port::finish(main());
}

}  // extern "C"

namespace {

using Handler = void (*)();

struct Vectors {
  std::uint32_t* stack_top;
  Handler handlers[15];
};

// The exceptions of Armv7-M by number: 1 reset, 2 to 6 faults, 11 SVCall, 12 debug, 14 PendSV, 15 SysTick.
[[gnu::section(".start"), gnu::used]] const Vectors vectors{
    crankloop_stack_top,
    {crankloop_reset, crankloop_fault, crankloop_fault, crankloop_fault, crankloop_fault, crankloop_fault,
     crankloop_fault, crankloop_fault, crankloop_fault, crankloop_fault, crankloop_fault, crankloop_fault,
     crankloop_fault, crankloop_fault, SysTick_Handler}};

}  // namespace

// Start-up: vector table and reset. CHANGE: as it stands, of a Cortex-M with floating-point unit.
//
// What belongs here: what happens between reset and main. Section .start is what the linker script puts first into
// flash.
#include "port/common/start.hpp"

#include "port/common/machine.hpp"

extern "C" {

extern std::uint32_t crankloop_stack_top[];
[[noreturn]] void crankloop_reset();

void crankloop_fault() {
  crankloop::port::write("stopped by a fault or an interrupt that nobody handles\n");
  crankloop::port::finish(3);
}

void crankloop_reset() {
  // CHANGE: turn the floating-point unit on, before anything else. A processor that does not load the stack pointer
  // from its vector table does that first, in a [[gnu::naked]] function: see port/cortex_r5f and port/rv32imafc.
  *reinterpret_cast<volatile std::uint32_t*>(0xE000ED88u) |= 0xFu << 20;  // CPACR: CP10 and CP11
  asm volatile("dsb\n isb" ::: "memory");
  crankloop::port::prepare_memory();  // initialised data, zeroed data, constructors
  crankloop::port::finish(main());
}

}  // extern "C"

namespace {

using Handler = void (*)();

struct Vectors {
  std::uint32_t* stack_top;
  Handler handlers[15];
};

// CHANGE: the processor's exceptions. Here: 1 is reset, all else ends the image.
[[gnu::section(".start"), gnu::used]] const Vectors vectors{
    crankloop_stack_top,
    {crankloop_reset, crankloop_fault, crankloop_fault, crankloop_fault, crankloop_fault, crankloop_fault,
     crankloop_fault, crankloop_fault, crankloop_fault, crankloop_fault, crankloop_fault, crankloop_fault,
     crankloop_fault, crankloop_fault, crankloop_fault}};

}  // namespace

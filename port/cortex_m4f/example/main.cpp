// A firmware that runs a four-cylinder engine with eight valves from a timer interrupt at 10 kHz, from standstill to
// 6000 rpm in two seconds.
//
// The interrupt does what a controller's would: reads the speed (here a ramp), steps the engine, keeps what it needs,
// and looks whether it was done in time. On a board it also counts the cycles of each step. The main loop sleeps,
// prints when all is over, and ends with the number of things that went wrong.
#include <cstdint>

#include "example_engine.hpp"
#include "model_cycles.hpp"
#include "port/common/machine.hpp"
#include "port/common/text.hpp"

namespace {

constexpr std::uint32_t kTicksPerSecond = 10'000;
constexpr std::uint32_t kRampTicks = 2 * kTicksPerSecond;
constexpr std::uint32_t kHoldTicks = kTicksPerSecond / 10;  ///< at 6000 rpm: five cycles
constexpr float kRedline_rad_s = 628.3185F;

// SysTick and the interrupt control and state register (Armv7-M Architecture Reference Manual, B3.3 and B3.2.4).
struct SysTickRegisters {
  volatile std::uint32_t control;
  volatile std::uint32_t reload;
  volatile std::uint32_t value;
};
SysTickRegisters* const systick = reinterpret_cast<SysTickRegisters*>(0xE000E010u);
volatile std::uint32_t* const interrupt_state = reinterpret_cast<volatile std::uint32_t*>(0xE000ED04u);
constexpr std::uint32_t kSysTickPending = 1u << 26;

// The core's cycle counter, and what turns it on (Armv7-M Architecture Reference Manual, C1.8 and C1.6.5). It stays 0
// in QEMU.
volatile std::uint32_t* const trace_control = reinterpret_cast<volatile std::uint32_t*>(0xE000EDFCu);
volatile std::uint32_t* const cycle_counter_control = reinterpret_cast<volatile std::uint32_t*>(0xE0001000u);
volatile std::uint32_t* const cycle_counter = reinterpret_cast<volatile std::uint32_t*>(0xE0001004u);

constexpr std::uint32_t kCoreClock_Hz = 25'000'000;  // of the board MPS2 with its AN386 image

example_engine::Engine engine;  // tables in flash, state here

/// Written by the interrupt, read by the main loop once `done` is set.
struct Results {
  std::uint32_t faults;
  std::uint32_t overruns;       ///< ticks during which the next one fell due
  std::uint32_t worst_time_us;  ///< of a tick
  std::uint32_t worst_cycles;   ///< of a step
  std::uint64_t sum_of_cycles;  ///< of all steps
  float mean_torque_sum_Nm;     ///< over the ticks at full speed
  float largest_lift_m;
  float lowest_lift_m;
};
Results results{};
std::uint32_t ticks = 0;
volatile bool done = false;

void keep(const example_engine::Output& out) {
  results.faults |= out.faults;
  for (const auto& train : out.valve) {
    for (const auto& valve : train) {
      if (valve.lift_m > results.largest_lift_m) results.largest_lift_m = valve.lift_m;
      if (valve.lift_m < results.lowest_lift_m) results.lowest_lift_m = valve.lift_m;
    }
  }
  if (ticks > kRampTicks) results.mean_torque_sum_Nm += out.mean_torque_Nm;
}

}  // namespace

extern "C" void SysTick_Handler() {
  if (done) return;
  example_engine::Input in;
  ++ticks;
  in.speed_rad_s = ticks < kRampTicks ? kRedline_rad_s * static_cast<float>(static_cast<std::int32_t>(ticks)) /
                                            static_cast<float>(kRampTicks)
                                      : kRedline_rad_s;
  const std::uint32_t before = *cycle_counter;
  const example_engine::Output& out = engine.step(in);
  const std::uint32_t cycles = *cycle_counter - before;
  results.sum_of_cycles += cycles;
  if (cycles > results.worst_cycles) results.worst_cycles = cycles;
  keep(out);

  const std::uint32_t elapsed_us = (systick->reload - systick->value) / (kCoreClock_Hz / 1'000'000);
  if (elapsed_us > results.worst_time_us) results.worst_time_us = elapsed_us;
  if ((*interrupt_state & kSysTickPending) != 0) ++results.overruns;
  if (ticks == kRampTicks + kHoldTicks) done = true;
}

int main() {
  *trace_control |= 1u << 24;  // TRCENA
  *cycle_counter = 0;
  *cycle_counter_control |= 1u;  // CYCCNTENA
  systick->reload = kCoreClock_Hz / kTicksPerSecond - 1;
  systick->value = 0;
  systick->control = 7;  // processor clock, interrupt, on
  while (!done) asm volatile("wfi");

  using crankloop::port::Line;
  const auto micrometres = [](float x_m) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(x_m * 1e6F)); };
  const auto mean_torque_Nm = static_cast<std::int32_t>(results.mean_torque_sum_Nm / static_cast<float>(kHoldTicks));
  Line() << "ticks " << ticks << " at 10 kHz, standstill to 6000 rpm";
  Line() << "mean torque at 6000 rpm " << static_cast<std::uint32_t>(mean_torque_Nm) << " Nm";
  Line() << "largest valve lift " << micrometres(results.largest_lift_m) << " um";
  Line() << "worst tick " << results.worst_time_us << " us of 100";
  if (results.worst_cycles != 0) {
    Line() << "cycles of a step, mean / worst: " << static_cast<std::uint32_t>(results.sum_of_cycles / ticks) << " / "
           << results.worst_cycles;
  } else {
    Line() << "this machine counts no cycles";
  }
  Line() << "the model's, without wait states: " << kModelCycles.mean << " / " << kModelCycles.worst
         << "; at 5 without a cache: " << kModelCyclesAt5.mean << " / " << kModelCyclesAt5.worst;
  Line() << "overruns " << results.overruns << ", fault bits " << results.faults;

  std::uint32_t failed = 0;
  const auto expect = [&failed](bool well, const char* what) {
    if (!well) Line() << "FAILED: " << what;
    failed += well ? 0 : 1;
  };
  expect(results.overruns == 0, "every tick is done before the next");
  expect(results.faults == 0, "no fault bits");
  // 1.596 L at 1050 kPa over 4 pi: 133.4 Nm.
  expect(mean_torque_Nm >= 132 && mean_torque_Nm <= 134, "the torque is that of the mean effective pressure");
  // Its cam's lift is 7.71 mm; an elastic valve overshoots by tenths of a millimetre at most below its float speed.
  expect(results.largest_lift_m > 7.5e-3F && results.largest_lift_m < 8e-3F, "the valves follow their cams");
  expect(results.lowest_lift_m > -50e-6F, "the valves do not sink into their seats");
  Line() << 5 - failed << " passed, " << failed << " failed";
  crankloop::port::finish(failed == 0 ? 0 : 1);
}

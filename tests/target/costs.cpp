// What a tick of one engine costs: instructions, RAM, stack. Compiled once for each scene, with COSTS_ENGINE and COSTS_ENGINE_HEADER defined;
// costs.sh reads what it prints.
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <crankloop/tick/valves_step.hpp>

#include "hostile.hpp"
#include "port/common/machine.hpp"
#include "port/common/text.hpp"

#include COSTS_ENGINE_HEADER

namespace {

namespace port = crankloop::port;
namespace under_test = COSTS_ENGINE;
using under_test::Engine;
using under_test::Input;
using under_test::Real;

Engine engine;
std::uint32_t phase_per_tick_high;  ///< of a measured phase

struct Speed {
  const char* name;
  std::int32_t rpm;  ///< such that a cycle is a whole number of ticks
};
constexpr Speed kSpeeds[] = {{"idle", 800}, {"rated", 5000}, {"redline", 6000}};
constexpr std::uint32_t kCycles = 2;  ///< measured, after as many in which the valves settle

Input input;

// Templates, since a scene's input lacks what the scene does not ask for.
template <class In>
void set_speed(In& in, std::int32_t rpm) noexcept {
  if constexpr (std::is_base_of_v<crankloop::SpeedInput<Real>, In>) {
    in.speed_rad_s = static_cast<Real>(rpm) * static_cast<Real>(0.10471975511965977);
  }
  if constexpr (crankloop::Needs<under_test::Scene>::input_pressure) {
    for (Real& pressure : in.pressure_Pa) pressure = static_cast<Real>(3e5);
  }
  // 2^32 per cycle of two turns.
  phase_per_tick_high = static_cast<std::uint32_t>((std::uint64_t{1} << 32) * static_cast<std::uint64_t>(rpm) * COSTS_TICK_US / 120'000'000u);
}

template <class In>
void turn_crank(In& in) noexcept {
  if constexpr (std::is_base_of_v<crankloop::PhaseInput, In>) in.crank += crankloop::Phase{std::uint64_t{phase_per_tick_high} << 32};
}

/// One step by the counter, with the call and without the reading of the counter.
std::uint32_t cost_of_step() noexcept {
  turn_crank(input);
  const std::uint32_t before = port::counter();
  engine.step(input);
  return port::instructions_between(before, port::counter());
}

std::uint32_t cost_of_counting() noexcept {
  const std::uint32_t before = port::counter();
  asm volatile("" ::: "memory");
  return port::instructions_between(before, port::counter());
}

void measure(const Speed& speed) noexcept {
  set_speed(input, speed.rpm);
  const std::uint32_t ticks = kCycles * (120'000'000u / (static_cast<std::uint32_t>(speed.rpm) * COSTS_TICK_US));
  for (std::uint32_t i = 0; i < ticks; ++i) cost_of_step();
  const std::uint32_t counting = cost_of_counting();
  std::uint64_t sum = 0;
  std::uint32_t worst = 0;
  std::uint32_t faults = 0;
  for (std::uint32_t i = 0; i < ticks; ++i) {
    const std::uint32_t cost = cost_of_step() - counting;
    sum += cost;
    if (cost > worst) worst = cost;
    faults |= engine.output().faults;
  }
  port::Line() << "instructions " << speed.name << " " << static_cast<std::uint32_t>((sum + ticks / 2) / ticks) << " " << worst;
  if (faults != 0) port::Line() << "faults " << faults;
}

/// The worst of many ticks whose inputs are meant to hurt.
void measure_hostile() noexcept {
  constexpr int kTicks = 5000;
  target_check::Random random(495);
  const std::uint32_t counting = cost_of_counting();
  std::uint32_t worst = 0;
  for (int i = 0; i < kTicks; ++i) {
    target_check::hurt<Real, under_test::Scene>(input, random);
    const std::uint32_t cost = cost_of_step() - counting;
    if (cost > worst) worst = cost;
  }
  port::Line() << "hostile " << worst;
}

/// What bounds the loops of a tick, for worst_tick: counts of the engine, from its tables, and the tick's budget of contact changes.
template <class Tables>
void print_limits(const Tables& tables) noexcept {
  using Needs = crankloop::Needs<under_test::Scene>;
  port::Line() << "limit cylinders " << tables.drive->cylinders;
  port::Line() << "limit mechanisms " << tables.drive->mechanisms;
  port::Line() << "limit trains " << (Needs::any_valves ? tables.drive->trains : 0);
  std::uint32_t pins = 0;
  std::uint32_t steps = 1;
  std::uint32_t fine_steps = 1;
  if constexpr (under_test::Scene::bearing_loads) pins = tables.bearings->pins;
  if constexpr (Needs::elastic_valves) {
    for (std::uint32_t t = 0; t < tables.drive->trains; ++t) {
      const auto& motion = tables.valve_motions[t];
      if (motion.steps > steps) steps = motion.steps;
      if (motion.fine_per_step > fine_steps) fine_steps = motion.fine_per_step;
    }
  }
  port::Line() << "limit pins " << pins;
  port::Line() << "limit steps " << steps;
  port::Line() << "limit fine_steps " << fine_steps;
  port::Line() << "limit changes " << crankloop::detail::kEventsPerTick;
}

constexpr std::uint32_t kPaint = 0xA5C3965Au;
constexpr std::ptrdiff_t kPaintedWords = 2048;

/// Bytes of stack below this function's frame that the next steps touch, at all speeds.
std::uint32_t painted_stack() noexcept {
  const port::FreeStack stack = port::free_stack();
  if (stack.top == nullptr) return 0;
  std::uint32_t worst = 0;
  for (const Speed& speed : kSpeeds) {
    set_speed(input, speed.rpm);
    for (int i = 0; i < 2000; ++i) {
      for (volatile std::uint32_t* word = stack.top - kPaintedWords; word != stack.top; ++word) *word = kPaint;
      turn_crank(input);
      engine.step(input);
      const volatile std::uint32_t* deepest = stack.top - kPaintedWords;
      while (deepest != stack.top && *deepest == kPaint) ++deepest;
      const auto used = static_cast<std::uint32_t>(stack.top - deepest) * 4;
      if (used > worst) worst = used;
    }
  }
  return worst;
}

}  // namespace

int main() {
  for (const Speed& speed : kSpeeds) measure(speed);
  measure_hostile();
  print_limits(*engine.tables());
  port::Line() << "ram " << static_cast<std::uint32_t>(sizeof engine);
  port::Line() << "painted_stack " << painted_stack();
  port::finish(0);
}

// What a tick of one engine costs: instructions, RAM, stack. Compiled once for each scene; costs.sh reads what it
// prints.
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "worst_search.hpp"

namespace {

std::uint32_t phase_per_tick_high;  ///< of a measured phase
[[maybe_unused]] Real held_rad_s;   ///< of a crank that forces turn, by a brake that meets every change of it

struct Speed {
  const char* name;
  std::int32_t rpm;  ///< such that a cycle is a whole number of ticks
};
constexpr Speed kSpeeds[] = {{"idle", 800}, {"rated", 5000}, {"redline", 6000}};
constexpr std::uint32_t kCycles = 2;  ///< measured, after as many in which the valves settle

// Templates, since a scene's input lacks what the scene does not ask for.
template <class In>
void set_speed(In& in, std::int32_t rpm) noexcept {
  if constexpr (std::is_base_of_v<crankloop::group::SpeedInput<Real>, In>) {
    in.speed_rad_s = static_cast<Real>(rpm) * static_cast<Real>(0.10471975511965977);
  }
  if constexpr (crankloop::detail::Needs<under_test::Scene>::input_pressure) {
    for (Real& pressure : in.pressure_Pa) pressure = static_cast<Real>(3e5);
  }
  if constexpr (crankloop::detail::Needs<under_test::Scene>::burn_input) {
    for (Real& fuel : in.fuel_kg) fuel = static_cast<Real>(30e-6);
  }
  if constexpr (crankloop::detail::Needs<under_test::Scene>::crank_dynamics) {
    held_rad_s = static_cast<Real>(rpm) * static_cast<Real>(0.10471975511965977);
    (void)engine.restore(crankloop::turning_at<Real, under_test::Scene>(engine.state(), held_rad_s));
  }
  // 2^32 per cycle of two turns.
  phase_per_tick_high = static_cast<std::uint32_t>((std::uint64_t{1} << 32) * static_cast<std::uint64_t>(rpm) *
                                                   COSTS_TICK_US / 120'000'000u);
}

/// A template, so that a scene without a crank's motion need not have it in its output.
template <class Out>
Real speed_of(const Out& out) noexcept {
  return out.speed_rad_s;
}

template <class In>
void turn_crank(In& in) noexcept {
  if constexpr (std::is_base_of_v<crankloop::group::PhaseInput, In>)
    in.crank += crankloop::Phase{std::uint64_t{phase_per_tick_high} << 32};
  if constexpr (crankloop::detail::Needs<under_test::Scene>::crank_dynamics) {
    constexpr Real kBrake_Nm_s = 50;
    in.external_torque_Nm = kBrake_Nm_s * (speed_of(engine.output()) - held_rad_s);
  }
}

std::uint32_t cost_of_turn() noexcept {
  turn_crank(input);
  return cost_of_step();
}

void measure(const Speed& speed) noexcept {
  set_speed(input, speed.rpm);
  const std::uint32_t ticks = kCycles * (120'000'000u / (static_cast<std::uint32_t>(speed.rpm) * COSTS_TICK_US));
  for (std::uint32_t i = 0; i < ticks; ++i) cost_of_turn();
  const std::uint32_t counting = cost_of_counting();
  std::uint64_t sum = 0;
  std::uint32_t worst = 0;
  std::uint32_t faults = 0;
  crankloop_measures();
  for (std::uint32_t i = 0; i < ticks; ++i) {
    const std::uint32_t cost = cost_of_turn() - counting;
    sum += cost;
    if (cost > worst) worst = cost;
    faults |= engine.output().faults;
  }
  crankloop_measures();
  port::Line() << "instructions " << speed.name << " " << static_cast<std::uint32_t>((sum + ticks / 2) / ticks) << " "
               << worst;
  if (faults != 0) port::Line() << "faults " << faults;
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
  search_worst();
  print_limits(*engine.tables());
  port::Line() << "ram " << static_cast<std::uint32_t>(sizeof engine);
  port::Line() << "painted_stack " << painted_stack();
  port::finish(0);
}

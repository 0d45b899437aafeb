// Many ticks with input that is meant to hurt: the worst of them has to stay below the bound for any input. hostile.sh
// compares. Needs HOSTILE_TICKS, and what counted_step.hpp needs.
#include "hostile.hpp"
#include "counted_step.hpp"

namespace {

/// The worst of many ticks whose inputs are meant to hurt.
void measure_hostile(std::uint32_t ticks) noexcept {
  target_check::Random random(495);
  const std::uint32_t counting = cost_of_counting();
  std::uint32_t worst = 0;
  crankloop_measures();
  for (std::uint32_t i = 0; i < ticks; ++i) {
    target_check::hurt<Real, under_test::Scene>(input, random, engine.tables()->drive->speed_limit_rad_s);
    const std::uint32_t cost = cost_of_step() - counting;
    if (cost > worst) worst = cost;
  }
  crankloop_measures();
  port::Line() << "hostile " << worst;
}

}  // namespace

int main() {
  measure_hostile(HOSTILE_TICKS);
  print_limits(*engine.tables());
  port::finish(0);
}

// Many ticks with input that is meant to hurt: the worst of them has to stay below the bound for any input. hostile.sh
// compares. Needs HOSTILE_TICKS, and what counted_step.hpp needs.
#include "counted_step.hpp"

int main() {
  measure_hostile(HOSTILE_TICKS);
  print_limits(*engine.tables());
  port::finish(0);
}

// The engine with eight elastic valves, in float, up through the speeds: what tests/numerical_sanitizer.sh runs. No
// test: it asserts nothing, the sanitizer's findings are read line by line.
#include <cstdio>

#include "support/kept_engines.hpp"

int main() {
  using namespace crankloop;
  using tick_test::FourWithValves;
  const auto engine = tick_test::started_four<float, FourWithValves>();
  Input<float, FourWithValves> in;
  double sum = 0;  // or nothing would be computed
  for (const float rpm : {900.0F, 3000.0F, 6000.0F, 9000.0F}) {
    in.speed_rad_s = rpm * 0.10471976F;
    for (int tick = 0; tick < 600; ++tick) sum += static_cast<double>(engine->step(in).mean_torque_Nm);
  }
  return std::printf("%g\n", sum) < 0;
}

// Runs the 495 diesel for some cycles and looks whether it turns: the figures themselves are tested elsewhere.
#include <cstdio>

#include "my_engine.hpp"

static my_engine::Engine engine;

int main() {
  my_engine::Input in;
  in.speed_rad_s = 209.44F;
  float sum_Nm = 0;
  std::uint32_t faults = 0;
  constexpr int kTicks = 6000;  // ten cycles of 60 ms
  for (int tick = 0; tick < kTicks; ++tick) {
    const auto& out = engine.step(in);
    sum_Nm += out.mean_torque_Nm;
    faults |= out.faults;
  }
  const float mean_Nm = sum_Nm / kTicks;
  std::printf("mean torque %.1f Nm, faults %u\n", static_cast<double>(mean_Nm), static_cast<unsigned>(faults));
  return faults == 0 && mean_Nm > 200 && mean_Nm < 220 ? 0 : 1;  // 4 cylinders, 0.8151 L, 809.7 kPa over 4 pi: 210 Nm
}

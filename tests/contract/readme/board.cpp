// A board at constant speed: calls the README's loop for a second, or as many ticks as it is told, and looks whether
// torque comes out and no fault.
#include "board.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

static float last_torque_Nm = 0;
static std::uint32_t all_faults = 0;

float crank_speed() { return 209.44F; }
void set_torque(float torque_Nm) { last_torque_Nm = torque_Nm; }
void report(std::uint32_t faults) { all_faults |= faults; }

int main(int count, char** words) {
  const int ticks = count > 1 ? std::atoi(words[1]) : 10000;
  for (int tick = 0; tick < ticks; ++tick) every_100_us();
  std::printf("torque %g Nm, faults %u\n", static_cast<double>(last_torque_Nm), static_cast<unsigned>(all_faults));
  return all_faults == 0 && std::isfinite(last_torque_Nm) && last_torque_Nm != 0 ? 0 : 1;
}

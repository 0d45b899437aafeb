/* A loop in C99 over one product's engine: its RAM is the engine's own size. */
#include "torque_only.h"

static torque_only_engine engine;

int main(void) {
  torque_only_input in;
  torque_only_output out;
  int tick;
  float largest_Nm = 0;
  if (torque_only_input_defaults(&in, sizeof in).reason) return 1;
  if (torque_only_step(&engine, &in, sizeof in) != CRANKLOOP_FAULT_NOT_READY) return 1; /* zero memory is no engine */
  if (torque_only_create(&engine, sizeof engine, 0).reason) return 1;
  in.speed_rad_s = 209.5f;
  for (tick = 0; tick < 300; ++tick) {
    if (torque_only_step(&engine, &in, sizeof in) != 0) return 2;
    if (torque_only_read(&engine, &out, sizeof out).reason) return 2;
    if (out.torque_Nm > largest_Nm) largest_Nm = out.torque_Nm;
  }
  return largest_Nm > 700 && largest_Nm < 760 ? 0 : 3; /* 737 Nm: README.md */
}

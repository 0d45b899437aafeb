// main.cpp
#include "board.hpp"                // yours: crank_speed(), set_torque(), report()
#include "my_engine.hpp"            // made by crankloop_add_scene(my_engine my_scene.hpp my_engine.ini TICK_US 100)

static my_engine::Engine engine;    // its tables are constant data; the RAM is 80 bytes

void every_100_us() {
  my_engine::Input in;
  in.speed_rad_s = crank_speed();
  const auto& out = engine.step(in);  // whatever bits come in: a defined, finite output
  set_torque(out.mean_torque_Nm);     // averaged over the tick
  if (out.faults != 0) report(out.faults);
}

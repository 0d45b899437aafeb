// bench.cpp
#include <cstdio>

#include <crankloop/crankloop.hpp>

using Scene = crankloop::scenes::Whole;                // ready-made: all outputs, 1 to 16 cylinders
static crankloop::TableStorage<double, Scene> tables;  // 0.8 MB: static or on the heap, not on a stack
static crankloop::Engine<double, Scene> engine;

int main() {
  crankloop::EngineDefinition diesel;
  diesel.crank.bore_m = 0.095;
  diesel.crank.crank_radius_m = 0.0575;
  diesel.crank.rod_length_m = 0.210;
  diesel.crank.compression_ratio = 19;
  diesel.masses.piston_kg = 0.810;
  diesel.masses.rod_small_end_kg = 0.505;
  diesel.masses.rod_big_end_kg = 1.382;
  diesel.pressure.source = crankloop::PressureSource::wiebe;
  diesel.pressure.wiebe.net_mep_Pa = 809.7e3;
  const int order[] = {1, 3, 4, 2};

  crankloop::Status status = crankloop::set_firing_order(order, 4, diesel.layout);
  if (status.ok()) status = tables.build(diesel, {100e-6});  // the tick's length is in the tables: step takes none
  if (status.ok()) status = engine.init(tables.tables());
  if (!status.ok()) {
    std::printf("%s %s\n", status.field, crankloop::describe(status.reason));  // e.g. crank.rod_length_m must be longer than ...
    return 1;
  }

  crankloop::Engine<double, Scene>::Input in;
  in.speed_rad_s = 209.44;
  in.load_ratio = 0.5;                      // half of what combustion adds; 0 = motored
  const auto snapshot = engine.state();     // plain data: a copy is a snapshot
  for (int tick = 0; tick < 22; ++tick) engine.step(in);
  std::printf("%.1f Nm, %.0f N on the crank pin\n", engine.output().torque_Nm, engine.output().pin_load_N[0]);
  return engine.restore(snapshot).ok() ? 0 : 1;
}

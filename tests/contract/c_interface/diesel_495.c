/* The 495 diesel by the C interface alone, in C99: a cycle at 2000 rpm, torque of every tick in float and in double.
 * The values are printed as hexadecimal floats; c_engine_test.cpp compares them with the C++ engine's. */
#include <crankloop/crankloop_whole_d.h>
#include <crankloop/crankloop_whole_f.h>
#include <stdio.h>

static crankloop_whole_f_tables f_tables;
static crankloop_whole_f_engine f_engine;
static crankloop_whole_d_tables d_tables;
static crankloop_whole_d_engine d_engine;

static int refused(crankloop_status status) {
  char text[100];
  if (status.reason == CRANKLOOP_OK) return 0;
  crankloop_status_text(status, text, sizeof text);
  fprintf(stderr, "%s\n", text);
  return 1;
}

static void make_train(crankloop_valve_train* train, double half_angle_deg, double full_lift_deg, double valve_kg) {
  static const double exponents[] = {2, 6, 10, 14};
  int i;
  train->cam.max_lift_m = 7.2e-3;
  train->cam.half_angle_deg = half_angle_deg;
  train->cam.exponent_count = 4;
  for (i = 0; i < 4; ++i) train->cam.exponents[i] = exponents[i];
  train->cam.full_lift_deg = full_lift_deg;
  train->rocker.kind = CRANKLOOP_ROCKER_RATIO;
  train->rocker.ratio = 1.5;
  train->rocker.base_circle_m = 16e-3;
  train->rocker.clearance_m = 0.3e-3;
  train->valve.valve_kg = valve_kg;
  train->valve.spring_kg = 0.090;
  train->valve.spring_N_m = 25e3;
  train->valve.spring_preload_N = 320;
  train->valve.train_N_m = 7e6;
  train->valve.train_damping_ratio = 0.08;
  train->valve.guide_damping_ratio = 0.003;
  train->valve.seat_N_m = 5e7;
  train->valve.seat_damping_ratio = 0.1;
}

int main(void) {
  static const int32_t order[] = {1, 3, 4, 2};
  crankloop_definition diesel;
  crankloop_options options;
  crankloop_whole_f_input f_in;
  crankloop_whole_d_input d_in;
  int k, tick;

  if (refused(crankloop_definition_defaults(&diesel, sizeof diesel))) return 1;
  diesel.crank.bore_m = 0.095;
  diesel.crank.crank_radius_m = 0.0575;
  diesel.crank.rod_length_m = 0.210;
  diesel.crank.compression_ratio = 19;
  diesel.masses.piston_kg = 0.810;
  diesel.masses.rod_small_end_kg = 0.505;
  diesel.masses.rod_big_end_kg = 1.382;
  diesel.masses.crank_inertia_kg_m2 = 0.5;
  if (refused(crankloop_set_firing_order(&diesel, sizeof diesel, order, 4))) return 1;
  for (k = 0; k < 4; ++k) diesel.layout.position_m[k] = 0.120 * k;
  diesel.pressure.source = CRANKLOOP_PRESSURE_WIEBE;
  diesel.pressure.wiebe.net_mep_Pa = 809.7e3;
  diesel.train_count = 2;
  make_train(&diesel.trains[0], 78, 466, 0.480);
  make_train(&diesel.trains[1], 80, 266, 0.470);
  if (refused(crankloop_options_defaults(&options, sizeof options))) return 1;

  if (refused(crankloop_whole_f_tables_create(&f_tables, sizeof f_tables, &diesel, sizeof diesel, &options,
                                              sizeof options)))
    return 1;
  if (refused(crankloop_whole_f_create(&f_engine, sizeof f_engine, &f_tables, 0))) return 1;
  if (refused(crankloop_whole_f_input_defaults(&f_in, sizeof f_in))) return 1;
  if (refused(crankloop_whole_d_tables_create(&d_tables, sizeof d_tables, &diesel, sizeof diesel, &options,
                                              sizeof options)))
    return 1;
  if (refused(crankloop_whole_d_create(&d_engine, sizeof d_engine, &d_tables, 0))) return 1;
  if (refused(crankloop_whole_d_input_defaults(&d_in, sizeof d_in))) return 1;

  f_in.speed_rad_s = 209.5f;
  d_in.speed_rad_s = 209.5;
  for (tick = 0; tick < 600; ++tick) {
    crankloop_whole_f_output f_out;
    crankloop_whole_d_output d_out;
    uint32_t faults = crankloop_whole_f_step(&f_engine, &f_in, sizeof f_in);
    faults |= crankloop_whole_d_step(&d_engine, &d_in, sizeof d_in);
    if (faults != 0) return 1;
    if (refused(crankloop_whole_f_read(&f_engine, &f_out, sizeof f_out))) return 1;
    if (refused(crankloop_whole_d_read(&d_engine, &d_out, sizeof d_out))) return 1;
    printf("%a %a %a %a\n", (double)f_out.torque_Nm, (double)f_out.mean_torque_Nm, d_out.torque_Nm,
           d_out.mean_torque_Nm);
  }
  return 0;
}

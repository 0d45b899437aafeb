#include <crankloop/tabulate/valve_lift.hpp>
#include <crankloop/tabulate/valve_motion.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop {

using namespace detail;

ValveBody<double> valve_body(const Valve& valve, double lever_m) noexcept {
  ValveBody<double> b{};
  b.rocker_mass_kg = valve.rocker_inertia_kg_m2 / (lever_m * lever_m);
  b.mass_kg = valve.valve_kg + valve.spring_kg / 3 + b.rocker_mass_kg;
  b.train_N_m = valve.train_N_m;
  b.seat_N_m = valve.seat_N_m;
  b.spring_N_m = valve.spring_N_m;
  b.train_Ns_m = 2 * valve.train_damping_ratio * square_root(b.train_N_m * b.mass_kg);
  b.guide_Ns_m = 2 * valve.guide_damping_ratio * square_root(b.train_N_m * b.mass_kg);
  b.seat_Ns_m = 2 * valve.seat_damping_ratio * square_root(b.seat_N_m * b.mass_kg);
  b.preload_N = valve.spring_preload_N;
  b.seat_compression_m = valve.spring_preload_N / valve.seat_N_m;
  b.head_area_m2 = valve.head_area_m2;
  b.per_mass = 1 / b.mass_kg;
  return b;
}

ValveBody<double> valve_body(const Valve& valve, const ValveLift& lift) noexcept {
  return valve_body(valve, lift.lever_m() > 0 ? lift.lever_m() : 1);
}

double open_frequency_rad_s(const ValveBody<double>& body) noexcept {
  return square_root((body.train_N_m + body.spring_N_m) / body.mass_kg);
}

double seated_frequency_rad_s(const ValveBody<double>& body) noexcept {
  return square_root((body.train_N_m + body.seat_N_m + body.spring_N_m) / body.mass_kg);
}

}  // namespace crankloop

// Runs the 495 diesel, and the valve of the 125 stepped in three ways, for some cycles, and looks whether they turn:
// the figures themselves are tested elsewhere.
#include <cmath>
#include <cstdio>

#include "as_usual.hpp"
#include "exactly.hpp"
#include "finely.hpp"
#include "free_running.hpp"
#include "my_engine.hpp"
#include "whole.hpp"

static my_engine::Engine diesel;
static whole::Engine diesel_without_valves;
static free_running::Engine diesel_without_wheels;

template <class Engine>
static bool turns(Engine& engine) {
  typename Engine::Input in;
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
  return faults == 0 && mean_Nm > 200 && mean_Nm < 220;  // 4 cylinders, 0.8151 L, 809.7 kPa over 4 pi: 210 Nm
}

struct Seating {
  double largest_lift_m;
  double speed_m_s;
};

template <class Engine>
static Seating seating(Engine& valve) {
  typename Engine::Input in;
  in.speed_rad_s = 733.04;                                 // 7000 rpm
  for (int tick = 0; tick < 2000; ++tick) valve.step(in);  // six cycles of 17 ms
  const auto& cycle = valve.output().valve_cycle[0][0];
  std::printf("lift %.6f mm, seating at %.6f m/s\n", cycle.largest_lift_m * 1e3, cycle.seating_speed_m_s);
  return {cycle.largest_lift_m, cycle.seating_speed_m_s};
}

static as_usual::Engine usual_valve;
static exactly::Engine exact_valve;
static finely::Engine fine_valve;

/// Each way gives the valve's lift, 7.785 mm, within 0.2 um, and none the bits of another: the options have arrived.
static bool steps_in_three_ways() {
  const Seating ways[] = {seating(usual_valve), seating(exact_valve), seating(fine_valve)};
  for (const Seating& way : ways) {
    if (std::fabs(way.largest_lift_m - 7.785e-3) > 0.5e-6) return false;  // a printed digit
    if (std::fabs(way.largest_lift_m - ways[0].largest_lift_m) > 0.2e-6) return false;
  }
  return ways[0].speed_m_s != ways[1].speed_m_s && ways[0].speed_m_s != ways[2].speed_m_s &&
         ways[1].speed_m_s != ways[2].speed_m_s;
}

static bool starts() {
  free_running::Input in;
  in.starter = 1;
  for (int tick = 0; tick < 20000; ++tick) diesel_without_wheels.step(in);
  const auto& out = diesel_without_wheels.output();
  std::printf("after 2 s %.0f rad/s, faults %u\n", static_cast<double>(out.speed_rad_s),
              static_cast<unsigned>(out.faults));
  return out.faults == 0 && out.speed_rad_s > 50;
}

int main() { return turns(diesel) && turns(diesel_without_valves) && starts() && steps_in_three_ways() ? 0 : 1; }

#include "redline_search.hpp"

#include <algorithm>
#include <cmath>

#include "../../files/units.hpp"
#include "../../loops/valve_tick_limit.hpp"

namespace crankloop::program {
namespace {

constexpr int kMaxSteps = 60;
constexpr double kShortestTick_s = 1e-6;

/// The tick of the search, or the longest that a stiff train allows.
double tick_for(const LoneValve& valve) {
  const double longest_s = longest_tick_s(valve.body(), {});
  if (longest_s < kShortestTick_s) throw tick_too_long(valve.file(), valve.train(), valve.valve(), kShortestTick_s, {});
  return std::min(kRedlineTick_s, longest_s);
}

SpeedResult run_at(ValveLoop<double>& loop, const LoneValve& valve, int speed_rpm) {
  SpeedResult result{speed_rpm, {}, 0, 0, 0, true};
  result.cycle = run_cycles<double>(loop, valve, speed_rpm, kRedlineCycles, [&](const ValveTickOutput<double>& out) {
    result.train_N = std::max(result.train_N, out.forces.train_N);
    result.cam_N = std::max(result.cam_N, out.forces.cam_N);
  });
  return result;
}

template <class Happens, class RunAt>
Onset onset_of(const std::vector<SpeedResult>& sweep, const Happens& happens, const RunAt& run_at) {
  const auto first = std::find_if(sweep.begin(), sweep.end(), happens);
  if (first == sweep.end()) return {};
  if (first == sweep.begin()) return {true, true, first->speed_rpm};
  int without = (first - 1)->speed_rpm;
  int with = first->speed_rpm;
  while (with - without > 1) {
    const int middle = without + (with - without) / 2;
    (happens(run_at(middle)) ? with : without) = middle;
  }
  return {true, false, with};
}

}  // namespace

SpeedRange speed_range(int from_rpm, int to_rpm) noexcept {
  constexpr int kSteps[] = {1, 2, 5, 10, 20, 25, 50, 100, 200, 250, 500, 1000, 2000};
  for (const int step : kSteps) {
    if (to_rpm - from_rpm <= step * kMaxSteps) return {from_rpm, to_rpm, step};
  }
  return {from_rpm, to_rpm, (to_rpm - from_rpm + kMaxSteps - 1) / kMaxSteps};
}

Sweep sweep_speeds(const LoneValve& valve, const SpeedRange& range, double factor,
                   const std::function<void()>& after_speed, const RedlineLimits& limits) {
  Sweep sweep;
  sweep.factor = factor;
  sweep.tick_s = tick_for(valve);
  sweep.max_lift_m = limits.lift_m > 0 ? limits.lift_m : kMaxLiftRatio * std::max(0.0, valve.lift().largest_lift_m());
  sweep.rigid = valve.static_redline();
  ValveLoop<double> loop(valve, sweep.tick_s, {});
  const auto run = [&](int speed_rpm) {
    SpeedResult result = run_at(loop, valve, speed_rpm);
    result.spring_margin = sweep.rigid.margin(speed_rpm * kRad_sPerRpm);
    result.is_possible = result.cycle.largest_lift_m <= sweep.max_lift_m;
    if (after_speed) after_speed();
    return result;
  };
  for (int rpm = range.from_rpm; rpm < range.to_rpm; rpm += range.step_rpm) sweep.at.push_back(run(rpm));
  sweep.at.push_back(run(range.to_rpm));
  sweep.separation = onset_of(
      sweep.at, [](const SpeedResult& r) { return r.cycle.separations > 0; }, run);
  sweep.bounce = onset_of(
      sweep.at, [&](const SpeedResult& r) { return r.cycle.bounces > 0 && r.cycle.bounce_height_m >= limits.bounce_m; },
      run);
  sweep.seating = onset_of(
      sweep.at, [&](const SpeedResult& r) { return r.cycle.seating_speed_m_s > limits.seating_m_s; }, run);
  return sweep;
}

Valve varied(const Valve& valve, const std::string& option, double factor) {
  Valve other = valve;
  if (option == "train") other.train_N_m *= factor;
  if (option == "spring") other.spring_N_m *= factor;
  if (option == "preload") other.spring_preload_N *= factor;
  if (option == "mass") {
    other.valve_kg *= factor;
    other.spring_kg *= factor;
    other.rocker_inertia_kg_m2 *= factor;
  }
  if (option == "damping") {
    other.train_damping_ratio *= factor;
    other.guide_damping_ratio *= factor;
    other.seat_damping_ratio *= factor;
  }
  return other;
}

}  // namespace crankloop::program

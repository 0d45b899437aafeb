#include "redline_search.hpp"

#include <algorithm>
#include <cmath>

#include "../../files/units.hpp"
#include "../../loops/run_limits.hpp"
#include "../../loops/valve_tick_limit.hpp"

namespace crankloop::program {
namespace {

constexpr int kMaxSteps = 60;

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

}  // namespace

SpeedRange speed_range(int from_rpm, int to_rpm) noexcept {
  constexpr int kSteps[] = {1, 2, 5, 10, 20, 25, 50, 100, 200, 250, 500, 1000, 2000};
  for (const int step : kSteps) {
    if (to_rpm - from_rpm <= step * kMaxSteps) return {from_rpm, to_rpm, step};
  }
  return {from_rpm, to_rpm, (to_rpm - from_rpm + kMaxSteps - 1) / kMaxSteps};
}

SpeedSearch::SpeedSearch(const LoneValve& valve, const SpeedRange& range, double factor, const RedlineLimits& limits)
    : valve_{valve},
      range_{range},
      limits_{limits},
      loop_(valve, tick_for(valve), {}),
      next_rpm_{std::min(range.from_rpm, range.to_rpm)} {
  sweep_.factor = factor;
  sweep_.tick_s = tick_for(valve);
  sweep_.max_lift_m = limits.lift_m > 0 ? limits.lift_m : kMaxLiftRatio * std::max(0.0, valve.lift().largest_lift_m());
  sweep_.rigid = valve.static_redline();
}

SpeedResult SpeedSearch::run(int speed_rpm) {
  SpeedResult result = run_at(loop_, valve_, speed_rpm);
  result.spring_margin = sweep_.rigid.margin(speed_rpm * kRad_sPerRpm);
  result.is_possible = result.cycle.largest_lift_m <= sweep_.max_lift_m;
  return result;
}

bool SpeedSearch::happens(const SpeedResult& result) const noexcept {
  switch (part_) {
    case Part::separation:
      return result.cycle.separations > 0;
    case Part::bounce:
      return result.cycle.bounces > 0 && result.cycle.bounce_height_m >= limits_.bounce_m;
    default:
      return result.cycle.seating_speed_m_s > limits_.seating_m_s;
  }
}

Onset& SpeedSearch::onset() noexcept {
  return part_ == Part::separation ? sweep_.separation : part_ == Part::bounce ? sweep_.bounce : sweep_.seating;
}

/// Of an onset: takes its bracket from the sweep, and goes on where there is nothing to narrow down.
void SpeedSearch::begin_part(Part part) {
  for (part_ = part; part_ != Part::ended; part_ = static_cast<Part>(static_cast<int>(part_) + 1)) {
    const auto first =
        std::find_if(sweep_.at.begin(), sweep_.at.end(), [this](const SpeedResult& result) { return happens(result); });
    if (first == sweep_.at.end()) continue;
    onset() = {true, first == sweep_.at.begin(), first->speed_rpm};
    without_rpm_ = onset().at_the_start ? first->speed_rpm : (first - 1)->speed_rpm;
    if (onset().speed_rpm - without_rpm_ > 1) return;
  }
}

SpeedResult SpeedSearch::step() {
  if (part_ == Part::sweep) {
    const SpeedResult result = run(next_rpm_);
    sweep_.at.push_back(result);
    const bool is_last = next_rpm_ >= range_.to_rpm;
    next_rpm_ = std::min(next_rpm_ + range_.step_rpm, range_.to_rpm);
    if (is_last) begin_part(Part::separation);
    return result;
  }
  const int middle_rpm = without_rpm_ + (onset().speed_rpm - without_rpm_) / 2;
  const SpeedResult result = run(middle_rpm);
  (happens(result) ? onset().speed_rpm : without_rpm_) = middle_rpm;
  if (onset().speed_rpm - without_rpm_ <= 1) begin_part(static_cast<Part>(static_cast<int>(part_) + 1));
  return result;
}

Sweep sweep_speeds(const LoneValve& valve, const SpeedRange& range, double factor,
                   const std::function<void()>& after_speed, const RedlineLimits& limits) {
  SpeedSearch search(valve, range, factor, limits);
  while (search.part() != SpeedSearch::Part::ended) {
    (void)search.step();
    if (after_speed) after_speed();
  }
  return search.sweep();
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

#include "surge_force.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <crankloop/assert.hpp>
#include <crankloop/tabulate/valve_springs.hpp>

#include "../files/units.hpp"

namespace crankloop::program {
namespace {

constexpr double kRadPerStep = 0.05;  // of the fastest mode: errors of 5e-4
constexpr double kTurn_rad = 2 * kPi;
constexpr double kSlow = 1000;  // oscillations in a turn of the cam
constexpr double kLeastDampingRatio = 1e-4;

/// Mean acceleration of the spring's end in each of a cycle's equal steps.
std::vector<double> accelerations_of(const LiftSlopes& slopes, double cam_rad_s, std::size_t steps, double step_s) {
  const auto speed_m_s = [&](std::size_t i) {
    return slopes.at(static_cast<double>(i) / static_cast<double>(steps)) * cam_rad_s;
  };
  std::vector<double> mean_m_s2(steps);
  double before_m_s = speed_m_s(0);
  for (std::size_t i = 0; i < steps; ++i) {
    const double after_m_s = speed_m_s(i + 1);
    mean_m_s2[i] = (after_m_s - before_m_s) / step_s;
    before_m_s = after_m_s;
  }
  return mean_m_s2;
}

struct ModeState {
  double q_m, v_m_s;
};

[[nodiscard]] ModeState stepped(const SpringMode& mode, const ModeState& s, double mean_m_s2) {
  const auto more = [&](const detail::ModeRow<double>& row) {
    return row.q * s.q_m + row.v * s.v_m_s + row.drive * mean_m_s2;
  };
  return {s.q_m + more(mode.step.of_q), s.v_m_s + more(mode.step.of_v)};
}

/// Where a mode starts a cycle that ends where it starts: a cycle takes a state s to A s + b, so s = (1 - A)^-1 b.
[[nodiscard]] ModeState steady_start(const SpringMode& mode, const std::vector<double>& mean_m_s2) {
  ModeState driven{0, 0}, of_q{1, 0}, of_v{0, 1};
  for (const double m_s2 : mean_m_s2)
    driven = stepped(mode, driven, m_s2), of_q = stepped(mode, of_q, 0), of_v = stepped(mode, of_v, 0);
  const double a = 1 - of_q.q_m, b = -of_v.q_m, c = -of_q.v_m_s, d = 1 - of_v.v_m_s;
  const double determinant = a * d - b * c;
  return {(d * driven.q_m - b * driven.v_m_s) / determinant, (a * driven.v_m_s - c * driven.q_m) / determinant};
}

/// Adds a mode's force in each step of a cycle that ends where it starts.
void add_steady_force(const SpringMode& mode, const std::vector<double>& mean_m_s2, std::vector<double>& force_N) {
  ModeState state = steady_start(mode, mean_m_s2);
  for (std::size_t at = 0; at < force_N.size(); ++at) {
    state = stepped(mode, state, mean_m_s2[at]);
    force_N[at] += mode.step.valve_N_m * state.q_m;
  }
}

}  // namespace

LiftSlopes::LiftSlopes(const ValveLift& lift) {
  points_.reserve(kPerTurn + 1);
  for (int i = 0; i <= kPerTurn; ++i) {
    const LiftPose pose = lift.at(kTurn_rad * (static_cast<double>(i) / kPerTurn - 0.5));
    points_.push_back({pose.lift_m, pose.per_rad_m});
  }
}

double LiftSlopes::at(double turn) const noexcept {
  const double place = turn * kPerTurn;
  const auto below = static_cast<std::size_t>(std::min(place, kPerTurn - 1.0));
  const double part = place - static_cast<double>(below);
  const Point &from = points_[below], &to = points_[below + 1];
  if (!(from.lift_m + part * (to.lift_m - from.lift_m) > 0)) return 0;
  return from.per_rad_m + part * (to.per_rad_m - from.per_rad_m);
}

SpringSurgeCycle surge_over_cycle(const LiftSlopes& slopes, const Valve& valve, double cam_rad_s) {
  if (!(valve.spring_kg > 0 && valve.spring_N_m > 0)) return {};
  SurgingSpring springs[2];
  const int count = springs_of(valve, springs);
  double slowest_rad_s = std::numeric_limits<double>::infinity(), fastest_rad_s = 0;
  for (int i = 0; i < count; ++i) {
    springs[i].modes = kMaxSpringModes;
    springs[i].damping_ratio = std::max(springs[i].damping_ratio, kLeastDampingRatio);
    slowest_rad_s = std::min(slowest_rad_s, surge_frequency_rad_s(springs[i]));
    fastest_rad_s = std::max(fastest_rad_s, surge_frequency_rad_s(springs[i]));
  }
  SpringSurgeCycle cycle{slowest_rad_s / kTurn_rad, 0};
  if (!(std::abs(cam_rad_s) * kSlow > fastest_rad_s)) return cycle;
  const double period_s = kTurn_rad / std::abs(cam_rad_s);
  const auto steps =
      static_cast<std::size_t>(std::ceil(period_s * kMaxSpringModes * fastest_rad_s / kRadPerStep)) + 720;
  const double step_s = period_s / static_cast<double>(steps);
  const std::vector<double> mean_m_s2 = accelerations_of(slopes, cam_rad_s, steps, step_s);
  std::vector<double> force_N(steps);
  for (int i = 0; i < count; ++i) {
    SpringSurge surge;
    [[maybe_unused]] const Status accepted = surge_of(springs[i], step_s, surge);
    CRANKLOOP_ASSERT(accepted.ok());
    for (int n = 0; n < surge.modes; ++n) add_steady_force(surge.mode[n], mean_m_s2, force_N);
  }
  for (const double force : force_N) cycle.largest_N = std::max(cycle.largest_N, std::abs(force));
  return cycle;
}

}  // namespace crankloop::program

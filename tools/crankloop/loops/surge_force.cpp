#include "surge_force.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <crankloop/tabulate/spring_surge.hpp>

#include "../files/units.hpp"

namespace crankloop::program {
namespace {

constexpr double kRadPerStep = 0.05;  // of the fastest mode: errors of 1e-4
constexpr double kLeft = 1e-4;        // of what was there at the start
constexpr double kTurn_rad = 2 * kPi;
constexpr double kSlow = 1000;  // oscillations in a turn of the cam

/// Mean acceleration of the spring's end in each of a cycle's equal steps.
std::vector<double> accelerations_of(const ValveLift& lift, double cam_rad_s, std::size_t steps, double step_s) {
  const auto speed_m_s = [&](std::size_t i) {
    const LiftPose pose = lift.at(kTurn_rad * (static_cast<double>(i) / static_cast<double>(steps) - 0.5));
    return pose.lift_m > 0 ? pose.per_rad_m * cam_rad_s : 0;
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

/// The largest force of a mode is not that of all: they are summed at each step.
class Modes {
 public:
  explicit Modes(const SpringSurge& surge) : surge_{surge} {}

  double step_N(double mean_m_s2) {
    double force_N = 0;
    for (int i = 0; i < surge_.modes; ++i) {
      const SpringMode& mode = surge_.mode[i];
      const auto more = [&](const SpringMode::Row& row) {
        return row.q * q_m_[i] + row.v * v_m_s_[i] + row.drive * mean_m_s2;
      };
      const double more_m = more(mode.of_q), more_m_s = more(mode.of_v);
      q_m_[i] += more_m, v_m_s_[i] += more_m_s;
      force_N += mode.valve_N_m * q_m_[i];
    }
    return force_N;
  }

 private:
  SpringSurge surge_;
  double q_m_[kMaxSpringModes] = {}, v_m_s_[kMaxSpringModes] = {};
};

}  // namespace

SpringSurgeCycle surge_over_cycle(const ValveLift& lift, const Valve& valve, double cam_rad_s) {
  if (!(valve.spring_kg > 0 && valve.spring_N_m > 0)) return {};
  const SurgingSpring spring{valve.spring_N_m, valve.spring_kg, kSurgeDampingRatio, kMaxSpringModes};
  const double first_rad_s = surge_frequency_rad_s(spring);
  SpringSurgeCycle cycle{first_rad_s / kTurn_rad, 0};
  if (!(std::abs(cam_rad_s) * kSlow > first_rad_s)) return cycle;
  const double period_s = kTurn_rad / std::abs(cam_rad_s);
  const auto steps = static_cast<std::size_t>(std::ceil(period_s * kMaxSpringModes * first_rad_s / kRadPerStep)) + 720;
  const double step_s = period_s / static_cast<double>(steps);
  SpringSurge surge;
  if (!surge_of(spring, step_s, surge).ok()) return cycle;
  const std::vector<double> mean_m_s2 = accelerations_of(lift, cam_rad_s, steps, step_s);
  const double cycles_to_settle = std::ceil(-std::log(kLeft) / (kSurgeDampingRatio * first_rad_s * period_s));
  Modes modes(surge);
  for (double i = 0; i < cycles_to_settle; ++i)
    for (const double m_s2 : mean_m_s2) (void)modes.step_N(m_s2);
  for (const double m_s2 : mean_m_s2) cycle.largest_N = std::max(cycle.largest_N, std::abs(modes.step_N(m_s2)));
  return cycle;
}

}  // namespace crankloop::program

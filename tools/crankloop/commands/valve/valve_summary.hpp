// What `valve` prints of one cycle.
//
// What belongs here: the figures, and what the ticks of the cycle add up to for them. What does not: the loop
// (loops/valve_loop.hpp), lines of the cam's loads and of the flow area (loops/cam_loads.hpp, loops/flow_lines.hpp),
// the drawing (valve_plot.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "../../command_line/summary.hpp"
#include "../../loops/cam_loads.hpp"
#include "../../loops/flow_area.hpp"
#include "../../loops/valve_loop.hpp"

namespace crankloop::program {

struct ValveRequest {
  double speed_rpm;
  double tick_s;
  int cycles;
  std::string integrator;
  ValveMethod method;
  std::string real;
};

/// The flow area where the file has the valve's dimensions.
struct ValveFlow {
  std::optional<FlowArea> area{};
  FlowIntegrals theory{};
  FlowIntegrals elastic{};
};

/// Forces of the springs over the cycle shown.
struct SpringRange {
  double largest_surge_N = 0;
  double least_N = std::numeric_limits<double>::infinity();
  double largest_N = 0;
  double least_fixed_N = std::numeric_limits<double>::infinity();  ///< at the spring's fixed end
  double largest_fixed_N = 0;

  template <class Real>
  void take(const ValveSpringOutput<Real>& s) {
    const auto moving_N = static_cast<double>(s.moving_N), fixed_N = static_cast<double>(s.fixed_N);
    largest_surge_N = std::max(largest_surge_N, std::abs(static_cast<double>(s.surge_N)));
    least_N = std::min(least_N, moving_N), largest_N = std::max(largest_N, moving_N);
    least_fixed_N = std::min(least_fixed_N, fixed_N), largest_fixed_N = std::max(largest_fixed_N, fixed_N);
  }
};

/// Largest and smallest speed and acceleration of a valve's lift, m/s and m/s^2.
struct MotionRange {
  double opening_m_s = 0;
  double closing_m_s = 0;
  double rise_m_s2 = 0;
  double fall_m_s2 = 0;

  void take(double velocity_m_s, double acceleration_m_s2) {
    opening_m_s = std::max(opening_m_s, velocity_m_s);
    closing_m_s = std::min(closing_m_s, velocity_m_s);
    rise_m_s2 = std::max(rise_m_s2, acceleration_m_s2);
    fall_m_s2 = std::min(fall_m_s2, acceleration_m_s2);
  }
};

/// What the ticks of the cycle shown come to.
struct TicksOfCycle {
  MotionRange motion{};
  SpringRange springs{};
  CamLoadsOfCycle loads;
};

/// "intake at 7000 rpm of the engine".
[[nodiscard]] std::string title_of(const LoneValve& valve, const ValveRequest& request);

/// "tick 20 us, rk4, double, cycle 4".
[[nodiscard]] std::string circumstances(const ValveRequest& request);

/// Forces on the valve beside spring and train.
[[nodiscard]] std::string forces_remark(const LoneValve& valve);

/// change_m: of lift, the largest between this cycle and the next.
template <class Real>
[[nodiscard]] Summary summary_of(const LoneValve& valve, const ValveRequest& request, const ValveLoop<Real>& loop,
                                 const ValveCycle<Real>& cycle, double change_m, const ValveFlow& flow,
                                 const TicksOfCycle& ticks);

}  // namespace crankloop::program

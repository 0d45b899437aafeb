// The sheet of `crankloop valve --plot`: one cycle of one valve, drawn so that float and bounce can be told apart.
//
// What belongs here: which curves, and which part of them is which contact. What does not: the loop (valve_loop.hpp),
// drawing (report/).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../../loops/cam_loads.hpp"
#include "../../loops/flow_area.hpp"
#include "../../loops/valve_cycle.hpp"
#include "../../loops/valve_loop.hpp"
#include "../../report/sheet.hpp"

namespace crankloop::program {

/// One cycle in the order of time, as run_cycles() shows it.
struct ValveCycleTrace {
  std::vector<ValveTickOutput<double>> ticks{};
  std::vector<CamLoads> loads{};  ///< of each tick; none: the file has no width of the contact
  ValveCycle<double> cycle{};
  StaticRedline redline{};
  double speed_rad_s = 0;  ///< of the crank
  double seat_contact_m =
      0;  ///< lift at which the valve meets its seat: closed, its spring presses the seat below that
  std::optional<FlowArea> area{};  ///< none: the file has no diameter of the valve
  double limit_Pa = 0;             ///< of the contact's stress; 0: none
};

/// Lift, gap and forces over the cam angle, the flow area and what the cam bears where their dimensions are known, and
/// a closer look at the seating where the valve does seat.
[[nodiscard]] report::Sheet valve_sheet(const ValveCycleTrace& trace, const std::string& title,
                                        const std::string& remark);

template <class Real>
[[nodiscard]] ValveTickOutput<double> in_double(const ValveTickOutput<Real>& out) noexcept {
  const auto wide = [](Real x) { return static_cast<double>(x); };
  const ValveMotionOutput<Real, OneValve>& m = out.motion;
  const ValveForcesOutput<Real>& f = out.forces;
  return {out.cam_deg,
          {{wide(m.theoretical_lift_m)}, {wide(m.lift_m), wide(m.velocity_m_s)}, {wide(m.acceleration_m_s2)}},
          {wide(f.train_N), wide(f.seat_N), wide(f.tip_N), wide(f.cam_N), wide(f.train_compression_m), f.regime},
          {wide(out.springs.surge_N), wide(out.springs.moving_N), wide(out.springs.fixed_N)}};
}

}  // namespace crankloop::program

// The results of one lobe of a valve, whatever the arithmetic of the tick that found them.
#pragma once

#include <crankloop/tick/valve/valve_results.hpp>

namespace crankloop::program {

/// A cycle's results in double.
template <class Real>
[[nodiscard]] ValveCycle<double> in_double(const ValveCycle<Real>& c) noexcept {
  const auto wide = [](Real x) { return static_cast<double>(x); };
  return {wide(c.largest_lift_m),
          wide(c.largest_speed_m_s),
          wide(c.largest_acceleration_m_s2),
          wide(c.opening_delay_deg),
          wide(c.separation_clearance_m),
          wide(c.separation_start_deg),
          wide(c.separation_duration_deg),
          wide(c.seating_speed_m_s),
          wide(c.bounce_height_m),
          c.separations,
          c.bounces,
          c.contact_changes,
          c.off_seat_at_end};
}

}  // namespace crankloop::program

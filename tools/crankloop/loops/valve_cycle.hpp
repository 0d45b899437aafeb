// The results of one lobe of a valve, independent of the tick's arithmetic.
#pragma once

#include <string>

#include <crankloop/tick/valve/valve_results.hpp>

#include "../command_line/summary.hpp"

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

/// Whether the valve opened after its cam did. A valve that was off its seat already has no delay; ValveCycle's is 0
/// then.
template <class Real>
[[nodiscard]] bool has_opening_delay(const ValveCycle<Real>& c) noexcept {
  return c.opening_delay_deg > 0;
}

template <class Real>
void add_opening_delay(Summary& s, const std::string& name, const ValveCycle<Real>& c) {
  if (has_opening_delay(c)) return s.line(name, c.opening_delay_deg, "deg", "of cam angle, at 0.1 mm of lift");
  s.none(name, "deg",
         c.largest_lift_m < Real(0.1e-3) ? "it does not rise by 0.1 mm" : "off its seat before its cam lifted it");
}

}  // namespace crankloop::program

#include "run_valves.hpp"

#include <algorithm>

namespace crankloop::program {

ValveCycle<double> worse_of(const ValveCycle<double>& a, const ValveCycle<double>& b) noexcept {
  ValveCycle<double> worse = a.separation_clearance_m >= b.separation_clearance_m ? a : b;
  worse.largest_lift_m = std::max(a.largest_lift_m, b.largest_lift_m);
  worse.largest_speed_m_s = std::max(a.largest_speed_m_s, b.largest_speed_m_s);
  worse.largest_acceleration_m_s2 = std::max(a.largest_acceleration_m_s2, b.largest_acceleration_m_s2);
  worse.opening_delay_deg = std::max(a.opening_delay_deg, b.opening_delay_deg);
  worse.seating_speed_m_s = std::max(a.seating_speed_m_s, b.seating_speed_m_s);
  worse.bounce_height_m = std::max(a.bounce_height_m, b.bounce_height_m);
  worse.separations = std::max(a.separations, b.separations);
  worse.bounces = std::max(a.bounces, b.bounces);
  worse.contact_changes = std::max(a.contact_changes, b.contact_changes);
  worse.off_seat_at_end = std::max(a.off_seat_at_end, b.off_seat_at_end);
  return worse;
}

std::vector<std::string> names_of_trains(const EngineFile& file) {
  std::vector<std::string> names;
  for (const TrainOfFile& train : file.trains()) {
    if (train.complete()) names.push_back(train.name);
  }
  return names;
}

}  // namespace crankloop::program

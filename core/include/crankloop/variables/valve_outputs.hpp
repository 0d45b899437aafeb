// Rows of the list of variables: outputs of valves and cams.
//
// What belongs here: rows of valve motion, forces, springs, results of a cycle, cam contact and torque. What does not:
// all others, and what a list is for (variables.hpp).
#pragma once

#include <cstdint>

#include <crankloop/output.hpp>
#include <crankloop/variable.hpp>

namespace crankloop::detail {

/// In the order of Output.
template <class S, class Visit, class AnOutput>
constexpr void each_valve_output([[maybe_unused]] Visit& visit, [[maybe_unused]] AnOutput& out,
                                 [[maybe_unused]] const EngineShape& shape) {
  const auto each_valve = [&](const auto& show) {
    for (std::uint32_t t = 0; t < shape.trains; ++t) {
      for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
        show([&visit, t, k](const Variable& variable, auto& value) { visit(variable.at(t, k), value); }, t, k);
      }
    }
  };
  if constexpr (detail::Needs<S>::any_valves) {
    each_valve([&out](const auto& show, std::uint32_t t, std::uint32_t k) {
      auto& v = out.valve[t][k];
      if constexpr (S::theoretical_lift)
        show(real("valve[#,#].theoretical_lift_m", "Lift of the cam at the valve, not below 0"), v.theoretical_lift_m);
      show(real("valve[#,#].lift_m", "Lift from the closed, preloaded valve"), v.lift_m);
      show(real("valve[#,#].velocity_m_s", "Velocity of the valve"), v.velocity_m_s);
      if constexpr (S::valve_acceleration)
        show(real("valve[#,#].acceleration_m_s2", "Acceleration of the valve"), v.acceleration_m_s2);
    });
  }
  if constexpr (S::valve_forces) {
    each_valve([&out](const auto& show, std::uint32_t t, std::uint32_t k) {
      auto& v = out.valve_forces[t][k];
      show(real("valve_forces[#,#].train_N", "Between train and valve, pushing"), v.train_N);
      show(real("valve_forces[#,#].seat_N", "Between valve and seat"), v.seat_N);
      show(real("valve_forces[#,#].tip_N", "At the stem's tip"), v.tip_N);
      show(real("valve_forces[#,#].cam_N", "Between cam and pad"), v.cam_N);
      show(real("valve_forces[#,#].train_compression_m", "Train lift less valve lift; negative: clearance"),
           v.train_compression_m);
      show(whole("valve_forces[#,#].regime", "0 free, 1 on its train, 2 on its seat, 3 on both"), v.regime);
    });
  }
  if constexpr (detail::Needs<S>::spring_forces) {
    each_valve([&out](const auto& show, std::uint32_t t, std::uint32_t k) {
      auto& v = out.valve_spring[t][k];
      show(real("valve_spring[#,#].surge_N", "Of the springs' surge on the valve, toward its seat"), v.surge_N);
      show(real("valve_spring[#,#].moving_N", "Of the springs on the valve, with surge"), v.moving_N);
      show(real("valve_spring[#,#].fixed_N", "Of the springs on the head, with surge"), v.fixed_N);
    });
  }
  if constexpr (S::valve_results) {
    each_valve([&out](const auto& show, std::uint32_t t, std::uint32_t k) {
      auto& c = out.valve_cycle[t][k];
      show(real("valve_cycle[#,#].largest_lift_m", "Of the last whole cycle"), c.largest_lift_m);
      show(real("valve_cycle[#,#].largest_speed_m_s", "Magnitude"), c.largest_speed_m_s);
      show(real("valve_cycle[#,#].largest_acceleration_m_s2", "Magnitude"), c.largest_acceleration_m_s2);
      show(real("valve_cycle[#,#].opening_delay_deg", "Valve against theory at 0.1 mm of lift, cam degrees"),
           c.opening_delay_deg);
      show(real("valve_cycle[#,#].separation_clearance_m", "Largest clearance of a separation before seating"),
           c.separation_clearance_m);
      show(real("valve_cycle[#,#].separation_start_deg", "Of that separation, cam degrees since the lobe's start"),
           c.separation_start_deg);
      show(real("valve_cycle[#,#].separation_duration_deg", "Of that separation"), c.separation_duration_deg);
      show(real("valve_cycle[#,#].seating_speed_m_s", "At the first contact with the seat"), c.seating_speed_m_s);
      show(real("valve_cycle[#,#].bounce_height_m", "Largest lift above the seat's contact after a lift-off"),
           c.bounce_height_m);
      show(whole("valve_cycle[#,#].separations", "Separations of at least 1 um"), c.separations);
      show(whole("valve_cycle[#,#].bounces", "Lift-offs of at least 1 um"), c.bounces);
      show(whole("valve_cycle[#,#].contact_changes", "Changes of contact"), c.contact_changes);
      show(truth("valve_cycle[#,#].off_seat_at_end", "Still off its seat in the middle of the base circle"),
           c.off_seat_at_end);
    });
  }
  if constexpr (S::cam_contact) {
    each_valve([&out](const auto& show, std::uint32_t t, std::uint32_t k) {
      auto& c = out.cam_contact[t][k];
      show(real("cam_contact[#,#].stress_Pa", "Largest pressure between cam and follower, by Hertz; 0: no contact"),
           c.stress_Pa);
      show(real("cam_contact[#,#].half_width_m", "Of the strip of contact"), c.half_width_m);
      show(real("cam_contact[#,#].sliding_m_s", "Surface of the cam less that of the follower"), c.sliding_m_s);
      show(real("cam_contact[#,#].entrainment_m_s", "Mean of both surfaces, relative to the contact"),
           c.entrainment_m_s);
    });
    each_valve([&out](const auto& show, std::uint32_t t, std::uint32_t k) {
      auto& c = out.cam_contact_cycle[t][k];
      show(real("cam_contact_cycle[#,#].largest_Pa", "Largest stress of the last whole cycle"), c.largest_Pa);
      show(real("cam_contact_cycle[#,#].largest_deg", "Where it was, cam degrees since the lobe's start"),
           c.largest_deg);
    });
  }
  if constexpr (S::cam_torque) {
    each_valve([&out](const auto& show, std::uint32_t t, std::uint32_t k) {
      auto& c = out.cam_torque[t][k];
      show(real("cam_torque[#,#].torque_Nm", "Torque that a cam takes, positive against forward rotation"),
           c.torque_Nm);
      show(real("cam_torque[#,#].friction_Nm", "Its part of friction between cam and follower"), c.friction_Nm);
    });
    visit(real("camshaft_Nm", "Torque that all cams take, positive against forward rotation"), out.camshaft_Nm);
  }
}

}  // namespace crankloop::detail

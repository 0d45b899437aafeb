// Every field of an output by its name, so that tests can print, hash or check them all.
//
// What belongs here: the walk over the groups that a scene has. What does not: what is done with a field.
#pragma once

#include <cstddef>
#include <cstdint>

#include <crankloop/output.hpp>

namespace crankloop::support {

/// How much of an output's arrays is in use.
struct Used {
  std::size_t cylinders;
  std::size_t pins;
  std::size_t trains;
};

/// Calls f(name, index, value) for every number in use, value a Real or a uint32_t; cylinder, pin or journal counted
/// from 0 is the index, of valves 16 * train + cylinder.
template <class Real, class S, class F>
void each_output(const Output<Real, S>& out, const Used& used, const F& f) {
  const auto row = [&f](const char* name, const Real* first, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) f(name, i, first[i]);
  };
  if constexpr (detail::Needs<S>::crank_dynamics) {
    f("speed_rad_s", std::size_t{0}, out.speed_rad_s);
    f("crank_acceleration_rad_s2", std::size_t{0}, out.acceleration_rad_s2);
    f("friction_Nm", std::size_t{0}, out.friction_Nm);
  }
  if constexpr (S::starter) f("starter_Nm", std::size_t{0}, out.starter_Nm);
  if constexpr (S::torque) f("torque_Nm", std::size_t{0}, out.torque_Nm);
  if constexpr (S::mean_torque) f("mean_torque_Nm", std::size_t{0}, out.mean_torque_Nm);
  if constexpr (S::kinematics) {
    row("displacement_m", out.displacement_m, used.cylinders);
    row("velocity_m_s", out.velocity_m_s, used.cylinders);
    row("acceleration_m_s2", out.acceleration_m_s2, used.cylinders);
  }
  if constexpr (S::rod_motion) {
    row("rod_angle_rad", out.rod_angle_rad, used.cylinders);
    row("rod_speed_rad_s", out.rod_speed_rad_s, used.cylinders);
    row("rod_acceleration_rad_s2", out.rod_acceleration_rad_s2, used.cylinders);
  }
  if constexpr (S::forces) {
    for (std::size_t k = 0; k < used.cylinders; ++k) {
      const CylinderForces<Real>& c = out.cylinder[k];
      f("pressure_Pa", k, c.pressure_Pa);
      f("gas_force_N", k, c.gas_force_N);
      f("inertia_force_N", k, c.inertia_force_N);
      f("total_force_N", k, c.total_force_N);
      f("side_force_N", k, c.side_force_N);
      f("rod_force_N", k, c.rod_force_N);
      f("radial_force_N", k, c.radial_force_N);
      f("tangential_force_N", k, c.tangential_force_N);
      f("cylinder_torque_Nm", k, c.torque_Nm);
      f("tilting_moment_Nm", k, c.tilting_moment_Nm);
    }
  }
  if constexpr (S::bearing_loads) {
    row("pin_radial_N", out.pin_radial_N, used.pins);
    row("pin_tangential_N", out.pin_tangential_N, used.pins);
    row("pin_load_N", out.pin_load_N, used.pins);
    row("journal_along_N", out.journal_along_N, used.pins + 1);
    row("journal_across_N", out.journal_across_N, used.pins + 1);
    row("journal_load_N", out.journal_load_N, used.pins + 1);
  }
  if constexpr (S::free_forces) {
    std::size_t i = 0;
    for (const FreeForce<Real>* force : {&out.first, &out.second, &out.rotating}) {
      f("free_up_N", i, force->up_N);
      f("free_lateral_N", i, force->lateral_N);
      f("free_pitch_Nm", i, force->pitch_Nm);
      f("free_yaw_Nm", i, force->yaw_Nm);
      ++i;
    }
  }
  if constexpr (detail::Needs<S>::any_valves) {
    for (std::size_t t = 0; t < used.trains; ++t) {
      for (std::size_t k = 0; k < used.cylinders; ++k) {
        const std::size_t i = 16 * t + k;
        const ValveMotionOutput<Real, S>& v = out.valve[t][k];
        if constexpr (S::theoretical_lift) f("theoretical_lift_m", i, v.theoretical_lift_m);
        f("lift_m", i, v.lift_m);
        f("valve_velocity_m_s", i, v.velocity_m_s);
        if constexpr (S::valve_acceleration) f("valve_acceleration_m_s2", i, v.acceleration_m_s2);
        if constexpr (S::valve_forces) {
          const ValveForcesOutput<Real>& force = out.valve_forces[t][k];
          f("train_N", i, force.train_N);
          f("seat_N", i, force.seat_N);
          f("tip_N", i, force.tip_N);
          f("cam_N", i, force.cam_N);
          f("train_compression_m", i, force.train_compression_m);
          f("regime", i, force.regime);
        }
        if constexpr (detail::Needs<S>::spring_forces) {
          const ValveSpringOutput<Real>& spring = out.valve_spring[t][k];
          f("surge_N", i, spring.surge_N);
          f("moving_N", i, spring.moving_N);
          f("fixed_N", i, spring.fixed_N);
        }
        if constexpr (S::valve_results) {
          const ValveCycle<Real>& c = out.valve_cycle[t][k];
          f("cycle_largest_lift_m", i, c.largest_lift_m);
          f("cycle_largest_speed_m_s", i, c.largest_speed_m_s);
          f("cycle_largest_acceleration_m_s2", i, c.largest_acceleration_m_s2);
          f("cycle_opening_delay_deg", i, c.opening_delay_deg);
          f("cycle_separation_gap_m", i, c.separation_clearance_m);
          f("cycle_separation_start_deg", i, c.separation_start_deg);
          f("cycle_separation_duration_deg", i, c.separation_duration_deg);
          f("cycle_seating_speed_m_s", i, c.seating_speed_m_s);
          f("cycle_bounce_height_m", i, c.bounce_height_m);
          f("cycle_separations", i, c.separations);
          f("cycle_bounces", i, c.bounces);
          f("cycle_contact_changes", i, c.contact_changes);
          f("cycle_off_seat_at_end", i, c.off_seat_at_end);
        }
        if constexpr (S::cam_contact) {
          const CamContactOutput<Real>& c = out.cam_contact[t][k];
          f("stress_Pa", i, c.stress_Pa);
          f("half_width_m", i, c.half_width_m);
          f("sliding_m_s", i, c.sliding_m_s);
          f("entrainment_m_s", i, c.entrainment_m_s);
          f("cycle_largest_Pa", i, out.cam_contact_cycle[t][k].largest_Pa);
          f("cycle_largest_deg", i, out.cam_contact_cycle[t][k].largest_deg);
        }
        if constexpr (S::cam_torque) {
          f("cam_torque_Nm", i, out.cam_torque[t][k].torque_Nm);
          f("cam_friction_Nm", i, out.cam_torque[t][k].friction_Nm);
        }
      }
    }
  }
  if constexpr (S::cam_torque) f("camshaft_Nm", std::size_t{0}, out.camshaft_Nm);
  if constexpr (detail::Needs<S>::gas) {
    for (std::size_t k = 0; k < used.cylinders; ++k) {
      const CylinderGasOutput<Real>& gas = out.cylinder_gas[k];
      f("gas_pressure_Pa", k, gas.pressure_Pa);
      f("gas_temperature_K", k, gas.temperature_K);
      f("gas_mass_kg", k, gas.mass_kg);
      f("gas_burned_ratio", k, gas.burned_ratio);
      f("intake_kg_s", k, gas.flow_kg_s[kIntake]);
      f("exhaust_kg_s", k, gas.flow_kg_s[kExhaust]);
      f("wall_heat_W", k, gas.wall_heat_W);
    }
  }
  if constexpr (S::crevice) {
    for (std::size_t k = 0; k < used.cylinders; ++k) {
      f("crevice_kg", k, out.crevice[k].mass_kg);
      f("blow_by_kg_s", k, out.crevice[k].blow_by_kg_s);
    }
  }
  if constexpr (S::runners) {
    for (std::size_t k = 0; k < used.cylinders; ++k) {
      for (std::size_t port = 0; port < kPorts; ++port) {
        f("port_Pa", 2 * k + port, out.runner[k].port_pressure_Pa[port]);
        f("runner_kg_s", 2 * k + port, out.runner[k].flow_kg_s[port]);
      }
    }
  }
  if constexpr (S::walls) {
    row("wall_K", out.wall_K, used.cylinders);
    row("port_heat_W", out.port_heat_W, std::size_t{kPorts});
  }
  if constexpr (detail::Needs<S>::manifolds) {
    for (std::size_t port = 0; port < kPorts; ++port) {
      f("manifold_Pa", port, out.manifold[port].pressure_Pa);
      f("manifold_K", port, out.manifold[port].temperature_K);
      f("manifold_burned_ratio", port, out.manifold[port].burned_ratio);
    }
    f("throttle_kg_s", std::size_t{0}, out.throttle_kg_s);
    f("outlet_kg_s", std::size_t{0}, out.outlet_kg_s);
  }
  if constexpr (S::gas_results) {
    for (std::size_t k = 0; k < used.cylinders; ++k) {
      const GasCycle<Real>& c = out.gas_cycle[k];
      f("net_mep_Pa", k, c.net_mep_Pa);
      f("pumping_mep_Pa", k, c.pumping_mep_Pa);
      f("peak_Pa", k, c.peak_Pa);
      f("peak_deg", k, c.peak_deg);
      f("trapped_kg", k, c.trapped_kg);
      f("trapped_air_kg", k, c.trapped_air_kg);
      f("residual_ratio", k, c.residual_ratio);
      f("volumetric_efficiency", k, c.volumetric_efficiency);
      f("exhaust_K", k, c.exhaust_K);
      f("fuel_kg", k, c.fuel_kg);
      f("excess_air_ratio", k, c.excess_air_ratio);
      f("heat_J", k, c.heat_J);
      f("gas_wall_heat_J", k, c.wall_heat_J);
      f("energy_defect_J", k, c.energy_defect_J);
    }
  }
  if constexpr (S::crevice && S::gas_results) row("cycle_blow_by_kg", out.cycle_blow_by_kg, used.cylinders);
  if constexpr (detail::Needs<S>::knock) {
    row("knock_integral", out.knock_integral, used.cylinders), row("knock_deg", out.knock_deg, used.cylinders);
  }
  if constexpr (detail::Needs<S>::charge_burn && S::gas_results) {
    for (std::size_t k = 0; k < used.cylinders; ++k) {
      f("cycle_burn_start_deg", k, out.cycle_burn[k].start_deg);
      f("cycle_burn_duration_deg", k, out.cycle_burn[k].duration_deg);
    }
  }
  if constexpr (detail::Needs<S>::lambda) {
    f("exhaust_excess_air_ratio", std::size_t{0}, out.exhaust_excess_air_ratio);
    f("sensor_excess_air_ratio", std::size_t{0}, out.sensor_excess_air_ratio);
    if constexpr (S::gas_results) row("outflow_excess_air_ratio", out.outflow_excess_air_ratio, used.cylinders);
  }
  if constexpr (S::sensor_faults) {
    f("sensor_faults_on", std::size_t{0}, out.sensor_faults_on);
    row("faulty_sensor", out.faulty_sensor, std::size_t{kControllerSensors});
  }
  f("faults", std::size_t{0}, out.faults);
}

}  // namespace crankloop::support

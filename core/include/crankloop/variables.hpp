// The one list of a scene's variables: what goes into a step and what comes out, each with its name, unit and meaning.
//
//     each_input<S>(visit, input, shape)              calls visit(variable, input.speed_rad_s), and so on
//     each_output<S>(visit, state, output, shape)     what a step shows, and what the state alone knows
//     each_event<S>(visit, output, shape)             what happened within a tick: signals and edges of trigger wheels
//
// What is written, read or described variable by variable goes by these lists: an FMU's model description, its get and
// set, its documentation; the structs of the C interface and the columns of its step_many(). A new group of Input or
// Output takes its rows here, in the order of its members, and nothing else.
//
// What belongs here: names, meanings, ranges, and in which scenes a variable is. What does not: what a variable is
// (variable.hpp), how a format spells it (fmi/description.hpp, c/header_text.hpp), its value as a number
// (variable_values.hpp).
#pragma once

#include <cstddef>
#include <cstdint>

#include <crankloop/input.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/variable.hpp>

namespace crankloop::detail {

template <class S, class Visit, class AnInput>
constexpr void each_input(Visit&& visit, AnInput& in, [[maybe_unused]] const EngineShape& shape) {
  if constexpr (S::crank == CrankGiven::speed) {
    const double limit_rad_s = shape.speed_limit_rad_s;
    visit(real("speed_rad_s", "Crank speed; negative: backwards").within(-limit_rad_s, limit_rad_s), in.speed_rad_s);
  } else if constexpr (S::crank == CrankGiven::phase) {
    visit(real("crank_deg",
               "Measured crank angle at the end of a tick, of a cycle of 720 deg; 0: cylinder 1's firing "
               "top dead centre"),
          in.crank);
  } else {
    visit(real("external_torque_Nm",
               "Torque on the crankshaft beside the engine's own brake; positive against forward rotation")
              .within(-kMaxExternalTorque_Nm, kMaxExternalTorque_Nm),
          in.external_torque_Nm);
  }
  if constexpr (detail::Needs<S>::load) {
    visit(real("load_ratio", "Scales the heat of combustion: 0 motored, 1 the diagram as given").within(0, 2),
          in.load_ratio);
  }
  if constexpr (detail::Needs<S>::input_pressure) {
    constexpr Variable pressure = real("pressure_Pa[#]", "Absolute pressure of a cylinder at the end of a tick");
    for (std::uint32_t k = 0; k < shape.cylinders; ++k)
      visit(pressure.at(k).within(0, kMaxPressure_Pa), in.pressure_Pa[k]);
  }
  if constexpr (S::cam_phasing) {
    constexpr Variable phase =
        real("cam_phase_deg[#]", "Target of a train's cam phaser, crank degrees later than defined");
    for (std::uint32_t t = 0; t < shape.trains; ++t) visit(phase.at(t).within(-180, 180), in.cam_phase_deg[t]);
  }
  if constexpr (S::starter) visit(truth("starter", "The starter turns the crank forward"), in.starter);
  if constexpr (detail::Needs<S>::cut || detail::Needs<S>::gas_cut) {
    visit(whole("cut_cylinders", "Bit k-1: cylinder k does not fire"), in.cut_cylinders);
  }
  if constexpr (detail::Needs<S>::gas && !detail::Needs<S>::manifolds) {
    const auto pressure = [](const char* name, const char* meaning) {
      return real(name, meaning).within(kLeastManifold_Pa, kMaxManifold_Pa);
    };
    const auto temperature = [](const char* name, const char* meaning) {
      return real(name, meaning).within(kLeastManifold_K, kMaxManifold_K);
    };
    visit(pressure("intake_Pa", "Absolute pressure in the intake manifold"), in.intake_Pa);
    visit(temperature("intake_K", "Temperature in the intake manifold"), in.intake_K);
    visit(pressure("exhaust_Pa", "Absolute pressure in the exhaust manifold"), in.exhaust_Pa);
    visit(temperature("exhaust_K", "Temperature of burned gas that flows back"), in.exhaust_K);
  }
  if constexpr (detail::Needs<S>::manifolds) {
    visit(real("throttle_ratio", "0 closed, 1 wide open").within(0, 1), in.throttle_ratio);
  }
  if constexpr (S::boundaries) {
    visit(real("ambient_Pa", "Absolute pressure before the throttle; 0: as defined").within(0, kMaxManifold_Pa),
          in.ambient_Pa);
    visit(real("ambient_K", "Temperature before the throttle; 0: as defined").within(0, kMaxManifold_K), in.ambient_K);
    visit(real("back_Pa", "Absolute pressure behind the outlet; 0: as defined").within(0, kMaxManifold_Pa), in.back_Pa);
  }
  if constexpr (detail::Needs<S>::burn_input) {
    constexpr Variable fuel =
        real("fuel_kg[#]", "Fuel of a cylinder's cycle, taken 90 deg before its firing dead centre");
    constexpr Variable start = real("burn_start_deg[#]", "Where it begins to burn, after firing top dead centre");
    constexpr Variable duration = real("burn_duration_deg[#]", "How long its first law burns; all by 150 deg");
    constexpr Variable excess_air =
        real("excess_air_ratio[#]", "Lambda: above 0 the cylinder's air says how much fuel, instead of fuel_kg");
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) visit(fuel.at(k).within(0, kMaxFuel_kg), in.fuel_kg[k]);
    for (std::uint32_t k = 0; k < shape.cylinders; ++k)
      visit(excess_air.at(k).within(0, kMaxExcessAir_ratio), in.excess_air_ratio[k]);
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) visit(start.at(k).within(-90, 60), in.burn_start_deg[k]);
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) visit(duration.at(k).within(5, 150), in.burn_duration_deg[k]);
  }
  if constexpr (detail::Needs<S>::faulty_wheels) {
    visit(whole("wheel_faults", "Bit b: faults of the wheels that are on by input bit b"), in.wheel_faults);
  }
  if constexpr (S::sensor_faults) {
    visit(whole("sensor_faults", "Bit b: faults of the sensors that are on by input bit b"), in.sensor_faults);
  }
  if constexpr (S::controller_names) {
    constexpr Variable advance = real("spark_advance_deg[#]", "Spark before firing top dead centre");
    visit(truth("by_spark_advance", "Sparks are where spark_advance_deg has them, not burn_start_deg"),
          in.by_spark_advance);
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) visit(advance.at(k).within(-60, 90), in.spark_advance_deg[k]);
  }
}

/// In the order of Output; a group whose name stands before the member is an array of records.
template <class S, class Visit, class AState, class AnOutput>
constexpr void each_output(Visit&& visit, AState& state, AnOutput& out, [[maybe_unused]] const EngineShape& shape) {
  [[maybe_unused]] const auto each = [&visit](const Variable& variable, auto& values, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) visit(variable.at(i), values[i]);
  };
  if constexpr (S::crank != CrankGiven::phase) {
    visit(real("crank_deg", "Crank angle, 0 to 720; 0: cylinder 1's firing top dead centre"), state.phase);
  }
  if constexpr (detail::Needs<S>::crank_dynamics) {
    visit(real("speed_rad_s", "Crank speed; negative: backwards"), out.speed_rad_s);
    visit(real("acceleration_rad_s2", "Acceleration of the crank"), out.acceleration_rad_s2);
    visit(real("friction_Nm", "Friction and brake, positive against forward rotation"), out.friction_Nm);
  }
  if constexpr (S::starter) visit(real("starter_Nm", "Torque of the starter"), out.starter_Nm);
  if constexpr (S::kinematics) {
    const std::uint32_t n = shape.cylinders;
    each(real("displacement_m[#]", "Piston from top dead centre, toward the crankshaft"), out.displacement_m, n);
    each(real("velocity_m_s[#]", "Velocity of the piston"), out.velocity_m_s, n);
    each(real("acceleration_m_s2[#]", "Acceleration of the piston"), out.acceleration_m_s2, n);
  }
  if constexpr (S::rod_motion) {
    const std::uint32_t n = shape.cylinders;
    each(real("rod_angle_rad[#]", "Angle of the connecting rod to the cylinder axis"), out.rod_angle_rad, n);
    each(real("rod_speed_rad_s[#]", "Angular speed of the connecting rod"), out.rod_speed_rad_s, n);
    each(real("rod_acceleration_rad_s2[#]", "Angular acceleration of the connecting rod"), out.rod_acceleration_rad_s2,
         n);
  }
  if constexpr (S::torque) {
    visit(real("torque_Nm", "Torque of gas and masses on the crankshaft, all cylinders"), out.torque_Nm);
  }
  if constexpr (S::mean_torque) {
    visit(real("mean_torque_Nm", "Torque averaged over the angle turned in a tick"), out.mean_torque_Nm);
  }
  if constexpr (S::forces) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
      auto& c = out.cylinder[k];
      visit(real("cylinder[#].pressure_Pa", "Absolute pressure").at(k), c.pressure_Pa);
      visit(real("cylinder[#].gas_force_N", "Gas force, positive toward the crankshaft").at(k), c.gas_force_N);
      visit(real("cylinder[#].inertia_force_N", "Force of the reciprocating masses").at(k), c.inertia_force_N);
      visit(real("cylinder[#].total_force_N", "Gas and inertia force").at(k), c.total_force_N);
      visit(real("cylinder[#].side_force_N", "Force on the cylinder wall").at(k), c.side_force_N);
      visit(real("cylinder[#].rod_force_N", "Force along the connecting rod").at(k), c.rod_force_N);
      visit(real("cylinder[#].radial_force_N", "At the crank pin, toward the crank centre").at(k), c.radial_force_N);
      visit(real("cylinder[#].tangential_force_N", "At the crank pin, with the rotation").at(k), c.tangential_force_N);
      visit(real("cylinder[#].torque_Nm", "Tangential force times crank radius").at(k), c.torque_Nm);
      visit(real("cylinder[#].tilting_moment_Nm", "On the engine block about the crank axis").at(k),
            c.tilting_moment_Nm);
    }
  }
  if constexpr (S::bearing_loads) {
    const std::uint32_t pins = shape.cylinders;
    each(real("pin_radial_N[#]", "Crank pin, toward the crank centre"), out.pin_radial_N, pins);
    each(real("pin_tangential_N[#]", "Crank pin, with the rotation"), out.pin_tangential_N, pins);
    each(real("pin_load_N[#]", "Crank pin, magnitude"), out.pin_load_N, pins);
    each(real("journal_along_N[#]", "Main journal, along the throw of pin 1"), out.journal_along_N, pins + 1);
    each(real("journal_across_N[#]", "Main journal, a quarter turn further"), out.journal_across_N, pins + 1);
    each(real("journal_load_N[#]", "Main journal, magnitude"), out.journal_load_N, pins + 1);
  }
  if constexpr (S::free_forces) {
    const auto force = [&visit](const Variable& up, const Variable& lateral, const Variable& pitch, const Variable& yaw,
                                auto& values) {
      visit(up, values.up_N);
      visit(lateral, values.lateral_N);
      visit(pitch, values.pitch_Nm);
      visit(yaw, values.yaw_Nm);
    };
    force(real("first.up_N", "Free force of the first order, up"), real("first.lateral_N", "Free force, lateral"),
          real("first.pitch_Nm", "Free moment, pitch"), real("first.yaw_Nm", "Free moment, yaw"), out.first);
    force(real("second.up_N", "Free force of the second order, up"), real("second.lateral_N", "Free force, lateral"),
          real("second.pitch_Nm", "Free moment, pitch"), real("second.yaw_Nm", "Free moment, yaw"), out.second);
    force(real("rotating.up_N", "Free centrifugal force, up"), real("rotating.lateral_N", "Free force, lateral"),
          real("rotating.pitch_Nm", "Free moment, pitch"), real("rotating.yaw_Nm", "Free moment, yaw"), out.rotating);
  }
  if constexpr (detail::Needs<S>::gas) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
      auto& g = out.cylinder_gas[k];
      visit(real("cylinder_gas[#].pressure_Pa", "Absolute pressure").at(k), g.pressure_Pa);
      visit(real("cylinder_gas[#].temperature_K", "Temperature").at(k), g.temperature_K);
      visit(real("cylinder_gas[#].mass_kg", "Mass of gas").at(k), g.mass_kg);
      visit(real("cylinder_gas[#].burned_ratio", "Burned share of the mass").at(k), g.burned_ratio);
      visit(real("cylinder_gas[#].intake_kg_s", "In through the intake, mean of the tick").at(k), g.flow_kg_s[kIntake]);
      visit(real("cylinder_gas[#].exhaust_kg_s", "In through the exhaust, mean of the tick").at(k),
            g.flow_kg_s[kExhaust]);
      visit(real("cylinder_gas[#].wall_heat_W", "Heat to the walls, mean of the tick").at(k), g.wall_heat_W);
    }
  }
  if constexpr (S::crevice) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
      auto& c = out.crevice[k];
      visit(real("crevice[#].mass_kg", "Mass of gas in the cylinder's crevices").at(k), c.mass_kg);
      visit(real("crevice[#].blow_by_kg_s", "From them into the crankcase, mean of the tick").at(k), c.blow_by_kg_s);
    }
  }
  if constexpr (S::runners) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
      auto& r = out.runner[k];
      visit(real("runner[#].intake_port_Pa", "Absolute pressure at the intake port").at(k),
            r.port_pressure_Pa[kIntake]);
      visit(real("runner[#].exhaust_port_Pa", "Absolute pressure at the exhaust port").at(k),
            r.port_pressure_Pa[kExhaust]);
      visit(real("runner[#].intake_kg_s", "Through the intake runner, toward the cylinder").at(k),
            r.flow_kg_s[kIntake]);
      visit(real("runner[#].exhaust_kg_s", "Through the exhaust runner, toward the cylinder").at(k),
            r.flow_kg_s[kExhaust]);
    }
  }
  if constexpr (S::walls) {
    each(real("wall_K[#]", "Temperature of the cylinder's walls"), out.wall_K, shape.cylinders);
    visit(real("intake_wall_heat_W", "To the walls of intake manifold or runners, mean of the tick"),
          out.port_heat_W[kIntake]);
    visit(real("exhaust_wall_heat_W", "To the walls of exhaust manifold or runners, mean of the tick"),
          out.port_heat_W[kExhaust]);
  }
  if constexpr (detail::Needs<S>::manifolds) {
    const auto manifold = [&visit](const Variable& pressure, const Variable& temperature, const Variable& burned,
                                   auto& values) {
      visit(pressure, values.pressure_Pa);
      visit(temperature, values.temperature_K);
      visit(burned, values.burned_ratio);
    };
    manifold(real("intake.pressure_Pa", "Absolute pressure in the intake manifold"),
             real("intake.temperature_K", "Temperature"), real("intake.burned_ratio", "Burned share of its gas"),
             out.manifold[kIntake]);
    manifold(real("exhaust.pressure_Pa", "Absolute pressure in the exhaust manifold"),
             real("exhaust.temperature_K", "Temperature"), real("exhaust.burned_ratio", "Burned share of its gas"),
             out.manifold[kExhaust]);
    visit(real("throttle_kg_s", "Through the throttle, mean of the tick"), out.throttle_kg_s);
    visit(real("outlet_kg_s", "Out of the exhaust manifold, mean of the tick"), out.outlet_kg_s);
  }
  if constexpr (S::gas_results) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
      auto& c = out.gas_cycle[k];
      visit(real("gas_cycle[#].net_mep_Pa", "Of the last whole cycle: work over the swept volume").at(k), c.net_mep_Pa);
      visit(real("gas_cycle[#].pumping_mep_Pa", "Its part from 180 to 540 deg; negative: a loss").at(k),
            c.pumping_mep_Pa);
      visit(real("gas_cycle[#].peak_Pa", "Largest pressure").at(k), c.peak_Pa);
      visit(real("gas_cycle[#].peak_deg", "Where it was").at(k), c.peak_deg);
      visit(real("gas_cycle[#].trapped_kg", "Gas in the cylinder when the intake closed").at(k), c.trapped_kg);
      visit(real("gas_cycle[#].trapped_air_kg", "Air of it").at(k), c.trapped_air_kg);
      visit(real("gas_cycle[#].residual_ratio", "Burned share of it").at(k), c.residual_ratio);
      visit(real("gas_cycle[#].volumetric_efficiency", "Air through the intake over ambient air that fills the stroke")
                .at(k),
            c.volumetric_efficiency);
      visit(real("gas_cycle[#].exhaust_K", "Of the gas through the exhaust, by its mean enthalpy").at(k), c.exhaust_K);
      visit(real("gas_cycle[#].fuel_kg", "Fuel burned").at(k), c.fuel_kg);
      visit(real("gas_cycle[#].excess_air_ratio", "Air there over air that the fuel wanted; 0: no fuel").at(k),
            c.excess_air_ratio);
      visit(real("gas_cycle[#].heat_J", "Of combustion").at(k), c.heat_J);
      visit(real("gas_cycle[#].wall_heat_J", "To the walls").at(k), c.wall_heat_J);
      visit(real("gas_cycle[#].energy_defect_J", "What the first law lacks: rounding").at(k), c.energy_defect_J);
    }
  }
  if constexpr (S::crevice && S::gas_results) {
    each(real("cycle_blow_by_kg[#]", "Of the last whole cycle: what blew by into the crankcase"), out.cycle_blow_by_kg,
         shape.cylinders);
  }
  if constexpr (detail::Needs<S>::lambda) {
    visit(real("exhaust.excess_air_ratio", "Lambda of the gas in the exhaust manifold; 100: air; 0: no sensor"),
          out.exhaust_excess_air_ratio);
    visit(real("sensor_excess_air_ratio", "Lambda that the sensor shows, behind its pipe and lag; 100: air"),
          out.sensor_excess_air_ratio);
    if constexpr (S::gas_results) {
      each(real("outflow_excess_air_ratio[#]", "Of the last whole cycle: lambda of what left the cylinder"),
           out.outflow_excess_air_ratio, shape.cylinders);
    }
  }
  if constexpr (detail::Needs<S>::charge_burn && S::gas_results) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
      auto& b = out.cycle_burn[k];
      visit(real("cycle_burn[#].start_deg", "Of the last whole cycle: where the burn began, by the charge").at(k),
            b.start_deg);
      visit(real("cycle_burn[#].duration_deg", "How long it lasted, by the charge; 0: nothing burned").at(k),
            b.duration_deg);
    }
  }
  if constexpr (detail::Needs<S>::knock) {
    each(real("knock_integral[#]", "Of the last whole cycle: the unburned gas ignites by itself at 1"),
         out.knock_integral, shape.cylinders);
    each(real("knock_deg[#]", "Where it passed 1; 0: it did not"), out.knock_deg, shape.cylinders);
  }
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
  if constexpr (detail::Needs<S>::faulty_wheels) {
    visit(whole("wheel_faults_on", "Bit i-1: fault i of the wheels is on"), out.wheel_faults_on);
  }
  if constexpr (S::misfire) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
      auto& m = state.misfire[k];
      visit(whole("misfire[#].cycles", "Cycles of a cylinder since the start").at(k), m.cycles);
      visit(whole("misfire[#].misfires", "Those that misfired by the engine's rule").at(k), m.misfires);
      visit(whole("misfire[#].in_200_turns", "Misfires in the last 100 cycles").at(k), m.in_200_turns);
      visit(whole("misfire[#].in_1000_turns", "Misfires in the last 500 cycles").at(k), m.in_1000_turns);
    }
  }
  if constexpr (detail::Needs<S>::reluctor) {
    each(real("reluctor_V[#]", "Voltage of the variable reluctance sensor within the tick"), out.reluctor_V,
         S::reluctor_samples);
  }
  if constexpr (S::controller_names) {  // what stands above already, by a controller's names
    visit(real("map_Pa", "Absolute pressure in the intake manifold"), out.manifold[kIntake].pressure_Pa);
    visit(real("intake_air_K", "Temperature in the intake manifold"), out.manifold[kIntake].temperature_K);
    visit(real("tps_ratio", "Throttle, as the tick took it"), state.throttle_ratio);
    if constexpr (S::gas_results) {
      for (std::uint32_t k = 0; k < shape.cylinders; ++k)
        visit(real("lambda[#]", "Of a cylinder's last whole cycle; 0: no fuel").at(k),
              out.gas_cycle[k].excess_air_ratio);
    }
    if constexpr (detail::Needs<S>::lambda)
      visit(real("sensor_lambda", "At the lambda sensor; 100: air; 0: no sensor"), out.sensor_excess_air_ratio);
    if constexpr (S::walls) visit(real("coolant_K", "Coolant of the walls; 0: none"), out.coolant_K);
  }
  if constexpr (S::sensor_faults) {
    visit(whole("sensor_faults_on", "Bit i-1: fault i of the sensors is on"), out.sensor_faults_on);
    visit(real("faulty_map_Pa", "As a controller reads map_Pa"), out.faulty_sensor[0]);
    visit(real("faulty_intake_air_K", "As a controller reads intake_air_K"), out.faulty_sensor[1]);
    visit(real("faulty_tps_ratio", "As a controller reads tps_ratio"), out.faulty_sensor[2]);
    visit(real("faulty_sensor_lambda", "As a controller reads sensor_lambda"), out.faulty_sensor[3]);
    visit(real("faulty_coolant_K", "As a controller reads coolant_K"), out.faulty_sensor[4]);
  }
  if constexpr (S::bad_input_count) {
    visit(whole("bad_input_ticks", "Ticks with a bad input since the start"), state.bad_input_ticks);
    visit(whole("bad_input_kinds", "Their fault bits, or-ed"), state.bad_input_kinds);
  }
}

/// A wheel's signal as names of two kinds have it.
struct SignalNames {
  const char *level, *edge_count, *time_s, *edge_level;
};
template <class S, class Visit, class ASignal>
constexpr void each_signal(Visit& visit, const SignalNames& names, std::uint32_t wheel, ASignal& t) {
  visit(truth(names.level, "Level of the signal at the end of the tick").at(wheel), t.level);
  visit(whole(names.edge_count, "Edges in the tick").at(wheel), t.edge_count);
  for (std::uint32_t e = 0; e < S::trigger_edges; ++e) {
    visit(real(names.time_s, "Time since the start of the tick").at(wheel, e), t.edge[e].time_s);
    visit(truth(names.edge_level, "After it: 1 it rose, 0 it fell").at(wheel, e), t.edge[e].level);
  }
}

template <class S, class Visit, class AnOutput>
constexpr void each_event([[maybe_unused]] Visit&& visit, [[maybe_unused]] AnOutput& out,
                          [[maybe_unused]] const EngineShape& shape) {
  if constexpr (detail::Needs<S>::any_triggers) {
    constexpr SignalNames kHealthy{"trigger[#].level", "trigger[#].edge_count", "trigger[#].edge[#].time_s",
                                   "trigger[#].edge[#].level"};
    for (std::uint32_t w = 0; w < shape.wheels; ++w) each_signal<S>(visit, kHealthy, w, out.trigger[w]);
  }
  if constexpr (detail::Needs<S>::faulty_wheels) {
    constexpr SignalNames kFaulty{"faulty_trigger[#].level", "faulty_trigger[#].edge_count",
                                  "faulty_trigger[#].edge[#].time_s", "faulty_trigger[#].edge[#].level"};
    for (std::uint32_t w = 0; w < shape.wheels; ++w) each_signal<S>(visit, kFaulty, w, out.faulty_trigger[w]);
  }
  if constexpr (detail::Needs<S>::reluctor) {
    constexpr SignalNames kComparator{"comparator[#].level", "comparator[#].edge_count", "comparator[#].edge[#].time_s",
                                      "comparator[#].edge[#].level"};
    each_signal<S>(visit, kComparator, 0, out.comparator);
  }
}

}  // namespace crankloop::detail

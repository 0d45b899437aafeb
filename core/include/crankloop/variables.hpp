// The one list of a scene's variables: what goes into a step and what comes out, each with its name, unit and meaning.
//
//     each_input<S>(visit, input, shape)              calls visit(variable, input.speed_rad_s), and so on
//     each_output<S>(visit, state, output, shape)     what a step shows, and what the state alone knows
//     each_event<S>(visit, output, shape)             what happened within a tick: signals and edges of trigger wheels
//
// What is written, read or described variable by variable goes by these lists: an FMU's model description, its get and
// set, its documentation; the structs of the C interface and the columns of its step_many(). A new group of Input or
// Output takes its rows here or, of gas and of valves, in variables/; in the order of its members, and nothing else.
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
#include <crankloop/variables/gas_outputs.hpp>
#include <crankloop/variables/valve_outputs.hpp>

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
  each_gas_output<S>(visit, out, shape);
  each_valve_output<S>(visit, out, shape);
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

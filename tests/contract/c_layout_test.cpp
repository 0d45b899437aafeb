// Where the fields of the C interface stand: a program that was compiled with an earlier header of this minor version
// reads and writes them there.
#include <crankloop/crankloop.h>
#include <crankloop/crankloop_free_f.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

namespace crankloop::c_layout_test {
namespace {

struct Place {
  const char* name;
  std::size_t is;
  std::size_t was;
};
#define CRANKLOOP_SIZE(STRUCT, BYTES) \
  { "sizeof(" #STRUCT ")", sizeof(STRUCT), BYTES }
#define CRANKLOOP_AT(STRUCT, FIELD, BYTES) \
  { #STRUCT "." #FIELD, offsetof(STRUCT, FIELD), BYTES }

/// By the rules of the usual 64-bit machines: a number stands at a multiple of its size, a struct ends at a multiple of
/// its largest number.
constexpr Place kPlaces[] = {
    // clang-format off
    CRANKLOOP_SIZE(crankloop_status, 16),
    CRANKLOOP_AT(crankloop_status, reason, 0),
    CRANKLOOP_AT(crankloop_status, index, 4),
    CRANKLOOP_AT(crankloop_status, field, 8),

    CRANKLOOP_SIZE(crankloop_crank, 48),
    CRANKLOOP_AT(crankloop_crank, bore_m, 0),
    CRANKLOOP_AT(crankloop_crank, crank_radius_m, 8),
    CRANKLOOP_AT(crankloop_crank, rod_length_m, 16),
    CRANKLOOP_AT(crankloop_crank, pin_offset_m, 24),
    CRANKLOOP_AT(crankloop_crank, compression_ratio, 32),
    CRANKLOOP_AT(crankloop_crank, max_speed_rad_s, 40),

    CRANKLOOP_SIZE(crankloop_masses, 48),
    CRANKLOOP_AT(crankloop_masses, piston_kg, 0),
    CRANKLOOP_AT(crankloop_masses, rod_small_end_kg, 8),
    CRANKLOOP_AT(crankloop_masses, rod_big_end_kg, 16),
    CRANKLOOP_AT(crankloop_masses, rod_inertia_correction_kg_m2, 24),
    CRANKLOOP_AT(crankloop_masses, crank_pin_equivalent_kg, 32),
    CRANKLOOP_AT(crankloop_masses, crank_inertia_kg_m2, 40),

    CRANKLOOP_SIZE(crankloop_layout, 408),
    CRANKLOOP_AT(crankloop_layout, firing_deg, 0),
    CRANKLOOP_AT(crankloop_layout, bank_deg, 128),
    CRANKLOOP_AT(crankloop_layout, position_m, 256),
    CRANKLOOP_AT(crankloop_layout, pin, 384),
    CRANKLOOP_AT(crankloop_layout, cylinders, 400),

    CRANKLOOP_SIZE(crankloop_diagram_point, 16),
    CRANKLOOP_AT(crankloop_diagram_point, at, 0),
    CRANKLOOP_AT(crankloop_diagram_point, pressure_Pa, 8),

    CRANKLOOP_SIZE(crankloop_wiebe, 96),
    CRANKLOOP_AT(crankloop_wiebe, intake_Pa, 0),
    CRANKLOOP_AT(crankloop_wiebe, exhaust_Pa, 8),
    CRANKLOOP_AT(crankloop_wiebe, start_of_combustion_deg, 16),
    CRANKLOOP_AT(crankloop_wiebe, combustion_duration_deg, 24),
    CRANKLOOP_AT(crankloop_wiebe, wiebe_m, 32),
    CRANKLOOP_AT(crankloop_wiebe, compression_exponent, 40),
    CRANKLOOP_AT(crankloop_wiebe, expansion_exponent, 48),
    CRANKLOOP_AT(crankloop_wiebe, motored_expansion_exponent, 56),
    CRANKLOOP_AT(crankloop_wiebe, exhaust_valve_opens_deg, 64),
    CRANKLOOP_AT(crankloop_wiebe, net_mep_Pa, 72),
    CRANKLOOP_AT(crankloop_wiebe, heat_J, 80),
    CRANKLOOP_AT(crankloop_wiebe, heat_given, 88),

    CRANKLOOP_SIZE(crankloop_pressure, 120),
    CRANKLOOP_AT(crankloop_pressure, source, 0),
    CRANKLOOP_AT(crankloop_pressure, point_count, 4),
    CRANKLOOP_AT(crankloop_pressure, points, 8),
    CRANKLOOP_AT(crankloop_pressure, crankcase_Pa, 16),
    CRANKLOOP_AT(crankloop_pressure, wiebe, 24),

    CRANKLOOP_SIZE(crankloop_cam_point, 16),
    CRANKLOOP_AT(crankloop_cam_point, cam_deg, 0),
    CRANKLOOP_AT(crankloop_cam_point, lift_m, 8),

    CRANKLOOP_SIZE(crankloop_cam, 128),
    CRANKLOOP_AT(crankloop_cam, source, 0),
    CRANKLOOP_AT(crankloop_cam, exponent_count, 4),
    CRANKLOOP_AT(crankloop_cam, max_lift_m, 8),
    CRANKLOOP_AT(crankloop_cam, half_angle_deg, 16),
    CRANKLOOP_AT(crankloop_cam, exponents, 24),
    CRANKLOOP_AT(crankloop_cam, points, 88),
    CRANKLOOP_AT(crankloop_cam, point_count, 96),
    CRANKLOOP_AT(crankloop_cam, smoothing_m, 104),
    CRANKLOOP_AT(crankloop_cam, full_lift_deg, 112),
    CRANKLOOP_AT(crankloop_cam, phase_rate_deg_s, 120),

    CRANKLOOP_SIZE(crankloop_rocker, 80),
    CRANKLOOP_AT(crankloop_rocker, kind, 0),
    CRANKLOOP_AT(crankloop_rocker, cam_turns, 4),
    CRANKLOOP_AT(crankloop_rocker, base_circle_m, 8),
    CRANKLOOP_AT(crankloop_rocker, clearance_m, 16),
    CRANKLOOP_AT(crankloop_rocker, ratio, 24),
    CRANKLOOP_AT(crankloop_rocker, pivot_to_pad_m, 32),
    CRANKLOOP_AT(crankloop_rocker, pivot_to_cam_m, 40),
    CRANKLOOP_AT(crankloop_rocker, pad_radius_m, 48),
    CRANKLOOP_AT(crankloop_rocker, pivot_to_screw_m, 56),
    CRANKLOOP_AT(crankloop_rocker, screw_ball_m, 64),
    CRANKLOOP_AT(crankloop_rocker, stem_above_pivot_m, 72),

    CRANKLOOP_SIZE(crankloop_valve, 136),
    CRANKLOOP_AT(crankloop_valve, per_cylinder, 0),
    CRANKLOOP_AT(crankloop_valve, valve_kg, 8),
    CRANKLOOP_AT(crankloop_valve, spring_kg, 16),
    CRANKLOOP_AT(crankloop_valve, rocker_inertia_kg_m2, 24),
    CRANKLOOP_AT(crankloop_valve, spring_N_m, 32),
    CRANKLOOP_AT(crankloop_valve, spring_preload_N, 40),
    CRANKLOOP_AT(crankloop_valve, train_N_m, 48),
    CRANKLOOP_AT(crankloop_valve, train_damping_ratio, 56),
    CRANKLOOP_AT(crankloop_valve, guide_damping_ratio, 64),
    CRANKLOOP_AT(crankloop_valve, seat_N_m, 72),
    CRANKLOOP_AT(crankloop_valve, seat_damping_ratio, 80),
    CRANKLOOP_AT(crankloop_valve, head_area_m2, 88),
    CRANKLOOP_AT(crankloop_valve, surge_modes, 96),
    CRANKLOOP_AT(crankloop_valve, surge_damping_ratio, 104),
    CRANKLOOP_AT(crankloop_valve, spring_active_kg, 112),
    CRANKLOOP_AT(crankloop_valve, inner_spring_N_m, 120),
    CRANKLOOP_AT(crankloop_valve, inner_spring_kg, 128),

    CRANKLOOP_SIZE(crankloop_valve_train, 344),
    CRANKLOOP_AT(crankloop_valve_train, cam, 0),
    CRANKLOOP_AT(crankloop_valve_train, rocker, 128),
    CRANKLOOP_AT(crankloop_valve_train, valve, 208),

    CRANKLOOP_SIZE(crankloop_friction, 24),
    CRANKLOOP_AT(crankloop_friction, constant_Pa, 0),
    CRANKLOOP_AT(crankloop_friction, linear_Pa_s, 8),
    CRANKLOOP_AT(crankloop_friction, quadratic_Pa_s2, 16),

    CRANKLOOP_SIZE(crankloop_machine, 32),
    CRANKLOOP_AT(crankloop_machine, constant_Nm, 0),
    CRANKLOOP_AT(crankloop_machine, linear_Nm_s, 8),
    CRANKLOOP_AT(crankloop_machine, quadratic_Nm_s2, 16),
    CRANKLOOP_AT(crankloop_machine, inertia_kg_m2, 24),

    CRANKLOOP_SIZE(crankloop_starter, 16),
    CRANKLOOP_AT(crankloop_starter, stall_Nm, 0),
    CRANKLOOP_AT(crankloop_starter, no_load_rad_s, 8),

    CRANKLOOP_SIZE(crankloop_tooth_gap, 8),
    CRANKLOOP_AT(crankloop_tooth_gap, teeth, 0),
    CRANKLOOP_AT(crankloop_tooth_gap, missing, 4),

    CRANKLOOP_SIZE(crankloop_trigger_wheel, 120),
    CRANKLOOP_AT(crankloop_trigger_wheel, shaft, 0),
    CRANKLOOP_AT(crankloop_trigger_wheel, train, 4),
    CRANKLOOP_AT(crankloop_trigger_wheel, pattern, 8),
    CRANKLOOP_AT(crankloop_trigger_wheel, places, 12),
    CRANKLOOP_AT(crankloop_trigger_wheel, gap_count, 16),
    CRANKLOOP_AT(crankloop_trigger_wheel, edge_count, 20),
    CRANKLOOP_AT(crankloop_trigger_wheel, gaps, 24),
    CRANKLOOP_AT(crankloop_trigger_wheel, first_tooth_deg, 88),
    CRANKLOOP_AT(crankloop_trigger_wheel, tooth_ratio, 96),
    CRANKLOOP_AT(crankloop_trigger_wheel, edges_deg, 104),
    CRANKLOOP_AT(crankloop_trigger_wheel, inverted, 112),

    CRANKLOOP_SIZE(crankloop_definition, 10968),
    CRANKLOOP_AT(crankloop_definition, crank, 0),
    CRANKLOOP_AT(crankloop_definition, masses, 48),
    CRANKLOOP_AT(crankloop_definition, layout, 96),
    CRANKLOOP_AT(crankloop_definition, pressure, 504),
    CRANKLOOP_AT(crankloop_definition, train_count, 624),
    CRANKLOOP_AT(crankloop_definition, trains, 632),
    CRANKLOOP_AT(crankloop_definition, friction, 2008),
    CRANKLOOP_AT(crankloop_definition, machine, 2032),
    CRANKLOOP_AT(crankloop_definition, starter, 2064),
    CRANKLOOP_AT(crankloop_definition, trigger_count, 2080),
    CRANKLOOP_AT(crankloop_definition, triggers, 2088),
    CRANKLOOP_AT(crankloop_definition, misfires, 3048),

    CRANKLOOP_AT(crankloop_definition, wheel_fault_count, 5736),
    CRANKLOOP_AT(crankloop_definition, wheel_faults, 5744),
    CRANKLOOP_AT(crankloop_definition, contacts, 7536),
    CRANKLOOP_AT(crankloop_definition, gas, 7728),
    CRANKLOOP_AT(crankloop_definition, reluctor, 9440),
    CRANKLOOP_AT(crankloop_definition, lambda_sensor, 9528),
    CRANKLOOP_AT(crankloop_definition, sensor_fault_count, 9552),
    CRANKLOOP_AT(crankloop_definition, sensor_faults, 9560),

    CRANKLOOP_SIZE(crankloop_lambda_sensor, 24),
    CRANKLOOP_AT(crankloop_lambda_sensor, pipe_m3, 0),
    CRANKLOOP_AT(crankloop_lambda_sensor, lag_s, 8),
    CRANKLOOP_AT(crankloop_lambda_sensor, in_use, 16),

    CRANKLOOP_SIZE(crankloop_sensor_fault, 88),
    CRANKLOOP_AT(crankloop_sensor_fault, start_s, 0),
    CRANKLOOP_AT(crankloop_sensor_fault, end_s, 8),
    CRANKLOOP_AT(crankloop_sensor_fault, offset, 16),
    CRANKLOOP_AT(crankloop_sensor_fault, noise, 24),
    CRANKLOOP_AT(crankloop_sensor_fault, delay_s, 32),
    CRANKLOOP_AT(crankloop_sensor_fault, lag_s, 40),
    CRANKLOOP_AT(crankloop_sensor_fault, least, 48),
    CRANKLOOP_AT(crankloop_sensor_fault, most, 56),
    CRANKLOOP_AT(crankloop_sensor_fault, step, 64),
    CRANKLOOP_AT(crankloop_sensor_fault, sensor, 72),
    CRANKLOOP_AT(crankloop_sensor_fault, input_bit, 76),
    CRANKLOOP_AT(crankloop_sensor_fault, wire, 80),
    CRANKLOOP_AT(crankloop_sensor_fault, noise_seed, 84),

    CRANKLOOP_SIZE(crankloop_reluctor, 88),
    CRANKLOOP_AT(crankloop_reluctor, gain_V_s, 0),
    CRANKLOOP_AT(crankloop_reluctor, reach_ratio, 8),
    CRANKLOOP_AT(crankloop_reluctor, gap_lobe_ratio, 16),
    CRANKLOOP_AT(crankloop_reluctor, runout_ratio, 24),
    CRANKLOOP_AT(crankloop_reluctor, runout_at_deg, 32),
    CRANKLOOP_AT(crankloop_reluctor, arm_ratio, 40),
    CRANKLOOP_AT(crankloop_reluctor, least_V, 48),
    CRANKLOOP_AT(crankloop_reluctor, hysteresis_V, 56),
    CRANKLOOP_AT(crankloop_reluctor, watchdog_s, 64),
    CRANKLOOP_AT(crankloop_reluctor, delay_s, 72),
    CRANKLOOP_AT(crankloop_reluctor, wheel, 80),
    CRANKLOOP_AT(crankloop_reluctor, reversed, 84),

    CRANKLOOP_SIZE(crankloop_wheel_fault, 112),
    CRANKLOOP_AT(crankloop_wheel_fault, start_s, 0),
    CRANKLOOP_AT(crankloop_wheel_fault, end_s, 8),
    CRANKLOOP_AT(crankloop_wheel_fault, moved_deg, 16),
    CRANKLOOP_AT(crankloop_wheel_fault, extra_tooth_deg, 24),
    CRANKLOOP_AT(crankloop_wheel_fault, extra_width_deg, 32),
    CRANKLOOP_AT(crankloop_wheel_fault, runout_deg, 40),
    CRANKLOOP_AT(crankloop_wheel_fault, runout_at_deg, 48),
    CRANKLOOP_AT(crankloop_wheel_fault, late_deg, 56),
    CRANKLOOP_AT(crankloop_wheel_fault, noise_Hz, 64),
    CRANKLOOP_AT(crankloop_wheel_fault, noise_pulse_s, 72),
    CRANKLOOP_AT(crankloop_wheel_fault, wheel, 80),
    CRANKLOOP_AT(crankloop_wheel_fault, input_bit, 84),
    CRANKLOOP_AT(crankloop_wheel_fault, missing_tooth, 88),
    CRANKLOOP_AT(crankloop_wheel_fault, moved_tooth, 92),
    CRANKLOOP_AT(crankloop_wheel_fault, inverted, 96),
    CRANKLOOP_AT(crankloop_wheel_fault, stuck, 100),
    CRANKLOOP_AT(crankloop_wheel_fault, noise_seed, 104),

    CRANKLOOP_SIZE(crankloop_misfire, 168),
    CRANKLOOP_AT(crankloop_misfire, random_ratio, 0),
    CRANKLOOP_AT(crankloop_misfire, burning_ratio, 8),
    CRANKLOOP_AT(crankloop_misfire, pattern, 16),
    CRANKLOOP_AT(crankloop_misfire, misfires, 20),
    CRANKLOOP_AT(crankloop_misfire, of, 24),
    CRANKLOOP_AT(crankloop_misfire, seed, 28),
    CRANKLOOP_AT(crankloop_misfire, cycle_count, 32),
    CRANKLOOP_AT(crankloop_misfire, cycles, 36),

    CRANKLOOP_SIZE(crankloop_cam_contact, 48),
    CRANKLOOP_AT(crankloop_cam_contact, width_m, 0),
    CRANKLOOP_AT(crankloop_cam_contact, friction_ratio, 8),
    CRANKLOOP_AT(crankloop_cam_contact, cam_Pa, 16),
    CRANKLOOP_AT(crankloop_cam_contact, cam_poisson_ratio, 24),
    CRANKLOOP_AT(crankloop_cam_contact, follower_Pa, 32),
    CRANKLOOP_AT(crankloop_cam_contact, follower_poisson_ratio, 40),

    CRANKLOOP_SIZE(crankloop_port, 272),
    CRANKLOOP_AT(crankloop_port, seat_diameter_m, 0),
    CRANKLOOP_AT(crankloop_port, flow_lift_ratio, 8),
    CRANKLOOP_AT(crankloop_port, flow_ratio, 136),
    CRANKLOOP_AT(crankloop_port, port, 264),
    CRANKLOOP_AT(crankloop_port, flow_count, 268),

    CRANKLOOP_SIZE(crankloop_runner, 24),
    CRANKLOOP_AT(crankloop_runner, length_m, 0),
    CRANKLOOP_AT(crankloop_runner, diameter_m, 8),
    CRANKLOOP_AT(crankloop_runner, loss_ratio, 16),

    CRANKLOOP_SIZE(crankloop_crevice, 16),
    CRANKLOOP_AT(crankloop_crevice, volume_ratio, 0),
    CRANKLOOP_AT(crankloop_crevice, blow_by_m2, 8),

    CRANKLOOP_SIZE(crankloop_walls, 48),
    CRANKLOOP_AT(crankloop_walls, capacity_J_K, 0),
    CRANKLOOP_AT(crankloop_walls, to_coolant_W_K, 8),
    CRANKLOOP_AT(crankloop_walls, coolant_K, 16),
    CRANKLOOP_AT(crankloop_walls, intake_W_K, 24),
    CRANKLOOP_AT(crankloop_walls, exhaust_W_K, 32),
    CRANKLOOP_AT(crankloop_walls, manifold_K, 40),

    CRANKLOOP_SIZE(crankloop_charge_burn, 56),
    CRANKLOOP_AT(crankloop_charge_burn, spark_to_start_deg, 0),
    CRANKLOOP_AT(crankloop_charge_burn, reference_rad_s, 8),
    CRANKLOOP_AT(crankloop_charge_burn, reference_K, 16),
    CRANKLOOP_AT(crankloop_charge_burn, reference_Pa, 24),
    CRANKLOOP_AT(crankloop_charge_burn, reference_burned_ratio, 32),
    CRANKLOOP_AT(crankloop_charge_burn, reference_excess_air_ratio, 40),
    CRANKLOOP_AT(crankloop_charge_burn, in_use, 48),

    CRANKLOOP_SIZE(crankloop_gas, 1712),
    CRANKLOOP_AT(crankloop_gas, intake_m3, 0),
    CRANKLOOP_AT(crankloop_gas, exhaust_m3, 8),
    CRANKLOOP_AT(crankloop_gas, throttle_m2, 16),
    CRANKLOOP_AT(crankloop_gas, throttle_closed_m2, 24),
    CRANKLOOP_AT(crankloop_gas, throttle_ratio, 32),
    CRANKLOOP_AT(crankloop_gas, throttle_area_ratio, 160),
    CRANKLOOP_AT(crankloop_gas, outlet_m2, 288),
    CRANKLOOP_AT(crankloop_gas, ambient_Pa, 296),
    CRANKLOOP_AT(crankloop_gas, back_Pa, 304),
    CRANKLOOP_AT(crankloop_gas, ambient_K, 312),
    CRANKLOOP_AT(crankloop_gas, exhaust_K, 320),
    CRANKLOOP_AT(crankloop_gas, wall_K, 328),
    CRANKLOOP_AT(crankloop_gas, wall_heat_ratio, 336),
    CRANKLOOP_AT(crankloop_gas, fuel_kg, 344),
    CRANKLOOP_AT(crankloop_gas, excess_air_ratio, 352),
    CRANKLOOP_AT(crankloop_gas, heating_value_J_kg, 360),
    CRANKLOOP_AT(crankloop_gas, combustion_efficiency, 368),
    CRANKLOOP_AT(crankloop_gas, air_fuel_ratio, 376),
    CRANKLOOP_AT(crankloop_gas, latch_deg, 384),
    CRANKLOOP_AT(crankloop_gas, burn_start_deg, 392),
    CRANKLOOP_AT(crankloop_gas, burn_duration_deg, 400),
    CRANKLOOP_AT(crankloop_gas, wiebe_m, 408),
    CRANKLOOP_AT(crankloop_gas, second_ratio, 416),
    CRANKLOOP_AT(crankloop_gas, second_m, 424),
    CRANKLOOP_AT(crankloop_gas, second_duration_ratio, 432),
    CRANKLOOP_AT(crankloop_gas, octane_number, 440),
    CRANKLOOP_AT(crankloop_gas, crevice, 448),
    CRANKLOOP_AT(crankloop_gas, intake_runner, 464),
    CRANKLOOP_AT(crankloop_gas, exhaust_runner, 488),
    CRANKLOOP_AT(crankloop_gas, walls, 512),
    CRANKLOOP_AT(crankloop_gas, charge_burn, 560),
    CRANKLOOP_AT(crankloop_gas, ports, 616),
    CRANKLOOP_AT(crankloop_gas, throttle_count, 1704),

    CRANKLOOP_SIZE(crankloop_options, 32),
    CRANKLOOP_AT(crankloop_options, tick_s, 0),
    CRANKLOOP_AT(crankloop_options, valve_accuracy_m, 8),
    CRANKLOOP_AT(crankloop_options, valve_integrator, 16),
    CRANKLOOP_AT(crankloop_options, valve_event_budget, 20),
    CRANKLOOP_AT(crankloop_options, max_speed_rad_s, 24),

    CRANKLOOP_SIZE(crankloop_column, 48),
    CRANKLOOP_AT(crankloop_column, name, 0),
    CRANKLOOP_AT(crankloop_column, values, 8),
    CRANKLOOP_AT(crankloop_column, count, 16),
    CRANKLOOP_AT(crankloop_column, stride, 24),
    CRANKLOOP_AT(crankloop_column, at, 32),
    CRANKLOOP_AT(crankloop_column, storage, 40),
    CRANKLOOP_AT(crankloop_column, is_input, 44),
    // clang-format on
};
#undef CRANKLOOP_SIZE
#undef CRANKLOOP_AT

constexpr const char* kWhatToDo =
    " has moved: programs compiled with an earlier header of this minor version would read something else there. "
    "Append "
    "a new field to crankloop_definition or crankloop_options, and its row here; or raise the minor version "
    "(version.h, "
    "CMakeLists.txt), which gives the shared library another name, and then write the new places here.";

TEST(CLayout, StaysAsItIsWithinAMinorVersion) {
  if (sizeof(void*) != 8 || alignof(double) != 8) GTEST_SKIP() << "the places are those of 64 bits";
  for (const Place& place : kPlaces) EXPECT_EQ(place.is, place.was) << place.name << kWhatToDo;
}

/// On a page: as much memory, in KiB.
void expect_told(const std::string& page, const char* format, std::size_t bytes) {
  char told[80];
  std::snprintf(told, sizeof told, format, static_cast<double>(bytes) / 1024);
  EXPECT_NE(page.find(told), std::string::npos) << told;
}

TEST(CLayout, HasTheSizesThatItsPageTells) {
  if (sizeof(void*) != 8) GTEST_SKIP() << "the page has those of 64 bits";
  std::ostringstream page;
  page << std::ifstream(CRANKLOOP_SOURCE_DIR "/docs/c_interface.md").rdbuf();
  expect_told(page.str(), "crankloop_free_f_tables tables;  // yours and zero at first: %.0f KiB,",
              sizeof(crankloop_free_f_tables));
  expect_told(page.str(), "crankloop_free_f_engine engine;  // %.1f KiB\n", sizeof(crankloop_free_f_engine));
}

}  // namespace
}  // namespace crankloop::c_layout_test

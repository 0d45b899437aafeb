#include "usual_ranges.hpp"

#include <cmath>
#include <string_view>

#include "../files/units.hpp"

namespace crankloop::program {
namespace {

constexpr bool kOrZero = true;

/// Wide enough for engines from 50 cm3 to ship engines, narrow enough to detect a factor of 10 wherever engines of one
/// size differ by less. The samples and the engines of docs/model.md "What `crankloop new` assumes" are well inside.
// clang-format off
constexpr UsualRange kRanges[] = {
    {"engine", "rated_rpm", Per::piston_speed, {2, 32}},

    {"crank", "pin_offset_mm", Per::bore, {-0.15, 0.15}},
    {"crank", "compression_ratio", Per::one, {4, 26}},

    {"masses", "rod_small_end_g", Per::bore3, {0.02, 4}},
    {"masses", "rod_big_end_g", Per::bore3, {0.05, 10}},
    {"masses", "rod_g", Per::bore3, {0.1, 15}},
    {"masses", "rod_com_to_crank_mm", Per::rod, {0.1, 0.6}},
    {"masses", "crank_pin_equivalent_g", Per::bore3, {0.02, 30}, kOrZero},
    {"masses", "crank_pin_g", Per::bore3, {0.02, 15}, kOrZero},
    {"masses", "crank_web_g", Per::bore3, {0.02, 30}, kOrZero},
    {"masses", "crank_web_radius_mm", Per::stroke, {0.02, 1}, kOrZero},
    {"masses", "crank_inertia_kg_m2", Per::inertia, {0.008, 1.5}},

    {"layout", "cylinder_spacing_mm", Per::bore, {0.4, 2.5}},

    {"pressure", "crankcase_kPa", Per::one, {50, 200}},
    {"pressure", "intake_kPa", Per::one, {20, 600}},
    {"pressure", "exhaust_kPa", Per::one, {50, 700}},
    {"pressure", "start_of_combustion_deg", Per::one, {-45, 20}},
    {"pressure", "combustion_duration_deg", Per::one, {20, 120}},
    {"pressure", "wiebe_m", Per::one, {0.2, 5}},
    {"pressure", "expansion_exponent", Per::one, {1.1, 1.45}},
    {"pressure", "exhaust_valve_opens_deg", Per::one, {90, 175}},
    {"pressure", "net_mep_kPa", Per::one, {150, 4000}},
    {"pressure", "heat_J", Per::cylinder, {0.1, 10}, kOrZero},

    {"gas", "intake_volume_cm3", Per::displacement, {0.02, 40}},
    {"gas", "exhaust_volume_cm3", Per::displacement, {0.02, 80}},
    {"gas", "throttle_mm2", Per::displacement, {0.05, 15}},
    {"gas", "throttle_closed_mm2", Per::displacement, {0.0001, 15}, kOrZero},
    {"gas", "outlet_mm2", Per::displacement, {0.05, 15}},
    {"gas", "ambient_kPa", Per::one, {40, 500}},
    {"gas", "ambient_C", Per::one, {-50, 70}},
    {"gas", "back_kPa", Per::one, {40, 600}, kOrZero},
    {"gas", "exhaust_C", Per::one, {50, 1200}},
    {"gas", "wall_C", Per::one, {0, 400}},
    {"gas", "wall_heat_factor", Per::one, {0.2, 5}, kOrZero},
    {"gas", "wall_J_per_K", Per::cylinder, {0.3, 20}, kOrZero},
    {"gas", "wall_W_per_K", Per::cylinder, {0.005, 0.5}, kOrZero},
    {"gas", "coolant_C", Per::one, {-40, 150}},
    {"gas", "intake_W_per_K", Per::one, {0.05, 30}, kOrZero},
    {"gas", "exhaust_W_per_K", Per::one, {0.1, 100}, kOrZero},
    {"gas", "manifold_C", Per::one, {-50, 400}},
    {"gas", "crevice_share", Per::one, {0.002, 0.04}, kOrZero},
    {"gas", "blow_by_mm2", Per::bore, {0.0002, 0.006}, kOrZero},
    {"gas", "intake_runner_mm", Per::stroke, {0.5, 30}, kOrZero},
    {"gas", "intake_runner_diameter_mm", Per::bore, {0.12, 0.8}},
    {"gas", "intake_runner_loss", Per::one, {0.05, 5}, kOrZero},
    {"gas", "exhaust_runner_mm", Per::stroke, {0.5, 30}, kOrZero},
    {"gas", "exhaust_runner_diameter_mm", Per::bore, {0.12, 0.8}},
    {"gas", "exhaust_runner_loss", Per::one, {0.05, 5}, kOrZero},
    {"gas", "fuel_mg", Per::cylinder, {0.002, 0.4}, kOrZero},
    {"gas", "heating_value_MJ_per_kg", Per::one, {15, 125}},
    {"gas", "combustion_efficiency", Per::one, {0.7, 1}},
    {"gas", "air_fuel_ratio", Per::one, {5, 40}},
    {"gas", "burn_start_deg", Per::one, {-50, 20}},
    {"gas", "burn_duration_deg", Per::one, {15, 120}},
    {"gas", "spark_to_start_deg", Per::one, {1, 30}, kOrZero},
    {"gas", "burn_reference_rpm", Per::one, {500, 8000}},
    {"gas", "burn_reference_K", Per::one, {500, 900}},
    {"gas", "burn_reference_kPa", Per::one, {200, 5000}},
    {"gas", "burn_reference_residual", Per::one, {0.01, 0.25}, kOrZero},
    {"gas", "burn_reference_lambda", Per::one, {0.8, 1.3}},
    {"gas", "octane", Per::one, {80, 110}, kOrZero},
    {"gas", "wiebe_m", Per::one, {0.2, 5}},

    {"friction", "constant_kPa", Per::one, {5, 500}, kOrZero},
    {"friction", "linear_kPa_per_1000rpm", Per::stroke, {0.01, 3}, kOrZero},
    {"friction", "quadratic_kPa_per_1000rpm2", Per::stroke2, {5e-6, 5e-3}, kOrZero},

    {"machine", "constant_Nm", Per::litre, {0.2, 400}, kOrZero},
    {"machine", "linear_Nm_per_1000rpm", Per::litre_per_speed, {0.2, 400}, kOrZero},
    {"machine", "quadratic_Nm_per_1000rpm2", Per::litre_per_speed2, {0.2, 400}, kOrZero},
    {"machine", "inertia_kg_m2", Per::inertia, {1e-4, 50}, kOrZero},
    {"starter", "stall_Nm", Per::litre, {8, 1500}, kOrZero},
    {"starter", "no_load_rpm", Per::one, {50, 3000}},

    {"cam", "max_lift_mm", Per::bore, {0.03, 0.35}},
    {"cam", "half_angle_deg", Per::one, {30, 120}},
    {"cam", "phase_rate_deg_per_s", Per::one, {5, 3000}, kOrZero},
    {"cam", "width_mm", Per::bore, {0.03, 0.6}},
    {"cam", "friction_ratio", Per::one, {0.005, 0.3}, kOrZero},
    {"cam", "limit_MPa", Per::one, {200, 4000}},
    {"material", "cam_GPa", Per::one, {60, 500}},
    {"material", "cam_poisson", Per::one, {0.1, 0.45}},
    {"material", "follower_GPa", Per::one, {60, 500}},
    {"material", "follower_poisson", Per::one, {0.1, 0.45}},
    {"rocker", "ratio", Per::one, {0.5, 3}},
    {"rocker", "base_circle_mm", Per::bore, {0.05, 0.8}},
    {"rocker", "pivot_to_pad_mm", Per::bore, {0.08, 4}},
    {"rocker", "pivot_to_cam_mm", Per::bore, {0.08, 4}},
    {"rocker", "pad_radius_mm", Per::bore, {0.03, 50}},
    {"rocker", "pivot_to_screw_mm", Per::bore, {0.08, 4}},
    {"rocker", "screw_ball_mm", Per::bore, {0.01, 1}, kOrZero},
    {"rocker", "stem_above_pivot_mm", Per::bore, {-1.5, 1.5}},
    {"rocker", "clearance_mm", Per::bore, {3e-5, 0.02}, kOrZero},
    {"valve", "valve_g", Per::bore3, {0.02, 2.5}},
    {"valve", "spring_g", Per::bore3, {0.005, 2}, kOrZero},
    {"valve", "rocker_inertia_kg_mm2", Per::bore5, {1e-4, 0.1}, kOrZero},
    {"valve", "spring_N_per_mm", Per::bore, {0.005, 10}},
    {"valve", "spring_preload_N", Per::bore2, {0.01, 80}},
    {"valve", "train_N_per_mm", Per::bore, {0.5, 5000}},
    {"valve", "train_damping_ratio", Per::one, {0.003, 1}, kOrZero},
    {"valve", "guide_damping_ratio", Per::one, {1e-5, 0.05}, kOrZero},
    {"valve", "seat_N_per_mm", Per::bore, {2, 50000}},
    {"valve", "seat_damping_ratio", Per::one, {0.003, 1}, kOrZero},
    {"valve", "head_area_mm2", Per::bore2, {1, 50}, kOrZero},
    {"valve", "seat_diameter_mm", Per::bore, {0.15, 0.65}},
    {"valve", "head_diameter_mm", Per::bore, {0.16, 0.7}},
    {"valve", "seat_width_mm", Per::bore, {0.005, 0.06}},
    {"valve", "seat_angle_deg", Per::one, {20, 60}},
    {"valve", "port_diameter_mm", Per::bore, {0.13, 0.7}},
    {"valve", "stem_diameter_mm", Per::bore, {0.02, 0.2}, kOrZero},
};
// clang-format on

}  // namespace

const UsualRange* usual_range_of(const Key& key) noexcept {
  for (const UsualRange& range : kRanges) {
    if (std::string_view(range.key) == key.name && std::string_view(range.section) == key.section) return &range;
  }
  return nullptr;
}

std::optional<double> EngineSize::of(Per per) const {
  if (per == Per::one) return 1;
  if (per == Per::rod) return rod_mm;
  if (per == Per::stroke) return stroke_mm;
  if (per == Per::stroke2) return stroke_mm ? std::optional(*stroke_mm * *stroke_mm) : std::nullopt;
  if (per == Per::piston_speed) return stroke_mm ? std::optional(30e3 / *stroke_mm) : std::nullopt;
  if (!bore_mm) return {};
  if (per == Per::bore) return bore_mm;
  const double bore_cm = *bore_mm / 10;
  if (per == Per::bore2) return bore_cm * bore_cm;
  if (per == Per::bore3) return bore_cm * bore_cm * bore_cm;
  if (per == Per::bore5) return std::pow(bore_cm, 5);
  if (!stroke_mm) return {};
  const double cylinder_cm3 = kPi / 4 * bore_cm * bore_cm * *stroke_mm / 10;
  if (per == Per::cylinder) return cylinder_cm3;
  if (per == Per::displacement) return cylinders * cylinder_cm3;
  const double litres = cylinders * cylinder_cm3 / 1e3;
  if (per == Per::litre) return litres;
  if (per == Per::inertia) return std::pow(litres, 4.0 / 3);
  if (!rated_krpm) return {};
  return litres / (per == Per::litre_per_speed ? *rated_krpm : *rated_krpm * *rated_krpm);
}

const char* in_words(Per per) noexcept {
  switch (per) {
    case Per::one:
      return "";
    case Per::piston_speed:
    case Per::stroke:
    case Per::stroke2:
      return " for this stroke";
    case Per::bore:
    case Per::bore2:
    case Per::bore3:
    case Per::bore5:
      return " for this bore";
    case Per::rod:
      return " for this rod";
    case Per::cylinder:
    case Per::displacement:
    case Per::litre:
    case Per::inertia:
    case Per::litre_per_speed:
    case Per::litre_per_speed2:
      break;
  }
  return " for this displacement";
}

}  // namespace crankloop::program

#include "usual_engine.hpp"

#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/cam_profile.hpp>

#include "../../files/units.hpp"

namespace crankloop::program {
namespace {

constexpr Combustion kSparkIgnition{10, -18, 55, 2, 1.32, 1.27, 130};
constexpr Combustion kSparkIgnitionBoosted{9.5, -10, 60, 2, 1.32, 1.27, 130};  // later: knock
constexpr Combustion kDiesel{18, -6, 60, 0.9, 1.35, 1.28, 135};
constexpr Combustion kDieselBoosted{16, -6, 60, 0.9, 1.35, 1.28, 135};

constexpr double kFrictionConstant_kPa = 40;
constexpr double kFrictionOfPeak = 0.005;
constexpr double kFrictionLinear_kPa_s_m = 9;
constexpr double kFrictionQuadratic_kPa_s2_m2 = 0.09;

/// g/cm^3 of the bore's cube.
constexpr double kPistonSpark = 0.68;
constexpr double kPistonDiesel = 1.2;
constexpr double kPistonTractor = 1.4;
constexpr double kRodSpark = 0.7;
constexpr double kRodDiesel = 1.5;
constexpr double kRodTractor = 1.9;
constexpr double kBoostedMass = 1.15;  ///< of pistons, pins and rods for higher peak pressures

constexpr double kValveKgAt95Mm = 0.15;      ///< two valves, with bucket
constexpr double kFourValveMassShare = 0.6;  ///< of each of four: heads of 0.38 bores instead of 0.45, cubed

bool is_spark(const EngineDesign& design) { return design.type == EngineType::spark_ignition; }
bool is_boosted(const EngineDesign& design) { return design.pressure_ratio > 1; }
double cubed(double bore_mm) { return bore_mm * bore_mm * bore_mm / 1e3; }

/// The lobe at the fraction u of its half angle: lift / full lift, and its slope.
struct LobePoint {
  double lift;
  double slope;
};
LobePoint lobe_at(double u) {
  double coefficients[kCamExponents.size()];
  cam_coefficients(kCamExponents.data(), static_cast<int>(kCamExponents.size()), coefficients);
  LobePoint point{1, 0};
  for (std::size_t i = 0; i < kCamExponents.size(); ++i) {
    point.lift += coefficients[i] * std::pow(u, kCamExponents[i]);
    point.slope += coefficients[i] * kCamExponents[i] * std::pow(u, kCamExponents[i] - 1);
  }
  return point;
}

}  // namespace

double usual_piston_speed_m_s(const EngineDesign& design) noexcept {
  if (design.type == EngineType::tractor) return 9;
  if (!is_spark(design)) return 11;
  return design.four_valves ? 15 : 13;
}

double usual_rated_rpm(const EngineDesign& design, double stroke_mm) noexcept {
  return std::round(usual_piston_speed_m_s(design) * 300 / stroke_mm) * 100;
}

const Combustion& usual_combustion(const EngineDesign& design) noexcept {
  if (is_spark(design)) return is_boosted(design) ? kSparkIgnitionBoosted : kSparkIgnition;
  return is_boosted(design) ? kDieselBoosted : kDiesel;
}

double usual_net_mep_kPa(const EngineDesign& design, double piston_speed_m_s) noexcept {
  const double four_valves_kPa = is_spark(design) ? 900 + 25 * piston_speed_m_s : 900;
  const double two_valves = is_spark(design) ? 0.87 : 0.93;
  return four_valves_kPa * (design.four_valves ? 1 : two_valves) * design.pressure_ratio;
}

Friction usual_friction(double peak_pressure_kPa, double stroke_mm) noexcept {
  const double piston_m_s_per_1000rpm = stroke_mm / 30;
  return {kFrictionConstant_kPa + kFrictionOfPeak * peak_pressure_kPa, kFrictionLinear_kPa_s_m * piston_m_s_per_1000rpm,
          kFrictionQuadratic_kPa_s2_m2 * piston_m_s_per_1000rpm * piston_m_s_per_1000rpm};
}

double usual_piston_g(const EngineDesign& design, double bore_mm) noexcept {
  const double natural = is_spark(design)                    ? kPistonSpark
                         : design.type == EngineType::diesel ? kPistonDiesel
                                                             : kPistonTractor;
  return natural * (is_boosted(design) ? kBoostedMass : 1) * cubed(bore_mm);
}

double usual_rod_g(const EngineDesign& design, double bore_mm) noexcept {
  const double natural = is_spark(design) ? kRodSpark : design.type == EngineType::diesel ? kRodDiesel : kRodTractor;
  return natural * (is_boosted(design) ? kBoostedMass : 1) * cubed(bore_mm);
}

double usual_inertia_kg_m2(const EngineDesign& design, double displacement_L) noexcept {
  return (is_spark(design) ? 0.05 : 0.12) * std::pow(displacement_L, 4.0 / 3);
}

double usual_lift_mm(const EngineDesign& design, double bore_mm) noexcept {
  return (design.four_valves ? 0.1 : 0.115) * bore_mm;
}

double usual_valve_g(const EngineDesign& design, double bore_mm) noexcept {
  return kValveKgAt95Mm * 1e3 * (design.four_valves ? kFourValveMassShare : 1) * std::pow(bore_mm / 95, 3);
}

Seats usual_seats(const EngineDesign& design, double bore_mm) noexcept {
  constexpr double kSeatPerHead = 0.93;
  return {kSeatPerHead * (design.four_valves ? 0.36 : 0.44) * bore_mm,
          kSeatPerHead * (design.four_valves ? 0.30 : 0.36) * bore_mm};
}

double seat_mm2(double seat_mm) noexcept { return kPi / 4 * seat_mm * seat_mm; }

GasExchange usual_gas_exchange(const EngineDesign& design, const CylinderSize& size, int cylinders,
                               double rated_rpm) noexcept {
  constexpr double kRunnerVolumes = 5.1;  // of the manifold
  const bool spark = is_spark(design);
  const double bore_mm = size.bore_mm;
  const double engine_cm3 = size.displacement_cm3 * cylinders;
  GasExchange g{};
  g.throttle_mm2 = engine_cm3 * rated_rpm / 120 / (spark ? kThrottleSpeed_m_s : kDuctSpeed_m_s);
  g.throttle_closed_mm2 = spark ? 3e-3 * engine_cm3 : g.throttle_mm2;  // less than what idling takes
  g.outlet_mm2 = kOutletPerInlet * g.throttle_mm2;
  g.intake_volume_cm3 = g.exhaust_volume_cm3 = kManifoldVolumes * engine_cm3;
  g.exhaust_full_lift_deg = 250;
  g.wall_C = spark ? 150 : 180;
  g.blow_by_mm2 = 0.1 * bore_mm / 86;
  if (!spark) return g;
  constexpr double kSound_m_s = 350, kEngelman = 2.1, kTunedAt = 0.8, kLongest_mm = 3000, kExhaustPerIntake = 1.4;
  const auto area_cm2 = [](double diameter_mm) { return kPi / 4 * diameter_mm * diameter_mm / 100; };
  const double swing_rad_s = 2 * kPi * kEngelman * kTunedAt * rated_rpm / 60;
  const double behind_cm3 = size.displacement_cm3 / 2 + size.clearance_cm3;
  const double intake_diameter_mm = 0.44 * bore_mm;
  const double intake_mm = 10 * std::pow(100 * kSound_m_s / swing_rad_s, 2) * area_cm2(intake_diameter_mm) / behind_cm3;
  if (kExhaustPerIntake * intake_mm > kLongest_mm) return g;  // too slow to be tuned
  g.intake_runner_diameter_mm = intake_diameter_mm;
  g.exhaust_runner_diameter_mm = 0.4 * bore_mm;
  g.intake_runner_mm = intake_mm;
  g.exhaust_runner_mm = kExhaustPerIntake * intake_mm;
  const auto least_cm3 = [&](double length_mm, double diameter_mm) {
    return kRunnerVolumes * length_mm / 10 * area_cm2(diameter_mm);
  };
  g.intake_volume_cm3 = std::max(g.intake_volume_cm3, least_cm3(g.intake_runner_mm, g.intake_runner_diameter_mm));
  g.exhaust_volume_cm3 = std::max(g.exhaust_volume_cm3, least_cm3(g.exhaust_runner_mm, g.exhaust_runner_diameter_mm));
  return g;
}

double cam_nose_factor() noexcept {
  double coefficients[kCamExponents.size()];
  cam_coefficients(kCamExponents.data(), static_cast<int>(kCamExponents.size()), coefficients);
  return -2 * coefficients[0];  // only the exponent 2 has curvature there
}

double clearance_for_speed_mm(double lift_mm, double cam_rad_s, double speed_m_s, double most_mm) noexcept {
  const double slope_per_speed = kCamHalfAngleDeg * kRadPerDeg / (lift_mm / 1e3 * cam_rad_s);
  double slow = 1;     // the lobe's end
  double fast = 0.75;  // its flank
  for (int i = 0; i < 60; ++i) {
    const double u = (slow + fast) / 2;
    (-lobe_at(u).slope < speed_m_s * slope_per_speed ? slow : fast) = u;
  }
  return std::min(lift_mm * std::max(lobe_at(slow).lift, 0.0), most_mm);
}

}  // namespace crankloop::program

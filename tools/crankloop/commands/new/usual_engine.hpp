// Usual values for an engine of a type and size, which `crankloop new` assumes if an option is not given.
//
// What belongs here: figures with their source. What does not: the engine file (new.cpp).
//
// tests/contract/real_engines_test.cpp compares these figures with twelve production engines.
#pragma once

#include <array>

namespace crankloop::program {

enum class EngineType { spark_ignition, diesel, tractor };

struct EngineDesign {
  EngineType type = EngineType::spark_ignition;
  bool four_valves = true;    ///< of a cylinder; else two
  double pressure_ratio = 1;  ///< intake / ambient pressure at full load; 1: naturally aspirated
};

struct Combustion {
  double compression_ratio;
  double start_deg;
  double duration_deg;
  double wiebe_m;
  double compression_exponent;
  double expansion_exponent;
  double exhaust_opens_deg;
};

/// m/s at rated speed. Heywood, Internal Combustion Engine Fundamentals (1988), section 2.2.
[[nodiscard]] double usual_piston_speed_m_s(const EngineDesign& design) noexcept;

/// At that piston speed, to 100 rpm.
[[nodiscard]] double usual_rated_rpm(const EngineDesign& design, double stroke_mm) noexcept;

[[nodiscard]] const Combustion& usual_combustion(const EngineDesign& design) noexcept;

/// Net indicated mean effective pressure at full load and rated speed, from published power of production engines and
/// the friction below. Spark-ignition engines that are built to turn faster breathe better: 900 kPa + 25 kPa s/m times
/// their mean piston speed. Diesels have 900 kPa. With two valves: 0.87 and 0.93 of that. Proportional to the pressure
/// ratio.
[[nodiscard]] double usual_net_mep_kPa(const EngineDesign& design, double piston_speed_m_s) noexcept;

/// Coefficients of friction as an engine file has them.
struct Friction {
  double constant_kPa;
  double linear_kPa_per_1000rpm;
  double quadratic_kPa_per_1000rpm2;

  [[nodiscard]] double at_kPa(double krpm) const noexcept {
    return constant_kPa + krpm * (linear_kPa_per_1000rpm + krpm * quadratic_kPa_per_1000rpm2);
  }
};

/// Chen and Flynn, SAE 650733: by peak pressure and mean piston speed c_m, without pumping,
///     40 kPa + 0.005 p_max + 9 kPa s/m c_m + 0.09 kPa s^2/m^2 c_m^2.
/// Their own coefficients, of one diesel of 1965, are 14 kPa, 0.005, 16 kPa s/m and 0; these are usual in engine
/// simulation since.
[[nodiscard]] Friction usual_friction(double peak_pressure_kPa, double stroke_mm) noexcept;

/// For one cylinder, proportional to bore cubed. Pistons alone have 0.40 to 0.60 g/cm^3 in spark-ignition engines and
/// 0.8 to 1.1 in diesels (MAHLE, Pistons and Engine Testing, 2nd ed., main dimensions of light-alloy pistons); rings
/// and pin add 0.3 to 0.5 of that.
[[nodiscard]] double usual_piston_g(const EngineDesign& design, double bore_mm) noexcept;
[[nodiscard]] double usual_rod_g(const EngineDesign& design, double bore_mm) noexcept;
inline constexpr double kRodShareAtPin = 0.27;  ///< of its mass that moves with the piston

/// Crankshaft with flywheel, by displacement: 0.05 kg m^2 in a litre with spark ignition (0.075 to 0.13 kg m^2 of 1.0
/// to 2.7 L, US EPA's ALPHA engine maps), 0.12 in diesels (0.41 + 0.27 per litre above 5 L, European Commission's
/// VECTO), times displacement to the power of 4/3.
[[nodiscard]] double usual_inertia_kg_m2(const EngineDesign& design, double displacement_L) noexcept;

/// A cam on a bucket tappet, ramps included in the lobe: six conditions at the lobe's end make the lift grow there with
/// the sixth power of the angle. 1 mm of 8.5 lasts 240 crank degrees.
inline constexpr std::array<double, 6> kCamExponents{2, 6, 10, 14, 18, 22};
inline constexpr double kCamHalfAngleDeg = 90;

[[nodiscard]] double usual_lift_mm(const EngineDesign& design, double bore_mm) noexcept;
/// An intake valve with its bucket.
[[nodiscard]] double usual_valve_g(const EngineDesign& design, double bore_mm) noexcept;

/// Valve seats, 0.93 of the valve heads of Heywood (1988), section 6.3: in bores 0.36 and 0.30 of four valves, 0.44 and
/// 0.36 of two.
struct Seats {
  double intake_mm;
  double exhaust_mm;
};
[[nodiscard]] Seats usual_seats(const EngineDesign& design, double bore_mm) noexcept;
[[nodiscard]] double seat_mm2(double seat_mm) noexcept;

/// Preload of production springs, N for a mm^2 of the intake valve's seat: 0.22 to 0.41, 0.29 in the mean of six
/// engines' service manuals (tests/contract/real_engines_test.cpp); four of them have 0.33 to 0.46 of the force at
/// full lift.
inline constexpr double kPreload_N_mm2 = 0.3;

/// y'' of the cam at full lift, in lift / half angle squared.
[[nodiscard]] double cam_nose_factor() noexcept;

/// Gas exchange. Throttle and outlet by the mean speed of the charge through their effective areas at rated speed; a
/// diesel has its air filter and duct in place of a throttle. Intake runners of spark-ignition engines swing at 2.1
/// times the rotation frequency (H. W. Engelman, ASME 73-WA/DGP-2) at 0.8 of the rated speed, with half the
/// displacement and the clearance volume behind them; those of the exhaust are 1.4 times as long.
struct GasExchange {
  double intake_volume_cm3;  ///< by the displacement, and five volumes of a runner or more
  double exhaust_volume_cm3;
  double throttle_mm2;
  double throttle_closed_mm2;
  double outlet_mm2;
  double intake_runner_mm;  ///< 0: none, of diesels and of engines too slow to be tuned
  double intake_runner_diameter_mm;
  double exhaust_runner_mm;
  double exhaust_runner_diameter_mm;
  double exhaust_full_lift_deg;  ///< of the train
  double wall_C;
  double blow_by_mm2;  ///< a sound ring pack, proportional to the bore
};
inline constexpr double kThrottleSpeed_m_s = 60;
inline constexpr double kDuctSpeed_m_s = 25;
inline constexpr double kOutletPerInlet = 0.9;     ///< effective areas
inline constexpr double kManifoldVolumes = 1.5;    ///< by the displacement
inline constexpr double kCreviceShare = 0.015;     ///< 0.01 to 0.02 of the clearance volume
inline constexpr double kDieselEfficiency = 0.43;  ///< net work over the fuel's heat, at full load

/// Of one cylinder, in mm and cm^3.
struct CylinderSize {
  double bore_mm;
  double displacement_cm3;
  double clearance_cm3;
};
[[nodiscard]] GasExchange usual_gas_exchange(const EngineDesign& design, const CylinderSize& size, int cylinders,
                                             double rated_rpm) noexcept;

/// Lift at which the cam ends with this speed; at most `most_mm`. The cam turns at cam_rad_s.
[[nodiscard]] double clearance_for_speed_mm(double lift_mm, double cam_rad_s, double speed_m_s,
                                            double most_mm) noexcept;

}  // namespace crankloop::program

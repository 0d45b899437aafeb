// The list of the engine file's sections and keys: a new key is a line here.
//
// What belongs here: sections, keys, their units. What does not: what a key's entries mean (engine_file_keys.hpp),
// look-up and checks of the list (engine_file_keys.cpp, which alone includes it).
#pragma once

#include <crankloop/variable.hpp>

#include "engine_file_keys.hpp"

namespace crankloop::program::list {

constexpr Unit kNoUnit{};
constexpr Unit kDeg{"deg"};  // angles stay in degrees: core takes them so, because 120 deg has no exact radian
constexpr Unit kDegPerS{"deg_per_s"};
constexpr Unit kS{"s"};
constexpr Unit kUs{"us", 1, 1e6};
constexpr Unit kHz{"Hz"};
constexpr Unit kV{"V"};
constexpr Unit kVS{"V_s"};
constexpr Unit kRpm{"rpm"};
constexpr Unit kMm{"mm", 1, 1e3};
constexpr Unit kUm{"um", 1, 1e6};
constexpr Unit kMm2{"mm2", 1, 1e6};
constexpr Unit kCm3{"cm3", 1, 1e6};
constexpr Unit kG{"g", 1, 1e3};
constexpr Unit kMg{"mg", 1, 1e6};
constexpr Unit kMJPerKg{"MJ_per_kg", 1e6, 1};
constexpr Unit kCelsius{"C"};  // core takes kelvins: engine_file_gas.cpp
constexpr Unit kKelvin{"K"};
constexpr Unit kJPerK{"J_per_K"};
constexpr Unit kWPerK{"W_per_K"};
constexpr Unit kKgM2{"kg_m2"};
constexpr Unit kKgMm2{"kg_mm2", 1, 1e6};
constexpr Unit kKPa{"kPa", 1e3, 1};
constexpr Unit kMPa{"MPa", 1e6, 1};
constexpr Unit kGPa{"GPa", 1e9, 1};
constexpr Unit kJ{"J"};
constexpr Unit kN{"N"};
constexpr Unit kNPerMm{"N_per_mm", 1e3, 1};
constexpr Unit kNm{"Nm"};

using detail::kRadSPer1000Rpm;
constexpr Unit kRpmAsRadS{"rpm", 1, 1e3 / kRadSPer1000Rpm};  // core takes these speeds in rad/s
constexpr Unit kKPaPerSpeed{"kPa_per_1000rpm", 1, kRadSPer1000Rpm / 1e3};
constexpr Unit kKPaPerSpeed2{"kPa_per_1000rpm2", 1, kRadSPer1000Rpm* kRadSPer1000Rpm / 1e3};
constexpr Unit kNmPerSpeed{"Nm_per_1000rpm", 1, kRadSPer1000Rpm};
constexpr Unit kNmPerSpeed2{"Nm_per_1000rpm2", 1, kRadSPer1000Rpm* kRadSPer1000Rpm};

constexpr Range kAny{};
constexpr Range kOfField{};  // the one that core lists, in the key's unit
constexpr Presence required = Presence::required;
constexpr Presence optional = Presence::optional;
constexpr Presence defaults = Presence::with_default;

constexpr const char* kWiebe = "source=wiebe";
constexpr const char* kTables = "source=angle_table|volume_table";
constexpr const char* kByCharge = "burn_by=charge";
constexpr const char* kPolynomial = "source=polynomial";
constexpr const char* kCamTable = "source=table";

inline constexpr SectionKind kSections[] = {
    {"engine", false, "name and rated speed"},
    {"crank", false, "geometry of the crank mechanism; all cylinders are alike"},
    {"masses", false, "moving masses of one cylinder, and the crankshaft"},
    {"layout", false, "cylinders around and along the crankshaft; absent: one cylinder"},
    {"pressure", false, "source of the cylinder pressure; absent: source = none"},
    {"gas", false, "manifolds, walls and combustion of an engine with gas exchange ([pressure] source = gas)"},
    {"friction", false, "mean effective pressure of friction; absent: none"},
    {"machine", false, "the driven machine, a passive brake on the crankshaft; absent: none"},
    {"starter", false, "as seen from the crankshaft; absent: none"},
    {"cam", true, "a cam, by the lift of a flat follower"},
    {"material", true, "of cam and follower of the same NAME, for their contact; absent: steel"},
    {"rocker", true, "what carries the cam's lift to the valve of the same NAME"},
    {"valve", true, "the valve of the same NAME, for its dynamics"},
    {"trigger", true, "a trigger wheel: what a crank or cam sensor sees"},
    {"misfire", true, "which cycles of cylinder NAME (1, 2, ...) misfire, where forces turn the crank: a test pattern"},
    {"fault", true,
     "what is wrong with a trigger wheel, its sensor or its wire, and when; where forces turn the crank"},
    {"reluctor", false, "a variable reluctance sensor at a trigger wheel, and its comparator; absent: none"},
    {"sensor_fault", true,
     "what a controller reads of a sensor, and when; where forces turn the crank of an engine that breathes"},
    {"lambda_sensor", false, "a lambda sensor in the exhaust pipe ([pressure] source = gas); absent: none"},
    {"counterweight", true, "a mass on the crankshaft, for `balance` and reports; no part of the tick"},
    {"balance_shaft", true,
     "an unbalanced shaft that the crankshaft drives, for `balance` and reports; no part of the tick"},
};

// clang-format off
inline constexpr Key kRows[] = {
    {"engine", "name", Kind::text, kNoUnit, "", kAny, "", required, "", "", "", "name of the engine in reports; free text"},
    {"engine", "rated_rpm", Kind::number, kRpm, "", above(0).up_to(100000), "", required, "", "", "", "rated engine speed"},
    {"engine", "max_rpm", Kind::number, kRpmAsRadS, "", above(0).up_to(100000), "", optional, "", "", "", "the highest speed the engine can have; a faster input counts as bad and is replaced. Without it the tick's length alone limits the speed"},

    {"crank", "bore_mm", Kind::number, kMm, "crank.bore_m", kOfField, "", required, "", "", "", "bore"},
    {"crank", "stroke_mm", Kind::number, kMm, "", above(0).up_to(4000), "", required, "", "", "", "2 r; with a pin offset the true stroke is longer"},
    {"crank", "rod_length_mm", Kind::number, kMm, "crank.rod_length_m", kOfField, "", required, "", "", "", "l, pin to pin"},
    {"crank", "rod_ratio", Kind::number, kNoUnit, "", above(0).below(1), "", optional, "", "", "", "lambda; sets l = r / lambda where a source rounds it, within 0.1 % of rod_length_mm", "0.2 to 0.35"},
    {"crank", "pin_offset_mm", Kind::number, kMm, "crank.pin_offset_m", kOfField, "", defaults, "0", "", "", "e; above 0: the axis lies on the side to which the pin moves after TDC"},
    {"crank", "compression_ratio", Kind::number, kNoUnit, "crank.compression_ratio", kOfField, "", required, "", "", "", "(clearance + displacement) / clearance volume", "8 to 12 with spark ignition, 14 to 22 in diesels"},

    {"masses", "piston_g", Kind::number, kG, "masses.piston_kg", kOfField, "", required, "", "", "", "piston with rings and pin"},
    {"masses", "rod_small_end_g", Kind::number, kG, "masses.rod_small_end_kg", kOfField, "", required, "", "", "rod:two ends", "rod's share that moves with the piston"},
    {"masses", "rod_big_end_g", Kind::number, kG, "masses.rod_big_end_kg", kOfField, "", required, "", "", "rod:two ends", "rod's share that turns with the crank pin"},
    {"masses", "rod_g", Kind::number, kG, "", from(0).up_to(5e6), "", required, "", "", "rod:whole rod", "whole rod, instead of its two ends"},
    {"masses", "rod_com_to_crank_mm", Kind::number, kMm, "", from(0).up_to(10000), "", required, "", "", "rod:whole rod", "rod's centre of mass from the crank pin"},
    {"masses", "rod_inertia_kg_mm2", Kind::number, kKgMm2, "", from(0).up_to(1e11), "", optional, "", "", "rod:whole rod", "about the centre of mass; absent: two-mass rod (0 is a value, not absence)"},
    {"masses", "crank_pin_equivalent_g", Kind::number, kG, "masses.crank_pin_equivalent_kg", kOfField, "", defaults, "0", "", "throw:reduced", "m_k, pin and webs reduced to the crank radius"},
    {"masses", "crank_pin_g", Kind::number, kG, "", from(0).up_to(5e6), "", required, "", "", "throw:pin and webs", "crank pin between its webs, instead of m_k"},
    {"masses", "crank_web_g", Kind::number, kG, "", from(0).up_to(5e6), "", required, "", "", "throw:pin and webs", "one of the two webs"},
    {"masses", "crank_web_radius_mm", Kind::number, kMm, "", from(0).up_to(2000), "", required, "", "", "throw:pin and webs", "a web's centre of mass from the crankshaft's axis, toward the pin"},
    {"masses", "crank_inertia_kg_m2", Kind::number, kKgM2, "masses.crank_inertia_kg_m2", kOfField, "", required, "", "", "", "whole crankshaft with flywheel"},

    {"layout", "cylinders", Kind::whole_number, kNoUnit, "layout.cylinders", kOfField, "", defaults, "1", "", "", "number of cylinders"},
    {"layout", "firing_order", Kind::firing_order, kNoUnit, "", kAny, "", optional, "", "", "firing:order", "even firing over 720 deg"},
    {"layout", "firing_angles_deg", Kind::numbers, kDeg, "", from(0).below(720), "", optional, "", "", "firing:angles", "engine angle of each cylinder's firing TDC; the first is 0"},
    {"layout", "bank_angles_deg", Kind::numbers, kDeg, "", from(-360).up_to(360), "", optional, "", "", "", "cylinder axis from the vertical, in the sense of rotation; absent: all 0"},
    {"layout", "cylinder_spacing_mm", Kind::number, kMm, "", above(0).up_to(5000), "", optional, "", "", "place:spacing", "from cylinder to cylinder, from pin to pin where shared_pins is given; absent: 1.2 bore"},
    {"layout", "cylinder_positions_mm", Kind::numbers, kMm, "", from(-100000).up_to(100000), "", optional, "", "", "place:positions", "along the crankshaft, per cylinder"},
    {"layout", "crank_throws_deg", Kind::numbers, kDeg, "", from(-720).up_to(720), "", optional, "", "", "", "direction of each throw at engine angle 0; must agree with bank - firing angle"},
    {"layout", "shared_pins", Kind::pin_groups, kNoUnit, "", kAny, "", optional, "", "", "", "cylinders on one crank pin; absent: those with equal position and throw"},

    {"pressure", "source", Kind::choice, kNoUnit, "", kAny, "wiebe|angle_table|volume_table|gas|none", required, "", "", "", "source of the diagram"},
    {"pressure", "crankcase_kPa", Kind::number, kKPa, "pressure.crankcase_Pa", kOfField, "", defaults, "100", "", "", "on the piston's other side"},
    {"pressure", "intake_kPa", Kind::number, kKPa, "pressure.wiebe.intake_Pa", kOfField, "", defaults, "98", kWiebe, "", "intake plenum"},
    {"pressure", "exhaust_kPa", Kind::number, kKPa, "pressure.wiebe.exhaust_Pa", kOfField, "", defaults, "105", kWiebe, "", "exhaust back pressure"},
    {"pressure", "start_of_combustion_deg", Kind::number, kDeg, "pressure.wiebe.start_of_combustion_deg", kOfField, "", defaults, "-6", kWiebe, "", "crank angle, firing TDC = 0", "-25 to 0"},
    {"pressure", "combustion_duration_deg", Kind::number, kDeg, "pressure.wiebe.combustion_duration_deg", kOfField, "", defaults, "60", kWiebe, "", "must end before the exhaust valve opens", "40 to 80"},
    {"pressure", "wiebe_m", Kind::number, kNoUnit, "pressure.wiebe.wiebe_m", kOfField, "", defaults, "0.9", kWiebe, "", "form exponent of the heat release", "0.7 to 3"},
    {"pressure", "compression_exponent", Kind::number, kNoUnit, "pressure.wiebe.compression_exponent", kOfField, "", defaults, "1.35", kWiebe, "", "n1, polytropic", "1.3 to 1.4"},
    {"pressure", "expansion_exponent", Kind::number, kNoUnit, "pressure.wiebe.expansion_exponent", kOfField, "", defaults, "1.28", kWiebe, "", "n2, polytropic", "1.25 to 1.35"},
    {"pressure", "motored_expansion_exponent", Kind::number, kNoUnit, "pressure.wiebe.motored_expansion_exponent", kOfField, "", defaults, "0", kWiebe, "", "of a cylinder that does not fire, at least n1; 0: n1 + 0.03"},
    {"pressure", "exhaust_valve_opens_deg", Kind::number, kDeg, "pressure.wiebe.exhaust_valve_opens_deg", kOfField, "", defaults, "135", kWiebe, "", "crank angle, firing TDC = 0", "110 to 145"},
    {"pressure", "net_mep_kPa", Kind::number, kKPa, "pressure.wiebe.net_mep_Pa", kOfField, "", required, "", kWiebe, "heat:net IMEP", "net IMEP over 720 deg, at least the motored one; heat is scaled to meet it"},
    {"pressure", "heat_J", Kind::number, kJ, "pressure.wiebe.heat_J", kOfField, "", required, "", kWiebe, "heat:heat", "heat per cylinder and cycle, instead of net_mep_kPa; 0: motored"},
    {"pressure", "file", Kind::path, kNoUnit, "", kAny, "", required, "", kTables, "", "CSV with header crank_deg,pressure_kPa or volume_cm3,pressure_kPa; relative to the engine file"},

    {"gas", "intake_volume_cm3", Kind::number, kCm3, "gas.intake_m3", kOfField, "", defaults, "3000", "", "", "of the intake manifold"},
    {"gas", "exhaust_volume_cm3", Kind::number, kCm3, "gas.exhaust_m3", kOfField, "", defaults, "2500", "", "", "of the exhaust manifold"},
    {"gas", "throttle_mm2", Kind::number, kMm2, "gas.throttle_m2", kOfField, "", defaults, "1600", "", "", "effective area of the throttle, wide open"},
    {"gas", "throttle_closed_mm2", Kind::number, kMm2, "gas.throttle_closed_m2", kOfField, "", defaults, "12", "", "", "effective area, closed; at most the open one"},
    {"gas", "throttle_curve", Kind::pairs, kNoUnit, "", from(0).up_to(1), "", defaults, "0:0,0.2:0.06,0.5:0.3,1:1", "", "", "share of the area between closed and open, by the throttle ratio 0 to 1; straight lines"},
    {"gas", "outlet_mm2", Kind::number, kMm2, "gas.outlet_m2", kOfField, "", defaults, "1200", "", "", "effective area of the exhaust system, as one orifice"},
    {"gas", "ambient_kPa", Kind::number, kKPa, "gas.ambient_Pa", kOfField, "", defaults, "100", "", "", "absolute, before the throttle"},
    {"gas", "back_kPa", Kind::number, kKPa, "gas.back_Pa", kOfField, "", defaults, "0", "", "", "absolute, behind the outlet; 0: as ambient_kPa"},
    {"gas", "ambient_C", Kind::number, kCelsius, "", from(-123.15).up_to(2726.85), "", defaults, "25", "", "", "of the air before the throttle"},
    {"gas", "exhaust_C", Kind::number, kCelsius, "", from(-123.15).up_to(2726.85), "", defaults, "500", "", "", "initial value for a scene whose exhaust manifold is given"},
    {"gas", "wall_C", Kind::number, kCelsius, "", from(-123.15).up_to(1726.85), "", defaults, "150", "", "", "mean temperature of the cylinder's walls"},
    {"gas", "wall_heat_factor", Kind::number, kNoUnit, "gas.wall_heat_ratio", kOfField, "", defaults, "1", "", "", "k_w, of Hohenberg's heat transfer; 0: adiabatic"},
    {"gas", "wall_J_per_K", Kind::number, kJPerK, "walls.capacity_J_K", from(0).up_to(1e6), "", defaults, "0", "", "", "heat capacity of each cylinder's walls, 1 and above, which start at wall_C; 0: they stay there", "500 to 3000"},
    {"gas", "wall_W_per_K", Kind::number, kWPerK, "walls.to_coolant_W_K", kOfField, "", defaults, "20", "", "", "of them to the coolant, with wall_J_per_K", "10 to 50"},
    {"gas", "coolant_C", Kind::number, kCelsius, "", from(-123.15).up_to(1726.85), "", defaults, "90", "", "", "temperature of the coolant, with wall_J_per_K"},
    {"gas", "intake_W_per_K", Kind::number, kWPerK, "walls.intake_W_K", kOfField, "", defaults, "0", "", "", "of the gas in the intake manifold to its walls, with runners at each port instead; 0: adiabatic", "1 to 3"},
    {"gas", "exhaust_W_per_K", Kind::number, kWPerK, "walls.exhaust_W_K", kOfField, "", defaults, "0", "", "", "of the gas in the exhaust manifold to its walls, with runners at each port instead; 0: adiabatic", "3 to 15"},
    {"gas", "manifold_C", Kind::number, kCelsius, "", from(-123.15).up_to(2726.85), "", optional, "", "", "", "temperature behind the walls of manifolds and runners; absent: ambient_C"},
    {"gas", "crevice_share", Kind::number, kNoUnit, "crevice.volume_ratio", kOfField, "", defaults, "0", "", "", "crevices (top land, ring pack, gasket, plug) by the clearance volume; 0: none", "0.01 to 0.02"},
    {"gas", "blow_by_mm2", Kind::number, kMm2, "crevice.blow_by_m2", kOfField, "", defaults, "0", "", "", "effective area of the leak past the rings into the crankcase; 0: tight", "0.03 to 0.15; worn 0.3"},
    {"gas", "intake_runner_mm", Kind::number, kMm, "", from(0).up_to(3000), "", optional, "", "", "", "length of the pipe from the intake manifold to each cylinder's port; 20 or more; 0 or absent: no inertia of its gas", "250 to 600"},
    {"gas", "intake_runner_diameter_mm", Kind::number, kMm, "", from(5).up_to(200), "", optional, "", "", "", "inner diameter of that pipe; needed with intake_runner_mm"},
    {"gas", "intake_runner_loss", Kind::number, kNoUnit, "", from(0).up_to(10), "", optional, "", "", "", "zeta, pressure lost over dynamic pressure: entrance 0.05 to 0.5, bends 0.2 each, 0.02 l/d; absent: 0.5"},
    {"gas", "exhaust_runner_mm", Kind::number, kMm, "", from(0).up_to(3000), "", optional, "", "", "", "length of the pipe from each cylinder's port to the exhaust manifold; 20 or more; 0 or absent: no inertia of its gas", "300 to 900"},
    {"gas", "exhaust_runner_diameter_mm", Kind::number, kMm, "", from(5).up_to(200), "", optional, "", "", "", "inner diameter of that pipe; needed with exhaust_runner_mm"},
    {"gas", "exhaust_runner_loss", Kind::number, kNoUnit, "", from(0).up_to(10), "", optional, "", "", "", "zeta, pressure lost over dynamic pressure: entrance 0.05 to 0.5, bends 0.2 each, 0.02 l/d; absent: 0.5"},
    {"gas", "fuel_mg", Kind::number, kMg, "gas.fuel_kg", kOfField, "", defaults, "30", "", "fuel:amount", "fuel per cylinder and cycle; 0: motored"},
    {"gas", "excess_air_ratio", Kind::number, kNoUnit, "gas.excess_air_ratio", above(0).up_to(100), "", optional, "", "", "fuel:lambda", "lambda: fuel by the air in each cylinder"},
    {"gas", "heating_value_MJ_per_kg", Kind::number, kMJPerKg, "gas.heating_value_J_kg", kOfField, "", defaults, "43", "", "", "lower"},
    {"gas", "combustion_efficiency", Kind::number, kNoUnit, "gas.combustion_efficiency", kOfField, "", defaults, "0.97", "", "", "share of the fuel's heat that is released"},
    {"gas", "air_fuel_ratio", Kind::number, kNoUnit, "gas.air_fuel_ratio", kOfField, "", defaults, "14.6", "", "", "stoichiometric, by mass"},
    {"gas", "burn_start_deg", Kind::number, kDeg, "gas.burn_start_deg", kOfField, "", defaults, "-18", "", "", "crank angle, firing TDC = 0"},
    {"gas", "burn_duration_deg", Kind::number, kDeg, "gas.burn_duration_deg", kOfField, "", defaults, "50", "", "", "must end by 150 deg"},
    {"gas", "burn_by", Kind::choice, kNoUnit, "", kAny, "order|charge", defaults, "order", "", "", "charge: the duration of a burn follows from speed, pressure, temperature, lambda and residual gas, and burn_start_deg is the spark"},
    {"gas", "spark_to_start_deg", Kind::number, kDeg, "charge_burn.spark_to_start_deg", kOfField, "", defaults, "0", kByCharge, "", "from the spark to the burn's start, in the state of reference"},
    {"gas", "burn_reference_rpm", Kind::number, kRpmAsRadS, "charge_burn.reference_rad_s", from(10).up_to(1e5), "", defaults, "2000", kByCharge, "", "state of reference, in which the burn lasts burn_duration_deg: speed"},
    {"gas", "burn_reference_K", Kind::number, kKelvin, "charge_burn.reference_K", kOfField, "", defaults, "650", kByCharge, "", "its temperature in the cylinder, where the burn starts"},
    {"gas", "burn_reference_kPa", Kind::number, kKPa, "charge_burn.reference_Pa", kOfField, "", defaults, "1300", kByCharge, "", "its absolute pressure there"},
    {"gas", "burn_reference_residual", Kind::number, kNoUnit, "charge_burn.reference_burned_ratio", kOfField, "", defaults, "0.05", kByCharge, "", "burned share of its gas"},
    {"gas", "burn_reference_lambda", Kind::number, kNoUnit, "charge_burn.reference_excess_air_ratio", kOfField, "", defaults, "1", kByCharge, "", "its excess-air ratio"},
    {"gas", "octane", Kind::number, kNoUnit, "gas.octane_number", from(0).up_to(120), "", defaults, "0", "", "", "octane number of the fuel, 60 to 120, for the knock integral of each cycle; 0: none", "91 to 98"},
    {"gas", "wiebe_m", Kind::number, kNoUnit, "gas.wiebe_m", kOfField, "", defaults, "2", "", "", "form exponent of the heat release"},
    {"gas", "second_share", Kind::number, kNoUnit, "gas.second_ratio", kOfField, "", defaults, "0", "", "", "share of the fuel that burns by a second law from the same start (diesel)"},
    {"gas", "second_m", Kind::number, kNoUnit, "gas.second_m", kOfField, "", defaults, "1", "", "", "its form exponent"},
    {"gas", "second_duration_ratio", Kind::number, kNoUnit, "gas.second_duration_ratio", kOfField, "", defaults, "3", "", "", "its duration by that of the first"},

    {"friction", "constant_kPa", Kind::number, kKPa, "friction.constant_Pa", kOfField, "", defaults, "0", "", "", "at any speed; holds at standstill"},
    {"friction", "linear_kPa_per_1000rpm", Kind::number, kKPaPerSpeed, "friction.linear_Pa_s", from(0).up_to(1e5), "", defaults, "0", "", "", "times the speed in 1000 rpm"},
    {"friction", "quadratic_kPa_per_1000rpm2", Kind::number, kKPaPerSpeed2, "friction.quadratic_Pa_s2", from(0).up_to(1e7), "", defaults, "0", "", "", "times its square"},

    {"machine", "constant_Nm", Kind::number, kNm, "machine.constant_Nm", kOfField, "", defaults, "0", "", "", "at any speed; holds at standstill"},
    {"machine", "linear_Nm_per_1000rpm", Kind::number, kNmPerSpeed, "machine.linear_Nm_s", from(0).up_to(1e8), "", defaults, "0", "", "", "times the speed in 1000 rpm"},
    {"machine", "quadratic_Nm_per_1000rpm2", Kind::number, kNmPerSpeed2, "machine.quadratic_Nm_s2", from(0).up_to(1e10), "", defaults, "0", "", "", "times its square: fan, propeller, water brake"},
    {"machine", "inertia_kg_m2", Kind::number, kKgM2, "machine.inertia_kg_m2", kOfField, "", defaults, "0", "", "", "turns with the crankshaft"},

    {"starter", "stall_Nm", Kind::number, kNm, "starter.stall_Nm", kOfField, "", defaults, "0", "", "", "torque at standstill; 0: no starter"},
    {"starter", "no_load_rpm", Kind::number, kRpmAsRadS, "starter.no_load_rad_s", from(0).up_to(95000), "", defaults, "0", "", "", "crank speed at which it gives none; above 0 where there is a starter"},

    {"cam", "source", Kind::choice, kNoUnit, "", kAny, "polynomial|table", required, "", "", "", "source of the lift"},
    {"cam", "max_lift_mm", Kind::number, kMm, "cam.max_lift_m", kOfField, "", required, "", kPolynomial, "", "largest lift of the flat follower"},
    {"cam", "half_angle_deg", Kind::number, kDeg, "cam.half_angle_deg", kOfField, "", required, "", kPolynomial, "", "from the start of the lobe to full lift, cam angle"},
    {"cam", "exponents", Kind::numbers, kNoUnit, "", from(2).up_to(100), "", required, "", kPolynomial, "", "rising; coefficients from y = y' = ... = 0 at the lobe's end"},
    {"cam", "full_lift_at_crank_deg", Kind::number, kDeg, "", from(-720).up_to(720), "", required, "", "", "", "engine angle of full theoretical lift in cylinder 1's cycle"},
    {"cam", "phase_rate_deg_per_s", Kind::number, kDegPerS, "cam.phase_rate_deg_s", kOfField, "", defaults, "0", "", "", "cam phaser's rate limit in crank degrees; 0: fixed cam"},
    {"cam", "file", Kind::path, kNoUnit, "", kAny, "", required, "", kCamTable, "", "CSV with header cam_deg,lift_mm; relative to the engine file"},
    {"cam", "smoothing_um", Kind::number, kUm, "cam.smoothing_m", kOfField, "auto", required, "", kCamTable, "", "largest residual that smoothing may leave; auto: by the scatter of the rows"},
    {"cam", "width_mm", Kind::number, kMm, "cam.width_m", above(0).up_to(1000), "", optional, "", "", "", "b, width of the contact with its follower, for stress"},
    {"cam", "friction_ratio", Kind::number, kNoUnit, "cam.friction_ratio", kOfField, "", optional, "", "", "", "mu between cam and follower, at any speed; absent: none", "0.03 to 0.12"},
    {"cam", "limit_MPa", Kind::number, kMPa, "", above(0).up_to(1e5), "", optional, "", "", "", "permissible contact stress; commands report where it is exceeded"},

    {"material", "cam_GPa", Kind::number, kGPa, "material.cam_Pa", kOfField, "", defaults, "206", "", "", "Young's modulus of the cam"},
    {"material", "cam_poisson", Kind::number, kNoUnit, "material.cam_poisson_ratio", kOfField, "", defaults, "0.3", "", "", "its Poisson's ratio"},
    {"material", "follower_GPa", Kind::number, kGPa, "material.follower_Pa", kOfField, "", defaults, "206", "", "", "Young's modulus of pad or flat follower"},
    {"material", "follower_poisson", Kind::number, kNoUnit, "material.follower_poisson_ratio", kOfField, "", defaults, "0.3", "", "", "its Poisson's ratio"},

    {"rocker", "ratio", Kind::number, kNoUnit, "rocker.ratio", kOfField, "", required, "", "", "train:constant ratio", "direct (1) or constant-ratio train, instead of the geometry"},
    {"rocker", "pivot_to_pad_mm", Kind::number, kMm, "rocker.pivot_to_pad_m", kOfField, "", required, "", "", "train:geometry", "l_a"},
    {"rocker", "pivot_to_cam_mm", Kind::number, kMm, "rocker.pivot_to_cam_m", kOfField, "", required, "", "", "train:geometry", "l_c"},
    {"rocker", "base_circle_mm", Kind::number, kMm, "rocker.base_circle_m", kOfField, "", required, "", "", "", "r_0, radius"},
    {"rocker", "pad_radius_mm", Kind::number, kMm, "rocker.pad_radius_m", kOfField, "", required, "", "", "train:geometry", "r_s"},
    {"rocker", "pivot_to_screw_mm", Kind::number, kMm, "rocker.pivot_to_screw_m", kOfField, "", required, "", "", "train:geometry", "l_b"},
    {"rocker", "screw_ball_mm", Kind::number, kMm, "rocker.screw_ball_m", kOfField, "", required, "", "", "train:geometry", "rho, radius"},
    {"rocker", "stem_above_pivot_mm", Kind::number, kMm, "rocker.stem_above_pivot_m", kOfField, "", required, "", "", "train:geometry", "z"},
    {"rocker", "clearance_mm", Kind::number, kMm, "rocker.clearance_m", kOfField, "", required, "", "", "", "at base circle; a hydraulic adjuster has 0"},
    {"rocker", "cam_turns", Kind::choice, kNoUnit, "", kAny, "toward_pivot|away_from_pivot", required, "", "", "train:geometry", "sense of the cam's rotation"},

    {"valve", "per_cylinder", Kind::whole_number, kNoUnit, "valve.per_cylinder", from(1).up_to(8), "", required, "", "", "", "how many of them a cylinder has"},
    {"valve", "valve_g", Kind::number, kG, "valve.valve_kg", kOfField, "", required, "", "", "", "valve, retainer, collets"},
    {"valve", "spring_g", Kind::number, kG, "valve.spring_kg", kOfField, "", required, "", "", "", "spring; a third of it moves"},
    {"valve", "rocker_inertia_kg_mm2", Kind::number, kKgMm2, "valve.rocker_inertia_kg_m2", kOfField, "", required, "", "", "", "about the pivot"},
    {"valve", "spring_N_per_mm", Kind::number, kNPerMm, "valve.spring_N_m", kOfField, "", required, "", "", "", "spring rate"},
    {"valve", "spring_preload_N", Kind::number, kN, "valve.spring_preload_N", kOfField, "", required, "", "", "", "spring force on the closed valve"},
    {"valve", "train_N_per_mm", Kind::number, kNPerMm, "valve.train_N_m", kOfField, "", required, "", "", "", "stiffness from rocker to camshaft"},
    {"valve", "train_damping_ratio", Kind::number, kNoUnit, "valve.train_damping_ratio", kOfField, "", required, "", "", "", "b = 2 zeta sqrt(k M)"},
    {"valve", "guide_damping_ratio", Kind::number, kNoUnit, "valve.guide_damping_ratio", kOfField, "", required, "", "", "", "c = 2 zeta sqrt(k M)"},
    {"valve", "seat_N_per_mm", Kind::number, kNPerMm, "valve.seat_N_m", kOfField, "", required, "", "", "", "stiffness of the seat"},
    {"valve", "seat_damping_ratio", Kind::number, kNoUnit, "valve.seat_damping_ratio", kOfField, "", required, "", "", "", "b_z = 2 zeta sqrt(k_z M)"},
    {"valve", "head_area_mm2", Kind::number, kMm2, "valve.head_area_m2", kOfField, "", defaults, "0", "", "", "gas force on the valve head; 0: none"},
    {"valve", "surge_modes", Kind::whole_number, kNoUnit, "valve.surge_modes", from(0).up_to(3), "", optional, "", "", "", "surge modes of each spring; absent: 0, the spring follows its valve"},
    {"valve", "surge_damping_ratio", Kind::number, kNoUnit, "valve.surge_damping_ratio", kOfField, "", optional, "", "", "", "of each mode; absent: 0.01"},
    {"valve", "spring_active_g", Kind::number, kG, "valve.spring_active_kg", kOfField, "", optional, "", "", "", "share of spring_g in the active coils of the (outer) spring; absent: all but the inner one's"},
    {"valve", "inner_spring_N_per_mm", Kind::number, kNPerMm, "valve.inner_spring_N_m", kOfField, "", optional, "", "", "", "share of spring_N_per_mm in the inner of two nested springs; absent: one spring"},
    {"valve", "inner_spring_g", Kind::number, kG, "valve.inner_spring_kg", kOfField, "", optional, "", "", "", "share of spring_g in the inner spring's active coils"},
    {"valve", "wire_mm", Kind::number, kMm, "", above(0).up_to(100), "", optional, "", "", "", "d, diameter of the spring's wire, for its stress"},
    {"valve", "coil_mm", Kind::number, kMm, "", above(0).up_to(1000), "", optional, "", "", "", "D, mean diameter of its coils"},
    {"valve", "active_coils", Kind::number, kNoUnit, "", from(0.5).up_to(100), "", optional, "", "", "", "n, number of active coils"},
    {"valve", "shear_GPa", Kind::number, kGPa, "", above(0).up_to(1000), "", optional, "", "", "", "G, shear modulus of the wire; absent: 79, spring steel"},
    {"valve", "shear_endurance_MPa", Kind::number, kMPa, "", above(0).up_to(1e5), "", optional, "", "", "", "endurance limit: amplitude of alternating shear stress; with the next key gives Goodman's factor"},
    {"valve", "shear_ultimate_MPa", Kind::number, kMPa, "", above(0).up_to(1e5), "", optional, "", "", "", "ultimate shear stress"},
    {"valve", "port", Kind::choice, kNoUnit, "", kAny, "intake|exhaust", optional, "", "", "", "the port that it opens; needed with [pressure] source = gas"},
    {"valve", "seat_diameter_mm", Kind::number, kMm, "gas.seat_diameter_m", kOfField, "", optional, "", "", "", "inner; needed with [pressure] source = gas"},
    {"valve", "head_diameter_mm", Kind::number, kMm, "", above(0).up_to(1000), "", optional, "", "", "", "D_v, outer diameter of the seat, for the flow area; absent: seat_diameter_mm and twice seat_width_mm"},
    {"valve", "seat_width_mm", Kind::number, kMm, "", above(0).up_to(100), "", optional, "", "", "", "s, outer less inner radius of the seat; absent: of the two diameters, or 0.04 of the inner one"},
    {"valve", "seat_angle_deg", Kind::number, kDeg, "", from(1).up_to(89), "", optional, "", "", "", "beta, from the plane of the head; absent: 45"},
    {"valve", "port_diameter_mm", Kind::number, kMm, "", above(0).up_to(1000), "", optional, "", "", "", "D_p, behind the seat; absent: the seat's inner diameter"},
    {"valve", "stem_diameter_mm", Kind::number, kMm, "", from(0).up_to(1000), "", optional, "", "", "", "D_s; absent: 0.2 of the seat's inner diameter"},
    {"valve", "flow_over_lift_ratio", Kind::pairs, kNoUnit, "", from(0).up_to(1), "", optional, "", "", "", "effective area over the seat's, by lift over seat diameter, 0 to 0.5; absent: a usual poppet valve"},

    {"trigger", "on", Kind::text, kNoUnit, "", kAny, "", required, "", "", "", "crank, cam, or cam NAME for one that the phaser of [cam NAME] moves"},
    {"trigger", "pattern", Kind::text, kNoUnit, "", kAny, "", required, "", "", "edges:teeth", "60 or 60-2 (two missing), 36-2-2-2, 36-2-2-2-H6, half-moon, teeth and (missing) in turn, like 13(2)16(2)1(2), or the name of a pair: `crankloop help patterns`"},
    {"trigger", "first_tooth_deg", Kind::number, kDeg, "", from(-720).up_to(720), "", defaults, "0", "", "edges:teeth", "engine angle at which the first tooth's rising edge is at the sensor; N-M: the tooth after the gap"},
    {"trigger", "tooth_ratio", Kind::number, kNoUnit, "", from(0.01).up_to(0.99), "", defaults, "0.5", "", "edges:teeth", "width of a tooth per distance from tooth to tooth"},
    {"trigger", "edges_deg", Kind::numbers, kDeg, "", from(0).up_to(1440), "", required, "", "", "edges:list", "instead of a pattern: rise, fall, rise, ... by engine angle, within one turn of the shaft (cam: 720 deg)"},
    {"trigger", "inverted", Kind::choice, kNoUnit, "", kAny, "no|yes", defaults, "no", "", "", "whether a tooth pulls the signal down"},

    {"misfire", "every", Kind::whole_number, kNoUnit, "misfire.of", kOfField, "", required, "", "", "rule:every", "the Nth, the 2 Nth, ... cycle misfires"},
    {"misfire", "misses", Kind::whole_number, kNoUnit, "misfire.misfires", kOfField, "", required, "", "", "rule:n of m", "number of misfires, evenly spread"},
    {"misfire", "of_cycles", Kind::whole_number, kNoUnit, "misfire.of", kOfField, "", required, "", "", "rule:n of m", "number of cycles over which they are spread, again and again"},
    {"misfire", "random_ratio", Kind::number, kNoUnit, "misfire.random_ratio", kOfField, "", required, "", "", "rule:random", "each cycle's probability of misfiring"},
    {"misfire", "seed", Kind::whole_number, kNoUnit, "misfire.seed", kOfField, "", defaults, "1", "", "rule:random", "seed of the random numbers; each cylinder draws its own"},
    {"misfire", "burst", Kind::whole_number, kNoUnit, "", from(1).up_to(kMaxMisfirePeriod - 1), "", required, "", "", "rule:burst", "number of misfires in a row"},
    {"misfire", "gap", Kind::whole_number, kNoUnit, "", from(1).up_to(kMaxMisfirePeriod - 1), "", required, "", "", "rule:burst", "cycles that fire before each burst"},
    {"misfire", "cycles", Kind::numbers, kNoUnit, "", from(1).up_to(2147483647), "", required, "", "", "rule:list", "numbers of the cycles that misfire, rising, up to 32; 1 is the first that takes its fuel"},
    {"misfire", "burning_ratio", Kind::number, kNoUnit, "misfire.burning_ratio", kOfField, "", defaults, "0", "", "", "share of its heat that a misfiring cycle releases; 0: none"},

    {"fault", "trigger", Kind::text, kNoUnit, "", kAny, "", required, "", "", "", "NAME of the [trigger NAME] with the fault"},
    {"fault", "start_s", Kind::number, kS, "fault.start_s", kOfField, "", defaults, "0", "", "", "time at which the fault begins, from the start of the run"},
    {"fault", "end_s", Kind::number, kS, "fault.end_s", kOfField, "", defaults, "0", "", "", "time at which it ends; 0: the fault is not switched by time"},
    {"fault", "input_bit", Kind::whole_number, kNoUnit, "fault.input_bit", from(0).below(32), "", optional, "", "", "", "bit of the input wheel_faults that switches the fault on; needed without end_s"},
    {"fault", "missing_tooth", Kind::whole_number, kNoUnit, "fault.missing_tooth", kOfField, "", defaults, "0", "", "", "number of a tooth that is missing, from 1; 0: none"},
    {"fault", "moved_tooth", Kind::whole_number, kNoUnit, "fault.moved_tooth", kOfField, "", defaults, "0", "", "", "number of a tooth that is out of place, from 1; 0: none"},
    {"fault", "moved_deg", Kind::number, kDeg, "fault.moved_deg", kOfField, "", defaults, "0", "", "", "delay of that tooth; negative: early"},
    {"fault", "extra_tooth_deg", Kind::number, kDeg, "fault.extra_tooth_deg", kOfField, "", defaults, "0", "", "", "angle of an extra tooth's rising edge, in crank degrees from the first tooth's"},
    {"fault", "extra_width_deg", Kind::number, kDeg, "fault.extra_width_deg", kOfField, "", defaults, "0", "", "", "width of the extra tooth; 0: none"},
    {"fault", "runout_deg", Kind::number, kDeg, "fault.runout_deg", kOfField, "", defaults, "0", "", "", "r, run-out of the wheel: delays edges by r sin(angle of the wheel - runout_at_deg) crank degrees"},
    {"fault", "runout_at_deg", Kind::number, kDeg, "fault.runout_at_deg", kOfField, "", defaults, "0", "", "", "of the wheel's own turn, from its first rising edge"},
    {"fault", "late_deg", Kind::number, kDeg, "fault.late_deg", kOfField, "", defaults, "0", "", "", "delay of all edges, as by a stretched chain; negative: early"},
    {"fault", "inverted", Kind::choice, kNoUnit, "", kAny, "no|yes", defaults, "no", "", "", "wires swapped"},
    {"fault", "stuck", Kind::choice, kNoUnit, "", kAny, "no|low|high", defaults, "no", "", "", "the signal stays at a level"},
    {"fault", "noise_Hz", Kind::number, kHz, "fault.noise_Hz", kOfField, "", defaults, "0", "", "", "mean rate of random pulses that invert the signal; at most one in a tick"},
    {"fault", "noise_pulse_us", Kind::number, kUs, "fault.noise_pulse_s", from(0).up_to(1000), "", defaults, "0", "", "", "length of these pulses, up to half a tick; above 0 with noise_Hz"},
    {"fault", "noise_seed", Kind::whole_number, kNoUnit, "fault.noise_seed", kOfField, "", defaults, "1", "", "", "seed of their random numbers"},

    {"reluctor", "trigger", Kind::text, kNoUnit, "", kAny, "", required, "", "", "", "NAME of the [trigger NAME] that it senses: a pattern of evenly spaced teeth, on the crank or on a cam without a phaser"},
    {"reluctor", "gain_V_s", Kind::number, kVS, "reluctor.gain_V_s", kOfField, "", required, "", "", "", "peak voltage at a tooth over the wheel's speed"},
    {"reluctor", "reach_ratio", Kind::number, kNoUnit, "reluctor.reach_ratio", kOfField, "", defaults, "0.9", "", "", "where a tooth's lobe ends, relative to the distance from its centre to the middle of the next gap; smaller for a small air gap"},
    {"reluctor", "gap_lobe_ratio", Kind::number, kNoUnit, "reluctor.gap_lobe_ratio", kOfField, "", defaults, "1.4", "", "", "height of the lobes beside missing teeth over that of the others"},
    {"reluctor", "runout_ratio", Kind::number, kNoUnit, "reluctor.runout_ratio", kOfField, "", defaults, "0", "", "", "r, run-out of the wheel: modulates the flux by 1 + r cos(angle of the wheel - runout_at_deg)"},
    {"reluctor", "runout_at_deg", Kind::number, kDeg, "reluctor.runout_at_deg", kOfField, "", defaults, "0", "", "", "of the wheel's own turn, from its first rising edge"},
    {"reluctor", "reversed", Kind::choice, kNoUnit, "", kAny, "no|yes", defaults, "no", "", "", "swapped wires: the voltage has the opposite sign"},
    {"reluctor", "arm_ratio", Kind::number, kNoUnit, "reluctor.arm_ratio", kOfField, "", defaults, "0.3333333333333333", "", "", "the comparator is armed above this share of the last peak"},
    {"reluctor", "least_V", Kind::number, kV, "reluctor.least_V", kOfField, "", defaults, "0.05", "", "", "and above this voltage"},
    {"reluctor", "hysteresis_V", Kind::number, kV, "reluctor.hysteresis_V", kOfField, "", defaults, "0", "", "", "its edge is where the voltage falls below minus this value"},
    {"reluctor", "watchdog_s", Kind::number, kS, "reluctor.watchdog_s", kOfField, "", defaults, "0.085", "", "", "time without an edge after which the last peak is discarded"},
    {"reluctor", "delay_us", Kind::number, kUs, "reluctor.delay_s", kOfField, "", defaults, "0", "", "", "delay of the comparator's edges, at most a tick"},

    {"sensor_fault", "sensor", Kind::choice, kNoUnit, "", kAny, "map|intake_air|tps|lambda|coolant", required, "", "", "", "the sensor with the fault: map in Pa, intake_air and coolant in K, tps, lambda"},
    {"sensor_fault", "start_s", Kind::number, kS, "sensor_fault.start_s", kOfField, "", defaults, "0", "", "", "time at which the fault begins, from the start of the run"},
    {"sensor_fault", "end_s", Kind::number, kS, "sensor_fault.end_s", kOfField, "", defaults, "0", "", "", "time at which it ends; 0: the fault is not switched by time"},
    {"sensor_fault", "input_bit", Kind::whole_number, kNoUnit, "sensor_fault.input_bit", from(0).below(32), "", optional, "", "", "", "bit of the input sensor_faults that switches the fault on; needed without end_s"},
    {"sensor_fault", "wire", Kind::choice, kNoUnit, "", kAny, "good|stuck|open|short", defaults, "good", "", "", "stuck: the value stays as it was; open: reads most; short: reads least"},
    {"sensor_fault", "offset", Kind::number, kNoUnit, "sensor_fault.offset", kOfField, "", defaults, "0", "", "", "added to the value, in the sensor's unit"},
    {"sensor_fault", "noise", Kind::number, kNoUnit, "sensor_fault.noise", kOfField, "", defaults, "0", "", "", "amplitude of random noise, uniform from -noise to noise in each tick, in the sensor's unit"},
    {"sensor_fault", "noise_seed", Kind::whole_number, kNoUnit, "sensor_fault.noise_seed", kOfField, "", defaults, "1", "", "", "seed of its random numbers"},
    {"sensor_fault", "delay_s", Kind::number, kS, "sensor_fault.delay_s", kOfField, "", defaults, "0", "", "", "delay of the value, to 1/32 of it"},
    {"sensor_fault", "lag_s", Kind::number, kS, "sensor_fault.lag_s", kOfField, "", defaults, "0", "", "", "time constant of first order"},
    {"sensor_fault", "least", Kind::number, kNoUnit, "sensor_fault.least", kOfField, "", defaults, "0", "", "", "smallest value that the sensor reads"},
    {"sensor_fault", "most", Kind::number, kNoUnit, "sensor_fault.most", kOfField, "", defaults, "0", "", "", "largest; not above least: no range"},
    {"sensor_fault", "step", Kind::number, kNoUnit, "sensor_fault.step", kOfField, "", defaults, "0", "", "", "step of a converter that counts from least, at most 65 536 steps; 0: none"},

    {"lambda_sensor", "pipe_cm3", Kind::number, kCm3, "lambda_sensor.pipe_m3", kOfField, "", defaults, "500", "", "", "volume of the pipe from the exhaust manifold to the sensor; 0: the sensor is at the manifold"},
    {"lambda_sensor", "lag_s", Kind::number, kS, "lambda_sensor.lag_s", kOfField, "", defaults, "0.05", "", "", "the sensor's time constant, of first order; 0: none", "0.02 to 0.2"},

    {"counterweight", "mass_g", Kind::number, kG, "", above(0).up_to(1e7), "", required, "", "", "", "of the weight"},
    {"counterweight", "radius_mm", Kind::number, kMm, "", above(0).up_to(1e4), "", required, "", "", "", "of its centre of mass from the crankshaft's axis"},
    {"counterweight", "angle_deg", Kind::number, kDeg, "", from(-360).up_to(360), "", defaults, "180", "", "", "from cylinder 1's crank pin, in the sense of rotation; 180: opposite"},
    {"counterweight", "position_mm", Kind::number, kMm, "", from(-1e5).up_to(1e5), "", required, "", "", "", "along the crankshaft, on the scale of cylinder_positions_mm"},

    {"balance_shaft", "mass_g", Kind::number, kG, "", above(0).up_to(1e7), "", required, "", "", "", "of its unbalance"},
    {"balance_shaft", "radius_mm", Kind::number, kMm, "", above(0).up_to(1e4), "", required, "", "", "", "of the unbalance's centre of mass from the shaft's axis"},
    {"balance_shaft", "turns", Kind::whole_number, kNoUnit, "", from(1).up_to(2), "", required, "", "", "", "of the shaft per turn of the crankshaft"},
    {"balance_shaft", "direction", Kind::choice, kNoUnit, "", kAny, "with|against", required, "", "", "", "of its rotation: with the crankshaft's or against it"},
    {"balance_shaft", "angle_deg", Kind::number, kDeg, "", from(-360).up_to(360), "", required, "", "", "", "of the unbalance at engine angle 0, from up in the crankshaft's sense of rotation"},
    {"balance_shaft", "position_mm", Kind::number, kMm, "", from(-1e5).up_to(1e5), "", required, "", "", "", "along the crankshaft, on the scale of cylinder_positions_mm"},
};
// clang-format on

}  // namespace crankloop::program::list

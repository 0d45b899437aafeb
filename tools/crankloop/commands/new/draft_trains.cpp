// Cams, tappets and valves, and the wheels that sensors see.
#include "draft.hpp"

#include <cmath>
#include <string_view>

#include "../../files/units.hpp"

namespace crankloop::program {
namespace {

constexpr double kCamEndsWith_m_s = 0.2;  ///< at rated speed; the valve's seating speed is this plus the train's
                                          ///< vibration
constexpr double kMostClearancePerLift = 0.008;
constexpr double kSpringMargin = 1.9;  ///< least spring force at full lift / inertia force at the nose at rated speed
constexpr double kPreloadShare = 0.4;  ///< preload / spring force at full lift
/// Natural frequency of the train / rotation frequency of the cam, at rated speed or, for an engine that is rated
/// slower than its size allows, at the usual speed of a square engine of its bore. The sample engines have 35 and 38.
constexpr double kTrainOrders = 40;

}  // namespace

void add_train(Draft& draft, const char* name, double full_lift_deg, const Numbers& n) {
  const double lift_mm = to_three_digits(usual_lift_mm(n.design, n.bore_mm));
  const double valve_g = to_three_digits(usual_valve_g(n.design, n.bore_mm));
  const double spring_g = to_three_digits(0.6 * valve_g);
  const double moving_kg = (valve_g + spring_g / 3) / 1e3;
  const double cam_rad_s = n.rated_rpm * kRad_sPerRpm / 2;
  const double half_angle_rad = kCamHalfAngleDeg * kRadPerDeg;
  const double nose_N = moving_kg * cam_nose_factor() * lift_mm / 1e3 * std::pow(cam_rad_s / half_angle_rad, 2);
  const Seats seats = usual_seats(n.design, n.bore_mm);
  const double preload_N = std::max(kPreloadShare * kSpringMargin * nose_N, kPreload_N_mm2 * seat_mm2(seats.intake_mm));
  const double full_lift_N = preload_N / kPreloadShare;
  const double square_rpm = usual_rated_rpm(n.design, n.bore_mm);
  const double stiff_at_rpm = std::max(n.rated_rpm, square_rpm);
  const double train_N_per_mm =
      to_three_digits(moving_kg * std::pow(kTrainOrders * stiff_at_rpm * kRad_sPerRpm / 2, 2) / 1e3);
  std::string exponents;
  for (const double exponent : kCamExponents) exponents += (exponents.empty() ? "" : ",") + shortest(exponent);
  draft.section((std::string("cam ") + name).c_str());
  draft.line("source", "polynomial", "assumed");
  draft.assume("max_lift_mm", lift_mm, shortest(usual_lift_mm(n.design, 1)) + " bores");
  draft.assume("half_angle_deg", kCamHalfAngleDeg, "with its ramps");
  draft.line("exponents", exponents, "assumed: the lobe ends with the angle's sixth power, as a ramp does");
  draft.assume("full_lift_at_crank_deg", full_lift_deg, "360 is the top dead centre of gas exchange");
  draft.section((std::string("rocker ") + name).c_str());
  draft.assume("ratio", 1, "a bucket tappet");
  draft.assume("base_circle_mm", to_three_digits(0.22 * n.bore_mm), "0.22 bores");
  draft.assume(
      "clearance_mm",
      to_three_digits(clearance_for_speed_mm(lift_mm, cam_rad_s, kCamEndsWith_m_s, kMostClearancePerLift * lift_mm)),
      "small: the cam ends with " + shortest(kCamEndsWith_m_s) + " m/s at rated speed, or slower");
  draft.section((std::string("valve ") + name).c_str());
  const double seat_mm = to_three_digits(std::string_view(name) == "intake" ? seats.intake_mm : seats.exhaust_mm);
  if (n.gas) {
    draft.line("port", name, "given");
    draft.assume("seat_diameter_mm", seat_mm, shortest(to_three_digits(seat_mm / n.bore_mm)) + " bores");
  }
  draft.assume("per_cylinder", n.design.four_valves ? 2 : 1,
               n.design.four_valves ? "two of each kind" : "one of each kind");
  draft.assume("valve_g", valve_g, "with bucket; proportional to bore cubed");
  draft.assume("spring_g", spring_g, "0.6 of that");
  draft.assume("rocker_inertia_kg_mm2", 0, "no rocker");
  draft.assume(
      "spring_N_per_mm", to_three_digits((full_lift_N - preload_N) / lift_mm),
      shortest(to_three_digits(full_lift_N / nose_N)) + " times the force needed at rated speed and full lift");
  draft.assume("spring_preload_N", to_three_digits(preload_N),
               shortest(kPreload_N_mm2) + " N for a mm2 of the intake seat, or more where the speed needs it");
  draft.assume("head_area_mm2", to_three_digits(seat_mm2(seat_mm)), "inside the seat; gas presses on it");
  draft.assume("train_N_per_mm", train_N_per_mm,
               "natural frequency " + shortest(kTrainOrders) + " times the cam's at " +
                   (stiff_at_rpm > n.rated_rpm ? shortest(stiff_at_rpm) + " rpm, usual for this bore" : "rated speed"));
  draft.assume("train_damping_ratio", 0.08, "usual");
  draft.assume("guide_damping_ratio", 0.003, "usual");
  draft.assume("seat_N_per_mm", to_three_digits(8 * train_N_per_mm), "8 times the train");
  draft.assume("seat_damping_ratio", 0.1, "usual");
}

void add_triggers(Draft& draft) {
  draft.section("trigger crank");
  draft.line("on", "crank", "assumed");
  draft.line("pattern", "60-2", "assumed; `crankloop help patterns` lists wheels in use");
  draft.assume("first_tooth_deg", 246, "the gap ends 114 deg before top dead centre");
  draft.section("trigger cam");
  draft.line("on", "cam intake", "assumed");
  draft.line("pattern", "half-moon", "assumed");
  draft.assume("first_tooth_deg", -180, "high through cylinder 1's compression and expansion");
}

}  // namespace crankloop::program

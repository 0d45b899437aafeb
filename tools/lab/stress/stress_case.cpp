#include "stress_case.hpp"

#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/valve_lift.hpp>

#include "../reference/ohc_125.hpp"
#include "../reference/valve_reference.hpp"
#include "crankloop/files/number.hpp"
#include "crankloop/files/units.hpp"

namespace crankloop::program {
namespace {

/// 3-4-5 polynomial from 0 to 1: speed and acceleration begin and end at 0.
double rise(double u) { return u <= 0 ? 0 : u >= 1 ? 1 : u * u * u * (10 + u * (-15 + 6 * u)); }

}  // namespace

std::uint64_t Draws::bits() noexcept {
  state_ += 0x9E37'79B9'7F4A'7C15u;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58'476D'1CE4'E5B9u;
  z = (z ^ (z >> 27)) * 0x94D0'49BB'1331'11EBu;
  return z ^ (z >> 31);
}

double Draws::between(double low, double high) noexcept {
  return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
}

double Draws::logarithmic(double low, double high) noexcept { return low * std::pow(high / low, between(0, 1)); }

StressCase::StressCase(std::uint64_t seed, std::uint64_t number, StressKind drawn) {
  Draws mix(seed);
  Draws draw(mix.bits() ^ number * 0xD134'2543'DE82'EF95u);
  draw_cam(draw);
  if (drawn == StressKind::smooth) make_smooth(draw);
  draw_valve(draw);
  draw_operation(draw);
  if (drawn == StressKind::smooth) make_calm(draw);
  own_seed = draw.bits();
}

void StressCase::draw_cam(Draws& draw) {
  Cam& cam = train.cam;
  Rocker& rocker = train.rocker;
  shape = static_cast<CamShape>(draw.bits() % 3);
  if (shape == CamShape::sample) {
    shape_as_ohc_125(cam, rocker);
    rocker.cam_turns = draw.one_in(2) ? CamTurns::toward_pivot : CamTurns::away_from_pivot;
  } else {
    rocker.kind = RockerKind::ratio;
    rocker.ratio = draw.between(0.7, 1.8);
    rocker.base_circle_m = draw.logarithmic(12e-3, 80e-3);
    cam.max_lift_m = draw.between(3e-3, 9e-3);
  }
  if (shape == CamShape::polynomial) {
    cam.half_angle_deg = draw.between(50, 90);
    double exponent = draw.between(2, 2.5);
    cam.exponent_count = 4;
    for (int i = 0; i < cam.exponent_count; ++i, exponent += draw.between(3, 9)) cam.exponents[i] = exponent;
  }
  if (shape == CamShape::dwell) {
    flank_deg_ = draw.between(45, 90);
    dwell_deg_ = draw.between(2, 60);
    cam.source = CamSource::table;
    cam.smoothing_m = draw.logarithmic(0.5e-6, 20e-6);
    const int half = static_cast<int>(flank_deg_ + dwell_deg_ / 2) + 5;
    for (int deg = -half; deg <= half; ++deg) rows.push_back({static_cast<double>(deg), follower_lift_m(deg)});
    cam.points = rows.data();
    cam.point_count = static_cast<int>(rows.size());
  }
  rocker.clearance_m = draw.one_in(10) ? 0 : draw.between(0, 1e-3);
  cam.full_lift_deg = draw.between(0, 719);
}

void StressCase::draw_valve(Draws& draw) {
  const auto damping = [&] { return draw.one_in(5) ? 0 : draw.between(0, 2); };
  Valve& valve = train.valve;
  valve.valve_kg = draw.logarithmic(0.01, 0.5);
  valve.spring_kg = draw.logarithmic(0.01, 0.5);
  if (shape == CamShape::sample) valve.rocker_inertia_kg_m2 = draw.one_in(4) ? 0 : draw.logarithmic(1e-6, 1e-4);
  valve.train_N_m = draw.logarithmic(1e6, 1e9);
  valve.seat_N_m = draw.logarithmic(1e6, 1e9);
  valve.spring_N_m = draw.logarithmic(5e3, 2e5);
  valve.spring_preload_N = draw.logarithmic(50, 1000);
  valve.train_damping_ratio = damping();
  valve.seat_damping_ratio = damping();
  valve.guide_damping_ratio = draw.one_in(5) ? 0 : draw.logarithmic(1e-3, 0.1);
}

void StressCase::draw_operation(Draws& draw) {
  options.tick_s = draw.logarithmic(1e-6, 2e-3);
  options.valves.accuracy_m = draw.logarithmic(0.01e-6, 10e-6);
  options.valves.integrator = draw.one_in(2) ? Integrator::rk4 : Integrator::exponential;
  in_float = draw.one_in(2);
  speed_rpm = draw.one_in(50) ? 0 : draw.logarithmic(draw.one_in(3) ? 1e-6 : 100, 30'000);
  speed_rpm = std::min(speed_rpm, 0.999 * 60 / options.tick_s);  // the tick's speed limit: a crank revolution
  if (draw.one_in(2)) speed_rpm = -speed_rpm;
  // Half of all cases begin anywhere. The others within 20 cam degrees before full lift, or before one of the lobe's
  // feet, so that events occur within few ticks.
  double half_lobe_deg = train.cam.half_angle_deg;
  if (shape == CamShape::dwell) half_lobe_deg = flank_deg_ + dwell_deg_ / 2;
  const double feet_deg[] = {-half_lobe_deg, 0, half_lobe_deg};
  const double before_deg = draw.between(0, 20) * (speed_rpm < 0 ? -1 : 1);
  const double near_deg = train.cam.full_lift_deg + 2 * (feet_deg[draw.bits() % 3] - before_deg);
  start_deg = draw.one_in(2) ? draw.between(0, 720) : near_deg - 720 * std::floor(near_deg / 720);
}

/// Whole even exponents in place of others: u^2.3 has no third derivative at the nose, a table none at its knots.
void StressCase::make_smooth(Draws& draw) {
  if (shape == CamShape::sample) return;
  shape = CamShape::polynomial;
  rows.clear();
  Cam& cam = train.cam;
  cam.source = CamSource::polynomial;
  cam.points = nullptr;
  cam.point_count = 0;
  cam.half_angle_deg = draw.between(50, 90);
  cam.exponent_count = 4;
  double exponent = 2;
  for (int i = 0; i < cam.exponent_count; ++i, exponent += 2 * static_cast<double>(2 + draw.bits() % 3))
    cam.exponents[i] = exponent;
}

/// A speed below float, from 5 to 20 cam degrees before the lobe. A refused train stays unchanged.
void StressCase::make_calm(Draws& draw) {
  train.valve.train_damping_ratio = draw.between(0.05, 0.5);
  train.valve.seat_damping_ratio = draw.between(0.05, 0.5);
  ValveLift lift;
  if (!lift.init(train.cam, train.rocker).ok()) return;
  const valve_reference::SingleMass mass(train.valve, train.rocker, lift.largest_lift_m());
  double separates_rad_s = 1e9;
  for (double deg = -90; deg < 90; deg += 0.5) {
    const LiftPose pose = lift.at(deg * kRadPerDeg);
    if (pose.lift_m <= 0 || pose.per_rad2_m >= 0) continue;
    const double spring_m_s2 = (mass.P + mass.k_s * pose.lift_m) / mass.M;
    separates_rad_s = std::min(separates_rad_s, std::sqrt(spring_m_s2 / -pose.per_rad2_m));
  }
  const double backwards = std::signbit(speed_rpm) ? -1 : 1;
  speed_rpm = draw.between(0.2, 0.8) * separates_rad_s * 2 * 30 / kPi;
  speed_rpm = backwards * std::min({speed_rpm, 30'000.0, 0.999 * 60 / options.tick_s});
  const double before_deg =
      train.cam.full_lift_deg - backwards * 2 * (lift.closes_rad() / kRadPerDeg + draw.between(5, 20));
  start_deg = before_deg - 720 * std::floor(before_deg / 720);
}

double StressCase::speed_rad_s() const noexcept { return speed_rpm * kPi / 30; }

/// The flat follower's lift. The polynomial's coefficients solve y = y' = ... = 0 at u = 1: C_i = -product of
/// p_j / (p_j - p_i) over the other exponents.
double StressCase::follower_lift_m(double from_full_lift_deg) const {
  const double deg = std::fabs(from_full_lift_deg);
  const Cam& cam = train.cam;
  if (shape == CamShape::dwell) return cam.max_lift_m * rise((flank_deg_ + dwell_deg_ / 2 - deg) / flank_deg_);
  if (deg >= cam.half_angle_deg) return 0;
  double sum = 1;
  for (int i = 0; i < cam.exponent_count; ++i) {
    double c = -1;
    for (int j = 0; j < cam.exponent_count; ++j) {
      if (j != i) c *= cam.exponents[j] / (cam.exponents[j] - cam.exponents[i]);
    }
    sum += c * std::pow(deg / cam.half_angle_deg, cam.exponents[i]);
  }
  return cam.max_lift_m * sum;
}

double StressCase::smallest_radius_m() const {
  constexpr double kStepDeg = 0.05;
  constexpr double kStepRad = kStepDeg * kRadPerDeg;
  double smallest = train.rocker.base_circle_m;
  for (double deg = -160; deg < 160; deg += kStepDeg) {
    const double y = follower_lift_m(deg);
    const double bend = follower_lift_m(deg - kStepDeg) - 2 * y + follower_lift_m(deg + kStepDeg);
    smallest = std::min(smallest, train.rocker.base_circle_m + y + bend / (kStepRad * kStepRad));
  }
  return smallest;
}

std::string StressCase::text() const {
  const char* const kShapes[] = {"the 125's cam", "polynomial cam", "cam with dwell"};
  const Valve& v = train.valve;
  const auto pair = [](const char* name, double value, const char* unit) {
    return std::string(", ") + name + " " + brief(value) + unit;
  };
  return std::string(in_float ? "float" : "double") +
         (options.valves.integrator == Integrator::rk4 ? ", rk4" : ", exponential") +
         pair("tick", options.tick_s * 1e6, " us") + pair("accuracy", options.valves.accuracy_m * 1e6, " um") +
         pair("speed", speed_rpm, " rpm") + pair("from", start_deg, " deg, ") + kShapes[static_cast<int>(shape)] +
         pair("full lift at", train.cam.full_lift_deg, " deg") +
         pair("clearance", train.rocker.clearance_m * 1e3, " mm") + pair("valve", v.valve_kg, " kg") +
         pair("spring", v.spring_kg, " kg") + pair("spring", v.spring_N_m * 1e-3, " N/mm") +
         pair("preload", v.spring_preload_N, " N") + pair("train", v.train_N_m * 1e-3, " N/mm") +
         pair("seat", v.seat_N_m * 1e-3, " N/mm") + pair("damping ratios: train", v.train_damping_ratio, "") +
         pair("seat", v.seat_damping_ratio, "") + pair("guide", v.guide_damping_ratio, "");
}

}  // namespace crankloop::program

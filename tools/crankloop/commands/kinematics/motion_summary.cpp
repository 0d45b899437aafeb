#include "motion_summary.hpp"

#include <algorithm>
#include <cmath>

#include "../../files/units.hpp"

namespace crankloop::program {
namespace {

constexpr int kPerTurn = 720;
constexpr double kStep = 2 * kPi / kPerTurn;

/// Golden section between two angles around the one extreme there.
double place_of(const Crank& crank, PoseMember quantity, PoseFunction pose, double sign, double from, double to) {
  const double part = (std::sqrt(5.0) - 1) / 2;
  while (to - from > 1e-9) {
    const double left = to - part * (to - from);
    const double right = from + part * (to - from);
    if (sign * (pose(crank, left).*quantity) > sign * (pose(crank, right).*quantity)) {
      to = right;
    } else {
      from = left;
    }
  }
  return (from + to) / 2;
}

double whole_turn(double rad) { return rad < 0 ? rad + 2 * kPi : rad >= 2 * kPi ? rad - 2 * kPi : rad; }

/// A line for a value and one for its place, in deg.
void add(Summary& s, const std::string& name, const Extreme& extreme, double factor, const std::string& unit,
         const std::string& remark = "") {
  s.line(name, extreme.value * factor, unit, remark);
  s.line(name + "_at", extreme.at_rad / kRadPerDeg, "deg");
}

void add_extremes(Summary& s, const Crank& crank, PoseFunction pose, double speed) {
  const auto of = [&](PoseMember quantity) { return extremes(crank, quantity, pose); };
  add(s, "max_displacement", of(&Pose<double>::displacement_m).largest, 1e3, "mm");
  const Extremes velocity = of(&Pose<double>::slope_m);
  add(s, "max_velocity", velocity.largest, speed, "m/s");
  add(s, "min_velocity", velocity.smallest, speed, "m/s");
  Extremes acceleration = of(&Pose<double>::acceleration_m);
  const std::vector<LocalExtreme> local = local_extremes(crank, &Pose<double>::acceleration_m, pose);
  const double equal = 1e-9 * (acceleration.largest.value - acceleration.smallest.value);
  for (auto of_local = local.rbegin(); of_local != local.rend(); ++of_local) {  // of two equal ones the first
    if (of_local->extreme.value < acceleration.smallest.value + equal) acceleration.smallest = of_local->extreme;
  }
  const double speed2 = speed * speed;
  add(s, "max_acceleration", acceleration.largest, speed2, "m/s2", "toward the crankshaft");
  add(s, "min_acceleration", acceleration.smallest, speed2, "m/s2");
  int further = 0;
  for (const LocalExtreme& one : local) {
    const Extreme& of_turn = one.is_largest ? acceleration.largest : acceleration.smallest;
    if (std::abs(std::remainder(one.extreme.at_rad - of_turn.at_rad, 2 * kPi)) < 4 * kStep) continue;
    add(s, "acceleration_extreme_" + std::to_string(++further), one.extreme, speed2, "m/s2",
        one.is_largest ? "largest of its neighbourhood" : "smallest of its neighbourhood");
  }
  const Extremes rod = of(&Pose<double>::rod_angle_rad);
  add(s, "max_rod_angle", rod.largest, 1 / kRadPerDeg, "deg");
  if (crank.pin_offset_m != 0) add(s, "min_rod_angle", rod.smallest, 1 / kRadPerDeg, "deg");
}

void add_series(Summary& s, const Crank& crank) {
  const ExactSeries series = exact_series(crank);
  for (int n = 0; n <= kSeriesOrders; ++n) {
    s.line("a_" + std::to_string(n), series.cosine[n], "",
           n == 0 ? "x / r = a_0 + sum of a_n cos n a" + std::string(crank.pin_offset_m != 0 ? " + b_n sin n a" : "")
                  : "");
  }
  for (int n = 1; n <= kSeriesOrders && crank.pin_offset_m != 0; ++n) s.line("b_" + std::to_string(n), series.sine[n]);
}

void add_errors(Summary& s, const Crank& crank, double speed) {
  const auto largest = [&](PoseMember quantity) {
    Extreme most{0, 0};
    for (int i = 0; i < 10 * kPerTurn; ++i) {
      const double a = i * kStep / 10;
      const double error = second_order_pose(crank, a).*quantity - exact_pose(crank, a).*quantity;
      if (std::abs(error) > std::abs(most.value)) most = {a, error};
    }
    return most;
  };
  add(s, "displacement_error", largest(&Pose<double>::displacement_m), 1e3, "mm", "approximation less exact, largest");
  add(s, "velocity_error", largest(&Pose<double>::slope_m), speed, "m/s");
  add(s, "acceleration_error", largest(&Pose<double>::acceleration_m), speed * speed, "m/s2");
  add(s, "rod_angle_error", largest(&Pose<double>::rod_angle_rad), 1 / kRadPerDeg, "deg");
}

}  // namespace

std::vector<LocalExtreme> local_extremes(const Crank& crank, PoseMember quantity, PoseFunction pose) {
  double values[kPerTurn];
  double size = 0;
  for (int i = 0; i < kPerTurn; ++i) {
    values[i] = pose(crank, i * kStep).*quantity;
    size = std::max(size, std::abs(values[i]));
  }
  std::vector<LocalExtreme> found;
  double last = values[kPerTurn - 1];  // the value of the extreme before, for ripples
  for (int i = 0; i < kPerTurn; ++i) {
    const double before = values[(i + kPerTurn - 1) % kPerTurn];
    const double behind = values[(i + 1) % kPerTurn];
    const bool largest = values[i] > before && values[i] >= behind;
    const bool smallest = values[i] < before && values[i] <= behind;
    if ((!largest && !smallest) || std::abs(values[i] - last) < 1e-9 * size) continue;
    const double sign = largest ? 1 : -1;
    double at = place_of(crank, quantity, pose, sign, (i - 1) * kStep, (i + 1) * kStep);
    // Flat at its extreme: the search has its place to the root of rounding, so a sample with an equal value counts.
    if (sign * (pose(crank, at).*quantity) <= sign * values[i]) at = i * kStep;
    last = pose(crank, at).*quantity;
    found.push_back({{whole_turn(at), last}, largest});
  }
  return found;
}

/// The trapezoidal rule, whose error falls like (lambda / 2)^kSamples.
ExactSeries exact_series(const Crank& crank) {
  constexpr int kSamples = 512;
  ExactSeries series{};
  for (int n = 0; n <= kSeriesOrders; ++n) {
    double cosine = 0;
    double sine = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double a = 2 * kPi * i / kSamples;
      const double x = exact_pose(crank, a).displacement_m / crank.crank_radius_m;
      cosine += x * elementary::cos(n * a);
      sine += x * elementary::sin(n * a);
    }
    const double scale = (n == 0 ? 1.0 : 2.0) / kSamples;
    const auto without_rounding = [](double value) { return std::abs(value) < 1e-14 ? 0 : value; };
    series.cosine[n] = without_rounding(scale * cosine);
    series.sine[n] = without_rounding(scale * sine);
  }
  return series;
}

Summary motion_summary(const Crank& crank, PoseFunction pose, double speed_rad_s, bool beside) {
  Summary s;
  s.line("crank_speed", speed_rad_s, "rad/s", "w");
  s.line("lambda", crank.rod_ratio(), "", "crank radius over rod length");
  s.line("r_w", crank.crank_radius_m * speed_rad_s, "m/s");
  s.line("r_w2", crank.crank_radius_m * speed_rad_s * speed_rad_s, "m/s2");
  add_extremes(s, crank, pose, speed_rad_s);
  add_series(s, crank);
  if (beside) add_errors(s, crank, speed_rad_s);
  return s;
}

}  // namespace crankloop::program

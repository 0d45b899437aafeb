#include <crankloop/assert.hpp>
#include <crankloop/tabulate/mechanism.hpp>

#include <crankloop/tabulate/elementary.hpp>

namespace crankloop {

using namespace detail;

using elementary::kPi;

ExactStroke::ExactStroke(const Crank& crank) noexcept
    : crank_radius_m_{crank.crank_radius_m},
      rod_length_m_{crank.rod_length_m},
      rod_ratio_{crank.rod_ratio()},
      offset_per_rod_{crank.pin_offset_m / crank.rod_length_m} {
  const double reach_m = crank_radius_m_ + rod_length_m_;
  height_at_tdc_m_ = square_root((reach_m - crank.pin_offset_m) * (reach_m + crank.pin_offset_m));
}

Stroke exact_stroke(const Crank& crank, double crank_rad) noexcept {
  return ExactStroke(crank).at(elementary::sin_cos(crank_rad));
}

Pose<double> exact_pose(const Crank& crank, double crank_rad) noexcept {
  const ExactStroke stroke(crank);
  const elementary::SinCos a = elementary::sin_cos(crank_rad);
  const elementary::SinCos b = stroke.rod_angle(a);
  const double r = crank.crank_radius_m;
  const double lambda = crank.rod_ratio();
  const double tan_b = b.sin / b.cos;
  const double rod_slope = lambda * a.cos / b.cos;

  Pose<double> pose;
  const auto [displacement_m, slope_m] = stroke.at(a);
  pose.displacement_m = displacement_m;
  pose.slope_m = slope_m;
  pose.radial = a.cos - a.sin * tan_b;  // cos(a + b) / cos b
  pose.acceleration_m = r * (pose.radial + rod_slope * a.cos / (b.cos * b.cos));
  pose.rod_angle_rad = elementary::asin(b.sin);
  pose.rod_slope = rod_slope;
  pose.rod_curvature = -lambda * a.sin / b.cos + tan_b * rod_slope * rod_slope;
  pose.rod_tilt = tan_b;
  return pose;
}

Pose<double> second_order_pose(const Crank& crank, double crank_rad) noexcept {
  const double r = crank.crank_radius_m;
  const double lambda = crank.rod_ratio();
  const double sin_a = elementary::sin(crank_rad);
  const double cos_a = elementary::cos(crank_rad);
  const double sin_2a = elementary::sin(2 * crank_rad);
  const double cos_2a = elementary::cos(2 * crank_rad);
  const double q = lambda * lambda * sin_a * sin_a;

  Pose<double> pose;
  pose.displacement_m = r * ((1 - cos_a) + lambda / 4 * (1 - cos_2a));
  pose.slope_m = r * (sin_a + lambda / 2 * sin_2a);
  pose.acceleration_m = r * (cos_a + lambda * cos_2a);
  pose.rod_angle_rad = lambda * sin_a * (1 + q / 6);
  pose.rod_slope = lambda * cos_a * (1 + q / 2);
  pose.rod_curvature = -lambda * sin_a * (1 - lambda * lambda + 1.5 * q);
  pose.rod_tilt = elementary::tan(pose.rod_angle_rad);
  pose.radial = cos_a - sin_a * pose.rod_tilt;
  return pose;
}

double crank_angle_rad(const Crank& crank, double displacement_m, bool downward) noexcept {
  // Triangle of crank centre, crank pin and piston pin: all sides are known, so all angles are.
  const double r = crank.crank_radius_m;
  const double l = crank.rod_length_m;
  const double e = crank.pin_offset_m;
  const double highest = square_root((l + r - e) * (l + r + e));
  const double lowest = square_root((l - r - e) * (l - r + e));
  double height = highest - displacement_m;
  if (height > highest) height = highest;
  if (height < lowest) height = lowest;
  const double side = square_root(height * height + e * e);
  const double half = (r + l + side) / 2;
  const auto root = [](double x) { return x > 0 ? square_root(x) : 0; };
  const double between =
      2 * elementary::quick_atan2(root((half - r) * (half - side)), root(half * (half - l)));  // half-angle theorem
  const double leaning = elementary::quick_atan2(e, height);
  return downward ? leaning + between : leaning - between + 2 * kPi;
}

double crank_angle_up_rad(const Crank& crank, double down_rad, double displacement_m) noexcept {
  // Both positions of the crank pin lie symmetrically to the line from the crank centre to the piston pin.
  const double r = crank.crank_radius_m;
  const double l = crank.rod_length_m;
  const double e = crank.pin_offset_m;
  const double height = square_root((l + r - e) * (l + r + e)) - displacement_m;
  return 2 * elementary::quick_atan2(e, height) - down_rad + 2 * kPi;
}

DeadCentres dead_centres(const Crank& crank) noexcept {
  const double r = crank.crank_radius_m;
  const double l = crank.rod_length_m;
  const double e = crank.pin_offset_m;
  return {elementary::asin(e / (l + r)), kPi + elementary::asin(e / (l - r)),
          square_root((l + r - e) * (l + r + e)) - square_root((l - r - e) * (l - r + e))};
}

double mean_piston_speed_m_s(const Crank& crank, double speed_rad_s) noexcept {
  return dead_centres(crank).stroke_m * speed_rad_s / kPi;
}

double bore_area_m2(const Crank& crank) noexcept { return kPi / 4 * crank.bore_m * crank.bore_m; }

double swept_volume_m3(const Crank& crank) noexcept { return bore_area_m2(crank) * dead_centres(crank).stroke_m; }

double clearance_volume_m3(const Crank& crank) noexcept {
  return swept_volume_m3(crank) / (crank.compression_ratio - 1);
}

namespace {

/// Golden-section search for the largest sign * quantity between two angles that bracket it.
[[nodiscard]] Extreme refine(const Crank& crank, PoseMember quantity, PoseFunction pose, double sign, double low,
                             double high) noexcept {
  CRANKLOOP_ASSERT(low < high);
  constexpr double kGolden = 0.6180339887498949;
  double left = high - kGolden * (high - low);
  double right = low + kGolden * (high - low);
  double at_left = sign * pose(crank, left).*quantity;
  double at_right = sign * pose(crank, right).*quantity;
  for (int i = 0; i < 40; ++i) {  // 2 deg times 0.618^40 = 1.5e-10 rad
    if (at_left > at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = sign * pose(crank, left).*quantity;
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = sign * pose(crank, right).*quantity;
    }
  }
  const double at = (low + high) / 2;
  return {at, pose(crank, at).*quantity};
}

}  // namespace

Extremes extremes(const Crank& crank, PoseMember quantity, PoseFunction pose) noexcept {
  constexpr double kStep = kPi / 180;
  Extreme largest{0, pose(crank, 0).*quantity};
  Extreme smallest = largest;
  for (int degree = 1; degree < 360; ++degree) {
    const double at = degree * kStep;
    const double value = pose(crank, at).*quantity;
    if (value > largest.value) largest = {at, value};
    if (value < smallest.value) smallest = {at, value};
  }
  const auto sharpen = [&](const Extreme& coarse, double sign) {
    Extreme fine = refine(crank, quantity, pose, sign, coarse.at_rad - kStep, coarse.at_rad + kStep);
    // A smooth extreme is flat: the search finds its angle only to the square root of rounding, so prefer a whole
    // degree with an equal value.
    if (sign * fine.value <= sign * coarse.value) fine = coarse;
    if (fine.at_rad < 0) fine.at_rad += 2 * kPi;
    if (fine.at_rad >= 2 * kPi) fine.at_rad -= 2 * kPi;
    return fine;
  };
  return {sharpen(largest, 1), sharpen(smallest, -1)};
}

DisplacementSeries displacement_series(double rod_ratio) noexcept {
  const double l1 = rod_ratio;
  const double l3 = l1 * l1 * l1;
  const double l5 = l3 * l1 * l1;
  return {1 + l1 / 4 + 3 * l3 / 64 + 5 * l5 / 256, -1, -(l1 / 4 + l3 / 16 + 15 * l5 / 512), l3 / 64 + 3 * l5 / 256,
          -l5 / 512};
}

}  // namespace crankloop

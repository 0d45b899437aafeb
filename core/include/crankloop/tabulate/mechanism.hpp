// Exact kinematics of the crank mechanism, at set-up time, in double.
//
// What belongs here: kinematics of one cylinder. What does not: per-degree tables (tabulate/tabulate.hpp) and forces.
// Angles in radians, derivatives by the crank angle and so independent of speed: multiply by w and w^2.
#pragma once

#include <crankloop/define/crank.hpp>
#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tick/crank/cylinder_forces.hpp>

namespace crankloop {

/// The pose at crank angle a, exact to rounding: docs/model.md "Kinematics". The crank must be valid.
[[nodiscard]] Pose<double> exact_pose(const Crank& crank, double crank_rad) noexcept;

/// Displacement and slope of exact_pose() with the same bits, at a third of the cost.
struct Stroke {
  double displacement_m;
  double slope_m;
};
[[nodiscard]] Stroke exact_stroke(const Crank& crank, double crank_rad) noexcept;

/// Displacement and slope at many angles with known sine and cosine, at a tenth of the cost.
class ExactStroke {
 public:
  explicit ExactStroke(const Crank& crank) noexcept;

  [[nodiscard]] Stroke at(const elementary::SinCos& crank_angle) const noexcept {
    const auto [sin_a, cos_a] = crank_angle;
    const auto [sin_b, cos_b] = rod_angle(crank_angle);
    return {height_at_tdc_m_ - crank_radius_m_ * cos_a - rod_length_m_ * cos_b,
            crank_radius_m_ * (sin_a + cos_a * (sin_b / cos_b))};  // sin(a + b) / cos b
  }
  /// Angle between rod and cylinder axis.
  [[nodiscard]] elementary::SinCos rod_angle(const elementary::SinCos& crank_angle) const noexcept {
    const double sin_b = rod_ratio_ * crank_angle.sin - offset_per_rod_;
    return {sin_b, detail::square_root((1 - sin_b) * (1 + sin_b))};
  }

 private:
  double crank_radius_m_;
  double rod_length_m_;
  double rod_ratio_;
  double offset_per_rod_;
  double height_at_tdc_m_;
};

/// The textbook second-order approximations for e = 0 (the offset is ignored), for comparison with the exact pose.
/// Displacement, slope, acceleration, rod angle, its slope and curvature are the published series; tilt and radial
/// follow from the rod angle's.
[[nodiscard]] Pose<double> second_order_pose(const Crank& crank, double crank_rad) noexcept;

/// Crank angle at which the piston is at displacement x: on the way down in [tdc, bdc], on the way up in [bdc, tdc + 2
/// pi]. For x outside the stroke: the nearer dead centre.
[[nodiscard]] double crank_angle_rad(const Crank& crank, double displacement_m, bool downward) noexcept;

/// Crank angle on the way up, in [bdc, tdc + 2 pi], with the same piston position as `down_rad`, in [tdc, bdc], has on
/// the way down. `displacement_m` is that position.
[[nodiscard]] double crank_angle_up_rad(const Crank& crank, double down_rad, double displacement_m) noexcept;

/// True dead centres and stroke. Without offset: 0, pi, 2 r.
struct DeadCentres {
  double tdc_rad;
  double bdc_rad;
  double stroke_m;
};
[[nodiscard]] DeadCentres dead_centres(const Crank& crank) noexcept;

/// Mean piston speed S n / 30 = stroke w / pi, with the true stroke.
[[nodiscard]] double mean_piston_speed_m_s(const Crank& crank, double speed_rad_s) noexcept;

[[nodiscard]] double bore_area_m2(const Crank& crank) noexcept;
[[nodiscard]] double swept_volume_m3(const Crank& crank) noexcept;      ///< area times true stroke, one cylinder
[[nodiscard]] double clearance_volume_m3(const Crank& crank) noexcept;  ///< V_c

/// A largest or smallest value and its angle in [0, 2 pi).
struct Extreme {
  double at_rad;
  double value;
};
struct Extremes {
  Extreme largest;
  Extreme smallest;
};

/// A quantity of the pose, e.g. &Pose<double>::slope_m.
using PoseMember = double Pose<double>::*;
using PoseFunction = Pose<double> (*)(const Crank&, double crank_rad) noexcept;

/// Largest and smallest value of a quantity over a turn; the value is accurate to rounding. The angle is accurate to
/// 1e-7 rad if the curve has curvature at its extreme, and less accurate if it is flatter (acceleration at lambda =
/// 0.264 is flat to fourth order). 440 evaluations.
[[nodiscard]] Extremes extremes(const Crank& crank, PoseMember quantity, PoseFunction pose = exact_pose) noexcept;

/// Fourier coefficients of x / r for e = 0, to O(lambda^7): x = r (a0 + a1 cos a + a2 cos 2a + a4 cos 4a + a6 cos 6a).
struct DisplacementSeries {
  double a0, a1, a2, a4, a6;
};
[[nodiscard]] DisplacementSeries displacement_series(double rod_ratio) noexcept;

}  // namespace crankloop

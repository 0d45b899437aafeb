// A cam, polynomial or table, as the lift of a flat follower over the cam angle: docs/model.md "Cam".
//
// What belongs here: y(phi) and its derivatives at set-up time, in double. What does not: the rocker
// (tabulate/valve_lift.hpp).
#pragma once

#include <crankloop/define/valve_train.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

/// Lift of the flat follower at one cam angle phi, and its derivatives by phi.
struct CamLift {
  double lift_m;      ///< y
  double per_rad_m;   ///< y', also the distance of the contact from the cam's centre line
  double per_rad2_m;  ///< y''; r_0 + y + y'' is the contour's radius of curvature
};

/// A uniform quintic B-spline that rises from zero and returns to it, four times continuously differentiable
/// everywhere.
///
/// c[i] weighs the basis function over [first + i knot, first + (i + 6) knot]; weights left out at both ends are zeros.
struct LobeSpline {
  static constexpr int kMaxWeights = 256;

  double first_rad = 0;  ///< knot where c[0]'s basis function begins
  double knot_rad = 1;   ///< distance of knots
  int begin = 0;         ///< first and one past the last weight that is not zero
  int end = 0;
  double c_m[kMaxWeights] = {};

  [[nodiscard]] CamLift at(double phi_rad) const noexcept;
  [[nodiscard]] double opens_rad() const noexcept { return first_rad + begin * knot_rad; }
  [[nodiscard]] double closes_rad() const noexcept { return first_rad + (end + 5) * knot_rad; }
};

/// Scatter of a table's rows, and how closely a smooth lobe fits them.
struct CamRows {
  double scatter_m = 0;    ///< standard deviation of a row, from the median deviation of the rows from their neighbours
  double unit_m = 0;       ///< resolution of the lifts: 1, 2 or 5 times a power of ten; 0 if they have none
  double smallest_m = 0;   ///< least smoothing_m that is not refused, to 1 %
  int worst_row = 0;       ///< row with the largest deviation from the closest lobe
  double worst_off_m = 0;  ///< that row's lift less the lobe's; smallest_m or a little less, with its sign
  double automatic_m = 0;  ///< proposed cam.smoothing_m: unit_m for rows that are only rounded, else five times the
                           ///< scatter; at least 1.5 smallest_m, at most 1 mm; two digits. The next larger that a lobe
                           ///< keeps, smallest_m itself if none does
};

/// Analyses a table; cam.smoothing_m is not read. Refuses what validate() refuses of the other fields, a cam that is
/// not a table (inconsistent "cam.source"), a table that does not fall to 50 um on both sides of its peak (inconsistent
/// "cam.points", its first or last row), and one that no lobe fits within 1 mm (no_solution "cam.smoothing_m", the
/// row). Takes some ten milliseconds and 50 kB of stack. Method: docs/model.md "Cam".
Status survey_rows(const Cam& cam, CamRows& rows) noexcept;

/// Size 2.3 kB. init() takes some microseconds for a polynomial; for a table of 1 deg rows a millisecond and 27 kB of
/// stack.
class CamProfile {
 public:
  /// Refuses what validate() refuses, and a table that has no lobe ("cam.points", with the row) or cannot be smoothed
  /// to the requested residual ("cam.smoothing_m").
  Status init(const Cam& cam) noexcept;

  /// At phi, 0 at full lift, not wrapped; all zero outside the lobe.
  [[nodiscard]] CamLift at(double phi_rad) const noexcept;

  [[nodiscard]] double opens_rad() const noexcept { return opens_rad_; }
  [[nodiscard]] double closes_rad() const noexcept { return closes_rad_; }
  [[nodiscard]] double largest_lift_m() const noexcept { return at(0).lift_m; }

  // Of a smoothed table; 0 for a polynomial.
  [[nodiscard]] double residual_m() const noexcept {
    return residual_m_;
  }  ///< largest distance of a row from the smooth curve
  [[nodiscard]] double peak_deg() const noexcept {
    return peak_deg_;
  }  ///< table angle of the smooth curve's peak, here phi = 0

 private:
  void init_polynomial(const Cam& cam) noexcept;
  Status init_table(const Cam& cam) noexcept;
  [[nodiscard]] CamLift polynomial(double phi_rad) const noexcept;

  CamSource source_ = CamSource::polynomial;
  double opens_rad_ = 0;
  double closes_rad_ = 0;
  double residual_m_ = 0;
  double peak_deg_ = 0;
  // polynomial
  double max_lift_m_ = 0;
  double half_angle_rad_ = 1;
  int terms_ = 0;
  double exponent_[kMaxCamExponents] = {};
  double coefficient_[kMaxCamExponents] = {};
  // table
  LobeSpline spline_;
};

/// Coefficients C_i of y = 1 + sum C_i u^p_i with y = y' = ... = 0 (as many conditions as exponents) at u = 1.
void cam_coefficients(const double* exponents, int count, double* coefficients) noexcept;

}  // namespace crankloop

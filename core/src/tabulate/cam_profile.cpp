#include <crankloop/tabulate/cam_profile.hpp>

#include <crankloop/phase.hpp>
#include <crankloop/tabulate/elementary.hpp>

#include "cam_smoothing.hpp"
#include "quintic_basis.hpp"

namespace crankloop {

namespace {}  // namespace

CamLift LobeSpline::at(double phi_rad) const noexcept {
  const double knots = (phi_rad - first_rad) / knot_rad;
  if (!(knots > begin && knots < end + detail::kBasis - 1)) return {};
  const int segment = static_cast<int>(knots);
  const detail::QuinticBasis basis = detail::quintic_basis(knots - segment);
  CamLift y{};
  for (int j = 0; j < detail::kBasis; ++j) {
    const int i = segment - (detail::kBasis - 1) + j;
    if (i < begin || i >= end) continue;
    y.lift_m += c_m[i] * basis.value[j];
    y.per_rad_m += c_m[i] * basis.slope[j];
    y.per_rad2_m += c_m[i] * basis.curvature[j];
  }
  return {y.lift_m, y.per_rad_m / knot_rad, y.per_rad2_m / (knot_rad * knot_rad)};
}

void cam_coefficients(const double* exponents, int count, double* coefficients) noexcept {
  // With C_0 = 1 for u^0, the conditions at u = 1 make sum C_i q(p_i) = 0 for every polynomial q of degree below
  // `count`. Choosing the q that is zero at all exponents but 0 and p_i leaves one equation for C_i.
  for (int i = 0; i < count; ++i) {
    double product = 1;
    for (int j = 0; j < count; ++j) {
      if (j != i) product *= exponents[j] / (exponents[j] - exponents[i]);
    }
    coefficients[i] = -product;
  }
}

Status CamProfile::init(const Cam& cam) noexcept {
  *this = CamProfile{};
  if (const Status refused = validate(cam); !refused.ok()) return refused;
  source_ = cam.source;
  if (cam.source == CamSource::table) return init_table(cam);
  init_polynomial(cam);
  return {};
}

CamLift CamProfile::at(double phi_rad) const noexcept {
  if (!(phi_rad > opens_rad_ && phi_rad < closes_rad_)) return {};
  if (source_ == CamSource::polynomial) return polynomial(phi_rad);
  return spline_.at(phi_rad);
}

void CamProfile::init_polynomial(const Cam& cam) noexcept {
  max_lift_m_ = cam.max_lift_m;
  half_angle_rad_ = cam.half_angle_deg * detail::kRadPerDegree;
  opens_rad_ = -half_angle_rad_;
  closes_rad_ = half_angle_rad_;
  terms_ = cam.exponent_count;
  for (int i = 0; i < terms_; ++i) exponent_[i] = cam.exponents[i];
  cam_coefficients(exponent_, terms_, coefficient_);
}

CamLift CamProfile::polynomial(double phi_rad) const noexcept {
  const double sign = phi_rad < 0 ? -1 : 1;
  const double u = sign * phi_rad / half_angle_rad_;
  CamLift y{1, 0, 0};
  for (int i = 0; i < terms_; ++i) {
    const double p = exponent_[i];
    const double term = coefficient_[i] * elementary::pow(u, p - 2);  // p >= 2, so no infinity at u = 0
    y.lift_m += term * u * u;
    y.per_rad_m += p * term * u;
    y.per_rad2_m += p * (p - 1) * term;
  }
  const double per_rad = max_lift_m_ / half_angle_rad_;
  return {max_lift_m_ * y.lift_m, sign * per_rad * y.per_rad_m, per_rad / half_angle_rad_ * y.per_rad2_m};
}

Status CamProfile::init_table(const Cam& cam) noexcept {
  if (const Status refused = detail::smooth_cam(cam, spline_, residual_m_); !refused.ok()) return refused;
  // The peak of the smooth curve becomes phi = 0: the angles of a table are often slightly off, and rocker angles start
  // at full lift.
  const double peak_rad = detail::peak_of(spline_);
  peak_deg_ = peak_rad / detail::kRadPerDegree;
  spline_.first_rad -= peak_rad;
  opens_rad_ = spline_.opens_rad();
  closes_rad_ = spline_.closes_rad();
  return {};
}

}  // namespace crankloop

// Derivation in docs/model.md "Rocker". Derivatives by phi_r are short: turning the cam by dphi_r moves the contact
// along its normal by y' dphi_r, and the pad centre turns about the pivot with the lever l_a sin J':
//
//     dW/dphi_r = y' / (l_a sin J')        dY/dphi_r = l_b cos psi dW/dphi_r = i y'
#include <crankloop/tabulate/valve_lift.hpp>

#include <cstdint>

#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop {

using namespace detail;

using elementary::kPi;

namespace {

constexpr double kDegPerRad = 180 / kPi;
constexpr int kScan = 720;  // steps over the lobe; at most half a degree

/// An angle reduced to [0, 2 pi); 0 for NaN and angles beyond 1e15 turns.
[[nodiscard]] double into_turn(double rad) noexcept {
  if (rad >= 0 && rad < 2 * kPi) return rad;
  const double turns = rad / (2 * kPi);
  if (!(turns > -1e15 && turns < 1e15)) return 0;
  const double rest = rad - 2 * kPi * static_cast<double>(static_cast<std::int64_t>(turns));
  const double positive = rest < 0 ? rest + 2 * kPi : rest;
  return positive >= 2 * kPi ? 0 : positive;
}

}  // namespace

Status ValveLift::init(const Cam& cam, const Rocker& rocker) noexcept {
  *this = ValveLift{};
  if (const Status refused = validate(rocker); !refused.ok()) return refused;
  if (const Status refused = cam_.init(cam); !refused.ok()) return refused;
  rocker_ = rocker;
  if (rocker.kind == RockerKind::circular_pad) {
    const double screw_height_m = rocker.screw_ball_m + rocker.stem_above_pivot_m;
    const double sine_seated = screw_height_m / rocker.pivot_to_screw_m;
    const double sine_at_rest = (screw_height_m + rocker.clearance_m) / rocker.pivot_to_screw_m;
    if (!(sine_seated > -1 && sine_at_rest < 1)) {
      failed_at_deg_ = cam_.opens_rad() * kDegPerRad;
      return refuse("rocker.pivot_to_screw_m", Reason::inconsistent);
    }
    screw_at_rest_rad_ = elementary::asin(sine_at_rest);
  }
  if (const Status refused = check_contacts(); !refused.ok()) return refused;
  const Contact rest = contact(cam_.opens_rad());
  outside_ = {-rocker.clearance_m, 0, 0, rest.pose.rocker_ratio, rest.pose.rocker_rad};
  opens_rad_ = rest.cam_rad;
  closes_rad_ = contact(cam_.closes_rad()).cam_rad;
  if (rocker.kind == RockerKind::circular_pad) {
    const double sine_seated = (rocker.screw_ball_m + rocker.stem_above_pivot_m) / rocker.pivot_to_screw_m;
    lever_m_ =
        rocker.pivot_to_screw_m * (square_root((1 - sine_seated) * (1 + sine_seated)) + contact(0).cos_screw) / 2;
  } else {
    lever_m_ = rocker.pivot_to_screw_m;
  }
  return {};
}

/// Whether a quantity of the contact is above 0 over the whole lobe. Sets failed_at_deg_ to the angle of its smallest
/// value.
template <class Quantity>
bool ValveLift::stays_positive(const Quantity& quantity, double& smallest) noexcept {
  const double step = (cam_.closes_rad() - cam_.opens_rad()) / kScan;
  const auto value_at = [&](double place) { return quantity(contact(cam_.opens_rad() + place * step)); };
  double where = 0;
  smallest = value_at(0);
  for (int i = 1; i <= kScan; ++i) {
    const double value = value_at(i);
    if (value < smallest) {
      smallest = value;
      where = i;
    }
  }
  for (double apart = 0.5; apart > 1e-6; apart /= 2) {  // down to 5e-7 deg
    const double places[] = {where - apart, where + apart};
    for (const double place : places) {
      const double value = place >= 0 && place <= kScan ? value_at(place) : smallest;
      if (value < smallest) {
        smallest = value;
        where = place;
      }
    }
  }
  failed_at_deg_ = (cam_.opens_rad() + where * step) * kDegPerRad;
  return smallest > 0;
}

Status ValveLift::check_contacts() noexcept {
  if (!stays_positive([](const Contact& c) { return c.radius_m; }, smallest_radius_m_)) {
    return refuse("rocker.base_circle_m", Reason::inconsistent);
  }
  smallest_radius_at_deg_ = failed_at_deg_;
  if (rocker_.kind == RockerKind::ratio) return {};
  double smallest = 0;
  if (!stays_positive([](const Contact& c) { return c.triangle; }, smallest))
    return refuse("rocker.pivot_to_pad_m", Reason::inconsistent);
  // The triangle closes, so the reference angles of W and K can be computed: while they are still 0, contact() returns
  // W and K themselves.
  const double full_lift_rad = contact(0).cam_rad;
  rocker_at_rest_rad_ = contact(cam_.opens_rad()).pose.rocker_rad;
  cam_angle_at_full_lift_rad_ = rocker_.cam_turns == CamTurns::toward_pivot ? -full_lift_rad : full_lift_rad;
  if (!stays_positive([](const Contact& c) { return c.sin_pressure; }, smallest))
    return refuse("rocker.pivot_to_cam_m", Reason::inconsistent);
  if (!stays_positive([](const Contact& c) { return c.cos_screw; }, smallest))
    return refuse("rocker.pivot_to_screw_m", Reason::inconsistent);
  return {};
}

ValveLift::Contact ValveLift::contact(double phi_rad) const noexcept {
  const CamLift y = cam_.at(phi_rad);
  if (rocker_.kind == RockerKind::circular_pad) return pad_contact(y, phi_rad);
  const double i = rocker_.ratio;
  const LiftPose pose{i * y.lift_m - rocker_.clearance_m, i * y.per_rad_m, i * y.per_rad2_m, i, 0};
  return {phi_rad, 1, rocker_.base_circle_m + y.lift_m + y.per_rad2_m, 1, 1, 0, 1, pose};
}

ValveLift::Contact ValveLift::pad_contact(const CamLift& y, double phi_rad) const noexcept {
  const double l_a = rocker_.pivot_to_pad_m;
  const double l_c = rocker_.pivot_to_cam_m;
  const double l_b = rocker_.pivot_to_screw_m;
  const double toward = rocker_.cam_turns == CamTurns::toward_pivot ? 1 : -1;

  // Triangle of pivot O, pad centre A and cam centre Oc from its sides; angles from their tangents, accurate to
  // rounding however flat the triangle is.
  const double height = rocker_.base_circle_m + rocker_.pad_radius_m + y.lift_m;
  const double R = square_root(height * height + y.per_rad_m * y.per_rad_m);
  const double area4_squared = (l_a + l_c - R) * (l_a + l_c + R) * (R - l_a + l_c) * (R + l_a - l_c);
  Contact c{};
  c.radius_m = rocker_.base_circle_m + y.lift_m + y.per_rad2_m;
  c.triangle = area4_squared / (l_a * l_a * l_c * l_c);
  if (!(c.triangle > 0)) return c;
  const double area4 = square_root(area4_squared);
  const double W = elementary::atan2(area4, l_a * l_a + l_c * l_c - R * R);  // at O
  const double K = elementary::atan2(area4, l_c * l_c + R * R - l_a * l_a);  // at Oc
  const double gamma = elementary::atan2(y.per_rad_m, height);
  const double pressure = elementary::atan2(area4, l_a * l_a + R * R - l_c * l_c) + toward * gamma;  // J', at A
  c.cam_rad = phi_rad + gamma - toward * (K - cam_angle_at_full_lift_rad_);
  c.pose.rocker_rad = W;
  c.sin_pressure = elementary::sin(pressure);
  if (!(c.sin_pressure > 0)) return c;
  c.cos_pressure = elementary::cos(pressure);
  const double turned = W - rocker_at_rest_rad_;
  const double psi = screw_at_rest_rad_ - turned;
  c.cos_screw = elementary::cos(psi);

  // The pad centre moves on a contour outside the cam's by the pad's radius. dR/dphi = y' offset_radius / R, dK/dR =
  // -cot J / R, dJ/dR = -cot K / R.
  const double offset_radius = c.radius_m + rocker_.pad_radius_m;
  const double arm = l_a * c.sin_pressure;
  c.cam_per_phi = 2 * arm * offset_radius / area4;
  const double cot_K = (l_c * l_c + R * R - l_a * l_a) / area4;
  const double J_per_phi = -cot_K * y.per_rad_m * offset_radius / (R * R);
  const double gamma_per_phi = (height * offset_radius - R * R) / (R * R);
  const double arm_per_cam = l_a * c.cos_pressure * (J_per_phi + toward * gamma_per_phi) / c.cam_per_phi;
  const double W_per_cam = y.per_rad_m / arm;
  const double W_per_cam2 = (y.per_rad2_m / c.cam_per_phi - W_per_cam * arm_per_cam) / arm;
  const double h = 2 * l_b * elementary::cos(screw_at_rest_rad_ - turned / 2) *
                   elementary::sin(turned / 2);  // l_b (sin psi_0 - sin psi)
  c.pose.lift_m = h - rocker_.clearance_m;
  c.pose.per_rad_m = l_b * c.cos_screw * W_per_cam;
  c.pose.per_rad2_m = l_b * (c.cos_screw * W_per_cam2 + elementary::sin(psi) * W_per_cam * W_per_cam);
  c.pose.rocker_ratio = l_b * c.cos_screw / arm;
  return c;
}

bool ValveLift::is_on_lobe(double cam_rad, double& since_opening_rad) const noexcept {
  since_opening_rad = into_turn(cam_rad - opens_rad_);
  return since_opening_rad > 0 && since_opening_rad < closes_rad_ - opens_rad_;
}

/// The flat follower's angle at a place of the lobe, and the contact there.
double ValveLift::phi_at(double since_opening_rad, Contact& c) const noexcept {
  const double wanted = opens_rad_ + since_opening_rad;
  // phi_r increases with phi (check_contacts), so the root stays between `low` and `high`. Newton's method, with
  // bisection where its step leaves that interval or is more than half the step before.
  double low = cam_.opens_rad();
  double high = cam_.closes_rad();
  double phi = low + since_opening_rad;
  double longest_step = (high - low) / 2;
  c = contact(phi);
  for (int i = 0; i < 100; ++i) {
    const double beyond = c.cam_rad - wanted;
    if (beyond > 0) high = phi;
    if (beyond < 0) low = phi;
    double step = -beyond / c.cam_per_phi;
    const double size = step < 0 ? -step : step;
    if (size > longest_step || phi + step < low || phi + step > high) step = (low + high) / 2 - phi;
    longest_step = (step < 0 ? -step : step) / 2;
    phi += step;
    c = contact(phi);
    if (longest_step < 1e-12) break;  // the next step would be its square
  }
  return phi;
}

LiftPose ValveLift::at(double cam_rad) const noexcept {
  double since_opening_rad;
  if (!is_on_lobe(cam_rad, since_opening_rad)) return outside_;
  Contact c;
  static_cast<void>(phi_at(since_opening_rad, c));
  return c.pose;
}

ContactPose ValveLift::contact_at(double cam_rad) const noexcept {
  const double r_0 = rocker_.base_circle_m;
  const bool has_pad = rocker_.kind == RockerKind::circular_pad;
  const double pad_per_m = has_pad ? 1 / rocker_.pad_radius_m : 0;
  double since_opening_rad;
  if (!is_on_lobe(cam_rad, since_opening_rad)) return {1 / r_0 + pad_per_m, 0, r_0, r_0 / 2};
  Contact c;
  const CamLift y = cam_.at(phi_at(since_opening_rad, c));
  // The rocker turns about O by dW/dphi_r = y' / (l_a sin J'), and its surface lies l_a cos J' - r_s beyond O along the
  // normal.
  double follower_m = 0;
  if (has_pad) {
    const double arm = rocker_.pivot_to_pad_m * c.sin_pressure;
    const double beyond = rocker_.pivot_to_pad_m * c.cos_pressure - rocker_.pad_radius_m;
    follower_m = (rocker_.cam_turns == CamTurns::toward_pivot ? 1 : -1) * (y.per_rad_m / arm) * beyond;
  }
  const double sliding_m = r_0 + y.lift_m - follower_m;
  return {1 / c.radius_m + pad_per_m, y.per_rad_m, sliding_m, c.radius_m / c.cam_per_phi - sliding_m / 2};
}

}  // namespace crankloop

// The rules that a valve train keeps; field names as in the engine file.
#include <crankloop/define/valve_train.hpp>

#include "rules.hpp"

namespace crankloop {

using detail::between;
using detail::finite;
using detail::first_refusal;
using detail::none_or_positive;
using detail::not_negative;
using detail::positive;

namespace {

constexpr int kLeastCamPoints = 8;

[[nodiscard]] Status validate_polynomial(const Cam& cam) noexcept {
  const Status answers[] = {positive(cam.max_lift_m, "cam.max_lift", 0.1), between(cam.half_angle_deg, "cam.half_angle", 10, 180)};
  if (const Status refused = first_refusal(answers); !refused.ok()) return refused;
  if (cam.exponent_count < 2) return {Reason::too_few_points, -1, "cam.exponents"};
  if (cam.exponent_count > kMostCamExponents) return {Reason::too_many_points, -1, "cam.exponents"};
  for (int i = 0; i < cam.exponent_count; ++i) {
    if (const Status refused = between(cam.exponents[i], "cam.exponents", 2, 100, i); !refused.ok()) return refused;
    // Closer ones leave nothing but rounding: the coefficients hold 1 / (p_j - p_i).
    if (i > 0 && cam.exponents[i] < cam.exponents[i - 1] + 0.1) return {Reason::not_increasing, i, "cam.exponents"};
  }
  return {};
}

[[nodiscard]] Status validate_table(const Cam& cam) noexcept {
  if (const Status refused = positive(cam.smoothing_m, "cam.smoothing", 0.001); !refused.ok()) return refused;
  if (cam.points == nullptr || cam.point_count < kLeastCamPoints) return {Reason::too_few_points, -1, "cam.file"};
  if (cam.point_count > kMostCamPoints) return {Reason::too_many_points, -1, "cam.file"};
  for (int i = 0; i < cam.point_count; ++i) {
    const CamPoint& point = cam.points[i];
    if (const Status refused = between(point.cam_deg, "cam.file", -360, 360, i); !refused.ok()) return refused;
    if (const Status refused = between(point.lift_m, "cam.file", -0.1, 0.1, i); !refused.ok()) return refused;
    if (i > 0 && point.cam_deg <= cam.points[i - 1].cam_deg) return {Reason::not_increasing, i, "cam.file"};
  }
  if (cam.points[cam.point_count - 1].cam_deg - cam.points[0].cam_deg > 360) return {Reason::out_of_range, -1, "cam.file"};
  return {};
}

[[nodiscard]] Status validate_pad(const Rocker& rocker) noexcept {
  const Status answers[] = {
      positive(rocker.pivot_to_pad_m, "rocker.pivot_to_pad", 1),
      positive(rocker.pivot_to_cam_m, "rocker.pivot_to_cam", 1),
      positive(rocker.pad_radius_m, "rocker.pad_radius", 10),
      positive(rocker.pivot_to_screw_m, "rocker.pivot_to_screw", 1),
      not_negative(rocker.screw_ball_m, "rocker.screw_ball", 1),
      between(rocker.stem_above_pivot_m, "rocker.stem_above_pivot", -1, 1),
  };
  if (const Status refused = first_refusal(answers); !refused.ok()) return refused;
  switch (rocker.cam_turns) {
    case CamTurns::toward_pivot:
    case CamTurns::away_from_pivot: return {};
  }
  return {Reason::out_of_range, -1, "rocker.cam_turns"};  // a number that names neither
}

}  // namespace

Status validate(const Cam& cam) noexcept {
  const Status answers[] = {between(cam.full_lift_deg, "cam.full_lift_at_crank", 0, 720),
                            not_negative(cam.phase_rate_deg_s, "cam.phase_rate", 100000)};
  if (const Status refused = first_refusal(answers); !refused.ok()) return refused;
  if (cam.full_lift_deg == 720) return {Reason::out_of_range, -1, "cam.full_lift_at_crank"};
  switch (cam.source) {
    case CamSource::polynomial: return validate_polynomial(cam);
    case CamSource::table: return validate_table(cam);
  }
  return {Reason::out_of_range, -1, "cam.source"};  // a number that names no source
}

Status validate(const Rocker& rocker) noexcept {
  const Status both[] = {positive(rocker.base_circle_m, "rocker.base_circle", 1), not_negative(rocker.clearance_m, "rocker.clearance", 0.01)};
  if (const Status refused = first_refusal(both); !refused.ok()) return refused;
  switch (rocker.kind) {
    case RockerKind::ratio: {
      const Status answers[] = {positive(rocker.ratio, "rocker.ratio", 10), none_or_positive(rocker.pivot_to_screw_m, "rocker.pivot_to_screw", 1)};
      return first_refusal(answers);
    }
    case RockerKind::circular_pad: return validate_pad(rocker);
  }
  return {Reason::out_of_range, -1, "rocker.kind"};  // a number that names no kind
}

Status validate(const Valve& valve) noexcept {
  if (valve.per_cylinder < 1 || valve.per_cylinder > 8) return {Reason::out_of_range, -1, "valve.per_cylinder"};
  const Status answers[] = {
      positive(valve.valve_kg, "valve.valve", 100),
      not_negative(valve.spring_kg, "valve.spring", 100),
      not_negative(valve.rocker_inertia_kg_m2, "valve.rocker_inertia", 100),
      not_negative(valve.spring_N_m, "valve.spring_rate", 1e9),
      positive(valve.spring_preload_N, "valve.spring_preload", 1e6),
      positive(valve.train_N_m, "valve.train", 1e12),
      not_negative(valve.train_damping_ratio, "valve.train_damping_ratio", 10),
      not_negative(valve.guide_damping_ratio, "valve.guide_damping_ratio", 10),
      positive(valve.seat_N_m, "valve.seat", 1e12),
      not_negative(valve.seat_damping_ratio, "valve.seat_damping_ratio", 10),
      not_negative(valve.head_area_m2, "valve.head_area", 1),
  };
  return first_refusal(answers);
}

Status validate(const ValveTrain& train) noexcept {
  const Status answers[] = {validate(train.cam), validate(train.rocker), validate(train.valve)};
  if (const Status refused = first_refusal(answers); !refused.ok()) return refused;
  const bool has_lever = train.rocker.kind == RockerKind::circular_pad || train.rocker.pivot_to_screw_m > 0;
  if (train.valve.rocker_inertia_kg_m2 > 0 && !has_lever) return {Reason::inconsistent, -1, "valve.rocker_inertia"};
  return {};
}

}  // namespace crankloop

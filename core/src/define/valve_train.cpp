// Validation of a valve train; field names as in the engine file.
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
  const Status answers[] = {positive(cam.max_lift_m, "cam.max_lift_m", 0.1),
                            between(cam.half_angle_deg, "cam.half_angle_deg", 10, 180)};
  if (const Status refused = first_refusal(answers); !refused.ok()) return refused;
  if (cam.exponent_count < 2) return refuse("cam.exponents", Reason::too_few_points);
  if (cam.exponent_count > kMaxCamExponents) return refuse("cam.exponents", Reason::too_many_points);
  for (int i = 0; i < cam.exponent_count; ++i) {
    if (const Status refused = between(cam.exponents[i], "cam.exponents", 2, 100, i); !refused.ok()) return refused;
    // With closer exponents only rounding errors remain: the coefficients contain 1 / (p_j - p_i).
    if (i > 0 && cam.exponents[i] < cam.exponents[i - 1] + 0.1)
      return refuse("cam.exponents", Reason::not_increasing, i);
  }
  return {};
}

[[nodiscard]] Status validate_table(const Cam& cam) noexcept {
  if (const Status refused = positive(cam.smoothing_m, "cam.smoothing_m", 0.001); !refused.ok()) return refused;
  if (cam.points == nullptr || cam.point_count < kLeastCamPoints) return refuse("cam.points", Reason::too_few_points);
  if (cam.point_count > kMaxCamPoints) return refuse("cam.points", Reason::too_many_points);
  for (int i = 0; i < cam.point_count; ++i) {
    const CamPoint& point = cam.points[i];
    if (const Status refused = between(point.cam_deg, "cam.points", -360, 360, i); !refused.ok()) return refused;
    if (const Status refused = between(point.lift_m, "cam.points", -0.1, 0.1, i); !refused.ok()) return refused;
    if (i > 0 && point.cam_deg <= cam.points[i - 1].cam_deg) return refuse("cam.points", Reason::not_increasing, i);
  }
  if (cam.points[cam.point_count - 1].cam_deg - cam.points[0].cam_deg > 360)
    return refuse("cam.points", Reason::out_of_range);
  return {};
}

[[nodiscard]] Status validate_pad(const Rocker& rocker) noexcept {
  const Status answers[] = {
      positive(rocker.pivot_to_pad_m, "rocker.pivot_to_pad_m", 1),
      positive(rocker.pivot_to_cam_m, "rocker.pivot_to_cam_m", 1),
      positive(rocker.pad_radius_m, "rocker.pad_radius_m", 10),
      positive(rocker.pivot_to_screw_m, "rocker.pivot_to_screw_m", 1),
      not_negative(rocker.screw_ball_m, "rocker.screw_ball_m", 1),
      between(rocker.stem_above_pivot_m, "rocker.stem_above_pivot_m", -1, 1),
  };
  if (const Status refused = first_refusal(answers); !refused.ok()) return refused;
  switch (rocker.cam_turns) {
    case CamTurns::toward_pivot:
    case CamTurns::away_from_pivot:
      return {};
  }
  return refuse("rocker.cam_turns", Reason::out_of_range);  // an undefined direction
}

}  // namespace

Status validate(const Cam& cam) noexcept {
  const Status answers[] = {between(cam.full_lift_deg, "cam.full_lift_deg", 0, 720),
                            not_negative(cam.phase_rate_deg_s, "cam.phase_rate_deg_s", 100000)};
  if (const Status refused = first_refusal(answers); !refused.ok()) return refused;
  if (cam.full_lift_deg == 720) return refuse("cam.full_lift_deg", Reason::out_of_range);
  switch (cam.source) {
    case CamSource::polynomial:
      return validate_polynomial(cam);
    case CamSource::table:
      return validate_table(cam);
  }
  return refuse("cam.source", Reason::out_of_range);  // a number that names no source
}

Status validate(const Rocker& rocker) noexcept {
  const Status both[] = {positive(rocker.base_circle_m, "rocker.base_circle_m", 1),
                         not_negative(rocker.clearance_m, "rocker.clearance_m", 0.01)};
  if (const Status refused = first_refusal(both); !refused.ok()) return refused;
  switch (rocker.kind) {
    case RockerKind::ratio: {
      const Status answers[] = {positive(rocker.ratio, "rocker.ratio", 10),
                                none_or_positive(rocker.pivot_to_screw_m, "rocker.pivot_to_screw_m", 1)};
      return first_refusal(answers);
    }
    case RockerKind::circular_pad:
      return validate_pad(rocker);
  }
  return refuse("rocker.kind", Reason::out_of_range);  // an undefined kind
}

Status validate(const Valve& valve) noexcept {
  if (valve.per_cylinder < 1 || valve.per_cylinder > 8) return refuse("valve.per_cylinder", Reason::out_of_range);
  const Status answers[] = {
      positive(valve.valve_kg, "valve.valve_kg", 100),
      not_negative(valve.spring_kg, "valve.spring_kg", 100),
      not_negative(valve.rocker_inertia_kg_m2, "valve.rocker_inertia_kg_m2", 100),
      not_negative(valve.spring_N_m, "valve.spring_N_m", 1e9),
      positive(valve.spring_preload_N, "valve.spring_preload_N", 1e6),
      positive(valve.train_N_m, "valve.train_N_m", 1e12),
      not_negative(valve.train_damping_ratio, "valve.train_damping_ratio", 10),
      not_negative(valve.guide_damping_ratio, "valve.guide_damping_ratio", 10),
      positive(valve.seat_N_m, "valve.seat_N_m", 1e12),
      not_negative(valve.seat_damping_ratio, "valve.seat_damping_ratio", 10),
      not_negative(valve.head_area_m2, "valve.head_area_m2", 1),
  };
  return first_refusal(answers);
}

Status validate(const ValveTrain& train) noexcept {
  const Status answers[] = {validate(train.cam), validate(train.rocker), validate(train.valve)};
  if (const Status refused = first_refusal(answers); !refused.ok()) return refused;
  const bool has_lever = train.rocker.kind == RockerKind::circular_pad || train.rocker.pivot_to_screw_m > 0;
  if (train.valve.rocker_inertia_kg_m2 > 0 && !has_lever)
    return refuse("valve.rocker_inertia_kg_m2", Reason::inconsistent);
  return {};
}

}  // namespace crankloop

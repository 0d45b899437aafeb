// Validation of a valve train and of its cam's contact; field names as in the engine file.
#include <crankloop/define/valve_train.hpp>

#include <crankloop/define/cam_contact.hpp>

#include "rules.hpp"

namespace crankloop {

using detail::first_refusal;
using detail::in_range;
using detail::none_or_positive;
using detail::out_of_range;

namespace {

constexpr int kLeastCamPoints = 8;

[[nodiscard]] Status validate_polynomial(const Cam& cam) noexcept {
  if (cam.exponent_count < 2) return refuse("cam.exponents", Reason::too_few_points);
  if (cam.exponent_count > kMaxCamExponents) return refuse("cam.exponents", Reason::too_many_points);
  if (const Status refused = out_of_range(cam); !refused.ok()) return refused;
  for (int i = 1; i < cam.exponent_count; ++i) {
    // With closer exponents only rounding errors remain: the coefficients contain 1 / (p_j - p_i).
    if (cam.exponents[i] < cam.exponents[i - 1] + 0.1) return refuse("cam.exponents", Reason::not_increasing, i);
  }
  return {};
}

[[nodiscard]] Status validate_table(const Cam& cam) noexcept {
  if (const Status refused = out_of_range(cam); !refused.ok()) return refused;
  if (cam.points == nullptr || cam.point_count < kLeastCamPoints) return refuse("cam.points", Reason::too_few_points);
  if (cam.point_count > kMaxCamPoints) return refuse("cam.points", Reason::too_many_points);
  for (int i = 0; i < cam.point_count; ++i) {
    const CamPoint& point = cam.points[i];
    if (const Status refused = in_range(point.cam_deg, "cam.points", from(-360).up_to(360), i); !refused.ok())
      return refused;
    if (const Status refused = in_range(point.lift_m, "cam.points", from(-0.1).up_to(0.1), i); !refused.ok())
      return refused;
    if (i > 0 && point.cam_deg <= cam.points[i - 1].cam_deg) return refuse("cam.points", Reason::not_increasing, i);
  }
  if (cam.points[cam.point_count - 1].cam_deg - cam.points[0].cam_deg > 360)
    return refuse("cam.points", Reason::out_of_range);
  return {};
}

/// Of springs that surge each has a rate and a mass, together no more than given.
[[nodiscard]] Status validate_springs(const Valve& valve) noexcept {
  if (!(valve.spring_N_m > 0)) return refuse("valve.spring_N_m", Reason::not_positive);
  if (!(valve.spring_kg > 0)) return refuse("valve.spring_kg", Reason::not_positive);
  if ((valve.inner_spring_N_m > 0) != (valve.inner_spring_kg > 0) || !(valve.inner_spring_N_m < valve.spring_N_m))
    return refuse("valve.inner_spring_N_m", Reason::inconsistent);
  if (!(valve.inner_spring_kg < valve.spring_kg)) return refuse("valve.inner_spring_kg", Reason::inconsistent);
  if (!(valve.spring_active_kg <= valve.spring_kg - valve.inner_spring_kg))
    return refuse("valve.spring_active_kg", Reason::inconsistent);
  return {};
}

}  // namespace

Status validate(const Cam& cam) noexcept {
  if (cam.source > CamSource::table) return refuse("cam.source", Reason::out_of_range);
  return cam.source == CamSource::polynomial ? validate_polynomial(cam) : validate_table(cam);
}

Status validate(const Rocker& rocker) noexcept {
  if (rocker.kind > RockerKind::ratio) return refuse("rocker.kind", Reason::out_of_range);
  if (const Status refused = out_of_range(rocker); !refused.ok()) return refused;
  if (rocker.kind == RockerKind::ratio) return none_or_positive(rocker.pivot_to_screw_m, "rocker.pivot_to_screw_m");
  const bool known = rocker.cam_turns <= CamTurns::away_from_pivot;
  return known ? Status{} : refuse("rocker.cam_turns", Reason::out_of_range);
}

Status validate(const Valve& valve) noexcept {
  if (valve.per_cylinder < 1 || valve.per_cylinder > 8) return refuse("valve.per_cylinder", Reason::out_of_range);
  if (valve.surge_modes < 0 || valve.surge_modes > kMaxSpringModes)
    return refuse("valve.surge_modes", Reason::out_of_range);
  if (const Status refused = out_of_range(valve); !refused.ok()) return refused;
  return valve.surge_modes > 0 ? validate_springs(valve) : Status{};
}

Status validate(const CamContact& contact) noexcept {
  if (const Status refused = out_of_range(contact); !refused.ok()) return refused;
  return none_or_positive(contact.width_m, "cam.width_m");
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

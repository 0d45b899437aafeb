#include "contact_curves.hpp"

#include <cstddef>

#include <crankloop/tabulate/cam_contact.hpp>
#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tabulate/valve_lift.hpp>
#include <crankloop/tick/one_instruction.hpp>

#include "curve_fit.hpp"

namespace crankloop::detail {
namespace {

/// A contact of a smaller radius is that of an edge, which no formula of Hertz's describes: its stress is bounded, so
/// that float holds it.
constexpr double kSharpest_per_m = 1e9;

/// Root of p_max^2 / F.
[[nodiscard]] double stress_per_root_N(const CamContact& contact, const ContactPose& pose) noexcept {
  const double per_m = pose.curvature_per_m < kSharpest_per_m ? pose.curvature_per_m : kSharpest_per_m;
  return square_root(contact_modulus_Pa(contact) * per_m / (elementary::kPi * contact.width_m));
}

/// A row of a curve: a degree of the lobe, or the base circle.
template <class Real, class Quantity>
void fill_row(const ValveLift& lift, std::uint32_t row, bool on_lobe, const Quantity& quantity,
              Segment<Real>& to) noexcept {
  const auto at = [&](double u) { return quantity(lift.contact_at(lift.opens_rad() + (row + u) * kRadPerDegree)); };
  if (on_lobe) {
    to = rounded<Real>(fitted<Real>(0, 1, at));
  } else {
    to = {};
    to.c[0] = static_cast<Real>(at(1));
  }
}

template <class Real>
void fill_train(const EngineDefinition& engine, int train, const ValveLift& lift,
                const TableTargets<Real>& targets) noexcept {
  const CamContact& contact = engine.contacts[train];
  const LiftCurve<Real>& curve = targets.lift_curves[train];
  const std::ptrdiff_t first = std::ptrdiff_t{train} * kDegreesPerTurn;
  const bool has_stress = targets.cam_contacts != nullptr && contact.width_m > 0;
  const bool has_friction = targets.cam_torques != nullptr && contact.friction_ratio > 0;
  Segment<Real>* const sliding = has_stress || has_friction ? targets.cam_sliding + first : nullptr;
  CamContactSegment<Real>* const at = has_stress ? targets.cam_contact_segments + first : nullptr;
  for (std::uint32_t row = 0; row < curve.rows() && sliding != nullptr; ++row) {
    const bool on_lobe = row < curve.segments;
    const auto fill = [&](Segment<Real>& to, const auto& quantity) { fill_row(lift, row, on_lobe, quantity, to); };
    fill(sliding[row], [](const ContactPose& pose) { return pose.sliding_m; });
    if (at == nullptr) continue;
    fill(at[row].stress, [&contact](const ContactPose& pose) { return stress_per_root_N(contact, pose); });
    fill(at[row].entrainment_m, [](const ContactPose& pose) { return pose.entrainment_m; });
  }
  if (targets.cam_contacts != nullptr) {
    const double per_width_m = has_stress ? 2 / (elementary::kPi * contact.width_m) : 0;
    targets.cam_contacts[train] = {at, has_stress ? sliding : nullptr, static_cast<Real>(per_width_m)};
  }
  if (targets.cam_torques != nullptr) {
    targets.cam_torques[train] = {has_friction ? sliding : nullptr, static_cast<Real>(contact.friction_ratio),
                                  static_cast<Real>(engine.trains[train].valve.per_cylinder)};
  }
}

}  // namespace

template <class Real>
void fill_contacts(const EngineDefinition& engine, const TableTargets<Real>& targets) noexcept {
  if (targets.cam_contacts == nullptr && targets.cam_torques == nullptr) return;
  for (int t = 0; t < engine.train_count; ++t) {
    ValveLift lift;
    static_cast<void>(lift.init(engine.trains[t].cam, engine.trains[t].rocker));  // accepted before
    fill_train(engine, t, lift, targets);
  }
}

template void fill_contacts(const EngineDefinition&, const TableTargets<float>&) noexcept;
template void fill_contacts(const EngineDefinition&, const TableTargets<double>&) noexcept;

}  // namespace crankloop::detail

#include "valve_curves.hpp"

#include <cstddef>
#include <type_traits>

#include <crankloop/tabulate/valve_lift.hpp>

#include "curve_fit.hpp"
#include "phase_units.hpp"

namespace crankloop::detail {
namespace {

/// Lift, slope and curvature at a knot, by cam degrees.
struct Knot {
  double lift_m;
  double per_deg_m;
  double per_deg2_m;
};

[[nodiscard]] Knot knot(const ValveLift& lift, double cam_rad) noexcept {
  const LiftPose pose = lift.at(cam_rad);
  return {pose.lift_m, pose.per_rad_m * kRadPerDegree, pose.per_rad2_m * (kRadPerDegree * kRadPerDegree)};
}

/// Degrees of the lobe, the last one perhaps only begun.
[[nodiscard]] int lobe_degrees(const ValveLift& lift) noexcept {
  const double degrees = (lift.closes_rad() - lift.opens_rad()) / kRadPerDegree;
  const int whole = static_cast<int>(degrees);
  const int begun = degrees > whole ? whole + 1 : whole;
  return begun < kDegreesPerTurn ? begun : kDegreesPerTurn;
}

template <class Real>
void fill_lift(const Cam& cam, const Rocker& rocker, const ValveLift& lift, double tick_s, LiftCurve<Real>& curve, LiftSegment<Real>* segments,
               Segment<Real>* ratios) noexcept {
  const int degrees = lobe_degrees(lift);
  const auto angle = [&](double degree) { return lift.opens_rad() + degree * kRadPerDegree; };
  for (int i = 0; i < degrees; ++i) {
    const Knot from = knot(lift, angle(i));
    const Knot to = knot(lift, angle(i + 1));
    const LiftQuintic<double> quintic(LiftStep<double>{{from.lift_m, to.lift_m, from.per_deg_m, to.per_deg_m, from.per_deg2_m, to.per_deg2_m}});
    for (int j = 0; j < 6; ++j) segments[i].c[j] = static_cast<Real>(quintic.coefficient(j));
    ratios[i] = rounded<Real>(fitted<Real>(0, 1, [&](double u) { return lift.at(angle(i + u)).rocker_ratio; }));
  }
  curve.at = segments;
  curve.rocker_ratio = ratios;
  // A cam turns 360 deg in the engine's 720: the phase of full lift less the lobe's rise.
  double opens_deg = cam.full_lift_deg + 2 * lift.opens_rad() / kRadPerDegree;
  while (opens_deg < 0) opens_deg += kDegreesPerCycle;
  while (opens_deg >= kDegreesPerCycle) opens_deg -= kDegreesPerCycle;
  curve.opens = phase_units(opens_deg);
  const double most_deg = cam.phase_rate_deg_s * tick_s;
  curve.most_phase_per_tick = most_deg < kDegreesPerTurn ? phase_units(most_deg) : phase_units(kDegreesPerTurn);
  curve.segments = static_cast<std::uint32_t>(degrees);
  curve.outside_m = static_cast<Real>(-rocker.clearance_m);
}

}  // namespace

template <class Real>
Status fill_valves(const EngineDefinition& engine, const TickOptions& options, const TableTargets<Real>& targets) noexcept {
  if (targets.lift_curves == nullptr && targets.valve_motions == nullptr) return {};
  const auto of_train = [](Status refused, int train) {
    refused.index = train;
    return refused;
  };
  ValveMotion<double> motions[kMaxTrains];
  for (int t = 0; t < engine.train_count; ++t) {
    const ValveTrain& train = engine.trains[t];
    ValveLift lift;
    if (const Status refused = lift.init(train.cam, train.rocker); !refused.ok()) return of_train(refused, t);
    if (targets.valve_motions == nullptr) continue;
    if (const Status refused = validate(train.valve); !refused.ok()) return of_train(refused, t);
    const double lever = lift.lever_m() > 0 ? lift.lever_m() : 1;
    if (const Status refused = motion_of(valve_body(train.valve, lever), options.tick_s, options.valves, motions[t]); !refused.ok()) {
      return of_train(refused, t);
    }
  }
  for (int t = 0; t < engine.train_count; ++t) {
    const ValveTrain& train = engine.trains[t];
    if (targets.lift_curves != nullptr) {
      ValveLift lift;
      static_cast<void>(lift.init(train.cam, train.rocker));  // it was accepted above
      const std::ptrdiff_t first = t * kDegreesPerTurn;
      fill_lift(train.cam, train.rocker, lift, options.tick_s, targets.lift_curves[t], targets.lift_segments + first,
                targets.rocker_ratios + first);
    }
    if (targets.valve_motions != nullptr) {
      if constexpr (std::is_same_v<Real, float>) {
        targets.valve_motions[t] = crankloop::rounded(motions[t]);
      } else {
        targets.valve_motions[t] = motions[t];
      }
    }
  }
  return {};
}

template Status fill_valves(const EngineDefinition&, const TickOptions&, const TableTargets<float>&) noexcept;
template Status fill_valves(const EngineDefinition&, const TickOptions&, const TableTargets<double>&) noexcept;

}  // namespace crankloop::detail

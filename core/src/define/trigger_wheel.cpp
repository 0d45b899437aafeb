// Validation of a trigger wheel; field names as in the engine file.
#include <crankloop/define/trigger_wheel.hpp>

#include "rules.hpp"

namespace crankloop {

using detail::in_range;
using detail::out_of_range;

namespace {

/// Smallest permitted distance between edges in crank degrees, far above the rounding of the tables.
constexpr double kLeastApartDeg = 1e-3;

[[nodiscard]] Status validate_teeth(const TriggerWheel& wheel) noexcept {
  int places_left = wheel.places;
  for (int i = 0; i < wheel.gap_count; ++i) {
    const ToothGap& gap = wheel.gaps[i];
    if (gap.teeth < 1 || gap.missing < 1) return refuse("trigger.gaps", Reason::not_positive, i);
    if (gap.teeth > places_left || gap.missing > places_left - gap.teeth)
      return refuse("trigger.gaps", Reason::inconsistent, i);
    places_left -= gap.teeth + gap.missing;
  }
  return {};
}

[[nodiscard]] Status validate_edges(const TriggerWheel& wheel) noexcept {
  if (wheel.edges_deg == nullptr || wheel.edge_count < 2) return refuse("trigger.edges_deg", Reason::too_few_points);
  if (wheel.edge_count > kMaxTriggerEdges) return refuse("trigger.edges_deg", Reason::too_many_points);
  if (wheel.edge_count % 2 != 0) return refuse("trigger.edges_deg", Reason::inconsistent);
  const double first_deg = wheel.edges_deg[0];
  if (const Status refused = in_range(first_deg, "trigger.edges_deg", from(0).below(720), 0); !refused.ok())
    return refused;
  const double turn_deg = wheel.shaft == TriggerShaft::crank ? 360 : 720;
  for (int i = 1; i < wheel.edge_count; ++i) {
    const double most_deg = first_deg + turn_deg - kLeastApartDeg;
    if (const Status refused = in_range(wheel.edges_deg[i], "trigger.edges_deg", from(0).up_to(most_deg), i);
        !refused.ok())
      return refused;
    if (wheel.edges_deg[i] < wheel.edges_deg[i - 1] + kLeastApartDeg)
      return refuse("trigger.edges_deg", Reason::not_increasing, i);
  }
  return {};
}

}  // namespace

Status validate(const TriggerWheel& wheel) noexcept {
  const bool on_crank = wheel.shaft == TriggerShaft::crank;
  if (!on_crank && wheel.shaft != TriggerShaft::cam)
    return refuse("trigger.shaft", Reason::out_of_range);  // an undefined shaft
  if (const Status refused = out_of_range(wheel); !refused.ok()) return refused;
  if (on_crank && wheel.train != -1)
    return refuse("trigger.train", Reason::inconsistent);  // no phaser moves the crankshaft
  switch (wheel.pattern) {
    case TriggerPattern::teeth:
      return validate_teeth(wheel);
    case TriggerPattern::edges:
      return validate_edges(wheel);
  }
  return refuse("trigger.pattern", Reason::out_of_range);  // an undefined pattern
}

}  // namespace crankloop

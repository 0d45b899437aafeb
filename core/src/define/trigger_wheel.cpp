// Validation of a trigger wheel; field names as in the engine file.
#include <crankloop/define/trigger_wheel.hpp>

#include "rules.hpp"

namespace crankloop {

using detail::between;
using detail::first_refusal;

namespace {

/// Smallest permitted distance between edges in crank degrees, far above the rounding of the tables.
constexpr double kLeastApartDeg = 1e-3;

[[nodiscard]] Status from_0_to_below_720(double deg, const char* field, int index) noexcept {
  if (const Status refused = between(deg, field, 0, 720, index); !refused.ok()) return refused;
  return deg < 720 ? Status{} : refuse(field, Reason::out_of_range, index);
}

[[nodiscard]] Status validate_teeth(const TriggerWheel& wheel) noexcept {
  if (wheel.places < 1 || wheel.places > kMaxToothPlaces) return refuse("trigger.places", Reason::out_of_range);
  if (wheel.gap_count < 0 || wheel.gap_count > kMaxToothGaps) return refuse("trigger.gap_count", Reason::out_of_range);
  int places_left = wheel.places;
  for (int i = 0; i < wheel.gap_count; ++i) {
    const ToothGap& gap = wheel.gaps[i];
    if (gap.teeth < 1 || gap.missing < 1) return refuse("trigger.gaps", Reason::not_positive, i);
    if (gap.teeth > places_left || gap.missing > places_left - gap.teeth)
      return refuse("trigger.gaps", Reason::inconsistent, i);
    places_left -= gap.teeth + gap.missing;
  }
  const Status answers[] = {from_0_to_below_720(wheel.first_tooth_deg, "trigger.first_tooth_deg", -1),
                            between(wheel.tooth_ratio, "trigger.tooth_ratio", 0.01, 0.99)};
  return first_refusal(answers);
}

[[nodiscard]] Status validate_edges(const TriggerWheel& wheel) noexcept {
  if (wheel.edges_deg == nullptr || wheel.edge_count < 2) return refuse("trigger.edges_deg", Reason::too_few_points);
  if (wheel.edge_count > kMaxTriggerEdges) return refuse("trigger.edges_deg", Reason::too_many_points);
  if (wheel.edge_count % 2 != 0) return refuse("trigger.edges_deg", Reason::inconsistent);
  const double first_deg = wheel.edges_deg[0];
  if (const Status refused = from_0_to_below_720(first_deg, "trigger.edges_deg", 0); !refused.ok()) return refused;
  const double turn_deg = wheel.shaft == TriggerShaft::crank ? 360 : 720;
  for (int i = 1; i < wheel.edge_count; ++i) {
    const double most_deg = first_deg + turn_deg - kLeastApartDeg;
    if (const Status refused = between(wheel.edges_deg[i], "trigger.edges_deg", 0, most_deg, i); !refused.ok())
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
  if (wheel.train < -1 || wheel.train >= kMaxTrains) return refuse("trigger.train", Reason::out_of_range);
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

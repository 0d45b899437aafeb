#include "valve_curves.hpp"

#include <cstddef>
#include <type_traits>

#include <crankloop/assert.hpp>
#include <crankloop/tabulate/spring_margin.hpp>
#include <crankloop/tabulate/valve_lift.hpp>
#include <crankloop/tabulate/valve_springs.hpp>
#include <crankloop/tick/one_instruction.hpp>

#include "curve_fit.hpp"
#include "phase_units.hpp"
#include "rounding.hpp"

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

/// Degrees of the lobe, including a fraction at its end.
[[nodiscard]] int lobe_degrees(const ValveLift& lift) noexcept {
  const double degrees = (lift.closes_rad() - lift.opens_rad()) / kRadPerDegree;
  const int whole = static_cast<int>(degrees);
  const int begun = degrees > whole ? whole + 1 : whole;
  return begun < kDegreesPerTurn ? begun : kDegreesPerTurn;
}

/// One degree of the lift, Y(u) = c[0] + u (c[1] + ...), with the lift's values, slopes and curvatures at both ends.
struct DegreeQuintic {
  double c[6];

  DegreeQuintic(const ValveLift& lift, int degree) noexcept {
    const Knot a = knot(lift, lift.opens_rad() + degree * kRadPerDegree);
    const Knot b = knot(lift, lift.opens_rad() + (degree + 1) * kRadPerDegree);
    const double rise = b.lift_m - a.lift_m - a.per_deg_m - a.per_deg2_m / 2;
    const double slope = b.per_deg_m - a.per_deg_m - a.per_deg2_m;
    const double curvature = b.per_deg2_m - a.per_deg2_m;
    c[0] = a.lift_m;
    c[1] = a.per_deg_m;
    c[2] = a.per_deg2_m / 2;
    c[3] = 10 * rise - 4 * slope + curvature / 2;
    c[4] = -15 * rise + 7 * slope - curvature;
    c[5] = 6 * rise - 3 * slope + curvature / 2;
  }

  [[nodiscard]] double value(double u) const noexcept {
    return c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5]))));
  }
  [[nodiscard]] double fourth_derivative(double u) const noexcept { return 24 * c[4] + 120 * c[5] * u; }
};

/// Cam degrees over which the error of the cubic through a step's ends, h^4 / 384 times the lift's largest fourth
/// derivative, is at most a tenth of the accuracy.
[[nodiscard]] double tenth_of_class_deg(const ValveLift& lift, double accuracy_m) noexcept {
  double largest = 0;
  for (int i = 0; i < lobe_degrees(lift); ++i) {
    const DegreeQuintic quintic(lift, i);
    for (const double u : {0.0, 1.0}) {
      const double derivative = quintic.fourth_derivative(u);
      if (derivative > largest) largest = derivative;
      if (-derivative > largest) largest = -derivative;
    }
  }
  const double allowed = 384 * accuracy_m / 10;
  return square_root(square_root(allowed / largest));
}

/// The cubic's error reaches the accuracy class at 1.78 times that width. With the lift in the middle of the step the
/// error stays within the class up to 3 times the width, where the cubic's would be 8 classes:
/// docs/decisions/0014-valve-records.md has the figures.
void set_widths(double tenth_of_class_deg, ValveMotion<double>& motion) noexcept {
  const auto times = [&](double ratio) {
    const double deg = ratio * tenth_of_class_deg;
    return deg < kDegreesPerTurn ? deg : kDegreesPerTurn;
  };
  motion.cubic_deg = times(1.75);
  motion.widest_step_deg = times(3);
}

/// Whether the train can touch a closed valve in a degree.
[[nodiscard]] bool touches(const DegreeQuintic& quintic) noexcept {
  constexpr int kLooks = 16;  // the cam is smooth: its rise between two samples is small against the margin of a degree
  for (int look = 0; look <= kLooks; ++look) {
    if (quintic.value(static_cast<double>(look) / kLooks) > -kLeastLash) return true;
  }
  return false;
}

template <class Real>
void fill_lift(const Cam& cam, const Rocker& rocker, const Layout& layout, const ValveLift& lift, double tick_s,
               LiftCurve<Real>& curve, LiftSegment<Real>* segments, Segment<Real>* ratios) noexcept {
  const int degrees = lobe_degrees(lift);
  CRANKLOOP_ASSERT(degrees >= 1 && degrees <= kDegreesPerTurn);
  const auto angle = [&](double degree) { return lift.opens_rad() + degree * kRadPerDegree; };
  int first = degrees;
  int last = 0;
  for (int i = 0; i < degrees; ++i) {
    const DegreeQuintic quintic(lift, i);
    for (int j = 0; j < 6; ++j) segments[i].c[j] = static_cast<Real>(quintic.c[j]);
    if (touches(quintic)) {
      if (first == degrees) first = i;
      last = i;
    }
    ratios[i] = rounded<Real>(fitted<Real>(0, 1, [&](double u) { return lift.at(angle(i + u)).rocker_ratio; }));
  }
  if (degrees < kDegreesPerTurn) {
    segments[degrees] = {{static_cast<Real>(-rocker.clearance_m)}};
    ratios[degrees] = {};
    ratios[degrees].c[0] = static_cast<Real>(lift.at(angle(degrees + 1)).rocker_ratio);  // on the base circle
  }
  curve.at = segments;
  curve.rocker_ratio = ratios;
  // A cam turns 360 deg in the engine's 720. opens_rad() is the start of the lobe relative to full lift.
  double opens_deg = cam.full_lift_deg + 2 * lift.opens_rad() / kRadPerDegree;
  while (opens_deg < 0) opens_deg += kDegreesPerCycle;
  while (opens_deg >= kDegreesPerCycle) opens_deg -= kDegreesPerCycle;
  for (int k = 0; k < kMaxCylinders; ++k) {
    const auto i = static_cast<std::size_t>(k);
    curve.opens[i] = k < layout.cylinders ? phase_units(layout.firing_deg[i]) + phase_units(opens_deg) : 0;
    // float rounds by 8e-8 cam degrees, so that a tick need not read the low word.
    if constexpr (sizeof(Real) == 4) curve.opens[i] = (curve.opens[i] + 0x8000'0000u) >> 32 << 32;
  }
  first = first > 0 ? first - 1 : 0;  // a margin of one degree at either end
  last = last + 1 < degrees ? last + 1 : degrees - 1;
  if (rocker.clearance_m < kLeastLash) first = 0, last = kDegreesPerTurn - 1;  // on the base circle too
  curve.touch_from = static_cast<std::uint32_t>(first);
  curve.touch_degrees = static_cast<std::uint32_t>(last >= first ? last - first + 1 : 0);
  curve.skip_deg =
      static_cast<Real>(curve.touch_degrees > 0 ? static_cast<double>(curve.touch_degrees) : kDegreesPerTurn + 1.0);
  const double most_deg = cam.phase_rate_deg_s * tick_s;
  curve.most_phase_per_tick = most_deg < kDegreesPerTurn ? phase_units(most_deg) : phase_units(kDegreesPerTurn);
  curve.segments = static_cast<std::uint32_t>(degrees);
  curve.outside_m = static_cast<Real>(0 - rocker.clearance_m);  // not -0: the table's row gives +0
}

/// Marks the degrees of the train's cam angle in which a cylinder's cam may be in a range of its own turn, `from`
/// counted from the start of its lobe. One degree more, because a lobe may start anywhere within a degree.
template <class Real>
void mark(const LiftCurve<Real>& curve, int cylinders, std::uint32_t from, std::uint32_t degrees,
          CamDegrees& to) noexcept {
  if (degrees == 0) return;
  for (int k = 0; k < cylinders; ++k) {
    const std::uint32_t first = LiftCurve<Real>::cell(curve.opens[k]).degree + from;
    for (std::uint32_t i = 0; i <= degrees; ++i)
      to.cylinders[(first + i) % kDegreesPerTurn] |= static_cast<std::uint16_t>(1u << k);
  }
}

template <class Real>
void fill_cam_degrees(const LiftCurve<Real>& curve, int cylinders, int train,
                      const TableTargets<Real>& targets) noexcept {
  if (targets.near_cams != nullptr) {
    targets.near_cams[train] = {};
    mark(curve, cylinders, curve.touch_from, curve.touch_degrees, targets.near_cams[train]);
  }
  if (targets.near_lobes != nullptr) {
    targets.near_lobes[train] = {};
    mark(curve, cylinders, curve.touch_from, curve.touch_degrees, targets.near_lobes[train]);
    mark(curve, cylinders, 0, curve.segments, targets.near_lobes[train]);
  }
  if (targets.cycle_ends != nullptr) {
    constexpr std::uint32_t kMargin = kCycleEndMargin_deg + 1;  // and a degree for rounding
    const std::uint32_t middle = LiftCurve<Real>::cell(curve.base_middle()).degree;
    targets.cycle_ends[train] = {};
    mark(curve, cylinders, middle + kDegreesPerTurn - kMargin, 2 * kMargin, targets.cycle_ends[train]);
  }
}

/// Keeps the lowest static redline of the trains.
void record_redline(const StaticRedline& of_train, int train, TableReport& report) noexcept {
  if (!(of_train.crank_rad_s > 0)) return;
  if (report.static_redline_train >= 0 && of_train.crank_rad_s >= report.static_redline_rad_s) return;
  report.static_redline_rad_s = of_train.crank_rad_s;
  report.static_redline_deg = of_train.cam_deg;
  report.static_redline_train = train;
}

}  // namespace

template <class Real>
Status fill_valves(const EngineDefinition& engine, const TickOptions& options, const TableTargets<Real>& targets,
                   TableReport& report) noexcept {
  if (targets.lift_curves == nullptr && targets.valve_motions == nullptr) return {};
  const auto of_train = [](Status refused, int train) {
    refused.index = train;
    return refused;
  };
  ValveMotion<double> motions[kMaxTrains];
  SurgeOfValve surges[kMaxTrains];
  int fine_steps = 0;
  double class_deg = kDegreesPerTurn;
  for (int t = 0; t < engine.train_count; ++t) {
    const ValveTrain& train = engine.trains[t];
    ValveLift lift;
    if (const Status refused = lift.init(train.cam, train.rocker); !refused.ok()) return of_train(refused, t);
    if (targets.valve_motions == nullptr) continue;
    const ValveBody<double> body = valve_body(train.valve, lift);
    if (const Status refused = surge_of(train.valve, options.tick_s, surges[t]); !refused.ok())
      return of_train(refused, t);
    if (const Status refused = motion_of(beside_modes(body, surges[t]), options.tick_s, options.valves, motions[t]);
        !refused.ok()) {
      return of_train(refused, t);
    }
    if (!(surge_growth(motions[t], surges[t].springs) < kMostSurgeGrowth))
      return refuse("valve.surge_modes", Reason::unstable, t);
    set_widths(tenth_of_class_deg(lift, options.valves.accuracy_m), motions[t]);
    find_decoupled(motions[t], train.rocker.clearance_m);
    fine_steps += static_cast<int>(motions[t].parts) * engine.layout.cylinders;
    if (fine_steps > kMaxFineStepsOfEngine) return refuse("options.tick_s", Reason::out_of_range, t);
    if (options.valves.event_budget != 0 &&
        options.valves.event_budget < static_cast<int>(motions[t].parts + kUnitsOfEvent))
      return refuse("options.valves.event_budget", Reason::out_of_range, t);
    const double keeps_deg = motions[t].cubic_deg * motions[t].parts;
    if (keeps_deg < class_deg) class_deg = keeps_deg;
    record_redline(static_redline(lift, body), t, report);
    const double surge_error = surge_error_ratio(surges[t], options.tick_s);
    if (surge_error > report.surge_error_ratio) report.surge_error_ratio = surge_error;
  }
  report.valve_fine_steps = fine_steps;
  report.valve_class_deg = targets.valve_motions != nullptr ? class_deg : 0;
  std::uint32_t event_budget = 0;
  const int valves = engine.train_count * engine.layout.cylinders;
  if (targets.valve_motions != nullptr && engine.train_count > 0) {
    event_budget = options.valves.event_budget != 0 ? static_cast<std::uint32_t>(options.valves.event_budget)
                                                    : usual_event_budget(fine_steps, valves);
  }
  report.event_budget = static_cast<int>(event_budget);
  for (int t = 0; t < engine.train_count; ++t) {
    const ValveTrain& train = engine.trains[t];
    if (targets.lift_curves != nullptr) {
      ValveLift lift;
      static_cast<void>(lift.init(train.cam, train.rocker));  // accepted above
      const std::ptrdiff_t first = std::ptrdiff_t{t} * kDegreesPerTurn;
      fill_lift(train.cam, train.rocker, engine.layout, lift, options.tick_s, targets.lift_curves[t],
                targets.lift_segments + first, targets.rocker_ratios + first);
      fill_cam_degrees(targets.lift_curves[t], engine.layout.cylinders, t, targets);
    }
    if (targets.valve_motions != nullptr) {
      motions[t].event_budget = event_budget;
      if constexpr (std::is_same_v<Real, float>) {
        targets.valve_motions[t] = crankloop::rounded(motions[t]);
      } else {
        targets.valve_motions[t] = motions[t];
      }
    }
    if (targets.valve_springs != nullptr) round_into(surges[t].springs, targets.valve_springs[t]);
  }
  return {};
}

template Status fill_valves(const EngineDefinition&, const TickOptions&, const TableTargets<float>&,
                            TableReport&) noexcept;
template Status fill_valves(const EngineDefinition&, const TickOptions&, const TableTargets<double>&,
                            TableReport&) noexcept;

}  // namespace crankloop::detail

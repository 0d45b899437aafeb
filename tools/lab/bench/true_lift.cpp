#include "true_lift.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "engines.hpp"

namespace crankloop::program::bench {
namespace {

constexpr double kRest_m = 1e-9;  // nearer to the seat, the library puts a valve at rest
constexpr double kFiner = 2;      // factor on the reference's steps: its error is below 1e-6 um with and without it

}  // namespace

double cam_deg_from_full_lift(std::uint64_t phase, double full_lift_deg) noexcept {
  return static_cast<double>(static_cast<std::int64_t>(phase - phase_at_cam_deg(0, full_lift_deg).units())) *
         kCamDegPerUnit;
}

Phase phase_at_cam_deg(double cam_deg, double full_lift_deg) noexcept {
  const double cycles = full_lift_deg / 720 + cam_deg / 360;
  return Phase::from_cycles(cycles - static_cast<double>(static_cast<long>(cycles)));
}

TrueLift::TrueLift(const ValveTrain& train, double engine_rpm) : deg_per_s_{engine_rpm / 2 * 6} {
  ValveLift lift;
  if (!lift.init(train.cam, train.rocker).ok()) throw std::logic_error("the benchmark's valve train was refused");
  valve_reference::Reference reference(valve_reference::SingleMass(train.valve, train.rocker, lift.largest_lift_m()),
                                       valve_reference::TurnedCam(lift), kFiner);
  reference.keep_moments = true;
  reference.advance(360 / deg_per_s_, -180, 180);
  if (std::fabs(reference.y) > kRest_m) {
    cycles_ = kCyclesToSettle;
    for (int cycle = 1; cycle < cycles_; ++cycle)
      reference.advance(360 / deg_per_s_, -180 + 360.0 * cycle, 180 + 360.0 * cycle);
  }
  changes_ = reference.changes;
  moments_ = std::move(reference.moments);
}

double TrueLift::lift_m(double cam_deg) const noexcept {
  const auto after = std::lower_bound(moments_.begin(), moments_.end(), cam_deg,
                                      [](const valve_reference::Moment& m, double deg) { return m.cam_deg < deg; });
  if (after == moments_.begin()) return after->y;
  if (after == moments_.end()) return moments_.back().y;
  const valve_reference::Moment& from = *(after - 1);
  const valve_reference::Moment& to = *after;
  const double h = (to.cam_deg - from.cam_deg) / deg_per_s_;
  if (!(h > 0)) return to.y;
  const double x = (cam_deg - from.cam_deg) / (to.cam_deg - from.cam_deg);
  // Quintic Hermite: value, speed and acceleration of this piece at both its ends.
  const double v0 = from.v * h, v1 = to.v * h, a0 = from.a_after * h * h / 2, a1 = to.a * h * h / 2;
  const double rise = to.y - from.y;
  const double p = rise - v0 - a0, q = v1 - v0 - 2 * a0, r = a1 - a0;
  return from.y +
         x * (v0 + x * (a0 + x * ((10 * p - 4 * q + r) + x * ((-15 * p + 7 * q - 2 * r) + x * (6 * p - 3 * q + r)))));
}

const TrueLift& true_lift_of_ohc_125(double engine_rpm) {
  static std::map<double, TrueLift> known;
  const auto at = known.find(engine_rpm);
  return at != known.end() ? at->second
                           : known.emplace(engine_rpm, TrueLift(ohc_125_train(), engine_rpm)).first->second;
}

}  // namespace crankloop::program::bench

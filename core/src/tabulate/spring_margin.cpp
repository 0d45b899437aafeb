#include <crankloop/tabulate/spring_margin.hpp>

#include <limits>

#include <crankloop/phase.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop {

using namespace detail;

namespace {

constexpr int kScan = 720;           // steps over the lobe, at most half a degree; a smoothed table has 250 pieces
constexpr double kSame = 1e-12;      // relative difference of equal values
constexpr double kOutside = -1;      // less than any place of the lobe has
constexpr double kFinest = 0x1p-20;  // of a step: 5e-7 deg
constexpr double kCrankPerCam = 2;   // turns
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Force that slows the valve down over the spring's, per squared speed of the cam: the margin's reciprocal, which has
/// no pole. 0 where nothing does, kOutside while the lash is open.
[[nodiscard]] double slowing_s2(const LiftPose& pose, const ValveBody<double>& body) noexcept {
  if (!(pose.lift_m >= 0)) return kOutside;
  if (!(pose.per_rad2_m < 0)) return 0;
  return -body.mass_kg * pose.per_rad2_m / (body.preload_N + body.spring_N_m * pose.lift_m);
}

/// A place of the lobe, in steps from full lift.
struct Place {
  double steps;
  double slowing_s2;

  [[nodiscard]] bool is_beaten_by(double other_s2) const noexcept { return other_s2 > slowing_s2 * (1 + kSame); }
};

/// The largest value within a step of `from`, where there is one peak.
template <class SlowingAt>
[[nodiscard]] Place peak_near(Place from, const SlowingAt& slowing_at) noexcept {
  for (double apart = 0.5; apart >= kFinest; apart /= 2) {
    const double sides[] = {from.steps - apart, from.steps + apart};
    for (const double steps : sides) {
      const double value = slowing_at(steps);
      if (from.is_beaten_by(value)) from = {steps, value};
    }
  }
  return from;
}

}  // namespace

double StaticRedline::margin(double speed_rad_s) const noexcept {
  if (!(crank_rad_s > 0) || speed_rad_s == 0) return kInfinity;
  const double ratio = crank_rad_s / speed_rad_s;
  return ratio * ratio;
}

double spring_margin(const LiftPose& pose, const ValveBody<double>& body, double crank_rad_s) noexcept {
  const double cam_rad_s = crank_rad_s / kCrankPerCam;
  const double slowing = slowing_s2(pose, body) * cam_rad_s * cam_rad_s;
  return slowing > 0 ? 1 / slowing : kInfinity;
}

StaticRedline static_redline(const ValveLift& lift, const ValveBody<double>& body) noexcept {
  const double step_rad = (lift.closes_rad() - lift.opens_rad()) / kScan;
  if (!(step_rad > 0)) return {};
  const double first = lift.opens_rad() / step_rad;
  const auto slowing_at = [&](double steps) { return slowing_s2(lift.at(steps * step_rad), body); };
  Place best = peak_near({0, slowing_at(0)}, slowing_at);
  double before = kOutside;
  Place here{first, slowing_at(first)};
  for (int i = 0; i <= kScan; ++i) {
    const Place next{first + (i + 1), slowing_at(first + (i + 1))};
    if (here.slowing_s2 > 0 && here.slowing_s2 > before && here.slowing_s2 >= next.slowing_s2) {
      const Place peak = peak_near(here, slowing_at);
      if (best.is_beaten_by(peak.slowing_s2)) best = peak;
    }
    before = here.slowing_s2;
    here = next;
  }
  if (!(best.slowing_s2 > 0)) return {};
  return {kCrankPerCam / square_root(best.slowing_s2), best.steps * step_rad / kRadPerDegree};
}

}  // namespace crankloop

#include "flow_area.hpp"

#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tick/gas/gas_properties.hpp>

#include "../files/units.hpp"

namespace crankloop::program {
namespace {

constexpr double kCrankPerCam = 2;
constexpr double kHeatRatio = 1.4;  // of air

/// Where the theoretical lift passes 0, between an end of the lobe and an open angle of the cam: without clearance at
/// that end.
double passes_zero_rad(const ValveLift& lift, double closed_rad, double open_rad) noexcept {
  if (!(lift.at(closed_rad).lift_m < 0)) return closed_rad;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle_rad = (closed_rad + open_rad) / 2;
    (lift.at(middle_rad).lift_m > 0 ? open_rad : closed_rad) = middle_rad;
  }
  return open_rad;
}

}  // namespace

FlowArea::FlowArea(const PortGeometry& geometry, const PortOfTrain& port) noexcept
    : geometry_{geometry},
      port_{port},
      sin_{elementary::sin(geometry.seat_angle_deg * kRadPerDeg)},
      cos_{elementary::cos(geometry.seat_angle_deg * kRadPerDeg)},
      low_m_{geometry.seat_width_m / (sin_ * cos_)},
      port_m2_{kPi / 4 * (geometry.port_m * geometry.port_m - geometry.stem_m * geometry.stem_m)} {
  if (!(port_.seat_diameter_m > 0)) port_.seat_diameter_m = geometry.seat_m;
}

double FlowArea::geometric_m2(double lift_m) const noexcept {
  if (!(lift_m > 0)) return 0;
  const PortGeometry& g = geometry_;
  if (lift_m <= low_m_) {
    return std::min(port_m2_, kPi * lift_m * cos_ * (g.head_m - 2 * g.seat_width_m + lift_m * sin_ * cos_));
  }
  const double axial_m = lift_m - g.seat_width_m * sin_ / cos_;
  const double slant_m = std::sqrt(axial_m * axial_m + g.seat_width_m * g.seat_width_m);
  return std::min(port_m2_, kPi * (g.head_m - g.seat_width_m) * slant_m);
}

double FlowArea::effective_m2(double lift_m) const noexcept {
  if (!(lift_m > 0)) return 0;
  const double seat_m = port_.seat_diameter_m;
  const double at = lift_m / seat_m;
  int row = 1;
  while (row < port_.flow_count && at > port_.flow_lift_ratio[row]) ++row;
  double ratio = port_.flow_ratio[port_.flow_count - 1];
  if (row < port_.flow_count) {
    const double share =
        (at - port_.flow_lift_ratio[row - 1]) / (port_.flow_lift_ratio[row] - port_.flow_lift_ratio[row - 1]);
    ratio = port_.flow_ratio[row - 1] + share * (port_.flow_ratio[row] - port_.flow_ratio[row - 1]);
  }
  return kPi / 4 * seat_m * seat_m * ratio;
}

FlowIntegrals theoretical_flow(const FlowArea& area, const ValveLift& lift) noexcept {
  constexpr int kParts = 8192;
  if (!(lift.largest_lift_m() > 0)) return {};
  const double from_rad = passes_zero_rad(lift, lift.opens_rad(), 0);
  const double to_rad = passes_zero_rad(lift, lift.closes_rad(), 0);
  const double part_rad = (to_rad - from_rad) / kParts;
  FlowSum sum(area, 0, kCrankPerCam * part_rad * kDegPerRad);
  for (int i = 0; i <= kParts; ++i) {
    const bool at_end = i == 0 || i == kParts;
    sum.add(at_end ? 0 : lift.at(from_rad + i * part_rad).lift_m);
  }
  FlowIntegrals flow = sum.largest();
  flow.open_deg = kCrankPerCam * (to_rad - from_rad) * kDegPerRad;
  return flow;
}

void FlowSum::add(double lift_m) noexcept {
  const double low_m = std::min(last_m_, lift_m) - closed_m_;
  const double high_m = std::max(last_m_, lift_m) - closed_m_;
  if (started_ && high_m > 0) {
    opening_.open_deg += step_deg_ * (low_m >= 0 ? 1 : high_m / (high_m - low_m));
    opening_.geometric_m2_deg += step_deg_ / 2 * (area_.geometric_m2(last_m_) + area_.geometric_m2(lift_m));
    opening_.effective_m2_deg += step_deg_ / 2 * (area_.effective_m2(last_m_) + area_.effective_m2(lift_m));
    if (opening_.geometric_m2_deg > largest_.geometric_m2_deg) largest_ = opening_;
  }
  if (!(lift_m > closed_m_)) opening_ = {};
  started_ = true;
  last_m_ = lift_m;
}

FlowFigures flow_figures(const PortArea& area, const EngineDefinition& engine, double speed_rad_s) noexcept {
  const double moved_m3_s = bore_area_m2(engine.crank) * mean_piston_speed_m_s(engine.crank, std::abs(speed_rad_s));
  const double sound_m_s = std::sqrt(kHeatRatio * detail::kGasConstant<double> * engine.gas.ambient_K);
  return {area.geometric_m2 / swept_volume_m3(engine.crank), moved_m3_s / area.geometric_m2,
          moved_m3_s / (area.effective_m2 * sound_m_s)};
}

}  // namespace crankloop::program

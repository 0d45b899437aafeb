// Section of the engine report: loads over the speed, at the run's load ratio.
#include <algorithm>
#include <cmath>

#include "../files/units.hpp"
#include "engine_report_parts.hpp"

namespace crankloop::program {
namespace {

using report::Plot;
using report::Series;

constexpr int kLoadSpeeds = 26;
constexpr double kLoadFrom = 0.2;  ///< of the larger of rated speed and the run's
constexpr double kLoadTo = 1.2;
constexpr double kStep_deg = 2;

}  // namespace

report::Section speed_section(const ReportInput& input) {
  const double high_rpm = std::max(input.operation.speed_rpm, input.file.rated_rpm());
  Plot loads = plot_of("Largest loads", axis_of("Engine speed", "rpm"), axis_of("Load", "kN"));
  loads.y.include_zero = true;
  loads.series = {
      {"crank pin", {}, {}, {}}, {"rod, pushed", {}, {}, {}}, {"rod, pulled", {}, {}, {}}, {"side", {}, {}, {}}};
  Plot torque = plot_of("Torque of the engine", axis_of("Engine speed", "rpm"), axis_of("Torque", "Nm"));
  torque.series = {{"largest", {}, {}, {}}, {"smallest", {}, {}, {}}, {"mean", {}, {}, {}}};
  for (int i = 0; i < kLoadSpeeds; ++i) {
    const double rpm = high_rpm * (kLoadFrom + (kLoadTo - kLoadFrom) * i / (kLoadSpeeds - 1));
    const double speed_rad_s = rpm * kRad_sPerRpm;
    double most[4] = {};
    double largest_Nm = -1e300;
    double smallest_Nm = 1e300;
    double sum_Nm = 0;
    for (double deg = 0; deg < 720; deg += kStep_deg) {
      const CylinderForces<double> f = input.exact.forces(0, deg, speed_rad_s, input.operation.load_ratio);
      const PinLoad pin = input.exact.pin_load(0, deg, speed_rad_s, input.operation.load_ratio);
      const double now[4] = {std::hypot(pin.radial_N, pin.tangential_N), f.rod_force_N, -f.rod_force_N,
                             std::abs(f.side_force_N)};
      for (int k = 0; k < 4; ++k) most[k] = std::max(most[k], now[k]);
      const double torque_Nm = input.exact.torque_Nm(deg, speed_rad_s, input.operation.load_ratio);
      largest_Nm = std::max(largest_Nm, torque_Nm);
      smallest_Nm = std::min(smallest_Nm, torque_Nm);
      sum_Nm += torque_Nm;
    }
    const double torques[3] = {largest_Nm, smallest_Nm, sum_Nm * kStep_deg / 720};
    for (std::size_t k = 0; k < 4; ++k) {
      loads.series[k].x.push_back(rpm);
      loads.series[k].y.push_back(most[k] * kKilo);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      torque.series[k].x.push_back(rpm);
      torque.series[k].y.push_back(torques[k]);
    }
  }
  loads.caption =
      "Of cylinder 1, magnitudes. Gas dominates at low speed. Inertia forces grow with the square of the speed: "
      "they first reduce the loads and then dominate them.";
  torque.caption =
      "The pressure diagram and the mean torque are the same at every speed: the mean torque of the masses is zero.";
  report::Section section{"over-speed", "Loads over the speed", {}};
  section.blocks.push_back(std::move(loads));
  section.blocks.push_back(std::move(torque));
  return section;
}

}  // namespace crankloop::program

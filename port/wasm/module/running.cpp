#include "running.hpp"

#include <cstring>

#include <crankloop/fmi/name.hpp>
#include <crankloop/tabulate/mechanism.hpp>

namespace crankloop::page {
namespace {

using detail::real;

/// What the module itself computes of a cycle, before the engine's own results.
constexpr detail::Variable kOfEngine[] = {
    real("mean_torque_Nm", "Of the last whole cycle: work on the crankshaft over the angle turned"),
    real("power_W", "Indicated: that work over the cycle's time"),
    real("net_mep_Pa", "That work over the swept volume of all cylinders"),
    real("mean_speed_rad_s", "Mean over the cycle's time"),
    real("least_speed_rad_s", "Lowest speed at a tick"),
    real("largest_speed_rad_s", "Highest speed at a tick"),
};
constexpr detail::Variable kPeakPressure = real("peak_pressure_Pa[#]", "Largest pressure at a tick");
constexpr detail::Variable kPeakAngle =
    real("peak_pressure_deg[#]", "Where it was, after the cylinder's firing top dead centre");

/// Outputs that hold for the last whole cycle.
bool is_of_cycle(const char* name) {
  for (const char* of_cycle :
       {"valve_cycle[", "gas_cycle[", "cycle_blow_by", "cycle_burn[", "knock_", "cam_contact_cycle[", "misfire["})
    if (std::strncmp(name, of_cycle, std::strlen(of_cycle)) == 0) return true;
  return false;
}

}  // namespace

Running::Running(const program::EngineFile& file, double tick_s)
    : tick_s_{tick_s}, swept_m3_{swept_volume_m3(file.definition().crank) * file.definition().layout.cylinders} {
  const Layout& layout = file.definition().layout;
  firing_deg_.assign(layout.firing_deg.begin(), layout.firing_deg.begin() + layout.cylinders);
}

const Probe* Running::find(const std::string& name) const {
  for (const Probe& probe : channels_) {
    if (detail::is_named(probe.variable, name.c_str())) return &probe;
  }
  return nullptr;
}

bool Running::watch(const std::vector<std::string>& names, std::string& unknown) {
  std::vector<const Probe*> found;
  for (const std::string& name : names) {
    found.push_back(find(name));
    if (found.back() == nullptr) return unknown = name, false;
  }
  columns_ = std::move(found);
  samples_.clear();
  return true;
}

void Running::list_results(const Phase& of_engine) {
  phase_ = &of_engine;
  mean_torque_ = RealOutput(*find("mean_torque_Nm"));
  speed_ = RealOutput(*find("speed_rad_s"));
  for (std::uint32_t k = 0; k < firing_deg_.size(); ++k)
    pressures_.emplace_back(*find("cylinder[" + std::to_string(k + 1) + "].pressure_Pa"));
  results_.assign(std::begin(kOfEngine), std::end(kOfEngine));
  for (std::uint32_t k = 0; k < firing_deg_.size(); ++k) {
    results_.push_back(kPeakPressure.at(k));
    results_.push_back(kPeakAngle.at(k));
  }
  for (const Probe& probe : channels_) {
    if (!is_of_cycle(probe.variable.name)) continue;
    results_.push_back(probe.variable);
    shown_results_.push_back(&probe);
  }
  result_values_.assign(results_.size(), std::numeric_limits<double>::quiet_NaN());
  cycle_.peak_Pa.assign(firing_deg_.size(), 0.0), cycle_.peak_deg.assign(firing_deg_.size(), 0.0);
  edges_.reserve(3 * kMaxEdges);
}

}  // namespace crankloop::page

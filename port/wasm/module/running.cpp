#include "running.hpp"

#include <algorithm>
#include <cstring>

#include <crankloop/fmi/name.hpp>
#include <crankloop/tabulate/mechanism.hpp>

#include "crankloop/files/units.hpp"

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

void Running::list_results() {
  mean_torque_ = find("mean_torque_Nm");
  speed_ = find("speed_rad_s");
  for (std::uint32_t k = 0; k < firing_deg_.size(); ++k)
    pressures_.push_back(find("cylinder[" + std::to_string(k + 1) + "].pressure_Pa"));
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
}

void Running::take_inputs() noexcept {
  for (std::size_t i = 0; i < inputs_.size(); ++i) inputs_[i].set(input_values_[i]);
}

void Running::add_row(std::vector<double>& rows) const {
  rows.push_back(time_s());
  rows.push_back(detail::degrees_of(phase()));
  for (const Probe* column : columns_) rows.push_back(column->number());
}

const std::vector<double>& Running::now() {
  now_.clear();
  add_row(now_);
  return now_;
}

std::uint32_t Running::step(std::uint32_t ticks, std::uint32_t every) {
  samples_.clear();
  edges_.clear();
  edges_lost_ = 0;
  take_inputs();
  for (std::uint32_t i = 0; i < ticks; ++i) {
    if (every != 0 && samples_.size() + row_size() > kMaxSampleNumbers) return i;
    const Phase before = phase();
    const double begin_s = time_s();
    tick();
    ++ticks_;
    note(before, phase());
    collect_edges(begin_s);
    if (every != 0 && ticks_ % every == 0) add_row(samples_);
  }
  return ticks;
}

void Running::add_edge(double time_s, double wheel, std::uint32_t level) {
  if (edges_.size() + 3 > 3 * kMaxEdges) {
    ++edges_lost_;
    return;
  }
  edges_.insert(edges_.end(), {time_s, wheel, static_cast<double>(level)});
}

void Running::note(Phase before, Phase after) {
  constexpr double kRadPerUnit = program::kRadPerDeg * program::kDegPerUnit;
  const auto turned = static_cast<std::int64_t>(after.units() - before.units());
  const bool forward_over_begin = turned > 0 && after.units() < before.units();
  const bool backward_over_begin = turned < 0 && after.units() > before.units();
  if (forward_over_begin) end_cycle();
  if (backward_over_begin) cycle_ = {}, is_whole_ = false;
  const double turned_rad = static_cast<double>(turned) * kRadPerUnit;
  cycle_.work_J += mean_torque_->number() * turned_rad;
  cycle_.angle_rad += turned_rad;
  cycle_.time_s += tick_s_;
  const double speed_rad_s = speed_->number();
  cycle_.least_rad_s = std::min(cycle_.least_rad_s, speed_rad_s);
  cycle_.largest_rad_s = std::max(cycle_.largest_rad_s, speed_rad_s);
  cycle_.peak_Pa.resize(firing_deg_.size(), 0), cycle_.peak_deg.resize(firing_deg_.size(), 0);
  for (std::size_t k = 0; k < firing_deg_.size(); ++k) {
    const double pressure_Pa = pressures_[k]->number();
    if (pressure_Pa <= cycle_.peak_Pa[k]) continue;
    const double from_firing_deg = detail::degrees_of(after) - firing_deg_[k];
    cycle_.peak_Pa[k] = pressure_Pa;
    cycle_.peak_deg[k] = from_firing_deg < -360  ? from_firing_deg + 720
                         : from_firing_deg > 360 ? from_firing_deg - 720
                                                 : from_firing_deg;
  }
}

void Running::end_cycle() {
  if (is_whole_) {
    ++cycles_;
    std::size_t i = 0;
    for (const double value :
         {cycle_.work_J / cycle_.angle_rad, cycle_.work_J / cycle_.time_s, cycle_.work_J / swept_m3_,
          cycle_.angle_rad / cycle_.time_s, cycle_.least_rad_s, cycle_.largest_rad_s})
      result_values_[i++] = value;
    for (std::size_t k = 0; k < firing_deg_.size(); ++k) {
      result_values_[i++] = cycle_.peak_Pa[k];
      result_values_[i++] = cycle_.peak_deg[k];
    }
    for (const Probe* shown : shown_results_) result_values_[i++] = shown->number();
  }
  std::fill(cycle_.peak_Pa.begin(), cycle_.peak_Pa.end(), 0.0);
  cycle_ = {0,
            0,
            0,
            std::numeric_limits<double>::infinity(),
            -std::numeric_limits<double>::infinity(),
            std::move(cycle_.peak_Pa),
            std::move(cycle_.peak_deg)};
  is_whole_ = true;
}

}  // namespace crankloop::page

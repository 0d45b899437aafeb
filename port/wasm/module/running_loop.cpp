// What a page does in each tick beside the engine's step: edges, sums and peaks of the cycle, samples. Compiled for
// speed.
#include <algorithm>

#include "crankloop/files/units.hpp"
#include "running.hpp"

namespace crankloop::page {

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
  std::uint64_t next_row = every != 0 ? (ticks_ / every + 1) * every : 0;
  for (std::uint32_t i = 0; i < ticks; ++i) {
    if (every != 0 && samples_.size() + row_size() > kMaxSampleNumbers) return i;
    const Phase before = phase();
    tick(time_s());
    ++ticks_;
    add_to_cycle(before, phase());
    if (ticks_ != next_row) continue;
    add_row(samples_);
    next_row += every;
  }
  return ticks;
}

void Running::add_edge(double time_s, double wheel, std::uint32_t level) noexcept {
  if (edges_.size() + 3 > 3 * kMaxEdges) {
    ++edges_lost_;
    return;
  }
  for (const double number : {time_s, wheel, static_cast<double>(level)}) edges_.push_back(number);
}

void Running::add_to_cycle(Phase before, Phase after) noexcept {
  constexpr double kRadPerUnit = program::kRadPerDeg * program::kDegPerUnit;
  const auto turned = static_cast<std::int64_t>(after.units() - before.units());
  const bool forward_over_begin = turned > 0 && after.units() < before.units();
  const bool backward_over_begin = turned < 0 && after.units() > before.units();
  if (forward_over_begin) end_cycle();
  if (backward_over_begin) begin_cycle(false);
  const double turned_rad = static_cast<double>(turned) * kRadPerUnit;
  cycle_.work_J += mean_torque_.number() * turned_rad;
  cycle_.angle_rad += turned_rad;
  cycle_.time_s += tick_s_;
  const double speed_rad_s = speed_.number();
  cycle_.least_rad_s = std::min(cycle_.least_rad_s, speed_rad_s);
  cycle_.largest_rad_s = std::max(cycle_.largest_rad_s, speed_rad_s);
  for (std::size_t k = 0; k < pressures_.size(); ++k) {
    const double pressure_Pa = pressures_[k].number();
    if (pressure_Pa <= cycle_.peak_Pa[k]) continue;
    const double from_firing_deg = detail::degrees_of(after) - firing_deg_[k];
    cycle_.peak_Pa[k] = pressure_Pa;
    cycle_.peak_deg[k] = from_firing_deg < -360  ? from_firing_deg + 720
                         : from_firing_deg > 360 ? from_firing_deg - 720
                                                 : from_firing_deg;
  }
}

void Running::end_cycle() noexcept {
  if (is_whole_) {
    ++cycles_;
    std::size_t i = 0;
    for (const double value :
         {cycle_.work_J / cycle_.angle_rad, cycle_.work_J / cycle_.time_s, cycle_.work_J / swept_m3_,
          cycle_.angle_rad / cycle_.time_s, cycle_.least_rad_s, cycle_.largest_rad_s})
      result_values_[i++] = value;
    for (std::size_t k = 0; k < pressures_.size(); ++k) {
      result_values_[i++] = cycle_.peak_Pa[k];
      result_values_[i++] = cycle_.peak_deg[k];
    }
    for (const Probe* shown : shown_results_) result_values_[i++] = shown->number();
  }
  begin_cycle(true);
}

void Running::begin_cycle(bool is_whole) noexcept {
  cycle_.work_J = cycle_.angle_rad = cycle_.time_s = 0;
  cycle_.least_rad_s = std::numeric_limits<double>::infinity();
  cycle_.largest_rad_s = -std::numeric_limits<double>::infinity();
  std::fill(cycle_.peak_Pa.begin(), cycle_.peak_Pa.end(), 0.0);
  std::fill(cycle_.peak_deg.begin(), cycle_.peak_deg.end(), 0.0);
  is_whole_ = is_whole;
}

}  // namespace crankloop::page

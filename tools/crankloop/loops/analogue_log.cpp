#include "analogue_log.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include "../files/units.hpp"

namespace crankloop::program {

template <class Real>
AnalogueLog<Real>::AnalogueLog(Output* csv, AnalogueTrace* trace, const EngineFile& file,
                               const EngineDefinition& definition, double tick_s)
    : trace_{trace},
      tick_s_{static_cast<Real>(tick_s)},
      cycles_per_tick_per_rad_s_{static_cast<Real>(tick_s * kTurnsPerRad / 2)} {
  if (csv != nullptr)
    csv_.emplace(*csv, std::vector<std::string>{"time_s", "crank_deg", "reluctor_V", "comparator_level"});
  TableTargets<Real> targets;
  targets.reluctor = table_.get();
  if (const Status refused = tabulate(definition, {tick_s}, targets); !refused.ok()) throw file.explain(refused);
}

template <class Real>
void AnalogueLog<Real>::take(double begin_s, Phase begin, Phase end, Real begin_rad_s, Real end_rad_s) {
  constexpr std::uint32_t kStep = detail::kSamplePlaces / S::reluctor_samples;
  const Real gain_rad_s = end_rad_s - begin_rad_s;
  const detail::CrankPath<Real> path{begin, end - begin, false, gain_rad_s * cycles_per_tick_per_rad_s_ / 2};
  const detail::CrankSample<Real> crank{path, begin_rad_s, gain_rad_s};
  std::uint32_t level = out_.comparator.level;
  (void)detail::read_reluctor<Real, S>(*table_, tick_s_, state_, out_, crank);
  std::uint32_t edge = 0;
  const auto& edges = out_.comparator;
  for (std::uint32_t i = 0; i < S::reluctor_samples; ++i) {
    const std::uint32_t place = (i + 1) * kStep;
    const Real time_s = tick_s_ * detail::CrankSample<Real>::ratio(place);
    for (; edge < edges.edge_count && !(edges.edge[edge].time_s > time_s); ++edge) level = edges.edge[edge].level;
    const double crank_deg = static_cast<double>(crank.phase(place)) * kDegPerUnit;
    const double at_s = begin_s + static_cast<double>(time_s);
    if (csv_) csv_->row(at_s, crank_deg, out_.reluctor_V[i], static_cast<int>(level));
    if (trace_ == nullptr || trace_->time_s.size() >= AnalogueTrace::kMost) continue;
    trace_->time_s.push_back(at_s);
    trace_->voltage_V.push_back(static_cast<double>(out_.reluctor_V[i]));
    trace_->level.push_back(static_cast<double>(level));
    const Real by_peak_V = table_->arm_ratio * state_.sensor_last_peak_V;
    trace_->arms_V.push_back(static_cast<double>(by_peak_V > table_->least_V ? by_peak_V : table_->least_V));
  }
  if (trace_ == nullptr || trace_->time_s.size() >= AnalogueTrace::kMost) return;
  trace_->tick_end_s.push_back(begin_s + static_cast<double>(tick_s_));
  trace_->speed_rad_s.push_back(static_cast<double>(end_rad_s));
  for (std::uint32_t e = 0; e < edges.edge_count && e < S::trigger_edges; ++e) {
    if (edges.edge[e].level != 0) trace_->edges_s.push_back(begin_s + static_cast<double>(edges.edge[e].time_s));
  }
}

template class AnalogueLog<float>;
template class AnalogueLog<double>;

}  // namespace crankloop::program

#include "analogue_log.hpp"

#include <cstdint>

#include "../files/units.hpp"

namespace crankloop::program {

template <class Real>
AnalogueLog<Real>::AnalogueLog(Output& out, const EngineFile& file, const EngineDefinition& definition, double tick_s)
    : csv_{out, {"time_s", "crank_deg", "reluctor_V", "comparator_level"}},
      tick_s_{static_cast<Real>(tick_s)},
      cycles_per_tick_per_rad_s_{static_cast<Real>(tick_s * kTurnsPerRad / 2)} {
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
  std::uint32_t level = state_.comparator_level;
  (void)detail::read_reluctor<Real, S>(*table_, tick_s_, state_, out_, crank);
  std::uint32_t edge = 0;
  const auto& edges = out_.comparator;
  for (std::uint32_t i = 0; i < S::reluctor_samples; ++i) {
    const std::uint32_t place = (i + 1) * kStep;
    const Real time_s = tick_s_ * detail::CrankSample<Real>::ratio(place);
    for (; edge < edges.edge_count && !(edges.edge[edge].time_s > time_s); ++edge) level = edges.edge[edge].level;
    const double crank_deg = static_cast<double>(crank.phase(place)) * kDegPerUnit;
    csv_.row(begin_s + static_cast<double>(time_s), crank_deg, out_.reluctor_V[i], static_cast<int>(level));
  }
}

template class AnalogueLog<float>;
template class AnalogueLog<double>;

}  // namespace crankloop::program

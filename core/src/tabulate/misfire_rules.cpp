#include "misfire_rules.hpp"

#include <cstddef>
#include <cstdint>

#include "seeds.hpp"

namespace crankloop::detail {
namespace {

[[nodiscard]] std::uint32_t pattern_of(MisfirePattern pattern) noexcept {
  switch (pattern) {
    case MisfirePattern::none:
      return kFires;
    case MisfirePattern::spread:
      return kMisfiresSpread;
    case MisfirePattern::burst:
      return kMisfiresInBursts;
    case MisfirePattern::random:
      return kMisfiresAtRandom;
    case MisfirePattern::listed:
      return kMisfiresListed;
  }
  return kFires;
}

template <class Real>
[[nodiscard]] MisfireRule<Real> rule_of(const Misfire& misfire, std::uint32_t cylinder) noexcept {
  MisfireRule<Real> rule{};
  rule.burning_ratio = static_cast<Real>(misfire.burning_ratio);
  rule.pattern = pattern_of(misfire.pattern);
  rule.of = 1;
  rule.seed = seed_of(misfire.seed, cylinder);
  if (rule.pattern == kMisfiresSpread || rule.pattern == kMisfiresInBursts) {
    rule.misfires = static_cast<std::uint32_t>(misfire.misfires);
    rule.of = static_cast<std::uint32_t>(misfire.of);
  }
  if (rule.pattern == kMisfiresAtRandom) rule.below = chance_of(misfire.random_ratio);
  if (rule.pattern == kMisfiresListed) {
    rule.listed = static_cast<std::uint32_t>(misfire.cycle_count);
    for (std::uint32_t i = 0; i < rule.listed; ++i) rule.cycle[i] = static_cast<std::uint32_t>(misfire.cycles[i]);
  }
  return rule;
}

}  // namespace

template <class Real>
void fill_misfires(const EngineDefinition& engine, const TableTargets<Real>& targets) noexcept {
  if (targets.misfires == nullptr) return;
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(engine.layout.cylinders); ++k)
    targets.misfires[k] = rule_of<Real>(engine.misfires[k], k);
}

template void fill_misfires(const EngineDefinition&, const TableTargets<float>&) noexcept;
template void fill_misfires(const EngineDefinition&, const TableTargets<double>&) noexcept;

}  // namespace crankloop::detail

// Validation of a cylinder's misfires; field names as in the engine file.
#include <crankloop/define/misfire.hpp>

#include "rules.hpp"

namespace crankloop {

Status validate(const Misfire& misfire) noexcept {
  if (misfire.pattern > MisfirePattern::listed) return refuse("misfire.pattern", Reason::out_of_range);
  if (const Status refused = detail::out_of_range(misfire); !refused.ok()) return refused;
  const bool counted = misfire.pattern == MisfirePattern::spread || misfire.pattern == MisfirePattern::burst;
  if (counted && misfire.misfires > misfire.of) return refuse("misfire.misfires", Reason::inconsistent);
  if (misfire.pattern != MisfirePattern::listed) return {};
  for (int i = 0; i < misfire.cycle_count; ++i) {
    if (misfire.cycles[i] < 1) return refuse("misfire.cycles", Reason::not_positive, i);
    if (i > 0 && misfire.cycles[i] <= misfire.cycles[i - 1]) return refuse("misfire.cycles", Reason::not_increasing, i);
  }
  return {};
}

}  // namespace crankloop

// Validation of friction, driven machine and starter; field names as in the engine file.
#include <crankloop/define/crank_dynamics.hpp>

#include "rules.hpp"

namespace crankloop {

using detail::none_or_positive;
using detail::out_of_range;

Status validate(const Friction& friction) noexcept { return out_of_range(friction); }

Status validate(const DrivenMachine& machine) noexcept { return out_of_range(machine); }

Status validate(const Starter& starter) noexcept {
  if (const Status refused = out_of_range(starter); !refused.ok()) return refused;
  if (starter.stall_Nm > 0 && starter.no_load_rad_s == 0) return refuse("starter.no_load_rad_s", Reason::not_positive);
  return none_or_positive(starter.no_load_rad_s, "starter.no_load_rad_s");
}

}  // namespace crankloop

// Validation of friction, driven machine and starter; field names as in the engine file.
#include <crankloop/define/crank_dynamics.hpp>

#include "rules.hpp"

namespace crankloop {

using detail::first_refusal;
using detail::none_or_positive;
using detail::not_negative;

namespace {

constexpr double kMaxTorque_Nm = 1e7;  // the largest marine engines have some 1e7
constexpr double kMaxSlope = 1e6;      // per rad/s and its square

}  // namespace

Status validate(const Friction& friction) noexcept {
  const Status answers[] = {
      not_negative(friction.constant_Pa, "friction.constant_Pa", 1e7),
      not_negative(friction.linear_Pa_s, "friction.linear_Pa_s", kMaxSlope),
      not_negative(friction.quadratic_Pa_s2, "friction.quadratic_Pa_s2", kMaxSlope),
  };
  return first_refusal(answers);
}

Status validate(const DrivenMachine& machine) noexcept {
  const Status answers[] = {
      not_negative(machine.constant_Nm, "machine.constant_Nm", kMaxTorque_Nm),
      not_negative(machine.linear_Nm_s, "machine.linear_Nm_s", kMaxSlope),
      not_negative(machine.quadratic_Nm_s2, "machine.quadratic_Nm_s2", kMaxSlope),
      not_negative(machine.inertia_kg_m2, "machine.inertia_kg_m2", 1e6),
  };
  return first_refusal(answers);
}

Status validate(const Starter& starter) noexcept {
  const Status answers[] = {
      not_negative(starter.stall_Nm, "starter.stall_Nm", kMaxTorque_Nm),
      none_or_positive(starter.no_load_rad_s, "starter.no_load_rad_s", 1e4),
  };
  if (const Status refused = first_refusal(answers); !refused.ok()) return refused;
  if (starter.stall_Nm > 0 && starter.no_load_rad_s == 0) return refuse("starter.no_load_rad_s", Reason::not_positive);
  return {};
}

}  // namespace crankloop

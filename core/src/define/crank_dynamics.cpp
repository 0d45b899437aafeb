// The rules that friction, driven machine and starter keep; field names as in the engine file.
#include <crankloop/define/crank_dynamics.hpp>

#include "rules.hpp"

namespace crankloop {

using detail::first_refusal;
using detail::none_or_positive;
using detail::not_negative;

namespace {

constexpr double kMostTorque_Nm = 1e7;  // the largest marine engines have some 1e7
constexpr double kMostSlope = 1e6;      // per rad/s and its square

}  // namespace

Status validate(const Friction& friction) noexcept {
  const Status answers[] = {
      not_negative(friction.constant_Pa, "friction.constant", 1e7),
      not_negative(friction.linear_Pa_s, "friction.linear", kMostSlope),
      not_negative(friction.quadratic_Pa_s2, "friction.quadratic", kMostSlope),
  };
  return first_refusal(answers);
}

Status validate(const Load& load) noexcept {
  const Status answers[] = {
      not_negative(load.constant_Nm, "load.constant", kMostTorque_Nm),
      not_negative(load.linear_Nm_s, "load.linear", kMostSlope),
      not_negative(load.quadratic_Nm_s2, "load.quadratic", kMostSlope),
      not_negative(load.inertia_kg_m2, "load.inertia", 1e6),
  };
  return first_refusal(answers);
}

Status validate(const Starter& starter) noexcept {
  const Status answers[] = {
      not_negative(starter.stall_Nm, "starter.stall", kMostTorque_Nm),
      none_or_positive(starter.no_load_rad_s, "starter.no_load", 1e4),
  };
  if (const Status refused = first_refusal(answers); !refused.ok()) return refused;
  if (starter.stall_Nm > 0 && starter.no_load_rad_s == 0) return {Reason::not_positive, -1, "starter.no_load"};
  return {};
}

}  // namespace crankloop

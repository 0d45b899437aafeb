// Validation of an engine's gas; field names as in the engine file.
#include <crankloop/define/gas.hpp>

#include "rules.hpp"

namespace crankloop {

using detail::in_range;
using detail::out_of_range;

namespace {

/// Where the rows of a curve stand: rising from 0.
[[nodiscard]] Status validate_curve(int count, const double* at, const char* field) noexcept {
  if (count < 2) return refuse(field, Reason::too_few_points);
  if (count > kMaxFlowPoints) return refuse(field, Reason::too_many_points);
  for (int i = 1; i < count; ++i) {
    if (at[i] <= at[i - 1]) return refuse(field, Reason::not_increasing, i);
  }
  if (at[0] != 0) return refuse(field, Reason::inconsistent, 0);
  return {};
}

[[nodiscard]] Status validate_port(const PortOfTrain& port, int train) noexcept {
  const auto of_train = [train](const Status& refused) { return refuse(refused.field, refused.reason, train); };
  if (port.port != GasPort::intake && port.port != GasPort::exhaust)
    return refuse("gas.port", Reason::inconsistent, train);
  if (const Status refused = out_of_range(port); !refused.ok()) return of_train(refused);
  if (const Status refused = validate_curve(port.flow_count, port.flow_lift_ratio, "gas.flow_lift_ratio");
      !refused.ok())
    return of_train(refused);
  if (port.flow_ratio[0] != 0)
    return refuse("gas.flow_lift_ratio", Reason::inconsistent, train);  // a closed valve has no flow
  return {};
}

[[nodiscard]] Status validate_runner(const Runner& runner, int port) noexcept {
  Status refused = out_of_range(runner);
  if (refused.ok() && runner.any()) refused = in_range(runner.length_m, "runner.length_m", from(0.02));
  return refused.ok() ? refused : refuse(refused.field, refused.reason, port);
}

[[nodiscard]] Status validate_walls(const Walls& walls) noexcept {
  if (const Status refused = out_of_range(walls); !refused.ok()) return refused;
  if (walls.capacity_J_K != 0) {
    if (const Status refused = in_range(walls.capacity_J_K, "walls.capacity_J_K", from(1)); !refused.ok())
      return refused;
  }
  if (walls.any() && walls.manifold_K != 0) return in_range(walls.manifold_K, "walls.manifold_K", from(150));
  return {};
}

}  // namespace

Status validate(const Gas& gas, int trains) noexcept {
  if (const Status refused = out_of_range(gas); !refused.ok()) return refused;
  if (const Status refused = out_of_range(gas.crevice); !refused.ok()) return refused;
  if (const Status refused = in_range(gas.behind_outlet_Pa(), "gas.back_Pa", from(1e3)); !refused.ok()) return refused;
  if (const Status refused = validate_curve(gas.throttle_count, gas.throttle_ratio, "gas.throttle_ratio");
      !refused.ok())
    return refused;
  if (gas.throttle_closed_m2 > gas.throttle_m2) return refuse("gas.throttle_closed_m2", Reason::inconsistent);
  if (gas.throttle_ratio[gas.throttle_count - 1] != 1)
    return refuse("gas.throttle_ratio", Reason::inconsistent, gas.throttle_count - 1);
  const double mixture_J_kg = gas.combustion_efficiency * gas.heating_value_J_kg / (1 + gas.air_fuel_ratio);
  if (mixture_J_kg > kMaxMixtureHeat_J_kg) return refuse("gas.air_fuel_ratio", Reason::too_much_heat);
  if (gas.burn_start_deg + gas.burn_duration_deg * gas.span_ratio() > kLatestBurn_deg)
    return refuse("gas.burn_duration_deg", Reason::inconsistent);
  if (const Status refused = validate_runner(gas.intake_runner, 0); !refused.ok()) return refused;
  if (const Status refused = validate_runner(gas.exhaust_runner, 1); !refused.ok()) return refused;
  if (const Status refused = out_of_range(gas.charge_burn); !refused.ok()) return refused;
  if (const Status refused = validate_walls(gas.walls); !refused.ok()) return refused;
  if (gas.octane_number != 0) {
    if (const Status refused = in_range(gas.octane_number, "gas.octane_number", from(60)); !refused.ok())
      return refused;
  }
  if (trains < 1) return refuse("train_count", Reason::inconsistent);  // no valve admits gas
  for (int t = 0; t < trains; ++t) {
    if (const Status refused = validate_port(gas.ports[t], t); !refused.ok()) return refused;
  }
  return {};
}

}  // namespace crankloop

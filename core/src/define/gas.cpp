// Validation of an engine's gas; field names as in the engine file.
#include <crankloop/define/gas.hpp>

#include "rules.hpp"

namespace crankloop {

using detail::between;
using detail::first_refusal;
using detail::not_negative;
using detail::positive;

namespace {

/// Rows of a curve: rising from `first` to at most `last`, values 0 to 1.
[[nodiscard]] Status validate_curve(int count, const double* at, const double* value, double last,
                                    const char* field) noexcept {
  if (count < 2) return refuse(field, Reason::too_few_points);
  if (count > kMaxFlowPoints) return refuse(field, Reason::too_many_points);
  for (int i = 0; i < count; ++i) {
    if (const Status refused = between(at[i], field, 0, last, i); !refused.ok()) return refused;
    if (const Status refused = between(value[i], field, 0, 1, i); !refused.ok()) return refused;
    if (i > 0 && at[i] <= at[i - 1]) return refuse(field, Reason::not_increasing, i);
  }
  if (at[0] != 0) return refuse(field, Reason::inconsistent, 0);
  return {};
}

[[nodiscard]] Status validate_port(const PortOfTrain& port, int train) noexcept {
  const auto of_train = [train](const Status& refused) { return refuse(refused.field, refused.reason, train); };
  if (port.port != GasPort::intake && port.port != GasPort::exhaust)
    return refuse("gas.port", Reason::inconsistent, train);
  if (const Status refused = positive(port.seat_diameter_m, "gas.seat_diameter_m", 1); !refused.ok())
    return of_train(refused);
  const Status curve =
      validate_curve(port.flow_count, port.flow_lift_ratio, port.flow_ratio, 0.5, "gas.flow_lift_ratio");
  if (!curve.ok()) return of_train(curve);
  if (port.flow_ratio[0] != 0)
    return refuse("gas.flow_lift_ratio", Reason::inconsistent, train);  // a closed valve has no flow
  return {};
}

}  // namespace

Status validate(const Gas& gas, int trains) noexcept {
  const Status answers[] = {
      positive(gas.intake_m3, "gas.intake_m3", 100),
      positive(gas.exhaust_m3, "gas.exhaust_m3", 100),
      positive(gas.throttle_m2, "gas.throttle_m2", 10),
      not_negative(gas.throttle_closed_m2, "gas.throttle_closed_m2", 10),
      validate_curve(gas.throttle_count, gas.throttle_ratio, gas.throttle_area_ratio, 1, "gas.throttle_ratio"),
      positive(gas.outlet_m2, "gas.outlet_m2", 10),
      between(gas.ambient_Pa, "gas.ambient_Pa", 1e3, 1e7),
      between(gas.behind_outlet_Pa(), "gas.back_Pa", 1e3, 1e7),
      not_negative(gas.back_Pa, "gas.back_Pa", 1e7),
      between(gas.ambient_K, "gas.ambient_K", 150, 3000),
      between(gas.exhaust_K, "gas.exhaust_K", 150, 3000),
      between(gas.wall_K, "gas.wall_K", 150, 2000),
      between(gas.wall_heat_ratio, "gas.wall_heat_ratio", 0, 100),
      between(gas.fuel_kg, "gas.fuel_kg", 0, 0.01),
      between(gas.excess_air_ratio, "gas.excess_air_ratio", 0, 100),
      between(gas.heating_value_J_kg, "gas.heating_value_J_kg", 0, 2e8),
      between(gas.combustion_efficiency, "gas.combustion_efficiency", 0, 1),
      between(gas.air_fuel_ratio, "gas.air_fuel_ratio", 1, 100),
      between(gas.latch_deg, "gas.latch_deg", -180, -90),
      between(gas.burn_start_deg, "gas.burn_start_deg", -90, 60),
      between(gas.burn_duration_deg, "gas.burn_duration_deg", 5, 150),
      between(gas.wiebe_m, "gas.wiebe_m", 0, 10),
      between(gas.second_ratio, "gas.second_ratio", 0, 1),
      between(gas.second_m, "gas.second_m", 0, 10),
      between(gas.second_duration_ratio, "gas.second_duration_ratio", 0.1, 10),
  };
  if (const Status refused = first_refusal(answers); !refused.ok()) return refused;
  if (gas.throttle_closed_m2 > gas.throttle_m2) return refuse("gas.throttle_closed_m2", Reason::inconsistent);
  if (gas.throttle_ratio[gas.throttle_count - 1] != 1)
    return refuse("gas.throttle_ratio", Reason::inconsistent, gas.throttle_count - 1);
  const double mixture_J_kg = gas.combustion_efficiency * gas.heating_value_J_kg / (1 + gas.air_fuel_ratio);
  if (mixture_J_kg > kMaxMixtureHeat_J_kg) return refuse("gas.air_fuel_ratio", Reason::too_much_heat);
  if (gas.burn_start_deg + gas.burn_duration_deg * gas.span_ratio() > kLatestBurn_deg)
    return refuse("gas.burn_duration_deg", Reason::inconsistent);
  if (trains < 1) return refuse("train_count", Reason::inconsistent);  // no valve admits gas
  for (int t = 0; t < trains; ++t) {
    if (const Status refused = validate_port(gas.ports[t], t); !refused.ok()) return refused;
  }
  return {};
}

}  // namespace crankloop

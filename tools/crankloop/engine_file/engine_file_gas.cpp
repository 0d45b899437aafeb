// The gas of an engine file: [gas], and the ports of its valves.
#include <cstddef>
#include <vector>

#include "../files/units.hpp"
#include "engine_file_parts.hpp"

namespace crankloop::program {
namespace {

/// Copies the rows of a curve: increasing from 0, at most as many as there is room for.
int fill_rows(const SectionValues& values, const char* key, double last, const std::string& path,
              double (&at)[kMaxFlowPoints], double (&value)[kMaxFlowPoints]) {
  const std::vector<double>& numbers = values.numbers(key);
  const std::size_t rows = numbers.size() / 2;
  if (rows < 2 || rows > kMaxFlowPoints) {
    refuse(values, key, std::to_string(rows) + " pairs given; allowed: 2 to " + std::to_string(kMaxFlowPoints), path);
  }
  for (std::size_t i = 0; i < kMaxFlowPoints; ++i) at[i] = value[i] = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    at[i] = numbers[2 * i], value[i] = numbers[2 * i + 1];
    if (i == 0 && at[i] != 0) refuse(values, key, "begins at " + shortest(at[i]) + "; it must begin at 0", path);
    if (i > 0 && at[i] <= at[i - 1]) {
      refuse(values, key, shortest(at[i]) + " follows " + shortest(at[i - 1]) + "; they must rise", path);
    }
    if (at[i] > last) refuse(values, key, shortest(at[i]) + " is beyond " + shortest(last), path);
  }
  return static_cast<int>(rows);
}

/// The runner of "intake" or "exhaust".
Runner build_runner(const SectionValues& values, const std::string& side, const std::string& path) {
  const std::string length = side + "_runner_mm", diameter = side + "_runner_diameter_mm", loss = side + "_runner_loss";
  Runner runner;
  if (!values.has(length)) {
    for (const std::string& key : {diameter, loss})
      if (values.has(key)) refuse(values, key.c_str(), "needs " + length + ", the length of that pipe; 0: none", path);
    return runner;
  }
  if (values.number(length) == 0) return runner;
  if (!values.has(diameter)) refuse(values, length.c_str(), "needs " + diameter, path);
  runner.length_m = values.si(length), runner.diameter_m = values.si(diameter);
  if (values.has(loss)) runner.loss_ratio = values.number(loss);
  return runner;
}

}  // namespace

Gas build_gas(const SectionValues& values, const std::string& path) {
  Gas gas;
  fill(values, gas);
  gas.ambient_K = values.number("ambient_C") + kZeroCelsius_K;
  gas.exhaust_K = values.number("exhaust_C") + kZeroCelsius_K;
  gas.wall_K = values.number("wall_C") + kZeroCelsius_K;
  gas.intake_runner = build_runner(values, "intake", path), gas.exhaust_runner = build_runner(values, "exhaust", path);
  gas.walls.coolant_K = values.number("coolant_C") + kZeroCelsius_K;
  if (values.has("manifold_C")) gas.walls.manifold_K = values.number("manifold_C") + kZeroCelsius_K;
  gas.charge_burn.in_use = values.text("burn_by") == "charge";
  gas.throttle_count = fill_rows(values, "throttle_curve", 1, path, gas.throttle_ratio, gas.throttle_area_ratio);
  if (gas.throttle_ratio[gas.throttle_count - 1] != 1) refuse(values, "throttle_curve", "must end at 1", path);
  if (gas.throttle_closed_m2 > gas.throttle_m2) {
    refuse(values, "throttle_closed_mm2",
           shortest(values.number("throttle_closed_mm2")) +
               " is more than throttle_mm2 = " + shortest(values.number("throttle_mm2")),
           path);
  }
  const double end_deg = gas.burn_start_deg + gas.burn_duration_deg * gas.span_ratio();
  if (end_deg > kLatestBurn_deg) {
    refuse(values, "burn_duration_deg",
           "the burn would end at " + brief(end_deg) + " deg; it must end by " + brief(kLatestBurn_deg) + " deg", path);
  }
  return gas;
}

PortOfTrain build_port(const SectionValues& valve, const std::string& path) {
  PortOfTrain port;
  if (valve.has("port")) port.port = valve.text("port") == "intake" ? GasPort::intake : GasPort::exhaust;
  if (valve.has("seat_diameter_mm")) port.seat_diameter_m = valve.si("seat_diameter_mm");
  if (!valve.has("flow_over_lift_ratio")) return port;
  port.flow_count = fill_rows(valve, "flow_over_lift_ratio", 0.5, path, port.flow_lift_ratio, port.flow_ratio);
  if (port.flow_ratio[0] != 0)
    refuse(valve, "flow_over_lift_ratio", "must be 0 at 0: a closed valve has no flow", path);
  return port;
}

}  // namespace crankloop::program

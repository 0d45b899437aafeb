#include "gas_exchange.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tick/gas/orifice.hpp>

#include "crank_dynamics.hpp"
#include "phase_units.hpp"
#include "rounding.hpp"

namespace crankloop::detail {
namespace {

/// Linear interpolation between a definition's rows; constant beyond the last.
[[nodiscard]] double between_rows(const double* at, const double* value, int count, double x) noexcept {
  for (int i = 1; i < count; ++i) {
    if (x <= at[i]) return value[i - 1] + (value[i] - value[i - 1]) * (x - at[i - 1]) / (at[i] - at[i - 1]);
  }
  return value[count - 1];
}

[[nodiscard]] double least_kg_m3(const EngineDefinition& engine) noexcept {
  constexpr double kShare = 1e-3;
  constexpr double kCold_K = 300;
  return kShare * engine.pressure.crankcase_Pa / (kGasConstant<double> * kCold_K);
}

[[nodiscard]] GasPortCurve<double> port_of(const EngineDefinition& engine, int train) noexcept {
  const PortOfTrain& port = engine.gas.ports[train];
  const double seat = port.seat_diameter_m;
  GasPortCurve<double> curve{};
  curve.port = port.port == GasPort::exhaust ? kExhaust : kIntake;
  curve.per_step_m = 80 / seat;
  for (int i = 0; i <= kFlowSteps; ++i) {
    const double ratio = between_rows(port.flow_lift_ratio, port.flow_ratio, port.flow_count, i / 80.0);
    curve.area_m2[i] = engine.trains[train].valve.per_cylinder * elementary::kPi / 4 * seat * seat * ratio;
  }
  return curve;
}

/// Manifold volumes that can flow through its openings in a tick at 1000 m/s. Openings: the one to the outside, and the
/// valves of as many cylinders as are open at a time.
[[nodiscard]] double volumes_in_a_tick(const EngineDefinition& engine, double tick_s, std::uint32_t port) noexcept {
  const Gas& gas = engine.gas;
  double valves_m2 = 0;
  for (int t = 0; t < engine.train_count; ++t) {
    const GasPortCurve<double> curve = port_of(engine, t);
    if (curve.port == port) valves_m2 += *std::max_element(std::begin(curve.area_m2), std::end(curve.area_m2));
  }
  const double open = 1 + (engine.layout.cylinders - 1) / 3.0;
  const double outside_m2 = port == kIntake ? gas.throttle_m2 : gas.outlet_m2;
  return (outside_m2 + open * valves_m2) * kFlowSpeed_m_s * tick_s / (port == kIntake ? gas.intake_m3 : gas.exhaust_m3);
}

/// Gas steps per tick; more than one for a small manifold.
[[nodiscard]] std::uint32_t parts_of(const EngineDefinition& engine, double tick_s) noexcept {
  constexpr double kVolumesInAStep = 1.3;
  const double share =
      std::max(volumes_in_a_tick(engine, tick_s, kIntake), volumes_in_a_tick(engine, tick_s, kExhaust));
  std::uint32_t parts = 1;
  while (parts < kMaxGasSteps && share > parts * kVolumesInAStep) ++parts;
  return parts;
}

/// Maximum number of gas steps per tick, for the largest rotation of the crank or a small manifold.
[[nodiscard]] std::uint32_t max_steps_of(const EngineDefinition& engine, const TickOptions& options) noexcept {
  const double steps = widest_turn_deg(engine, options) / kGasStep_deg;
  std::uint32_t parts = parts_of(engine, options.tick_s);
  while (parts < kMaxGasSteps && steps > parts) ++parts;
  return parts;
}

[[nodiscard]] GasCylinders<double> cylinders_of(const EngineDefinition& engine, const TickOptions& options) noexcept {
  const Crank& crank = engine.crank;
  const Gas& gas = engine.gas;
  const double area = bore_area_m2(crank);
  const double swept = swept_volume_m3(crank);
  GasCylinders<double> c{};
  c.walls = {130e-4 * gas.wall_heat_ratio, 2 * area, 4 / crank.bore_m, gas.wall_K, mean_piston_speed_m_s(crank, 1)};
  c.clearance_m3 = clearance_volume_m3(crank);
  c.bore_area_m2 = area;
  c.crankcase_Pa = engine.pressure.crankcase_Pa;
  c.least_kg_m3 = least_kg_m3(engine);
  c.per_swept_m3 = 1 / swept;
  c.per_full_charge = kGasConstant<double> * gas.ambient_K / (gas.ambient_Pa * swept);
  c.ambient_Pa = gas.ambient_Pa;
  c.ambient_K = gas.ambient_K;
  c.exhaust_K = gas.exhaust_K;
  c.max_steps = max_steps_of(engine, options);
  if (gas.crevice.any()) c.parts |= kGasCrevice;
  if (gas.intake_runner.any() || gas.exhaust_runner.any()) c.parts |= kGasRunners;
  if (gas.charge_burn.in_use) c.parts |= kGasChargeBurn;
  if (gas.walls.any()) c.parts |= kGasWalls;
  return c;
}

[[nodiscard]] GasCrevice<double> crevice_of(const EngineDefinition& engine) noexcept {
  const Gas& gas = engine.gas;
  GasCrevice<double> c{};
  if (!gas.crevice.any()) return c;
  const GasPoint<double> at_wall{0, gas.wall_K, 0, 0};
  c.specific_work_J_kg = kGasConstant<double> * gas.wall_K;
  c.kg_per_Pa = gas.crevice.volume_ratio * clearance_volume_m3(engine.crank) / c.specific_work_J_kg;
  c.wall_K = gas.wall_K;
  c.energy_J_kg = energy_J_kg(gas.wall_K, 0.0);
  c.burned_more_J_kg = energy_J_kg(gas.wall_K, 1.0) - c.energy_J_kg;
  c.leak_kg_s_Pa = gas.crevice.blow_by_m2 * beyond(at_wall, 0.0).choked_per_Pa;
  c.crankcase_Pa = engine.pressure.crankcase_Pa;
  c.in_use = 1;
  return c;
}

/// Share of a pipe's volume that swings at its port: 4 / pi^2, so that the lump has the first frequency of the pipe
/// shut at one end. The rest belongs to the manifold.
constexpr double kPortShare = 4 / (elementary::kPi * elementary::kPi);

/// With what runners leave to it. A manifold of less than five of them answers as a mode of its own: nothing is added.
[[nodiscard]] double with_runners_m3(double manifold_m3, const Runner& runner, int cylinders) noexcept {
  constexpr double kLeastRunners = 5;
  if (!runner.any() || manifold_m3 < kLeastRunners * runner.volume_m3()) return manifold_m3;
  return manifold_m3 + cylinders * (1 - kPortShare) * runner.volume_m3();
}

[[nodiscard]] GasRunners<double> runners_of(const EngineDefinition& engine) noexcept {
  GasRunners<double> all{};
  for (int port = 0; port < kPorts; ++port) {
    const Runner& runner = port == kIntake ? engine.gas.intake_runner : engine.gas.exhaust_runner;
    if (!runner.any()) continue;
    const double area = runner.area_m2(), volume = kPortShare * runner.volume_m3();
    all.of[port] = {area, area / runner.length_m, runner.loss_ratio / (2 * area * area), 1 / volume,
                    least_kg_m3(engine) * volume};
  }
  return all;
}

[[nodiscard]] GasManifolds<double> manifolds_of(const EngineDefinition& engine, double tick_s) noexcept {
  const Gas& gas = engine.gas;
  const double volumes[kPorts] = {with_runners_m3(gas.intake_m3, gas.intake_runner, engine.layout.cylinders),
                                  with_runners_m3(gas.exhaust_m3, gas.exhaust_runner, engine.layout.cylinders)};
  GasManifolds<double> m{};
  m.parts = parts_of(engine, tick_s);
  for (int i = 0; i < kPorts; ++i) {
    m.per_volume_m3[i] = 1 / volumes[i];
    m.least_kg[i] = least_kg_m3(engine) * volumes[i];
  }
  const double pressure_Pa[kPorts] = {gas.ambient_Pa, gas.behind_outlet_Pa()};
  for (int i = 0; i < kPorts; ++i) m.outside[i] = beyond(GasPoint<double>{pressure_Pa[i], gas.ambient_K, 0, 0}, 0.0);
  m.outlet_m2 = gas.outlet_m2;
  for (int i = 0; i <= kThrottleSteps; ++i) {
    const double share = between_rows(gas.throttle_ratio, gas.throttle_area_ratio, gas.throttle_count,
                                      i / static_cast<double>(kThrottleSteps));
    m.throttle_m2[i] = gas.throttle_closed_m2 + share * (gas.throttle_m2 - gas.throttle_closed_m2);
  }
  return m;
}

/// 1 - exp(-6.908 s^(m+1)), 1 at s = 1 (and beyond).
[[nodiscard]] double wiebe(double s, double m) noexcept {
  constexpr double kWhole = 6.908;
  if (s >= 1) return 1;
  return (1 - elementary::exp(-kWhole * elementary::pow(s, m + 1))) / (1 - elementary::exp(-kWhole));
}

[[nodiscard]] BurnTable<double> burn_of(const EngineDefinition& engine) noexcept {
  const Gas& gas = engine.gas;
  const double air = gas.air_fuel_ratio;
  // Heating values refer to 25 C, the energies of the gas to 0 K.
  constexpr double kMeasured_K = 298.15;
  BurnTable<double> b{};
  b.latch_phase = phase_units(gas.latch_deg + 720);
  b.heat_J_kg = gas.combustion_efficiency * gas.heating_value_J_kg;
  b.energy_J_kg = b.heat_J_kg + (1 + air) * energy_J_kg(kMeasured_K, 1.0) - air * energy_J_kg(kMeasured_K, 0.0);
  b.burning_J_kg = b.energy_J_kg - energy_J_kg(kMeasured_K, 1.0);
  b.burned_kg_kg = 1 + air;
  b.air_fuel_ratio = air;
  b.per_air_fuel_ratio = 1 / air;
  b.span_ratio = gas.span_ratio();
  b.fuel_kg = gas.excess_air_ratio > 0 ? 0 : gas.fuel_kg;
  b.excess_air_ratio = gas.excess_air_ratio;
  b.burn_start_deg = gas.burn_start_deg;
  b.burn_duration_deg = gas.burn_duration_deg;
  for (int i = 0; i <= kBurnSteps; ++i) {
    const double s = i * b.span_ratio / kBurnSteps;
    b.burnt[i] = (1 - gas.second_ratio) * wiebe(s, gas.wiebe_m) +
                 gas.second_ratio * wiebe(s / gas.second_duration_ratio, gas.second_m);
  }
  b.burnt[kBurnSteps] = 1;
  return b;
}

constexpr double kLn2 = 0.69314718055994531;

/// Laminar flame of gasoline in m/s: tick/gas/charge_burn.hpp.
[[nodiscard]] double flame_m_s(const ChargeBurn& at) noexcept {
  using elementary::pow;
  const double phi = 1 / at.reference_excess_air_ratio, off = phi - 1.21;
  const double unspoiled = at.reference_burned_ratio > 0 ? 1 - 2.06 * pow(at.reference_burned_ratio, 0.77) : 1;
  return (0.305 - 0.549 * off * off) * unspoiled * pow(at.reference_K / 298, 2.4 - 0.271 * pow(phi, 3.51)) *
         pow(at.reference_Pa / 101325, -0.357 + 0.14 * pow(phi, 2.77));
}

[[nodiscard]] ChargeBurnTable<double> charge_burn_of(const EngineDefinition& engine) noexcept {
  const ChargeBurn& burn = engine.gas.charge_burn;
  ChargeBurnTable<double> table{};
  if (!burn.in_use) return table;
  const double flame = flame_m_s(burn);
  table.reference = elementary::log(flame * flame / burn.reference_rad_s) / (3 * kLn2);
  table.spark_to_start_deg = burn.spark_to_start_deg;
  table.in_use = 1;
  return table;
}

/// Ticks from one change of wall temperatures to the next, a power of 2: no more than change one by 0.05 K, by as much
/// heat as ever comes through a surface (5 MW/m2) or a thousandth of what flows to the coolant.
[[nodiscard]] std::uint32_t wall_ticks(const EngineDefinition& engine, double tick_s) noexcept {
  constexpr std::uint32_t kMost = 32;
  constexpr double kMostHeat_W_m2 = 5e6, kMostChange_K = 0.05, kMostShare = 1e-3;
  const Walls& walls = engine.gas.walls;
  if (walls.capacity_J_K == 0) return kMost;
  const double heat_W = kMostHeat_W_m2 * 2 * bore_area_m2(engine.crank);
  const auto few = [&](double time_s) {
    return time_s * heat_W <= kMostChange_K * walls.capacity_J_K &&
           time_s * walls.to_coolant_W_K <= kMostShare * walls.capacity_J_K;
  };
  std::uint32_t ticks = 1;
  while (ticks < kMost && few(2 * ticks * tick_s)) ticks *= 2;
  return ticks;
}

[[nodiscard]] WarmWallsTable<double> walls_of(const EngineDefinition& engine, double tick_s) noexcept {
  const Gas& gas = engine.gas;
  const Walls& walls = gas.walls;
  WarmWallsTable<double> table{};
  table.ticks = wall_ticks(engine, tick_s);
  if (!walls.any()) return table;
  table.capacity_J_K = walls.capacity_J_K, table.to_coolant_W_K = walls.to_coolant_W_K;
  table.coolant_K = walls.coolant_K, table.behind_K = gas.behind_walls_K();
  table.port_W_K[kIntake] = walls.intake_W_K, table.port_W_K[kExhaust] = walls.exhaust_W_K;
  table.of_ports = walls.intake_W_K > 0 || walls.exhaust_W_K > 0 ? 1 : 0;
  return table;
}

[[nodiscard]] LambdaTable<double> lambda_of(const EngineDefinition& engine, double tick_s) noexcept {
  constexpr double kMost = 1e12;  // of pipes: a float holds it
  const LambdaSensor& sensor = engine.lambda_sensor;
  const double air_fuel = engine.gas.air_fuel_ratio;
  LambdaTable<double> table{};
  if (!sensor.in_use) return table;
  table.air_fuel_ratio = air_fuel;
  table.burned_fuel_ratio = 1 / (1 + air_fuel);
  table.unburned_ratio = air_fuel / (1 + air_fuel);
  if (sensor.pipe_m3 > 0) {
    const bool tiny = engine.gas.exhaust_m3 > kMost * sensor.pipe_m3;
    table.pipes_in_exhaust = tiny ? kMost : engine.gas.exhaust_m3 / sensor.pipe_m3;
  }
  table.follows_ratio = sensor.lag_s > 0 ? 1 - elementary::exp(-tick_s / sensor.lag_s) : 1;
  table.in_use = 1;
  return table;
}

[[nodiscard]] KnockTable<double> knock_of(const EngineDefinition& engine) noexcept {
  KnockTable<double> table{};
  if (engine.gas.octane_number == 0) return table;
  const double delay_s = 17.68e-3 * elementary::pow(engine.gas.octane_number / 100, 3.402);
  table.rate = -(elementary::log(delay_s) + 1.7 * elementary::log(101325)) / kLn2;
  table.hot_K = 3800 / kLn2;
  table.in_use = 1;
  return table;
}

}  // namespace

Status validate_manifolds(const EngineDefinition& engine, double tick_s) noexcept {
  constexpr double kMostVolumes = 80;
  if (engine.pressure.source != PressureSource::gas) return {};
  if (volumes_in_a_tick(engine, tick_s, kIntake) > kMostVolumes) return refuse("gas.intake_m3", Reason::inconsistent);
  if (volumes_in_a_tick(engine, tick_s, kExhaust) > kMostVolumes) return refuse("gas.exhaust_m3", Reason::inconsistent);
  return {};
}

template <class Real>
void fill_gas_exchange(const EngineDefinition& engine, const TickOptions& options,
                       const TableTargets<Real>& targets) noexcept {
  const bool breathes = engine.pressure.source == PressureSource::gas;
  const auto fill = [breathes, &engine](auto* target, const auto& make) {
    if (target == nullptr) return;
    *target = {};
    if (breathes) round_into(make(engine), *target);
  };
  fill(targets.gas_cylinders, [&options](const EngineDefinition& e) { return cylinders_of(e, options); });
  fill(targets.gas_manifolds, [&options](const EngineDefinition& e) { return manifolds_of(e, options.tick_s); });
  fill(targets.gas_crevice, crevice_of);
  fill(targets.gas_runners, runners_of);
  fill(targets.burn, burn_of);
  fill(targets.charge_burn, charge_burn_of);
  fill(targets.knock, knock_of);
  fill(targets.gas_walls, [&options](const EngineDefinition& e) { return walls_of(e, options.tick_s); });
  fill(targets.lambda, [&options](const EngineDefinition& e) { return lambda_of(e, options.tick_s); });
  if (targets.gas_ports == nullptr) return;
  for (int t = 0; t < engine.train_count; ++t)
    fill(targets.gas_ports + t, [t](const EngineDefinition& e) { return port_of(e, t); });
}

template void fill_gas_exchange(const EngineDefinition&, const TickOptions&, const TableTargets<float>&) noexcept;
template void fill_gas_exchange(const EngineDefinition&, const TickOptions&, const TableTargets<double>&) noexcept;

}  // namespace crankloop::detail

// The gas of an engine with gas exchange, as `run` shows it: the quantities of a cylinder, a cycle's results.
//
// What belongs here: the list, once, for CSV columns and plots; figures over all cylinders. What does not: their use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <crankloop/define/engine_definition.hpp>
#include <crankloop/scenes.hpp>

#include "../command_line/summary.hpp"
#include "../engine_file/engine_file.hpp"
#include "../engine_file/gas_order.hpp"
#include "../files/csv.hpp"
#include "../files/units.hpp"
#include "run_quantities.hpp"

namespace crankloop::program {

/// In the order of the CSV columns.
enum class GasQuantity : std::uint8_t {
  pressure,
  temperature,
  mass,
  burned_ratio,
  intake_flow,
  exhaust_flow,
  wall_heat,
};
inline constexpr std::size_t kGasQuantities = 7;

[[nodiscard]] constexpr std::size_t index_of(GasQuantity quantity) noexcept {
  return static_cast<std::size_t>(quantity);
}

using GasQuantityKind = KindOf<GasQuantity>;
inline constexpr GasQuantityKind kGasQuantityKinds[kGasQuantities] = {
    {GasQuantity::pressure, "gas_pressure", "kPa", "kPa", 1e-3},
    {GasQuantity::temperature, "temperature", "K", "K", 1},
    {GasQuantity::mass, "mass", "mg", "mg", 1e6},
    {GasQuantity::burned_ratio, "burned", "ratio", "", 1},
    {GasQuantity::intake_flow, "intake_flow", "g_s", "g/s", 1e3},
    {GasQuantity::exhaust_flow, "exhaust_flow", "g_s", "g/s", 1e3},
    {GasQuantity::wall_heat, "wall_heat", "W", "W", 1},
};

/// In SI, in the order of GasQuantity; flows are positive into the cylinder.
template <class Real>
[[nodiscard]] std::array<Real, kGasQuantities> values_of(const CylinderGasOutput<Real>& gas) noexcept {
  return {gas.pressure_Pa,        gas.temperature_K,       gas.mass_kg,    gas.burned_ratio,
          gas.flow_kg_s[kIntake], gas.flow_kg_s[kExhaust], gas.wall_heat_W};
}

/// Columns of a CSV file, and their cells for a tick: the cylinders, then the manifolds, then crevices, runners and
/// the lambda sensor where the engine has some.
void add_gas_columns(std::vector<std::string>& columns, const EngineDefinition& engine);
template <class Real, class S>
void write_gas(CsvWriter& csv, const crankloop::Output<Real, S>& out, const EngineDefinition& engine) {
  const auto cylinders = static_cast<std::size_t>(engine.layout.cylinders);
  for (std::size_t k = 0; k < cylinders; ++k) {
    const auto values = values_of(out.cylinder_gas[k]);
    for (std::size_t i = 0; i < kGasQuantities; ++i)
      csv.cell(values[i] * static_cast<Real>(kGasQuantityKinds[i].per_si));
  }
  for (const ManifoldOutput<Real>& manifold : out.manifold) {
    csv.cell(manifold.pressure_Pa * static_cast<Real>(1e-3));
    csv.cell(manifold.temperature_K);
    csv.cell(manifold.burned_ratio);
  }
  csv.cell(out.throttle_kg_s * static_cast<Real>(1e3));
  csv.cell(out.outlet_kg_s * static_cast<Real>(1e3));
  for (std::size_t k = 0; k < cylinders && engine.gas.crevice.any(); ++k) {
    csv.cell(out.crevice[k].mass_kg * static_cast<Real>(1e6));
    csv.cell(out.crevice[k].blow_by_kg_s * static_cast<Real>(1e3));
  }
  for (std::size_t k = 0; k < cylinders && engine.gas.walls.capacity_J_K > 0; ++k) csv.cell(out.wall_K[k]);
  if (engine.gas.walls.intake_W_K > 0 || engine.gas.walls.exhaust_W_K > 0) {
    for (const Real heat_W : out.port_heat_W) csv.cell(heat_W);
  }
  const bool runners[] = {engine.gas.intake_runner.any(), engine.gas.exhaust_runner.any()};
  for (std::size_t k = 0; k < cylinders; ++k) {
    for (const std::size_t port : {std::size_t{kIntake}, std::size_t{kExhaust}}) {
      if (!runners[port]) continue;
      csv.cell(out.runner[k].port_pressure_Pa[port] * static_cast<Real>(1e-3));
      csv.cell(out.runner[k].flow_kg_s[port] * static_cast<Real>(1e3));
    }
  }
  if (engine.lambda_sensor.in_use) csv.cell(out.exhaust_excess_air_ratio), csv.cell(out.sensor_excess_air_ratio);
}

/// Means over the cylinders' last whole cycles, of lambda over those that had fuel; for the energy defect, the one of
/// largest magnitude.
template <class Real, std::size_t Capacity>
[[nodiscard]] GasCycle<double> mean_cycle(const GasCycle<Real> (&cycles)[Capacity], std::size_t cylinders) noexcept {
  GasCycle<double> mean{};
  double fired = 0;
  for (std::size_t k = 0; k < cylinders; ++k) {
    const GasCycle<Real>& c = cycles[k];
    const auto add = [&](double GasCycle<double>::*to, Real value) {
      mean.*to += static_cast<double>(value) / static_cast<double>(cylinders);
    };
    add(&GasCycle<double>::net_mep_Pa, c.net_mep_Pa);
    add(&GasCycle<double>::pumping_mep_Pa, c.pumping_mep_Pa);
    add(&GasCycle<double>::peak_Pa, c.peak_Pa);
    add(&GasCycle<double>::peak_deg, c.peak_deg);
    add(&GasCycle<double>::trapped_kg, c.trapped_kg);
    add(&GasCycle<double>::trapped_air_kg, c.trapped_air_kg);
    add(&GasCycle<double>::residual_ratio, c.residual_ratio);
    add(&GasCycle<double>::volumetric_efficiency, c.volumetric_efficiency);
    add(&GasCycle<double>::exhaust_K, c.exhaust_K);
    add(&GasCycle<double>::fuel_kg, c.fuel_kg);
    if (c.excess_air_ratio > 0) ++fired, mean.excess_air_ratio += static_cast<double>(c.excess_air_ratio);
    add(&GasCycle<double>::heat_J, c.heat_J);
    add(&GasCycle<double>::wall_heat_J, c.wall_heat_J);
    const auto defect_J = static_cast<double>(c.energy_defect_J);
    const double magnitude_J = defect_J < 0 ? -defect_J : defect_J;
    if (magnitude_J > mean.energy_defect_J) mean.energy_defect_J = magnitude_J;
  }
  if (fired > 0) mean.excess_air_ratio /= fired;
  return mean;
}

/// Residual share of the trapped mass beyond which a real charge burns in part or not at all: 15 to 30 % of exhaust gas
/// beside the residual, whatever the kind of combustion chamber (Heywood, section 9.4).
inline constexpr double kMaxResidualThatBurns = 0.4;

/// Results of the gas in a run.
struct GasFigures {
  GasCycle<double> cycle{};  ///< mean_cycle at the end
  double intake_Pa = 0;      ///< of the manifold, mean over the ticks
  double exhaust_Pa = 0;
  double exhaust_manifold_K = 0;
  double wall_K = 0;                                 ///< of a cylinder's walls at the end, their mean
  double wall_heat_W = 0;                            ///< into those of a cylinder, mean of its last whole cycle
  double blow_by_kg = 0;                             ///< of a cylinder's cycle, their mean
  double knock_integral = 0;                         ///< largest of the cylinders
  double knock_deg = 0;                              ///< earliest of the cylinders that passed 1; 0: none did
  double burn_start_deg = 0, burn_duration_deg = 0;  ///< by the charge, mean of the cylinders where it burned
  double air_over_lambda_kg = 0;                     ///< trapped air over lambda, of a cylinder's cycle, their mean
  double exhaust_lambda = 0, sensor_lambda = 0;      ///< at the end; 0: no lambda sensor
};

/// Figures of the cylinders' last whole cycles, at this speed.
template <class Real, class S>
void take_cycles(const crankloop::Output<Real, S>& out, std::size_t cylinders, double speed_rad_s,
                 GasFigures& figures) {
  figures.cycle = mean_cycle(out.gas_cycle, cylinders);
  figures.wall_heat_W = figures.cycle.wall_heat_J * speed_rad_s / kCycle_rad;
  figures.wall_K = figures.blow_by_kg = figures.burn_start_deg = figures.burn_duration_deg = 0;
  figures.knock_integral = figures.knock_deg = 0;
  figures.exhaust_lambda = static_cast<double>(out.exhaust_excess_air_ratio);
  figures.sensor_lambda = static_cast<double>(out.sensor_excess_air_ratio);
  figures.air_over_lambda_kg = 0;
  const double share = 1 / static_cast<double>(cylinders);
  double burned = 0;
  for (std::size_t k = 0; k < cylinders; ++k) {
    figures.wall_K += static_cast<double>(out.wall_K[k]) * share;
    figures.blow_by_kg += static_cast<double>(out.cycle_blow_by_kg[k]) * share;
    const auto knock = static_cast<double>(out.knock_integral[k]), knock_deg = static_cast<double>(out.knock_deg[k]);
    if (knock >= 1 && (figures.knock_integral < 1 || knock_deg < figures.knock_deg)) figures.knock_deg = knock_deg;
    if (knock > figures.knock_integral) figures.knock_integral = knock;
    if (out.cycle_burn[k].duration_deg > 0) {
      ++burned;
      figures.burn_start_deg += static_cast<double>(out.cycle_burn[k].start_deg);
      figures.burn_duration_deg += static_cast<double>(out.cycle_burn[k].duration_deg);
    }
    const GasCycle<Real>& cycle = out.gas_cycle[k];
    if (cycle.excess_air_ratio > 0)
      figures.air_over_lambda_kg += static_cast<double>(cycle.trapped_air_kg / cycle.excess_air_ratio) * share;
  }
  if (burned > 0) figures.burn_start_deg /= burned, figures.burn_duration_deg /= burned;
}

/// The line of a summary with the requested fuel: fuel, or lambda.
void add_fuel(Summary& s, const GasOrder& order);
/// The lines that show the engine's inputs, throttle, fuel or lambda, burn_start: those that have one value.
void add_order(Summary& s, const GasOrder& order, const std::function<bool(const char*)>& is_given);

/// Fuel of a cylinder's cycle that found no air: in the burn's gas crevices lack theirs (docs/model.md, "Crevices and
/// blow-by"). 0 below 0.5 %, which is as far as air left over from the last cycle makes it uncertain.
[[nodiscard]] double unburned_kg(const Gas& gas, const GasFigures& figures) noexcept;

/// Fuel of all cylinders, burned or not, at this speed.
[[nodiscard]] double fuel_kg_s(const EngineDefinition& engine, const GasFigures& figures, double speed_rad_s) noexcept;

/// That a tick turns the crank too far for the steps of the gas, and what to take; "": it does not.
[[nodiscard]] std::string beyond_steps_of_gas(const EngineDefinition& engine, double speed_rpm, double tick_s);

/// What a real engine would do otherwise than these figures say, a sentence each: it misfires, it knocks.
[[nodiscard]] std::vector<std::string> doubts_about(const GasFigures& figures);

/// What is left out of an exhaust manifold's temperature: "" or a remark.
[[nodiscard]] std::string exhaust_heat_left_out(const EngineDefinition& engine);

/// The lines about the gas, from pumping_mep to wall_heat, and of an engine with crevices blow_by.
void add_gas(Summary& s, const EngineDefinition& engine, const GasFigures& figures);

/// Refuses an engine with gas exchange whose manifolds are too small for a tick.
void require_manifolds(const EngineFile& engine, double tick_s);

/// A warning if a tick turns the crank of an engine with gas exchange too far; else empty.
[[nodiscard]] std::vector<std::string> warnings_about_gas(const EngineFile& engine, double speed_rpm, double tick_s);

/// Number of cycles before recording starts: long enough to replace the gas in the manifolds many times. One for an
/// engine with a diagram.
[[nodiscard]] int cycles_to_settle(const EngineDefinition& engine) noexcept;

}  // namespace crankloop::program

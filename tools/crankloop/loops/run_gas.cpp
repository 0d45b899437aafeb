#include "run_gas.hpp"

#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tabulate/tabulate.hpp>

#include "../files/number.hpp"

namespace crankloop::program {

namespace {

constexpr double kLeanestThatIgnites = 2;    // lambda; with one spark in a homogeneous mixture some 1.6 to 1.8
constexpr double kRichestThatIgnites = 0.5;  // lambda; gasoline's limit in air is about 0.4, an engine misfires before

}  // namespace

void add_gas_columns(std::vector<std::string>& columns, const EngineDefinition& engine) {
  for (int k = 1; k <= engine.layout.cylinders; ++k) {
    for (const GasQuantityKind& kind : kGasQuantityKinds)
      columns.push_back("c" + std::to_string(k) + "_" + kind.name + "_" + kind.suffix);
  }
  for (const char* manifold : {"intake", "exhaust"}) {
    for (const char* what : {"_manifold_kPa", "_manifold_K", "_manifold_burned_ratio"})
      columns.push_back(std::string(manifold) + what);
  }
  columns.insert(columns.end(), {"throttle_g_s", "outlet_g_s"});
  for (int k = 1; k <= engine.layout.cylinders && engine.gas.crevice.any(); ++k) {
    for (const char* what : {"_crevice_mg", "_blow_by_g_s"}) columns.push_back("c" + std::to_string(k) + what);
  }
  for (int k = 1; k <= engine.layout.cylinders && engine.gas.walls.capacity_J_K > 0; ++k)
    columns.push_back("c" + std::to_string(k) + "_wall_K");
  if (engine.gas.walls.intake_W_K > 0 || engine.gas.walls.exhaust_W_K > 0)
    columns.insert(columns.end(), {"intake_wall_heat_W", "exhaust_wall_heat_W"});
  const bool runners[] = {engine.gas.intake_runner.any(), engine.gas.exhaust_runner.any()};
  for (int k = 1; k <= engine.layout.cylinders; ++k) {
    for (const std::size_t port : {std::size_t{kIntake}, std::size_t{kExhaust}}) {
      const std::string name = "c" + std::to_string(k) + (port == kIntake ? "_intake" : "_exhaust");
      if (runners[port]) columns.push_back(name + "_port_kPa"), columns.push_back(name + "_runner_g_s");
    }
  }
  if (engine.lambda_sensor.in_use) columns.insert(columns.end(), {"exhaust_lambda", "sensor_lambda"});
}

void add_fuel(Summary& s, const GasOrder& order) {
  if (order.excess_air_ratio > 0) {
    s.line("lambda", order.excess_air_ratio, "", "requested: fuel follows the air in each cylinder");
  } else {
    s.line("fuel", order.fuel_kg * 1e6, "mg", "per cylinder and cycle");
  }
}

void add_order(Summary& s, const GasOrder& order, const std::function<bool(const char*)>& is_given) {
  if (is_given("throttle_ratio")) s.line("throttle", order.throttle_ratio);
  if (is_given("excess_air_ratio") && (order.excess_air_ratio > 0 || is_given("fuel_kg"))) add_fuel(s, order);
  if (is_given("burn_start_deg") && is_given("by_spark_advance")) s.line("burn_start", order.burn_start_deg, "deg");
}

double unburned_kg(const Gas& gas, const GasFigures& figures) noexcept {
  constexpr double kUncertain = 5e-3;
  if (!gas.crevice.any()) return 0;
  const double taken_kg = figures.air_over_lambda_kg / gas.air_fuel_ratio;
  const double unburned_kg = taken_kg - figures.cycle.fuel_kg;
  return unburned_kg > kUncertain * taken_kg ? unburned_kg : 0;
}

double fuel_kg_s(const EngineDefinition& engine, const GasFigures& figures, double speed_rad_s) noexcept {
  return (figures.cycle.fuel_kg + unburned_kg(engine.gas, figures)) * engine.layout.cylinders * speed_rad_s /
         kCycle_rad;
}

std::vector<std::string> doubts_about(const GasFigures& figures) {
  std::vector<std::string> doubts;
  const GasCycle<double>& cycle = figures.cycle;
  if (cycle.residual_ratio > kMaxResidualThatBurns && cycle.heat_J > 0) {
    doubts.push_back(brief(std::round(100 * cycle.residual_ratio)) +
                     " % of the trapped mass is residual gas: a real engine misfires. Here all fuel burns, and "
                     "temperatures are too high.");
  }
  if (figures.knock_integral >= 1) {
    doubts.push_back("The knock integral passes 1 at " + brief(std::round(10 * figures.knock_deg) / 10) +
                     " deg: a real engine knocks. It would burn later or take a fuel of higher octane number.");
  }
  return doubts;
}

std::string exhaust_heat_left_out(const EngineDefinition& engine) {
  return engine.gas.walls.exhaust_W_K > 0 ? "" : "no heat to its walls: exhaust_W_per_K is 0";
}

/// A diesel, whose fuel burns by two laws, has no leanest mixture.
std::string remark_on_lambda(const Gas& gas, double lambda) {
  if (lambda > 0 && lambda < kRichestThatIgnites)
    return "lambda: so rich a mixture does not ignite; here it burns, with all its air";
  if (lambda > kLeanestThatIgnites && !(gas.second_ratio > 0))
    return "lambda: so lean a mixture of gasoline does not ignite; here all of it burns";
  return "lambda; 0: no fuel";
}

/// Where walls that warm up would end at their present heat: a run of some cycles sees the begin of it.
std::string remark_on_walls(const Walls& walls, const GasFigures& figures) {
  constexpr double kSettled_K = 5;
  const std::string now = "of a cylinder's walls, at the end";
  if (!(walls.to_coolant_W_K > 0)) return now + "; they give no heat to the coolant: wall_W_per_K is 0";
  const double end_K = walls.coolant_K + figures.wall_heat_W / walls.to_coolant_W_K;
  if (std::abs(end_K - figures.wall_K) <= kSettled_K || !(figures.wall_heat_W > 0)) return now;
  return now + "; at this heat they settle near " + brief(std::round(end_K)) +
         " K: for a warm engine set wall_C = " + brief(std::round(end_K - kZeroCelsius_K));
}

/// What the fuel's figure is of, and what of a real engine is not in it.
std::string remark_on_fuel(double lambda) {
  constexpr double kBestTorque = 0.9;  // Heywood, Internal Combustion Engine Fundamentals (1988), section 15.3: 1/1.1
  std::string remark = "of a cylinder's cycle";
  if (lambda > 0 && lambda < 1) remark += "; of a rich mixture the excess gives no heat";
  if (lambda > 0 && lambda < kBestTorque)
    remark += ", and a real engine loses torque below a lambda of " + brief(kBestTorque);
  return remark;
}

void add_gas(Summary& s, const EngineDefinition& engine, const GasFigures& figures) {
  const GasCycle<double>& cycle = figures.cycle;
  s.line("pumping_mep", cycle.pumping_mep_Pa / 1e3, "kPa", "from 180 to 540 deg; negative: a loss");
  s.line("volumetric_efficiency", cycle.volumetric_efficiency, "",
         "air through the intake, by the file's ambient density");
  s.line("trapped_air", cycle.trapped_air_kg * 1e6, "mg",
         cycle.trapped_kg > 0 ? "in a cylinder when its intake closed" : "no intake closed before a burn");
  s.line("residual_ratio", cycle.residual_ratio, "",
         std::string("burned share of the trapped mass") +
             (cycle.residual_ratio > kMaxResidualThatBurns && cycle.heat_J > 0
                  ? "; so much makes a real engine misfire, here all fuel burns"
                  : ""));
  s.line("fuel_burned", cycle.fuel_kg * 1e6, "mg", remark_on_fuel(cycle.excess_air_ratio));
  if (const double unburned = unburned_kg(engine.gas, figures); unburned > 0)
    s.line("fuel_unburned", unburned * 1e6, "mg",
           "found no air beside that in crevices; the exhaust's lambda lacks it");
  s.line("excess_air_ratio", cycle.excess_air_ratio, "", remark_on_lambda(engine.gas, cycle.excess_air_ratio));
  if (engine.lambda_sensor.in_use) {
    s.line("exhaust_lambda", figures.exhaust_lambda, "", "of the gas in the exhaust manifold, at the end; 100: air");
    s.line("sensor_lambda", figures.sensor_lambda, "", "shown by the sensor");
  }
  if (engine.gas.charge_burn.in_use) {
    s.line("burn_by_charge_start", figures.burn_start_deg, "deg", "where the burn began after the spark");
    s.line("burn_by_charge_duration", figures.burn_duration_deg, "deg", "as the charge had it; 0: nothing burned");
  }
  if (engine.gas.octane_number > 0) {
    s.line("knock_integral", figures.knock_integral, "",
           figures.knock_integral >= 1 ? "of the cylinder nearest to knock: beyond 1, so a real engine knocks here"
                                       : "of the cylinder nearest to knock: a real engine knocks from 1 on");
    if (figures.knock_integral >= 1)
      s.line("knock", figures.knock_deg, "deg",
             "where the first cylinder passes 1; a later burn_start or a fuel of higher octane avoids it");
  }
  s.line("exhaust_temperature", cycle.exhaust_K, "K", "of the gas that leaves through the exhaust valve");
  s.line("heat", cycle.heat_J, "J", "of combustion, of a cylinder's cycle");
  s.line("wall_heat", cycle.wall_heat_J, "J");
  if (engine.gas.walls.capacity_J_K > 0)
    s.line("wall_temperature", figures.wall_K, "K", remark_on_walls(engine.gas.walls, figures));
  if (engine.gas.crevice.any())
    s.line("blow_by", figures.blow_by_kg * 1e6, "mg", "into the crankcase, of a cylinder's cycle");
}

void require_manifolds(const EngineFile& engine, double tick_s) {
  if (!breathes(engine.definition())) return;
  detail::GasManifolds<float> manifolds{};
  TableTargets<float> only{};
  only.gas_manifolds = &manifolds;
  const Status refused = tabulate(engine.definition(), {tick_s, {}}, only);
  const std::string field = refused.field;
  if (refused.reason != Reason::inconsistent || (field != "gas.intake_m3" && field != "gas.exhaust_m3")) return;
  const std::string key = field == "gas.intake_m3" ? "intake_volume_cm3" : "exhaust_volume_cm3";
  throw InputError(engine.path(), engine.section("gas").line_of(key),
                   key + ": too small for a tick of " + brief(tick_s * 1e6) +
                       " us: throttle, outlet and valves could let through more than 80 times this volume in one; "
                       "take a shorter --tick-us");
}

namespace {

/// A runner's first mode has to be followed: pi a h / (2 l) up to 1, a phase of a radian a tick.
std::vector<std::string> warnings_about_runners(const EngineFile& engine, double tick_s) {
  constexpr double kSound_m_s = 346;
  std::vector<std::string> warnings;
  const auto look = [&](const Runner& runner, const std::string& side) {
    const double longest_s = 2 * runner.length_m / (3.14159265358979 * kSound_m_s);
    if (!runner.any() || tick_s <= longest_s) return;
    warnings.push_back(engine.path() + ": warning: a tick of " + brief(tick_s * 1e6) + " us is too long for the " +
                       side + " runners' own " + brief(std::round(kSound_m_s / (4 * runner.length_m))) +
                       " Hz: their waves are damped; take --tick-us " + brief(std::floor(longest_s * 1e6)) +
                       " or less");
  };
  look(engine.definition().gas.intake_runner, "intake");
  look(engine.definition().gas.exhaust_runner, "exhaust");
  return warnings;
}

}  // namespace

std::string beyond_steps_of_gas(const EngineDefinition& engine, double speed_rpm, double tick_s) {
  constexpr double kFollowed_deg = 40;       // eight steps of 5 deg
  constexpr double kPercent_per_deg = 0.12;  // measured: 5 % at 42 deg, 14 % at 120
  const double deg = speed_rpm * 6 * tick_s;
  if (!breathes(engine) || !(deg > kFollowed_deg)) return "";
  return "a tick turns the crank by " + brief(deg) + " deg at " + brief(speed_rpm) +
         " rpm, and gas follows in eight steps of at most 5 deg: net_mep may be off by some " +
         brief(std::round(kPercent_per_deg * deg)) + " %; take --tick-us " +
         brief(std::floor(kFollowed_deg / (speed_rpm * 6) * 1e6)) + " or less";
}

std::vector<std::string> warnings_about_gas(const EngineFile& engine, double speed_rpm, double tick_s) {
  if (!breathes(engine.definition())) return {};
  std::vector<std::string> warnings = warnings_about_runners(engine, tick_s);
  const std::string steps = beyond_steps_of_gas(engine.definition(), speed_rpm, tick_s);
  if (!steps.empty()) warnings.push_back(engine.path() + ": warning: " + steps);
  return warnings;
}

int cycles_to_settle(const EngineDefinition& engine) noexcept {
  if (!breathes(engine)) return 1;
  // Each cycle draws its swept volume out of a manifold. After eight manifold volumes 1e-3 of the initial gas is left.
  // Residual gas and walls settle within some cycles.
  constexpr double kChanges = 8;
  constexpr double kAfter = 6;
  constexpr double kMax = 500;
  const double volume_m3 = std::max(engine.gas.intake_m3, engine.gas.exhaust_m3);
  const double swept_m3 = swept_volume_m3(engine.crank) * engine.layout.cylinders;
  return static_cast<int>(std::min(kMax, std::ceil(kAfter + kChanges * volume_m3 / swept_m3)));
}

}  // namespace crankloop::program

// Of gas exchange: mixture, runners and the burn, in the file and on the command line.
#include <optional>
#include <string>

#include "../files/units.hpp"
#include "../files/words.hpp"
#include "plausibility.hpp"
#include "plausibility_parts.hpp"

namespace crankloop::program {
namespace {

constexpr Interval kLambdaWithSpark{0.7, 2};
constexpr double kAirConstant = 287.1;  ///< J/(kg K)
constexpr double kFilling = 0.9;        ///< volumetric efficiency at an open throttle

/// An engine with gas exchange, and no diesel: the fuel of those burns by two Wiebe functions, and they have more air.
bool has_spark_ignition(const EngineFile& engine) {
  return engine.definition().pressure.source == PressureSource::gas && engine.has("gas") &&
         engine.section("gas").number("second_share") == 0;
}

std::string usual_with_spark() {
  return "; usual with spark ignition: " + brief(kLambdaWithSpark.least) + " to " + brief(kLambdaWithSpark.most);
}

std::string unusual_lambda(const std::string& name, double lambda) {
  return within(kLambdaWithSpark, lambda) ? "" : name + brief(lambda) + usual_with_spark();
}

/// By the lambda of a full cylinder.
std::string unusual_fuel(const SectionValues& gas, const EngineSize& size, const std::string& name, double fuel_mg) {
  const std::optional<double> cylinder_cm3 = size.of(Per::cylinder);
  if (!cylinder_cm3 || fuel_mg == 0) return "";
  const double density_kg_m3 =
      gas.number("ambient_kPa") * 1e3 / (kAirConstant * (gas.number("ambient_C") + kZeroCelsius_K));
  const double lambda = kFilling * density_kg_m3 * *cylinder_cm3 / (fuel_mg * gas.number("air_fuel_ratio"));
  if (within(kLambdaWithSpark, lambda)) return "";
  return name + brief(fuel_mg) + " gives a lambda of about " + about(lambda) + " in a cylinder full of air" +
         usual_with_spark();
}

/// Warns about an unusual lambda, given or in a full cylinder.
void look_at_mixture(const EngineFile& engine, const EngineSize& size, Warnings& warnings) {
  if (!has_spark_ignition(engine)) return;
  const SectionValues& gas = engine.section("gas");
  const bool by_air = gas.has("excess_air_ratio");
  const std::string unusual = by_air ? unusual_lambda("excess_air_ratio = ", gas.number("excess_air_ratio"))
                                     : unusual_fuel(gas, size, "fuel_mg = ", gas.number("fuel_mg"));
  warnings.add_if_any(gas.line_of(by_air ? "excess_air_ratio" : "fuel_mg"), unusual);
}

/// Warns about a burn by charge, and an octane number, of a fuel that burns by two laws: they are of gasoline in a
/// flame.
void look_at_burn(const EngineFile& engine, Warnings& warnings) {
  const Gas& gas = engine.definition().gas;
  if (!(gas.second_ratio > 0)) return;
  const SectionValues& values = engine.section("gas");
  const std::string why = ": a law of gasoline, and second_share = " + brief(gas.second_ratio) + " is a diesel's";
  if (gas.charge_burn.in_use) warnings.add(values.line_of("burn_by"), "burn_by = charge" + why);
  if (gas.octane_number > 0) warnings.add(values.line_of("octane"), "octane = " + brief(gas.octane_number) + why);
}

/// Warns about a manifold that is no large volume for its runners: docs/model.md "Runners".
void look_at_runners(const EngineFile& engine, Warnings& warnings) {
  constexpr double kLeastVolumes = 5;
  const Gas& gas = engine.definition().gas;
  const auto look = [&](const Runner& runner, double manifold_m3, const std::string& key) {
    if (!runner.any() || manifold_m3 >= kLeastVolumes * runner.volume_m3()) return;
    warnings.add(engine.section("gas").line_of(key),
                 key + " = " + brief(manifold_m3 * 1e6) + " is less than five volumes of a runner, " +
                     brief(runner.volume_m3() * 1e6) + " cm3 each: its frequency is then 5 to 13 % low");
  };
  look(gas.intake_runner, gas.intake_m3, "intake_volume_cm3");
  look(gas.exhaust_runner, gas.exhaust_m3, "exhaust_volume_cm3");
}

}  // namespace

void look_at_gas(const EngineFile& engine, const EngineSize& size, Warnings& warnings) {
  if (engine.definition().pressure.source != PressureSource::gas || !engine.has("gas")) return;
  look_at_mixture(engine, size, warnings);
  look_at_runners(engine, warnings);
  look_at_burn(engine, warnings);
}

std::vector<std::string> warnings_about_order(const EngineFile& engine, const GasOrder& order) {
  if (!engine.has("gas")) return {};
  Warnings warnings(engine);
  const GasOrder of_file = gas_order(engine.definition().gas);
  if (order.burn_start_deg != of_file.burn_start_deg) {
    const UsualRange& range = *usual_range_of(*find_key("gas", "burn_start_deg"));
    warnings.add_unless(range.usual, order.burn_start_deg, 0, "--burn-start-deg", " deg");
  }
  if (!has_spark_ignition(engine)) return warnings.lines();
  if (order.excess_air_ratio > 0 && order.excess_air_ratio != of_file.excess_air_ratio)
    warnings.add_if_any(0, unusual_lambda("--lambda ", order.excess_air_ratio));
  if (order.fuel_kg > 0 && order.fuel_kg != of_file.fuel_kg) {
    Warnings told_of_file(engine);
    const EngineSize size = look_at_crank(engine, told_of_file);
    warnings.add_if_any(0, unusual_fuel(engine.section("gas"), size, "--fuel-mg ", order.fuel_kg * 1e6));
  }
  return warnings.lines();
}

}  // namespace crankloop::program

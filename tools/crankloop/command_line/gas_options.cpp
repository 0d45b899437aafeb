#include "gas_options.hpp"

#include "../engine_file/plausibility.hpp"
#include "../files/error.hpp"
#include "../files/number.hpp"

namespace crankloop::program {

void set_fuel_mg(GasOrder& order, double fuel_mg) { order.fuel_kg = millionths(fuel_mg), order.excess_air_ratio = 0; }

namespace {

/// The file's, with lambda and burn of the command line as they stand there.
GasOrder lambda_and_spark_given(const Arguments& arguments, const EngineFile& engine) {
  GasOrder order = gas_order(engine.definition().gas);
  if (arguments.has(kLambda.name)) order.excess_air_ratio = arguments.number(kLambda.name), order.fuel_kg = 0;
  if (arguments.has(kBurnStart.name)) order.burn_start_deg = arguments.number(kBurnStart.name);
  return order;
}

}  // namespace

GasOrder lambda_and_spark(const Arguments& arguments, const EngineFile& engine) {
  if (arguments.has(kFuel.name) && arguments.has(kLambda.name))
    throw UsageError("--fuel-mg and --lambda both say how much fuel: give one of them");
  const GasOrder order = lambda_and_spark_given(arguments, engine);
  const double end_deg = order.burn_start_deg + order.burn_duration_deg * engine.definition().gas.span_ratio();
  if (end_deg > kLatestBurn_deg) {
    throw UsageError("--burn-start-deg: the burn would end at " + brief(end_deg) + " deg; it must end by " +
                     brief(kLatestBurn_deg) + " deg");
  }
  return order;
}

GasOrder fuel_and_spark(const Arguments& arguments, const EngineFile& engine) {
  GasOrder order = lambda_and_spark(arguments, engine);
  if (arguments.has(kFuel.name)) set_fuel_mg(order, arguments.number(kFuel.name));
  return order;
}

GasOrder gas_order(const Arguments& arguments, const EngineFile& engine, double throttle_unless_told) {
  if (!breathes(engine.definition())) {
    for (const Option& option : {kThrottle, kFuel, kLambda, kBurnStart}) {
      if (!arguments.has(option.name)) continue;
      throw UsageError(std::string(option.name) + ": " + engine.path() +
                       " has no gas exchange; the option needs [pressure] source = gas");
    }
    return {};
  }
  if (arguments.has("--load-ratio")) {
    throw UsageError("--load-ratio: " + engine.path() +
                     " has gas exchange (source = gas), no diagram to scale; use --throttle and --lambda or --fuel-mg");
  }
  GasOrder order = fuel_and_spark(arguments, engine);
  order.throttle_ratio = arguments.has(kThrottle.name) ? arguments.number(kThrottle.name) : throttle_unless_told;
  return order;
}

std::vector<std::string> warnings_about_gas_options(const Arguments& arguments, const EngineFile& engine) {
  GasOrder order = lambda_and_spark_given(arguments, engine);
  if (arguments.has(kFuel.name)) set_fuel_mg(order, arguments.number(kFuel.name));
  return warnings_about_order(engine, order);
}

std::string fuel_option(const GasOrder& order) {
  return order.excess_air_ratio > 0 ? "--lambda " + shortest(order.excess_air_ratio)
                                    : "--fuel-mg " + brief(order.fuel_kg * 1e6);
}

std::string options_of(const GasOrder& order) {
  return "--throttle " + shortest(order.throttle_ratio) + " " + fuel_option(order) + " --burn-start-deg " +
         shortest(order.burn_start_deg);
}

}  // namespace crankloop::program

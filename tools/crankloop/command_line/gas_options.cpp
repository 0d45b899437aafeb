#include "gas_options.hpp"

#include "../files/error.hpp"
#include "../files/number.hpp"

namespace crankloop::program {

GasOrder fuel_and_spark(const Arguments& arguments, const EngineFile& engine) {
  const Gas& gas = engine.definition().gas;
  GasOrder order = gas_order(gas);
  if (arguments.has(kFuel.name)) order.fuel_kg = millionths(arguments.number(kFuel.name));
  if (arguments.has(kBurnStart.name)) order.burn_start_deg = arguments.number(kBurnStart.name);
  const double end_deg = order.burn_start_deg + order.burn_duration_deg * gas.span_ratio();
  if (end_deg > kLatestBurn_deg) {
    throw UsageError("--burn-start-deg: the burn would end at " + brief(end_deg) + " deg; it must end by " +
                     brief(kLatestBurn_deg) + " deg");
  }
  return order;
}

GasOrder gas_order(const Arguments& arguments, const EngineFile& engine, double throttle_unless_told) {
  if (!breathes(engine.definition())) {
    for (const Option& option : {kThrottle, kFuel, kBurnStart}) {
      if (!arguments.has(option.name)) continue;
      throw UsageError(std::string(option.name) + ": " + engine.path() +
                       " has its pressure from a diagram, or none; only [pressure] source = gas takes it");
    }
    return {};
  }
  if (arguments.has("--load-ratio")) {
    throw UsageError("--load-ratio: " + engine.path() +
                     " breathes (source = gas) and has no diagram to scale; take --throttle and --fuel-mg");
  }
  GasOrder order = fuel_and_spark(arguments, engine);
  order.throttle_ratio = arguments.has(kThrottle.name) ? arguments.number(kThrottle.name) : throttle_unless_told;
  return order;
}

std::string options_of(const GasOrder& order) {
  return "--throttle " + shortest(order.throttle_ratio) + " --fuel-mg " + brief(order.fuel_kg * 1e6) +
         " --burn-start-deg " + shortest(order.burn_start_deg);
}

}  // namespace crankloop::program

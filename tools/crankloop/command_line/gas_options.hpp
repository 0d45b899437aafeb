// The inputs of an engine with gas exchange on the command line: throttle, fuel, spark.
#pragma once

#include <string>
#include <vector>

#include <crankloop/scenes.hpp>

#include "../engine_file/engine_file.hpp"
#include "../engine_file/gas_order.hpp"
#include "arguments.hpp"

namespace crankloop::program {

inline constexpr Option kThrottle =
    number("--throttle", "R", from(0).up_to(1), "throttle of an engine with gas exchange: 0 closed, 1 wide open", "1");
inline constexpr Option kFuel = number("--fuel-mg", "M", from(0).up_to(kMaxFuel_kg * 1e6),
                                       "fuel per cylinder and cycle in mg, with gas exchange; default the file's");
inline constexpr Option kLambda =
    number("--lambda", "L", above(0).up_to(kMaxExcessAir_ratio),
           "excess-air ratio: fuel follows the air in each cylinder, instead of --fuel-mg; default the file's");
inline constexpr Option kBurnStart =
    number("--burn-start-deg", "A", from(-90).up_to(60), "start of the burn, firing TDC = 0; default the file's");

/// The file's, with the lambda and the burn of the command line; throws UsageError where that has the fuel too.
[[nodiscard]] GasOrder lambda_and_spark(const Arguments& arguments, const EngineFile& engine);

/// As many milligrams of fuel, whatever the air.
void set_fuel_mg(GasOrder& order, double fuel_mg);

/// The file's, with the fuel and burn of the command line.
[[nodiscard]] GasOrder fuel_and_spark(const Arguments& arguments, const EngineFile& engine);

/// The same, with the throttle. Throws UsageError for such options where the engine has no gas exchange,
/// and for --load-ratio where it does.
[[nodiscard]] GasOrder gas_order(const Arguments& arguments, const EngineFile& engine, double throttle_unless_told);

/// Where the options above are given and unusual: warnings.
[[nodiscard]] std::vector<std::string> warnings_about_gas_options(const Arguments& arguments, const EngineFile& engine);

/// "--lambda 1", or "--fuel-mg 30".
[[nodiscard]] std::string fuel_option(const GasOrder& order);
/// "--throttle 1 --lambda 1 --burn-start-deg -18".
[[nodiscard]] std::string options_of(const GasOrder& order);

}  // namespace crankloop::program

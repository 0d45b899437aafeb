#include "input_option.hpp"

#include <utility>

#include "../files/error.hpp"
#include "../files/number.hpp"

namespace crankloop::program {

namespace {

/// An option that a column of the file would override from the first tick on.
constexpr std::pair<const char*, const char*> kSameInput[] = {
    {"--load-ratio", "load_ratio"},
    {"--throttle", "throttle_ratio"},
    {"--lambda", "excess_air_ratio"},
    {"--burn-start-deg", "burn_start_deg"},
    {"--cut", "cut_cylinders"},
    {"--starter", "starter"},
    {"--external-torque-Nm", "external_torque_Nm"},
    {"--fault-bits", "wheel_faults"},
};

}  // namespace

std::optional<InputSchedule> read_inputs(const Arguments& arguments, const EngineFile& engine,
                                         const std::vector<SceneInput>& inputs) {
  if (!arguments.has(kInputs.name)) return std::nullopt;
  InputSchedule schedule(arguments.text(kInputs.name), inputs);
  for (const auto& [option, column] : kSameInput) {
    if (arguments.has(option) && schedule.drives_any(column))
      throw UsageError(std::string(option) + " and the column " + column + " of " + schedule.path() +
                       " give the same input; leave out one of them");
  }
  const EngineDefinition& definition = engine.definition();
  if (schedule.largest("starter") != 0 && definition.starter.stall_Nm == 0) {
    throw InputError(schedule.path() + ": column starter: " + engine.path() +
                     " has no [starter] with a torque, so it has nothing to turn the crank with");
  }
  if (schedule.drives("load_ratio") && definition.pressure.source == PressureSource::none)
    throw InputError(schedule.path() + ": column load_ratio: " + engine.path() + " has no pressure source to scale");
  return schedule;
}

std::vector<std::string> warnings_about_inputs(const InputSchedule& schedule, double excess_air_ratio) {
  std::vector<std::string> warnings;
  if (schedule.drives_any("fuel_kg") && !schedule.drives_any("excess_air_ratio") && excess_air_ratio > 0) {
    warnings.push_back(schedule.path() +
                       ": warning: column fuel_kg has no effect: excess_air_ratio = " + brief(excess_air_ratio) +
                       " sets the fuel; add a column excess_air_ratio with 0, or give --fuel-mg");
  }
  if (schedule.drives_any("spark_advance_deg") && schedule.largest("by_spark_advance") == 0) {
    warnings.push_back(schedule.path() +
                       ": warning: column spark_advance_deg has no effect: burn_start_deg sets the burn; add a column "
                       "by_spark_advance with 1");
  }
  return warnings;
}

}  // namespace crankloop::program

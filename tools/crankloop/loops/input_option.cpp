#include "input_option.hpp"

#include "../files/error.hpp"

namespace crankloop::program {

std::optional<InputSchedule> read_inputs(const Arguments& arguments, const EngineFile& engine,
                                         const std::vector<SceneInput>& inputs) {
  if (!arguments.has(kInputs.name)) return std::nullopt;
  InputSchedule schedule(arguments.text(kInputs.name), inputs);
  const EngineDefinition& definition = engine.definition();
  if (schedule.largest("starter") != 0 && definition.starter.stall_Nm == 0) {
    throw InputError(schedule.path() + ": column starter: " + engine.path() +
                     " has no [starter] with a torque, so it has nothing to turn the crank with");
  }
  if (schedule.drives("load_ratio") && definition.pressure.source == PressureSource::none)
    throw InputError(schedule.path() + ": column load_ratio: " + engine.path() + " has no pressure source to scale");
  return schedule;
}

}  // namespace crankloop::program

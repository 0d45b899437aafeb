#include "free_request.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "../../command_line/engine_argument.hpp"
#include "../../command_line/gas_options.hpp"
#include "../../engine_file/plausibility.hpp"
#include "../../files/error.hpp"
#include "../../files/number.hpp"
#include "../../files/words.hpp"
#include "../../loops/fault_option.hpp"
#include "../../loops/input_option.hpp"
#include "free_run.hpp"

namespace crankloop::program {
namespace {

/// "1,3": cylinders as the engine file counts them, from 1.
std::uint32_t cut_cylinders(const std::string& text, const Layout& layout) {
  std::uint32_t cut = 0;
  for (const std::string_view one : split(text, ',')) {
    const ParsedNumber number = parse_number(one, from(1).up_to(layout.cylinders), "");
    if (!number.ok()) throw UsageError("--cut: " + number.problem);
    const auto cylinder = static_cast<std::uint32_t>(number.value);
    if (static_cast<double>(cylinder) != number.value)
      throw UsageError("--cut: " + in_quotes(one) + " is not a whole number");
    cut |= 1u << (cylinder - 1);
  }
  return cut;
}

/// The file's engine, with the brake of the command line.
EngineDefinition loaded(const EngineFile& file, const Arguments& arguments) {
  EngineDefinition definition = file.definition();
  if (arguments.has("--machine-Nm"))
    definition.machine = {arguments.number("--machine-Nm"), 0, 0, definition.machine.inertia_kg_m2};
  return definition;
}

/// What an input file may drive: the scene's inputs, of which those of this engine.
std::shared_ptr<const InputSchedule> schedule_of(const Arguments& arguments, const EngineFile& file) {
  detail::EngineShape shape;
  shape.cylinders = static_cast<std::uint32_t>(file.definition().layout.cylinders);
  std::optional<InputSchedule> schedule =
      read_inputs(arguments, file,
                  breathes(file.definition()) ? scene_inputs<scenes::BreathingFree>(shape)
                                              : scene_inputs<scenes::FreeRunning>(shape));
  return schedule ? std::make_shared<const InputSchedule>(std::move(*schedule)) : nullptr;
}

std::string command_line(const Arguments& arguments, const EngineFile& file, const GasOrder& gas) {
  std::string text = "crankloop run " + shell_word(arguments.file()) + " --free";
  for (const char* number : {"--from-rpm", "--seconds", "--tick-us", "--load-ratio", "--machine-Nm"}) {
    if (number == std::string_view("--machine-Nm") && !arguments.has(number)) continue;  // the file's brake
    if (number == std::string_view("--load-ratio") && breathes(file.definition())) continue;
    text += std::string(" ") + number + " " + shortest(arguments.number(number));
  }
  if (breathes(file.definition())) text += " " + options_of(gas);
  if (arguments.has("--starter")) text += " --starter";
  if (arguments.has("--cut")) text += " --cut " + arguments.text("--cut");
  if (arguments.has("--fault-bits")) text += " --fault-bits " + arguments.text("--fault-bits");
  for (const std::string& misfire : arguments.words("--misfire")) text += " --misfire " + shell_word(misfire);
  if (arguments.has("--inputs")) text += " --inputs " + shell_word(arguments.text("--inputs"));
  return text + " --real " + arguments.text("--real");
}

}  // namespace

void require_options_that_fit(const Arguments& arguments) {
  const bool free = arguments.has("--free");
  for (const char* option : {"--machine-Nm", "--starter", "--from-rpm", "--seconds", "--cut", "--misfire",
                             "--fault-bits", "--inputs", "--analogue", "--cranking"}) {
    if (!free && arguments.has(option)) throw UsageError(std::string(option) + " is for a run with --free");
  }
  if (free && arguments.has("--rpm"))
    throw UsageError("--rpm is for a run at constant speed; with --free the speed begins at --from-rpm");
  if (free && arguments.has("--cycles"))
    throw UsageError("--cycles is for a run at constant speed; with --free take --seconds");
}

/// Faults switched by time alone, after the end.
std::vector<std::string> warnings_about_late_faults(const EngineFile& file, double seconds) {
  std::vector<std::string> warnings;
  std::size_t fault = 0;
  for (const SectionValues& section : file.sections()) {
    if (section.kind != "fault") continue;
    const WheelFault& when = file.definition().wheel_faults[fault++];
    if (when.input_bit >= 0 || when.start_s < seconds) continue;
    warnings.push_back(file.path() + ":" + std::to_string(section.line_of("start_s")) + ": warning: " +
                       section.title() + " begins at " + brief(when.start_s) + " s, after the end of --seconds " +
                       brief(seconds));
  }
  return warnings;
}

int run_free_by(const Arguments& arguments, const EngineFile& file, const GasOrder& gas,
                std::vector<std::string> warnings) {
  const EngineDefinition definition = loaded(file, arguments);
  if (arguments.has("--starter") && definition.starter.stall_Nm == 0) {
    throw InputError(file.path() +
                     ": there is no [starter] with a torque, so --starter has nothing to turn the crank with");
  }
  FreeRequest request;
  request.operation.tick_s = millionths(arguments.number("--tick-us"));
  request.operation.load_ratio = arguments.number("--load-ratio");
  request.operation.from_rpm = arguments.number("--from-rpm");
  request.operation.seconds = arguments.number("--seconds");
  if (request.operation.seconds < request.operation.tick_s) {
    throw UsageError("--seconds: " + shortest(request.operation.seconds) + " is shorter than a tick of " +
                     shortest(arguments.number("--tick-us")) + " us");
  }
  request.operation.gas = gas;
  request.operation.starter = arguments.has("--starter");
  if (arguments.has("--cut"))
    request.operation.cut_cylinders = cut_cylinders(arguments.text("--cut"), definition.layout);
  request.operation.wheel_faults = fault_bits(arguments, definition);
  request.operation.schedule = schedule_of(arguments, file);
  request.real = arguments.text("--real");
  request.is_hashed = arguments.has("--hash");
  request.command_line = command_line(arguments, file, gas);
  const std::vector<std::string> of_inputs =
      request.operation.schedule ? warnings_about_inputs(*request.operation.schedule, gas.excess_air_ratio)
                                 : std::vector<std::string>{};
  for (const auto& lines : {warnings_about_running_free(file, definition), warnings_about_sensor_faults_left_out(file),
                            warnings_about_late_faults(file, request.operation.seconds), of_inputs,
                            warnings_about_gas(file, 0, request.operation.tick_s)}) {
    for (std::string& line : tell_warnings(arguments, lines)) warnings.push_back(std::move(line));
  }
  request.warnings = std::move(warnings);
  Results results(arguments, {"--csv", "--report", "--vcd", "--analogue", "--cranking"});
  for (const char* option : {"--analogue", "--cranking"}) {
    if (results[option] != nullptr && definition.reluctor.wheel < 0)
      throw InputError(file.path() + ": there is no [reluctor], so " + option + " has nothing to write");
  }
  run_free(file, definition, request, results);
  return kSuccess;
}

}  // namespace crankloop::program

// `crankloop new`: a complete engine file from a few numbers.
//
// What belongs here: options, the order of the sections, the check of what they make. What does not: their lines
// (draft.hpp), usual values and their sources (usual_engine.hpp), the format of engine files (engine_file/).
#include <memory>
#include <string>

#include <crankloop/tabulate/indicator_diagram.hpp>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../engine_file/crankshaft_words.hpp"
#include "../../engine_file/plausibility.hpp"
#include "../../engine_file/problems.hpp"
#include "../../files/error.hpp"
#include "../../files/output_file.hpp"
#include "../../files/words.hpp"
#include "draft.hpp"

namespace crankloop::program {
namespace {

constexpr const char* kCommand = "crankloop new";

/// "crankloop new: firing_order: cylinder 2 does not fire": the user does not have the file.
InputError without_lines(const InputError& error) { return InputError(without_line_numbers(error.what(), kCommand)); }

EngineFile read_draft(const std::string& text) {
  try {
    return read_engine_text(text, kCommand, {});
  } catch (const InputError& error) {
    throw without_lines(error);
  }
}

/// The diagram from the sections that friction depends on.
std::unique_ptr<IndicatorDiagram> diagram_of(const EngineFile& engine) {
  auto diagram = std::make_unique<IndicatorDiagram>();  // large
  const EngineDefinition& d = engine.definition();
  const Status status = diagram->init(d.crank, d.pressure);
  if (!status.ok()) throw without_lines(engine.explain(status));
  return diagram;
}

/// As it stands in the file, behind the blank of "name = ".
void require_name(const std::string& name) {
  if (trim(name).empty()) throw UsageError("--name: the value is missing");
  if ((" " + name).find(" #") != std::string::npos)
    throw UsageError("--name: a # at the start or behind a blank starts a comment in an engine file");
}

/// Outside of it, what is assumed of gas exchange is beyond what an engine file takes.
void require_bore_for_gas(double bore_mm) {
  constexpr Range kBore_mm = from(13).up_to(400);
  if (!kBore_mm.contains(bore_mm))
    throw UsageError("--bore-mm: " + shortest(bore_mm) +
                     " is out of range with --gas; allowed: " + describe(kBore_mm, ""));
}

/// What a spark-ignition engine with gas exchange burns follows from its air.
void refuse_mep_of_air(const Arguments& arguments) {
  if (!arguments.has("--gas") || !arguments.has("--net-mep-kPa") || arguments.text("--type") != "si") return;
  throw UsageError(
      "--net-mep-kPa: with --gas the fuel of a spark-ignition engine follows its air, and `run` prints what "
      "that gives; leave it out, or --gas");
}

/// Real engines that tests hold what is assumed against have up to 2.4.
std::string unusual_boost(double pressure_ratio) {
  constexpr double kMost = 2.4;
  if (pressure_ratio <= kMost) return "";
  return "--boost " + brief(pressure_ratio) + ": what is assumed was compared with engines of up to " + brief(kMost);
}

int run_new(const Arguments& arguments) {
  require_name(arguments.text("--name"));
  if (arguments.has("--gas")) require_bore_for_gas(arguments.number("--bore-mm"));
  refuse_mep_of_air(arguments);
  const std::string& type = arguments.text("--type");
  Numbers n;
  n.design.type = type == "si"       ? EngineType::spark_ignition
                  : type == "diesel" ? EngineType::diesel
                                     : EngineType::tractor;
  n.design.four_valves = arguments.text("--valves") == "4";
  n.design.pressure_ratio = arguments.number("--boost");
  Draft crank(arguments);
  add_crank(crank, arguments, n);
  Draft diagram(arguments);
  add_pressure(diagram, n);
  Draft gas(arguments);
  if (arguments.has("--gas")) {
    const double cylinder_cm3 = n.displacement_L * 1e3 / n.cylinders;
    n.gas = usual_gas_exchange(n.design, {n.bore_mm, cylinder_cm3, cylinder_cm3 / (n.compression_ratio - 1)},
                               n.cylinders, n.rated_rpm);
    add_gas_exchange(gas, n);
  }
  Draft body(arguments);
  add_masses_and_layout(body, arguments, n);
  if (n.cylinders > 1) add_places(body, read_draft(crank.text() + body.text() + diagram.text()).definition().layout, n);
  const EngineFile half_way = read_draft(crank.text() + body.text() + diagram.text());
  const std::unique_ptr<IndicatorDiagram> estimate = diagram_of(half_way);
  Draft rest(arguments);
  add_what_turns_it(rest, *estimate, n);
  add_train(rest, "intake", 468, n);
  add_train(rest, "exhaust", n.gas ? n.gas->exhaust_full_lift_deg : 262, n);
  add_triggers(rest);
  const std::string text =
      "# An engine file from a few numbers, by `crankloop new`. Values from its command line are marked \"given\",\n"
      "# all others \"assumed\", with the reason: replace them by what you know. Angles are crank degrees, 0 at "
      "cylinder 1's firing "
      "TDC.\n" +
      crank.text() + body.text() + crankshaft_comments(half_way.definition().layout) + (n.gas ? gas : diagram).text() +
      rest.text();
  const EngineFile engine = read_draft(text);
  tell_warnings(arguments, warnings_about(engine));
  const std::string unusual[] = {n.gas ? unusual_peak(estimate->peak_Pa()) : "",
                                 unusual_boost(n.design.pressure_ratio)};
  for (const std::string& what : unusual)
    if (!what.empty()) tell_warnings(arguments, {std::string(kCommand) + ": warning: " + what});
  print(text);
  return kSuccess;
}

constexpr Option kNewOptions[] = {
    required(whole_number("--cylinders", "N", from(1).up_to(kMaxCylinders), "number of cylinders")),
    required(number("--bore-mm", "D", from(1).up_to(800), "bore in mm, with --gas 13 to 400")),
    required(number("--stroke-mm", "S", from(5).up_to(4000), "stroke in mm")),
    choice("--type", "si|diesel|tractor", "spark ignition, car and truck diesel, or tractor diesel", "si"),
    choice("--valves", "2|4", "valves of a cylinder", "4"),
    flag("--gas", "pressure from gas exchange instead of a diagram: [gas], ports and seats of the valves"),
    number("--boost", "R", from(1).up_to(5), "intake pressure over ambient pressure, at full load", "1"),
    text("--name", "TEXT", "name of the engine in reports", "new engine"),
    number("--rated-rpm", "N", above(0).up_to(100000), "rated speed in rpm"),
    number("--compression-ratio", "E", above(1).up_to(100), "geometric"),
    number("--rod-length-mm", "L", above(0).up_to(10000), "pin to pin, in mm"),
    text("--firing-order", "1-3-2", "needed for 7, 9 and more cylinders and with banks"),
    text("--firing-angles-deg", "0,270",
         "each cylinder's firing top dead centre, 0 to below 720, instead of the order"),
    text("--bank-angles-deg", "0,90", "each cylinder's axis from the vertical; without it inline"),
    number("--net-mep-kPa", "P", above(0).up_to(100000), "net indicated mean effective pressure at full load"),
    number("--piston-g", "M", above(0).up_to(5e6), "piston with rings and pin, in g"),
    number("--crank-inertia-kg-m2", "J", above(0).up_to(1e6), "crankshaft with flywheel"),
};

}  // namespace

const Command kNew{"new",
                   "prints a complete engine file from a few numbers, each line given or assumed",
                   "--cylinders N --bore-mm D --stroke-mm S [...]",
                   "crankloop new --cylinders 3 --bore-mm 74 --stroke-mm 77 --rated-rpm 5500 > three.ini",
                   0,
                   kNewOptions,
                   run_new};

}  // namespace crankloop::program

// `crankloop masses`: masses for a first design.
#include <crankloop/tabulate/first_design.hpp>

#include "../command_line/commands.hpp"
#include "../command_line/summary.hpp"
#include "../files/error.hpp"
#include "../files/output_file.hpp"

namespace crankloop::program {
namespace {

void add_interval(Summary& s, const std::string& name, Interval interval, double scale, const char* unit) {
  s.line("min_" + name, interval.least * scale, unit);
  s.line("max_" + name, interval.most * scale, unit);
}

int run_masses(const Arguments& arguments) {
  const std::string& type = arguments.text("--type");
  const EngineKind kind = type == "si"       ? EngineKind::spark_ignition
                          : type == "diesel" ? EngineKind::diesel
                                             : EngineKind::tractor_diesel;
  const FirstDesign design = first_design(kind, arguments.number("--bore-mm") / 1000, arguments.number("--speed-rpm"));
  Summary s;
  add_interval(s, "piston_group", design.piston_kg, 1000, "g");
  add_interval(s, "rod", design.rod_kg, 1000, "g");
  add_interval(s, "rod_share_at_piston_pin_inline", design.pin_share_inline, 1, "");
  add_interval(s, "rod_share_at_piston_pin_v", design.pin_share_v, 1, "");
  print(s.text());
  return kSuccess;
}

constexpr Option kMassesOptions[] = {
    required(choice("--type", "si|diesel|tractor", "spark ignition, car and truck diesel, or tractor diesel")),
    required(number("--bore-mm", "D", above(0).up_to(2000), "bore in mm")),
    required(number("--speed-rpm", "N", above(0).up_to(100000), "rated speed in rpm")),
};

}  // namespace

const Command kMasses{"masses",
                      "usual masses of piston and rod, for a first design",
                      "--type si|diesel|tractor --bore-mm D --speed-rpm N",
                      "crankloop masses --type diesel --bore-mm 95 --speed-rpm 2000",
                      0,
                      kMassesOptions,
                      run_masses};

}  // namespace crankloop::program

// `crankloop new`: a complete engine file from a few numbers.
//
// What belongs here: the file, line by line. What does not: usual values and their sources (usual_engine.hpp), the
// format of engine files (engine_file/).
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <crankloop/tabulate/indicator_diagram.hpp>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../engine_file/crankshaft_words.hpp"
#include "../../engine_file/plausibility.hpp"
#include "../../files/error.hpp"
#include "../../files/output_file.hpp"
#include "../../files/units.hpp"
#include "usual_engine.hpp"

namespace crankloop::program {
namespace {

constexpr double kRodRatio = 0.28;
constexpr double kStarterNmPerLitre =
    280;  ///< for one cylinder; divided by the root of the number of cylinders, which share the compression work
constexpr double kCamEndsWith_m_s = 0.2;  ///< at rated speed; the valve's seating speed is this plus the train's
                                          ///< vibration
constexpr double kMostClearancePerLift = 0.008;
constexpr double kSpringMargin = 1.9;  ///< spring force at full lift / inertia force at the nose at rated speed
constexpr double kPreloadShare = 0.4;  ///< preload / spring force at full lift
constexpr double kTrainOrders = 40;    ///< natural frequency of the train / rotation frequency of the cam; the sample
                                       ///< engines have 35 and 38

double to_three_digits(double value) {
  if (value == 0) return 0;
  const double digit = std::pow(10, std::floor(std::log10(std::abs(value))) - 2);
  return parse_number(brief(std::round(value / digit) * digit)).value;
}

const char* usual_firing_order(int cylinders) {
  constexpr const char* kOrders[] = {"1", "1-2", "1-3-2", "1-3-4-2", "1-2-4-5-3", "1-5-3-6-2-4", "", "1-6-2-5-8-3-7-4"};
  return cylinders <= 8 ? kOrders[cylinders - 1] : "";
}

/// Writes the file: each line states the source of its value.
class Draft {
 public:
  explicit Draft(const Arguments& arguments) : arguments_{arguments} {}

  void section(const char* title) { text_ += std::string("\n[") + title + "]\n"; }
  void line(const char* key, const std::string& value, const std::string& remark) {
    std::string line = std::string(key) + " = " + value;
    line.resize(std::max(line.size() + 2, kRemarkColumn), ' ');
    text_ += line + "# " + remark + "\n";
  }
  void assume(const char* key, double value, const std::string& why) { line(key, shortest(value), "assumed: " + why); }

  /// The option's value if it is given; else the assumed one, to three digits.
  double number(const char* key, const char* option, double usual, const std::string& why) {
    if (!arguments_.has(option)) {
      usual = to_three_digits(usual);
      assume(key, usual, why);
      return usual;
    }
    line(key, shortest(arguments_.number(option)), "given");
    return arguments_.number(option);
  }

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  static constexpr std::size_t kRemarkColumn = 36;
  const Arguments& arguments_;
  std::string text_;
};

/// Values that several sections use.
struct Numbers {
  EngineDesign design;
  int cylinders = 0;
  double bore_mm = 0;
  double stroke_mm = 0;
  double rated_rpm = 0;
  double displacement_L = 0;  ///< of all cylinders
  double compression_ratio = 0;
  double net_mep_kPa = 0;
  double brake_Nm = 0;
  std::optional<GasExchange> gas{};  ///< where the pressure follows from it

  [[nodiscard]] double piston_speed_m_s() const noexcept { return stroke_mm * rated_rpm / 30e3; }
  [[nodiscard]] bool is_boosted() const noexcept { return design.pressure_ratio > 1; }
};

void add_crank(Draft& draft, const Arguments& arguments, Numbers& n) {
  const double piston_m_s = usual_piston_speed_m_s(n.design);
  n.stroke_mm = arguments.number("--stroke-mm");
  draft.section("engine");
  draft.line("name", arguments.text("--name"), arguments.has("--name") ? "given" : "assumed");
  n.rated_rpm = draft.number("rated_rpm", "--rated-rpm", std::round(piston_m_s * 300 / n.stroke_mm) * 100,
                             "a mean piston speed of " + shortest(piston_m_s) + " m/s");
  draft.section("crank");
  n.bore_mm = draft.number("bore_mm", "--bore-mm", 0, "");
  draft.number("stroke_mm", "--stroke-mm", 0, "");
  draft.number("rod_length_mm", "--rod-length-mm", std::round(n.stroke_mm / 2 / kRodRatio * 10) / 10,
               "a rod ratio of " + shortest(kRodRatio));
  draft.assume("pin_offset_mm", 0, "none");
  n.compression_ratio = draft.number("compression_ratio", "--compression-ratio",
                                     usual_combustion(n.design).compression_ratio, "usual for this kind");
  n.cylinders = arguments.whole_number("--cylinders");
  n.displacement_L = kPi / 4 * n.bore_mm * n.bore_mm * n.stroke_mm * n.cylinders / 1e6;
}

void add_masses_and_layout(Draft& draft, const Arguments& arguments, const Numbers& n) {
  const double rod_g = usual_rod_g(n.design, n.bore_mm);
  draft.section("masses");
  draft.number("piston_g", "--piston-g", usual_piston_g(n.design, n.bore_mm),
               "with rings and pin, proportional to bore cubed, as in current engines");
  draft.assume("rod_small_end_g", to_three_digits(rod_g * kRodShareAtPin),
               shortest(kRodShareAtPin) + " of the rod, whose mass is proportional to bore cubed");
  draft.assume("rod_big_end_g", to_three_digits(rod_g * (1 - kRodShareAtPin)), "the rest of it");
  draft.assume("crank_pin_equivalent_g", 0, "balanced by the webs; adds to the centrifugal force only");
  draft.number("crank_inertia_kg_m2", "--crank-inertia-kg-m2", usual_inertia_kg_m2(n.design, n.displacement_L),
               "proportional to displacement to the power of 4/3; flywheel included");
  draft.section("layout");
  draft.line("cylinders", std::to_string(n.cylinders), "given");
  const bool banked = arguments.has("--bank-angles-deg");
  const bool ordered = arguments.has("--firing-order");
  arguments.refuse_with("--firing-order", {"--firing-angles-deg"});
  if (arguments.has("--firing-angles-deg")) {
    draft.line("firing_angles_deg", arguments.text("--firing-angles-deg"), "given");
  } else {
    const std::string usual_order = banked ? "" : usual_firing_order(n.cylinders);
    if (!ordered && usual_order.empty())
      throw UsageError(
          "--firing-order or --firing-angles-deg is missing: there is no usual firing order for these cylinders");
    draft.line("firing_order", ordered ? arguments.text("--firing-order") : usual_order,
               ordered ? "given" : "assumed: the usual one");
  }
  if (banked) draft.line("bank_angles_deg", arguments.text("--bank-angles-deg"), "given");
  if (!banked)
    draft.assume("cylinder_spacing_mm", to_three_digits(1.2 * n.bore_mm), "1.2 bores; matters for free moments only");
}

void add_pressure(Draft& draft, Numbers& n) {
  const Combustion& usual = usual_combustion(n.design);
  const std::string breathes =
      n.is_boosted() ? "boosted, " + shortest(n.design.pressure_ratio) + " times ambient" : "naturally aspirated";
  draft.section("pressure");
  draft.line("source", "wiebe", "assumed: synthesised until there is a measured diagram (angle_table)");
  draft.assume("crankcase_kPa", 100, "ambient");
  const double intake_kPa = to_three_digits(98 * n.design.pressure_ratio);
  draft.assume("intake_kPa", intake_kPa, breathes + ", full load");
  draft.assume("exhaust_kPa", n.is_boosted() ? intake_kPa : 105,
               n.is_boosted() ? "before the turbine: that of the intake" : "a free exhaust");
  draft.assume("start_of_combustion_deg", usual.start_deg, "usual for this kind");
  draft.assume("combustion_duration_deg", usual.duration_deg, "usual for this kind");
  draft.assume("wiebe_m", usual.wiebe_m, "usual for this kind");
  draft.assume("compression_exponent", usual.compression_exponent, "usual for this kind");
  draft.assume("expansion_exponent", usual.expansion_exponent, "usual for this kind");
  draft.assume("exhaust_valve_opens_deg", usual.exhaust_opens_deg, "usual for this kind");
  n.net_mep_kPa = draft.number("net_mep_kPa", "--net-mep-kPa", usual_net_mep_kPa(n.design, n.piston_speed_m_s()),
                               breathes + ", full load, " + (n.design.four_valves ? "four" : "two") +
                                   " valves; pumping is subtracted, friction is not");
}

/// [pressure] and [gas] of an engine whose pressure follows from its gas exchange, in place of add_pressure's.
void add_gas_exchange(Draft& draft, const Numbers& n) {
  const Combustion& burn = usual_combustion(n.design);
  const GasExchange& usual = *n.gas;
  const bool spark = n.design.type == EngineType::spark_ignition;
  const auto rounded = [&](const char* key, double value, const std::string& why) {
    draft.assume(key, to_three_digits(value), why);
  };
  draft.section("pressure");
  draft.line("source", "gas", "given");
  draft.assume("crankcase_kPa", 100, "ambient");
  draft.section("gas");
  const std::string volumes =
      shortest(kManifoldVolumes) + " times the displacement" + (spark ? ", five volumes of a runner or more" : "");
  rounded("intake_volume_cm3", usual.intake_volume_cm3, volumes);
  rounded("exhaust_volume_cm3", usual.exhaust_volume_cm3, volumes);
  if (spark) {
    rounded("intake_runner_mm", usual.intake_runner_mm, "tuned to 0.8 of the rated speed");
    rounded("intake_runner_diameter_mm", usual.intake_runner_diameter_mm, "0.44 bores");
    rounded("exhaust_runner_mm", usual.exhaust_runner_mm, "1.4 times the intake runner");
    rounded("exhaust_runner_diameter_mm", usual.exhaust_runner_diameter_mm, "0.4 bores");
  }
  rounded("throttle_mm2", usual.throttle_mm2,
          spark ? "effective area: " + shortest(kThrottleSpeed_m_s) + " m/s at rated speed"
                : "effective area of air filter and duct: " + shortest(kDuctSpeed_m_s) + " m/s at rated speed");
  rounded("throttle_closed_mm2", usual.throttle_closed_mm2, spark ? "leakage, for idling" : "a diesel has no throttle");
  rounded("outlet_mm2", usual.outlet_mm2,
          "the exhaust system as one orifice: " + shortest(kOutletPerInlet) + " of throttle_mm2");
  rounded("ambient_kPa", 100 * n.design.pressure_ratio, n.is_boosted() ? "behind the compressor" : "sea level");
  if (n.is_boosted()) rounded("back_kPa", 100 * n.design.pressure_ratio, "before the turbine: that of the intake");
  draft.assume("ambient_C", n.is_boosted() ? 50 : 25,
               n.is_boosted() ? "behind the charge cooler" : "of the air it draws in");
  draft.assume("wall_C", usual.wall_C, "mean of head, piston and liner, at full load");
  draft.assume("crevice_share", kCreviceShare, "top land, ring pack, gasket and plug by the clearance volume");
  rounded("blow_by_mm2", usual.blow_by_mm2, "sound piston rings");
  if (spark) {
    draft.assume("excess_air_ratio", 1, "fuel by the air in each cylinder");
    draft.assume("burn_start_deg", burn.start_deg, "usual for this kind");
    draft.assume("burn_duration_deg", burn.duration_deg, "usual for this kind");
    draft.assume("wiebe_m", burn.wiebe_m, "usual for this kind");
    return;
  }
  constexpr double kHeatingValue_MJ_kg = 42.5;
  const double work_J = n.net_mep_kPa * n.displacement_L / n.cylinders;
  rounded("fuel_mg", work_J / (kDieselEfficiency * kHeatingValue_MJ_kg),
          "full load, a net mean effective pressure of " + brief(to_three_digits(n.net_mep_kPa)) +
              " kPa at an efficiency of " + shortest(kDieselEfficiency));
  draft.assume("heating_value_MJ_per_kg", kHeatingValue_MJ_kg, "diesel fuel");
  draft.assume("air_fuel_ratio", 14.5, "diesel fuel");
  draft.assume("burn_start_deg", burn.start_deg, "usual for this kind");
  draft.assume("burn_duration_deg", 20, "of what has mixed by then; the rest burns as it mixes");
  draft.assume("wiebe_m", 1, "usual for this kind");
  draft.assume("second_share", 0.7, "usual for this kind");
  draft.assume("second_m", 0.9, "usual for this kind");
  draft.assume("second_duration_ratio", 3.5, "usual for this kind");
}

/// `diagram` follows from the sections written so far.
void add_what_turns_it(Draft& draft, const IndicatorDiagram& diagram, Numbers& n) {
  const double krpm = n.rated_rpm / 1000;
  Friction friction = usual_friction(diagram.peak_Pa() / 1e3, n.stroke_mm);
  friction = {to_three_digits(friction.constant_kPa), to_three_digits(friction.linear_kPa_per_1000rpm),
              to_three_digits(friction.quadratic_kPa_per_1000rpm2)};
  n.brake_Nm = std::max(n.net_mep_kPa - friction.at_kPa(krpm), 0.0) * n.displacement_L / (4 * kPi);
  draft.section("friction");
  draft.assume("constant_kPa", friction.constant_kPa,
               "Chen and Flynn (SAE 650733), without pumping; " + brief(to_three_digits(diagram.peak_Pa() / 1e5)) +
                   " bar peak pressure");
  draft.assume("linear_kPa_per_1000rpm", friction.linear_kPa_per_1000rpm,
               "the same, proportional to mean piston speed");
  draft.assume("quadratic_kPa_per_1000rpm2", friction.quadratic_kPa_per_1000rpm2,
               "the same, proportional to its square");
  draft.section("machine");
  draft.assume("quadratic_Nm_per_1000rpm2", to_three_digits(n.brake_Nm / (krpm * krpm)),
               std::string("a brake that takes ") + (n.gas ? "what is usual" : "full load") + " at rated speed, " +
                   brief(to_three_digits(n.brake_Nm)) + " Nm, " +
                   brief(to_three_digits(n.brake_Nm * n.rated_rpm * kRad_sPerRpm / 1e3)) + " kW" +
                   (n.gas ? "; `run` prints what [gas] gives" : ""));
  draft.section("starter");
  draft.assume("stall_Nm", to_three_digits(kStarterNmPerLitre * n.displacement_L / std::sqrt(n.cylinders)),
               "by displacement");
  draft.assume("no_load_rpm", 400, "usual");
}

/// A direct train: a bucket between cam and valve. The spring keeps it in contact up to about 1.3 times the rated
/// speed, from the inertia force at the nose.
void add_train(Draft& draft, const char* name, double full_lift_deg, const Numbers& n) {
  const double lift_mm = to_three_digits(usual_lift_mm(n.design, n.bore_mm));
  const double valve_g = to_three_digits(usual_valve_g(n.design, n.bore_mm));
  const double spring_g = to_three_digits(0.6 * valve_g);
  const double moving_kg = (valve_g + spring_g / 3) / 1e3;
  const double cam_rad_s = n.rated_rpm * kRad_sPerRpm / 2;
  const double half_angle_rad = kCamHalfAngleDeg * kRadPerDeg;
  const double nose_N = moving_kg * cam_nose_factor() * lift_mm / 1e3 * std::pow(cam_rad_s / half_angle_rad, 2);
  const double train_N_per_mm = to_three_digits(moving_kg * std::pow(kTrainOrders * cam_rad_s, 2) / 1e3);
  std::string exponents;
  for (const double exponent : kCamExponents) exponents += (exponents.empty() ? "" : ",") + shortest(exponent);
  draft.section((std::string("cam ") + name).c_str());
  draft.line("source", "polynomial", "assumed");
  draft.assume("max_lift_mm", lift_mm, shortest(usual_lift_mm(n.design, 1)) + " bores");
  draft.assume("half_angle_deg", kCamHalfAngleDeg, "with its ramps");
  draft.line("exponents", exponents, "assumed: the lobe ends with the angle's sixth power, as a ramp does");
  draft.assume("full_lift_at_crank_deg", full_lift_deg, "360 is the top dead centre of gas exchange");
  draft.section((std::string("rocker ") + name).c_str());
  draft.assume("ratio", 1, "a bucket tappet");
  draft.assume("base_circle_mm", to_three_digits(0.22 * n.bore_mm), "0.22 bores");
  draft.assume(
      "clearance_mm",
      to_three_digits(clearance_for_speed_mm(lift_mm, cam_rad_s, kCamEndsWith_m_s, kMostClearancePerLift * lift_mm)),
      "small: the cam ends with " + shortest(kCamEndsWith_m_s) + " m/s at rated speed, or slower");
  draft.section((std::string("valve ") + name).c_str());
  if (n.gas) {
    const bool intake = std::string_view(name) == "intake";
    const double seat_mm = to_three_digits(intake ? n.gas->intake_seat_mm : n.gas->exhaust_seat_mm);
    draft.line("port", name, "given");
    draft.assume("seat_diameter_mm", seat_mm, shortest(to_three_digits(seat_mm / n.bore_mm)) + " bores");
  }
  draft.assume("per_cylinder", n.design.four_valves ? 2 : 1,
               n.design.four_valves ? "two of each kind" : "one of each kind");
  draft.assume("valve_g", valve_g, "with bucket; proportional to bore cubed");
  draft.assume("spring_g", spring_g, "0.6 of that");
  draft.assume("rocker_inertia_kg_mm2", 0, "no rocker");
  draft.assume("spring_N_per_mm", to_three_digits((1 - kPreloadShare) * kSpringMargin * nose_N / lift_mm),
               shortest(kSpringMargin) + " times the force needed at rated speed and full lift");
  draft.assume("spring_preload_N", to_three_digits(kPreloadShare * kSpringMargin * nose_N), "of the same spring");
  draft.assume("train_N_per_mm", train_N_per_mm,
               "natural frequency " + shortest(kTrainOrders) + " times the cam's at rated speed");
  draft.assume("train_damping_ratio", 0.08, "usual");
  draft.assume("guide_damping_ratio", 0.003, "usual");
  draft.assume("seat_N_per_mm", to_three_digits(8 * train_N_per_mm), "8 times the train");
  draft.assume("seat_damping_ratio", 0.1, "usual");
}

void add_triggers(Draft& draft) {
  draft.section("trigger crank");
  draft.line("on", "crank", "assumed");
  draft.line("pattern", "60-2", "assumed; `crankloop help patterns` lists wheels in use");
  draft.assume("first_tooth_deg", 246, "the gap ends 114 deg before top dead centre");
  draft.section("trigger cam");
  draft.line("on", "cam intake", "assumed");
  draft.line("pattern", "half-moon", "assumed");
  draft.assume("first_tooth_deg", -180, "high through cylinder 1's compression and expansion");
}

constexpr const char* kCommand = "crankloop new";

/// Removes line numbers, because the user does not have the file: "crankloop new: firing_order: cylinder 2 does not
/// fire".
InputError without_lines(const InputError& error) {
  const std::string name = kCommand;
  std::string told = error.what();
  for (std::size_t at = 0; (at = told.find(name + ":", at)) != std::string::npos; ++at) {
    const std::size_t from = at + name.size();
    told.erase(from, told.find_first_not_of("0123456789", from + 1) - from);
  }
  return InputError(told);
}

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

int run_new(const Arguments& arguments) {
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
  const EngineFile half_way = read_draft(crank.text() + body.text() + diagram.text());
  Draft rest(arguments);
  add_what_turns_it(rest, *diagram_of(half_way), n);
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
  if (engine.name() != arguments.text("--name"))
    throw UsageError("--name: a blank followed by # starts a comment in an engine file");
  tell_warnings(arguments, warnings_about(engine));
  print(text);
  return kSuccess;
}

constexpr Option kOptions[] = {
    required(whole_number("--cylinders", "N", from(1).up_to(kMaxCylinders), "number of cylinders")),
    required(number("--bore-mm", "D", above(0).up_to(2000), "bore in mm")),
    required(number("--stroke-mm", "S", above(0).up_to(4000), "stroke in mm")),
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
                   kOptions,
                   run_new};

}  // namespace crankloop::program

// `crankloop new`: a complete engine file from a few numbers.
//
// What belongs here: what to assume where nothing is known, and why. What does not: what an engine file may say
// (engine_file/).
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include <crankloop/tabulate/first_design.hpp>

#include "commands.hpp"
#include "engine_file/plausibility.hpp"
#include "error.hpp"
#include "output_file.hpp"
#include "units.hpp"

namespace crankloop::program {
namespace {

/// What is usual for a kind of engine. Mean piston speeds: Heywood, Internal Combustion Engine Fundamentals (1988),
/// section 2.2.
struct Usual {
  EngineKind kind;
  double piston_m_s;
  double compression_ratio;
  double combustion_from_deg;
  double combustion_deg;
  double wiebe_m;
  double compression_exponent;
  double expansion_exponent;
  double exhaust_opens_deg;
  double net_mep_kPa;
  double friction_kPa[3];  ///< constant, per 1000 rpm, per its square
  const char* friction_source;
};

constexpr const char* kHeywood = "Heywood (1988), four-cylinder engines of 0.8 to 2 L, motored";
constexpr const char* kAs495 = "as for the sample diesel_495.ini";
constexpr Usual kSparkIgnition{
    EngineKind::spark_ignition, 15, 10, -18, 55, 2, 1.32, 1.27, 130, 1000, {97, 15, 5}, kHeywood};
constexpr Usual kDiesel{EngineKind::diesel, 11, 18, -6, 60, 0.9, 1.35, 1.28, 135, 850, {90, 26, 5}, kAs495};
constexpr Usual kTractor{EngineKind::tractor_diesel, 9, 18, -6, 60, 0.9, 1.35, 1.28, 135, 850, {90, 26, 5}, kAs495};

constexpr double kRodRatio = 0.28;
constexpr double kCyclesOfWorkInFlywheel =
    5;  ///< kinetic energy at rated speed by work of a cycle; the samples have 4 and 7
constexpr double kStarterNmPerLitre =
    280;  ///< of one cylinder; more of them share the work of compression: by the root of their number
constexpr double kLiftPerBore = 0.115;
constexpr double kClearancePerLift = 0.008;
constexpr double kHalfAngleDeg = 78;
constexpr double kNoseFactor =
    4.375;  ///< y'' at full lift by lift and half angle squared, of the exponents 2, 6, 10, 14
constexpr double kSpringMargin = 1.5;  ///< spring force at full lift by what the nose takes from it at rated speed
constexpr double kPreloadShare = 0.4;  ///< of that force on the closed valve
constexpr double kTrainOrders = 36;    ///< natural frequency of the train by the cam's; the samples have 35 and 38
constexpr double kValveKgAt95Mm = 0.15;

double to_three_digits(double value) {
  if (value == 0) return 0;
  const double digit = std::pow(10, std::floor(std::log10(std::abs(value))) - 2);
  return parse_number(brief(std::round(value / digit) * digit)).value;
}

const char* usual_firing_order(int cylinders) {
  constexpr const char* kOrders[] = {"1", "1-2", "1-3-2", "1-3-4-2", "1-2-4-5-3", "1-5-3-6-2-4", "", "1-6-2-5-8-3-7-4"};
  return cylinders <= 8 ? kOrders[cylinders - 1] : "";
}

double mean(const Interval& usual) { return (usual.least + usual.most) / 2; }

/// The file as it grows: each line says where its value comes from.
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

  /// The option's value where it is given; else what is assumed, to three digits.
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

/// What sections need of one another.
struct Numbers {
  int cylinders = 0;
  double bore_mm = 0;
  double rated_rpm = 0;
  double displacement_L = 0;  ///< of all cylinders
  double net_mep_kPa = 0;
  double brake_Nm = 0;
};

void add_crank(Draft& draft, const Arguments& arguments, const Usual& usual, Numbers& n) {
  const double stroke_mm = arguments.number("--stroke-mm");
  draft.section("engine");
  draft.line("name", arguments.text("--name"), arguments.has("--name") ? "given" : "assumed");
  n.rated_rpm = draft.number("rated_rpm", "--rated-rpm", std::round(usual.piston_m_s * 300 / stroke_mm) * 100,
                             "a mean piston speed of " + shortest(usual.piston_m_s) + " m/s");
  draft.section("crank");
  n.bore_mm = draft.number("bore_mm", "--bore-mm", 0, "");
  draft.number("stroke_mm", "--stroke-mm", 0, "");
  draft.number("rod_length_mm", "--rod-length-mm", std::round(stroke_mm / 2 / kRodRatio),
               "a rod ratio of " + shortest(kRodRatio));
  draft.assume("pin_offset_mm", 0, "none");
  draft.number("compression_ratio", "--compression-ratio", usual.compression_ratio, "usual for this kind");
  n.cylinders = arguments.whole_number("--cylinders");
  n.displacement_L = kPi / 4 * n.bore_mm * n.bore_mm * stroke_mm * n.cylinders / 1e6;
}

void add_masses_and_layout(Draft& draft, const Arguments& arguments, const Usual& usual, const Numbers& n) {
  const FirstDesign design = first_design(usual.kind, n.bore_mm / 1e3, n.rated_rpm);
  const double rod_g = mean(design.rod_kg) * 1e3;
  const double share = mean(design.pin_share_inline);
  const double cycle_J = n.net_mep_kPa * n.displacement_L;
  const double rated_rad_s = n.rated_rpm * kRad_sPerRpm;
  draft.section("masses");
  draft.number("piston_g", "--piston-g", mean(design.piston_kg) * 1e3, "middle of what `crankloop masses` tells");
  draft.assume("rod_small_end_g", to_three_digits(rod_g * share), "rod and its split by `crankloop masses`");
  draft.assume("rod_big_end_g", to_three_digits(rod_g * (1 - share)), "rod and its split by `crankloop masses`");
  draft.assume("crank_pin_equivalent_g", 0, "balanced by the webs; adds to the centrifugal force only");
  draft.number(
      "crank_inertia_kg_m2", "--crank-inertia-kg-m2",
      2 * kCyclesOfWorkInFlywheel * cycle_J / (rated_rad_s * rated_rad_s),
      "at rated speed the energy of " + shortest(kCyclesOfWorkInFlywheel) + " cycles' work; flywheel included");
  draft.section("layout");
  draft.line("cylinders", std::to_string(n.cylinders), "given");
  const bool banked = arguments.has("--bank-angles-deg");
  const bool ordered = arguments.has("--firing-order");
  const std::string usual_order = banked ? "" : usual_firing_order(n.cylinders);
  if (!ordered && usual_order.empty())
    throw UsageError("--firing-order is missing: there is no usual one for these cylinders");
  draft.line("firing_order", ordered ? arguments.text("--firing-order") : usual_order,
             ordered ? "given" : "assumed: the usual one");
  if (banked) draft.line("bank_angles_deg", arguments.text("--bank-angles-deg"), "given");
  if (!banked)
    draft.assume("cylinder_spacing_mm", to_three_digits(1.2 * n.bore_mm), "1.2 bores; matters for free moments only");
}

void add_pressure(Draft& draft, const Usual& usual, Numbers& n) {
  draft.section("pressure");
  draft.line("source", "wiebe", "assumed: synthesised until there is a measured diagram (angle_table)");
  draft.assume("crankcase_kPa", 100, "ambient");
  draft.assume("intake_kPa", 98, "naturally aspirated, full load");
  draft.assume("exhaust_kPa", 105, "a free exhaust");
  draft.assume("start_of_combustion_deg", usual.combustion_from_deg, "usual for this kind");
  draft.assume("combustion_duration_deg", usual.combustion_deg, "usual for this kind");
  draft.assume("wiebe_m", usual.wiebe_m, "usual for this kind");
  draft.assume("compression_exponent", usual.compression_exponent, "usual for this kind");
  draft.assume("expansion_exponent", usual.expansion_exponent, "usual for this kind");
  draft.assume("exhaust_valve_opens_deg", usual.exhaust_opens_deg, "usual for this kind");
  n.net_mep_kPa = draft.number("net_mep_kPa", "--net-mep-kPa", usual.net_mep_kPa, "naturally aspirated, full load");
}

void add_what_turns_it(Draft& draft, const Usual& usual, Numbers& n) {
  const double krpm = n.rated_rpm / 1000;
  const double friction_kPa = usual.friction_kPa[0] + krpm * (usual.friction_kPa[1] + krpm * usual.friction_kPa[2]);
  n.brake_Nm = std::max(n.net_mep_kPa - friction_kPa, 0.0) * n.displacement_L / (4 * kPi);
  draft.section("friction");
  draft.assume("constant_kPa", usual.friction_kPa[0], usual.friction_source);
  draft.assume("linear_kPa_per_1000rpm", usual.friction_kPa[1], usual.friction_source);
  draft.assume("quadratic_kPa_per_1000rpm2", usual.friction_kPa[2], usual.friction_source);
  draft.section("machine");
  draft.assume("quadratic_Nm_per_1000rpm2", to_three_digits(n.brake_Nm / (krpm * krpm)),
               "a brake that takes full load at rated speed, " + brief(to_three_digits(n.brake_Nm)) + " Nm");
  draft.section("starter");
  draft.assume("stall_Nm", to_three_digits(kStarterNmPerLitre * n.displacement_L / std::sqrt(n.cylinders)),
               "by displacement");
  draft.assume("no_load_rpm", 400, "usual");
}

/// A direct train: a bucket between cam and valve. The spring holds it to the cam up to 1.2 times the rated speed, by
/// Newton's law at the nose.
void add_train(Draft& draft, const char* name, double full_lift_deg, const Numbers& n) {
  const double lift_mm = to_three_digits(kLiftPerBore * n.bore_mm);
  const double valve_g = to_three_digits(kValveKgAt95Mm * 1e3 * std::pow(n.bore_mm / 95, 3));
  const double spring_g = to_three_digits(0.6 * valve_g);
  const double moving_kg = (valve_g + spring_g / 3) / 1e3;
  const double cam_rad_s = n.rated_rpm * kRad_sPerRpm / 2;
  const double half_angle_rad = kHalfAngleDeg * kRadPerDeg;
  const double nose_N = moving_kg * kNoseFactor * lift_mm / 1e3 * std::pow(cam_rad_s / half_angle_rad, 2);
  const double train_N_per_mm = to_three_digits(moving_kg * std::pow(kTrainOrders * cam_rad_s, 2) / 1e3);
  draft.section((std::string("cam ") + name).c_str());
  draft.line("source", "polynomial", "assumed");
  draft.assume("max_lift_mm", lift_mm, shortest(kLiftPerBore) + " bores");
  draft.assume("half_angle_deg", kHalfAngleDeg, "with its ramps");
  draft.line("exponents", "2,6,10,14", "assumed");
  draft.assume("full_lift_at_crank_deg", full_lift_deg, "360 is the top dead centre of gas exchange");
  draft.section((std::string("rocker ") + name).c_str());
  draft.assume("ratio", 1, "a bucket tappet");
  draft.assume("base_circle_mm", to_three_digits(0.22 * n.bore_mm), "0.22 bores");
  draft.assume("clearance_mm", to_three_digits(kClearancePerLift * lift_mm),
               "small, so that the cam takes the valve up gently");
  draft.section((std::string("valve ") + name).c_str());
  draft.assume("per_cylinder", 1, "one of each kind");
  draft.assume("valve_g", valve_g, "with bucket; by the bore's cube");
  draft.assume("spring_g", spring_g, "0.6 of that");
  draft.assume("rocker_inertia_kg_mm2", 0, "no rocker");
  draft.assume("spring_N_per_mm", to_three_digits((1 - kPreloadShare) * kSpringMargin * nose_N / lift_mm),
               "holds at full lift " + shortest(kSpringMargin) + " times what rated speed asks for");
  draft.assume("spring_preload_N", to_three_digits(kPreloadShare * kSpringMargin * nose_N), "of the same spring");
  draft.assume("train_N_per_mm", train_N_per_mm,
               "swings at " + shortest(kTrainOrders) + " times the cam's rated frequency");
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

/// Errors without the lines of a file that nobody has seen: "crankloop new: firing_order: cylinder 2 does not fire".
EngineFile read_draft(const std::string& text) {
  const std::string name = "crankloop new";
  try {
    return read_engine_text(text, name, {});
  } catch (const InputError& error) {
    std::string told = error.what();
    for (std::size_t at = 0; (at = told.find(name + ":", at)) != std::string::npos; ++at) {
      const std::size_t from = at + name.size();
      told.erase(from, told.find_first_not_of("0123456789", from + 1) - from);
    }
    throw InputError(told);
  }
}

int run_new(const Arguments& arguments) {
  const std::string& type = arguments.text("--type");
  const Usual& usual = type == "si" ? kSparkIgnition : type == "diesel" ? kDiesel : kTractor;
  Numbers n;
  Draft crank(arguments);
  add_crank(crank, arguments, usual, n);
  Draft gas(arguments);
  add_pressure(gas, usual, n);
  Draft body(arguments);
  add_masses_and_layout(body, arguments, usual, n);
  Draft rest(arguments);
  add_what_turns_it(rest, usual, n);
  add_train(rest, "intake", 468, n);
  add_train(rest, "exhaust", 262, n);
  add_triggers(rest);
  const std::string text =
      "# An engine file from a few numbers, by `crankloop new`. What stood on its command line is \"given\"; all else "
      "is\n"
      "# \"assumed\" and says why: replace it by what you know. Angles are crank degrees, 0 at cylinder 1's firing "
      "TDC.\n" +
      crank.text() + body.text() + gas.text() + rest.text();
  const EngineFile engine = read_draft(text);
  if (engine.name() != arguments.text("--name"))
    throw UsageError("--name: a blank and # begin a comment in an engine file");
  tell_warnings(arguments, warnings_about(engine));
  print(text);
  return kSuccess;
}

constexpr Option kOptions[] = {
    required(whole_number("--cylinders", "N", from(1).up_to(kMaxCylinders), "number of cylinders")),
    required(number("--bore-mm", "D", above(0).up_to(2000), "bore in mm")),
    required(number("--stroke-mm", "S", above(0).up_to(4000), "stroke in mm")),
    choice("--type", "si|diesel|tractor", "spark ignition, car and truck diesel, or tractor diesel", "si"),
    text("--name", "TEXT", "what reports call it", "new engine"),
    number("--rated-rpm", "N", above(0).up_to(100000), "rated speed in rpm"),
    number("--compression-ratio", "E", above(1).up_to(100), "geometric"),
    number("--rod-length-mm", "L", above(0).up_to(10000), "pin to pin, in mm"),
    text("--firing-order", "1-3-2", "needed for 7, 9 and more cylinders and with banks"),
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

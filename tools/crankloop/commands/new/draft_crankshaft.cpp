// Crank, masses, layout, and what turns the crank.
#include "draft.hpp"

#include <algorithm>
#include <cmath>

#include "../../engine_file/crankshaft_words.hpp"
#include "../../files/error.hpp"
#include "../../files/units.hpp"
#include "../../files/words.hpp"

namespace crankloop::program {
namespace {

constexpr double kRodRatio = 0.28;
constexpr double kStarterNmPerLitre =
    280;  ///< for one cylinder; divided by the root of the number of cylinders, which share the compression work

const char* usual_firing_order(int cylinders) {
  constexpr const char* kOrders[] = {"1", "1-2", "1-3-2", "1-3-4-2", "1-2-4-5-3", "1-5-3-6-2-4", "", "1-6-2-5-8-3-7-4"};
  return cylinders <= 8 ? kOrders[cylinders - 1] : "";
}

}  // namespace

void add_crank(Draft& draft, const Arguments& arguments, Numbers& n) {
  const double piston_m_s = usual_piston_speed_m_s(n.design);
  n.stroke_mm = arguments.number("--stroke-mm");
  draft.section("engine");
  draft.line("name", arguments.text("--name"), arguments.has("--name") ? "given" : "assumed");
  n.rated_rpm = draft.number("rated_rpm", "--rated-rpm", usual_rated_rpm(n.design, n.stroke_mm),
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
}

void add_places(Draft& draft, const Layout& layout, const Numbers& n) {
  const std::vector<std::string> pairs = pairs_for_one_pin(layout);
  if (!pairs.empty() && 2 * static_cast<int>(pairs.size()) == layout.cylinders)
    draft.line("shared_pins", join(pairs, ","), "assumed: neighbours of two banks whose throws agree");
  if (are_opposed(layout)) {
    draft.assume("cylinder_spacing_mm", to_three_digits(0.6 * n.bore_mm),
                 "0.6 bores from pin to pin, 1.2 in a bank; matters for free moments only");
  } else {
    draft.assume("cylinder_spacing_mm", to_three_digits(1.2 * n.bore_mm),
                 pairs.empty() ? "1.2 bores; matters for free moments only"
                               : "1.2 bores from pin to pin; matters for free moments only");
  }
}

void add_what_turns_it(Draft& draft, const IndicatorDiagram& diagram, Numbers& n) {
  const double krpm = n.rated_rpm / 1000;
  Friction friction = usual_friction(diagram.peak_Pa() / 1e3, n.stroke_mm);
  friction = {to_three_digits(friction.constant_kPa), to_three_digits(friction.linear_kPa_per_1000rpm),
              to_three_digits(friction.quadratic_kPa_per_1000rpm2)};
  n.brake_Nm = std::max(n.net_mep_kPa - friction.at_kPa(krpm), 0.0) * n.displacement_L / kCycle_rad;
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
  const bool is_boosted_at_rest = n.gas && n.is_boosted();
  const double compressed = is_boosted_at_rest ? n.design.pressure_ratio : 1;
  draft.assume("stall_Nm", to_three_digits(kStarterNmPerLitre * compressed * n.displacement_L / std::sqrt(n.cylinders)),
               is_boosted_at_rest ? "by displacement and ambient_kPa, which it compresses" : "by displacement");
  draft.assume("no_load_rpm", 400, "usual");
}

}  // namespace crankloop::program

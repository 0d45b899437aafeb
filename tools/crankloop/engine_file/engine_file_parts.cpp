#include "engine_file_parts.hpp"

#include <cmath>

#include "../files/error.hpp"

namespace crankloop::program {

std::string rod_length_too_short(const SectionValues& crank) {
  return "rod_length_mm: " + shortest(crank.number("rod_length_mm")) +
         " is too short; it must be longer than stroke_mm / 2 + |pin_offset_mm| = " +
         brief(crank.number("stroke_mm") / 2 + std::abs(crank.number("pin_offset_mm"))) +
         " mm, by more than a billionth, or the crank cannot turn";
}

namespace {

/// Tolerance between two values of the rod ratio from a source that rounds both; a larger difference is an error.
constexpr double kMaxRodDisagreement = 1e-3;

void require_that_rod_and_ratio_agree(const SectionValues& values, const Crank& drawn, const std::string& path) {
  const double given = values.si("rod_ratio");
  if (std::abs(given / drawn.rod_ratio() - 1) <= kMaxRodDisagreement) return;
  refuse(values, "rod_ratio",
         shortest(given) + " contradicts rod_length_mm = " + shortest(values.number("rod_length_mm")) + " (line " +
             std::to_string(values.line_of("rod_length_mm")) + "), with which stroke_mm / 2 / rod_length_mm = " +
             brief(drawn.rod_ratio()) + "; they may differ by 0.1 %, or leave rod_ratio out",
         path);
}

}  // namespace

Crank build_crank(const SectionValues& values, const std::string& path) {
  Crank crank;
  fill(values, crank);
  crank.crank_radius_m = values.si("stroke_mm") / 2;
  if (crank.rod_length_m <= crank.least_rod_length_m()) {
    throw InputError(path, values.line_of("rod_length_mm"), rod_length_too_short(values));
  }
  if (values.has("rod_ratio")) {
    require_that_rod_and_ratio_agree(values, crank, path);
    // All code then uses this rod length, so that motion, masses and energies are consistent.
    crank.rod_length_m = crank.crank_radius_m / values.si("rod_ratio");
  }
  return crank;
}

Masses build_masses(const SectionValues& values, const Crank& crank, const std::string& path) {
  Masses masses;
  fill(values, masses);
  if (values.has("crank_pin_g")) {
    reduce_throw({values.si("crank_pin_g"), values.si("crank_web_g"), values.si("crank_web_radius_mm")}, crank, masses);
  }
  if (values.has("rod_g")) {
    RigidRod rod;
    rod.mass_kg = values.si("rod_g");
    rod.com_to_crank_m = values.si("rod_com_to_crank_mm");
    if (rod.com_to_crank_m > crank.rod_length_m) {
      throw InputError(path, values.line_of("rod_com_to_crank_mm"),
                       "rod_com_to_crank_mm: " + shortest(values.number("rod_com_to_crank_mm")) +
                           " is out of range; the centre of mass lies between the pins, at most " +
                           brief(crank.rod_length_m * 1e3) + " mm from the crank pin");
    }
    if (values.has("rod_inertia_kg_mm2")) rod.inertia_kg_m2 = values.si("rod_inertia_kg_mm2");
    lump_rod(rod, crank, masses);
    if (!values.has("rod_inertia_kg_mm2"))
      masses.rod_inertia_correction_kg_m2 = 0;  // inertia not given: two-mass rod, not a point mass
  }
  if (!(masses.reciprocating_kg() > 0)) {
    throw InputError(path, values.line_of("piston_g"),
                     "piston_g: piston and the rod's small end weigh nothing; at least one must be above 0");
  }
  return masses;
}

Pressure build_pressure(const SectionValues& values) {
  Pressure pressure;
  fill(values, pressure);
  const std::string& source = values.text("source");
  if (source == "angle_table") pressure.source = PressureSource::angle_table;
  if (source == "volume_table") pressure.source = PressureSource::volume_table;
  if (source == "gas") pressure.source = PressureSource::gas;
  if (source == "wiebe") pressure.source = PressureSource::wiebe;
  pressure.wiebe.heat_given = values.has("heat_J");
  return pressure;
}

}  // namespace crankloop::program

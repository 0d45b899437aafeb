// Of the crank mechanism, the pistons and the pressure above them.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crankloop/tabulate/first_design.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>

#include "../files/units.hpp"
#include "../files/words.hpp"
#include "measured_rows.hpp"
#include "plausibility.hpp"
#include "plausibility_parts.hpp"

namespace crankloop::program {
namespace {

constexpr Interval kBoreMm{10, 1200};
constexpr Interval kBorePerStroke{0.3, 2};
constexpr Interval kRodRatio{0.15, 0.45};
constexpr double kMassFactor = 10;  ///< permitted factor between a mass and the table of first designs, both ways

/// Heywood, Internal Combustion Engine Fundamentals (1988), section 9.2: 1.3 +- 0.05 with spark ignition; diesels
/// reach 1.4. An angle error of 5 deg changes it by 0.11.
constexpr Interval kCompressionExponent{1.25, 1.45};
constexpr double kCompressionFromDeg = -90;
constexpr double kCompressionToDeg = -30;

/// Absolute, around the bottom dead centre at which the compression begins: from a closed throttle to a ship engine's
/// boost. A trace in bar, MPa or psi is below, most in hPa are above.
constexpr Interval kBottomKPa{15, 700};
constexpr double kBottomDeg = -180;

/// Losses of heat and gas shift the motored peak to half a degree or one before dead centre; more is an error of the
/// angles, of which 1 deg is 42 kPa of mean effective pressure in the engine of docs/gas_exchange.md.
constexpr double kMaxPeakLeadDeg = 2;
constexpr double kPeakStepsPerDeg = 10;
constexpr int kPeakSteps = 400;

/// A trace over the crank angle, of a cycle: what is between its last row and the first of the next one counts too.
void look_at_trace(const Pressure& pressure, int line, Warnings& warnings) {
  constexpr double kLeastDeg = 15;
  constexpr double kCycleDeg = 720;
  constexpr double kSamePressure = 0.02;
  if (pressure.source != PressureSource::angle_table) return;
  std::vector<double> angles_deg;
  for (int i = 0; i < pressure.point_count; ++i) angles_deg.push_back(pressure.points[i].at);
  const DiagramPoint &first = pressure.points[0], &last = pressure.points[pressure.point_count - 1];
  if (last.at - first.at < kCycleDeg - 1e-9) {
    angles_deg.push_back(first.at + kCycleDeg);
  } else if (std::abs(last.pressure_Pa - first.pressure_Pa) > kSamePressure * first.pressure_Pa) {
    warnings.add(line, "the row at " + brief(last.at) + " deg, " + brief(last.pressure_Pa / 1e3) +
                           " kPa, is the same place as that at " + brief(first.at) + " deg, " +
                           brief(first.pressure_Pa / 1e3) + " kPa, and is left out");
  }
  if (const std::optional<Gap> gap = widest_gap(angles_deg, kLeastDeg))
    warnings.add(line, gap_in_words(*gap) + ": a smooth curve goes across, and work and torque are of that");
}

}  // namespace

std::string unusual_peak(double peak_Pa) {
  constexpr double kMost_kPa = 25000;  // of diesels with high boost
  if (peak_Pa / 1e3 <= kMost_kPa) return "";
  return "the largest pressure is " + about(peak_Pa / 1e3) + " kPa; usual at full load: up to " + brief(kMost_kPa) +
         " kPa: are compression ratio, boost and mean effective pressure those of one engine?";
}

bool lengths_look_like_metres(const SectionValues& crank) {
  return crank.number("bore_mm") < kBoreMm.most / 1e3 && crank.number("stroke_mm") < 4 &&
         crank.number("rod_length_mm") < 10;
}

EngineSize look_at_crank(const EngineFile& engine, Warnings& warnings) {
  const SectionValues& crank = engine.section("crank");
  const double bore_mm = crank.number("bore_mm");
  const double stroke_mm = crank.number("stroke_mm");
  EngineSize size;
  size.cylinders = engine.definition().layout.cylinders;
  if (lengths_look_like_metres(crank)) {
    warnings.add(crank.line_of("bore_mm"),
                 "all lengths look like metres: bore_mm = " + brief(bore_mm) + ", stroke_mm = " + brief(stroke_mm) +
                     ", rod_length_mm = " + brief(crank.number("rod_length_mm")) + "; the file takes mm");
    size.bore_mm = bore_mm * 1e3;
    size.stroke_mm = stroke_mm * 1e3;
    return size;
  }
  // Only one warning at a time, because the next size is compared with this one.
  if (!warnings.add_unless(kBoreMm, bore_mm, crank.line_of("bore_mm"), "bore_mm", " mm")) return size;
  size.bore_mm = bore_mm;
  if (!warnings.add_unless(kBorePerStroke, bore_mm / stroke_mm, crank.line_of("bore_mm"), "bore_mm / stroke_mm", ""))
    return size;
  size.stroke_mm = stroke_mm;
  if (warnings.add_unless(kRodRatio, engine.definition().crank.rod_ratio(), crank.line_of("rod_length_mm"),
                          "stroke_mm / 2 / rod_length_mm", ""))
    size.rod_mm = crank.number("rod_length_mm");
  return size;
}

/// A spacing between the cylinders of a boxer is less than a bore, but not within a bank.
void look_at_spacing(const EngineFile& engine, const EngineSize& size, Warnings& warnings) {
  if (!size.bore_mm || !engine.has("layout") || !engine.section("layout").has("cylinder_spacing_mm")) return;
  const Layout& layout = engine.definition().layout;
  const int line = engine.section("layout").line_of("cylinder_spacing_mm");
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    for (std::size_t other = 0; other < k; ++other) {
      const double apart_mm = 1e3 * std::abs(layout.position_m[k] - layout.position_m[other]);
      if (layout.bank_deg[k] != layout.bank_deg[other] || apart_mm >= *size.bore_mm) continue;
      warnings.add(line, "cylinder_spacing_mm: cylinders " + std::to_string(other + 1) + " and " +
                             std::to_string(k + 1) + " of one bank are " + brief(apart_mm) +
                             " mm apart, less than a bore");
      return;
    }
  }
}

/// Over all kinds of engines, because the file does not state the kind.
void look_at_piston(const EngineFile& engine, Warnings& warnings) {
  const double bore_m = engine.definition().crank.bore_m;
  Interval usual_kg = first_design(EngineKind::diesel, bore_m, engine.rated_rpm()).piston_kg;
  for (const EngineKind kind : {EngineKind::spark_ignition, EngineKind::tractor_diesel}) {
    const Interval piston_kg = first_design(kind, bore_m, engine.rated_rpm()).piston_kg;
    usual_kg = {std::min(usual_kg.least, piston_kg.least), std::max(usual_kg.most, piston_kg.most)};
  }
  const SectionValues& masses = engine.section("masses");
  warnings.add_unless({two_digits(usual_kg.least * 1e3 / kMassFactor), two_digits(usual_kg.most * 1e3 * kMassFactor)},
                      masses.number("piston_g"), masses.line_of("piston_g"), "piston_g", " g",
                      " for this bore; `crankloop masses` has a first guess");
}

void look_at_diagram(const EngineFile& engine, Warnings& warnings) {
  const EngineDefinition& d = engine.definition();
  const auto diagram = std::make_unique<IndicatorDiagram>();  // large
  if (d.pressure.source == PressureSource::none || d.pressure.source == PressureSource::gas ||
      !diagram->init(d.crank, d.pressure).ok())
    return;  // the run refuses it
  const SectionValues& pressure = engine.section("pressure");
  const bool is_table = pressure.has("file");
  const int line = pressure.line_of(is_table ? "file" : "compression_exponent");
  look_at_trace(d.pressure, line, warnings);
  const bool in_kPa = !is_table || warnings.add_unless(kBottomKPa, diagram->full_Pa(kBottomDeg) / 1e3, line,
                                                       "pressure where the compression begins", " kPa",
                                                       ": is it in kPa, and absolute?");
  if (in_kPa) warnings.add_if_any(line, unusual_peak(diagram->peak_Pa()));

  const auto motored_Pa = [&](double deg) { return diagram->motored_Pa(deg); };
  const auto volume_m3 = [&](double deg) {
    return clearance_volume_m3(d.crank) +
           bore_area_m2(d.crank) * exact_stroke(d.crank, deg / kDegPerRad).displacement_m;
  };
  const double exponent = std::log(motored_Pa(kCompressionToDeg) / motored_Pa(kCompressionFromDeg)) /
                          std::log(volume_m3(kCompressionFromDeg) / volume_m3(kCompressionToDeg));
  warnings.add_unless(kCompressionExponent, exponent, line, "polytropic exponent of the compression, -90 to -30 deg,",
                      "", is_table ? ": are its angles right, and its pressures absolute?" : "");

  const double dead_centre_deg = dead_centres(d.crank).tdc_rad * kDegPerRad;
  double peak_lead_deg = 0;
  for (int step = 0; step <= kPeakSteps; ++step) {
    const double lead_deg = step / kPeakStepsPerDeg;
    if (motored_Pa(dead_centre_deg - lead_deg) > motored_Pa(dead_centre_deg - peak_lead_deg)) peak_lead_deg = lead_deg;
  }
  if (peak_lead_deg <= kMaxPeakLeadDeg) return;
  warnings.add(line, "the motored pressure is largest " + brief(peak_lead_deg) +
                         " deg before top dead centre; usual: at most " + brief(kMaxPeakLeadDeg) +
                         " deg: are its angles right?");
}

}  // namespace crankloop::program

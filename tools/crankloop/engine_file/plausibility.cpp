#include "plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include <crankloop/tabulate/first_design.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>

#include "../units.hpp"

namespace crankloop::program {
namespace {

constexpr Interval kBoreMm{10, 1200};
constexpr Interval kBorePerStroke{0.3, 2};
constexpr Interval kRodRatio{0.15, 0.45};
constexpr double kMassFactor = 10;  ///< of the table of first designs, either way

/// Heywood, Internal Combustion Engine Fundamentals (1988), section 9.2: 1.3 +- 0.05 with spark ignition; diesels
/// reach 1.4. Angles 5 deg off move it by 0.11.
constexpr Interval kCompressionExponent{1.25, 1.45};
constexpr double kCompressionFromDeg = -90;
constexpr double kCompressionToDeg = -30;

/// Losses put the motored peak up to a degree or so before dead centre; more is an error of the angles.
constexpr double kMaxPeakLeadDeg = 3;
constexpr double kPeakSearchDeg = 40;
constexpr double kPeakStepDeg = 0.1;

class Warnings {
 public:
  explicit Warnings(const EngineFile& engine) : engine_{engine} {}

  /// Line 0: of the whole file.
  void add(int line, const std::string& text) {
    lines_.push_back(engine_.path() + (line > 0 ? ":" + std::to_string(line) : "") + ": warning: " + text);
  }

  void add_unless(Interval usual, double value, int line, const std::string& what, const char* unit,
                  const std::string& remark = "") {
    if (value >= usual.least && value <= usual.most) return;
    add(line, what + " = " + brief(value) + " is unusual; usual: " + brief(usual.least) + " to " + brief(usual.most) +
                  unit + remark);
  }

  [[nodiscard]] const std::vector<std::string>& lines() const noexcept { return lines_; }

 private:
  const EngineFile& engine_;
  std::vector<std::string> lines_;
};

void look_at_crank(const EngineFile& engine, Warnings& warnings) {
  const SectionValues& crank = engine.section("crank");
  warnings.add_unless(kBoreMm, crank.number("bore_mm"), crank.line_of("bore_mm"), "bore_mm", " mm");
  warnings.add_unless(kBorePerStroke, crank.number("bore_mm") / crank.number("stroke_mm"), crank.line_of("bore_mm"),
                      "bore_mm / stroke_mm", "");
  warnings.add_unless(kRodRatio, engine.definition().crank.rod_ratio(), crank.line_of("rod_length_mm"),
                      "stroke_mm / 2 / rod_length_mm", "");
}

/// Of any kind of engine: the file does not say which it is.
void look_at_piston(const EngineFile& engine, Warnings& warnings) {
  const double bore_m = engine.definition().crank.bore_m;
  Interval usual_kg = first_design(EngineKind::diesel, bore_m, engine.rated_rpm()).piston_kg;
  for (const EngineKind kind : {EngineKind::spark_ignition, EngineKind::tractor_diesel}) {
    const Interval piston_kg = first_design(kind, bore_m, engine.rated_rpm()).piston_kg;
    usual_kg = {std::min(usual_kg.least, piston_kg.least), std::max(usual_kg.most, piston_kg.most)};
  }
  const SectionValues& masses = engine.section("masses");
  warnings.add_unless({usual_kg.least * 1e3 / kMassFactor, usual_kg.most * 1e3 * kMassFactor},
                      masses.number("piston_g"), masses.line_of("piston_g"), "piston_g", " g",
                      " for this bore; `crankloop masses` has a first guess");
}

void look_at_diagram(const EngineFile& engine, Warnings& warnings) {
  const EngineDefinition& d = engine.definition();
  const auto diagram = std::make_unique<IndicatorDiagram>();  // large
  if (d.pressure.source == PressureSource::none || d.pressure.source == PressureSource::gas ||
      !diagram->init(d.crank, d.pressure).ok())
    return;  // refused by whoever runs it
  const SectionValues& pressure = engine.section("pressure");
  const bool is_table = pressure.has("file");
  const int line = pressure.line_of(is_table ? "file" : "compression_exponent");

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
  double peak_deg = dead_centre_deg;
  for (double lead_deg = 0; lead_deg <= kPeakSearchDeg; lead_deg += kPeakStepDeg) {
    if (motored_Pa(dead_centre_deg - lead_deg) > motored_Pa(peak_deg)) peak_deg = dead_centre_deg - lead_deg;
  }
  if (dead_centre_deg - peak_deg <= kMaxPeakLeadDeg) return;
  warnings.add(line, "the motored pressure is largest " + brief(dead_centre_deg - peak_deg) +
                         " deg before top dead centre; usual: less than " + brief(kMaxPeakLeadDeg) +
                         " deg: are its angles right?");
}

}  // namespace

std::vector<std::string> warnings_about(const EngineFile& engine) {
  Warnings warnings(engine);
  if (engine.has("crank")) {
    look_at_crank(engine, warnings);
    if (engine.has("masses") && engine.has("engine")) look_at_piston(engine, warnings);
    look_at_diagram(engine, warnings);
  }
  return warnings.lines();
}

std::vector<std::string> warnings_about_running_free(const EngineFile& engine, const EngineDefinition& definition) {
  Warnings warnings(engine);
  const DrivenMachine& machine = definition.machine;
  const bool held =
      definition.friction.any() || machine.constant_Nm != 0 || machine.linear_Nm_s != 0 || machine.quadratic_Nm_s2 != 0;
  if (!held) warnings.add(0, "nothing holds back an engine that runs free without [friction] and [machine]");
  return warnings.lines();
}

std::vector<std::string> tell_warnings(const Arguments& arguments, std::vector<std::string> warnings) {
  if (arguments.has(kNoWarnings.name)) return {};
  for (const std::string& line : warnings) std::fprintf(stderr, "%s\n", line.c_str());
  return warnings;
}

EngineFile read_engine(const Arguments& arguments, const std::vector<std::string>& needed_sections,
                       std::vector<std::string>* warnings) {
  EngineFile engine = read_engine_file(arguments.file(), needed_sections);
  std::vector<std::string> told = tell_warnings(arguments, warnings_about(engine));
  if (warnings != nullptr) *warnings = std::move(told);
  return engine;
}

void demand_a_diagram(const EngineFile& engine) {
  if (engine.definition().pressure.source != PressureSource::gas) return;
  throw InputError(
      engine.path(), engine.section("pressure").line_of("source"),
      "source: this command takes the pressure from a diagram, and gas has none; `crankloop run --csv` has "
      "the forces of an engine that breathes");
}

}  // namespace crankloop::program

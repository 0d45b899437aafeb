#include "plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <utility>

#include <crankloop/tabulate/first_design.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>

#include "../files/units.hpp"
#include "../files/words.hpp"
#include "lobe_feet.hpp"
#include "measured_rows.hpp"
#include "usual_ranges.hpp"

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

bool within(Interval usual, double value) { return value >= usual.least && value <= usual.most; }

class Warnings {
 public:
  explicit Warnings(const EngineFile& engine) : engine_{engine} {}

  /// Line 0: for the whole file.
  void add(int line, const std::string& text) {
    lines_.push_back(engine_.path() + (line > 0 ? ":" + std::to_string(line) : "") + ": warning: " + text);
  }

  void add_if_any(int line, const std::string& text) {
    if (!text.empty()) add(line, text);
  }

  /// Whether it is usual.
  bool add_unless(Interval usual, double value, int line, const std::string& what, const char* unit,
                  const std::string& remark = "") {
    if (within(usual, value)) return true;
    add(line, what + " = " + brief(value) + " is unusual; usual: " + brief(usual.least) + " to " + brief(usual.most) +
                  unit + remark);
    return false;
  }

  [[nodiscard]] const std::vector<std::string>& lines() const noexcept { return lines_; }

 private:
  const EngineFile& engine_;
  std::vector<std::string> lines_;
};

/// Bore, stroke and rod a thousand times too small.
bool lengths_look_like_metres(const SectionValues& crank) {
  return crank.number("bore_mm") < kBoreMm.most / 1e3 && crank.number("stroke_mm") < 4 &&
         crank.number("rod_length_mm") < 10;
}

/// Warns about unusual sizes, and returns the others.
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

void look_at_value(const Value& value, const EngineSize& size, Warnings& warnings) {
  const UsualRange* const range = usual_range_of(*value.key);
  if (range == nullptr || value.line == 0 || !value.used) return;
  const std::optional<double> per = size.of(range->per);
  const double given = value.numbers.at(0);
  if (!per || (range->zero && given == 0) || within(range->usual, given / *per)) return;
  const std::string unit = unit_in_words(value.key->unit.name);
  warnings.add(value.line, std::string(value.key->name) + " = " + brief(given) + " is unusual; usual: " +
                               about(range->usual.least * *per) + " to " + about(range->usual.most * *per) +
                               (unit.empty() ? "" : " " + unit) + in_words(range->per));
}

/// Compares each value with engines of this size.
void look_at_values(const EngineFile& engine, EngineSize size, bool metres, Warnings& warnings) {
  if (engine.has("engine") && size.stroke_mm) {
    const double piston_m_s = engine.rated_rpm() / *size.of(Per::piston_speed);
    const Value* const rated = engine.section("engine").find("rated_rpm");
    if (within(usual_range_of(*rated->key)->usual, piston_m_s)) size.rated_krpm = engine.rated_rpm() / 1e3;
  }
  for (const SectionValues& section : engine.sections()) {
    for (const Value& value : section.values) {
      if (!metres || value.key->unit.name != std::string_view("mm")) look_at_value(value, size, warnings);
    }
  }
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

/// In degrees of cylinder 1's cycle, with the dead centre of gas exchange at 360.
constexpr Interval kIntakeFullLiftDeg{380, 560};
constexpr Interval kExhaustFullLiftDeg{160, 340};

void look_at_cams(const EngineFile& engine, Warnings& warnings) {
  for (const SectionValues& cam : engine.sections()) {
    if (cam.kind != "cam") continue;
    const std::string valve = "valve " + cam.name;
    const std::string port =
        engine.has(valve) && engine.section(valve).has("port") ? engine.section(valve).text("port") : cam.name;
    const bool intake = port == "intake";
    if (!intake && port != "exhaust") continue;
    const double given_deg = cam.number("full_lift_at_crank_deg");
    const double deg = given_deg - 720 * std::floor(given_deg / 720);
    const Interval usual = intake ? kIntakeFullLiftDeg : kExhaustFullLiftDeg;
    if (within(usual, deg)) continue;
    warnings.add(cam.line_of("full_lift_at_crank_deg"),
                 "full_lift_at_crank_deg = " + brief(given_deg) + " is unusual; usual: " + brief(usual.least) + " to " +
                     brief(usual.most) + " deg for " + (intake ? "an intake" : "an exhaust") +
                     " valve: 0 is the firing top dead centre, 360 that of gas exchange");
  }
}

void look_at_misread_rows(const SectionValues& cam, const TrainOfFile& train, Warnings& warnings) {
  if (!train.rows) return;
  const std::string misread = misread_row({train.points_path, train.points, train.point_lines}, *train.rows);
  if (misread.empty()) return;
  warnings.add(cam.line_of("smoothing_um"),
               "smoothing_um = auto becomes " + brief(cam.number("smoothing_um")) + " because of " + misread);
}

/// Of a cam's largest speed: ramps begin with up to a tenth of it, a lift less a clearance of 0.1 mm with a fifth.
constexpr double kMaxFirstSpeed = 0.15;

/// Warns about a lift that leaves the base circle and returns to it with a step in speed.
void look_at_feet(const SectionValues& cam, const TrainOfFile& train, Warnings& warnings) {
  const LobeFeet feet = lobe_feet(train.points, train.definition.cam.smoothing_m);
  if (feet.step_m_deg <= kMaxFirstSpeed * feet.largest_m_deg) return;
  warnings.add(cam.line_of("file"), train.points_path + ":" + std::to_string(train.point_lines[feet.first_row]) +
                                        ": the lift leaves the base circle with a step in speed to " +
                                        about(feet.step_m_deg * 1e6) + " um/deg, " +
                                        about(100 * feet.step_m_deg / feet.largest_m_deg) +
                                        " % of the largest, and returns with one; usual: less than 10 %. Is it a "
                                        "valve's lift less its clearance? The table takes the cam's lift, ramps "
                                        "included, and clearance_mm the clearance");
}

std::string in_words(const Gap& gap) {
  return "no row between " + brief(gap.from_deg) + " and " + brief(gap.to_deg) + " deg, where others are " +
         brief(gap.usual_deg) + " deg apart";
}

/// A lobe's rows, with the last of the base circle on either side.
std::vector<double> angles_of_lobe(const TrainOfFile& train) {
  constexpr double kBase_m = 50e-6;
  std::vector<double> angles_deg;
  for (std::size_t i = 0; i < train.points.size(); ++i) {
    const auto is_lift = [&](std::size_t row) {
      return row < train.points.size() && train.points[row].lift_m > kBase_m;
    };
    if (is_lift(i - 1) || is_lift(i) || is_lift(i + 1)) angles_deg.push_back(train.points[i].cam_deg);
  }
  return angles_deg;
}

void look_at_rows_left_out(const SectionValues& cam, const TrainOfFile& train, Warnings& warnings) {
  constexpr double kLeastDeg = 10;
  if (const std::optional<Gap> gap = widest_gap(angles_of_lobe(train), kLeastDeg))
    warnings.add(cam.line_of("file"), train.points_path + ": " + in_words(*gap) + ": a smooth lobe goes across");
}

double largest_lift_m(const TrainOfFile& train) {
  const auto lower = [](const CamPoint& a, const CamPoint& b) { return a.lift_m < b.lift_m; };
  return std::max_element(train.points.begin(), train.points.end(), lower)->lift_m;
}

/// The largest lift, in the range of an analytic cam's.
void look_at_largest_lift(const SectionValues& cam, const TrainOfFile& train, const EngineSize& size,
                          Warnings& warnings) {
  const UsualRange& range = *usual_range_of(*find_key("cam", "max_lift_mm"));
  const std::optional<double> per = size.of(range.per);
  const double lift_mm = 1e3 * largest_lift_m(train);
  if (!per || within(range.usual, lift_mm / *per)) return;
  warnings.add(cam.line_of("file"), train.points_path + ": lift_mm up to " + brief(lift_mm) + " is unusual; usual: " +
                                        about(range.usual.least * *per) + " to " + about(range.usual.most * *per) +
                                        " mm" + in_words(range.per) + ": is it in mm?");
}

/// From where the lobe leaves the base circle to where it returns, in half.
void look_at_width_of_lobe(const SectionValues& cam, const TrainOfFile& train, Warnings& warnings) {
  constexpr Interval kHalfWidthDeg{25, 105};
  const std::vector<double> angles_deg = angles_of_lobe(train);
  if (angles_deg.size() < 2) return;
  const double half_deg = (angles_deg.back() - angles_deg.front()) / 2;
  if (within(kHalfWidthDeg, half_deg)) return;
  warnings.add(cam.line_of("file"), train.points_path + ": the lobe is " + brief(2 * half_deg) +
                                        " deg wide, which is unusual; usual: " + brief(2 * kHalfWidthDeg.least) +
                                        " to " + brief(2 * kHalfWidthDeg.most) +
                                        " deg: are its angles of the cam, not of the crank?");
}

/// The residual of `smoothing_um = auto`, beside the lift.
void look_at_residual(const SectionValues& cam, const TrainOfFile& train, Warnings& warnings) {
  constexpr double kMostOfLift = 0.005;
  if (!train.rows || !misread_row({train.points_path, train.points, train.point_lines}, *train.rows).empty()) return;
  const double share = cam.number("smoothing_um") * 1e-6 / largest_lift_m(train);
  if (share <= kMostOfLift) return;
  warnings.add(cam.line_of("smoothing_um"),
               "smoothing_um = auto becomes " + brief(cam.number("smoothing_um")) + ", " + about(100 * share) +
                   " % of the lift; usual: up to " + brief(100 * kMostOfLift) +
                   " %: are there enough rows for the lobe's shape, one each few degrees?");
}

void look_at_measured_cams(const EngineFile& engine, const EngineSize& size, Warnings& warnings) {
  for (const TrainOfFile& train : engine.trains()) {
    if (!train.has_cam || train.definition.cam.source != CamSource::table) continue;
    const SectionValues& cam = engine.section("cam " + train.name);
    look_at_largest_lift(cam, train, size, warnings);
    look_at_rows_left_out(cam, train, warnings);
    look_at_width_of_lobe(cam, train, warnings);
    look_at_misread_rows(cam, train, warnings);
    look_at_residual(cam, train, warnings);
    look_at_feet(cam, train, warnings);
  }
}

/// Warns about a train that its spring's preload alone compresses far.
void look_at_soft_trains(const EngineFile& engine, Warnings& warnings) {
  constexpr double kMostOfLift = 0.02;
  for (const TrainOfFile& train : engine.trains()) {
    if (!train.complete()) continue;
    const Cam& cam = train.definition.cam;
    const double lift_m = cam.source == CamSource::table ? largest_lift_m(train) : cam.max_lift_m;
    const double shrinks_m = train.definition.valve.spring_preload_N / train.definition.valve.train_N_m;
    if (shrinks_m <= kMostOfLift * lift_m) continue;
    const SectionValues& valve = engine.section("valve " + train.name);
    warnings.add(valve.line_of("train_N_per_mm"),
                 "train_N_per_mm = " + brief(valve.number("train_N_per_mm")) +
                     ": the spring's preload compresses the train by " + about(shrinks_m * 1e3) + " mm, " +
                     about(100 * shrinks_m / lift_m) + " % of the cam's lift; usual: up to " +
                     brief(100 * kMostOfLift) + " %");
  }
}

constexpr Interval kLambdaWithSpark{0.7, 2};
constexpr double kAirConstant = 287.1;  ///< J/(kg K)
constexpr double kFilling = 0.9;        ///< volumetric efficiency at an open throttle

/// An engine with gas exchange, and no diesel: the fuel of those burns by two Wiebe functions, and they have more air.
bool has_spark_ignition(const EngineFile& engine) {
  return engine.definition().pressure.source == PressureSource::gas && engine.has("gas") &&
         engine.section("gas").number("second_share") == 0;
}

std::string usual_with_spark() {
  return "; usual with spark ignition: " + brief(kLambdaWithSpark.least) + " to " + brief(kLambdaWithSpark.most);
}

std::string unusual_lambda(const std::string& name, double lambda) {
  return within(kLambdaWithSpark, lambda) ? "" : name + brief(lambda) + usual_with_spark();
}

/// By the lambda of a full cylinder.
std::string unusual_fuel(const SectionValues& gas, const EngineSize& size, const std::string& name, double fuel_mg) {
  const std::optional<double> cylinder_cm3 = size.of(Per::cylinder);
  if (!cylinder_cm3 || fuel_mg == 0) return "";
  const double density_kg_m3 =
      gas.number("ambient_kPa") * 1e3 / (kAirConstant * (gas.number("ambient_C") + kZeroCelsius_K));
  const double lambda = kFilling * density_kg_m3 * *cylinder_cm3 / (fuel_mg * gas.number("air_fuel_ratio"));
  if (within(kLambdaWithSpark, lambda)) return "";
  return name + brief(fuel_mg) + " gives a lambda of about " + about(lambda) + " in a cylinder full of air" +
         usual_with_spark();
}

/// Warns about an unusual lambda, given or in a full cylinder.
void look_at_mixture(const EngineFile& engine, const EngineSize& size, Warnings& warnings) {
  if (!has_spark_ignition(engine)) return;
  const SectionValues& gas = engine.section("gas");
  const bool by_air = gas.has("excess_air_ratio");
  const std::string unusual = by_air ? unusual_lambda("excess_air_ratio = ", gas.number("excess_air_ratio"))
                                     : unusual_fuel(gas, size, "fuel_mg = ", gas.number("fuel_mg"));
  warnings.add_if_any(gas.line_of(by_air ? "excess_air_ratio" : "fuel_mg"), unusual);
}

/// Warns about a burn by charge, and an octane number, of a fuel that burns by two laws: they are of gasoline in a
/// flame.
void look_at_burn(const EngineFile& engine, Warnings& warnings) {
  if (engine.definition().pressure.source != PressureSource::gas || !engine.has("gas")) return;
  const Gas& gas = engine.definition().gas;
  if (!(gas.second_ratio > 0)) return;
  const SectionValues& values = engine.section("gas");
  const std::string why = ": a law of gasoline, and second_share = " + brief(gas.second_ratio) + " is a diesel's";
  if (gas.charge_burn.in_use) warnings.add(values.line_of("burn_by"), "burn_by = charge" + why);
  if (gas.octane_number > 0) warnings.add(values.line_of("octane"), "octane = " + brief(gas.octane_number) + why);
}

/// Warns about a manifold that is no large volume for its runners: docs/model.md "Runners".
void look_at_runners(const EngineFile& engine, Warnings& warnings) {
  constexpr double kLeastVolumes = 5;
  if (engine.definition().pressure.source != PressureSource::gas || !engine.has("gas")) return;
  const Gas& gas = engine.definition().gas;
  const auto look = [&](const Runner& runner, double manifold_m3, const std::string& key) {
    if (!runner.any() || manifold_m3 >= kLeastVolumes * runner.volume_m3()) return;
    warnings.add(engine.section("gas").line_of(key),
                 key + " = " + brief(manifold_m3 * 1e6) + " is less than five volumes of a runner, " +
                     brief(runner.volume_m3() * 1e6) + " cm3 each: its frequency is then 5 to 13 % low");
  };
  look(gas.intake_runner, gas.intake_m3, "intake_volume_cm3");
  look(gas.exhaust_runner, gas.exhaust_m3, "exhaust_volume_cm3");
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
    warnings.add(line, in_words(*gap) + ": a smooth curve goes across, and work and torque are of that");
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

}  // namespace

std::vector<std::string> warnings_about(const EngineFile& engine) {
  Warnings warnings(engine);
  EngineSize size;
  bool metres = false;
  if (engine.has("crank")) {
    metres = lengths_look_like_metres(engine.section("crank"));
    size = look_at_crank(engine, warnings);
    if (engine.has("masses") && engine.has("engine") && size.bore_mm && !metres) look_at_piston(engine, warnings);
    look_at_diagram(engine, warnings);
  }
  look_at_values(engine, size, metres, warnings);
  if (!metres) look_at_spacing(engine, size, warnings);
  look_at_cams(engine, warnings);
  look_at_measured_cams(engine, size, warnings);
  look_at_soft_trains(engine, warnings);
  look_at_mixture(engine, size, warnings);
  look_at_runners(engine, warnings);
  look_at_burn(engine, warnings);
  return warnings.lines();
}

std::string unusual_peak(double peak_Pa) {
  constexpr double kMost_kPa = 25000;  // of diesels with high boost
  if (peak_Pa / 1e3 <= kMost_kPa) return "";
  return "the largest pressure at full load is " + about(peak_Pa / 1e3) + " kPa; usual: up to " + brief(kMost_kPa) +
         " kPa: are compression ratio, boost and mean effective pressure those of one engine?";
}

std::vector<std::string> warnings_about_order(const EngineFile& engine, const GasOrder& order) {
  if (!engine.has("gas")) return {};
  Warnings warnings(engine);
  const GasOrder of_file = gas_order(engine.definition().gas);
  if (order.burn_start_deg != of_file.burn_start_deg) {
    const UsualRange& range = *usual_range_of(*find_key("gas", "burn_start_deg"));
    warnings.add_unless(range.usual, order.burn_start_deg, 0, "--burn-start-deg", " deg");
  }
  if (!has_spark_ignition(engine)) return warnings.lines();
  if (order.excess_air_ratio > 0 && order.excess_air_ratio != of_file.excess_air_ratio)
    warnings.add_if_any(0, unusual_lambda("--lambda ", order.excess_air_ratio));
  if (order.fuel_kg > 0 && order.fuel_kg != of_file.fuel_kg) {
    Warnings told_of_file(engine);
    const EngineSize size = look_at_crank(engine, told_of_file);
    warnings.add_if_any(0, unusual_fuel(engine.section("gas"), size, "--fuel-mg ", order.fuel_kg * 1e6));
  }
  return warnings.lines();
}

std::vector<std::string> warnings_about_running_free(const EngineFile& engine, const EngineDefinition& definition) {
  Warnings warnings(engine);
  const DrivenMachine& machine = definition.machine;
  const bool held =
      definition.friction.any() || machine.constant_Nm != 0 || machine.linear_Nm_s != 0 || machine.quadratic_Nm_s2 != 0;
  if (!held) warnings.add(0, "a free-running engine without [friction] and [machine] has nothing to limit its speed");
  return warnings.lines();
}

namespace {

struct LeftOut {
  const char* section;
  const char* instead;
  const char* taken;
};
constexpr LeftOut kMisfiresLeftOut{
    "misfire", "every cycle fires",
    "`crankloop run --free`, `crankloop live` and FMUs whose crank forces turn take misfires"};
constexpr LeftOut kFault{"fault", "every signal is healthy",
                         "`crankloop run --free`, `crankloop live` and FMUs whose crank forces turn take faults"};
constexpr LeftOut kSensorFault{"sensor_fault", "no sensor is read",
                               "`crankloop live` and FMUs whose crank forces turn take faults of sensors"};

std::vector<std::string> warnings_about_each(std::initializer_list<LeftOut> left_out, const EngineFile& engine) {
  Warnings warnings(engine);
  for (const SectionValues& section : engine.sections()) {
    for (const LeftOut& kind : left_out) {
      if (section.kind == kind.section)
        warnings.add(section.line, section.title() + ": " + kind.instead + " in this command; " + kind.taken);
    }
  }
  return warnings.lines();
}

}  // namespace

std::vector<std::string> warnings_about_misfires_left_out(const EngineFile& engine) {
  return warnings_about_each({kMisfiresLeftOut, kFault, kSensorFault}, engine);
}
std::vector<std::string> warnings_about_sensor_faults_left_out(const EngineFile& engine) {
  return warnings_about_each({kSensorFault}, engine);
}

void demand_a_diagram(const EngineFile& engine) {
  if (engine.definition().pressure.source != PressureSource::gas) return;
  throw InputError(
      engine.path(), engine.section("pressure").line_of("source"),
      "source: this command takes the pressure from a diagram, and gas has none; `crankloop run --csv` has "
      "the forces of an engine with gas exchange");
}

}  // namespace crankloop::program

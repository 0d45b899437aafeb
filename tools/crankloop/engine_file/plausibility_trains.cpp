// Of cams, analytic and measured, and the trains that they lift.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "../files/words.hpp"
#include "lobe_feet.hpp"
#include "measured_rows.hpp"
#include "plausibility_parts.hpp"

namespace crankloop::program {
namespace {

/// In degrees of cylinder 1's cycle, with the dead centre of gas exchange at 360.
constexpr Interval kIntakeFullLiftDeg{380, 560};
constexpr Interval kExhaustFullLiftDeg{160, 340};

void look_at_full_lift(const EngineFile& engine, Warnings& warnings) {
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
    warnings.add(cam.line_of("file"), train.points_path + ": " + gap_in_words(*gap) + ": a smooth lobe goes across");
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

}  // namespace

void look_at_trains(const EngineFile& engine, const EngineSize& size, Warnings& warnings) {
  look_at_full_lift(engine, warnings);
  look_at_measured_cams(engine, size, warnings);
  look_at_soft_trains(engine, warnings);
}

}  // namespace crankloop::program

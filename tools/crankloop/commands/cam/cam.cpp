// `crankloop cam FILE`: the ground profile of a cam, its picture with pad and rocker, and the cam for a wanted valve
// lift.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crankloop/tabulate/valve_lift.hpp>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/operating_point.hpp"
#include "../../command_line/results.hpp"
#include "../../command_line/summary.hpp"
#include "../../files/csv.hpp"
#include "../../files/units.hpp"
#include "../../loops/cam_from_lift.hpp"
#include "../../loops/tick_probe.hpp"
#include "cam_picture.hpp"
#include "cam_wanted.hpp"

namespace crankloop::program {
namespace {

/// The train's cam, or the designed one in its place.
struct CamOfTrain {
  const TrainOfFile& train;
  std::optional<WantedCam> wanted{};
  Cam cam{};
  std::unique_ptr<ValveLift> lift = std::make_unique<ValveLift>();

  [[nodiscard]] const Rocker& rocker() const { return train.definition.rocker; }
  [[nodiscard]] bool is_table() const { return cam.source == CamSource::table; }
  [[nodiscard]] std::vector<CamPoint> points() const { return {cam.points, cam.points + cam.point_count}; }
};

CamOfTrain cam_of_file(const EngineFile& file, const TrainOfFile& train) {
  CamOfTrain result{train};
  if (!train.has_cam)
    throw InputError(file.path() + ": section [cam " + train.name + "] is missing; without one give --wanted");
  result.cam = train.definition.cam;
  if (const Status refused = result.lift->init(result.cam, result.rocker()); !refused.ok())
    throw file.explain(refused, train, result.lift->failed_at_deg());
  return result;
}

CamOfTrain cam_for(const std::string& wanted, const TrainOfFile& train, const WantedOptions& options) {
  CamOfTrain result{train, cam_for_lift(wanted, train.definition.rocker, options)};
  result.cam.source = CamSource::table;
  result.cam.points = result.wanted->points.data();
  result.cam.point_count = static_cast<int>(result.wanted->points.size());
  const auto accept = [&](const Status& refused, const std::string& where) {
    if (refused.ok()) return;
    throw InputError(wanted + ": the table of its cam is refused" + where + ": " + refused.field + " " +
                     describe(refused.reason) + "; try another --step-deg");
  };
  CamRows rows;
  accept(choose_smoothing(result.cam, rows), "");
  const Status of_lift = result.lift->init(result.cam, result.rocker());
  accept(of_lift, " at " + brief(result.lift->failed_at_deg()) + " deg of the flat follower's angle");
  return result;
}

void write_profile(Output& out, const CamOfTrain& cam, double step_deg) {
  CsvWriter csv(
      out, {"flat_deg", "x_mm", "y_mm", "polar_deg", "polar_radius_mm", "follower_lift_mm", "curvature_radius_mm"});
  const double base_m = cam.rocker().base_circle_m;
  for_each_angle(step_deg, 360, [&](double since_first_row) {
    const double flat_deg = since_first_row - 180;
    const CamLift y = cam.lift->cam().at(flat_deg * kRadPerDeg);
    const ContourPoint p = contour_point(base_m, flat_deg * kRadPerDeg, y);
    csv.row(flat_deg, p.x_m * kMilli, p.y_m * kMilli, std::atan2(p.y_m, p.x_m) * kDegPerRad,
            std::hypot(p.x_m, p.y_m) * kMilli, y.lift_m * kMilli, (base_m + y.lift_m + y.per_rad2_m) * kMilli);
  });
}

/// What an engine file's [cam] takes as its table.
void write_table(Output& out, const CamOfTrain& cam, double step_deg) {
  CsvWriter csv(out, {"cam_deg", "lift_mm"});
  if (cam.wanted) {
    for (const CamPoint& point : cam.wanted->points) csv.row(point.cam_deg, point.lift_m * kMilli);
    return;
  }
  for_each_angle(step_deg, 360, [&](double since_first_row) {
    if (since_first_row >= 360) return;  // a table is less than a turn
    const double deg = since_first_row - 180;
    csv.row(deg, cam.lift->cam().at(deg * kRadPerDeg).lift_m * kMilli);
  });
}

void add_design(Summary& s, const CamOfTrain& cam) {
  const WantedCam& wanted = *cam.wanted;
  s.line("wanted_smoothing", wanted.smoothing_m * kMicro, "um", "of its rows, chosen by their scatter");
  s.line("wanted_residual", wanted.residual_m * kMicro, "um");
  s.line("wanted_peak", std::abs(wanted.peak_deg) < 1e-9 ? 0 : wanted.peak_deg, "deg", "cam angle in its file; here 0");
  s.line("deviation_from_wanted", deviation_m(wanted, *cam.lift) * kMicro, "um",
         "largest, of the valve lift that the cam's table gives");
}

std::string summary(const CamOfTrain& cam) {
  const ValveLift& lift = *cam.lift;
  const double base_m = cam.rocker().base_circle_m;
  Summary s;
  s.remark("cam of train " + cam.train.name + ", angles from full lift");
  if (cam.wanted) add_design(s, cam);
  s.line("base_circle", base_m * kMilli, "mm", "radius");
  s.line("max_follower_lift", lift.cam().largest_lift_m() * kMilli, "mm", "of a flat follower");
  s.line("max_valve_lift", lift.largest_lift_m() * kMilli, "mm");
  s.line("lobe", (lift.cam().closes_rad() - lift.cam().opens_rad()) * kDegPerRad, "deg", "cam angle");
  s.line("min_curvature_radius", lift.smallest_radius_m() * kMilli, "mm",
         "at " + brief(lift.smallest_radius_at_deg()) + " deg of the flat follower's angle");
  const CamLift nose = lift.cam().at(0);
  s.line("nose_curvature_radius", (base_m + nose.lift_m + nose.per_rad2_m) * kMilli, "mm");
  s.line("undercut", "no", "", "the radius of curvature is above 0 everywhere");
  s.line("base_circle_of_undercut", std::max(base_m - lift.smallest_radius_m(), 0.0) * kMilli, "mm",
         "with this flat follower's lift");
  if (cam.is_table()) {
    s.line("smoothing", cam.cam.smoothing_m * kMicro, "um", cam.wanted || cam.train.rows ? "chosen by auto" : "");
    s.line("smoothing_residual", lift.cam().residual_m() * kMicro, "um");
  }
  return s.text();
}

std::string title_of(const CamOfTrain& cam) {
  return "Cam of train " + cam.train.name + (cam.wanted ? ", for a wanted lift" : "");
}

std::string picture(const EngineFile& file, const CamOfTrain& cam, double at_deg) {
  const double stem_m = cam.train.geometry ? cam.train.geometry->stem_m : 0;
  report::Sheet sheet = cam_sheet({cam.rocker(), *cam.lift, stem_m}, at_deg);
  sheet.title = title_of(cam) + ", at " + report::number_text(at_deg) + " deg";
  sheet.remarks = {std::filesystem::path(file.path()).filename().string() + ", to scale"};
  sheet.remarks.push_back(cam.rocker().kind == RockerKind::circular_pad
                              ? "Assumed: the outlines of rocker, screw and valve, and the angle between the arms"
                              : "The train behind the flat follower has a constant ratio and is not shown");
  return to_svg_file(sheet);
}

std::string smoothing_picture(const EngineFile& file, const CamOfTrain& cam) {
  report::Sheet sheet = smoothing_sheet(cam.points(), cam.lift->cam());
  sheet.title = title_of(cam) + ": before and after smoothing";
  sheet.remarks = {std::filesystem::path(file.path()).filename().string() + ", smoothing_um " +
                       brief(cam.cam.smoothing_m * kMicro) + ", largest residual " +
                       report::number_text(cam.lift->cam().residual_m() * kMicro, 3) + " um",
                   "Rows by differences of neighbours; smoothed by derivatives of the spline"};
  return to_svg_file(sheet);
}

int run_cam(const Arguments& arguments) {
  const EngineFile file = read_engine(arguments, {});
  const TrainOfFile& train = file.train(train_name(arguments, file));
  if (!train.has_rocker)
    throw InputError(file.path() + ": section [rocker " + train.name + "] is missing; this command needs it");
  const double step_deg = arguments.number("--step-deg");
  arguments.require_with("--at", "--svg");
  if (arguments.has("--zero-lash") && !arguments.has("--wanted"))
    throw UsageError("--zero-lash says how a wanted lift is counted; give --wanted");
  const WantedOptions options{step_deg, arguments.has("--zero-lash")};
  const CamOfTrain cam =
      arguments.has("--wanted") ? cam_for(arguments.text("--wanted"), train, options) : cam_of_file(file, train);
  if (cam.wanted && !cam.wanted->misread.empty()) {
    (void)tell_warnings(arguments,
                        {arguments.text("--wanted") + ": warning: the smoothing of the wanted lift becomes " +
                         brief(cam.wanted->smoothing_m * kMicro) + " um because of " + cam.wanted->misread});
  }
  if (arguments.has("--smoothing") && !cam.is_table())
    throw UsageError("--smoothing: the cam of train " + train.name + " is no table, so nothing is smoothed");
  if (arguments.has("--table") && !cam.wanted && 360 / step_deg > kMaxCamPoints)
    throw UsageError("--step-deg " + brief(step_deg) + ": a cam's table has at most " + std::to_string(kMaxCamPoints) +
                     " rows");
  Results results(arguments, {"--csv", "--table", "--svg", "--smoothing"});
  if (Output* csv = results["--csv"]) write_profile(*csv, cam, step_deg);
  if (Output* table = results["--table"]) write_table(*table, cam, step_deg);
  if (Output* svg = results["--svg"]) svg->write(picture(file, cam, arguments.number("--at")));
  if (Output* svg = results["--smoothing"]) svg->write(smoothing_picture(file, cam));
  results.finish(summary(cam));
  return kSuccess;
}

constexpr Option kCamOptions[] = {
    text("--train", "NAME",
         "valve train: the NAME of its [cam NAME] and [rocker NAME]; default the only one of the file"),
    number("--step-deg", "D", from(0.001).up_to(30), "degrees of the flat follower's angle between rows", "1"),
    text("--csv", "F", "file for the ground profile: coordinates, radius of curvature; - is standard output"),
    text("--svg", "F.svg", "picture of cam, pad and rocker to scale, with radius of curvature and lift"),
    number("--at", "DEG", from(-360).up_to(360), "cam angle of the picture from full lift", "0"),
    text("--wanted", "LIFT.csv",
         "design the cam for this valve lift: cam_deg,lift_mm from minus the clearance on the base circle"),
    flag("--zero-lash", "the wanted lift is that without clearance: 0 on the base circle, its ramps above"),
    text("--table", "F", "file for the flat follower's lift, which an engine file reads as a cam: cam_deg,lift_mm"),
    text("--smoothing", "F.svg", "picture of a measured table before and after smoothing"),
};

}  // namespace

const Command kCam{"cam",
                   "the ground profile of a cam, with its picture; the cam for a wanted valve lift",
                   "FILE [--train NAME] [--step-deg D] [--csv F] [--svg F.svg] [--at DEG] [--wanted LIFT.csv] "
                   "[--zero-lash] [--table F] [--smoothing F.svg]",
                   "crankloop cam ohc_125.ini --train intake --csv cam.csv --svg cam.svg --at -30",
                   1,
                   kCamOptions,
                   run_cam};

}  // namespace crankloop::program

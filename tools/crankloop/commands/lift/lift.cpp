// `crankloop lift FILE`: cam, rocker and theoretical valve lift over a turn of the cam, without forces or elasticity.
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
#include "../../loops/flow_lines.hpp"
#include "../../loops/tick_probe.hpp"
#include "lift_plot.hpp"

namespace crankloop::program {
namespace {

constexpr double kRounding_deg = 1e-9;

void write_lift(Output& out, const ShownLift& shown, double step_deg) {
  std::vector<std::string> columns{"cam_deg",         "rocker_angle_deg", "lift_mm",
                                   "lift_mm_per_rad", "lift_mm_per_rad2", "rocker_ratio"};
  if (shown.speed_rpm) columns.insert(columns.end(), {"velocity_m_s", "acceleration_m_s2"});
  if (shown.area) columns.insert(columns.end(), {"flow_area_mm2", "effective_area_mm2"});
  CsvWriter csv(out, columns);
  const ValveLift& lift = shown.lift;
  const std::optional<FlowArea>& area = shown.area;
  const double cam_speed = shown.cam_rad_s();
  for_each_angle(step_deg, 360, [&](double since_first_row) {
    const double cam_deg = since_first_row - 180;
    const LiftPose pose = lift.at(cam_deg / kDegPerRad);
    // The valve is at rest while the lash is open. These derivatives are those of the train, whose speed at the end of
    // the lash is the impact speed.
    for (const double value : {cam_deg, pose.rocker_rad * kDegPerRad, std::max(pose.lift_m, 0.0) * 1e3,
                               pose.per_rad_m * 1e3, pose.per_rad2_m * 1e3, pose.rocker_ratio})
      csv.cell(value);
    if (shown.speed_rpm) csv.cell(pose.per_rad_m * cam_speed), csv.cell(pose.per_rad2_m * cam_speed * cam_speed);
    if (area) csv.cell(area->geometric_m2(pose.lift_m) * 1e6), csv.cell(area->effective_m2(pose.lift_m) * 1e6);
    csv.end_row();
  });
}

/// Of rigid parts, at the engine's speed; the extremes of rows every tenth of a degree.
void add_motion(Summary& s, const ShownLift& shown) {
  const ValveLift& lift = shown.lift;
  double velocity_m = 0;
  double rising_m = 0;
  double slowing_m = 0;
  for (int tenth = -1800; tenth < 1800; ++tenth) {
    const LiftPose pose = lift.at(tenth * 0.1 / kDegPerRad);
    velocity_m = std::max(velocity_m, std::abs(pose.per_rad_m));
    rising_m = std::max(rising_m, pose.per_rad2_m);
    slowing_m = std::min(slowing_m, pose.per_rad2_m);
  }
  const double speed = shown.cam_rad_s();
  const std::string at = "at " + brief(*shown.speed_rpm) + " rpm of the engine";
  const auto per_rad = [](double m, const char* unit) { return brief(m * 1e3) + unit; };
  s.line("max_theoretical_velocity", velocity_m * speed, "m/s", at + "; " + per_rad(velocity_m, " mm/rad"));
  s.line("max_theoretical_acceleration", rising_m * speed * speed, "m/s^2", per_rad(rising_m, " mm/rad^2"));
  s.line("min_theoretical_acceleration", slowing_m * speed * speed, "m/s^2", per_rad(slowing_m, " mm/rad^2"));
}

std::string summary(const EngineFile& engine, const ShownLift& shown, const TrainOfFile& train) {
  const ValveLift& lift = shown.lift;
  const std::optional<FlowArea>& area = shown.area;
  double least_ratio = lift.at(0).rocker_ratio;
  double most_ratio = least_ratio;
  for (int tenth = -1800; tenth < 1800; ++tenth) {
    const double ratio = lift.at(tenth * 0.1 / kDegPerRad).rocker_ratio;
    least_ratio = std::min(least_ratio, ratio);
    most_ratio = std::max(most_ratio, ratio);
  }
  Summary s;
  s.line("max_theoretical_lift", lift.largest_lift_m() * 1e3, "mm");
  s.line("lobe_start", lift.opens_rad() * kDegPerRad, "deg");
  s.line("lobe_end", lift.closes_rad() * kDegPerRad, "deg");
  s.line("min_rocker_ratio", least_ratio);
  s.line("max_rocker_ratio", most_ratio);
  s.line("min_cam_radius", lift.smallest_radius_m() * 1e3, "mm");
  if (shown.speed_rpm) add_motion(s, shown);
  if (train.definition.cam.source == CamSource::table) {
    s.line("smoothing", train.definition.cam.smoothing_m * 1e6, "um", train.rows ? "chosen by auto" : "");
    s.line("smoothing_residual", lift.cam().residual_m() * 1e6, "um");
    const double peak_deg = lift.cam().peak_deg();
    s.line("table_peak", std::abs(peak_deg) > kRounding_deg ? peak_deg : 0, "deg");
  }
  s.remark(flow_remark(train));
  if (!area) return s.text();
  const FlowIntegrals flow = theoretical_flow(*area, lift);
  add_flow(s, "theoretical_", flow);
  const std::optional<double> rated_rpm = engine.has("engine") ? std::optional(engine.rated_rpm()) : std::nullopt;
  add_flow_figures(s, flow, engine, train, rated_rpm);
  return s.text();
}

std::string picture(const EngineFile& engine, const ShownLift& shown, const std::string& name) {
  report::Sheet sheet = lift_sheet(shown);
  sheet.title = "Theoretical lift of train " + name;
  if (shown.speed_rpm) sheet.title += " at " + brief(*shown.speed_rpm) + " rpm of the engine";
  sheet.remarks = {std::filesystem::path(engine.path()).filename().string() +
                   "; rigid parts. Derivatives are the train's, also while its lash is open"};
  if (shown.area) add_flow_remarks(sheet.remarks, engine.train(name));
  return report::to_svg_file(sheet);
}

int run_lift(const Arguments& arguments) {
  const EngineFile engine = read_engine(arguments, {});
  const std::string name = train_name(arguments, engine);
  const TrainOfFile& train = engine.train(name);
  for (const std::string& title : {"cam " + name, "rocker " + name}) {
    if (!engine.has(title))
      throw InputError(engine.path() + ": section [" + title + "] is missing; this command needs it");
  }
  const auto lift = std::make_unique<ValveLift>();
  if (const Status refused = lift->init(train.definition.cam, train.definition.rocker); !refused.ok()) {
    throw engine.explain(refused, train, lift->failed_at_deg());
  }
  const std::optional<FlowArea> area = flow_area_of(train);
  ShownLift shown{*lift, area};
  if (arguments.has("--rpm")) shown.speed_rpm = arguments.number("--rpm");
  const double step_deg = arguments.number("--step-deg");
  Results results(arguments, {"--csv", "--plot"});
  if (Output* csv = results["--csv"]) write_lift(*csv, shown, step_deg);
  if (Output* plot = results["--plot"]) plot->write(picture(engine, shown, name));
  if (arguments.has("--csv") || arguments.has("--plot")) {
    results.finish(summary(engine, shown, train));
    return kSuccess;
  }
  Output out = Output::standard();
  write_lift(out, shown, step_deg);
  out.finish();
  return kSuccess;
}

constexpr Option kLiftOptions[] = {
    text("--train", "NAME",
         "valve train: the NAME of its [cam NAME] and [rocker NAME]; default the only one of the file"),
    number("--rpm", "N", above(0).up_to(100000),
           "engine speed in rpm, for velocity in m/s and acceleration in m/s^2 beside mm/rad and mm/rad^2"),
    number("--step-deg", "D", from(0.001).up_to(360), "cam degrees between rows", "1"),
    text("--csv", "F", "file for the table; standard output then shows a summary instead of it"),
    text("--plot", "F.svg", "SVG file with a picture: lift, velocity, acceleration, jerk, rocker ratio, flow area"),
};

}  // namespace

const Command kLift{"lift",
                    "cam, rocker and theoretical valve lift over a turn of the cam",
                    "FILE [--train NAME] [--rpm N] [--step-deg D] [--csv F] [--plot F.svg]",
                    "crankloop lift ohc_125.ini --train intake --csv lift.csv",
                    1,
                    kLiftOptions,
                    run_lift};

}  // namespace crankloop::program

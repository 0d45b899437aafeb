// `crankloop lift FILE`: cam, rocker and theoretical valve lift over a turn of the cam, without forces or elasticity.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crankloop/tabulate/valve_lift.hpp>

#include "../command_line/commands.hpp"
#include "../command_line/engine_argument.hpp"
#include "../command_line/operating_point.hpp"
#include "../command_line/summary.hpp"
#include "../files/csv.hpp"
#include "../files/units.hpp"
#include "../loops/flow_lines.hpp"
#include "../loops/tick_probe.hpp"

namespace crankloop::program {
namespace {

void write_lift(CsvWriter& csv, const ValveLift& lift, const std::optional<FlowArea>& area, double step_deg) {
  for_each_angle(step_deg, 360, [&](double since_first_row) {
    const double cam_deg = since_first_row - 180;
    const LiftPose pose = lift.at(cam_deg / kDegPerRad);
    // The valve is at rest while the lash is open. These derivatives are those of the train, whose speed at the end of
    // the lash is the impact speed.
    for (const double value : {cam_deg, pose.rocker_rad * kDegPerRad, std::max(pose.lift_m, 0.0) * 1e3,
                               pose.per_rad_m * 1e3, pose.per_rad2_m * 1e3, pose.rocker_ratio})
      csv.cell(value);
    if (area) csv.cell(area->geometric_m2(pose.lift_m) * 1e6), csv.cell(area->effective_m2(pose.lift_m) * 1e6);
    csv.end_row();
  });
}

std::string summary(const EngineFile& engine, const ValveLift& lift, const TrainOfFile& train,
                    const std::optional<FlowArea>& area) {
  double least_ratio = lift.at(0).rocker_ratio;
  double most_ratio = least_ratio;
  for (int tenth = -1800; tenth < 1800; ++tenth) {
    const double ratio = lift.at(tenth * 0.1 / kDegPerRad).rocker_ratio;
    least_ratio = std::min(least_ratio, ratio);
    most_ratio = std::max(most_ratio, ratio);
  }
  Summary s;
  s.line("max_theoretical_lift", lift.largest_lift_m() * 1e3, "mm");
  s.line("lobe_begin", lift.opens_rad() * kDegPerRad, "deg");
  s.line("lobe_end", lift.closes_rad() * kDegPerRad, "deg");
  s.line("rocker_ratio_least", least_ratio);
  s.line("rocker_ratio_most", most_ratio);
  s.line("min_cam_radius", lift.smallest_radius_m() * 1e3, "mm");
  if (train.definition.cam.source == CamSource::table) {
    s.line("smoothing", train.definition.cam.smoothing_m * 1e6, "um", train.rows ? "chosen by auto" : "");
    s.line("smoothing_residual", lift.cam().residual_m() * 1e6, "um");
    s.line("table_peak", lift.cam().peak_deg(), "deg");
  }
  s.remark(flow_remark(train));
  if (!area) return s.text();
  const FlowIntegrals flow = theoretical_flow(*area, lift);
  add_flow(s, "theoretical_", flow);
  const std::optional<double> rated_rpm = engine.has("engine") ? std::optional(engine.rated_rpm()) : std::nullopt;
  add_flow_figures(s, flow, engine, train, rated_rpm);
  return s.text();
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
  Output out(arguments.text_or_empty("--csv"));
  const std::optional<FlowArea> area = flow_area_of(train);
  std::vector<std::string> columns{"cam_deg",         "rocker_angle_deg", "lift_mm",
                                   "lift_mm_per_rad", "lift_mm_per_rad2", "rocker_ratio"};
  if (area) columns.insert(columns.end(), {"flow_area_mm2", "effective_area_mm2"});
  CsvWriter csv(out, columns);
  write_lift(csv, *lift, area, arguments.number("--step-deg"));
  out.finish();
  if (arguments.has("--csv")) print(summary(engine, *lift, train, area));
  return kSuccess;
}

constexpr Option kOptions[] = {
    text("--train", "NAME",
         "valve train: the NAME of its [cam NAME] and [rocker NAME]; default the only one of the file"),
    number("--step-deg", "D", from(0.001).up_to(360), "cam degrees between rows", "1"),
    text("--csv", "F", "file for the table, and a summary on standard output; else the table there"),
};

}  // namespace

const Command kLift{"lift",
                    "cam, rocker and theoretical valve lift over a turn of the cam",
                    "FILE [--train NAME] [--step-deg D] [--csv F]",
                    "crankloop lift ohc_125.ini --train intake --csv lift.csv",
                    1,
                    kOptions,
                    run_lift};

}  // namespace crankloop::program

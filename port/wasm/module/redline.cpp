#include "redline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "crankloop/files/error.hpp"
#include "crankloop/files/units.hpp"

namespace crankloop::page {
namespace {

constexpr int kLeastRedline_rpm = 500, kMaxRedline_rpm = 15000;  // as `redline` has them

/// Speeds of the sweep, and of an onset's search.
int sweep_speeds_of(const program::SpeedRange& range) {
  return (range.to_rpm - range.from_rpm + range.step_rpm - 1) / range.step_rpm + 1;
}
int speeds_per_onset(const program::SpeedRange& range) {
  return static_cast<int>(std::ceil(std::log2(std::max(range.step_rpm, 1))));
}

const char* name_of(program::SpeedSearch::Part part) {
  constexpr const char* kNames[] = {"sweep", "separation", "bounce", "seating", "ended"};
  return kNames[static_cast<int>(part)];
}

void add_onset(Json& json, const std::string& name, const program::Onset& onset) {
  json.key(name + "_rpm");
  json.value(onset.found ? onset.speed_rpm : std::numeric_limits<double>::infinity());
  json.member(name + "_at_start", onset.at_the_start);
}

}  // namespace

void RedlineSearch::begin(Json& json, const std::shared_ptr<const program::EngineFile>& file, const std::string& train,
                          int from_rpm, int to_rpm) {
  const program::SpeedRange range =
      program::speed_range(from_rpm > 0 ? from_rpm : kLeastRedline_rpm, to_rpm > 0 ? to_rpm : kMaxRedline_rpm);
  if (range.from_rpm >= range.to_rpm) throw program::InputError("the lowest speed must be less than the highest");
  auto valve = std::make_unique<program::LoneValve>(*file, train);
  auto search = std::make_unique<program::SpeedSearch>(*valve, range, 1.0);
  search_ = std::move(search);  // in this order: the old search points to the old valve
  valve_ = std::move(valve);
  file_ = file;
  range_ = range;
  speeds_run_ = 0;
  const double rigid_rad_s = search_->sweep().rigid.crank_rad_s;
  json.member("from_rpm", range.from_rpm).member("to_rpm", range.to_rpm).member("step_rpm", range.step_rpm);
  json.member("speeds", sweep_speeds_of(range)).key("static_redline_rpm");
  json.value(rigid_rad_s > 0 ? rigid_rad_s * program::kRpmPerRad_s : std::numeric_limits<double>::infinity());
  json.member("tick_us", search_->sweep().tick_s * 1e6);
}

void RedlineSearch::step(Json& json) {
  if (search_ == nullptr) throw program::InputError("no search has begun");
  const auto part = search_->part();
  if (part == program::SpeedSearch::Part::ended) {
    const program::Sweep& sweep = search_->sweep();
    json.member("ended", true);
    add_onset(json, "separation", sweep.separation);
    add_onset(json, "bounce", sweep.bounce);
    add_onset(json, "seating", sweep.seating);
    return;
  }
  const program::SpeedResult result = search_->step();
  const int of = sweep_speeds_of(range_) + 3 * speeds_per_onset(range_);
  ++speeds_run_;
  json.member("ended", false)
      .member("part", name_of(part))
      .member("done", speeds_run_)
      .member("of", std::max(of, speeds_run_));
  json.member("speed_rpm", result.speed_rpm).key("results").open('{');
  json.member("max_lift_m", result.cycle.largest_lift_m).member("separations", result.cycle.separations);
  json.member("separation_gap_m", result.cycle.separation_clearance_m)
      .member("seating_m_s", result.cycle.seating_speed_m_s);
  json.member("bounces", result.cycle.bounces).member("bounce_m", result.cycle.bounce_height_m);
  json.member("max_acceleration_m_s2", result.cycle.largest_acceleration_m_s2).member("train_N", result.train_N);
  json.member("cam_N", result.cam_N).member("spring_margin", result.spring_margin);
  json.member("is_possible", result.is_possible).close('}');
}

}  // namespace crankloop::page

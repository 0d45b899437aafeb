#include "engine_report_trains.hpp"

#include <cmath>
#include <memory>

#include <crankloop/tabulate/valve_lift.hpp>
#include <crankloop/tabulate/valve_motion.hpp>

#include "../loops/lift_jerk.hpp"

namespace crankloop::program {
namespace {

RigidMotion theory_of(const ReportInput& input, const ValveLift& lift, double full_lift_deg) {
  const double cam_rad_s = input.operation.speed_rad_s() / 2;
  RigidMotion theory;
  for (const double crank_deg : input.trace.crank_deg) {
    const double cam_rad = (crank_deg - full_lift_deg) / 2 * kRadPerDeg;
    const LiftPose pose = lift.at(cam_rad);
    const bool open = pose.lift_m > 0;
    theory.velocity_m_s.push_back(open ? pose.per_rad_m * cam_rad_s : 0);
    theory.acceleration_m_s2.push_back(open ? pose.per_rad2_m * cam_rad_s * cam_rad_s : 0);
    theory.jerk_m_s3.push_back(open ? lift_jerk_m(lift, cam_rad) * cam_rad_s * cam_rad_s * cam_rad_s : 0);
  }
  return theory;
}

}  // namespace

std::vector<ShownTrain> trains_of(const ReportInput& input) {
  const EngineDefinition& definition = input.exact.definition();
  const std::vector<std::string> names = names_of_trains(input.file);
  std::vector<ShownTrain> trains;
  const auto lift = std::make_unique<ValveLift>();
  for (std::size_t t = 0; t < input.trace.valves.size(); ++t) {
    const ValveTrain& train = definition.trains[t];
    if (!lift->init(train.cam, train.rocker).ok()) continue;  // the loop has accepted it
    const detail::ValveBody<double> body = valve_body(train.valve, *lift);
    const ValveTrace& trace = input.trace.valves[t];
    const StaticRedline rigid = static_redline(*lift, body);
    trains.push_back({names[t], trace, index_of_largest(trace[ValveQuantity::theoretical_lift]),
                      train.cam.full_lift_deg + 2 * lift->opens_rad() * kDegPerRad, lift->largest_lift_m(),
                      body.preload_N / body.seat_N_m, open_frequency_rad_s(body) * kTurnsPerRad,
                      seated_frequency_rad_s(body) * kTurnsPerRad, rigid, rigid.margin(input.operation.speed_rad_s()),
                      std::fmod(train.cam.full_lift_deg + 2 * rigid.cam_deg + 720, 720),
                      theory_of(input, *lift, train.cam.full_lift_deg), std::abs(input.operation.speed_rad_s()) / 2,
                      lift->smallest_radius_m()});
  }
  return trains;
}

double crank_deg(const ShownTrain& train, double since_opening_deg) {
  const double deg = std::fmod(train.lobe_begin_deg + 2 * since_opening_deg, 720);
  return deg < 0 ? deg + 720 : deg;
}

std::vector<std::size_t> entries_of_lobe(const ShownTrain& train) {
  const std::size_t count = train.trace.regime.size() - 1;  // the last entry is the first of the next cycle
  std::vector<std::size_t> entries(count);
  for (std::size_t i = 0; i < count; ++i) entries[i] = (train.full_lift + count / 2 + i) % count;
  return entries;
}

std::size_t seating_place(const ShownTrain& train, const std::vector<std::size_t>& entries) {
  std::size_t i = entries.size() / 2;
  while (i < entries.size() && (train.trace.regime[entries[i]] & kSeatOn) == 0) ++i;
  return i;
}

}  // namespace crankloop::program

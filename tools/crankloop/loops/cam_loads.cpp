#include "cam_loads.hpp"

#include <algorithm>
#include <cmath>

#include "../files/number.hpp"
#include "../files/units.hpp"

namespace crankloop::program {
namespace {

constexpr double kPaPerMPa = 1e6;

std::string at_deg(double cam_deg) { return "at " + brief(std::round(cam_deg * 100) / 100) + " deg"; }

}  // namespace

CamLoads cam_loads_at(const ValveLift& lift, const CamContact& contact, double cam_rad, double cam_rad_s,
                      double train_N) {
  if (!(train_N > 0)) return {};
  const ContactPose at = lift.contact_at(cam_rad);
  const LiftPose pose = lift.at(cam_rad);
  const double cam_N = train_N * pose.rocker_ratio;
  CamLoads loads;
  if (contact.width_m > 0) {
    const HertzContact hertz = hertz_contact(contact, at.curvature_per_m, cam_N);
    loads.stress_Pa = hertz.largest_Pa;
    loads.half_width_m = hertz.half_width_m;
  }
  loads.sliding_m_s = at.sliding_m * cam_rad_s;
  loads.entrainment_m_s = at.entrainment_m * cam_rad_s;
  const double sense = cam_rad_s > 0 ? 1 : cam_rad_s < 0 ? -1 : 0;
  loads.torque_Nm = train_N * pose.per_rad_m + sense * contact.friction_ratio * cam_N * std::abs(at.sliding_m);
  return loads;
}

StaticStress static_stress(const ValveLift& lift, const ValveTrain& train, const CamContact& contact) {
  StaticStress found;
  if (!(contact.width_m > 0)) return found;
  const int from = static_cast<int>(std::floor(lift.opens_rad() * kDegPerRad * 100));
  const int to = static_cast<int>(std::ceil(lift.closes_rad() * kDegPerRad * 100));
  for (int i = from; i <= to; ++i) {
    const double rad = i * 0.01 * kRadPerDeg;
    const LiftPose pose = lift.at(rad);
    if (!(pose.lift_m > 0)) continue;
    const double train_N = train.valve.spring_preload_N + train.valve.spring_N_m * pose.lift_m;
    const double cam_N = train_N * pose.rocker_ratio;
    const double stress_Pa = hertz_contact(contact, lift.contact_at(rad).curvature_per_m, cam_N).largest_Pa;
    if (stress_Pa > found.largest_Pa) found = {stress_Pa, i * 0.01};
  }
  return found;
}

void CamLoadsOfCycle::add(double cam_deg, const CamLoads& loads) {
  if (began_) {
    const double turned_deg = std::abs(cam_deg - last_deg_);
    work_deg_ += (last_Nm_ + loads.torque_Nm) / 2 * turned_deg;
    turned_deg_ += turned_deg;
  }
  began_ = true, last_deg_ = cam_deg, last_Nm_ = loads.torque_Nm;
  if (loads.stress_Pa > stress_.value) stress_ = {loads.stress_Pa, cam_deg};
  if (loads.half_width_m > half_width_.value) half_width_ = {loads.half_width_m, cam_deg};
  if (loads.torque_Nm > largest_torque_.value) largest_torque_ = {loads.torque_Nm, cam_deg};
  if (loads.torque_Nm < least_torque_.value) least_torque_ = {loads.torque_Nm, cam_deg};
  if (std::abs(loads.sliding_m_s) > std::abs(sliding_.value)) sliding_ = {loads.sliding_m_s, cam_deg};
  const bool touches = loads.sliding_m_s != 0 || loads.entrainment_m_s != 0;
  if (touches && (!in_contact_ || loads.entrainment_m_s < least_entrainment_.value))
    least_entrainment_ = {loads.entrainment_m_s, cam_deg};
  if (touches && (!in_contact_ || loads.entrainment_m_s > largest_entrainment_.value))
    largest_entrainment_ = {loads.entrainment_m_s, cam_deg};
  in_contact_ = in_contact_ || touches;
  if (limit_Pa_ > 0 && loads.stress_Pa > limit_Pa_) {
    if (!passed_) passed_from_deg_ = cam_deg;
    passed_ = true, passed_to_deg_ = cam_deg;
  }
}

double CamLoadsOfCycle::mean_torque_Nm() const noexcept { return turned_deg_ > 0 ? work_deg_ / turned_deg_ : 0; }

std::string CamLoadsOfCycle::limit_in_words() const {
  if (!(limit_Pa_ > 0)) return "";
  const std::string limit = "limit_MPa = " + brief(limit_Pa_ / kPaPerMPa);
  if (!passed_) return ", below " + limit;
  const auto deg = [](double cam_deg) { return brief(std::round(cam_deg * 100) / 100); };
  return ", passes " + limit + " from " + deg(passed_from_deg_) + " to " + deg(passed_to_deg_) + " deg";
}

void add_cam_loads(Summary& s, const TrainOfFile& train, const StaticStress& at_rest, const CamLoadsOfCycle& cycle,
                   double cam_rad_s) {
  if (train.contact.width_m > 0) {
    s.line("contact_stress", cycle.stress().value / kPaPerMPa, "MPa",
           "largest, by Hertz, " + at_deg(cycle.stress().cam_deg) + cycle.limit_in_words());
    const bool passed = train.stress_limit_Pa > 0 && at_rest.largest_Pa > train.stress_limit_Pa;
    s.line("static_contact_stress", at_rest.largest_Pa / kPaPerMPa, "MPa",
           "of rigid parts at standstill, " + at_deg(at_rest.cam_deg) + (passed ? ", passes limit_MPa" : ""));
    s.line("contact_half_width", cycle.half_width().value * 1e6, "um", "largest");
  } else {
    s.line("contact_stress", "none", "", "[cam " + train.name + "] has no width_mm");
  }
  s.line("sliding_speed", cycle.sliding().value, "m/s",
         "fastest between cam and follower, " + at_deg(cycle.sliding().cam_deg));
  const CamLoadsOfCycle::At& least = cycle.least_entrainment();
  const CamLoadsOfCycle::At& largest = cycle.largest_entrainment();
  s.line("entrainment_speed", least.value, "m/s",
         "least, " + at_deg(least.cam_deg) + "; largest " + brief(largest.value) + " m/s " + at_deg(largest.cam_deg) +
             (least.value < 0 && largest.value > 0 ? "; where it passes 0 no film is drawn in" : ""));
  s.line("cam_torque", cycle.largest_torque().value, "Nm",
         "largest of one cam, " + at_deg(cycle.largest_torque().cam_deg) + "; least " +
             brief(cycle.least_torque().value) + " Nm " + at_deg(cycle.least_torque().cam_deg));
  s.line("drive_power", cycle.mean_torque_Nm() * cam_rad_s, "W",
         train.contact.friction_ratio > 0 ? "mean of one cam, with friction of " + brief(train.contact.friction_ratio)
                                          : "mean of one cam: losses of train, guide and seat; no friction_ratio");
}

}  // namespace crankloop::program

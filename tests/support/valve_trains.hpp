// Valve trains that tests share.
#pragma once

#include <crankloop/define/valve_train.hpp>

#include <initializer_list>

#include <gtest/gtest.h>

#include <crankloop/tabulate/valve_lift.hpp>

#include "lab/reference/ohc_125.hpp"
#include "support/random.hpp"

namespace crankloop::support {

inline Cam polynomial_cam(double max_lift_m, double half_angle_deg, std::initializer_list<double> exponents) {
  Cam cam;
  cam.max_lift_m = max_lift_m;
  cam.half_angle_deg = half_angle_deg;
  for (const double p : exponents) cam.exponents[cam.exponent_count++] = p;
  return cam;
}

/// The 125 cm^3 overhead-cam engine of [Li 2017]: tools/engines/ohc_125.ini.
inline Cam ohc_125_cam() {
  Cam cam;
  Rocker rocker;
  program::shape_as_ohc_125(cam, rocker);
  return cam;
}

inline Rocker ohc_125_rocker(CamTurns turns = CamTurns::toward_pivot) {
  Cam cam;
  Rocker rocker;
  program::shape_as_ohc_125(cam, rocker);
  rocker.clearance_m = 0.05e-3;
  rocker.cam_turns = turns;
  return rocker;
}

/// The valve of the 125 cm^3 engine [Li 2017], with what its print leaves open as docs/model.md assumes it.
inline Valve ohc_125_valve() {
  Valve valve;
  valve.valve_kg = 0.033;
  valve.spring_kg = 0.06;
  valve.rocker_inertia_kg_m2 = 8.12e-6;
  valve.spring_N_m = 40e3;
  valve.spring_preload_N = 205.8;
  valve.train_N_m = 1000 / 0.085e-3;
  valve.train_damping_ratio = 0.10;
  valve.guide_damping_ratio = 0.003;
  valve.seat_N_m = 1e8;
  valve.seat_damping_ratio = 0.10;
  return valve;
}

/// The whole train of the 125 cm^3 engine; full lift at 450 deg of the crank, half way through the intake stroke.
inline ValveTrain ohc_125_train() {
  ValveTrain train;
  train.cam = ohc_125_cam();
  train.cam.full_lift_deg = 450;
  train.rocker = ohc_125_rocker();
  train.valve = ohc_125_valve();
  return train;
}

inline Rocker direct_rocker(double base_circle_m, double clearance_m, double ratio = 1) {
  Rocker rocker;
  rocker.kind = RockerKind::ratio;
  rocker.base_circle_m = base_circle_m;
  rocker.clearance_m = clearance_m;
  rocker.ratio = ratio;
  return rocker;
}

/// Cams and rockers of cars and motorcycles; not every one of them can turn.
inline Cam random_cam(Random& random) {
  const double first = random.between(2, 2.5);
  const double second = first + random.between(3, 9);
  const double third = second + random.between(3, 9);
  return polynomial_cam(random.between(3e-3, 9e-3), random.between(55, 85),
                        {first, second, third, third + random.between(3, 9)});
}

inline Rocker random_rocker(Random& random) {
  Rocker rocker = ohc_125_rocker(random.coin() ? CamTurns::toward_pivot : CamTurns::away_from_pivot);
  rocker.base_circle_m = random.between(14e-3, 18e-3);
  rocker.clearance_m = random.between(0, 0.3e-3);
  rocker.pad_radius_m = random.between(8e-3, 40e-3);
  rocker.pivot_to_pad_m = random.between(35e-3, 50e-3);
  rocker.pivot_to_cam_m = random.between(28e-3, 45e-3);
  rocker.pivot_to_screw_m = random.between(28e-3, 45e-3);
  rocker.screw_ball_m = random.between(3e-3, 10e-3);
  rocker.stem_above_pivot_m = random.between(-8e-3, 5e-3);
  return rocker;
}

/// Calls for some random trains that can turn: call(cam, rocker, lift, trace).
template <class Call>
void each_random_train(Random& random, int trains, const Call& call) {
  for (int draw = 0; trains > 0; ++draw) {
    ASSERT_LT(draw, 500) << "most draws are refused";
    const Cam cam = random_cam(random);
    const Rocker rocker = random_rocker(random);
    ValveLift lift;
    if (!lift.init(cam, rocker).ok()) continue;
    --trains;
    call(cam, rocker, lift, random.trace(draw));
  }
}

}  // namespace crankloop::support

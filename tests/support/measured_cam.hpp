// A cam as an instrument measures it: rows of a true one, with rounding, noise and misread rows.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <crankloop/tabulate/cam_profile.hpp>

#include "support/random.hpp"
#include "support/status.hpp"
#include "support/units.hpp"

namespace crankloop::support {

inline CamProfile profile_of(const Cam& cam) {
  CamProfile profile;
  EXPECT_TRUE(accepted(profile.init(cam)));
  return profile;
}

/// A cam measured from `from_deg` to `to_deg`, with what the instrument adds.
struct Measured {
  std::vector<CamPoint> points;

  Measured(const CamProfile& cam, double from_deg, double to_deg, double step_deg) {
    for (int i = 0; from_deg + i * step_deg <= to_deg + 1e-9; ++i) {
      const double deg = from_deg + i * step_deg;
      points.push_back({deg, cam.at(deg * kRadPerDeg).lift_m});
    }
  }
  Measured& rounded_to(double unit_m) {
    for (CamPoint& point : points) point.lift_m = std::round(point.lift_m / unit_m) * unit_m;
    return *this;
  }
  Measured& off_by_up_to(double noise_m, Random& random) {
    for (CamPoint& point : points) point.lift_m += random.between(-noise_m, noise_m);
    return *this;
  }
  /// Normal noise of standard deviation sigma: the sum of twelve uniform numbers has variance 1.
  Measured& off_by_normal(double sigma_m, Random& random) {
    for (CamPoint& point : points) {
      double sum = -6;
      for (int i = 0; i < 12; ++i) sum += random.between(0, 1);
      point.lift_m += sigma_m * sum;
    }
    return *this;
  }
  [[nodiscard]] Cam cam(double smoothing_m) const {
    Cam cam;
    cam.source = CamSource::table;
    cam.points = points.data();
    cam.point_count = static_cast<int>(points.size());
    cam.smoothing_m = smoothing_m;
    return cam;
  }
  [[nodiscard]] double residual_m(const CamProfile& smooth) const {
    double largest = 0;
    for (const CamPoint& point : points) {
      largest = std::max(largest,
                         std::fabs(point.lift_m - smooth.at((point.cam_deg - smooth.peak_deg()) * kRadPerDeg).lift_m));
    }
    return largest;
  }
};

}  // namespace crankloop::support

// What a cycle of the reference's motion was, and the textbook method to compare with.
//
// What belongs here: the record of a cycle by the rules of docs/model.md, one textbook step. What does not: the
// reference itself (tools/lab/reference/valve_reference.hpp, which the benchmark measures against too), the valves it
// is run on.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "crankloop/loops/textbook_valve.hpp"
#include "lab/reference/valve_reference.hpp"

namespace crankloop::valve_test {

using namespace valve_reference;  // NOLINT: one vocabulary for tests

/// What a cycle was, by the rules of docs/model.md "Separation and bounce", from the reference's moments: all of one
/// cycle, from rest.
struct ReferenceCycle {
  double largest_lift_m = 0, largest_speed_m_s = 0, largest_acceleration_m_s2 = 0;
  double opening_delay_deg = 0;
  double separation_clearance_m = 0, separation_start_deg = 0, separation_duration_deg = 0;
  double seating_speed_m_s = 0;
  double bounce_height_m = 0;
  double nearest_to_threshold_m = 1;  ///< how far the nearest gap or hop is from the 1 um that count
  int separations = 0, bounces = 0;
};

namespace of_a_cycle {

/// A cubic through two values and slopes over a step of length h.
struct Cubic {
  double from, slope_from, to, slope_to, h;
  [[nodiscard]] double at(double x) const {
    const double rise = to - from;
    const double a = slope_from * h;
    const double b = slope_to * h;
    return from + x * (a + x * ((3 * rise - 2 * a - b) + x * (a + b - 2 * rise)));
  }
  [[nodiscard]] double largest() const {
    double best = std::max(from, to);
    if (slope_from > 0 && slope_to < 0) {
      double low = 0;
      double high = 1;
      for (int i = 0; i < 60; ++i) {  // golden section would do; thirds are simpler
        const double left = low + (high - low) / 3;
        const double right = high - (high - low) / 3;
        (at(left) < at(right) ? low : high) = at(left) < at(right) ? left : right;
      }
      best = std::max(best, at((low + high) / 2));
    }
    return best;
  }
  [[nodiscard]] double crossing(double level) const {
    double low = 0;
    double high = 1;
    for (int i = 0; i < 60; ++i) (((at((low + high) / 2) > level) == (to > level)) ? high : low) = (low + high) / 2;
    return high;
  }
};

}  // namespace of_a_cycle

[[nodiscard]] inline ReferenceCycle cycle_of(const std::vector<Moment>& all, const SingleMass& mass) {
  constexpr double kOpen_m = 0.1e-3;
  constexpr double kLeast_m = 1e-6;
  ReferenceCycle cycle;
  double theory_opened = 0, opened = 0;
  bool theory_is_open = false, is_open = false, lift_has_peaked = false, seated = false;
  bool floating = false, in_air = false;
  double gap = 0, hop = 0, floats_since = 0;
  const auto near_threshold = [&](double x) {
    cycle.nearest_to_threshold_m = std::min(cycle.nearest_to_threshold_m, std::fabs(x - kLeast_m));
  };
  const auto end_float = [&](double deg) {
    floating = false;
    near_threshold(gap);
    if (gap < kLeast_m) return;
    ++cycle.separations;
    if (gap > cycle.separation_clearance_m) {
      cycle.separation_clearance_m = gap;
      cycle.separation_start_deg = floats_since;
      cycle.separation_duration_deg = std::fabs(deg - floats_since);
    }
  };
  const auto end_hop = [&] {
    in_air = false;
    near_threshold(hop);
    if (hop < kLeast_m) return;
    ++cycle.bounces;
    cycle.bounce_height_m = std::max(cycle.bounce_height_m, hop);
  };
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Moment& a = all[i - 1];
    const Moment& b = all[i];
    const double h = b.t - a.t;
    const of_a_cycle::Cubic y{a.y, a.v, b.y, b.v, h};
    const of_a_cycle::Cubic Y{a.Y, a.Yd, b.Y, b.Yd, h};
    const of_a_cycle::Cubic apart{a.y - a.Y, a.v - a.Yd, b.y - b.Y, b.v - b.Yd, h};
    cycle.largest_lift_m = std::max(cycle.largest_lift_m, y.largest());
    cycle.largest_speed_m_s = std::max(cycle.largest_speed_m_s, std::fabs(b.v));
    cycle.largest_acceleration_m_s2 = std::max({cycle.largest_acceleration_m_s2, std::fabs(b.a), std::fabs(b.a_after)});
    if (!theory_is_open && a.Y < kOpen_m && b.Y >= kOpen_m) {
      theory_is_open = true;
      theory_opened = a.cam_deg + (b.cam_deg - a.cam_deg) * Y.crossing(kOpen_m);
    }
    if (theory_is_open && !is_open && b.y >= kOpen_m) {
      is_open = true;
      opened = a.cam_deg + (b.cam_deg - a.cam_deg) * y.crossing(kOpen_m);
      cycle.opening_delay_deg = std::fabs(opened - theory_opened);
    }
    if (a.Yd > 0 && b.Yd <= 0 && b.Y > 0) lift_has_peaked = true;
    const bool on_seat = (b.regime & 2) != 0;
    if (is_open && lift_has_peaked && !seated && on_seat && (a.regime & 2) == 0) {
      seated = true;
      cycle.seating_speed_m_s = -a.v;
    }
    const bool free_of_both = b.regime == 0 && std::max(a.y, b.y) > mass.delta;
    if (free_of_both && !seated) {
      if (!floating) floating = true, gap = 0, floats_since = a.cam_deg;
      gap = std::max(gap, apart.largest());
    } else if (floating) {
      end_float(a.cam_deg);
    }
    if (seated && !on_seat) {
      if (!in_air) in_air = true, hop = 0;
      hop = std::max(hop, y.largest() - mass.delta);
    } else if (in_air) {
      end_hop();
    }
  }
  if (floating) end_float(all.back().cam_deg);
  if (in_air) end_hop();
  return cycle;
}

/// Four-stage Runge-Kutta as every textbook has it [Li 2017, 4.9-4.13]: contacts tested at each stage, the cam looked
/// up at each.
inline void textbook_step(const SingleMass& m, const std::function<CamAt(double part)>& cam, double d, double& y,
                          double& v) {
  const auto f = [&](double part, double y_m, double v_m_s) {
    const CamAt at = cam(part);
    const Acting forces = acting(m, y_m, v_m_s, at.Y, at.Yd);
    return (forces.train_N + forces.seat_N - m.k_s * y_m - m.P - m.c * v_m_s) / m.M;
  };
  const detail::ValveState<double> s =
      program::textbook_step([&](int half, double y_m, double v_m_s) { return f(0.5 * half, y_m, v_m_s); }, d,
                             detail::ValveState<double>{y, v});
  y = s.lift_m;
  v = s.velocity_m_s;
}

}  // namespace crankloop::valve_test

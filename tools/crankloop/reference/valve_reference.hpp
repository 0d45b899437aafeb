// A valve's true motion, by other means than the library's: implicit Gauss collocation of order ten on the exact cam,
// contact changes bisected to rounding, steps so short that the method's error is below rounding. Written from
// docs/model.md, without the library's step code.
//
// What belongs here: the reference, its record of a cycle, the textbook method to compare with. What does not: the
// valves it is run on.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <crankloop/define/valve_train.hpp>
#include <crankloop/tabulate/valve_lift.hpp>

namespace crankloop::valve_test {

/// The single-mass model's constants, from the definition by the printed formulas.
struct SingleMass {
  double M = 0, k = 0, b = 0, k_z = 0, b_z = 0, k_s = 0, c = 0, P = 0, delta = 0;
  double rocker_kg = 0;

  SingleMass() = default;
  SingleMass(const Valve& v, const Rocker& r, double largest_lift_m) {
    if (v.rocker_inertia_kg_m2 > 0) {
      double lever = r.pivot_to_screw_m;
      if (r.kind == RockerKind::circular_pad) {
        const double seated = (r.screw_ball_m + r.stem_above_pivot_m) / r.pivot_to_screw_m;
        const double at_base = (r.screw_ball_m + r.clearance_m + r.stem_above_pivot_m) / r.pivot_to_screw_m;
        const double open = at_base - (largest_lift_m + r.clearance_m) / r.pivot_to_screw_m;
        lever = r.pivot_to_screw_m * (std::sqrt(1 - seated * seated) + std::sqrt(1 - open * open)) / 2;
      }
      rocker_kg = v.rocker_inertia_kg_m2 / (lever * lever);
    }
    M = v.valve_kg + v.spring_kg / 3 + rocker_kg;
    k = v.train_N_m;
    k_z = v.seat_N_m;
    k_s = v.spring_N_m;
    b = 2 * v.train_damping_ratio * std::sqrt(k * M);
    c = 2 * v.guide_damping_ratio * std::sqrt(k * M);
    b_z = 2 * v.seat_damping_ratio * std::sqrt(k_z * M);
    P = v.spring_preload_N;
    delta = P / k_z;
  }

  /// Fastest rate of all regimes, decay included.
  [[nodiscard]] double fastest() const {
    const auto rate = [this](double stiffness, double damping) {
      const double w = std::sqrt(stiffness / M);
      const double zeta = damping / (2 * M * w);
      return zeta <= 1 ? w : w * (zeta + std::sqrt(zeta * zeta - 1));
    };
    return std::max({rate(k_s + k + k_z, c + b + b_z), rate(k_s + k_z, c + b_z), rate(k_s + k, c + b)});
  }
};

/// What acts on a valve at a moment.
struct Acting {
  double train_N, seat_N;
  bool train, seat;
};

[[nodiscard]] inline Acting acting(const SingleMass& m, double y, double v, double Y, double Yd) {
  const double gap = Y - y;
  const double sink = m.delta - y;
  const double train = m.k * gap + m.b * (Yd - v);
  const double seat = m.k_z * sink - m.b_z * v;
  const bool on_train = gap > 0 && train > 0;
  const bool on_seat = sink > 0 && seat > 0;
  return {on_train ? train : 0, on_seat ? seat : 0, on_train, on_seat};
}

/// The cam's lift and its speed at a moment.
struct CamAt {
  double Y, Yd;
};

/// A cam that the reference turns: lift and slope by the cam angle, and the angles where its higher derivatives jump.
struct TurnedCam {
  struct Pose {
    double lift_m, per_deg_m;
  };
  std::function<Pose(double cam_deg)> at;
  std::vector<double> edges_deg;

  /// The exact one. `lift` must live as long as this.
  explicit TurnedCam(const ValveLift& lift)
      : at{[&lift](double deg) {
          const LiftPose pose = lift.at(deg * kDeg);
          return Pose{pose.lift_m, pose.per_rad_m * kDeg};
        }},
        edges_deg{lift.opens_rad() / kDeg, lift.closes_rad() / kDeg} {}
  TurnedCam(std::function<Pose(double)> lift, std::vector<double> edges)
      : at{std::move(lift)}, edges_deg{std::move(edges)} {}

  static constexpr double kDeg = 3.14159265358979323846 / 180;
};

/// A moment of the reference's motion.
struct Moment {
  double t, cam_deg;  ///< cam_deg counts on beyond 180
  double y, v;
  double a, a_after;  ///< acceleration before and after it: different where a damper's force jumps
  double Y, Yd;
  std::uint32_t regime;  ///< before it: of the piece that ends here
};

class Reference {
 public:
  static constexpr int kStages = 5;

  /// `finer` divides the steps, to show that the reference has converged.
  Reference(const SingleMass& mass, TurnedCam cam, double finer = 1)
      : mass_{mass}, cam_{std::move(cam)}, step_s_{0.4 / mass.fastest() / finer} {
    make_collocation();
  }

  double y = 0;
  double v = 0;
  double gas_N = 0;
  std::uint32_t regime = 2;
  int changes = 0;
  double train_Ns = 0, seat_Ns = 0,
         spring_Ns = 0;  ///< impulses since the start, of the train, the seat, and of all else
  bool keep_moments = false;
  std::vector<Moment> moments;

  /// The cam turns evenly from one angle to the other in `span_s`.
  void advance(double span_s, double from_deg, double to_deg) {
    const double per_s = (to_deg - from_deg) / span_s;
    if (rests(from_deg, to_deg)) {
      y = v = 0;
      t_ += span_s;
      return;
    }
    std::vector<double> ends{1};
    for (const double edge : cam_.edges_deg) {
      if (to_deg == from_deg) break;  // a cam that stands passes no edge
      for (double turn = std::floor((std::min(from_deg, to_deg) - edge) / 360) * 360; turn < 720; turn += 360) {
        const double part = (edge + turn - from_deg) / (to_deg - from_deg);
        if (part > 0 && part < 1) ends.push_back(part);
        if (edge + turn > std::max(from_deg, to_deg)) break;
      }
    }
    std::sort(ends.begin(), ends.end());
    double at = 0;
    for (const double end : ends) {
      const double piece_s = (end - at) * span_s;
      const double most_deg = std::fabs(per_s) * step_s_ > 0.25 ? 0.25 / std::fabs(per_s) : step_s_;
      const int n = static_cast<int>(std::ceil(piece_s / most_deg));
      for (int i = 0; i < n; ++i) {
        const double begin_deg = from_deg + (to_deg - from_deg) * (at + (end - at) * i / n);
        piece(piece_s / n, begin_deg, per_s);
      }
      at = end;
    }
  }

  [[nodiscard]] const SingleMass& mass() const { return mass_; }
  [[nodiscard]] CamAt cam(double deg, double deg_per_s) const {
    const TurnedCam::Pose pose = cam_.at(deg);
    return {pose.lift_m, pose.per_deg_m * deg_per_s};
  }
  [[nodiscard]] double acceleration(const CamAt& at, double y_m, double v_m_s, std::uint32_t in_regime) const {
    double force = -mass_.k_s * y_m - mass_.P - mass_.c * v_m_s - gas_N;
    if ((in_regime & 1) != 0) force += mass_.k * (at.Y - y_m) + mass_.b * (at.Yd - v_m_s);
    if ((in_regime & 2) != 0) force += mass_.k_z * (mass_.delta - y_m) - mass_.b_z * v_m_s;
    return force / mass_.M;
  }

 private:
  /// Closed, still to 1e-20 m, and the lash open all the while (by its ends: callers advance by less than the base
  /// circle).
  [[nodiscard]] bool rests(double from_deg, double to_deg) const {
    if (keep_moments || gas_N != 0 || regime != 2 || std::fabs(y) > 1e-20 || std::fabs(v) > 1e-16) return false;
    return std::fabs(to_deg - from_deg) < 10 && cam_.at(from_deg).lift_m < -1e-8 && cam_.at(to_deg).lift_m < -1e-8;
  }

  void make_collocation() {
    const double r = 2 * std::sqrt(10.0 / 7);
    const double inner = std::sqrt(5 - r) / 3;
    const double outer = std::sqrt(5 + r) / 3;
    const double x[kStages] = {-outer, -inner, 0, inner, outer};
    const double w_inner = (322 + 13 * std::sqrt(70.0)) / 900;
    const double w_outer = (322 - 13 * std::sqrt(70.0)) / 900;
    const double w[kStages] = {w_outer, w_inner, 128.0 / 225, w_inner, w_outer};
    for (int i = 0; i < kStages; ++i) c_[i] = (1 + x[i]) / 2, weight_[i] = w[i] / 2;
    for (int i = 0; i < kStages; ++i) {
      for (int j = 0; j < kStages;
           ++j) {  // integral of the Lagrange polynomial j from 0 to c_i: the rule itself is exact for it
        double sum = 0;
        for (int q = 0; q < kStages; ++q) {
          double lagrange = 1;
          for (int n = 0; n < kStages; ++n) {
            if (n != j) lagrange *= (c_[i] * c_[q] - c_[n]) / (c_[j] - c_[n]);
          }
          sum += weight_[q] * lagrange;
        }
        a_[i][j] = c_[i] * sum;
      }
    }
  }

  struct Trial {
    double y, v;
    double stage_y[kStages], stage_v[kStages];
    CamAt stage_cam[kStages];
    double train_Ns, seat_Ns, other_Ns;
  };

  /// One step of length h from the present state in the present regime.
  [[nodiscard]] Trial collocate(double h, double from_deg, double per_s) const {
    Trial s{};
    double slope[kStages];
    for (int i = 0; i < kStages; ++i) {
      s.stage_cam[i] = cam(from_deg + per_s * h * c_[i], per_s);
      slope[i] = acceleration(s.stage_cam[i], y, v, regime);
    }
    for (int iteration = 0; iteration < 60; ++iteration) {
      double moved = 0;
      for (int i = 0; i < kStages; ++i) {
        double vi = v;
        for (int j = 0; j < kStages; ++j) vi += h * a_[i][j] * slope[j];
        s.stage_v[i] = vi;
      }
      for (int i = 0; i < kStages; ++i) {
        double yi = y;
        for (int j = 0; j < kStages; ++j) yi += h * a_[i][j] * s.stage_v[j];
        moved = std::max(moved, std::fabs(yi - s.stage_y[i]));
        s.stage_y[i] = yi;
      }
      for (int i = 0; i < kStages; ++i) slope[i] = acceleration(s.stage_cam[i], s.stage_y[i], s.stage_v[i], regime);
      if (iteration > 1 && moved <= 1e-19) break;
    }
    s.y = y, s.v = v;
    for (int i = 0; i < kStages; ++i) {
      s.y += h * weight_[i] * s.stage_v[i];
      s.v += h * weight_[i] * slope[i];
      const double train =
          (regime & 1) != 0 ? mass_.k * (s.stage_cam[i].Y - s.stage_y[i]) + mass_.b * (s.stage_cam[i].Yd - s.stage_v[i])
                            : 0;
      const double seat = (regime & 2) != 0 ? mass_.k_z * (mass_.delta - s.stage_y[i]) - mass_.b_z * s.stage_v[i] : 0;
      s.train_Ns += h * weight_[i] * train;
      s.seat_Ns += h * weight_[i] * seat;
      s.other_Ns += h * weight_[i] * (mass_.M * slope[i] - train - seat);
    }
    return s;
  }

  [[nodiscard]] std::uint32_t regime_of(const CamAt& at, double y_m, double v_m_s) const {
    const Acting forces = acting(mass_, y_m, v_m_s, at.Y, at.Yd);
    return (forces.train ? 1u : 0u) | (forces.seat ? 2u : 0u);
  }

  void take(const Trial& trial, double h, double from_deg, double per_s) {
    y = trial.y, v = trial.v;
    train_Ns += trial.train_Ns, seat_Ns += trial.seat_Ns, spring_Ns += trial.other_Ns;
    t_ += h;
    if (keep_moments) {
      const CamAt at = cam(from_deg + per_s * h, per_s);
      moments.push_back({t_, from_deg + per_s * h, y, v, acceleration(at, y, v, regime),
                         acceleration(at, y, v, regime_of(at, y, v)), at.Y, at.Yd, regime});
    }
  }

  /// A short stretch: whole if no contact changes, else up to the change and on.
  void piece(double h, double from_deg, double per_s) {
    for (int guard = 0; guard < 1000 && h > 0; ++guard) {
      const Trial whole = collocate(h, from_deg, per_s);
      double low = 0;
      double high = -1;
      for (int i = 0; i < kStages && high < 0; ++i) {
        (regime_of(whole.stage_cam[i], whole.stage_y[i], whole.stage_v[i]) == regime ? low : high) = c_[i] * h;
      }
      if (high < 0 && regime_of(cam(from_deg + per_s * h, per_s), whole.y, whole.v) != regime) high = h;
      if (high < 0) return take(whole, h, from_deg, per_s);
      for (int i = 0; i < 60 && high - low > 1e-17 * h; ++i) {
        const double middle = (low + high) / 2;
        if (middle <= low || middle >= high) break;
        const Trial part = collocate(middle, from_deg, per_s);
        (regime_of(cam(from_deg + per_s * middle, per_s), part.y, part.v) == regime ? low : high) = middle;
      }
      const Trial part = collocate(high, from_deg, per_s);
      take(part, high, from_deg, per_s);
      const std::uint32_t next = regime_of(cam(from_deg + per_s * high, per_s), y, v);
      changes += next != regime ? 1 : 0;
      regime = next;
      from_deg += per_s * high;
      h -= high;
    }
  }

  SingleMass mass_;
  TurnedCam cam_;
  double step_s_;
  double t_ = 0;
  double c_[kStages], weight_[kStages], a_[kStages][kStages];
};

/// What a cycle was, by the rules of docs/model.md "Separation and bounce", from the reference's moments: all of one
/// cycle, from rest.
struct ReferenceCycle {
  double largest_lift_m = 0, largest_speed_m_s = 0, largest_acceleration_m_s2 = 0;
  double opening_delay_deg = 0;
  double separation_gap_m = 0, separation_start_deg = 0, separation_duration_deg = 0;
  double seating_speed_m_s = 0;
  double bounce_height_m = 0;
  double nearest_to_threshold_m = 1;  ///< how far the nearest gap or hop is from the 1 um that count
  int separations = 0, bounces = 0;
};

namespace detail {

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

}  // namespace detail

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
    if (gap > cycle.separation_gap_m) {
      cycle.separation_gap_m = gap;
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
    const detail::Cubic y{a.y, a.v, b.y, b.v, h};
    const detail::Cubic Y{a.Y, a.Yd, b.Y, b.Yd, h};
    const detail::Cubic apart{a.y - a.Y, a.v - a.Yd, b.y - b.Y, b.v - b.Yd, h};
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
  const double k1 = f(0, y, v);
  const double k2 = f(0.5, y + d / 2 * v, v + d / 2 * k1);
  const double k3 = f(0.5, y + d / 2 * v + d * d / 4 * k1, v + d / 2 * k2);
  const double k4 = f(1, y + d * v + d * d / 2 * k2, v + d * k3);
  y += d * v + d * d / 6 * (k1 + k2 + k3);
  v += d / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

}  // namespace crankloop::valve_test

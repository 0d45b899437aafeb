// A valve's reference motion, by other methods than the library's: implicit Gauss collocation of order ten on the exact
// cam, contact changes located by bisection to rounding, steps short enough that the method's error is below rounding.
// Written from docs/model.md, without the library's step code. Tests, the benchmark and the stress test measure errors
// against it.
//
// What belongs here: the reference. What does not: the valves it is run on, results of a cycle
// (tests/support/valve_reference.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <crankloop/define/valve_train.hpp>
#include <crankloop/tabulate/valve_lift.hpp>

#include "crankloop/files/units.hpp"

namespace crankloop::valve_reference {

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

/// The forces on a valve at one time.
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

  static constexpr double kDeg = program::kRadPerDeg;
};

/// A moment of the reference's motion.
struct Moment {
  double t, cam_deg;  ///< cam_deg continues beyond 180
  double y, v;
  double a, a_after;  ///< acceleration just before and after: they differ where a damper's force jumps
  double Y, Yd;
  std::uint32_t regime;  ///< of the piece that ends here
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
         spring_Ns = 0;  ///< impulses since the start: of the train, the seat, and all other forces
  double cam_J = 0,
         lost_J = 0;  ///< work since the start: of the cam on the train, and what train, guide and seat lost of it
  bool keep_moments = false;
  std::vector<Moment> moments;

  /// Advances by `span_s`, with the cam turning at constant speed from one angle to the other.
  void advance(double span_s, double from_deg, double to_deg) {
    const double per_s = (to_deg - from_deg) / span_s;
    if (rests(from_deg, to_deg)) {
      y = v = 0;
      t_ += span_s;
      return;
    }
    std::vector<double> ends{1};
    for (const double edge : cam_.edges_deg) {
      if (to_deg == from_deg) break;  // a cam at rest passes no edge
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

  /// Energy of the mass, of the spring beyond its preload, and of the contacts that are on.
  [[nodiscard]] double energy_J(double cam_deg) const {
    return mass_.M * v * v / 2 + mass_.k_s * y * y / 2 + mass_.P * y + held_J(cam(cam_deg, 0), regime);
  }

 private:
  /// Whether the valve is closed and at rest to 1e-20 m, and the lash stays open (checked at both ends: callers advance
  /// by less than the base circle).
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
    double cam_J, lost_J;
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
      s.cam_J += h * weight_[i] * train * s.stage_cam[i].Yd;
      s.lost_J += h * weight_[i] * lost_W(s.stage_cam[i], s.stage_v[i]);
    }
    return s;
  }

  [[nodiscard]] std::uint32_t regime_of(const CamAt& at, double y_m, double v_m_s) const {
    const Acting forces = acting(mass_, y_m, v_m_s, at.Y, at.Yd);
    return (forces.train ? 1u : 0u) | (forces.seat ? 2u : 0u);
  }

  /// Power that the dampers of the contacts that are on take, and the guide.
  [[nodiscard]] double lost_W(const CamAt& at, double v_m_s) const {
    const double train = (regime & 1) != 0 ? mass_.b * (at.Yd - v_m_s) * (at.Yd - v_m_s) : 0;
    const double seat = (regime & 2) != 0 ? mass_.b_z * v_m_s * v_m_s : 0;
    return train + seat + mass_.c * v_m_s * v_m_s;
  }
  /// What the springs of some contacts hold: a contact that ends while its damper still pulls loses it.
  [[nodiscard]] double held_J(const CamAt& at, std::uint32_t contacts) const {
    const double train = (contacts & 1) != 0 ? mass_.k * (at.Y - y) * (at.Y - y) / 2 : 0;
    const double seat = (contacts & 2) != 0 ? mass_.k_z * (mass_.delta - y) * (mass_.delta - y) / 2 : 0;
    return train + seat;
  }

  void take(const Trial& trial, double h, double from_deg, double per_s) {
    y = trial.y, v = trial.v;
    train_Ns += trial.train_Ns, seat_Ns += trial.seat_Ns, spring_Ns += trial.other_Ns;
    cam_J += trial.cam_J, lost_J += trial.lost_J;
    t_ += h;
    if (keep_moments) {
      const CamAt at = cam(from_deg + per_s * h, per_s);
      moments.push_back({t_, from_deg + per_s * h, y, v, acceleration(at, y, v, regime),
                         acceleration(at, y, v, regime_of(at, y, v)), at.Y, at.Yd, regime});
    }
  }

  /// A short span: in one step if no contact changes, else in two, to the change and from it.
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
      const CamAt there = cam(from_deg + per_s * high, per_s);
      const std::uint32_t next = regime_of(there, y, v);
      lost_J += held_J(there, regime & ~next) - held_J(there, next & ~regime);
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

}  // namespace crankloop::valve_reference

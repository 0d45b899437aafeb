// The gas of an engine by its differential equations, in textbook Runge-Kutta with pow(): shares no code with the
// library.
//
// docs/model.md "Gas": dm, dU, dm_b of every cylinder and both manifolds. Cams are the polynomial of the definition,
// valves follow them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <crankloop/define/engine_definition.hpp>

#include "support/gas_equations.hpp"
#include "support/units.hpp"

namespace crankloop::support {

class GasReference {
 public:
  GasReference(const EngineDefinition& engine, double speed_rad_s, double throttle_ratio_m2,
               OrificeLaw orifice = OrificeLaw::ellipse)
      : e_{engine},
        w_{speed_rad_s},
        throttle_m2_{throttle_ratio_m2},
        orifice_{orifice},
        walls_{engine, speed_rad_s},
        n_{static_cast<std::size_t>(engine.layout.cylinders)} {
    const Gas& g = e_.gas;
    const double r = e_.crank.crank_radius_m, bore = e_.crank.bore_m;
    area_ = kPi / 4 * bore * bore;
    swept_ = area_ * 2 * r;
    clearance_ = swept_ / (e_.crank.compression_ratio - 1);
    intake() = gas_filled(g.ambient_Pa, g.ambient_K, 0, g.intake_m3);
    const double back_Pa = g.back_Pa > 0 ? g.back_Pa : g.ambient_Pa;
    exhaust() = gas_filled(back_Pa, g.ambient_K, 0, g.exhaust_m3);
    outlet_ = {back_Pa, g.ambient_K, 0};
    for (std::size_t k = 0; k < n_; ++k) y_[k] = gas_filled(g.ambient_Pa, g.ambient_K, 0, volume(own_deg(k)));
    for (int t = 0; t < 2; ++t) solve_cam(e_.trains[t].cam, cam_[static_cast<std::size_t>(t)]);
    fuel_.assign(n_, 0.0), burning_.assign(n_, 1.0);
  }

  /// Manifolds that nothing changes, as a scene with Manifold::given has them.
  void hold_manifolds(const GasSeen& in, const GasSeen& out) {
    held_ = true;
    intake() = gas_filled(in.p, in.t, in.x, e_.gas.intake_m3);
    exhaust() = gas_filled(out.p, out.t, out.x, e_.gas.exhaust_m3);
  }
  /// At rest, where the crank stands at `deg`; cylinders anew from the intake manifold.
  void start_at(double deg) {
    deg_ = deg;
    const GasSeen in = gas_seen(intake(), e_.gas.intake_m3);
    for (std::size_t k = 0; k < n_; ++k) y_[k] = gas_filled(in.p, in.t, in.x, volume(own_deg(k)));
  }
  void turn_at(double speed_rad_s) { w_ = speed_rad_s, walls_ = WallHeat(e_, speed_rad_s); }

  /// Fourth order, except where a valve or a burn begins.
  void step(double h) {
    std::array<std::vector<GasVolume>, 4> k;
    // Fuel of a cycle, by the air there at -90 deg; the same in all stages.
    for (std::size_t c = 0; c < n_; ++c) {
      const double from = own_deg(c), to = wrapped(from + w_ * h * 180 / kPi);
      if (from < -90 && to >= -90) {
        const double most_kg = (y_[c].m - y_[c].b) / e_.gas.air_fuel_ratio;
        const double asked_kg = e_.gas.excess_air_ratio > 0 ? most_kg / e_.gas.excess_air_ratio : e_.gas.fuel_kg;
        fuel_[c] = std::fmin(asked_kg, 4 * most_kg);
        burning_[c] = fuel_[c] > most_kg ? most_kg / fuel_[c] : 1;
      }
      if (from > 0 && to < 0) fuel_[c] = 0;
    }
    const std::vector<GasVolume> from = y_;
    const GasSeen out = gas_seen(exhaust(), e_.gas.exhaust_m3);
    if (out.p > outlet_.p) outlet_.t = out.t, outlet_.x = out.x;
    const double angle = deg_;
    const double part[] = {0, 0.5, 0.5, 1};
    double work[4] = {}, air[4] = {};
    for (std::size_t i = 0; i < 4; ++i) {
      if (i > 0) {
        for (std::size_t v = 0; v < y_.size(); ++v) {
          y_[v] = {from[v].m + h * part[i] * k[i - 1][v].m, from[v].u + h * part[i] * k[i - 1][v].u,
                   from[v].b + h * part[i] * k[i - 1][v].b};
        }
      }
      deg_ = angle + part[i] * h * w_ * 180 / kPi;
      k[i].resize(y_.size());
      slopes(k[i], work[i], air[i]);
    }
    const auto mean = [&](double a, double b, double c, double d) { return h / 6 * (a + 2 * b + 2 * c + d); };
    for (std::size_t v = 0; v < y_.size(); ++v) {
      y_[v] = {from[v].m + mean(k[0][v].m, k[1][v].m, k[2][v].m, k[3][v].m),
               from[v].u + mean(k[0][v].u, k[1][v].u, k[2][v].u, k[3][v].u),
               from[v].b + mean(k[0][v].b, k[1][v].b, k[2][v].b, k[3][v].b)};
    }
    deg_ = angle + h * w_ * 180 / kPi;
    work_J_ += mean(work[0], work[1], work[2], work[3]);
    air_kg_ += mean(air[0], air[1], air[2], air[3]);
  }

  [[nodiscard]] double pressure(std::size_t k) const { return gas_seen(y_[k], volume(own_deg(k))).p; }
  [[nodiscard]] double temperature(std::size_t k) const { return gas_seen(y_[k], volume(own_deg(k))).t; }
  [[nodiscard]] double mass(std::size_t k) const { return y_[k].m; }
  [[nodiscard]] double burned(std::size_t k) const { return y_[k].b; }
  [[nodiscard]] double intake_Pa() const { return gas_seen(y_[n_], e_.gas.intake_m3).p; }
  [[nodiscard]] GasSeen exhaust_gas() const { return gas_seen(y_[n_ + 1], e_.gas.exhaust_m3); }
  [[nodiscard]] double work_J() const { return work_J_; }  ///< of cylinder 1 on its piston
  [[nodiscard]] double air_kg() const { return air_kg_; }  ///< into cylinder 1 through its intake
  [[nodiscard]] double own_deg(std::size_t k) const { return wrapped(deg_ - e_.layout.firing_deg[k]); }

  [[nodiscard]] double volume(double deg) const { return clearance_ + area_ * displacement(deg); }
  /// Effective, of a train's valves in the cylinder that fires at 0.
  [[nodiscard]] double area_of(std::size_t train, double deg) const {
    const Cam& cam = e_.trains[train].cam;
    const double u = std::fabs(wrapped(deg - cam.full_lift_deg)) / 2 / cam.half_angle_deg;
    if (u >= 1) return 0;
    double lift = 1;
    for (std::size_t i = 0; i < 4; ++i) lift += cam_[train][i] * std::pow(u, cam.exponents[i]);
    lift *= cam.max_lift_m;
    if (lift <= 1e-6) return 0;
    const PortOfTrain& port = e_.gas.ports[train];
    const double d = port.seat_diameter_m, x = lift / d;
    double alpha = port.flow_ratio[port.flow_count - 1];
    for (int i = 1; i < port.flow_count; ++i) {
      if (x <= port.flow_lift_ratio[i]) {
        const double part = (x - port.flow_lift_ratio[i - 1]) / (port.flow_lift_ratio[i] - port.flow_lift_ratio[i - 1]);
        alpha = port.flow_ratio[i - 1] + part * (port.flow_ratio[i] - port.flow_ratio[i - 1]);
        break;
      }
    }
    return e_.trains[train].valve.per_cylinder * kPi / 4 * d * d * alpha;
  }

 private:
  static double wrapped(double deg) { return deg - 720 * std::floor((deg + 360) / 720); }
  GasVolume& intake() { return y_.size() < n_ + 2 ? (y_.resize(n_ + 2), y_[n_]) : y_[n_]; }
  GasVolume& exhaust() { return y_[n_ + 1]; }

  [[nodiscard]] double displacement(double deg) const {
    const double r = e_.crank.crank_radius_m, l = e_.crank.rod_length_m, s = std::sin(deg * kPi / 180);
    return r + l - r * std::cos(deg * kPi / 180) - std::sqrt(l * l - r * r * s * s);
  }
  [[nodiscard]] double volume_slope(double deg) const {  // by radians
    const double r = e_.crank.crank_radius_m, l = e_.crank.rod_length_m, s = std::sin(deg * kPi / 180),
                 c = std::cos(deg * kPi / 180);
    return area_ * (r * s + r * r * s * c / std::sqrt(l * l - r * r * s * s));
  }

  /// y = max (1 + sum C_i u^p_i) with y = y' = y'' = y''' = 0 at u = 1: by Gauss.
  static void solve_cam(const Cam& cam, std::array<double, 4>& c) {
    double m[4][5];
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t i = 0; i < 4; ++i) {
        m[row][i] = 1;
        for (std::size_t d = 0; d < row; ++d) m[row][i] *= cam.exponents[i] - static_cast<double>(d);
      }
      m[row][4] = row == 0 ? -1 : 0;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        if (j == i) continue;
        const double f = m[j][i] / m[i][i];
        for (std::size_t k = i; k < 5; ++k) m[j][k] -= f * m[i][k];
      }
    }
    for (std::size_t i = 0; i < 4; ++i) c[i] = m[i][4] / m[i][i];
  }
  void slopes(std::vector<GasVolume>& dy, double& work, double& air) const {
    const Gas& g = e_.gas;
    for (GasVolume& v : dy) v = {0, 0, 0};
    const GasSeen in = gas_seen(y_[n_], g.intake_m3), ex = gas_seen(y_[n_ + 1], g.exhaust_m3);
    GasVolume outside{};
    gas_flow(orifice_, throttle_m2_, {g.ambient_Pa, g.ambient_K, 0}, in, outside, dy[n_]);
    gas_flow(orifice_, g.outlet_m2, ex, outlet_, dy[n_ + 1], outside);
    const double q = fuel_energy_J_kg(g);
    for (std::size_t k = 0; k < n_; ++k) {
      const double deg = own_deg(k), v = volume(deg);
      const GasSeen at = gas_seen(y_[k], v);
      gas_flow(orifice_, area_of(0, deg), in, at, dy[n_], dy[k]);
      if (k == 0) air = dy[k].m - dy[k].b;
      gas_flow(orifice_, area_of(1, deg), at, ex, dy[k], dy[n_ + 1]);
      const double burn = wiebe_slope((deg - g.burn_start_deg) / g.burn_duration_deg, g.wiebe_m) / g.burn_duration_deg;
      const double fuel = fuel_[k] * burn * w_ * 180 / kPi;
      const double power = at.p * volume_slope(deg) * w_;
      dy[k].m += fuel;
      const double r = burning_[k];  // of rich fuel; the rest becomes burned gas of 25 C
      dy[k].u += (r * q + (1 - r) * gas_energy(298.15, 1)) * fuel - walls_.W(at, v) - power;
      dy[k].b += (1 + r * g.air_fuel_ratio) * fuel;
      if (k == 0) work = power;
    }
    if (held_) dy[n_] = dy[n_ + 1] = {0, 0, 0};
  }

  EngineDefinition e_;
  double w_, throttle_m2_;
  OrificeLaw orifice_;
  WallHeat walls_;
  std::size_t n_;
  bool held_ = false;
  double area_, swept_, clearance_, deg_ = 0, work_J_ = 0, air_kg_ = 0;
  std::vector<GasVolume> y_;
  GasSeen outlet_{};                    ///< what flows back
  std::vector<double> fuel_, burning_;  ///< of a cycle: all of it, the share that its air burns
  std::array<std::array<double, 4>, 2> cam_{};
};

}  // namespace crankloop::support

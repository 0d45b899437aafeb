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

namespace crankloop::support {

class GasReference {
 public:
  struct Volume {
    double m, u, b;
  };
  enum class Orifice { ellipse, saint_venant };

  GasReference(const EngineDefinition& engine, double speed_rad_s, double throttle_ratio_m2,
               Orifice orifice = Orifice::ellipse)
      : e_{engine},
        w_{speed_rad_s},
        throttle_m2_{throttle_ratio_m2},
        orifice_{orifice},
        n_{static_cast<std::size_t>(engine.layout.cylinders)} {
    const Gas& g = e_.gas;
    const double r = e_.crank.crank_radius_m, bore = e_.crank.bore_m;
    area_ = kPi / 4 * bore * bore;
    swept_ = area_ * 2 * r;
    clearance_ = swept_ / (e_.crank.compression_ratio - 1);
    intake() = filled(g.ambient_Pa, g.ambient_K, 0, g.intake_m3);
    exhaust() = filled(g.ambient_Pa, g.exhaust_K, 1, g.exhaust_m3);
    for (std::size_t k = 0; k < n_; ++k) y_[k] = filled(g.ambient_Pa, g.ambient_K, 0, volume(own_deg(k)));
    for (int t = 0; t < 2; ++t) solve_cam(e_.trains[t].cam, cam_[static_cast<std::size_t>(t)]);
    fuel_.assign(n_, 0.0);
  }

  /// Fourth order, except where a valve or a burn begins.
  void step(double h) {
    std::array<std::vector<Volume>, 4> k;
    // Fuel of a cycle, by the air there at -90 deg; the same in all stages.
    for (std::size_t c = 0; c < n_; ++c) {
      const double from = own_deg(c), to = wrapped(from + w_ * h * 180 / kPi);
      if (from < -90 && to >= -90) fuel_[c] = std::fmin(e_.gas.fuel_kg, (y_[c].m - y_[c].b) / e_.gas.air_fuel_ratio);
      if (from > 0 && to < 0) fuel_[c] = 0;
    }
    const std::vector<Volume> from = y_;
    const double angle = deg_;
    const double part[] = {0, 0.5, 0.5, 1};
    double work[4] = {};
    for (std::size_t i = 0; i < 4; ++i) {
      if (i > 0) {
        for (std::size_t v = 0; v < y_.size(); ++v) {
          y_[v] = {from[v].m + h * part[i] * k[i - 1][v].m, from[v].u + h * part[i] * k[i - 1][v].u,
                   from[v].b + h * part[i] * k[i - 1][v].b};
        }
      }
      deg_ = angle + part[i] * h * w_ * 180 / kPi;
      k[i].resize(y_.size());
      slopes(k[i], work[i]);
    }
    const auto mean = [&](double a, double b, double c, double d) { return h / 6 * (a + 2 * b + 2 * c + d); };
    for (std::size_t v = 0; v < y_.size(); ++v) {
      y_[v] = {from[v].m + mean(k[0][v].m, k[1][v].m, k[2][v].m, k[3][v].m),
               from[v].u + mean(k[0][v].u, k[1][v].u, k[2][v].u, k[3][v].u),
               from[v].b + mean(k[0][v].b, k[1][v].b, k[2][v].b, k[3][v].b)};
    }
    deg_ = angle + h * w_ * 180 / kPi;
    work_J_ += mean(work[0], work[1], work[2], work[3]);
  }

  [[nodiscard]] double pressure(std::size_t k) const { return pressure_of(y_[k], volume(own_deg(k))); }
  [[nodiscard]] double temperature(std::size_t k) const { return temperature_of(y_[k]); }
  [[nodiscard]] double mass(std::size_t k) const { return y_[k].m; }
  [[nodiscard]] double burned(std::size_t k) const { return y_[k].b; }
  [[nodiscard]] double intake_Pa() const { return pressure_of(y_[n_], e_.gas.intake_m3); }
  [[nodiscard]] double work_J() const { return work_J_; }  ///< of cylinder 1 on its piston
  [[nodiscard]] double own_deg(std::size_t k) const { return wrapped(deg_ - e_.layout.firing_deg[k]); }

 private:
  static constexpr double kPi = 3.14159265358979323846, kR = 287.1, kB = 0.205;

  static double wrapped(double deg) { return deg - 720 * std::floor((deg + 360) / 720); }
  static double a(const Volume& v) { return 646 + 93 * v.b / v.m; }
  static double temperature_of(const Volume& v) {
    const double x = a(v);
    return (-x + std::sqrt(x * x + 2 * kB * v.u / v.m)) / kB;
  }
  static double pressure_of(const Volume& v, double volume) { return v.m * kR * temperature_of(v) / volume; }
  static Volume filled(double p, double t, double x, double volume) {
    const double m = p * volume / (kR * t);
    return {m, m * ((646 + 93 * x) * t + kB / 2 * t * t), m * x};
  }
  Volume& intake() { return y_.size() < n_ + 2 ? (y_.resize(n_ + 2), y_[n_]) : y_[n_]; }
  Volume& exhaust() { return y_[n_ + 1]; }

  [[nodiscard]] double displacement(double deg) const {
    const double r = e_.crank.crank_radius_m, l = e_.crank.rod_length_m, s = std::sin(deg * kPi / 180);
    return r + l - r * std::cos(deg * kPi / 180) - std::sqrt(l * l - r * r * s * s);
  }
  [[nodiscard]] double volume(double deg) const { return clearance_ + area_ * displacement(deg); }
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

  struct Gas_ {
    double p, t, x;
  };
  /// From 1 to 2 where positive; adds what it moves.
  void flow(double area, const Gas_& one, const Gas_& two, Volume& from, Volume& to) const {
    if (area == 0 || one.p == two.p) return;
    const bool forward = one.p > two.p;
    const Gas_& up = forward ? one : two;
    const double down = forward ? two.p : one.p;
    double psi;
    if (orifice_ == Orifice::ellipse) {
      const double s = std::fmin(1, (up.p - down) / (0.46488669399358847 * up.p));
      psi = 0.6778852870696124 * std::sqrt(s * (2 - s));
    } else {
      const double g = 1.36, ratio = std::fmax(down / up.p, std::pow(2 / (g + 1), g / (g - 1)));
      psi = std::sqrt(2 * g / (g - 1) * (std::pow(ratio, 2 / g) - std::pow(ratio, (g + 1) / g)));
    }
    const double w = (forward ? 1 : -1) * area * up.p / std::sqrt(kR * up.t) * psi;
    const double h = (646 + 93 * up.x) * up.t + kB / 2 * up.t * up.t + kR * up.t;
    from.m -= w, from.u -= w * h, from.b -= w * up.x;
    to.m += w, to.u += w * h, to.b += w * up.x;
  }
  static double wiebe(double s, double m) {
    if (s <= 0) return 0;
    if (s >= 1) return 1;
    return (1 - std::exp(-6.908 * std::pow(s, m + 1))) / (1 - std::exp(-6.908));
  }
  [[nodiscard]] double burn_slope(double deg) const {  // by degrees
    const double s = (deg - e_.gas.burn_start_deg) / e_.gas.burn_duration_deg, m = e_.gas.wiebe_m;
    if (s <= 0 || s >= 1) return 0;
    return 6.908 * (m + 1) * std::pow(s, m) * std::exp(-6.908 * std::pow(s, m + 1)) / (1 - std::exp(-6.908)) /
           e_.gas.burn_duration_deg;
  }

  void slopes(std::vector<Volume>& dy, double& work) const {
    const Gas& g = e_.gas;
    for (Volume& v : dy) v = {0, 0, 0};
    const auto gas = [](const Volume& v, double volume) {
      return Gas_{pressure_of(v, volume), temperature_of(v), v.b / v.m};
    };
    const Gas_ in = gas(y_[n_], g.intake_m3), ex = gas(y_[n_ + 1], g.exhaust_m3);
    Volume outside{};
    flow(throttle_m2_, {g.ambient_Pa, g.ambient_K, 0}, in, outside, dy[n_]);
    flow(g.outlet_m2, ex, {g.ambient_Pa, g.exhaust_K, 1}, dy[n_ + 1], outside);
    const double l = g.air_fuel_ratio;
    const auto e298 = [](double x) { return (646 + 93 * x) * 298.15 + kB / 2 * 298.15 * 298.15; };
    const double q = g.combustion_efficiency * g.heating_value_J_kg + (1 + l) * e298(1) - l * e298(0);
    const double piston = 2 * e_.crank.crank_radius_m * std::fabs(w_) / kPi;
    const double c = 130 * g.wall_heat_ratio * std::pow(piston + 1.4, 0.8) * std::pow(swept_ / 2, -0.06) * 1e-4;
    for (std::size_t k = 0; k < n_; ++k) {
      const double deg = own_deg(k), v = volume(deg);
      const Gas_ at = gas(y_[k], v);
      flow(area_of(0, deg), in, at, dy[n_], dy[k]);
      flow(area_of(1, deg), at, ex, dy[k], dy[n_ + 1]);
      const double fuel = fuel_[k] * burn_slope(deg) * w_ * 180 / kPi;
      const double wall =
          c * std::pow(at.p, 0.8) * std::pow(at.t, -0.4) * (2 * area_ + 4 * v / e_.crank.bore_m) * (at.t - g.wall_K);
      const double power = at.p * volume_slope(deg) * w_;
      dy[k].m += fuel;
      dy[k].u += q * fuel - wall - power;
      dy[k].b += (1 + l) * fuel;
      if (k == 0) work = power;
    }
  }

  EngineDefinition e_;
  double w_, throttle_m2_;
  Orifice orifice_;
  std::size_t n_;
  double area_, swept_, clearance_, deg_ = 0, work_J_ = 0;
  std::vector<Volume> y_;
  std::vector<double> fuel_;
  std::array<std::array<double, 4>, 2> cam_{};
};

}  // namespace crankloop::support

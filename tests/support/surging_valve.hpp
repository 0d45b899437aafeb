// A valve whose springs surge, by the coupled equations of valve and modes: classical Runge-Kutta in steps of 0.5 us,
// contacts as they stand at each stage. Written from docs/model.md "Spring surge", without the
// library's steps.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <crankloop/limits.hpp>

#include "support/units.hpp"
#include "support/valve_reference.hpp"

namespace crankloop::valve_test {

/// Valve and modes; the valve's moving mass is without what the modes move.
class SurgingValve {
 public:
  struct Mode {
    double rate_rad_s, damping_ratio, drive, force_N_m;  ///< q'' + 2 z w q' + w^2 q = drive y''
  };

  SurgingValve(const SingleMass& mass, TurnedCam cam) : mass_{mass}, cam_{std::move(cam)} {}

  /// A spring with one end fixed.
  void add_spring(double rate_N_m, double active_kg, double damping_ratio, int modes) {
    for (int n = 1; n <= modes; ++n) {
      const double sign = n % 2 == 0 ? 1 : -1;
      modes_.push_back({n * support::kPi * std::sqrt(rate_N_m / active_kg), damping_ratio,
                        2 * sign / (n * support::kPi), rate_N_m * n * support::kPi * sign});
      mass_.M -= 2 * active_kg / (support::kPi * support::kPi * n * n);
    }
  }

  void advance(double span_s, double from_deg, double to_deg) {
    const int steps = static_cast<int>(std::ceil(span_s / kStep_s));
    const double h = span_s / steps;
    const double per_s = (to_deg - from_deg) / span_s;
    for (int i = 0; i < steps; ++i) {
      const double deg = from_deg + per_s * h * i;
      const auto rates = [&](const State& s, double part) {
        const TurnedCam::Pose cam = cam_.at(wrapped(deg + part * per_s * h));
        return rates_of(s, cam.lift_m, cam.per_deg_m * per_s);
      };
      const State k1 = rates(state_, 0);
      const State k2 = rates(plus(state_, k1, h / 2), 0.5);
      const State k3 = rates(plus(state_, k2, h / 2), 0.5);
      const State k4 = rates(plus(state_, k3, h), 1);
      for (std::size_t j = 0; j < state_.size(); ++j) state_[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
    }
  }

  [[nodiscard]] double lift_m() const { return state_[0]; }
  [[nodiscard]] double surge_N() const { return force_N(state_); }

 private:
  static constexpr double kStep_s = 0.5e-6;
  using State = std::array<double, 2 + 2 * kMaxValveModes>;  ///< lift, velocity, then q and q' of each mode

  [[nodiscard]] static double wrapped(double deg) { return deg - 360 * std::floor(deg / 360 + 0.5); }
  [[nodiscard]] static State plus(State s, const State& k, double h) {
    for (std::size_t j = 0; j < s.size(); ++j) s[j] += h * k[j];
    return s;
  }
  [[nodiscard]] double force_N(const State& s) const {
    double sum = 0;
    for (std::size_t n = 0; n < modes_.size(); ++n) sum += modes_[n].force_N_m * s[2 + 2 * n];
    return sum;
  }
  [[nodiscard]] State rates_of(const State& s, double cam_m, double cam_m_s) const {
    const Acting contact = acting(mass_, s[0], s[1], cam_m, cam_m_s);
    const double accelerates =
        (contact.train_N + contact.seat_N - mass_.k_s * s[0] - mass_.P - mass_.c * s[1] - force_N(s)) / mass_.M;
    State rates{s[1], accelerates};
    for (std::size_t n = 0; n < modes_.size(); ++n) {
      const Mode& m = modes_[n];
      const double q = s[2 + 2 * n], v = s[3 + 2 * n];
      rates[2 + 2 * n] = v;
      rates[3 + 2 * n] =
          m.drive * accelerates - 2 * m.damping_ratio * m.rate_rad_s * v - m.rate_rad_s * m.rate_rad_s * q;
    }
    return rates;
  }

  SingleMass mass_;
  TurnedCam cam_;
  std::vector<Mode> modes_;
  State state_{};
};

}  // namespace crankloop::valve_test

// A crank mechanism with a rigid rod as Lagrange's equation has it: nothing but where its bodies are at a crank angle.
//
// What belongs here: mechanics with nothing lumped and no table. What does not: any formula of the library.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace crankloop::support {

/// One cylinder without pin offset, its rod a rigid body, turned by a constant torque.
struct CrankMechanism {
  long double crank_radius_m, rod_length_m;
  long double piston_kg, rod_kg, rod_com_to_crank_m, rod_inertia_kg_m2;  ///< the last about the centre of mass
  long double crank_inertia_kg_m2;
  long double torque_Nm;
};

/// Its motion over time: J(a) a'' + 1/2 dJ/da a'^2 = torque, J = sum of m (dP/da)^2 + I (db/da)^2 by differences of the
/// positions.
class Lagrange {
  using Place =
      std::array<long double, 4>;  ///< height of the piston, place of the rod's centre of mass, the rod's angle

 public:
  Lagrange(const CrankMechanism& mechanism, long double speed_rad_s) : m_{mechanism}, speed_{speed_rad_s} {}

  /// Runge-Kutta of fourth order for a'' = f(a, a').
  void run(long double time_s, int steps) {
    const long double h = time_s / steps;
    for (int i = 0; i < steps; ++i) {
      const long double k1 = acceleration(angle_, speed_);
      const long double k2 = acceleration(angle_ + h / 2 * speed_, speed_ + h / 2 * k1);
      const long double k3 = acceleration(angle_ + h / 2 * speed_ + h * h / 4 * k1, speed_ + h / 2 * k2);
      const long double k4 = acceleration(angle_ + h * speed_ + h * h / 2 * k2, speed_ + h * k3);
      angle_ += h * speed_ + h * h / 6 * (k1 + k2 + k3);
      speed_ += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
  [[nodiscard]] long double angle_rad() const { return angle_; }
  [[nodiscard]] long double speed_rad_s() const { return speed_; }

  [[nodiscard]] long double inertia_kg_m2(long double a) const {
    const Place d = difference(
        1e-4L, [&](long double at) { return place(at); }, a);
    return m_.crank_inertia_kg_m2 + m_.piston_kg * d[0] * d[0] + m_.rod_kg * (d[1] * d[1] + d[2] * d[2]) +
           m_.rod_inertia_kg_m2 * d[3] * d[3];
  }

 private:
  /// Derivative by the central difference of fourth order.
  template <class Function>
  [[nodiscard]] static Place difference(long double d, const Function& f, long double a) {
    const auto near_up = f(a + d), near_down = f(a - d), far_up = f(a + 2 * d), far_down = f(a - 2 * d);
    Place slope{};
    for (std::size_t i = 0; i < slope.size(); ++i)
      slope[i] = (8 * (near_up[i] - near_down[i]) - (far_up[i] - far_down[i])) / (12 * d);
    return slope;
  }
  [[nodiscard]] Place place(long double a) const {
    const long double x = m_.crank_radius_m * std::sin(a);
    const long double y = m_.crank_radius_m * std::cos(a);
    const long double top = y + std::sqrt(m_.rod_length_m * m_.rod_length_m - x * x);
    const long double share = m_.rod_com_to_crank_m / m_.rod_length_m;
    return {top, x * (1 - share), y + (top - y) * share, std::asin(x / m_.rod_length_m)};
  }
  [[nodiscard]] long double acceleration(long double a, long double w) const {
    const auto inertia = [&](long double at) { return Place{inertia_kg_m2(at), 0, 0, 0}; };
    const long double slope = difference(1e-3L, inertia, a)[0];
    return (m_.torque_Nm - slope * w * w / 2) / inertia_kg_m2(a);
  }

  CrankMechanism m_;
  long double angle_ = 0;
  long double speed_;
};

}  // namespace crankloop::support

// The work that gas and masses do on the crankshaft between two angles, worked out apart from the tick: pressure times
// dV by fine quadrature of the diagram, and the change of kinetic energy.
//
// What belongs here: work of a whole engine at constant speed. What does not: how a diagram is made (it is taken as
// given).
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <crankloop/define/engine_definition.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>

#include "support/tick_oracle.hpp"

namespace crankloop::tick_test {

/// Work over the engine angle A, counted from A = 0, at load ratio q and speed w: gas(A) + w^2 masses(A).
class WorkOracle {
 public:
  WorkOracle(const EngineDefinition& engine, double load_ratio) : engine_{engine}, load_ratio_{load_ratio} {
    const Status status = diagram_.init(engine.crank, engine.pressure);
    ready_ = status.ok();
    one_.assign(kPanels + 1, 0.0L);
    for (int i = 0; i < kPanels; ++i) one_[index(i) + 1] = one_[index(i)] + panel_J(i, 1.0L);
  }

  [[nodiscard]] bool ready() const { return ready_; }

  /// Gas work of one cylinder over a cycle.
  [[nodiscard]] double cycle_J() const { return static_cast<double>(one_.back()); }

  /// Gas work of all cylinders from engine angle 0 to A, A >= 0 and below 720.
  [[nodiscard]] long double gas_J(long double engine_deg) const {
    long double sum = 0;
    for (std::size_t k = 0; k < cylinders(); ++k) {
      const auto firing = static_cast<long double>(engine_.layout.firing_deg[k]);
      sum += one_J(engine_deg - firing) - one_J(-firing);
    }
    return sum;
  }

  /// Work of all masses per w^2 up to A: minus their kinetic energy, less that at angle 0.
  [[nodiscard]] long double masses_kg_m2(long double engine_deg) const {
    long double sum = 0;
    for (std::size_t k = 0; k < cylinders(); ++k) {
      const auto firing = static_cast<long double>(engine_.layout.firing_deg[k]);
      sum += energy_kg_m2(-firing) - energy_kg_m2(engine_deg - firing);
    }
    return sum;
  }

  /// Torque scale: the largest gas torque of one cylinder that the diagram could give, peak pressure on a full lever.
  [[nodiscard]] double gas_torque_scale_Nm() const {
    double peak = 0;
    for (int i = 0; i < 7200; ++i) peak = std::fmax(peak, pressure_Pa(i / 10.0));
    return peak * static_cast<double>(area_m2()) * engine_.crank.crank_radius_m;
  }
  [[nodiscard]] double inertia_torque_scale_kg_m2() const {
    return engine_.masses.reciprocating_kg() * engine_.crank.crank_radius_m * engine_.crank.crank_radius_m;
  }

 private:
  static constexpr int kPanels = 14400;  // 0.05 deg
  [[nodiscard]] static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] std::size_t cylinders() const { return static_cast<std::size_t>(engine_.layout.cylinders); }
  [[nodiscard]] long double area_m2() const {
    const auto bore = static_cast<long double>(engine_.crank.bore_m);
    return kWidePi / 4 * bore * bore;
  }
  [[nodiscard]] double pressure_Pa(double own_deg) const {
    return diagram_.motored_Pa(own_deg) + load_ratio_ * diagram_.heat_Pa(own_deg);
  }

  /// Work of a cylinder over the first `part` of a panel: three Gauss points, where the pressure is smooth over 0.05
  /// deg.
  [[nodiscard]] long double panel_J(int i, long double part) const {
    const long double width = part * (720.0L / kPanels);
    const long double middle = i * (720.0L / kPanels) + width / 2;
    const long double apart = width / 2 * std::sqrt(0.6L);
    const auto torque = [&](long double deg) {
      const auto over_Pa =
          static_cast<long double>(pressure_Pa(static_cast<double>(deg)) - engine_.pressure.crankcase_Pa);
      return over_Pa * area_m2() * oracle_pose(engine_.crank, deg * (kWidePi / 180)).slope_m;
    };
    return width * (kWidePi / 180) * (5 * torque(middle - apart) + 8 * torque(middle) + 5 * torque(middle + apart)) /
           18;
  }
  /// Work of one cylinder up to its own angle, any value.
  [[nodiscard]] long double one_J(long double own_deg) const {
    const long double cycles = std::floor(own_deg / 720);
    const long double panels = (own_deg - cycles * 720) * (kPanels / 720.0L);
    int i = static_cast<int>(panels);
    if (i >= kPanels) i = kPanels - 1;
    return cycles * one_.back() + one_[index(i)] + panel_J(i, panels - i);
  }
  [[nodiscard]] long double energy_kg_m2(long double own_deg) const {
    const OraclePose p = oracle_pose(engine_.crank, own_deg * (kWidePi / 180));
    const auto m = static_cast<long double>(engine_.masses.reciprocating_kg());
    const auto inertia = static_cast<long double>(engine_.masses.rod_inertia_correction_kg_m2);
    return (m * p.slope_m * p.slope_m + inertia * p.rod_slope * p.rod_slope) / 2;
  }

  EngineDefinition engine_;
  double load_ratio_;
  IndicatorDiagram diagram_;
  bool ready_ = false;
  std::vector<long double> one_;  ///< gas work of one cylinder up to each panel's start
};

}  // namespace crankloop::tick_test

// Flow area of a valve over its lift, and over the crank angle: docs/model.md "Flow area".
//
// What belongs here: areas, their integrals and what follows from these. What does not: the dimensions
// (engine_file/port_geometry.hpp), lines of summaries (flow_lines.hpp).
#pragma once

#include <crankloop/define/gas.hpp>
#include <crankloop/tabulate/valve_lift.hpp>

#include "../engine_file/engine_file.hpp"

namespace crankloop::program {

/// Areas of one valve at one lift.
class FlowArea {
 public:
  FlowArea(const PortGeometry& geometry, const PortOfTrain& port) noexcept;

  /// The least area between seat and head, at most the port's less its stem; 0 without lift.
  [[nodiscard]] double geometric_m2(double lift_m) const noexcept;

  /// That of the gas: pi/4 D^2 times the flow curve.
  [[nodiscard]] double effective_m2(double lift_m) const noexcept;

  /// L1: up to it the shortest way from the head is perpendicular to the seat; beyond, it ends at the seat's outer
  /// edge.
  [[nodiscard]] double end_of_low_lift_m() const noexcept { return low_m_; }

 private:
  PortGeometry geometry_;
  PortOfTrain port_;
  double sin_;
  double cos_;
  double low_m_;
  double port_m2_;  ///< less the stem
};

/// One opening of one valve over the crank angle.
struct FlowIntegrals {
  double open_deg = 0;
  double geometric_m2_deg = 0;
  double effective_m2_deg = 0;

  [[nodiscard]] double mean_geometric_m2() const noexcept { return mean(geometric_m2_deg); }  ///< while it is open
  [[nodiscard]] double mean_effective_m2() const noexcept { return mean(effective_m2_deg); }

 private:
  [[nodiscard]] double mean(double integral) const noexcept { return open_deg > 0 ? integral / open_deg : 0; }
};

/// Of the theoretical lift, open from where the clearance has closed.
[[nodiscard]] FlowIntegrals theoretical_flow(const FlowArea& area, const ValveLift& lift) noexcept;

/// Sums the areas of lifts at equal distances, from a closed valve on. Open above `closed_m`.
class FlowSum {
 public:
  FlowSum(const FlowArea& area, double closed_m, double crank_deg_per_step) noexcept
      : area_{area}, closed_m_{closed_m}, step_deg_{crank_deg_per_step} {}

  void add(double lift_m) noexcept;

  /// Of the opening with the largest integral: bounces on the seat behind it do not count.
  [[nodiscard]] const FlowIntegrals& largest() const noexcept { return largest_; }

 private:
  const FlowArea& area_;
  double closed_m_;
  double step_deg_;
  double last_m_ = 0;  ///< lift
  bool started_ = false;
  FlowIntegrals opening_{};
  FlowIntegrals largest_{};
};

/// Mean areas, while they are open, of all valves of one cylinder that open to one port.
struct PortArea {
  double geometric_m2 = 0;
  double effective_m2 = 0;

  void add(const FlowIntegrals& flow, int valves) noexcept {
    geometric_m2 += valves * flow.mean_geometric_m2();
    effective_m2 += valves * flow.mean_effective_m2();
  }
};

/// What these come to.
struct FlowFigures {
  double area_per_displacement_per_m = 0;  ///< A_v / V_h, by the mean geometric area
  double gas_speed_m_s = 0;                ///< F_p S_p over the mean geometric area
  double mach_index = 0;                   ///< Z, Taylor's, by the mean effective area
};

[[nodiscard]] FlowFigures flow_figures(const PortArea& area, const EngineDefinition& engine,
                                       double speed_rad_s) noexcept;

}  // namespace crankloop::program

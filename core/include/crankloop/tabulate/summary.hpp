// What an engine does at one speed, at set-up time, exactly: mean effective pressures, power, torque harmonics, balance.
//
// What belongs here: figures of a whole cycle at constant speed, in double. What does not: anything per tick.
#pragma once

#include <crankloop/define/engine_definition.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tick/tables.hpp>

namespace crankloop {

/// Constants of the force equations (docs/model.md "Forces") for one cylinder of an engine.
[[nodiscard]] Body<double> body_of(const EngineDefinition& engine) noexcept;

/// First and second order of the reciprocating inertia force P_j of one cylinder at its own crank angle, N, positive toward the crankshaft.
struct InertiaOrders {
  double first_N;
  double second_N;
};
[[nodiscard]] InertiaOrders inertia_orders(const EngineDefinition& engine, double crank_rad, double speed_rad_s) noexcept;

struct PinLoad {
  double radial_N;
  double tangential_N;
};

/// A definition ready to be asked at any crank angle: the exact counterpart of the tick.
class ExactEngine {
 public:
  Status init(const EngineDefinition& engine) noexcept;

  /// Forces of cylinder k (from 0) at engine angle A in degrees, load ratio q.
  [[nodiscard]] CylinderForces<double> forces(int cylinder, double engine_deg, double speed_rad_s, double load_ratio = 1) const noexcept;
  /// Torque of all cylinders at engine angle A.
  [[nodiscard]] double torque_Nm(double engine_deg, double speed_rad_s, double load_ratio = 1) const noexcept;

  /// Load of the crank pin that carries cylinder k, all its rods: radial toward the crank centre, tangential with the rotation.
  [[nodiscard]] PinLoad pin_load(int cylinder, double engine_deg, double speed_rad_s, double load_ratio = 1) const noexcept;

  [[nodiscard]] const EngineDefinition& definition() const noexcept { return engine_; }
  [[nodiscard]] const IndicatorDiagram& diagram() const noexcept { return diagram_; }
  [[nodiscard]] const Body<double>& body() const noexcept { return body_; }

 private:
  EngineDefinition engine_{};
  Body<double> body_{};
  IndicatorDiagram diagram_{};
};

/// Amplitudes of torque harmonic `order` (per crank revolution): torque = mean + sum cosine cos(order A) + sine sin(order A).
struct Harmonic {
  double order;
  double cosine_Nm;
  double sine_Nm;
  double amplitude_Nm;
};

inline constexpr int kHarmonics = 24;  ///< orders 0.5, 1, 1.5 ... 12

/// Whole-cycle figures at constant speed.
struct CycleSummary {
  double net_mep_Pa;         ///< loop integral of p dV over 720 deg per swept volume, one cylinder
  double gross_mep_Pa;       ///< over the closed 360 deg, compression and expansion
  double mean_torque_Nm;     ///< all cylinders
  double power_W;            ///< indicated: mean torque times speed
  double largest_torque_Nm;
  double largest_torque_deg;
  double smallest_torque_Nm;
  double smallest_torque_deg;
  double fluctuation_ratio;  ///< (largest - smallest) / mean; 0 where the mean is 0
  Harmonic harmonics[kHarmonics];
};

/// 7200 torques of every cylinder: some 100 ms on a desktop. Speed in rad/s, load ratio as in Input.
[[nodiscard]] CycleSummary summarise(const ExactEngine& engine, double speed_rad_s, double load_ratio = 1) noexcept;

/// Free forces and moments about the middle of the crankshaft, without the cosine curve: docs/model.md "Balance".
[[nodiscard]] Balance<double> balance_of(const EngineDefinition& engine) noexcept;

/// Longest length of the vector (up, lateral) over a turn: the half major axis of its ellipse.
[[nodiscard]] double peak_force_kg_m(const Turning<double>& turning) noexcept;
[[nodiscard]] double peak_moment_kg_m2(const Turning<double>& turning) noexcept;

/// Crank pins, their throws and masses.
[[nodiscard]] Bearings<double> bearings_of(const EngineDefinition& engine) noexcept;

}  // namespace crankloop

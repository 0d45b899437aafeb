// Exact figures of an engine at one speed, at set-up time: mean effective pressures, power, torque harmonics, balance.
//
// What belongs here: figures of a whole cycle at constant speed, in double. What does not: anything per tick.
#pragma once

#include <crankloop/define/engine_definition.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>

namespace crankloop {

/// Constants of the force equations (docs/model.md "Forces") for one cylinder of an engine.
[[nodiscard]] detail::Body<double> body_of(const EngineDefinition& engine) noexcept;

/// First and second order of the reciprocating inertia force P_j of one cylinder at its own crank angle, N, positive
/// toward the crankshaft.
struct InertiaOrders {
  double first_N;
  double second_N;
};
[[nodiscard]] InertiaOrders inertia_orders(const EngineDefinition& engine, double crank_rad,
                                           double speed_rad_s) noexcept;

struct PinLoad {
  double radial_N;
  double tangential_N;
};

/// A definition that can be evaluated at any crank angle: the exact counterpart of the tick.
class ExactEngine {
 public:
  Status init(const EngineDefinition& engine) noexcept;

  /// Forces of cylinder k (from 0) at engine angle A in degrees, load ratio q.
  [[nodiscard]] CylinderForces<double> forces(int cylinder, double engine_deg, double speed_rad_s,
                                              double load_ratio = 1) const noexcept;
  /// Torque of all cylinders at engine angle A.
  [[nodiscard]] double torque_Nm(double engine_deg, double speed_rad_s, double load_ratio = 1) const noexcept;

  /// Load on the crank pin of cylinder k from all its rods: radial toward the crank centre, tangential with the
  /// rotation.
  [[nodiscard]] PinLoad pin_load(int cylinder, double engine_deg, double speed_rad_s,
                                 double load_ratio = 1) const noexcept;

  [[nodiscard]] const EngineDefinition& definition() const noexcept { return engine_; }
  [[nodiscard]] const IndicatorDiagram& diagram() const noexcept { return diagram_; }
  [[nodiscard]] const detail::Body<double>& body() const noexcept { return body_; }

 private:
  EngineDefinition engine_{};
  detail::Body<double> body_{};
  IndicatorDiagram diagram_{};
};

/// cosine cos(order A) + sine sin(order A) as amplitude cos(order A - phase), phase within +-180 deg.
struct Wave {
  double amplitude;
  double phase_deg;
};
[[nodiscard]] Wave wave_of(double cosine, double sine) noexcept;

/// Amplitudes of torque harmonic `order` (per crank revolution): torque = mean + sum cosine cos(order A) + sine
/// sin(order A).
struct Harmonic {
  double order;
  double cosine_Nm;
  double sine_Nm;
  double amplitude_Nm;
  double phase_deg;  ///< as in Wave
};

inline constexpr int kHarmonics = 24;  ///< orders 0.5, 1, 1.5 ... 12

/// Brake figures at the coupling: indicated torque less friction, before the driven machine's load.
struct BrakeFigures {
  double friction_mep_Pa;
  double torque_Nm;
  double power_W;
  double efficiency_ratio;  ///< mechanical efficiency: power_W / indicated power; 0 if that is not positive
};
[[nodiscard]] BrakeFigures brake_figures(const EngineDefinition& engine, double indicated_Nm,
                                         double speed_rad_s) noexcept;

/// Whole-cycle figures at constant speed.
struct CycleSummary {
  double net_mep_Pa;      ///< loop integral of p dV over 720 deg per swept volume, one cylinder
  double gross_mep_Pa;    ///< over the closed 360 deg, compression and expansion
  double mean_torque_Nm;  ///< all cylinders
  double power_W;         ///< indicated: mean torque times speed
  double largest_torque_Nm;
  double largest_torque_deg;
  double smallest_torque_Nm;
  double smallest_torque_deg;
  double fluctuation_ratio;  ///< (largest - smallest) / mean; 0 where the mean is 0
  BrakeFigures brake;
  Harmonic harmonics[kHarmonics];
};

/// Evaluates 7200 torques of every cylinder: about 100 ms on a desktop. Speed in rad/s, load ratio as in Input.
[[nodiscard]] CycleSummary summarise(const ExactEngine& engine, double speed_rad_s, double load_ratio = 1) noexcept;

/// Torque of the engine `of` at an engine angle of 0 to 720 deg.
using TorqueAt = double (*)(const void* of, double engine_deg);
/// Adds extremes, fluctuation and harmonics of a cycle's torque, from `samples` samples, to a summary that has the
/// mean: for an engine whose torque has no closed form.
void add_torques(CycleSummary& summary, int samples, TorqueAt torque_Nm, const void* of) noexcept;

/// Middle of the crankshaft, about which moments are: half way between its first and last throw, as
/// Layout::position_m.
[[nodiscard]] double crankshaft_middle_m(const Layout& layout) noexcept;

/// Harmonic `order` of the reciprocating masses' free force and its moment, of the exact motion: docs/model.md
/// "Balance". Only orders 1, 2, 4 and 6 matter, and 3 and 5 with a pin offset.
[[nodiscard]] detail::RotatingVector<double> reciprocating_order(const EngineDefinition& engine, int order) noexcept;

/// Free forces and moments about the middle of the crankshaft, without the cosine curve: docs/model.md "Balance".
[[nodiscard]] detail::Balance<double> balance_of(const EngineDefinition& engine) noexcept;

/// Longest length of the vector (up, lateral) over a turn: the half major axis of its ellipse.
[[nodiscard]] double peak_force_kg_m(const detail::RotatingVector<double>& turning) noexcept;
[[nodiscard]] double peak_moment_kg_m2(const detail::RotatingVector<double>& turning) noexcept;

/// Crank pins, their throws and masses.
[[nodiscard]] detail::Bearings<double> bearings_of(const EngineDefinition& engine) noexcept;

/// A main journal's load in the block's coordinates. Up is bank angle 0, lateral is 90 deg further in the sense of
/// rotation.
struct BlockLoad {
  double up_N;
  double lateral_N;
};
/// Converts journal_along_N and journal_across_N, which rotate with the crank, at engine angle A.
[[nodiscard]] BlockLoad in_block(const EngineDefinition& engine, double engine_deg, double along_N,
                                 double across_N) noexcept;

}  // namespace crankloop

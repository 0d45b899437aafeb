// The books of a free run: what gas and starter put in, what friction and load took out, what the moving masses kept.
//
// What belongs here: energies by ways that the tick does not go: the gas's from the exact engine's torque over the
// angle (with gas exchange: from the loop's torque, less that of the masses), the masses' from the mechanism's
// geometry, friction, load and starter by their power over time. What does not: the tick's own energy
// (crankloop::CrankStep).
#pragma once

#include <vector>

#include <crankloop/tabulate/summary.hpp>

#include "free_loop.hpp"

namespace crankloop::program {

/// All in J, over the run.
struct EnergyBalance {
  double gas_J = 0;
  double starter_J = 0;
  double friction_J = 0;
  double load_J = 0;           ///< the external torque's too
  double kinetic_J = 0;        ///< change
  bool gas_by_torque = false;  ///< gas_J is of the loop's torque, not of the pressure diagram

  [[nodiscard]] double missing_J() const noexcept { return gas_J + starter_J - friction_J - load_J - kinetic_J; }
  /// Per the largest of them.
  [[nodiscard]] double missing_ratio() const noexcept;
};

/// Work of the gas of all cylinders from one angle to another at a constant load ratio.
class GasWork {
 public:
  GasWork(const ExactEngine& exact, const FreeOperation& operation);

  [[nodiscard]] double between_J(double from_deg, double to_deg) const { return until_J(to_deg) - until_J(from_deg); }
  /// What the crank loses beside it when it turns backwards, where the gas's cycle would give it work: docs/model.md
  /// "Crank dynamics".
  [[nodiscard]] double backwards_Nm() const;

 private:
  /// One cylinder's work since its firing top dead centre, its cycle in equal parts.
  struct Curve {
    std::vector<double> work_J;
    std::vector<double> torque_Nm;
    [[nodiscard]] double until_J(double own_deg) const;
  };
  [[nodiscard]] Curve curve_of(const ExactEngine& exact, double load_ratio) const;
  [[nodiscard]] double until_J(double angle_deg) const;

  std::vector<double> firing_deg_;
  std::uint32_t cut_;
  Curve firing_;
  Curve motored_;
};

class EnergyBooks {
 public:
  /// Of an engine, with the load and the friction that it runs with, from a state on.
  EnergyBooks(const ExactEngine& exact, const FreeOperation& operation, const FreeState& begin);

  /// Powers are a cubic over each tick. `starter_Nm` as at its end.
  void take(const FreeState& before, const FreeState& after, double starter_Nm);

  [[nodiscard]] EnergyBalance balance(const FreeState& end) const;

  [[nodiscard]] double friction_Nm(
      double speed_rad_s) const noexcept;  ///< the engine's own, against the rotation; backwards also the gas's
  [[nodiscard]] double load_Nm(double speed_rad_s) const noexcept;      ///< the brake's
  [[nodiscard]] double inertia_kg_m2(double angle_deg) const noexcept;  ///< J_eff

 private:
  [[nodiscard]] double kinetic_J(const FreeState& at) const noexcept;

  const EngineDefinition& engine_;
  GasWork gas_;
  double backwards_Nm_;
  bool by_torque_;  ///< the gas's work, from the loop's torque
  FreeState begin_;
  double starter_J_ = 0;
  double friction_J_ = 0;
  double load_J_ = 0;
  double starter_before_Nm_ = 0;
  double slowed_J_ = 0;  ///< what the masses took by their change of inertia, at the speed of the moment
};

}  // namespace crankloop::program

// What acts on the crankshaft besides gas and masses: friction, the driven machine, the starter.
//
// What belongs here: what a scene that integrates the speed (CrankGiven::torque) needs beyond the engine
// itself. What does not: what changes from tick to tick (Input::external_torque_Nm, Input::starter). Equations:
// docs/model.md "Crank dynamics". All zero: none.
#pragma once

#include <crankloop/define/field.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

/// Friction of the engine as a mean effective pressure over the crank speed w: constant + linear |w| + quadratic w^2.
/// As a torque it is that pressure times the swept volume of all cylinders / (4 pi). It opposes the rotation in either
/// direction, and holds at standstill.
struct Friction {
  double constant_Pa = 0;
  double linear_Pa_s = 0;      ///< per rad/s
  double quadratic_Pa_s2 = 0;  ///< per (rad/s)^2

  [[nodiscard]] constexpr bool any() const noexcept {
    return constant_Pa != 0 || linear_Pa_s != 0 || quadratic_Pa_s2 != 0;
  }

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_NUMBER(1, friction, constant_Pa, from(0).up_to(1e7));
    CRANKLOOP_NUMBER(1, friction, linear_Pa_s, from(0).up_to(1e6));
    CRANKLOOP_NUMBER(1, friction, quadratic_Pa_s2, from(0).up_to(1e6));
  }
};

/// The driven machine as a passive brake: its torque opposes the rotation like friction does. What may also drive is
/// Input::external_torque_Nm.
struct DrivenMachine {
  double constant_Nm = 0;
  double linear_Nm_s = 0;      ///< per rad/s
  double quadratic_Nm_s2 = 0;  ///< per (rad/s)^2
  double inertia_kg_m2 = 0;    ///< turns with the crankshaft, seen from it

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_NUMBER(1, machine, constant_Nm, from(0).up_to(1e7));
    CRANKLOOP_NUMBER(1, machine, linear_Nm_s, from(0).up_to(1e6));
    CRANKLOOP_NUMBER(1, machine, quadratic_Nm_s2, from(0).up_to(1e6));
    CRANKLOOP_NUMBER(1, machine, inertia_kg_m2, from(0).up_to(1e6));
  }
};

/// A starter, seen from the crankshaft: its torque falls in a straight line from standstill to the no-load speed.
/// Above, it free-wheels; the crank turning backwards meets the stall torque.
struct Starter {
  double stall_Nm = 0;       ///< 0: no starter
  double no_load_rad_s = 0;  ///< > 0 where there is a stall torque

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_NUMBER(1, starter, stall_Nm, from(0).up_to(1e7));
    CRANKLOOP_NUMBER(1, starter, no_load_rad_s, from(0).up_to(1e4));
  }
};

/// Field names "friction.*", "machine.*", "starter.*".
Status validate(const Friction& friction) noexcept;
Status validate(const DrivenMachine& machine) noexcept;
Status validate(const Starter& starter) noexcept;

}  // namespace crankloop

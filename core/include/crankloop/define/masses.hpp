// The moving masses of one crank mechanism.
//
// What belongs here: masses as the equations use them, and the ways to get there from a weighed or a drawn rod.
// What does not: forces (tick/crank/cylinder_forces.hpp), first-design estimates (tabulate/first_design.hpp).
#pragma once

#include <crankloop/define/crank.hpp>
#include <crankloop/define/field.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

/// A rod as a rigid body: docs/model.md "Masses".
struct RigidRod {
  double mass_kg = 0;
  double com_to_crank_m = 0;  ///< l_crank: centre of mass to crank pin, 0 to l
  double inertia_kg_m2 = 0;   ///< J_rod about the centre of mass; 0 is a physical value (a point mass)
};

/// One throw of the crankshaft as it is drawn.
struct CrankThrow {
  double pin_kg = 0;     ///< between the webs
  double web_kg = 0;     ///< one of the two
  double web_com_m = 0;  ///< rho_web: a web's centre of mass from the crankshaft's axis, toward the pin
};

/// Masses per cylinder, the rod already lumped on its two ends.
struct Masses {
  double piston_kg = 0;                     ///< piston, rings, pin
  double rod_small_end_kg = 0;              ///< m_rod_pin, moves with the piston
  double rod_big_end_kg = 0;                ///< m_rod_crank, turns with the crank pin
  double rod_inertia_correction_kg_m2 = 0;  ///< dI = J_rod - m_rod l_pin l_crank; 0 = two-mass rod; may be negative
  double crank_pin_equivalent_kg =
      0;  ///< m_k, pin and webs reduced to the crank radius; acts in the centrifugal force only
  double crank_inertia_kg_m2 = 0;  ///< whole crankshaft with flywheel, without rods

  [[nodiscard]] constexpr double reciprocating_kg() const noexcept { return piston_kg + rod_small_end_kg; }  ///< m_j

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_NUMBER(1, masses, piston_kg, from(0).up_to(1e4));
    CRANKLOOP_NUMBER(1, masses, rod_small_end_kg, from(0).up_to(1e4));
    CRANKLOOP_NUMBER(1, masses, rod_big_end_kg, from(0).up_to(1e4));
    CRANKLOOP_NUMBER(1, masses, rod_inertia_correction_kg_m2, from(-1e6).up_to(1e6));
    CRANKLOOP_NUMBER(1, masses, crank_pin_equivalent_kg, from(0).up_to(1e4));
    CRANKLOOP_NUMBER(1, masses, crank_inertia_kg_m2, from(0).up_to(1e6));
  }
};

/// Lumps a rigid rod on its ends: same mass, centre of mass and, by the correction dI, the same kinetic energy.
void lump_rod(const RigidRod& rod, const Crank& crank, Masses& masses) noexcept;

/// Reduces pin and webs to the crank radius: the same centrifugal force, m_k = pin + 2 web rho_web / r.
void reduce_throw(const CrankThrow& crank_throw, const Crank& crank, Masses& masses) noexcept;

/// Field names "masses.*". Every mass >= 0 and m_j > 0.
Status validate(const Masses& masses) noexcept;

}  // namespace crankloop

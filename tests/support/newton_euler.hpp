// Crank, rod and piston as three rigid bodies: the forces in their joints from Newton's and Euler's equations.
//
// What belongs here: mechanics with nothing lumped. What does not: any formula of the library.
//
//     unknown   B, C, P   forces main bearing -> crank, rod -> crank pin, rod -> piston pin (two components each)
//               W, W_M    wall -> piston: force across the axis, moment
//               L         load -> crank: torque
//     equations           force up, force lateral and moment for each body: nine
#pragma once

#include <crankloop/define/engine_definition.hpp>

#include <cstddef>
#include <initializer_list>
#include <utility>

#include "support/linear_solve.hpp"
#include "support/vector_geometry.hpp"

namespace crankloop::support {

struct JointForces {
  Vec bearing_on_crank, rod_on_crank_pin, rod_on_piston_pin;
  Wide wall_on_piston, wall_moment, load_torque;
};

/// In the cylinder's own frame. The crank's own unbalance is m_k at the pin's radius; what accelerates the crankshaft
/// is in the load.
inline JointForces newton_euler(const EngineDefinition& engine, const RigidRod& rod, const Motion& m, Wide gas_force) {
  enum Unknown : std::size_t { bl, bu, cl, cu, pl, pu, wall, wall_moment, load };
  const Wide crank_kg = wide(engine.masses.crank_pin_equivalent_kg);
  const Wide piston_kg = wide(engine.masses.piston_kg);
  const Wide rod_kg = wide(rod.mass_kg);
  const Wide along = wide(rod.com_to_crank_m) / wide(engine.crank.rod_length_m);
  // Points of a rigid body on one line: the centre of mass moves as the mean of both ends, weighted by its distance.
  const Vec com = m.crank_pin + along * (m.piston_pin - m.crank_pin);
  const Vec com_acceleration =
      m.crank_pin_acceleration + along * (m.piston_pin_acceleration - m.crank_pin_acceleration);

  LinearSystem<9> s;
  std::size_t row = 0;
  const auto equation = [&](std::initializer_list<std::pair<Unknown, Wide>> terms, Wide right) {
    for (const auto& [unknown, factor] : terms) s.matrix[row][unknown] += factor;
    s.right[row++] = right;
  };
  // crank: forces, and moments about its centre
  equation({{bl, 1}, {cl, 1}}, crank_kg * m.crank_pin_acceleration.lateral);
  equation({{bu, 1}, {cu, 1}}, crank_kg * m.crank_pin_acceleration.up);
  equation({{cl, m.crank_pin.up}, {cu, -m.crank_pin.lateral}, {load, 1}}, 0);
  // rod: forces, and moments about its centre of mass
  const Vec to_crank = m.crank_pin - com;
  const Vec to_piston = m.piston_pin - com;
  equation({{cl, -1}, {pl, -1}}, rod_kg * com_acceleration.lateral);
  equation({{cu, -1}, {pu, -1}}, rod_kg * com_acceleration.up);
  equation({{cl, -to_crank.up}, {cu, to_crank.lateral}, {pl, -to_piston.up}, {pu, to_piston.lateral}},
           wide(rod.inertia_kg_m2) * m.rod_turn_rad_s2);
  // piston: forces, and moments about its pin
  equation({{pl, 1}, {wall, 1}}, piston_kg * m.piston_pin_acceleration.lateral);
  equation({{pu, 1}}, piston_kg * m.piston_pin_acceleration.up + gas_force);
  equation({{wall_moment, 1}}, 0);
  const auto x = solve(s);
  return {{x[bl], x[bu]}, {x[cl], x[cu]}, {x[pl], x[pu]}, x[wall], x[wall_moment], x[load]};
}

}  // namespace crankloop::support

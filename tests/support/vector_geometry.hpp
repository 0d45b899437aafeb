// The crank mechanism as a drawing: points, vectors, rigid bodies. The second way to every kinematic figure.
//
// What belongs here: motion from vector geometry, in the widest floating point there is. What does not: any formula of
// the library.
#pragma once

#include <crankloop/define/crank.hpp>

#include <cmath>
#include <limits>

#include "support/units.hpp"

namespace crankloop::support {

/// Wider than double on x86 and 64-bit Arm, so that a comparison sees the library's rounding and not its own.
using Wide = long double;

/// To Wide, said aloud: clang counts it among the promotions it warns of.
[[nodiscard]] constexpr Wide wide(double x) { return static_cast<Wide>(x); }

inline constexpr double kEps = std::numeric_limits<double>::epsilon();

/// A point or vector in the plane of the mechanism: origin at the crank centre, up = toward the head along the cylinder
/// axis, lateral = where the crank pin goes when it leaves the top.
struct Vec {
  Wide lateral;
  Wide up;
};
inline Vec operator+(Vec a, Vec b) { return {a.lateral + b.lateral, a.up + b.up}; }
inline Vec operator-(Vec a, Vec b) { return {a.lateral - b.lateral, a.up - b.up}; }
inline Vec operator*(Wide k, Vec a) { return {k * a.lateral, k * a.up}; }
inline Wide dot(Vec a, Vec b) { return a.lateral * b.lateral + a.up * b.up; }
inline Wide length(Vec a) { return std::sqrt(dot(a, a)); }

/// a turned a quarter turn in the sense of rotation (up to lateral): the velocity, at 1 rad/s, of a point at a.
inline Vec quarter_turn(Vec a) { return {a.up, -a.lateral}; }

/// Moment about the origin of a force at a point, positive in the sense of rotation.
inline Wide moment(Vec at, Vec force) { return at.up * force.lateral - at.lateral * force.up; }

/// Where everything is and how it moves. The rod's turning is positive in the crank's sense of
/// rotation.
struct Motion {
  Vec crank_pin, crank_pin_velocity, crank_pin_acceleration;
  Vec piston_pin, piston_pin_velocity, piston_pin_acceleration;
  Wide rod_turn_rad_s, rod_turn_rad_s2;
  Wide rod_lean_rad;  ///< of the crank pin's end from the cylinder axis, positive to the lateral side
};

/// Height of the piston pin: where the cylinder axis meets the circle of the rod's length about the crank pin, above
/// it.
inline Wide piston_height(const Crank& crank, Wide crank_rad) {
  const Wide r = wide(crank.crank_radius_m);
  const Wide l = wide(crank.rod_length_m);
  const Wide sideways = r * std::sin(crank_rad) - wide(crank.pin_offset_m);
  return r * std::cos(crank_rad) + std::sqrt((l - sideways) * (l + sideways));
}

/// Highest place of the piston pin: crank and rod in one line through the crank centre.
inline Wide greatest_height(const Crank& crank) {
  const Wide reach = wide(crank.crank_radius_m) + wide(crank.rod_length_m);
  const Wide e = wide(crank.pin_offset_m);
  return std::sqrt((reach - e) * (reach + e));
}
/// Lowest: rod folded back over the crank.
inline Wide least_height(const Crank& crank) {
  const Wide reach = wide(crank.rod_length_m) - wide(crank.crank_radius_m);
  const Wide e = wide(crank.pin_offset_m);
  return std::sqrt((reach - e) * (reach + e));
}

/// Velocities and accelerations from the rod as a rigid body whose upper end cannot leave the cylinder axis.
inline Motion motion_at(const Crank& crank, Wide crank_rad, Wide speed_rad_s, Wide acceleration_rad_s2 = 0) {
  Motion m{};
  const Wide r = wide(crank.crank_radius_m);
  const Wide w = speed_rad_s;
  m.crank_pin = {r * std::sin(crank_rad), r * std::cos(crank_rad)};
  m.crank_pin_velocity = w * quarter_turn(m.crank_pin);
  m.crank_pin_acceleration = (-w * w) * m.crank_pin + acceleration_rad_s2 * quarter_turn(m.crank_pin);
  m.piston_pin = {wide(crank.pin_offset_m), piston_height(crank, crank_rad)};

  const Vec rod = m.piston_pin - m.crank_pin;
  m.rod_lean_rad = std::atan2(-rod.lateral, rod.up);
  // Of v_piston = v_crank + turn x rod the lateral part is zero; likewise of the acceleration.
  m.rod_turn_rad_s = -m.crank_pin_velocity.lateral / rod.up;
  m.piston_pin_velocity = m.crank_pin_velocity + m.rod_turn_rad_s * quarter_turn(rod);
  const Wide centripetal = m.rod_turn_rad_s * m.rod_turn_rad_s;
  m.rod_turn_rad_s2 = -(m.crank_pin_acceleration.lateral - centripetal * rod.lateral) / rod.up;
  m.piston_pin_acceleration = m.crank_pin_acceleration + m.rod_turn_rad_s2 * quarter_turn(rod) - centripetal * rod;
  return m;
}

}  // namespace crankloop::support

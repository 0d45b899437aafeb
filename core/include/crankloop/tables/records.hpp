// The records of most sections of the tables: plain structs.
//
// What belongs here: their members and what they mean. What does not: which sections there are (tables/tables.hpp), how
// they are filled (tabulate/), curves (tables/curve.hpp), valves (tables/valve_tables.hpp, tables/lift_curve.hpp),
// trigger wheels (tables/trigger_tables.hpp).
#pragma once

#include <cstdint>

#include <crankloop/limits.hpp>
#include <crankloop/tables/curve.hpp>

namespace crankloop::detail {

/// Cylinders by group: group g has cylinder[end[g - 1]] (the first group: cylinder[0]) to cylinder[end[g] - 1].
struct CylinderGroups {
  std::uint8_t cylinder[kMaxCylinders];
  std::uint8_t end[kMaxCylinders];
};

/// Time and cylinder arrangement; every scene has it.
template <class Real>
struct Drive {
  std::uint64_t fingerprint;  ///< of all sections: a state is valid only with its own tables
  Real tick_s;
  Real per_tick_s;                 ///< 1 / tick
  Real cycles_per_tick_per_rad_s;  ///< tick / (4 pi): speed to phase increment
  Real rad_s_per_cycle_per_tick;   ///< 4 pi / tick
  Real speed_limit_rad_s;          ///< beyond it an input is refused; at most one revolution per tick
  std::uint32_t cylinders;
  std::uint32_t mechanisms;  ///< number of different crank angles; cylinders with equal ones share look-ups
  std::uint64_t firing_phase[kMaxCylinders];  ///< per mechanism: phase units at which its own crank angle is 0; in
                                              ///< float whole 2^32
  std::uint8_t mechanism_of[kMaxCylinders];   ///< per cylinder
  std::uint8_t
      turn_of[kMaxCylinders];  ///< per cylinder: 0, or 1 when it fires a crank turn after its mechanism's phase
  CylinderGroups by_mechanism;
  std::uint32_t trains;        ///< valve trains of each cylinder
  std::uint32_t spring_modes;  ///< of the valve that has most
};

/// Lengths and masses of one cylinder as the force equations use them. All cylinders are the same.
template <class Real>
struct Body {
  Real crank_radius_m;
  Real per_crank_radius;  ///< 1 / r
  Real per_rod_length;    ///< 1 / l
  Real pin_offset_m;      ///< e
  Real height_at_tdc_m;   ///< h + x = sqrt((r + l)^2 - e^2): piston pin above the crank centre at top dead centre
  Real bore_area_m2;
  Real crankcase_Pa;
  Real reciprocating_kg;              ///< m_j
  Real rod_inertia_correction_kg_m2;  ///< dI
};

/// A piston's motion.
template <class Real>
struct MotionSegment {
  IntegralSegment<Real> displacement;  ///< x, m: the integral of the slope
  Segment<Real> slope;                 ///< dx/da, m/rad
  Segment<Real> acceleration;          ///< d2x/da2, m/rad^2
};
/// The rod's angle at its piston and its crank pin.
template <class Real>
struct LeanSegment {
  Segment<Real> tilt;    ///< tan b
  Segment<Real> radial;  ///< cos(a + b) / cos b
};
/// A rod's motion.
template <class Real>
struct RodSegment {
  IntegralSegment<Real> angle;  ///< b, rad: the integral of the slope
  Segment<Real> slope;          ///< db/da
};

/// Crank pins and the main journals between them, numbered along the shaft; journals = pins + 1.
template <class Real>
struct Bearings {
  std::uint32_t pins;
  std::uint8_t pin_of[kMaxCylinders];  ///< per cylinder
  CylinderGroups by_pin;
  Real rods_kg_m[kMaxCylinders];   ///< per pin: m_rod_crank r, times the rods on it
  Real throw_kg_m[kMaxCylinders];  ///< per pin: m_r r
  Real throw_cos[kMaxCylinders];   ///< per pin: direction of its throw, from that of pin 0 in the sense of rotation
  Real throw_sin[kMaxCylinders];
};

/// A force and its moment at one order, per w^2: amplitudes of cos(order A) and sin(order A) at engine angle A.
template <class Real>
struct RotatingVector {
  Real up_cos, up_sin, lateral_cos, lateral_sin;  ///< kg m
  Real pitch_cos, pitch_sin, yaw_cos, yaw_sin;    ///< kg m^2
};

/// Free forces and moments of the whole engine about the middle of its crankshaft.
template <class Real>
struct Balance {
  RotatingVector<Real> first;     ///< reciprocating, first order
  RotatingVector<Real> second;    ///< reciprocating, second order
  RotatingVector<Real> rotating;  ///< centrifugal, first order
  Curve<Real> cosine;             ///< cos of the crank angle
};

/// Gas torque of all cylinders over the cycle, on a GasGrid; its integral is the work less that of the mean torque, so
/// it is periodic.
template <class Real>
struct GasTorque {
  const IntegratedSegment<Real>* at;
  Real quantum;
  Real mean_Nm;
};

/// Constant inertia, friction, load and starter of the crank, for scenes that integrate its speed w: docs/model.md
/// "Crank dynamics".
template <class Real>
struct CrankDynamics {
  Real turning_kg_m2;  ///< the part of J_eff that does not change with the angle: crankshaft, driven machine, the rods'
                       ///< big ends
  Real least_kg_m2;    ///< smallest J_eff; 0 if it is less than kLeastInertia_ratio of the largest
  Real drag_Nm;        ///< friction and brake: constant, per |w| and per w^2
  Real drag_Nm_s;
  Real drag_Nm_s2;
  Real starter_stall_Nm;
  Real starter_slope_Nm_s;  ///< stall torque / no-load speed
  Real most_rad_s2;         ///< largest acceleration: from one speed limit to the other in a tick
};

/// Smallest J_eff that is integrated, absolute and relative to the largest: float still resolves the difference of its
/// two terms.
inline constexpr double kLeastInertia_kg_m2 = 1e-9;
inline constexpr double kLeastInertia_ratio = 1e-3;

}  // namespace crankloop::detail

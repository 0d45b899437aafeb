// What the tick reads: plain data, made by tabulate in RAM or printed by the program as constexpr arrays for flash.
//
// What belongs here: the sections and the view of them that a scene takes. What does not: how they are filled (tabulate/).
// One object per section, so that what a scene does not reference is not linked.
#pragma once

#include <array>
#include <cstdint>

#include <crankloop/limits.hpp>
#include <crankloop/tick/curve.hpp>
#include <crankloop/tick/lift_curve.hpp>
#include <crankloop/tick/scene.hpp>
#include <crankloop/tick/trigger_tables.hpp>
#include <crankloop/tick/valve_tables.hpp>

namespace crankloop {

/// Cylinders in groups: those of group g are cylinder[end[g - 1]], or [0] of the first, to cylinder[end[g] - 1].
struct CylinderGroups {
  std::uint8_t cylinder[kMaxCylinders];
  std::uint8_t end[kMaxCylinders];
};

/// Time and cylinder arrangement; every scene has it.
template <class Real>
struct Drive {
  std::uint64_t fingerprint;  ///< of all sections: a state belongs to its tables
  Real tick_s;
  Real per_tick_s;                 ///< 1 / tick
  Real cycles_per_tick_per_rad_s;  ///< tick / (4 pi): speed to phase increment
  Real rad_s_per_cycle_per_tick;   ///< 4 pi / tick
  Real speed_limit_rad_s;          ///< beyond it an input is refused; at most one revolution per tick
  std::uint32_t cylinders;
  std::uint32_t mechanisms;                         ///< cylinders with different crank angles; the others share their look-ups
  std::uint64_t firing_phase[kMaxCylinders];        ///< per mechanism: phase units at which its own crank angle is 0; in float whole 2^32
  std::uint8_t mechanism_of[kMaxCylinders];         ///< per cylinder
  std::uint8_t turn_of[kMaxCylinders];              ///< per cylinder: 0, or 1 when it fires a crank turn after its mechanism's phase
  CylinderGroups by_mechanism;
  std::uint32_t trains;                             ///< valve trains of each cylinder
};

/// Lengths and masses of one cylinder as the force equations use them. All cylinders are alike.
template <class Real>
struct Body {
  Real crank_radius_m;
  Real per_crank_radius;   ///< 1 / r
  Real per_rod_length;     ///< 1 / l
  Real pin_offset_m;       ///< e
  Real height_at_tdc_m;    ///< h + x = sqrt((r + l)^2 - e^2): piston pin above the crank centre at top dead centre
  Real bore_area_m2;
  Real crankcase_Pa;
  Real reciprocating_kg;               ///< m_j
  Real rod_inertia_correction_kg_m2;   ///< dI
};

/// A piston's motion.
template <class Real>
struct MotionSegment {
  IntegralSegment<Real> displacement;  ///< x, m: the integral of the slope
  Segment<Real> slope;                 ///< dx/da, m/rad
  Segment<Real> acceleration;          ///< d2x/da2, m/rad^2
};
/// How a rod leans on its piston and its crank pin.
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
  std::uint8_t pin_of[kMaxCylinders];        ///< per cylinder
  CylinderGroups by_pin;
  Real rods_kg_m[kMaxCylinders];             ///< per pin: m_rod_crank r, times the rods on it
  Real throw_kg_m[kMaxCylinders];            ///< per pin: m_r r
  Real throw_cos[kMaxCylinders];             ///< per pin: direction of its throw, from that of pin 0 in the sense of rotation
  Real throw_sin[kMaxCylinders];
};

/// One vector that turns with the engine: value = (cos, sin) amplitudes of cos(order A), sin(order A), per w^2.
template <class Real>
struct Turning {
  Real up_cos, up_sin, lateral_cos, lateral_sin;              ///< kg m
  Real pitch_cos, pitch_sin, yaw_cos, yaw_sin;                ///< kg m^2
};

/// Free forces and moments of the whole engine about the middle of its crankshaft.
template <class Real>
struct Balance {
  Turning<Real> first;     ///< reciprocating, first order
  Turning<Real> second;    ///< reciprocating, second order
  Turning<Real> rotating;  ///< centrifugal, first order
  Curve<Real> cosine;      ///< cos of the crank angle
};

/// Gas torque of all cylinders over the cycle, on a GasGrid; its integral is the work less that of the mean torque, so it repeats.
template <class Real>
struct GasTorque {
  const IntegratedSegment<Real>* at;
  Real quantum;
  Real mean_Nm;
};

/// What moves the crank besides gas and the pistons' masses, for scenes that integrate its speed w: docs/model.md "Crank dynamics".
template <class Real>
struct CrankDynamics {
  Real turning_kg_m2;         ///< the part of J_eff that does not change with the angle: crankshaft, driven machine, the rods' big ends
  Real least_kg_m2;           ///< J_eff where it is smallest; 0 where that is less than kLeastInertia_ratio of its largest
  Real drag_Nm;               ///< friction and brake: constant, per |w| and per w^2
  Real drag_Nm_s;
  Real drag_Nm_s2;
  Real starter_stall_Nm;
  Real starter_slope_Nm_s;    ///< stall torque / no-load speed
  Real most_rad_s2;           ///< from one speed limit to the other in a tick: no acceleration is larger
};

/// Least J_eff that is integrated, and least part of its largest: float keeps the difference of the two that make it.
inline constexpr double kLeastInertia_kg_m2 = 1e-9;
inline constexpr double kLeastInertia_ratio = 1e-3;

/// All sections by address; null where there is none. constexpr in flash, so only what a Tables takes from it is linked.
template <class Real>
struct Sections {
  const Drive<Real>* drive = nullptr;
  const Body<Real>* body = nullptr;
  const IntegratedCurve<Real>* stroke = nullptr;         ///< slope dx/da in m/rad, integral x in m: for torque and work of given pressures
  const Revolution<MotionSegment<Real>>* motion = nullptr;
  const Revolution<LeanSegment<Real>>* lean = nullptr;
  const Revolution<RodSegment<Real>>* rod = nullptr;
  const Curve<Real>* rod_curvature = nullptr;            ///< d2b/da2
  const IntegratedCurve<Real>* inertia_torque = nullptr; ///< torque of masses per w^2 in kg m^2, all cylinders, over the engine's angle
  const GasGrid* gas_grid = nullptr;                     ///< of the pressures: a cylinder's own cycle
  const GasGrid* torque_grid = nullptr;                  ///< of the gas torques: the engine's cycle
  // At load ratio q: motored + q heat. A scene without load ratio takes their sum, `full`.
  const Segment<Real>* pressure_full = nullptr;          ///< Pa, on gas_grid
  const Segment<Real>* pressure_motored = nullptr;
  const Segment<Real>* pressure_heat = nullptr;
  const GasTorque<Real>* gas_torque_full = nullptr;      ///< on torque_grid
  const GasTorque<Real>* gas_torque_motored = nullptr;
  const GasTorque<Real>* gas_torque_heat = nullptr;
  const GasGrid* cut_grid = nullptr;                     ///< of the torque that a cut lacks: a cylinder's own cycle
  const GasTorque<Real>* cut_torque = nullptr;           ///< of the heat in one cylinder, on cut_grid
  const CrankDynamics<Real>* crank_dynamics = nullptr;
  const Bearings<Real>* bearings = nullptr;
  const Balance<Real>* balance = nullptr;
  const LiftCurve<Real>* lift_curves = nullptr;      ///< per train
  const ValveMotion<Real>* valve_motions = nullptr;  ///< per train
  const TriggerWheels* triggers = nullptr;
};

namespace part {
// One holder per section: a base of Tables when the scene needs it.
template <class Real> struct BodyRef { const Body<Real>* body = nullptr; };
template <class Real> struct StrokeRef { const IntegratedCurve<Real>* stroke = nullptr; };
template <class Real> struct MotionRef { const Revolution<MotionSegment<Real>>* motion = nullptr; };
template <class Real> struct LeanRef { const Revolution<LeanSegment<Real>>* lean = nullptr; };
template <class Real> struct RodRef { const Revolution<RodSegment<Real>>* rod = nullptr; };
template <class Real> struct RodCurvatureRef { const Curve<Real>* rod_curvature = nullptr; };
template <class Real> struct InertiaTorqueRef { const IntegratedCurve<Real>* inertia_torque = nullptr; };
struct GasGridRef { const GasGrid* gas_grid = nullptr; };
struct TorqueGridRef { const GasGrid* torque_grid = nullptr; };
template <class Real> struct PressureRef { const Segment<Real>* pressure_full = nullptr; };
template <class Real> struct PressureByLoadRef { const Segment<Real>* pressure_motored = nullptr; const Segment<Real>* pressure_heat = nullptr; };
template <class Real> struct GasTorqueRef { const GasTorque<Real>* gas_torque_full = nullptr; };
template <class Real> struct GasTorqueByLoadRef { const GasTorque<Real>* gas_torque_motored = nullptr; const GasTorque<Real>* gas_torque_heat = nullptr; };
template <class Real> struct CutTorqueRef { const GasGrid* cut_grid = nullptr; const GasTorque<Real>* cut_torque = nullptr; };
template <class Real> struct CrankDynamicsRef { const CrankDynamics<Real>* crank_dynamics = nullptr; };
template <class Real> struct BearingsRef { const Bearings<Real>* bearings = nullptr; };
template <class Real> struct BalanceRef { const Balance<Real>* balance = nullptr; };
template <class Real> struct LiftRef { const LiftCurve<Real>* lift_curves = nullptr; };
template <class Real> struct ValveMotionRef { const ValveMotion<Real>* valve_motions = nullptr; };
struct TriggersRef { const TriggerWheels* triggers = nullptr; };
}  // namespace part

/// The sections a scene reads, and no others.
template <class Real, class S>
struct Tables : If<Needs<S>::body, part::BodyRef<Real>>,
                If<Needs<S>::stroke, part::StrokeRef<Real>>,
                If<Needs<S>::motion, part::MotionRef<Real>>,
                If<Needs<S>::lean, part::LeanRef<Real>>,
                If<Needs<S>::rod, part::RodRef<Real>>,
                If<Needs<S>::rod_curvature, part::RodCurvatureRef<Real>>,
                If<Needs<S>::inertia_torque, part::InertiaTorqueRef<Real>>,
                If<Needs<S>::gas_pressure, part::GasGridRef>,
                If<Needs<S>::gas_torque, part::TorqueGridRef>,
                If<Needs<S>::gas_pressure && !Needs<S>::load, part::PressureRef<Real>>,
                If<Needs<S>::gas_pressure && Needs<S>::load, part::PressureByLoadRef<Real>>,
                If<Needs<S>::gas_torque && !Needs<S>::load, part::GasTorqueRef<Real>>,
                If<Needs<S>::gas_torque && Needs<S>::load, part::GasTorqueByLoadRef<Real>>,
                If<Needs<S>::cut_torque, part::CutTorqueRef<Real>>,
                If<Needs<S>::crank_dynamics, part::CrankDynamicsRef<Real>>,
                If<S::bearing_loads, part::BearingsRef<Real>>,
                If<S::free_forces, part::BalanceRef<Real>>,
                If<Needs<S>::any_valves, part::LiftRef<Real>>,
                If<Needs<S>::elastic_valves, part::ValveMotionRef<Real>>,
                If<Needs<S>::any_triggers, part::TriggersRef> {
  const Drive<Real>* drive = nullptr;

  constexpr Tables() = default;
  constexpr explicit Tables(const Sections<Real>& s) noexcept : drive{s.drive} {
    using N = Needs<S>;
    if constexpr (N::body) this->body = s.body;
    if constexpr (N::stroke) this->stroke = s.stroke;
    if constexpr (N::motion) this->motion = s.motion;
    if constexpr (N::lean) this->lean = s.lean;
    if constexpr (N::rod) this->rod = s.rod;
    if constexpr (N::rod_curvature) this->rod_curvature = s.rod_curvature;
    if constexpr (N::inertia_torque) this->inertia_torque = s.inertia_torque;
    if constexpr (N::gas_pressure) this->gas_grid = s.gas_grid;
    if constexpr (N::gas_torque) this->torque_grid = s.torque_grid;
    if constexpr (N::gas_pressure && !N::load) this->pressure_full = s.pressure_full;
    if constexpr (N::gas_pressure && N::load) this->pressure_motored = s.pressure_motored, this->pressure_heat = s.pressure_heat;
    if constexpr (N::gas_torque && !N::load) this->gas_torque_full = s.gas_torque_full;
    if constexpr (N::gas_torque && N::load) this->gas_torque_motored = s.gas_torque_motored, this->gas_torque_heat = s.gas_torque_heat;
    if constexpr (N::cut_torque) this->cut_grid = s.cut_grid, this->cut_torque = s.cut_torque;
    if constexpr (N::crank_dynamics) this->crank_dynamics = s.crank_dynamics;
    if constexpr (S::bearing_loads) this->bearings = s.bearings;
    if constexpr (S::free_forces) this->balance = s.balance;
    if constexpr (N::any_valves) this->lift_curves = s.lift_curves;
    if constexpr (N::elastic_valves) this->valve_motions = s.valve_motions;
    if constexpr (N::any_triggers) this->triggers = s.triggers;
  }
};

}  // namespace crankloop

// What the gas of an engine reads, made at set-up.
//
// What belongs here: constants and curves of walls, ports, manifolds and combustion. What does not: how they are made
// (tabulate/gas_exchange.cpp), how a step uses them (tick/gas/).
#pragma once

#include <cstdint>

#include <crankloop/limits.hpp>

namespace crankloop {

inline constexpr int kPorts = 2;  ///< of a cylinder
inline constexpr int kIntake = 0;
inline constexpr int kExhaust = 1;

}  // namespace crankloop

namespace crankloop::detail {

inline constexpr int kMaxGasSteps = 8;     ///< of a tick
inline constexpr double kGasStep_deg = 5;  ///< a tick that turns the crank further is cut into equal steps

/// What a cylinder's walls take: tick/gas/wall_heat.hpp.
template <class Real>
struct GasWalls {
  Real heat_factor;  ///< 130 k_w 1e-4; 0 = adiabatic
  Real area_m2;      ///< 2 A_p
  Real area_per_m3;  ///< 4 / bore
  Real temperature_K;
  Real piston_m;  ///< mean piston speed per rad/s: stroke / pi
};

/// The cylinders, all the same. Zero in an engine without gas exchange.
template <class Real>
struct GasCylinders {
  GasWalls<Real> walls;
  Real clearance_m3;
  Real bore_area_m2;
  Real crankcase_Pa;
  Real least_kg_m3;      ///< a cylinder never holds less per volume: a thousandth of crankcase pressure at 300 K
  Real per_swept_m3;     ///< 1 / swept volume
  Real per_full_charge;  ///< 1 / (swept volume times density of ambient air), 1/kg
  Real ambient_Pa;       ///< what an engine starts with
  Real ambient_K;
  Real exhaust_K;
  std::uint32_t max_steps;  ///< of a tick, at its speed limit: 1 to kMaxGasSteps
  std::uint32_t spare;
};

/// Effective area of the valves of one train over their lift.
inline constexpr int kFlowSteps = 40;  ///< of 1/80 of the seat's diameter each
template <class Real>
struct GasPortCurve {
  std::uint32_t port;  ///< kIntake or kExhaust
  Real per_step_m;     ///< 1 / length of a step
  Real area_m2[kFlowSteps + 1];
};

/// The gas on the far side of a port or throttle: a manifold as it stands in a step, or what is given.
template <class Real>
struct GasBeyond {
  Real pressure_Pa;
  Real choked_per_Pa;       ///< psi_c / sqrt(R T): choked flow per area and Pa
  Real specific_work_J_kg;  ///< R T
  Real enthalpy_J_kg;
  Real burned_ratio;
  Real response_Pa_kg;  ///< how far its own pressure falls per kg that leaves it; 0: given
  Real end_Pa;          ///< its pressure at the step's end if nothing flows through ports
  Real as_was_Pa;       ///< by how much that moves if all flows through them stay as they were
};

inline constexpr int kThrottleSteps = 100;
/// Intake and exhaust manifold, throttle and outlet.
template <class Real>
struct GasManifolds {
  std::uint32_t parts;  ///< of a tick, at least: more than 1 for small manifolds
  std::uint32_t spare;
  Real per_volume_m3[kPorts];       ///< 1 / V
  Real least_kg[kPorts];            ///< as least_kg_m3
  GasBeyond<Real> outside[kPorts];  ///< before the throttle; behind the outlet, where nothing has flowed out yet
  Real outlet_m2;
  Real throttle_m2[kThrottleSteps + 1];  ///< over the throttle ratio, 0 to 1
};

inline constexpr int kBurnSteps = 512;
/// Share of the fuel that has burned, over the part of the burn.
template <class Real>
struct BurnTable {
  std::uint64_t latch_phase;  ///< of the cylinder's own cycle
  Real energy_J_kg;           ///< q_f: heat, and the energies of what burns and what comes of it
  Real heat_J_kg;             ///< combustion efficiency times lower heating value
  Real burning_J_kg;          ///< what of energy_J_kg fuel that finds no air lacks
  Real burned_kg_kg;          ///< 1 + L
  Real air_fuel_ratio;        ///< L
  Real per_air_fuel_ratio;
  Real span_ratio;  ///< the whole burn's duration by that of the first law
  Real fuel_kg;     ///< as defined, as are the next three
  Real excess_air_ratio;
  Real burn_start_deg;
  Real burn_duration_deg;
  Real burnt[kBurnSteps + 1];
};

}  // namespace crankloop::detail

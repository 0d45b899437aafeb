// Tables of gas exchange and combustion, filled at set-up.
//
// What belongs here: constants and curves of walls, ports, manifolds and combustion. What does not: how they are
// computed (tabulate/gas_exchange.cpp), how a step uses them (tick/gas/).
#pragma once

#include <cstdint>

#include <crankloop/limits.hpp>

namespace crankloop {

inline constexpr int kPorts = 2;  ///< per cylinder
inline constexpr int kIntake = 0;
inline constexpr int kExhaust = 1;

}  // namespace crankloop

namespace crankloop::detail {

inline constexpr int kMaxGasSteps = 8;     ///< per tick
inline constexpr double kGasStep_deg = 5;  ///< a tick that turns the crank further has several equal steps

/// Heat transfer to a cylinder's walls: tick/gas/wall_heat.hpp.
template <class Real>
struct GasWalls {
  Real heat_factor;  ///< 130 k_w 1e-4; 0 = adiabatic
  Real area_m2;      ///< 2 A_p
  Real area_per_m3;  ///< 4 / bore
  Real temperature_K;
  Real piston_m;  ///< mean piston speed per rad/s: stroke / pi
};

/// Constants of a cylinder; all cylinders have the same. Zero in an engine without gas exchange.
template <class Real>
struct GasCylinders {
  GasWalls<Real> walls;
  Real clearance_m3;
  Real bore_area_m2;
  Real crankcase_Pa;
  Real least_kg_m3;      ///< lower limit of the density: a thousandth of crankcase pressure at 300 K
  Real per_swept_m3;     ///< 1 / swept volume
  Real per_full_charge;  ///< 1 / (swept volume times density of ambient air), 1/kg
  Real ambient_Pa;       ///< initial state of the gas, with the next two
  Real ambient_K;
  Real exhaust_K;
  std::uint32_t max_steps;  ///< per tick, at the speed limit: 1 to kMaxGasSteps
  std::uint32_t parts;      ///< bits of GasPart: what a scene must step to run this engine
};

/// Parts of an engine's gas that a scene may leave out where an engine does not have them.
enum GasPart : std::uint32_t { kGasCrevice = 1, kGasRunners = 2, kGasChargeBurn = 4, kGasWalls = 8 };

/// Crevices of a cylinder and its leak into the crankcase: tick/gas/crevice.hpp. Zero in an engine without either.
template <class Real>
struct GasCrevice {
  Real kg_per_Pa;  ///< V_cr / (R T_w)
  Real wall_K;
  Real specific_work_J_kg;  ///< R T_w
  Real energy_J_kg;         ///< of air at T_w
  Real burned_more_J_kg;    ///< energy of burned gas at T_w less that of air
  Real leak_kg_s_Pa;        ///< A_bb psi_c / sqrt(R T_w)
  Real crankcase_Pa;
  std::uint32_t in_use;  ///< 0: neither crevice nor leak
};

/// Effective area of the valves of one train over their lift.
inline constexpr int kFlowSteps = 40;  ///< each 1/80 of the seat's diameter
template <class Real>
struct GasPortCurve {
  std::uint32_t port;  ///< kIntake or kExhaust
  Real per_step_m;     ///< 1 / length of a step
  Real area_m2[kFlowSteps + 1];
};

/// The gas on the far side of a port or throttle: a manifold in the current step, or a given reservoir.
template <class Real>
struct GasBeyond {
  Real pressure_Pa;
  Real choked_per_Pa;       ///< psi_c / sqrt(R T): choked flow per area and Pa
  Real specific_work_J_kg;  ///< R T
  Real enthalpy_J_kg;
  Real burned_ratio;
  Real response_Pa_kg;  ///< its pressure drop per kg that leaves; 0 for a given reservoir
  Real end_Pa;          ///< its pressure at the step's end if no gas flows through the ports
  Real as_was_Pa;       ///< change of end_Pa if all flows through the ports stay as in the last step
};

/// The pipe between a manifold and a port of one cylinder: tick/gas/runner.hpp. Zero where there is none.
template <class Real>
struct GasRunner {
  Real area_m2;            ///< A; 0: none
  Real area_per_length_m;  ///< A / l
  Real loss_per_m4;        ///< zeta / (2 A^2)
  Real per_volume_m3;      ///< 1 / port volume
  Real least_kg;           ///< lower limit of what the port holds
};
template <class Real>
struct GasRunners {
  GasRunner<Real> of[kPorts];
};

inline constexpr int kThrottleSteps = 100;
/// Intake and exhaust manifold, throttle and outlet.
template <class Real>
struct GasManifolds {
  std::uint32_t parts;  ///< minimum number of gas steps per tick: more than 1 for small manifolds
  std::uint32_t spare;
  Real per_volume_m3[kPorts];       ///< 1 / V
  Real least_kg[kPorts];            ///< lower limit of the mass: least_kg_m3 times the volume
  GasBeyond<Real> outside[kPorts];  ///< upstream of the throttle; downstream of the outlet, before any exhaust has left
  Real outlet_m2;
  Real throttle_m2[kThrottleSteps + 1];  ///< over the throttle ratio, 0 to 1
};

inline constexpr int kBurnSteps = 512;
/// Burned fraction of the fuel over the fraction of the burn duration.
template <class Real>
struct BurnTable {
  std::uint64_t latch_phase;  ///< where a cycle's fuel command is latched, in the cylinder's own cycle
  Real energy_J_kg;           ///< q_f: heat released plus energy of the products less that of the air, at 25 C
  Real heat_J_kg;             ///< combustion efficiency times lower heating value
  Real burning_J_kg;          ///< share of energy_J_kg that fuel without air does not release
  Real burned_kg_kg;          ///< 1 + L
  Real air_fuel_ratio;        ///< L
  Real per_air_fuel_ratio;
  Real span_ratio;  ///< duration of the whole burn / that of the first Wiebe function
  Real fuel_kg;     ///< from the definition, with the next three
  Real excess_air_ratio;
  Real burn_start_deg;
  Real burn_duration_deg;
  Real burnt[kBurnSteps + 1];
};

/// Walls that warm up: tick/gas/warm_walls.hpp. Zero in an engine without, but for `ticks`.
template <class Real>
struct WarmWallsTable {
  Real capacity_J_K;  ///< of a cylinder's; 0: fixed
  Real to_coolant_W_K;
  Real coolant_K;
  Real port_W_K[kPorts];   ///< of manifolds, or where there are runners of each port; 0: adiabatic
  Real behind_K;           ///< behind them
  std::uint32_t ticks;     ///< from one change of wall temperatures to the next, a power of 2
  std::uint32_t of_ports;  ///< 1: one of port_W_K is not 0
};

/// Ignition delay of unburned gas: tick/gas/knock.hpp.
template <class Real>
struct KnockTable {
  Real rate;             ///< octaves of 1/tau at 1 Pa and no end of temperature, in 1/s
  Real hot_K;            ///< 3800 K / ln 2
  std::uint32_t in_use;  ///< 0: no octane number
  std::uint32_t spare;
};

/// Lambda of the exhaust and its sensor: tick/gas/exhaust_lambda.hpp. Zero in an engine without.
template <class Real>
struct LambdaTable {
  Real air_fuel_ratio;     ///< L
  Real burned_fuel_ratio;  ///< 1 / (1 + L): the fuel in gas that burned with enough air
  Real unburned_ratio;     ///< L / (1 + L): of a kg that turns into burned gas without air, what that has too much
  Real pipes_in_exhaust;   ///< volume of the exhaust manifold over that of the pipe; 0: no pipe
  Real follows_ratio;      ///< of the sensor, in a tick: 1 - exp(-tick / lag)
  std::uint32_t in_use;
  std::uint32_t spare;
};

/// A burn whose duration follows the charge: tick/gas/charge_burn.hpp.
template <class Real>
struct ChargeBurnTable {
  Real reference;           ///< octaves of (S_0^2 / n_0)^(1/3), S_0 in m/s, n_0 in rad/s
  Real spark_to_start_deg;  ///< in the state of reference
  std::uint32_t in_use;     ///< 0: as ordered
  std::uint32_t spare;
};

}  // namespace crankloop::detail

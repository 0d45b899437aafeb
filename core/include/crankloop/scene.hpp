// The scene: what one use of the model needs. What it leaves out costs no code, no RAM, no flash and no time.
//
// What belongs here: the settings of a scene and what follows from them. What does not: the data (tables, output).
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/limits.hpp>

namespace crankloop {

/// How many cylinders: exactly that many (loops unroll), or up to a capacity with the count taken from the tables.
struct Count {
  std::uint32_t capacity;
  bool exact;
};
template <std::uint32_t N>
inline constexpr Count exactly{N, true};
template <std::uint32_t N>
inline constexpr Count up_to{N, false};

enum class CrankGiven : std::uint8_t {
  speed,   ///< Input::speed_rad_s; the engine counts the angle
  phase,   ///< Input::crank, an absolute angle that the controller measured; the engine works out the speed
  torque,  ///< integrated from gas, masses, friction, driven machine, starter and Input::external_torque_Nm
};

enum class PressureGiven : std::uint8_t {
  none,      ///< crankcase pressure on both sides: inertia only
  by_table,  ///< from the definition's diagram
  by_input,  ///< Input::pressure_Pa, each tick
  by_gas,  ///< of what the cylinder holds: gas flows through the valves as they move, burns, loses heat (docs/model.md
           ///< "Gas")
};

/// Where the gas outside the ports comes from.
enum class Manifold : std::uint8_t {
  given,     ///< Input::intake_Pa and the like, each tick: pure air in, burned gas back
  throttle,  ///< one volume each, behind a throttle and before the exhaust system: Input::throttle_ratio
};

/// What burns in the gas.
enum class Combustion : std::uint8_t {
  none,      ///< motored
  by_table,  ///< fuel and burn of the definition
  by_input,  ///< Input::fuel_kg or excess_air_ratio, burn_start_deg, burn_duration_deg, taken once in a cycle
};

enum class ValveModel : std::uint8_t {
  none,
  following,  ///< lift = the cam's: no dynamics
  elastic,    ///< a mass between train and seat, advanced in time: float and bounce
};

/// Derive from this and redefine what you need; the defaults leave everything out.
///
///     struct MyScene : crankloop::Scene {
///       static constexpr auto cylinders = crankloop::exactly<4>;
///       static constexpr auto pressure = crankloop::PressureGiven::by_table;
///       static constexpr bool mean_torque = true;
///     };
struct Scene {
  static constexpr Count cylinders = exactly<1>;
  static constexpr CrankGiven crank = CrankGiven::speed;
  static constexpr PressureGiven pressure = PressureGiven::none;
  static constexpr Manifold manifold = Manifold::given;  ///< of PressureGiven::by_gas, as are the next two
  static constexpr Combustion combustion = Combustion::none;
  static constexpr bool controller_names =
      false;  ///< Input::spark_advance_deg beside burn_start_deg; throttle, manifold, lambda and coolant once more, by
              ///< a controller's names; needs Manifold::throttle and Combustion::by_input
  static constexpr bool sensor_faults = false;  ///< faults of a controller's sensors: faulty values beside the healthy
                                                ///< ones; needs controller_names
  static constexpr bool boundaries =
      false;  ///< Input::ambient_Pa, ambient_K, back_Pa: boost, altitude, a silencer; needs Manifold::throttle
  static constexpr bool crevice = false;      ///< crevices and blow-by of each cylinder; a definition with either
                                              ///< demands it; needs PressureGiven::by_gas
  static constexpr bool runners = false;      ///< inertia of the gas between manifolds and ports; a definition with a
                                              ///< runner demands it; needs PressureGiven::by_gas
  static constexpr bool walls = false;        ///< walls that warm up, heat of manifolds and runners; a definition with
                                              ///< either demands it; needs PressureGiven::by_gas
  static constexpr bool charge_burn = false;  ///< burns last as long as the charge makes them; a definition that says
                                              ///< so demands it; needs combustion
  static constexpr bool knock = false;  ///< per-cycle result: how far unburned gas came to knock; needs combustion
                                        ///< and a definition with an octane number
  static constexpr bool gas_results = false;  ///< per-cycle results: mean pressures, charge, heat
  static constexpr std::uint32_t lambda_parcels =
      0;  ///< of the pipe to the definition's lambda sensor: lambda of the exhaust and at the sensor; 8 to 256. Needs
          ///< Manifold::throttle and combustion
  static constexpr bool load_ratio = false;  ///< Input::load_ratio scales the heat of a pressure table; else full load
  static constexpr bool rod_inertia =
      false;  ///< take the rod's inertia correction dI into account; a definition with dI != 0 demands it
  static constexpr bool kinematics = false;     ///< displacement, velocity, acceleration of each piston
  static constexpr bool rod_motion = false;     ///< angle, speed, acceleration of each rod
  static constexpr bool torque = false;         ///< engine torque at the tick
  static constexpr bool mean_torque = false;    ///< engine torque averaged over the tick
  static constexpr bool forces = false;         ///< all forces of each cylinder
  static constexpr bool bearing_loads = false;  ///< crank pins and main journals; needs forces
  static constexpr bool free_forces = false;    ///< free forces and moments of first and second order
  static constexpr ValveModel valves = ValveModel::none;
  static constexpr Count trains = exactly<1>;        ///< valve trains per cylinder, where there are valves
  static constexpr bool theoretical_lift = false;    ///< of each cam at its valve
  static constexpr bool valve_acceleration = false;  ///< of each valve
  static constexpr bool valve_forces = false;        ///< forces at train, seat, stem tip and cam; elastic valves
  static constexpr bool valve_results = false;  ///< per-cycle results: float, bounce, seating speed; elastic valves
  static constexpr bool cam_contact = false;    ///< stress, sliding and rolling where cam and follower touch, and the
                                                ///< largest stress of a cycle; elastic valves
  static constexpr bool cam_torque = false;     ///< of each cam, and of the camshaft; elastic valves
  static constexpr bool cam_drag = false;       ///< the crank turns the camshaft: cam_torque, CrankGiven::torque
  static constexpr bool valve_gas =
      false;  ///< cylinder pressure on the valve heads; a train with a head area demands it
  static constexpr std::uint32_t spring_modes = 0;  ///< of a valve's springs together, up to kMaxValveModes, that
                                                    ///< surge; elastic valves. A train with more is refused
  static constexpr bool cam_phasing = false;        ///< Input::cam_phase_deg moves the cams
  static constexpr bool bad_input_count =
      false;  ///< State::bad_input_ticks: how many ticks had a bad input, and of which kinds
  static constexpr bool starter = false;  ///< Input::starter turns the crank; CrankGiven::torque
  static constexpr bool cylinder_cut =
      false;  ///< Input::cut_cylinders: cylinders that do not fire this tick (where gas burns: the cycle whose fuel is
              ///< due); needs load_ratio or combustion
  static constexpr bool misfire = false;         ///< cycles that misfire by the definition's rules, and their counts
                                                 ///< (State::misfire); needs load_ratio or combustion
  static constexpr Count triggers = exactly<0>;  ///< trigger wheels: their signals and the edges in each tick
  static constexpr std::uint32_t wheel_faults =
      0;  ///< faults of trigger wheels that there is room for: faulty signals beside the healthy ones; at most 16
  static constexpr std::uint32_t reluctor_samples =
      0;  ///< voltages in a tick of the definition's variable reluctance sensor, and its comparator: 8, 16 or 32
  static constexpr std::uint32_t trigger_edges =
      8;  ///< of a wheel that a tick has room for; more are counted, but not listed
};

namespace detail {

/// What a scene's settings imply.
template <class S>
struct Needs {
  static constexpr bool table_pressure = S::pressure == PressureGiven::by_table;
  static constexpr bool gas = S::pressure == PressureGiven::by_gas;
  static constexpr bool manifolds = gas && S::manifold == Manifold::throttle;
  static constexpr bool given_gas = gas && (!manifolds || S::boundaries);  ///< by inputs, each tick
  static constexpr bool burn = gas && S::combustion != Combustion::none;
  static constexpr bool burn_input = gas && S::combustion == Combustion::by_input;
  static constexpr bool charge_burn = burn && S::charge_burn;
  static constexpr bool knock = burn && S::knock;
  static constexpr bool lambda = S::lambda_parcels > 0;
  static constexpr bool gas_cut = burn && S::cylinder_cut;
  static constexpr bool crank_dynamics = S::crank == CrankGiven::torque;
  static constexpr bool any_torque = S::torque || S::mean_torque || crank_dynamics;
  static constexpr bool work = S::mean_torque || crank_dynamics;  ///< of a tick, as a difference of integrals
  static constexpr bool any_valves = S::valves != ValveModel::none;
  static constexpr bool elastic_valves = S::valves == ValveModel::elastic;
  static constexpr bool surge = S::spring_modes > 0;
  static constexpr bool valve_push = S::valve_gas || surge;  ///< forces on the valves from outside their equation
  static constexpr bool valves_rest = elastic_valves && !valve_push;  ///< pushed they never do, or not for long
  static constexpr bool spring_forces = surge && S::valve_forces;
  static constexpr bool cylinder_pressure = S::forces || (elastic_valves && S::valve_gas && !gas);
  static constexpr bool input_pressure = S::pressure == PressureGiven::by_input && (any_torque || cylinder_pressure);
  /// With forces asked for, the torque at the tick is their sum; without, it is read from torque curves.
  static constexpr bool torque_curves = work || (S::torque && !S::forces);

  static constexpr bool body = S::forces || (any_torque && input_pressure) || cylinder_pressure || gas;
  static constexpr bool motion = S::kinematics || S::forces;
  static constexpr bool given_torque =
      any_torque && (input_pressure || gas);                  ///< of gas, from pressures and not from curves
  static constexpr bool given_work = work && input_pressure;  ///< of gas, from pressures and not from curves
  static constexpr bool gas_work = work && gas;
  static constexpr bool stroke = given_work || ((given_torque || gas) && !motion) || (gas && crank_dynamics);
  static constexpr bool lean = S::forces;
  static constexpr bool rod = S::rod_motion;
  static constexpr bool rod_curvature = S::rod_motion || (S::forces && S::rod_inertia);
  static constexpr bool shown_by_cylinder = motion || rod || cylinder_pressure;
  static constexpr bool inertia_torque = torque_curves;
  static constexpr bool gas_torque = torque_curves && table_pressure;
  static constexpr bool gas_pressure = cylinder_pressure && table_pressure;
  static constexpr bool load = S::load_ratio && table_pressure;
  static constexpr bool cut = S::cylinder_cut && table_pressure;
  static constexpr bool misfire_of_table = S::misfire && table_pressure;
  static constexpr bool lack = cut || misfire_of_table;  ///< cylinders may lack heat of the table, or all of it
  static constexpr bool cam_loads = S::cam_contact || S::cam_torque;
  static constexpr bool cycle_ends = S::valve_results || S::cam_contact;  ///< of valves are noticed
  static constexpr bool valve_gas_held = S::valve_gas && !gas;  ///< the force of the last tick is part of the state
  static constexpr bool cut_torque =
      lack && torque_curves;  ///< the engine's gas torque less that of cylinders which do not fire
  static constexpr bool mechanisms = stroke || shown_by_cylinder;
  static constexpr bool any_triggers = S::triggers.capacity > 0;
  static constexpr bool faulty_wheels = S::wheel_faults > 0;
  static constexpr bool reluctor = S::reluctor_samples > 0;
  static constexpr std::uint32_t valve_count = any_valves ? S::trains.capacity * S::cylinders.capacity : 0;
};

/// The rules every scene keeps, each with its sentence.
template <class S>
struct CheckedScene {
  static_assert(S::cylinders.capacity >= 1, "a scene has at least one cylinder");
  static_assert(S::cylinders.capacity <= kMaxCylinders, "a scene has at most 16 cylinders");
  static_assert(!S::bearing_loads || S::forces, "bearing_loads are made from forces: ask for forces too");
  static_assert(!S::load_ratio || S::pressure == PressureGiven::by_table,
                "load_ratio scales a pressure table: set pressure = by_table");
  static_assert(!S::cylinder_cut || S::load_ratio || Needs<S>::burn,
                "a cut cylinder has the pressure of load ratio 0: set load_ratio too");
  static_assert(!S::misfire || S::load_ratio || Needs<S>::burn,
                "a misfiring cycle lacks heat of a pressure table with load_ratio, or of gas that burns: set one");
  static_assert(S::pressure != PressureGiven::by_gas || S::valves != ValveModel::none,
                "gas flows through valves: ask for elastic or following ones");
  static_assert(S::pressure == PressureGiven::by_gas ||
                    (S::manifold == Manifold::given && S::combustion == Combustion::none && !S::gas_results),
                "manifold, combustion and gas_results are of gas: set pressure = by_gas");
  static_assert(!S::crevice || Needs<S>::gas, "crevices hold gas of a cylinder: set pressure = by_gas");
  static_assert(!S::runners || Needs<S>::gas, "runners lead gas to the ports: set pressure = by_gas");
  static_assert(!S::charge_burn || Needs<S>::burn, "charge_burn is of combustion: ask for it too");
  static_assert(!S::walls || Needs<S>::gas, "walls take heat of gas: set pressure = by_gas");
  static_assert(!S::knock || Needs<S>::burn, "knock is of combustion: ask for it too");
  static_assert(!Needs<S>::lambda || (Needs<S>::manifolds && Needs<S>::burn),
                "lambda is of an exhaust manifold: set manifold = throttle, and combustion");
  static_assert(S::lambda_parcels <= 256 && S::lambda_parcels % 8 == 0, "lambda_parcels is 8, 16, ... 256");
  static_assert(!S::boundaries || Needs<S>::manifolds, "boundaries are outside the manifolds: set manifold = throttle");
  static_assert(!S::controller_names || (Needs<S>::manifolds && Needs<S>::burn_input),
                "controller_names are of throttle and spark: set manifold = throttle, combustion = by_input");
  static_assert(!S::sensor_faults || S::controller_names,
                "sensor_faults are of a controller's sensors: set controller_names");
  static_assert(!S::starter || S::crank == CrankGiven::torque,
                "a starter needs a crank that is turned by forces: set crank = torque");
  static_assert(S::valves == ValveModel::none || (S::trains.capacity >= 1 && S::trains.capacity <= kMaxTrains),
                "a cylinder has 1 to 4 valve trains");
  static_assert(S::valves == ValveModel::elastic || (!S::valve_forces && !S::valve_results && !S::valve_gas),
                "valve forces, results and gas force need elastic valves");
  static_assert(S::valves == ValveModel::elastic || S::spring_modes == 0, "springs surge at elastic valves");
  static_assert(S::spring_modes <= kMaxValveModes, "a valve's springs have at most 6 modes");
  static_assert(S::valves == ValveModel::elastic || (!S::cam_contact && !S::cam_torque),
                "cam_contact and cam_torque need elastic valves");
  static_assert(!S::cam_drag || (S::cam_torque && S::crank == CrankGiven::torque),
                "cam_drag needs cam_torque, and a crank that is turned by forces: set crank = torque");
  static_assert(S::valves != ValveModel::none || !S::cam_phasing, "cam_phasing needs valves");
  static_assert(S::valves != ValveModel::none || (!S::theoretical_lift && !S::valve_acceleration),
                "theoretical_lift and valve_acceleration need valves");
  static_assert(!S::valve_gas || S::pressure != PressureGiven::none, "valve_gas needs a pressure");
  static_assert(S::triggers.capacity <= kMaxTriggerWheels, "an engine has at most 8 trigger wheels");
  static_assert(S::wheel_faults == 0 || S::triggers.capacity > 0, "wheel_faults are of trigger wheels: set triggers");
  static_assert(S::wheel_faults <= kMaxWheelFaults, "an engine has at most 16 faults of trigger wheels");
  static_assert(S::reluctor_samples == 0 || S::reluctor_samples == 8 || S::reluctor_samples == 16 ||
                    S::reluctor_samples == 32,
                "reluctor_samples is 8, 16 or 32");
  static_assert(S::reluctor_samples == 0 || S::triggers.capacity > 0,
                "a reluctor's sensor is at a trigger wheel: set triggers");
  static_assert(S::trigger_edges >= 1 && S::trigger_edges <= 2 * kMaxTriggerEdges,
                "trigger_edges is 1 to 1440: two turns of the finest wheel");
  static constexpr bool value = true;
};

/// A group that a scene left out: a distinct empty base, so that it takes no room.
template <class Group>
struct Without {};
template <bool Has, class Group>
using If = std::conditional_t<Has, Group, Without<Group>>;

}  // namespace detail
}  // namespace crankloop

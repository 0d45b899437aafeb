// The scenes that the benchmark runs, compiled one per source file with the library's own flags, as crankloop_add_scene
// does it.
//
// What belongs here: the settings of each scene. What does not: engines (engines.hpp), timing.
#pragma once

#include <crankloop/engine.hpp>
#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::program::bench {

/// One valve and nothing else.
struct LoneElastic : Scene {
  static constexpr ValveModel valves = ValveModel::elastic;
};
struct LoneFollowing : Scene {
  static constexpr ValveModel valves = ValveModel::following;
};

/// Torque at the tick, of four cylinders whose pressures are given.
struct FourTorque : Scene {
  static constexpr Count cylinders = exactly<4>;
  static constexpr PressureGiven pressure = PressureGiven::by_input;
  static constexpr bool torque = true;
};
/// And the pistons' motion.
struct FourMotion : FourTorque {
  static constexpr bool kinematics = true;
};
/// And every force of each cylinder.
struct FourForces : FourMotion {
  static constexpr bool forces = true;
};

/// The whole tick of the ratios: pistons, torque, valves; `Trains` different ones per cylinder.
template <std::uint32_t Trains>
struct FourElastic : FourMotion {
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr Count trains = exactly<Trains>;
};
template <std::uint32_t Trains>
struct FourFollowing : FourElastic<Trains> {
  static constexpr ValveModel valves = ValveModel::following;
};
/// Torque and valves without the pistons' motion.
struct FourTorqueElastic : FourElastic<2> {
  static constexpr bool kinematics = false;
};
/// With the valves' forces and the record of each cycle.
struct FourElasticForces : FourElastic<2> {
  static constexpr bool valve_forces = true;
};
struct FourElasticResults : FourElasticForces {
  static constexpr bool valve_results = true;
};

/// Any engine: counts come from the tables.
struct AnyMotion : FourMotion {
  static constexpr Count cylinders = up_to<kMaxCylinders>;
};
struct AnyElastic : AnyMotion {
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr Count trains = up_to<kMaxTrains>;
};

}  // namespace crankloop::program::bench

namespace crankloop {

extern template class Engine<float, program::bench::LoneElastic>;
extern template class Engine<double, program::bench::LoneElastic>;
extern template class Engine<float, program::bench::LoneFollowing>;
extern template class Engine<double, program::bench::LoneFollowing>;
extern template class Engine<float, program::bench::FourTorque>;
extern template class Engine<float, program::bench::FourMotion>;
extern template class Engine<double, program::bench::FourMotion>;
extern template class Engine<float, program::bench::FourForces>;
extern template class Engine<float, program::bench::FourElastic<2>>;
extern template class Engine<double, program::bench::FourElastic<2>>;
extern template class Engine<float, program::bench::FourElastic<4>>;
extern template class Engine<double, program::bench::FourElastic<4>>;
extern template class Engine<float, program::bench::FourFollowing<2>>;
extern template class Engine<float, program::bench::FourTorqueElastic>;
extern template class Engine<float, program::bench::FourElasticForces>;
extern template class Engine<float, program::bench::FourElasticResults>;
extern template class Engine<float, program::bench::AnyMotion>;
extern template class Engine<float, program::bench::AnyElastic>;

}  // namespace crankloop

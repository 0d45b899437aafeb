// Scenes for tests/tidy.sh: what no ready-made scene requests, so that clang-tidy sees every template of the tick.
#include <crankloop/scenes.hpp>
#include <crankloop/tick/state/saved_state.hpp>
#include <crankloop/tick/step.hpp>

namespace crankloop {

struct AllTurnedByForces : scenes::BreathingFree {
  static constexpr bool kinematics = true;
  static constexpr bool rod_motion = true;
  static constexpr bool forces = true;
  static constexpr bool bearing_loads = true;
  static constexpr bool free_forces = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
  static constexpr bool cam_contact = true;
  static constexpr bool cam_torque = true;
  static constexpr bool cam_drag = true;
  static constexpr std::uint32_t spring_modes = kMaxValveModes;
  static constexpr bool cam_phasing = true;
  static constexpr bool bad_input_count = true;
};
struct AllMeasured : scenes::MeasuredMotion {
  static constexpr PressureGiven pressure = PressureGiven::by_input;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
  static constexpr ValveModel valves = ValveModel::following;
  static constexpr Count trains = up_to<kMaxTrains>;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool cam_phasing = true;
  static constexpr Count triggers = up_to<kMaxTriggerWheels>;
};

template class Engine<float, AllTurnedByForces>;
template class Engine<double, AllTurnedByForces>;
template class Engine<float, AllMeasured>;
template class Engine<double, AllMeasured>;
template Status save_state(const Engine<float, AllTurnedByForces>&, unsigned char*, std::size_t) noexcept;
template Status load_state(const unsigned char*, std::size_t, Engine<float, AllTurnedByForces>&) noexcept;

}  // namespace crankloop

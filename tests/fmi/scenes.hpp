// Scenes whose FMUs are tested: each ready-made one, exact counts, trigger wheels, a valve that bounces.
#pragma once

#include <crankloop/scenes.hpp>

struct Whole : crankloop::scenes::Whole {};
struct FreeRunning : crankloop::scenes::FreeRunning {};
struct BreathingFree : crankloop::scenes::BreathingFree {};
struct MeasuredMotion : crankloop::scenes::MeasuredMotion {};
struct TorqueByTable : crankloop::scenes::TorqueByTable {};
struct TorqueByPressure : crankloop::scenes::TorqueByPressure {};

struct FourPistons : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr bool kinematics = true;
  static constexpr bool bad_input_count = true;
};

struct TriggerWheels : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto triggers = crankloop::exactly<2>;
  static constexpr std::uint32_t trigger_edges = 6;
};

struct BouncingValve : crankloop::Scene {
  static constexpr auto valves = crankloop::ValveModel::elastic;
  static constexpr auto trains = crankloop::up_to<2>;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
};

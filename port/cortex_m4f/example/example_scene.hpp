// What this firmware wants of the model: the torque of the last tick and the motion of eight elastic valves.
#pragma once

#include <crankloop/scene.hpp>

struct ExampleScene : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool mean_torque = true;
  static constexpr auto valves = crankloop::ValveModel::elastic;
  static constexpr auto trains = crankloop::exactly<2>;
};

// A scene of one elastic valve.
#pragma once

#include <crankloop/scene.hpp>

struct MyValve : crankloop::Scene {
  static constexpr auto valves = crankloop::ValveModel::elastic;
  static constexpr bool valve_results = true;
};

// my_scene.hpp
#pragma once
#include <crankloop/scene.hpp>

struct MyScene : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool mean_torque = true;
};

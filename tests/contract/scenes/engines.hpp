// The engines of all scenes in a row, and inputs that keep them busy, so that a program can run whatever there is.
//
// What belongs here: what the programs of this folder share. What does not: what they look for.
#pragma once

#include <cstdint>
#include <limits>
#include <tuple>
#include <type_traits>

#include "ForcesAndTorque_double.hpp"
#include "ForcesAndTorque_float.hpp"
#include "PistonMotion_double.hpp"
#include "PistonMotion_float.hpp"
#include "TorqueOnly_double.hpp"
#include "TorqueOnly_float.hpp"
#include "TriggerSignals_double.hpp"
#include "TriggerSignals_float.hpp"
#include "ValveDynamics_double.hpp"
#include "ValveDynamics_float.hpp"
#include "ValveLift_double.hpp"
#include "ValveLift_float.hpp"
#include "WholeEngine_double.hpp"
#include "WholeEngine_float.hpp"

using Engines = std::tuple<PistonMotion_float::Engine, PistonMotion_double::Engine, TorqueOnly_float::Engine,
                           TorqueOnly_double::Engine, ForcesAndTorque_float::Engine, ForcesAndTorque_double::Engine,
                           ValveLift_float::Engine, ValveLift_double::Engine, ValveDynamics_float::Engine,
                           ValveDynamics_double::Engine, TriggerSignals_float::Engine, TriggerSignals_double::Engine,
                           WholeEngine_float::Engine, WholeEngine_double::Engine>;

/// Runs up and down between 600 and 2400 rpm, backwards now and then; one input in a thousand is bad.
template <class Engine>
[[nodiscard]] typename Engine::Input input_at(long tick) {
  typename Engine::Input in;
  using Real = decltype(in.speed_rad_s);
  const long ramp = tick % 4000 < 2000 ? tick % 2000 : 2000 - tick % 2000;
  const double speed_rad_s = 63 + 0.094 * static_cast<double>(ramp);
  in.speed_rad_s = static_cast<Real>(tick % 50000 < 48000 ? speed_rad_s : -speed_rad_s);
  if (tick % 1000 == 999) in.speed_rad_s = std::numeric_limits<Real>::quiet_NaN();
  if constexpr (std::is_base_of_v<crankloop::group::LoadInput<Real>, typename Engine::Input>)
    in.load_ratio = static_cast<Real>(tick % 3) / 2;
  return in;
}

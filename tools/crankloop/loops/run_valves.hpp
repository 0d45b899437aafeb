// The quantities of one valve that `run` shows, and the results of a valve train over some cycles.
//
// What belongs here: the list, once, for CSV columns, peaks and plots; results over all cylinders. What does not: their
// use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <crankloop/scenes.hpp>

#include "../engine_file/engine_file.hpp"
#include "run_quantities.hpp"
#include "valve_cycle.hpp"

namespace crankloop::program {

/// In the order of the CSV columns.
enum class ValveQuantity : std::uint8_t {
  theoretical_lift,
  lift,
  velocity,
  acceleration,
  train_force,
  seat_force,
  cam_force,
  compression,
};
inline constexpr std::size_t kValveQuantities = 8;

[[nodiscard]] constexpr std::size_t index_of(ValveQuantity quantity) noexcept {
  return static_cast<std::size_t>(quantity);
}

using ValveQuantityKind = KindOf<ValveQuantity>;
inline constexpr ValveQuantityKind kValveQuantityKinds[kValveQuantities] = {
    {ValveQuantity::theoretical_lift, "theoretical_lift", "mm", "mm", 1e3},
    {ValveQuantity::lift, "lift", "mm", "mm", 1e3},
    {ValveQuantity::velocity, "velocity", "m_s", "m/s", 1},
    {ValveQuantity::acceleration, "acceleration", "m_s2", "m/s^2", 1},
    {ValveQuantity::train_force, "train_force", "N", "N", 1},
    {ValveQuantity::seat_force, "seat_force", "N", "N", 1},
    {ValveQuantity::cam_force, "cam_force", "N", "N", 1},
    {ValveQuantity::compression, "train_compression", "mm", "mm", 1e3},
};

/// In SI, in the order of ValveQuantity.
template <class Real, class S>
[[nodiscard]] std::array<Real, kValveQuantities> values_of(const crankloop::Output<Real, S>& out, std::size_t train,
                                                           std::size_t cylinder) noexcept {
  const ValveMotionOutput<Real, S>& m = out.valve[train][cylinder];
  const ValveForcesOutput<Real>& f = out.valve_forces[train][cylinder];
  return {m.theoretical_lift_m, m.lift_m, m.velocity_m_s, m.acceleration_m_s2, f.train_N, f.seat_N, f.cam_N,
          f.train_compression_m};
}

/// Of each result the worst of two cycles; start and duration are those of the larger separation.
[[nodiscard]] ValveCycle<double> worse_of(const ValveCycle<double>& a, const ValveCycle<double>& b) noexcept;

/// The complete valve trains of a file by name, in the order of definition().trains.
[[nodiscard]] std::vector<std::string> names_of_trains(const EngineFile& file);

}  // namespace crankloop::program

// The quantities of one valve that `run` shows, and what a run of some cycles found of a valve train.
//
// What belongs here: the list, once, for CSV columns, peaks and plots; results over all cylinders. What does not: what
// is done with them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <crankloop/tick/scenes.hpp>

#include "../engine_file/engine_file.hpp"
#include "run_quantities.hpp"

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
  gap,
};
inline constexpr std::size_t kValveQuantities = 8;

[[nodiscard]] constexpr std::size_t index_of(ValveQuantity quantity) noexcept {
  return static_cast<std::size_t>(quantity);
}

/// How a quantity is written: value in SI times `per_si`, in a unit that stands in CSV names as `suffix`.
struct ValveQuantityKind {
  ValveQuantity quantity;
  const char* name;
  const char* suffix;
  const char* unit;
  double per_si;
};
inline constexpr ValveQuantityKind kValveQuantityKinds[kValveQuantities] = {
    {ValveQuantity::theoretical_lift, "theoretical_lift", "mm", "mm", 1e3},
    {ValveQuantity::lift, "lift", "mm", "mm", 1e3},
    {ValveQuantity::velocity, "velocity", "m_s", "m/s", 1},
    {ValveQuantity::acceleration, "acceleration", "m_s2", "m/s^2", 1},
    {ValveQuantity::train_force, "train_force", "N", "N", 1},
    {ValveQuantity::seat_force, "seat_force", "N", "N", 1},
    {ValveQuantity::cam_force, "cam_force", "N", "N", 1},
    {ValveQuantity::gap, "gap", "mm", "mm", 1e3},
};

/// In SI.
template <class Real>
[[nodiscard]] Real value_of(const WholeOutput<Real>& out, ValveQuantity quantity, std::size_t train,
                            std::size_t cylinder) noexcept {
  const ValveMotionOutput<Real>& motion = out.valve[train][cylinder];
  const ValveForcesOutput<Real>& forces = out.valve_forces[train][cylinder];
  switch (quantity) {
    case ValveQuantity::theoretical_lift:
      return motion.theoretical_lift_m;
    case ValveQuantity::lift:
      return motion.lift_m;
    case ValveQuantity::velocity:
      return motion.velocity_m_s;
    case ValveQuantity::acceleration:
      return motion.acceleration_m_s2;
    case ValveQuantity::train_force:
      return forces.train_N;
    case ValveQuantity::seat_force:
      return forces.seat_N;
    case ValveQuantity::cam_force:
      return forces.cam_N;
    case ValveQuantity::gap:
      return forces.gap_m;
  }
  return Real{0};
}

/// A cycle's results in double.
template <class Real>
[[nodiscard]] ValveCycle<double> in_double(const ValveCycle<Real>& c) noexcept {
  const auto wide = [](Real x) { return static_cast<double>(x); };
  return {wide(c.largest_lift_m),
          wide(c.largest_speed_m_s),
          wide(c.largest_acceleration_m_s2),
          wide(c.opening_delay_deg),
          wide(c.separation_gap_m),
          wide(c.separation_start_deg),
          wide(c.separation_duration_deg),
          wide(c.seating_speed_m_s),
          wide(c.bounce_height_m),
          c.separations,
          c.bounces,
          c.contact_changes,
          c.off_seat_at_end};
}

/// Of each result the worst of two cycles; start and duration are those of the larger separation.
[[nodiscard]] ValveCycle<double> worse_of(const ValveCycle<double>& a, const ValveCycle<double>& b) noexcept;

/// The complete valve trains of a file by name, in the order of definition().trains.
[[nodiscard]] std::vector<std::string> names_of_trains(const EngineFile& file);

}  // namespace crankloop::program

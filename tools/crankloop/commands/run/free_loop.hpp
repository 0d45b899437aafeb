// The engine turned by its own gas, as a controller's test bench runs it: `crankloop run --free`.
//
// What belongs here: stepping, and what a tick has come to, in double. What does not: what a run makes of it
// (free_cycles.hpp, free_energy.hpp), files (free_run.cpp).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include <crankloop/crankloop.hpp>
#include <crankloop/scenes.hpp>

#include "../../engine_file/engine_file.hpp"
#include "../../engine_file/gas_order.hpp"
#include "../../files/units.hpp"
#include "../../loops/input_schedule.hpp"

namespace crankloop::program {

/// As many as it takes to cover the time.
[[nodiscard]] inline std::uint64_t ticks_of(double seconds, double tick_s) noexcept {
  constexpr double kRounding = 1e-6;  // 2 s are 20000 ticks of 100 us, however the quotient is rounded
  return static_cast<std::uint64_t>(std::ceil(seconds / tick_s - kRounding));
}

/// How the engine is let run. All of it holds for the whole run, but for the inputs of a schedule.
struct FreeOperation {
  double tick_s = 100e-6;
  double load_ratio = 1;
  double from_rpm = 0;  ///< negative = backwards
  double seconds = 2;
  bool starter = false;
  std::uint32_t cut_cylinders = 0;                  ///< bit k: cylinder k does not fire
  std::uint32_t wheel_faults = 0;                   ///< bit b: faults of input_bit b are on
  GasOrder gas{};                                   ///< of an engine with gas exchange, instead of the load ratio
  std::shared_ptr<const InputSchedule> schedule{};  ///< inputs over time; null: none

  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_of(seconds, tick_s); }
};

/// The crank at the end of a tick, and what has passed since the run began at cylinder 1's firing top dead centre.
struct FreeState {
  double time_s = 0;
  double angle_deg = 0;  ///< turned, without end: backwards it falls
  double speed_rad_s = 0;
  double acceleration_rad_s2 = 0;
  double torque_Nm = 0;   ///< of gas and masses, as in crankloop::Torque
  double work_J = 0;      ///< of that torque
  double external_J = 0;  ///< taken by the external torque

  [[nodiscard]] double speed_rpm() const noexcept { return speed_rad_s * kRpmPerRad_s; }
};

/// `angle_deg` within the cycle, 0 to below 720.
[[nodiscard]] double in_cycle_deg(double angle_deg) noexcept;

/// S is FreeRunning, or BreathingFree for an engine with gas exchange.
template <class Real, class S = scenes::FreeRunning>
class FreeLoop {
 public:
  using Engine = crankloop::Engine<Real, S>;
  using Output = typename Engine::Output;

  /// `definition` is the file's, perhaps with another load. Throws UsageError for a speed beyond one revolution per
  /// tick or too many ticks, InputError for an engine that cannot run free.
  FreeLoop(const EngineFile& file, const EngineDefinition& definition, const FreeOperation& operation);

  const Output& step() noexcept;  ///< with the schedule's inputs as they are when the tick begins

  [[nodiscard]] const Output& output() const noexcept { return engine_.output(); }
  [[nodiscard]] const Engine& engine() const noexcept { return engine_; }
  [[nodiscard]] const detail::EngineShape& shape() const noexcept { return shape_; }
  [[nodiscard]] const FreeState& state() const noexcept { return state_; }
  [[nodiscard]] const MisfireRecord& misfires_of(std::size_t cylinder) const noexcept {
    return engine_.state().misfire[cylinder];
  }
  [[nodiscard]] const FreeState& before() const noexcept { return before_; }  ///< the last tick

 private:
  using Tables = TableStorage<Real, S, kMaxGasSegments>;  // the program has memory

  std::unique_ptr<Tables> tables_ = std::make_unique<Tables>();
  Engine engine_;
  typename Engine::Input input_;
  detail::EngineShape shape_;
  std::optional<InputSchedule> schedule_;
  std::array<double, kMaxSceneInputs> inputs_{};
  double tick_s_;
  std::uint64_t ticks_ = 0;
  std::int64_t cycles_ = 0;
  FreeState state_;
  FreeState before_;
};

}  // namespace crankloop::program

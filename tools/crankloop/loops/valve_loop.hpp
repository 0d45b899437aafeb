// One valve train alone at constant speed: what `valve` shows and `redline` searches.
//
// What belongs here: the train out of its file, and the loop over whole cycles. What does not: output (valve.cpp,
// redline.cpp).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <crankloop/engine.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/spring_margin.hpp>
#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tabulate/valve_lift.hpp>

#include "../engine_file/engine_file.hpp"

namespace crankloop::program {

/// One train of one cylinder; with a head area the cylinder's pressure acts on the valve, and its springs surge if they
/// have modes.
struct OneValve : Scene {
  static constexpr PressureGiven pressure = PressureGiven::by_table;
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
  static constexpr bool valve_gas = true;
  static constexpr std::uint32_t spring_modes = kMaxValveModes;
};

/// Cylinder 1 of an engine file with one of its trains. A train needs neither [engine] nor [crank]; without a pressure
/// source, or without an area of the head, no gas acts on the valve. The file must outlive it.
class LoneValve {
 public:
  /// Refuses an unknown train, one that lacks a part, and what ValveLift refuses.
  LoneValve(const EngineFile& file, const std::string& name);

  /// The same train with another valve, for a study of its influence.
  [[nodiscard]] LoneValve with(const Valve& valve) const;

  [[nodiscard]] const EngineFile& file() const noexcept { return file_; }
  [[nodiscard]] const TrainOfFile& train() const noexcept { return train_; }
  [[nodiscard]] const EngineDefinition& definition() const noexcept { return definition_; }
  [[nodiscard]] const Valve& valve() const noexcept { return definition_.trains[0].valve; }
  [[nodiscard]] const ValveLift& lift() const noexcept { return *lift_; }
  [[nodiscard]] detail::ValveBody<double> body() const noexcept;
  [[nodiscard]] StaticRedline static_redline() const noexcept;

  /// Cam angle from full lift of what the tick counts from the start of the lobe.
  [[nodiscard]] double cam_deg(double since_opening_deg) const noexcept;

 private:
  const EngineFile& file_;
  const TrainOfFile& train_;
  EngineDefinition definition_;
  std::shared_ptr<const ValveLift> lift_;
};

/// Whether the gas of full load presses on the valve's head.
[[nodiscard]] bool gas_acts(const LoneValve& valve) noexcept;
/// The same in words, with the reason where it does not.
[[nodiscard]] std::string gas_on_head(const LoneValve& valve);

/// The tick's integrator, or the textbook's in its place.
struct ValveMethod {
  ValveStepping stepping{};
  bool textbook = false;
};

/// After a tick. SI; cam angle from full theoretical lift.
template <class Real>
struct ValveTickOutput {
  double cam_deg;
  ValveMotionOutput<Real, OneValve> motion;
  ValveForcesOutput<Real> forces;
  ValveSpringOutput<Real> springs;
};

/// The loop of one train. Copying it copies the valve's position: both then run independently.
template <class Real>
class ValveLoop {
 public:
  /// Throws InputError where a tick would need too many sub-steps; the message names the longest tick possible.
  ValveLoop(const LoneValve& valve, double tick_s, const ValveMethod& method);

  /// Stops the valve on its seat, and puts the cam where `ticks` ticks at this speed take it to `cam_deg`. Throws
  /// UsageError for a speed beyond one revolution per tick.
  void start(double speed_rpm, double cam_deg, std::uint64_t ticks);

  void step() noexcept;

  [[nodiscard]] ValveTickOutput<Real> output() const noexcept;
  [[nodiscard]] const ValveCycle<Real>& last_cycle() const noexcept;
  [[nodiscard]] std::uint32_t faults() const noexcept { return faults_; }  ///< of all ticks since the start

  [[nodiscard]] double deg_per_tick(double speed_rpm) const noexcept;  ///< cam degrees, with sign
  [[nodiscard]] const detail::LiftCurve<Real>& curve() const noexcept { return tables().lift_curves[0]; }
  [[nodiscard]] double surge_error_ratio() const noexcept { return report_.surge_error_ratio; }
  [[nodiscard]] const detail::ValveMotion<Real>& motion() const noexcept { return tables().valve_motions[0]; }

 private:
  using OneEngine = Engine<Real, OneValve>;
  using Storage = TableStorage<Real, OneValve, kMaxGasSegments>;

  /// The textbook's valve and its state.
  struct Textbook {
    detail::ValveInRegime<Real> valve;
    detail::ValveRecord<Real> record;
    ValveCycle<Real> cycle;
    Real cam_deg_s;
    Real gas_N;
  };

  [[nodiscard]] const Tables<Real, OneValve>& tables() const noexcept { return storage_->tables(); }
  [[nodiscard]] Phase turned(double speed_rpm) const noexcept;
  [[nodiscard]] std::uint64_t since_opening(Phase phase) const noexcept { return phase.units() - curve().opens[0]; }
  void textbook_step(Phase before, Phase after) noexcept;

  double full_lift_deg_;
  bool is_textbook_;
  double head_area_m2_;
  double crankcase_Pa_;
  std::shared_ptr<Storage> storage_;
  TableReport report_;
  std::shared_ptr<const IndicatorDiagram> diagram_;
  OneEngine engine_;
  typename OneEngine::Input input_;
  Textbook textbook_{};
  std::uint32_t faults_ = 0;
  double start_cam_deg_ = 0;
  double deg_per_tick_ = 0;
  std::int64_t ticks_ = 0;  ///< since start_cam_deg_; negative before it
};

/// Called for every tick of a recorded cycle.
template <class Real>
using OnValveTick = std::function<void(const ValveTickOutput<Real>&)>;

/// Runs `cycles` cycles from rest. The last goes from -180 to 180 deg of cam angle (backwards from 180 to -180) and is
/// shown tick by tick, its first at the very start; its results are returned. Throws UsageError where that would take
/// more than kMaxTicks.
template <class Real>
ValveCycle<Real> run_cycles(ValveLoop<Real>& loop, const LoneValve& valve, double speed_rpm, int cycles,
                            const OnValveTick<Real>& on_tick, const std::function<void()>& after_tick = {});

/// Largest difference of lift between the last of `cycles` cycles (2 at least) and the one before, at equal cam angles:
/// with a tick of which a whole number makes a cycle, the one next below.
template <class Real>
double largest_change_of_lift_m(const LoneValve& valve, double speed_rpm, double tick_s, const ValveMethod& method,
                                int cycles, const std::function<void()>& after_tick = {});

/// Ticks of one cycle, not a whole number.
[[nodiscard]] double ticks_per_cycle(double speed_rpm, double tick_s) noexcept;

}  // namespace crankloop::program

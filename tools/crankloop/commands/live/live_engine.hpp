// The engine that `live` steps: its tables, its inputs from wherever, its outputs for the block.
//
// What belongs here: one engine and a tick of it. What does not: whose inputs they are (live_inputs.hpp), when a tick
// is due (live_loop.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/crankloop.hpp>

#include "../../engine_file/following_springs.hpp"
#include "../../loops/run_limits.hpp"
#include "../../loops/scene_inputs.hpp"
#include "../../loops/valve_tick_limit.hpp"
#include "live_loop.hpp"
#include "live_scenes.hpp"
#include "live_signals.hpp"

namespace crankloop::program {

/// A controller may write any number: one beyond the type's range becomes infinite, which the engine refuses.
template <class Real>
[[nodiscard]] Real as(double value) noexcept {
  constexpr auto kMax = static_cast<double>(std::numeric_limits<Real>::max());
  constexpr Real kInfinite = std::numeric_limits<Real>::infinity();
  if (value > kMax) return kInfinite;
  if (value < -kMax) return -kInfinite;
  return static_cast<Real>(value);
}

/// The engine at rest or turning, and its tables.
template <class Real, class S>
class LiveEngine {
 public:
  using Engine = crankloop::Engine<Real, S>;

  LiveEngine(const EngineFile& file, const LiveRequest& request)
      : burn_duration_deg_{request.burn_duration_deg}, wheel_faults_{request.wheel_faults} {
    const Status built = tables_->build(with_springs_that_follow(file.definition()), {request.tick_s});
    if (!built.ok()) throw explain_tabulate(file, built, request.tick_s, {});
    const Status ready = engine_.init(tables_->tables());
    if (!ready.ok()) throw file.explain(ready);
    require_speed(request.start_rad_s * kRpmPerRad_s, speed_limit_rad_s(), request.tick_s, file.definition().crank);
    const Status turning = engine_.restore(turning_at(engine_.state(), static_cast<Real>(request.start_rad_s)));
    if (!turning.ok()) throw file.explain(turning);
    shape_ = detail::shape_of<Real, S>(tables_->tables());
  }

  /// As in the block's fixed part: the same for all cylinders, with the definition's phasing and surroundings, and the
  /// faults of the command line.
  void set(const port::LiveInputs& in) noexcept {
    input_ = {};
    if constexpr (detail::Needs<S>::gas) {
      input_.throttle_ratio = as<Real>(in.throttle_ratio);
      for (std::size_t k = 0; k < shape_.cylinders; ++k) {
        input_.fuel_kg[k] = as<Real>(in.fuel_kg);
        input_.excess_air_ratio[k] = as<Real>(in.excess_air_ratio);
        input_.burn_start_deg[k] = as<Real>(in.burn_start_deg);
        input_.burn_duration_deg[k] = static_cast<Real>(burn_duration_deg_);
      }
    } else {
      input_.load_ratio = as<Real>(in.load_ratio);
    }
    input_.external_torque_Nm = as<Real>(in.external_torque_Nm);
    input_.starter = in.starter;
    input_.cut_cylinders = in.cut_cylinders;
    input_.wheel_faults = wheel_faults_;
  }
  /// All of the scene's, in the order of scene_inputs().
  void set(const port::LiveNumbers& numbers) noexcept { set_inputs(input_, shape_, numbers.data()); }
  [[nodiscard]] port::LiveNumbers inputs() const noexcept {
    port::LiveNumbers numbers{};
    get_inputs(input_, shape_, numbers.data());
    return numbers;
  }

  void step() noexcept { engine_.step(input_); }

  [[nodiscard]] const typename Engine::Output& output() const noexcept { return engine_.output(); }
  [[nodiscard]] const detail::EngineShape& shape() const noexcept { return shape_; }
  [[nodiscard]] double speed_limit_rad_s() const noexcept {
    return static_cast<double>(tables_->tables().drive->speed_limit_rad_s);
  }

  void tell(port::LiveNumbers& signals) const noexcept {
    write_signals(engine_.output(), engine_.state(), shape_, signals);
  }

  void tell(port::LiveOutputs& told) const noexcept {
    const typename Engine::Output& out = engine_.output();
    told.speed_rad_s = static_cast<double>(out.speed_rad_s);
    told.acceleration_rad_s2 = static_cast<double>(out.acceleration_rad_s2);
    told.crank_deg = detail::degrees_of(out.crank);
    told.torque_Nm = static_cast<double>(out.torque_Nm);
    told.mean_torque_Nm = static_cast<double>(out.mean_torque_Nm);
    told.friction_Nm = static_cast<double>(out.friction_Nm);
    told.starter_Nm = static_cast<double>(out.starter_Nm);
    told.faults = out.faults;
    if constexpr (detail::Needs<S>::gas) {
      told.intake_Pa = static_cast<double>(out.manifold[kIntake].pressure_Pa);
      told.trapped_air_kg = 0;
      for (std::size_t k = 0; k < shape_.cylinders; ++k)
        told.trapped_air_kg +=
            static_cast<double>(out.gas_cycle[k].trapped_air_kg) / static_cast<double>(shape_.cylinders);
    }
  }

 private:
  static_assert(kMaxSceneInputs <= port::kMaxLiveNumbers);
  using Tables = TableStorage<Real, S, kMaxGasSegments>;  // room for the finest gas grid there is

  double burn_duration_deg_;
  std::uint32_t wheel_faults_;
  detail::EngineShape shape_;
  std::unique_ptr<Tables> tables_ = std::make_unique<Tables>();
  Engine engine_;
  typename Engine::Input input_;
};

}  // namespace crankloop::program

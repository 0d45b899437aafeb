// A Running of one scene: its tables, its step, and where its numbers are. Included by one source per arithmetic.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include <crankloop/crankloop.hpp>
#include <crankloop/variables.hpp>

#include "crankloop/commands/run/free_loop.hpp"
#include "crankloop/engine_file/following_springs.hpp"
#include "crankloop/engine_file/gas_order.hpp"
#include "crankloop/files/units.hpp"
#include "crankloop/loops/run_hash.hpp"
#include "crankloop/loops/run_limits.hpp"
#include "crankloop/loops/valve_tick_limit.hpp"
#include "page_scenes.hpp"
#include "running.hpp"

namespace crankloop::page {

template <class Value>
[[nodiscard]] Probe probe_of(const detail::Variable& variable, const Value& value) {
  return {variable, detail::kStorageOf<Value>, const_cast<Value*>(&value)};  // is only read
}

/// All that `Shown` shows of such a scene, in its order. The numbers stay where they are as long as the engine does.
template <class Shown, class Real, class S>
[[gnu::noinline]] void list_outputs(const Engine<Real, S>& engine, const detail::EngineShape& shape,
                                    std::vector<Probe>& probes) {
  const auto add = [&probes](const detail::Variable& variable, const auto& value) {
    probes.push_back(probe_of(variable, value));
  };
  detail::each_output<Shown>(add, engine.state(), engine.output(), shape);
}

inline void add_tick(program::BitHash& hash, const std::vector<Probe>& outputs) noexcept {
  for (const Probe& output : outputs)
    detail::with_value(output.storage, output.at, [&hash](const auto& value) { hash.add(value); });
}

template <class Real, class S>
class RunningScene final : public Running {
 public:
  RunningScene(const program::EngineFile& file, const StartRequest& request) : Running(file, request.tick_s) {
    const auto require = [&](const Status& status) {
      if (!status.ok()) throw program::explain_tabulate(file, status, request.tick_s);
    };
    require(tables_->build(program::with_springs_that_follow(file.definition()), {request.tick_s}));
    require(engine_.init(tables_->tables(), Phase::from_cycles(request.crank_deg / kDegreesPerCycle)));
    program::require_speed(request.speed_rpm, static_cast<double>(tables_->tables().drive->speed_limit_rad_s),
                           request.tick_s, file.definition().crank);
    shape_ = detail::shape_of<Real, S>(tables_->tables());
    has_faults_ = tables_->tables().wheel_faults->count > 0;
    if constexpr (kIsFree) {  // each speed by the quotient of its own run, for the same bits
      const double speed_rad_s = request.speed_rpm / program::kRpmPerRad_s;
      require(engine_.restore(turning_at<Real, S>(engine_.state(), static_cast<Real>(speed_rad_s))));
    } else {
      input_.speed_rad_s = static_cast<Real>(program::Operation{request.speed_rpm}.speed_rad_s());
    }
    if constexpr (detail::Needs<S>::gas) program::tell(input_, program::gas_order(file.definition().gas));
    list_inputs();
    list_channels();
    list_results(engine_.state().phase);
  }

  /// Of the ticks from now on, with the inputs as they are.
  [[nodiscard]] HashedRun hash(std::uint64_t ticks) {
    std::vector<Probe> outputs;
    list_outputs<program::FreeShown<S>>(engine_, shape_, outputs);
    program::BitHash hash;
    for (std::uint64_t i = 0; i < ticks; ++i) {
      engine_.step(input_);
      add_tick(hash, outputs);
    }
    return {hash.text(), ticks};
  }

 private:
  static constexpr bool kIsFree = S::crank == CrankGiven::torque;
  using Tables = TableStorage<Real, S, kMaxGasSegments>;

  void list_inputs() {
    detail::each_input<S>([this](const detail::Variable& variable, auto& value) { this->add_input(variable, value); },
                          input_, shape_);
  }

  template <class Value>
  void add_input(const detail::Variable& variable, Value& value) {
    inputs_.push_back({variable, detail::kStorageOf<Value>, &value});
    input_values_.push_back(detail::as_number(value));
  }
  /// The engine's numbers stay where they are as long as it lives.
  void list_channels() {
    list_outputs<typename S::Shown>(engine_, shape_, channels_);
    const auto add_channel = [this](const detail::Variable& variable, const auto& value) {
      channels_.push_back(probe_of(variable, value));
    };
    if constexpr (!kIsFree)
      add_channel(detail::real("speed_rad_s", "Crank speed; negative: backwards"), input_.speed_rad_s);
    const auto& out = engine_.output();
    for (std::uint32_t w = 0; w < shape_.wheels; ++w)
      add_channel(detail::truth("trigger[#].level", "Level of the signal").at(w), out.trigger[w].level);
    for (std::uint32_t w = 0; w < shape_.wheels && has_faults_; ++w)
      add_channel(detail::truth("faulty_trigger[#].level", "Level of the faulty signal").at(w),
                  out.faulty_trigger[w].level);
    if constexpr (!kIsFree)
      add_channel(detail::whole("wheel_faults_on", "Bit i-1: fault i of the wheels is on"), out.wheel_faults_on);
    add_channel(detail::whole("faults", "The tick's fault bits"), out.faults);
  }

  void tick(double begin_s) noexcept override {
    engine_.step(input_);
    const auto& out = engine_.output();
    for (std::uint32_t w = 0; w < shape_.wheels; ++w) {
      if (out.trigger[w].edge_count != 0) add_edges(out.trigger[w], begin_s, w);
      if (has_faults_ && out.faulty_trigger[w].edge_count != 0)
        add_edges(out.faulty_trigger[w], begin_s, w + kFaultySignal);
    }
  }
  template <class Signal>
  void add_edges(const Signal& signal, double begin_s, double wheel) noexcept {
    for (std::uint32_t e = 0; e < signal.edge_count && e < S::trigger_edges; ++e)
      add_edge(begin_s + static_cast<double>(signal.edge[e].time_s), wheel, signal.edge[e].level);
  }

  std::unique_ptr<Tables> tables_ = std::make_unique<Tables>();
  Engine<Real, S> engine_;
  typename Engine<Real, S>::Input input_;
  detail::EngineShape shape_;
  bool has_faults_ = false;  ///< of trigger wheels
};

template <class Real, class S>
[[nodiscard]] HashedRun hash_of(const program::EngineFile& file, const program::Operation& operation, int cycles) {
  program::FixedStepLoop<Real, S> loop(file.definition(), operation);
  const double span = cycles * loop.ticks_per_cycle();
  program::require_ticks(span, operation.tick_s, program::kFewerTicks);
  std::vector<Probe> outputs;
  list_outputs<typename S::Shown>(loop.engine(), detail::shape_of<Real, S>(*loop.engine().tables()), outputs);
  program::BitHash hash;
  const auto ticks = static_cast<std::uint64_t>(std::max(1.0, std::ceil(span - program::kHairOfATick)));
  for (std::uint64_t i = 0; i < ticks; ++i) {
    loop.step();
    add_tick(hash, outputs);
  }
  return {hash.text(), ticks};
}

template <class Real>
std::unique_ptr<Running> start_running(const program::EngineFile& file, const StartRequest& request) {
  const bool breathes = program::breathes(file.definition());
  if (request.crank_is_free) {
    if (breathes) return std::make_unique<RunningScene<Real, FreeBreathing>>(file, request);
    return std::make_unique<RunningScene<Real, Free>>(file, request);
  }
  if (breathes) return std::make_unique<RunningScene<Real, HeldBreathing>>(file, request);
  return std::make_unique<RunningScene<Real, Held>>(file, request);
}

template <class Real>
HashedRun hash_held_run(const program::EngineFile& file, const program::Operation& operation, int cycles) {
  return program::breathes(file.definition()) ? hash_of<Real, HeldBreathing>(file, operation, cycles)
                                              : hash_of<Real, Held>(file, operation, cycles);
}

template <class Real>
HashedRun hash_free_run(const program::EngineFile& file, const StartRequest& request, double seconds) {
  const std::uint64_t ticks = program::ticks_of(seconds, request.tick_s);
  if (program::breathes(file.definition()))
    return std::make_unique<RunningScene<Real, FreeBreathing>>(file, request)->hash(ticks);
  return std::make_unique<RunningScene<Real, Free>>(file, request)->hash(ticks);
}

}  // namespace crankloop::page

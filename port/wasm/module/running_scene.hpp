// A Running of one scene: its tables, its step, and where its numbers are. Included by one source per kind of scene.
#pragma once

#include <memory>

#include <crankloop/crankloop.hpp>
#include <crankloop/variables.hpp>

#include "crankloop/engine_file/following_springs.hpp"
#include "crankloop/engine_file/gas_order.hpp"
#include "crankloop/files/units.hpp"
#include "crankloop/loops/run_limits.hpp"
#include "crankloop/loops/valve_tick_limit.hpp"
#include "page_scenes.hpp"
#include "running.hpp"

namespace crankloop::page {

template <class Value>
[[nodiscard]] Probe probe_of(const detail::Variable& variable, const Value& value) {
  return {variable, detail::kStorageOf<Value>, const_cast<Value*>(&value)};  // is only read
}

/// All that the program shows of such a scene, in its order. The numbers stay where they are as long as the engine
/// does.
template <class Real, class S>
[[gnu::noinline]] void list_outputs(const Engine<Real, S>& engine, const detail::EngineShape& shape,
                                    std::vector<Probe>& probes) {
  const auto add = [&probes](const detail::Variable& variable, const auto& value) {
    probes.push_back(probe_of(variable, value));
  };
  detail::each_output<typename S::Shown>(add, engine.state(), engine.output(), shape);
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
    const double speed_rad_s = request.speed_rpm * program::kRad_sPerRpm;
    shape_ = detail::shape_of<Real, S>(tables_->tables());
    if constexpr (kIsFree) {
      require(engine_.restore(turning_at<Real, S>(engine_.state(), static_cast<Real>(speed_rad_s))));
    } else {
      input_.speed_rad_s = static_cast<Real>(speed_rad_s);
    }
    if constexpr (detail::Needs<S>::gas) program::tell(input_, program::gas_order(file.definition().gas));
    list_inputs();
    list_channels();
    list_results();
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
    list_outputs(engine_, shape_, channels_);
    const auto add_channel = [this](const detail::Variable& variable, const auto& value) {
      channels_.push_back(probe_of(variable, value));
    };
    if constexpr (!kIsFree)
      add_channel(detail::real("speed_rad_s", "Crank speed; negative: backwards"), input_.speed_rad_s);
    const auto& out = engine_.output();
    for (std::uint32_t w = 0; w < shape_.wheels; ++w)
      add_channel(detail::truth("trigger[#].level", "Level of the signal").at(w), out.trigger[w].level);
    for (std::uint32_t w = 0; w < shape_.wheels && has_faults(); ++w)
      add_channel(detail::truth("faulty_trigger[#].level", "Level of the faulty signal").at(w),
                  out.faulty_trigger[w].level);
    if constexpr (!kIsFree)
      add_channel(detail::whole("wheel_faults_on", "Bit i-1: fault i of the wheels is on"), out.wheel_faults_on);
    add_channel(detail::whole("faults", "The tick's fault bits"), out.faults);
  }
  [[nodiscard]] bool has_faults() const noexcept { return tables_->tables().wheel_faults->count > 0; }

  void tick() noexcept override { engine_.step(input_); }
  [[nodiscard]] Phase phase() const noexcept override { return engine_.state().phase; }

  template <class Signal>
  void collect(const Signal& signal, double begin_s, double wheel) {
    for (std::uint32_t e = 0; e < signal.edge_count && e < S::trigger_edges; ++e)
      add_edge(begin_s + static_cast<double>(signal.edge[e].time_s), wheel, signal.edge[e].level);
  }
  void collect_edges(double begin_s) override {
    const auto& out = engine_.output();
    for (std::uint32_t w = 0; w < shape_.wheels; ++w) {
      collect(out.trigger[w], begin_s, w);
      if (has_faults()) collect(out.faulty_trigger[w], begin_s, w + kFaultySignal);
    }
  }

  std::unique_ptr<Tables> tables_ = std::make_unique<Tables>();
  Engine<Real, S> engine_;
  typename Engine<Real, S>::Input input_;
  detail::EngineShape shape_;
};

template <class S>
[[nodiscard]] std::unique_ptr<Running> running_of(const program::EngineFile& file, const StartRequest& request) {
  if (request.in_double) return std::make_unique<RunningScene<double, S>>(file, request);
  return std::make_unique<RunningScene<float, S>>(file, request);
}

[[nodiscard]] std::unique_ptr<Running> start_held(const program::EngineFile& file, const StartRequest& request);
[[nodiscard]] std::unique_ptr<Running> start_free(const program::EngineFile& file, const StartRequest& request);

}  // namespace crankloop::page

// An engine that a page steps: whatever its scene and arithmetic are, its inputs and outputs are numbers by name.
//
// What belongs here: names and numbers, samples, edges, results of a cycle. What does not: the scene's step
// (running_scene.hpp), texts for the page (module.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/variable.hpp>
#include <crankloop/variable_values.hpp>

#include "crankloop/engine_file/engine_file.hpp"
#include "crankloop/loops/fixed_step_loop.hpp"

namespace crankloop::page {

/// A variable and where the engine keeps it.
struct Probe {
  detail::Variable variable;
  detail::Storage storage;
  void* at;

  [[nodiscard]] double number() const noexcept {
    double x = 0;
    detail::with_value(storage, at, [&x](const auto& value) { x = detail::as_number(value); });
    return x;
  }
  void set(double number) const noexcept {
    detail::with_value(storage, at, [number](auto& value) { detail::assign(value, number); });
  }
};

/// A real output, which the bookkeeping of a tick reads.
class RealOutput {
 public:
  RealOutput() = default;
  explicit RealOutput(const Probe& probe) noexcept
      : at_{probe.at}, is_double_{probe.storage == detail::Storage::real} {}
  [[nodiscard]] double number() const noexcept {
    return is_double_ ? *static_cast<const double*>(at_) : static_cast<double>(*static_cast<const float*>(at_));
  }

 private:
  const void* at_ = nullptr;
  bool is_double_ = false;
};

struct StartRequest {
  double tick_s = 0;
  bool in_double = false;
  bool crank_is_free = false;
  double speed_rpm = 0;
  double crank_deg = 0;
};

/// Doubles that samples may have room for together.
inline constexpr std::size_t kMaxSampleNumbers = std::size_t{1} << 18;
inline constexpr std::size_t kMaxEdges = 4096;
inline constexpr double kFaultySignal = 100;  ///< added to the wheel's number of an edge of a faulty signal

class Running {
 public:
  virtual ~Running() = default;
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  [[nodiscard]] const std::vector<Probe>& inputs() const noexcept { return inputs_; }
  [[nodiscard]] std::vector<double>& input_values() noexcept { return input_values_; }

  [[nodiscard]] const std::vector<Probe>& channels() const noexcept { return channels_; }
  [[nodiscard]] const Probe* find(const std::string& name) const;
  /// The columns of samples behind time_s and crank_deg. False where a name is no channel: nothing is changed then.
  bool watch(const std::vector<std::string>& names, std::string& unknown);
  [[nodiscard]] const std::vector<const Probe*>& columns() const noexcept { return columns_; }

  /// As many ticks as there is room for the samples of; answers how many.
  std::uint32_t step(std::uint32_t ticks, std::uint32_t every);
  [[nodiscard]] const std::vector<double>& samples() const noexcept { return samples_; }
  [[nodiscard]] std::size_t sample_count() const noexcept { return samples_.size() / row_size(); }
  [[nodiscard]] const std::vector<double>& now();
  [[nodiscard]] const std::vector<double>& edges() const noexcept { return edges_; }
  [[nodiscard]] std::uint32_t edges_lost() const noexcept { return edges_lost_; }

  [[nodiscard]] std::uint32_t cycles() const noexcept { return cycles_; }
  [[nodiscard]] const std::vector<detail::Variable>& results() const noexcept { return results_; }
  [[nodiscard]] const std::vector<double>& result_values() const noexcept { return result_values_; }

 protected:
  explicit Running(const program::EngineFile& file, double tick_s);

  /// The engine's step, and its edges: `begin_s` is the time before the tick.
  virtual void tick(double begin_s) noexcept = 0;

  void add_edge(double time_s, double wheel, std::uint32_t level) noexcept;
  void list_results(const Phase& of_engine);  ///< when the channels are known

  std::vector<Probe> inputs_;
  std::vector<double> input_values_;
  std::vector<Probe> channels_;

 private:
  /// What a cycle has come to so far.
  struct Cycle {
    double work_J = 0;  ///< of the torque on the crankshaft
    double angle_rad = 0;
    double time_s = 0;
    double least_rad_s = std::numeric_limits<double>::infinity();
    double largest_rad_s = -std::numeric_limits<double>::infinity();
    std::vector<double> peak_Pa, peak_deg;
  };

  void take_inputs() noexcept;  ///< into the engine's input
  [[nodiscard]] Phase phase() const noexcept { return *phase_; }
  [[nodiscard]] std::size_t row_size() const noexcept { return 2 + columns_.size(); }
  [[nodiscard]] double time_s() const noexcept { return static_cast<double>(ticks_) * tick_s_; }
  void add_row(std::vector<double>& rows) const;
  void add_to_cycle(Phase before, Phase after) noexcept;
  void end_cycle() noexcept;
  void begin_cycle(bool is_whole) noexcept;

  double tick_s_;
  std::vector<double> firing_deg_;
  double swept_m3_;  ///< of all cylinders
  std::uint64_t ticks_ = 0;
  std::uint32_t cycles_ = 0;
  std::vector<const Probe*> columns_;
  std::vector<double> samples_, now_, edges_;
  std::uint32_t edges_lost_ = 0;
  Cycle cycle_;
  bool is_whole_ = false;         ///< the cycle began at its begin
  const Phase* phase_ = nullptr;  ///< of the engine
  RealOutput mean_torque_, speed_;
  std::vector<RealOutput> pressures_;
  std::vector<const Probe*> shown_results_;
  std::vector<detail::Variable> results_;
  std::vector<double> result_values_;
};

struct HashedRun {
  std::string hash;
  std::uint64_t ticks;
};

// In running_float.cpp and running_double.cpp: what only double needs is a part of the module by itself.

/// Makes the engine's tables and starts it; throws InputError and UsageError as `run` does.
template <class Real>
[[nodiscard]] std::unique_ptr<Running> start_running(const program::EngineFile& file, const StartRequest& request);
/// As `run --hash`, with throttle, fuel and spark of the operation.
template <class Real>
[[nodiscard]] HashedRun hash_held_run(const program::EngineFile& file, const program::Operation& operation, int cycles);
/// As `run --free --hash`.
template <class Real>
[[nodiscard]] HashedRun hash_free_run(const program::EngineFile& file, const StartRequest& request, double seconds);

}  // namespace crankloop::page

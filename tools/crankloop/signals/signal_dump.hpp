// Writes the signals of an engine's trigger wheels tick by tick to a file for logic signal viewers.
//
// What belongs here: wheels, edges and times. What does not: the file's format (vcd.hpp), the run (run_signals.hpp,
// free_run.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "../engine_file/engine_file.hpp"
#include "../files/output_file.hpp"
#include "vcd.hpp"

namespace crankloop::program {

[[nodiscard]] inline std::vector<std::string> names_of_triggers(const EngineFile& engine) {
  std::vector<std::string> names;
  for (const TriggerOfFile& trigger : engine.triggers()) names.push_back(trigger.name);
  return names;
}

/// Those, and with faults the signals that a controller sees: "crank_faulty".
[[nodiscard]] inline std::vector<std::string> names_of_signals(const EngineFile& engine) {
  std::vector<std::string> names = names_of_triggers(engine);
  if (engine.definition().wheel_fault_count == 0) return names;
  for (const TriggerOfFile& trigger : engine.triggers()) names.push_back(trigger.name + "_faulty");
  return names;
}
/// In that order.
template <class Output>
[[nodiscard]] constexpr const auto& signal_of(const Output& out, std::size_t which, std::size_t wheels) noexcept {
  return which < wheels ? out.trigger[which] : out.faulty_trigger[which - wheels];
}

/// The edges of a signal that the scene had room for.
template <class Signal>
[[nodiscard]] constexpr std::uint32_t listed_edges(const Signal& signal) noexcept {
  constexpr std::uint32_t kRoom = sizeof signal.edge / sizeof signal.edge[0];
  return signal.edge_count < kRoom ? signal.edge_count : kRoom;
}

/// The level at the start of the tick: every edge has inverted it.
template <class Signal>
[[nodiscard]] constexpr bool level_before(const Signal& signal) noexcept {
  return ((signal.level ^ signal.edge_count) & 1u) != 0;
}

/// Whether a scene makes faulty signals.
template <class Output, class = void>
inline constexpr bool kHasFaultySignals = false;
template <class Output>
inline constexpr bool kHasFaultySignals<Output, std::void_t<decltype(std::declval<Output>().faulty_trigger)>> = true;

class SignalDump {
 public:
  /// Throws InputError for a file without wheels.
  SignalDump(const EngineFile& engine, Output& out, const std::vector<std::string>& numbers);
  /// With faulty signals, where the engine has faults: for a scene that makes them.
  static SignalDump with_faults(const EngineFile& engine, Output& out, const std::vector<std::string>& numbers);

  /// Writes the edges of a tick that ends at `end_s`; before the first tick, the initial levels.
  template <class Output>
  void tick(double end_s, double tick_s, const Output& out) {
    const double begin_s = end_s - tick_s;
    for (std::size_t w = 0; w < wheels_; ++w) take(w, begin_s, end_s, out.trigger[w]);
    if constexpr (kHasFaultySignals<Output>) {
      for (std::size_t w = 0; w < faulty_; ++w) take(wheels_ + w, begin_s, end_s, out.faulty_trigger[w]);
    }
    begun_ = true;
    vcd_.write_until(end_s);
  }

  /// Call it before the tick that starts at this time is written.
  void number(std::size_t which, double time_s, double value) { vcd_.number(which, time_s, value); }
  void finish(double end_s) { vcd_.finish(end_s); }

 private:
  SignalDump(const EngineFile& engine, Output& out, const std::vector<std::string>& signals,
             const std::vector<std::string>& numbers);

  template <class Signal>
  void take(std::size_t which, double begin_s, double end_s, const Signal& signal) {
    if (!begun_) vcd_.level(which, begin_s, level_before(signal));
    for (std::uint32_t e = 0; e < listed_edges(signal); ++e) {
      vcd_.level(which, begin_s + static_cast<double>(signal.edge[e].time_s), signal.edge[e].level != 0);
    }
    vcd_.level(which, end_s, signal.level != 0);  // has an effect only if edges were lost
  }

  std::size_t wheels_;
  std::size_t faulty_ = 0;
  bool begun_ = false;
  VcdFile vcd_;
};

}  // namespace crankloop::program

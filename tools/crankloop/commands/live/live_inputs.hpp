// Whose inputs a tick of `live` uses: those of the command line and its file until a controller writes, then the
// controller's, and the safe ones where it has fallen silent.
//
// What belongs here: that choice. What does not: what is a sign of life (port/linux/watched_inputs.hpp).
#pragma once

#include <cstdint>

#include "../../loops/input_schedule.hpp"
#include "port/linux/watched_inputs.hpp"

namespace crankloop::program {

/// A controller writes the fixed part or the section of inputs by name, which has all of them. Who has written the
/// section has taken over: the fixed part then counts no more. Never waits and never loops.
template <class Engine>
class LiveInputSources {
 public:
  /// `engine` has the inputs of the command line. `schedule` is null where there is no file.
  LiveInputSources(const port::SequenceLocked<port::LiveInputs>& fixed, port::LockedNumbers by_name, Engine& engine,
                   std::int64_t patience_ns, InputSchedule* schedule) noexcept
      : engine_{engine},
        schedule_{schedule},
        at_start_{engine.inputs()},
        section_{by_name},
        fixed_{fixed, {}, patience_ns},
        by_name_{section_, at_start_, patience_ns, safe_inputs(engine)} {}

  /// Gives the engine the inputs of the tick that begins now, `time_s` of the model.
  void give(std::int64_t now_ns, double time_s) noexcept {
    const port::LiveNumbers& named = by_name_.at(now_ns);
    const port::LiveInputs& fixed = fixed_.at(now_ns);
    if (by_name_is_used()) return engine_.set(named);
    if (is_seen(fixed_)) return engine_.set(fixed);
    if (schedule_ != nullptr) schedule_->at(time_s, at_start_.data());
    engine_.set(at_start_);
  }

  [[nodiscard]] bool by_name_is_used() const noexcept { return is_seen(by_name_); }
  [[nodiscard]] bool fixed_is_ignored() const noexcept { return by_name_is_used() && is_seen(fixed_); }
  // of the area that is used
  [[nodiscard]] std::uint32_t flags() const noexcept { return by_name_is_used() ? by_name_.flags() : fixed_.flags(); }
  [[nodiscard]] std::uint32_t sequence() const noexcept {
    return by_name_is_used() ? by_name_.sequence() : fixed_.sequence();
  }
  [[nodiscard]] std::uint32_t torn() const noexcept { return by_name_is_used() ? by_name_.torn() : fixed_.torn(); }
  [[nodiscard]] std::uint32_t silences() const noexcept {
    return by_name_is_used() ? by_name_.silences() : fixed_.silences();
  }

 private:
  template <class Watched>
  static bool is_seen(const Watched& watched) noexcept {
    return (watched.flags() & port::kControllerSeen) != 0;
  }
  static port::LiveNumbers safe_inputs(Engine& engine) noexcept {
    engine.set(port::LiveInputs{});
    return engine.inputs();
  }

  Engine& engine_;
  InputSchedule* schedule_;
  port::LiveNumbers at_start_;
  port::LockedNumbers section_;
  port::WatchedInputs fixed_;
  port::WatchedNumbers by_name_;
};

}  // namespace crankloop::program

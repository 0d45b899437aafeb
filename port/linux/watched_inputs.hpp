// Whose inputs a tick uses: those given at the start, the controller's, or the safe ones once it falls silent.
//
// What belongs here: telling a live controller from a dead one. What does not: whether its numbers make sense (the
// engine says).
#pragma once

#include <cstdint>

#include "shared_block.hpp"

namespace crankloop::port {

/// A controller is there from its first write on. Its sign of life is a write: a sequence number not seen before, with
/// inputs that are whole. One that stays away for longer than the patience, be it dead, stopped or stuck half-way
/// through a write, is silent until its next write. Never waits and never loops.
///
/// Area is a value under a sequence lock.
template <class Value, class Area = SequenceLocked<Value>>
class Watched {
 public:
  /// `at_start` is used until a controller has written, `safe` where it is silent. What stands in `area` now was
  /// written for an earlier run and is not used.
  Watched(const Area& area, const Value& at_start, std::int64_t patience_ns, const Value& safe = {}) noexcept
      : area_{area}, used_{at_start}, safe_{safe}, patience_ns_{patience_ns}, sequence_{area.sequence()} {}

  /// The inputs of the tick that begins now. Times must not go back.
  [[nodiscard]] const Value& at(std::int64_t now_ns) noexcept {
    if (area_.sequence() != sequence_) take(now_ns);
    if (flags_ == kControllerSeen && now_ns - written_ns_ > patience_ns_) {
      used_ = safe_;
      flags_ |= kControllerSilent;
      ++silences_;
    }
    return used_;
  }

  [[nodiscard]] std::uint32_t flags() const noexcept { return flags_; }        ///< LiveFlag
  [[nodiscard]] std::uint32_t sequence() const noexcept { return sequence_; }  ///< of the latest inputs that came
  [[nodiscard]] std::uint32_t torn() const noexcept { return torn_; }          ///< ticks that found a write under way
  [[nodiscard]] std::uint32_t silences() const noexcept { return silences_; }  ///< how often the controller fell silent

 private:
  /// What was written since.
  void take(std::int64_t now_ns) noexcept {
    Value written = used_;
    std::uint32_t sequence = sequence_;
    if (!area_.read(written, sequence)) {
      ++torn_;
      return;
    }
    used_ = written;
    sequence_ = sequence;
    written_ns_ = now_ns;
    flags_ = kControllerSeen;
  }

  const Area& area_;
  Value used_;
  Value safe_;
  std::int64_t patience_ns_;
  std::uint32_t sequence_;
  std::int64_t written_ns_ = 0;
  std::uint32_t flags_ = 0;
  std::uint32_t torn_ = 0;
  std::uint32_t silences_ = 0;
};

using WatchedInputs = Watched<LiveInputs>;
using WatchedNumbers = Watched<LiveNumbers, LockedNumbers>;

}  // namespace crankloop::port

// A loop with a fixed period against the machine's clock.
//
// What belongs here: when a tick is due, and whether it was done in time. What does not: what a tick does, and how to
// be woken in time (real_time.hpp).
#pragma once

#include <cstdint>

namespace crankloop::port {

/// What became of the ticks so far.
struct PeriodicTally {
  std::uint64_t ticks = 0;   ///< done
  std::uint64_t late = 0;    ///< of them, those that began a period or more after they were due
  std::uint64_t missed = 0;  ///< of them, those that were not done when the next one was due; late ones are among them
  std::int64_t longest_backlog_ns = 0;  ///< how far behind the clock a tick began
};

/// Tick n is due n + 1 periods after the construction, whatever happened before: a tick is never dropped, and the times
/// do not drift. Ticks whose time has passed begin at once, back to back, until the loop has caught up with the clock.
///
///     Periodic periodic(1'000'000);
///     while (periodic.tally().ticks < 1000) {
///       periodic.begin();
///       ...
///       periodic.done();
///     }
class Periodic {
 public:
  explicit Periodic(std::int64_t period_ns) noexcept;

  /// Sleeps until the tick is due, through signals. Returns how long after that it begins, >= 0.
  std::int64_t begin() noexcept;

  /// Its work is done. Returns how long that took.
  std::int64_t done() noexcept;

  [[nodiscard]] std::int64_t due_ns() const noexcept { return due_ns_; }      ///< of the tick begun last, by now_ns()
  [[nodiscard]] std::int64_t begun_ns() const noexcept { return begun_ns_; }  ///< when it did begin
  [[nodiscard]] const PeriodicTally& tally() const noexcept { return tally_; }

 private:
  std::int64_t period_ns_;
  std::int64_t due_ns_;
  std::int64_t begun_ns_;
  PeriodicTally tally_;
};

}  // namespace crankloop::port

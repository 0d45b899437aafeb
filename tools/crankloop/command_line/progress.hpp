// A line that shows the progress of a long command.
//
// What belongs here: when and where it is shown. On a terminal: on stderr once a second has passed, over and over in
// one line, erased at the end. Where stderr is none, as in a log: a line every ten seconds, if the command requests it.
// What does not: what the command does.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <limits>

#include "port/linux/stopwatch.hpp"

namespace crankloop::program {

class Progress {
 public:
  static constexpr std::int64_t kLogPeriod_ns = 10'000'000'000;
  static constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();

  /// `what` stands before the percentage, "running"; `steps` is how often step() will be called; a log is told only by
  /// commands that take minutes.
  Progress(const char* what, double steps, std::int64_t log_period_ns = kNever_ns)
      : what_{what},
        steps_{steps},
        terminal_{::isatty(STDERR_FILENO) != 0},
        period_ns_{terminal_ ? 200'000'000 : log_period_ns},
        next_ns_{terminal_ ? 1'000'000'000 : log_period_ns} {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
  }

  /// Cheap enough for every tick: the clock is looked at now and then only.
  void step() {
    if (++done_ % kStepsPerLook == 0) look();
  }

  /// For steps that are long themselves: looks at the clock each time.
  void long_step() {
    ++done_;
    look();
  }

 private:
  static constexpr std::uint64_t kStepsPerLook = 4096;

  void look() {
    const std::int64_t now_ns = stopwatch_.elapsed_ns();
    if (now_ns < next_ns_) return;
    next_ns_ = now_ns + period_ns_;
    shown_ = terminal_;
    const auto done = static_cast<double>(done_);
    const double left_s = static_cast<double>(stopwatch_.elapsed_ns()) * 1e-9 * (steps_ / done - 1);
    std::fprintf(stderr, terminal_ ? "\r\033[K%s: %.0f %%" : "%s: %.0f %%", what_, 100 * done / steps_);
    if (left_s >= 1) std::fprintf(stderr, ", %.0f s left", left_s);
    if (!terminal_) std::fprintf(stderr, "\n");
  }

  const char* what_;
  double steps_;
  bool terminal_;
  bool shown_ = false;
  std::uint64_t done_ = 0;
  std::int64_t period_ns_;
  std::int64_t next_ns_;
  port::Stopwatch stopwatch_;
};

}  // namespace crankloop::program

// A line on a terminal that tells how far a long command is.
//
// What belongs here: when and where it is shown: on stderr if that is a terminal, once a second has passed, erased at
// the end. What does not: what the command does.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>

#include "port/linux/stopwatch.hpp"

namespace crankloop::program {

class Progress {
 public:
  /// `what` stands before the percentage, "running"; `steps` is how often step() will be called.
  Progress(const char* what, double steps) : what_{what}, steps_{steps}, on_{::isatty(STDERR_FILENO) != 0} {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
  }

  /// Cheap enough for every tick: the clock is looked at now and then only.
  void step() {
    if (on_ && ++done_ % kStepsPerLook == 0) look();
  }

  /// For steps that are long themselves: looks at the clock each time.
  void long_step() {
    ++done_;
    if (on_) look();
  }

 private:
  static constexpr std::uint64_t kStepsPerLook = 4096;
  static constexpr std::int64_t kPeriod_ns = 200'000'000;

  void look() {
    const std::int64_t now_ns = stopwatch_.elapsed_ns();
    if (now_ns < next_ns_) return;
    next_ns_ = now_ns + kPeriod_ns;
    shown_ = true;
    std::fprintf(stderr, "\r%s: %.0f %%", what_, 100 * static_cast<double>(done_) / steps_);
  }

  const char* what_;
  double steps_;
  bool on_;
  bool shown_ = false;
  std::uint64_t done_ = 0;
  std::int64_t next_ns_ = 1'000'000'000;
  port::Stopwatch stopwatch_;
};

}  // namespace crankloop::program

// A clock for measuring what a tick costs on this machine.
//
// What belongs here: reading the clock. What does not: what is measured, and how often
// (tools/crankloop/run/run_loop.cpp).
#pragma once

#include <time.h>

#include <cstdint>

namespace crankloop::port {

/// Nanoseconds since a fixed moment. CLOCK_MONOTONIC: never goes back when the time of day is set. A reading costs some
/// 20 ns.
[[nodiscard]] inline std::int64_t now_ns() noexcept {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + std::int64_t{time.tv_nsec};
}

/// Nanoseconds that this thread has run: what the machine gave to other programs meanwhile is not in it. A reading is a
/// system call, some 200 ns.
[[nodiscard]] inline std::int64_t thread_ns() noexcept {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + std::int64_t{time.tv_nsec};
}

/// Runs from its construction.
class Stopwatch {
 public:
  [[nodiscard]] std::int64_t elapsed_ns() const noexcept { return now_ns() - started_ns_; }

 private:
  std::int64_t started_ns_ = now_ns();
};

}  // namespace crankloop::port

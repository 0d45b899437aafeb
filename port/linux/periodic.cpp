#include "periodic.hpp"

#include <time.h>

#include <algorithm>
#include <cerrno>

#include "stopwatch.hpp"

namespace crankloop::port {
namespace {

/// By CLOCK_MONOTONIC, as now_ns(). To an absolute time, so that neither a signal nor what passes between reading the
/// clock and falling asleep shifts it.
void sleep_until(std::int64_t time_ns) noexcept {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  timespec time{};
  time.tv_sec = static_cast<time_t>(time_ns / kSecond_ns);
  time.tv_nsec = static_cast<long>(time_ns % kSecond_ns);
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

}  // namespace

Periodic::Periodic(std::int64_t period_ns) noexcept : period_ns_{period_ns}, due_ns_{now_ns()}, begun_ns_{due_ns_} {}

std::int64_t Periodic::begin() noexcept {
  due_ns_ += period_ns_;
  begun_ns_ = now_ns();
  if (begun_ns_ < due_ns_) {
    sleep_until(due_ns_);
    begun_ns_ = now_ns();
  }
  const std::int64_t behind_ns = begun_ns_ - due_ns_;
  if (behind_ns >= period_ns_) ++tally_.late;
  tally_.longest_backlog_ns = std::max(tally_.longest_backlog_ns, behind_ns);
  return behind_ns;
}

std::int64_t Periodic::done() noexcept {
  const std::int64_t done_ns = now_ns();
  ++tally_.ticks;
  if (done_ns > due_ns_ + period_ns_) ++tally_.missed;
  return done_ns - begun_ns_;
}

}  // namespace crankloop::port

#include "real_time.hpp"

#include <sys/mman.h>
#include <sys/prctl.h>

#include <cerrno>
#include <cstddef>

namespace crankloop::port {
namespace {

/// Touches the stack that the loop may grow into, so that its pages are there to be locked. Not inlined: the array has
/// to lie below the caller's frame.
__attribute__((noinline)) void touch_stack() noexcept {
  constexpr std::size_t kBytes = std::size_t{256} * 1024;
  constexpr std::size_t kPage = 4096;  // the smallest there is
  volatile unsigned char stack[kBytes];
  for (std::size_t i = 0; i < kBytes; i += kPage) stack[i] = 0;
  static_cast<void>(stack[0]);
}

int run_only_on(int cpu) noexcept {
  if (cpu >= CPU_SETSIZE) return EINVAL;
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(cpu), &set);
  return ::sched_setaffinity(0, sizeof set, &set) == 0 ? 0 : errno;
}

}  // namespace

RealTime::RealTime(const RealTimeWish& wish) noexcept : before_{::sched_getscheduler(0), {}} {
  ::sched_getparam(0, &before_.parameters);
  if (wish.cpu >= 0) cpu_error_ = run_only_on(wish.cpu);
  touch_stack();
  if (::mlockall(MCL_CURRENT) != 0) memory_error_ = errno;
  // Under the usual scheduler Linux may wake a sleeper 50 us late to save power, by default; under
  // SCHED_FIFO it does not.
  ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  if (wish.priority > 0) {
    sched_param parameters{};
    parameters.sched_priority = wish.priority;
    if (::sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) priority_error_ = errno;
  }
}

RealTime::~RealTime() {
  if (before_.policy >= 0) ::sched_setscheduler(0, before_.policy, &before_.parameters);
  ::prctl(PR_SET_TIMERSLACK, 0UL, 0UL, 0UL, 0UL);  // 0: back to the default
  ::munlockall();
}

}  // namespace crankloop::port

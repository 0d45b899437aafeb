// What a process requests from Linux so that it wakes in time: priority, memory that stays, a processor of its own.
//
// What belongs here: asking, and telling what was refused. What does not: the loop (periodic.hpp).
#pragma once

#include <sched.h>

namespace crankloop::port {

struct RealTimeWish {
  int priority = 0;  ///< of SCHED_FIFO, 1 to 99; 0: the scheduler stays as it is
  int cpu = -1;      ///< the only processor to run on, counted from 0; -1: any
};

/// Held by the calling thread from the construction to the end of the object. Nothing of it is needed for right
/// results, only for being in time, so a refusal is no error: it is kept, as errno's number (0: granted), for whoever
/// wants to tell it.
///
/// Memory: every page that there is at the construction stays in RAM, and 256 KiB of stack below the caller with them.
/// Pages that come later do not (MCL_FUTURE): a limit on locked memory would then let an allocation fail somewhere
/// else. So allocate before, not in the loop.
class RealTime {
 public:
  explicit RealTime(const RealTimeWish& wish) noexcept;
  RealTime(const RealTime&) = delete;
  RealTime& operator=(const RealTime&) = delete;
  ~RealTime();  ///< gives back priority and memory

  [[nodiscard]] int cpu_error() const noexcept { return cpu_error_; }
  [[nodiscard]] int memory_error() const noexcept { return memory_error_; }
  [[nodiscard]] int priority_error() const noexcept { return priority_error_; }

 private:
  struct Scheduler {
    int policy;
    sched_param parameters;
  };

  Scheduler before_;
  int cpu_error_ = 0;
  int memory_error_ = 0;
  int priority_error_ = 0;
};

}  // namespace crankloop::port

// SIGINT and SIGTERM as a flag that a loop looks at.
#pragma once

#include <atomic>
#include <csignal>

namespace crankloop::port {

/// While one lives, both signals only set the flag; before and after they do what they did. One at a time.
class StopSignal {
 public:
  StopSignal() noexcept {
    received_.store(false, std::memory_order_relaxed);
    struct sigaction note {};
    note.sa_handler = [](int) { received_.store(true, std::memory_order_relaxed); };
    ::sigaction(SIGINT, &note, &interrupt_before_);
    ::sigaction(SIGTERM, &note, &terminate_before_);
  }
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  ~StopSignal() {
    ::sigaction(SIGINT, &interrupt_before_, nullptr);
    ::sigaction(SIGTERM, &terminate_before_, nullptr);
  }

  [[nodiscard]] bool received() const noexcept { return received_.load(std::memory_order_relaxed); }

 private:
  static inline std::atomic<bool> received_{false};  // a handler has nothing else to write to
  struct sigaction interrupt_before_ {};
  struct sigaction terminate_before_ {};
};

}  // namespace crankloop::port

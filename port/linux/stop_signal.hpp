// SIGINT, SIGTERM and SIGHUP as a flag that a loop looks at.
#pragma once

#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>

namespace crankloop::port {

/// While one lives, these signals only set the flag; before and after they do what they did. A SIGHUP that is ignored
/// stays so: a run under nohup outlives its terminal. One at a time.
class StopSignal {
 public:
  StopSignal() noexcept {
    received_.store(false, std::memory_order_relaxed);
    struct sigaction note {};
    note.sa_handler = [](int) { received_.store(true, std::memory_order_relaxed); };
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      ::sigaction(kSignals[i], &note, &before_[i]);
      if (kSignals[i] == SIGHUP && before_[i].sa_handler == SIG_IGN) ::sigaction(kSignals[i], &before_[i], nullptr);
    }
  }
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  ~StopSignal() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
  }

  [[nodiscard]] bool received() const noexcept { return received_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
  static inline std::atomic<bool> received_{false};  // a handler has nothing else to write to
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace crankloop::port

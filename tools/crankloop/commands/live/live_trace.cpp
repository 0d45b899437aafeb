#include "live_trace.hpp"

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <csignal>

namespace crankloop::program {
namespace {

constexpr std::chrono::milliseconds kPause{5};

/// Signals that end a run are the loop's to receive: while one lives, threads are started with them blocked.
class WithoutSignals {
 public:
  WithoutSignals() noexcept {
    sigset_t all;
    ::sigfillset(&all);
    ::sigdelset(&all, SIGBUS);  // of a lost block
    ::pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  WithoutSignals(const WithoutSignals&) = delete;
  WithoutSignals& operator=(const WithoutSignals&) = delete;
  ~WithoutSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_{};
};

std::vector<std::string> numbers() { return {"speed_rpm", "torque_Nm"}; }

}  // namespace

LiveTrace::LiveTrace(Output& out, const std::string& module, const std::vector<std::string>& wheels, std::size_t room)
    : vcd_{out, module, wheels, numbers()}, wheels_{static_cast<std::uint32_t>(wheels.size())}, queue_(room) {
  const WithoutSignals blocked;
  thread_ = std::thread([this] { run(); });
}

LiveTrace::~LiveTrace() {
  ending_ = true;
  if (thread_.joinable()) thread_.join();
}

void LiveTrace::put(const Change& change) noexcept {
  end_ns_ = std::max(end_ns_, change.time_ns);
  const std::uint64_t at = put_.load(std::memory_order_relaxed);
  if (at - taken_.load(std::memory_order_acquire) >= queue_.size()) {
    ++dropped_;
    return;
  }
  queue_[at % queue_.size()] = change;
  put_.store(at + 1, std::memory_order_release);
}

void LiveTrace::write_what_is_there() {
  const std::uint64_t end = put_.load(std::memory_order_acquire);
  std::uint64_t next = taken_.load(std::memory_order_relaxed);
  if (next == end) return;
  double time_s = 0;
  for (; next != end; ++next) {
    const Change& change = queue_[next % queue_.size()];
    time_s = static_cast<double>(change.time_ns) * 1e-9;
    if (change.variable < wheels_) {
      vcd_.level(change.variable, time_s, change.value != 0);
    } else {
      vcd_.number(change.variable - wheels_, time_s, change.value);
    }
    taken_.store(next + 1, std::memory_order_release);
  }
  vcd_.write_until(time_s);
}

void LiveTrace::run() noexcept {
  try {
    while (!ending_.load(std::memory_order_acquire)) {
      write_what_is_there();
      std::this_thread::sleep_for(kPause);
    }
    write_what_is_there();
  } catch (...) {
    failure_ = std::current_exception();  // the queue fills up, and the rest is dropped
  }
}

void LiveTrace::finish() {
  ending_.store(true, std::memory_order_release);
  thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  vcd_.finish(static_cast<double>(end_ns_) * 1e-9);
}

}  // namespace crankloop::program

// `live --trace F.vcd`: the signals of a run as it goes, written by a second thread.
//
// What belongs here: the queue between the loop and its writer. What does not: the format (signals/vcd.hpp).
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "../../files/output_file.hpp"
#include "../../signals/vcd.hpp"

namespace crankloop::program {

/// The loop puts changes into a queue of fixed size and never waits; the thread takes them out and writes the file.
/// Where the disk or the processor is too slow for it the queue fills up: what finds no room is dropped and counted.
/// The memory in use does not grow with the run.
class LiveTrace {
 public:
  /// Wires of trigger wheels; speed_rpm and torque_Nm beside. The thread starts here: before the loop asks for its
  /// priority, which the thread is not to have.
  LiveTrace(Output& out, const std::string& module, const std::vector<std::string>& wheels,
            std::size_t room = std::size_t{1} << 16);
  LiveTrace(const LiveTrace&) = delete;
  LiveTrace& operator=(const LiveTrace&) = delete;
  ~LiveTrace();

  /// Of the loop's thread, in the order of time since the start of the run. O(1); neither allocates nor waits.
  void level(std::int64_t time_ns, std::uint32_t wheel, bool high) noexcept { put({time_ns, wheel, high ? 1.0 : 0.0}); }
  void speed(std::int64_t time_ns, double rpm) noexcept { put({time_ns, wheels_, rpm}); }
  void torque(std::int64_t time_ns, double Nm) noexcept { put({time_ns, wheels_ + 1, Nm}); }

  /// Writes what is left, and the end; throws what the thread met: OutputError.
  void finish();

  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  struct Change {
    std::int64_t time_ns;
    std::uint32_t variable;  ///< a wheel, or one of the two numbers behind them
    double value;
  };

  void put(const Change& change) noexcept;
  void run() noexcept;
  void write_what_is_there();

  VcdFile vcd_;
  std::uint32_t wheels_;
  std::vector<Change> queue_;  ///< a ring; change n is at n mod its size
  std::atomic<std::uint64_t> put_{0};
  std::atomic<std::uint64_t> taken_{0};
  std::uint64_t dropped_ = 0;
  std::int64_t end_ns_ = 0;
  std::atomic<bool> ending_{false};
  std::exception_ptr failure_;  ///< of the thread; read after it has ended
  std::thread thread_;
};

}  // namespace crankloop::program

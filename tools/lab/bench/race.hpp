// Times contestants in one process and in turns, so that a slow-down of the machine affects all of them.
//
// What belongs here: rounds, medians, the cost of reading the clock. What does not: the contestants.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "crankloop/command_line/progress.hpp"

namespace crankloop::program::bench {

/// Makes the compiler assume that the value is read, so that it cannot remove its computation.
template <class T>
inline void keep(const T& value) noexcept {
  asm volatile("" : : "m"(value) : "memory");
}

/// A function to time. A batch is a whole number of periods (engine cycles), so that all batches cost the same.
struct Contestant {
  std::function<void()> batch;
  double operations;  ///< of one batch: the time is divided by them
};

struct Effort {
  int rounds;                    ///< after one to warm up
  double round_ns;               ///< minimum time of a contestant's turn, which has as many batches as needed
  Progress* progress = nullptr;  ///< a long step of it is a round
};
inline constexpr Effort kQuick{15, 100e3};
inline constexpr Effort kFull{101, 400e3};
inline constexpr Effort kErrorsOnly{0, 0};  ///< times are then NaN

/// Of one operation.
struct Timing {
  double median_ns;
  double spread_ns;  ///< between the quartiles
};

/// Every contestant has a turn in every round, each time in another order. Measures this thread's processor time, so
/// that preemption does not count.
[[nodiscard]] std::vector<Timing> race(const std::vector<Contestant>& contestants, const Effort& effort);

using Clock = std::int64_t() noexcept;

/// Cost of two readings of the clock: mean of the middle half of many.
[[nodiscard]] double clock_cost_ns(Clock& clock);

/// Of a sample, which must not be empty; sorts it.
[[nodiscard]] double quantile(std::vector<double>& sample, double part);
[[nodiscard]] Timing timing_of(std::vector<double>& sample);

/// The mean of a sample's middle half: as robust as the median, and finer than a clock with a resolution of 10 ns.
[[nodiscard]] double middle_mean(std::vector<double>& sample);

}  // namespace crankloop::program::bench

// Timing contestants against one another: in one process, in turns, so that whatever slows the machine slows all of
// them.
//
// What belongs here: rounds, medians, the clock's own cost. What does not: what is timed.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "crankloop/command_line/progress.hpp"

namespace crankloop::program::bench {

/// Makes the compiler believe that the value is read: neither it nor what led to it can be left out.
template <class T>
inline void keep(const T& value) noexcept {
  asm volatile("" : : "m"(value) : "memory");
}

/// Something to be timed. A batch is a whole number of what repeats itself (a cycle of the engine), so that batches
/// cost alike.
struct Contestant {
  std::function<void()> batch;
  double operations;  ///< of one batch: the time is divided by them
};

struct Effort {
  int rounds;                    ///< after one to warm up
  double round_ns;               ///< a contestant's turn lasts at least that long: as many batches as it takes
  Progress* progress = nullptr;  ///< a long step of it is a round
};
inline constexpr Effort kQuick{15, 100e3};
inline constexpr Effort kFull{101, 400e3};
inline constexpr Effort kErrorsOnly{0, 0};  ///< times are then no numbers

/// Of one operation.
struct Timing {
  double median_ns;
  double spread_ns;  ///< between the quartiles
};

/// Every contestant has its turn in every round, in another order each time. Timed by what this thread ran, so that
/// being put aside for another program does not count.
[[nodiscard]] std::vector<Timing> race(const std::vector<Contestant>& contestants, const Effort& effort);

using Clock = std::int64_t() noexcept;

/// What a pair of readings of a clock costs, by the middle half of many.
[[nodiscard]] double clock_cost_ns(Clock& clock);

/// Of a sample, which must not be empty: it is put in order.
[[nodiscard]] double quantile(std::vector<double>& sample, double part);
[[nodiscard]] Timing timing_of(std::vector<double>& sample);

/// The mean of a sample's middle half: as hardy as the median, and finer than a clock that ticks every 10 ns.
[[nodiscard]] double middle_mean(std::vector<double>& sample);

}  // namespace crankloop::program::bench

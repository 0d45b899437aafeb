// A free run from its beginning to its end, in as many points as a drawing shows.
//
// What belongs here: the smallest and largest of a value in equal parts of the run. What does not: a cycle's details
// (free_cycles.hpp).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crankloop::program {

/// Memory does not grow with the run: the number of parts is fixed by the number of ticks that is told first.
class Overview {
 public:
  struct Part {
    double begin_s;
    double smallest;
    double largest;
  };

  explicit Overview(std::uint64_t ticks) : ticks_per_part_{ticks / kMaxParts + 1} {}

  void take(double time_s, double value) {
    if (taken_++ % ticks_per_part_ == 0) parts_.push_back({time_s, value, value});
    parts_.back().smallest = std::min(parts_.back().smallest, value);
    parts_.back().largest = std::max(parts_.back().largest, value);
  }
  [[nodiscard]] const std::vector<Part>& parts() const noexcept { return parts_; }

 private:
  static constexpr std::uint64_t kMaxParts = 2000;

  std::uint64_t ticks_per_part_;
  std::uint64_t taken_ = 0;
  std::vector<Part> parts_;
};

}  // namespace crankloop::program

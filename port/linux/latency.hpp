// How long something took, many times over: a histogram with fixed buckets, so that counting neither allocates nor
// waits.
//
// What belongs here: counting times and telling percentiles. What does not: reading clocks (stopwatch.hpp), text and
// files.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace crankloop::port {

/// Buckets as wide as 1 ns below 128 ns, and 64 to each octave above: no bucket is wider than 1/64 of the times in it.
/// Octaves end at 2^40 ns, 18 minutes; longer times are counted in the last bucket. Some 18 KB.
class LatencyHistogram {
 public:
  struct Bucket {
    std::int64_t first_ns;  ///< the shortest time it counts
    std::int64_t last_ns;   ///< the longest
    std::uint64_t count;
  };

  /// O(1). A negative time, which a clock that is set could give, counts as 0.
  void add(std::int64_t time_ns) noexcept {
    time_ns = std::max<std::int64_t>(time_ns, 0);
    ++buckets_[index_of(time_ns)];
    ++count_;
    sum_ns_ += time_ns;
    longest_ns_ = std::max(longest_ns_, time_ns);
  }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::int64_t longest_ns() const noexcept { return longest_ns_; }
  [[nodiscard]] double mean_ns() const noexcept {
    return count_ == 0 ? 0 : static_cast<double>(sum_ns_) / static_cast<double>(count_);
  }

  /// The time that at least `parts` of 10 000 did not exceed: 5000 is the median, 9990 the 99.9th percentile, 10 000
  /// the longest. Told as its bucket's end, so never too short, and at most 1/64 too long. 0 where nothing was counted.
  [[nodiscard]] std::int64_t quantile_ns(std::uint32_t parts) const noexcept {
    // The rank in whole numbers: 99.9 / 100 * count in double can come out one too high. ceil(parts * count / 10 000):
    const std::uint64_t rank = count_ / 10000 * parts + (count_ % 10000 * parts + 9999) / 10000;
    std::uint64_t counted = 0;
    for (std::size_t i = 0; i < kBuckets; ++i) {
      counted += buckets_[i];
      if (counted >= rank && counted > 0) return std::min(bucket(i).last_ns, longest_ns_);
    }
    return longest_ns_;
  }

  static constexpr int kParts = 64;       // of an octave
  static constexpr int kPartsLog2 = 6;    // 2^6 = 64
  static constexpr int kLastOctave = 39;  // 2^39 to 2^40 - 1 ns
  static constexpr std::size_t kBuckets = std::size_t{2 + kLastOctave - kPartsLog2} * kParts;

  /// From the shortest times to the longest.
  [[nodiscard]] Bucket bucket(std::size_t index) const noexcept {
    if (index < std::size_t{2} * kParts)
      return {static_cast<std::int64_t>(index), static_cast<std::int64_t>(index), buckets_[index]};
    const std::size_t width_log2 = index / kParts - 1;
    const auto first_ns = static_cast<std::int64_t>((index % kParts + kParts) << width_log2);
    return {first_ns, first_ns + (std::int64_t{1} << width_log2) - 1, buckets_[index]};
  }

 private:
  /// A time of octave o has the leading bit 2^o; it and the six bits below it say which part of the octave.
  [[nodiscard]] static std::size_t index_of(std::int64_t time_ns) noexcept {
    const auto bits = static_cast<std::uint64_t>(time_ns);
    if (bits < std::uint64_t{2} * kParts) return static_cast<std::size_t>(bits);
    const int octave = 63 - __builtin_clzll(bits);
    if (octave > kLastOctave) return kBuckets - 1;
    const int width_log2 = octave - kPartsLog2;
    return static_cast<std::size_t>(width_log2) * kParts + static_cast<std::size_t>(bits >> width_log2);
  }

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  std::int64_t sum_ns_ = 0;
  std::int64_t longest_ns_ = 0;
};

}  // namespace crankloop::port

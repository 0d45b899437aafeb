// Some doubles under one sequence lock, as many as a section of the block has: signals and inputs by name.
//
// What belongs here: reading and writing them as a whole. What does not: what they are (live_block.h lists the names).
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "live_block.h"
#include "sequence_lock.hpp"

namespace crankloop::port {

inline constexpr std::size_t kMaxLiveNumbers = 256;  ///< of one section
using LiveNumbers = std::array<double, kMaxLiveNumbers>;

/// A view of a section, whose memory others own. Without one (count 0) it is never written, and what is read is left
/// as it was.
class LockedNumbers {
 public:
  LockedNumbers() = default;
  /// `section`: its sequence number, then 8 bytes on the numbers. At most kMaxLiveNumbers.
  LockedNumbers(void* section, std::size_t count) noexcept
      : sequence_{static_cast<std::atomic<std::uint32_t>*>(section)}, words_{sequence_ + 2}, count_{count} {}

  /// The first count() of them. One writer.
  void write(const LiveNumbers& numbers) noexcept {
    if (count_ == 0) return;
    Words words;
    std::memcpy(words.data(), numbers.data(), count_ * sizeof(double));
    sequence_lock::write(*sequence_, words_, words.data(), 2 * count_);
  }

  /// False, and both are left as they were, while the writer is at it.
  [[nodiscard]] bool read(LiveNumbers& numbers, std::uint32_t& sequence) const noexcept {
    if (count_ == 0) return true;
    Words words;
    if (!sequence_lock::read(*sequence_, words_, words.data(), 2 * count_, sequence)) return false;
    std::memcpy(numbers.data(), words.data(), count_ * sizeof(double));
    return true;
  }

  [[nodiscard]] std::uint32_t sequence() const noexcept {
    return count_ == 0 ? 0 : sequence_->load(std::memory_order_acquire);
  }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }

 private:
  static_assert(sizeof(std::atomic<std::uint32_t>) == 4 && sizeof(crankloop_live_numbers) == 8);
  using Words = std::array<std::uint32_t, 2 * kMaxLiveNumbers>;

  std::atomic<std::uint32_t>* sequence_ = nullptr;
  std::atomic<std::uint32_t>* words_ = nullptr;
  std::size_t count_ = 0;
};

}  // namespace crankloop::port

// The ring of trigger edges in the block, from its writer's side. Readers: live_block.h.
//
// What belongs here: how an edge is published. What does not: when an edge is due (the loop that writes it).
#pragma once

#include <atomic>
#include <cstdint>

#include "live_block.h"

namespace crankloop::port {

/// One writer, any number of readers, none of whom it knows or waits for: a reader that is slower than a whole ring
/// finds its edges overwritten, and counts them.
///
/// Each word of an entry is stored with release after the counter of the edge before, and loaded with acquire: a reader
/// that finds a word of edge n in its entry also finds the counter at n or more afterwards, and so throws away what it
/// took for edge n - depth.
class EdgeRing {
 public:
  EdgeRing() = default;
  /// `section`: struct crankloop_live_edges and `depth` entries, a power of two; all zero.
  EdgeRing(void* section, std::uint64_t depth) noexcept
      : ring_{static_cast<crankloop_live_edges*>(section)},
        entries_{reinterpret_cast<crankloop_live_edge*>(ring_ + 1)},
        depth_{depth} {}

  /// In the order of due times. Without a ring it does nothing. O(1).
  void write(std::uint64_t due_ns, std::uint32_t wheel, std::uint32_t level) noexcept {
    if (depth_ == 0) return;
    crankloop_live_edge& entry = entries_[written_ & (depth_ - 1)];
    __atomic_store_n(&entry.due_ns, due_ns, __ATOMIC_RELEASE);
    __atomic_store_n(&entry.wheel, wheel, __ATOMIC_RELEASE);
    __atomic_store_n(&entry.level, level, __ATOMIC_RELEASE);
    __atomic_store_n(&ring_->written, ++written_, __ATOMIC_RELEASE);
  }

  [[nodiscard]] std::uint64_t written() const noexcept { return written_; }
  [[nodiscard]] std::uint64_t depth() const noexcept { return depth_; }

 private:
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "a lock is not shared with another process");

  crankloop_live_edges* ring_ = nullptr;
  crankloop_live_edge* entries_ = nullptr;
  std::uint64_t depth_ = 0;
  std::uint64_t written_ = 0;  // its own: who overwrites the block's counter moves no entry
};

}  // namespace crankloop::port

// A value that one thread or process writes and others read, none of them ever waiting for another.
//
// What belongs here: the lock. What does not: what is written under it (shared_block.hpp).
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace crankloop::port {

/// The writer makes the sequence number odd, writes the words, and makes it even again, two more than before. Who reads
/// the same even number before and after the words has words of one write; otherwise they are torn and thrown away.
///
/// Every word is a separate atomic, so a torn read is no data race. A word is stored with release and loaded with
/// acquire: whoever loads a word of a write also sees the odd number stored before it, and so never accepts it as a
/// part of the write before. The same is often written with fences, which the thread sanitizer does not understand; on
/// x86 both are plain moves.
namespace sequence_lock {

/// Never waits. A writer that died while writing left the number odd; the next one goes on from there.
inline void write(std::atomic<std::uint32_t>& sequence, std::atomic<std::uint32_t>* words, const std::uint32_t* from,
                  std::size_t count) noexcept {
  const std::uint32_t odd = sequence.load(std::memory_order_relaxed) | 1u;
  sequence.store(odd, std::memory_order_relaxed);
  for (std::size_t i = 0; i < count; ++i) words[i].store(from[i], std::memory_order_release);
  sequence.store(odd + 1, std::memory_order_release);
}

/// One try, so it never waits. False while the writer is at it: what is in `to` is then torn. `number`: of the write.
[[nodiscard]] inline bool read(const std::atomic<std::uint32_t>& sequence, const std::atomic<std::uint32_t>* words,
                               std::uint32_t* to, std::size_t count, std::uint32_t& number) noexcept {
  const std::uint32_t before = sequence.load(std::memory_order_acquire);
  if (before % 2 != 0) return false;
  for (std::size_t i = 0; i < count; ++i) to[i] = words[i].load(std::memory_order_acquire);
  if (sequence.load(std::memory_order_relaxed) != before) return false;
  number = before;
  return true;
}

}  // namespace sequence_lock

/// A value under such a lock. One writer. All zeros is a valid lock that was never written (sequence 0), so it may lie
/// in a new file.
template <class Value>
class SequenceLocked {
  static_assert(std::is_trivially_copyable_v<Value> && sizeof(Value) % sizeof(std::uint32_t) == 0);
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free,
                "a lock hidden in an atomic is not shared with another process");

 public:
  void write(const Value& value) noexcept {
    Words words;
    std::memcpy(words.data(), &value, sizeof value);
    sequence_lock::write(sequence_, words_.data(), words.data(), kWords);
  }

  /// False, and `value` and `sequence` are left as they were, while the writer is at it.
  [[nodiscard]] bool read(Value& value, std::uint32_t& sequence) const noexcept {
    Words words;
    if (!sequence_lock::read(sequence_, words_.data(), words.data(), kWords, sequence)) return false;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
    return true;
  }

  /// Grows by 2 with every write, modulo 2^32; odd while one is under way.
  [[nodiscard]] std::uint32_t sequence() const noexcept { return sequence_.load(std::memory_order_acquire); }

 private:
  static constexpr std::size_t kWords = sizeof(Value) / sizeof(std::uint32_t);
  using Words = std::array<std::uint32_t, kWords>;

  std::atomic<std::uint32_t> sequence_{0};
  alignas(8) std::array<std::atomic<std::uint32_t>, kWords> words_{};
};

}  // namespace crankloop::port

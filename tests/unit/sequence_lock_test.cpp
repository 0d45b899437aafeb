// The sequence lock of port/linux: what is read is what was written as a whole. Also built with the thread sanitizer
// (tests/contract).
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <thread>

#include "port/linux/sequence_lock.hpp"

namespace crankloop::port::sequence_lock_test {
namespace {

/// Every word says which write it is of; as long as LiveOutputs.
struct Numbered {
  std::array<std::uint32_t, 26> words;

  static Numbered of(std::uint32_t write) {
    Numbered value{};
    for (std::uint32_t i = 0; i < value.words.size(); ++i) value.words[i] = write * 31 + i;
    return value;
  }
  [[nodiscard]] bool is_of(std::uint32_t write) const { return words == of(write).words; }
  [[nodiscard]] bool is_of_none() const { return words == Numbered{}.words; }
};

TEST(SequenceLock, ReadsWhatWasWrittenAndCountsItsWrites) {
  SequenceLocked<Numbered> shared;
  Numbered value{};
  std::uint32_t sequence = 7;
  EXPECT_TRUE(shared.read(value, sequence));
  EXPECT_EQ(sequence, 0u) << "never written";
  for (std::uint32_t write = 1; write <= 5; ++write) {
    shared.write(Numbered::of(write));
    ASSERT_TRUE(shared.read(value, sequence));
    EXPECT_TRUE(value.is_of(write));
    EXPECT_EQ(sequence, 2 * write);
    EXPECT_EQ(shared.sequence(), 2 * write);
  }
}

/// The lock's first word: what another process finds there.
template <class Value>
std::atomic<std::uint32_t>& number_of(SequenceLocked<Value>& shared) {
  static_assert(std::is_standard_layout_v<SequenceLocked<Value>>);
  return reinterpret_cast<std::atomic<std::uint32_t>&>(shared);
}

TEST(SequenceLock, RefusesToReadWhileAWriteIsUnderWayAndGoesOnAfterADeadWriter) {
  SequenceLocked<Numbered> shared;
  shared.write(Numbered::of(1));
  number_of(shared) = 3;  // a writer that died after it began
  Numbered value = Numbered::of(9);
  std::uint32_t sequence = 9;
  EXPECT_FALSE(shared.read(value, sequence));
  EXPECT_TRUE(value.is_of(9)) << "left as it was";
  EXPECT_EQ(sequence, 9u);

  shared.write(Numbered::of(2));  // by the next writer
  ASSERT_TRUE(shared.read(value, sequence));
  EXPECT_TRUE(value.is_of(2));
  EXPECT_EQ(sequence, 4u);
}

TEST(SequenceLock, GoesOnWhereTheNumberWraps) {
  SequenceLocked<Numbered> shared;
  number_of(shared) = 0xFFFFFFFE;
  shared.write(Numbered::of(1));
  Numbered value{};
  std::uint32_t sequence = 9;
  ASSERT_TRUE(shared.read(value, sequence));
  EXPECT_TRUE(value.is_of(1));
  EXPECT_EQ(sequence, 0u);
}

TEST(SequenceLock, NoTornReadIsEverAcceptedBetweenTwoThreads) {
  constexpr std::uint32_t kReads = 300'000;
  constexpr std::uint32_t kTorn = 10'000;  // reads that met a write
  const auto patience =
      std::chrono::steady_clock::now() + std::chrono::seconds(3);  // on one processor they hardly meet
  SequenceLocked<Numbered> shared;
  std::atomic<bool> enough{false};
  std::thread writer([&] {
    std::uint32_t write = 0;
    while (!enough.load(std::memory_order_relaxed)) {
      shared.write(Numbered::of(++write));
      // Pauses of many lengths, so that reads begin between two writes and are caught by the next at every word.
      for (std::uint32_t pause = write % 128; pause > 0 && !enough.load(std::memory_order_relaxed); --pause) {
      }
    }
  });
  std::uint32_t accepted = 0;
  std::uint32_t torn = 0;
  std::uint32_t wrong = 0;
  std::uint32_t latest = 0;
  const auto enough_of_both = [&] { return accepted >= kReads && torn >= kTorn; };
  while (!enough_of_both() && (latest == 0 || std::chrono::steady_clock::now() < patience)) {
    Numbered value{};
    std::uint32_t sequence = 0;
    if (!shared.read(value, sequence)) {
      ++torn;
      if (torn % 1024 == 0) std::this_thread::yield();  // on a single processor a write may need our time to end
      continue;
    }
    ++accepted;
    const bool is_whole = sequence == 0 ? value.is_of_none() : value.is_of(sequence / 2);
    if (!is_whole || sequence < latest) ++wrong;
    latest = sequence;
  }
  enough = true;
  writer.join();
  EXPECT_EQ(wrong, 0u) << "of " << accepted << " accepted reads, " << torn << " torn";
}

}  // namespace
}  // namespace crankloop::port::sequence_lock_test

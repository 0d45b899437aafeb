// The ring of edges of port/linux: a reader gets each edge once and whole, or counts it as lost. Also built with the
// thread sanitizer (tests/contract).
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include "port/linux/edge_ring.hpp"

namespace crankloop::port::edge_ring_test {
namespace {

/// A block with nothing but a ring.
class Ring {
 public:
  explicit Ring(std::uint32_t depth) : words_(kRing / 8 + 8 + std::size_t{2} * depth) {
    auto* block = static_cast<crankloop_live_block*>(data());
    block->magic = CRANKLOOP_LIVE_MAGIC;
    block->version = CRANKLOOP_LIVE_VERSION;
    block->size_bytes = static_cast<std::uint32_t>(bytes());
    block->section_count = 1;
    block->section_list = CRANKLOOP_LIVE_FIXED_BYTES;
    *reinterpret_cast<crankloop_live_section*>(block + 1) = {CRANKLOOP_LIVE_EDGES, kRing, depth,
                                                             sizeof(crankloop_live_edge)};
    EXPECT_EQ(crankloop_live_refusal(data(), bytes()), nullptr);
    writer = EdgeRing(words_.data() + kRing / 8, depth);
  }
  [[nodiscard]] void* data() { return words_.data(); }
  [[nodiscard]] std::size_t bytes() const { return words_.size() * 8; }
  [[nodiscard]] crankloop_live_edge_reader reader() {
    crankloop_live_edge_reader reader;
    EXPECT_EQ(crankloop_live_edges_begin(data(), &reader), 1);
    return reader;
  }
  /// Edge n says of itself that it is.
  void write() {
    const std::uint64_t n = writer.written();
    writer.write(n * 1000, static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(n * 7));
  }

  EdgeRing writer;

 private:
  static constexpr std::uint32_t kRing = 320;
  std::vector<std::uint64_t> words_;
};

bool is_whole(const crankloop_live_edge& edge) {
  return edge.due_ns % 1000 == 0 && edge.wheel == static_cast<std::uint32_t>(edge.due_ns / 1000) &&
         edge.level == edge.wheel * 7;
}

TEST(EdgeRing, GivesEachEdgeOnceAndInOrderToAnyNumberOfReaders) {
  Ring ring(16);
  ring.write();  // before the readers begin
  std::vector<crankloop_live_edge_reader> readers{ring.reader(), ring.reader()};
  std::vector<std::uint64_t> next{1, 1};
  for (int round = 0; round < 100; ++round) {
    for (int i = 0; i < 1 + round % 5; ++i) ring.write();
    for (std::size_t r = 0; r < 2; ++r) {
      if (r == 1 && round % 3 != 0) continue;  // a slower one: up to 15 edges in a ring of 16
      crankloop_live_edge edges[4];
      for (std::size_t count = 4; count == 4;) {
        count = crankloop_live_edges_read(&readers[r], edges, 4);
        for (std::size_t i = 0; i < count; ++i) {
          ASSERT_TRUE(is_whole(edges[i]));
          ASSERT_EQ(edges[i].due_ns, 1000 * next[r]++);
        }
      }
    }
  }
  for (const crankloop_live_edge_reader& reader : readers) EXPECT_EQ(reader.lost, 0u);
  EXPECT_EQ(readers[0].read, ring.writer.written() - 1);
}

/// One of the ring's places may be under the writer's hand: a reader that is depth - 1 behind loses nothing, one that
/// is depth behind loses one.
TEST(EdgeRing, CountsWhatAReaderMissedToTheEdge) {
  for (const std::uint64_t written : {0u, 1u, 14u, 15u, 16u, 17u, 31u, 32u, 1000u}) {
    Ring ring(16);
    crankloop_live_edge_reader reader = ring.reader();
    for (std::uint64_t i = 0; i < written; ++i) ring.write();
    crankloop_live_edge edges[64];
    const std::size_t count = crankloop_live_edges_read(&reader, edges, 64);
    EXPECT_EQ(count, written < 15 ? written : 15) << written;
    EXPECT_EQ(reader.lost, written - count);
    EXPECT_EQ(reader.read, count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(edges[i].due_ns, 1000 * (written - count + i));
  }
}

TEST(EdgeRing, SurvivesACounterThatSomebodyOverwrote) {
  Ring ring(16);
  for (int i = 0; i < 20; ++i) ring.write();
  crankloop_live_edge_reader reader = ring.reader();
  auto* counter = static_cast<std::uint64_t*>(ring.data()) + 320 / 8;
  crankloop_live_edge edges[64];
  *counter = 3;
  EXPECT_EQ(crankloop_live_edges_read(&reader, edges, 64), 0u);
  *counter = ~std::uint64_t{0};
  EXPECT_LE(crankloop_live_edges_read(&reader, edges, 64), 64u);
  ring.write();
  EXPECT_EQ(*counter, 21u) << "the writer counts on its own";
}

/// A writer that never waits and readers that are too slow for a small ring: what they get is whole and the edge that
/// it counts as, and what they did not get is counted.
TEST(EdgeRing, IsNeverReadTorn) {
  constexpr std::chrono::milliseconds kRace{500};  // some ten million edges
  Ring ring(8);
  std::atomic<bool> done{false};
  const auto follow = [&](crankloop_live_edge_reader reader, std::size_t most) {
    std::uint64_t torn = 0, misplaced = 0;
    std::vector<crankloop_live_edge> edges(most);
    for (bool last = false; !last;) {
      last = done.load();
      for (std::size_t count = most; count > 0;) {
        count = crankloop_live_edges_read(&reader, edges.data(), most);
        for (std::size_t i = 0; i < count; ++i) {
          torn += is_whole(edges[i]) ? 0u : 1u;
          misplaced += edges[i].due_ns == 1000 * (reader.next - count + i) ? 0u : 1u;
        }
      }
    }
    EXPECT_EQ(torn, 0u);
    EXPECT_EQ(misplaced, 0u);
    EXPECT_EQ(reader.read + reader.lost, ring.writer.written());
    EXPECT_GT(reader.lost, 0u) << "it was no race";
  };
  std::thread one(follow, ring.reader(), 64);
  std::thread other(follow, ring.reader(), 3);
  for (const auto end = std::chrono::steady_clock::now() + kRace; std::chrono::steady_clock::now() < end;) {
    for (int i = 0; i < 1000; ++i) ring.write();
  }
  done = true;
  one.join();
  other.join();
}

}  // namespace
}  // namespace crankloop::port::edge_ring_test

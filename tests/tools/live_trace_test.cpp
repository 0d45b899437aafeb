// The trace of `live`: all changes in the file where the writer keeps up, dropped and counted where it does not, and a
// loop that never learns of a full disk.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "crankloop/commands/live/live_trace.hpp"
#include "crankloop/files/error.hpp"
#include "support/files.hpp"
#include "support/vcd_dump.hpp"

namespace crankloop::program::live_trace_test {
namespace {

struct Written {
  Dump dump;
  std::uint64_t dropped;
};

/// As fast as it can, `changes` changes of a wire, one each microsecond.
Written write(const std::string& path, std::size_t room, int changes) {
  Output out(path);
  LiveTrace trace(out, "engine", {"crank", "cam"}, room);
  for (int i = 0; i < changes; ++i) trace.level(1000 * i, 1, i % 2 == 1);
  trace.finish();
  out.finish();
  return {read_dump(path), trace.dropped()};
}

TEST(LiveTrace, HasEveryChangeWhereTheQueueHasRoom) {
  const support::TemporaryFolder folder;
  const Written written = write(folder / "all.vcd", 1000, 1000);
  EXPECT_EQ(written.dropped, 0u);
  ASSERT_EQ(written.dump.changes.size(), 1000u);
  for (std::size_t i = 0; i < 1000; ++i) {
    EXPECT_EQ(written.dump.changes[i].time_ns, static_cast<long long>(1000 * i));
    EXPECT_EQ(written.dump.changes[i].name, "cam");
    EXPECT_EQ(written.dump.changes[i].value, i % 2 == 1 ? 1 : 0);
  }
  EXPECT_EQ(written.dump.end_ns, 999'000);
}

/// The queue is full at once. What is in the file is true, and its end is the run's.
TEST(LiveTrace, DropsAndCountsWhatFindsNoRoom) {
  const support::TemporaryFolder folder;
  constexpr int kChanges = 2'000'001;
  const Written written = write(folder / "some.vcd", 64, kChanges);
  EXPECT_GT(written.dropped, 1000u);
  EXPECT_LE(written.dump.changes.size() + written.dropped, std::size_t{kChanges});
  EXPECT_GE(written.dump.changes.size(), 64u / 2) << "after a gap a wire may be where it was";
  for (const Dump::Change& change : written.dump.changes)
    ASSERT_EQ(change.value, change.time_ns / 1000 % 2 == 1 ? 1 : 0) << change.time_ns;
  EXPECT_EQ(written.dump.end_ns, 1000LL * (kChanges - 1));
}

TEST(LiveTrace, TellsAFullDiskAtItsEndAlone) {
  Output out("/dev/full");
  LiveTrace trace(out, "engine", {"crank"}, 1 << 16);
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
  for (std::int64_t time_ns = 0; std::chrono::steady_clock::now() < end; ++time_ns)
    trace.speed(time_ns, static_cast<double>(time_ns));
  const auto finish = [&] {
    trace.finish();
    out.finish();
  };
  EXPECT_THROW(finish(), OutputError);
}

}  // namespace
}  // namespace crankloop::program::live_trace_test

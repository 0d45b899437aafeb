// The VCD writer, read back by a reader of its own: whitespace-separated tokens, as IEEE 1364 has them.
#include "crankloop/signals/vcd.hpp"

#include "crankloop/commands/run/run_signals.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "support/files.hpp"
#include "support/vcd_dump.hpp"

namespace crankloop::program::vcd_test {
namespace {

class VcdTest : public testing::Test {
 protected:
  VcdTest() { path_ = folder_ / "signals.vcd"; }

  support::TemporaryFolder folder_;
  std::string path_;
};

void expect_change(const Dump::Change& change, long long time_ns, const std::string& name, double value) {
  EXPECT_EQ(change.time_ns, time_ns);
  EXPECT_EQ(change.name, name);
  EXPECT_EQ(change.value, value);
}

TEST_F(VcdTest, TellsSignalsByNameInTheOrderOfTime) {
  Output out(path_);
  VcdFile vcd(out, "495 diesel", {"crank", "cam"}, {"speed_rpm"});
  vcd.level(0, 0, false);
  vcd.level(1, 0, true);
  vcd.number(0, 0, 812.5);
  vcd.write_until(0);
  // One tick's edges, wheel after wheel: not in the order of time.
  vcd.level(0, 30.2e-6, true);
  vcd.level(0, 80e-6, false);
  vcd.level(1, 55e-6, false);
  vcd.number(0, 100e-6, 812.25);
  vcd.write_until(100e-6);
  vcd.finish(200e-6);
  out.finish();

  const Dump dump = read_dump(path_);
  EXPECT_EQ(dump.scope, "495_diesel");
  EXPECT_EQ(dump.timescale, "1ns");
  ASSERT_EQ(dump.changes.size(), 7u);
  expect_change(dump.changes[0], 0, "crank", 0);
  expect_change(dump.changes[1], 0, "cam", 1);
  expect_change(dump.changes[2], 0, "speed_rpm", 812.5);
  expect_change(dump.changes[3], 30200, "crank", 1);
  expect_change(dump.changes[4], 55000, "cam", 0);
  expect_change(dump.changes[5], 80000, "crank", 0);
  expect_change(dump.changes[6], 100000, "speed_rpm", 812.25);
  EXPECT_EQ(dump.end_ns, 200000);
}

TEST_F(VcdTest, LeavesOutWhatDoesNotChange) {
  Output out(path_);
  VcdFile vcd(out, "m", {"a"}, {"b"});
  for (int i = 0; i < 10; ++i) {
    vcd.level(0, i * 1e-6, i >= 5);
    vcd.number(0, i * 1e-6, i / 4);
    vcd.write_until(i * 1e-6);
  }
  vcd.finish(10e-6);
  out.finish();
  const Dump dump = read_dump(path_);
  ASSERT_EQ(dump.changes.size(), 5u);
  expect_change(dump.changes[2], 4000, "b", 1);
  expect_change(dump.changes[3], 5000, "a", 1);
  expect_change(dump.changes[4], 8000, "b", 2);
}

TEST_F(VcdTest, KeepsTimesRisingAndLosesNothingAtItsEnd) {
  Output out(path_);
  VcdFile vcd(out, "m", {"a"}, {});
  vcd.level(0, 100e-9, true);
  vcd.write_until(1e-6);
  vcd.level(0, 50e-9, false);  // too late to be told at its time
  vcd.level(0, 700e-9, true);  // beyond the end that finish() gives
  vcd.finish(300e-9);
  out.finish();
  const Dump dump = read_dump(path_);
  ASSERT_EQ(dump.changes.size(), 3u);
  expect_change(dump.changes[1], 100, "a", 0);
  expect_change(dump.changes[2], 700, "a", 1);
  EXPECT_EQ(dump.end_ns, 700);
}

TEST_F(VcdTest, HasCodesForMoreSignalsThanThereArePrintableCharacters) {
  std::vector<std::string> names;
  for (int i = 0; i < 200; ++i) names.push_back("wheel" + std::to_string(i));
  Output out(path_);
  VcdFile vcd(out, "m", names, {});
  for (std::size_t i = 0; i < names.size(); ++i) vcd.level(i, static_cast<double>(i) * 1e-9, true);
  vcd.finish(1e-6);
  out.finish();
  const Dump dump = read_dump(path_);
  ASSERT_EQ(dump.changes.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) expect_change(dump.changes[i], static_cast<long long>(i), names[i], 1);
}

TEST_F(VcdTest, OfARunHasTheTeethOfItsWheelsAtTheirTimes) {
  // 495: 60-2 from 246 deg on, a tooth every 6 deg; half a moon from 540 to 900 deg. At 2000 rpm a degree takes 83.333
  // us.
  const EngineFile engine = read_engine_file(CRANKLOOP_SOURCE_DIR "/tools/engines/diesel_495.ini", {});
  Output out(path_);
  write_signals(engine, {2000, 100e-6, 1}, 2, out);
  out.finish();
  const Dump dump = read_dump(path_);
  EXPECT_EQ(dump.scope, "495_diesel");
  EXPECT_EQ(dump.end_ns, 120'000'000) << "two cycles";
  std::map<std::string, std::vector<long long>> rises_ns, falls_ns;
  for (const Dump::Change& change : dump.changes) {
    if (change.time_ns > 0) (change.value != 0 ? rises_ns : falls_ns)[change.name].push_back(change.time_ns);
  }
  const auto expect_times = [](const std::vector<long long>& times_ns, const std::vector<double>& degrees) {
    ASSERT_EQ(times_ns.size(), degrees.size());
    for (std::size_t i = 0; i < degrees.size(); ++i)
      EXPECT_NEAR(static_cast<double>(times_ns[i]), degrees[i] / 12e-6, 1.0);
  };
  std::vector<double> teeth_deg;
  for (double turn_deg = 246 - 360; turn_deg < 1440; turn_deg += 360) {
    for (int tooth = 0; tooth < 58; ++tooth) {
      if (const double deg = turn_deg + 6 * tooth; deg > 0 && deg <= 1440) teeth_deg.push_back(deg);
    }
  }
  expect_times(rises_ns["crank"], teeth_deg);
  expect_times(rises_ns["cam"], {540, 1260});
  expect_times(falls_ns["cam"], {180, 900});
  expect_change(dump.changes.at(2), 0, "cam", 1);
}

}  // namespace
}  // namespace crankloop::program::vcd_test

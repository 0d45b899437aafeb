// The edges of `crankloop live` outside its process: readers in C and Python that lose and double none or say what they
// lost, a player, a controller that has nothing but edges, the trace; and `live` under attack.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "support/live_bench.hpp"
#include "support/vcd_dump.hpp"

namespace crankloop::port::live_edges_test {
namespace {

const std::string kReader = CRANKLOOP_SOURCE_DIR "/docs/live_reader.py";

constexpr const char* kNoPython = "there is no python3, which nothing of crankloop needs";
/// With the reader's modules: their first import on a machine takes longer than some of these tests run `live`.
bool has_python() { return std::system("python3 -c 'import argparse, mmap, struct, threading' >/dev/null 2>&1") == 0; }

class LiveRing : public LiveBench {
 protected:
  /// fast.ini turns at 6000 rpm as good as for ever: without gas, friction or brake. A 60-2 wheel and half a moon are
  /// 11 700 edges a second.
  void SetUp() override {
    std::string text = contents(kEngine);
    text.resize(text.find("[pressure]"));
    const std::string limit = "max_rpm = 3000 ";
    ASSERT_NE(text.find(limit), std::string::npos);
    text.replace(text.find(limit), limit.size(), "max_rpm = 7000 ");
    text +=
        "\n[friction]\nconstant_kPa = 0\n[trigger crank]\non = crank\npattern = 60-2\nfirst_tooth_deg = 246\n"
        "[trigger cam]\non = cam\npattern = half-moon\nfirst_tooth_deg = -180\n";
    std::ofstream(in_folder("fast.ini")) << text;
  }
  [[nodiscard]] std::vector<std::string> fast_live(const std::string& block, const std::string& tick_us,
                                                   const std::string& seconds,
                                                   const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words{CRANKLOOP_PROGRAM, "live",      in_folder("fast.ini"),
                                   "--from-rpm",      "6000",      "--tick-us",
                                   tick_us,           "--seconds", seconds,
                                   "--shared",        block,       "--no-warnings"};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  }
  static std::vector<std::string> c_reader(const std::string& block, const std::string& seconds,
                                           const std::string& pause_ms) {
    return {CRANKLOOP_EDGE_READER, block, seconds, pause_ms};
  }
  static std::vector<std::string> python_reader(const std::string& block, const std::string& pause_s) {
    return {"/usr/bin/env", "python3", kReader, block, "--pause", pause_s};
  }
};

long long count_of(const std::map<std::string, std::string>& values, const std::string& name) {
  const auto found = values.find(name);
  EXPECT_NE(found, values.end()) << name;
  return found == values.end() ? -1 : std::stoll(found->second);
}

/// Whether it had each edge that `live` wrote since it began, or says how many not.
void expect_books_that_agree(const std::string& reader, const std::string& live) {
  SCOPED_TRACE(reader + "\n---\n" + live);
  const auto read = values_of(reader);
  const auto ran = values_of(live);
  EXPECT_EQ(count_of(read, "written"), count_of(ran, "edges")) << "followed to the end";
  EXPECT_EQ(count_of(read, "begin") + count_of(read, "read") + count_of(read, "lost"), count_of(read, "written"));
  EXPECT_EQ(count_of(read, "wrong"), 0);
}

/// What `live` and its readers have printed in the end.
struct Prints {
  std::string live, c, python;
};

/// Ends `live` some seconds after both readers have its block: their start may take seconds. They follow it to its end.
Prints prints_of(const std::vector<std::string>& live, const std::string& block,
                 const std::vector<std::string>& c_reader, const std::vector<std::string>& python_reader,
                 const std::string& folder, double seconds) {
  Process engine(live, folder + "live.txt");
  EXPECT_TRUE(running_block(block)) << engine.output();  // and unmapped: a child begins with its parent's maps
  Process c(c_reader, folder + "c.txt");
  Process python(python_reader, folder + "python.txt");
  EXPECT_TRUE(comes_true([&] { return c.has_mapped(block) && python.has_mapped(block); }))
      << c.output() << python.output();
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  engine.signal(SIGINT);
  EXPECT_EQ(engine.wait(), 0) << engine.output();
  EXPECT_EQ(c.wait(), 0) << c.output();
  EXPECT_EQ(python.wait(), 0) << python.output();
  Prints prints{engine.output(), c.output(), python.output()};
  expect_books_that_agree(prints.c, prints.live);
  expect_books_that_agree(prints.python, prints.live);
  return prints;
}

/// At 1 kHz and 10 kHz, side by side. The reader in C misses no edge; what the one in Python misses, it counts.
void expect_no_loss_at_both_rates(const std::function<Prints(const std::string& tick_us)>& prints_at) {
  const auto keep_up = [&](const std::string& tick_us) {
    const Prints prints = prints_at(tick_us);
    const auto live = values_of(prints.live), c = values_of(prints.c), python = values_of(prints.python);
    EXPECT_EQ(count_of(c, "lost"), 0) << prints.c;
    const double ran_s = static_cast<double>(count_of(live, "ticks")) * std::stod(tick_us) * 1e-6;
    EXPECT_NEAR(static_cast<double>(count_of(live, "edges")), 11'650 * ran_s, 250 * ran_s);
    std::printf("[ figures  ] %s us: C %lld read, %lld lost; Python %lld, %lld\n", tick_us.c_str(), count_of(c, "read"),
                count_of(c, "lost"), count_of(python, "read"), count_of(python, "lost"));
  };
  std::thread other(keep_up, "1000");
  keep_up("100");
  other.join();
}

TEST_F(LiveRing, LosesNoEdgeAt1kHzAnd10kHz) {
  if (!has_python()) GTEST_SKIP() << kNoPython;
  expect_no_loss_at_both_rates([&](const std::string& tick_us) {
    const std::string block = in_folder(tick_us + "_block");
    return prints_of(fast_live(block, tick_us, "600"), block, c_reader(block, "1e9", "5"),
                     python_reader(block, "0.005"), in_folder(tick_us), 3);
  });
}

/// While four other programs want the processors. CRANKLOOP_LONG_TESTS=1 in the environment: for a minute.
TEST_F(LiveRing, LosesNoEdgeOnALoadedMachine) {
  if (!has_python()) GTEST_SKIP() << kNoPython;
  const double seconds = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 60 : 6;
  std::vector<std::unique_ptr<Process>> load;
  for (int i = 0; i < 4; ++i) {
    load.push_back(std::make_unique<Process>(std::vector<std::string>{"/bin/sh", "-c", "while :; do :; done"},
                                             in_folder("load.txt")));
  }
  expect_no_loss_at_both_rates([&](const std::string& tick_us) {
    const std::string block = in_folder(tick_us + "_block");
    return prints_of(fast_live(block, tick_us, "600"), block, c_reader(block, "1e9", "5"), python_reader(block, "0.01"),
                     in_folder(tick_us), seconds);
  });
}

TEST_F(LiveRing, CountsOverrunToTheEdgeWhenItIsForced) {
  if (!has_python()) GTEST_SKIP() << kNoPython;
  const Prints prints = prints_of(fast_live(block_path(), "1000", "600", {"--ring-edges", "64"}), block_path(),
                                  c_reader(block_path(), "1e9", "100"),  // 1165 edges between two looks
                                  python_reader(block_path(), "0.1"), in_folder(""), 1);
  EXPECT_GT(count_of(values_of(prints.c), "lost"), 1000) << prints.c;
  EXPECT_GT(count_of(values_of(prints.python), "lost"), 1000) << prints.python;
}

/// An edge's due time is its own: as far ahead as asked for, and the teeth as even as the speed.
TEST_F(LiveRing, HasEdgesThatAreDueWhenTheyAreSupposedTo) {
  std::map<int, double> margin_ms;
  for (const int lead : {0, 3}) {
    Process engine(fast_live(block_path(), "1000", "600", {"--lead-ticks", std::to_string(lead)}),
                   in_folder("live.txt"));
    const std::optional<SharedBlock> block = open_running();
    ASSERT_TRUE(block) << engine.output();
    crankloop_live_edge_reader reader;
    ASSERT_EQ(crankloop_live_edges_begin(block->data(), &reader), 1);
    std::vector<double> rising_ns;
    double largest_ms = -1e9;
    crankloop_live_edge edges[64];
    ASSERT_TRUE(comes_true([&] {
      const std::size_t count = crankloop_live_edges_read(&reader, edges, 64);
      for (std::size_t i = 0; i < count; ++i) {
        if (edges[i].wheel == 0 && edges[i].level == 1) rising_ns.push_back(static_cast<double>(edges[i].due_ns));
        largest_ms = std::max(largest_ms, (static_cast<double>(edges[i].due_ns) -
                                           static_cast<double>(std::chrono::steady_clock::now().time_since_epoch() /
                                                               std::chrono::nanoseconds(1))) /
                                              1e6);
      }
      return rising_ns.size() > 1200;
    }));
    margin_ms[lead] = largest_ms;
    // A tooth is 1 / 6000 s at 6000 rpm, the gap three; the teeth stand where they are to the float's resolution in a
    // tick, 0.1 ns of 1 ms, and the masses let the speed of a heavy flywheel swing by a part of a per cent.
    int gaps = 0;
    for (std::size_t i = 1; i < rising_ns.size(); ++i) {
      const double pitches = (rising_ns[i] - rising_ns[i - 1]) / (1e9 / 6000);
      const double whole = std::round(pitches);
      ASSERT_TRUE(whole == 1 || whole == 3) << pitches;
      ASSERT_NEAR(pitches, whole, 0.05 * whole);
      gaps += whole == 3 ? 1 : 0;
    }
    EXPECT_NEAR(gaps, 1200 / 58, 1);
    engine.signal(SIGINT);
    EXPECT_EQ(engine.wait(), 0);
  }
  // The last edge of a tick that is published at once is due nearly a tick later, and the lead on top of it.
  EXPECT_LE(margin_ms[0], 1.0);
  EXPECT_LE(margin_ms[3], 4.0);
  EXPECT_GT(margin_ms[3], 3.0) << "this machine never published a tick within its own time";
}

/// A machine that is busy with other things stops the controller for longer than an engine idles without it: of three
/// tries, one holds the speed.
TEST_F(LiveRing, IdlesThe495FromItsEdgesAlone) {
  std::map<std::string, std::string> held;
  std::string controller_said;
  const auto value = [&](const char* name) { return std::stod(held.at(name)); };
  const auto is_held = [&] { return std::abs(value("mean_speed") - 800) <= 8 && value("peak_error") <= 80; };
  for (int tries = 0; tries < 3 && (held.empty() || !is_held()); ++tries) {
    Process engine(live({"--tick-us", "1000", "--seconds", "30", "--shared", block_path(), "--silent-ms", "5000"}),
                   in_folder("live.txt"));
    Process controller({CRANKLOOP_EDGE_COUNTER, block_path(), "--target-rpm", "800", "--seconds", "5"},
                       in_folder("control.txt"));
    EXPECT_EQ(controller.wait(), 0) << controller.output();
    engine.signal(SIGINT);
    EXPECT_EQ(engine.wait(), 0) << engine.output();
    EXPECT_EQ(values_of(engine.output()).at("faulty_ticks"), "0");
    controller_said = controller.output();
    held = values_of(controller_said);
    EXPECT_EQ(held.at("edges_lost"), "0");
  }
  EXPECT_TRUE(is_held()) << controller_said;  // as idle_control, which is shown the speed
}

TEST_F(LiveRing, IsPlayedEdgeByEdgeAndTheLatenessTold) {
  Process engine(fast_live(block_path(), "1000", "0.6"), in_folder("live.txt"));
  ASSERT_TRUE(open_running()) << engine.output();
  Process player({CRANKLOOP_EDGE_PLAYER, block_path(), "--record", in_folder("played.csv"), "--priority", "0"},
                 in_folder("player.txt"));
  EXPECT_EQ(player.wait(), 0) << player.output();
  EXPECT_EQ(engine.wait(), 0);
  const auto played = values_of(player.output());
  std::istringstream rows(contents(in_folder("played.csv")));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row, "wheel,level,due_ns,set_ns");
  std::map<int, int> level;
  std::vector<long long> lateness_ns;
  long long set_before_ns = 0;
  while (std::getline(rows, row)) {
    int wheel = -1, high = -1;
    long long due_ns = 0, set_ns = 0;
    ASSERT_EQ(std::sscanf(row.c_str(), "%d,%d,%lld,%lld", &wheel, &high, &due_ns, &set_ns), 4) << row;
    if (level.count(wheel) > 0) {
      EXPECT_NE(level[wheel], high) << row;
    }
    level[wheel] = high;
    EXPECT_GE(set_ns, due_ns) << "never before it is due";
    EXPECT_GE(set_ns, set_before_ns);
    set_before_ns = set_ns;
    lateness_ns.push_back(set_ns - due_ns);
  }
  ASSERT_GT(lateness_ns.size(), 1000u) << player.output();
  EXPECT_EQ(count_of(played, "edges_played"), static_cast<long long>(lateness_ns.size()));
  EXPECT_EQ(count_of(played, "edges_lost"), 0);
  // The figures that it prints are those of its record, to a bucket of the histogram.
  std::sort(lateness_ns.begin(), lateness_ns.end());
  const auto expect_quantile = [&](const std::string& name, double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(lateness_ns.size())));
    const double exact_us = static_cast<double>(lateness_ns[rank - 1]) / 1e3;
    EXPECT_NEAR(std::stod(played.at("lateness_" + name)), exact_us, exact_us / 64 + 0.001) << name;
  };
  expect_quantile("p50", 0.5);
  expect_quantile("p99", 0.99);
  expect_quantile("max", 1);
}

TEST_F(LiveRing, IsRefusedByPlayersAndReadersThatCannotUseIt) {
  if (!has_python()) GTEST_SKIP() << kNoPython;
  std::string block_of_version_3(256, '\0');
  const std::uint32_t head[] = {kLiveMagic, 3, 256, 1};
  block_of_version_3.replace(0, sizeof head, std::string(reinterpret_cast<const char*>(head), sizeof head));
  std::ofstream(block_path()) << block_of_version_3;
  Process c(c_reader(block_path(), "1", "1"), in_folder("c.txt"));
  EXPECT_EQ(c.wait(), 1);
  EXPECT_EQ(c.output(), block_path() + ": is a block of another version of crankloop\n");
  Process python(python_reader(block_path(), "0.1"), in_folder("python.txt"));
  EXPECT_EQ(python.wait(), 1);
  EXPECT_EQ(python.output(),
            "live_reader: " + block_path() + ": is a block of version 3 of crankloop live; this reader's is 4\n");
  Process player({CRANKLOOP_EDGE_PLAYER, block_path(), "--chip", "/dev/null", "--lines", "1,2"}, in_folder("p.txt"));
  EXPECT_EQ(player.wait(), 1);
  // The system's own reason follows: an emulated processor's is another.
  const std::string refusal = "edge_player: /dev/null: lines cannot be had: ";
  EXPECT_EQ(player.output().substr(0, refusal.size()), refusal);
  EXPECT_EQ(player.output().find('\n'), player.output().size() - 1);
}

TEST_F(LiveRing, IsRecordedOrThePlayerSaysThatItIsNot) {
  Process engine(fast_live(block_path(), "1000", "600"), in_folder("live.txt"));
  ASSERT_TRUE(open_running()) << engine.output();
  Process player({CRANKLOOP_EDGE_PLAYER, block_path(), "--record", "/dev/full", "--seconds", "0.2", "--priority", "0",
                  "--cpu", "1023"},
                 in_folder("player.txt"));
  EXPECT_EQ(player.wait(), 1);
  EXPECT_EQ(values_of(player.output()).count("edges_played"), 1u) << player.output();
  EXPECT_NE(player.output().find("edge_player: /dev/full: cannot be written: "), std::string::npos) << player.output();
  EXPECT_NE(player.output().find("edge_player: not on processor 1023: "), std::string::npos) << player.output();
}

TEST_F(LiveRing, LeavesARecordAloneWhereThereIsNothingToRecord) {
  std::string text = contents(in_folder("fast.ini"));
  text.resize(text.find("[trigger crank]"));
  std::ofstream(in_folder("fast.ini")) << text;
  std::ofstream(in_folder("played.csv")) << "precious\n";
  Process engine(fast_live(block_path(), "1000", "600"), in_folder("live.txt"));
  ASSERT_TRUE(open_running()) << engine.output();
  Process player({CRANKLOOP_EDGE_PLAYER, block_path(), "--record", in_folder("played.csv")}, in_folder("player.txt"));
  EXPECT_EQ(player.wait(), 1);
  EXPECT_EQ(player.output(), "edge_player: " + block_path() + ": the engine has no trigger wheel\n");
  EXPECT_EQ(contents(in_folder("played.csv")), "precious\n");
}

TEST_F(LiveRing, IsNotForCommandLinesThatCanOnlyBeGuessed) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{CRANKLOOP_EDGE_PLAYER, "--cpu", "x"}, "edge_player: --cpu: 'x' is no number from 0 to 1023\n"},
      {{CRANKLOOP_EDGE_PLAYER, "--cpu", "1.5"}, "edge_player: --cpu: '1.5' is no whole number\n"},
      {{CRANKLOOP_EDGE_PLAYER, "--seconds", "1e"}, "edge_player: --seconds: '1e' is no number from 0.001 to 1000000\n"},
      {{CRANKLOOP_EDGE_PLAYER, "--spin-us", "nan"}, "edge_player: --spin-us: 'nan' is no number from 0 to 1000000\n"},
      {{CRANKLOOP_EDGE_PLAYER, "--secnds", "1"}, "edge_player: --secnds: is no option\n"},
      {{CRANKLOOP_EDGE_PLAYER, "--seconds"}, "edge_player: --seconds: its value is missing\n"},
      {{CRANKLOOP_EDGE_PLAYER, "1"}, "edge_player: 1: the path is " + block_path() + " already\n"},
      {{CRANKLOOP_EDGE_PLAYER, "--lines", "17,"}, "edge_player: --lines: '' is no number from 0 to 4294967295\n"},
      {{CRANKLOOP_EDGE_COUNTER, "--pattern", "60"}, "edge_counter: --pattern: '60' is no N-M, like 60-2\n"},
      {{CRANKLOOP_EDGE_COUNTER, "--wheel", "-1"}, "edge_counter: --wheel: '-1' is no number from 0 to 1000\n"},
      {{CRANKLOOP_IDLE_CONTROL, "--target-rpm", "8OO"},
       "idle_control: --target-rpm: '8OO' is no number from 1 to 100000\n"},
  };
  for (const auto& [words, message] : cases) {
    std::vector<std::string> all = words;
    all.insert(all.begin() + 1, block_path());
    if (words[0] == CRANKLOOP_EDGE_PLAYER) all.insert(all.begin() + 1, {"--record", in_folder("played.csv")});
    Process refused(all, in_folder("refused.txt"));
    EXPECT_EQ(refused.wait(), 1) << message;
    EXPECT_EQ(refused.output().substr(0, message.size()), message);
    EXPECT_EQ(refused.output().substr(message.size(), 7), "usage: ");
    EXPECT_FALSE(std::filesystem::exists(in_folder("played.csv")));
  }
}

// ---- the trace ------------------------------------------------------------------------------------------------------

/// The model's signals, whenever they were computed: those of `run --free` with the same tick.
TEST_F(LiveRing, IsTracedAsAFreeRunIs) {
  const std::vector<std::string> same{"--from-rpm", "900", "--load-ratio", "0.3", "--starter", "--seconds", "0.5"};
  std::vector<std::string> traced = live({"--tick-us", "500", "--trace", in_folder("live.vcd")});
  traced.insert(traced.end(), same.begin(), same.end());
  Process engine(traced, in_folder("live.txt"));
  ASSERT_EQ(engine.wait(), 0) << engine.output();
  EXPECT_EQ(values_of(engine.output()).at("trace_dropped"), "0");
  std::vector<std::string> words{CRANKLOOP_PROGRAM, "run", kEngine, "--free",
                                 "--tick-us",       "500", "--vcd", in_folder("run.vcd")};
  words.insert(words.end(), same.begin(), same.end());
  Process free_run(words, in_folder("run.txt"));
  ASSERT_EQ(free_run.wait(), 0) << free_run.output();
  const program::Dump live_dump = program::read_dump(in_folder("live.vcd"));
  const program::Dump run_dump = program::read_dump(in_folder("run.vcd"));
  EXPECT_EQ(live_dump.end_ns, 500'000'000);
  ASSERT_GT(run_dump.changes.size(), 2500u);
  const auto of = [](const program::Dump& dump, const std::string& name) {
    std::vector<program::Dump::Change> changes;
    for (const program::Dump::Change& change : dump.changes) {
      if (change.name == name) changes.push_back(change);
    }
    return changes;
  };
  for (const char* name : {"crank", "cam", "speed_rpm", "torque_Nm"}) {
    const auto a = of(live_dump, name);
    const auto b = of(run_dump, name);
    ASSERT_EQ(a.size(), b.size()) << name;
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_NEAR(static_cast<double>(a[i].time_ns), static_cast<double>(b[i].time_ns), 1) << name;
      ASSERT_EQ(a[i].value, b[i].value) << name << " at " << a[i].time_ns;
    }
  }
}

TEST_F(LiveRing, IsTracedWithoutHarmToTheRunWhereTheDiskIsFull) {
  Process engine(live({"--tick-us", "500", "--from-rpm", "900", "--seconds", "0.3", "--trace", "/dev/full"}),
                 in_folder("live.txt"));
  EXPECT_EQ(engine.wait(), 1);
  EXPECT_EQ(values_of(engine.output()).at("ticks"), "600") << engine.output();
  EXPECT_NE(engine.output().find("crankloop: /dev/full cannot be written: No space left on device\n"),
            std::string::npos)
      << engine.output();
}

// ---- inputs ---------------------------------------------------------------------------------------------------------

TEST_F(LiveRing, TakesInputsFromAFileUntilAControllerWrites) {
  std::ofstream(in_folder("inputs.csv")) << "time_s,load_ratio,starter\n0,0.3,1\n0.3,0.3,0\n0.5,0.1,0\n";
  const std::vector<std::string> same{"--inputs", in_folder("inputs.csv"), "--seconds", "0.6", "--tick-us", "500"};
  std::vector<std::string> words = live(same);
  Process engine(words, in_folder("live.txt"));
  ASSERT_EQ(engine.wait(), 0) << engine.output();
  std::vector<std::string> free_words{CRANKLOOP_PROGRAM, "run", kEngine, "--free"};
  free_words.insert(free_words.end(), same.begin(), same.end());
  Process free_run(free_words, in_folder("run.txt"));
  ASSERT_EQ(free_run.wait(), 0) << free_run.output();
  const std::string speed = values_of(free_run.output()).at("speed_at_end");
  EXPECT_EQ(values_of(engine.output()).at("final_speed"), speed);
  EXPECT_GT(std::stod(speed), 200) << "the file's starter turned it";
  EXPECT_EQ(values_of(engine.output()).at("inputs_from_file"), "load_ratio, starter");
}

TEST_F(LiveRing, IsDrivenByInputsByName) {
  std::string text = contents(kEngine);
  const std::string cam = "[cam intake]\n";
  ASSERT_NE(text.find(cam), std::string::npos);
  text.insert(text.find(cam) + cam.size(), "phase_rate_deg_per_s = 100\n");
  std::ofstream(in_folder("phased.ini")) << text;
  Process engine({CRANKLOOP_PROGRAM, "live", in_folder("phased.ini"), "--seconds", "600", "--from-rpm", "1000",
                  "--shared", block_path(), "--silent-ms", "60000"},
                 in_folder("live.txt"));
  const std::optional<SharedBlock> block = open_running();
  ASSERT_TRUE(block) << engine.output();
  const void* map = block->data();
  const crankloop_live_section names = crankloop_live_find(map, CRANKLOOP_LIVE_INPUT_NAMES);
  LiveNumbers inputs{};
  std::uint32_t sequence = 0;
  ASSERT_TRUE(block->inputs_by_name().read(inputs, sequence));
  EXPECT_NE(sequence, 0u) << "live shows what there is to begin with";
  inputs[crankloop_live_index(map, names, "load_ratio")] = 0.5;
  inputs[crankloop_live_index(map, names, "starter")] = 1;  // should it have stopped meanwhile
  inputs[crankloop_live_index(map, names, "cam_phase_deg[1]")] = 7;
  LiveInputs fixed;
  fixed.external_torque_Nm = 1e6;  // would stop it at once
  block->inputs_by_name().write(inputs);
  EXPECT_TRUE(comes_true([&] { return outputs_of(*block).inputs_sequence == sequence + 2; }));
  (*block)->inputs.write(fixed);
  EXPECT_TRUE(comes_true([&] { return outputs_of(*block).speed_rad_s > 130; })) << "faster by half its load";
  const crankloop_live_section signal_names = crankloop_live_find(map, CRANKLOOP_LIVE_SIGNAL_NAMES);
  const std::uint32_t phase = crankloop_live_index(map, signal_names, "cam_phase_deg[1]");
  ASSERT_LT(phase, signal_names.count);
  LiveNumbers signals{};
  EXPECT_TRUE(comes_true([&] { return block->signals().read(signals, sequence) && signals[phase] > 6.99; }))
      << signals[phase];
  engine.signal(SIGINT);
  EXPECT_EQ(engine.wait(), 0);
  EXPECT_EQ(values_of(engine.output()).at("controller"), "seen, inputs by name");
  EXPECT_NE(engine.output().find("# the inputs of the fixed part were written too: not used"), std::string::npos);
}

/// With the starter: on a busy machine the engine has stopped before Python is there.
TEST_F(LiveRing, IsDrivenFromPython) {
  if (!has_python()) GTEST_SKIP() << kNoPython;
  std::ofstream(in_folder("drive.py")) << "import sys, time\n"
                                          "sys.path.insert(0, sys.argv[1])\n"
                                          "from live_reader import Block, RUNNING\n"
                                          "block = Block(sys.argv[2])\n"
                                          "inputs = block.inputs()\n"
                                          "inputs['load_ratio'] = 0.5\n"
                                          "inputs['starter'] = 1\n"
                                          "while block.state == RUNNING:\n"
                                          "    block.write_inputs(inputs)\n"
                                          "    signals = block.signals()\n"
                                          "    speed = block.speed_rad_s()\n"
                                          "    if signals and speed and speed > 130: break\n"
                                          "    time.sleep(0.005)\n"
                                          "print('cylinder = %s' % (signals['cylinder[4].pressure_Pa'] > 1e4))\n";
  Process engine(live({"--seconds", "600", "--from-rpm", "1000", "--shared", block_path(), "--silent-ms", "5000"}),
                 in_folder("live.txt"));
  const std::optional<SharedBlock> block = open_running();
  ASSERT_TRUE(block) << engine.output();
  Process python({"/usr/bin/env", "python3", "-B", in_folder("drive.py"), CRANKLOOP_SOURCE_DIR "/docs", block_path()},
                 in_folder("python.txt"));
  EXPECT_EQ(python.wait(), 0) << python.output();
  EXPECT_EQ(python.output(), "cylinder = True\n");
  EXPECT_GT(outputs_of(*block).speed_rad_s, 100);
  engine.signal(SIGINT);
  EXPECT_EQ(engine.wait(), 0);
  EXPECT_EQ(values_of(engine.output()).at("controller"), "seen, inputs by name");
}

// ---- attacks --------------------------------------------------------------------------------------------------------

TEST_F(LiveRing, IsMissedByItsPlayerInOneLineWhenLiveDies) {
  if (!has_python()) GTEST_SKIP() << kNoPython;
  Process engine(fast_live(block_path(), "1000", "600"), in_folder("live.txt"));
  ASSERT_TRUE(open_running()) << engine.output();
  Process player({CRANKLOOP_EDGE_PLAYER, block_path(), "--record", in_folder("played.csv"), "--priority", "0"},
                 in_folder("player.txt"));
  Process python(python_reader(block_path(), "0.01"), in_folder("python.txt"));
  Process counter({CRANKLOOP_EDGE_COUNTER, block_path(), "--target-rpm", "5000"}, in_folder("counter.txt"));
  ASSERT_TRUE(comes_true([&] {
    return std::filesystem::exists(in_folder("played.csv")) &&
           std::filesystem::file_size(in_folder("played.csv")) > 9999;
  }));
  engine.signal(SIGKILL);
  EXPECT_EQ(player.wait(), 1);
  EXPECT_NE(player.output().find("edge_player: " + block_path() +
                                 ": live has written nothing for 1 s: it has died or hangs\n"),
            std::string::npos)
      << player.output();
  EXPECT_EQ(count_of(values_of(player.output()), "edges_lost"), 0) << "and it says what it had";
  EXPECT_EQ(counter.wait(), 1);
  EXPECT_EQ(counter.output().substr(0, counter.output().find('\n')),
            "edge_counter: live has written nothing for 1 s: it has died or hangs");
  EXPECT_EQ(python.wait(), 1);
  EXPECT_EQ(python.output().substr(python.output().find("live_reader")),
            "live_reader: live has written nothing for 1 s: it has died or hangs\n");
}

TEST_F(LiveRing, IsMissedByItsPlayerInOneLineWhenTheBlockIsTakenAway) {
  Process engine(fast_live(block_path(), "1000", "600"), in_folder("live.txt"));
  ASSERT_TRUE(open_running()) << engine.output();
  Process player({CRANKLOOP_EDGE_PLAYER, block_path(), "--record", in_folder("played.csv"), "--priority", "0"},
                 in_folder("player.txt"));
  ASSERT_TRUE(comes_true([&] {
    return std::filesystem::exists(in_folder("played.csv")) &&
           std::filesystem::file_size(in_folder("played.csv")) > 9999;
  }));
  std::filesystem::resize_file(block_path(), 0);
  EXPECT_EQ(engine.wait(), 1);
  EXPECT_EQ(player.wait(), 1) << player.output();
  EXPECT_NE(player.output().find("edge_player: " + block_path() + ": the block was truncated or overwritten\n"),
            std::string::npos)
      << player.output();
}

/// Writes any bytes at all into the inputs, the list of sections, the names and the counter of the ring.
void write_garbage(const SharedBlock& block, std::uint32_t seed, std::chrono::milliseconds duration) {
  std::mt19937 random(seed);
  auto* words = static_cast<std::uint32_t*>(const_cast<void*>(block.data()));
  std::vector<std::uint32_t> targets;
  for (std::uint32_t at = 64; at < 128; at += 4) targets.push_back(at / 4);
  for (std::uint32_t at = 16; at < 64; at += 4) targets.push_back(at / 4);
  const void* map = block.data();
  const crankloop_live_section inputs = crankloop_live_find(map, CRANKLOOP_LIVE_INPUTS);
  const crankloop_live_section ring = crankloop_live_find(map, CRANKLOOP_LIVE_EDGES);
  const crankloop_live_section names = crankloop_live_find(map, CRANKLOOP_LIVE_INPUT_NAMES);
  for (std::uint32_t at = 0; at < 8 + 8 * inputs.count; at += 4) targets.push_back((inputs.offset + at) / 4);
  for (std::uint32_t at = 0; at < 128; at += 4) targets.push_back((ring.offset + at) / 4);
  for (std::uint32_t at = 0; at < 48; at += 4) targets.push_back((names.offset + at) / 4);
  for (std::uint32_t at = 256; at < 320; at += 4) targets.push_back(at / 4);
  constexpr std::uint32_t kNasty[] = {0,          0xFFFFFFFFu, 0x7FF00000u, 0xFFF00000u, 0x7FF80000u,
                                      0x80000000, 0x7FEFFFFFu, 1,           0x40590000u};
  const auto end = std::chrono::steady_clock::now() + duration;
  while (std::chrono::steady_clock::now() < end) {
    for (int i = 0; i < 64; ++i) {
      const std::uint32_t word = random() % 2 == 0 ? kNasty[random() % 9] : static_cast<std::uint32_t>(random());
      __atomic_store_n(words + targets[random() % targets.size()], word, __ATOMIC_RELEASE);
    }
  }
}

TEST_F(LiveRing, GoesOnWhateverIsWrittenIntoItsInputs) {
  for (const char* sample : {"diesel_495", "four_2000"}) {
    Process engine({CRANKLOOP_PROGRAM, "live", std::string(CRANKLOOP_SOURCE_DIR "/tools/engines/") + sample + ".ini",
                    "--tick-us", "200", "--seconds", "600", "--from-rpm", "1500", "--shared", block_path()},
                   in_folder("live.txt"));
    const std::optional<SharedBlock> block = open_running();
    ASSERT_TRUE(block) << engine.output();
    write_garbage(*block, 7, std::chrono::milliseconds(400));
    std::vector<double> numbers(kMaxLiveNumbers, 0);
    const LiveOutputs out = outputs_of(*block);
    for (const double number : {out.speed_rad_s, out.acceleration_rad_s2, out.crank_deg, out.torque_Nm,
                                out.mean_torque_Nm, out.friction_Nm, out.intake_Pa, out.trapped_air_kg})
      EXPECT_TRUE(std::isfinite(number));
    EXPECT_GT(out.ticks, 100u);
    engine.signal(SIGINT);
    EXPECT_EQ(engine.wait(), 0) << engine.output();
    const auto ran = values_of(engine.output());
    EXPECT_GT(std::stoll(ran.at("faulty_ticks")), 0) << "and says what it was given";
    EXPECT_TRUE(std::isfinite(std::stod(ran.at("final_speed"))));
  }
}

TEST_F(LiveRing, GoesOnWithTwoWritersOfItsInputs) {
  Process engine(live({"--tick-us", "200", "--seconds", "600", "--from-rpm", "1500", "--shared", block_path()}),
                 in_folder("live.txt"));
  const std::optional<SharedBlock> block = open_running();
  ASSERT_TRUE(block) << engine.output();
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
  const auto write = [&](double load_ratio) {
    LiveInputs in;
    in.load_ratio = load_ratio;
    while (std::chrono::steady_clock::now() < end) (*block)->inputs.write(in);
  };
  std::thread other(write, 0.2);
  write(0.3);
  other.join();
  engine.signal(SIGINT);
  EXPECT_EQ(engine.wait(), 0) << engine.output();
  const auto ran = values_of(engine.output());
  EXPECT_EQ(ran.at("controller"), "seen");
  EXPECT_EQ(ran.at("faulty_ticks"), "0") << "either's load ratio is one";
}

}  // namespace
}  // namespace crankloop::port::live_edges_test

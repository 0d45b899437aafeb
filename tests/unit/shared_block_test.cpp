// The block that `crankloop live` shares: its bytes as docs/live.md lists them, who gets it and who is refused, and
// whose inputs count.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "port/linux/shared_block.hpp"
#include "port/linux/watched_inputs.hpp"
#include "support/files.hpp"

namespace crankloop::port::shared_block_test {
namespace {

constexpr double kTick_s = 1e-3;
constexpr std::uint32_t kCylinders = 4;

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class SharedBlockFile : public testing::Test {
 protected:
  [[nodiscard]] std::string path() const { return folder_ / "block"; }
  void put(const std::string& text) const { std::ofstream(path(), std::ios::binary) << text; }

  /// A number of the file at an offset of docs/live.md.
  template <class Number>
  [[nodiscard]] Number at(std::size_t offset) const {
    Number number{};
    const std::string bytes = bytes_of(path());
    EXPECT_LE(offset + sizeof number, bytes.size());
    if (offset + sizeof number <= bytes.size()) std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
  }

  static std::string refusal_of(SharedBlock (*action)(const std::string&), const std::string& path) {
    try {
      static_cast<void>(action(path));
    } catch (const SharedBlockError& error) {
      return error.what();
    }
    return "";
  }
  static SharedBlock create_at(const std::string& path) { return SharedBlock::create(path, contents()); }
  static LiveContents contents() {
    LiveContents contents;
    contents.tick_s = kTick_s;
    contents.cylinders = kCylinders;
    contents.signals = {"crank_deg", "faults", "cam_deg"};
    contents.inputs = {"fuel_kg[1]", "starter"};
    contents.wheels = {"crank", std::string(60, 'w')};
    contents.ring_edges = 64;
    return contents;
  }

  support::TemporaryFolder folder_;
};

// ---- layout ---------------------------------------------------------------------------------------------------------

TEST_F(SharedBlockFile, HasItsNumbersWhereTheDocumentSays) {
  const SharedBlock block = create_at(path());
  EXPECT_EQ(at<std::uint32_t>(0), 0x4C4B5243u);
  EXPECT_EQ(at<std::uint32_t>(4), 4u);
  EXPECT_EQ(at<std::uint32_t>(8), bytes_of(path()).size());
  EXPECT_EQ(at<std::uint32_t>(12), 0u);
  EXPECT_EQ(at<double>(16), kTick_s);
  EXPECT_EQ(at<std::uint32_t>(24), kCylinders);
  EXPECT_EQ(at<std::uint32_t>(28), 0u);
  block->breathes = 1;
  EXPECT_EQ(at<std::uint32_t>(28), 1u);

  LiveInputs in;
  in.load_ratio = 0.25;
  in.external_torque_Nm = -3;
  in.starter = 1;
  in.cut_cylinders = 5;
  in.throttle_ratio = 0.75;
  in.fuel_kg = 6;
  in.burn_start_deg = 7;
  in.excess_air_ratio = 8;
  block->inputs.write(in);
  EXPECT_EQ(at<std::uint32_t>(64), 2u);
  EXPECT_EQ(at<double>(72), 0.25);
  EXPECT_EQ(at<double>(80), -3);
  EXPECT_EQ(at<std::uint32_t>(88), 1u);
  EXPECT_EQ(at<std::uint32_t>(92), 5u);
  EXPECT_EQ(at<double>(96), 0.75);
  EXPECT_EQ(at<double>(104), 6);
  EXPECT_EQ(at<double>(112), 7);
  EXPECT_EQ(at<double>(120), 8);

  LiveOutputs out;
  out.ticks = 1;
  out.time_s = 2;
  out.speed_rad_s = 3;
  out.acceleration_rad_s2 = 4;
  out.crank_deg = 5;
  out.torque_Nm = 6;
  out.mean_torque_Nm = 7;
  out.friction_Nm = 8;
  out.starter_Nm = 9;
  out.faults = 10;
  out.flags = 11;
  out.inputs_sequence = 12;
  out.torn_inputs = 13;
  out.late_ticks = 14;
  out.missed_deadlines = 15;
  out.intake_Pa = 16;
  out.trapped_air_kg = 17;
  block->outputs.write(out);
  EXPECT_EQ(at<std::uint32_t>(128), 2u);
  EXPECT_EQ(at<std::uint64_t>(136), 1u);
  for (std::size_t i = 1; i <= 8; ++i) EXPECT_EQ(at<double>(136 + 8 * i), static_cast<double>(i + 1));
  for (std::size_t i = 0; i <= 3; ++i) EXPECT_EQ(at<std::uint32_t>(208 + 4 * i), static_cast<std::uint32_t>(i + 10));
  EXPECT_EQ(at<std::uint64_t>(224), 14u);
  EXPECT_EQ(at<std::uint64_t>(232), 15u);
  EXPECT_EQ(at<double>(240), 16);
  EXPECT_EQ(at<double>(248), 17);
}

/// The rows "| offset | type | field | ..." of the document's table.
std::map<std::string, std::size_t> offsets_of_the_document() {
  std::map<std::string, std::size_t> offsets;
  std::istringstream document(bytes_of(CRANKLOOP_SOURCE_DIR "/docs/live.md"));
  for (std::string line; std::getline(document, line);) {
    std::string bar, field, type;
    std::size_t offset = 0;
    std::istringstream row(line);
    if (row >> bar >> offset >> bar >> type >> bar >> field && (type == "u32" || type == "u64" || type == "f64"))
      offsets[field] = offset;
  }
  return offsets;
}

TEST(LiveBlock, IsTheTableOfTheDocument) {
  constexpr std::size_t kInputs = offsetof(LiveBlock, inputs) + 8;
  constexpr std::size_t kOutputs = offsetof(LiveBlock, outputs) + 8;
  const std::map<std::string, std::size_t> offsets = {
      {"magic", offsetof(LiveBlock, magic)},
      {"version", offsetof(LiveBlock, version)},
      {"size_bytes", offsetof(LiveBlock, size_bytes)},
      {"state", offsetof(LiveBlock, state)},
      {"tick_s", offsetof(LiveBlock, tick_s)},
      {"cylinders", offsetof(LiveBlock, cylinders)},
      {"breathes", offsetof(LiveBlock, breathes)},
      {"section_count", offsetof(LiveBlock, section_count)},
      {"section_list", offsetof(LiveBlock, section_list)},
      {"load_ratio", kInputs + offsetof(LiveInputs, load_ratio)},
      {"external_torque_Nm", kInputs + offsetof(LiveInputs, external_torque_Nm)},
      {"starter", kInputs + offsetof(LiveInputs, starter)},
      {"cut_cylinders", kInputs + offsetof(LiveInputs, cut_cylinders)},
      {"throttle_ratio", kInputs + offsetof(LiveInputs, throttle_ratio)},
      {"fuel_kg", kInputs + offsetof(LiveInputs, fuel_kg)},
      {"burn_start_deg", kInputs + offsetof(LiveInputs, burn_start_deg)},
      {"excess_air_ratio", kInputs + offsetof(LiveInputs, excess_air_ratio)},
      {"ticks", kOutputs + offsetof(LiveOutputs, ticks)},
      {"time_s", kOutputs + offsetof(LiveOutputs, time_s)},
      {"speed_rad_s", kOutputs + offsetof(LiveOutputs, speed_rad_s)},
      {"acceleration_rad_s2", kOutputs + offsetof(LiveOutputs, acceleration_rad_s2)},
      {"crank_deg", kOutputs + offsetof(LiveOutputs, crank_deg)},
      {"torque_Nm", kOutputs + offsetof(LiveOutputs, torque_Nm)},
      {"mean_torque_Nm", kOutputs + offsetof(LiveOutputs, mean_torque_Nm)},
      {"friction_Nm", kOutputs + offsetof(LiveOutputs, friction_Nm)},
      {"starter_Nm", kOutputs + offsetof(LiveOutputs, starter_Nm)},
      {"faults", kOutputs + offsetof(LiveOutputs, faults)},
      {"flags", kOutputs + offsetof(LiveOutputs, flags)},
      {"inputs_sequence", kOutputs + offsetof(LiveOutputs, inputs_sequence)},
      {"due_ns", offsetof(crankloop_live_edge, due_ns)},
      {"wheel", offsetof(crankloop_live_edge, wheel)},
      {"level", offsetof(crankloop_live_edge, level)},
      {"torn_inputs", kOutputs + offsetof(LiveOutputs, torn_inputs)},
      {"late_ticks", kOutputs + offsetof(LiveOutputs, late_ticks)},
      {"missed_deadlines", kOutputs + offsetof(LiveOutputs, missed_deadlines)},
      {"intake_Pa", kOutputs + offsetof(LiveOutputs, intake_Pa)},
      {"trapped_air_kg", kOutputs + offsetof(LiveOutputs, trapped_air_kg)},
  };
  EXPECT_EQ(offsets_of_the_document(), offsets);
}

TEST_F(SharedBlockFile, IsTheSameMemoryOnBothSides) {
  const SharedBlock live = create_at(path());
  const SharedBlock controller = SharedBlock::open(path());
  EXPECT_EQ(controller->tick_s, kTick_s);
  EXPECT_EQ(controller->cylinders, kCylinders);

  LiveInputs in;
  in.load_ratio = 0.5;
  controller->inputs.write(in);
  std::uint32_t sequence = 0;
  ASSERT_TRUE(live->inputs.read(in = LiveInputs{}, sequence));
  EXPECT_EQ(in.load_ratio, 0.5);

  LiveOutputs out;
  out.speed_rad_s = 83;
  live->outputs.write(out);
  ASSERT_TRUE(controller->outputs.read(out = LiveOutputs{}, sequence));
  EXPECT_EQ(out.speed_rad_s, 83);
}

// ---- sections -------------------------------------------------------------------------------------------------------

TEST_F(SharedBlockFile, HasSectionsThatAReaderFindsByKind) {
  const SharedBlock live = create_at(path());
  const SharedBlock reader = SharedBlock::open(path());
  const void* map = reader.data();
  ASSERT_EQ(crankloop_live_refusal(map, reader.bytes()), nullptr);
  const crankloop_live_section names = crankloop_live_find(map, CRANKLOOP_LIVE_SIGNAL_NAMES);
  const crankloop_live_section signals = crankloop_live_find(map, CRANKLOOP_LIVE_SIGNALS);
  EXPECT_EQ(names.count, 3u);
  EXPECT_EQ(crankloop_live_index(map, names, "cam_deg"), 2u);
  EXPECT_EQ(crankloop_live_index(map, names, "cam"), 3u) << "there is none";
  const crankloop_live_section wheels = crankloop_live_find(map, CRANKLOOP_LIVE_WHEEL_NAMES);
  EXPECT_EQ(crankloop_live_index(map, wheels, "crank"), 0u);
  EXPECT_EQ(crankloop_live_index(map, wheels, std::string(47, 'w').c_str()), 1u) << "cut";
  EXPECT_EQ(crankloop_live_find(map, 99).count, 0u) << "a kind that is not there";
  EXPECT_EQ(crankloop_live_find(map, CRANKLOOP_LIVE_EDGES).count, 64u);

  LiveNumbers written{};
  written[0] = 123.5, written[1] = 7, written[2] = -0.25;
  live.signals().write(written);
  double read[3] = {};
  ASSERT_EQ(crankloop_live_numbers_read(map, signals, read), 1);
  EXPECT_EQ(std::vector<double>(read, read + 3), (std::vector<double>{123.5, 7, -0.25}));

  written[0] = 1e-5, written[1] = 1;
  reader.inputs_by_name().write(written);
  LiveNumbers taken{};
  std::uint32_t sequence = 0;
  ASSERT_TRUE(live.inputs_by_name().read(taken, sequence));
  EXPECT_EQ(sequence, 2u);
  EXPECT_EQ(taken[0], 1e-5);
  EXPECT_EQ(taken[1], 1);
  EXPECT_EQ(taken[2], 0) << "two are there";
}

TEST_F(SharedBlockFile, WithoutSectionsHasNone) {
  LiveContents bare;
  bare.tick_s = kTick_s;
  const SharedBlock live = SharedBlock::create(path(), bare);
  EXPECT_EQ(live->section_count, 0u);
  EXPECT_EQ(live.signals().count(), 0u);
  LiveNumbers numbers{};
  live.signals().write(numbers);  // does nothing
  EdgeRing ring = live.edges();
  ring.write(1, 2, 1);
  EXPECT_EQ(ring.written(), 0u);
  crankloop_live_edge_reader reader;
  EXPECT_EQ(crankloop_live_edges_begin(live.data(), &reader), 0);
}

TEST_F(SharedBlockFile, IsRefusedWhereASectionIsNotWithinIt) {
  const std::string whole = [&] {
    const SharedBlock live = create_at(path());
    return bytes_of(path());
  }();
  const auto with_word = [&](std::size_t at, std::uint32_t word) {
    std::string bytes = whole;
    bytes.replace(at, 4, std::string(reinterpret_cast<const char*>(&word), 4));
    return bytes;
  };
  const std::size_t list = 256;  // of entries kind, offset, count, entry_bytes
  for (const std::string& bytes :
       {with_word(32, 1u << 31), with_word(36, 0xFFFFFFF0u), with_word(36, 1), with_word(list + 4, 0xFFFFFFC0u),
        with_word(list + 4, 1), with_word(list + 8, 0xFFFFFFFFu), with_word(list + 12, 0xFFFFFFFFu),
        with_word(list + 5 * 16 + 8, 63), with_word(list + 5 * 16 + 8, 128), with_word(list + 5 * 16 + 12, 8),
        with_word(8, 256), whole + "x"}) {
    put(bytes);
    EXPECT_EQ(refusal_of(SharedBlock::open, path()), path() + ": is a block that is not whole");
  }
}

// ---- who gets it ----------------------------------------------------------------------------------------------------

TEST_F(SharedBlockFile, IsReadAndWrittenByNobodyElseAndRemovedAtTheEnd) {
  {
    const SharedBlock live = create_at(path());
    struct stat found {};
    ASSERT_EQ(::stat(path().c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0007u, 0u);
    const SharedBlock controller = SharedBlock::open(path());
    live->state = LiveState::running;
    EXPECT_EQ(controller->state, LiveState::running);
  }
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(SharedBlockFile, TellsAControllerThatStaysThatItEnded) {
  auto live = std::make_unique<SharedBlock>(create_at(path()));
  const SharedBlock controller = SharedBlock::open(path());
  live.reset();
  EXPECT_EQ(controller->state, LiveState::ended);
}

TEST_F(SharedBlockFile, IsRefusedAndLeftAloneWhereAnotherFileStands) {
  const std::string other_size = "[engine]\n";
  const std::string other_content(256, 'x');
  for (const std::string& text : {other_size, other_content}) {
    put(text);
    EXPECT_EQ(refusal_of(create_at, path()), path() + ": exists and is no block of crankloop live");
    EXPECT_EQ(bytes_of(path()), text);
    EXPECT_EQ(refusal_of(SharedBlock::open, path()), path() + ": is no block of crankloop live");
  }
  EXPECT_EQ(refusal_of(create_at, folder_.path()), folder_.path() + ": exists and is no block of crankloop live");
  EXPECT_EQ(refusal_of(create_at, folder_ / "none/block"),
            folder_ / "none/block: cannot be created: No such file or directory");
}

TEST_F(SharedBlockFile, IsRefusedWhereItIsOfAnotherVersion) {
  std::string bytes;
  {
    const SharedBlock live = create_at(path());
    bytes = bytes_of(path());
  }
  for (const char version : {'\2', '\3', '\5'}) {
    for (const std::size_t size : {std::size_t{256}, bytes.size()}) {  // those before 4 had 256 bytes
      std::string other = bytes.substr(0, size);
      other[4] = version;
      put(other);
      const std::string what = "a block of version " + std::to_string(version) + " of crankloop live; this one's is 4";
      EXPECT_EQ(refusal_of(create_at, path()), path() + ": exists and is " + what);
      EXPECT_EQ(refusal_of(SharedBlock::open, path()), path() + ": is " + what);
      EXPECT_STREQ(crankloop_live_refusal(other.data(), other.size()), "is a block of another version of crankloop");
      EXPECT_EQ(bytes_of(path()), other) << "left alone";
    }
  }
}

/// What the readers of version 2 and 3 looked at: 256 bytes, and the first three words.
TEST_F(SharedBlockFile, IsRefusedByTheReadersOfEarlierVersions) {
  const SharedBlock live = create_at(path());
  EXPECT_NE(bytes_of(path()).size(), 256u) << "they said: is no block of this version of crankloop";
  EXPECT_GT(at<std::uint32_t>(4), 3u) << "as did those that map 256 bytes of it";
}

TEST_F(SharedBlockFile, IsRefusedWhereAnotherProcessRunsOnIt) {
  const SharedBlock live = create_at(path());
  EXPECT_EQ(refusal_of(create_at, path()), path() + ": another process runs on this block");
  EXPECT_TRUE(std::filesystem::exists(path()));
}

TEST_F(SharedBlockFile, ReplacesWhatAKilledRunLeftBehind) {
  const ::pid_t child = ::fork();
  if (child == 0) {
    const SharedBlock live = create_at(path());
    ::_exit(0);  // as if killed: nothing is cleaned up
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(std::filesystem::exists(path()));
  const SharedBlock of_the_dead = SharedBlock::open(path());
  {
    const SharedBlock live = create_at(path());
    const SharedBlock controller = SharedBlock::open(path());
    live->state = LiveState::running;
    EXPECT_EQ(controller->state, LiveState::running);
    EXPECT_EQ(of_the_dead->state, LiveState::starting) << "a file of its own";
  }
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(SharedBlockFile, ReplacesABlockThatItsMakerDiedOver) {
  std::string whole;
  {
    const SharedBlock live = create_at(path());
    whole = bytes_of(path());
  }
  std::string without_magic = whole;  // which is written last
  without_magic.replace(0, 4, 4, '\0');
  for (const std::string& text : {std::string(), std::string(256, '\0'), without_magic, without_magic.substr(0, 16),
                                  whole.substr(0, 100), without_magic.substr(0, 12), without_magic.substr(0, 1000)}) {
    put(text);
    const SharedBlock live = create_at(path());
    EXPECT_EQ(bytes_of(path()), whole) << text.size();
  }
}

TEST_F(SharedBlockFile, IsOneOwnersWhoeverStartsAtTheSameTime) {
  constexpr int kStarters = 16;
  for (int round = 0; round < 20; ++round) {
    if (round % 2 == 0) put("");  // what a killed one left behind is in the way of all
    int go[2], said[2];
    ASSERT_EQ(::pipe(go), 0);
    ASSERT_EQ(::pipe(said), 0);
    std::vector<::pid_t> children;
    for (int i = 0; i < kStarters; ++i) {
      children.push_back(::fork());
      if (children.back() != 0) continue;
      ::close(go[1]);
      char none = 0;
      static_cast<void>(!::read(go[0], &none, 1));  // until the pipe is closed
      char answer = 'r';
      try {
        const SharedBlock live = create_at(path());
        struct stat mine {};
        answer = ::stat(path().c_str(), &mine) == 0 ? 'o' : '?';
        static_cast<void>(!::write(said[1], &answer, 1));
        ::pause();  // owns it until it is killed
      } catch (const SharedBlockError&) {
        static_cast<void>(!::write(said[1], &answer, 1));
      }
      ::_exit(0);
    }
    ::close(go[0]);
    ::close(go[1]);
    std::map<char, int> answers;
    for (int i = 0; i < kStarters; ++i) {
      char answer = 0;
      ASSERT_EQ(::read(said[0], &answer, 1), 1);
      ++answers[answer];
    }
    for (const ::pid_t child : children) {
      ::kill(child, SIGKILL);
      ::waitpid(child, nullptr, 0);
    }
    ::close(said[0]);
    ::close(said[1]);
    EXPECT_EQ(answers['o'], 1) << round;
    EXPECT_EQ(answers['r'], kStarters - 1) << round;
  }
}

TEST_F(SharedBlockFile, ThatIsTruncatedUnderItsOwnersLosesItsMagicAndNobodysLife) {
  const SharedBlock live = create_at(path());
  const SharedBlock controller = SharedBlock::open(path());
  ASSERT_EQ(::truncate(path().c_str(), 0), 0);
  controller->inputs.write(LiveInputs{});  // would be SIGBUS
  live->outputs.write(LiveOutputs{});
  EXPECT_EQ(controller->magic, 0u);
  EXPECT_EQ(live->magic, 0u);
}

TEST_F(SharedBlockFile, ThatLosesItsLastPagesIsNobodysDeathEither) {
  LiveContents large = contents();
  large.ring_edges = 4096;  // 16 pages
  const SharedBlock live = SharedBlock::create(path(), large);
  ASSERT_EQ(::truncate(path().c_str(), 4096), 0);
  EXPECT_TRUE(live.has_magic());
  EXPECT_FALSE(live.is_whole());
  EdgeRing ring = live.edges();
  for (int i = 0; i < 4096; ++i) ring.write(1, 0, 1);  // would be SIGBUS
  EXPECT_FALSE(live.has_magic()) << "it is memory of this process alone now";
}

TEST_F(SharedBlockFile, IsNotWholeOnceItIsShorterByAByteOrItsMagicIsGone) {
  for (const ::off_t size : {0, 1, 100, 200, 255, 256, 1000}) {
    const SharedBlock live = create_at(path());
    const SharedBlock controller = SharedBlock::open(path());
    EXPECT_TRUE(live.is_whole() && controller.is_whole());
    ASSERT_EQ(::truncate(path().c_str(), size), 0);
    EXPECT_FALSE(live.is_whole()) << size;
    EXPECT_FALSE(controller.is_whole()) << size;
    EXPECT_EQ(live.has_magic(), size >= 4) << size << ": its page stays, zeros in the place of what is gone";
  }
  const SharedBlock live = create_at(path());
  live->magic = 0;
  EXPECT_FALSE(live.is_whole());
}

TEST_F(SharedBlockFile, IsNotOpenedBeforeItIsReady) {
  put(std::string(256, '\0'));
  EXPECT_EQ(refusal_of(SharedBlock::open, path()), path() + ": is not ready yet");
  std::filesystem::remove(path());
  EXPECT_EQ(refusal_of(SharedBlock::open, path()), path() + ": cannot be opened: No such file or directory");
}

// ---- whose inputs count ---------------------------------------------------------------------------------------------

constexpr std::int64_t kPatience_ns = 1000;

LiveInputs with_load(double load_ratio) {
  LiveInputs in;
  in.load_ratio = load_ratio;
  in.external_torque_Nm = 40;
  in.starter = 1;
  in.cut_cylinders = 2;
  in.throttle_ratio = 0.5;
  in.fuel_kg = 1e-5;
  return in;
}

TEST(WatchedInputs, AreThoseGivenAtTheStartUntilAControllerWrites) {
  SequenceLocked<LiveInputs> area;
  area.write(with_load(0.9));  // of an earlier run
  WatchedInputs watched(area, with_load(0.1), kPatience_ns);
  EXPECT_EQ(watched.at(0).load_ratio, 0.1);
  EXPECT_EQ(watched.at(1'000'000).load_ratio, 0.1) << "nobody is there who could have fallen silent";
  EXPECT_EQ(watched.flags(), 0u);

  area.write(with_load(0.2));
  EXPECT_EQ(watched.at(1'000'001).load_ratio, 0.2);
  EXPECT_EQ(watched.flags(), kControllerSeen);
  EXPECT_EQ(watched.sequence(), 4u);
}

TEST(WatchedInputs, AreTheSafeOnesAfterTheControllerFellSilentAndItsOwnWhenItIsBack) {
  SequenceLocked<LiveInputs> area;
  WatchedInputs watched(area, {}, kPatience_ns);
  area.write(with_load(0.2));
  EXPECT_EQ(watched.at(5000).load_ratio, 0.2);
  EXPECT_EQ(watched.at(5000 + kPatience_ns).load_ratio, 0.2);

  const LiveInputs safe = watched.at(5001 + kPatience_ns);
  EXPECT_EQ(safe.load_ratio, 0);
  EXPECT_EQ(safe.external_torque_Nm, 0);
  EXPECT_EQ(safe.starter, 0u);
  EXPECT_EQ(safe.cut_cylinders, 0u);
  EXPECT_EQ(safe.throttle_ratio, 0);
  EXPECT_EQ(safe.fuel_kg, 0);
  EXPECT_EQ(watched.flags(), kControllerSeen | kControllerSilent);
  EXPECT_EQ(watched.at(5002 + kPatience_ns).load_ratio, 0);
  EXPECT_EQ(watched.silences(), 1u);

  area.write(with_load(0.3));
  EXPECT_EQ(watched.at(9000).load_ratio, 0.3);
  EXPECT_EQ(watched.flags(), kControllerSeen);
}

TEST(WatchedInputs, AreTheLastWholeOnesWhileAWriteIsUnderWayAndThenTheSafeOnes) {
  SequenceLocked<LiveInputs> area;
  WatchedInputs watched(area, {}, kPatience_ns);
  area.write(with_load(0.2));
  EXPECT_EQ(watched.at(0).load_ratio, 0.2);
  reinterpret_cast<std::atomic<std::uint32_t>&>(area) = 3;  // the controller dies here
  EXPECT_EQ(watched.at(1).load_ratio, 0.2);
  EXPECT_EQ(watched.at(2).load_ratio, 0.2);
  EXPECT_EQ(watched.torn(), 2u);
  EXPECT_EQ(watched.flags(), kControllerSeen);
  EXPECT_EQ(watched.at(1 + kPatience_ns).load_ratio, 0);
  EXPECT_EQ(watched.flags(), kControllerSeen | kControllerSilent);
}

}  // namespace
}  // namespace crankloop::port::shared_block_test

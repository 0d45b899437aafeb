// What an FMU's functions stand on, called directly: its start, its time, its faults, the memory that it writes.
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "instance.hpp"

namespace {

using crankloop::fmi::kDiscard;
using crankloop::fmi::kError;
using crankloop::fmi::kOk;
using crankloop::fmi::Message;
using crankloop::fmi::Stage;
using fmu::BoreFmu;
using fmu::BoreSupply;
using fmu::PistonsFmu;
using fmu::told;

// ---- what is set before the start -----------------------------------------------------------------------------------

TEST(StartSpeed, IsUpToTheLimitEitherWayRound) {
  BoreSupply supply;
  Message why;
  ASSERT_TRUE(supply.open(nullptr, why)) << why.text;
  const double limit_rad_s = supply.shape().speed_limit_rad_s;
  EXPECT_NEAR(limit_rad_s, 10472, 1) << "100 000 rpm";
  for (const double sign : {1.0, -1.0}) {
    BoreFmu fmu;
    fmu.set("start.speed_rad_s", sign * std::nextafter(limit_rad_s, HUGE_VAL));
    ASSERT_EQ(fmu.unit->begin_initialization(0), kOk);
    EXPECT_EQ(fmu.unit->finish_initialization(), kError);
    EXPECT_NE(told().find("start.speed_rad_s"), std::string::npos) << told();
    ASSERT_EQ(fmu.unit->instance.stage(), Stage::initializing);
    fmu.set("start.speed_rad_s", sign * limit_rad_s);
    EXPECT_EQ(fmu.unit->finish_initialization(), kOk) << told();
    fmu.run(1);
    EXPECT_NEAR(fmu.get("speed_rad_s"), sign * limit_rad_s, limit_rad_s / 10);
  }
}

/// An engine that begins otherwise than at 0.
struct BegunSupply : BoreSupply {
  void set_start_values(crankloop::Input<double, Scene>& in, double& speed_rad_s) const noexcept {
    in.load_ratio = 0.25, speed_rad_s = 50;
  }
};

TEST(StartValues, AreTheSuppliersBeforeAStartAndAfterAReset) {
  fmu::Instance<BegunSupply> fmu;
  EXPECT_EQ(fmu.get("load_ratio"), 0.25);
  EXPECT_EQ(fmu.get("start.speed_rad_s"), 50);
  fmu.set("load_ratio", 0.75);
  fmu.start();
  EXPECT_EQ(fmu.get("faults"), 0);
  EXPECT_EQ(fmu.get("fault_ticks"), 0);
  fmu.run(1);
  EXPECT_EQ(fmu.get("load_ratio"), 0.75);
  ASSERT_EQ(fmu.unit->reset(), kOk);
  EXPECT_EQ(fmu.get("load_ratio"), 0.25);
  EXPECT_EQ(fmu.get("start.speed_rad_s"), 50);
}

TEST(StartAngle, IsFromZeroToAWholeCycle) {
  for (const double deg : {-1e-9, 720.0000001, std::nan("")}) {
    BoreFmu fmu;
    fmu.set("start.crank_deg", deg);
    ASSERT_EQ(fmu.unit->begin_initialization(0), kOk);
    EXPECT_EQ(fmu.unit->finish_initialization(), kError) << deg;
    EXPECT_NE(told().find("start.crank_deg"), std::string::npos) << told();
  }
  for (const double deg : {0.0, 720.0}) {
    BoreFmu fmu;
    fmu.set("start.crank_deg", deg);
    fmu.start();
    EXPECT_EQ(fmu.get("crank_deg"), 0) << deg;
  }
}

TEST(ResetOfAnFmu, LeavesNothingOfTheRun) {
  BoreFmu used;
  BoreFmu fresh;
  used.set("engine.crank.bore_m", 0.09);
  used.set("start.crank_deg", 200);
  ASSERT_NO_FATAL_FAILURE(used.start(1));
  used.set("starter", 1);
  used.run(300);
  ASSERT_NE(used.get("torque_Nm"), 0);
  ASSERT_EQ(used.unit->reset(), kOk);
  EXPECT_EQ(used.unit->instance.stage(), Stage::instantiated);
  EXPECT_EQ(used.shown(), fresh.shown());
  EXPECT_EQ(used.saved(), fresh.saved());
}

// ---- time -----------------------------------------------------------------------------------------------------------

TEST(StepOfAnFmu, BeginsWithinHalfATickOfWhereTheLastOneEnded) {
  constexpr double kTick_s = 62.5e-6;
  for (const double off : {0.49, -0.49, 0.25, 0.0}) {
    PistonsFmu fmu;
    ASSERT_NO_FATAL_FAILURE(fmu.start());
    ASSERT_EQ(fmu.unit->step(0, 16 * kTick_s), kOk);
    EXPECT_EQ(fmu.unit->step((16 + off) * kTick_s, 16 * kTick_s), kOk) << off;
  }
  for (const double off : {0.51, -0.51, 1.0, -1.0, 2.0, -2.0, std::nan("")}) {
    PistonsFmu fmu;
    ASSERT_NO_FATAL_FAILURE(fmu.start());
    ASSERT_EQ(fmu.unit->step(0, 16 * kTick_s), kOk);
    EXPECT_EQ(fmu.unit->step((16 + off) * kTick_s, 16 * kTick_s), kError) << off;
    EXPECT_NE(told().find("where the last one ended"), std::string::npos) << told();
    EXPECT_EQ(fmu.unit->instance.time_s(), 16 * kTick_s);
  }
}

TEST(StepOfAnFmu, RunsTenMillionTicksAndNotOneMore) {
  constexpr double kTick_s = 62.5e-6;
  PistonsFmu fmu;
  ASSERT_NO_FATAL_FAILURE(fmu.start());
  EXPECT_EQ(fmu.unit->step(0, (1e7 + 1) * kTick_s), kError);
  EXPECT_NE(told().find("10000001 ticks: at most 10000000"), std::string::npos) << told();
  for (const double bad : {0.0, -kTick_s, std::nan("")}) {
    EXPECT_EQ(fmu.unit->step(0, bad), kError) << bad;
    EXPECT_NE(told().find("above 0 and finite"), std::string::npos) << told();
  }
  EXPECT_EQ(fmu.unit->instance.time_s(), 0);
  EXPECT_EQ(fmu.unit->step(0, 1e7 * kTick_s), kOk) << told();
  EXPECT_EQ(fmu.unit->instance.time_s(), 625);
}

TEST(StepOfAnFmu, TellsItsTimeAndThatItNeitherStopsNorAsks) {
  PistonsFmu fmu;
  ASSERT_NO_FATAL_FAILURE(fmu.start(3));
  bool needs_event = true, ends = true, early = true;
  double last_s = 0;
  EXPECT_EQ(fmu.unit->step(3, 1e-3, &needs_event, &ends, &early, &last_s), kOk);
  EXPECT_FALSE(needs_event || ends || early);
  EXPECT_EQ(last_s, 3.001);
  EXPECT_EQ(fmu.unit->step(7, 1e-3, &needs_event, &ends, &early, &last_s), kError);
  EXPECT_EQ(last_s, 3.001);
  EXPECT_EQ(fmu.unit->step(3.001, 1e-3, nullptr, &ends, &early, &last_s), kError);
  EXPECT_EQ(fmu.unit->step(3.001, 1e-3, &needs_event, nullptr, &early, &last_s), kError);
  EXPECT_EQ(fmu.unit->step(3.001, 1e-3, &needs_event, &ends, nullptr, &last_s), kError);
  EXPECT_EQ(fmu.unit->step(3.001, 1e-3, &needs_event, &ends, &early, nullptr), kError);
  EXPECT_EQ(fmu.unit->last_time(true, &last_s), kOk);
  EXPECT_EQ(last_s, 3.001);
  EXPECT_EQ(fmu.unit->last_time(false, &last_s), kDiscard);
  EXPECT_EQ(fmu.unit->last_time(true, nullptr), kError);
  int ended = 1;
  EXPECT_EQ(fmu.unit->never(true, &ended), kOk);
  EXPECT_EQ(ended, 0);
  EXPECT_EQ(fmu.unit->never(false, &ended), kDiscard);
}

TEST(FaultsOfAnFmu, AreThoseOfTheStepAndCountedByTick) {
  PistonsFmu fmu;
  ASSERT_NO_FATAL_FAILURE(fmu.start());
  fmu.set("speed_rad_s", std::nan(""));
  fmu.run(3);
  EXPECT_EQ(fmu.get("faults"), crankloop::kFaultSpeed);
  EXPECT_EQ(fmu.get("fault_ticks"), 3);
  fmu.set("speed_rad_s", 100);
  fmu.run(2);
  EXPECT_EQ(fmu.get("faults"), 0);
  EXPECT_EQ(fmu.get("fault_ticks"), 3);
  EXPECT_GT(fmu.get("displacement_m[1]"), 0) << "the new speed turns the crank";
}

TEST(FaultsOfAnFmu, AreToldWhereLoggingIsOnAndOnlyWhenTheyChange) {
  PistonsFmu fmu;
  ASSERT_NO_FATAL_FAILURE(fmu.start());
  const char* const faults[] = {"logFaults"};
  const char* const errors[] = {"logStatusError"};
  const char* const none[] = {"logNothing"};
  EXPECT_EQ(fmu.unit->set_logging(true, 1, none), kError);
  EXPECT_EQ(fmu.unit->set_logging(true, 1, nullptr), kError);
  EXPECT_EQ(fmu.unit->set_logging(true, 1, errors), kOk);
  fmu.set("speed_rad_s", std::nan(""));
  told().clear();
  fmu.run(1);
  EXPECT_EQ(told(), "") << "faults are not asked for";
  fmu.set("speed_rad_s", 10);
  fmu.run(1);
  EXPECT_EQ(fmu.unit->set_logging(true, 1, faults), kOk);
  fmu.set("speed_rad_s", std::nan(""));
  fmu.run(1);
  EXPECT_NE(told().find("fault bits 0x2 "), std::string::npos) << told();
  told().clear();
  fmu.run(1);
  EXPECT_EQ(told(), "") << "the same faults again";
  EXPECT_EQ(fmu.unit->set_logging(false, 0, nullptr), kOk);
  told().clear();
  fmu.run(1);
  EXPECT_EQ(told(), "");
}

// ---- memory -------------------------------------------------------------------------------------------------------

TEST(SerializedState, TakesTheRoomItSaysAndNotAByteMore) {
  PistonsFmu fmu;
  ASSERT_NO_FATAL_FAILURE(fmu.start());
  fmu.run(5);
  void* state = nullptr;
  ASSERT_EQ(fmu.unit->get_state(&state), kOk);
  std::size_t size = 0;
  ASSERT_EQ(fmu.unit->state_size(state, &size), kOk);
  std::vector<unsigned char> room(size + 8, 0xA5);
  EXPECT_EQ(fmu.unit->write_state(state, room.data(), size - 1), kError);
  EXPECT_EQ(room, std::vector<unsigned char>(size + 8, 0xA5)) << "too little room is left alone";
  EXPECT_EQ(fmu.unit->write_state(state, room.data(), 0), kError);
  EXPECT_EQ(fmu.unit->write_state(state, room.data(), size), kOk);
  EXPECT_TRUE(std::equal(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(size), fmu.saved().begin()));
  EXPECT_EQ(std::vector<unsigned char>(room.end() - 8, room.end()), std::vector<unsigned char>(8, 0xA5));
  EXPECT_EQ(fmu.unit->write_state(state, room.data(), size + 8), kOk) << "more room does no harm";
  EXPECT_EQ(std::vector<unsigned char>(room.end() - 8, room.end()), std::vector<unsigned char>(8, 0xA5));
  void* again = nullptr;
  EXPECT_EQ(fmu.unit->read_state(room.data(), size + 1, &again), kError);
  EXPECT_EQ(fmu.unit->read_state(room.data(), size - 1, &again), kError);
  EXPECT_EQ(again, nullptr);
  EXPECT_EQ(fmu.unit->write_state(nullptr, room.data(), size), kError);
  EXPECT_EQ(fmu.unit->write_state(state, nullptr, size), kError);
  EXPECT_EQ(fmu.unit->state_size(state, nullptr), kError);
  EXPECT_EQ(fmu.unit->free_state(&state), kOk);
  EXPECT_EQ(state, nullptr);
}

TEST(SerializedState, IsFilledAgainWhereTheImporterKeepsIt) {
  PistonsFmu fmu;
  ASSERT_NO_FATAL_FAILURE(fmu.start());
  void* state = nullptr;
  ASSERT_EQ(fmu.unit->get_state(&state), kOk);
  void* const first = state;
  fmu.set("speed_rad_s", 200);
  fmu.run(50);
  ASSERT_EQ(fmu.unit->get_state(&state), kOk);
  EXPECT_EQ(state, first);
  const auto later = fmu.saved();
  EXPECT_EQ(std::memcmp(state, later.data(), later.size()), 0);
  fmu.run(50);
  EXPECT_EQ(fmu.unit->set_state(state), kOk);
  EXPECT_EQ(fmu.saved(), later);
  EXPECT_EQ(fmu.unit->set_state(nullptr), kError);
  EXPECT_EQ(fmu.unit->free_state(&state), kOk);
}

/// Bytes of the heap that are in use.
std::size_t in_use() { return ::mallinfo2().uordblks; }

TEST(MemoryOfAnInstance, IsGivenBackWhenItIsFreedOrRefused) {
  using Unit = PistonsFmu::Unit;
  const auto make = [](const char* name, const char* token) {
    return Unit::create(PistonsFmu::kVersion, name, token, nullptr, fmu::logger());
  };
  const PistonsFmu kept;
  const crankloop::fmi::TokenText token(kept.unit->instance.token());
  std::string wrong = token.text;
  wrong[3] = wrong[3] == '0' ? '1' : '0';
  told() = std::string(200, ' ');  // has its memory
  const std::size_t before = in_use();
  for (int i = 0; i < 50; ++i) {
    Unit* const unit = make("an instance", token.text);
    ASSERT_NE(unit, nullptr);
    Unit::destroy(unit, PistonsFmu::kVersion);
    EXPECT_EQ(make("an instance", wrong.c_str()), nullptr);
    EXPECT_NE(told().find("token"), std::string::npos);
    EXPECT_EQ(make("an instance", nullptr), nullptr);
    EXPECT_EQ(make("", token.text), nullptr);
    EXPECT_EQ(make(nullptr, token.text), nullptr);
  }
  EXPECT_LT(in_use(), before + 10 * sizeof(Unit)) << "of 50 instances, each made and refused";
}

// The last byte of a name is the last of a page, behind which nothing may be read.
TEST(NameOfAnInstance, IsReadToItsEnd) {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  void* const pages = ::mmap(nullptr, 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(pages, MAP_FAILED);
  char* const end = static_cast<char*>(pages) + page;
  ASSERT_EQ(::mprotect(end, page, PROT_NONE), 0);
  char* const name = end - 5;
  std::memcpy(name, "edge", 5);
  const PistonsFmu kept;
  const crankloop::fmi::TokenText token(kept.unit->instance.token());
  auto* const unit =
      PistonsFmu::Unit::create(PistonsFmu::kVersion, name, token.text, nullptr, crankloop::fmi::Logger{});
  ASSERT_NE(unit, nullptr);
  EXPECT_STREQ(unit->logger.instance_name, "edge");
  EXPECT_NE(unit->logger.instance_name, name) << "a copy: the importer may free its own";
  PistonsFmu::Unit::destroy(unit, PistonsFmu::kVersion);
  ::munmap(pages, 2 * page);
}

TEST(ResourcePath, IsWrittenWithinItsRoom) {
  for (const auto& [uri, length] : {std::pair<const char*, std::size_t>{"file:///a/b", 4}, {"file:/%41%42", 3}}) {
    for (std::size_t room = 1; room < 10; ++room) {
      char path[16];
      std::memset(path, '#', sizeof path);
      const bool good = crankloop::fmi::path_of_uri(uri, path, room);
      EXPECT_EQ(good, room > length) << uri << ", " << room;
      for (std::size_t i = room; i < sizeof path; ++i) ASSERT_EQ(path[i], '#') << uri << ", " << room << ": byte " << i;
      if (good) {
        EXPECT_EQ(std::strlen(path), length);
      }
    }
  }
}

// ---- counts -------------------------------------------------------------------------------------------------------

TEST(EdgesOfAWheel, AreCountedModuloTwoToThe31) {
  crankloop::TriggerSignal<double, TriggerWheels> signal{};
  signal.edge_count = 3;
  for (std::uint32_t e = 0; e < 3; ++e) signal.edge[e] = {1e-6 * (e + 1), (e + 1) % 2};
  crankloop::fmi::WheelShown wheel;
  wheel.edges = 0x7FFF'FFFE;
  wheel.note(signal, 5);
  EXPECT_EQ(wheel.edges, 1u);
  EXPECT_EQ(wheel.edge[0].time_s, 5 + 3e-6) << "the newest first";
  EXPECT_EQ(wheel.edge[2].time_s, 5 + 1e-6);
  EXPECT_EQ(wheel.edge[0].rises, 1u);
  EXPECT_EQ(wheel.edge[1].rises, 0u);
  signal.edge_count = TriggerWheels::trigger_edges + 4;  // more than are listed
  wheel.note(signal, 6);
  EXPECT_EQ(wheel.edges, 1u + TriggerWheels::trigger_edges + 4);
  EXPECT_EQ(wheel.edge[TriggerWheels::trigger_edges].time_s, 5 + 3e-6);
}

}  // namespace

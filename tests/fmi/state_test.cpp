// Saved states of an FMU: forged with the right checksums, and refused by an instance whose tables are its own.
#include <algorithm>

#include "instance.hpp"

namespace {

using crankloop::fmi::kError;
using crankloop::fmi::kOk;
using crankloop::fmi::Stage;
using fmu::BoreFmu;
using fmu::BoreSupply;
using fmu::told;

// ---- saved states and their tables --------------------------------------------------------------------------------

/// Bytes changed on purpose, with the checksums that belong to them: the engine's, which stand before the whole's.
void seal(std::vector<unsigned char>& bytes, std::size_t engine_at) {
  const auto put = [&bytes](std::size_t at, std::uint32_t crc) {
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<unsigned char>(crc >> (8 * i));
  };
  const std::size_t end = bytes.size() - 4;
  put(end - 4, crankloop::detail::crc32_of(bytes.data() + engine_at, end - 4 - engine_at));
  put(end, crankloop::detail::crc32_of(bytes.data(), end));
}
std::size_t engine_in(const std::vector<unsigned char>& bytes) {
  const unsigned char head[] = {'C', 'L', 'S', 'T'};
  const auto at = std::search(bytes.begin(), bytes.end(), std::begin(head), std::end(head));
  EXPECT_NE(at, bytes.end());
  return static_cast<std::size_t>(at - bytes.begin());
}
void put_number(std::vector<unsigned char>& bytes, std::size_t at, double number) {
  std::memcpy(&bytes[at], &number, sizeof number);
}
// Where fields stand behind the 28 bytes of the head: kept.hpp's order.
constexpr std::size_t kStage = 28, kStart = kStage + 12, kTime = kStart + 8;

/// An engine of 90 mm that has run, and whose crank turns.
void run_narrow(BoreFmu& fmu) {
  fmu.set("engine.crank.bore_m", 0.09);
  fmu.start();
  fmu.set("starter", 1);
  fmu.run(300);
}

TEST(ForeignState, ThatIsRefusedLeavesTheInstanceItsOwnTables) {
  BoreFmu narrow;
  ASSERT_NO_FATAL_FAILURE(run_narrow(narrow));
  const auto theirs = narrow.saved();
  const std::size_t engine = engine_in(theirs);
  const auto number = [&theirs](std::size_t at, double x) {
    auto bytes = theirs;
    put_number(bytes, at, x);
    return bytes;
  };
  const std::size_t parameter = kTime + 8 + 2 * 8 + 2 * 4 + 8 * crankloop::fmi::Kept<BoreSupply>::kCount.inputs;
  double as_saved = 0;
  std::memcpy(&as_saved, &theirs[parameter], sizeof as_saved);
  ASSERT_EQ(as_saved, 0.09);

  BoreFmu hurt;
  BoreFmu sound;
  for (BoreFmu* fmu : {&hurt, &sound}) {
    ASSERT_NO_FATAL_FAILURE(fmu->start());
    fmu->set("starter", 1);
    fmu->run(200);
  }
  // Refused by its engine, whose tables were made for it; and by a bore that no tables can be made for.
  for (auto& bytes : {number(engine + 40, std::nan("")), number(engine + 40, 1e6), number(parameter, -1),
                      number(parameter, std::nan("")), number(parameter, 0.0901)}) {
    auto sealed = bytes;
    seal(sealed, engine);
    const auto before = hurt.saved();
    told().clear();
    EXPECT_EQ(hurt.restore(sealed), kError);
    EXPECT_NE(told().find("refused"), std::string::npos) << told();
    EXPECT_EQ(hurt.saved(), before);
    EXPECT_EQ(hurt.get("engine.crank.bore_m"), BoreSupply::kBore_m);
    hurt.run(40), sound.run(40);
    EXPECT_EQ(hurt.shown(), sound.shown()) << "the engine goes on by its own bore";
    EXPECT_EQ(hurt.saved(), sound.saved());
  }
  EXPECT_EQ(hurt.restore(theirs), kOk) << told();
  EXPECT_EQ(hurt.get("engine.crank.bore_m"), 0.09);
  hurt.run(40), narrow.run(40);
  EXPECT_EQ(hurt.shown(), narrow.shown());
}

TEST(ForeignState, ThatIsRefusedLeavesAnInstanceThatHasNotStartedAsItWas) {
  BoreFmu narrow;
  ASSERT_NO_FATAL_FAILURE(run_narrow(narrow));
  auto bytes = narrow.saved();
  put_number(bytes, engine_in(bytes) + 40, std::nan(""));
  seal(bytes, engine_in(bytes));
  BoreFmu fresh;
  BoreFmu untouched;
  EXPECT_EQ(fresh.restore(bytes), kError);
  EXPECT_EQ(fresh.unit->instance.stage(), Stage::instantiated);
  for (BoreFmu* fmu : {&fresh, &untouched}) {
    ASSERT_NO_FATAL_FAILURE(fmu->start());
    fmu->set("starter", 1);
    fmu->run(100);
  }
  EXPECT_EQ(fresh.saved(), untouched.saved());
}

TEST(ForeignState, OfAnInstanceThatHasNotStartedIsTakenWithoutAnEngine) {
  BoreFmu fresh;
  const auto bytes = fresh.saved();
  BoreFmu running;
  ASSERT_NO_FATAL_FAILURE(running.start());
  running.set("starter", 1);
  running.run(100);
  EXPECT_EQ(running.restore(bytes), kOk) << told();
  EXPECT_EQ(running.unit->instance.stage(), Stage::instantiated);
  EXPECT_EQ(running.shown(), fresh.shown()) << "nothing of the run is left";
  EXPECT_EQ(running.saved(), bytes);
}

TEST(ForgedFmuState, IsRefusedWhereAFieldIsWhatNoRunLeaves) {
  BoreFmu fmu;
  ASSERT_NO_FATAL_FAILURE(fmu.start(2));
  fmu.set("starter", 1);
  fmu.run(600);
  const auto good = fmu.saved();
  const std::size_t engine = engine_in(good);
  ASSERT_GT(fmu.get("trigger[1].edges"), 8);
  const auto word_with = [&good, engine](std::size_t at, std::uint32_t word) {
    auto bytes = good;
    std::memcpy(&bytes[at], &word, sizeof word);
    seal(bytes, engine);
    return bytes;
  };
  const auto number_with = [&good, engine](std::size_t at, double x) {
    auto bytes = good;
    put_number(bytes, at, x);
    seal(bytes, engine);
    return bytes;
  };
  // Places by the order that kept.hpp writes: stage, ticks, start, time, crank, speed, faults, fault ticks, inputs,
  // parameters, wheels (level, edges, eight times a time and a sense), outputs.
  using Kept = crankloop::fmi::Kept<BoreSupply>;
  const std::size_t fault_ticks = kTime + 8 + 2 * 8 + 4;
  const std::size_t wheel = fault_ticks + 4 + 8 * (Kept::kCount.inputs + 1);
  const std::size_t outputs = engine - Kept::kCount.output_bytes;
  double newest_s = 0;
  std::memcpy(&newest_s, &good[wheel + 8], sizeof newest_s);
  ASSERT_EQ(newest_s, fmu.get("trigger[1].edge_s[1]"));
  constexpr std::uint32_t kTerminated = 3;
  EXPECT_EQ(fmu.restore(good), kOk) << told();
  EXPECT_EQ(fmu.restore(word_with(kStage, kTerminated)), kOk) << told();
  EXPECT_EQ(fmu.restore(word_with(kStage, kTerminated + 1)), kError);
  EXPECT_EQ(fmu.restore(word_with(fault_ticks, 0x7FFF'FFFF)), kOk) << told();
  EXPECT_EQ(fmu.restore(word_with(fault_ticks, 0x8000'0000)), kError);
  EXPECT_EQ(fmu.restore(word_with(wheel, 2)), kError) << "a level";
  EXPECT_EQ(fmu.restore(word_with(wheel + 4, 0x7FFF'FFFF)), kOk) << told();
  EXPECT_EQ(fmu.restore(word_with(wheel + 4, 0x8000'0000)), kError) << "a count of edges";
  EXPECT_EQ(fmu.restore(word_with(wheel + 8 + 7 * 12 + 8, 2)), kError) << "the sense of the oldest edge";
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (const std::size_t at : {kStart, kTime, wheel + 8, wheel + 8 + 7 * 12, outputs + 8, outputs + 16}) {
      EXPECT_EQ(fmu.restore(number_with(at, bad)), kError) << at << ", " << bad;
      EXPECT_NE(told().find("damaged"), std::string::npos) << told();
    }
  }
  const double most = std::numeric_limits<double>::max();
  EXPECT_EQ(fmu.restore(number_with(wheel + 8, -most)), kOk) << told();
  EXPECT_EQ(fmu.get("trigger[1].edge_s[1]"), -most);
}

}  // namespace

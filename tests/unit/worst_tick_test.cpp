// worst_tick on small listings whose longest path is counted by hand, and on those that it must refuse.
#include "worst_tick/longest_path.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace worst_tick::worst_tick_test {
namespace {

/// Lines of the one source file that the listings stem from.
class Lines : public Sources {
 public:
  explicit Lines(std::vector<std::string> lines) : lines_{std::move(lines)} {}
  std::string line(const Place& place) override {
    const auto index = static_cast<std::size_t>(place.line);
    return index >= 1 && index <= lines_.size() ? lines_[index - 1] : "";
  }

 private:
  std::vector<std::string> lines_;
};

/// The bound of the function at `root`. `places` says "ADDRESS LINE" of those instructions whose line matters.
std::int64_t bound(const std::string& listing, const std::string& places, const std::string& bounds,
                   const Numbers& limits = {}, const Costs& costs = InstructionCosts()) {
  std::istringstream code(listing), bounds_file(bounds), place_list(places);
  std::ostringstream addr2line;
  for (std::string address, line; place_list >> address >> line;)
    addr2line << "0x000000" << address << "\n/home/anna/src/engine.hpp:" << line << "\n";
  std::istringstream answered(addr2line.str());
  Program program = read_listing(code);
  read_places(answered, program);
  Lines sources({"for (int i = 0; i < cylinders; ++i) {", "  if (far(i)) locate(i);", "}",
                 "for (int i = 0; i < cylinders; ++i) once(i);", "while (true)"});
  const Bounds all(bounds_file, limits, sources);
  return LongestPath(program, all, costs, 0x10).bound();
}

std::string refusal(const std::string& listing, const std::string& places = "", const std::string& bounds = "") {
  try {
    return "no refusal, but " + std::to_string(bound(listing, places, bounds));
  } catch (const Refusal& refusal) {
    return refusal.what();
  }
}

TEST(WorstTick, TakesTheLongerBranchAndWhatItCalls) {
  const std::string listing =
      "00000010 <step>:\n"
      "      10:\tpush\t{r4, lr}\n"
      "      12:\tcmp\tr0, #0\n"
      "      14:\tbeq.n\t1c <step+0xc>\n"
      "      16:\tmovs\tr0, #1\n"
      "      18:\tadds\tr0, #2\n"
      "      1a:\tpop\t{r4, pc}\n"
      "      1c:\tbl\t30 <callee>\n"
      "      20:\tpop\t{r4, pc}\n"
      "\n"
      "00000030 <callee>:\n"
      "      30:\tit\teq\n"
      "      32:\tbxeq\tlr\n"
      "      34:\tvadd.f32\ts0, s0, s1\n"
      "      38:\tbx\tlr\n"
      "      3c:\t.word\t0x3f800000\n";
  // push cmp beq, bl, the callee's four, pop; the other branch has 6.
  EXPECT_EQ(bound(listing, "", ""), 3 + 1 + 4 + 1);
}

/// A loop with its test at the bottom: before it 1, the body 2 and the test 2; a detour of 3 in its body.
const char* const kLoop =
    "00000010 <step>:\n"
    "      10:\tmovs\tr3, #0\n"
    "      12:\tcmp\tr1, r3\n"
    "      14:\tbne.n\t20 <step+0x10>\n"
    "      16:\tadds\tr3, #1\n"
    "      18:\tcmp\tr3, r0\n"
    "      1a:\tbcc.n\t12 <step+0x2>\n"
    "      1c:\tbx\tlr\n"
    "      20:\tvdiv.f32\ts0, s1, s2\n"
    "      24:\tadds\tr1, #1\n"
    "      26:\tb.n\t16 <step+0x6>\n";

TEST(WorstTick, RunsALoopAsOftenAsItsBoundSays) {
  const std::string bounds = "loop | engine.hpp | i < cylinders; ++i) { | cylinders | as the engine has\n";
  // Before 1, four times the body with its detour (2 + 3 + 3), the end 1.
  EXPECT_EQ(bound(kLoop, "1a 1", bounds, {{"cylinders", 4}}), 1 + 4 * 8 + 1);
  EXPECT_EQ(bound(kLoop, "1a 1", bounds, {{"cylinders", 1}}), 1 + 8 + 1);
}

TEST(WorstTick, SpendsABudgetOnce) {
  const std::string bounds =
      "loop | engine.hpp | i < cylinders; ++i) { | 10 | .\n"
      "code | engine.hpp | locate(i) | vdiv.f32 spends place | .\n"
      "budget | place | places | .\n";
  // Ten rounds of 5, three of which take the detour; any more detours than rounds are worth nothing.
  EXPECT_EQ(bound(kLoop, "1a 1 20 2", bounds, {{"places", 3}}), 1 + 10 * 5 + 3 * 3 + 1);
  EXPECT_EQ(bound(kLoop, "1a 1 20 2", bounds, {{"places", 0}}), 1 + 10 * 5 + 1);
  EXPECT_EQ(bound(kLoop, "1a 1 20 2", bounds, {{"places", 99}}), 1 + 10 * 8 + 1);
}

TEST(WorstTick, SpendsABudgetBySharesOfTwoPaths) {
  // A loop that begins anew only by spending: 6 in all over any number of entries.
  const std::string bounds =
      "loop | engine.hpp | i < cylinders; ++i) { | 7 spends round | .\n"
      "budget | round | 6 | .\n";
  EXPECT_EQ(bound(kLoop, "1a 1", bounds), 1 + 7 * 8 + 1);
}

TEST(WorstTick, SpendsOnTheFirstRoundTooWhereTheBoundSaysEach) {
  const std::string bounds =
      "loop | engine.hpp | i < cylinders; ++i) { | 7 each spends round | .\n"
      "budget | round | 6 | .\n";
  EXPECT_EQ(bound(kLoop, "1a 1", bounds), 1 + 6 * 8 + 1);
  EXPECT_EQ(refusal(kLoop, "1a 1", "loop | engine.hpp | i < cylinders | 7 each | .\n"), "a bound says '7 each'");
}

TEST(WorstTick, KnowsWhatWasInlinedByTheCallsAroundIt) {
  const std::string bounds =
      "loop | engine.hpp | i < cylinders; ++i) { | 10 | .\n"
      "code | engine.hpp | locate(i) | vdiv spends place | .\n"
      "budget | place | 3 | .\n";
  // Line 5 called from line 2, and from line 4.
  EXPECT_EQ(bound(kLoop, "1a 1 20 5 20 2", bounds), 1 + 10 * 5 + 3 * 3 + 1);
  EXPECT_EQ(bound(kLoop, "1a 1 20 5 20 4", bounds), 1 + 10 * 8 + 1);
}

TEST(WorstTick, TellsWhichCallOfALineSpends) {
  const std::string listing =
      "00000010 <step>:\n"
      "      10:\tbl\t30 <far>\n"
      "      14:\tcbz\tr0, 1a <step+0xa>\n"
      "      16:\tbl\t40 <locate>\n"
      "      1a:\tbl\t40 <locate>\n"
      "      1e:\tpop\t{r4, pc}\n"
      "00000030 <far>:\n"
      "      30:\tbx\tlr\n"
      "00000040 <locate>:\n"
      "      40:\tnop\n"
      "      42:\tbx\tlr\n";
  const std::string budget = "budget | place | 1 | .\n";
  const std::string places = "10 2 16 2 1a 4";
  EXPECT_EQ(bound(listing, places, "code | engine.hpp | locate(i) | bl locate spends place | .\n" + budget),
            2 + 1 + 3 + 3 + 1);
  EXPECT_EQ(bound(listing, places, "code | engine.hpp | locate(i) | bl spends place | .\n" + budget), 2 + 1 + 3 + 1)
      << "both calls of line 2 spend";
}

TEST(WorstTick, RefusesAStoreOrCallBesideTheOneThatSpends) {
  // Arguments of a call on the line that pays: counted as payments, they would be for work that nobody does.
  const std::string listing =
      "00000010 <step>:\n"
      "      10:\tstr\tr0, [r3, #0]\n"
      "      12:\tstr\tr1, [sp, #4]\n"
      "      14:\tbl\t30 <locate>\n"
      "      18:\tbl\t30 <locate>\n"
      "      1c:\tpop\t{r4, pc}\n"
      "00000030 <locate>:\n"
      "      30:\tbx\tlr\n";
  const std::string budget = "budget | place | 1 | .\n";
  EXPECT_EQ(refusal(listing, "10 2 12 2", "code | engine.hpp | locate(i) | str spends place | .\n" + budget),
            "12: a second str that spends place");
  EXPECT_EQ(refusal(listing, "14 2 18 2", "code | engine.hpp | locate(i) | bl spends place | .\n" + budget),
            "18: a second bl that spends place");
  EXPECT_EQ(bound(listing, "10 2 12 4", "code | engine.hpp | locate(i) | str spends place | .\n" + budget), 7);
}

TEST(WorstTick, CountsABodyBelowItsTestOncePerRepeat) {
  const std::string listing =
      "00000010 <step>:\n"
      "      10:\tmovs\tr3, #0\n"
      "      12:\tcmp\tr3, r0\n"
      "      14:\tbcs.n\t1a <step+0xa>\n"
      "      16:\tadds\tr3, #1\n"
      "      18:\tb.n\t12 <step+0x2>\n"
      "      1a:\tbx\tlr\n";
  // Before 1, four times test and body (4), the last test 2, the end 1.
  EXPECT_EQ(bound(listing, "14 1", "loop | engine.hpp | i < cylinders; ++i) { | 4 | .\n"), 1 + 4 * 4 + 2 + 1);
}

TEST(WorstTick, TakesALoopWithoutRoundsForOneThatIsNotEntered) {
  const std::string listing =
      "00000010 <step>:\n"
      "      10:\tcbz\tr0, 1c <step+0xc>\n"
      "      12:\tadds\tr3, #1\n"
      "      14:\tadds\tr3, #1\n"
      "      16:\tcmp\tr3, r0\n"
      "      18:\tbcc.n\t12 <step+0x2>\n"
      "      1a:\tnop\n"
      "      1c:\tbx\tlr\n";
  EXPECT_EQ(bound(listing, "18 1", "loop | engine.hpp | i < cylinders; ++i) { | 0 | .\n"), 2);
}

TEST(WorstTick, DoesNotTakeAnInnerLoopsTestForTheOuters) {
  const std::string listing =
      "00000010 <step>:\n"
      "      10:\tmovs\tr3, #0\n"
      "      12:\tcbz\tr2, 20 <step+0x10>\n"
      "      14:\tadds\tr3, #1\n"
      "      16:\tcmp\tr3, r0\n"
      "      18:\tbcc.n\t14 <step+0x4>\n"
      "      1a:\tb.n\t12 <step+0x2>\n"
      "      20:\tbx\tlr\n";
  const std::string inner = "loop | engine.hpp | once(i) | 3 | .\n";
  EXPECT_EQ(refusal(listing, "12 4 18 4", inner), "step, loop at 12: no test of a source loop of its own leaves it");
  // The outer's own: twice 1 + 3 * 3 + 1, then its test once more.
  EXPECT_EQ(bound(listing, "12 1 18 4", inner + "loop | engine.hpp | ++i) { | 2 | .\n"), 1 + 2 * 11 + 1 + 1);
}

TEST(WorstTick, RefusesWhatItCannotBound) {
  EXPECT_EQ(refusal(kLoop, "1a 1"),
            "/home/anna/src/engine.hpp:1: a loop without a bound: for (int i = 0; i < cylinders; ++i) {");
  EXPECT_EQ(refusal(kLoop, "1a 2"), "step, loop at 12: no test of a source loop of its own leaves it");
  EXPECT_EQ(refusal(kLoop, "1a 1", "loop | engine.hpp | i < cylinders | 4 spends place | .\n"), "no budget of place");
  EXPECT_EQ(refusal(kLoop, "1a 1", "loop | engine.hpp | i < cylinders | few | .\n"),
            "a bound says 'few', which the image does not tell");
  EXPECT_EQ(refusal(kLoop, "1a 1", "loop | engine.hpp | i < cylinders | 4 | .\nloop | engine.hpp | ++i | 5 | .\n"),
            "/home/anna/src/engine.hpp:1: two bounds speak of this loop");
}

TEST(WorstTick, RefusesWhatLeadsAnywhere) {
  const auto with = [](const std::string& instruction) {
    return refusal("00000010 <step>:\n      10:\t" + instruction + "\n      14:\tbx\tlr\n");
  };
  EXPECT_EQ(with("blx\tr3"), "10: not known where it leads: blx r3");
  EXPECT_EQ(with("bx\tr3"), "10: not known where it leads: bx r3");
  EXPECT_EQ(with("tbb\t[pc, r0]"), "10: not known where it leads: tbb [pc, r0]");
  EXPECT_EQ(with("ldr.w\tpc, [r3, r2, lsl #2]"),
            "10: a jump to an address that was computed: ldr pc, [r3, r2, lsl #2]");
  EXPECT_EQ(with("mov\tpc, r3"), "10: a jump to an address that was computed: mov pc, r3");
  EXPECT_EQ(with("svc\t0"), "10: not known where it leads: svc 0");
  EXPECT_EQ(with("bl\t80 <gone>"), "a call of 80, where no function begins");
  EXPECT_EQ(with("bl\t10 <step>"), "recursion: step");
  EXPECT_EQ(with("bics\tr0, r1"), "no refusal, but 2");
}

TEST(WorstTick, CopiesWhatALoopWithTwoWaysInRunsBeforeItsHeader) {
  const std::string listing =
      "00000010 <step>:\n"
      "      10:\tcbz\tr0, 16 <step+0x6>\n"
      "      12:\tadds\tr1, #1\n"
      "      14:\tcbz\tr1, 1c <step+0xc>\n"
      "      16:\tadds\tr2, #1\n"
      "      18:\tcmp\tr2, r3\n"
      "      1a:\tbcc.n\t12 <step+0x2>\n"
      "      1c:\tbx\tlr\n";
  // The way to a copy of 12 and 14, then the loop from its header at 16. That has the test: four times round, and out
  // at 14 in the fifth.
  EXPECT_EQ(bound(listing, "1a 1", "loop | engine.hpp | i < cylinders; ++i) { | 4 | .\n"), 1 + 2 + 4 * 5 + 5 + 1);
}

TEST(WorstTick, TakesTheBlockWhereTheWaysInMeetForTheHeader) {
  // Ways in at 14, 18 and 1a, which meet at 1a: the first round begins in a copy of what is before that.
  const std::string listing =
      "00000010 <step>:\n"
      "      10:\tcbz\tr0, 18 <step+0x8>\n"
      "      12:\tcbz\tr1, 1a <step+0xa>\n"
      "      14:\tadds\tr1, #1\n"
      "      16:\tcbz\tr1, 1a <step+0xa>\n"
      "      18:\tadds\tr2, #1\n"
      "      1a:\tadds\tr2, #1\n"
      "      1c:\tcbz\tr4, 20 <step+0x10>\n"
      "      1e:\tadds\tr2, #1\n"
      "      20:\tcmp\tr2, r3\n"
      "      22:\tbcc.n\t14 <step+0x4>\n"
      "      24:\tbx\tlr\n";
  // Before it 5, the 5 from the header to the test four times, the 3 back to the header three times, and out.
  EXPECT_EQ(bound(listing, "22 1", "loop | engine.hpp | i < cylinders; ++i) { | 4 | .\n"), 5 + 4 * 5 + 3 * 3 + 1);
}

TEST(WorstTick, RefusesToRunIntoData) {
  EXPECT_EQ(refusal("00000010 <step>:\n      10:\tadds\tr1, #1\n      12:\t.word\t0x3f800000\n      18:\tbx\tlr\n"),
            "step, 10: runs into what is not an instruction");
  EXPECT_EQ(refusal("00000010 <step>:\n      10:\tadds\tr1, #1\n"), "step, 10: runs into what is not an instruction");
  // Not if there is another way: what leads into data is undefined, and the compiler left it out.
  EXPECT_EQ(refusal("00000010 <step>:\n      10:\tadds\tr1, #1\n      12:\tbeq.n\t18 <step+0x8>\n      "
                    "14:\t.word\t0x3f800000\n      18:\tbx\tlr\n"),
            "no refusal, but 3");
}

// ---- cycles of a Cortex-M4
// -------------------------------------------------------------------------------------------

/// Cycles of a step that is these instructions and a return, which takes 1 + 3.
std::int64_t cycles(const std::vector<std::string>& instructions, std::int64_t wait_states = 0,
                    std::uint32_t size = 4) {
  std::ostringstream listing;
  listing << "00000010 <step>:\n" << std::hex;
  std::uint32_t address = 0x10;
  for (const std::string& instruction : instructions) {
    listing << "      " << address << ":\t" << instruction << "\n";
    address += size;
  }
  listing << "      " << address << ":\tbx\tlr\n      " << address + 2 << ":\tnop\n";
  return bound(listing.str(), "", "", {}, CortexM4Costs(wait_states)) - (wait_states == 0 ? 4 : 0);
}

struct Cycles {
  const char* instruction;
  std::int64_t cycles;
};

TEST(CortexM4Cycles, AreTheManuals) {
  const Cycles table[] = {{"adds\tr0, r1", 1},
                          {"addeq\tr0, r1, r2", 1},
                          {"lslscs\tr0, r1", 1},
                          {"mul.w\tr0, r1, r2", 1},
                          {"umull\tr0, r1, r2, r3", 1},
                          {"mla\tr0, r1, r2, r3", 2},
                          {"mls\tr0, r1, r2, r3", 2},
                          {"udiv\tr0, r1, r2", 12},
                          {"sdiv\tr0, r1, r2", 12},
                          {"itte\teq", 1},
                          {"ldr.w\tr0, [r1, #4]", 2},
                          {"ldrb.w\tr0, [r1, r2]", 2},
                          {"str\tr0, [r1, #0]", 2},
                          {"ldrd\tr0, r1, [r2, #8]", 3},
                          {"strd\tr0, r1, [r2, #8]", 3},
                          {"ldmia.w\tr0, {r1, r2, sl}", 4},
                          {"stmdb\tsp!, {r4, r5, r6, fp, lr}", 6},
                          {"push\t{r4, lr}", 3},
                          {"pop\t{r4, r5, r6}", 4},
                          {"vadd.f32\ts0, s1, s2", 1},
                          {"vmulgt.f32\ts0, s1, s2", 1},
                          {"vcvt.f32.s32\ts0, s1", 1},
                          {"vmla.f32\ts0, s1, s2", 3},
                          {"vfma.f32\ts0, s1, s2", 3},
                          {"vnmls.f32\ts0, s1, s2", 3},
                          {"vdiv.f32\ts0, s1, s2", 14},
                          {"vsqrt.f32\ts0, s1", 14},
                          {"vldr\ts0, [r1, #4]", 2},
                          {"vldr\td0, [r1, #4]", 3},
                          {"vstr\ts0, [r1, #4]", 2},
                          {"vldmia\tr1!, {s4-s7}", 5},
                          {"vldmia\tr1!, {s4}", 2},
                          {"vpush\t{d8-d15}", 17},
                          {"vpop\t{d8-d9}", 5},
                          {"vmov.f32\ts0, #112", 1},
                          {"vmov.f32\ts0, s1", 1},
                          {"vmov\tr0, s1", 2},
                          {"vmov\ts1, sl", 2},
                          {"vmov\tr0, r1, d4", 2},
                          {"vmrs\tAPSR_nzcv, fpscr", 1}};
  for (const Cycles& row : table) EXPECT_EQ(cycles({row.instruction}), row.cycles) << row.instruction;
}

TEST(CortexM4Cycles, AreOneMoreWhereTheNextInstructionUsesAFloatingPointResult) {
  EXPECT_EQ(cycles({"vmul.f32\ts0, s1, s2", "vadd.f32\ts3, s0, s4"}), 1 + 1 + 1);
  EXPECT_EQ(cycles({"vmul.f32\ts0, s1, s2", "vadd.f32\ts3, s10, s4"}), 1 + 1);
  EXPECT_EQ(cycles({"vmul.f32\ts0, s1, s2", "movs\tr0, #0", "vadd.f32\ts3, s0, s4"}), 1 + 1 + 1);
  EXPECT_EQ(cycles({"vdiv.f32\ts9, s1, s2", "vstr\ts9, [r0]"}), 14 + 1 + 2);
  EXPECT_EQ(cycles({"vadd.f32\ts9, s1, s2", "vstmia\tr0!, {s8-s11}"}), 1 + 1 + 5);
  EXPECT_EQ(cycles({"vadd.f32\ts9, s1, s2", "vmov\tr0, r1, d4"}), 1 + 1 + 2);
  EXPECT_EQ(cycles({"vadd.f32\ts0, s1, s2", "it\tgt", "vmovgt.f32\ts3, s4"}), 1 + 1 + 1 + 1) << "IT may be folded";
  EXPECT_EQ(cycles({"vcmpe.f32\ts0, s1", "vmrs\tAPSR_nzcv, fpscr"}), 1 + 1 + 1);
  EXPECT_EQ(cycles({"vldr\ts0, [r0]", "vadd.f32\ts3, s0, s4"}), 2 + 1) << "a load is no arithmetic";
}

TEST(CortexM4Cycles, AreThreeMoreWhereABranchIsTaken) {
  const std::string listing =
      "00000010 <step>:\n"
      "      10:\tpush\t{r4, lr}\n"
      "      12:\tcbz\tr0, 18 <step+0x8>\n"
      "      14:\tadds\tr0, #1\n"
      "      16:\tadds\tr0, #1\n"
      "      18:\tbl\t30 <callee>\n"
      "      1c:\tpop\t{r4, pc}\n"
      "00000030 <callee>:\n"
      "      30:\tb.n\t34 <callee+0x4>\n"
      "      32:\tnop\n"
      "      34:\tbx\tlr\n";
  // push 3, cbz taken 1 + 3 (not taken with two additions 3), bl 1 + 3, b 1 + 3, bx 1 + 3, pop of two 3 + 3.
  EXPECT_EQ(bound(listing, "", "", {}, CortexM4Costs(0)), 3 + 4 + 4 + 4 + 4 + 6);
}

TEST(CortexM4Cycles, OfALoopCountItsBackEdgesAsTaken) {
  const std::string bounds = "loop | engine.hpp | i < cylinders; ++i) { | 4 | .\n";
  // The detour: 14 and one more of the division before what may use it, the additions, two branches taken; the last
  // test is not.
  EXPECT_EQ(bound(kLoop, "1a 1", bounds, {}, CortexM4Costs(0)), 1 + 4 * (1 + 4 + 14 + 1 + 4 + 2 + 1) + 3 * 3 + 4);
}

TEST(CortexM4Cycles, AtWaitStatesCountFetchesAndLoadsFromFlash) {
  const std::int64_t bx = 4 + 5 * (1 + 2);  // in a word of its own; the fetch under way, that of where it arrives
  EXPECT_EQ(cycles({}, 5), bx);
  EXPECT_EQ(cycles({"add.w\tr0, r1, r2"}, 5), 1 + 5 + bx);
  EXPECT_EQ(cycles({"adds\tr0, r1", "adds\tr0, r1"}, 5, 2), 1 + 5 + 1 + bx) << "two in a word";
  EXPECT_EQ(cycles({"ldr.w\tr0, [r1, #4]"}, 5), 2 + 5 + 5 + bx);
  EXPECT_EQ(cycles({"vldmia\tr1!, {s4-s7}"}, 5), 5 + 5 + 4 * 5 + bx);
  EXPECT_EQ(cycles({"ldr.w\tr0, [pc, #4]"}, 5), 2 + 5 + 5 + bx);
  EXPECT_EQ(cycles({"ldr.w\tr0, [sp, #4]"}, 5), 2 + 5 + bx) << "the stack is RAM";
  EXPECT_EQ(cycles({"ldmia.w\tsp!, {r4, r5}"}, 5), 3 + 5 + bx);
  EXPECT_EQ(cycles({"str.w\tr0, [r1, #4]"}, 5), 2 + 5 + bx) << "so is what is written";
}

TEST(CortexM4Cycles, OfAnInstructionThatTheManualDoesNotListAreRefused) {
  const auto refused = [](const std::string& instruction) {
    try {
      return std::to_string(cycles({instruction}));
    } catch (const Refusal& refusal) {
      return std::string(refusal.what());
    }
  };
  EXPECT_EQ(refused("vrintz.f32\ts0, s1"), "10: no cycles are known of vrintz.f32 s0, s1");
  EXPECT_EQ(refused("addxx\tr0, r1"), "10: no cycles are known of addxx r0, r1");
  EXPECT_EQ(refused("push\t{r4-r7}"), "10: a list that is not read: push {r4-r7}");
}

TEST(CortexM4Cycles, OfAFunctionWithoutBoundsAreThoseOfItsDearestInstruction) {
  const std::string listing =
      "00000010 <step>:\n"
      "      10:\tb.n\t20 <memset>\n"
      "      12:\tnop\n"
      "00000020 <memset>:\n"
      "      20:\tstrd\tr1, r1, [r0]\n"
      "      24:\tbne.n\t20 <memset>\n"
      "      26:\tbx\tlr\n"
      "      28:\tnop\n";
  EXPECT_EQ(bound(listing, "", "call | memset | 10 | .\n", {}, CortexM4Costs(0)), 4 + 10 * 4);
  EXPECT_EQ(bound(listing, "", "call | memset | 10 | .\n"), 1 + 10);
}

}  // namespace
}  // namespace worst_tick::worst_tick_test

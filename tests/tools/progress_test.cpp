// How far a long command is, where nobody looks at a terminal: a line now and then in the log.
#include "crankloop/command_line/progress.hpp"

#include <gtest/gtest.h>

#include <string>

namespace crankloop::program::progress_test {
namespace {

std::string told_in_four_steps(std::int64_t log_period_ns) {
  testing::internal::CaptureStderr();  // a file
  {
    Progress progress("stressing", 4, log_period_ns);
    for (int i = 0; i < 4; ++i) progress.long_step();
  }
  return testing::internal::GetCapturedStderr();
}

TEST(ProgressInALog, IsALineWithoutControlCodesEachTimeThatThePeriodHasPassed) {
  EXPECT_EQ(told_in_four_steps(0), "stressing: 25 %\nstressing: 50 %\nstressing: 75 %\nstressing: 100 %\n");
}

TEST(ProgressInALog, IsNothingOfAShortCommand) {
  EXPECT_EQ(told_in_four_steps(Progress::kLogPeriod_ns), "");
  EXPECT_EQ(Progress::kLogPeriod_ns, 10'000'000'000);
}

}  // namespace
}  // namespace crankloop::program::progress_test

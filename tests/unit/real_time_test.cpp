// The histogram of port/linux against sorting, the periodic loop against the clock, and what is asked of the operating
// system.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <thread>
#include <vector>

#include "port/linux/latency.hpp"
#include "port/linux/periodic.hpp"
#include "port/linux/real_time.hpp"
#include "port/linux/stop_signal.hpp"
#include "port/linux/stopwatch.hpp"
#include "support/random.hpp"

namespace crankloop::port::real_time_test {
namespace {

// ---- the histogram --------------------------------------------------------------------------------------------------

TEST(Latency, NothingCountedIsZeroEverywhere) {
  const LatencyHistogram empty;
  EXPECT_EQ(empty.count(), 0u);
  EXPECT_EQ(empty.quantile_ns(5000), 0);
  EXPECT_EQ(empty.quantile_ns(10000), 0);
  EXPECT_EQ(empty.longest_ns(), 0);
  EXPECT_EQ(empty.mean_ns(), 0);
}

TEST(Latency, BucketsFollowEachOtherWithoutGapAndAreAtMostA64thWide) {
  const LatencyHistogram histogram;
  std::int64_t next_ns = 0;
  for (std::size_t i = 0; i < LatencyHistogram::kBuckets; ++i) {
    const LatencyHistogram::Bucket bucket = histogram.bucket(i);
    ASSERT_EQ(bucket.first_ns, next_ns) << "bucket " << i;
    ASSERT_GE(bucket.last_ns, bucket.first_ns) << "bucket " << i;
    ASSERT_LE((bucket.last_ns - bucket.first_ns) * 64, bucket.first_ns) << "bucket " << i;
    next_ns = bucket.last_ns + 1;
  }
  EXPECT_EQ(next_ns, std::int64_t{1} << 40);
}

TEST(Latency, BothEndsOfEveryBucketAreCountedInIt) {
  LatencyHistogram histogram;
  for (std::size_t i = 0; i < LatencyHistogram::kBuckets; ++i) {
    const LatencyHistogram::Bucket bucket = histogram.bucket(i);
    histogram.add(bucket.first_ns);
    histogram.add(bucket.last_ns);
    ASSERT_EQ(histogram.bucket(i).count, 2u) << "bucket " << i;
  }
}

TEST(Latency, TimesBeyondEitherEndAreCountedAtThatEnd) {
  LatencyHistogram histogram;
  histogram.add(-5);
  histogram.add(std::int64_t{1} << 50);
  EXPECT_EQ(histogram.count(), 2u);
  EXPECT_EQ(histogram.bucket(0).count, 1u);
  EXPECT_EQ(histogram.bucket(LatencyHistogram::kBuckets - 1).count, 1u);
  EXPECT_EQ(histogram.longest_ns(), std::int64_t{1} << 50);
}

TEST(Latency, QuantilesAreThoseOfTheSortedTimesAndAtMostA64thMore) {
  constexpr std::uint32_t kParts[] = {1, 100, 5000, 9000, 9900, 9990, 9999, 10000};
  support::Random random;
  for (int draw = 0; draw < 200; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    LatencyHistogram histogram;
    std::vector<std::int64_t> times_ns(static_cast<std::size_t>(random.whole(1, 3000)));
    double sum_ns = 0;
    for (std::int64_t& time_ns : times_ns) {
      time_ns = static_cast<std::int64_t>(std::exp(random.between(0, 25)));  // 1 ns to 72 s
      sum_ns += static_cast<double>(time_ns);
      histogram.add(time_ns);
    }
    std::sort(times_ns.begin(), times_ns.end());
    for (const std::uint32_t parts : kParts) {
      // The first of the sorted times that has at least this part of them up to it.
      std::size_t place = 0;
      while ((place + 1) * 10000 < times_ns.size() * parts) ++place;
      const std::int64_t exact_ns = times_ns[place];
      const std::int64_t told_ns = histogram.quantile_ns(parts);
      EXPECT_GE(told_ns, exact_ns) << parts;
      EXPECT_LE((told_ns - exact_ns) * 64, exact_ns) << parts;
    }
    EXPECT_EQ(histogram.longest_ns(), times_ns.back());
    EXPECT_EQ(histogram.quantile_ns(10000), times_ns.back());
    EXPECT_NEAR(histogram.mean_ns(), sum_ns / static_cast<double>(times_ns.size()), 1e-9 * sum_ns);
  }
}

// ---- the loop -------------------------------------------------------------------------------------------------------

constexpr std::int64_t kPeriod_ns = 1'000'000;

void spin_until(std::int64_t time_ns) {
  while (now_ns() < time_ns) {
  }
}

TEST(Periodic, EveryTickIsDueAPeriodAfterTheOneBeforeAndNeverBeginsEarly) {
  const std::int64_t start_ns = now_ns();
  Periodic periodic(kPeriod_ns);
  for (int tick = 0; tick < 50; ++tick) {
    const std::int64_t due_before_ns = periodic.due_ns();
    const std::int64_t behind_ns = periodic.begin();
    EXPECT_EQ(periodic.due_ns() - due_before_ns, kPeriod_ns);
    EXPECT_GE(behind_ns, 0);
    EXPECT_EQ(periodic.begun_ns() - periodic.due_ns(), behind_ns);
    EXPECT_GE(now_ns(), periodic.due_ns());
    EXPECT_GE(periodic.done(), 0);
  }
  EXPECT_EQ(periodic.tally().ticks, 50u);
  EXPECT_GE(now_ns() - start_ns, 50 * kPeriod_ns);
}

TEST(Periodic, ATickThatTakesTooLongIsMissedAndTheNextOnesCatchUpWithoutLoss) {
  Periodic periodic(kPeriod_ns);
  periodic.begin();
  const std::int64_t first_due_ns = periodic.due_ns();
  spin_until(first_due_ns + 7 * kPeriod_ns / 2);  // through the times of the next three ticks
  EXPECT_GE(periodic.done(), 0);
  for (int tick = 1; tick <= 3; ++tick) {
    const std::int64_t behind_ns = periodic.begin();
    EXPECT_EQ(periodic.due_ns(), first_due_ns + tick * kPeriod_ns);
    EXPECT_GE(behind_ns, (7 - 2 * tick) * kPeriod_ns / 2);
    periodic.done();
  }
  // The long one, and the two that began 2.5 and 1.5 periods after their time. A busy machine may add to them.
  EXPECT_EQ(periodic.tally().ticks, 4u);
  EXPECT_GE(periodic.tally().missed, 3u);
  EXPECT_GE(periodic.tally().late, 2u);
  EXPECT_GE(periodic.tally().longest_backlog_ns, 5 * kPeriod_ns / 2);
}

// ---- what is asked of Linux -----------------------------------------------------------------------------------------

TEST(RealTime, HasThePriorityOrSaysWhyNotAndGivesItBack) {
  const int before = ::sched_getscheduler(0);
  {
    const RealTime real_time({1, -1});
    EXPECT_EQ(::sched_getscheduler(0) == SCHED_FIFO, real_time.priority_error() == 0)
        << std::strerror(real_time.priority_error());
  }
  EXPECT_EQ(::sched_getscheduler(0), before);
}

TEST(RealTime, LeavesTheSchedulerAloneUnlessAsked) {
  const int before = ::sched_getscheduler(0);
  const RealTime real_time({0, -1});
  EXPECT_EQ(::sched_getscheduler(0), before);
  EXPECT_EQ(real_time.priority_error(), 0);
}

TEST(RealTime, SaysThatAProcessorIsNotThere) {
  const RealTime real_time({0, 1023});
  EXPECT_EQ(real_time.cpu_error(), EINVAL);
}

int signals_before = 0;

TEST(StopSignal, IsReceivedWhileItLivesAndGoesWhereItWentAfterwards) {
  signals_before = 0;
  const auto old = std::signal(SIGTERM, [](int) { ++signals_before; });
  {
    const StopSignal stop;
    EXPECT_FALSE(stop.received());
    std::raise(SIGTERM);
    EXPECT_TRUE(stop.received());
  }
  EXPECT_EQ(signals_before, 0);
  std::raise(SIGTERM);
  EXPECT_EQ(signals_before, 1);
  std::signal(SIGTERM, old);
  const StopSignal next;
  EXPECT_FALSE(next.received());
}

TEST(StopSignal, DoesNotCutATickShort) {
  const StopSignal stop;
  Periodic periodic(50 * kPeriod_ns);
  std::thread other([thread = ::pthread_self()] {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ::pthread_kill(thread, SIGINT);
  });
  EXPECT_GE(periodic.begin(), 0) << "asleep until the tick is due";
  EXPECT_GE(now_ns(), periodic.due_ns());
  other.join();
  EXPECT_TRUE(stop.received());
}

}  // namespace
}  // namespace crankloop::port::real_time_test

// docs/contract.md "What the caller keeps alive, and threads": engines share nothing but tables that they read, and
// set-up shares nothing at all. The preset `thread` runs this under the thread sanitizer, which sees any byte that two
// threads touch.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include <crankloop/tick/state/saved_state.hpp>

#include "support/both_reals.hpp"
#include "support/kept_engines.hpp"
#include "support/status.hpp"

namespace crankloop::threads_test {
namespace {

using namespace tick_test;

constexpr std::uint32_t kThreads = 4;

/// Lets go of all threads at once, so that their work overlaps.
class Start {
 public:
  void wait() {
    ++waiting_;
    while (waiting_ < kThreads) std::this_thread::yield();
  }

 private:
  std::atomic<std::uint32_t> waiting_{0};
};

/// work(i) in kThreads threads at once, i from 0.
template <class Work>
void in_threads(const Work& work) {
  Start start;
  std::vector<std::thread> threads;
  for (std::uint32_t i = 0; i < kThreads; ++i) {
    threads.emplace_back([&start, &work, i] {
      start.wait();
      work(i);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

template <class Real>
class Threads : public ::testing::Test {};
TYPED_TEST_SUITE(Threads, BothReals, RealName);

/// Every output of some cycles and the state after them, saved: of engine `which`, each at a speed of its own, now and
/// then given nonsense.
template <class Real>
std::vector<std::uint64_t> drive(std::uint32_t which) {
  using S = FourWithValves;
  const auto engine = started_four<Real, S>(phase_at_deg(10 * which));
  typename Engine<Real, S>::Input in;
  std::vector<std::uint64_t> all;
  for (std::uint32_t tick = 0; tick < 1500; ++tick) {
    in.speed_rad_s = static_cast<Real>(tick % 100 == 99 ? 1e9 : 200 + 150 * which);
    in.cam_phase_deg[0] = static_cast<Real>(which * 5);
    for (const std::uint64_t word : bits_now(engine->step(in))) all.push_back(word);
  }
  std::vector<unsigned char> bytes(kSavedStateBytes<Real, S>);
  EXPECT_TRUE(accepted(save_state(*engine, bytes.data(), bytes.size())));
  all.insert(all.end(), bytes.begin(), bytes.end());
  return all;
}

TYPED_TEST(Threads, StepEnginesOnTheSameTablesToTheBitsOfEachAlone) {
  using Real = TypeParam;
  std::vector<std::uint64_t> alone[kThreads];
  for (std::uint32_t i = 0; i < kThreads; ++i) alone[i] = drive<Real>(i);
  std::vector<std::uint64_t> together[kThreads];
  in_threads([&together](std::uint32_t i) { together[i] = drive<Real>(i); });
  for (std::uint32_t i = 0; i < kThreads; ++i) {
    EXPECT_EQ(together[i], alone[i]) << "engine " << i;
    EXPECT_TRUE(i == 0 || alone[i] != alone[i - 1]) << "or the engines did the same";
  }
}

TYPED_TEST(Threads, BuildTablesAtOnce) {
  using Real = TypeParam;
  using S = FourWithValves;
  using Storage = TableStorage<Real, S>;
  std::unique_ptr<Storage> built[kThreads];
  Status status[kThreads];
  in_threads([&](std::uint32_t i) {
    built[i] = std::make_unique<Storage>();
    status[i] = built[i]->build(four_with_valves(), {50e-6, {}});
  });
  const Tables<Real, S>& want = tables_of_four<Real, S>().tables();
  for (std::uint32_t i = 0; i < kThreads; ++i) {
    ASSERT_TRUE(accepted(status[i]));
    const Tables<Real, S>& tables = built[i]->tables();
    EXPECT_EQ(tables.drive->fingerprint, want.drive->fingerprint);
    EXPECT_EQ(std::memcmp(tables.valve_motions, want.valve_motions, 2 * sizeof *want.valve_motions), 0)
        << "thread " << i;
  }
}

}  // namespace
}  // namespace crankloop::threads_test

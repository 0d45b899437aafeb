// The budget that a tick has for events of elastic valves: how large it is, and what becomes of a tick beyond it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/step.hpp>

#include "crankloop/engine_file/engine_file.hpp"
#include "support/both_reals.hpp"
#include "support/engines.hpp"
#include "support/status.hpp"
#include "support/units.hpp"

namespace crankloop::event_budget_test {
namespace {

using support::refuses;
using tick_test::BothReals;
using tick_test::RealName;

struct EightValves : Scene {
  static constexpr auto cylinders = exactly<4>;
  static constexpr auto valves = ValveModel::elastic;
  static constexpr auto trains = exactly<2>;
};

/// Four cylinders that fire together, so that four valves open and land in the same tick.
EngineDefinition all_at_once(double max_rpm) {
  EngineDefinition engine = support::with_cylinders(support::single_495(), {0, 0, 0, 0});
  engine.crank.max_speed_rad_s = max_rpm * support::kPi / 30;
  engine.train_count = 2;
  for (int t = 0; t < 2; ++t) {
    engine.trains[t] = support::ohc_125_train();
    engine.trains[t].cam.full_lift_deg = t == 0 ? 450 : 250;
  }
  return engine;
}

template <class Real>
class EventBudgetOf : public ::testing::Test {
 protected:
  using Engine = crankloop::Engine<Real, EightValves>;
  using Tables = TableStorage<Real, EightValves>;
  using State = typename Engine::State;

  /// The state as one of another engine, whose tables have another budget.
  static State as_of(const Engine& other, State state) {
    state.fingerprint = other.state().fingerprint;
    return state;
  }

  static std::unique_ptr<Tables> tables(double tick_s, int budget, TableReport* report = nullptr) {
    auto storage = std::make_unique<Tables>();
    TickOptions options{tick_s};
    options.valves.event_budget = budget;
    EXPECT_TRUE(accepted(storage->build(all_at_once(6000), options, report)));
    return storage;
  }
};
TYPED_TEST_SUITE(EventBudgetOf, BothReals, RealName);

TYPED_TEST(EventBudgetOf, IsByDefaultForTwoEventsInEveryFineStepAndTwoMoreOfEachValve) {
  TableReport report;
  (void)TestFixture::tables(100e-6, 0, &report);
  ASSERT_EQ(report.valve_fine_steps, 8 * 5);
  EXPECT_EQ(report.event_budget, 8 * 5 + 2 * 2 * (8 * 5 + 8));
  (void)TestFixture::tables(10e-6, 0, &report);
  ASSERT_EQ(report.valve_fine_steps, 8 * 1);
  EXPECT_EQ(report.event_budget, 8 * 1 + 2 * 2 * (8 * 1 + 8));
  (void)TestFixture::tables(10e-6, 17, &report);
  EXPECT_EQ(report.event_budget, 17);
}

TYPED_TEST(EventBudgetOf, HasNoLessThanTheFineStepsOfAValveAndAnEvent) {
  const auto storage = std::make_unique<typename TestFixture::Tables>();
  TickOptions options{100e-6};
  for (const int bad : {-1, 1, 6, 32769}) {
    options.valves.event_budget = bad;
    const int train = bad == 1 || bad == 6 ? 0 : -1;
    EXPECT_TRUE(
        refuses(storage->build(all_at_once(6000), options), Reason::out_of_range, "options.valves.event_budget", train))
        << bad;
  }
  for (const int good : {7, 32768}) {
    options.valves.event_budget = good;
    EXPECT_TRUE(accepted(storage->build(all_at_once(6000), options))) << good;
  }
}

/// From every state of a run with little budget, a tick that sets no bit leads where one with all the budget leads, to
/// the bit. The others stay near it.
TYPED_TEST(EventBudgetOf, TellsEveryTickThatItDidNotSufficeFor) {
  using Real = TypeParam;
  for (const double tick_s : {10e-6, 100e-6}) {
    const auto few = TestFixture::tables(tick_s, tick_s < 50e-6 ? 3 : 7);
    const auto all = TestFixture::tables(tick_s, 8192);
    typename TestFixture::Engine tested, free;
    ASSERT_TRUE(accepted(tested.init(few->tables())));
    ASSERT_TRUE(accepted(free.init(all->tables())));
    typename TestFixture::Engine::Input in;
    in.speed_rad_s = static_cast<Real>(4000 * support::kPi / 30);
    int beyond = 0, differ = 0;
    double worst_m = 0;
    const int ticks = static_cast<int>(0.06 / tick_s);  // two cycles
    for (int i = 0; i < ticks; ++i) {
      ASSERT_TRUE(accepted(free.restore(TestFixture::as_of(free, tested.state()))));
      const auto& limited = tested.step(in);
      const auto& unlimited = free.step(in);
      ASSERT_EQ(unlimited.faults, 0u) << "tick " << i;
      ASSERT_EQ(limited.faults & ~std::uint32_t{kFaultEventBudget}, 0u) << "tick " << i;
      const bool same = std::memcmp(&limited.valve, &unlimited.valve, sizeof limited.valve) == 0;
      if (limited.faults == 0) {
        ASSERT_TRUE(same) << "tick " << i;
      } else {
        ++beyond;
        differ += same ? 0 : 1;
      }
      for (std::uint32_t t = 0; t < 2; ++t) {
        for (std::uint32_t k = 0; k < 4; ++k) {
          const double off_m = std::fabs(static_cast<double>(limited.valve[t][k].lift_m) -
                                         static_cast<double>(unlimited.valve[t][k].lift_m));
          worst_m = std::fmax(worst_m, off_m);
        }
      }
    }
    EXPECT_GT(beyond, 10) << tick_s;
    EXPECT_GT(differ, 5) << tick_s;
    EXPECT_LT(beyond, ticks / 4) << tick_s;
    // One tick at the seating speed of 0.5 m/s, with a contact that the other end of it has.
    EXPECT_LT(worst_m, 0.5 * tick_s) << tick_s;
    EXPECT_GT(worst_m, 1e-9) << tick_s;
  }
}

/// Valves that fly beyond any lift, as bad numbers may make them, are put back at rest, on their seats or onto their
/// cams: also those that the budget does not suffice for.
TYPED_TEST(EventBudgetOf, PutsBackValvesThatAreTooFarWithinItAndBeyondIt) {
  using Real = TypeParam;
  const auto few = TestFixture::tables(10e-6, 3);
  typename TestFixture::Engine engine;
  ASSERT_TRUE(accepted(engine.init(few->tables())));
  typename TestFixture::Engine::Input in;
  in.speed_rad_s = Real{200};
  while (engine.state().valve_lift_m[0] < Real(5e-3)) engine.step(in);
  typename TestFixture::State state = engine.state();
  for (std::uint32_t v = 0; v < 8; ++v)
    state.valve_lift_m[v] = Real(0.999), state.valve_velocity_m_s[v] = Real(1e4), state.valve_regime[v] = kTrainOn;
  ASSERT_TRUE(accepted(engine.restore(state)));
  const auto& out = engine.step(in);
  EXPECT_EQ(out.faults, std::uint32_t{kFaultEventBudget});
  for (std::uint32_t t = 0; t < 2; ++t) {
    const auto& curve = few->tables().lift_curves[t];
    const Real cam_m = curve.read(curve.cell(engine.state().phase.units(), 0)).lift_m;
    ASSERT_EQ(cam_m > 0, t == 0) << "the other cam is away";
    for (std::uint32_t k = 0; k < 4; ++k) {
      EXPECT_EQ(out.valve[t][k].lift_m, t == 0 ? cam_m : Real{0}) << t << ' ' << k;
      EXPECT_EQ(out.valve[t][k].velocity_m_s, 0) << t << ' ' << k;
    }
  }
  for (int i = 0; i < 100; ++i) engine.step(in);
  EXPECT_EQ(engine.output().faults, 0u);
}

/// Valves that move alike are late by turns: none is always the one that the budget does not suffice for.
TYPED_TEST(EventBudgetOf, IsSpentOnAnotherValveFirstInEveryTick) {
  using Real = TypeParam;
  const auto few = TestFixture::tables(10e-6, 3);
  const auto all = TestFixture::tables(10e-6, 8192);
  typename TestFixture::Engine tested, free;
  ASSERT_TRUE(accepted(tested.init(few->tables())));
  ASSERT_TRUE(accepted(free.init(all->tables())));
  typename TestFixture::Engine::Input in;
  in.speed_rad_s = static_cast<Real>(4000 * support::kPi / 30);
  int located[4] = {}, late[4] = {};
  for (int i = 0; i < 12000; ++i) {
    ASSERT_TRUE(accepted(free.restore(TestFixture::as_of(free, tested.state()))));
    const auto& limited = tested.step(in);
    const auto& unlimited = free.step(in);
    if ((limited.faults & kFaultEventBudget) == 0) continue;
    for (std::uint32_t k = 0; k < 4; ++k)
      ++(limited.valve[0][k].lift_m == unlimited.valve[0][k].lift_m ? located : late)[k];
  }
  for (int k = 0; k < 4; ++k) {
    EXPECT_GT(located[k], 0) << k;
    EXPECT_GT(late[k], 0) << k;
  }
}

/// Ticks that exceeded their budget, by the time since the start.
struct Exceeded {
  int in_first_5_ms = 0, later = 0, ticks = 0;
};

/// Half a second of the Cortex-M4F's example engine, started at each speed up to 1.2 times its 6000 rpm.
Exceeded exceeded_by_the_ohc_1600(double tick_us, int budget) {
  const program::EngineFile file =
      program::read_engine_file(CRANKLOOP_SOURCE_DIR "/port/cortex_m4f/example/ohc_1600.ini", {});
  const auto storage = std::make_unique<TableStorage<float, EightValves>>();
  TickOptions options{tick_us * 1e-6};
  options.valves.event_budget = budget;
  EXPECT_TRUE(accepted(storage->build(file.definition(), options)));
  Exceeded exceeded;
  for (int rpm = 600; rpm <= 7200; rpm += 600) {
    crankloop::Engine<float, EightValves> run;
    EXPECT_TRUE(accepted(run.init(storage->tables())));
    crankloop::Engine<float, EightValves>::Input in;
    in.speed_rad_s = static_cast<float>(rpm * support::kPi / 30);
    const int ticks = static_cast<int>(0.5e6 / tick_us);
    for (int i = 0; i < ticks; ++i) {
      if ((run.step(in).faults & kFaultEventBudget) == 0) continue;
      ++(i * tick_us < 5000 ? exceeded.in_first_5_ms : exceeded.later);
    }
    exceeded.ticks += ticks;
  }
  return exceeded;
}

/// The budgets of the cost tables (tests/target/CMakeLists.txt), and the smallest that bind only at a start.
TEST(EventBudgetOfTheOhc1600, BindsInFewTicksAfterAStart) {
  const struct {
    double tick_us;
    int budget, most_in_first_5_ms, most_later;
  } cases[] = {{10, 6, 1, 0}, {20, 6, 1, 2}, {20, 9, 1, 0}, {50, 14, 1, 0}, {100, 18, 3, 4}, {100, 24, 2, 0}};
  for (const auto& c : cases) {
    const Exceeded exceeded = exceeded_by_the_ohc_1600(c.tick_us, c.budget);
    std::printf("[ figures  ] %g us, %d units: exceeded in %d ticks of the first 5 ms, %d later, of %d\n", c.tick_us,
                c.budget, exceeded.in_first_5_ms, exceeded.later, exceeded.ticks);
    EXPECT_LE(exceeded.in_first_5_ms, c.most_in_first_5_ms);
    EXPECT_LE(exceeded.later, c.most_later);
  }
}

}  // namespace
}  // namespace crankloop::event_budget_test

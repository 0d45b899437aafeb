// A tick in which contacts change, by itself: against the law of motion in steps so short that they need not know where
// a contact changes.
#include <crankloop/tabulate/valve_motion.hpp>
#include <crankloop/tick/valve/event_location.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "support/random.hpp"
#include "support/test_valves.hpp"
#include "support/valve_reference.hpp"

namespace crankloop::event_location_test {
namespace {

using namespace valve_test;
using detail::ValveState;
using support::Random;

using Gas = detail::GasForce<double>;
using Span = detail::Span<double, Gas>;

/// Counts the contacts that change.
struct Changes {
  template <class DegAt>
  void step(const detail::ObservedStep<double>&, double, const DegAt&) noexcept {}
  void event(std::uint32_t before, std::uint32_t after, double, double) noexcept {
    const std::uint32_t changed = before ^ after;
    count += ((changed & kTrainOn) != 0 ? 1 : 0) + ((changed & kSeatOn) != 0 ? 1 : 0);
  }
  int count = 0;
};
using Locator = detail::EventLocator<double, Gas, Changes>;

/// The cubic between a cam's lifts and slopes at both ends of a step, by the handbook's formulas.
CamAt cam_within(const Span& step, double x, double step_s) {
  const double p0 = step.from.lift_m, m0 = step.cam.deg * step.from.per_deg_m;
  const double p1 = step.to.lift_m, m1 = step.cam.deg * step.to.per_deg_m;
  const double lift = (2 * x * x * x - 3 * x * x + 1) * p0 + (x * x * x - 2 * x * x + x) * m0 +
                      (3 * x * x - 2 * x * x * x) * p1 + (x * x * x - x * x) * m1;
  const double slope =
      (6 * x * x - 6 * x) * p0 + (3 * x * x - 4 * x + 1) * m0 + (6 * x - 6 * x * x) * p1 + (3 * x * x - 2 * x) * m1;
  return {lift, slope / step_s};
}

/// The textbook's four stages, many times over the step; each checks the contacts, and the gas force rises evenly.
struct Brute {
  ValveState<double> end;
  int changes = 0;
};
template <class CamWithin>
Brute brute_force(const SingleMass& mass, ValveState<double> s, const Gas& gas, double step_s, int steps,
                  const CamWithin& cam_within) {
  const auto acceleration = [&](double x, double y, double v) {
    const CamAt cam = cam_within(x);
    const Acting forces = acting(mass, y, v, cam.Y, cam.Yd);
    const double gas_N = gas.from_N + x * (gas.to_N - gas.from_N);
    return (forces.train_N + forces.seat_N - mass.k_s * y - mass.P - mass.c * v - gas_N) / mass.M;
  };
  const auto contacts = [&](double x) {
    const CamAt cam = cam_within(x);
    const Acting forces = acting(mass, s.lift_m, s.velocity_m_s, cam.Y, cam.Yd);
    return (forces.train ? 1 : 0) + (forces.seat ? 2 : 0);
  };
  Brute all{};
  const double d = step_s / steps;
  for (int i = 0; i < steps; ++i) {
    const double x = static_cast<double>(i) / steps;
    const int before = contacts(x);
    const double half = 0.5 / steps;
    const double y = s.lift_m, v = s.velocity_m_s;
    const double a1 = acceleration(x, y, v);
    const double v2 = v + d / 2 * a1, a2 = acceleration(x + half, y + d / 2 * v, v2);
    const double v3 = v + d / 2 * a2, a3 = acceleration(x + half, y + d / 2 * v2, v3);
    const double v4 = v + d * a3, a4 = acceleration(x + 2 * half, y + d * v3, v4);
    s = {y + d / 6 * (v + 2 * v2 + 2 * v3 + v4), v + d / 6 * (a1 + 2 * a2 + 2 * a3 + a4)};
    all.changes += contacts(x + 2 * half) != before ? 1 : 0;
  }
  all.end = s;
  return all;
}

/// A valve near its train, its seat or both, so that a tick of 10 us changes a contact once or more often.
struct Draw {
  ValveState<double> start;
  Span step;
};
Draw drawn(Random& random, const SingleMass& mass, double tick_s) {
  Draw draw{};
  const bool on_seat = random.whole(0, 2) == 0;
  draw.start.lift_m = on_seat ? mass.delta + random.between(-3e-6, 3e-6) : random.between(0.5e-3, 5e-3);
  draw.start.velocity_m_s = random.between(-1, 1) * (on_seat ? 0.5 : 3);
  const bool touches_and_goes = random.coin();
  const double relative_m_s = random.between(-0.7, 0.7) * (touches_and_goes ? 0.1 : 1);
  const double cam_m_s = draw.start.velocity_m_s + relative_m_s;
  draw.step.cam = {0.25, 0.25 / tick_s};
  const double per_deg = 1 / draw.step.cam.deg_per_s;
  draw.step.from = {draw.start.lift_m + random.between(-1, 1) * (touches_and_goes ? 1e-7 : 3e-6), cam_m_s * per_deg};
  const double later_m_s = cam_m_s + random.between(-0.3, 0.3);
  draw.step.to = {draw.step.from.lift_m + (cam_m_s + later_m_s) / 2 * tick_s + random.between(-1, 1) * 3e-7,
                  later_m_s * per_deg};
  draw.step.gas = {random.between(-3000, 3000), random.between(-3000, 3000)};
  return draw;
}

/// The 125's valve in ticks so short that none is divided.
class EventLocator : public testing::Test {
 protected:
  static constexpr double kTick_s = 10e-6;

  /// A tick whose step begins in `regime`, whatever contacts its start requires.
  template <class Record>
  [[nodiscard]] detail::ValveInRegime<double> run(const ValveState<double>& start, std::uint32_t regime,
                                                  const Span& tick, detail::EventBudget& budget, Record& record) const {
    const auto plain = stepped(motion_.fine[regime], start, tick.from, tick.to, tick.cam.deg, tick.gas);
    return detail::EventLocator<double, Gas, Record>(motion_, curve_, budget, record)
        .run({start, regime}, plain, tick, 0, std::int64_t{1} << 50);
  }

  const ValveTrain train_ = ohc_125_train();
  const SingleMass mass_{train_.valve, train_.rocker, lift_of(train_).largest_lift_m()};
  const detail::ValveMotion<double> motion_ = motion_for(body_of(train_), kTick_s);
  const detail::LiftCurve<double> curve_{};
};

TEST_F(EventLocator, LeadsWhereTheLawOfMotionDoesUnderGasThatRisesWithinTheTick) {
  ASSERT_EQ(motion_.parts, 1u);
  ASSERT_GT(motion_.widest_step_deg, 0.25);
  Random random;
  std::vector<double> off_m, off_m_s;
  int once = 0, more = 0, told_otherwise = 0;
  for (int i = 0; i < 6000; ++i) {
    const Draw draw = drawn(random, mass_, kTick_s);
    const Brute truth = brute_force(mass_, draw.start, draw.step.gas, kTick_s, 400,
                                    [&draw](double x) { return cam_within(draw.step, x, kTick_s); });
    if (truth.changes == 0) continue;
    ++(truth.changes == 1 ? once : more);
    detail::EventBudget budget{100, false};
    const std::uint32_t regime =
        detail::required_contacts(motion_, draw.start, draw.step.from, draw.step.cam.deg_per_s);
    Changes located;
    const auto end = run(draw.start, regime, draw.step, budget, located);
    off_m.push_back(std::fabs(end.state.lift_m - truth.end.lift_m));
    off_m_s.push_back(std::fabs(end.state.velocity_m_s - truth.end.velocity_m_s));
    EXPECT_FALSE(budget.exceeded) << random.trace(i);
    told_otherwise += located.count != truth.changes ? 1 : 0;
  }
  EXPECT_LT(told_otherwise, (once + more) / 25) << "changes that did not happen, or were missed";
  EXPECT_GT(once, 1000);
  EXPECT_GT(more, 100);
  // A contact that is only just touched is badly told, by either: the worst are of that kind.
  const auto of_rank = [](std::vector<double>& all, double part) {
    std::sort(all.begin(), all.end());
    return all[static_cast<std::size_t>(part * static_cast<double>(all.size() - 1))];
  };
  std::printf(
      "[ figures  ] %d ticks with a change, %d with more: lift off by %.3g nm in half of them, %.3g in 9 of 10, at "
      "most %.3g; speed by %.3g um/s, %.3g, %.3g\n",
      once, more, of_rank(off_m, 0.5) * 1e9, of_rank(off_m, 0.9) * 1e9, of_rank(off_m, 1) * 1e9,
      of_rank(off_m_s, 0.5) * 1e6, of_rank(off_m_s, 0.9) * 1e6, of_rank(off_m_s, 1) * 1e6);
  EXPECT_LT(of_rank(off_m, 0.5), 2e-11);
  EXPECT_LT(of_rank(off_m, 0.9), 4e-10);
  EXPECT_LT(of_rank(off_m, 1), 0.1e-6) << "the accuracy class";
  EXPECT_LT(of_rank(off_m_s, 1), 20e-3);
}

TEST_F(EventLocator, FindsAllEventsInTheFineStepsOfALongTick) {
  // On the flanks of the lobe the valve flies along its train, a tenth of a micrometre from it: it touches and leaves
  // it within a fine step, or several times in a tick.
  const ValveTrain train = ohc_125_train();
  constexpr double kLongTick_s = 100e-6;
  const Rig<double> rig(train, {kLongTick_s, {}});
  const detail::ValveMotion<double>& motion = rig.motion();
  const detail::LiftCurve<double>& curve = rig.curve();
  const SingleMass mass(train.valve, train.rocker, lift_of(train).largest_lift_m());
  ASSERT_GT(motion.parts, 1u);
  Random random;
  int changes = 0, told_otherwise = 0;
  double off_m = 0;
  for (int i = 0; i < 1000; ++i) {
    const double deg_per_s = random.between(9e3, 27e3);  // to 9000 rpm
    const double deg = deg_per_s * kLongTick_s;
    const auto at = [&](double x, double from_deg) {
      return curve.read(
          detail::LiftCurve<double>::cell(static_cast<std::uint64_t>((from_deg + x * deg) / 360 * 0x1p64)));
    };
    const double from_deg = random.between(10, 130);
    Span step{at(0, from_deg), at(1, from_deg), {deg, deg_per_s}, {}, 0, 0};
    if (step.from.lift_m < 1e-4 || step.to.lift_m < 1e-4) continue;
    const ValveState<double> start{step.from.lift_m + random.between(-1, 1) * 1e-7,
                                   step.from.per_deg_m * deg_per_s + random.between(-0.03, 0.03)};
    const double hold_N = -mass.k_s * start.lift_m - mass.P;  // cancels the spring
    const double bend_N = (step.to.per_deg_m - step.from.per_deg_m) * deg_per_s / kLongTick_s * mass.M;
    const double gas_N = hold_N - bend_N;  // so that it flies as its cam moves
    step.gas = {gas_N + random.between(-100, 100), gas_N + random.between(-100, 100)};
    const Brute truth = brute_force(mass, start, step.gas, kLongTick_s, 1000, [&](double x) {
      const detail::Lift<double> lift = at(x, from_deg);
      return CamAt{lift.lift_m, lift.per_deg_m * deg_per_s};
    });
    detail::EventBudget budget{100, false};
    Changes located;
    const std::uint32_t regime = detail::required_contacts(motion, start, step.from, deg_per_s);
    const std::uint64_t to = static_cast<std::uint64_t>((from_deg + deg) / 360 * 0x1p64);
    const auto turned = static_cast<std::int64_t>(deg / 360 * 0x1p64);
    const auto end = Locator(motion, curve, budget, located).run({start, regime}, {}, step, to, turned);
    changes += truth.changes;
    told_otherwise += located.count != truth.changes ? 1 : 0;
    off_m = std::max(off_m, std::fabs(end.state.lift_m - truth.end.lift_m));
  }
  std::printf("[ figures  ] %d changes in %u fine steps a tick, told otherwise %d times; lift off by up to %.3g nm\n",
              changes, motion.parts, told_otherwise, off_m * 1e9);
  EXPECT_GT(changes, 500);
  EXPECT_LE(told_otherwise, 1) << "one that only just touches";
  EXPECT_LT(off_m, 0.1e-6);
}

/// Keeps where in the lobe each span and each change of contacts was.
struct Path {
  struct Part {
    double from_deg, to_deg, step_s;
    std::uint32_t regime;
  };
  struct Event {
    std::uint32_t before, after;
    double at_deg;
    std::size_t parts_before;
  };
  template <class DegAt>
  void step(const detail::ObservedStep<double>& s, double, const DegAt& deg_at) {
    parts.push_back({deg_at(0), deg_at(1), s.step_s, s.regime});
  }
  void event(std::uint32_t before, std::uint32_t after, double, double at_deg) {
    events.push_back({before, after, at_deg, parts.size()});
  }
  std::vector<Part> parts;
  std::vector<Event> events;
};

/// The parts of a tick follow one another without a gap, from its start to its end, as long as the cam takes to turn
/// through them; contacts change where one ends, and are the next one's. So too with a budget for one event.
TEST_F(EventLocator, RecordsTheTickPartByPart) {
  Random random;
  int behind_an_event = 0, for_want_of_budget = 0;
  for (int i = 0; i < 3000; ++i) {
    SCOPED_TRACE(random.trace(i));
    const Draw draw = drawn(random, mass_, kTick_s);
    const Span& tick = draw.step;
    const std::uint32_t start = detail::required_contacts(motion_, draw.start, tick.from, tick.cam.deg_per_s);
    detail::EventBudget budget{random.coin() ? 100 : detail::kUnitsOfEvent, false};
    Path path;
    const auto end = run(draw.start, start, tick, budget, path);
    double at_deg = 0;
    std::uint32_t regime = start;
    std::size_t told = 0;
    for (std::size_t part = 0; part < path.parts.size(); ++part) {
      const Path::Part& p = path.parts[part];
      EXPECT_NEAR(p.from_deg, at_deg, 1e-12);
      EXPECT_NEAR(p.to_deg - p.from_deg, tick.cam.deg_per_s * p.step_s, 1e-12);
      EXPECT_EQ(p.regime, regime);
      at_deg = p.to_deg;
      for (; told < path.events.size() && path.events[told].parts_before == part + 1; ++told) {
        EXPECT_EQ(path.events[told].before, regime);
        EXPECT_NEAR(path.events[told].at_deg, at_deg, 1e-12);
        regime = path.events[told].after;
      }
    }
    EXPECT_EQ(told, path.events.size()) << "one before the first part";
    EXPECT_NEAR(at_deg, tick.cam.deg, 1e-12);
    EXPECT_EQ(end.regime, regime);
    behind_an_event += path.parts.size() > 2 ? 1 : 0;
    for_want_of_budget += budget.exceeded && path.parts.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(behind_an_event, 50);
  EXPECT_GT(for_want_of_budget, 50);
}

/// The cam's speed may change between two ticks, and with it whether the train pushes: then the contacts with which the
/// tick before ended are not those that this one begins with.
TEST_F(EventLocator, BeginsATickWithTheContactsThatItsStartRequires) {
  Random random;
  int calm = 0;
  for (int i = 0; i < 3000; ++i) {
    SCOPED_TRACE(random.trace(i));
    const Draw draw = drawn(random, mass_, kTick_s);
    const Span& tick = draw.step;
    const std::uint32_t now = detail::required_contacts(motion_, draw.start, tick.from, tick.cam.deg_per_s);
    const std::uint32_t before = now ^ kTrainOn;
    const Brute truth = brute_force(mass_, draw.start, tick.gas, kTick_s, 200,
                                    [&tick](double x) { return cam_within(tick, x, kTick_s); });
    if (truth.changes != 0) continue;
    ++calm;
    const auto plain = stepped(motion_.fine[before], draw.start, tick.from, tick.to, tick.cam.deg, tick.gas);
    const auto run_with = [&](std::uint32_t units, Changes& changes, detail::EventBudget& budget) {
      budget = {units, false};
      return run(draw.start, before, tick, budget, changes);
    };
    detail::EventBudget budget{};
    Changes located;
    const auto end = run_with(100, located, budget);
    EXPECT_FALSE(budget.exceeded);
    EXPECT_NEAR(end.state.lift_m, truth.end.lift_m, 1e-9);
    EXPECT_NEAR(end.state.velocity_m_s, truth.end.velocity_m_s, 1e-3);

    Changes none_at_start;
    const auto beyond = run_with(detail::kUnitsOfSearch, none_at_start, budget);
    EXPECT_TRUE(budget.exceeded) << "a search more than there is";
    EXPECT_EQ(beyond.state.lift_m, plain.state.lift_m) << "as the tick before ended";
    EXPECT_EQ(beyond.regime, detail::required_contacts(motion_, plain.state, tick.to, tick.cam.deg_per_s));
  }
  EXPECT_GT(calm, 500);
}

/// A train that touches at the end of a step by less than a valve at rest may be off needs no location: without budget
/// for it nothing is amiss, be it the step's first change or one after another. A larger one is told.
TEST_F(EventLocator, ExceedsItsBudgetByNoTouchOfATrainThatIsNegligible) {
  const double rest_m = motion_.fine[kSeatOn].rest_m;
  for (const bool lands_before : {false, true}) {
    Span step{};
    step.cam = {0.25, 0.25 / kTick_s};
    const double fall_m_s = 0.3;
    const double seat_m = motion_.body.seat_compression_m;
    const ValveState<double> start{lands_before ? seat_m + 0.3 * fall_m_s * kTick_s : 3e-3, -fall_m_s};
    const auto run_with = [&](double cam_m, std::uint32_t units, Changes& located, detail::EventBudget& budget) {
      const double rise_m_s = 0.5;
      step.from = {cam_m - rise_m_s * kTick_s, rise_m_s / step.cam.deg_per_s};
      step.to = {cam_m, rise_m_s / step.cam.deg_per_s};
      budget = {units, false};
      return run(start, 0, step, budget, located);
    };
    detail::EventBudget budget{};
    Changes landing;
    const auto without_cam = run_with(-1e-3, 100, landing, budget);
    ASSERT_EQ(without_cam.regime, lands_before ? kSeatOn : 0u);
    ASSERT_EQ(landing.count, lands_before ? 1 : 0);
    const std::uint32_t units = lands_before ? detail::kUnitsOfEvent + detail::kUnitsOfSearch : detail::kUnitsOfLook;
    for (const double part : {0.5, 2.0}) {
      Changes located;
      const auto end = run_with(without_cam.state.lift_m + part * rest_m, units, located, budget);
      EXPECT_EQ(budget.exceeded, part > 1) << lands_before;
      EXPECT_EQ(end.regime, without_cam.regime | kTrainOn);
      EXPECT_EQ(end.state.lift_m, without_cam.state.lift_m) << "the touch counts at the end";
      EXPECT_EQ(located.count, lands_before ? 2 : 1);
    }
  }
}

/// Valve and cam are braked alike, and the force between them goes through zero and back within the step: so shortly
/// that at both ends of it nothing has changed.
TEST_F(EventLocator, FindsATrainThatPartsAndTouchesWithinAFineStepHoweverTheCamIsBraked) {
  const double lag_s = mass_.b / mass_.k;
  Random random;
  int parted = 0, told_otherwise = 0;
  for (int i = 0; i < 1000; ++i) {
    const double valve_m_s2 = random.between(-3e4, 3e4), closing_m_s2 = random.between(500, 5000);
    const double part = random.between(0.3, 0.7), parts_at_s = part * kTick_s;
    const double most_m = closing_m_s2 / 2 * std::pow(std::min(part, 1 - part) * kTick_s, 2);
    // The force is in proportion to depth + lag * speed: a parabola whose lowest point is at parts_at_s.
    const double lowest_m = -random.between(0.2, 0.8) * most_m;
    const double speed_m_s = -closing_m_s2 * (parts_at_s + lag_s);
    const double depth_m = lowest_m + closing_m_s2 / 2 * parts_at_s * parts_at_s - lag_s * speed_m_s;
    const ValveState<double> start{random.between(2e-3, 5e-3), random.between(-3, 3)};
    const double end_m = start.lift_m + start.velocity_m_s * kTick_s + valve_m_s2 / 2 * kTick_s * kTick_s;
    const double end_m_s = start.velocity_m_s + valve_m_s2 * kTick_s;
    Span step{};
    step.cam = {0.25, 0.25 / kTick_s};
    const double per_deg = 1 / step.cam.deg_per_s;
    step.from = {start.lift_m + depth_m, (start.velocity_m_s + speed_m_s) * per_deg};
    step.to = {end_m + depth_m + speed_m_s * kTick_s + closing_m_s2 / 2 * kTick_s * kTick_s,
               (end_m_s + speed_m_s + closing_m_s2 * kTick_s) * per_deg};
    const auto gas_N = [&](double y, double v) {
      return -mass_.k_s * y - mass_.P - mass_.c * v - mass_.M * valve_m_s2;
    };
    step.gas = {gas_N(start.lift_m, start.velocity_m_s), gas_N(end_m, end_m_s)};
    const Brute truth =
        brute_force(mass_, start, step.gas, kTick_s, 400, [&step](double x) { return cam_within(step, x, kTick_s); });
    const std::uint32_t regime = detail::required_contacts(motion_, start, step.from, step.cam.deg_per_s);
    if (regime != kTrainOn || truth.changes != 2) continue;
    ++parted;
    detail::EventBudget budget{100, false};
    Changes located;
    const auto end = run(start, regime, step, budget, located);
    told_otherwise += located.count != 2 ? 1 : 0;
    EXPECT_NEAR(end.state.lift_m, truth.end.lift_m, 1e-10) << random.trace(i);
  }
  std::printf("[ figures  ] parted and touched %d times, told otherwise %d times\n", parted, told_otherwise);
  EXPECT_GT(parted, 500);
  EXPECT_LE(told_otherwise, parted / 50);
}

/// A valve that gas lifts off its seat by nearly as much as its spring presses it in is not taken for one that no train
/// can reach; one that stays deep in its seat is.
TEST_F(EventLocator, TakesAValveForQuietByWhereGasHoldsIt) {
  const ValveTrain train = ohc_125_train();
  const Rig<double> rig(train, {100e-6, {}});
  const detail::ValveMotion<double>& motion = rig.motion();
  ASSERT_GT(motion.parts, 1u);
  const double deg_per_s = 9000;
  for (const bool high : {false, true}) {
    const double lift_m = high ? (motion.quiet_m + motion.body.seat_compression_m) / 2 : motion.quiet_m / 2;
    Span step{};
    step.cam = {deg_per_s * 100e-6, deg_per_s};
    step.from = step.to = rig.curve().read(detail::LiftCurve<double>::cell(std::uint64_t{1} << 63));
    ASSERT_LT(step.from.lift_m, 0) << "the base circle";
    step.gas = {-lift_m / motion.per_seat_N_m, -lift_m / motion.per_seat_N_m};
    detail::EventBudget budget{100, false};
    Changes none;
    const auto turned = static_cast<std::int64_t>(step.cam.deg / 360 * 0x1p64);
    const auto end = Locator(motion, rig.curve(), budget, none)
                         .run({{lift_m, 0}, kSeatOn}, {}, step,
                              (std::uint64_t{1} << 63) + static_cast<std::uint64_t>(turned), turned);
    EXPECT_EQ(end.regime, high ? kSeatOn : detail::kQuiet);
    EXPECT_NEAR(end.state.lift_m, lift_m, 1e-12);
  }
}

TEST(SmoothSegment, TakesATrainsContactForNegligibleByItsGapAlone) {
  const detail::ValveMotion<double> motion = motion_for(body_of(ohc_125_train()), 10e-6);
  const double rest_m = motion.fine[kSeatOn].rest_m;
  ASSERT_GT(rest_m, 0);
  for (const double lift_m : {-5e-6, 0.0, 3e-3}) {
    for (const double sign : {-1.0, 1.0}) {
      const auto with_gap = [&](double gap_m) { return detail::Lift<double>{lift_m + sign * gap_m, 0}; };
      EXPECT_TRUE(detail::is_negligible(motion, kTrainOn, {lift_m, 0.1}, with_gap(0.9 * rest_m))) << lift_m;
      EXPECT_FALSE(detail::is_negligible(motion, kTrainOn, {lift_m, 0.1}, with_gap(1.1 * rest_m))) << lift_m;
      EXPECT_FALSE(detail::is_negligible(motion, kSeatOn, {lift_m, 0.1}, with_gap(0))) << "seats are never";
    }
  }
}

/// A contact at both ends of a segment, by what it is made of: the cam's lift less the valve's, or the seat's place
/// less the valve's, with the first two derivatives by time.
TEST(SmoothSegment, HasDepthSpeedAndRateOfBothContactsAtBothEnds) {
  const ValveTrain train = ohc_125_train();
  const SingleMass mass(train.valve, train.rocker, lift_of(train).largest_lift_m());
  const detail::ValveMotion<double> motion = motion_for(body_of(train), 10e-6);
  const double d_s = motion.fine_step_s;
  Random random;
  for (int i = 0; i < 200; ++i) {
    const double left = random.between(0.1, 1);
    Span step{};
    step.cam = {0.25, 0.25 / d_s};
    step.gas = {random.between(-300, 300), random.between(-300, 300)};
    const detail::Cubic<double> whole(random.between(0, 1e-3), random.between(-1, 1) * 1e-5, random.between(0, 1e-3),
                                      random.between(-1, 1) * 1e-5);
    step.to = {whole.at(1).value, whole.at(1).slope / step.cam.deg};
    detail::Cubic<double> lift = whole;
    lift.shift(1 - left);  // what is left of the step begins there
    const ValveState<double> from{random.between(0, 1e-3), random.between(-2, 2)};
    const ValveState<double> to{random.between(0, 1e-3), random.between(-2, 2)};
    for (const std::uint32_t regime : {0u, kTrainOn, kSeatOn, kTrainOn | kSeatOn}) {
      const auto s = detail::segment_of(motion, {from, regime}, {to, to.lift_m - from.lift_m}, lift, left, step);
      const detail::Contact<double> of_train = detail::train_over(motion, s, lift, left, step);
      const detail::Contact<double> of_seat = detail::seat_over(motion, s);
      for (int end = 0; end < 2; ++end) {
        const ValveState<double>& valve = end == 0 ? from : to;
        const double x = end == 0 ? 1 - left : 1;  // of the whole step
        const double gas_N = step.gas.from_N + x * (step.gas.to_N - step.gas.from_N);
        const double h = 0.01;
        const auto lift_at = [&whole](double part) { return whole.at(part).value; };
        const double cam_m = lift_at(x);
        const double cam_m_s = whole.at(x).slope / d_s;
        const double cam_m_s2 = (lift_at(x + h) - 2 * cam_m + lift_at(x - h)) / (h * d_s * (h * d_s));
        double force_N = -mass.k_s * valve.lift_m - mass.P - mass.c * valve.velocity_m_s - gas_N;
        if ((regime & kTrainOn) != 0)
          force_N += mass.k * (cam_m - valve.lift_m) + mass.b * (cam_m_s - valve.velocity_m_s);
        if ((regime & kSeatOn) != 0) force_N += mass.k_z * (mass.delta - valve.lift_m) - mass.b_z * valve.velocity_m_s;
        const double valve_m_s2 = force_N / mass.M;
        EXPECT_NEAR(of_train.depth_m[end], cam_m - valve.lift_m, 1e-15);
        EXPECT_NEAR(of_train.speed_m_s[end], cam_m_s - valve.velocity_m_s, 1e-9);
        const double scale_m_s2 = std::fabs(cam_m_s2) + std::fabs(valve_m_s2);
        EXPECT_NEAR(of_train.rate_m_s2[end], cam_m_s2 - valve_m_s2, 1e-6 * scale_m_s2) << end << ' ' << regime;
        EXPECT_NEAR(of_seat.depth_m[end], mass.delta - valve.lift_m, 1e-15);
        EXPECT_NEAR(of_seat.speed_m_s[end], -valve.velocity_m_s, 1e-15);
        EXPECT_NEAR(of_seat.rate_m_s2[end], -valve_m_s2, 1e-6 * scale_m_s2) << end << ' ' << regime;
        EXPECT_NEAR(s.acceleration[end], valve_m_s2, 1e-6 * scale_m_s2);
      }
    }
  }
}

}  // namespace
}  // namespace crankloop::event_location_test

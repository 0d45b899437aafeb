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

TEST(EventLocator, LeadsWhereTheLawOfMotionDoesUnderGasThatRisesWithinTheTick) {
  const ValveTrain train = ohc_125_train();
  const SingleMass mass(train.valve, train.rocker, lift_of(train).largest_lift_m());
  constexpr double kTick_s = 10e-6;
  const detail::ValveMotion<double> motion = motion_for(body_of(train), kTick_s);
  ASSERT_EQ(motion.parts, 1u);
  ASSERT_GT(motion.widest_step_deg, 0.25);
  const detail::LiftCurve<double> curve{};
  Random random;
  std::vector<double> off_m, off_m_s;
  int once = 0, more = 0, told_otherwise = 0;
  for (int i = 0; i < 6000; ++i) {
    const Draw draw = drawn(random, mass, kTick_s);
    const Brute truth = brute_force(mass, draw.start, draw.step.gas, kTick_s, 400,
                                    [&draw](double x) { return cam_within(draw.step, x, kTick_s); });
    if (truth.changes == 0) continue;
    ++(truth.changes == 1 ? once : more);
    detail::EventBudget budget{100, false};
    const std::uint32_t regime = detail::required_contacts(motion, draw.start, draw.step.from, draw.step.cam.deg_per_s);
    const auto plain =
        stepped(motion.fine[regime], draw.start, draw.step.from, draw.step.to, draw.step.cam.deg, draw.step.gas);
    Changes located;
    const auto end =
        Locator(motion, curve, budget, located).run({draw.start, regime}, plain, draw.step, 0, std::int64_t{1} << 50);
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

TEST(EventLocator, FindsAllEventsInTheFineStepsOfALongTick) {
  // On the flanks of the lobe the valve flies along its train, a tenth of a micrometre from it: it touches and leaves
  // it within a fine step, or several times in a tick.
  const ValveTrain train = ohc_125_train();
  constexpr double kTick_s = 100e-6;
  const Rig<double> rig(train, {kTick_s, {}});
  const detail::ValveMotion<double>& motion = rig.motion();
  const detail::LiftCurve<double>& curve = rig.curve();
  const SingleMass mass(train.valve, train.rocker, lift_of(train).largest_lift_m());
  ASSERT_GT(motion.parts, 1u);
  Random random;
  int changes = 0, told_otherwise = 0;
  double off_m = 0;
  for (int i = 0; i < 1000; ++i) {
    const double deg_per_s = random.between(9e3, 27e3);  // to 9000 rpm
    const double deg = deg_per_s * kTick_s;
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
    const double bend_N = (step.to.per_deg_m - step.from.per_deg_m) * deg_per_s / kTick_s * mass.M;
    const double gas_N = hold_N - bend_N;  // so that it flies as its cam moves
    step.gas = {gas_N + random.between(-100, 100), gas_N + random.between(-100, 100)};
    const Brute truth = brute_force(mass, start, step.gas, kTick_s, 1000, [&](double x) {
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

// What a scene asks for beside its valves' motion - forces, results of a cycle - changes no bit of that motion, nor
// does forces' being asked for change results: at ticks of one fine step and of many, at speeds from standstill to a
// lobe in a tick, through jumps of the crank, with gas on the valves and without.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>

#include "support/both_reals.hpp"
#include "support/kept_engines.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/units.hpp"

namespace crankloop::valve_groups_test {
namespace {

using namespace tick_test;
using support::Random;

template <class Real, class S>
struct Rig {
  Rig(const EngineDefinition& definition, double tick_s) {
    EXPECT_TRUE(accepted(tables->build(definition, {tick_s, {}})));
    EXPECT_TRUE(accepted(engine.init(tables->tables())));
  }
  const auto& step(Phase crank, double pressure_Pa) {
    typename Engine<Real, S>::Input in;
    in.crank = crank;
    if constexpr (S::valve_gas) {
      for (Real& p : in.pressure_Pa) p = static_cast<Real>(pressure_Pa);
    }
    return engine.step(in);
  }
  std::unique_ptr<TableStorage<Real, S>> tables = std::make_unique<TableStorage<Real, S>>();
  Engine<Real, S> engine;
};

/// Same bits of what both scenes ask for.
template <class Real, class A, class B>
bool same_motion(const ValveMotionOutput<Real, A>& a, const ValveMotionOutput<Real, B>& b) {
  const auto same = [](const Real& x, const Real& y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  bool all = same(a.lift_m, b.lift_m) && same(a.velocity_m_s, b.velocity_m_s);
  if constexpr (A::theoretical_lift && B::theoretical_lift)
    all = all && same(a.theoretical_lift_m, b.theoretical_lift_m);
  if constexpr (A::valve_acceleration && B::valve_acceleration)
    all = all && same(a.acceleration_m_s2, b.acceleration_m_s2);
  return all;
}

template <class Real>
class ValveGroups : public ::testing::Test {
 protected:
  template <class Base>
  void all_move_alike(const EngineDefinition& definition) {
    Random random;
    int moving = 0;
    for (const double tick_s : {20e-6, 250e-6, 2e-3}) {
      Rig<Real, Asked<Base, false, false>> plain(definition, tick_s);
      Rig<Real, Asked<Base, true, false, true>> forces(definition, tick_s);
      Rig<Real, Asked<Base, false, true>> results(definition, tick_s);
      Rig<Real, Asked<Base, true, true, true, true>> both(definition, tick_s);
      Rig<Real, Asked<Base, false, false, false, true>> acceleration(definition, tick_s);
      const double limit_deg =
          static_cast<double>(plain.tables->tables().drive->speed_limit_rad_s) * tick_s * 180 / support::kPi;
      double deg_per_tick = 0;
      double pressure_Pa = 1e5;
      Phase crank;
      for (int tick = 0; tick < 6000; ++tick) {
        if (tick % 500 == 0) deg_per_tick = random.between(-1, 1) * limit_deg * (random.coin() ? 1 : 0.05);
        crank += Phase{static_cast<std::uint64_t>(static_cast<std::int64_t>(deg_per_tick / 720 * 0x1p64))};
        if (random.whole(0, 299) == 0) crank = Phase{random.bits()};
        if (random.whole(0, 9) == 0) pressure_Pa = random.between(0, 8e5);
        const auto& a = plain.step(crank, pressure_Pa);
        const auto& b = forces.step(crank, pressure_Pa);
        const auto& c = results.step(crank, pressure_Pa);
        const auto& d = both.step(crank, pressure_Pa);
        const auto& e = acceleration.step(crank, pressure_Pa);
        ASSERT_TRUE(a.faults == b.faults && a.faults == c.faults && a.faults == d.faults && a.faults == e.faults);
        for (int t = 0; t < 2; ++t) {
          for (int k = 0; k < 4; ++k) {
            ASSERT_TRUE(same_motion(a.valve[t][k], d.valve[t][k]) && same_motion(b.valve[t][k], d.valve[t][k]) &&
                        same_motion(c.valve[t][k], d.valve[t][k]) && same_motion(e.valve[t][k], d.valve[t][k]))
                << random.trace(tick) << ", tick of " << tick_s * 1e6 << " us, train " << t << ", cylinder " << k
                << ": " << a.valve[t][k].lift_m;
            // All members: in double there is padding behind the last.
            constexpr std::size_t kMembers = offsetof(ValveForcesOutput<Real>, regime) + sizeof(std::uint32_t);
            ASSERT_EQ(std::memcmp(&b.valve_forces[t][k], &d.valve_forces[t][k], kMembers), 0) << random.trace(tick);
            ASSERT_EQ(std::memcmp(&c.valve_cycle[t][k], &d.valve_cycle[t][k], sizeof c.valve_cycle[t][k]), 0)
                << random.trace(tick);
            moving += a.valve[t][k].lift_m > static_cast<Real>(1e-4) ? 1 : 0;
          }
        }
      }
    }
    EXPECT_GT(moving, 5000) << "or nothing happened";
  }
};
TYPED_TEST_SUITE(ValveGroups, BothReals, RealName);

TYPED_TEST(ValveGroups, ChangeNoBitOfTheMotion) { this->template all_move_alike<Airless>(four_with_valves()); }

TYPED_TEST(ValveGroups, ChangeNoBitOfTheMotionUnderGas) {
  EngineDefinition engine = four_with_valves();
  for (int t = 0; t < 2; ++t) engine.trains[t].valve.head_area_m2 = 6e-4;
  this->template all_move_alike<MeasuredFourWithValves>(engine);
}

/// Also of valves at rest, which a tick leaves alone: their cams pass all the same.
TYPED_TEST(ValveGroups, ForcesAreThoseOfWhereValveAndCamStand) {
  using S = Asked<Airless, true, false>;
  Rig<TypeParam, S> rig(four_with_valves(), 50e-6);
  constexpr int kCycles = 7;
  constexpr int kTicks = kCycles * 424;  // of 1.7 deg
  int away = 0;
  int openings[2][4] = {};
  bool was_open[2][4] = {};
  Phase crank;
  for (int tick = 0; tick < kTicks; ++tick, crank += Phase::from_cycles(1.0 / 424)) {
    const auto& out = rig.step(crank, 0);
    ASSERT_EQ(out.faults, 0u);
    for (std::uint32_t t = 0; t < 2; ++t) {
      const auto& curve = rig.tables->tables().lift_curves[t];
      for (std::uint32_t k = 0; k < 4; ++k) {
        const auto& f = out.valve_forces[t][k];
        const auto cell = curve.cell(detail::cam_phase(rig.engine.state(), t), k);
        ASSERT_EQ(f.train_compression_m, curve.read(cell).lift_m - out.valve[t][k].lift_m) << t << k << ' ' << tick;
        ASSERT_EQ(f.cam_N > 0, f.train_N > 0) << t << k << ' ' << tick;
        away += cell.degree >= curve.segments ? 1 : 0;
        const bool open = out.valve[t][k].lift_m > static_cast<TypeParam>(1e-3);
        openings[t][k] += open && !was_open[t][k] ? 1 : 0;
        was_open[t][k] = open;
      }
    }
  }
  EXPECT_GT(away, 3000);
  for (const auto& train : openings) {
    for (const int times : train)
      EXPECT_NEAR(times, kCycles, 1) << "once in a cycle, but where the run begins and ends";
  }
}

}  // namespace
}  // namespace crankloop::valve_groups_test

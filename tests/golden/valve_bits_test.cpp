// The same bits everywhere: the tables of two elastic valves and their motion at several speeds have one hash each,
// whatever compiler, optimisation or machine built them, as long as it does not fuse multiply and add
// (-ffp-contract=off).
//
// A changed hash means that every user's valves change: renew it (support/golden.hpp), which says so in the CHANGELOG.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>

#include "support/golden.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"

namespace crankloop::valve_bits_test {

using namespace detail;
namespace {

using namespace tick_test;

/// FNV-1a over the bytes of numbers, least significant first.
class Fnv {
 public:
  void add(std::uint32_t x) { mix(x, 4); }
  void add(std::uint64_t x) { mix(x, 8); }
  void add(float x) {
    std::uint32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    add(bits);
  }
  void add(double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    add(bits);
  }
  template <class Real>
  void add(const StepRow<Real>& r) {
    for (const Real x : {r.rest, r.gas, r.gas_rise, r.gap, r.rise, r.from, r.to, r.lift, r.velocity}) add(x);
  }
  template <class Real>
  void add(const RegimeStep<Real>& s) {
    add(s.lift);
    add(s.velocity);
    const ForceRow<Real>& a = s.acceleration;
    for (const Real x : {a.rest, a.gas, a.lift, a.velocity, a.gap, a.gap_speed, s.train.sign, s.train.lag_s,
                         s.train.least_m, s.seat.sign, s.seat.lag_s, s.seat.least_m, s.rest_m, s.rest_m_s}) {
      add(x);
    }
    for (const Real x : {s.middle.lift, s.middle.velocity}) add(x);
  }
  template <class Real>
  void add(const RegimeSeries<Real>& s) {
    for (const Real x : {s.rest, s.gas, s.stiffness, s.damping, s.lift, s.lift_speed}) add(x);
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  void mix(std::uint64_t x, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      hash_ ^= (x >> (8 * i)) & 0xFFu;
      hash_ *= 0x100000001B3u;
    }
  }
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

/// Intake by the 125's rocker, exhaust by a direct train with a head area: every term counts. Numbers as literals, no
/// arithmetic before tabulate.
EngineDefinition two_trains() {
  EngineDefinition engine = single_495();
  engine.masses.rod_inertia_correction_kg_m2 = 0;
  engine.train_count = 2;
  for (int t = 0; t < 2; ++t) {
    ValveTrain& train = engine.trains[t];
    train.cam.max_lift_m = 6.301099e-3;
    train.cam.half_angle_deg = 74;
    train.cam.exponent_count = 4;
    const double exponents[] = {2, 10, 18, 26};
    for (int i = 0; i < 4; ++i) train.cam.exponents[i] = exponents[i];
    train.rocker = support::ohc_125_rocker();
    train.valve.valve_kg = 0.033;
    train.valve.spring_kg = 0.06;
    train.valve.rocker_inertia_kg_m2 = 8.12e-6;
    train.valve.spring_N_m = 40e3;
    train.valve.spring_preload_N = 205.8;
    train.valve.train_N_m = 1.176e7;
    train.valve.train_damping_ratio = 0.10;
    train.valve.guide_damping_ratio = 0.003;
    train.valve.seat_N_m = 1e8;
    train.valve.seat_damping_ratio = 0.10;
  }
  engine.trains[0].cam.full_lift_deg = 450;
  engine.trains[0].cam.phase_rate_deg_s = 250;
  engine.trains[1].cam.full_lift_deg = 250;
  engine.trains[1].rocker = Rocker{};
  engine.trains[1].rocker.kind = RockerKind::ratio;
  engine.trains[1].rocker.base_circle_m = 0.018;
  engine.trains[1].rocker.clearance_m = 0.125e-3;
  engine.trains[1].rocker.ratio = 1.25;
  engine.trains[1].valve.rocker_inertia_kg_m2 = 0;
  engine.trains[1].valve.head_area_m2 = 6e-4;
  return engine;
}

template <class Real>
std::uint64_t hash_of_tables(const Tables<Real, TwoValves>& tables) {
  Fnv fnv;
  for (int t = 0; t < 2; ++t) {
    const LiftCurve<Real>& curve = tables.lift_curves[t];
    fnv.add(curve.opens[0]);
    fnv.add(curve.most_phase_per_tick);
    fnv.add(curve.segments);
    fnv.add(curve.touch_from);
    fnv.add(curve.touch_degrees);
    fnv.add(curve.skip_deg);
    fnv.add(curve.outside_m);
    for (std::uint32_t i = 0; i < curve.segments; ++i) {
      for (const Real x : curve.at[i].c) fnv.add(x);
      for (const Real x : curve.rocker_ratio[i].c) fnv.add(x);
    }
    const ValveMotion<Real>& m = tables.valve_motions[t];
    const ValveBody<Real>& b = m.body;
    for (const Real x :
         {b.mass_kg,      b.train_N_m, b.train_Ns_m,         b.seat_N_m,        b.seat_Ns_m,      b.spring_N_m,
          b.guide_Ns_m,   b.preload_N, b.seat_compression_m, b.head_area_m2,    b.rocker_mass_kg, m.tick_s,
          m.fine_step_s,  m.per_parts, m.cubic_deg,          m.widest_step_deg, m.train_lag_s,    m.seat_lag_s,
          m.per_seat_N_m, m.quiet_m,   m.per_seat_rate_s}) {
      fnv.add(x);
    }
    fnv.add(m.parts);
    fnv.add(m.event_budget);
    for (const RegimeStep<Real>& step : m.whole) fnv.add(step);
    for (const RegimeStep<Real>& step : m.fine) fnv.add(step);
    for (const RegimeSeries<Real>& series : m.series) fnv.add(series);
  }
  return fnv.value();
}

/// Up to 1408 rad/s (13 400 rpm, float and bounce), down through standstill, backwards; the intake's phase moves.
/// Speeds are binary fractions.
template <class Real>
std::uint64_t hash_of_run(const Tables<Real, TwoValves>& tables) {
  auto engine = std::make_unique<Engine<Real, TwoValves>>();
  EXPECT_TRUE(accepted(engine->init(tables, Phase{0x1234'5678'9ABC'DEF0u})));
  Fnv fnv;
  for (int tick = 0; tick < 6000; ++tick) {
    typename Engine<Real, TwoValves>::Input in;
    const int up = tick < 2816 ? tick : 5632 - tick;
    in.speed_rad_s = static_cast<Real>(up) * static_cast<Real>(0.5);
    in.cam_phase_deg[0] = tick / 1000 % 2 == 0 ? Real{0} : Real{-20};
    const auto& out = engine->step(in);
    for (int t = 0; t < 2; ++t) {
      const ValveMotionOutput<Real, TwoValves>& v = out.valve[t][0];
      const ValveForcesOutput<Real>& f = out.valve_forces[t][0];
      for (const Real x : {v.theoretical_lift_m, v.lift_m, v.velocity_m_s, v.acceleration_m_s2, f.train_N, f.seat_N,
                           f.tip_N, f.cam_N, f.train_compression_m})
        fnv.add(x);
      fnv.add(f.regime);
      const ValveCycle<Real>& c = out.valve_cycle[t][0];
      for (const Real x : {c.largest_lift_m, c.largest_speed_m_s, c.largest_acceleration_m_s2, c.opening_delay_deg,
                           c.separation_clearance_m, c.separation_start_deg, c.separation_duration_deg,
                           c.seating_speed_m_s, c.bounce_height_m}) {
        fnv.add(x);
      }
      for (const std::uint32_t x : {c.separations, c.bounces, c.contact_changes, c.off_seat_at_end}) fnv.add(x);
    }
    fnv.add(out.faults);
  }
  return fnv.value();
}

template <class Real>
class ValveBits : public ::testing::Test {};
TYPED_TEST_SUITE(ValveBits, BothReals, RealName);

TYPED_TEST(ValveBits, OfTablesAndASweepOfSpeedsAreTheCommittedOnes) {
  using Real = TypeParam;
  std::string hashes;
  for (const Integrator integrator : {Integrator::rk4, Integrator::exponential}) {
    auto storage = std::make_unique<TableStorage<Real, TwoValves>>();
    ASSERT_TRUE(accepted(storage->build(two_trains(), {50e-6, {integrator}})));
    hashes += std::string(integrator == Integrator::rk4 ? "rk4" : "exponential") + " tables " +
              support::hex(hash_of_tables<Real>(storage->tables())) + " run " +
              support::hex(hash_of_run<Real>(storage->tables())) + "\n";
  }
  support::expect_golden(sizeof(Real) == 4 ? "two_valves_float" : "two_valves_double", hashes);
}

TYPED_TEST(ValveBits, OfASnapshotGoOnWithTheSameBits) {
  using Real = TypeParam;
  auto storage = std::make_unique<TableStorage<Real, TwoValves>>();
  ASSERT_TRUE(accepted(storage->build(two_trains(), {100e-6, {}})));
  auto one = std::make_unique<Engine<Real, TwoValves>>();
  auto other = std::make_unique<Engine<Real, TwoValves>>();
  ASSERT_TRUE(accepted(one->init(storage->tables())));
  ASSERT_TRUE(accepted(other->init(storage->tables())));
  typename Engine<Real, TwoValves>::Input in;
  in.speed_rad_s = Real{1300};
  for (int tick = 0; tick < 3000; ++tick) {
    one->step(in);
    if (tick % 100 == 37) {  // in the middle of anything
      ASSERT_TRUE(accepted(other->restore(one->state())));
    } else if (tick > 37) {
      other->step(in);
      ASSERT_EQ(std::memcmp(one->output().valve, other->output().valve, sizeof one->output().valve), 0)
          << "tick " << tick;
      ASSERT_EQ(std::memcmp(&one->state(), &other->state(), sizeof one->state()), 0) << "tick " << tick;
    }
  }
}

}  // namespace
}  // namespace crankloop::valve_bits_test

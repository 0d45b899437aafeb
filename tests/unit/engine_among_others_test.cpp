// An engine and others: snapshots, engines side by side, cylinders as if each were alone, tables of a scene alone.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "support/kept_engines.hpp"
#include "support/output_numbers.hpp"
#include "support/status.hpp"
#include "support/tick_oracle.hpp"

namespace crankloop::engine_among_others_test {

using namespace detail;
namespace {

using namespace tick_test;

template <class Real>
class EngineAmongOthers : public DieselEngine<Real> {};
TYPED_TEST_SUITE(EngineAmongOthers, BothReals, RealName);

template <class Real, class S>
void expect_snapshot_to_go_on_with_the_same_bits(const FullTables<Real>& tables) {
  Running<Real, S> run(tables, phase_at_deg(5));
  for (int tick = 0; tick < 333; ++tick) run.engine.step(drive_of<Real, S>(tick));
  const auto snapshot = run.engine.state();  // assignment is all it takes
  std::vector<std::vector<Real>> first;
  for (int tick = 333; tick < 700; ++tick) first.push_back(all_numbers<Real>(run.engine.step(drive_of<Real, S>(tick))));

  const std::vector<Real> last = all_numbers<Real>(run.engine.output());
  ASSERT_TRUE(accepted(run.engine.restore(snapshot)));
  EXPECT_TRUE(same_bits(all_numbers<Real>(run.engine.output()), last));  // until the next step
  Running<Real, S> fresh(tables, phase_at_deg(300));
  ASSERT_TRUE(accepted(fresh.engine.restore(snapshot)));
  Engine<Real, S> copy = run.engine;
  for (int tick = 333; tick < 700; ++tick) {
    const auto in = drive_of<Real, S>(tick);
    const std::vector<Real>& want = first[static_cast<std::size_t>(tick - 333)];
    ASSERT_TRUE(same_bits(all_numbers<Real>(run.engine.step(in)), want)) << "same engine, tick " << tick;
    ASSERT_TRUE(same_bits(all_numbers<Real>(fresh.engine.step(in)), want)) << "other engine, tick " << tick;
    ASSERT_TRUE(same_bits(all_numbers<Real>(copy.step(in)), want)) << "copied engine, tick " << tick;
  }
}

TYPED_TEST(EngineAmongOthers, GoesOnFromASnapshotWithTheSameBitsInTheSameAnotherOrACopiedEngine) {
  using Real = TypeParam;
  expect_snapshot_to_go_on_with_the_same_bits<Real, Everything>(this->diesel());
  expect_snapshot_to_go_on_with_the_same_bits<Real, EverythingByInput>(this->diesel());
  expect_snapshot_to_go_on_with_the_same_bits<Real, TorqueOfFour>(this->diesel());
  expect_snapshot_to_go_on_with_the_same_bits<Real, Asking<kMeanTorque, kByInput>>(this->diesel());
}

TYPED_TEST(EngineAmongOthers, RefusesASnapshotOfOtherTablesAndKeepsItsOwnState) {
  using Real = TypeParam;
  EngineDefinition heavier = diesel_495();
  heavier.masses.piston_kg = std::nextafter(heavier.masses.piston_kg, 1.0);
  EngineDefinition other_order = diesel_495();
  std::swap(other_order.layout.firing_deg[1], other_order.layout.firing_deg[2]);
  EngineDefinition more_heat = diesel_495();
  more_heat.pressure.wiebe.net_mep_Pa += 1;
  struct Case {
    const char* what;
    EngineDefinition engine;
    double tick_s;
    int gas_capacity;
  };
  for (const Case& c :
       {Case{"a heavier piston", heavier, kTick_s, kFinestGrid},
        Case{"another firing order", other_order, kTick_s, kFinestGrid},
        Case{"more heat", more_heat, kTick_s, kFinestGrid}, Case{"another tick", diesel_495(), 99e-6, kFinestGrid},
        Case{"a coarser gas grid", diesel_495(), kTick_s, 720}}) {
    FullTables<Real> tables;
    ASSERT_TRUE(accepted(tables.build(c.engine, c.tick_s, c.gas_capacity)));
    Running<Real, Everything> other(tables, phase_at_deg(100));
    Running<Real, Everything> own(this->diesel(), phase_at_deg(50));
    other.engine.step(at_speed<Engine<Real, Everything>>(100));
    const Status status = own.engine.restore(other.engine.state());
    EXPECT_EQ(status.reason, Reason::other_tables) << c.what;
    EXPECT_STREQ(status.field, "state.fingerprint") << c.what;
    EXPECT_EQ(own.engine.state().phase.units(), phase_at_deg(50).units()) << c.what;
  }
  // The same definition tabulated anew is the same tables.
  FullTables<Real> again;
  ASSERT_TRUE(accepted(again.build(diesel_495(), kTick_s)));
  Running<Real, Everything> twin(again, phase_at_deg(100));
  Running<Real, Everything> own(this->diesel());
  EXPECT_TRUE(accepted(own.engine.restore(twin.engine.state())));
}

TYPED_TEST(EngineAmongOthers, TwoEnginesSideBySideDoNotKnowOfEachOther) {
  using Real = TypeParam;
  Running<Real, Everything> alone(this->diesel());
  Running<Real, Everything> first(this->diesel());
  Running<Real, Everything> second(this->diesel(), phase_at_deg(200));
  for (int tick = 0; tick < 500; ++tick) {
    const auto in = drive_of<Real, Everything>(tick);
    const std::vector<Real> want = all_numbers<Real>(alone.engine.step(in));
    const auto& out = first.engine.step(in);
    second.engine.step(at_speed<Engine<Real, Everything>>(tick % 7 == 0 ? std::nan("") : -400.0));
    ASSERT_TRUE(same_bits(all_numbers<Real>(out), want)) << tick;
  }
}

TYPED_TEST(EngineAmongOthers, ExactlyFourAndUpToSixteenAnswerTheSameBitsAndTheUnusedPlacesStayZero) {
  using Real = TypeParam;
  Running<Real, Everything> up_to_sixteen(this->diesel(), phase_at_deg(1));
  Running<Real, EverythingOfFour> exactly_four(this->diesel(), phase_at_deg(1));
  const InUse use = in_use(this->diesel());
  for (int tick = 0; tick < 1500; ++tick) {
    const auto& wide = up_to_sixteen.engine.step(drive_of<Real, Everything>(tick));
    const auto& narrow = exactly_four.engine.step(drive_of<Real, EverythingOfFour>(tick));
    ASSERT_TRUE(same_bits(numbers<kAllGroups>(wide, use), numbers<kAllGroups>(narrow, use))) << tick;
    for (std::size_t k = 4; k < 16; ++k) {
      ASSERT_EQ(wide.displacement_m[k], Real{0});
      ASSERT_EQ(wide.cylinder[k].torque_Nm, Real{0});
      ASSERT_EQ(wide.pin_load_N[k], Real{0});
      ASSERT_EQ(wide.journal_load_N[k + 1], Real{0});
    }
  }
}

TYPED_TEST(EngineAmongOthers, CylindersAtTheSameCrankAngleShareTheirLookUps) {
  using Real = TypeParam;
  EXPECT_EQ(this->diesel().drive().mechanisms, 2u);
  const auto mechanisms = [](const std::vector<double>& firing_deg) {
    FullTables<Real> tables;
    EXPECT_TRUE(accepted(tables.build(without_gas(with_cylinders(single_495(), firing_deg)), kTick_s)));
    return tables.drive().mechanisms;
  };
  EXPECT_EQ(mechanisms({0}), 1u);
  EXPECT_EQ(mechanisms({0, 360}), 1u);  // a parallel twin
  EXPECT_EQ(mechanisms({360, 0}), 1u);
  EXPECT_EQ(mechanisms({0, 240, 480}), 3u);                          // a three
  EXPECT_EQ(mechanisms({0, 480, 240, 600, 120, 360}), 3u);           // an inline six
  EXPECT_EQ(mechanisms({0, 90, 270, 180, 630, 540, 450, 360}), 4u);  // a cross-plane V8
  EXPECT_EQ(mechanisms({0, 144, 288, 432, 576}), 5u);                // a five
  EXPECT_EQ(mechanisms(std::vector<double>(16, 15.5)), 1u);
  EXPECT_EQ(mechanisms({719.9999999999, 0}), 2u);
}

/// Each cylinder against a one-cylinder engine that stands where the cylinder stands.
template <class Real>
void expect_cylinders_as_if_alone(const EngineDefinition& engine) {
  EngineDefinition one = with_cylinders(engine, {0});
  FullTables<Real> together;
  FullTables<Real> alone;
  ASSERT_TRUE(accepted(together.build(engine, kTick_s)));
  ASSERT_TRUE(accepted(alone.build(one, kTick_s)));
  const Drive<Real>& drive = together.drive();
  Running<Real, Everything> all(together);
  std::vector<std::unique_ptr<Running<Real, Everything>>> single;
  for (std::size_t k = 0; k < drive.cylinders; ++k) {
    const Phase firing{drive.firing_phase[drive.mechanism_of[k]] +
                       (drive.turn_of[k] != 0 ? std::uint64_t{1} << 63 : 0)};
    const long double off = turned_rad(phase_at_deg(static_cast<long double>(engine.layout.firing_deg[k])), firing);
    // Angles within 1e-9 deg are one mechanism's; float keeps firing phases to the nearest 2^-32 of a cycle, 4 pi rad.
    const long double rounding_rad = sizeof(Real) == 4 ? 4 * kWidePi * 0x1p-33L : 0;
    ASSERT_LE(std::fabs(off), 2e-11L + rounding_rad) << "cylinder " << k << " fires elsewhere";
    single.push_back(std::make_unique<Running<Real, Everything>>(alone, Phase{} - firing));
  }
  const InUse one_in_use = in_use(alone);
  for (int tick = 0; tick < 1200; ++tick) {
    const auto in = drive_of<Real, Everything>(3 * tick);
    const auto& out = all.engine.step(in);
    long double torque = 0;
    long double mean = 0;
    long double size = 1;
    for (std::size_t k = 0; k < drive.cylinders; ++k) {
      const auto& own = single[k]->engine.step(in);
      ASSERT_EQ(out.displacement_m[k], own.displacement_m[0]) << "cylinder " << k << ", tick " << tick;
      ASSERT_EQ(out.velocity_m_s[k], own.velocity_m_s[0]);
      ASSERT_EQ(out.acceleration_m_s2[k], own.acceleration_m_s2[0]);
      ASSERT_EQ(out.rod_angle_rad[k], own.rod_angle_rad[0]);
      ASSERT_EQ(out.rod_speed_rad_s[k], own.rod_speed_rad_s[0]);
      ASSERT_EQ(out.rod_acceleration_rad_s2[k], own.rod_acceleration_rad_s2[0]);
      const auto forces = numbers<kForces>(own, one_in_use);
      std::vector<Real> in_company = numbers<kForces>(out, InUse{drive.cylinders, 0});
      ASSERT_EQ(std::memcmp(in_company.data() + 10 * k, forces.data(), 10 * sizeof(Real)), 0)
          << "cylinder " << k << ", tick " << tick;
      torque += static_cast<long double>(own.torque_Nm);
      mean += static_cast<long double>(own.mean_torque_Nm);
      size += std::fabs(static_cast<long double>(own.torque_Nm));
    }
    const double rounding = static_cast<double>(size) * 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());
    ASSERT_NEAR(static_cast<double>(out.torque_Nm), static_cast<double>(torque), rounding) << tick;
    // The first tick's mean is a trapezoid where it crawls; later it is a difference of work, right to 1e-6 or 1e-10 of
    // the torques. The engine's torque curve is fitted by itself, within 1e-5 of 5 kNm as each cylinder's is: the bound
    // holds for the middle of a degree and for the diagram's worst, most are far within.
    ASSERT_NEAR(static_cast<double>(out.mean_torque_Nm), static_cast<double>(mean),
                static_cast<double>(size) * (sizeof(Real) == 4 ? 3e-6 : 1e-10) + 0.02)
        << tick;
  }
}

TYPED_TEST(EngineAmongOthers, EveryCylinderAnswersAsIfItWereAlone) {
  using Real = TypeParam;
  expect_cylinders_as_if_alone<Real>(diesel_495());
  expect_cylinders_as_if_alone<Real>(uneven_v4());
  expect_cylinders_as_if_alone<Real>(with_cylinders(single_495(), {0, 480, 240, 600, 120, 360}));
  expect_cylinders_as_if_alone<Real>(with_cylinders(single_495(), {3.7, 719.99, 360.3, 0.3, 363.7, 100}));
}

TYPED_TEST(EngineAmongOthers, TablesBuiltForASceneAloneAnswerTheSameBitsAsAllSections) {
  using Real = TypeParam;
  static TableStorage<Real, EverythingOfFour, 14'400> storage;
  ASSERT_TRUE(accepted(storage.build(diesel_495(), {kTick_s})));
  Engine<Real, EverythingOfFour> engine;
  ASSERT_TRUE(accepted(engine.init(storage.tables())));
  Running<Real, EverythingOfFour> full(this->diesel());
  for (int tick = 0; tick < 500; ++tick) {
    const auto in = drive_of<Real, EverythingOfFour>(tick);
    ASSERT_TRUE(same_bits(all_numbers<Real>(engine.step(in)), all_numbers<Real>(full.engine.step(in)))) << tick;
  }
  EngineDefinition bad = diesel_495();
  bad.crank.rod_length_m = 0.01;
  EXPECT_EQ(storage.build(bad, {kTick_s}).reason, Reason::rod_too_short);
  EXPECT_EQ(engine.init(storage.tables()).reason, Reason::missing_table);
  EXPECT_EQ(engine.step({}).faults, kFaultNotReady);
}

}  // namespace
}  // namespace crankloop::engine_among_others_test

// What cams bear: stress, sliding and rolling where they touch their followers, and torque. Against the exact geometry
// and Hertz's formula, and against the work that a converged reference of the valve does and loses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/scenes.hpp>
#include <crankloop/tabulate/cam_contact.hpp>
#include <crankloop/tick/state/saved_state.hpp>

#include "support/both_reals.hpp"
#include "support/test_valves.hpp"

namespace crankloop::cam_loads_test {
namespace {

using namespace valve_test;
using support::direct_rocker;
using support::ohc_125_rocker;
using support::polynomial_cam;
using support::refuses;
using tick_test::BothReals;
using tick_test::CamLoadsAlone;
using tick_test::RealName;
using tick_test::WithCamLoads;

constexpr double kWidth_m = 9e-3;
constexpr double kFriction = 0.08;

EngineDefinition loaded_engine(const ValveTrain& train = ohc_125_train(), double friction_ratio = kFriction) {
  EngineDefinition engine = engine_with(train);
  engine.contacts[0].width_m = kWidth_m;
  engine.contacts[0].friction_ratio = friction_ratio;
  engine.contacts[0].follower_Pa = 180e9;
  return engine;
}

/// The 125's valve as if a flat follower lifted it.
ValveTrain flat_train() {
  ValveTrain train = ohc_125_train();
  train.rocker = direct_rocker(25e-3, 0.05e-3, 1.2);
  train.valve.rocker_inertia_kg_m2 = 0;
  train.valve.valve_kg += 0.03;
  return train;
}

// ---- at a tick ----

template <class Real>
class CamLoads : public ::testing::Test {
 protected:
  static constexpr double kExact = sizeof(Real) == 4 ? 1e-4 : 1e-5;

  /// Every tick of two cycles, either way.
  static void follow_geometry_and_hertz(const ValveTrain& train, double rpm) {
    const EngineDefinition engine = loaded_engine(train);
    Rig<Real, WithCamLoads<>> rig(engine, {50e-6, {}}, 90);
    const ValveLift lift = lift_of(train);
    const double speed = rad_s_of_rpm(rpm);
    const double sense = rpm < 0 ? -1 : 1;
    int in_contact = 0;
    for (int i = 0; i < 2 * rig.ticks_per_cycle(speed); ++i) {
      const auto& out = rig.step(speed);
      const auto& contact = out.cam_contact[0][0];
      const auto& torque = out.cam_torque[0][0];
      const auto force_N = static_cast<double>(out.valve_forces[0][0].train_N);
      ASSERT_EQ(out.camshaft_Nm, torque.torque_Nm);
      if (force_N == 0) {
        ASSERT_TRUE(contact.stress_Pa == 0 && contact.half_width_m == 0 && contact.sliding_m_s == 0 &&
                    contact.entrainment_m_s == 0 && torque.torque_Nm == 0 && torque.friction_Nm == 0);
        continue;
      }
      ++in_contact;
      const double rad = rig.cam_deg() * kRadPerDeg;
      const ContactPose at = lift.contact_at(rad);
      const LiftPose pose = lift.at(rad);
      const double cam_N = force_N * pose.rocker_ratio;
      const HertzContact hertz = hertz_contact(engine.contacts[0], at.curvature_per_m, cam_N);
      const double r_0 = train.rocker.base_circle_m;
      const auto near = [&](Real is, double wanted, double size, const char* of) {
        EXPECT_NEAR(static_cast<double>(is), wanted, kExact * size) << of << " at " << rig.cam_deg() << " deg";
      };
      near(contact.stress_Pa, hertz.largest_Pa, hertz.largest_Pa, "stress");
      near(contact.half_width_m, hertz.half_width_m, hertz.half_width_m, "half width");
      near(contact.sliding_m_s, at.sliding_m * speed / 2, r_0 * std::fabs(speed) / 2, "sliding");
      near(contact.entrainment_m_s, at.entrainment_m * speed / 2, r_0 * std::fabs(speed) / 2, "entrainment");
      near(torque.friction_Nm, sense * kFriction * cam_N * std::fabs(at.sliding_m), kFriction * cam_N * r_0,
           "friction");
      near(torque.torque_Nm - torque.friction_Nm, force_N * pose.per_rad_m, force_N * 0.015, "torque");
    }
    EXPECT_GT(in_contact, 50) << "or nothing happened";
  }
};
TYPED_TEST_SUITE(CamLoads, BothReals, RealName);

TYPED_TEST(CamLoads, AreThoseOfTheExactContactInEveryTick) {
  this->follow_geometry_and_hertz(ohc_125_train(), 5000);
  this->follow_geometry_and_hertz(ohc_125_train(), -3000);
  ValveTrain away = ohc_125_train();
  away.rocker = ohc_125_rocker(CamTurns::away_from_pivot);
  this->follow_geometry_and_hertz(away, 4000);
  this->follow_geometry_and_hertz(flat_train(), 3000);
}

/// Without forces and results asked for, from the valve's state: the same bits.
TYPED_TEST(CamLoads, DoNotDependOnWhatElseIsAskedFor) {
  Rig<TypeParam, WithCamLoads<>> all(loaded_engine(), {50e-6, {}}, 90);
  Rig<TypeParam, CamLoadsAlone<OneValve>> alone(loaded_engine(), {50e-6, {}}, 90);
  Rig<TypeParam, OneValve> plain(loaded_engine(), {50e-6, {}}, 90);
  for (int i = 0; i < 3000; ++i) {
    const double speed = rad_s_of_rpm(i < 1500 ? 9000 : -4000);
    const auto& a = all.step(speed);
    const auto& b = alone.step(speed);
    const auto& c = plain.step(speed);
    ASSERT_EQ(std::memcmp(a.cam_contact, b.cam_contact, sizeof a.cam_contact), 0) << i;
    ASSERT_EQ(std::memcmp(a.cam_contact_cycle, b.cam_contact_cycle, sizeof a.cam_contact_cycle), 0) << i;
    ASSERT_EQ(std::memcmp(a.cam_torque, b.cam_torque, sizeof a.cam_torque), 0) << i;
    ASSERT_EQ(a.camshaft_Nm, b.camshaft_Nm);
    ASSERT_TRUE(a.valve[0][0].lift_m == b.valve[0][0].lift_m && a.valve[0][0].lift_m == c.valve[0][0].lift_m);
    ASSERT_EQ(std::memcmp(a.valve_cycle, c.valve_cycle, sizeof a.valve_cycle), 0) << i;
  }
}

TYPED_TEST(CamLoads, OfACycleAreTheLargestOfItsTicks) {
  Rig<TypeParam, CamLoadsAlone<OneValve>> rig(loaded_engine(), {50e-6, {}}, 90);
  const double opens_deg = lift_of(ohc_125_train()).opens_rad() / kRadPerDeg;
  TypeParam largest_Pa = 0, largest_of_last_Pa = 0;
  double at_deg = 0, at_of_last_deg = 0;
  int cycles = 0;
  for (int i = 0; i < 3000; ++i) {
    const TypeParam before_Pa = rig.engine().output().cam_contact_cycle[0][0].largest_Pa;
    const auto& out = rig.step(rad_s_of_rpm(6000 + i));
    if (out.cam_contact_cycle[0][0].largest_Pa != before_Pa) {
      ++cycles;
      largest_of_last_Pa = largest_Pa, at_of_last_deg = at_deg;
      largest_Pa = 0;
    }
    if (out.cam_contact[0][0].stress_Pa > largest_Pa)
      largest_Pa = out.cam_contact[0][0].stress_Pa, at_deg = rig.cam_deg() - opens_deg;
    ASSERT_EQ(out.cam_contact_cycle[0][0].largest_Pa, largest_of_last_Pa) << i;
    ASSERT_NEAR(static_cast<double>(out.cam_contact_cycle[0][0].largest_deg), at_of_last_deg, 1e-4) << i;
  }
  EXPECT_GE(cycles, 5);
}

TYPED_TEST(CamLoads, OfTheCamshaftAreThoseOfAllCylindersAndAlikeValves) {
  EngineDefinition engine = tick_test::with_cylinders(loaded_engine(), {0, 540, 180, 360});
  engine.train_count = 2;
  engine.trains[1] = engine.trains[0];
  engine.trains[1].cam.full_lift_deg = 250;
  engine.trains[0].valve.per_cylinder = 2;
  engine.contacts[1].width_m = 5e-3;  // without friction
  Rig<TypeParam, WithCamLoads<tick_test::Elastic<4, 2>>> rig(engine, {50e-6, {}}, 17);
  Rig<TypeParam, WithCamLoads<>> one(loaded_engine(), {50e-6, {}}, 17);
  double most_Nm = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto& out = rig.step(rad_s_of_rpm(4000));
    const auto& of_one = one.step(rad_s_of_rpm(4000));
    double sum_Nm = 0;
    for (int t = 0; t < 2; ++t) {
      for (int k = 0; k < 4; ++k) {
        sum_Nm += (t == 0 ? 2 : 1) * static_cast<double>(out.cam_torque[t][k].torque_Nm);
        EXPECT_TRUE(t == 0 || out.cam_torque[t][k].friction_Nm == 0);
      }
    }
    EXPECT_NEAR(static_cast<double>(out.camshaft_Nm), sum_Nm, 1e-5);
    EXPECT_EQ(out.cam_torque[0][0].torque_Nm, of_one.cam_torque[0][0].torque_Nm) << i;
    most_Nm = std::max(most_Nm, std::fabs(sum_Nm));
  }
  EXPECT_GT(most_Nm, 5);
}

TYPED_TEST(CamLoads, GoOnFromASavedState) {
  using S = CamLoadsAlone<OneValve>;
  Rig<TypeParam, S> rig(loaded_engine(), {50e-6, {}}, 90);
  Rig<TypeParam, S> other(loaded_engine(), {50e-6, {}}, 90);
  for (int i = 0; i < 700; ++i) rig.step(rad_s_of_rpm(7000));
  unsigned char bytes[kSavedStateBytes<TypeParam, S>];
  ASSERT_TRUE(accepted(save_state(rig.engine(), bytes, sizeof bytes)));
  ASSERT_TRUE(accepted(load_state(bytes, sizeof bytes, other.engine())));
  for (int i = 0; i < 700; ++i) {
    const auto& a = rig.step(rad_s_of_rpm(7000));
    const auto& b = other.step(rad_s_of_rpm(7000));
    ASSERT_EQ(std::memcmp(a.cam_contact, b.cam_contact, sizeof a.cam_contact), 0) << i;
    ASSERT_EQ(a.camshaft_Nm, b.camshaft_Nm) << i;
  }
  EXPECT_EQ(rig.engine().output().cam_contact_cycle[0][0].largest_Pa,
            other.engine().output().cam_contact_cycle[0][0].largest_Pa);
}

/// Where a curve's fit falls below 0, or the force that it takes, there is no stress and no width, and the largest of
/// the cycle is that of the other ticks.
TYPED_TEST(CamLoads, AreNoneWhereACurveOfTheContactIsNegative) {
  using S = WithCamLoads<>;
  using Curve = detail::CamContactSegment<TypeParam>;
  using Ratio = detail::Segment<TypeParam>;
  for (const bool by_ratio : {false, true}) {
    const auto storage = std::make_unique<TableStorage<TypeParam, S>>();
    ASSERT_TRUE(accepted(storage->build(loaded_engine(), {50e-6, {}})));
    Tables<TypeParam, S> tables = storage->tables();
    detail::CamContactCurve<TypeParam> contact = tables.cam_contacts[0];
    detail::LiftCurve<TypeParam> lift = tables.lift_curves[0];
    const std::uint32_t rows = lift.rows();
    const auto is_bad = [rows](std::uint32_t row) { return row < rows / 2; };  // the opening flank and full lift
    std::vector<Curve> stress(contact.at, contact.at + rows);
    std::vector<Ratio> ratio(lift.rocker_ratio, lift.rocker_ratio + rows);
    for (std::uint32_t row = 0; row < rows; ++row) {
      if (!is_bad(row)) continue;
      for (TypeParam& c : by_ratio ? ratio[row].c : stress[row].stress.c) c = -c;
    }
    contact.at = stress.data(), lift.rocker_ratio = ratio.data();
    tables.cam_contacts = &contact, tables.lift_curves = &lift;
    Engine<TypeParam, S> engine;
    ASSERT_TRUE(accepted(engine.init(tables, phase_at(90))));
    Rig<TypeParam, S> sound(loaded_engine(), {50e-6, {}}, 90);
    const double speed = rad_s_of_rpm(5000);
    typename Engine<TypeParam, S>::Input in;
    in.speed_rad_s = static_cast<TypeParam>(speed);
    int none = 0, same = 0;
    TypeParam largest_Pa = 0;
    for (int i = 0; i < 2 * sound.ticks_per_cycle(speed); ++i) {
      const auto& out = engine.step(in);
      const auto &is = out.cam_contact[0][0], &was = sound.step(speed).cam_contact[0][0];
      ASSERT_EQ(is.sliding_m_s, was.sliding_m_s) << i;
      ASSERT_EQ(is.entrainment_m_s, was.entrainment_m_s) << i;
      if (was.stress_Pa == 0 || is_bad(lift.cell(engine.state().phase.units(), 0).degree)) {
        none += was.stress_Pa == 0 ? 0 : 1;
        ASSERT_EQ(is.stress_Pa, 0) << i;
        ASSERT_EQ(is.half_width_m, 0) << i;
      } else {
        ++same;
        ASSERT_EQ(is.stress_Pa, was.stress_Pa) << i;
        ASSERT_EQ(is.half_width_m, was.half_width_m) << i;
        largest_Pa = std::max(largest_Pa, is.stress_Pa);
      }
    }
    EXPECT_GT(none, 50);
    EXPECT_GT(same, 50);
    EXPECT_EQ(engine.output().cam_contact_cycle[0][0].largest_Pa, largest_Pa);
  }
}

/// A lobe as long as the cam's turn leaves no row for a base circle.
TYPED_TEST(CamLoads, OfALobeOfTheWholeTurnAreThoseOfTheExactContact) {
  ValveTrain train = flat_train();
  train.cam = polynomial_cam(8e-3, 180, {2, 4, 6, 8});
  train.cam.full_lift_deg = 450;
  this->follow_geometry_and_hertz(train, 3000);
}

TEST(CamContactScene, IsRefusedATrainWithoutAWidth) {
  EngineDefinition engine = loaded_engine();
  engine.contacts[0].width_m = 0;
  using S = CamLoadsAlone<OneValve>;
  const auto storage = std::make_unique<TableStorage<float, S>>();
  ASSERT_TRUE(accepted(storage->build(engine, {50e-6, {}})));
  Engine<float, S> refused;
  EXPECT_TRUE(refuses(refused.init(storage->tables()), Reason::not_positive, "cam.width_m", 0));
}

// ---- the work of a cycle ----

struct CamTorqueAlone : Scene {
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr bool cam_torque = true;
};

/// A cycle of the reference from the middle of the base circle to the next, and of the tick beside it.
struct CycleOfWork {
  double cam_J = 0, lost_J = 0, gained_J = 0;
  double largest_J = 0;   ///< of the cam so far in the cycle
  double of_ticks_J = 0;  ///< camshaft torque of the ticks times the angle
};

CycleOfWork work_of(const ValveTrain& train, double rpm, double tick_s, int settling) {
  SideBySide<double, CamTorqueAlone> both(train, {tick_s, {}}, 90);
  const double speed = rad_s_of_rpm(rpm);
  const int ticks = static_cast<int>(std::lround(4 * kPi / speed / tick_s));
  for (int i = 0; i < settling * ticks; ++i) both.step(speed);
  const double cam_J = both.reference.cam_J, lost_J = both.reference.lost_J;
  const double before_J = both.reference.energy_J(both.rig.cam_deg());
  CycleOfWork work;
  for (int i = 0; i < ticks; ++i) {
    both.step(speed);
    work.of_ticks_J += both.rig.engine().output().camshaft_Nm * speed / 2 * tick_s;
    work.largest_J = std::max(work.largest_J, std::fabs(both.reference.cam_J - cam_J));
  }
  work.cam_J = both.reference.cam_J - cam_J;
  work.lost_J = both.reference.lost_J - lost_J;
  work.gained_J = both.reference.energy_J(both.rig.cam_deg()) - before_J;
  return work;
}

TEST(CamshaftTorque, DoesTheWorkThatTrainGuideAndSeatLose) {
  for (const double rpm : {2000.0, 6000.0, 9000.0}) {
    const CycleOfWork work = work_of(ohc_125_train(), rpm, 20e-6, 2);
    std::printf("[ figures  ] %5.0f rpm: cam %.6f J, lost %.6f J, difference %.1e of the largest %.3f J\n", rpm,
                work.cam_J, work.lost_J, (work.cam_J - work.lost_J - work.gained_J) / work.largest_J, work.largest_J);
    EXPECT_NEAR(work.cam_J, work.lost_J + work.gained_J, 1e-9 * work.largest_J);
    EXPECT_NEAR(work.gained_J, 0, 1e-6 * work.largest_J) << "periodic";
    EXPECT_NEAR(work.cam_J, work.lost_J, 1e-6 * work.largest_J);
    EXPECT_GT(work.lost_J, 1e-4 * work.largest_J);
  }
}

TEST(CamshaftTorque, FromSamplesOnceATickDoesThatWorkToFirstOrder) {
  // Where contact begins and ends the force jumps: a jump's place within its tick is lost.
  double before = 1;
  for (const double tick_s : {80e-6, 40e-6, 20e-6, 10e-6, 5e-6}) {
    const CycleOfWork work = work_of(ohc_125_train(), 6000, tick_s, 2);
    const double off = std::fabs(work.of_ticks_J - work.lost_J) / work.largest_J;
    std::printf("[ figures  ] %4.0f us: %.2e of the largest work of a cycle\n", tick_s * 1e6, off);
    EXPECT_LT(off, 6 * tick_s);
    before = off;
  }
  EXPECT_LT(before, 1e-4);
}

TEST(CamshaftTorque, WithoutLossesStoresAllOfItsWork) {
  ValveTrain train = ohc_125_train();
  train.valve.train_damping_ratio = train.valve.guide_damping_ratio = train.valve.seat_damping_ratio = 0;
  const CycleOfWork work = work_of(train, 4000, 20e-6, 1);
  EXPECT_NEAR(work.lost_J, 0, 1e-20);
  EXPECT_NEAR(work.cam_J, work.gained_J, 1e-9 * work.largest_J);
}

TEST(CamshaftTorque, IsNoneInTheMeanWithoutLossesAndVibration) {
  // So slow that the valve follows its cam without ringing.
  ValveTrain train = ohc_125_train();
  train.valve.train_damping_ratio = train.valve.guide_damping_ratio = train.valve.seat_damping_ratio = 0;
  Rig<double, WithCamLoads<>> rig(loaded_engine(train, 0), {200e-6, {}}, 90);
  const double speed = rad_s_of_rpm(60);
  const int ticks = static_cast<int>(std::lround(4 * kPi / speed / 200e-6));
  double sum_J = 0, largest_J = 0;
  for (int i = 0; i < ticks; ++i) {
    sum_J += rig.step(speed).camshaft_Nm * speed / 2 * 200e-6;
    largest_J = std::max(largest_J, sum_J);
  }
  EXPECT_GT(largest_J, 1);
  EXPECT_NEAR(sum_J, 0, 1e-4 * largest_J);
}

// ---- the crank that turns the camshaft ----

struct Coasting : Scene {
  static constexpr CrankGiven crank = CrankGiven::torque;
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr bool torque = true;
  static constexpr bool starter = true;
  static constexpr bool cam_torque = true;
  static constexpr bool cam_drag = true;
};
struct CoastingFreely : Coasting {
  static constexpr bool cam_drag = false;
};
struct Breathing : scenes::BreathingFree {
  static constexpr bool cam_torque = true;
  static constexpr bool cam_drag = true;
};

template <class Real, class S>
struct Turned {
  explicit Turned(const EngineDefinition& definition, double tick_s, double speed_rad_s = 0, double start_deg = 90) {
    EXPECT_TRUE(accepted(tables->build(definition, {tick_s, {}})));
    EXPECT_TRUE(accepted(engine.init(tables->tables(), phase_at(start_deg))));
    if (speed_rad_s != 0) {
      EXPECT_TRUE(accepted(engine.restore(turning_at<Real, S>(engine.state(), static_cast<Real>(speed_rad_s)))));
    }
  }
  const Output<Real, S>& step() { return engine.step(in); }
  /// Of the crank and all that turns with it.
  [[nodiscard]] double kinetic_J() const {
    const auto u = static_cast<double>(engine.state().reduced_speed);
    return u * u / 2;
  }
  std::unique_ptr<TableStorage<Real, S>> tables = std::make_unique<TableStorage<Real, S>>();
  Engine<Real, S> engine;
  Input<Real, S> in{};
};

EngineDefinition coasting_engine() {
  EngineDefinition engine = loaded_engine();
  engine.masses.crank_inertia_kg_m2 = 0.5;
  return engine;
}

TEST(CamDrag, TakesFromTheCrankTheWorkOfTheCams) {
  constexpr double kTick_s = 50e-6;
  Turned<double, Coasting> run(coasting_engine(), kTick_s, rad_s_of_rpm(1500));
  Turned<double, CoastingFreely> freely(coasting_engine(), kTick_s, rad_s_of_rpm(1500));
  const double start_J = run.kinetic_J();
  double work_J = 0, largest_J = 0, before_Nm = 0;
  Phase before = run.engine.state().phase;
  for (int i = 0; i < 40000; ++i) {  // 25 cycles
    const auto& out = run.step();
    const double turned_rad = (out.crank - before).signed_cycles<double>() * 4 * kPi;
    work_J += (before_Nm + out.camshaft_Nm) / 2 * turned_rad / 2;  // the cams turn half as far
    largest_J = std::max(largest_J, std::fabs(start_J - run.kinetic_J()));
    before_Nm = out.camshaft_Nm, before = out.crank;
    freely.step();
    // What the crank still has is what the cams have not taken, but for a tick's delay.
    ASSERT_NEAR(start_J - run.kinetic_J(), work_J, 0.02) << i;
  }
  std::printf("[ figures  ] the crank lost %.4f J, the cams took %.4f J\n", start_J - run.kinetic_J(), work_J);
  EXPECT_GT(work_J, 5);
  EXPECT_NEAR(start_J - run.kinetic_J(), work_J, 2e-4 * work_J);
  EXPECT_NEAR(freely.kinetic_J(), start_J, 1e-9 * start_J);
}

/// The acceleration that is shown is that of all torques shown, the cams' as the tick before left them.
template <class Real, class S>
void accelerates_by_what_is_shown(Turned<Real, S>& run, int ticks, double tolerance) {
  double before_Nm = 0, largest_Nm = 0;
  for (int i = 0; i < ticks; ++i) {
    const auto& out = run.step();
    const auto per_root = static_cast<double>(run.engine.state().per_root_inertia);
    const double net_Nm = static_cast<double>(out.torque_Nm) + static_cast<double>(out.starter_Nm) -
                          static_cast<double>(out.friction_Nm) - before_Nm / 2;
    if (out.speed_rad_s != 0) {
      ASSERT_NEAR(static_cast<double>(out.acceleration_rad_s2), net_Nm * per_root * per_root, tolerance) << i;
    }
    before_Nm = static_cast<double>(out.camshaft_Nm);
    largest_Nm = std::max(largest_Nm, std::fabs(before_Nm));
  }
  EXPECT_GT(largest_Nm, 0.5);
}

TEST(CamDrag, IsPartOfTheAccelerationShown) {
  Turned<double, Coasting> coasting(coasting_engine(), 100e-6, rad_s_of_rpm(800));
  accelerates_by_what_is_shown(coasting, 4000, 1e-9);
  Turned<double, Breathing> breathing(support::four_2000(), 100e-6);
  breathing.in.starter = 1;
  for (double& fuel : breathing.in.fuel_kg) fuel = 15e-6;
  accelerates_by_what_is_shown(breathing, 8000, 1e-6);
}

TEST(CamDrag, OfAClosingFlankTurnsACrankThatNothingHolds) {
  // On its closing flank the spring drives the cam; with friction of the engine the crank stands.
  const double closing_deg = 450 + 2 * 30;
  Turned<double, Coasting> loose(coasting_engine(), 100e-6, 0, closing_deg);
  for (int i = 0; i < 200; ++i) loose.step();
  EXPECT_LT(loose.engine.output().camshaft_Nm, -1);
  EXPECT_GT(loose.engine.output().speed_rad_s, 0.01);
  EngineDefinition held_engine = coasting_engine();
  held_engine.friction.constant_Pa = 300e3;
  Turned<double, Coasting> held(held_engine, 100e-6, 0, closing_deg);
  for (int i = 0; i < 200; ++i) held.step();
  EXPECT_LT(held.engine.output().camshaft_Nm, -1);
  EXPECT_EQ(held.engine.output().speed_rad_s, 0);
  EXPECT_EQ(held.engine.output().acceleration_rad_s2, 0);
}

}  // namespace
}  // namespace crankloop::cam_loads_test

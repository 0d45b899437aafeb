// The equations of docs/model.md against mechanics itself: crank, rod and piston as three rigid bodies with joints
// between them (support/newton_euler.hpp).
//
// The library lumps the rod: m_rod_pin moves with the piston, m_rod_crank turns with the crank pin, and a couple dM =
// dI d2b/dt2 stands for what two masses get wrong about turning. How the two compare: a real rod's big end needs a
// force to be turned round, which the real joint carries and the lumped one does not see, so the force on the crank pin
// is the library's (K, T) with m_rod_crank r w^2 outward added, which is its "crank-pin load". The small end's share
// moves along the cylinder axis only: the wall force is the library's N as it is, and the piston pin carries P less
// m_rod_pin's part.
#include <crankloop/tabulate/summary.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/differences.hpp"
#include "support/engines.hpp"
#include "support/newton_euler.hpp"
#include "support/units.hpp"
#include "support/vector_geometry.hpp"

namespace crankloop::rigid_bodies_test {

using namespace detail;
namespace {

using support::JointForces;
using support::kEps;
using support::Motion;
using support::Random;
using support::Vec;
using support::wide;
using support::Wide;

using support::kPi;

/// One random engine at a random angle, speed and pressure, by both models.
struct Encounter {
  EngineDefinition engine;
  Motion motion;
  Wide gas_force;
  JointForces joints;
  CylinderForces<double> lumped;
  Bearings<double> bearings;
  double speed_squared;
  double force_tolerance;  ///< see below
};

Encounter random_encounter(Random& random, bool two_mass_rod) {
  support::RandomEngine made = support::random_engine(random);
  EngineDefinition& engine = made.definition;
  if (two_mass_rod) {
    // The inertia that two masses at the ends have.
    made.rod.inertia_kg_m2 =
        made.rod.mass_kg * made.rod.com_to_crank_m * (engine.crank.rod_length_m - made.rod.com_to_crank_m);
    engine.masses.rod_inertia_correction_kg_m2 = 0;
  }
  const double a = random.between(0, 4 * kPi);
  const double w = random.between(-700, 700);
  const double pressure = random.between(0.3e5, 150e5);

  Encounter e{};
  e.engine = engine;
  e.motion = support::motion_at(engine.crank, wide(a), wide(w));
  e.gas_force = (wide(pressure) - wide(engine.pressure.crankcase_Pa)) * support::kWidePi / 4 *
                wide(engine.crank.bore_m) * wide(engine.crank.bore_m);
  e.joints = support::newton_euler(engine, made.rod, e.motion, e.gas_force);
  e.lumped = cylinder_forces<true>(body_of(engine), exact_pose(engine.crank, a), pressure, w);
  e.bearings = bearings_of(engine);
  e.speed_squared = w * w;
  // Rounding: every force is a sum of a handful of products; each of them is within 16 units of the largest terms that
  // enter, which are the gas force (its pressure difference may cancel: hence p A), the masses' r w^2 and dI w^2/l,
  // times up to 1/cos^3 b < 2 for the geometry.
  const double r = engine.crank.crank_radius_m;
  const double area = kPi / 4 * engine.crank.bore_m * engine.crank.bore_m;
  const double masses = engine.masses.reciprocating_kg() + made.rod.mass_kg + engine.masses.crank_pin_equivalent_kg;
  const double inertia = std::fabs(engine.masses.rod_inertia_correction_kg_m2) + made.rod.inertia_kg_m2;
  const double largest = (pressure + engine.pressure.crankcase_Pa) * area + masses * 1.5 * r * e.speed_squared +
                         inertia * engine.crank.rod_ratio() / engine.crank.rod_length_m * e.speed_squared;
  e.force_tolerance = 16 * kEps * largest;
  return e;
}

constexpr int kDraws = 10'000;

template <class Check>
void at_random_encounters(const Check& check) {
  Random random;
  for (int draw = 0; draw < kDraws; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    check(random_encounter(random, draw % 4 == 0));
    if (testing::Test::HasFailure()) return;
  }
}

#define EXPECT_FORCE(got, want, tolerance) \
  EXPECT_NEAR(static_cast<double>(wide(got) - (want)), 0, tolerance) << "got " << (got)

TEST(ThreeRigidBodies, HaveTheSideForceOfTheLumpedModel) {
  at_random_encounters(
      [](const Encounter& e) { EXPECT_FORCE(e.lumped.side_force_N, e.joints.wall_on_piston, e.force_tolerance); });
}

TEST(ThreeRigidBodies, NeedTheLoadTorqueThatTheLumpedModelDelivers) {
  at_random_encounters([](const Encounter& e) {
    EXPECT_FORCE(e.lumped.torque_Nm, -e.joints.load_torque, e.force_tolerance * e.engine.crank.crank_radius_m);
  });
}

TEST(ThreeRigidBodies, PressTheCrankPinWithTangentialForceAndRadialForceLessTheTurningBigEnd) {
  at_random_encounters([](const Encounter& e) {
    const Vec outward = (1 / support::length(e.motion.crank_pin)) * e.motion.crank_pin;
    const Wide tangential = support::dot(e.joints.rod_on_crank_pin, support::quarter_turn(outward));
    const Wide inward = -support::dot(e.joints.rod_on_crank_pin, outward);
    EXPECT_FORCE(e.lumped.tangential_force_N, tangential, e.force_tolerance);
    const double pin_load = e.lumped.radial_force_N - e.bearings.rods_kg_m[0] * e.speed_squared;
    EXPECT_FORCE(pin_load, inward, e.force_tolerance);
  });
}

TEST(ThreeRigidBodies, PressTheMainBearingWithTheThrowLoad) {
  at_random_encounters([](const Encounter& e) {
    const Vec outward = (1 / support::length(e.motion.crank_pin)) * e.motion.crank_pin;
    const Vec on_bearing = -1 * e.joints.bearing_on_crank;
    const double throw_load = e.lumped.radial_force_N - e.bearings.throw_kg_m[0] * e.speed_squared;
    EXPECT_FORCE(throw_load, -support::dot(on_bearing, outward), e.force_tolerance);
    EXPECT_FORCE(e.lumped.tangential_force_N, support::dot(on_bearing, support::quarter_turn(outward)),
                 e.force_tolerance);
  });
}

TEST(ThreeRigidBodies, CarryTheRodForceBetweenTheLumpedEnds) {
  // What the rod's middle carries: the force at the piston pin, less what the rod's own small end needs. Its part along
  // the cylinder axis is P, and for a two-mass rod it points along the rod with S = P/cos b. With a couple it does not:
  // the part along the rod is S - dM tan b/l.
  at_random_encounters([](const Encounter& e) {
    const Wide small_end = wide(e.engine.masses.rod_small_end_kg);
    const Vec in_rod = e.joints.rod_on_piston_pin + small_end * e.motion.piston_pin_acceleration;
    EXPECT_FORCE(e.lumped.total_force_N, in_rod.up, e.force_tolerance);
    const Vec rod = e.motion.piston_pin - e.motion.crank_pin;
    const Wide along = support::dot(in_rod, rod) / support::length(rod);
    const Wide couple = wide(e.engine.masses.rod_inertia_correction_kg_m2) * -e.motion.rod_turn_rad_s2;
    const Wide tilt = -rod.lateral / rod.up;
    EXPECT_FORCE(e.lumped.rod_force_N, along + couple * tilt / support::length(rod), e.force_tolerance);
  });
}

TEST(ThreeRigidBodies, TwistTheBlockWithTheTiltingMoment) {
  // The block receives the wall's, the main bearing's and the cylinder head's reactions; only their moment about the
  // crank axis counts.
  at_random_encounters([](const Encounter& e) {
    const Vec head{e.motion.piston_pin.lateral,
                   e.motion.piston_pin.up + 1};  // any height: the gas force is along the axis
    const Wide on_block = support::moment(e.motion.piston_pin, {-e.joints.wall_on_piston, 0}) +
                          support::moment({0, 0}, -1 * e.joints.bearing_on_crank) +
                          support::moment(head, {0, e.gas_force}) - e.joints.wall_moment;
    EXPECT_FORCE(e.lumped.tilting_moment_Nm, on_block, 2 * e.force_tolerance * e.engine.crank.rod_length_m);
  });
}

TEST(ThreeRigidBodies, SpareTheMountsTheGasForceButNotTheInertiaForces) {
  at_random_encounters([](const Encounter& e) {
    const Vec on_block{-e.joints.wall_on_piston - e.joints.bearing_on_crank.lateral,
                       e.gas_force - e.joints.bearing_on_crank.up};
    const double centrifugal = e.bearings.throw_kg_m[0] * e.speed_squared;
    const Vec outward = (1 / support::length(e.motion.crank_pin)) * e.motion.crank_pin;
    EXPECT_FORCE(centrifugal * static_cast<double>(outward.lateral), on_block.lateral, e.force_tolerance);
    EXPECT_FORCE(centrifugal * static_cast<double>(outward.up) - e.lumped.inertia_force_N, on_block.up,
                 e.force_tolerance);
  });
}

// ---- energy ---------------------------------------------------------------------------------------------------------

Wide rigid_kinetic_energy(const EngineDefinition& engine, const RigidRod& rod, Wide a, Wide w) {
  const Motion m = support::motion_at(engine.crank, a, w);
  const Wide along = wide(rod.com_to_crank_m) / wide(engine.crank.rod_length_m);
  const Vec com_velocity = m.crank_pin_velocity + along * (m.piston_pin_velocity - m.crank_pin_velocity);
  return (wide(rod.mass_kg) * support::dot(com_velocity, com_velocity) +
          wide(rod.inertia_kg_m2) * m.rod_turn_rad_s * m.rod_turn_rad_s +
          wide(engine.masses.piston_kg) * support::dot(m.piston_pin_velocity, m.piston_pin_velocity)) /
         2;
}

TEST(KineticEnergy, OfTheRigidPartsIsThatOfTheEffectiveInertia) {
  Random random;
  for (int draw = 0; draw < kDraws; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const support::RandomEngine made = support::random_engine(random);
    const EngineDefinition& engine = made.definition;
    const double a = random.between(0, 2 * kPi);
    const Pose<double> pose = exact_pose(engine.crank, a);
    const double r = engine.crank.crank_radius_m;
    const double effective = engine.masses.rod_big_end_kg * r * r +
                             engine.masses.reciprocating_kg() * pose.slope_m * pose.slope_m +
                             engine.masses.rod_inertia_correction_kg_m2 * pose.rod_slope * pose.rod_slope;
    const double scale = (engine.masses.reciprocating_kg() + made.rod.mass_kg) * r * r +
                         made.rod.inertia_kg_m2 * engine.crank.rod_ratio() * engine.crank.rod_ratio();
    EXPECT_NEAR(effective, static_cast<double>(2 * rigid_kinetic_energy(engine, made.rod, wide(a), 1)),
                16 * kEps * scale);
    if (HasFailure()) return;
  }
}

TEST(KineticEnergy, ChangesByTheWorkThatTheInertiaTorqueTakes) {
  // At constant speed what the masses give to the crankshaft is what their kinetic energy loses: M_inertia = -dE/da.
  Random random;
  for (int draw = 0; draw < 2'000; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const support::RandomEngine made = support::random_engine(random);
    const EngineDefinition& engine = made.definition;
    const double a = random.between(0, 2 * kPi);
    const double w = random.between(-700, 700);
    const double torque =
        cylinder_forces<true>(body_of(engine), exact_pose(engine.crank, a), engine.pressure.crankcase_Pa, w).torque_Nm;
    // Differences in the wide type, h = 2^-10: off by 4 h^4 = 4e-12 of the energy's bound in the strip |Im a| <= 1.
    // There |dx/da| <= 3.6 r and |db/da| <= 2.5 lambda (lambda <= 0.45, |e| <= 0.2 r), so the energy is at most 13
    // times what follows.
    const double r = engine.crank.crank_radius_m;
    const double lambda = engine.crank.rod_ratio();
    const double energy =
        ((engine.masses.reciprocating_kg() + made.rod.mass_kg) * r * r + made.rod.inertia_kg_m2 * lambda * lambda) * w *
        w / 2;
    const Wide lost =
        support::slope_of([&](Wide at) { return -rigid_kinetic_energy(engine, made.rod, at, wide(w)); }, wide(a));
    const double wide_noise = std::numeric_limits<Wide>::digits > 53 ? 0 : 16 * kEps * energy;
    EXPECT_NEAR(torque, static_cast<double>(lost),
                support::slope_tolerance(13 * energy, wide_noise) + 64 * kEps * energy);
    if (HasFailure()) return;
  }
}

// ---- the lumped rod by itself ---------------------------------------------------------------------------------------

TEST(LumpedRod, HasMassCentreOfMassMomentumSpinAndEnergyOfTheRigidRodInAnyMotion) {
  Random random;
  for (int draw = 0; draw < kDraws; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Crank crank = support::random_crank(random);
    const RigidRod rod = support::random_rod(random, crank);
    Masses masses;
    lump_rod(rod, crank, masses);
    const double l = crank.rod_length_m;
    const double mass_tolerance = 4 * kEps * rod.mass_kg;
    EXPECT_NEAR(masses.rod_small_end_kg + masses.rod_big_end_kg, rod.mass_kg, mass_tolerance);
    EXPECT_NEAR(masses.rod_small_end_kg * l, rod.mass_kg * rod.com_to_crank_m,
                mass_tolerance * l);  // centre of mass, from the crank pin

    // Any plane motion: velocity of the crank pin's end and a turning speed; the rod lies along `direction`.
    const Wide lean = wide(random.between(0, 2 * kPi));
    const Vec direction{std::sin(lean), std::cos(lean)};
    const Vec crank_end{wide(random.between(-20, 20)), wide(random.between(-20, 20))};
    const Wide turn = wide(random.between(-200, 200));
    const Wide at_pin = wide(masses.rod_small_end_kg);
    const Wide at_crank = wide(masses.rod_big_end_kg);
    const Wide correction = wide(masses.rod_inertia_correction_kg_m2);
    const Wide mass = wide(rod.mass_kg);
    const Wide inertia = wide(rod.inertia_kg_m2);
    const auto velocity = [&](Wide from_crank) {
      return crank_end + (turn * from_crank) * support::quarter_turn(direction);
    };
    const Vec com = velocity(wide(rod.com_to_crank_m));
    const Vec pin_end = velocity(wide(l));
    const Wide rigid = (mass * support::dot(com, com) + inertia * turn * turn) / 2;
    const Wide lumped = (at_pin * support::dot(pin_end, pin_end) + at_crank * support::dot(crank_end, crank_end) +
                         correction * turn * turn) /
                        2;
    const double fastest = 29 + 200 * l;
    EXPECT_NEAR(static_cast<double>(lumped - rigid), 0,
                4 * kEps * (rod.mass_kg * fastest * fastest + rod.inertia_kg_m2 * 200 * 200));

    const Vec momentum = at_pin * pin_end + at_crank * crank_end;
    EXPECT_NEAR(static_cast<double>(support::length(momentum - mass * com)), 0, mass_tolerance * fastest);
    // Moment of momentum about the crank pin's end.
    const Wide rigid_spin = support::moment(wide(rod.com_to_crank_m) * direction, mass * com) + inertia * turn;
    const Wide lumped_spin = support::moment(wide(l) * direction, at_pin * pin_end) + correction * turn;
    EXPECT_NEAR(static_cast<double>(lumped_spin - rigid_spin), 0,
                8 * kEps * (rod.mass_kg * fastest * l + rod.inertia_kg_m2 * 200));
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace crankloop::rigid_bodies_test

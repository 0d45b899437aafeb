// What must hold between the forces of any engine, at any angle, speed and pressure: docs/model.md "Forces".
//
// With P = P_g + P_j, the rod's couple dM = dI d2b/dt2 and h the piston pin's height over the crank centre:
//
//     M = T r = P dx/da - dM db/da     work: what the piston and the rod's turning give, the crank gets
//     M = N h + P e + dM               moments about the crank centre of all that moves (below)
//     M_tilt = -(N h + P_g e) = -(M - P_j e - dM)
//     K^2 + T^2 = N^2 + P^2            one force in the rod, seen from either end
//
// The second one: the wall gives N h and the gas P_g e; the piston's momentum m_j v, at arm e, takes m_j j e = -P_j e,
// the turning rod -dM (it turns against the crank); what is left, the crank delivers.
#include <crankloop/tabulate/summary.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "support/diagrams.hpp"
#include "support/engines.hpp"
#include "support/fourier.hpp"
#include "support/status.hpp"
#include "support/units.hpp"
#include "support/vector_geometry.hpp"

namespace crankloop::force_identities_test {

using namespace detail;
namespace {

using support::kEps;
using support::Random;
using support::wide;
using support::Wide;

using support::kPi;
using support::kRadPerDeg;

/// A random engine's cylinder somewhere in its cycle, with what the identities need from an independent hand.
struct Moment {
  EngineDefinition engine;
  double crank_rad, speed_rad_s, pressure_Pa;
  Pose<double> pose;
  CylinderForces<double> forces;
  double sin_a, cos_a, sin_b, cos_b, couple_Nm;
  double force_size;  ///< sum of the magnitudes that enter a force

  /// Every identity is a sum of less than a dozen products: 16 half units of the terms that enter.
  [[nodiscard]] double rounding_N() const { return 8 * kEps * force_size; }
};

Moment random_moment(Random& random) {
  Moment m{};
  m.engine = support::random_engine(random).definition;
  m.crank_rad = random.between(0, 4 * kPi);
  m.speed_rad_s = random.between(-700, 700);
  m.pressure_Pa = random.between(0.3e5, 150e5);
  const Crank& crank = m.engine.crank;
  m.pose = exact_pose(crank, m.crank_rad);
  m.forces = cylinder_forces<true>(body_of(m.engine), m.pose, m.pressure_Pa, m.speed_rad_s);
  m.sin_a = std::sin(m.crank_rad);
  m.cos_a = std::cos(m.crank_rad);
  m.sin_b = (crank.crank_radius_m * m.sin_a - crank.pin_offset_m) / crank.rod_length_m;
  m.cos_b = std::sqrt(1 - m.sin_b * m.sin_b);
  const double w2 = m.speed_rad_s * m.speed_rad_s;
  m.couple_Nm = m.engine.masses.rod_inertia_correction_kg_m2 * m.pose.rod_curvature * w2;
  const double area = kPi / 4 * crank.bore_m * crank.bore_m;
  m.force_size = (m.pressure_Pa + m.engine.pressure.crankcase_Pa) * area +
                 m.engine.masses.reciprocating_kg() * 1.5 * crank.crank_radius_m * w2 +
                 std::fabs(m.engine.masses.rod_inertia_correction_kg_m2) * crank.rod_ratio() / crank.rod_length_m * w2;
  return m;
}

template <class Check>
void at_random_moments(const Check& check) {
  Random random;
  for (int draw = 0; draw < 20'000; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    check(random_moment(random));
    if (testing::Test::HasFailure()) return;
  }
}

TEST(Forces, OfGasAndMassesAreWhatTheyAreCalled) {
  at_random_moments([](const Moment& m) {
    const double area = kPi * m.engine.crank.bore_m * m.engine.crank.bore_m / 4;
    EXPECT_EQ(m.forces.pressure_Pa, m.pressure_Pa);
    EXPECT_NEAR(m.forces.gas_force_N, (m.pressure_Pa - m.engine.pressure.crankcase_Pa) * area, m.rounding_N());
    const double mass = m.engine.masses.piston_kg + m.engine.masses.rod_small_end_kg;
    EXPECT_NEAR(m.forces.inertia_force_N, -mass * m.pose.acceleration_m * m.speed_rad_s * m.speed_rad_s,
                m.rounding_N());
    EXPECT_NEAR(m.forces.total_force_N, m.forces.gas_force_N + m.forces.inertia_force_N, m.rounding_N());
  });
}

TEST(Forces, TorqueIsTheWorkOfPistonAndTurningRodPerAngle) {
  at_random_moments([](const Moment& m) {
    const double r = m.engine.crank.crank_radius_m;
    EXPECT_NEAR(m.forces.torque_Nm, m.forces.tangential_force_N * r, m.rounding_N() * r);
    EXPECT_NEAR(m.forces.torque_Nm, m.forces.total_force_N * m.pose.slope_m - m.couple_Nm * m.pose.rod_slope,
                m.rounding_N() * r);
  });
}

TEST(Forces, TorqueIsTheMomentOfSideForceOffsetForceAndTurningRod) {
  at_random_moments([](const Moment& m) {
    const Crank& crank = m.engine.crank;
    const double h = crank.crank_radius_m * m.cos_a + crank.rod_length_m * m.cos_b;
    const double want = m.forces.side_force_N * h + m.forces.total_force_N * crank.pin_offset_m + m.couple_Nm;
    // The side force's rounding has the long arm h.
    EXPECT_NEAR(m.forces.torque_Nm, want,
                m.rounding_N() * (crank.crank_radius_m + crank.rod_length_m) * crank.rod_ratio() * 2);
  });
}

TEST(Forces, TiltingMomentIsTheTorqueLessWhatTheMassesKeep) {
  at_random_moments([](const Moment& m) {
    const Crank& crank = m.engine.crank;
    const double h = crank.crank_radius_m * m.cos_a + crank.rod_length_m * m.cos_b;
    const double tolerance = m.rounding_N() * (crank.crank_radius_m + crank.rod_length_m) * crank.rod_ratio() * 2;
    EXPECT_NEAR(m.forces.tilting_moment_Nm, -(m.forces.side_force_N * h + m.forces.gas_force_N * crank.pin_offset_m),
                tolerance);
    EXPECT_NEAR(m.forces.tilting_moment_Nm,
                -(m.forces.torque_Nm - m.forces.inertia_force_N * crank.pin_offset_m - m.couple_Nm), tolerance);
  });
}

TEST(Forces, WithoutOffsetAndCoupleTheBlockTiltsByTheTorqueReversed) {
  Random random;
  for (int draw = 0; draw < 1'000; ++draw) {
    Moment m = random_moment(random);
    m.engine.crank.pin_offset_m = 0;
    m.engine.masses.rod_inertia_correction_kg_m2 = 0;
    const auto f =
        cylinder_forces<true>(body_of(m.engine), exact_pose(m.engine.crank, m.crank_rad), m.pressure_Pa, m.speed_rad_s);
    const double tolerance = m.rounding_N() * (m.engine.crank.crank_radius_m + m.engine.crank.rod_length_m);
    EXPECT_NEAR(f.tilting_moment_Nm, -f.torque_Nm, tolerance) << random.trace(draw);
  }
}

TEST(Forces, AtTheCrankPinAreTheRodsForceTurnedIntoTheCrank) {
  at_random_moments([](const Moment& m) {
    // The rod hands the crank pin what it received at the piston pin: P along the axis and the wall's N across it.
    const double lateral = m.forces.side_force_N;
    const double up = -m.forces.total_force_N;
    EXPECT_NEAR(m.forces.radial_force_N, -(lateral * m.sin_a + up * m.cos_a), m.rounding_N());
    EXPECT_NEAR(m.forces.tangential_force_N, lateral * m.cos_a - up * m.sin_a, m.rounding_N());
  });
}

TEST(Forces, FollowTheirFormulasInAnglesOfCrankAndRod) {
  at_random_moments([](const Moment& m) {
    const double b = std::asin(m.sin_b);
    const double p = m.forces.total_force_N;
    const double couple_per_arm = m.couple_Nm / (m.engine.crank.rod_length_m * m.cos_b);
    EXPECT_NEAR(m.forces.side_force_N, p * std::tan(b) - couple_per_arm, m.rounding_N());
    EXPECT_NEAR(m.forces.rod_force_N, p / std::cos(b), m.rounding_N());
    EXPECT_NEAR(m.forces.radial_force_N, p * std::cos(m.crank_rad + b) / std::cos(b) + couple_per_arm * m.sin_a,
                m.rounding_N() + 4 * kEps * m.force_size * m.crank_rad);
    EXPECT_NEAR(m.forces.tangential_force_N, p * std::sin(m.crank_rad + b) / std::cos(b) - couple_per_arm * m.cos_a,
                m.rounding_N() + 4 * kEps * m.force_size * m.crank_rad);
  });
}

TEST(Forces, OfATwoMassRodAreTheSameBitsWithAndWithoutTheCouplesCode) {
  Random random;
  for (int draw = 0; draw < 1'000; ++draw) {
    Moment m = random_moment(random);
    m.engine.masses.rod_inertia_correction_kg_m2 = 0;
    const auto with = cylinder_forces<true>(body_of(m.engine), m.pose, m.pressure_Pa, m.speed_rad_s);
    const auto without = cylinder_forces<false>(body_of(m.engine), m.pose, m.pressure_Pa, m.speed_rad_s);
    EXPECT_EQ(with.side_force_N, without.side_force_N) << random.trace(draw);
    EXPECT_EQ(with.radial_force_N, without.radial_force_N) << random.trace(draw);
    EXPECT_EQ(with.tangential_force_N, without.tangential_force_N) << random.trace(draw);
    EXPECT_EQ(with.torque_Nm, without.torque_Nm) << random.trace(draw);
    EXPECT_EQ(with.tilting_moment_Nm, without.tilting_moment_Nm) << random.trace(draw);
  }
}

TEST(Forces, InFloatAreTheDoubleOnesToFloatsRounding) {
  at_random_moments([](const Moment& m) {
    const Body<double> d = body_of(m.engine);
    const auto f = [](double x) { return static_cast<float>(x); };
    const Body<float> body{f(d.crank_radius_m), f(d.per_crank_radius), f(d.per_rod_length),
                           f(d.pin_offset_m),   f(d.height_at_tdc_m),  f(d.bore_area_m2),
                           f(d.crankcase_Pa),   f(d.reciprocating_kg), f(d.rod_inertia_correction_kg_m2)};
    const Pose<double>& p = m.pose;
    const Pose<float> pose{f(p.displacement_m), f(p.slope_m),       f(p.acceleration_m), f(p.rod_angle_rad),
                           f(p.rod_slope),      f(p.rod_curvature), f(p.rod_tilt),       f(p.radial)};
    const CylinderForces<float> got = cylinder_forces<true>(body, pose, f(m.pressure_Pa), f(m.speed_rad_s));
    // Some ten roundings and as many rounded operands, of half a float's unit each, on the terms that enter.
    const double tolerance = 10 * static_cast<double>(std::numeric_limits<float>::epsilon()) * m.force_size;
    const Crank& crank = m.engine.crank;
    EXPECT_NEAR(static_cast<double>(got.side_force_N), m.forces.side_force_N, tolerance);
    EXPECT_NEAR(static_cast<double>(got.rod_force_N), m.forces.rod_force_N, tolerance);
    EXPECT_NEAR(static_cast<double>(got.radial_force_N), m.forces.radial_force_N, tolerance);
    EXPECT_NEAR(static_cast<double>(got.tangential_force_N), m.forces.tangential_force_N, tolerance);
    EXPECT_NEAR(static_cast<double>(got.torque_Nm), m.forces.torque_Nm, tolerance * crank.crank_radius_m);
    EXPECT_NEAR(static_cast<double>(got.tilting_moment_Nm), m.forces.tilting_moment_Nm,
                tolerance * (crank.crank_radius_m + crank.rod_length_m));
  });
}

TEST(Forces, DoNotDependOnTheDirectionOfRotation) {
  at_random_moments([](const Moment& m) {
    const auto back = cylinder_forces<true>(body_of(m.engine), m.pose, m.pressure_Pa, -m.speed_rad_s);
    EXPECT_EQ(back.torque_Nm, m.forces.torque_Nm);
    EXPECT_EQ(back.side_force_N, m.forces.side_force_N);
  });
}

// ---- over a cycle ---------------------------------------------------------------------------------------------------

EngineDefinition diesel_495() {
  EngineDefinition engine;
  engine.crank = support::diesel_495_crank();
  engine.masses.piston_kg = 0.810;
  engine.masses.rod_small_end_kg = 0.505;
  engine.masses.rod_big_end_kg = 1.382;
  const int order[] = {1, 3, 4, 2};
  EXPECT_TRUE(accepted(set_firing_order(order, 4, engine.layout)));
  engine.pressure.source = PressureSource::wiebe;
  engine.pressure.wiebe.net_mep_Pa = 809.7e3;
  return engine;
}

ExactEngine ready(const EngineDefinition& definition) {
  ExactEngine engine;
  EXPECT_TRUE(accepted(engine.init(definition)));
  return engine;
}

/// Sum over the loop of mean pressure times volume difference, the p-V diagram's area by trapezoids, with volumes by
/// vector geometry.
double loop_work_J(const ExactEngine& engine, double load_ratio, double from_deg, double to_deg, int steps) {
  const Crank& crank = engine.definition().crank;
  const auto pressure = [&](double deg) {
    return engine.diagram().motored_Pa(deg) + load_ratio * engine.diagram().heat_Pa(deg);
  };
  Wide sum = 0;
  double p0 = pressure(from_deg);
  double v0 = support::volume_m3(crank, from_deg);
  for (int i = 1; i <= steps; ++i) {
    const double deg = from_deg + (to_deg - from_deg) * i / steps;
    const double p1 = pressure(deg);
    const double v1 = support::volume_m3(crank, deg);
    sum += wide((p0 + p1) / 2) * wide(v1 - v0);
    p0 = p1;
    v0 = v1;
  }
  return static_cast<double>(sum);
}

// Trapezoids of h = 0.02 deg in the p-V plane miss h^2/6 of the integral of p' V'': at most that times the 150 bar that
// p rises and V'' < V_d, 2e-8 p_max V_d. Corners of p (start of combustion, valves) are of the same order.
constexpr int kLoopSteps = 36'000;
constexpr double kLoopShare = 1e-7;

TEST(CycleWork, OfTheGasForceIsTheLoopOfThePressureVolumeDiagramAndTheMeanEffectivePressure) {
  Random random;
  for (int draw = 0; draw < 4; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    EngineDefinition definition = diesel_495();
    if (draw > 0) {
      const support::RandomEngine made = support::random_engine(random);
      definition.crank = made.definition.crank;
      definition.masses = made.definition.masses;
    }
    const ExactEngine engine = ready(definition);
    const double swept = support::swept_m3(definition.crank);
    for (const double load : {1.0, 0.3, 0.0}) {
      const CycleSummary summary = summarise(engine, 210, load);
      const double loop = loop_work_J(engine, load, 0, 720, kLoopSteps);
      const double tolerance = kLoopShare * 150e5 * swept;
      EXPECT_NEAR(summary.net_mep_Pa * swept, loop, tolerance);
      if (load == 1.0) {
        EXPECT_NEAR(loop / swept, 809.7e3, tolerance / swept);
      }
      const double bottom_deg = dead_centres(definition.crank).bdc_rad / kRadPerDeg;
      EXPECT_NEAR(summary.gross_mep_Pa * swept, loop_work_J(engine, load, bottom_deg - 360, bottom_deg, kLoopSteps / 2),
                  tolerance);
      EXPECT_NEAR(summary.mean_torque_Nm, definition.layout.cylinders * loop / (4 * kPi),
                  definition.layout.cylinders * tolerance / (4 * kPi));
      EXPECT_NEAR(summary.power_W, summary.mean_torque_Nm * 210, 4 * kEps * std::fabs(summary.power_W));
    }
  }
}

TEST(CycleWork, OfTheTorqueCurveIsThatOfTheGasAloneBecauseMassesGiveBackWhatTheyTake) {
  // Mean of the torque at equal angles, inertia at full speed included: spectrally exact for the masses; for the gas,
  // whose slope jumps, as above.
  Random random;
  for (int draw = 0; draw < 4; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    EngineDefinition definition = diesel_495();
    if (draw > 0) {
      const support::RandomEngine made = support::random_engine(random);
      definition.crank = made.definition.crank;
      definition.masses = made.definition.masses;
    }
    const ExactEngine engine = ready(definition);
    const double speed = 600;
    Wide sum = 0;
    for (int i = 0; i < kLoopSteps; ++i) sum += wide(engine.forces(2, 720.0 * i / kLoopSteps, speed).torque_Nm);
    const double swept = support::swept_m3(definition.crank);
    const double inertia_size = definition.masses.reciprocating_kg() * definition.crank.crank_radius_m *
                                definition.crank.crank_radius_m * speed * speed;
    EXPECT_NEAR(static_cast<double>(sum) / kLoopSteps, 809.7e3 * swept / (4 * kPi),
                kLoopShare * 150e5 * swept / (4 * kPi) + 16 * kEps * inertia_size);
  }
}

TEST(CycleWork, Of809700PascalGives8800WattsAtAMechanicalEfficiencyOf080) {
  // [495]: 8.8 kW per cylinder at 2000 rpm.
  const CycleSummary summary = summarise(ready(diesel_495()), 2000 * 2 * kPi / 60);
  EXPECT_NEAR(summary.net_mep_Pa, 809.7e3, 0.5);
  EXPECT_NEAR(summary.power_W / 4 * 0.80 / 1000, 8.80, 0.005);
}

TEST(EngineTorque, IsTheSumOfCylindersEachAtItsOwnAngle) {
  const EngineDefinition definition = diesel_495();
  const ExactEngine engine = ready(definition);
  EngineDefinition one = definition;
  one.layout = Layout{};
  const ExactEngine single = ready(one);
  for (double deg = 0; deg < 720; deg += 7.3) {
    double sum = 0;
    for (const double firing : {0.0, 540.0, 180.0, 360.0}) sum += single.torque_Nm(deg - firing, 210);
    EXPECT_NEAR(engine.torque_Nm(deg, 210), sum,
                1e-9 * 500);  // 1e-9: the angle's rounding, 1e-13 deg, times the pressure's slope
    EXPECT_NEAR(engine.forces(1, deg, 210).torque_Nm, single.torque_Nm(deg - 540, 210), 1e-9 * 500);
  }
}

TEST(EngineTorque, LiesBetweenItsReportedExtremesAndReachesThem) {
  const ExactEngine engine = ready(diesel_495());
  const CycleSummary summary = summarise(engine, 210);
  EXPECT_EQ(engine.torque_Nm(summary.largest_torque_deg, 210), summary.largest_torque_Nm);
  EXPECT_EQ(engine.torque_Nm(summary.smallest_torque_deg, 210), summary.smallest_torque_Nm);
  for (int i = 0; i < 7200; ++i) {
    const double torque = engine.torque_Nm(0.1 * i, 210);
    const double rounding = 1e-9 * summary.largest_torque_Nm;
    EXPECT_LE(torque, summary.largest_torque_Nm + rounding);
    EXPECT_GE(torque, summary.smallest_torque_Nm - rounding);
  }
  EXPECT_NEAR(summary.fluctuation_ratio,
              (summary.largest_torque_Nm - summary.smallest_torque_Nm) / summary.mean_torque_Nm, 1e-12);
}

// ---- harmonics ------------------------------------------------------------------------------------------------------

/// A random engine with an arbitrary pressure of period 720 deg that is a smooth formula, tabulated every 0.1 deg.
struct SmoothEngine {
  std::vector<DiagramPoint> rows = support::angle_rows(support::smooth_pressure_Pa, 10);
  EngineDefinition definition;
  explicit SmoothEngine(Random& random) {
    definition = support::random_engine(random).definition;
    const int order[] = {1, 2, 3};
    EXPECT_TRUE(accepted(set_firing_order(order, 3, definition.layout)));
    definition.pressure = support::table_pressure(PressureSource::angle_table, rows);
  }
};

/// The torque by the formula's pressure and vector geometry, without the library's tables or equations.
double independent_torque_Nm(const EngineDefinition& engine, double engine_deg, double w) {
  double sum = 0;
  for (int k = 0; k < engine.layout.cylinders; ++k) {
    const double deg = engine_deg - engine.layout.firing_deg[static_cast<std::size_t>(k)];
    const support::Motion m = support::motion_at(engine.crank, wide(deg) * support::kWidePi / 180, 1);
    const double area = kPi / 4 * engine.crank.bore_m * engine.crank.bore_m;
    const double gas = (support::smooth_pressure_Pa(deg) - engine.pressure.crankcase_Pa) * area;
    const double down = -static_cast<double>(m.piston_pin_velocity.up);
    const double inertia = engine.masses.reciprocating_kg() * static_cast<double>(m.piston_pin_acceleration.up) * w * w;
    const double couple =
        engine.masses.rod_inertia_correction_kg_m2 * static_cast<double>(m.rod_turn_rad_s2 * m.rod_turn_rad_s) * w * w;
    sum += (gas + inertia) * down - couple;
  }
  return sum;
}

TEST(TorqueHarmonics, AreTheFourierCoefficientsOfTheTorque) {
  Random random;
  for (int draw = 0; draw < 4; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const SmoothEngine smooth{random};
    const double w = random.between(50, 400);
    const ExactEngine engine = ready(smooth.definition);
    const CycleSummary summary = summarise(engine, w);
    // A monotone cubic through points h = 0.1 deg apart is off by h^2/8 of p'' where p has a peak (slope zero is forced
    // on a point beside it) and by h^3 or less elsewhere: below 60e5 * 30/4 rad^-2 * h^2/8 = 18 Pa at the peak, times
    // area and about r, for one degree or two.
    const double area = kPi / 4 * smooth.definition.crank.bore_m * smooth.definition.crank.bore_m;
    const double tolerance = 18 * area * 1.2 * smooth.definition.crank.crank_radius_m;
    const auto torque = [&](double t) { return independent_torque_Nm(smooth.definition, 2 * t / kRadPerDeg, w); };
    constexpr int kSamples = 1'440;  // the torque's own harmonics beyond order 700 are far below rounding
    EXPECT_NEAR(summary.mean_torque_Nm, support::fourier_term(torque, 0, kSamples).cosine, tolerance);
    for (int h = 0; h < kHarmonics; ++h) {
      const support::FourierTerm want = support::fourier_term(torque, h + 1, kSamples);
      EXPECT_EQ(summary.harmonics[h].order, (h + 1) / 2.0);
      EXPECT_NEAR(summary.harmonics[h].cosine_Nm, want.cosine, tolerance) << "order " << summary.harmonics[h].order;
      EXPECT_NEAR(summary.harmonics[h].sine_Nm, want.sine, tolerance) << "order " << summary.harmonics[h].order;
      EXPECT_NEAR(summary.harmonics[h].amplitude_Nm, std::hypot(want.cosine, want.sine), 2 * tolerance);
    }
  }
}

TEST(TorqueHarmonics, AddedUpGiveTheTorqueToWhatTheyLeaveOut) {
  Random random;
  for (int draw = 0; draw < 4; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const SmoothEngine smooth{random};
    const double w = random.between(50, 400);
    const ExactEngine engine = ready(smooth.definition);
    const CycleSummary summary = summarise(engine, w);
    // Left out: orders 12.5 and up, whose sum of amplitudes bounds what is missing at any angle.
    const auto torque = [&](double t) { return engine.torque_Nm(2 * t / kRadPerDeg, w); };
    double left_out = 0;
    for (int order = kHarmonics + 1; order <= 150; ++order) {
      const support::FourierTerm term = support::fourier_term(torque, order, 720);
      left_out += std::hypot(term.cosine, term.sine);
    }
    double largest_torque = 0;
    double largest_miss = 0;
    for (int i = 0; i < 720; ++i) {
      double sum = summary.mean_torque_Nm;
      for (const Harmonic& h : summary.harmonics) {
        sum += h.cosine_Nm * std::cos(h.order * i * kRadPerDeg) + h.sine_Nm * std::sin(h.order * i * kRadPerDeg);
      }
      const double want = engine.torque_Nm(i, w);
      largest_torque = std::max(largest_torque, std::fabs(want));
      largest_miss = std::max(largest_miss, std::fabs(sum - want));
    }
    EXPECT_LE(largest_miss,
              left_out * (1 + 1e-6) + 1e-6 * largest_torque);  // 1e-6: orders above 75, and the table's corners
    EXPECT_LT(largest_miss, 0.05 * largest_torque);            // and what is left out is little
  }
}

TEST(TorqueHarmonics, OfMassesAloneAreAllThereIs) {
  // Without gas the torque's series falls like lambda^n: beyond order 12 nothing is left but (lambda/1.9)^11.
  EngineDefinition definition = diesel_495();
  definition.layout = Layout{};
  definition.pressure = Pressure{};
  const ExactEngine engine = ready(definition);
  const double w = 210;
  const CycleSummary summary = summarise(engine, w);
  const double size = definition.masses.reciprocating_kg() * 0.0575 * 0.0575 * w * w;
  EXPECT_NEAR(summary.mean_torque_Nm, 0, 1e-12 * size);
  EXPECT_EQ(summary.fluctuation_ratio, 0);
  for (int i = 0; i < 3600; ++i) {
    double sum = 0;
    for (const Harmonic& h : summary.harmonics) {
      sum +=
          h.cosine_Nm * std::cos(h.order * 0.1 * i * kRadPerDeg) + h.sine_Nm * std::sin(h.order * 0.1 * i * kRadPerDeg);
    }
    EXPECT_NEAR(sum, engine.torque_Nm(0.1 * i, w), 1e-8 * size);
  }
  // Half orders belong to the 720 deg cycle of the gas: masses have none, nor any cosine (torque is odd about the dead
  // centre).
  for (const Harmonic& h : summary.harmonics) {
    EXPECT_NEAR(h.cosine_Nm, 0, 1e-12 * size);
    if (h.order != std::floor(h.order)) {
      EXPECT_NEAR(h.amplitude_Nm, 0, 1e-12 * size);
    }
  }
  // Known in closed form [Li 2006] to the second power of lambda: m_j r^2 w^2 (lambda/4 sin a - 1/2 sin 2a - 3/4 lambda
  // sin 3a ...).
  const double lambda = definition.crank.rod_ratio();
  const double left_out = lambda * lambda * lambda;
  EXPECT_NEAR(summary.harmonics[1].sine_Nm / size, lambda / 4, left_out);
  EXPECT_NEAR(summary.harmonics[3].sine_Nm / size, -0.5, lambda * left_out);
  EXPECT_NEAR(summary.harmonics[5].sine_Nm / size, -0.75 * lambda, left_out);
}

TEST(TorqueHarmonics, OfAnEvenFiringEngineHaveOnlyTheFiringOrders) {
  const CycleSummary summary = summarise(ready(diesel_495()), 210);
  for (const Harmonic& h : summary.harmonics) {
    if (std::fmod(h.order, 2) == 0) continue;  // four cylinders in two turns: orders 2, 4, 6 ...
    EXPECT_NEAR(h.amplitude_Nm, 0, 1e-9 * summary.largest_torque_Nm) << "order " << h.order;
  }
  EXPECT_GT(summary.harmonics[3].amplitude_Nm, 0.1 * summary.largest_torque_Nm);
}

}  // namespace
}  // namespace crankloop::force_identities_test

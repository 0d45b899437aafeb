// Torque averaged over a tick is the work done in it divided by the angle turned, whatever the tick, the speed and the
// direction: so over a cycle it adds up to the cycle's work, where torque sampled at the tick would alias.
//
// Oracle: support/work_oracle.hpp, quadrature of p dV and kinetic energy, by the phases the engine itself went through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

#include "support/engines.hpp"
#include "support/random.hpp"
#include "support/running.hpp"
#include "support/status.hpp"
#include "support/work_oracle.hpp"

namespace crankloop::mean_torque_test {

using namespace detail;
namespace {

using namespace tick_test;
using support::Random;

constexpr double kRpm = kPi / 30;  // in rad/s

using MeanByTable = Asking<kTorque | kMeanTorque>;
using MeanByLoad = Asking<kTorque | kMeanTorque, PressureGiven::by_table, true>;
using MeanByPhase = Asking<kTorque | kMeanTorque, PressureGiven::by_table, false, CrankGiven::phase>;
using MeanWithForces = Asking<kForces | kTorque | kMeanTorque>;
using MeanByInput = Asking<kTorque | kMeanTorque, PressureGiven::by_input>;

/// Below this angle a tick's mean torque is the mean of both ends' torques instead: a difference of work would drown in
/// rounding.
template <class Real>
constexpr double kCrawl_rad = (sizeof(Real) == 4 ? 1.0 / 16 : 1.0 / 1048576) * kPi / 180;

/// What the tables of gas work may be off by anywhere: the pressure's stated 1e-5 of its peak on a full lever, over the
/// half radian that the burning lasts; per cylinder.
double table_error_J(const WorkOracle& oracle) { return 0.5 * 1e-5 * oracle.gas_torque_scale_Nm(); }

template <class Real>
class MeanTorque : public ::testing::Test {};
TYPED_TEST_SUITE(MeanTorque, BothReals, RealName);

/// Sum of mean torque times angle over a run, and what it went through.
struct Ledger {
  long double work_J = 0;
  long double turned_rad = 0;
  long double torque_size_Nm_rad = 0;  ///< sum of |mean torque| times |angle|: what roundings are relative to
};
template <class Real, class S>
void step_and_book(Engine<Real, S>& engine, const typename Engine<Real, S>::Input& in, Ledger& ledger) {
  const Phase before = engine.state().phase;
  const auto mean = static_cast<long double>(engine.step(in).mean_torque_Nm);
  ASSERT_EQ(engine.output().faults, 0u);
  const long double angle = turned_rad(before, engine.state().phase);
  ledger.work_J += mean * angle;
  ledger.turned_rad += angle;
  ledger.torque_size_Nm_rad += std::fabs(mean * angle);
}

/// Roundings of a tick's mean torque: difference, quantum, quotient, sum; a handful of units in the last place of what
/// goes in. What goes in is work up to a degree's, also of cylinders whose works cancel, so it is booked at the scale
/// of the torques and not of their sum.
template <class Real>
double rounding_J(const Ledger& ledger, double torque_scale_Nm) {
  const double handful = 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  return handful * (static_cast<double>(ledger.torque_size_Nm_rad) +
                    torque_scale_Nm * std::fabs(static_cast<double>(ledger.turned_rad)));
}

// ---- whole cycles ---------------------------------------------------------------------------------------------------

TYPED_TEST(MeanTorque, OverAMeasuredCycleOfAnyNumberOfTicksAddsUpToTheTablesOwnWork) {
  using Real = TypeParam;
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(diesel_495(), 500e-6)));
  const GasTorque<Real>& gas = *tables.sections().gas_torque_full;
  const long double cycle_J = static_cast<long double>(gas.mean_Nm) * 4 * kWidePi;  // of all cylinders
  Random random;
  for (const int ticks : {5, 7, 36, 100, 359, 720, 1440, 3'601, 14'400, 100'003}) {
    for (const bool backwards : {false, true}) {
      const Phase start{random.bits()};
      Running<Real, MeanByPhase> run(tables);
      run.engine.step(at_phase<Engine<Real, MeanByPhase>>(start));  // the first measured angle has no tick behind it
      Ledger ledger;
      for (int i = 1; i <= ticks; ++i) {
        // i/ticks of a cycle further on, in units, without loss.
        const auto share = static_cast<std::uint64_t>(i);
        const auto of = static_cast<std::uint64_t>(ticks);
        const std::uint64_t quotient = ~std::uint64_t{0} / of;
        const std::uint64_t units = i == ticks ? 0 : share * quotient + share * (~std::uint64_t{0} % of + 1) / of;
        typename Engine<Real, MeanByPhase>::Input in;
        in.crank = backwards ? start - Phase{units} : start + Phase{units};
        step_and_book<Real, MeanByPhase>(run.engine, in, ledger);
      }
      const long double direction = backwards ? -1 : 1;
      EXPECT_NEAR(static_cast<double>(ledger.turned_rad), static_cast<double>(direction * 4 * kWidePi), 1e-12);
      const double speed = 4 * kPi / ticks / 500e-6;
      const double scale = static_cast<double>(gas.mean_Nm) + 4 * 0.0045 * speed * speed;  // m_j r^2 = 4.3e-3 kg m^2
      // Torques at the ends of crawling ticks are those of a trapezoid: its error over a cycle comes from the diagram's
      // few kinks.
      const bool crawls = 4 * kPi / ticks <= kCrawl_rad<Real>;
      const double trapezoid_J = crawls ? 1e-7 * static_cast<double>(cycle_J) : 0;
      EXPECT_NEAR(static_cast<double>(ledger.work_J), static_cast<double>(direction * cycle_J),
                  rounding_J<Real>(ledger, scale) + trapezoid_J)
          << random.trace(ticks) << (backwards ? " backwards" : "");
      if (sizeof(Real) == 8 && !crawls) {
        EXPECT_NEAR(static_cast<double>(ledger.work_J / (direction * cycle_J)), 1,
                    1e-12 * std::max(1.0, scale / static_cast<double>(gas.mean_Nm)))
            << ticks << " ticks";
      }
    }
  }
}

TYPED_TEST(MeanTorque, TheTablesWorkIsTheDiagramsLoopIntegral) {
  using Real = TypeParam;
  const EngineDefinition engine = diesel_495();
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(engine, 100e-6)));
  const WorkOracle full(engine, 1);
  const WorkOracle motored(engine, 0);
  ASSERT_TRUE(full.ready());
  const Sections<Real>& s = tables.sections();
  const auto table_J = [](const GasTorque<Real>& gas) {
    return static_cast<double>(static_cast<long double>(gas.mean_Nm) * 4 * kWidePi) / 4;  // of one cylinder
  };
  // The 1e-4 is for measured traces; a synthesised one leaves 1e-6.
  EXPECT_NEAR(table_J(*s.gas_torque_full), full.cycle_J(), 1e-6 * full.cycle_J());
  EXPECT_NEAR(table_J(*s.gas_torque_motored), motored.cycle_J(), 1e-6 * full.cycle_J());
  EXPECT_NEAR(table_J(*s.gas_torque_heat), full.cycle_J() - motored.cycle_J(), 1e-6 * full.cycle_J());
  std::printf("[ measured ] %s: cycle work of the tables against the loop integral %.2g\n",
              sizeof(Real) == 4 ? "float" : "double", table_J(*s.gas_torque_full) / full.cycle_J() - 1);
}

// ---- any tick, any speed --------------------------------------------------------------------------------------------

/// A run at constant speed, from anywhere: the sum of its ticks' work against the work between its first and last
/// angle.
template <class Real, class S>
void expect_work_between_angles(const FullTables<Real>& tables, const WorkOracle& oracle, double speed_rad_s,
                                double load_ratio, double tick_s, Random& random, const char* what) {
  const double per_tick_rad = std::fabs(speed_rad_s) * tick_s;
  const double cycle_rad = 4 * kPi;
  // A cycle and a bit where that is affordable, else what 2000 ticks turn.
  const int ticks = static_cast<int>(std::min(2000.0, std::ceil(1.3 * cycle_rad / per_tick_rad)));
  Running<Real, S> run(tables, Phase{random.bits()});
  const Phase start = run.engine.state().phase;
  typename Engine<Real, S>::Input in;
  in.speed_rad_s = static_cast<Real>(speed_rad_s);
  if constexpr (Needs<S>::load) in.load_ratio = static_cast<Real>(load_ratio);
  (void)load_ratio;
  Ledger ledger;
  // The engine starts at rest and at full load: only a crawling first tick could tell, so it is not booked.
  run.engine.step(in);
  const Phase booked_from = run.engine.state().phase;
  for (int tick = 0; tick < ticks; ++tick) step_and_book<Real, S>(run.engine, in, ledger);
  const Phase end = run.engine.state().phase;

  const long double w = static_cast<long double>(in.speed_rad_s);
  const long double start_deg = deg_of(booked_from);
  const long double end_deg = deg_of(end);
  const long double cycles = std::round((ledger.turned_rad * 180 / kWidePi - (end_deg - start_deg)) / 720);
  const auto cylinders = static_cast<double>(tables.drive().cylinders);
  const long double want = cycles * wide(cylinders * oracle.cycle_J()) + oracle.gas_J(end_deg) -
                           oracle.gas_J(start_deg) +
                           w * w * (oracle.masses_kg_m2(end_deg) - oracle.masses_kg_m2(start_deg));

  const double inertia_scale = oracle.inertia_torque_scale_kg_m2() * speed_rad_s * speed_rad_s;
  const double scale = cylinders * (oracle.gas_torque_scale_Nm() + 2 * inertia_scale);
  // Crawling ticks: trapezoids. Torque curves bend by up to (1/5 rad)^-2 of their scale in the burning, and kink at the
  // diagram's corners.
  const bool crawls = per_tick_rad <= kCrawl_rad<Real>;
  const double turned = std::fabs(static_cast<double>(ledger.turned_rad));
  const double trapezoid_J = crawls ? scale * per_tick_rad * per_tick_rad * (25.0 / 12 * std::min(turned, 1.0) + 2) : 0;
  const double count_J = sizeof(Real) == 4 ? scale * 4e-9 : 0;  // both ends' integer counts, 2^-30 of the range each
  const double inertia_table_J = cylinders * inertia_scale * (sizeof(Real) == 4 ? 2e-7 : 1e-9);
  const double fit_J = std::min(1.0, 20 * turned) * cylinders * (std::fabs(static_cast<double>(cycles)) + 2) *
                       table_error_J(oracle) * (1 + load_ratio);
  EXPECT_NEAR(static_cast<double>(ledger.work_J), static_cast<double>(want),
              rounding_J<Real>(ledger, scale) + trapezoid_J + count_J + inertia_table_J + fit_J)
      << what << ", " << random.trace(0) << ", tick " << tick_s << " s, " << speed_rad_s / kRpm << " rpm, start "
      << start.units() << ", " << ticks << " ticks, load " << load_ratio;
}

TYPED_TEST(MeanTorque, OfAnyTickAtAnySpeedEitherWayIsWorkOverAngle) {
  using Real = TypeParam;
  Random random;
  struct Case {
    const char* name;
    EngineDefinition engine;
  };
  for (const Case& c :
       {Case{"495", diesel_495()}, Case{"uneven V4 with offset", uneven_v4()}, Case{"one cylinder", single_495()}}) {
    const WorkOracle full(c.engine, 1);
    const WorkOracle light(c.engine, 0.35);
    const WorkOracle boosted(c.engine, 1.9);
    FullTables<Real> tables;
    for (const double tick_s : {1e-6, 7.7e-6, 50e-6, 100e-6, 333e-6, 2e-3}) {
      ASSERT_TRUE(accepted(tables.build(c.engine, tick_s)));
      for (int draw = 0; draw < 4; ++draw) {
        const double rpm = std::exp(random.between(0, std::log(12'000.0)));
        const double speed = (random.coin() ? 1 : -1) * rpm * kRpm;
        expect_work_between_angles<Real, MeanByTable>(tables, full, speed, 1, tick_s, random, c.name);
        expect_work_between_angles<Real, MeanWithForces>(tables, full, speed, 1, tick_s, random, c.name);
        expect_work_between_angles<Real, MeanByLoad>(tables, light, speed, 0.35, tick_s, random, c.name);
        expect_work_between_angles<Real, MeanByLoad>(tables, boosted, speed, 1.9, tick_s, random, c.name);
      }
    }
  }
}

TYPED_TEST(MeanTorque, AtTheSpeedLimitTheSignStillFollowsTheRotation) {
  using Real = TypeParam;
  // At 2 ms a tick may turn almost a whole revolution: the largest angle whose short way round is still its own.
  const EngineDefinition engine = diesel_495();
  const WorkOracle oracle(engine, 1);
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(engine, 2e-3)));
  Random random;
  const auto limit = static_cast<double>(tables.drive().speed_limit_rad_s);
  EXPECT_GT(limit * 2e-3, 0.999 * 2 * kPi);
  for (const double speed : {limit, -limit, 0.999 * limit, -0.5 * limit}) {
    expect_work_between_angles<Real, MeanByTable>(tables, oracle, speed, 1, 2e-3, random, "495 at its limit");
  }
}

// ---- one tick against many small ones -------------------------------------------------------------------------------

TYPED_TEST(MeanTorque, OfAMillisecondIsTheAverageOfTheTorqueAtAThousandMicroseconds) {
  using Real = TypeParam;
  const EngineDefinition engine = diesel_495();
  const WorkOracle oracle(engine, 1);
  FullTables<Real> coarse;
  FullTables<Real> fine;
  ASSERT_TRUE(accepted(coarse.build(engine, 1e-3)));
  ASSERT_TRUE(accepted(fine.build(engine, 1e-6)));
  Random random;
  double worst = 0;
  for (int draw = 0; draw < 200; ++draw) {
    const double speed = (random.coin() ? 1 : -1) * random.between(20, 6000) * kRpm;
    Running<Real, MeanByTable> tick(coarse, Phase{random.bits()});
    typename Engine<Real, MeanByTable>::Input in;
    in.speed_rad_s = static_cast<Real>(speed);
    tick.engine.step(in);
    const Phase from = tick.engine.state().phase;
    const auto first = static_cast<double>(tick.engine.output().torque_Nm);
    tick.engine.step(in);
    const auto mean = static_cast<double>(tick.engine.output().mean_torque_Nm);

    Running<Real, MeanByTable> watch(fine, from);
    double sum = first / 2;
    for (int i = 1; i <= 1000; ++i) {
      const auto torque = static_cast<double>(watch.engine.step(in).torque_Nm);
      sum += i < 1000 ? torque : torque / 2;
    }
    const double scale = 4 * (oracle.gas_torque_scale_Nm() + 2 * oracle.inertia_torque_scale_kg_m2() * speed * speed);
    // The trapezoid: (angle / 1000)^2 / 12 times a curvature of (1/5 rad)^-2. Rounding: work to 1e-8 of the scale over
    // the angle; float's thousand small angles also end up to 1e-7 of their sum elsewhere.
    const double angle = std::fabs(speed) * 1e-3;
    const double tolerance = scale * (angle * angle * 1e-6 * 25 / 12 + angle * 1e-6 / 2 +
                                      (sizeof(Real) == 4 ? 3e-7 + 1e-8 / angle : 1e-11 + 1e-12 / angle));
    EXPECT_NEAR(mean, sum / 1000, tolerance)
        << random.trace(draw) << ", " << speed / kRpm << " rpm from " << static_cast<double>(deg_of(from)) << " deg";
    worst = std::max(worst, std::fabs(mean - sum / 1000) / scale);
  }
  std::printf("[ measured ] %s: mean torque of 1 ms against 1000 torques, of the torque scale %.2g\n",
              sizeof(Real) == 4 ? "float" : "double", worst);
}

TYPED_TEST(MeanTorque, OfASmallTickDoesNotDrownInRoundingOnEitherSideOfTheCrawl) {
  using Real = TypeParam;
  // Whatever angle a tick turns, its mean torque lies between the torques at both ends but for their curvature and
  // rounding.
  const EngineDefinition engine = single_495();
  const WorkOracle oracle(engine, 1);
  const double scale = oracle.gas_torque_scale_Nm();
  Random random;
  double worst = 0;
  double worst_at_rad = 0;
  int worst_draw = 0;
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(engine, 1e-6)));
  for (int draw = 0; draw < 20'000; ++draw) {
    const double angle = std::exp(random.between(std::log(1e-9), std::log(5e-3))) * (random.coin() ? 1 : -1);
    // During compression and expansion, where the torque is large and smooth.
    const double at_deg = random.coin() ? random.between(20, 120) : random.between(600, 700);
    typename Engine<Real, MeanByTable>::Input in;
    in.speed_rad_s = static_cast<Real>(angle / 1e-6);
    Running<Real, MeanByTable> run(tables, phase_at_deg(static_cast<long double>(at_deg)));
    run.engine.step(in);
    const auto first = static_cast<double>(run.engine.output().torque_Nm);
    run.engine.step(in);
    const auto last = static_cast<double>(run.engine.output().torque_Nm);
    const auto mean = static_cast<double>(run.engine.output().mean_torque_Nm);
    const double speed = angle / 1e-6;
    const double whole_scale = scale + 2 * oracle.inertia_torque_scale_kg_m2() * speed * speed;
    const double error = std::fabs(mean - (first + last) / 2) / whole_scale;
    const double curvature = angle * angle * 25 / 12;
    if (error - curvature > worst) worst = error - curvature, worst_at_rad = angle, worst_draw = draw;
  }
  // float: 6e-8 of a degree's work (0.0175 rad) over the smallest angle that is not a crawl (0.0011 rad), a few times.
  // double: 1e-16 of it over 2e-8 rad.
  EXPECT_LE(worst, sizeof(Real) == 4 ? 5e-6 : 1e-9)
      << random.trace(worst_draw) << ", " << worst_at_rad << " rad a tick";
  std::printf(
      "[ measured ] %s: mean torque of a small tick against its ends, of the torque scale %.2g (at %.2g rad a tick)\n",
      sizeof(Real) == 4 ? "float" : "double", worst, worst_at_rad);
}

// ---- pressure from outside ------------------------------------------------------------------------------------------

TYPED_TEST(MeanTorque, OfAConstantPressureFromOutsideDoesNoWorkOverACycle) {
  using Real = TypeParam;
  EngineDefinition engine = uneven_v4();
  engine.pressure.source = PressureSource::none;
  FullTables<Real> tables;
  Random random;
  for (const double tick_s : {20e-6, 100e-6, 1e-3}) {
    ASSERT_TRUE(accepted(tables.build(engine, tick_s)));
    for (const double sign : {1.0, -1.0}) {
      Running<Real, MeanByInput> run(tables, Phase{random.bits()});
      const int ticks = tick_s < 1e-4 ? 3600 : 360;
      // Exactly a cycle in `ticks` ticks, to rounding of the speed.
      const double speed = sign * 4 * kPi / ticks / tick_s;
      typename Engine<Real, MeanByInput>::Input in;
      in.speed_rad_s = static_cast<Real>(speed);
      for (int k = 0; k < 4; ++k) in.pressure_Pa[k] = static_cast<Real>(2e5 + 13e5 * k);
      run.engine.step(in);  // its trapezoid begins at the crankcase pressure
      Ledger ledger;
      for (int tick = 0; tick < ticks; ++tick) step_and_book<Real, MeanByInput>(run.engine, in, ledger);
      const double area = kPi / 4 * 0.095 * 0.095;
      const double scale = 4 * (41e5 * area * 0.0575 + 2 * 0.0045 * speed * speed);
      // What is left: rounding, and the little angle by which the cycle is not whole, of the torque there.
      const double not_whole = std::fabs(std::fabs(static_cast<double>(ledger.turned_rad)) - 4 * kPi);
      EXPECT_NEAR(static_cast<double>(ledger.work_J), 0,
                  rounding_J<Real>(ledger, scale) + not_whole * scale * 1.5 + scale * 1e-9)
          << "tick " << tick_s << ", direction " << sign;
    }
  }
}

TYPED_TEST(MeanTorque, OfAPressureFromOutsideIsATrapezoidOfPressureTimesVolume) {
  using Real = TypeParam;
  EngineDefinition engine = uneven_v4();
  engine.pressure.source = PressureSource::none;
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(engine, 100e-6)));
  Random random;
  const long double area = kWidePi / 4 * 0.095L * 0.095L;
  const WorkOracle masses(engine, 1);
  Running<Real, MeanByInput> run(tables, Phase{random.bits()});
  typename Engine<Real, MeanByInput>::Input in;
  long double last_Pa[4] = {100e3L, 100e3L, 100e3L, 100e3L};  // the engine starts at crankcase pressure
  long double last_deg = deg_of(run.engine.state().phase);
  const auto displacement_m = [&](long double engine_deg, std::size_t k) {
    return oracle_pose(engine.crank, (engine_deg - wide(engine.layout.firing_deg[k])) * kWidePi / 180).displacement_m;
  };
  for (int draw = 0; draw < 2000; ++draw) {
    const double speed = (random.coin() ? 1 : -1) * random.between(200, 8000) * kRpm;
    in.speed_rad_s = static_cast<Real>(speed);
    for (int k = 0; k < 4; ++k) in.pressure_Pa[k] = static_cast<Real>(random.between(0, 1e7));
    const Phase before = run.engine.state().phase;
    const auto mean = static_cast<double>(run.engine.step(in).mean_torque_Nm);
    const long double deg = deg_of(run.engine.state().phase);
    const long double angle = turned_rad(before, run.engine.state().phase);
    const long double w = static_cast<long double>(in.speed_rad_s);
    long double work = w * w * (masses.masses_kg_m2(deg) - masses.masses_kg_m2(last_deg));
    for (std::size_t k = 0; k < 4; ++k) {
      const auto now_Pa = static_cast<long double>(in.pressure_Pa[k]);
      work += ((last_Pa[k] + now_Pa) / 2 - 100e3L) * area * (displacement_m(deg, k) - displacement_m(last_deg, k));
      last_Pa[k] = now_Pa;
    }
    last_deg = deg;
    const double scale = 4 * (1e7 * static_cast<double>(area) * 0.0575 + 2 * 0.0045 * speed * speed);
    const double size = std::fabs(static_cast<double>(angle));
    // Work from a difference of tabulated displacements: theirs is 1e-8 r (float: counts of 2^-30) or 1e-11 r, over the
    // angle.
    const double tolerance = scale * (sizeof(Real) == 4 ? 4e-7 + 3e-9 / size : 2e-9 + 2e-11 / size);
    if (size > kCrawl_rad<Real>) {
      ASSERT_NEAR(mean, static_cast<double>(work / angle), tolerance)
          << random.trace(draw) << ", " << speed / kRpm << " rpm";
    }
  }
}

// ---- many cylinders at once -----------------------------------------------------------------------------------------

TYPED_TEST(MeanTorque, OfSixteenCylindersThatFireTogetherDoesNotOverflowItsCounts) {
  using Real = TypeParam;
  const EngineDefinition one = single_495();
  EngineDefinition many = with_cylinders(one, std::vector<double>(16, 0.0));
  EngineDefinition paired = with_cylinders(one, {0, 360, 0, 360, 0, 360, 0, 360, 0, 360, 0, 360, 0, 360, 0, 360});
  for (const EngineDefinition* engine : {&many, &paired}) {
    const WorkOracle oracle(*engine, 1);
    FullTables<Real> tables;
    ASSERT_TRUE(accepted(tables.build(*engine, 2e-3)));
    EXPECT_EQ(tables.drive().mechanisms, 1u);
    Random random;
    // Half a revolution a tick: from the least to the most work in one difference.
    for (const double rpm : {15'000.0, 14'000.0, 7'000.0, 3'333.0}) {
      expect_work_between_angles<Real, MeanByTable>(tables, oracle, rpm * kRpm, 1, 2e-3, random, "sixteen at once");
      expect_work_between_angles<Real, MeanByTable>(tables, oracle, -rpm * kRpm, 1, 2e-3, random,
                                                    "sixteen at once, backwards");
    }
  }
}

/// What docs/contract.md says that scenes may differ by, of the torque that the largest cylinder pressure has on a full
/// lever: with a load ratio, and with forces.
template <class Real>
constexpr double kApartByLoad = sizeof(Real) == 4 ? 3e-7 : 1e-12;
constexpr double kApartByForces = 1e-5;

TYPED_TEST(MeanTorque, OfScenesThatAskForMoreDiffersByLessThanTheContractSays) {
  // With a load ratio the gas torque is two curves instead of one; with forces the torque at the tick, and at a crawl
  // the mean, is the sum of the cylinders'.
  using Real = TypeParam;
  double worst = 0;
  double worst_forces = 0;
  for (const EngineDefinition& engine : {single_495(), diesel_495(), uneven_v4()}) {
    const double scale_Nm = WorkOracle(engine, 1).gas_torque_scale_Nm();
    for (const auto& [at_rpm, tick_s] : {std::pair{2000.0, 100e-6}, {400.0, 20e-6}, {0.001, 20e-6}, {3000.0, 1e-3}}) {
      const double rpm = at_rpm;  // which a lambda may hold
      FullTables<Real> tables;
      ASSERT_TRUE(accepted(tables.build(engine, tick_s)));
      Running<Real, MeanByTable> plain(tables);
      Running<Real, MeanByLoad> load(tables);
      Running<Real, MeanWithForces> forces(tables);
      for (int i = 0; i < std::min(15'000.0, 120 / rpm / tick_s); ++i) {
        const auto torque = [&](auto& run) {
          using Engine = std::decay_t<decltype(run.engine)>;
          return static_cast<double>(run.engine.step(at_speed<Engine>(rpm * kRpm)).mean_torque_Nm) / scale_Nm;
        };
        const double of_plain = torque(plain);
        worst = std::max(worst, std::fabs(torque(load) - of_plain));
        worst_forces = std::max(worst_forces, std::fabs(torque(forces) - of_plain));
      }
    }
  }
  std::printf("with a load ratio %.1e, with forces %.1e of the torque scale\n", worst, worst_forces);
  EXPECT_LT(worst, kApartByLoad<Real>);
  EXPECT_LT(worst_forces, kApartByForces);
}

TYPED_TEST(MeanTorque, AtStandstillIsTheTorqueThere) {
  using Real = TypeParam;
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(diesel_495(), 100e-6)));
  Running<Real, MeanByTable> run(tables, phase_at_deg(50));
  typename Engine<Real, MeanByTable>::Input in;
  run.engine.step(in);
  const auto& out = run.engine.step(in);
  EXPECT_EQ(out.mean_torque_Nm, out.torque_Nm);
  EXPECT_GT(out.torque_Nm, Real{100});  // 50 deg after firing: the gas pushes
}

}  // namespace
}  // namespace crankloop::mean_torque_test

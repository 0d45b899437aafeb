// `crankloop run`: a fixed-step run against the exact engine, its CSV, its curves, its report.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tabulate/summary.hpp>

#include "crankloop/command_line/commands.hpp"
#include "crankloop/files/error.hpp"
#include "crankloop/loops/run_accuracy.hpp"
#include "crankloop/loops/run_loop.hpp"
#include "crankloop/loops/run_trace.hpp"
#include "support/both_reals.hpp"
#include "support/engines.hpp"
#include "support/run_command.hpp"
#include "support/status.hpp"

namespace crankloop::program::run_test {
namespace {

// ---- The loop against the exact engine ----

struct Case {
  const char* name;
  EngineDefinition engine;
  Operation operation;
  int cycles;
};

/// Three cylinders with a pin offset and a rod that is no two masses: no term is zero.
EngineDefinition uneven_three() {
  EngineDefinition engine = support::with_cylinders(support::single_495(), {0, 480, 240});
  engine.crank.pin_offset_m = 0.006;
  return engine;
}

/// Operation{rpm, tick in s, load ratio}: whole and broken numbers of ticks per cycle, the extremes of tick and speed.
std::vector<Case> cases() {
  return {
      {"495, 600 ticks a cycle", support::diesel_495(), {2000, 100e-6, 1}, 2},
      {"495, 571.43 ticks a cycle", support::diesel_495(), {2100, 100e-6, 1}, 3},
      {"495, half load", support::diesel_495(), {2000, 100e-6, 0.5}, 1},
      {"495, motored, a tick of 2 ms", support::diesel_495(), {1234.5, 2e-3, 0}, 5},
      {"495, 6 ticks a cycle", support::diesel_495(), {10000, 2e-3, 1}, 4},
      {"495, a crawl", support::diesel_495(), {1, 2e-3, 1}, 1},
      {"three with offset, 300 ticks a cycle", uneven_three(), {4000, 100e-6, 1}, 2},
      {"three with offset, 10 us", uneven_three(), {6000, 10e-6, 1}, 2},
      {"three with offset, 4.3 ticks a cycle", uneven_three(), {9300, 3e-3 / 2, 1.5}, 50},
      {"inertia only", support::without_gas(uneven_three()), {5000, 100e-6, 1}, 2},
  };
}

template <class Real>
double eps() {
  return static_cast<double>(std::numeric_limits<Real>::epsilon());
}

/// Largest value of the cycle, by the exact engine each degree.
template <class Value>
double peak_of(const Value& value) {
  double peak = 0;
  for (int deg = 0; deg < 720; ++deg) peak = std::max(peak, std::abs(value(static_cast<double>(deg))));
  return peak;
}

/// What tables and rounding may do to a run's forces. Kinematics are promised to 4e-7 of their scale in float and 2e-9
/// in double; the pressure to what tabulate reports, and a small factor because it looks at 10 points of a segment
/// only.
struct Tolerances {
  double force_N;
  double torque_Nm;

  template <class Real>
  static Tolerances of(const ExactEngine& exact, const Operation& operation, const TableReport& tables) {
    const EngineDefinition& d = exact.definition();
    const double speed = operation.speed_rad_s();
    const double per_scale = sizeof(Real) == 4 ? 4e-7 : 2e-9;
    const double gas =
        peak_of([&](double deg) { return exact.forces(0, deg, speed, operation.load_ratio).gas_force_N; });
    const double inertia = peak_of([&](double deg) { return exact.forces(0, deg, speed).inertia_force_N; });
    constexpr double kTerms = 6;  // products and sums behind a force, each with its own look-up or rounding
    const double load = std::max(1.0, operation.load_ratio);
    const double force = 1.5 * load * tables.pressure_error_Pa * bore_area_m2(d.crank) +
                         kTerms * per_scale * (gas + inertia) +
                         kTerms * eps<Real>() * exact.diagram().full_Pa(0) * bore_area_m2(d.crank);
    // |dx/da| <= r (1 + lambda)
    return {force, d.layout.cylinders * force * d.crank.crank_radius_m * (1 + d.crank.rod_ratio())};
  }
};

template <class Real>
class RunIn : public testing::Test {};
TYPED_TEST_SUITE(RunIn, tick_test::BothReals, tick_test::RealName);

TYPED_TEST(RunIn, EveryTickIsTheExactEngineWithinTheErrorOfItsTables) {
  using Real = TypeParam;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    ExactEngine exact;
    ASSERT_TRUE(accepted(exact.init(c.engine)));
    FixedStepLoop<Real> loop(c.engine, c.operation);
    const auto tolerances = Tolerances::of<Real>(exact, c.operation, loop.tables());
    double worst_Nm = 0;
    double worst_gas_N = 0;
    double worst_side_N = 0;
    const OnTick<Real> compare = [&](std::uint64_t, double deg, const WholeOutput<Real>& out) {
      const double speed = c.operation.speed_rad_s();
      const double torque = exact.torque_Nm(deg, speed, c.operation.load_ratio);
      const CylinderForces<double> forces = exact.forces(0, deg, speed, c.operation.load_ratio);
      worst_Nm = std::max(worst_Nm, std::abs(static_cast<double>(out.torque_Nm) - torque));
      const CylinderForces<Real>& tick = out.cylinder[0];
      worst_gas_N = std::max(worst_gas_N, std::abs(static_cast<double>(tick.gas_force_N) - forces.gas_force_N));
      worst_side_N = std::max(worst_side_N, std::abs(static_cast<double>(tick.side_force_N) - forces.side_force_N));
    };
    const RunFigures figures = run_cycles<Real>(loop, c.engine, c.operation, c.cycles, compare);
    EXPECT_LE(worst_Nm, tolerances.torque_Nm);
    EXPECT_LE(worst_gas_N, tolerances.force_N);
    EXPECT_LE(worst_side_N, tolerances.force_N);
    EXPECT_EQ(figures.faulty_ticks, 0u);
    EXPECT_EQ(figures.faults, 0u);
  }
}

/// What the mean torque may be off by because the last tick reaches beyond the last cycle. Its part is integrated over
/// a parabola with the right ends and the right mean; the remainder is T''' h^3 u (u - 1/2) (u - 1) / 6, whose integral
/// from 0 to any part is at most 1/384 of T''' h^3. T''' from the harmonics up to order 12, twice, for those above. And
/// however coarse the tick, the part's mean is not further from the torque than some three times its range: the
/// parabola's bulge is at most 6/4 of it.
double last_tick_error(const CycleSummary& summary, double ticks_per_cycle, int cycles) {
  const double ticks = cycles * ticks_per_cycle;
  const double beyond = std::ceil(ticks) - ticks;
  if (beyond < 1e-3 || beyond > 1 - 1e-3) return 0;  // a whole number of ticks, but for the rounding of an increment
  const double h = 4 * elementary::kPi / ticks_per_cycle;
  double third = 0;
  for (const Harmonic& harmonic : summary.harmonics) third += std::pow(harmonic.order, 3) * harmonic.amplitude_Nm;
  const double torque_range = summary.largest_torque_Nm - summary.smallest_torque_Nm;
  return std::min(2 * third * h * h * h / 384, 3 * torque_range) / ticks;
}

TYPED_TEST(RunIn, MeanTorquePowerAndImepAreThoseOfTheExactCycle) {
  using Real = TypeParam;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    ExactEngine exact;
    ASSERT_TRUE(accepted(exact.init(c.engine)));
    const double speed = c.operation.speed_rad_s();
    const CycleSummary summary = summarise(exact, speed, c.operation.load_ratio);
    FixedStepLoop<Real> loop(c.engine, c.operation);
    const RunFigures figures = run_cycles<Real>(loop, c.engine, c.operation, c.cycles);

    // Torque tables carry the exact work of a whole cycle, so that only rounding remains (1e-9 found in double).
    const double torque_range = summary.largest_torque_Nm - summary.smallest_torque_Nm;
    const double rounding_Nm = 4 * eps<Real>() * torque_range + 1e-8 * torque_range;
    const double tolerance_Nm = rounding_Nm + last_tick_error(summary, loop.ticks_per_cycle(), c.cycles);
    const double swept_m3 = swept_volume_m3(c.engine.crank) * c.engine.layout.cylinders;
    const double cycle_rad = 4 * elementary::kPi;

    EXPECT_NEAR(figures.mean_torque_Nm, summary.mean_torque_Nm, tolerance_Nm);
    EXPECT_NEAR(figures.power_W, summary.power_W, tolerance_Nm * speed);
    EXPECT_NEAR(figures.net_mep_Pa, summary.net_mep_Pa, tolerance_Nm * cycle_rad / swept_m3);
  }
}

TYPED_TEST(RunIn, AnImepGivenInTheFileIsMetToOneTenThousandth) {
  const EngineDefinition engine = support::diesel_495();  // 809.7 kPa
  const Operation operation{2000, 100e-6, 1};
  FixedStepLoop<TypeParam> loop(engine, operation);
  EXPECT_NEAR(run_cycles<TypeParam>(loop, engine, operation, 2).net_mep_Pa, 809.7e3, 1e-4 * 809.7e3);
}

TYPED_TEST(RunIn, PeaksAreTheExtremesOfAllTicksAndCylinders) {
  using Real = TypeParam;
  const EngineDefinition engine = uneven_three();
  const Operation operation{3700, 100e-6, 1};
  FixedStepLoop<Real> loop(engine, operation);
  std::vector<double> side;
  std::vector<double> own_deg;
  std::vector<double> torque;
  const RunFigures figures =
      run_cycles<Real>(loop, engine, operation, 3, [&](std::uint64_t, double deg, const WholeOutput<Real>& out) {
        for (std::size_t k = 0; k < 3; ++k) {
          side.push_back(static_cast<double>(out.cylinder[k].side_force_N));
          own_deg.push_back(std::fmod(deg - engine.layout.firing_deg[k] + 720, 720));
        }
        torque.push_back(static_cast<double>(out.torque_Nm));
      });
  const Peaks& peaks = figures.of[index_of(Quantity::side_force)];
  const auto most = static_cast<std::size_t>(std::max_element(side.begin(), side.end()) - side.begin());
  const auto least = static_cast<std::size_t>(std::min_element(side.begin(), side.end()) - side.begin());
  EXPECT_EQ(peaks.largest.value, side[most]);
  EXPECT_NEAR(peaks.largest.at_deg, own_deg[most], 1e-9);
  EXPECT_EQ(peaks.smallest.value, side[least]);
  EXPECT_NEAR(peaks.smallest.at_deg, own_deg[least], 1e-9);
  EXPECT_EQ(figures.torque.largest.value, *std::max_element(torque.begin(), torque.end()));
  EXPECT_EQ(figures.torque.smallest.value, *std::min_element(torque.begin(), torque.end()));
}

TYPED_TEST(RunIn, ARunBeginsAtFiringTdcAndCoversItsCyclesWhateverTheTick) {
  using Real = TypeParam;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    FixedStepLoop<Real> loop(c.engine, c.operation);
    const double deg_per_tick = c.operation.speed_rpm * 6 * c.operation.tick_s;
    const double quantum_deg = 720 * 0x1p-62;  // of a phase increment
    EXPECT_NEAR(loop.deg_per_tick(), deg_per_tick, 4 * eps<Real>() * deg_per_tick + quantum_deg);
    double turned_deg = 0;
    double last_deg = 0;
    std::uint64_t last_tick = 0;
    const RunFigures figures = run_cycles<Real>(loop, c.engine, c.operation, c.cycles,
                                                [&](std::uint64_t tick, double deg, const WholeOutput<Real>&) {
                                                  EXPECT_EQ(tick, last_tick + 1);
                                                  turned_deg += deg >= last_deg ? deg - last_deg : deg - last_deg + 720;
                                                  last_deg = deg;
                                                  last_tick = tick;
                                                  if (tick == 1) {
                                                    EXPECT_NEAR(deg, loop.deg_per_tick(), 1e-9);
                                                  }
                                                });
    EXPECT_EQ(figures.ticks, last_tick);
    EXPECT_GE(turned_deg, c.cycles * 720 - 1.001e-3 * deg_per_tick - 1e-6);
    EXPECT_LT(turned_deg, c.cycles * 720 + deg_per_tick);
  }
}

TYPED_TEST(RunIn, RefusesASpeedBeyondOneRevolutionPerTickInsteadOfStandingStill) {
  const EngineDefinition engine = support::diesel_495();
  EXPECT_THROW((FixedStepLoop<TypeParam>(engine, {40000, 2e-3, 1})), UsageError);
  EXPECT_NO_THROW((FixedStepLoop<TypeParam>(engine, {29000, 2e-3, 1})));
}

TYPED_TEST(RunIn, RefusesARunThatWouldNotEnd) {
  const EngineDefinition engine = support::diesel_495();
  EXPECT_THROW((FixedStepLoop<TypeParam>(engine, {0.001, 10e-6, 1})), UsageError);
  const Operation operation{2000, 100e-6, 1};
  FixedStepLoop<TypeParam> loop(engine, operation);
  EXPECT_THROW(run_cycles<TypeParam>(loop, engine, operation, 10'000'000), UsageError);
}

TYPED_TEST(RunIn, MeasuresWhatATickCosts) {
  FixedStepLoop<TypeParam> loop(support::diesel_495(), {2000, 100e-6, 1});
  const double per_tick_ns = loop.wall_time_per_tick_ns();
  EXPECT_GT(per_tick_ns, 1);    // less is no clock
  EXPECT_LT(per_tick_ns, 1e5);  // sanitizers and a busy machine included
}

// ---- Accuracy and curves for the report ----

TYPED_TEST(RunIn, MeasuredAccuracyIsWithinTheTolerances) {
  using Real = TypeParam;
  ExactEngine exact;
  ASSERT_TRUE(accepted(exact.init(uneven_three())));
  const Operation operation{4000, 100e-6, 1};
  const FixedStepLoop<Real> loop(exact.definition(), operation);
  const auto tolerances = Tolerances::of<Real>(exact, operation, loop.tables());
  const Accuracy accuracy = measure_accuracy<Real>(exact, operation);
  EXPECT_LE(accuracy.torque.largest, tolerances.torque_Nm);
  for (const Quantity q : {Quantity::gas_force, Quantity::inertia_force, Quantity::side_force, Quantity::rod_force,
                           Quantity::radial_force, Quantity::tangential_force, Quantity::crank_pin_load}) {
    EXPECT_LE(accuracy.of[index_of(q)].largest, tolerances.force_N) << kQuantityKinds[index_of(q)].name;
    EXPECT_GT(accuracy.of[index_of(q)].peak, 1000) << kQuantityKinds[index_of(q)].name;
  }
}

TEST(Accuracy, FindsADifferenceWhereItIs) {
  Deviation deviation;
  deviation.take(1.0, 1.0, 10);
  deviation.take(-5.0, -5.5, 20);
  deviation.take(2.0, 2.25, 30);
  EXPECT_EQ(deviation.largest, 0.5);
  EXPECT_EQ(deviation.at_deg, 20);
  EXPECT_EQ(deviation.peak, 5.5);
  EXPECT_EQ(deviation.ratio(), 0.5 / 5.5);
}

TYPED_TEST(RunIn, ATraceIsOneCycleFromCylinderOnesFiring) {
  using Real = TypeParam;
  EngineDefinition engine = uneven_three();
  engine.layout.firing_deg = {500, 260, 20};  // cylinder 1 fires at 500: the trace still begins there
  ExactEngine exact;
  ASSERT_TRUE(accepted(exact.init(engine)));
  const Operation operation{4000, 100e-6, 1};
  const FixedStepLoop<Real> loop(engine, operation);
  const auto tolerances = Tolerances::of<Real>(exact, operation, loop.tables());
  const Trace trace = record_trace<Real>(engine, operation);
  ASSERT_EQ(trace.crank_deg.size(), 2881u);
  EXPECT_EQ(trace.crank_deg.front(), 0);
  EXPECT_EQ(trace.crank_deg.back(), 720);
  EXPECT_NEAR(trace.tick_s, 0.25 / (6 * 4000), 1e-15);
  const double drift_deg = 720 * eps<Real>();  // of the angle: every increment is rounded the same way
  for (std::size_t i = 0; i < trace.crank_deg.size(); i += 40) {
    const double engine_deg = trace.crank_deg[i] + 500;
    const double here = exact.torque_Nm(engine_deg, operation.speed_rad_s());
    const double slope = std::abs(exact.torque_Nm(engine_deg + 0.5, operation.speed_rad_s()) -
                                  exact.torque_Nm(engine_deg - 0.5, operation.speed_rad_s()));
    EXPECT_NEAR(trace.torque_Nm[i], here, tolerances.torque_Nm + 2 * drift_deg * slope) << trace.crank_deg[i];
  }
}

TYPED_TEST(RunIn, ATraceIsCoarserWhereItsTicksWouldBeTooShortAndSkipsTicksAtACrawl) {
  const Trace fastest = record_trace<TypeParam>(support::single_495(), {100000, 100e-6, 1});
  EXPECT_EQ(fastest.spacing_deg, 1);  // 0.6 deg is the least at 1 us
  EXPECT_EQ(fastest.crank_deg.size(), 721u);
  const Trace slowest = record_trace<TypeParam>(support::single_495(), {1, 100e-6, 1});
  EXPECT_EQ(slowest.spacing_deg, 0.25);
  EXPECT_LE(slowest.tick_s, 2e-3);
  EXPECT_EQ(slowest.crank_deg.size(), 2881u);
}

// ---- The command ----

/// Digits of a number's mantissa, without leading and trailing zeros: "-0.00120e-5" has two.
std::size_t significant_digits(const std::string& number) {
  std::string digits;
  for (const char c : number.substr(0, number.find('e'))) {
    if (c >= '0' && c <= '9') digits += c;
  }
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
  while (!digits.empty() && digits.back() == '0') digits.pop_back();
  return digits.size();
}

TEST_F(RunCommand, PrintsThe495AtItsRatedSpeed) {
  const std::string summary = run({kSample});
  EXPECT_EQ(line(summary, "speed"), std::make_pair(2000.0, std::string("rpm")));
  EXPECT_EQ(line(summary, "tick"), std::make_pair(100.0, std::string("us")));
  // 809.7 kPa over four cylinders of pi/4 95^2 115 mm^3, once in two turns.
  const double work_J = 809.7e3 * 4 * elementary::kPi / 4 * 0.095 * 0.095 * 0.115;
  EXPECT_NEAR(line(summary, "mean_torque").first, work_J / (4 * elementary::kPi), 0.02);
  EXPECT_NEAR(line(summary, "power").first, work_J * 2000 / 120 / 1000, 0.005);
  EXPECT_EQ(line(summary, "power").second, "kW");
  EXPECT_NEAR(line(summary, "brake_power").first, 4 * 8.8, 0.02);  // the sheet's 8.8 kW a cylinder
  EXPECT_NEAR(line(summary, "brake_torque").first * 2000 * elementary::kPi / 30,
              line(summary, "brake_power").first * 1000, 1);
  EXPECT_NEAR(line(summary, "mechanical_efficiency").first, 0.80, 0.001);
  EXPECT_NEAR(line(summary, "net_mep").first, 809.7, 0.08);
  EXPECT_NEAR(line(summary, "net_mep_exact").first, 809.7, 1e-3);
  EXPECT_NEAR(line(summary, "mean_piston_speed").first, 7.67, 0.005);  // the sheet's
  EXPECT_EQ(line(summary, "swept_volume").second, "cm^3");
  EXPECT_NEAR(line(summary, "swept_volume").first, 815.1, 0.05);
  EXPECT_EQ(line(summary, "faulty_ticks").first, 0);
  EXPECT_EQ(line(summary, "ticks").first, 1200);
  for (const char* name :
       {"max_torque", "min_torque", "max_pressure", "max_gas_force", "max_inertia_force", "min_inertia_force",
        "max_side_force", "min_side_force", "max_rod_force", "max_radial_force", "min_radial_force",
        "max_tangential_force", "min_tangential_force", "max_crank_pin_load", "max_main_journal_load"}) {
    EXPECT_FALSE(std::isnan(line(summary, name).first)) << name;
    EXPECT_FALSE(std::isnan(line(summary, std::string(name) + "_at").first)) << name;
  }
}

/// Against traces whose angles are half a degree too small and too large.
TEST_F(RunCommand, SaysWhatADegreeOfATracesAnglesCosts) {
  const std::string sample = contents(kSample);
  const auto run_of = [&](double later_deg) {
    IndicatorDiagram diagram;
    const EngineFile file = read_engine_file(kSample, {});
    EXPECT_TRUE(diagram.init(file.definition().crank, file.definition().pressure).ok());
    std::ofstream trace(path("trace.csv"));
    trace << "crank_deg,pressure_kPa\n";
    for (double deg = 0; deg < 720; deg += 0.25) {
      const double true_deg = deg - later_deg < 0 ? deg - later_deg + 720 : deg - later_deg;
      trace << deg << ',' << shortest(diagram.full_Pa(true_deg) / 1e3) << '\n';
    }
    trace.close();
    std::string text = sample;
    const std::string source = "source = wiebe";
    text.replace(text.find(source), source.size(), "source = angle_table\nfile = trace.csv");
    std::ofstream(path("trace.ini")) << text;
    return run({path("trace.ini"), "--cycles", "1"});
  };
  const double difference_kPa = line(run_of(0.5), "net_mep_exact").first - line(run_of(-0.5), "net_mep_exact").first;
  EXPECT_NEAR(line(run_of(0), "net_mep_per_degree").first / difference_kPa, 1, 2e-3);
  EXPECT_EQ(run({kSample, "--cycles", "1"}).find("net_mep_per_degree"), std::string::npos);
}

TEST_F(RunCommand, SaysThatAnEngineWithoutPressureHasInertiaOnly) {
  const std::string summary = run({engine_without_pressure(), "--report", path("report.html")});
  EXPECT_NE(summary.find("inertia only"), std::string::npos);
  EXPECT_TRUE(std::isnan(line(summary, "power").first));
  EXPECT_TRUE(std::isnan(line(summary, "max_pressure").first));
  EXPECT_NEAR(line(summary, "mean_torque").first, 0, 1e-3);
  const std::string page = contents(path("report.html"));
  EXPECT_NE(page.find("There is no pressure source"), std::string::npos);
  EXPECT_EQ(page.find("IMEP"), std::string::npos);
  EXPECT_EQ(page.find("NaN"), std::string::npos);
}

TEST_F(RunCommand, CsvHasAHeaderAndARowForEachTickOfTheRecordedCycles) {
  run({kSample, "--cycles", "3", "--rpm", "2100", "--csv", path("run.csv")});
  const std::vector<std::string> rows = split_at(contents(path("run.csv")), '\n');
  std::string header = "time_s,crank_deg,speed_rpm,torque_Nm,mean_torque_Nm";
  for (const char* c : {"c1", "c2", "c3", "c4"}) {
    for (const char* quantity : {"pressure_kPa", "displacement_mm", "velocity_m_s", "acceleration_m_s2", "gas_force_N",
                                 "inertia_force_N", "total_force_N", "side_force_N", "rod_force_N", "radial_force_N",
                                 "tangential_force_N", "torque_Nm", "tilting_moment_Nm", "crank_pin_load_N"}) {
      header += std::string(",") + c + "_" + quantity;
    }
  }
  for (const char* c : {"c1", "c2", "c3", "c4"}) {
    for (const char* train : {"intake", "exhaust"}) {
      for (const char* quantity : {"theoretical_lift_mm", "lift_mm", "velocity_m_s", "acceleration_m_s2",
                                   "train_force_N", "seat_force_N", "cam_force_N", "train_compression_mm", "regime"}) {
        header += std::string(",") + c + "_" + train + "_" + quantity;
      }
    }
  }
  ASSERT_FALSE(rows.empty());
  EXPECT_EQ(rows[0], header);
  EXPECT_EQ(rows.size() - 1, 1715u);  // 3 * 720 deg at 1.26 deg a tick: 1714.3
  const std::vector<std::string> second = split_at(rows[2], ',');
  ASSERT_EQ(second.size(), 5u + 4 * 14 + 4 * 2 * 9);
  EXPECT_EQ(second[0], "0.0002");
  EXPECT_NEAR(std::stod(second[1]), 2.52, 1e-5);
  EXPECT_EQ(second[2], "2100");
  double cylinders_Nm = 0;
  for (const std::size_t k : {0u, 1u, 2u, 3u}) cylinders_Nm += std::stod(second[5 + 14 * k + 11]);
  EXPECT_NEAR(std::stod(second[3]), cylinders_Nm, 1e-3);
}

TEST_F(RunCommand, CsvHasNineDigitsInFloatAndTwelveInDouble) {
  for (const auto& [real, most] : {std::pair<const char*, std::size_t>{"float", 9}, {"double", 12}}) {
    run({kSample, "--real", real, "--cycles", "1", "--csv", path("run.csv")});
    std::size_t longest = 0;
    for (const std::string& row : split_at(contents(path("run.csv")), '\n')) {
      const std::vector<std::string> cells = split_at(row, ',');
      if (cells[0] == "time_s") continue;
      for (std::size_t i = 3; i < cells.size(); ++i) longest = std::max(longest, significant_digits(cells[i]));
    }
    EXPECT_EQ(longest, most) << real;
  }
}

TEST_F(RunCommand, TheSameInputGivesTheSameCsv) {
  run({kSample, "--csv", path("one.csv")});
  run({kSample, "--csv", path("two.csv")});
  EXPECT_EQ(contents(path("one.csv")), contents(path("two.csv")));
  EXPECT_GT(contents(path("one.csv")).size(), 100'000u);
}

TEST_F(RunCommand, CsvOnStandardOutputLeavesTheSummaryToStandardError) {
  EXPECT_EQ(status_of(std::string("'") + kSample + "' --cycles 1 --csv -"), kSuccess);
  EXPECT_EQ(contents(path("out")).rfind("time_s,", 0), 0u);
  EXPECT_EQ(contents(path("out")).find("mean_torque ="), std::string::npos);
  EXPECT_NE(contents(path("err")).find("mean_torque ="), std::string::npos);
  EXPECT_EQ(contents(path("err")).find("running"), std::string::npos);  // progress is for terminals
}

TEST_F(RunCommand, ReportShowsEveryCurveThatTheDesignSheetAsksFor) {
  run({kSample, "--report", path("report.html")});
  const std::string page = contents(path("report.html"));
  for (const char* title :
       {"Piston displacement", "Piston velocity", "Piston acceleration",
        "Gas force, reciprocating inertia force and their sum", "Rod force", "Tangential force at the crank pin",
        "Radial force at the crank pin", "Side force on the cylinder wall", "Side force over the piston displacement",
        "Torque of one cylinder", "Engine torque, all cylinders", "Pressure over the volume", "Torque harmonics",
        "Forces per piston area"}) {
    EXPECT_NE(page.find(title), std::string::npos) << title;
  }
  EXPECT_NE(page.find("The cylinder pressure is not measured: it is synthesised with a net IMEP of 809.7 kPa"),
            std::string::npos);
  EXPECT_NE(page.find("0.2738"), std::string::npos);
  EXPECT_NE(page.find("assumed: not in the sheet; the usual one"), std::string::npos);  // the firing order's remark
  EXPECT_EQ(page.find("http"), page.find("http-equiv"));                                // and the SVG namespace below
  EXPECT_EQ(page.find("<script"), page.rfind("<script"));  // report_page_test.cpp has the one
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

TEST_F(RunCommand, WorksFromACrawlToTenThousandRpmAndFrom10UsTo2Ms) {
  const std::string fast = engine_up_to("10000");
  for (const char* real : {"float", "double"}) {
    for (const auto& [rpm, tick_us] :
         {std::pair<const char*, const char*>{"10000", "10"}, {"10000", "2000"}, {"1", "2000"}}) {
      const std::string summary = run(
          {fast, "--rpm", rpm, "--tick-us", tick_us, "--cycles", "1", "--real", real, "--report", path("report.html")});
      EXPECT_NEAR(line(summary, "net_mep").first, 809.7, 0.08) << rpm << " rpm, " << tick_us << " us, " << real;
      EXPECT_EQ(line(summary, "faulty_ticks").first, 0);
      EXPECT_EQ(contents(path("report.html")).find("NaN"), std::string::npos);
    }
  }
}

TEST_F(RunCommand, BadOptionsEndWithStatus2AndLeaveNoFile) {
  const std::string files =
      std::string("'") + kSample + "' --csv '" + path("run.csv") + "' --report '" + path("report.html") + "'";
  for (const char* bad : {"--rpm 0", "--rpm -5", "--rpm nan", "--tick-us 0.5", "--tick-us 2001", "--cycles 0",
                          "--cycles 1.5", "--real half", "--load-ratio 2.1", "--rpm 40000 --tick-us 2000",
                          "--rpm 0.001 --tick-us 1", "--speed 5", "--csv x --csv y"}) {
    EXPECT_EQ(status_of(files + " " + bad), kBadInput) << bad;
    EXPECT_EQ(contents(path("out")), "") << bad;
    EXPECT_NE(contents(path("err")), "") << bad;
    EXPECT_FALSE(std::filesystem::exists(path("run.csv"))) << bad;
    EXPECT_FALSE(std::filesystem::exists(path("report.html"))) << bad;
  }
  EXPECT_EQ(status_of("'" + engine_without_pressure() + "' --load-ratio 0.5"), kBadInput);
  EXPECT_EQ(status_of("'" + path("nowhere.ini") + "'"), kBadInput);
}

}  // namespace
}  // namespace crankloop::program::run_test

// Cylinder pressure synthesised from a heat release obeys its equations; the motored diagram of any source. Tables:
// indicator_table_test.cpp.
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/differences.hpp"
#include "support/indicator_diagrams.hpp"
#include "support/motored_cycle.hpp"
#include "support/random.hpp"

namespace crankloop::indicator_diagram_test {
namespace {

using namespace support;

// ---- synthesised ----------------------------------------------------------------------------------------------------

/// The 495's diagram as spec and sample engine have it.
WiebeDiagram wiebe_495() {
  WiebeDiagram w;
  w.net_mep_Pa = 809.7e3;
  return w;
}

Pressure wiebe_pressure(const WiebeDiagram& w) {
  Pressure pressure;
  pressure.source = PressureSource::wiebe;
  pressure.wiebe = w;
  return pressure;
}

struct Synthesised {
  Crank crank;
  WiebeDiagram wiebe;
  double top_deg, bottom_deg;
};

/// Any mechanism, any plausible combustion: heat given, so that every draw has an answer.
Synthesised random_synthesised(Random& random) {
  Synthesised s{};
  s.crank = support::random_crank(random);
  s.top_deg = dead_centres(s.crank).tdc_rad / kRadPerDeg;
  s.bottom_deg = dead_centres(s.crank).bdc_rad / kRadPerDeg;
  WiebeDiagram& w = s.wiebe;
  w.intake_Pa = random.between(30e3, 250e3);
  w.exhaust_Pa = random.between(90e3, 200e3);
  w.start_of_combustion_deg = random.between(-40, 20);
  w.combustion_duration_deg = random.between(10, 75);
  w.wiebe_m = random.between(0, 4);
  w.compression_exponent = random.between(1.1, 1.5);
  w.expansion_exponent = random.between(1.1, 1.5);
  w.exhaust_valve_opens_deg = random.between(100, s.bottom_deg - 8);
  w.heat_given = true;
  w.heat_J = random.between(0.2, 2) * support::swept_m3(s.crank) * 1e6;
  return s;
}

/// Share of the heat released, and nothing else: 1 - exp(-6.908 s^(m + 1)) [spec section 8].
double burnt_share(const WiebeDiagram& w, double deg) {
  const double s = (deg - w.start_of_combustion_deg) / w.combustion_duration_deg;
  if (s <= 0) return 0;
  return 1 - std::exp(-6.908 * std::pow(std::min(s, 1.0), w.wiebe_m + 1));
}

TEST(SynthesisedDiagram, IsIntakePressureInIntakeAndExhaustPressureInExhaust) {
  for (const double offset_ratio : {-0.2, 0.0, 0.2}) {
    const Crank crank = crank_with_offset(offset_ratio);
    const IndicatorDiagram diagram = diagram_of(crank, wiebe_pressure(wiebe_495()));
    const double top = dead_centres(crank).tdc_rad / kRadPerDeg;
    const double bottom = dead_centres(crank).bdc_rad / kRadPerDeg;
    for (double deg = bottom + 1e-6; deg < top + 360; deg += 0.9) EXPECT_EQ(diagram.full_Pa(deg), 105e3) << deg;
    for (double deg = top + 362; deg < bottom + 360; deg += 0.9) EXPECT_EQ(diagram.full_Pa(deg), 98e3) << deg;
  }
}

TEST(SynthesisedDiagram, CompressesAndExpandsByItsPolytropicExponents) {
  Random random;
  for (int draw = 0; draw < 100; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Synthesised s = random_synthesised(random);
    const WiebeDiagram& w = s.wiebe;
    const IndicatorDiagram diagram = diagram_of(s.crank, wiebe_pressure(w));
    const auto exponent = [&](double from_deg, double to_deg,
                              double (IndicatorDiagram::*curve)(double) const noexcept) {
      return -std::log((diagram.*curve)(to_deg) / (diagram.*curve)(from_deg)) /
             std::log(support::volume_m3(s.crank, to_deg) / support::volume_m3(s.crank, from_deg));
    };
    // The pressures' rounding, some 20 eps, over the logarithm of a volume ratio of at least 1.1.
    const double tolerance = 20 * kEps / std::log(1.1);
    const double compression_end = std::min(w.start_of_combustion_deg, s.top_deg - 8) + 720;
    EXPECT_NEAR(exponent(s.bottom_deg + 400, compression_end, &IndicatorDiagram::full_Pa), w.compression_exponent,
                tolerance);
    EXPECT_NEAR(diagram.full_Pa(s.bottom_deg + 360), w.intake_Pa, 20 * kEps * w.intake_Pa)
        << "compression begins at intake pressure";
    const double burnt_deg = w.start_of_combustion_deg + w.combustion_duration_deg;
    const double late = std::max(burnt_deg, 30.0);
    if (w.exhaust_valve_opens_deg > late + 15) {
      const double opens = w.exhaust_valve_opens_deg - 0.01;
      EXPECT_NEAR(exponent(late, opens, &IndicatorDiagram::full_Pa), w.expansion_exponent, tolerance);
      EXPECT_NEAR(exponent(late, opens, &IndicatorDiagram::motored_Pa), w.compression_exponent + 0.03, tolerance);
    }
    if (HasFailure()) return;
  }
}

TEST(SynthesisedDiagram, ObeysTheFirstLawDuringCombustionAtEveryAngle) {
  // dp/da = (n2 - 1)/V dQ/da - n2 p/V dV/da [spec section 8], every derivative by five-point differences of 0.05 deg.
  Random random;
  for (int draw = 0; draw < 60; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Synthesised s = random_synthesised(random);
    const WiebeDiagram& w = s.wiebe;
    const IndicatorDiagram diagram = diagram_of(s.crank, wiebe_pressure(w));
    const double h = 0.05;
    double largest = 0;
    double worst = 0;
    // From 10 % on: at the start dQ/da goes like s^m, whose fifth derivative is without bound.
    for (double share = 0.1; share < 0.99; share += 0.01) {
      const double deg = w.start_of_combustion_deg + share * w.combustion_duration_deg;
      const double dp = support::slope_of([&](double at) { return diagram.full_Pa(at); }, deg, h);
      const double dQ = support::slope_of([&](double at) { return w.heat_J * burnt_share(w, at); }, deg, h);
      const double dV = support::slope_of([&](double at) { return support::volume_m3(s.crank, at); }, deg, h);
      const double V = support::volume_m3(s.crank, deg);
      const double want = (w.expansion_exponent - 1) / V * dQ - w.expansion_exponent * diagram.full_Pa(deg) / V * dV;
      largest = std::max({largest, std::fabs(want), std::fabs((w.expansion_exponent - 1) / V * dQ)});
      worst = std::max(worst, std::fabs(dp - want));
    }
    // h^4/30 f^(5): in s = (a - a0)/da, h/da <= 0.005, and from s = 0.1 the fifth derivative of exp(-6.9 s^(m+1)) (m <=
    // 4) stays below 7e4 times its slope; 0.005^4/30 * 7e4 = 1.5e-6. Rounding: 1.5 * 10 eps p/h against a slope of at
    // least p/100 deg, 1e-11.
    EXPECT_LE(worst, 2e-6 * largest);
    if (HasFailure()) return;
  }
}

TEST(SynthesisedDiagram, IsTheSolutionThatRungeKuttaFindsFromTheFirstLaw) {
  Random random;
  for (int draw = 0; draw < 20; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    Synthesised s = random_synthesised(random);
    if (draw % 4 == 0) s.wiebe.wiebe_m = 0.9;
    const WiebeDiagram& w = s.wiebe;
    const IndicatorDiagram diagram = diagram_of(s.crank, wiebe_pressure(w));
    // In u with s = u^2, so that the heat's rate at the start, like s^m ds = 2 u^(2m+1) du, does not jump for any m >=
    // 0.
    const auto rate = [&](double u, double p) {
      const double deg = w.start_of_combustion_deg + w.combustion_duration_deg * u * u;
      const double deg_per_u = 2 * u * w.combustion_duration_deg;
      const support::Motion m = support::motion_at(s.crank, wide(deg) * support::kWidePi / 180, 1);
      const double area = kPi / 4 * s.crank.bore_m * s.crank.bore_m;
      const double dV = -static_cast<double>(m.piston_pin_velocity.up) * area * kRadPerDeg * deg_per_u;
      const double V = support::volume_m3(s.crank, deg);
      const double k = w.wiebe_m + 1;
      const double dQ =
          w.heat_J * 6.908 * 2 * k * (u > 0 ? std::pow(u, 2 * k - 1) : 0) * std::exp(-6.908 * std::pow(u, 2 * k));
      return (w.expansion_exponent - 1) / V * dQ - w.expansion_exponent * p / V * dV;
    };
    constexpr int kSteps = 4'000;
    double p = w.intake_Pa * std::pow(support::volume_m3(s.crank, s.bottom_deg) /
                                          support::volume_m3(s.crank, w.start_of_combustion_deg),
                                      w.compression_exponent);
    double peak = p;
    for (int i = 0; i < kSteps; ++i) {
      const double h = 1.0 / kSteps;
      const double u = i * h;
      const double k1 = rate(u, p);
      const double k2 = rate(u + h / 2, p + h / 2 * k1);
      const double k3 = rate(u + h / 2, p + h / 2 * k2);
      const double k4 = rate(u + h, p + h * k3);
      p += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      peak = std::max(peak, p);
      if ((i + 1) % 250 == 0) {
        const double deg = w.start_of_combustion_deg + w.combustion_duration_deg * (u + h) * (u + h);
        // Runge-Kutta's own error: steps of 1/4000, smooth but at u = 0 where u^(2m+1) leaves one of order h^2 in the
        // first step: 1e-7 of the first step's heat, 1e-7 of all. The library's quadrature: five points in each of 256
        // panels, the first one with s^m too.
        EXPECT_NEAR(diagram.full_Pa(deg), p, 2e-7 * peak) << deg;
      }
    }
    if (HasFailure()) return;
  }
}

TEST(SynthesisedDiagram, IsLinearInItsHeat) {
  Random random;
  for (int draw = 0; draw < 20; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Synthesised s = random_synthesised(random);
    const IndicatorDiagram once = diagram_of(s.crank, wiebe_pressure(s.wiebe));
    WiebeDiagram more = s.wiebe;
    more.heat_J *= 2;
    const IndicatorDiagram twice = diagram_of(s.crank, wiebe_pressure(more));
    more.heat_J *= 1.5;
    const IndicatorDiagram thrice = diagram_of(s.crank, wiebe_pressure(more));
    for (double deg = 0; deg < 720; deg += 2.3) {
      EXPECT_EQ(twice.motored_Pa(deg), once.motored_Pa(deg)) << "heat does not touch the motored cycle";
      const double p = thrice.full_Pa(deg);
      EXPECT_NEAR(p - twice.full_Pa(deg), twice.full_Pa(deg) - once.full_Pa(deg), 8 * kEps * p) << deg;
    }
  }
}

TEST(MotoredDiagram, WithoutLossRetracesTheCompressionVolumeForVolume) {
  WiebeDiagram w = wiebe_495();
  w.compression_exponent = w.expansion_exponent = w.motored_expansion_exponent = 1.32;
  for (const double offset_ratio : {-0.2, 0.0, 0.2}) {
    const Crank crank = crank_with_offset(offset_ratio);
    const IndicatorDiagram diagram = diagram_of(crank, wiebe_pressure(w));
    const double top = dead_centres(crank).tdc_rad / kRadPerDeg;
    const double bottom = dead_centres(crank).bdc_rad / kRadPerDeg;
    for (double deg = top + 1; deg < 134; deg += 1.1) {
      const double up = same_height_going_up(crank, deg, bottom, top);
      const double p = diagram.motored_Pa(deg);
      EXPECT_NEAR(p, diagram.motored_Pa(up), 1e-9 * p)
          << deg;  // the bisection's angle near top dead centre: 1e-8 of p's slope
    }
  }
}

TEST(SynthesisedDiagram, HasNoStepAnywhereWhereverItsEventsLie) {
  Random random;
  for (int draw = 0; draw < 12; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    Synthesised s = random_synthesised(random);
    s.wiebe.wiebe_m += 0.2;
    s.wiebe.wiebe_m = std::min(s.wiebe.wiebe_m, 3.0);
    s.wiebe.combustion_duration_deg = std::max(s.wiebe.combustion_duration_deg, 30.0);
    const WiebeDiagram& w = s.wiebe;
    const IndicatorDiagram diagram = diagram_of(s.crank, wiebe_pressure(w));
    double peak = 0;
    for (double deg = -90; deg < 180; deg += 0.1) peak = std::max(peak, diagram.full_Pa(deg));
    // Heat rises by at most 6.9 (m + 1)/da; compression by n V'/V; the ramp after gas exchange takes its one degree for
    // |intake - exhaust|.
    double shrinks = 0;
    for (double deg = -90; deg < 180; deg += 0.1) {
      shrinks = std::max(
          shrinks, std::fabs(support::volume_m3(s.crank, deg + 0.1) / support::volume_m3(s.crank, deg) - 1) / 0.1);
    }
    const double heat_rate = 6.908 * 4 / w.combustion_duration_deg * w.heat_J * (w.expansion_exponent - 1) /
                             support::volume_m3(s.crank, s.top_deg);
    const double blow_down =
        5.04 / (s.bottom_deg - w.exhaust_valve_opens_deg) * diagram.full_Pa(w.exhaust_valve_opens_deg);
    expect_no_step(diagram,
                   1.1 * std::max({heat_rate + 2 * shrinks * peak, blow_down, std::fabs(w.intake_Pa - w.exhaust_Pa)}),
                   "random diagram");
    if (HasFailure()) return;
  }
}

TEST(SynthesisedDiagram, HasNoJumpAtItsEvents) {
  // A billionth of a degree to either side: what is left is the slope's share and rounding.
  Random random;
  for (int draw = 0; draw < 200; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Synthesised s = random_synthesised(random);
    const WiebeDiagram& w = s.wiebe;
    const IndicatorDiagram diagram = diagram_of(s.crank, wiebe_pressure(w));
    for (const double event :
         {w.start_of_combustion_deg, w.start_of_combustion_deg + w.combustion_duration_deg, w.exhaust_valve_opens_deg,
          s.top_deg, s.bottom_deg, s.top_deg + 360, s.top_deg + 361, s.bottom_deg + 360, s.top_deg + 720}) {
      for (const auto curve : {&IndicatorDiagram::full_Pa, &IndicatorDiagram::motored_Pa, &IndicatorDiagram::heat_Pa}) {
        const double before = (diagram.*curve)(event - 1e-9);
        const double after = (diagram.*curve)(event + 1e-9);
        // Nothing in a draw is steeper than 100 bar/deg but a start of combustion with m near 0, like s^m: (1e-9/10)^(m
        // + 1) of the heat's 100 bar.
        EXPECT_NEAR(before, after, 3e-9 * 1000e5) << "at " << event;
      }
    }
    if (HasFailure()) return;
  }
}

TEST(SynthesisedDiagram, BlowsDownExponentiallyFromValveOpeningToExhaustPressureAtTheBottom) {
  const Crank crank = crank_with_offset(0.1);
  const IndicatorDiagram diagram = diagram_of(crank, wiebe_pressure(wiebe_495()));
  const double bottom = dead_centres(crank).bdc_rad / kRadPerDeg;
  EXPECT_NEAR(diagram.full_Pa(bottom - 1e-9), 105e3, 1);
  // Equal steps of an exponential: their falls form a geometric series.
  const double step = (bottom - 135) / 10;
  double fall_before = diagram.full_Pa(135) - diagram.full_Pa(135 + step);
  const double ratio = (diagram.full_Pa(135 + step) - diagram.full_Pa(135 + 2 * step)) / fall_before;
  EXPECT_GT(fall_before, 0);
  EXPECT_LT(ratio, 1);
  for (int i = 1; i < 9; ++i) {
    const double fall = diagram.full_Pa(135 + i * step) - diagram.full_Pa(135 + (i + 1) * step);
    EXPECT_NEAR(fall / fall_before, ratio, 1e-8) << i;
    fall_before = fall;
  }
}

TEST(SynthesisedDiagram, ScalesItsHeatToTheMeanEffectivePressureAskedForInAnyEngine) {
  Random random;
  for (int draw = 0; draw < 20; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    Synthesised s = random_synthesised(random);
    s.wiebe.heat_given = false;
    s.wiebe.net_mep_Pa = random.between(2e5, 20e5);
    IndicatorDiagram diagram;
    ASSERT_TRUE(accepted(diagram.init(s.crank, wiebe_pressure(s.wiebe)))) << "more than the motored one";
    EXPECT_GE(diagram.heat_J(), 0);
    constexpr int kSteps = 36'000;
    Wide work = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double a = 720.0 * i / kSteps;
      const double b = 720.0 * (i + 1) / kSteps;
      work +=
          wide(diagram.full_Pa((a + b) / 2)) * wide(support::volume_m3(s.crank, b) - support::volume_m3(s.crank, a));
    }
    // Midpoint pressures, h = 0.02 deg: h^2/12 of p' V'' and corners of p, some 1e-8 of 200 bar V_d, where random
    // events fall between steps.
    EXPECT_NEAR(static_cast<double>(work) / support::swept_m3(s.crank), s.wiebe.net_mep_Pa, 2e-8 * 200e5);
  }
}

TEST(SynthesisedDiagram, ReportsTheHeatItWasGiven) {
  WiebeDiagram w = wiebe_495();
  w.heat_given = true;
  w.heat_J = 1234.5;
  EXPECT_EQ(diagram_of(support::diesel_495_crank(), wiebe_pressure(w)).heat_J(), 1234.5);
}

TEST(SynthesisedDiagram, HeatFoundForTheMeanEffectivePressureGivesItBack) {
  WiebeDiagram w = wiebe_495();
  const IndicatorDiagram found = diagram_of(support::diesel_495_crank(), wiebe_pressure(w));
  w.heat_given = true;
  w.heat_J = found.heat_J();
  const IndicatorDiagram given = diagram_of(support::diesel_495_crank(), wiebe_pressure(w));
  for (double deg = 0; deg < 720; deg += 0.7)
    EXPECT_NEAR(given.full_Pa(deg), found.full_Pa(deg), 4 * kEps * 100e5) << deg;
  // Plausible, too: no more work than the ideal cycle with all heat at top dead centre, 1 - 19^(1 - 1.28) = 56 %, and
  // not much less.
  const double efficiency = w.net_mep_Pa * support::swept_m3(support::diesel_495_crank()) / found.heat_J();
  EXPECT_LT(efficiency, 1 - std::pow(19, 1 - w.expansion_exponent));
  EXPECT_GT(efficiency, 0.45);
}

// ---- motored --------------------------------------------------------------------------------------------------------

double net_mep_Pa(const Crank& crank, const IndicatorDiagram& diagram,
                  double (IndicatorDiagram::*curve)(double) const noexcept, int steps = 72'000) {
  return support::loop_work_J(
             crank, [&](double deg) { return (diagram.*curve)(deg); }, steps) /
         support::swept_m3(crank);
}

TEST(MotoredDiagram, OfThe495IsCompressedByOneExponentAndExpandedByALargerOneAndCosts25KPa) {
  const Crank crank = support::diesel_495_crank();
  const WiebeDiagram w = wiebe_495();
  const IndicatorDiagram diagram = diagram_of(crank, wiebe_pressure(w));
  constexpr double kUsual = 1.35 + 0.03;
  for (double deg = 0.05; deg < 720; deg += 0.37) {
    const double want = support::motored_cycle_Pa(crank, w, kUsual, deg);
    // The volume of the first degree after dead centre hangs on its rounding: 1e-16 of r, 1e-13 of the clearance
    // height.
    EXPECT_NEAR(diagram.motored_Pa(deg), want, 1e-11 * want) << deg;
  }
  const double loss_Pa = net_mep_Pa(crank, diagram, &IndicatorDiagram::motored_Pa);
  EXPECT_NEAR(loss_Pa, -25e3, 1e3);
}

TEST(MotoredDiagram, TakesTheExponentThatIsGiven) {
  const Crank crank = support::diesel_495_crank();
  for (const double exponent : {1.35, 1.40, 1.6}) {
    WiebeDiagram w = wiebe_495();
    w.motored_expansion_exponent = exponent;
    const IndicatorDiagram diagram = diagram_of(crank, wiebe_pressure(w));
    const IndicatorDiagram usual = diagram_of(crank, wiebe_pressure(wiebe_495()));
    for (double deg = 0.05; deg < 720; deg += 0.37) {
      const double want = support::motored_cycle_Pa(crank, w, exponent, deg);
      EXPECT_NEAR(diagram.motored_Pa(deg), want, 1e-11 * want) << deg;
      EXPECT_EQ(diagram.full_Pa(deg), usual.full_Pa(deg)) << "load ratio 1 knows nothing of it";
    }
  }
}

TEST(MotoredDiagram, PeaksAtDeadCentreInAnyEngine) {
  Random random;
  for (int draw = 0; draw < 40; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Synthesised s = random_synthesised(random);
    const IndicatorDiagram synthesised = diagram_of(s.crank, wiebe_pressure(s.wiebe));
    const Rows rows = support::angle_rows(smooth_pressure_Pa, 2);  // peaks 11 deg after dead centre, fired
    const IndicatorDiagram measured = diagram_of_rows(rows, PressureSource::angle_table, s.crank);
    for (const IndicatorDiagram* diagram : {&synthesised, &measured}) {
      double peak_deg = 0;
      for (double deg = -40; deg < 40; deg += 0.01) {
        if (diagram->motored_Pa(deg) > diagram->motored_Pa(peak_deg)) peak_deg = deg;
      }
      EXPECT_GE(peak_deg, s.top_deg - 2);
      EXPECT_LE(peak_deg, s.top_deg + 0.011);
    }
  }
}

/// A trace of any kind: charged or throttled, noisy, with pulsations.
Rows random_trace(Random& random) {
  const double intake_Pa = random.between(-0.6e5, 1.5e5);
  const double exhaust_Pa = random.between(0, 1.5e5);
  const double noise_Pa = random.coin() ? 0 : random.between(0, 0.3e5);
  return support::angle_rows(
      [&](double deg) {
        const double into = deg - 720 * std::floor(deg / 720);
        const double valves_Pa = into > 180 && into < 360 ? exhaust_Pa : into > 360 && into < 540 ? intake_Pa : 0;
        return smooth_pressure_Pa(deg) + valves_Pa + random.between(0, noise_Pa);
      },
      2);
}

TEST(MotoredDiagram, NeverGivesWorkWhateverItsSource) {
  Random random;
  for (int draw = 0; draw < 40; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Synthesised s = random_synthesised(random);
    const IndicatorDiagram synthesised = diagram_of(s.crank, wiebe_pressure(s.wiebe));
    const Rows rows = random_trace(random);
    const IndicatorDiagram measured = diagram_of_rows(rows, PressureSource::angle_table, s.crank);
    EXPECT_LT(net_mep_Pa(s.crank, synthesised, &IndicatorDiagram::motored_Pa, 7200), -1e3);
    EXPECT_LT(net_mep_Pa(s.crank, measured, &IndicatorDiagram::motored_Pa, 7200), -1e3);
  }
}

TEST(MotoredDiagram, OfALoopOverVolumeIsThatOfTheTraceOverAngle) {
  const Crank crank = crank_with_offset(0.1);
  const VolumeLoop loop = volume_loop(crank, smooth_pressure_Pa, 0.5, true);
  const IndicatorDiagram of_volumes = diagram_of_rows(loop.rows, PressureSource::volume_table, crank);
  const double mep_Pa = net_mep_Pa(crank, of_volumes, &IndicatorDiagram::motored_Pa);
  const Rows rows = support::angle_rows(smooth_pressure_Pa, 2);
  const IndicatorDiagram of_angles = diagram_of_rows(rows, PressureSource::angle_table, crank);
  EXPECT_LT(mep_Pa, -10e3);
  // Between rows 0.5 deg apart either table is off by h^2/4 of the bend, some hundred Pa at the peak, alike in sign up
  // and down.
  EXPECT_NEAR(mep_Pa, net_mep_Pa(crank, of_angles, &IndicatorDiagram::motored_Pa), 20);
}

TEST(SynthesisedDiagram, AnyMeanEffectivePressureFromTheMotoredOneOnIsMet) {
  const Crank crank = support::diesel_495_crank();
  const IndicatorDiagram usual = diagram_of(crank, wiebe_pressure(wiebe_495()));
  const double motored_Pa = net_mep_Pa(crank, usual, &IndicatorDiagram::motored_Pa);
  double before_Pa = motored_Pa;
  for (const double mep_Pa : {motored_Pa + 1, -20e3, 0.0, 20e3, 37e3, 38e3, 60e3, 809.7e3}) {
    WiebeDiagram w = wiebe_495();
    w.net_mep_Pa = mep_Pa;
    const IndicatorDiagram diagram = diagram_of(crank, wiebe_pressure(w));
    // Midpoint pressures, h = 0.01 deg: h^2/12 of p' V'' and corners of p, below 1e-8 of 200 bar.
    EXPECT_NEAR(net_mep_Pa(crank, diagram, &IndicatorDiagram::full_Pa), mep_Pa, 0.2) << mep_Pa;
    EXPECT_GE(diagram.heat_J(), 0);
    // Only the heat is another: the motored diagram stays, and a little more work is a little more pressure, without a
    // step.
    EXPECT_EQ(diagram.motored_Pa(30), usual.motored_Pa(30));
    EXPECT_GE(diagram.full_Pa(60), usual.motored_Pa(60));
    EXPECT_GT(mep_Pa, before_Pa);
    before_Pa = mep_Pa;
  }
  WiebeDiagram less = wiebe_495();
  less.net_mep_Pa = motored_Pa - 1;
  IndicatorDiagram diagram;
  EXPECT_TRUE(refuses(diagram.init(crank, wiebe_pressure(less)), Reason::no_solution, "pressure.wiebe.net_mep_Pa"));
}

/// A gas that expands by a larger exponent than air gives less than the motored cycle before it has any heat: nothing
/// lies between them and less than both.
TEST(SynthesisedDiagram, LessThanWithoutHeatIsNotMetByMotoring) {
  const Crank crank = support::diesel_495_crank();
  WiebeDiagram w = wiebe_495();
  w.compression_exponent = w.motored_expansion_exponent = 1.3;
  w.expansion_exponent = 1.45;
  const IndicatorDiagram usual = diagram_of(crank, wiebe_pressure(w));
  const double motored_Pa = net_mep_Pa(crank, usual, &IndicatorDiagram::motored_Pa);
  WiebeDiagram hardly = w;
  hardly.heat_given = true, hardly.heat_J = 1e-6;
  const double unheated_Pa = net_mep_Pa(crank, diagram_of(crank, wiebe_pressure(hardly)), &IndicatorDiagram::full_Pa);
  ASSERT_LT(unheated_Pa, motored_Pa - 5e3);
  IndicatorDiagram diagram;
  w.net_mep_Pa = unheated_Pa - 1e3;
  EXPECT_TRUE(refuses(diagram.init(crank, wiebe_pressure(w)), Reason::no_solution, "pressure.wiebe.net_mep_Pa"));
  w.net_mep_Pa = unheated_Pa + 1e3;
  ASSERT_TRUE(accepted(diagram.init(crank, wiebe_pressure(w))));
  EXPECT_GT(diagram.heat_J(), 0);
  EXPECT_NEAR(net_mep_Pa(crank, diagram, &IndicatorDiagram::full_Pa), w.net_mep_Pa, 0.2);
}

TEST(SynthesisedDiagram, WithoutHeatIsTheMotoredOne) {
  WiebeDiagram w = wiebe_495();
  w.heat_given = true;
  w.heat_J = 0;
  const IndicatorDiagram diagram = diagram_of(support::diesel_495_crank(), wiebe_pressure(w));
  for (double deg = 0; deg < 720; deg += 0.7) {
    EXPECT_EQ(diagram.full_Pa(deg), diagram.motored_Pa(deg)) << deg;
    EXPECT_EQ(diagram.heat_Pa(deg), 0) << deg;
  }
}

TEST(SynthesisedDiagram, RefusesAnExhaustValveThatOpensAfterTheBottomDeadCentreOfAnOffsetEngine) {
  // With the pin offset to the other side bottom dead centre comes before 180 deg: at 170.6 deg here.
  Crank crank = support::diesel_495_crank();
  crank.rod_length_m = crank.crank_radius_m / 0.45;
  crank.pin_offset_m = -0.2 * crank.crank_radius_m;
  WiebeDiagram w = wiebe_495();
  w.exhaust_valve_opens_deg = 170.5;
  IndicatorDiagram diagram;
  EXPECT_TRUE(accepted(diagram.init(crank, wiebe_pressure(w))));
  w.exhaust_valve_opens_deg = 175;
  EXPECT_TRUE(
      refuses(diagram.init(crank, wiebe_pressure(w)), Reason::inconsistent, "pressure.wiebe.exhaust_valve_opens_deg"));
}

TEST(SynthesisedDiagram, RefusesHeatAndCompressionThatWouldMakeMoreThanAThousandBar) {
  const Crank crank = support::diesel_495_crank();
  WiebeDiagram w = wiebe_495();
  w.heat_given = true;
  IndicatorDiagram diagram;
  // Pressure is linear in the heat: two diagrams tell how much of it adds 1000 bar where the second kJ adds most.
  IndicatorDiagram twice;
  w.heat_J = 1000;
  ASSERT_TRUE(accepted(diagram.init(crank, wiebe_pressure(w))));
  w.heat_J = 2000;
  ASSERT_TRUE(accepted(twice.init(crank, wiebe_pressure(w))));
  double added_Pa = 0;
  for (double deg = 0; deg < 90; deg += 0.1) added_Pa = std::max(added_Pa, twice.full_Pa(deg) - diagram.full_Pa(deg));
  w.heat_J = 1000 * 1e8 / added_Pa;
  EXPECT_TRUE(refuses(diagram.init(crank, wiebe_pressure(w)), Reason::pressure_too_high, "pressure.wiebe.heat_J"));
  w.heat_J *= 0.9;
  ASSERT_TRUE(accepted(diagram.init(crank, wiebe_pressure(w))));
  EXPECT_GT(diagram.peak_Pa(), 0.9e8);
  EXPECT_LT(diagram.peak_Pa(), 1e8);

  Crank pin_hole = crank;
  pin_hole.bore_m = 1e-9;
  w.heat_J = 1e9;
  EXPECT_TRUE(refuses(diagram.init(pin_hole, wiebe_pressure(w)), Reason::pressure_too_high, "pressure.wiebe.heat_J"));

  w = wiebe_495();
  w.net_mep_Pa = 1e8;  // a mean pressure of 1000 bar has a larger peak
  EXPECT_TRUE(refuses(diagram.init(crank, wiebe_pressure(w)), Reason::pressure_too_high, "pressure.wiebe.net_mep_Pa"));

  w = wiebe_495();
  w.intake_Pa = 1e7;  // 100 bar, compressed 19 times by the power of 1.35: 5000 bar without any heat
  w.heat_given = true;
  w.heat_J = 0;
  EXPECT_TRUE(refuses(diagram.init(crank, wiebe_pressure(w)), Reason::pressure_too_high, "pressure.wiebe.intake_Pa"));
}

TEST(Diagram, OfAnySourceKnowsItsPeak) {
  const Crank crank = support::diesel_495_crank();
  const Rows rows = support::angle_rows(smooth_pressure_Pa, 10);
  Pressure none;
  for (const Pressure& pressure :
       {none, wiebe_pressure(wiebe_495()), support::table_pressure(PressureSource::angle_table, rows)}) {
    const IndicatorDiagram diagram = diagram_of(crank, pressure);
    double peak_Pa = 0;
    for (int i = 0; i < 7200; ++i) peak_Pa = std::max(peak_Pa, diagram.full_Pa(i / 10.0));
    EXPECT_EQ(diagram.peak_Pa(), peak_Pa);
  }
}

TEST(SynthesisedDiagram, RefusesWhatItsDefinitionRefuses) {
  IndicatorDiagram diagram;
  Crank crank = support::diesel_495_crank();
  crank.bore_m = -1;
  EXPECT_TRUE(refuses(diagram.init(crank, wiebe_pressure(wiebe_495())), Reason::not_positive, "crank.bore_m"));
  WiebeDiagram w = wiebe_495();
  w.expansion_exponent = 1;
  EXPECT_TRUE(refuses(diagram.init(support::diesel_495_crank(), wiebe_pressure(w)), Reason::out_of_range,
                      "pressure.wiebe.expansion_exponent"));
  EXPECT_TRUE(accepted(diagram.init(support::diesel_495_crank(), wiebe_pressure(wiebe_495()))))
      << "a refusal leaves nothing behind";
  EXPECT_NEAR(diagram.full_Pa(400), 98e3, 1);
}

}  // namespace
}  // namespace crankloop::indicator_diagram_test

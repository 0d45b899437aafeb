// Definitions: what is accepted, what is refused and why, and how a drawn rod becomes the masses of the equations.
#include <crankloop/define/engine_definition.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "support/engines.hpp"
#include "support/status.hpp"

namespace crankloop::define_test {
namespace {

using support::Bad;
using support::inline_four;
using support::Random;
using support::refuses;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEps = std::numeric_limits<double>::epsilon();

// ---- crank ----------------------------------------------------------------------------------------------------------

TEST(CrankDefinition, OfThe495IsAccepted) { EXPECT_TRUE(accepted(validate(support::diesel_495_crank()))); }

TEST(CrankDefinition, OfAnyMechanismThatCanTurnIsAccepted) {
  Random random;
  for (int draw = 0; draw < 1'000; ++draw) {
    EXPECT_TRUE(accepted(validate(support::random_crank(random)))) << random.trace(draw);
  }
}

TEST(CrankDefinition, RefusesEveryLengthThatIsNoLengthByItsName) {
  const struct {
    double Crank::*member;
    const char* field;
    double most;
  } fields[] = {{&Crank::bore_m, "crank.bore_m", 2},
                {&Crank::crank_radius_m, "crank.crank_radius_m", 2},
                {&Crank::rod_length_m, "crank.rod_length_m", 10}};
  for (const auto& field : fields) {
    for (const Bad& bad :
         {Bad{0, Reason::not_positive}, Bad{-0.0, Reason::not_positive}, Bad{-0.1, Reason::not_positive},
          Bad{kNaN, Reason::not_finite}, Bad{kInfinity, Reason::not_finite}, Bad{-kInfinity, Reason::not_finite},
          Bad{std::nextafter(field.most, 100), Reason::out_of_range}}) {
      Crank crank = support::diesel_495_crank();
      crank.*field.member = bad.value;
      EXPECT_TRUE(refuses(validate(crank), bad.reason, field.field)) << bad.value;
    }
  }
}

TEST(CrankDefinition, RefusesAnOffsetThatIsNoNumber) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    Crank crank = support::diesel_495_crank();
    crank.pin_offset_m = bad;
    EXPECT_TRUE(refuses(validate(crank), Reason::not_finite, "crank.pin_offset_m"));
  }
  Crank crank = support::diesel_495_crank();
  crank.pin_offset_m = 2.1;
  EXPECT_TRUE(refuses(validate(crank), Reason::out_of_range, "crank.pin_offset_m"));
}

TEST(CrankDefinition, RefusesARodThatTheCrankCannotCarryRound) {
  // Without offset the rod must be longer than the crank; the offset, to either side, comes on top.
  for (const double offset : {0.0, 0.010, -0.010}) {
    Crank crank = support::diesel_495_crank();
    crank.pin_offset_m = offset;
    crank.rod_length_m = crank.crank_radius_m + std::fabs(offset);
    EXPECT_TRUE(refuses(validate(crank), Reason::rod_too_short, "crank.rod_length_m")) << offset;
    crank.rod_length_m *= 1 - 1e-9;
    EXPECT_TRUE(refuses(validate(crank), Reason::rod_too_short, "crank.rod_length_m")) << offset;
    // Nor with a rod that is longer by less than a billionth: the tangent of its angle would be anything.
    const double touching_m = crank.crank_radius_m + std::fabs(offset);
    for (const double rod_m : {std::nextafter(touching_m, 1), touching_m * (1 + 0.99e-9)}) {
      crank.rod_length_m = rod_m;
      EXPECT_TRUE(refuses(validate(crank), Reason::rod_too_short, "crank.rod_length_m")) << offset;
    }
    crank.rod_length_m = touching_m * (1 + 1.01e-9);
    EXPECT_TRUE(accepted(validate(crank))) << offset;
    crank.rod_length_m = touching_m * (1 + 1e-9);
    EXPECT_TRUE(refuses(validate(crank), Reason::rod_too_short, "crank.rod_length_m")) << "by a billionth, not more";
    crank.rod_length_m = std::nextafter(crank.rod_length_m, 1);
    EXPECT_TRUE(accepted(validate(crank))) << offset;
  }
}

TEST(CrankDefinition, RefusesACompressionRatioThatLeavesNoCylinder) {
  for (const Bad& bad :
       {Bad{1, Reason::out_of_range}, Bad{0.5, Reason::out_of_range}, Bad{-19, Reason::out_of_range},
        Bad{100.5, Reason::out_of_range}, Bad{kNaN, Reason::not_finite}, Bad{kInfinity, Reason::not_finite}}) {
    Crank crank = support::diesel_495_crank();
    crank.compression_ratio = bad.value;
    EXPECT_TRUE(refuses(validate(crank), bad.reason, "crank.compression_ratio")) << bad.value;
  }
}

TEST(CrankDefinition, RefusesAMaximumSpeedThatIsNone) {
  for (const Bad& bad : {Bad{-1, Reason::negative}, Bad{10472.5, Reason::out_of_range}, Bad{kNaN, Reason::not_finite},
                         Bad{kInfinity, Reason::not_finite}}) {
    Crank crank = support::diesel_495_crank();
    crank.max_speed_rad_s = bad.value;
    EXPECT_TRUE(refuses(validate(crank), bad.reason, "crank.max_speed_rad_s")) << bad.value;
  }
}

TEST(CrankDefinition, RodRatioIsCrankRadiusPerRodLength) {
  EXPECT_NEAR(support::diesel_495_crank().rod_ratio(), 0.2738, 0.00005);  // [495]
}

// ---- masses ---------------------------------------------------------------------------------------------------------

Masses diesel_495_masses() {
  Masses masses;
  masses.piston_kg = 0.810;
  masses.rod_small_end_kg = 0.505;
  masses.rod_big_end_kg = 1.382;
  return masses;
}

TEST(MassesDefinition, OfThe495AreAccepted) {
  EXPECT_TRUE(accepted(validate(diesel_495_masses())));
  EXPECT_NEAR(diesel_495_masses().reciprocating_kg(), 1.315, 2 * kEps);
}

TEST(MassesDefinition, RefusesEveryMassThatIsNoMassByItsName) {
  const struct {
    double Masses::*member;
    const char* field;
  } fields[] = {{&Masses::piston_kg, "masses.piston_kg"},
                {&Masses::rod_small_end_kg, "masses.rod_small_end_kg"},
                {&Masses::rod_big_end_kg, "masses.rod_big_end_kg"},
                {&Masses::crank_pin_equivalent_kg, "masses.crank_pin_equivalent_kg"},
                {&Masses::crank_inertia_kg_m2, "masses.crank_inertia_kg_m2"}};
  for (const auto& field : fields) {
    for (const Bad& bad :
         {Bad{-1e-9, Reason::negative}, Bad{kNaN, Reason::not_finite}, Bad{kInfinity, Reason::not_finite},
          Bad{-kInfinity, Reason::not_finite}, Bad{1e300, Reason::out_of_range}}) {
      Masses masses = diesel_495_masses();
      masses.*field.member = bad.value;
      EXPECT_TRUE(refuses(validate(masses), bad.reason, field.field)) << bad.value;
    }
  }
}

TEST(MassesDefinition, AllowsARodWhoseInertiaIsLessThanThatOfTwoMasses) {
  Masses masses = diesel_495_masses();
  masses.rod_inertia_correction_kg_m2 = -0.001;
  EXPECT_TRUE(accepted(validate(masses)));
  masses.rod_inertia_correction_kg_m2 = kNaN;
  EXPECT_TRUE(refuses(validate(masses), Reason::not_finite, "masses.rod_inertia_correction_kg_m2"));
}

TEST(MassesDefinition, RefusesARodOfNegativeInertia) {
  // dI = -m_rod_pin m_rod_crank/m_rod l^2 is a rod with all its mass in one point; less than that no rod has.
  EngineDefinition engine;
  engine.crank = support::diesel_495_crank();
  engine.masses = diesel_495_masses();
  const double l = engine.crank.rod_length_m;
  const double point_mass = -0.505 * 1.382 / 1.887 * l * l;
  engine.masses.rod_inertia_correction_kg_m2 = point_mass;
  EXPECT_TRUE(accepted(validate(engine)));
  engine.masses.rod_inertia_correction_kg_m2 = point_mass * 1.001;
  EXPECT_TRUE(refuses(validate(engine), Reason::negative, "masses.rod_inertia_correction_kg_m2"));
}

TEST(MassesDefinition, RefusesAnEngineInWhichNothingReciprocates) {
  Masses masses = diesel_495_masses();
  masses.piston_kg = 0;
  EXPECT_TRUE(accepted(validate(masses))) << "a weightless piston on a rod with a small end still has mass";
  masses.rod_small_end_kg = 0;
  EXPECT_TRUE(refuses(validate(masses), Reason::not_positive, "masses.piston_kg"));
}

TEST(LumpedRod, OfThe495HasTheWeighedEndsThatItsCentreOfMassGives) {
  // 505 g and 1382 g weighed: the centre of mass lies 505/1887 of the length from the crank pin [495].
  const Crank crank = support::diesel_495_crank();
  RigidRod rod;
  rod.mass_kg = 1.887;
  rod.com_to_crank_m = crank.rod_length_m * 505 / 1887;
  Masses masses;
  lump_rod(rod, crank, masses);
  EXPECT_NEAR(masses.rod_small_end_kg, 0.505, 4 * kEps);
  EXPECT_NEAR(masses.rod_big_end_kg, 1.382, 4 * kEps);
  EXPECT_NEAR(rod.com_to_crank_m / crank.rod_length_m, 0.268, 0.0005);
}

TEST(LumpedRod, OfAUniformBarTurnsLessEasilyThanTwoHalvesAtItsEnds) {
  // Two half masses at the ends have m l^2/4, the bar m l^2/12: dI = -m l^2/6.
  const Crank crank = support::diesel_495_crank();
  const double l = crank.rod_length_m;
  const RigidRod bar{1.2, l / 2, 1.2 * l * l / 12};
  Masses masses;
  lump_rod(bar, crank, masses);
  EXPECT_NEAR(masses.rod_small_end_kg, 0.6, 2 * kEps);
  EXPECT_NEAR(masses.rod_big_end_kg, 0.6, 2 * kEps);
  EXPECT_NEAR(masses.rod_inertia_correction_kg_m2, -1.2 * l * l / 6, 4 * kEps * 1.2 * l * l);
}

TEST(LumpedRod, OfTwoPointMassesNeedsNoCorrection) {
  const Crank crank = support::diesel_495_crank();
  const double l = crank.rod_length_m;
  // 0.505 kg at the piston pin and 1.382 kg at the crank pin, as a rigid body: moments about the common centre of mass.
  const double com = l * 0.505 / 1.887;
  const RigidRod rod{1.887, com, 1.382 * com * com + 0.505 * (l - com) * (l - com)};
  Masses masses;
  lump_rod(rod, crank, masses);
  EXPECT_NEAR(masses.rod_inertia_correction_kg_m2, 0, 8 * kEps * 1.887 * l * l);
}

TEST(CrankThrow, PullsOutwardAsItsPinAndBothWebsDo) {
  const Crank crank = support::diesel_495_crank();
  constexpr double kSpeed_rad_s = 210;
  const auto centrifugal_N = [&](double kg, double radius_m) { return kg * radius_m * kSpeed_rad_s * kSpeed_rad_s; };
  for (const CrankThrow& drawn : {CrankThrow{0.9, 1.4, 0.021}, CrankThrow{0.9, 1.4, 0}, CrankThrow{0, 1.4, 0.07}}) {
    Masses masses = diesel_495_masses();
    reduce_throw(drawn, crank, masses);
    const double of_parts_N = centrifugal_N(drawn.pin_kg, crank.crank_radius_m) +
                              centrifugal_N(drawn.web_kg, drawn.web_com_m) +
                              centrifugal_N(drawn.web_kg, drawn.web_com_m);
    EXPECT_NEAR(centrifugal_N(masses.crank_pin_equivalent_kg, crank.crank_radius_m), of_parts_N, 8 * kEps * of_parts_N);
    EXPECT_EQ(masses.reciprocating_kg(), diesel_495_masses().reciprocating_kg());
  }
}

TEST(LumpedRod, LeavesTheOtherMassesAlone) {
  Masses masses = diesel_495_masses();
  masses.crank_pin_equivalent_kg = 2;
  masses.crank_inertia_kg_m2 = 0.5;
  lump_rod(RigidRod{1, 0.05, 0.01}, support::diesel_495_crank(), masses);
  EXPECT_EQ(masses.piston_kg, 0.810);
  EXPECT_EQ(masses.crank_pin_equivalent_kg, 2);
  EXPECT_EQ(masses.crank_inertia_kg_m2, 0.5);
}

// ---- pressure -------------------------------------------------------------------------------------------------------

Pressure wiebe_pressure() {
  Pressure pressure;
  pressure.source = PressureSource::wiebe;
  pressure.wiebe.net_mep_Pa = 809.7e3;
  return pressure;
}

TEST(PressureDefinition, CrankcasePressureIsAskedForWhateverTheSource) {
  for (const PressureSource source :
       {PressureSource::none, PressureSource::wiebe, PressureSource::angle_table, PressureSource::volume_table}) {
    for (const Bad& bad : {Bad{0, Reason::not_positive}, Bad{-1, Reason::not_positive}, Bad{kNaN, Reason::not_finite},
                           Bad{kInfinity, Reason::not_finite}, Bad{2e7, Reason::out_of_range}}) {
      Pressure pressure = wiebe_pressure();
      pressure.source = source;
      pressure.crankcase_Pa = bad.value;
      EXPECT_TRUE(refuses(validate(pressure, support::diesel_495_crank()), bad.reason, "pressure.crankcase_Pa"));
    }
  }
}

TEST(PressureDefinition, RefusesEveryWiebeFigureOutsideItsRangeByItsName) {
  const struct {
    double WiebeDiagram::*member;
    const char* field;
    double bad;
    Reason reason;
  } cases[] = {
      {&WiebeDiagram::intake_Pa, "pressure.wiebe.intake_Pa", 0, Reason::not_positive},
      {&WiebeDiagram::intake_Pa, "pressure.wiebe.intake_Pa", kNaN, Reason::not_finite},
      {&WiebeDiagram::exhaust_Pa, "pressure.wiebe.exhaust_Pa", -1, Reason::not_positive},
      {&WiebeDiagram::exhaust_Pa, "pressure.wiebe.exhaust_Pa", 2e7, Reason::out_of_range},
      {&WiebeDiagram::start_of_combustion_deg, "pressure.wiebe.start_of_combustion_deg", -91, Reason::out_of_range},
      {&WiebeDiagram::start_of_combustion_deg, "pressure.wiebe.start_of_combustion_deg", 91, Reason::out_of_range},
      {&WiebeDiagram::combustion_duration_deg, "pressure.wiebe.combustion_duration_deg", 0.5, Reason::out_of_range},
      {&WiebeDiagram::combustion_duration_deg, "pressure.wiebe.combustion_duration_deg", 151, Reason::out_of_range},
      {&WiebeDiagram::wiebe_m, "pressure.wiebe.wiebe_m", -0.1, Reason::negative},
      {&WiebeDiagram::wiebe_m, "pressure.wiebe.wiebe_m", 10.1, Reason::out_of_range},
      {&WiebeDiagram::compression_exponent, "pressure.wiebe.compression_exponent", 0.9, Reason::out_of_range},
      {&WiebeDiagram::compression_exponent, "pressure.wiebe.compression_exponent", 2.1, Reason::out_of_range},
      {&WiebeDiagram::expansion_exponent, "pressure.wiebe.expansion_exponent", 1, Reason::out_of_range},
      {&WiebeDiagram::motored_expansion_exponent, "pressure.wiebe.motored_expansion_exponent", -0.1, Reason::negative},
      {&WiebeDiagram::motored_expansion_exponent, "pressure.wiebe.motored_expansion_exponent", 3.1,
       Reason::out_of_range},
      {&WiebeDiagram::motored_expansion_exponent, "pressure.wiebe.motored_expansion_exponent", 1.34,
       Reason::inconsistent},
      {&WiebeDiagram::expansion_exponent, "pressure.wiebe.expansion_exponent", kInfinity, Reason::not_finite},
      {&WiebeDiagram::exhaust_valve_opens_deg, "pressure.wiebe.exhaust_valve_opens_deg", 180, Reason::out_of_range},
      {&WiebeDiagram::exhaust_valve_opens_deg, "pressure.wiebe.exhaust_valve_opens_deg", 29, Reason::out_of_range},
      {&WiebeDiagram::net_mep_Pa, "pressure.wiebe.net_mep_Pa", kNaN, Reason::not_finite},
      {&WiebeDiagram::net_mep_Pa, "pressure.wiebe.net_mep_Pa", 2e8, Reason::out_of_range},
  };
  for (const auto& one : cases) {
    Pressure pressure = wiebe_pressure();
    pressure.wiebe.*one.member = one.bad;
    EXPECT_TRUE(refuses(validate(pressure, support::diesel_495_crank()), one.reason, one.field)) << one.bad;
  }
  Pressure pressure = wiebe_pressure();
  EXPECT_TRUE(accepted(validate(pressure, support::diesel_495_crank())));
  pressure.wiebe.heat_given = true;
  pressure.wiebe.heat_J = -1;
  EXPECT_TRUE(refuses(validate(pressure, support::diesel_495_crank()), Reason::negative, "pressure.wiebe.heat_J"));
  pressure.wiebe.heat_J = 1e10;
  EXPECT_TRUE(refuses(validate(pressure, support::diesel_495_crank()), Reason::out_of_range, "pressure.wiebe.heat_J"));
  pressure.wiebe.heat_J = kNaN;
  EXPECT_TRUE(refuses(validate(pressure, support::diesel_495_crank()), Reason::not_finite, "pressure.wiebe.heat_J"));
}

TEST(PressureDefinition, RefusesCombustionThatOutlastsTheClosedExhaustValve) {
  Pressure pressure = wiebe_pressure();
  pressure.wiebe.start_of_combustion_deg = 0;
  pressure.wiebe.exhaust_valve_opens_deg = 120;
  pressure.wiebe.combustion_duration_deg = 120;
  EXPECT_TRUE(accepted(validate(pressure, support::diesel_495_crank())));
  pressure.wiebe.combustion_duration_deg = 120.001;
  EXPECT_TRUE(refuses(validate(pressure, support::diesel_495_crank()), Reason::inconsistent,
                      "pressure.wiebe.combustion_duration_deg"));
}

/// An angle table with a point every 10 deg.
std::vector<DiagramPoint> flat_table() {
  std::vector<DiagramPoint> points;
  for (int i = 0; i < 72; ++i) points.push_back({10.0 * i, 1e5});
  return points;
}

Status validate_table(const std::vector<DiagramPoint>& points, PressureSource source = PressureSource::angle_table) {
  Pressure pressure;
  pressure.source = source;
  pressure.points = points.data();
  pressure.point_count = static_cast<int>(points.size());
  return validate(pressure, support::diesel_495_crank());
}

TEST(PressureDefinition, AcceptsATableOfOnePeriodWithAndWithoutItsClosingRowFromAnyStart) {
  for (const double start : {0.0, -360.0, -180.5, 1080.0}) {
    std::vector<DiagramPoint> points = flat_table();
    for (DiagramPoint& point : points) point.at += start;
    EXPECT_TRUE(accepted(validate_table(points))) << start;
    points.push_back({start + 720, 1e5});
    EXPECT_TRUE(accepted(validate_table(points))) << start;
  }
}

TEST(PressureDefinition, RefusesTablesThatAreNotOnePeriod) {
  std::vector<DiagramPoint> too_long = flat_table();
  too_long.push_back({720.1, 1e5});
  EXPECT_TRUE(refuses(validate_table(too_long), Reason::not_one_period, "pressure.points"));
  std::vector<DiagramPoint> one_turn = flat_table();
  one_turn.resize(37);
  EXPECT_TRUE(refuses(validate_table(one_turn), Reason::not_one_period, "pressure.points"));
}

TEST(PressureDefinition, AcceptsAGapThatClosesTheCircleUpToSixtyDegreesWide) {
  // 720 deg less the gap: the last row, alone beyond 650 deg, makes the gap.
  for (const double start : {0.0, -360.0}) {
    const auto with_gap = [&](double gap_deg) {
      std::vector<DiagramPoint> points;
      for (double at = 0; at < 650; at += 10) points.push_back({start + at, 1e5});
      points.push_back({start + 720 - gap_deg, 1e5});
      return validate_table(points);
    };
    EXPECT_TRUE(accepted(with_gap(59.9))) << start;
    EXPECT_TRUE(accepted(with_gap(60))) << start;
    EXPECT_TRUE(refuses(with_gap(60.1), Reason::not_one_period, "pressure.points")) << start;
  }
}

TEST(PressureDefinition, RefusesAnAngleTableSoFarFromZeroThatADoubleHardlyTellsItsAnglesApart) {
  for (const double start : {1e6 - 700, 1e9, 4e12, -1e6 - 1, -1e9}) {
    std::vector<DiagramPoint> points = flat_table();
    for (DiagramPoint& point : points) point.at += start;
    const int row = start == 1e6 - 700 ? 71 : 0;  // from 999 300 deg on, the last row is the one beyond 1e6
    EXPECT_TRUE(refuses(validate_table(points), Reason::out_of_range, "pressure.points", row)) << start;
  }
  for (const double start : {1e6 - 710, -1e6}) {
    std::vector<DiagramPoint> points = flat_table();
    for (DiagramPoint& point : points) point.at += start;
    EXPECT_TRUE(accepted(validate_table(points))) << start;
  }
}

TEST(PressureDefinition, RefusesRowsThatDoNotRiseAndNamesTheRow) {
  std::vector<DiagramPoint> points = flat_table();
  points[40].at = points[39].at;
  EXPECT_TRUE(refuses(validate_table(points), Reason::not_increasing, "pressure.points", 40));
  points[40].at = points[39].at - 5;
  EXPECT_TRUE(refuses(validate_table(points), Reason::not_increasing, "pressure.points", 40));
}

TEST(PressureDefinition, RefusesRowsThatAreNoNumbersOrNoPressuresAndNamesTheRow) {
  for (const PressureSource source : {PressureSource::angle_table, PressureSource::volume_table}) {
    for (const double bad : {kNaN, kInfinity, -kInfinity}) {
      std::vector<DiagramPoint> points = flat_table();
      points[17].at = bad;
      EXPECT_TRUE(refuses(validate_table(points, source), Reason::not_finite, "pressure.points", 17));
      points = flat_table();
      points[71].pressure_Pa = bad;
      EXPECT_TRUE(refuses(validate_table(points, source), Reason::not_finite, "pressure.points", 71));
    }
    std::vector<DiagramPoint> points = flat_table();
    points[5].pressure_Pa = -1;
    EXPECT_TRUE(refuses(validate_table(points, source), Reason::negative, "pressure.points", 5));
    points[5].pressure_Pa = 1.1e8;
    EXPECT_TRUE(refuses(validate_table(points, source), Reason::out_of_range, "pressure.points", 5));
  }
}

TEST(PressureDefinition, RefusesTablesThatAreMissingOrTooShortOrTooLong) {
  for (const PressureSource source : {PressureSource::angle_table, PressureSource::volume_table}) {
    EXPECT_TRUE(refuses(validate_table({}, source), Reason::too_few_points, "pressure.points"));
    std::vector<DiagramPoint> few = flat_table();
    few.resize(7);
    EXPECT_TRUE(refuses(validate_table(few, source), Reason::too_few_points, "pressure.points"));
    Pressure pressure;
    pressure.source = source;
    pressure.point_count = 100;  // and no rows
    EXPECT_TRUE(refuses(validate(pressure, support::diesel_495_crank()), Reason::too_few_points, "pressure.points"));
    pressure.points = few.data();
    pressure.point_count = -5;
    EXPECT_TRUE(refuses(validate(pressure, support::diesel_495_crank()), Reason::too_few_points, "pressure.points"));
    pressure.point_count = (1 << 20) + 1;  // refused by its count, no row is read
    EXPECT_TRUE(refuses(validate(pressure, support::diesel_495_crank()), Reason::too_many_points, "pressure.points"));
  }
}

TEST(GasDefinition, SaysWhichFieldIsWrong) {
  const EngineDefinition good = support::four_2000();
  EXPECT_TRUE(accepted(validate(good)));
  const auto refused = [&good](const auto& spoil, Reason reason, const char* field) {
    EngineDefinition engine = good;
    spoil(engine.gas);
    const Status answer = validate(engine);
    return answer.reason == reason && std::string(answer.field) == field;
  };
  EXPECT_TRUE(refused([](Gas& g) { g.intake_m3 = 0; }, Reason::not_positive, "gas.intake_m3"));
  EXPECT_TRUE(refused([](Gas& g) { g.exhaust_m3 = kNaN; }, Reason::not_finite, "gas.exhaust_m3"));
  EXPECT_TRUE(refused([](Gas& g) { g.throttle_closed_m2 = 1; }, Reason::inconsistent, "gas.throttle_closed_m2"));
  EXPECT_TRUE(refused([](Gas& g) { g.throttle_count = 1; }, Reason::too_few_points, "gas.throttle_ratio"));
  EXPECT_TRUE(refused([](Gas& g) { g.throttle_count = 17; }, Reason::too_many_points, "gas.throttle_ratio"));
  EXPECT_TRUE(refused([](Gas& g) { g.throttle_ratio[1] = 0; }, Reason::not_increasing, "gas.throttle_ratio"));
  EXPECT_TRUE(refused([](Gas& g) { g.throttle_ratio[3] = 0.9; }, Reason::inconsistent, "gas.throttle_ratio"));
  EXPECT_TRUE(refused([](Gas& g) { g.ambient_K = 149; }, Reason::out_of_range, "gas.ambient_K"));
  EXPECT_TRUE(refused([](Gas& g) { g.latch_deg = -89; }, Reason::out_of_range, "gas.latch_deg"));
  EXPECT_TRUE(refused([](Gas& g) { g.burn_start_deg = 101; }, Reason::out_of_range, "gas.burn_start_deg"));
  EXPECT_TRUE(refused([](Gas& g) { g.burn_start_deg = 60, g.burn_duration_deg = 91; }, Reason::inconsistent,
                      "gas.burn_duration_deg"));
  EXPECT_TRUE(refused([](Gas& g) { g.second_ratio = 0.1, g.burn_duration_deg = 60; }, Reason::inconsistent,
                      "gas.burn_duration_deg"));
  EXPECT_TRUE(refused([](Gas& g) { g.ports[1].port = GasPort::none; }, Reason::inconsistent, "gas.port"));
  EXPECT_TRUE(refused([](Gas& g) { g.ports[0].port = static_cast<GasPort>(3); }, Reason::inconsistent, "gas.port"));
  EXPECT_TRUE(refused([](Gas& g) { g.ports[0].seat_diameter_m = 0; }, Reason::not_positive, "gas.seat_diameter_m"));
  EXPECT_TRUE(refused([](Gas& g) { g.ports[0].flow_ratio[0] = 0.1; }, Reason::inconsistent, "gas.flow_lift_ratio"));
  EXPECT_TRUE(
      refused([](Gas& g) { g.ports[1].flow_lift_ratio[9] = 0.6; }, Reason::out_of_range, "gas.flow_lift_ratio"));
  EngineDefinition valveless = good;
  valveless.train_count = 0;
  EXPECT_TRUE(refuses(validate(valveless), Reason::inconsistent, "train_count"));
  EngineDefinition unread = good;  // of an engine with a diagram nothing of the gas counts
  unread.pressure.source = PressureSource::none;
  unread.gas.intake_m3 = -1;
  EXPECT_TRUE(accepted(validate(unread)));
}

TEST(GasDefinition, KeepsEveryRangeThatIsListed) {
  EngineDefinition good = support::four_2000();
  good.gas.throttle_closed_m2 = 0;
  good.gas.air_fuel_ratio = 100, good.gas.combustion_efficiency = 0.5;
  good.gas.burn_start_deg = -90;
  good.gas.second_ratio = 0;
  const struct {
    double Gas::*member;
    const char* field;
    double least, most;
    bool positive = false;
  } rules[] = {{&Gas::intake_m3, "gas.intake_m3", 1e-9, 100, true},
               {&Gas::exhaust_m3, "gas.exhaust_m3", 1e-9, 100, true},
               {&Gas::throttle_m2, "gas.throttle_m2", 1e-9, 10, true},
               {&Gas::outlet_m2, "gas.outlet_m2", 1e-9, 10, true},
               {&Gas::ambient_Pa, "gas.ambient_Pa", 1e3, 1e7},
               {&Gas::ambient_K, "gas.ambient_K", 150, 3000},
               {&Gas::exhaust_K, "gas.exhaust_K", 150, 3000},
               {&Gas::wall_K, "gas.wall_K", 150, 2000},
               {&Gas::wall_heat_ratio, "gas.wall_heat_ratio", 0, 100},
               {&Gas::fuel_kg, "gas.fuel_kg", 0, 0.01},
               {&Gas::heating_value_J_kg, "gas.heating_value_J_kg", 0, 2e8},
               {&Gas::combustion_efficiency, "gas.combustion_efficiency", 0, 1},
               {&Gas::air_fuel_ratio, "gas.air_fuel_ratio", 1, 100},
               {&Gas::latch_deg, "gas.latch_deg", -180, -90},
               {&Gas::burn_start_deg, "gas.burn_start_deg", -90, 60},
               {&Gas::burn_duration_deg, "gas.burn_duration_deg", 5, 150},
               {&Gas::wiebe_m, "gas.wiebe_m", 0, 10},
               {&Gas::second_ratio, "gas.second_ratio", 0, 1},
               {&Gas::second_m, "gas.second_m", 0, 10},
               {&Gas::second_duration_ratio, "gas.second_duration_ratio", 0.1, 10}};
  for (const auto& rule : rules) {
    const auto with = [&](double value) {
      EngineDefinition engine = good;
      engine.gas.*rule.member = value;
      if (rule.member == &Gas::air_fuel_ratio) engine.gas.heating_value_J_kg = 1e6;
      if (rule.member == &Gas::second_ratio) engine.gas.second_duration_ratio = 1;
      return validate(engine);
    };
    for (const double bad : {kNaN, kInfinity, -kInfinity})
      EXPECT_TRUE(refuses(with(bad), Reason::not_finite, rule.field)) << bad;
    EXPECT_TRUE(accepted(with(rule.least))) << rule.field;
    EXPECT_TRUE(accepted(with(rule.most))) << rule.field;
    const Reason below = rule.least == 0 ? Reason::negative : Reason::out_of_range;
    EXPECT_TRUE(refuses(with(std::nextafter(rule.least, -1e9)), below, rule.field));
    EXPECT_TRUE(refuses(with(std::nextafter(rule.most, 1e9)), Reason::out_of_range, rule.field));
    if (rule.positive) {
      EXPECT_TRUE(refuses(with(0), Reason::not_positive, rule.field));
    }
  }
  good.gas.throttle_closed_m2 = good.gas.throttle_m2;
  EXPECT_TRUE(accepted(validate(good))) << "a throttle that shuts nothing";
  good.gas.throttle_closed_m2 = std::nextafter(good.gas.throttle_m2, 1);
  EXPECT_TRUE(refuses(validate(good), Reason::inconsistent, "gas.throttle_closed_m2"));
  good.gas.throttle_closed_m2 = -1e-9;
  EXPECT_TRUE(refuses(validate(good), Reason::negative, "gas.throttle_closed_m2"));
}

TEST(GasDefinition, HasCrevicesAndALeakWithinTheirRanges) {
  const EngineDefinition good = support::four_2000();
  const auto with = [&good](double Crevice::*member, double value) {
    EngineDefinition engine = good;
    engine.gas.crevice.*member = value;
    return validate(engine);
  };
  const struct {
    double Crevice::*member;
    const char* field;
    double most;
  } rules[] = {{&Crevice::volume_ratio, "crevice.volume_ratio", 0.1},
               {&Crevice::blow_by_m2, "crevice.blow_by_m2", 5e-6}};
  for (const auto& rule : rules) {
    for (const double accepted_one : {0.0, rule.most}) EXPECT_TRUE(accepted(with(rule.member, accepted_one)));
    EXPECT_TRUE(refuses(with(rule.member, std::nextafter(rule.most, 1)), Reason::out_of_range, rule.field));
    EXPECT_TRUE(refuses(with(rule.member, -1e-9), Reason::negative, rule.field));
    EXPECT_TRUE(refuses(with(rule.member, kNaN), Reason::not_finite, rule.field));
  }
}

TEST(GasDefinition, HasRunnersWithinTheirRanges) {
  const EngineDefinition good = support::four_2000();
  const auto with = [&good](Runner Gas::*side, const Runner& runner) {
    EngineDefinition engine = good;
    engine.gas.*side = runner;
    return validate(engine);
  };
  for (int port = 0; port < 2; ++port) {
    Runner Gas::*const side = port == 0 ? &Gas::intake_runner : &Gas::exhaust_runner;
    EXPECT_TRUE(accepted(with(side, {0, kNaN, -1}))) << "no runner: nothing of it counts";
    EXPECT_TRUE(accepted(with(side, {0.02, 0.005, 0})));
    EXPECT_TRUE(accepted(with(side, {3, 0.2, 10})));
    EXPECT_TRUE(refuses(with(side, {std::nextafter(0.02, 0), 0.04, 0}), Reason::out_of_range, "runner.length_m", port));
    EXPECT_TRUE(refuses(with(side, {std::nextafter(3.0, 4), 0.04, 0}), Reason::out_of_range, "runner.length_m", port));
    EXPECT_TRUE(refuses(with(side, {-0.3, 0.04, 0}), Reason::negative, "runner.length_m", port));
    EXPECT_TRUE(refuses(with(side, {kNaN, 0.04, 0}), Reason::not_finite, "runner.length_m", port));
    EXPECT_TRUE(refuses(with(side, {0.3, 0, 0}), Reason::out_of_range, "runner.diameter_m", port));
    EXPECT_TRUE(refuses(with(side, {0.3, std::nextafter(0.2, 1), 0}), Reason::out_of_range, "runner.diameter_m", port));
    EXPECT_TRUE(refuses(with(side, {0.3, 0.04, -0.1}), Reason::negative, "runner.loss_ratio", port));
    EXPECT_TRUE(refuses(with(side, {0.3, 0.04, 10.1}), Reason::out_of_range, "runner.loss_ratio", port));
  }
}

TEST(GasDefinition, HasWallsThatWarmUpWithinTheirRanges) {
  const auto with = [](const Walls& walls) {
    EngineDefinition engine = support::four_2000();
    engine.gas.walls = walls;
    return validate(engine);
  };
  EXPECT_TRUE(accepted(with({0, kNaN, kNaN, 0, 0, kNaN}))) << "none: nothing of it counts";
  EXPECT_TRUE(accepted(with({1, 0, 150, 0, 0, 0})));
  EXPECT_TRUE(accepted(with({1e6, 1e5, 2000, 1e5, 1e5, 3000})));
  EXPECT_TRUE(refuses(with({0.99, 20, 363, 0, 0, 0}), Reason::out_of_range, "walls.capacity_J_K"));
  EXPECT_TRUE(refuses(with({-1, 20, 363, 0, 0, 0}), Reason::negative, "walls.capacity_J_K"));
  EXPECT_TRUE(refuses(with({kNaN, 20, 363, 0, 0, 0}), Reason::not_finite, "walls.capacity_J_K"));
  EXPECT_TRUE(refuses(with({1500, -1, 363, 0, 0, 0}), Reason::negative, "walls.to_coolant_W_K"));
  EXPECT_TRUE(refuses(with({1500, 20, 149, 0, 0, 0}), Reason::out_of_range, "walls.coolant_K"));
  EXPECT_TRUE(refuses(with({0, 20, 363, 1e6, 0, 0}), Reason::out_of_range, "walls.intake_W_K"));
  EXPECT_TRUE(refuses(with({0, 20, 363, 0, -2, 0}), Reason::negative, "walls.exhaust_W_K"));
  EXPECT_TRUE(refuses(with({0, 20, 363, 0, 2, 149}), Reason::out_of_range, "walls.manifold_K"));
}

TEST(GasDefinition, HasAnOctaneNumberOrNone) {
  const auto with = [](double octane_number) {
    EngineDefinition engine = support::four_2000();
    engine.gas.octane_number = octane_number;
    return validate(engine);
  };
  for (const double good : {0.0, 60.0, 120.0}) EXPECT_TRUE(accepted(with(good)));
  for (const double bad : {std::nextafter(60.0, 0), std::nextafter(120.0, 121), 1.0})
    EXPECT_TRUE(refuses(with(bad), Reason::out_of_range, "gas.octane_number"));
  EXPECT_TRUE(refuses(with(-1), Reason::negative, "gas.octane_number"));
  EXPECT_TRUE(refuses(with(kNaN), Reason::not_finite, "gas.octane_number"));
}

TEST(GasDefinition, HasABurnByChargeWithinItsRanges) {
  const EngineDefinition good = support::four_2000();
  const auto with = [&good](double ChargeBurn::*field, double value, bool in_use = true) {
    EngineDefinition engine = good;
    engine.gas.charge_burn.in_use = in_use, engine.gas.charge_burn.*field = value;
    return validate(engine);
  };
  const struct {
    double ChargeBurn::*field;
    const char* name;
    double least, most;
  } ranges[] = {{&ChargeBurn::spark_to_start_deg, "charge_burn.spark_to_start_deg", 0, 40},
                {&ChargeBurn::reference_rad_s, "charge_burn.reference_rad_s", 1, 10500},
                {&ChargeBurn::reference_K, "charge_burn.reference_K", 300, 1500},
                {&ChargeBurn::reference_Pa, "charge_burn.reference_Pa", 1e4, 1e8},
                {&ChargeBurn::reference_burned_ratio, "charge_burn.reference_burned_ratio", 0, 0.3},
                {&ChargeBurn::reference_excess_air_ratio, "charge_burn.reference_excess_air_ratio", 0.72, 1.42}};
  for (const auto& range : ranges) {
    EXPECT_TRUE(accepted(with(range.field, range.least)));
    EXPECT_TRUE(accepted(with(range.field, range.most)));
    EXPECT_TRUE(refuses(with(range.field, std::nextafter(range.most, 1e9)), Reason::out_of_range, range.name));
    EXPECT_TRUE(refuses(with(range.field, kNaN), Reason::not_finite, range.name));
    EXPECT_FALSE(with(range.field, std::nextafter(range.least, -1)).ok()) << range.name;
    EXPECT_TRUE(accepted(with(range.field, kNaN, false))) << "not in use: nothing of it counts";
  }
}

TEST(GasDefinition, HasABackPressureOrThatOfTheAmbient) {
  EngineDefinition engine = support::four_2000();
  engine.gas.ambient_Pa = 95e3;
  EXPECT_EQ(engine.gas.behind_outlet_Pa(), 95e3);
  for (const double good : {0.0, 1e3, 130e3, 1e7}) {
    engine.gas.back_Pa = good;
    EXPECT_TRUE(accepted(validate(engine))) << good;
    EXPECT_EQ(engine.gas.behind_outlet_Pa(), good > 0 ? good : 95e3);
  }
  const struct {
    double back_Pa;
    Reason reason;
  } refused[] = {{999, Reason::out_of_range},      {std::nextafter(1e7, 1e9), Reason::out_of_range},
                 {-1e5, Reason::negative},         {kNaN, Reason::not_finite},
                 {-kInfinity, Reason::not_finite}, {kInfinity, Reason::not_finite}};
  for (const auto& bad : refused) {
    engine.gas.back_Pa = bad.back_Pa;
    EXPECT_TRUE(refuses(validate(engine), bad.reason, "gas.back_Pa")) << bad.back_Pa;
  }
}

TEST(GasDefinition, HasABurnThatEndsBy150Degrees) {
  EngineDefinition engine = support::four_2000();
  Gas& gas = engine.gas;
  gas.burn_start_deg = -10, gas.burn_duration_deg = 80;
  gas.second_ratio = 0.2, gas.second_duration_ratio = 2;
  EXPECT_TRUE(accepted(validate(engine))) << "from -10 for 160 deg";
  gas.burn_duration_deg = std::nextafter(80.0, 100);
  EXPECT_TRUE(refuses(validate(engine), Reason::inconsistent, "gas.burn_duration_deg"));
  gas.second_duration_ratio = 0.5;
  EXPECT_TRUE(accepted(validate(engine))) << "the first law is the longer one";
  gas.second_ratio = 0, gas.second_duration_ratio = 10;
  EXPECT_TRUE(accepted(validate(engine))) << "no fuel burns by the second";
}

TEST(GasDefinition, HasCurvesFrom0WithSharesOf0To1) {
  const EngineDefinition good = support::four_2000();
  const auto refused_row = [&good](const auto& spoil, Reason reason, const char* field, int index) {
    EngineDefinition engine = good;
    spoil(engine.gas);
    return reason == Reason::ok ? accepted(validate(engine)) : refuses(validate(engine), reason, field, index);
  };
  // Of a port the train is named, of the throttle the row.
  EXPECT_TRUE(refused_row([](Gas& g) { g.ports[1].flow_ratio[9] = 1; }, Reason::ok, "", 0));
  EXPECT_TRUE(refused_row([](Gas& g) { g.ports[1].flow_ratio[9] = std::nextafter(1.0, 2); }, Reason::out_of_range,
                          "gas.flow_ratio", 1));
  EXPECT_TRUE(refused_row([](Gas& g) { g.ports[0].flow_ratio[3] = -1e-300; }, Reason::negative, "gas.flow_ratio", 0));
  EXPECT_TRUE(refused_row([](Gas& g) { g.ports[1].flow_lift_ratio[9] = std::nextafter(0.5, 1); }, Reason::out_of_range,
                          "gas.flow_lift_ratio", 1));
  EXPECT_TRUE(refused_row([](Gas& g) { g.ports[1].flow_lift_ratio[0] = 1e-300; }, Reason::inconsistent,
                          "gas.flow_lift_ratio", 1));
  EXPECT_TRUE(refused_row([](Gas& g) { g.ports[0].flow_count = kMaxFlowPoints + 1; }, Reason::too_many_points,
                          "gas.flow_lift_ratio", 0));
  EXPECT_TRUE(refused_row([](Gas& g) { g.ports[0].flow_count = 1; }, Reason::too_few_points, "gas.flow_lift_ratio", 0));
  EXPECT_TRUE(refused_row([](Gas& g) { g.ports[0].flow_count = 2; }, Reason::ok, "", 0));
  EXPECT_TRUE(refused_row([](Gas& g) { g.throttle_area_ratio[2] = std::nextafter(1.0, 2); }, Reason::out_of_range,
                          "gas.throttle_area_ratio", 2));
  EXPECT_TRUE(refused_row([](Gas& g) { g.throttle_ratio[0] = 1e-300; }, Reason::inconsistent, "gas.throttle_ratio", 0));
  EXPECT_TRUE(refused_row([](Gas& g) { g.throttle_ratio[2] = 0.2; }, Reason::not_increasing, "gas.throttle_ratio", 2));
  EXPECT_TRUE(refused_row([](Gas& g) { g.throttle_ratio[3] = std::nextafter(1.0, 2); }, Reason::out_of_range,
                          "gas.throttle_ratio", 3));
  EXPECT_TRUE(refused_row([](Gas& g) { g.throttle_ratio[3] = std::nextafter(1.0, 0); }, Reason::inconsistent,
                          "gas.throttle_ratio", 3));
  const auto full = [](Gas& g) {
    g.throttle_count = kMaxFlowPoints;
    for (int i = 0; i < kMaxFlowPoints; ++i) g.throttle_ratio[i] = i / 15.0, g.throttle_area_ratio[i] = 1;
  };
  EXPECT_TRUE(refused_row(full, Reason::ok, "", 0));
}

TEST(GasDefinition, AcceptsEveryFuelAndRefusesAMixtureHotterThanAny) {
  const auto answer = [](double heating_value_J_kg, double air_fuel_ratio, double efficiency = 1) {
    EngineDefinition engine = support::four_2000();
    engine.gas.heating_value_J_kg = heating_value_J_kg;
    engine.gas.air_fuel_ratio = air_fuel_ratio;
    engine.gas.combustion_efficiency = efficiency;
    return validate(engine);
  };
  const struct {
    const char* name;
    double lower_J_kg, air_fuel_ratio;
  } fuels[] = {{"petrol", 43e6, 14.6},      {"diesel", 42.5e6, 14.5},     {"methane", 50e6, 17.2},
               {"propane", 46.4e6, 15.7},   {"hydrogen", 120e6, 34.3},    {"methanol", 19.9e6, 6.45},
               {"ethanol", 26.8e6, 9},      {"ammonia", 18.6e6, 6.05},    {"carbon monoxide", 10.1e6, 2.46},
               {"acetylene", 48.2e6, 13.3}, {"nitromethane", 11.3e6, 1.7}};
  for (const auto& fuel : fuels) EXPECT_TRUE(accepted(answer(fuel.lower_J_kg, fuel.air_fuel_ratio))) << fuel.name;
  EXPECT_TRUE(refuses(answer(43e6, 1.46, 0.97), Reason::too_much_heat, "gas.air_fuel_ratio"))
      << "14.6 mistyped: 17 MJ per kg of mixture";
  EXPECT_TRUE(refuses(answer(200e6, 14.6), Reason::too_much_heat, "gas.air_fuel_ratio"));
  EXPECT_TRUE(accepted(answer(10e6, 1))) << "5 MJ/kg of mixture";
  EXPECT_TRUE(refuses(answer(std::nextafter(10e6, 1e9), 1), Reason::too_much_heat, "gas.air_fuel_ratio"));
  EXPECT_TRUE(accepted(answer(40e6, 1, 0.25))) << "what does not burn releases nothing";
}

TEST(PressureDefinition, RefusesASourceThatIsNone) {
  Pressure pressure = wiebe_pressure();
  for (const int number : {5, 6, 128, 255}) {
    pressure.source = static_cast<PressureSource>(number);
    EXPECT_TRUE(refuses(validate(pressure, support::diesel_495_crank()), Reason::out_of_range, "pressure.source"))
        << number;
  }
}

// ---- the whole ------------------------------------------------------------------------------------------------------

TEST(EngineDefinition, IsRefusedForItsFirstBadPart) {
  EngineDefinition engine;
  engine.crank = support::diesel_495_crank();
  engine.masses = diesel_495_masses();
  engine.layout = inline_four();
  engine.pressure = wiebe_pressure();
  EXPECT_TRUE(accepted(validate(engine)));
  engine.pressure.crankcase_Pa = -1;
  EXPECT_TRUE(refuses(validate(engine), Reason::not_positive, "pressure.crankcase_Pa"));
  engine.layout.cylinders = 0;
  EXPECT_TRUE(refuses(validate(engine), Reason::out_of_range, "layout.cylinders"));
  engine.masses.piston_kg = -1;
  EXPECT_TRUE(refuses(validate(engine), Reason::negative, "masses.piston_kg"));
  engine.crank.bore_m = 0;
  EXPECT_TRUE(refuses(validate(engine), Reason::not_positive, "crank.bore_m"));
}

TEST(Reasons, EachHaveTheirOwnWords) {
  std::vector<std::string> phrases;
  for (int i = 0; i <= static_cast<int>(Reason::too_much_heat); ++i) {
    const std::string phrase = describe(static_cast<Reason>(i));
    EXPECT_FALSE(phrase.empty());
    for (const std::string& earlier : phrases) EXPECT_NE(phrase, earlier);
    phrases.push_back(phrase);
  }
  EXPECT_STREQ(describe(static_cast<Reason>(255)), "unknown reason");
}

// ---- what turns and brakes the crankshaft ---------------------------------------------------------------------------

template <class Part>
void expect_none_or_positive(const char* field, double Part::*member, double most) {
  for (const Bad& bad :
       {Bad{-1e-9, Reason::negative}, Bad{kNaN, Reason::not_finite}, Bad{kInfinity, Reason::not_finite},
        Bad{std::nextafter(most, kInfinity), Reason::out_of_range}}) {
    Part part;
    part.*member = bad.value;
    EXPECT_TRUE(refuses(validate(part), bad.reason, field)) << bad.value;
  }
  for (const double good : {0.0, most}) {
    Part part;
    part.*member = good;
    EXPECT_TRUE(accepted(validate(part))) << field << " " << good;
  }
}

TEST(CrankshaftDefinition, HasFrictionByAnyOfItsParts) {
  EXPECT_FALSE(Friction{}.any());
  for (double Friction::*part : {&Friction::constant_Pa, &Friction::linear_Pa_s, &Friction::quadratic_Pa_s2}) {
    Friction friction;
    friction.*part = 1e-9;
    EXPECT_TRUE(friction.any());
  }
}

TEST(CrankshaftDefinition, RefusesFrictionLoadAndStarterOutsideTheirRangesByName) {
  expect_none_or_positive("friction.constant_Pa", &Friction::constant_Pa, 1e7);
  expect_none_or_positive("friction.linear_Pa_s", &Friction::linear_Pa_s, 1e6);
  expect_none_or_positive("friction.quadratic_Pa_s2", &Friction::quadratic_Pa_s2, 1e6);
  expect_none_or_positive("machine.constant_Nm", &DrivenMachine::constant_Nm, 1e7);
  expect_none_or_positive("machine.linear_Nm_s", &DrivenMachine::linear_Nm_s, 1e6);
  expect_none_or_positive("machine.quadratic_Nm_s2", &DrivenMachine::quadratic_Nm_s2, 1e6);
  expect_none_or_positive("machine.inertia_kg_m2", &DrivenMachine::inertia_kg_m2, 1e6);
  EXPECT_TRUE(refuses(validate(Starter{-1, 10}), Reason::negative, "starter.stall_Nm"));
  EXPECT_TRUE(
      refuses(validate(Starter{1, 0}), Reason::not_positive, "starter.no_load_rad_s"));  // a torque that never ends
  EXPECT_TRUE(refuses(validate(Starter{1, 1.1e4}), Reason::out_of_range, "starter.no_load_rad_s"));
  EXPECT_TRUE(accepted(validate(Starter{0, 0})));
  EXPECT_TRUE(accepted(validate(Starter{300, 30})));
}

}  // namespace
}  // namespace crankloop::define_test

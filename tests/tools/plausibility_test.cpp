// Engine files that say what is possible and hardly meant: told as warnings, with the line, and computed all the same.
#include "crankloop/engine_file/plausibility.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <crankloop/tabulate/indicator_diagram.hpp>

#include "crankloop/files/number.hpp"
#include "support/bad_input.hpp"
#include "support/measured_cam.hpp"
#include "support/valve_trains.hpp"

namespace crankloop::program::plausibility_test {
namespace {

using bad_input::Engine;

class Unusual : public bad_input::BadInput {
 protected:
  std::vector<std::string> warnings(const Engine& engine) const {
    write("engine.ini", engine.text());
    return warnings_about(read_engine_file(path_, {}));
  }

  void expect_only(const Engine& engine, const std::string& key, const std::string& fragment) const {
    const std::vector<std::string> told = warnings(engine);
    ASSERT_EQ(told.size(), 1u) << key << (told.empty() ? "" : told[1 % told.size()]);
    const std::string start = path_ + ":" + std::to_string(engine.line_of(key)) + ": warning: ";
    EXPECT_EQ(told[0].compare(0, start.size(), start), 0) << told[0] << "  should start with " << start;
    EXPECT_NE(told[0].find(fragment), std::string::npos) << told[0] << "  should say: " << fragment;
  }

  /// The sample's own diagram, or what of it is motored, as rows that come `later_deg` too late, in another unit.
  Engine measured(double later_deg, bool motored, double kPa_per_unit = 1) const {
    write("engine.ini", sample_.text());
    const EngineFile file = read_engine_file(path_, {});
    IndicatorDiagram diagram;
    EXPECT_TRUE(diagram.init(file.definition().crank, file.definition().pressure).ok());
    std::ostringstream rows;
    rows.precision(12);
    rows << "crank_deg,pressure_kPa\n";
    for (double deg = 0; deg < 720; deg += 0.5) {
      const double true_deg = deg - later_deg < 0 ? deg - later_deg + 720 : deg - later_deg;
      rows << deg << ',' << (motored ? diagram.motored_Pa(true_deg) : diagram.full_Pa(true_deg)) / 1e3 / kPa_per_unit
           << '\n';
    }
    write("trace.csv", rows.str());
    return sample_.changed("source = wiebe", "source = angle_table\nfile = trace.csv");
  }

  const Engine bare_ = sample_.without("rod_ratio");  // it would have to change with stroke and rod
};

/// Engines that `new` makes of real ones have none either: tests/contract/real_engines_test.cpp.
TEST_F(Unusual, NothingIsInTheSampleEngines) {
  for (const char* name : {"diesel_495", "diesel_495_gas", "diesel_435_motored", "four_2000", "four_2000_runners",
                           "four_2000_everything", "ohc_125", "ohc_125_gas"}) {
    const std::vector<std::string> told =
        warnings_about(read_engine_file(CRANKLOOP_SOURCE_DIR "/tools/engines/" + std::string(name) + ".ini", {}));
    EXPECT_TRUE(told.empty()) << told[0];
  }
}

/// One value in another unit, or otherwise off by what people get wrong; `told`: whether a warning names its key.
struct WrongUnit {
  const char* file;
  const char* line;  ///< as the file has it, up to where it becomes wrong
  const char* wrong;
  const char* what;
  bool told = true;
};

constexpr WrongUnit kWrongUnits[] = {
    {"diesel_495", "rated_rpm", "33.3", "rev/s"},
    {"diesel_495", "rated_rpm", "209.4", "rad/s"},
    {"diesel_495", "bore_mm", "0.095", "m"},
    {"diesel_495", "bore_mm", "9.5", "cm"},
    {"diesel_495", "bore_mm", "3.74", "in"},
    {"diesel_495", "stroke_mm", "11.5", "cm"},
    {"diesel_495", "rod_length_mm", "2100", "0.1 mm"},
    {"diesel_495", "piston_g", "0.81", "kg"},
    {"diesel_495", "rod_small_end_g", "0.505", "kg"},
    {"diesel_495", "rod_big_end_g", "1.382", "kg"},
    {"diesel_495", "crank_inertia_kg_m2", "299", "g m2"},
    {"diesel_495", "crank_inertia_kg_m2", "5000", "kg cm2"},
    {"diesel_495", "crank_inertia_kg_m2", "11.9", "lb ft2"},
    {"diesel_495", "cylinder_spacing_mm", "0.12", "m"},
    {"diesel_495", "crankcase_kPa", "1", "bar"},
    {"diesel_495", "intake_kPa", "0.98", "bar"},
    {"diesel_495", "intake_kPa", "14.2", "psi"},
    {"diesel_495", "exhaust_kPa", "1.05", "bar"},
    {"diesel_495", "net_mep_kPa", "8.097", "bar"},
    {"diesel_495", "net_mep_kPa", "10", "bar, rounded"},
    {"diesel_495", "net_mep_kPa", "117.4", "psi"},
    {"diesel_495", "constant_kPa", "0.9", "bar"},
    {"diesel_495", "constant_kPa", "9700", "10 Pa"},
    {"diesel_495", "linear_kPa_per_1000rpm", "0.26", "bar"},
    {"diesel_495", "quadratic_Nm_per_1000rpm2", "4.2e-5", "of rpm squared"},
    {"diesel_495", "stall_Nm", "0.42", "kNm"},
    {"diesel_495", "no_load_rpm", "6.3", "rev/s"},
    {"diesel_495", "max_lift_mm", "0.0072", "m"},
    {"diesel_495", "base_circle_mm", "0.016", "m"},
    {"diesel_495", "clearance_mm", "0.0003", "m"},
    {"diesel_495", "clearance_mm", "0.012", "in", false},  // as small as a bucket's
    {"diesel_495", "valve_g", "0.48", "kg"},
    {"diesel_495", "spring_g", "0.09", "kg"},
    {"diesel_495", "spring_N_per_mm", "15000", "N/m"},
    {"diesel_495", "spring_N_per_mm", "0.025", "kN/mm"},
    {"diesel_495", "spring_preload_N", "0.32", "kN"},
    {"diesel_495", "train_N_per_mm", "7e6", "N/m"},
    {"diesel_495", "train_N_per_mm", "7", "kN/mm"},
    {"diesel_495", "seat_N_per_mm", "50", "kN/mm"},
    {"diesel_495", "train_damping_ratio", "8", "per cent"},
    {"diesel_495", "full_lift_at_crank_deg", "106", "from the other dead centre"},
    {"diesel_495", "start_of_combustion_deg", "-0.1", "rad", false},  // a late start
    {"four_2000", "intake_volume_cm3", "3", "L"},
    {"four_2000", "throttle_mm2", "16", "cm2"},
    {"four_2000", "outlet_mm2", "12", "cm2"},
    {"diesel_495_gas", "fuel_mg", "0.036", "g"},
    {"four_2000", "excess_air_ratio", "14.6", "air-fuel ratio"},
    {"four_2000", "max_lift_mm", "0.95", "cm"},
    {"four_2000", "seat_diameter_mm", "3.3", "cm"},
    {"ohc_125", "valve_g", "0.033", "kg"},
};
static_assert(std::size(kWrongUnits) == 50);

TEST_F(Unusual, AValueInAnotherUnitIsTold) {
  int told_of = 0;
  for (const WrongUnit& wrong : kWrongUnits) {
    const std::string path = CRANKLOOP_SOURCE_DIR "/tools/engines/" + std::string(wrong.file) + ".ini";
    const Engine right(bad_input::contents(path));
    const Engine engine = (std::string(wrong.file) == "diesel_495" ? bare_ : right).with(wrong.line, wrong.wrong);
    bool told = false;
    for (const std::string& line : warnings(engine)) {
      // On the value's line, or on that of what it is measured with.
      told = told || line.find(":" + std::to_string(engine.line_of(wrong.line)) + ": warning: ") != std::string::npos ||
             line.find(wrong.line) != std::string::npos;
    }
    EXPECT_EQ(told, wrong.told) << wrong.file << ": " << wrong.line << " = " << wrong.wrong << ", " << wrong.what;
    told_of += told ? 1 : 0;
  }
  EXPECT_GE(told_of, 45);
}

TEST_F(Unusual, OneWrongLengthIsToldOnceAndNotOfAllThatIsMeasuredByIt) {
  EXPECT_EQ(warnings(bare_.with("bore_mm", "9.5")).size(), 1u);
  EXPECT_EQ(warnings(bare_.with("stroke_mm", "11.5")).size(), 1u);
  EXPECT_EQ(warnings(sample_.with("rated_rpm", "209.4")).size(), 1u);
}

TEST_F(Unusual, LengthsInMetresAreToldOnce) {
  const Engine metres = bare_.with("bore_mm", "0.095")
                            .with("stroke_mm", "0.115")
                            .with("rod_length_mm", "0.21")
                            .with("cylinder_spacing_mm", "0.12")
                            .with("base_circle_mm", "0.016");
  expect_only(metres, "bore_mm",
              "all lengths look like metres: bore_mm = 0.095, stroke_mm = 0.115, rod_length_mm = 0.21");
  // What is no length is measured by the engine that is meant.
  EXPECT_EQ(warnings(metres.with("valve_g", "0.48")).size(), 2u);
}

TEST_F(Unusual, ARangeIsToldInTheUnitOfTheFileForAnEngineOfThisSize) {
  // 0.008 to 1.5 times 3.2605 L to the power of 4/3, 4.835; a bore of 95 mm.
  expect_only(sample_.with("crank_inertia_kg_m2", "299"), "crank_inertia_kg_m2",
              "crank_inertia_kg_m2 = 299 is unusual; usual: 0.039 to 7.3 kg m^2 for this displacement");
  expect_only(sample_.with("base_circle_mm", "0.016"), "base_circle_mm",
              "base_circle_mm = 0.016 is unusual; usual: 4.8 to 76 mm for this bore");
  expect_only(sample_.with("net_mep_kPa", "10"), "net_mep_kPa", "net_mep_kPa = 10 is unusual; usual: 150 to 4000 kPa");
}

TEST_F(Unusual, CylindersOfABankThatOverlapAreTold) {
  expect_only(sample_.with("cylinder_spacing_mm", "60"), "cylinder_spacing_mm",
              "cylinders 1 and 2 of one bank are 60 mm apart, less than a bore");
  EXPECT_TRUE(warnings(sample_.with("cylinder_spacing_mm", "100")).empty());
}

/// 250 N of preload by 500 N/mm is half a millimetre.
TEST_F(Unusual, ATrainThatItsSpringCompressesFarIsTold) {
  const Engine soft = sample_.with("spring_preload_N", "250").with("train_N_per_mm", "500");
  expect_only(soft, "train_N_per_mm", "train_N_per_mm = 500: the spring's preload compresses the train by 0.5 mm");
}

TEST_F(Unusual, AGuideThatHoldsTheValveIsTold) {
  expect_only(sample_.with("guide_damping_ratio", "0.3"), "guide_damping_ratio",
              "guide_damping_ratio = 0.3 is unusual; usual: 1e-05 to 0.05");
}

TEST_F(Unusual, APressureThatNoEngineHasIsTold) {
  const std::vector<std::string> told =
      warnings(sample_.with("compression_ratio", "26").with("net_mep_kPa", "3950").with("intake_kPa", "250"));
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("the largest pressure is "), std::string::npos) << told[0];
  EXPECT_NE(told[0].find(" kPa; usual at full load: up to 25000 kPa"), std::string::npos) << told[0];
}

TEST_F(Unusual, AnExhaustInTheWrongUnitIsTold) {
  const Engine gas(bad_input::contents(CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini"));
  const Engine in_bar = gas.changed("[gas]", "[gas]\nback_kPa = 1.05");
  expect_only(in_bar, "back_kPa", "back_kPa = 1.05 is unusual; usual: 40 to 600 kPa");
}

TEST_F(Unusual, AFaultThatChangesNothingIsTold) {
  const Engine faulty = sample_.plus("[fault x]").plus("trigger = crank").plus("end_s = 1");
  expect_only(faulty, "[fault x]", "[fault x] says when, and not what: the signal stays healthy");
  EXPECT_TRUE(warnings(faulty.plus("late_deg = 1")).empty());
  const std::pair<const char*, const char*> together[] = {{"moved_deg = 1", "moved_tooth = 3"},
                                                          {"moved_tooth = 3", "moved_deg = 1"},
                                                          {"extra_tooth_deg = 8", "extra_width_deg = 1"},
                                                          {"runout_at_deg = 8", "runout_deg = 0.1"},
                                                          {"noise_pulse_us = 8", "noise_Hz = 10"}};
  for (const auto& [alone, other] : together) {
    const std::string key = std::string(alone).substr(0, std::string(alone).find(' '));
    const std::string needed = std::string(other).substr(0, std::string(other).find(' '));
    expect_only(faulty.plus(alone), key, key + " does nothing without " + needed);
    EXPECT_TRUE(warnings(faulty.plus(alone).plus(other)).empty()) << alone << ", " << other;
  }
}

TEST_F(Unusual, AToothRatioOfAWheelWithItsOwnWidthsIsTold) {
  const Engine wheel = sample_.plus("[trigger k]").plus("on = crank").plus("pattern = honda-k");
  EXPECT_TRUE(warnings(wheel).empty());
  expect_only(wheel.plus("tooth_ratio = 0.21"), "tooth_ratio = 0.21", "tooth_ratio does nothing: pattern = honda-k");
}

TEST_F(Unusual, FullLiftOnTheOtherTurnIsTold) {
  expect_only(sample_.with("full_lift_at_crank_deg", "106"), "full_lift_at_crank_deg",
              "full_lift_at_crank_deg = 106 is unusual; usual: 380 to 560 deg for an intake valve");
  EXPECT_TRUE(warnings(sample_.with("full_lift_at_crank_deg", "-254")).empty());  // 466 a cycle earlier
}

/// 499.6 cm3 of air at 25 deg C and 100 kPa, 0.9 of it in the cylinder: 525 mg, by 14.6 for 36 mg of fuel.
TEST_F(Unusual, AMixtureThatNoSparkLightsIsTold) {
  const Engine by_air(bad_input::contents(CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini"));
  EXPECT_TRUE(warnings(by_air.with("excess_air_ratio", "0.75")).empty());
  expect_only(by_air.with("excess_air_ratio", "0.65"), "excess_air_ratio",
              "excess_air_ratio = 0.65; usual with spark ignition: 0.7 to 2");
  expect_only(by_air.with("excess_air_ratio", "2.1"), "excess_air_ratio", "usual with spark ignition: 0.7 to 2");
  const Engine four = by_air.changed("excess_air_ratio", "fuel_mg = 30");
  EXPECT_TRUE(warnings(four.with("fuel_mg", "50")).empty());  // 0.72
  expect_only(four.with("fuel_mg", "53"), "fuel_mg", "fuel_mg = 53 gives a lambda of about 0.68");
  EXPECT_TRUE(warnings(four.with("fuel_mg", "18.5")).empty());
  expect_only(four.with("fuel_mg", "17.5"), "fuel_mg", "gives a lambda of about 2.1");
  EXPECT_TRUE(warnings(four.with("fuel_mg", "0")).empty());  // motored
  const Engine diesel(bad_input::contents(CRANKLOOP_SOURCE_DIR "/tools/engines/diesel_495_gas.ini"));
  EXPECT_TRUE(warnings(diesel.with("fuel_mg", "10")).empty());
}

/// Fuel and spark of the command line are judged as the file's.
TEST_F(Unusual, OrderOfTheCommandLineIsTold) {
  const auto told = [](const char* file, const auto& change) {
    const EngineFile engine = read_engine_file(CRANKLOOP_SOURCE_DIR "/tools/engines/" + std::string(file), {});
    GasOrder order = gas_order(engine.definition().gas);
    change(order);
    const std::vector<std::string> lines = warnings_about_order(engine, order);
    EXPECT_LE(lines.size(), 1u);
    if (lines.empty()) return std::string();
    const std::string start = engine.path() + ": warning: ";
    EXPECT_EQ(lines[0].compare(0, start.size(), start), 0) << lines[0];
    return lines[0].substr(start.size());
  };
  EXPECT_EQ(told("four_2000.ini", [](GasOrder&) {}), "");
  EXPECT_EQ(told("four_2000.ini", [](GasOrder& order) { order.excess_air_ratio = 1.9; }), "");
  EXPECT_EQ(told("four_2000.ini", [](GasOrder& order) { order.excess_air_ratio = 60; }),
            "--lambda 60; usual with spark ignition: 0.7 to 2");
  const auto by_fuel = [](double mg) {
    return [mg](GasOrder& order) { order.excess_air_ratio = 0, order.fuel_kg = mg * 1e-6; };
  };
  EXPECT_EQ(told("four_2000.ini", by_fuel(30)), "");
  EXPECT_EQ(told("four_2000.ini", by_fuel(53)),
            "--fuel-mg 53 gives a lambda of about 0.68 in a cylinder full of air; "
            "usual with spark ignition: 0.7 to 2");
  EXPECT_EQ(told("four_2000.ini", by_fuel(0)), "");  // motored
  EXPECT_EQ(told("diesel_495_gas.ini", by_fuel(10)), "");
  EXPECT_EQ(told("four_2000.ini", [](GasOrder& order) { order.burn_start_deg = 30; }),
            "--burn-start-deg = 30 is unusual; usual: -50 to 20 deg");
}

TEST_F(Unusual, ShapeOfACylinderIsToldOutsideItsBounds) {
  const Engine long_stroke = bare_.with("stroke_mm", "310").with("rod_length_mm", "600");
  EXPECT_TRUE(warnings(long_stroke).empty());  // 95 / 310 = 0.306, 155 / 600 = 0.258
  expect_only(long_stroke.with("stroke_mm", "320"), "bore_mm",
              "bore_mm / stroke_mm = 0.296875 is unusual; usual: 0.3 to 2");
  EXPECT_TRUE(warnings(bare_.with("stroke_mm", "48").with("rod_length_mm", "100")).empty());
  expect_only(bare_.with("stroke_mm", "47").with("rod_length_mm", "100"), "bore_mm", "bore_mm / stroke_mm = 2.02128");
  EXPECT_TRUE(warnings(bare_.with("rod_length_mm", "380")).empty());  // 0.1513
  expect_only(bare_.with("rod_length_mm", "390"), "rod_length_mm",
              "stroke_mm / 2 / rod_length_mm = 0.147436 is unusual; usual: 0.15 to 0.45");
  EXPECT_TRUE(warnings(bare_.with("rod_length_mm", "128")).empty());  // 0.4492
  expect_only(bare_.with("rod_length_mm", "127"), "rod_length_mm", "0.452756");
}

/// The rest of the engine would have to grow and shrink along: what is said of the bore itself.
TEST_F(Unusual, SizeIsToldOutsideItsBounds) {
  const auto told_of_bore = [&](const Engine& engine) {
    std::string of_bore;
    for (const std::string& line : warnings(engine)) {
      if (line.find("warning: bore_mm") != std::string::npos) of_bore += line;
    }
    return of_bore;
  };
  const Engine model =
      bare_.with("bore_mm", "9.9").with("stroke_mm", "10").with("rod_length_mm", "20").with("piston_g", "1.5");
  expect_only(model, "bore_mm", "bore_mm = 9.9 is unusual; usual: 10 to 1200 mm");
  EXPECT_EQ(told_of_bore(model.with("bore_mm", "10.1")), "");
  const Engine ship = bare_.with("stroke_mm", "3000").with("rod_length_mm", "4500").with("piston_g", "2e6");
  EXPECT_EQ(told_of_bore(ship.with("bore_mm", "1199")), "");
  expect_only(ship.with("bore_mm", "1201"), "bore_mm", "bore_mm = 1201");
}

TEST_F(Unusual, APistonIsToldBelowATenthAndAboveTenTimesTheTableOfFirstDesigns) {
  // At 95 mm and 2000 rpm `masses` has 1.08 to 2.2 kg/m^2 for each mm of bore and 70.88 cm^2: 727 to 1481 g over its
  // three kinds.
  EXPECT_TRUE(warnings(sample_.with("piston_g", "73")).empty());
  expect_only(sample_.with("piston_g", "72"), "piston_g",
              "piston_g = 72 is unusual; usual: 73 to 15000 g for this bore");   // to two digits
  expect_only(sample_.with("piston_g", "0.81"), "piston_g", "piston_g = 0.81");  // kilograms where grams are asked for
  EXPECT_TRUE(warnings(sample_.with("piston_g", "14990")).empty());
  expect_only(sample_.with("piston_g", "15010"), "piston_g", "piston_g = 15010");
}

TEST_F(Unusual, ACompressionThatNoGasFollowsIsTold) {
  EXPECT_TRUE(warnings(sample_.with("compression_exponent", "1.26")).empty());
  expect_only(sample_.with("compression_exponent", "1.24"), "compression_exponent",
              "polytropic exponent of the compression, -90 to -30 deg, = 1.24 ");
  EXPECT_TRUE(warnings(sample_.with("compression_exponent", "1.44")).empty());
  expect_only(sample_.with("compression_exponent", "1.46"), "compression_exponent", "= 1.46 ");
}

TEST_F(Unusual, ATraceThatIsFiveDegreesOffIsTold) {
  EXPECT_TRUE(warnings(measured(0, false)).empty());
  expect_only(measured(5, false), "file = trace.csv", "are its angles right");   // 1102 kPa of net IMEP instead of 810
  expect_only(measured(-5, false), "file = trace.csv", "are its angles right");  // 509 kPa
}

TEST_F(Unusual, ATraceInAnotherUnitIsTold) {
  expect_only(measured(0, false, 100), "file = trace.csv",
              "pressure where the compression begins = 0.98 is unusual; usual: 15 to 700 kPa: is it in kPa");  // bar
  expect_only(measured(0, false, 1000), "file = trace.csv", "= 0.098 is unusual");                             // MPa
  expect_only(measured(0, false, 6.894757), "file = trace.csv", "= 14.2137 is unusual");                       // psi
  expect_only(measured(0, false, 0.1), "file = trace.csv", "= 980 is unusual");                                // hPa
}

TEST_F(Unusual, AMotoredTraceThatPeaksLongBeforeDeadCentreIsTold) {
  EXPECT_TRUE(warnings(measured(0, true)).empty());
  EXPECT_TRUE(warnings(measured(-1.5, true)).empty());
  EXPECT_TRUE(warnings(measured(-2, true)).empty());
  expect_only(measured(-2.5, true), "file = trace.csv",
              "the motored pressure is largest 2.5 deg before top dead centre; usual: at most 2 deg");
}

TEST_F(Unusual, ATraceThatLacksRowsIsTold) {
  const Engine engine = measured(0, false);
  const std::string whole = bad_input::contents(folder_ / "trace.csv");
  const auto told_without = [&](double from_deg, double to_deg, const std::string& more = "") {
    std::string kept;
    for (const std::string& line : bad_input::lines_of(whole)) {
      const double deg = line[0] == 'c' ? -1 : std::stod(line);
      if (deg <= from_deg || deg >= to_deg) kept += line + "\n";
    }
    write("trace.csv", kept + more);
    std::string all;
    for (const std::string& line : warnings(engine)) all += line + "\n";
    return all;
  };
  EXPECT_NE(told_without(20, 200).find("no row between 20 and 200 deg, where others are 0.5 deg apart"),
            std::string::npos);
  EXPECT_NE(told_without(690, 721).find("no row between 690 and 720 deg"), std::string::npos)
      << "the first row follows";
  EXPECT_EQ(told_without(300, 315), "");
  EXPECT_NE(told_without(300, 316), "");
  const std::string first = whole.substr(whole.find("\n0,") + 3, 6);
  EXPECT_EQ(told_without(0, 0, "720," + first + "\n"), "");
  EXPECT_NE(told_without(0, 0, "720,1\n").find("the row at 720 deg, 1 kPa, is the same place as that at 0 deg"),
            std::string::npos);
}

TEST_F(Unusual, AFlameOfGasolineAndAnOctaneNumberInADieselAreTold) {
  const Engine diesel(bad_input::contents(CRANKLOOP_SOURCE_DIR "/tools/engines/diesel_495_gas.ini"));
  EXPECT_TRUE(warnings(diesel).empty());
  expect_only(diesel.changed("[gas]", "[gas]\nburn_by = charge"), "burn_by", "a law of gasoline");
  expect_only(diesel.changed("[gas]", "[gas]\noctane = 95"), "octane", "is a diesel's");
}

/// The 125 with its intake cam measured to whole micrometres every `step_deg`: its lift above `clearance_mm`.
class MeasuredCam : public Unusual {
 protected:
  Engine with_cam(double clearance_mm, double step_deg, const std::string& smoothing_um) const {
    const support::Measured table(support::profile_of(support::ohc_125_cam()), -180, 179.9, step_deg);
    std::ostringstream rows;
    rows << "cam_deg,lift_mm\n";
    for (const CamPoint& row : table.points)
      rows << row.cam_deg << ',' << std::max(0.0, std::round(row.lift_m * 1e6) / 1e3 - clearance_mm) << '\n';
    write("cam.csv", rows.str());
    return Engine(bad_input::contents(CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini"))
        .changed("source = polynomial", "source = table\nfile = cam.csv\nsmoothing_um = " + smoothing_um)
        .without("max_lift_mm")
        .without("half_angle_deg")
        .without("exponents");
  }
};

TEST_F(MeasuredCam, AValvesLiftLessItsClearanceIsTold) {
  for (const double step_deg : {0.2, 0.5, 1.0, 2.0, 5.0}) {
    for (const double clearance_mm : {0.1, 0.2, 0.4}) {
      if (step_deg == 5) continue;  // too coarse to tell
      expect_only(with_cam(clearance_mm, step_deg, "200"), "file", "Is it a valve's lift less its clearance?");
    }
    for (const char* smoothing_um : {"auto", "1", "50"}) {
      const std::vector<std::string> told = warnings(with_cam(0, step_deg, smoothing_um));
      EXPECT_TRUE(told.empty()) << step_deg << ": " << told[0];
    }
  }
}

/// Published lift is often over the crank's angle.
TEST_F(MeasuredCam, AnglesOfTheCrankAreTold) {
  const Engine engine = with_cam(0, 1, "200");
  std::string table = "cam_deg,lift_mm\n";
  for (const std::string& row : bad_input::lines_of(bad_input::contents(folder_ / "cam.csv"))) {
    if (row[0] == 'c' || std::abs(std::stod(row)) > 89) continue;
    table += shortest(2 * std::stod(row)) + row.substr(row.find(',')) + "\n";
  }
  write("cam.csv", table);
  expect_only(engine, "file",
              "deg wide, which is unusual; usual: 50 to 210 deg: are its angles of the cam, not of the crank?");
}

TEST_F(MeasuredCam, RowsTooFarApartForTheLobesShapeAreTold) {
  const Engine engine = with_cam(0, 1, "auto");
  write("cam.csv", "cam_deg,lift_mm\n-60,0\n-50,0.4\n-40,2\n-20,5\n0,6\n20,5\n40,2\n50,0.4\n60,0\n");
  expect_only(engine, "smoothing_um", "smoothing_um = auto becomes 200, 3.3 % of the lift; usual: up to 0.5 %");
}

TEST_F(MeasuredCam, AMisreadRowThatRaisesTheSmoothingIsTold) {
  const Engine engine = with_cam(0, 1, "auto");
  std::vector<std::string> rows = bad_input::lines_of(bad_input::contents(folder_ / "cam.csv"));
  ASSERT_EQ(rows[151].compare(0, 4, "-30,"), 0);
  rows[151] = "-30," + shortest(std::stod(rows[151].substr(4)) + 0.1);
  std::string table;
  for (const std::string& row : rows) table += row + "\n";
  write("cam.csv", table);
  expect_only(engine, "smoothing_um", "the row at -30 deg (" + (folder_ / "cam.csv") + ":152)");
}

TEST_F(MeasuredCam, ALobeThatLacksRowsIsTold) {
  const Engine engine = with_cam(0, 1, "auto");
  const auto told_without = [&](double from_deg, double to_deg) {
    std::string kept;
    for (const std::string& line : bad_input::lines_of(bad_input::contents(folder_ / "cam.csv"))) {
      const double deg = line[0] == 'c' ? from_deg : std::stod(line);
      if (deg <= from_deg || deg >= to_deg) kept += line + "\n";
    }
    write("cam.csv", kept);
    return warnings(engine);
  };
  EXPECT_TRUE(told_without(-179, -110).empty()) << "base circle";
  const std::vector<std::string> told = told_without(-20, 20);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("no row between -20 and 20 deg, where others are 1 deg apart"), std::string::npos) << told[0];
}

TEST_F(MeasuredCam, ALiftInAnotherUnitIsTold) {
  const Engine engine = with_cam(0, 1, "auto");
  const std::string table = bad_input::contents(folder_ / "cam.csv");
  for (const double mm_per_unit : {1000.0, 25.4}) {
    std::string other = "cam_deg,lift_mm\n";
    for (const std::string& line : bad_input::lines_of(table)) {
      const std::size_t comma = line.find(',');
      if (line[0] != 'c')
        other += line.substr(0, comma + 1) + shortest(std::stod(line.substr(comma + 1)) / mm_per_unit) + "\n";
    }
    write("cam.csv", other);
    std::string all;
    for (const std::string& line : warnings(engine)) all += line;
    EXPECT_NE(all.find("cam.csv: lift_mm up to 0."), std::string::npos) << all;
    EXPECT_NE(all.find("is it in mm?"), std::string::npos) << all;
  }
}

TEST_F(Unusual, WarningsStandOnStderrAndInTheReportUnlessSilenced) {
  write("engine.ini", bare_.with("rod_length_mm", "390").text());
  const std::string warning = "stroke_mm / 2 / rod_length_mm = 0.147436 is unusual";
  const auto answer = [&](std::vector<std::string> words, const char* silence) {
    words.insert(words.end(), {path_, "--report", folder_ / "report.html"});
    if (*silence != '\0') words.emplace_back(silence);
    return run(words);
  };
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "--cycles", "1"}, {"run", "--free", "--from-rpm", "900", "--seconds", "0.2"}}) {
    const bad_input::Answer told = answer(words, "");
    EXPECT_EQ(told.status, 0);
    EXPECT_NE(told.error.find(path_ + ":13: warning: " + warning), std::string::npos) << told.error;
    EXPECT_EQ(told.out.find("warning"), std::string::npos);
    EXPECT_NE(bad_input::contents(folder_ / "report.html").find(warning), std::string::npos);
    const bad_input::Answer silent = answer(words, "--no-warnings");
    EXPECT_EQ(silent.status, 0);
    EXPECT_EQ(silent.error, "");
    EXPECT_EQ(bad_input::contents(folder_ / "report.html").find(warning), std::string::npos);
  }
  EXPECT_NE(run({"help", "show"}).out.find("--no-warnings"), std::string::npos);
  EXPECT_EQ(run({"masses", "--no-warnings"}).status, bad_input::kBadInput);
}

TEST_F(Unusual, AnEngineThatNothingHoldsBackIsToldWhereItRunsFree) {
  std::string text = sample_.text();
  const auto from = text.find("[friction]");
  write("engine.ini", text.erase(from, text.find("[starter]") - from));
  const std::string warning = path_ + ": warning: a free-running engine without [friction]";
  const std::vector<std::string> free{"run", path_, "--free", "--seconds", "0.05"};
  EXPECT_EQ(run(free).error.compare(0, warning.size(), warning), 0) << run(free).error;
  std::vector<std::string> braked = free;
  braked.insert(braked.end(), {"--machine-Nm", "5"});
  EXPECT_EQ(run(braked).error, "");
  EXPECT_EQ(run({"run", path_, "--cycles", "1"}).error, "");
}

}  // namespace
}  // namespace crankloop::program::plausibility_test

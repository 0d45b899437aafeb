// Engine files that say what is possible and hardly meant: told as warnings, with the line, and computed all the same.
#include "crankloop/engine_file/plausibility.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <crankloop/tabulate/indicator_diagram.hpp>

#include "support/bad_input.hpp"

namespace crankloop::program {
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

  /// The sample's own diagram, or what of it is motored, as rows that come `later_deg` too late.
  Engine measured(double later_deg, bool motored) const {
    write("engine.ini", sample_.text());
    const EngineFile file = read_engine_file(path_, {});
    IndicatorDiagram diagram;
    EXPECT_TRUE(diagram.init(file.definition().crank, file.definition().pressure).ok());
    std::ostringstream rows;
    rows.precision(12);
    rows << "crank_deg,pressure_kPa\n";
    for (double deg = 0; deg < 720; deg += 0.5) {
      const double true_deg = deg - later_deg < 0 ? deg - later_deg + 720 : deg - later_deg;
      rows << deg << ',' << (motored ? diagram.motored_Pa(true_deg) : diagram.full_Pa(true_deg)) / 1e3 << '\n';
    }
    write("trace.csv", rows.str());
    return sample_.changed("source = wiebe", "source = angle_table\nfile = trace.csv");
  }

  const Engine bare_ = sample_.without("rod_ratio");  // it would have to change with stroke and rod
};

TEST_F(Unusual, NothingIsInTheSampleEngines) {
  EXPECT_TRUE(warnings(sample_).empty());
  EXPECT_TRUE(warnings(Engine(bad_input::contents(CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini"))).empty());
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

TEST_F(Unusual, SizeIsToldOutsideItsBounds) {
  const Engine model =
      bare_.with("bore_mm", "9.9").with("stroke_mm", "10").with("rod_length_mm", "20").with("piston_g", "1.5");
  expect_only(model, "bore_mm", "bore_mm = 9.9 is unusual; usual: 10 to 1200 mm");
  EXPECT_TRUE(warnings(model.with("bore_mm", "10.1")).empty());
  const Engine ship = bare_.with("stroke_mm", "3000").with("rod_length_mm", "4500").with("piston_g", "2e6");
  EXPECT_TRUE(warnings(ship.with("bore_mm", "1199")).empty());
  expect_only(ship.with("bore_mm", "1201"), "bore_mm", "bore_mm = 1201");
}

TEST_F(Unusual, APistonIsToldBelowATenthAndAboveTenTimesTheTableOfFirstDesigns) {
  // At 95 mm and 2000 rpm `masses` has 1.08 to 2.2 kg/m^2 for each mm of bore and 70.88 cm^2: 727 to 1481 g over its
  // three kinds.
  EXPECT_TRUE(warnings(sample_.with("piston_g", "73")).empty());
  expect_only(sample_.with("piston_g", "72"), "piston_g", "piston_g = 72 is unusual");
  expect_only(sample_.with("piston_g", "0.81"), "piston_g", "piston_g = 0.81");  // kilograms where grams are asked for
  EXPECT_TRUE(warnings(sample_.with("piston_g", "14800")).empty());
  expect_only(sample_.with("piston_g", "14820"), "piston_g", "piston_g = 14820");
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

TEST_F(Unusual, AMotoredTraceThatPeaksLongBeforeDeadCentreIsTold) {
  EXPECT_TRUE(warnings(measured(0, true)).empty());
  EXPECT_TRUE(warnings(measured(-2.5, true)).empty());
  expect_only(measured(-3.5, true), "file = trace.csv",
              "the motored pressure is largest 3.5 deg before top dead centre");
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
    EXPECT_NE(told.error.find(path_ + ":12: warning: " + warning), std::string::npos) << told.error;
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
  const std::string warning = path_ + ": warning: nothing holds back an engine";
  const std::vector<std::string> free{"run", path_, "--free", "--seconds", "0.05"};
  EXPECT_EQ(run(free).error.compare(0, warning.size(), warning), 0) << run(free).error;
  std::vector<std::string> braked = free;
  braked.insert(braked.end(), {"--machine-Nm", "5"});
  EXPECT_EQ(run(braked).error, "");
  EXPECT_EQ(run({"run", path_, "--cycles", "1"}).error, "");
}

}  // namespace
}  // namespace crankloop::program

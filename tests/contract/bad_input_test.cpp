// What the program answers to bad engine files and diagrams: one line that names file and line, exit status 2, and
// nothing else written.
//
// The program runs as its users run it, as a process of its own.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "support/bad_input.hpp"

namespace crankloop::bad_input::bad_input_test {
namespace {

struct NumberKey {
  const char* section;
  const char* name;
  bool may_be_absent;
  bool may_be_negative;
};

constexpr NumberKey kNumberKeys[] = {
    {"[engine]", "rated_rpm", false, false},
    {"[crank]", "bore_mm", false, false},
    {"[crank]", "stroke_mm", false, false},
    {"[crank]", "rod_length_mm", false, false},
    {"[crank]", "rod_ratio", true, false},
    {"[crank]", "pin_offset_mm", true, true},
    {"[crank]", "compression_ratio", false, false},
    {"[masses]", "piston_g", false, false},
    {"[masses]", "rod_small_end_g", false, false},
    {"[masses]", "rod_big_end_g", false, false},
    {"[masses]", "crank_pin_equivalent_g", true, false},
    {"[masses]", "crank_inertia_kg_m2", false, false},
    {"[layout]", "cylinder_spacing_mm", true, false},
    {"[pressure]", "crankcase_kPa", true, false},
    {"[pressure]", "intake_kPa", true, false},
    {"[pressure]", "exhaust_kPa", true, false},
    {"[pressure]", "start_of_combustion_deg", true, true},
    {"[pressure]", "combustion_duration_deg", true, false},
    {"[pressure]", "wiebe_m", true, false},
    {"[pressure]", "compression_exponent", true, false},
    {"[pressure]", "expansion_exponent", true, false},
    {"[pressure]", "exhaust_valve_opens_deg", true, false},
    {"[pressure]", "net_mep_kPa", false, true},
};

TEST_F(BadInput, EveryKeyIsMissedWhereItHasNoDefault) {
  for (const NumberKey& key : kNumberKeys) {
    SCOPED_TRACE(key.name);
    if (key.may_be_absent) {
      expect_accepted(sample_.without(key.name));
    } else {
      expect_refused(sample_.without(key.name), key.section, {key.name});  // told at the section's header
    }
  }
  expect_refused(sample_.without("name"), "[engine]", {"lacks name"});
  expect_refused(sample_.without("source"), "[pressure]",
                 {"lacks source", "wiebe | angle_table | volume_table | gas | none"});
}

TEST_F(BadInput, EveryKeyIsRefusedWhenItIsDoubled) {
  for (const NumberKey& key : kNumberKeys) {
    SCOPED_TRACE(key.name);
    const std::size_t line = sample_.line_of(key.name);
    const std::string once = lines_of(sample_.text())[line - 1];
    expect_refused(sample_.changed(key.name, once + "\n" + once), line + 1,
                   {key.name, "given twice", "line " + std::to_string(line)});
  }
}

TEST_F(BadInput, EveryNumberMustBeAPlainFiniteNumber) {
  const std::pair<const char*, const char*> kNoNumbers[] = {
      {"", "has no value"},           {"abc", "not a number"},         {"12 mm", "'mm' follows"},
      {"12mm", "'mm' follows"},       {"9,5", "decimal sign"},         {"0x1p4", "hexadecimal"},
      {"1e", "not a number"},         {"--1", "not a number"},         {"1 2", "not a number"},
      {"inf", "not a finite number"}, {"-INF", "not a finite number"}, {"Infinity", "not a finite number"},
      {"nan", "not a finite number"}, {"NaN", "not a finite number"},  {"1e999", "too large or too small"},
      {"-1e999", "too large"},        {"1e-999", "or too small"},      {"1e30", "out of range; allowed: "},
      {"95\u00A0", "no-break space"},
  };
  // Every key says no to three kinds of nonsense, one key to all: they share what reads a number, but each must use it.
  for (const auto& [text, complaint] : kNoNumbers) {
    SCOPED_TRACE(std::string("bore_mm = ") + text);
    expect_refused(sample_.with("bore_mm", text), "bore_mm", {"bore_mm", complaint});
  }
  for (const NumberKey& key : kNumberKeys) {
    for (const auto& [text, complaint] : {kNoNumbers[3], kNoNumbers[12], kNoNumbers[17]}) {
      SCOPED_TRACE(std::string(key.name) + " = " + text);
      expect_refused(sample_.with(key.name, text), key.name, {key.name, complaint});
    }
    if (!key.may_be_negative)
      expect_refused(sample_.with(key.name, "-1"), key.name, {key.name, "-1 is out of range; allowed: "});
  }
}

TEST_F(BadInput, AMotoredExpansionThatGivesWorkIsRefused) {
  const auto with_exponent = [this](const char* exponent) {
    return sample_.changed("exhaust_valve_opens_deg",
                           std::string("exhaust_valve_opens_deg = 135\nmotored_expansion_exponent = ") + exponent);
  };
  for (const char* good : {"0", "1.35", "1.5"}) expect_accepted(with_exponent(good));
  expect_refused(with_exponent("1.34"), sample_.line_of("exhaust_valve_opens_deg") + 1,
                 {"motored_expansion_exponent: 1.34 would give work", "at least compression_exponent = 1.35"});
  expect_refused(with_exponent("3.1"), sample_.line_of("exhaust_valve_opens_deg") + 1,
                 {"3.1 is out of range; allowed: "});
}

TEST_F(BadInput, ZeroIsRefusedWhereItMeansNothing) {
  for (const char* key : {"rated_rpm", "bore_mm", "stroke_mm", "rod_length_mm", "rod_ratio", "compression_ratio",
                          "cylinder_spacing_mm", "crankcase_kPa", "intake_kPa", "combustion_duration_deg"}) {
    SCOPED_TRACE(key);
    expect_refused(sample_.with(key, "0"), key, {key, "0 is out of range; allowed: "});
  }
  expect_refused(sample_.with("piston_g", "0").with("rod_small_end_g", "0"), "piston_g", {"weigh nothing"});
}

TEST_F(BadInput, ARodThatCannotTurnIsRefusedWithTheLengthItNeeds) {
  const Engine drawn = sample_.without("rod_ratio");
  expect_refused(drawn.with("rod_length_mm", "57.5"), "rod_length_mm", {"57.5 is too short", "57.5 mm"});
  expect_refused(drawn.with("rod_length_mm", "67").with("pin_offset_mm", "-10"), "rod_length_mm",
                 {"67 is too short", "67.5 mm"});
  expect_accepted(drawn.with("rod_length_mm", "67.6").with("pin_offset_mm", "-10"));
  expect_refused(sample_.with("rod_length_mm", "50"), "rod_length_mm",
                 {"50 is too short"});  // though rod_ratio replaces it
  const Engine hardly =
      sample_.with("pin_offset_mm", "10").with("rod_length_mm", "67.501");  // by a thousandth of a millimetre
  expect_refused(hardly.with("rod_ratio", "0.852"), "rod_ratio", {"makes the rod 67.4883"});
}

TEST_F(BadInput, ARodWhoseLengthAndRatioDisagreeIsRefusedWithBoth) {
  expect_accepted(sample_);                               // 0.2738, and 57.5 / 210 = 0.27381
  expect_accepted(sample_.with("rod_ratio", "0.27354"));  // 0.098 % below 57.5 / 210
  expect_refused(sample_.with("rod_ratio", "0.27353"), "rod_ratio", {"0.27353", "rod_length_mm"});  // 0.102 %
  expect_refused(sample_.with("rod_ratio", "0.27409"), "rod_ratio", {"0.27409"});                   // 0.102 % above
  expect_refused(sample_.with("rod_length_mm", "260"), "rod_ratio",
                 {"rod_ratio: 0.2738 contradicts rod_length_mm = 260 (line " +
                      std::to_string(sample_.line_of("rod_length_mm")) + ")",
                  "stroke_mm / 2 / rod_length_mm = 0.221154", "0.1 %", "leave rod_ratio out"});
  expect_accepted(sample_.with("rod_length_mm", "260").without("rod_ratio"));
}

TEST_F(BadInput, AFiringOrderNamesEveryCylinderOnce) {
  expect_refused(sample_.with("firing_order", "1-3-4-4"), "firing_order", {"cylinder 4 fires twice", "1 to 4"});
  expect_refused(sample_.with("firing_order", "1-3-4"), "firing_order", {"cylinder 2 does not fire"});
  expect_refused(sample_.with("firing_order", "1-3-4-5"), "firing_order", {"cylinder 5 does not exist"});
  expect_refused(sample_.with("firing_order", "1-3-4-2-1"), "firing_order", {"cylinder 1 fires twice"});
  for (const char* nonsense : {"1,3,4,2", "1-3-x-2", "1--3-4-2", "0-1-2-3", "1-3-4-2-", "1.5-2-3-4", "1-17-3-2"}) {
    expect_refused(sample_.with("firing_order", nonsense), "firing_order", {nonsense, "like 1-3-4-2"});
  }
  expect_refused(sample_.without("firing_order"), "cylinders",
                 {"lacks firing_order", "firing_angles_deg", "4 cylinders"});
  expect_refused(sample_.changed("bank_angles_deg", "firing_angles_deg = 0,540,180,360"), "firing_angles_deg",
                 {"firing_angles_deg and firing_order", "exclude each other"});
}

TEST_F(BadInput, ListsHaveOneEntryPerCylinder) {
  expect_refused(sample_.with("bank_angles_deg", "0,0,0"), "bank_angles_deg", {"3 entries for 4 cylinders"});
  expect_refused(sample_.with("bank_angles_deg", "0"), "bank_angles_deg", {"1 entry for 4 cylinders"});
  expect_refused(sample_.with("bank_angles_deg", "0,0,,0"), "bank_angles_deg", {"entry 3", "missing"});
  expect_refused(sample_.with("bank_angles_deg", "0,0,nan,0"), "bank_angles_deg", {"entry 3", "not a finite number"});
  expect_refused(sample_.changed("firing_order", "firing_angles_deg = 0,540,180,720"), "firing_angles_deg",
                 {"entry 4", "0 to below 720 deg"});
  expect_refused(sample_.with("cylinders", "17"), "cylinders", {"1 to 16"});
  expect_refused(sample_.with("cylinders", "2.5"), "cylinders", {"not a whole number"});
  expect_refused(sample_.with("cylinders", "5"), "bank_angles_deg", {"4 entries for 5 cylinders"});
}

TEST_F(BadInput, ThrowsAndSharedPinsMustFollowFromFiring) {
  const Engine with_throws = sample_.changed("cylinder_spacing_mm", "crank_throws_deg = 0,180,90,0");
  expect_refused(with_throws, "crank_throws_deg", {"cylinder 3", "given 90 deg", "at 180 deg"});
  const auto sharing = [this](const char* pins) {
    return sample_.changed("cylinder_spacing_mm", std::string("shared_pins = ") + pins);
  };
  expect_refused(sharing("1-2"), "shared_pins", {"cylinders 1 and 2 cannot share a pin", "0 and 180 deg"});
  expect_refused(sharing("1-4,2-1"), "shared_pins", {"cylinder 1 is named twice"});
  expect_refused(sharing("1-5"), "shared_pins", {"cylinder 5 does not exist"});
  expect_refused(sharing("3"), "shared_pins", {"cylinder 3 stands alone"});
  expect_refused(sharing("2-3").plus("[layout]"), sample_.size() + 1, {"[layout] is given twice"});
  expect_accepted(sharing("1-4,2-3"));
  expect_refused(sharing("1-4\ncylinder_positions_mm = 0,100,200,300"), "shared_pins", {"cylinder 2 stands between"});
  expect_refused(sample_.changed("bank_angles_deg", "cylinder_positions_mm = 0,100,200,300"), "cylinder_spacing_mm",
                 {"exclude each other"});
}

TEST_F(BadInput, ARodIsGivenByItsEndsOrAsAWholeButNotBothOrNeither) {
  const Engine no_rod = sample_.without("rod_small_end_g").without("rod_big_end_g");
  expect_refused(no_rod, "[masses]", {"either rod_small_end_g and rod_big_end_g, or rod_g and rod_com_to_crank_mm"});
  expect_refused(sample_.changed("rod_big_end_g", "rod_g = 1887"), "rod_g",
                 {"rod_g and rod_small_end_g", "exclude each other"});
  const auto whole = [&no_rod](const std::string& keys) {
    return no_rod.changed("piston_g", "piston_g = 810\n" + keys);
  };
  expect_refused(whole("rod_g = 1887"), "[masses]", {"lacks rod_com_to_crank_mm"});
  expect_refused(whole("rod_inertia_kg_mm2 = 9000\nrod_com_to_crank_mm = 56"), "[masses]", {"lacks rod_g"});
  expect_refused(whole("rod_g = 1887\nrod_com_to_crank_mm = 250"), "rod_com_to_crank_mm",
                 {"250 is out of range", "between the pins"});
  expect_accepted(whole("rod_g = 1887\nrod_com_to_crank_mm = 56"));
}

TEST_F(BadInput, AThrowIsGivenReducedOrByPinAndWebsButNotBothOrInPart) {
  const auto with = [this](const std::string& keys) { return sample_.changed("crank_pin_equivalent_g", keys); };
  expect_accepted(with("crank_pin_g = 900\ncrank_web_g = 1400\ncrank_web_radius_mm = 21"));
  expect_refused(with("crank_pin_equivalent_g = 900\ncrank_pin_g = 900"), "crank_pin_g",
                 {"crank_pin_g and crank_pin_equivalent_g", "exclude each other",
                  "crank_pin_g and crank_web_g and crank_web_radius_mm"});
  expect_refused(with("crank_pin_g = 900\ncrank_web_radius_mm = 21"), "[masses]", {"lacks crank_web_g"});
  expect_refused(with("crank_web_g = 1400\ncrank_web_radius_mm = 21"), "[masses]", {"lacks crank_pin_g"});
  expect_refused(with("crank_pin_g = 900\ncrank_web_g = -1\ncrank_web_radius_mm = 21"), "crank_web_g",
                 {"-1 is out of range; allowed: "});
}

TEST_F(BadInput, HeatIsGivenAsItselfOrByWhatItMustReach) {
  expect_refused(sample_.changed("crankcase_kPa", "heat_J = 2000"), "net_mep_kPa",
                 {"net_mep_kPa and heat_J", "exclude each other"});
  expect_refused(sample_.without("net_mep_kPa"), "[pressure]", {"either net_mep_kPa, or heat_J"});
  expect_accepted(sample_.changed("net_mep_kPa", "heat_J = 2000"));
  expect_refused(sample_.with("combustion_duration_deg", "150"), "combustion_duration_deg",
                 {"end at 144 deg", "exhaust_valve_opens_deg = 135"});
  expect_refused(sample_.with("source", "weibe"), "source", {"'weibe' is not one of", "did you mean wiebe?"});
}

TEST_F(BadInput, MisspeltNamesAreToldWithTheNameThatWasMeant) {
  expect_refused(sample_.changed("bore_mm", "bore_cm = 9.5"), "bore_cm",
                 {"unknown key 'bore_cm' in [crank]", "did you mean bore_mm?"});
  expect_refused(sample_.changed("bore_mm", "Bore_mm = 95"), "Bore_mm", {"did you mean bore_mm?"});
  expect_refused(sample_.changed("bore_mm", "stroke = 95"), "stroke = ", {"did you mean stroke_mm?"});
  expect_refused(sample_.changed("bore_mm", "piston_g = 95"), sample_.line_of("bore_mm"), {"belongs to [masses]"});
  expect_refused(sample_.changed("bore_mm", "colour = 95"), "colour", {"keys: bore_mm, stroke_mm"});
  expect_refused(sample_.changed("[masses]", "[mass]"), "[mass]", {"unknown section [mass]", "did you mean masses?"});
  expect_refused(sample_.changed("[masses]", "[flywheel]"), "[flywheel]", {"sections: engine, crank"});
  expect_refused(sample_.plus("[cam]"), "[cam]", {"[cam] needs a name", "[cam intake]"});
  expect_refused(sample_.changed("[crank]", "[crank 1]"), "[crank 1]", {"takes no name"});
  expect_refused(sample_.plus("[crank]"), sample_.size() + 1,
                 {"[crank] is given twice", "line " + std::to_string(sample_.line_of("[crank]"))});
}

TEST_F(BadInput, SeveralErrorsAreToldAtOnceAndNoneThatFollowsFromAnother) {
  const auto told = [this](const Engine& engine) {
    write("engine.ini", engine.text());
    const Answer answer = run({"show", path_});
    EXPECT_EQ(answer.status, kBadInput);
    EXPECT_EQ(answer.out, "");
    return lines_of(answer.error);
  };
  const auto expect_at = [this](const std::string& line, std::size_t number, const std::string& fragment) {
    const std::string start = path_ + ":" + std::to_string(number) + ": ";
    EXPECT_EQ(line.compare(0, start.size(), start), 0) << line << "  should start with " << start;
    EXPECT_NE(line.find(fragment), std::string::npos) << line << "  should say: " << fragment;
  };
  const Engine engine = sample_.with("bore_mm", "abc")
                            .with("compression_ratio", "-1")
                            .without("piston_g")
                            .without("rod_big_end_g")
                            .with("wiebe_m", "99");
  const std::vector<std::string> lines = told(engine);
  ASSERT_EQ(lines.size(), 5u);
  expect_at(lines[0], engine.line_of("bore_mm"), "not a number");
  expect_at(lines[1], engine.line_of("compression_ratio"), "-1 is out of range");
  expect_at(lines[2], engine.line_of("[masses]"), "lacks piston_g");
  expect_at(lines[3], engine.line_of("[masses]"), "lacks rod_big_end_g");
  expect_at(lines[4], engine.line_of("wiebe_m"), "99 is out of range");
  EXPECT_EQ(told(sample_.with("source", "weibe").without("net_mep_kPa")).size(), 1u)
      << "what a source needs is known with the source";
  EXPECT_EQ(told(sample_.changed("bore_mm", "bor_mm = 95")).size(), 1u) << "the key that was meant is not missing too";
  EXPECT_EQ(told(sample_.changed("[crank]", "[crnk]").changed("[masses]", "[mases]")).size(), 2u);
  EXPECT_EQ(told(sample_.changed("[crank]", "[crank").changed("bore_mm", "bore_mm 95")).size(), 2u);

  Engine many = sample_;
  for (int i = 0; i < 30; ++i) many = many.plus("nonsense" + std::to_string(i) + " = 1");
  const std::vector<std::string> most = told(many);
  ASSERT_EQ(most.size(), 20u);
  EXPECT_EQ(most.back(), path_ + ": 11 errors more");
}

TEST_F(BadInput, LinesThatAreNoLinesAreTold) {
  expect_refused(sample_.changed("[engine]", ""), "name", {"stands before the first section"});
  expect_refused(sample_.changed("bore_mm", "bore_mm 95"), "bore_mm", {"neither 'key = value' nor '[section]'"});
  expect_refused(sample_.changed("bore_mm", "= 95"), "= 95", {"no key stands before '='"});
  expect_refused(sample_.changed("bore_mm", "b\xC3\xBCre = 95"), "b\xC3\xBC", {"is not a key"});
  expect_refused(sample_.changed("[crank]", "[crank"), "[crank", {"no closing bracket"});
  expect_refused(sample_.changed("[crank]", "[]"), "[]", {"is not a section"});
  expect_refused(sample_.with("name", ""), "name", {"name has no value"});
  expect_refused(sample_.with("name", "# a comment"), "name", {"name has no value"});
  expect_refused(sample_.changed("name", "name =#5"), "name", {"name has no value"});
}

TEST_F(BadInput, AFileThatIsNoEngineFileIsRefusedAsAWhole) {
  expect_refusal(run({"show", folder_ / "nowhere.ini"}), folder_ / "nowhere.ini", {"cannot be read", "No such file"});
  expect_refusal(run({"show", folder_.path()}), folder_.path(), {"is a directory"});
  const auto refused = [this](const std::string& text, const std::string& place,
                              const std::vector<std::string>& fragments) {
    write("engine.ini", text);
    expect_refusal(run({"show", path_}), path_ + place, fragments);
  };
  refused("", ":1", {"the file is empty"});
  refused("# only\n\n# comments\n", ":3", {"the file is empty"});
  refused(std::string("[engine]\nname = a\0b\n", 20), ":2", {"not a text file", "0x00"});
  refused("[engine]\nname = \x1b[31mred\n", ":2", {"not a text file", "0x1B"});
  refused("[engine]\nname = caf\xE9\n", ":2", {"not a text file", "0xE9"});
  refused("[engine]\rname = old Mac\r", ":1", {"not a text file", "0x0D"});
  refused(std::string("\xFF\xFE[\0e\0", 6), ":1", {"not a text file", "UTF-16"});
  const std::string padding(1 << 20, '#');
  refused(sample_.text() + padding, "", {"too large", "1 MiB"});
  write("engine.ini", sample_.text() + padding.substr(sample_.text().size()));  // 1 MiB exactly
  EXPECT_EQ(run({"show", path_}).status, 0);
}

/// Some never end, some wait for another process, some do something when they are read: nothing but a regular file is
/// read.
TEST_F(BadInput, AFileThatIsNoRegularOneIsNotRead) {
  ASSERT_EQ(mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  std::filesystem::create_symlink(folder_ / "fifo", folder_ / "link");
  for (const std::string& path : {folder_ / "fifo", folder_ / "link", std::string("/dev/zero"),
                                  std::string("/dev/null"), std::string("/dev/tty")}) {
    const Answer answer = run({"show", path});
    EXPECT_EQ(answer.status, kBadInput) << path;
    if (path != "/dev/tty") expect_refusal(answer, path, {"is not a regular file"});  // which may not even open
  }
  for (const std::string source : {"angle_table", "volume_table"}) {
    for (const std::string table : {"fifo", "link", "/dev/zero"}) {
      expect_refused(sample_.changed("source", "source = " + source + "\nfile = " + table),
                     "file = ", {table + " is not a regular file"});
    }
  }
  const Engine ohc(contents(CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini"));
  write("engine.ini", ohc.changed("source = polynomial", "source = table\nfile = fifo\nsmoothing_um = 10")
                          .without("max_lift_mm")
                          .without("half_angle_deg")
                          .without("exponents")
                          .text());
  const Answer answer = run({"lift", path_, "--train", "intake"});
  EXPECT_EQ(answer.status, kBadInput);
  EXPECT_NE(answer.error.find("fifo is not a regular file"), std::string::npos) << answer.error;
}

TEST_F(BadInput, ASectionThatACommandNeedsIsMissedAtTheEndOfTheFile) {
  const Engine no_crank("[engine]\nname = none\nrated_rpm = 1000");
  write("engine.ini", no_crank.text());
  expect_refusal(run({"kinematics", path_, "--rpm", "2000"}), path_ + ":3", {"section [crank] is missing"});
  expect_refused(no_crank.plus("[layout]"), 4, {"[layout] needs a [crank] section"});
}

class BadDiagram : public BadInput {
 protected:
  void expect_diagram_refused(const std::string& table, const std::string& place,
                              const std::vector<std::string>& fragments,
                              const std::string& source = "angle_table") const {
    write("p.csv", table);
    write("engine.ini", sample_.changed("source", "source = " + source + "\nfile = p.csv").text());
    expect_refusal(run({"show", path_}), folder_ / "p.csv" + place, fragments);
  }
  /// Rows from -360 deg on, 1 deg apart.
  static std::string table(int rows, const std::string& last_rows = "") {
    std::string text = "crank_deg,pressure_kPa\n";
    for (int i = 0; i < rows; ++i) text += std::to_string(i - 360) + ",100\n";
    return text + last_rows;
  }
};

TEST_F(BadDiagram, IsMissedWhereItIsNamed) {
  const Engine named = sample_.changed("source", "source = angle_table\nfile = nowhere.csv");
  expect_refused(named, "file = ", {"nowhere.csv cannot be read", "No such file"});
  expect_refused(sample_.with("source", "angle_table"), "[pressure]", {"lacks file"});
  std::filesystem::create_directory(folder_ / "nowhere.csv");
  expect_refused(named, "file = ", {"is a directory"});
  std::filesystem::remove(folder_ / "nowhere.csv");
  write("nowhere.csv", "crank_deg,pressure_kPa\n" + std::string(std::size_t{8} << 20, '\n'));
  expect_refused(named, "file = ", {"too large", "8 MiB"});
}

/// The path stands in an engine file, which may come from anybody, and leads to whatever its reader may read.
TEST_F(BadDiagram, IsNotShownWhereItIsNone) {
  const std::string secret = "root:$6$salt$hash:19000:0:99999:7:::";
  for (const std::string& text :
       {secret + "\n", "crank_deg,pressure_kPa\n" + secret + "\n", "crank_deg,pressure_kPa\n1," + secret + "\n",
        "crank_deg,pressure_kPa\n" + secret + ",1\n", "crank_deg,pressure_kPa\n1,12" + secret + "\n"}) {
    write("p.csv", text);
    write("engine.ini", sample_.changed("source", "source = angle_table\nfile = p.csv").text());
    const Answer answer = run({"show", path_});
    expect_refusal(answer, folder_ / "p.csv:" + std::to_string(std::count(text.begin(), text.end(), '\n')), {});
    for (const char* part : {"root", "salt", "hash", "19000"})
      EXPECT_EQ(answer.error.find(part), std::string::npos) << answer.error;
  }
}

TEST_F(BadDiagram, NeedsItsHeaderAndTwoColumnsOfNumbers) {
  expect_diagram_refused("", ":1", {"the file is empty", "'crank_deg,pressure_kPa'"});
  expect_diagram_refused("crank_deg,pressure_kPa\n", ":1", {"no rows"});
  expect_diagram_refused("-360,100\n", ":1", {"the header row must be 'crank_deg,pressure_kPa'"});
  expect_diagram_refused("crank_deg;pressure_kPa\n", ":1", {"must be 'crank_deg,pressure_kPa'"});
  expect_diagram_refused("volume_cm3,pressure_kPa\n1,1\n", ":1", {"must be 'crank_deg,pressure_kPa'"});
  expect_diagram_refused(table(720), ":1", {"must be 'volume_cm3,pressure_kPa'"}, "volume_table");
  expect_diagram_refused(table(10, "1,2,3\n"), ":12", {"3 columns"});
  expect_diagram_refused(table(10, "17\n"), ":12", {"1 column"});
  expect_diagram_refused(table(10, "17,abc\n"), ":12", {"pressure_kPa: not a finite number"});
  expect_diagram_refused(table(10, "17,nan\n"), ":12", {"pressure_kPa: not a finite number"});
  expect_diagram_refused(table(10, "inf,100\n"), ":12", {"crank_deg: not a finite number"});
  expect_diagram_refused(table(10, "17,-1\n"), ":12", {"-1 is out of range"});
  expect_diagram_refused(table(10, std::string("17,\0\n", 5)), ":12", {"not a text file"});
}

TEST_F(BadDiagram, RisesThroughOnePeriod) {
  expect_diagram_refused(table(720, "359,100\n"), ":722", {"359 follows 359", "must rise"});
  expect_diagram_refused(table(720, "12.5,100\n"), ":722", {"12.5 follows 359", "must rise"});
  expect_diagram_refused(table(722), ":723", {"from -360 to 361 deg", "one period of 720 deg"});
  expect_diagram_refused(table(360), ":361", {"from -360 to -1 deg", "one period of 720 deg"});
  expect_diagram_refused(table(3), ":4", {"3 rows are too few"});
  expect_diagram_refused(table(1), ":2", {"1 row is too few"});
  for (const int rows : {720, 721}) {  // the closing row may stand there or not
    write("p.csv", table(rows));
    expect_accepted(sample_.changed("source", "source = angle_table\nfile = p.csv"));
  }
}

TEST_F(BadDiagram, HasTheVolumesOfItsEngine) {
  // pi / 4 * 9.5^2 * 11.5 = 815.145 cm3 displaced, an 18th of it above the piston.
  std::string litres = "volume_cm3,pressure_kPa\n0.0453,100\n";
  for (int i = 1; i < 20; ++i) litres += std::to_string(0.0453 + 0.04 * i) + ",100\n";
  write("p.csv", litres);
  write("engine.ini", sample_.changed("source", "source = volume_table\nfile = p.csv").text());
  const Answer answer = run({"forces", path_});  // what reads the diagram
  EXPECT_EQ(answer.status, 2);
  EXPECT_NE(answer.error.find("p.csv:2: volume_cm3: 0.0453 lies outside this engine's 45.2858 to 860.431 cm3 (bore, "
                              "stroke, compression_ratio)"),
            std::string::npos)
      << answer.error;
}

TEST_F(BadInput, ShowIsAnEngineFileThatShowsTheSame) {
  const Answer first = run({"show", kSample});
  EXPECT_EQ(first.status, 0);
  write("engine.ini", first.out);
  EXPECT_EQ(run({"show", path_}).out, first.out);
}

TEST_F(BadInput, OfAValveTrainIsToldWhereItStands) {
  const auto quiet = [](std::vector<std::string> words) {
    words.emplace_back("--no-warnings");  // what is refused is unusual too
    return words;
  };
  write("engine.ini", sample_.text());
  expect_refusal(run({"valve", path_, "--train", "inlet", "--rpm", "2000"}), path_,
                 {"no valve train is called 'inlet'"});
  expect_refusal(run({"redline", path_, "--train", "exhausts"}), path_, {"did you mean exhaust?"});
  // A seat of 1e9 N/mm under half a kilogram swings at 7 kHz: too fast for 512 steps in 2 ms.
  const Engine stiff = sample_.with("seat_N_per_mm", "1000000000");
  write("engine.ini", stiff.text());
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"valve", path_, "--train", "intake", "--rpm", "2000", "--tick-us", "2000"},
           {"run", path_, "--tick-us", "2000"},
           {"tables", path_, "--tick-us", "2000"}}) {
    expect_refusal(run(quiet(words)), path_, {"valve train intake", "the longest tick possible is"});
  }
  // A cam that would need a hollow flank is refused with the angle, by whichever command meets it.
  const Engine undercut = sample_.with("base_circle_mm", "2");
  write("engine.ini", undercut.text());
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"valve", path_, "--train", "intake", "--rpm", "2000"},
                                             {"redline", path_, "--train", "intake"},
                                             {"run", path_},
                                             {"tables", path_, "--tick-us", "100"}}) {
    expect_refusal(run(quiet(words)), path_ + ":" + std::to_string(undercut.line_of("base_circle_mm")),
                   {"undercut at", "deg"});
  }
}

}  // namespace
}  // namespace crankloop::bad_input::bad_input_test

// `crankloop study`: its points against commands run on files that have the values, its parts against the whole, its
// drawings, its refusals.
#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "crankloop/command_line/parallel.hpp"
#include "crankloop/command_line/shards.hpp"
#include "support/markup.hpp"
#include "support/run_command.hpp"
#include "support/units.hpp"

namespace crankloop::program::study_test {
namespace {

const std::string k125 = CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini";
const std::string kFour = CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini";

using Words = std::vector<std::string>;

std::string printed_by(const Command& command, const Words& words) {
  testing::internal::CaptureStdout();
  std::string refusal;
  try {
    EXPECT_EQ(command.run(Arguments(command, words)), kSuccess);
  } catch (const InputError& refused) {
    refusal = refused.what();
  }
  std::string printed = testing::internal::GetCapturedStdout();
  EXPECT_EQ(refusal, "") << command.name;
  return printed;
}

std::string refusal_of(const Command& command, const Words& words) {
  testing::internal::CaptureStdout();
  std::string message;
  try {
    command.run(Arguments(command, words));
  } catch (const InputError& refused) {
    message = refused.what();
  }
  testing::internal::GetCapturedStdout();
  return message;
}

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Cells of a CSV file below its header; the last cell, a reason, may hold commas.
class Rows {
 public:
  explicit Rows(const std::string& csv) : lines_{split_at(csv, '\n')}, names_{split_at(lines_.at(0), ',')} {}

  [[nodiscard]] std::size_t count() const { return lines_.size() - 1; }
  [[nodiscard]] std::string cell(std::size_t row, const std::string& column) const {
    const auto at = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), column) - names_.begin());
    EXPECT_LT(at, names_.size()) << column << " in " << lines_[0];
    std::vector<std::string> cells = split_at(lines_.at(row + 1), ',');
    cells.resize(std::max(cells.size(), names_.size()));
    return cells.at(at);
  }
  [[nodiscard]] double number(std::size_t row, const std::string& column) const {
    const std::string text = cell(row, column);
    return text.empty() ? std::nan("") : std::stod(text);
  }
  [[nodiscard]] const std::string& line(std::size_t row) const { return lines_.at(row + 1); }

 private:
  std::vector<std::string> lines_;
  std::vector<std::string> names_;
};

class StudyCommand : public RunCommand {
 protected:
  /// The 125 with another line for a key, as an editor would write it.
  [[nodiscard]] std::string edited(const std::string& key, const std::string& value) const {
    std::string text = contents(k125);
    const std::size_t at = text.find("\n" + key + " = ");
    EXPECT_NE(at, std::string::npos) << key;
    text.replace(at + 1, text.find('\n', at + 1) - at - 1, key + " = " + value);
    const std::string file = path("edited_" + key + "_" + value + ".ini");
    std::ofstream(file) << text;
    return file;
  }
  /// A small study: 12 points of cheap commands, with gaps.
  [[nodiscard]] static Words small() {
    return {k125,    "--vary",         "cam.intake.max_lift_mm=5:60:4", "rpm=5000:9000:3",
            "--of",  "valve.max_lift", "valve.separation_start",        "kinematics.max_velocity",
            "--set", "cycles=2"};
  }
  [[nodiscard]] std::string part(int number, int count, const Words& study = small()) const {
    const std::string file = path("part_" + std::to_string(number) + "_" + std::to_string(count));
    printed_by(kStudy,
               joined(study, {"--shard", std::to_string(number) + "/" + std::to_string(count), "--part", file}));
    return file;
  }
};

TEST_F(StudyCommand, HasWhatEachCommandPrintsOfAFileWithThatValue) {
  const struct {
    const char* key;
    const char* name;
    const char* values;
    double numbers[2];
  } cases[] = {{"rocker.clearance_mm", "clearance_mm", "0.03:0.1:2", {0.03, 0.1}},
               {"crank.pin_offset_mm", "pin_offset_mm", "0:2:2", {0, 2}}};
  for (const auto& one : cases) {
    SCOPED_TRACE(one.key);
    const Rows rows(printed_by(
        kStudy, {k125, "--vary", std::string(one.key) + "=" + one.values, "--of", "valve.max_lift",
                 "valve.max_acceleration", "redline.static_redline", "run.mean_torque", "run.max_crank_pin_load",
                 "balance.free_force_first_N", "kinematics.min_acceleration", "--set", "from=8560", "to=8566"}));
    ASSERT_EQ(rows.count(), 2u);
    for (std::size_t row = 0; row < 2; ++row) {
      const std::string file = edited(one.name, shortest(one.numbers[row]));
      const auto same = [&](const std::string& column, const Command& command, const std::string& figure, Words words) {
        words.insert(words.begin(), file);
        const double expected = line(printed_by(command, words), figure).first;
        EXPECT_NEAR(rows.number(row, column), expected, 1e-5 * std::abs(expected)) << column;
      };
      same("valve.max_lift_mm", kValve, "max_lift", {});
      same("valve.max_acceleration_m_s2", kValve, "max_acceleration", {});
      same("redline.static_redline_rpm", kRedline, "static_redline", {"--from", "8560", "--to", "8566"});
      same("run.mean_torque_Nm", kRun, "mean_torque", {});
      same("run.max_crank_pin_load_N", kRun, "max_crank_pin_load", {});
      same("kinematics.min_acceleration_m_s2", kKinematics, "min_acceleration", {"--csv", path("k.csv")});
      const std::string balance = printed_by(kBalance, {file});
      EXPECT_NE(balance.find("free_force_first_N," + rows.cell(row, "balance.free_force_first_N") + "\n"),
                std::string::npos);
    }
  }
}

TEST_F(StudyCommand, VariesOptionsAndPassesThemToTheCommandsThatHaveThem) {
  const Rows rows(printed_by(kStudy, {kFour, "--vary", "rpm=2000:4000:2", "throttle=0.2,1", "--of",
                                      "run.volumetric_efficiency", "kinematics.crank_speed", "--set", "tick-us=200"}));
  ASSERT_EQ(rows.count(), 4u);
  std::size_t row = 0;
  for (const char* rpm : {"2000", "4000"}) {
    for (const char* throttle : {"0.2", "1"}) {
      const std::string printed = run({kFour, "--rpm", rpm, "--throttle", throttle, "--tick-us", "200"});
      EXPECT_NEAR(rows.number(row, "run.volumetric_efficiency"), line(printed, "volumetric_efficiency").first, 1e-5);
      EXPECT_NEAR(rows.number(row, "kinematics.crank_speed_rad_s"), std::stod(rpm) * support::kPi / 30, 1e-8);
      ++row;
    }
  }
}

/// A centric crank's largest acceleration is r w^2 (1 + lambda), at the top dead centre.
TEST_F(StudyCommand, LetsTheRodFollowLambda) {
  const Rows rows(printed_by(kStudy, {k125, "--vary", "crank.rod_ratio=0.2:0.35:7", "--of",
                                      "kinematics.max_acceleration", "kinematics.lambda", "--set", "rpm=6000"}));
  ASSERT_EQ(rows.count(), 7u);
  const double w = 6000 * support::kPi / 30;
  for (std::size_t row = 0; row < 7; ++row) {
    const double lambda = rows.number(row, "crank.rod_ratio");
    EXPECT_NEAR(rows.number(row, "kinematics.lambda"), lambda, 1e-12);
    EXPECT_NEAR(rows.number(row, "kinematics.max_acceleration_m_s2"), 28.9e-3 * w * w * (1 + lambda), 1e-6);
  }
}

TEST_F(StudyCommand, VariesTablesEntriesOfListsAndWords) {
  for (const char* scale : {"1", "1.1"}) {
    std::ofstream table(path(std::string("cam_") + scale + ".csv"));
    table << "cam_deg,lift_mm\n";
    for (int deg = -80; deg <= 80; ++deg) {
      const double u = std::min(1.0, std::abs(deg / 70.0));
      table << deg << "," << std::stod(scale) * 3 * std::pow(1 - u * u, 3) << "\n";
    }
  }
  const std::string file = path("copy.ini");
  std::ofstream(file) << contents(k125);
  const Rows tables(printed_by(
      kStudy, joined({file, "--vary", "cam.file=cam_1.csv,cam_1.1.csv", "--of", "valve.max_theoretical_lift"},
                     {"--set", "cam.source=table", "cam.smoothing_um=1", "cam.file=cam_1.csv"})));
  ASSERT_EQ(tables.count(), 2u);
  EXPECT_EQ(tables.cell(1, "cam.intake.file"), "cam_1.1.csv");
  // The rocker turns 3 mm of cam lift into nearly 4 mm of the valve, and 10 % more into some 10 % more.
  EXPECT_NEAR(tables.number(1, "valve.max_theoretical_lift_mm") / tables.number(0, "valve.max_theoretical_lift_mm"),
              1.1, 0.01);

  const Rows entries(printed_by(kStudy, {k125, "--vary", "cam.exponents.2=8:10:2", "--of", "valve.max_acceleration"}));
  const Rows lists(
      printed_by(kStudy, {k125, "--vary", "cam.exponents=2,8,18,26/2,10,18,26", "--of", "valve.max_acceleration"}));
  for (std::size_t row = 0; row < 2; ++row)
    EXPECT_EQ(split_at(entries.line(row), ',').at(1), split_at(lists.line(row), ',').at(4));  // of a quoted list
  EXPECT_NE(entries.cell(0, "valve.max_acceleration_m_s2"), entries.cell(1, "valve.max_acceleration_m_s2"));
}

TEST_F(StudyCommand, LeavesAGapWithItsReasonWhereAPointIsRefused) {
  const Rows rows(printed_by(kStudy, small()));
  ASSERT_EQ(rows.count(), 12u);
  EXPECT_EQ(rows.line(0).rfind("5,5000,", 0), 0u);
  EXPECT_NE(rows.cell(0, "valve.max_lift_mm"), "");
  EXPECT_EQ(rows.cell(0, "valve.separation_start_deg"), "");
  EXPECT_EQ(rows.cell(0, "refused"), "valve.separation_start is none");
  EXPECT_EQ(rows.cell(11, "valve.max_lift_mm"), "");
  EXPECT_NE(rows.cell(11, "kinematics.max_velocity_m_s"), "") << "one command's refusal is not another's";
  EXPECT_NE(rows.line(11).find("the cam is undercut"), std::string::npos) << rows.line(11);
}

TEST_F(StudyCommand, HasTheSameBytesOfAnyNumberOfThreads) {
  std::string first;
  for (const char* threads : {"1", "2", "3", "16"}) {
    const Words files{"--csv", path("t.csv"), "--report", path("t.html"), "--plot", path("t.svg")};
    const std::string summary = printed_by(kStudy, joined(joined(small(), {"--threads", threads}), files));
    const std::string all = summary + contents(path("t.csv")) + contents(path("t.html")) + contents(path("t.svg"));
    if (first.empty()) first = all;
    EXPECT_TRUE(all == first) << threads;
  }
}

TEST_F(StudyCommand, HasTheSameBytesJoinedFromShardsInAnyOrder) {
  const auto outputs = [&](const Words& how, const std::string& name) {
    const Words files{"--csv", path(name + ".csv"), "--report", path(name + ".html"), "--plot", path(name + ".svg")};
    const std::string summary = printed_by(kStudy, joined(joined(small(), how), files));
    return summary + contents(path(name + ".csv")) + contents(path(name + ".html")) + contents(path(name + ".svg"));
  };
  const std::string whole = outputs({}, "whole");
  EXPECT_TRUE(outputs({"--join", part(1, 1)}, "one") == whole);
  EXPECT_TRUE(outputs({"--join", part(2, 3), part(3, 3), part(1, 3)}, "three") == whole);
  Words many{"--join"};
  for (int number = 1; number <= 13; ++number) many.push_back(part(number, 13));  // more than points: some are empty
  EXPECT_TRUE(outputs(many, "many") == whole);
}

TEST_F(StudyCommand, RefusesPartsThatAreNotOneWholeStudyByName) {
  const std::string one = part(1, 3), two = part(2, 3), three = part(3, 3);
  const auto refuses = [&](const Words& parts, const std::string& why) {
    const std::string told = refusal_of(kStudy, joined(joined(small(), {"--join"}), parts));
    EXPECT_NE(told.find(why), std::string::npos) << told;
  };
  refuses({one, three}, "shard 2 of 3 is missing");
  refuses({three}, "shards 1, 2 of 3 are missing");
  refuses({one, two, three, two}, two + ": is shard 2 of 3, as is " + two + "; each is needed once");
  refuses({one, part(1, 2)}, path("part_1_2") + ": is shard 1 of 2, but " + one + " is one of 3");
  refuses({one, two, path("no_part")}, path("no_part") + ": cannot be read");
  refuses({one, two, k125}, k125 + ": is no part of a `crankloop study --shard K/N`");
  const std::string whole_part = contents(three);
  for (const std::size_t left : {std::size_t{1}, std::size_t{10}, whole_part.size() / 2}) {
    std::ofstream(path("cut"), std::ios::binary) << whole_part.substr(0, whole_part.size() - left);
    if (left > 1) refuses({one, two, path("cut")}, path("cut") + ": is not complete; run its shard again");
  }
  Words other = small();
  other[2] = "cam.intake.max_lift_mm=5:50:4";
  const std::string told = refusal_of(kStudy, joined(joined(other, {"--join"}), {one, two, three}));
  EXPECT_NE(told.find(one + ": is a part of another study"), std::string::npos) << told;
}

TEST_F(StudyCommand, TellsPartsOfAnotherEngineFromItsOwn) {
  const std::string file = path("engine.ini");
  const auto words = [&] { return Words{file, "--vary", "rpm=1000:2000:2", "--of", "kinematics.max_velocity"}; };
  std::ofstream(file) << contents(k125);
  const std::string one = part(1, 2, words()), two = part(2, 2, words());
  std::ofstream(file) << contents(k125) << "# another remark\n";
  EXPECT_NE(printed_by(kStudy, joined(words(), {"--join", one, two})), "") << "remarks do not matter";
  std::string text = contents(k125);
  text.replace(text.find("57.8"), 4, "57.9");
  std::ofstream(file) << text;
  EXPECT_NE(refusal_of(kStudy, joined(words(), {"--join", one, two})).find("is a part of another study"),
            std::string::npos);
}

/// The file has no octane number, the points have one.
TEST_F(StudyCommand, HasAFigureThatOnlyTheVariedValueBrings) {
  const Rows rows(printed_by(kStudy, {kFour, "--vary", "gas.octane=90,100", "--of", "run.knock_integral", "--set",
                                      "rpm=2000", "tick-us=200"}));
  ASSERT_EQ(rows.count(), 2u);
  EXPECT_GT(rows.number(0, "run.knock_integral"), rows.number(1, "run.knock_integral"));
  EXPECT_GT(rows.number(1, "run.knock_integral"), 0);
}

TEST_F(StudyCommand, RefusesByName) {
  const struct {
    Words words;
    const char* why;
  } cases[] = {
      {{"--of", "valve.max_lift"}, "--vary is missing"},
      {{"--vary", "rpm=1000:2000:2"}, "--of is missing"},
      {{"--vary", "rpm=1000:2000:2", "--of", "valve.max_lft"}, "did you mean max_lift?"},
      {{"--vary", "rpm=1000:2000:2", "--of", "valve.periodic"}, "valve.periodic is no number but a word: yes"},
      {{"--vary", "rpm=1000:2000:2", "--of", "valves.max_lift"}, "did you mean valve?"},
      {{"--vary", "rpm=1000:2000:2", "--of", "valve"}, "write COMMAND.NAME"},
      {{"--vary", "rpm=1000:2000:2", "--of", "run.wall_time_per_tick"},
       "prints no 'wall_time_per_tick' here; nearest are "},
      {{"--vary", "rpm=1000:2000:2", "--of", "run.knocking"}, "`crankloop run FILE` lists all "},
      {{"--vary", "rpm=1000:2000:2", "--of", "valve.max_lift", "valve.max_lift"}, "given twice"},
      {{"--vary", "rmp=1000:2000:2", "--of", "valve.max_lift"}, "did you mean rpm?"},
      {{"--vary", "csv=a,b", "--of", "valve.max_lift"}, "'csv' is neither SECTION.KEY"},
      {{"--vary", "rpm=2000:1000:2", "--of", "valve.max_lift"}, "rpm: FROM must be less than TO"},
      {{"--vary", "rpm=1000:1e9:2", "--of", "valve.max_lift"}, "rpm: TO: 1e9 is out of range"},
      {{"--vary", "rpm=1:2:0", "--of", "valve.max_lift"}, "rpm: N, the number of values: 0 is out of range"},
      {{"--vary", "rpm", "--of", "valve.max_lift"}, "'rpm' has no name or no value"},
      {{"--vary", "rpm=1,,3", "--of", "valve.max_lift"}, "a value is missing"},
      {{"--vary", "rpm=1,2", "rpm=1,2", "--of", "valve.max_lift"}, "rpm is varied twice"},
      {{"--vary", "crank.rod_length_mm=90,100", "crank.rod_ratio=0.25,0.3", "--of", "valve.max_lift"},
       "crank.rod_length_mm and crank.rod_ratio are one quantity"},
      {{"--vary", "cam.exponents.2=8,10", "cam.exponents=2,8,18,26/2,12,18,26", "--of", "valve.max_lift"},
       "cam.intake.exponents.2 and cam.intake.exponents are one quantity"},
      {{"--vary", "rpm=1,2", "--of", "valve.max_lift", "--set", "crank.stroke_mm=57", "crank.stroke_mm=30"},
       "crank.stroke_mm is set twice"},
      {{"--vary", "crank.rod_ratio=0.25,0.3", "--of", "valve.max_lift", "--set", "crank.rod_length_mm=150"},
       "crank.rod_length_mm and the varied crank.rod_ratio are one quantity"},
      {{"--vary", "rpm=1,2", "cycles=1,2", "tick-us=10,20", "--of", "valve.max_lift"}, "at most two"},
      {{"--vary", "rpm=1:2:2000", "tick-us=1:2:2000", "--of", "valve.max_lift"}, "a study of 4e+06 points"},
      {{"--vary", "crnk.bore_mm=50:60:2", "--of", "valve.max_lift"}, "did you mean crank?"},
      {{"--vary", "crank.bore=50:60:2", "--of", "valve.max_lift"}, "did you mean bore_mm?"},
      {{"--vary", "cam.exhaust.max_lift_mm=5:6:2", "--of", "valve.max_lift"}, "has no [cam exhaust]"},
      {{"--vary", "crank.bore_mm.2=50:60:2", "--of", "valve.max_lift"}, "bore_mm is no list of numbers"},
      {{"--vary", "cam.exponents.9=50:60:2", "--of", "valve.max_lift"}, "none is number 9"},
      {{"--vary", "cam.file=a.csv,b.csv", "--of", "valve.max_lift"}, "cam.intake.file is not used"},
      {{"--vary", "rpm=1000:2000:2", "--of", "valve.max_lift", "--set", "cam.file=a.csv"}, "is not used"},
      {{"--vary", "rpm=1000:2000:2", "--of", "valve.max_lift", "--set", "crank.bore_mm=-1"}, "-1 is out of range"},
      {{"--vary", "rpm=1000:2000:2", "--of", "valve.max_lift", "--shard", "1/2"}, "--shard and --part belong together"},
      {{"--vary", "rpm=1000:2000:2", "--of", "valve.max_lift", "--shard", "3/2", "--part", "p"}, "K must be at most N"},
      {{"--vary", "rpm=1000:2000:2", "--of", "valve.max_lift", "--shard", "0/2", "--part", "p"}, "is no K/N"},
      {{"--vary", "rpm=1000:2000:2", "--of", "valve.max_lift", "--shard", "1/2", "--part", "p", "--csv", "x"},
       "--csv is of all points"},
      {{"--vary", "rpm=1000:2000:2", "--of", "valve.max_lift", "--shard", "1/2", "--part", "p", "--join", "x"},
       "--shard and --join exclude each other"},
  };
  for (const auto& one : cases) {
    const std::string told = refusal_of(kStudy, joined({k125}, one.words));
    EXPECT_NE(told.find(one.why), std::string::npos) << one.why << " is not in: " << told;
  }
  const std::string which =
      refusal_of(kStudy, {kFour, "--vary", "cam.max_lift_mm=5:6:2", "--of", "kinematics.max_velocity"});
  EXPECT_NE(which.find("could be any of cam.intake.max_lift_mm, cam.exhaust.max_lift_mm"), std::string::npos) << which;
}

TEST_F(StudyCommand, DrawsCurvesWithTheFilesOwnValueOverOneKeyHeatMapsOverTwoAndACurvePerValueWhereTheyAreFew) {
  printed_by(kStudy, {k125, "--vary", "crank.rod_length_mm=90:120:4", "--of", "kinematics.max_velocity",
                      "kinematics.max_acceleration", "--report", path("one.html"), "--plot", path("one.svg")});
  const support::Markup one = support::read(contents(path("one.html")));
  EXPECT_EQ(one.fault, "");
  EXPECT_EQ(one.all("svg").size(), 2u);
  EXPECT_NE(contents(path("one.html")).find("the file&#39;s own"), std::string::npos);
  EXPECT_EQ(support::read(contents(path("one.svg"))).fault, "");

  printed_by(kStudy, {k125, "--vary", "crank.rod_length_mm=90:120:6", "crank.pin_offset_mm=0:2:5", "--of",
                      "kinematics.max_velocity", "--report", path("two.html")});
  const support::Markup two = support::read(contents(path("two.html")));
  EXPECT_EQ(two.fault, "");
  std::size_t fields = 0;
  for (const auto& group : two.all("g")) {
    const auto field = group.attributes.find("data-field");
    if (field == group.attributes.end()) continue;
    EXPECT_EQ(split_at(field->second, ' ').size(), 30u);
    ++fields;
  }
  EXPECT_EQ(fields, 1u);

  printed_by(kStudy, {k125, "--vary", "crank.pin_offset_mm=0,1", "crank.rod_length_mm=90:120:6", "--of",
                      "kinematics.max_velocity", "--report", path("few.html")});
  const support::Markup few = support::read(contents(path("few.html")));
  EXPECT_TRUE(few.of_class("heat").empty());
  std::vector<std::string> curves;
  for (const support::Element& legend : few.of_class("legend")) curves.push_back(legend.text);
  EXPECT_EQ(curves, (std::vector<std::string>{"0 mm", "1 mm"}));
}

/// `redline --vary` of a key: each row is the redline of a file that has the value, and the file's own is among them.
TEST_F(StudyCommand, IsUnderRedlineWhoseKeysHaveTheRedlineOfAFileWithThatValue) {
  const Words range{"--from", "8500", "--to", "8620"};
  const std::string csv = path("redline.csv");
  const std::string printed = printed_by(
      kRedline,
      joined({k125, "--vary", "rocker.clearance_mm=0.02:0.08:2", "--csv", csv, "--report", path("r.html")}, range));
  EXPECT_EQ(support::read(contents(path("r.html"))).fault, "");
  const std::vector<std::string> lines = split_at(printed, '\n');
  const auto row_of = [&](const std::string& value) {
    for (const std::string& one : lines) {
      std::istringstream words(one);
      std::string first;
      std::string second;
      if (words >> first >> second && first == value) return second;
    }
    return std::string();
  };
  for (const char* clearance : {"0.02", "0.05", "0.08"}) {
    const std::string alone = printed_by(kRedline, joined({edited("clearance_mm", clearance)}, range));
    EXPECT_EQ(row_of(clearance), shortest(line(alone, "separation_onset").first)) << clearance << "\n" << printed;
  }
  EXPECT_EQ(contents(csv).rfind("rocker.intake.clearance_mm,speed_rpm,", 0), 0u);
  const std::string told = refusal_of(kRedline, joined({k125, "--vary", "cam.max_lift_mm=6,60"}, range));
  EXPECT_NE(told.find("refused with cam.intake.max_lift_mm = 60"), std::string::npos) << told;
}

TEST(RunInParallel, DoesEachOnceAndThrowsTheFirstRefusal) {
  for (const int threads : {1, 2, 7}) {
    std::vector<int> done(100, 0);
    int after = 0;
    run_in_parallel(
        threads, done.size(), [&](std::size_t i) { ++done[i]; }, [&] { ++after; });
    EXPECT_EQ(done, std::vector<int>(100, 1));
    EXPECT_EQ(after, 100);
    for (int repeat = 0; repeat < 50; ++repeat) {
      std::string told;
      try {
        run_in_parallel(
            threads, 100,
            [](std::size_t i) {
              if (i % 10 == 3) throw InputError(std::to_string(i));
            },
            [] {});
      } catch (const InputError& refused) {
        told = refused.what();
      }
      EXPECT_EQ(told, "3");
    }
  }
}

/// While one lives, a new thread needs a stack that no machine has room for.
class NoRoomForThreads {
 public:
  NoRoomForThreads() {
    EXPECT_EQ(pthread_getattr_default_np(&before_), 0);
    pthread_attr_t huge;
    pthread_attr_init(&huge);
    EXPECT_EQ(pthread_attr_setstacksize(&huge, std::size_t{1} << 60), 0);
    EXPECT_EQ(pthread_setattr_default_np(&huge), 0);
    pthread_attr_destroy(&huge);
  }
  NoRoomForThreads(const NoRoomForThreads&) = delete;
  NoRoomForThreads& operator=(const NoRoomForThreads&) = delete;
  ~NoRoomForThreads() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }

 private:
  pthread_attr_t before_{};
};

TEST(RunInParallel, DoesAllWithTheThreadsThereAre) {
  const NoRoomForThreads none;
  std::vector<int> done(100, 0);
  int after = 0;
  run_in_parallel(
      64, done.size(), [&](std::size_t i) { ++done[i]; }, [&] { ++after; });
  EXPECT_EQ(done, std::vector<int>(100, 1));
  EXPECT_EQ(after, 100);
}

TEST(ExactText, GivesEveryNumberBack) {
  for (const double value : {0.0, 1.0 / 3, -1e-300, 5e-324, 1.7976931348623157e308})
    EXPECT_EQ(exact_number(exact_text(value)), value);
  EXPECT_TRUE(std::isnan(exact_number(exact_text(std::nan("")))));
  EXPECT_TRUE(std::isinf(exact_number(exact_text(-HUGE_VAL))) && exact_number(exact_text(-HUGE_VAL)) < 0);
}

}  // namespace
}  // namespace crankloop::program::study_test

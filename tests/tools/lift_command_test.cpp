// `crankloop lift` and the valve trains of an engine file: the 125's table, measured cams, and what is said about
// trains that cannot work.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <crankloop/tabulate/valve_lift.hpp>

#include "crankloop/command_line/commands.hpp"
#include "crankloop/engine_file/engine_file.hpp"
#include "crankloop/files/error.hpp"
#include "support/files.hpp"
#include "support/markup.hpp"
#include "support/status.hpp"
#include "support/units.hpp"
#include "support/valve_trains.hpp"

namespace crankloop::program::lift_command_test {
namespace {

using support::kOhc125;
using support::kRadPerDeg;

using support::contents;

/// `text` with the line that starts with `start` replaced.
std::string with_line(const std::string& text, const std::string& start, const std::string& line) {
  std::istringstream lines(text);
  std::string changed;
  bool found = false;
  for (std::string one; std::getline(lines, one);) {
    const bool here = one.compare(0, start.size(), start) == 0;
    found = found || here;
    changed += (here ? line : one) + "\n";
  }
  EXPECT_TRUE(found) << start;
  return changed;
}

class LiftCommand : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  /// The table's rows, and what is printed beside it in `summary_`.
  std::vector<std::vector<double>> rows(const std::string& file, const std::vector<std::string>& options = {}) {
    const std::string csv = folder_ / "lift.csv";
    std::vector<std::string> words = {file, "--train", "intake", "--csv", csv};
    words.insert(words.end(), options.begin(), options.end());
    testing::internal::CaptureStdout();
    const int status = kLift.run(Arguments(kLift, words));
    summary_ = testing::internal::GetCapturedStdout();
    EXPECT_EQ(status, kSuccess);
    std::ifstream table(csv);
    std::string line;
    std::getline(table, line);
    EXPECT_EQ(line, "cam_deg,rocker_angle_deg,lift_mm,lift_mm_per_rad,lift_mm_per_rad2,rocker_ratio");
    std::vector<std::vector<double>> rows;
    while (std::getline(table, line)) {
      std::istringstream cells(line);
      rows.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
      EXPECT_EQ(rows.back().size(), 6u) << line;
    }
    return rows;
  }

  void rows_with_flow(const std::string& file) {
    testing::internal::CaptureStdout();
    const int status = kLift.run(Arguments(kLift, {file, "--train", "intake", "--csv", folder_ / "flow.csv"}));
    summary_ = testing::internal::GetCapturedStdout();
    EXPECT_EQ(status, kSuccess);
  }

  std::string refusal(const std::string& file, const std::string& train = "intake") const {
    try {
      static_cast<void>(kLift.run(Arguments(kLift, {file, "--train", train, "--csv", folder_ / "none.csv"})));
    } catch (const InputError& error) {
      EXPECT_FALSE(std::filesystem::exists(folder_ / "none.csv"));
      return error.what();
    }
    return "";
  }

  /// The 125 with its cam measured to whole micrometres every degree.
  std::string measured_125(const std::string& csv, double smoothing_um) const {
    std::string text = with_line(contents(kOhc125), "source = polynomial", "source = table");
    text = with_line(text, "max_lift_mm", "file = " + csv);
    text = with_line(text, "half_angle_deg", "smoothing_um = " + std::to_string(smoothing_um));
    return with_line(text, "exponents", "");
  }
  static std::string cam_rows(int from_deg, int to_deg) {
    CamProfile cam;
    EXPECT_TRUE(accepted(cam.init(support::ohc_125_cam())));
    std::string rows = "cam_deg,lift_mm\n";
    for (int deg = from_deg; deg <= to_deg; ++deg) {
      rows +=
          std::to_string(deg) + "," + std::to_string(std::round(cam.at(deg * kRadPerDeg).lift_m * 1e6) / 1e3) + "\n";
    }
    return rows;
  }

  support::TemporaryFolder folder_;
  std::string summary_;
};

TEST_F(LiftCommand, TabulatesTheTrainOfThe125OverATurnOfItsCam) {
  const auto table = rows(kOhc125);
  ValveLift lift;
  ASSERT_TRUE(accepted(lift.init(support::ohc_125_cam(), support::ohc_125_rocker())));
  ASSERT_EQ(table.size(), 361u);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::vector<double>& row = table[i];
    EXPECT_EQ(row[0], static_cast<double>(i) - 180);
    const LiftPose pose = lift.at(row[0] * kRadPerDeg);
    // 12 digits are printed; the file's millimetres are the definition's to one rounding.
    EXPECT_NEAR(row[1], pose.rocker_rad / kRadPerDeg, 1e-9);
    EXPECT_NEAR(row[2], pose.lift_m > 0 ? pose.lift_m * 1e3 : 0, 1e-11);
    EXPECT_NEAR(row[3], pose.per_rad_m * 1e3, 1e-10);
    EXPECT_NEAR(row[4], pose.per_rad2_m * 1e3, 1e-9);
    EXPECT_NEAR(row[5], pose.rocker_ratio, 1e-11);
  }
  EXPECT_NEAR(table[180][2], 7.815, 0.0005);
  EXPECT_NE(summary_.find("max_theoretical_lift = 7.815"), std::string::npos) << summary_;
  EXPECT_NE(summary_.find("min_cam_radius = 5.869"), std::string::npos) << summary_;
  EXPECT_EQ(summary_.find("smoothing"), std::string::npos) << summary_;
}

/// The sample of two litres: valves of 33 mm, of which a cylinder has two.
/// Two intake valves of a cylinder as one train of two or as two trains of one: the same gas goes through them.
TEST_F(LiftCommand, CountsTheValvesOfAllTrainsOfThePort) {
  const std::string text = support::contents(CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini");
  std::string rest, ones, twos;
  bool of_intake = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line[0] == '[') of_intake = line.find(" intake]") != std::string::npos;
    if (!of_intake) {
      if (line.rfind("on = cam intake", 0) == 0) line = "on = cam in1";
      rest += line + "\n";
      continue;
    }
    if (line.compare(0, 12, "per_cylinder") == 0) line = "per_cylinder = 1";
    const std::size_t name = line[0] == '[' ? line.find(" intake]") : std::string::npos;
    ones += (name == std::string::npos ? line : line.substr(0, name) + " in1]") + "\n";
    twos += (name == std::string::npos ? line : line.substr(0, name) + " in2]") + "\n";
  }
  const auto figures = [](const std::string& file, const char* train) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(kLift.run(Arguments(kLift, {file, "--train", train, "--csv", "/dev/null"})), kSuccess);
    const std::string summary = testing::internal::GetCapturedStdout();
    return summary.substr(std::min(summary.size(), summary.find("area_per_displacement")));
  };
  const std::string together = figures(write("one.ini", text), "intake");
  EXPECT_NE(together.find("inlet_mach_index"), std::string::npos) << together;
  EXPECT_EQ(figures(write("two.ini", rest + ones + twos), "in1"), together);
}

TEST_F(LiftCommand, TellsTheFlowAreaWhereTheFileHasADiameterOfTheValve) {
  constexpr const char* kFour = CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini";
  const std::string csv = folder_ / "flow.csv";
  testing::internal::CaptureStdout();
  ASSERT_EQ(kLift.run(Arguments(kLift, {kFour, "--train", "intake", "--csv", csv, "--step-deg", "0.1"})), kSuccess);
  const std::string summary = testing::internal::GetCapturedStdout();
  std::ifstream table(csv);
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line,
            "cam_deg,rocker_angle_deg,lift_mm,lift_mm_per_rad,lift_mm_per_rad2,rocker_ratio,flow_area_mm2,"
            "effective_area_mm2");
  double geometric = 0;
  double effective = 0;
  double largest = 0;
  while (std::getline(table, line)) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    ASSERT_EQ(row.size(), 8u) << line;
    geometric += 0.2 * row[6];  // 0.1 deg of the cam are 0.2 of the crank
    effective += 0.2 * row[7];
    largest = std::max(largest, row[6]);
  }
  EXPECT_NEAR(largest, std::acos(-1.0) / 4 * (33 * 33 - 6.6 * 6.6), 1e-6);  // the port's, less the stem
  const auto value = [&summary](const std::string& name) {
    const std::size_t at = summary.find("\n" + name + " = ");
    EXPECT_NE(at, std::string::npos) << name << " is not in\n" << summary;
    return at == std::string::npos ? 0 : std::stod(summary.substr(at + name.size() + 4));
  };
  EXPECT_NEAR(value("theoretical_open_period"), 256, 1e-3);  // 4 times the half angle
  EXPECT_NEAR(value("theoretical_flow_area_integral"), geometric, 1e-5 * geometric);
  EXPECT_NEAR(value("theoretical_effective_area_integral"), effective, 1e-5 * effective);
  EXPECT_NEAR(value("theoretical_flow_area_mean"), geometric / 256, 1e-5 * geometric);
  EXPECT_NEAR(value("theoretical_effective_area_mean"), effective / 256, 1e-5 * effective);
  EXPECT_NEAR(value("area_per_displacement"), 2e-6 * (geometric / 256) / 499.56e-6, 1e-4);
  EXPECT_NEAR(value("mean_gas_speed"), 5808.8 * 17.2 / (2 * geometric / 256), 1e-2);
  EXPECT_NEAR(value("inlet_mach_index"), 5808.8 * 17.2 / (2 * effective / 256) / 346.2, 1e-4);
  EXPECT_NE(summary.find("# flow area: of one valve, over the crank angle; assumed: seat_width_mm = 1.32, "
                         "seat_angle_deg = 45, port_diameter_mm = 33, stem_diameter_mm = 6.6, flow coefficients of a "
                         "usual valve\n"),
            std::string::npos)
      << summary;
}

/// Speeds per second against differences of the rows, a step of 0.05 deg at 7000 / 2 rpm.
TEST_F(LiftCommand, TellsVelocityAndAccelerationPerSecondAtASpeed) {
  const std::string csv = folder_ / "speeds.csv";
  testing::internal::CaptureStdout();
  ASSERT_EQ(kLift.run(Arguments(kLift, {kOhc125, "--csv", csv, "--rpm", "7000", "--step-deg", "0.05"})), kSuccess);
  const std::string summary = testing::internal::GetCapturedStdout();
  std::ifstream table(csv);
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line,
            "cam_deg,rocker_angle_deg,lift_mm,lift_mm_per_rad,lift_mm_per_rad2,rocker_ratio,velocity_m_s,"
            "acceleration_m_s2");
  std::vector<std::vector<double>> rows;
  while (std::getline(table, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  constexpr double kStep_s = 0.05 / (7000.0 / 2 / 60 * 360);
  double fastest = 0;
  double hardest = 0;
  double slowest = 0;
  for (std::size_t i = 1; i + 1 < rows.size(); ++i) {
    fastest = std::max(fastest, std::abs(rows[i][6]));
    hardest = std::max(hardest, rows[i][7]);
    slowest = std::min(slowest, rows[i][7]);
    if (rows[i - 1][2] <= 0 || rows[i + 1][2] <= 0) continue;  // lift_mm is clipped
    const double before = rows[i - 1][2];
    const double behind = rows[i + 1][2];
    ASSERT_NEAR(rows[i][6], (behind - before) / 1e3 / (2 * kStep_s), 1e-4) << rows[i][0];
    ASSERT_NEAR(rows[i][7], (behind - 2 * rows[i][2] + before) / 1e3 / (kStep_s * kStep_s), 1) << rows[i][0];
  }
  const auto value = [&summary](const std::string& name) {
    const std::size_t at = summary.find("\n" + name + " = ");
    return at == std::string::npos ? 0 : std::stod(summary.substr(at + name.size() + 4));
  };
  EXPECT_NEAR(value("max_theoretical_velocity"), fastest, 1e-4);
  EXPECT_NEAR(value("max_theoretical_acceleration"), hardest, 0.5);
  EXPECT_NEAR(value("min_theoretical_acceleration"), slowest, 0.5);
}

TEST_F(LiftCommand, DrawsLiftAndItsDerivativesInBothUnits) {
  const auto drawn = [this](const std::vector<std::string>& words) {
    std::vector<std::string> all = {"--train", "intake", "--plot", folder_ / "lift.svg"};
    all.insert(all.end(), words.begin(), words.end());
    testing::internal::CaptureStdout();
    EXPECT_EQ(kLift.run(Arguments(kLift, all)), kSuccess);
    testing::internal::GetCapturedStdout();
    const std::string svg = contents(folder_ / "lift.svg");
    EXPECT_EQ(support::read(svg).fault, "");
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    return svg;
  };
  const auto has = [](const std::string& svg, const char* part) { return svg.find(part) != std::string::npos; };
  const std::string plain = drawn({kOhc125});
  EXPECT_TRUE(has(plain, "Velocity, mm/rad") && has(plain, "38.4 mm/rad\u00B2") && !has(plain, "m/s"));
  EXPECT_FALSE(has(plain, "Flow area"));
  const std::string at_speed = drawn({kOhc125, "--rpm", "7000"});
  EXPECT_TRUE(has(at_speed, "Velocity, m/s") && has(at_speed, "5154 m/s\u00B2, 38.4 mm/rad\u00B2"));
  EXPECT_TRUE(has(at_speed, "Jerk, mm/ms\u00B3"));
  EXPECT_TRUE(has(drawn({CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini"}), "Flow area of one valve"));
}

TEST_F(LiftCommand, TellsWhyItHasNoFlowArea) {
  rows(kOhc125);
  EXPECT_NE(summary_.find("# no flow area: [valve intake] has neither seat_diameter_mm nor head_diameter_mm\n"),
            std::string::npos)
      << summary_;
  EXPECT_EQ(summary_.find("flow_area"), std::string::npos) << summary_;
}

/// An exhaust has no inlet Mach index, and without [crank] there is no piston.
TEST_F(LiftCommand, LeavesOutWhatTheFileDoesNotTell) {
  const std::string seat = "per_cylinder = 1\nhead_diameter_mm = 26\nport = exhaust";
  const std::string text = with_line(contents(kOhc125), "per_cylinder", seat);
  rows_with_flow(write("exhaust.ini", text));
  EXPECT_NE(summary_.find("mean_gas_speed"), std::string::npos) << summary_;
  EXPECT_EQ(summary_.find("inlet_mach_index"), std::string::npos) << summary_;
  const std::size_t cam = text.find("[cam intake]");
  rows_with_flow(write("train.ini", text.substr(cam, text.find("[trigger") - cam)));
  EXPECT_NE(summary_.find("theoretical_flow_area_mean"), std::string::npos) << summary_;
  EXPECT_EQ(summary_.find("area_per_displacement"), std::string::npos) << summary_;
}

TEST_F(LiftCommand, EndsAt180DegWhateverTheStep) {
  const auto table = rows(kOhc125, {"--step-deg", "7"});
  EXPECT_EQ(table.front()[0], -180);
  EXPECT_EQ(table.back()[0], 180);
  EXPECT_EQ(table.size(), 360u / 7 + 2);
}

TEST_F(LiftCommand, SmoothsAMeasuredCamAndTellsWhatItLeft) {
  write("cam.csv", cam_rows(-180, 180));
  const auto exact = rows(kOhc125);
  const auto smooth = rows(write("measured.ini", measured_125("cam.csv", 1)));
  ASSERT_EQ(smooth.size(), exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_NEAR(smooth[i][2], exact[i][2], 1.65 * 1.5e-3 + 1e-3)
        << exact[i][0];                                        // the cam's 1.5 um by the ratio, and a little turn
    EXPECT_NEAR(smooth[i][4], exact[i][4], 3) << exact[i][0];  // of 45 mm/rad^2
  }
  EXPECT_NE(summary_.find("smoothing_residual = "), std::string::npos) << summary_;
  EXPECT_NE(summary_.find("table_peak = 0 deg\n"), std::string::npos) << "both flanks are equal: " << summary_;
}

TEST_F(LiftCommand, NamesTheTrainThatIsNotThere) {
  EXPECT_NE(refusal(kOhc125, "intak").find("did you mean intake?"), std::string::npos) << refusal(kOhc125, "intak");
  const std::string none = write("none.ini", "[engine]\nname = bare\nrated_rpm = 1000\n");
  EXPECT_EQ(refusal(none), none + ": no valve train is called 'intake'; the file has none");
  const std::string cam_alone = write("cam_alone.ini",
                                      "[cam intake]\nsource = polynomial\nmax_lift_mm = 6\nhalf_angle_deg = "
                                      "74\nexponents = 2,10\nfull_lift_at_crank_deg = 470\n");
  EXPECT_EQ(refusal(cam_alone), cam_alone + ": section [rocker intake] is missing; this command needs it");
}

TEST_F(LiftCommand, NamesTheLineAndTheAngleWhereTheGeometryCannotWork) {
  const struct {
    const char* start;
    const char* line;
    const char* says;
  } cases[] = {
      {"base_circle_mm", "base_circle_mm = 6.5", "base_circle_mm: the cam is undercut at 32.9"},
      {"pivot_to_pad_mm", "pivot_to_pad_mm = 18", "pivot_to_pad_mm: pivot, pad and cam form no triangle at 0 deg"},
      {"pivot_to_screw_mm", "pivot_to_screw_mm = 11.69",
       "pivot_to_screw_mm: the screw would stand more than 90 deg off the pivot's level at -74 deg"},
      {"stem_above_pivot_mm", "stem_above_pivot_mm = -42.6",
       "pivot_to_screw_mm: the screw would stand more than 90 deg off the pivot's level at 0 deg"},
      {"exponents", "exponents = 2,10,10.05,26", "exponents: 2,10,10.05,26 must rise by at least 0.1"},
      {"half_angle_deg", "half_angle_deg = 7", "half_angle_deg: 7 is out of range; allowed: 10 to 180 deg"},
  };
  for (const auto& one : cases) {
    const std::string file = write("bad.ini", with_line(contents(kOhc125), one.start, one.line));
    const std::string message = refusal(file);
    EXPECT_NE(message.find(one.says), std::string::npos) << message;
    EXPECT_EQ(message.compare(0, file.size() + 1, file + ":"), 0) << message;
  }
}

TEST_F(LiftCommand, NamesTheRowOfAMeasuredCamThatIsWrong) {
  const std::string csv = folder_ / "cam.csv";
  const std::string engine = write("measured.ini", measured_125("cam.csv", 1));
  write("cam.csv", cam_rows(-60, 180));
  EXPECT_EQ(refusal(engine).compare(0, csv.size() + 3, csv + ":2:"), 0) << refusal(engine);
  write("cam.csv", cam_rows(-180, 180) + "180,0\n");
  EXPECT_EQ(refusal(engine), csv + ":363: cam_deg: 180 follows 180; angles must rise from row to row");
  write("cam.csv", "cam_deg,lift_mm\n-74,0\n0,6.3\n74,0\n");
  EXPECT_EQ(refusal(engine), csv + ":4: 3 rows are too few for a cam");
  write("cam.csv", "cam_deg,lift_mm\n0,6.3\n");
  EXPECT_EQ(refusal(engine), csv + ":2: 1 row is too few for a cam");
  write("cam.csv", with_line(cam_rows(-180, 180), "-30,", "-30,5.2"));
  EXPECT_NE(refusal(engine).find("smoothing_um: 1"), std::string::npos) << refusal(engine);
  std::string long_table = "cam_deg,lift_mm\n";
  for (int i = 0; i <= 2000; ++i) long_table += std::to_string(i * 0.1) + ",0\n";
  write("cam.csv", long_table);
  EXPECT_EQ(refusal(engine), csv + ":2002: 2001 rows; at most 2000 are allowed");
}

TEST_F(LiftCommand, ChoosesTheSmoothingOfAMeasuredCamByItself) {
  write("cam.csv", cam_rows(-180, 180));
  const std::string engine =
      write("auto.ini", with_line(measured_125("cam.csv", 1), "smoothing_um", "smoothing_um = auto"));
  const auto by_itself = rows(engine);
  EXPECT_NE(summary_.find("smoothing = 1 um  # chosen by auto"), std::string::npos) << summary_;
  EXPECT_EQ(by_itself, rows(write("measured.ini", measured_125("cam.csv", 1)))) << "rounded to 1 um";
  EXPECT_NE(summary_.find("smoothing = 1 um\n"), std::string::npos) << summary_;

  // What is shown is a number, and gives the same definition.
  const EngineFile chosen = read_engine_file(engine, {});
  EXPECT_EQ(chosen.definition().trains[0].cam.smoothing_m, 1e-6);
  const std::string shown = show(chosen);
  EXPECT_NE(shown.find("smoothing_um = 1  "), std::string::npos) << shown;
  EXPECT_NE(shown.find("; chosen by auto"), std::string::npos) << shown;
  EXPECT_EQ(read_engine_text(shown, engine, {}).definition().trains[0].cam.smoothing_m, 1e-6);

  EXPECT_NE(refusal(write("auto.ini", with_line(measured_125("cam.csv", 1), "smoothing_um", "smoothing_um = Auto")))
                .find("'Auto' is not a number; the word auto is allowed too"),
            std::string::npos);
  write("polynomial.ini", with_line(contents(kOhc125), "max_lift_mm", "max_lift_mm = 6.301099\nsmoothing_um = auto"));
  EXPECT_NE(show(read_engine_file(folder_ / "polynomial.ini", {})).find("smoothing_um = auto"), std::string::npos)
      << "not used, and nothing to choose it by";
}

TEST_F(LiftCommand, NamesTheSmallestSmoothingAndTheRowThatIsToBlame) {
  const std::string csv = folder_ / "cam.csv";
  const std::string given = cam_rows(-180, 180);
  const std::size_t row = given.find("\n-30,") + 5;
  const double misread_mm = std::stod(given.substr(row)) + 0.05;
  write("cam.csv", with_line(given, "-30,", "-30," + std::to_string(misread_mm)));
  const std::string engine = write("measured.ini", measured_125("cam.csv", 1));
  const std::string message = refusal(engine);
  EXPECT_NE(message.find("-30 deg (" + csv + ":152)"), std::string::npos) << message;
  const std::string words = "smallest possible: ";
  const std::size_t at = message.find(words);
  ASSERT_NE(at, std::string::npos) << message;
  const double smallest_um = std::stod(message.substr(at + words.size()));
  const auto is_smoothed = [&](double smoothing_um) {
    const EngineFile file = read_engine_file(write("other.ini", measured_125("cam.csv", smoothing_um)), {});
    CamProfile cam;
    return cam.init(file.train("intake").definition.cam).ok();
  };
  EXPECT_TRUE(is_smoothed(smallest_um));
  EXPECT_FALSE(is_smoothed(0.96 * smallest_um));
  const std::string lies = " lies ";
  EXPECT_NEAR(std::stod(message.substr(message.find(lies) + lies.size())), smallest_um, 0.03 * smallest_um);

  // A lost decimal point, and a digit misread by one, wherever they are.
  for (const std::string deg : {"-60", "-42", "-22", "-8", "0", "13", "35", "58"}) {
    const double true_mm = std::stod(given.substr(given.find("\n" + deg + ",") + deg.size() + 2));
    for (const double misread : {10 * true_mm, true_mm + 0.1}) {
      write("cam.csv", with_line(given, deg + ",", deg + "," + std::to_string(misread)));
      EXPECT_NE(refusal(engine).find(" row at " + deg + " deg"), std::string::npos)
          << misread << ": " << refusal(engine);
    }
  }
  write("cam.csv", with_line(given, "-30,", "-30,40"));
  EXPECT_NE(refusal(engine).find("no smooth lobe comes within 1000 um of every row; check the row at -30 deg"),
            std::string::npos)
      << refusal(engine);
  write("cam.csv", cam_rows(-60, 180));
  const std::string cut =
      refusal(write("auto.ini", with_line(measured_125("cam.csv", 1), "smoothing_um", "smoothing_um = auto")));
  EXPECT_EQ(cut.compare(0, csv.size() + 3, csv + ":2:"), 0) << cut;
  EXPECT_NE(cut.find("no row on this side comes down to 50 um"), std::string::npos) << cut;
}

TEST_F(LiftCommand, AllowsNoRockerInertiaToATrainOfConstantRatio) {
  const std::string train =
      "[cam a]\nsource = polynomial\nmax_lift_mm = 6\nhalf_angle_deg = 74\nexponents = 2,10,18\nfull_lift_at_crank_deg "
      "= -250\n"
      "[rocker a]\nratio = 1.4\nbase_circle_mm = 18\nclearance_mm = 0.2\n"
      "[valve a]\nper_cylinder = 2\nvalve_g = 90\nspring_g = 60\nrocker_inertia_kg_mm2 = 0\nspring_N_per_mm = "
      "40\nspring_preload_N = 200\n"
      "train_N_per_mm = 5000\ntrain_damping_ratio = 0.1\nguide_damping_ratio = 0.003\nseat_N_per_mm = "
      "100000\nseat_damping_ratio = 0.1\n";
  const EngineFile engine = read_engine_file(write("direct.ini", train), {});
  ASSERT_EQ(engine.definition().train_count, 1);
  const ValveTrain& read = engine.definition().trains[0];
  EXPECT_EQ(read.rocker.kind, RockerKind::ratio);
  EXPECT_EQ(read.rocker.ratio, 1.4);
  EXPECT_EQ(read.cam.full_lift_deg, 470);  // -250 in the cycle from 0 to 720
  EXPECT_EQ(read.cam.exponent_count, 3);
  EXPECT_EQ(read.valve.per_cylinder, 2);
  EXPECT_EQ(read.valve.train_N_m, 5e6);
  const std::string heavy = write("heavy.ini", with_line(train, "rocker_inertia_kg_mm2", "rocker_inertia_kg_mm2 = 8"));
  EXPECT_EQ(refusal(heavy, "a").compare(0, heavy.size() + 27, heavy + ":15: rocker_inertia_kg_mm2:"), 0)
      << refusal(heavy, "a");
}

TEST_F(LiftCommand, AllowsFourTrains) {
  const std::string sample = contents(kOhc125);
  std::string text = sample;
  for (const char* name : {"exhaust", "third", "fourth", "fifth"}) {
    const std::size_t cam = sample.find("[cam intake]");
    std::string more = sample.substr(cam, sample.find("# Trigger wheels") - cam);
    for (std::size_t at = more.find(" intake]"); at != std::string::npos; at = more.find(" intake]"))
      more.replace(at, 8, " " + std::string(name) + "]");
    if (std::string(name) == "fifth") {
      const std::string four = write("four.ini", text);
      EXPECT_EQ(read_engine_file(four, {}).definition().train_count, kMaxTrains);
    }
    text += more;
  }
  EXPECT_NE(refusal(write("five.ini", text)).find("one valve train too many; allowed: 4"), std::string::npos);
}

}  // namespace
}  // namespace crankloop::program::lift_command_test

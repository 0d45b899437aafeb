// `crankloop cam`: the ground profile against the flat followers that touch it, the cam for a wanted lift and back
// again through an engine file, and what is said where there is none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "crankloop/commands/cam/cam_wanted.hpp"
#include "crankloop/engine_file/engine_file.hpp"
#include "support/files.hpp"
#include "support/markup.hpp"
#include "support/run_command.hpp"
#include "support/units.hpp"

namespace crankloop::program::cam_command_test {
namespace {

using support::kPi;
using support::kRadPerDeg;

using support::kOhc125;
constexpr const char* kWanted125 = CRANKLOOP_SOURCE_DIR "/tools/engines/wanted_125.csv";

class CamCommand : public testing::Test {
 protected:
  std::string run(const Command& command, const std::vector<std::string>& words) const {
    testing::internal::CaptureStdout();
    const int status = command.run(Arguments(command, words));
    const std::string printed = testing::internal::GetCapturedStdout();
    EXPECT_EQ(status, kSuccess);
    return printed;
  }
  std::string refusal(const std::vector<std::string>& words) const {
    try {
      static_cast<void>(kCam.run(Arguments(kCam, words)));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }

  /// The numbers below a header; lines with # are left out.
  static std::vector<std::vector<double>> rows(const std::string& path, const std::string& header) {
    std::vector<std::vector<double>> rows;
    bool header_seen = false;
    for (const std::string& text : split_at(contents(path), '\n')) {
      if (text[0] == '#') continue;
      if (!header_seen) {
        EXPECT_EQ(text, header);
        header_seen = true;
        continue;
      }
      rows.emplace_back();
      for (const std::string& cell : split_at(text, ',')) rows.back().push_back(std::stod(cell));
    }
    return rows;
  }

  /// A wanted lift over the cam angle, a row each degree.
  std::string wanted(const std::string& name, const std::function<double(double)>& lift_mm) const {
    std::string text = "cam_deg,lift_mm\n";
    for (int deg = -110; deg <= 110; ++deg) text += std::to_string(deg) + "," + std::to_string(lift_mm(deg)) + "\n";
    return write(name, text);
  }
  /// A squared raised cosine of 7.5 mm, from minus `clearance_mm`.
  std::string raised_cosine(double half_deg, double clearance_mm) const {
    return wanted("wanted.csv", [=](double deg) {
      if (std::abs(deg) >= half_deg) return -clearance_mm;
      const double c = (1 + std::cos(kPi * deg / half_deg)) / 2;
      return (7.5 + clearance_mm) * c * c - clearance_mm;
    });
  }
  /// The 125 with a table as its cam.
  std::string engine_with(const std::string& table) const {
    std::string text = contents(kOhc125);
    const std::size_t from = text.find("source = polynomial");
    const std::size_t to = text.find("full_lift_at_crank_deg");
    return write("own.ini",
                 text.replace(from, to - from, "source = table\nfile = " + table + "\nsmoothing_um = auto\n"));
  }

  support::TemporaryFolder folder_;
};

TEST_F(CamCommand, WritesTheProfileThatAllFlatFollowersTouch) {
  run(kCam, {kOhc125, "--csv", in("cam.csv"), "--step-deg", "0.25"});
  const auto profile =
      rows(in("cam.csv"), "flat_deg,x_mm,y_mm,polar_deg,polar_radius_mm,follower_lift_mm,curvature_radius_mm");
  ASSERT_EQ(profile.size(), 1441u);
  for (std::size_t i = 1; i + 1 < profile.size(); i += 7) {
    const std::vector<double>& row = profile[i];
    const double flat = row[0] * kRadPerDeg;
    double highest = 0;
    for (const auto& p : profile) highest = std::max(highest, p[1] * std::cos(flat) + p[2] * std::sin(flat));
    EXPECT_NEAR(highest, 12.5 + row[5], 1e-9) << row[0];
    EXPECT_NEAR(row[4] * std::cos(row[3] * kRadPerDeg), row[1], 1e-9);
    EXPECT_NEAR(row[4] * std::sin(row[3] * kRadPerDeg), row[2], 1e-9);
    // The circle through three points of the profile: product of its sides over four times their area.
    const auto side = [&](std::size_t a, std::size_t b) {
      return std::hypot(profile[a][1] - profile[b][1], profile[a][2] - profile[b][2]);
    };
    const auto& a = profile[i - 1];
    const auto& b = profile[i + 1];
    const double area2 = (row[1] - a[1]) * (b[2] - a[2]) - (row[2] - a[2]) * (b[1] - a[1]);
    EXPECT_NEAR(side(i - 1, i) * side(i, i + 1) * side(i - 1, i + 1) / (2 * area2), row[6], 2e-3 * row[6]) << row[0];
  }
}

TEST_F(CamCommand, TellsTheLeastRadiusOfCurvatureAndWhereIt) {
  const std::string printed = run(kCam, {kOhc125, "--csv", in("cam.csv"), "--step-deg", "0.05"});
  const auto profile =
      rows(in("cam.csv"), "flat_deg,x_mm,y_mm,polar_deg,polar_radius_mm,follower_lift_mm,curvature_radius_mm");
  const auto least =
      *std::min_element(profile.begin(), profile.end(), [](const auto& a, const auto& b) { return a[6] < b[6]; });
  EXPECT_NEAR(line(printed, "min_curvature_radius").first, least[6], 1e-5);
  EXPECT_NE(printed.find("# at " + std::string("32.90")), std::string::npos) << printed;
  EXPECT_NEAR(std::abs(least[0]), 32.9, 0.06);
  EXPECT_NE(printed.find("undercut = no"), std::string::npos);
  // On the base circle at which the cam would be undercut the least radius is 0.
  EXPECT_NEAR(12.5 - line(printed, "base_circle_of_undercut").first, least[6], 1e-4);
}

TEST_F(CamCommand, RefusesAnUndercutCamWithItsAngle) {
  std::string text = contents(kOhc125);
  text.replace(text.find("base_circle_mm = 12.5"), 21, "base_circle_mm = 6.5 ");
  const std::string said = refusal({write("under.ini", text), "--csv", in("cam.csv")});
  EXPECT_NE(said.find("the cam is undercut at"), std::string::npos) << said;
  EXPECT_FALSE(std::filesystem::exists(in("cam.csv")));
}

TEST_F(CamCommand, DesignsACamThatGivesTheWantedLiftWhenAnEngineFileReadsIt) {
  const std::string printed = run(kCam, {kOhc125, "--wanted", kWanted125, "--table", in("cam.csv")});
  const std::string engine = engine_with("cam.csv");
  run(kLift, {engine, "--csv", in("lift.csv")});
  const auto lifts =
      rows(in("lift.csv"), "cam_deg,rocker_angle_deg,lift_mm,lift_mm_per_rad,lift_mm_per_rad2,rocker_ratio");
  double largest_mm = 0;
  for (const auto& row : rows(kWanted125, "cam_deg,lift_mm")) {
    const auto& given = lifts[static_cast<std::size_t>(row[0] + 180)];
    ASSERT_EQ(given[0], row[0]);
    largest_mm = std::max(largest_mm, std::abs(given[2] - std::max(row[1], 0.0)));
  }
  EXPECT_LT(largest_mm, 0.1e-3);
  EXPECT_GT(largest_mm, 0);
  // What is told is of the train's lift with its lash, of which the valve's is a part.
  EXPECT_GE(line(printed, "deviation_from_wanted").first, largest_mm * 1e3 * (1 - 1e-5));
  EXPECT_LT(line(printed, "deviation_from_wanted").first, 0.1);
}

TEST_F(CamCommand, CountsAWantedLiftFromItsPeak) {
  const std::string early = wanted("early.csv", [](double deg) {
    const double u = (deg + 4.5) / 95;
    return std::abs(u) >= 1 ? -0.05 : 7.85 * std::pow(1 - u * u, 5) - 0.05;
  });
  const std::string printed = run(kCam, {kOhc125, "--wanted", early, "--table", in("cam.csv")});
  EXPECT_NEAR(line(printed, "wanted_peak").first, -4.5, 1e-3);
  EXPECT_LT(line(printed, "deviation_from_wanted").first, 5);  // its rows are rounded to 1 nm
}

TEST_F(CamCommand, TakesAWantedLiftWithoutLashToo) {
  std::string raised = "cam_deg,lift_mm\n";
  for (const auto& row : rows(kWanted125, "cam_deg,lift_mm"))
    raised += std::to_string(row[0]) + "," + std::to_string(row[1] + 0.05) + "\n";
  run(kCam, {kOhc125, "--wanted", kWanted125, "--table", in("signed.csv")});
  run(kCam, {kOhc125, "--wanted", write("raised.csv", raised), "--zero-lash", "--table", in("raised_cam.csv")});
  const auto expected = rows(in("signed.csv"), "cam_deg,lift_mm");
  const auto found = rows(in("raised_cam.csv"), "cam_deg,lift_mm");
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i][0], expected[i][0]);
    EXPECT_NEAR(found[i][1], expected[i][1], 1e-6);
  }
  EXPECT_NE(refusal({kOhc125, "--zero-lash"}).find("give --wanted"), std::string::npos);
}

TEST_F(CamCommand, DesignsForAConstantRatioToo) {
  const std::string engine =
      write("direct.ini", "[rocker intake]\nratio = 1.6\nbase_circle_mm = 18\nclearance_mm = 0.05\n");
  run(kCam, {engine, "--wanted", kWanted125, "--table", in("cam.csv")});
  for (const auto& row : rows(in("cam.csv"), "cam_deg,lift_mm")) {
    for (const auto& want : rows(kWanted125, "cam_deg,lift_mm")) {
      if (want[0] != row[0]) continue;
      EXPECT_NEAR(row[1], (want[1] + 0.05) / 1.6, 0.05e-3) << row[0];
    }
  }
}

TEST_F(CamCommand, WritesAPolynomialAsATableThatGivesTheSameLift) {
  run(kCam, {kOhc125, "--table", in("cam.csv"), "--step-deg", "0.5"});
  const std::string engine = engine_with("cam.csv");
  const std::string by_table = run(kLift, {engine, "--csv", in("a.csv")});
  const std::string by_polynomial = run(kLift, {kOhc125, "--csv", in("b.csv")});
  EXPECT_NEAR(line(by_table, "max_theoretical_lift").first, line(by_polynomial, "max_theoretical_lift").first, 1e-4);
}

TEST_F(CamCommand, SaysWhyThereIsNoCamForALift) {
  const auto said = [this](const std::string& path) {
    const std::string text = refusal({kOhc125, "--wanted", path, "--table", in("none.csv")});
    EXPECT_FALSE(std::filesystem::exists(in("none.csv")));
    return text;
  };
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_PRED2(has, said(raised_cosine(95, 0)), "on this side the lift comes down to 0 mm only, which is a step");
  EXPECT_PRED2(has, said(raised_cosine(95, 0.1)), "-0.1 mm is below the base circle");
  EXPECT_PRED2(has, said(raised_cosine(85, 0.05)), "the cam is undercut, its radius of curvature would be -");
  EXPECT_PRED2(has, said(raised_cosine(60, 0.05)), "the flat follower's angle does not rise");
  EXPECT_PRED2(has, said(write("w.csv", "cam_deg,lift_mm\n1,0\n0,1\n")), "w.csv:3: cam_deg: 0 follows 1");
  EXPECT_PRED2(has, said(write("w.csv", "cam_deg,lift_mm\n-1,-0.05\n0,1\n1,-0.05\n")), "3 rows are too few for a lift");
  EXPECT_PRED2(has, said(in("absent.csv")), "absent.csv: cannot be read");
  EXPECT_PRED2(
      has,
      said(wanted("far.csv", [](double deg) { return 60 * std::pow(std::max(0.0, 1 - deg * deg / 9025), 5) - 0.05; })),
      "screw or pad cannot stand");
}

TEST_F(CamCommand, NamesAMisreadRowOfTheWantedLift) {
  const Rocker rocker = read_engine_file(kOhc125, {}).trains()[0].definition.rocker;
  const std::string given = contents(kWanted125);
  EXPECT_EQ(cam_for_lift(kWanted125, rocker, {}).misread, "");
  const std::size_t at = given.find("\n10,") + 4;
  const std::size_t end = given.find('\n', at);
  const auto line =
      std::to_string(1 + std::count(given.begin(), given.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
  const auto misread_by = [&](double mm) {
    std::string text = given;
    return write("w.csv", text.replace(at, end - at, std::to_string(std::stod(given.substr(at)) + mm)));
  };
  const std::string told = cam_for_lift(misread_by(0.2), rocker, {}).misread;
  EXPECT_NE(told.find("the row at 10 deg (" + in("w.csv") + ":" + line + "), which lies 200 um off its neighbours"),
            std::string::npos)
      << told;
  const std::string said = refusal({kOhc125, "--wanted", misread_by(3)});
  EXPECT_NE(said.find("w.csv:" + line + ": no smooth lift"), std::string::npos) << said;
}

TEST_F(CamCommand, RefusesALiftThatLeavesTheBaseCircleWithAStepInSpeed) {
  const std::string engine =
      write("direct.ini", "[rocker intake]\nratio = 1.6\nbase_circle_mm = 18\nclearance_mm = 0\n");
  const std::string step = wanted("step.csv", [](double deg) { return std::max(0.0, 7.5 * (1 - deg * deg / 4900)); });
  const std::string said = refusal({engine, "--wanted", step});
  EXPECT_NE(said.find("with a step in speed"), std::string::npos) << said;
}

TEST_F(CamCommand, DrawsCamPadAndRockerAtAnyAngle) {
  std::string away = contents(kOhc125);
  away.replace(away.find("toward_pivot"), 12, "away_from_pivot");
  write("away.ini", away);
  for (const char* at : {"-30", "0", "170", "-360"}) {
    const std::string engine = std::string(at) == "0" ? in("away.ini") : std::string(kOhc125);
    run(kCam, {engine, "--svg", in("cam.svg"), "--at", at});
    const std::string svg = contents(in("cam.svg"));
    const support::Markup markup = support::read(svg);
    EXPECT_EQ(markup.fault, "") << at;
    EXPECT_EQ(markup.of_class("cam").size(), 1u);
    EXPECT_EQ(markup.of_class("contact").size(), 1u);
    EXPECT_EQ(svg.find("nan"), std::string::npos) << at;
    // The base circle's lash is open behind the lobe.
    EXPECT_EQ(svg.find("0, lash 0.05 mm") != std::string::npos, std::string(at) == "170") << at;
  }
}

/// To scale: the distance of the contact from the pad's centre is the pad's radius, in the scale of the bar.
TEST_F(CamCommand, DrawsToScale) {
  run(kCam, {kOhc125, "--svg", in("cam.svg"), "--at", "-40"});
  const support::Markup markup = support::read(contents(in("cam.svg")));
  const auto points = [&](const std::string& what, std::size_t which) {
    std::vector<double> numbers;
    std::string d = markup.of_class(what).at(which).attributes.at("d");
    for (char& c : d) {
      if (c == 'M' || c == 'L' || c == 'Z' || c == 'v' || c == 'h' || c == 'm') c = ' ';
    }
    std::istringstream stream(d);
    for (double number; stream >> number;) numbers.push_back(number);
    return numbers;
  };
  const std::vector<double> bar = points("bar-of-scale", 0);
  const double per_mm = bar[5] / 10;  // its length
  constexpr double kDrawn = 0.05;     // coordinates of two decimals, the bar's among them, and steps of the contour
  // The levers: pivot to pad centre, to the cam's centre, to the ball.
  const double lengths_mm[] = {39.61, 30.28, 33.28};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<double> lever = points("lever", i);
    EXPECT_NEAR(std::hypot(lever[2] - lever[0], lever[3] - lever[1]), lengths_mm[i] * per_mm, kDrawn);
  }
  const std::vector<double> pad = points("lever", 0);
  const std::vector<double> centre = points("lever", 1);
  const std::vector<double> contour = points("cam", 0);
  double nearest = 1e9;
  double farthest = 0;
  for (std::size_t i = 0; i + 1 < contour.size(); i += 2) {
    nearest = std::min(nearest, std::hypot(contour[i] - pad[2], contour[i + 1] - pad[3]));
    farthest = std::max(farthest, std::hypot(contour[i] - centre[2], contour[i + 1] - centre[3]));
  }
  EXPECT_NEAR(nearest, 30 * per_mm, kDrawn);  // the pad's circle touches the cam
  EXPECT_NEAR(farthest, (12.5 + 6.301099) * per_mm, kDrawn);
}

TEST_F(CamCommand, ShowsAMeasuredTableBeforeAndAfterSmoothing) {
  std::filesystem::copy(CRANKLOOP_SOURCE_DIR "/tools/engines/cam_495.csv", in("cam_495.csv"));
  run(kCam, {engine_with("cam_495.csv"), "--smoothing", in("smooth.svg"), "--svg", in("cam.svg")});
  const std::string svg = contents(in("smooth.svg"));
  EXPECT_EQ(support::read(svg).fault, "");
  for (const char* panel : {"Residual", "Velocity", "Acceleration", "Jerk", "rows, by differences", "smoothed"})
    EXPECT_NE(svg.find(panel), std::string::npos) << panel;
  EXPECT_NE(refusal({kOhc125, "--smoothing", in("none.svg")}).find("is no table, so nothing is smoothed"),
            std::string::npos);
}

}  // namespace
}  // namespace crankloop::program::cam_command_test

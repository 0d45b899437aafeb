// What `crankloop valve`, its picture and the report of `run` tell of a cam's contact and torque, and the keys of an
// engine file for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <crankloop/tabulate/cam_contact.hpp>

#include "crankloop/command_line/commands.hpp"
#include "crankloop/engine_file/engine_file.hpp"
#include "crankloop/files/error.hpp"
#include "crankloop/loops/cam_loads.hpp"
#include "crankloop/loops/harmonics.hpp"
#include "support/files.hpp"
#include "support/test_valves.hpp"
#include "support/valve_runs.hpp"

namespace crankloop::program::valve_contact_test {
namespace {

std::vector<std::string> split_at(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

std::string run_command(const Command& command, const std::vector<std::string>& words) {
  testing::internal::CaptureStdout();
  const int status = command.run(Arguments(command, words));
  const std::string printed = testing::internal::GetCapturedStdout();
  EXPECT_EQ(status, kSuccess);
  return printed;
}

/// The 125 with lines more in its [cam intake], and sections more at its end.
class Wide125 {
 public:
  explicit Wide125(const std::string& cam_lines, const std::string& sections = "")
      : changed_(kOhc125, "full_lift_at_crank_deg", "full_lift_at_crank_deg = 470\n" + cam_lines) {
    std::ofstream(changed_.path(), std::ios::app) << sections;
  }
  [[nodiscard]] std::string path() const { return changed_.path(); }

 private:
  ChangedFile changed_;
};

double number_of(const std::string& summary, const std::string& name) {
  const std::size_t at = summary.find("\n" + name + " = ");
  EXPECT_NE(at, std::string::npos) << name;
  return at == std::string::npos ? 0 : std::stod(summary.substr(at + name.size() + 4));
}

TEST(ContactKeys, AreThoseOfTheDefinition) {
  const Wide125 file("width_mm = 9\nfriction_ratio = 0.06\nlimit_MPa = 900\n",
                     "\n[material intake]\ncam_GPa = 170\nfollower_poisson = 0.25\n");
  const EngineFile engine = read_engine_file(file.path(), {});
  const CamContact& contact = engine.definition().contacts[0];
  EXPECT_EQ(contact.width_m, 9e-3);
  EXPECT_EQ(contact.friction_ratio, 0.06);
  EXPECT_EQ(contact.cam_Pa, 170e9);
  EXPECT_EQ(contact.cam_poisson_ratio, 0.3);
  EXPECT_EQ(contact.follower_Pa, 206e9);
  EXPECT_EQ(contact.follower_poisson_ratio, 0.25);
  EXPECT_EQ(engine.train("intake").stress_limit_Pa, 900e6);
  const std::string shown = run_command(kShow, {file.path()});
  for (const char* line : {"\nwidth_mm = 9 ", "\nfriction_ratio = 0.06 ", "\nlimit_MPa = 900 ", "\n[material intake]\n",
                           "\ncam_GPa = 170 ", "\ncam_poisson = 0.3 ", "\nfollower_GPa = 206 "}) {
    EXPECT_NE(shown.find(line), std::string::npos) << line;
  }
}

TEST(ContactKeys, AreRefusedWithTheirLine) {
  const auto refusal = [](const std::string& cam_lines, const std::string& sections) -> std::string {
    const Wide125 file(cam_lines, sections);
    try {
      static_cast<void>(read_engine_file(file.path(), {}));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("width_mm = 0", "").find("width_mm"), std::string::npos);
  EXPECT_NE(refusal("friction_ratio = -1", "").find("friction_ratio"), std::string::npos);
  EXPECT_NE(refusal("", "\n[material intake]\ncam_poisson = 0.7\n").find("cam_poisson"), std::string::npos);
  EXPECT_NE(refusal("", "\n[material outlet]\n").find("[material outlet] has no [cam outlet] beside it"),
            std::string::npos);
}

TEST(ContactOfValve, IsTheLargestOfItsCsv) {
  support::TemporaryFolder folder;
  const Wide125 file("width_mm = 9\nfriction_ratio = 0.06\nlimit_MPa = 700\n");
  const std::string told = run_command(kValve, {file.path(), "--train", "intake", "--rpm", "6000", "--csv",
                                                folder / "v.csv", "--plot", folder / "v.svg"});
  const std::vector<std::string> rows = split_at(contents(folder / "v.csv"), '\n');
  const std::vector<std::string> names = split_at(rows[0], ',');
  const auto column = [&names](const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const EngineFile engine = read_engine_file(file.path(), {});
  const TrainOfFile& train = engine.train("intake");
  ValveLift lift;
  ASSERT_TRUE(lift.init(train.definition.cam, train.definition.rocker).ok());
  double stress = 0, torque = 0, least = 0, sliding = 0, work = 0, turned = 0, before_Nm = 0, before_deg = 0;
  for (std::size_t row = 1; row < rows.size(); ++row) {
    const std::vector<std::string> cells = split_at(rows[row], ',');
    const auto cell = [&](const char* name) { return std::stod(cells.at(column(name))); };
    const double deg = cell("cam_deg"), cam_N = cell("cam_force_N");
    // By the force and the exact geometry.
    if (cam_N > 0) {
      const ContactPose at = lift.contact_at(deg * support::kRadPerDeg);
      EXPECT_NEAR(cell("contact_stress_MPa"), hertz_contact(train.contact, at.curvature_per_m, cam_N).largest_Pa / 1e6,
                  0.01);
      EXPECT_NEAR(cell("cam_torque_Nm"), cam_N * at.lever_m + 0.06 * cam_N * std::fabs(at.sliding_m),
                  1e-3 + 1e-5 * cam_N);
    } else {
      EXPECT_EQ(cell("contact_stress_MPa"), 0);
    }
    stress = std::max(stress, cell("contact_stress_MPa"));
    torque = std::max(torque, cell("cam_torque_Nm"));
    least = std::min(least, cell("cam_torque_Nm"));
    sliding = std::max(sliding, cell("sliding_m_s"));
    if (row > 1) work += (before_Nm + cell("cam_torque_Nm")) / 2 * (deg - before_deg), turned += deg - before_deg;
    before_Nm = cell("cam_torque_Nm"), before_deg = deg;
  }
  EXPECT_NEAR(number_of(told, "contact_stress"), stress, 0.01);
  EXPECT_NEAR(number_of(told, "cam_torque"), torque, 1e-3);
  EXPECT_NEAR(number_of(told, "sliding_speed"), sliding, 1e-3);
  EXPECT_NEAR(number_of(told, "drive_power"), work / turned * 6000 * support::kPi / 60, 0.01);
  EXPECT_GT(stress, 300);
  EXPECT_NE(told.find("limit_MPa = 700"), std::string::npos) << told;
  const std::string picture = contents(folder / "v.svg");
  EXPECT_NE(picture.find("Stress between cam and follower"), std::string::npos);
  EXPECT_NE(picture.find("Torque of the cam"), std::string::npos);
}

TEST(ContactOfValve, TellsWhereTheLimitIsPassed) {
  CamLoadsOfCycle cycle(500e6);
  for (int deg = -90; deg <= 90; ++deg) {
    CamLoads loads;
    loads.stress_Pa = deg == 10 ? 600e6 : 400e6;
    cycle.add(deg, loads);
  }
  EXPECT_EQ(cycle.limit_in_words(), ", passes limit_MPa = 500 from 10 to 10 deg");
  CamLoadsOfCycle below(700e6);
  below.add(0, {});
  EXPECT_EQ(below.limit_in_words(), ", below limit_MPa = 700");
  EXPECT_EQ(CamLoadsOfCycle(0).limit_in_words(), "");
}

TEST(ContactOfValve, AtStandstillIsThatOfTheSpringOnItsNose) {
  const Wide125 file("width_mm = 9\n");
  const EngineFile engine = read_engine_file(file.path(), {});
  const TrainOfFile& train = engine.train("intake");
  ValveLift lift;
  ASSERT_TRUE(lift.init(train.definition.cam, train.definition.rocker).ok());
  const StaticStress found = static_stress(lift, train.definition, train.contact);
  double largest_Pa = 0;
  for (double deg = -80; deg < 60; deg += 0.1) {
    const double rad = deg * support::kRadPerDeg;
    const LiftPose pose = lift.at(rad);
    const double spring_N = 205.8 + 40e3 * pose.lift_m;
    const double Pa =
        hertz_contact(train.contact, lift.contact_at(rad).curvature_per_m, spring_N * pose.rocker_ratio).largest_Pa;
    largest_Pa = std::max(largest_Pa, pose.lift_m > 0 ? Pa : 0);
  }
  EXPECT_NEAR(found.largest_Pa, largest_Pa, 1e-4 * largest_Pa);
  EXPECT_GE(found.largest_Pa, largest_Pa * (1 - 1e-9));
}

TEST(ContactOfValve, IsNoneWithoutAWidthButTorqueIsTold) {
  support::TemporaryFolder folder;
  const std::string told = run_command(
      kValve, {kOhc125, "--train", "intake", "--rpm", "6000", "--csv", folder / "v.csv", "--plot", folder / "v.svg"});
  EXPECT_NE(told.find("\ncontact_stress = none  # [cam intake] has no width_mm\n"), std::string::npos) << told;
  EXPECT_GT(number_of(told, "cam_torque"), 1);
  // What train, guide and seat lose at 6000 rpm: 0.2306 J a turn of the cam (tests/property/cam_loads_test.cpp).
  EXPECT_NEAR(number_of(told, "drive_power"), 0.230635 * 50, 0.02);
  EXPECT_EQ(contents(folder / "v.csv").find("cam_torque_Nm"), std::string::npos);
  EXPECT_EQ(contents(folder / "v.svg").find("Torque of the cam"), std::string::npos);
}

TEST(ContactOfRun, IsInTheCsvWhereTheFileHasAWidth) {
  support::TemporaryFolder folder;
  const Wide125 file("width_mm = 9\nfriction_ratio = 0.06\n");
  run_command(kRun, {file.path(), "--rpm", "6000", "--cycles", "1", "--real", "double", "--csv", folder / "r.csv"});
  const std::vector<std::string> rows = split_at(contents(folder / "r.csv"), '\n');
  const std::vector<std::string> names = split_at(rows[0], ',');
  EXPECT_EQ(names.back(), "camshaft_torque_Nm");
  const auto column = [&names](const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const EngineFile engine = read_engine_file(file.path(), {});
  const TrainOfFile& train = engine.train("intake");
  ValveLift lift;
  ASSERT_TRUE(lift.init(train.definition.cam, train.definition.rocker).ok());
  int in_contact = 0;
  for (std::size_t row = 1; row < rows.size(); ++row) {
    const std::vector<std::string> cells = split_at(rows[row], ',');
    const auto cell = [&](const std::string& name) { return std::stod(cells.at(column(name))); };
    const double rad = (cell("crank_deg") - train.definition.cam.full_lift_deg) / 2 * support::kRadPerDeg;
    const double cam_N = cell("c1_intake_cam_force_N");
    if (!(cam_N > 0)) continue;
    ++in_contact;
    const ContactPose at = lift.contact_at(rad);
    EXPECT_NEAR(cell("c1_intake_contact_stress_MPa"),
                hertz_contact(train.contact, at.curvature_per_m, cam_N).largest_Pa / 1e6, 0.05);
    EXPECT_NEAR(cell("c1_intake_sliding_m_s"), at.sliding_m * 6000 * support::kPi / 60, 1e-3);
    EXPECT_NEAR(cell("c1_intake_cam_torque_Nm"), cam_N * (at.lever_m + 0.06 * at.sliding_m), 1e-3 + 1e-5 * cam_N);
  }
  EXPECT_GT(in_contact, 50);
}

TEST(HarmonicAmplitudes, AreThoseOfASumOfWaves) {
  std::vector<double> samples;
  for (int i = 0; i < 90; ++i) {
    const double rad = 2 * support::kPi * i / 90;
    samples.push_back(7 + 3 * std::cos(2 * rad) - 4 * std::sin(2 * rad) + 0.5 * std::cos(5 * rad + 1));
  }
  const std::vector<double> amplitudes = harmonic_amplitudes(samples, 6);
  const std::vector<double> expected{0, 5, 0, 0, 0.5, 0};
  for (std::size_t n = 0; n < 6; ++n) EXPECT_NEAR(amplitudes[n], expected[n], 1e-13) << n + 1;
}

TEST(ContactOfRun, IsInTheReportWhereTheFileHasAWidth) {
  support::TemporaryFolder folder;
  const Wide125 file("width_mm = 9\nlimit_MPa = 300\n");
  run_command(kRun, {file.path(), "--rpm", "6000", "--report", folder / "r.html"});
  const std::string page = contents(folder / "r.html");
  EXPECT_NE(page.find("Stress between cam and follower"), std::string::npos);
  EXPECT_NE(page.find("passes limit_MPa = 300"), std::string::npos);
  EXPECT_NE(page.find("Torque of the camshaft"), std::string::npos);
  EXPECT_NE(page.find("Orders of the camshaft&#39;s torque"), std::string::npos);
  EXPECT_NE(page.find("Mean power of all cams"), std::string::npos);
  run_command(kRun, {kOhc125, "--rpm", "6000", "--report", folder / "r.html"});
  EXPECT_EQ(contents(folder / "r.html").find("Torque of the camshaft"), std::string::npos);
}

}  // namespace
}  // namespace crankloop::program::valve_contact_test

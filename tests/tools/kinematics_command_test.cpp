// `crankloop kinematics`: its extremes, series and approximations against geometry and dense samples.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <crankloop/tabulate/mechanism.hpp>

#include "crankloop/engine_file/engine_file.hpp"
#include "support/files.hpp"
#include "support/run_command.hpp"
#include "support/units.hpp"

namespace crankloop::program::kinematics_command_test {
namespace {

using support::kPi;

constexpr double kRpm = 2000;
constexpr double kSpeed_rad_s = kRpm * kPi / 30;
constexpr double kRadius_m = 0.0575;

/// The 495 with another rod and pin offset.
std::string engine_text(double lambda, double offset_mm) {
  std::ostringstream rod;
  rod.precision(17);
  rod << "[crank]\nbore_mm = 95\nstroke_mm = 115\nrod_length_mm = " << 57.5 / lambda
      << "\npin_offset_mm = " << offset_mm << "\ncompression_ratio = 16.5\n";
  return "[engine]\nname = one\nrated_rpm = 2000\n" + rod.str();
}

/// The piston's height above the crankshaft.
double height_m(double lambda, double offset_m, double a) {
  const double rod_m = kRadius_m / lambda;
  const double side_m = kRadius_m * std::sin(a) - offset_m;
  return kRadius_m * std::cos(a) + std::sqrt(rod_m * rod_m - side_m * side_m);
}

class KinematicsCommand : public testing::Test {
 protected:
  std::map<std::string, double> summary(const std::string& text, const std::vector<std::string>& options = {}) {
    std::ofstream(folder_ / "engine.ini") << text;
    std::vector<std::string> words = {folder_ / "engine.ini", "--rpm", "2000", "--csv", folder_ / "k.csv"};
    words.insert(words.end(), options.begin(), options.end());
    testing::internal::CaptureStdout();
    EXPECT_EQ(kKinematics.run(Arguments(kKinematics, words)), kSuccess);
    std::map<std::string, double> values;
    for (const std::string& line : split_at(testing::internal::GetCapturedStdout(), '\n')) {
      const std::size_t equals = line.find(" = ");
      if (equals != std::string::npos) values[line.substr(0, equals)] = std::stod(line.substr(equals + 3));
    }
    return values;
  }

  /// The table, by the names of its columns.
  std::map<std::string, std::vector<double>> table() const {
    const std::vector<std::string> lines = split_at(contents(folder_ / "k.csv"), '\n');
    const std::vector<std::string> names = split_at(lines.at(0), ',');
    std::map<std::string, std::vector<double>> columns;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const std::vector<std::string> cells = split_at(lines[i], ',');
      for (std::size_t k = 0; k < names.size(); ++k) columns[names[k]].push_back(std::stod(cells.at(k)));
    }
    return columns;
  }

  support::TemporaryFolder folder_;
};

/// Speed and acceleration from the height at three angles; extremes from 36 000 of them.
TEST_F(KinematicsCommand, TellsWhereTheMotionHasItsExtremes) {
  for (const double lambda : {0.2, 0.3}) {
    for (const double offset_mm : {0.0, 5.0}) {
      SCOPED_TRACE(testing::Message() << "lambda " << lambda << ", offset " << offset_mm);
      const std::map<std::string, double> found = summary(engine_text(lambda, offset_mm));
      struct Dense {
        double most = -1e9, most_deg = 0, least = 1e9, least_deg = 0;
        void take(double value, double deg) {
          if (value > most) most = value, most_deg = deg;
          if (value < least) least = value, least_deg = deg;
        }
      } velocity, acceleration, rod;
      for (int i = 0; i < 36000; ++i) {
        const double deg = i / 100.0, a = deg * kPi / 180, offset_m = offset_mm / 1e3;
        constexpr double kStep = 1e-4;
        const double before = height_m(lambda, offset_m, a - kStep), behind = height_m(lambda, offset_m, a + kStep);
        velocity.take(-(behind - before) / (2 * kStep) * kSpeed_rad_s, deg);
        acceleration.take(
            -(before - 2 * height_m(lambda, offset_m, a) + behind) / (kStep * kStep) * kSpeed_rad_s * kSpeed_rad_s,
            deg);
        rod.take(std::asin(lambda * (std::sin(a) - offset_m / kRadius_m)) * 180 / kPi, deg);
      }
      EXPECT_NEAR(found.at("max_velocity"), velocity.most, 1e-5 * velocity.most);
      EXPECT_NEAR(found.at("max_velocity_at"), velocity.most_deg, 0.2);
      EXPECT_NEAR(found.at("min_velocity"), velocity.least, 1e-5 * velocity.most);
      EXPECT_NEAR(found.at("min_velocity_at"), velocity.least_deg, 0.2);
      EXPECT_NEAR(found.at("max_acceleration"), acceleration.most, 1e-4 * acceleration.most);
      EXPECT_NEAR(std::remainder(found.at("max_acceleration_at") - acceleration.most_deg, 360), 0, 0.5);
      EXPECT_NEAR(found.at("min_acceleration"), acceleration.least, 1e-4 * acceleration.most);
      EXPECT_NEAR(found.at("max_rod_angle"), rod.most, 1e-4);
      EXPECT_NEAR(found.at("max_rod_angle_at"), rod.most_deg, 0.02);
      EXPECT_NEAR(found.at("r_w"), kRadius_m * kSpeed_rad_s, 1e-4);
      EXPECT_NEAR(found.at("r_w2"), kRadius_m * kSpeed_rad_s * kSpeed_rad_s, 1e-2);
    }
  }
}

TEST_F(KinematicsCommand, RefusesASpeedBeyondTheEnginesOrTheTablesWithTheLimit) {
  const auto refusal = [this](const std::string& max_rpm, const char* rpm) -> std::string {
    std::string text = engine_text(0.3, 0);
    text.insert(text.find("[crank]"), max_rpm);
    std::ofstream(folder_ / "engine.ini") << text;
    try {
      (void)kKinematics.run(Arguments(kKinematics, {folder_ / "engine.ini", "--rpm", rpm, "--csv", folder_ / "k.csv"}));
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("max_rpm = 3000\n", "5000"), "5000 rpm is beyond the engine's max_rpm of 3000");
  EXPECT_EQ(refusal("max_rpm = 3000\n", "-5000"), "-5000 rpm is beyond the engine's max_rpm of 3000");
  EXPECT_EQ(refusal("max_rpm = 3000\n", "3000"), "");
  EXPECT_EQ(refusal("", "100000"), "");
}

/// Of a short rod the acceleration at the bottom lies between two smallest values; of the second order its place is
/// cos a = -1/(4 lambda), and the values r w^2 (1 + lambda), -r w^2 (1 - lambda) and -r w^2 (lambda + 1/(8 lambda)).
TEST_F(KinematicsCommand, TellsAllExtremesOfTheAccelerationOfAShortRod) {
  const double lambda = 0.3, rw2 = kRadius_m * kSpeed_rad_s * kSpeed_rad_s;
  std::map<std::string, double> found = summary(engine_text(lambda, 0), {"--method", "approx"});
  const double at_deg = std::acos(-1 / (4 * lambda)) * 180 / kPi;
  EXPECT_NEAR(found.at("max_acceleration"), rw2 * (1 + lambda), 1e-5 * rw2);
  EXPECT_NEAR(found.at("acceleration_extreme_1"), -rw2 * (1 - lambda), 1e-5 * rw2);
  EXPECT_NEAR(found.at("acceleration_extreme_1_at"), 180, 1e-3);
  EXPECT_NEAR(found.at("min_acceleration"), -rw2 * (lambda + 1 / (8 * lambda)), 1e-5 * rw2);
  EXPECT_NEAR(found.at("min_acceleration_at"), at_deg, 1e-2);
  EXPECT_NEAR(found.at("acceleration_extreme_2_at"), 360 - at_deg, 1e-2);
  found = summary(engine_text(lambda, 0));
  EXPECT_NEAR(found.at("acceleration_extreme_1"), -rw2 * (1 - lambda), 1e-5 * rw2) << "exact, too";
  EXPECT_LT(found.at("min_acceleration"), found.at("acceleration_extreme_1"));
  EXPECT_EQ(summary(engine_text(0.24, 0)).count("acceleration_extreme_1"), 0u) << "a longer rod has no more than two";
}

/// The textbook's a_n by powers of lambda; what is left is of the seventh.
TEST_F(KinematicsCommand, TellsTheSeriesOfTheDisplacement) {
  const double lambda = 0.25, left = std::pow(lambda, 7);
  std::map<std::string, double> found = summary(engine_text(lambda, 0));
  const double l3 = lambda * lambda * lambda, l5 = l3 * lambda * lambda;
  EXPECT_NEAR(found.at("a_0"), 1 + lambda / 4 + 3 * l3 / 64 + 5 * l5 / 256, 5e-6 + left);
  EXPECT_EQ(found.at("a_1"), -1);
  EXPECT_NEAR(found.at("a_2"), -(lambda / 4 + l3 / 16 + 15 * l5 / 512), 1e-7 + left);
  EXPECT_EQ(found.at("a_3"), 0);
  EXPECT_NEAR(found.at("a_4"), l3 / 64 + 3 * l5 / 256, 1e-8 + left / 30);
  EXPECT_EQ(found.at("a_5"), 0);
  EXPECT_NEAR(found.at("a_6"), -l5 / 512, left / 30);
  EXPECT_EQ(found.count("b_1"), 0u);
  // With an offset the sum is the geometry, but for what is above the sixth order and the digits printed.
  found = summary(engine_text(lambda, 8));
  const double rod_m = kRadius_m / lambda;
  const double top_m = std::sqrt((kRadius_m + rod_m) * (kRadius_m + rod_m) - 0.008 * 0.008);
  for (double a = 0; a < 6.2; a += 0.37) {
    double x = found.at("a_0");
    for (int n = 1; n <= 6; ++n) {
      const std::string order = std::to_string(n);
      x += found.at("a_" + order) * std::cos(n * a) + found.at("b_" + order) * std::sin(n * a);
    }
    EXPECT_NEAR(x, (top_m - height_m(lambda, 0.008, a)) / kRadius_m, 1e-5) << a;
  }
}

TEST_F(KinematicsCommand, ShowsTheApproximationBesideTheExactWithItsError) {
  const double lambda = 0.2738;
  const std::map<std::string, double> found =
      summary(engine_text(lambda, 0), {"--method", "both", "--step-deg", "0.25", "--plot", folder_ / "k.svg"});
  const std::map<std::string, std::vector<double>> columns = table();
  double most_mm = 0;
  for (std::size_t i = 0; i < columns.at("crank_deg").size(); ++i) {
    const double a = columns.at("crank_deg")[i] * kPi / 180;
    const double exact_mm = (height_m(lambda, 0, 0) - height_m(lambda, 0, a)) * 1e3;
    const double approx_mm = kRadius_m * (1 - std::cos(a) + lambda / 4 * (1 - std::cos(2 * a))) * 1e3;
    EXPECT_NEAR(columns.at("displacement_mm")[i], exact_mm, 1e-7);
    EXPECT_NEAR(columns.at("displacement_approx_mm")[i], approx_mm, 1e-7);
    EXPECT_NEAR(columns.at("displacement_error_mm")[i], approx_mm - exact_mm, 1e-7);
    const double approx_m_s2 = kRadius_m * kSpeed_rad_s * kSpeed_rad_s * (std::cos(a) + lambda * std::cos(2 * a));
    EXPECT_NEAR(columns.at("acceleration_approx_m_s2")[i], approx_m_s2, 1e-6);
    EXPECT_NEAR(columns.at("acceleration_error_m_s2")[i],
                columns.at("acceleration_approx_m_s2")[i] - columns.at("acceleration_m_s2")[i], 1e-6);
    if (std::abs(approx_mm - exact_mm) > std::abs(most_mm)) most_mm = approx_mm - exact_mm;
  }
  EXPECT_NEAR(found.at("displacement_error"), most_mm, 1e-5);
  const std::string picture = contents(folder_ / "k.svg");
  for (const char* words : {"approximation less exact", "Acceleration", "exact", "one: motion of piston and rod"})
    EXPECT_NE(picture.find(words), std::string::npos) << words;
  std::ofstream(folder_ / "offset.ini") << engine_text(lambda, 5);
  const Arguments both(kKinematics, {folder_ / "offset.ini", "--method", "both", "--csv", folder_ / "none.csv"});
  EXPECT_THROW(kKinematics.run(both), InputError) << "they hold without an offset";
}

}  // namespace
}  // namespace crankloop::program::kinematics_command_test

// The published kinematics of the 495 diesel: every row of its design sheet's table.
//
// diesel_495_kinematics.csv is that table, [495] table 2-1. The sheet computed x and b exactly, v and j by the
// second-order approximations, with lambda = 0.2738 (not 57.5/210) and w = 210 rad/s.
#include <crankloop/tabulate/mechanism.hpp>

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/units.hpp"

namespace crankloop::diesel_495_table_test {

using namespace detail;
namespace {

using support::kRadPerDeg;
constexpr double kSpeed_rad_s = 210;

// Half a unit of the last printed digit. v at 90 and 270 deg is an exact tie, 12.075 printed as 12.08: hence the 1e-9.
constexpr double kHalfOfLastDigit = 0.005 + 1e-9;

struct Row {
  double crank_deg, rod_angle_deg, displacement_mm, velocity_m_s, acceleration_m_s2;
};

std::vector<Row> published_rows() {
  std::ifstream file{std::string{CRANKLOOP_GOLDEN_DIR} + "/diesel_495_kinematics.csv"};
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#' || line[0] == 'c') continue;  // comments, and the header "crank_deg,..."
    for (char& c : line) {
      if (c == ',') c = ' ';
    }
    std::istringstream numbers{line};
    Row row{};
    numbers >> row.crank_deg >> row.rod_angle_deg >> row.displacement_mm >> row.velocity_m_s >> row.acceleration_m_s2;
    EXPECT_FALSE(numbers.fail()) << line;
    rows.push_back(row);
  }
  return rows;
}

Crank crank_of_the_sheet() {
  Crank crank;
  crank.bore_m = 0.095;
  crank.crank_radius_m = 0.0575;
  crank.rod_length_m = 0.0575 / 0.2738;
  return crank;
}

TEST(Diesel495Table, HasARowEveryTenDegreesOfATurn) {
  const std::vector<Row> rows = published_rows();
  ASSERT_EQ(rows.size(), 37u);
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].crank_deg, 10.0 * static_cast<double>(i));
}

TEST(Diesel495Table, DisplacementAndRodAngleAreTheExactOnes) {
  for (const Row& row : published_rows()) {
    const Pose<double> exact = exact_pose(crank_of_the_sheet(), row.crank_deg * kRadPerDeg);
    EXPECT_NEAR(exact.displacement_m * 1000, row.displacement_mm, kHalfOfLastDigit) << row.crank_deg << " deg";
    EXPECT_NEAR(exact.rod_angle_rad / kRadPerDeg, row.rod_angle_deg, kHalfOfLastDigit) << row.crank_deg << " deg";
  }
}

TEST(Diesel495Table, VelocityAndAccelerationAreTheSecondOrderApproximations) {
  for (const Row& row : published_rows()) {
    const Pose<double> approximate = second_order_pose(crank_of_the_sheet(), row.crank_deg * kRadPerDeg);
    EXPECT_NEAR(approximate.slope_m * kSpeed_rad_s, row.velocity_m_s, kHalfOfLastDigit) << row.crank_deg << " deg";
    EXPECT_NEAR(approximate.acceleration_m * kSpeed_rad_s * kSpeed_rad_s, row.acceleration_m_s2, kHalfOfLastDigit)
        << row.crank_deg << " deg";
  }
}

TEST(Diesel495Table, TellsTheApproximationFromTheExactMotionAndTheRoundedRodRatioFromTheTrueOne) {
  // The test above would be worth little if the other choice passed too.
  Crank true_rod = crank_of_the_sheet();
  true_rod.rod_length_m = 0.210;
  int exact_acceleration_fits = 0;
  int true_rod_fits = 0;
  for (const Row& row : published_rows()) {
    const double a = row.crank_deg * kRadPerDeg;
    const auto fits = [&](double acceleration_m) {
      const double off = acceleration_m * kSpeed_rad_s * kSpeed_rad_s - row.acceleration_m_s2;
      return off <= kHalfOfLastDigit && off >= -kHalfOfLastDigit ? 1 : 0;
    };
    exact_acceleration_fits += fits(exact_pose(crank_of_the_sheet(), a).acceleration_m);
    true_rod_fits += fits(second_order_pose(true_rod, a).acceleration_m);
  }
  EXPECT_LE(exact_acceleration_fits, 3);  // 0, 180 and 360 deg, where both agree
  EXPECT_LE(true_rod_fits, 4);            // where cos 2a is small, and lambda hardly enters: 50, 130, 230 and 310 deg
}

}  // namespace
}  // namespace crankloop::diesel_495_table_test

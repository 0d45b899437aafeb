// Counterweights, balance shafts and mounts against parts that are put where they are and differenced twice.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "crankloop/engine_file/engine_file.hpp"
#include "crankloop/files/number.hpp"
#include "crankloop/loops/free_forces.hpp"
#include "support/files.hpp"
#include "support/run_command.hpp"
#include "support/units.hpp"

namespace crankloop::program::free_forces_test {
namespace {

using support::kPi;

constexpr const char* kOhc = CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini";
constexpr double kRadius_m = 0.040, kRod_m = 0.130, kOffset_m = 0.006;
constexpr double kPiston_kg = 0.4, kSmallEnd_kg = 0.1, kBigEnd_kg = 0.3, kPin_kg = 0.2;
constexpr double kSpeed_rad_s = 400;

/// A V-twin on two pins with an offset of the piston pin, two counterweights, and shafts of either sense and speed.
constexpr const char* kTwin =
    "[engine]\nname = twin\nrated_rpm = 4000\n"
    "[crank]\nbore_mm = 70\nstroke_mm = 80\nrod_length_mm = 130\npin_offset_mm = 6\ncompression_ratio = 9\n"
    "[masses]\npiston_g = 400\nrod_small_end_g = 100\nrod_big_end_g = 300\ncrank_pin_equivalent_g = 200\n"
    "crank_inertia_kg_m2 = 0.1\n"
    "[layout]\ncylinders = 2\nfiring_angles_deg = 0,300\nbank_angles_deg = -30,30\ncylinder_positions_mm = 0,100\n";
constexpr const char* kBalancers =
    "[counterweight front]\nmass_g = 700\nradius_mm = 35\nposition_mm = -20\n"
    "[counterweight rear]\nmass_g = 500\nradius_mm = 30\nangle_deg = -75\nposition_mm = 130\n"
    "[balance_shaft left]\nmass_g = 300\nradius_mm = 20\nturns = 1\ndirection = against\nangle_deg = 50\nposition_mm "
    "= 60\n"
    "[balance_shaft right]\nmass_g = 100\nradius_mm = 15\nturns = 2\ndirection = with\nangle_deg = -20\nposition_mm = "
    "10\n"
    "[balance_shaft third]\nmass_g = 200\nradius_mm = 10\nturns = 2\ndirection = against\nangle_deg = 110\n"
    "position_mm = 90\n";

struct Point {
  double kg;
  double up_m;
  double lateral_m;
  double along_m;
};

/// At `radius` and an angle from up in the sense of rotation.
Point on_circle(double kg, double radius_m, double deg, double along_m) {
  return {kg, radius_m * std::cos(deg * kPi / 180), radius_m * std::sin(deg * kPi / 180), along_m};
}

std::vector<Point> moving_parts(double engine_deg, bool balanced) {
  std::vector<Point> parts;
  const double bank_deg[] = {-30, 30}, firing_deg[] = {0, 300}, along_m[] = {0, 0.1};
  for (int k = 0; k < 2; ++k) {
    const double pin_deg = engine_deg + bank_deg[k] - firing_deg[k];
    parts.push_back(on_circle(kBigEnd_kg + kPin_kg, kRadius_m, pin_deg, along_m[k]));
    const double own_rad = (engine_deg - firing_deg[k]) * kPi / 180;
    const double side_m = kRadius_m * std::sin(own_rad) - kOffset_m;
    const double height_m = kRadius_m * std::cos(own_rad) + std::sqrt(kRod_m * kRod_m - side_m * side_m);
    const double bank = bank_deg[k] * kPi / 180;
    parts.push_back({kPiston_kg + kSmallEnd_kg, height_m * std::cos(bank) - kOffset_m * std::sin(bank),
                     height_m * std::sin(bank) + kOffset_m * std::cos(bank), along_m[k]});
  }
  if (!balanced) return parts;
  const double first_pin_deg = engine_deg - 30;
  parts.push_back(on_circle(0.7, 0.035, first_pin_deg + 180, -0.02));
  parts.push_back(on_circle(0.5, 0.030, first_pin_deg - 75, 0.13));
  parts.push_back(on_circle(0.3, 0.020, 50 - engine_deg, 0.06));
  parts.push_back(on_circle(0.1, 0.015, -20 + 2 * engine_deg, 0.01));
  parts.push_back(on_circle(0.2, 0.010, 110 - 2 * engine_deg, 0.09));
  return parts;
}

/// Minus mass times acceleration of every part, the acceleration from three places; about the middle, at 50 mm.
FreeLoad by_differences(double engine_deg, bool balanced) {
  constexpr double kStep_deg = 0.02;
  const double step_s = kStep_deg * kPi / 180 / kSpeed_rad_s;
  const std::vector<Point> before = moving_parts(engine_deg - kStep_deg, balanced);
  const std::vector<Point> now = moving_parts(engine_deg, balanced);
  const std::vector<Point> after = moving_parts(engine_deg + kStep_deg, balanced);
  FreeLoad load;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double per_s2 = -now[i].kg / (step_s * step_s);
    const double up_N = per_s2 * (before[i].up_m - 2 * now[i].up_m + after[i].up_m);
    const double lateral_N = per_s2 * (before[i].lateral_m - 2 * now[i].lateral_m + after[i].lateral_m);
    load.up_N += up_N;
    load.lateral_N += lateral_N;
    load.pitch_Nm += (now[i].along_m - 0.05) * up_N;
    load.yaw_Nm += (now[i].along_m - 0.05) * lateral_N;
  }
  return load;
}

TEST(FreeForces, AreThoseOfEveryPartDifferencedTwice) {
  for (const bool balanced : {false, true}) {
    const EngineFile engine = read_engine_text(std::string(kTwin) + (balanced ? kBalancers : ""), "twin.ini", {});
    ASSERT_EQ(engine.balancers().size(), balanced ? 5u : 0u);
    const FreeForces found(engine.definition(), engine.balancers());
    constexpr double kTolerance = 0.5;  // N of 3200 of a piston's first order: what is above the sixth order
    for (double deg = 0; deg < 360; deg += 7.3) {
      SCOPED_TRACE(deg);
      const FreeLoad want = by_differences(deg, balanced);
      const FreeLoad is = found.at(deg, kSpeed_rad_s);
      EXPECT_NEAR(is.up_N, want.up_N, kTolerance);
      EXPECT_NEAR(is.lateral_N, want.lateral_N, kTolerance);
      EXPECT_NEAR(is.pitch_Nm, want.pitch_Nm, 0.05 * kTolerance);
      EXPECT_NEAR(is.yaw_Nm, want.yaw_Nm, 0.05 * kTolerance);
    }
  }
}

/// Half of the first order of one cylinder turns backward: a shaft with as much unbalance, opposite and against the
/// crankshaft, and a counterweight of that half and of what rotates leave none of it.
TEST(FreeForces, OfASingleAreBalancedByACounterweightAndAShaft) {
  const EngineFile bare = read_engine_file(kOhc, {});
  const Masses& masses = bare.definition().masses;
  const double radius_m = bare.definition().crank.crank_radius_m;
  const double half_kg_mm = masses.reciprocating_kg() * radius_m / 2 * 1e3;
  const double rotating_kg_mm = (masses.rod_big_end_kg + masses.crank_pin_equivalent_kg) * radius_m * 1e3;
  const std::string balancers =
      "\n[counterweight 1]\nmass_g = " + std::to_string((half_kg_mm + rotating_kg_mm) / 40 * 1e3) +
      "\nradius_mm = 40\nposition_mm = 0\n[balance_shaft 1]\nmass_g = " + std::to_string(half_kg_mm / 10 * 1e3) +
      "\nradius_mm = 10\nturns = 1\ndirection = against\nangle_deg = 180\nposition_mm = 0\n";
  const EngineFile engine = read_engine_text(contents(kOhc) + balancers, kOhc, {});
  const double alone = peak_force_kg_m(free_force(engine.definition(), {}, 1));
  EXPECT_NEAR(alone * 1e3, 2 * half_kg_mm + rotating_kg_mm, 1e-9);
  EXPECT_LT(peak_force_kg_m(free_force(engine.definition(), engine.balancers(), 1)), 1e-5 * alone)
      << "six decimals of the masses";
  EXPECT_EQ(peak_force_kg_m(free_force(engine.definition(), engine.balancers(), 2)),
            peak_force_kg_m(free_force(engine.definition(), {}, 2)));
}

TEST(FootForces, HoldTheEngineInEquilibrium) {
  const Mounts mounts{0.32, 0.45};
  const FreeLoad load{1000, -300, 70, 25};
  const double tilting_Nm = -120;
  double up_N = 0, lateral_N = 0, pitch_Nm = 0, yaw_Nm = 0, roll_Nm = 0;
  for (const Foot& foot : kFeetOf) {
    const FootForce force = foot_force(mounts, foot, load, tilting_Nm);
    const double lateral_m = foot.lateral * mounts.width_m / 2, along_m = foot.along * mounts.length_m / 2;
    up_N += force.up_N, lateral_N += force.lateral_N;
    pitch_Nm += along_m * force.up_N, yaw_Nm += along_m * force.lateral_N;
    roll_Nm -= lateral_m * force.up_N;  // a force up on the lateral side turns lateral to up, against the rotation
  }
  EXPECT_NEAR(up_N, load.up_N, 1e-9);
  EXPECT_NEAR(lateral_N, load.lateral_N, 1e-9);
  EXPECT_NEAR(pitch_Nm, load.pitch_Nm, 1e-9);
  EXPECT_NEAR(yaw_Nm, load.yaw_Nm, 1e-9);
  EXPECT_NEAR(roll_Nm, tilting_Nm, 1e-9);
}

std::map<std::string, double> balance(const std::vector<std::string>& words) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(kBalance.run(Arguments(kBalance, words)), kSuccess);
  std::map<std::string, double> values;
  for (const std::string& row : split_at(testing::internal::GetCapturedStdout(), '\n')) {
    const std::vector<std::string> cells = split_at(row, ',');
    if (cells.at(1) != "value") values[cells.at(0)] = std::stod(cells.at(1));
  }
  return values;
}

/// Without offset and with a rod of two masses the block bears what the crankshaft gives, turned round: energy, not a
/// sum of side forces.
TEST(FootForces, OfACommandAreThoseOfTorqueAndFreeForce) {
  const EngineFile engine = read_engine_file(kOhc, {});
  ASSERT_EQ(engine.definition().crank.pin_offset_m, 0);
  ASSERT_EQ(engine.definition().masses.rod_inertia_correction_kg_m2, 0);
  ExactEngine exact;
  ASSERT_TRUE(exact.init(engine.definition()).ok());
  const double speed_rad_s = 7000 * kPi / 30;
  const Crank& crank = engine.definition().crank;
  const Masses& masses = engine.definition().masses;
  const double rotating_N =
      (masses.rod_big_end_kg + masses.crank_pin_equivalent_kg) * crank.crank_radius_m * speed_rad_s * speed_rad_s;
  double most_N = 0, least_N = 0;
  for (int half = 0; half <= 1440; ++half) {
    const double rad = half * 0.5 * kPi / 180;
    const auto height_m = [&](double a) {
      const double side_m = crank.crank_radius_m * std::sin(a);
      return crank.crank_radius_m * std::cos(a) + std::sqrt(crank.rod_length_m * crank.rod_length_m - side_m * side_m);
    };
    constexpr double kStep = 1e-3;
    const double per_rad2_m = (height_m(rad - kStep) - 2 * height_m(rad) + height_m(rad + kStep)) / (kStep * kStep);
    const double up_N = rotating_N * std::cos(rad) - masses.reciprocating_kg() * per_rad2_m * speed_rad_s * speed_rad_s;
    const double foot_N = up_N / 4 + exact.torque_Nm(half * 0.5, speed_rad_s) / (2 * 0.3);
    most_N = std::max(most_N, foot_N), least_N = std::min(least_N, foot_N);
  }
  std::map<std::string, double> found =
      balance({kOhc, "--rpm", "7000", "--mount-width-mm", "300", "--mount-length-mm", "400", "--no-warnings"});
  EXPECT_NEAR(found.at("mount_front_plus_max_up_N"), most_N, 1e-4 * most_N);
  EXPECT_NEAR(found.at("mount_rear_plus_max_down_N"), -least_N, 1e-4 * most_N);
  EXPECT_EQ(found.count("residual_force_first_N"), 0u) << "the file has no balancers";
  EXPECT_EQ(balance({kOhc, "--rpm", "7000", "--no-warnings"}).count("mount_front_plus_max_up_N"), 0u);
  EXPECT_THROW(kBalance.run(Arguments(kBalance, {kOhc, "--rpm", "7000", "--mount-width-mm", "300"})), UsageError);
}

TEST(Balance, PrintsNoRoundingForTheFeet) {
  const EngineFile bare = read_engine_file(kOhc, {});
  const Masses& masses = bare.definition().masses;
  const double kg_m = (masses.reciprocating_kg() / 2 + masses.rod_big_end_kg + masses.crank_pin_equivalent_kg) *
                      bare.definition().crank.crank_radius_m;
  const support::TemporaryFolder folder;
  const std::string file = folder / "balanced.ini";
  std::ofstream(file) << contents(kOhc) << "\n[counterweight 1]\nmass_g = " << shortest(kg_m * 1e6 / 40)
                      << "\nradius_mm = 40\nposition_mm = 0\n[balance_shaft 1]\nmass_g = "
                      << shortest(masses.reciprocating_kg() / 2 * bare.definition().crank.crank_radius_m * 1e6 / 10)
                      << "\nradius_mm = 10\nturns = 1\ndirection = against\nangle_deg = 180\nposition_mm = 0\n";
  const std::map<std::string, double> found =
      balance({file, "--rpm", "7000", "--mount-width-mm", "300", "--mount-length-mm", "400", "--no-warnings"});
  EXPECT_GT(found.at("mount_front_plus_max_up_N"), 100);
  EXPECT_EQ(found.at("mount_front_plus_max_lateral_N"), 0);
  EXPECT_EQ(found.at("mount_rear_minus_min_lateral_N"), 0);
}

/// In the report and in `show`, which reads back as the same file. The single's first order with its rotating mass, by
/// hand: 155 g and 110 g at 28.9 mm.
TEST(Balancers, StandInTheReportAndInShow) {
  const support::TemporaryFolder folder;
  const std::string file = folder / "balanced.ini";
  std::ofstream(file) << contents(kOhc) << "\n[counterweight web]\nmass_g = 100\nradius_mm = 28.9\nposition_mm = 0\n";
  testing::internal::CaptureStdout();
  EXPECT_EQ(kRun.run(Arguments(kRun, {file, "--rpm", "7000", "--report", folder / "r.html"})), kSuccess);
  testing::internal::GetCapturedStdout();
  const std::string page = contents(folder / "r.html");
  const std::size_t at = page.find("With counterweights and balance shafts");
  ASSERT_NE(at, std::string::npos);
  const double w2 = std::pow(7000 * kPi / 30, 2);
  char alone[16], left[16];
  std::snprintf(alone, sizeof alone, "%.1f", (0.155 + 0.110) * 0.0289 * w2);
  std::snprintf(left, sizeof left, "%.1f", (0.155 + 0.110 - 0.100) * 0.0289 * w2);
  EXPECT_LT(page.find(alone, at), page.find("Second order", at)) << alone;
  EXPECT_LT(page.find(left, at), page.find("Second order", at)) << left;
  const EngineFile read = read_engine_file(file, {});
  const EngineFile again = read_engine_text(show(read), file, {});
  ASSERT_EQ(again.balancers().size(), 1u);
  EXPECT_EQ(again.balancers()[0].angle_deg, 180) << "the default, shown";
  EXPECT_EQ(again.balancers()[0].unbalance_kg_m, read.balancers()[0].unbalance_kg_m);
}

TEST(Balancers, ThatAreWrongAreRefusedAtTheirLines) {
  const auto refusal = [](const std::string& section) {
    try {
      static_cast<void>(read_engine_text(std::string(kTwin) + section, "twin.ini", {}));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string shaft = "[balance_shaft 1]\nmass_g = 1\nradius_mm = 1\nangle_deg = 0\nposition_mm = 0\n";
  EXPECT_NE(refusal(shaft + "turns = 3\ndirection = with\n").find("turns"), std::string::npos);
  EXPECT_NE(refusal(shaft + "turns = 1\ndirection = back\n").find("with, against"), std::string::npos)
      << refusal(shaft + "turns = 1\ndirection = back\n");
  EXPECT_NE(refusal(shaft + "turns = 1\n").find("direction"), std::string::npos);
  EXPECT_NE(refusal("[counterweight]\nmass_g = 1\n").find("needs a name"), std::string::npos);
}

}  // namespace
}  // namespace crankloop::program::free_forces_test

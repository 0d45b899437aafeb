// `crankloop balance` and `crankloop forces`: their tables of the 495 against geometry, plain Fourier sums and its
// design sheet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <crankloop/tabulate/summary.hpp>

#include "crankloop/engine_file/engine_file.hpp"
#include "support/files.hpp"
#include "support/fourier.hpp"
#include "support/motored_cycle.hpp"
#include "support/run_command.hpp"
#include "support/status.hpp"
#include "support/units.hpp"

namespace crankloop::program::balance_command_test {
namespace {

constexpr double kRated_rad_s = 2000 * support::kPi / 30;

std::string printed_by(const Command& command, std::vector<std::string> options) {
  options.insert(options.begin(), kSample);
  testing::internal::CaptureStdout();
  const int status = command.run(Arguments(command, options));
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_EQ(status, kSuccess);
  return text;
}

std::map<std::string, double> balance(const std::vector<std::string>& options = {}) {
  std::vector<std::string> words = {"--rpm", "2000"};
  words.insert(words.end(), options.begin(), options.end());
  std::map<std::string, double> values;
  for (const std::string& row : split_at(printed_by(kBalance, words), '\n')) {
    const std::vector<std::string> cells = split_at(row, ',');
    if (cells.at(1) != "value") values[cells.at(0)] = std::stod(cells.at(1));
  }
  return values;
}

/// A column of `forces` by its name.
std::vector<double> column(const std::string& csv, const std::string& name) {
  const std::vector<std::string> lines = split_at(csv, '\n');
  const std::vector<std::string> names = split_at(lines.at(0), ',');
  const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  std::vector<double> values;
  for (std::size_t i = 1; i < lines.size(); ++i) values.push_back(std::stod(split_at(lines[i], ',').at(at)));
  return values;
}

EngineDefinition diesel() { return read_engine_file(kSample, {}).definition(); }

TEST(BalanceCommand, HasNoWorkAndNoEfficiencyWithoutPressure) {
  const support::TemporaryFolder folder;
  std::string text = contents(kSample);
  const std::size_t at = text.find("\n[pressure]");
  text.erase(at, text.find("\n[", at + 1) - at);
  std::ofstream(folder / "masses.ini") << text;
  testing::internal::CaptureStdout();
  EXPECT_EQ(kBalance.run(Arguments(kBalance, {folder / "masses.ini", "--rpm", "2000"})), kSuccess);
  const std::string printed = testing::internal::GetCapturedStdout();
  for (const char* name : {"net_mep_kPa", "gross_mep_kPa", "power_kW", "mean_torque_Nm", "mechanical_efficiency_ratio"})
    EXPECT_NE(printed.find(std::string("\n") + name + ",0\n"), std::string::npos) << name << "\n" << printed;
}

TEST(BalanceCommand, GivesTheSheetsPowerAtTheCouplingAndTheEfficiencyAssumed) {
  std::map<std::string, double> b = balance();
  EXPECT_NEAR(b["brake_power_kW"] / 4, 8.8, 0.005);
  EXPECT_NEAR(b["mechanical_efficiency_ratio"], 0.80, 0.0005);
  EXPECT_NEAR(b["brake_torque_Nm"] * kRated_rad_s / 1000, b["brake_power_kW"], 1e-6);
  // 90 + 26 * 2 + 5 * 4 kPa [friction]
  EXPECT_NEAR(b["friction_mep_kPa"], 162, 1e-6);
  EXPECT_NEAR(b["brake_power_kW"] / b["power_kW"], (809.7 - 162) / 809.7, 1e-6);
}

/// The acceleration's harmonics from the position's, a sum over the turn: (r + l) cos ... of the mechanism, each times
/// n^2.
TEST(BalanceCommand, ShowsTheThirdAndFifthOrdersThatAPinOffsetMakes) {
  const support::TemporaryFolder folder;
  std::string text = contents(CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini");
  const std::string none = "pin_offset_mm = 0";
  const std::size_t at = text.find(none);
  ASSERT_NE(at, std::string::npos);
  std::ofstream(folder / "offset.ini") << text.replace(at, none.size(), "pin_offset_mm = 6");
  const auto values_of = [](const std::string& path) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(kBalance.run(Arguments(kBalance, {path, "--rpm", "7000"})), kSuccess);
    std::map<std::string, double> values;
    for (const std::string& row : split_at(testing::internal::GetCapturedStdout(), '\n')) {
      const std::vector<std::string> cells = split_at(row, ',');
      if (cells.at(1) != "value") values[cells.at(0)] = std::stod(cells.at(1));
    }
    return values;
  };
  std::map<std::string, double> found = values_of(folder / "offset.ini");
  const double r_m = 57.8e-3 / 2, l_m = 101e-3, e_m = 6e-3, w = 7000 * support::kPi / 30;
  const double mass_kg = found.at("reciprocating_mass_kg");
  for (const auto& [order, name] :
       std::map<int, std::string>{{1, "first"}, {3, "third"}, {4, "fourth"}, {5, "fifth"}}) {
    double cosine_m = 0, sine_m = 0;
    constexpr int kSteps = 360;
    for (int i = 0; i < kSteps; ++i) {
      const double a = 2 * support::kPi * i / kSteps;
      const double side_m = r_m * std::sin(a) - e_m;
      const double pin_m = r_m * std::cos(a) + std::sqrt(l_m * l_m - side_m * side_m);  // above the crank's axis
      cosine_m += 2.0 / kSteps * pin_m * std::cos(order * a);
      sine_m += 2.0 / kSteps * pin_m * std::sin(order * a);
    }
    const double force_N = mass_kg * order * order * w * w * std::hypot(cosine_m, sine_m);
    EXPECT_NEAR(found.at("free_force_" + name + "_N"), force_N, 1e-6 * force_N + 1e-9) << name;
  }
  EXPECT_EQ(values_of(CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini").count("free_force_third_N"), 0u)
      << "without an offset there is none";
}

TEST(BalanceCommand, AtLoadRatioZeroIsTheMotoredEngine) {
  const EngineDefinition engine = diesel();
  const double motored_kPa =
      support::loop_work_J(
          engine.crank,
          [&](double deg) { return support::motored_cycle_Pa(engine.crank, engine.pressure.wiebe, 1.38, deg); }) /
      support::swept_m3(engine.crank) / 1000;
  std::map<std::string, double> b = balance({"--load-ratio", "0"});
  EXPECT_NEAR(b["net_mep_kPa"], motored_kPa, 1e-3);
  EXPECT_LT(b["brake_power_kW"], b["power_kW"]);
  EXPECT_EQ(b["mechanical_efficiency_ratio"], 0) << "nothing is indicated to be lost";
  EXPECT_LT(b["main_journal_3_max_down_N"], balance()["main_journal_3_max_down_N"] / 1.2);
}

TEST(BalanceCommand, GivesAmplitudeAndPhaseOfForcesAndTorque) {
  const EngineDefinition engine = diesel();
  std::map<std::string, double> b = balance();
  // Four pistons, all in phase in even orders: straight up where cylinder 1 is at top dead centre, or straight down.
  for (const auto& [order, name] : {std::pair<int, const char*>{2, "second"}, {4, "fourth"}, {6, "sixth"}}) {
    const auto upward_N = [&](double a) {
      const support::Motion m =
          support::motion_at(engine.crank, static_cast<long double>(a), static_cast<long double>(kRated_rad_s));
      return -4 * engine.masses.reciprocating_kg() * static_cast<double>(m.piston_pin_acceleration.up);
    };
    const support::FourierTerm term = support::fourier_term(upward_N, order, 64);
    const std::string key = std::string("free_force_") + name;
    EXPECT_NEAR(b[key + "_up_N"], std::fabs(term.cosine), 1e-8 * 3700) << name;
    EXPECT_NEAR(b[key + "_N"], std::fabs(term.cosine), 1e-8 * 3700) << name;
    EXPECT_NEAR(b[key + "_up_phase_deg"], term.cosine > 0 ? 0 : 180, 1e-6) << name;
  }
  ExactEngine exact;
  ASSERT_TRUE(accepted(exact.init(engine)));
  for (const int order : {2, 4, 6}) {
    const support::FourierTerm term = support::fourier_term(
        [&](double a) { return exact.torque_Nm(a * 180 / support::kPi, kRated_rad_s); }, order, 3600);
    const std::string key = "torque_order_" + std::to_string(order);
    const double phase_rad = b[key + "_phase_deg"] * support::kPi / 180;
    EXPECT_NEAR(b[key + "_Nm"] * std::cos(phase_rad), term.cosine, 1e-3) << order;
    EXPECT_NEAR(b[key + "_Nm"] * std::sin(phase_rad), term.sine, 1e-3) << order;
  }
}

/// By symmetry: four cylinders in line, 180 deg apart, have torque and forces of even orders alone and no moments.
TEST(BalanceCommand, PrintsZeroForWhatCancels) {
  std::map<std::string, double> b = balance();
  for (const char* order : {"0.5", "1", "1.5", "2.5", "3", "5", "11.5"}) {
    const std::string key = std::string("torque_order_") + order;
    ASSERT_EQ(b.count(key + "_Nm"), 1u) << key;
    EXPECT_EQ(b[key + "_Nm"], 0) << key;
    EXPECT_EQ(b[key + "_phase_deg"], 0) << key;
  }
  for (const char* name : {"free_force_first_N", "free_moment_first_Nm", "free_moment_first_pitch_Nm",
                           "free_moment_second_Nm", "free_moment_rotating_yaw_Nm"}) {
    ASSERT_EQ(b.count(name), 1u) << name;
    EXPECT_EQ(b[name], 0) << name;
  }
  for (const auto& [name, value] : b) {
    EXPECT_TRUE(value == 0 || std::abs(value) > 1e-7) << name << " = " << value << " is rounding";
  }
}

TEST(BalanceCommand, GivesTheMainBearingsLoadsOnTheBlock) {
  std::map<std::string, double> b = balance();
  for (int j = 1; j <= 5; ++j) {
    const std::string journal = "main_journal_" + std::to_string(j) + "_";
    const double largest = b[journal + "max_load_N"];
    const double down = b[journal + "max_down_N"];
    const double aside = std::max(b[journal + "max_lateral_N"], -b[journal + "min_lateral_N"]);
    EXPECT_GT(down, b[journal + "max_up_N"]) << "gas pushes the crankshaft down";
    EXPECT_LE(down, largest);
    EXPECT_GE(std::hypot(std::max(down, b[journal + "max_up_N"]), aside), largest * (1 - 1e-9));
  }
}

TEST(ForcesCommand, GivesDisplacementAndVolumeAndTakesALoadRatio) {
  const EngineDefinition engine = diesel();
  for (const char* method : {"table", "exact"}) {
    const std::string csv =
        printed_by(kForces, {"--rpm", "2000", "--load-ratio", "0", "--method", method, "--cylinder", "2"});
    const std::vector<double> deg = column(csv, "crank_deg");
    const std::vector<double> displacement_mm = column(csv, "displacement_mm");
    const std::vector<double> volume_cm3 = column(csv, "volume_cm3");
    const std::vector<double> pressure_kPa = column(csv, "pressure_kPa");
    ASSERT_EQ(deg.size(), 721u);
    for (std::size_t i = 0; i < deg.size(); ++i) {
      const long double a = static_cast<long double>(deg[i]) * support::kWidePi / 180;
      const auto below_m =
          static_cast<double>(support::greatest_height(engine.crank) - support::piston_height(engine.crank, a));
      EXPECT_NEAR(displacement_mm[i], below_m * 1e3, 1e-6) << deg[i];
      EXPECT_NEAR(volume_cm3[i], support::volume_m3(engine.crank, deg[i]) * 1e6, 1e-5) << deg[i];
      const double want_Pa = support::motored_cycle_Pa(engine.crank, engine.pressure.wiebe, 1.38, deg[i]);
      EXPECT_NEAR(pressure_kPa[i], want_Pa / 1000, 0.2)
          << deg[i];  // tables: 1e-5 of the fired peak of 7 MPa, motored and heat
    }
  }
}

TEST(ForcesCommand, RefusesALoadRatioWithoutAPressure) {
  class Bare : public RunCommand {
   public:
    void TestBody() override {}
    using RunCommand::engine_without_pressure;
  };
  const Bare bare;
  for (const Command* command : {&kForces, &kBalance}) {
    const std::vector<std::string> words = {bare.engine_without_pressure(), "--rpm", "2000", "--load-ratio", "0.5"};
    EXPECT_THROW(command->run(Arguments(*command, words)), InputError);
  }
}

}  // namespace
}  // namespace crankloop::program::balance_command_test

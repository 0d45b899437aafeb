// `crankloop run` and `run --free` with engines that breathe: figures against the ticks of the CSV and against what is
// known of engines.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "support/columns.hpp"
#include "support/markup.hpp"
#include "support/run_command.hpp"
#include "support/units.hpp"

namespace crankloop::program::breathing_run_test {
namespace {

const std::string kEngines = CRANKLOOP_SOURCE_DIR "/tools/engines/";
const std::string kFour = kEngines + "four_2000.ini";

using support::Columns;

class BreathingRun : public RunCommand {
 protected:
  /// The summary's number of that name, at a speed, with more options.
  static double at(const std::string& name, const std::string& engine, double rpm,
                   std::vector<std::string> options = {}) {
    options.insert(options.begin(), {engine, "--rpm", std::to_string(rpm), "--no-warnings"});
    return line(run(options), name).first;
  }
  /// four_2000.ini with these lines in its [gas].
  [[nodiscard]] std::string with(const std::string& keys) const {
    const std::string before = "[gas]\n";
    std::string text = contents(kFour);
    text.replace(text.find(before), before.size(), before + keys);
    const std::string file = path("engine.ini");
    std::ofstream(file) << text;
    return file;
  }
};

TEST_F(BreathingRun, TellsWhatItsTicksAddUpTo) {
  // Trapezoids over ticks of 0.24 deg, and flows that are means over a tick: a part in a thousand.
  constexpr double kOfSums = 2e-3;
  constexpr double kStroke_mm = 86;
  constexpr double kSwept_mm3 = kStroke_mm * 86 * 86 * 3.14159265358979 / 4;
  const std::string csv = path("run.csv");
  const std::string summary =
      run({kFour, "--rpm", "2000", "--tick-us", "20", "--cycles", "1", "--real", "double", "--csv", csv});
  const Columns ticks(csv);
  const std::vector<double> pressure_kPa = ticks.column("c1_gas_pressure_kPa");
  EXPECT_EQ(pressure_kPa, ticks.column("c1_pressure_kPa"));
  const std::vector<double> piston_mm = ticks.column("c1_displacement_mm");
  const std::vector<double> intake_g_s = ticks.column("c1_intake_flow_g_s");
  const std::vector<double> mass_mg = ticks.column("c1_mass_mg");
  const std::vector<double> burned = ticks.column("c1_burned_ratio");
  const std::vector<double> lift_mm = ticks.column("c1_intake_lift_mm");
  const std::vector<double> wall_W = ticks.column("c1_wall_heat_W");
  ASSERT_EQ(pressure_kPa.size(), 3000u);
  double work = 0;
  double in_mg = 0;
  double wall_J = 0;
  double trapped_mg = 0;
  double peak_kPa = 0;
  for (std::size_t i = 0; i < pressure_kPa.size(); ++i) {
    const std::size_t before = (i + pressure_kPa.size() - 1) % pressure_kPa.size();
    work += (pressure_kPa[before] + pressure_kPa[i]) / 2 * (piston_mm[i] - piston_mm[before]);
    in_mg += intake_g_s[i] * 20e-6 * 1e3;
    wall_J += wall_W[i] * 20e-6;
    peak_kPa = std::max(peak_kPa, pressure_kPa[i]);
    if (lift_mm[before] > 1e-3 && lift_mm[i] <= 1e-3) trapped_mg = mass_mg[i] * (1 - burned[i]);
  }
  EXPECT_NEAR(line(summary, "net_mep").first, work / kStroke_mm, kOfSums * work / kStroke_mm);
  EXPECT_NEAR(line(summary, "trapped_air").first, trapped_mg, kOfSums * trapped_mg);
  EXPECT_NEAR(line(summary, "wall_heat").first, wall_J, kOfSums * wall_J);
  EXPECT_NEAR(line(summary, "max_pressure").first, peak_kPa, 1e-5 * peak_kPa);
  // Wide open at low speed some fresh gas is pushed back, and comes in again: what came in on balance is air.
  const double ambient_mg = 100e3 / 287.1 / 298.15 * kSwept_mm3 * 1e-9 * 1e6;
  EXPECT_NEAR(line(summary, "volumetric_efficiency").first, in_mg / ambient_mg, 0.01);
  const double fuel_mg = line(summary, "fuel_burned").first;
  EXPECT_NEAR(fuel_mg, trapped_mg / 14.6, 0.02 * fuel_mg);
  EXPECT_NEAR(line(summary, "heat").first, fuel_mg * 0.97 * 43, 1e-4 * fuel_mg * 42);
  EXPECT_LT(line(summary, "energy_defect").first, 1e-9 * line(summary, "heat").first);
}

TEST_F(BreathingRun, TellsWhatBlowsByWhereTheEngineHasCrevices) {
  std::string text = contents(kFour);
  const std::string before = "[gas]\n";
  text.replace(text.find(before), before.size(), "[gas]\ncrevice_share = 0.015\nblow_by_mm2 = 0.1\n");
  const std::string leaky = path("leaky.ini"), csv = path("run.csv");
  std::ofstream(leaky) << text;
  const std::string summary = run({leaky, "--rpm", "2000", "--tick-us", "20", "--cycles", "1", "--csv", csv});
  const Columns ticks(csv);
  double blow_by_mg = 0;
  for (const double g_s : ticks.column("c1_blow_by_g_s")) blow_by_mg += g_s * 20e-6 * 1e3;
  EXPECT_GT(blow_by_mg, 3);
  EXPECT_NEAR(line(summary, "blow_by").first, blow_by_mg, 2e-3 * blow_by_mg);
  const std::vector<double> pressure_kPa = ticks.column("c1_gas_pressure_kPa"), held_mg = ticks.column("c1_crevice_mg");
  const double per_kPa_mg = 0.015 * 86 * 86 * 86 * 3.14159265358979 / 4 * 1e-9 / 9.5 * 1e3 / 287.1 / 423.15 * 1e6;
  for (std::size_t i = 0; i < held_mg.size(); ++i)
    ASSERT_NEAR(held_mg[i], per_kPa_mg * pressure_kPa[i], 0.02 * held_mg[i]) << i;
  EXPECT_LT(line(summary, "max_pressure").first, line(run({kFour, "--rpm", "2000"}), "max_pressure").first * 0.97);
  EXPECT_EQ(run({kFour, "--rpm", "2000"}).find("blow_by"), std::string::npos);
}

TEST_F(BreathingRun, IsTunedByItsRunners) {
  const std::string tuned = with("intake_runner_mm = 400\nintake_runner_diameter_mm = 38\n");
  const std::string csv = path("run.csv");
  const double charge = at("volumetric_efficiency", tuned, 4800, {"--tick-us", "50", "--csv", csv});
  EXPECT_GT(charge, at("volumetric_efficiency", kFour, 4800) + 0.08);
  const Columns ticks(csv);
  double through_mg = 0, runner_mg = 0, swing_kPa = 0;
  for (const double g_s : ticks.column("c1_intake_flow_g_s")) through_mg += g_s * 50e-3;
  for (const double g_s : ticks.column("c1_intake_runner_g_s")) runner_mg += g_s * 50e-3;
  for (const double kPa : ticks.column("c1_intake_port_kPa")) swing_kPa = std::max(swing_kPa, std::fabs(kPa - 100));
  EXPECT_NEAR(runner_mg, through_mg, 0.01 * through_mg);
  EXPECT_GT(swing_kPa, 10);
  const char* const refused[] = {"intake_runner_mm = 400\n", "exhaust_runner_loss = 1\n", "intake_runner_mm = 10\n"};
  for (const std::string bad : refused) {
    EXPECT_NE(status_of("'" + with(bad) + "' --rpm 3000"), 0) << bad;
    EXPECT_NE(contents(path("err")).find(bad.substr(0, bad.find(' '))), std::string::npos) << contents(path("err"));
  }
}

TEST_F(BreathingRun, WarmsItsWallsUp) {
  const std::string csv = path("run.csv");
  (void)run({with("wall_J_per_K = 100\nexhaust_W_per_K = 8\n"), "--rpm", "3000", "--no-warnings", "--csv", csv});
  const Columns ticks(csv);
  const auto wall_K = ticks.column("c4_wall_K"), heat_W = ticks.column("exhaust_wall_heat_W"),
             manifold_K = ticks.column("exhaust_manifold_K");
  EXPECT_GT(wall_K.back(), 424);
  EXPECT_NEAR(heat_W.back(), 8 * (manifold_K.back() - 298.15), 0.02 * heat_W.back());
  EXPECT_EQ(ticks.column("intake_wall_heat_W").back(), 0);
  EXPECT_NE(status_of("'" + with("wall_J_per_K = 0.5\n") + "' --rpm 3000"), 0);
  EXPECT_NE(contents(path("err")).find("wall_J_per_K"), std::string::npos) << contents(path("err"));
}

TEST_F(BreathingRun, SaysWhereItsWallsEndUp) {
  const auto walls = [&](const std::string& heat_capacity, const std::string& wall_C) {
    return with("wall_W_per_K = 40\nwall_J_per_K = " + heat_capacity + "\nwall_C = " + wall_C + "\n");
  };
  // Thin walls get there within the run.
  const std::string warm = run({walls("50", "100"), "--rpm", "3000", "--no-warnings", "--cycles", "400"});
  const double end_K = line(warm, "wall_temperature").first;
  EXPECT_EQ(warm.find("settle near"), std::string::npos) << warm;
  std::string wall_C = "100";
  for (int round = 0; round < 2; ++round) {  // the warmer the walls, the less heat they take
    const std::string begun = run({walls("2000", wall_C), "--rpm", "3000", "--no-warnings"});
    EXPECT_NEAR(line(begun, "wall_temperature").first, std::stod(wall_C) + 273.15, 5);
    const std::string words = "set wall_C = ";
    const std::size_t at = begun.find(words);
    if (at == std::string::npos) break;
    wall_C = std::to_string(std::stoi(begun.substr(at + words.size())));
  }
  EXPECT_NEAR(std::stod(wall_C) + 273.15, end_K, 4);
}

TEST_F(BreathingRun, TellsHowNearItComesToKnock) {
  const std::string file = with("octane = 95\n");
  const double at_2000 = at("knock_integral", file, 2000);
  EXPECT_GT(at_2000, 0.5);
  EXPECT_LT(at("knock_integral", file, 5000), 0.7 * at_2000);
  EXPECT_LT(at("knock_integral", file, 2000, {"--throttle", "0.1"}), 0.5 * at_2000);
  EXPECT_GT(at("knock", with("octane = 60\n"), 1500), -18);
  EXPECT_EQ(run({kFour, "--rpm", "2000"}).find("knock"), std::string::npos);
  EXPECT_NE(status_of("'" + with("octane = 30\n") + "' --rpm 3000"), 0);
  EXPECT_NE(contents(path("err")).find("octane"), std::string::npos) << contents(path("err"));
}

TEST_F(BreathingRun, BurnsByItsCharge) {
  const std::string file = with("burn_by = charge\nspark_to_start_deg = 5\n");
  const auto duration = [&](double rpm, const std::vector<std::string>& more) {
    return at("burn_by_charge_duration", file, rpm, more);
  };
  const double at_2000 = duration(2000, {});
  EXPECT_GT(duration(4000, {}), 1.15 * at_2000);
  EXPECT_GT(duration(2000, {"--lambda", "1.3"}), 1.1 * at_2000);
  EXPECT_NEAR(at("burn_by_charge_start", file, 2000), -18 + 5 * at_2000 / 50, 0.1);
  const char* const refused[] = {"burn_by = magic\n", "burn_by = charge\nspark_to_start_deg = 41\n",
                                 "burn_by = charge\nburn_reference_residual = 0.31\n"};
  for (const std::string bad : refused) EXPECT_NE(status_of("'" + with(bad) + "' --rpm 3000"), 0) << bad;
}

TEST_F(BreathingRun, HasTheChargeOfAnEngineOfItsKind) {
  // No pressure waves, so no tuning peaks: flat, and less where the valves choke.
  for (const double rpm : {1000.0, 2000.0, 4000.0, 6000.0}) {
    const double charge = at("volumetric_efficiency", kFour, rpm);
    EXPECT_GT(charge, 0.8) << rpm;
    EXPECT_LT(charge, 0.95) << rpm;
  }
  EXPECT_LT(at("volumetric_efficiency", kFour, 9000), at("volumetric_efficiency", kFour, 6000) - 0.02);
}

TEST_F(BreathingRun, PumpsThroughAThrottleAndKeepsMoreOfItsExhaust) {
  double residual_before = 0;
  for (const char* throttle : {"1", "0.2", "0.05", "0.02"}) {
    SCOPED_TRACE(throttle);
    const std::vector<std::string> options{"--throttle", throttle, "--fuel-mg", "10"};
    const double intake_kPa = at("intake_pressure", kFour, 1500, options);
    const double exhaust_kPa = at("exhaust_pressure", kFour, 1500, options);
    // Down at the manifold's pressure, up at the exhaust's: what lies between is lost, less what the last of the
    // expansion and the first of the compression share with it.
    EXPECT_NEAR(at("pumping_mep", kFour, 1500, options), intake_kPa - exhaust_kPa, 8);
    const double residual = at("residual_ratio", kFour, 1500, options);
    EXPECT_GT(residual, residual_before);
    residual_before = residual;
  }
  EXPECT_GT(residual_before, 0.1);
  EXPECT_LT(residual_before, 0.35);
}

TEST_F(BreathingRun, MakesTheMostTorqueWherePressurePeaksSomeTwelveDegreesLate) {
  double best_mep_kPa = 0;
  double best_peak_deg = 0;
  for (const char* start : {"-34", "-30", "-26", "-22", "-18", "-14", "-10", "-6"}) {
    const std::vector<std::string> options{"--burn-start-deg", start, "--tick-us", "20"};
    const double mep_kPa = at("net_mep", kFour, 2000, options);
    if (mep_kPa <= best_mep_kPa) continue;
    best_mep_kPa = mep_kPa;
    best_peak_deg = at("max_pressure_at", kFour, 2000, options);
  }
  EXPECT_GT(best_peak_deg, 8);  // Heywood, Internal Combustion Engine Fundamentals, section 9.1: about 16
  EXPECT_LT(best_peak_deg, 18);
}

TEST_F(BreathingRun, OfTheDieselGivesTheSheetsPowerWithoutAThrottle) {
  const std::string diesel = kEngines + "diesel_495_gas.ini";
  EXPECT_NEAR(at("brake_power", diesel, 2000), 4 * 8.8, 0.05 * 4 * 8.8);
  EXPECT_EQ(at("net_mep", diesel, 2000), at("net_mep", diesel, 2000, {"--throttle", "0"}));
  EXPECT_GT(at("excess_air_ratio", diesel, 2000), 1.3);
  EXPECT_LT(at("net_mep", diesel, 2000, {"--fuel-mg", "0"}), 0);
}

TEST_F(BreathingRun, TurnsFreelyToTheSpeedWhereItsFrictionTakesWhatItMakes) {
  const std::string summary = run({kFour, "--free", "--from-rpm", "1000", "--throttle", "0.02", "--fuel-mg", "8",
                                   "--seconds", "12", "--tick-us", "200"});
  const double torque_Nm = line(summary, "cycle_torque").first;
  EXPECT_NEAR(torque_Nm, line(summary, "cycle_friction").first, 0.05 * torque_Nm);
  const double rpm = line(summary, "cycle_speed").first;
  EXPECT_NEAR(line(summary, "net_mep").first,
              at("net_mep", kFour, rpm, {"--throttle", "0.02", "--fuel-mg", "8", "--tick-us", "200"}),
              0.05 * line(summary, "net_mep").first);
  // What left the gas turned the crank: the books close but for friction's trapezoids.
  EXPECT_LT(std::fabs(line(summary, "energy_defect").first), 1e-4);
  EXPECT_EQ(line(summary, "faulty_ticks").first, 0);
}

/// Four times the fuel that the air can burn.
TEST_F(BreathingRun, OfTooMuchFuelBurnsWhatThereIsAirForAndHasNoFault) {
  const std::string summary = run({kEngines + "diesel_495_gas.ini", "--rpm", "2000", "--fuel-mg", "180"});
  EXPECT_EQ(line(summary, "faulty_ticks").first, 0) << summary;
  EXPECT_LT(line(summary, "excess_air_ratio").first, 0.3);
}

/// Fuel by the air in each cylinder: what the README's own example asks for.
TEST_F(BreathingRun, TakesItsFuelByItsAirAtAnyThrottle) {
  for (const char* throttle : {"0.05", "0.1", "1"}) {
    for (const char* lambda : {"0.8", "1", "1.3"}) {
      SCOPED_TRACE(std::string(throttle) + " " + lambda);
      const std::string summary = run({kFour, "--rpm", "3000", "--throttle", throttle, "--lambda", lambda});
      EXPECT_EQ(line(summary, "lambda").first, std::stod(lambda));
      EXPECT_NEAR(line(summary, "excess_air_ratio").first, std::stod(lambda), 1e-5);
      const double fuel_mg = line(summary, "fuel_burned").first;
      EXPECT_NEAR(fuel_mg * 14.6 * std::stod(lambda) / line(summary, "trapped_air").first, 1, 0.02);
      EXPECT_NEAR(line(summary, "heat").first, fuel_mg * 0.97 * 43 * std::min(1.0, std::stod(lambda)),
                  1e-4 * 42 * fuel_mg);
      EXPECT_EQ(line(summary, "faulty_ticks").first, 0);
    }
  }
  EXPECT_NEAR(at("excess_air_ratio", kFour, 3000, {"--throttle", "0.1"}), 1, 1e-5) << "the file's";
  const std::string rich = run({kFour, "--rpm", "3000", "--throttle", "0.1", "--fuel-mg", "30"});
  EXPECT_NE(rich.find("so rich a mixture does not ignite"), std::string::npos) << rich;
  EXPECT_NE(rich.find("a real engine loses torque below a lambda of 0.9"), std::string::npos) << rich;
  EXPECT_EQ(run({kFour, "--rpm", "3000", "--lambda", "0.95"}).find("loses torque"), std::string::npos);
  const std::vector<std::string> free{kFour, "--free", "--from-rpm", "2000", "--seconds", "0.3"};
  std::vector<std::string> misfiring = free;
  misfiring.insert(misfiring.end(), {"--misfire", "cylinder=2 every=3"});
  EXPECT_NE(run(misfiring).find("# fuel of misfires is in no figure"), std::string::npos);
  EXPECT_EQ(run(free).find("fuel of misfires"), std::string::npos);
  const std::string lean = run({kFour, "--rpm", "3000", "--lambda", "3"});
  EXPECT_NE(lean.find("so lean a mixture of gasoline does not ignite"), std::string::npos) << lean;
  const std::string diesel = run({kEngines + "diesel_495_gas.ini", "--rpm", "1000", "--lambda", "3"});
  EXPECT_EQ(diesel.find("does not ignite"), std::string::npos) << diesel;
}

TEST_F(BreathingRun, SaysThatNoEngineHasSuchAPressure) {
  std::string text = contents(kFour);
  text.insert(text.find("[gas]\n") + 6, "ambient_kPa = 500\n");
  std::ofstream(path("boosted.ini")) << text;
  EXPECT_NE(run({path("boosted.ini"), "--rpm", "3000"}).find("# the largest pressure is 3"), std::string::npos);
  EXPECT_EQ(run({kFour, "--rpm", "3000"}).find("the largest pressure is"), std::string::npos);
}

/// An intake of 1.2 m3 behind a closed throttle is still being emptied after 500 cycles.
TEST_F(BreathingRun, SaysThatItHasNotSettled) {
  std::string text = contents(kFour);
  text.replace(text.find("intake_volume_cm3 = 3000"), 24, "intake_volume_cm3 = 1.2e6");
  std::ofstream(path("large.ini")) << text;
  const std::string summary = run({path("large.ini"), "--rpm", "6000", "--throttle", "0", "--fuel-mg", "60"});
  EXPECT_NE(summary.find("not settled: net mep moved by "), std::string::npos) << summary;
  const std::string settled = run({kFour, "--rpm", "6000", "--throttle", "0", "--fuel-mg", "60"});
  EXPECT_EQ(settled.find("not settled"), std::string::npos) << settled;
}

/// 8000 rpm are 4.8 deg in 100 us and 96 deg in 2 ms.
TEST_F(BreathingRun, WarnsOfATickThatTurnsTheCrankTooFar) {
  EXPECT_EQ(status_of("'" + kFour + "' --rpm 8000 --tick-us 2000"), 0);
  EXPECT_NE(contents(path("err")).find("turns the crank by 96 deg at 8000 rpm"), std::string::npos)
      << contents(path("err"));
  EXPECT_NE(contents(path("err")).find("off by some 12 %; take --tick-us 833 or less"), std::string::npos);
  EXPECT_EQ(status_of("'" + kFour + "' --rpm 6000 --tick-us 1000"), 0);
  EXPECT_EQ(contents(path("err")).find("turns the crank"), std::string::npos) << "36 deg, in eight steps";
}

/// A free engine gets as fast as it likes: it says what speed it reached.
TEST_F(BreathingRun, SaysWhereAFreeEngineOutranItsTick) {
  const auto told = [&](const char* tick_us) {
    const std::string summary = run({kFour, "--free", "--from-rpm", "6000", "--machine-Nm", "120", "--seconds", "0.2",
                                     "--tick-us", tick_us, "--report", path("report.html")});
    const bool in_summary = summary.find("# a tick turns the crank by ") != std::string::npos;
    EXPECT_EQ(contents(path("report.html")).find("warning: a tick turns the crank by") != std::string::npos,
              in_summary);
    return in_summary;
  };
  EXPECT_TRUE(told("2000"));
  EXPECT_FALSE(told("500"));
}

/// Lambda is that of the cylinders that had fuel: one that is cut is not infinitely rich.
TEST_F(BreathingRun, HasTheLambdaOfTheCylindersThatFire) {
  const std::string summary = run({kEngines + "four_2000_everything.ini", "--free", "--from-rpm", "3000", "--throttle",
                                   "0.3", "--machine-Nm", "20", "--seconds", "0.5", "--cut", "1"});
  EXPECT_NEAR(line(summary, "excess_air_ratio").first, 1, 1e-4);
  EXPECT_GT(line(summary, "burn_by_charge_duration").first, 40);
}

/// Crevices hold air that the burn lacks: fuel is consumed that does not burn, and said so.
TEST_F(BreathingRun, ConsumesTheFuelThatFindsNoAir) {
  const std::string everything = kEngines + "four_2000_everything.ini";
  const std::string rich = run({everything, "--rpm", "3000", "--fuel-mg", "41"});
  const double power_kW = line(rich, "brake_power").first;
  EXPECT_NEAR(line(rich, "brake_specific_consumption").first, 41e-6 * 4 * 25 * 3600 * 1e3 / power_kW, 0.5);
  EXPECT_NEAR(line(rich, "fuel_burned").first + line(rich, "fuel_unburned").first, 41, 0.1);
  const std::string balanced = run({everything, "--rpm", "3000", "--lambda", "1"});  // docs/model.md
  const double unburned_mg = line(balanced, "fuel_unburned").first;
  EXPECT_NEAR(unburned_mg / (unburned_mg + line(balanced, "fuel_burned").first), 0.036, 0.001);
  EXPECT_NEAR(line(balanced, "sensor_lambda").first, 1.029, 0.001);
  const std::string lean = run({everything, "--rpm", "3000", "--fuel-mg", "20"});
  EXPECT_EQ(lean.find("fuel_unburned"), std::string::npos) << lean;
  EXPECT_NEAR(line(lean, "brake_specific_consumption").first,
              20e-6 * 4 * 25 * 3600 * 1e3 / line(lean, "brake_power").first, 1e-3);
}

TEST_F(BreathingRun, IsRefusedWithAManifoldThatIsTooSmallForTheTick) {
  std::string text = contents(kFour);
  text.replace(text.find("intake_volume_cm3 = 3000"), 24, "intake_volume_cm3 = 1");
  std::ofstream(path("tiny.ini")) << text;
  EXPECT_NE(status_of("'" + path("tiny.ini") + "' --rpm 2000"), 0);
  EXPECT_NE(contents(path("err")).find("intake_volume_cm3: too small for a tick of 100 us"), std::string::npos)
      << contents(path("err"));
  EXPECT_EQ(status_of("'" + path("tiny.ini") + "' --rpm 2000 --tick-us 10"), 0);
}

TEST_F(BreathingRun, OfOneCylinderCutTurnsMoreSlowly) {
  const auto speed = [](const std::vector<std::string>& more) {
    std::vector<std::string> words{kFour, "--free", "--from-rpm", "2000", "--throttle", "0.05", "--seconds", "2"};
    words.insert(words.end(), more.begin(), more.end());
    return line(run(words), "speed_at_end").first;
  };
  EXPECT_LT(speed({"--cut", "2"}), speed({}) - 50);
}

/// The exhaust port swings far beyond its manifold; what is modelled is not told as missing.
TEST_F(BreathingRun, DrawsThePressureAtThePortsOfItsRunners) {
  const std::string engine = kEngines + "four_2000_runners.ini";
  const std::string summary = run({engine, "--rpm", "4500", "--tick-us", "50", "--report", path("report.html")});
  EXPECT_NE(summary.find("first mode of runners"), std::string::npos);
  const std::string text = contents(path("report.html"));
  EXPECT_NE(text.find("beyond the first mode of the runners"), std::string::npos);
  EXPECT_EQ(text.find("crevices and blow-by"), std::string::npos);
  const support::Markup page = support::read(text);
  std::vector<std::string> legends;
  for (const support::Element& legend : page.of_class("legend")) legends.push_back(legend.text);
  for (const char* port : {"intake port", "exhaust port"})
    EXPECT_EQ(std::count(legends.begin(), legends.end(), port), 1) << port;
}

TEST_F(BreathingRun, OfTheSampleWithEverythingIsThatOfATwoLitreEngine) {
  const std::string engine = kEngines + "four_2000_everything.ini";
  double burn_deg = 0;
  for (const int rpm : {1000, 3000, 6000}) {
    const std::string summary = run({engine, "--rpm", std::to_string(rpm)});
    const auto number = [&summary](const char* name) { return line(summary, name).first; };
    const double brake_Nm = number("brake_torque"), efficiency = number("volumetric_efficiency");
    EXPECT_TRUE(brake_Nm > 140 && brake_Nm < 190) << rpm << ": " << brake_Nm;
    EXPECT_TRUE(efficiency > 0.8 && efficiency < 1.05) << rpm << ": " << efficiency;
    EXPECT_GT(number("burn_by_charge_duration"), burn_deg) << "burns take longer at " << rpm;
    burn_deg = number("burn_by_charge_duration");
    EXPECT_GT(number("burn_by_charge_start"), -16) << "the spark";
    EXPECT_GT(number("blow_by"), 1) << "mg";
    EXPECT_GT(number("knock_integral"), 0.5);
    EXPECT_EQ(number("faulty_ticks"), 0);
  }
}

TEST_F(BreathingRun, DrawsItsGasExchangeOnAPageOfTheUsualSize) {
  const std::string summary = run({kFour, "--rpm", "3000", "--report", path("report.html")});
  const std::string text = contents(path("report.html"));
  EXPECT_LT(text.size(), 460'000u);
  EXPECT_NE(text.find("Not modelled: pressure waves in pipes and the tuning"), std::string::npos);
  EXPECT_NE(text.find("crevices and blow-by"), std::string::npos);
  const support::Markup page = support::read(text);
  const auto description = [&page](const std::string& title) {
    const auto titles = page.all("title");
    for (std::size_t i = 1; i < titles.size(); ++i) {
      if (titles[i].text == title) return page.all("desc")[i - 1].text;  // the first is the page's
    }
    return std::string();
  };
  for (const char* title : {"Pressure over the volume", "The same, both axes logarithmic", "Rate of heat release",
                            "Flow through the valves", "Pressure on both sides of the valves", "Temperature of the gas",
                            "Mass in the cylinder", "Heat to the walls"})
    EXPECT_NE(description(title), "") << title;
  const auto largest = [&](const std::string& title) {
    const std::string all = description(title);
    return std::stod(all.substr(all.rfind(" to ") + 4));
  };
  // What the gas takes up by pressure and volume is the heat less what the walls take until the exhaust opens.
  const double heat_J = line(summary, "heat").first;
  EXPECT_LT(largest("Heat released"), heat_J);
  EXPECT_GT(largest("Heat released"), 0.97 * (heat_J - line(summary, "wall_heat").first));  // burned gas takes more
  EXPECT_NEAR(largest("Mass in the cylinder"),
              line(summary, "trapped_air").first / (1 - line(summary, "residual_ratio").first) +
                  line(summary, "fuel_burned").first,
              12);
  // The loop's caption has the work of the ticks, not the area between its points.
  const auto behind = [&text](const std::string& words) {
    return std::stod(text.substr(text.find(words) + words.size()));
  };
  const double net_kPa = line(summary, "net_mep").first;
  EXPECT_NEAR(behind("Its area is the indicated work: net IMEP "), net_kPa, 0.5);
  EXPECT_NEAR(behind("gross (over the closed 360 deg) "), net_kPa - line(summary, "pumping_mep").first, 0.5);
}

/// Intake valves of the sample by theory, as `lift` has them (lift_command_test.cpp sums those by hand); the elastic
/// ones, on a stiff train, are within a per cent.
TEST_F(BreathingRun, ShowsTheFlowAreaOfItsValves) {
  run({kFour, "--rpm", "3000", "--report", path("report.html")});
  const std::string text = contents(path("report.html"));
  const auto intake = [&text](const std::string& row) {
    const std::size_t at = text.find(row + "</th>");
    EXPECT_NE(at, std::string::npos) << row;
    if (at == std::string::npos) return 0.0;
    const std::size_t cell = text.find("<td class=\"number\">", text.find("<td", at) + 1);  // behind the unit
    std::string digits;
    for (const char c : text.substr(cell + 19, 24)) {
      if (c == '<') break;
      if ((c >= '0' && c <= '9') || c == '.') digits += c;  // without the thin space between thousands
    }
    return std::stod(digits);
  };
  EXPECT_EQ(support::read(text).fault, "");
  EXPECT_NE(text.find(">Flow area of one valve<"), std::string::npos);
  EXPECT_NE(text.find("Assumed, intake: seat_width_mm = 1.32, seat_angle_deg = 45"), std::string::npos);
  EXPECT_EQ(intake("Valves in a cylinder"), 2);
  EXPECT_NEAR(intake("Open period of theory, crank angle"), 256, 0.05);
  const double theory = intake("Integral of the area, theory");
  const double elastic = intake("Integral of the area");
  EXPECT_NEAR(elastic, theory, 0.01 * theory);
  EXPECT_LT(elastic, theory);
  EXPECT_NEAR(intake("Mean area while open") * intake("Open period"), elastic, 1e-3 * elastic);
  EXPECT_NEAR(intake("Mean gas speed"), 5808.8 * 8.6 / (2 * intake("Mean area while open")), 0.02);
  EXPECT_NEAR(intake("Inlet Mach index Z"), 5808.8 * 8.6 / (2 * intake("Mean effective area")) / 346.2, 1e-3);
}

TEST_F(BreathingRun, HasTheBalanceOfTheCycleThatItRuns) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(kBalance.run(Arguments(kBalance, {kFour, "--rpm", "3000", "--throttle", "0.3"})), kSuccess);
  const std::string rows = testing::internal::GetCapturedStdout();
  const auto row = [&](const std::string& name) {
    for (const std::string& text : split_at(rows, '\n')) {
      if (text.rfind(name + ",", 0) == 0) return std::stod(text.substr(name.size() + 1));
    }
    ADD_FAILURE() << name;
    return 0.0;
  };
  const std::string summary = run({kFour, "--rpm", "3000", "--throttle", "0.3", "--tick-us", "20"});
  const double torque_Nm = line(summary, "mean_torque").first;
  EXPECT_NEAR(row("mean_torque_Nm"), torque_Nm, 2e-3 * torque_Nm);
  EXPECT_NEAR(row("net_mep_kPa"), line(summary, "net_mep").first, 2e-3 * line(summary, "net_mep").first);
  EXPECT_NEAR(row("net_mep_kPa") - row("gross_mep_kPa"), line(summary, "pumping_mep").first, 1);
  // Four even firings: the second order and its multiples are all that torque has.
  EXPECT_GT(row("torque_order_2_Nm"), 0.5 * torque_Nm);
  for (const char* order : {"0.5", "1", "1.5", "3"})
    EXPECT_LT(row("torque_order_" + std::string(order) + "_Nm"), 0.01 * torque_Nm) << order;
  const double pin_N = line(summary, "max_crank_pin_load").first;
  EXPECT_NEAR(row("crank_pin_1_max_load_N"), pin_N, 2e-3 * pin_N);
}

TEST_F(BreathingRun, RefusesWhatItsEngineDoesNotHave) {
  const auto refused = [](const std::vector<std::string>& words, const std::string& why) {
    try {
      kRun.run(Arguments(kRun, words));
      ADD_FAILURE() << "not refused: " << why;
    } catch (const std::exception& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  refused({kFour, "--load-ratio", "1"}, "has gas exchange (source = gas), no diagram to scale");
  refused({kFour, "--lambda", "1", "--fuel-mg", "9"}, "--fuel-mg and --lambda both say how much fuel");
  refused({kFour, "--free", "--load-ratio", "1"}, "has gas exchange (source = gas), no diagram to scale");
  for (const char* option : {"--throttle", "--fuel-mg", "--lambda", "--burn-start-deg"})
    refused({kSample, option, "0.5"}, std::string(option) + ": " + kSample + " has no gas exchange");
  std::string slow = contents(kFour);
  slow.replace(slow.find("burn_duration_deg = 50"), 22, "burn_duration_deg = 95");
  std::ofstream(path("slow.ini")) << slow;
  std::string both = contents(kFour);
  both.insert(both.find("excess_air_ratio"), "fuel_mg = 30\n");
  std::ofstream(path("both.ini")) << both;
  refused({path("both.ini")}, "exclude each other; give either fuel_mg, or excess_air_ratio");
  refused({path("slow.ini"), "--burn-start-deg", "60"}, "the burn would end at 155 deg; it must end by 150 deg");
}

}  // namespace
}  // namespace crankloop::program::breathing_run_test

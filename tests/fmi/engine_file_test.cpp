// FMUs that `crankloop fmu` makes of an engine file: the bits of the scene that a compiler makes of it, the rows that
// `crankloop run` prints, and the file's numbers as parameters.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fmu.hpp"

namespace {

using fmu::Fmu;
using fmu::Unit;

/// A folder of its own for each test, gone with it.
class EngineFileFmu : public testing::Test {
 protected:
  EngineFileFmu() {
    folder_ = std::filesystem::temp_directory_path() / ("crankloop engine fmu " + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~EngineFileFmu() override { std::filesystem::remove_all(folder_); }

  /// What the program says, after its exit status.
  std::string run(const std::string& words) const {
    const std::string log = (folder_ / "log").string();
    const int status = std::system(("'" CRANKLOOP_PROGRAM "' " + words + " > '" + log + "' 2>&1").c_str());
    std::ifstream in(log);
    std::stringstream text;
    text << WEXITSTATUS(status) << " " << in.rdbuf();
    return text.str();
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] static std::string sample(const std::string& name) {
    return std::string(ENGINE_DIR) + "/" + name + ".ini";
  }
  std::string made(const std::string& engine_file, const std::string& options) const {
    const std::string fmu = path("an engine.fmu");
    const std::string said = run("fmu '" + engine_file + "' " + options + " -o '" + fmu + "'");
    EXPECT_EQ(said, "0 ");
    return fmu;
  }
  /// The sample with one line in the place of another.
  [[nodiscard]] std::string changed(const std::string& engine, const std::string& from, const std::string& to) const {
    std::ifstream in(sample(engine));
    std::stringstream text;
    text << in.rdbuf();
    std::string all = text.str();
    const std::size_t at = all.find("\n" + from);
    EXPECT_NE(at, std::string::npos);
    all.replace(at + 1, all.find('\n', at + 1) - at - 1, to);
    std::ofstream(path("changed.ini")) << all;
    return path("changed.ini");
  }
  static std::vector<double> after_a_turn(const Unit& unit, double speed_rad_s) {
    unit.set("speed_rad_s", speed_rad_s);
    EXPECT_EQ(unit_step(unit.unit, 0, 0.0613), UNIT_OK) << importer_message();
    std::vector<double> outputs;
    for (const auto& [name, reference] : unit.names()) {
      if (name.compare(0, 7, "engine.") != 0) outputs.push_back(unit.get(name));
    }
    return outputs;
  }

 private:
  std::filesystem::path folder_;
};

/// The outputs that two FMUs share, equal bit by bit.
void expect_equal_outputs(const Fmu& a, const Unit& unit_a, const Fmu& b, const Unit& unit_b) {
  std::size_t compared = 0;
  for (const auto& variable : a.model.variables) {
    if (variable.causality != "output") continue;
    ASSERT_EQ(b.model.by_name.count(variable.name), 1u) << variable.name;
    const double x = unit_a.get(variable.name);
    const double y = unit_b.get(variable.name);
    ASSERT_EQ(std::memcmp(&x, &y, sizeof x), 0) << variable.name << ": " << x << ", " << y;
    ++compared;
  }
  EXPECT_GT(compared, 10u);
}

TEST_F(EngineFileFmu, HasTheBitsOfTheCompiledScene) {
  for (const int version : {2, 3}) {
    for (const bool free : {false, true}) {
      const std::string v = std::to_string(version);
      const Fmu packed(made(sample("diesel_495"), "--fmi " + v + " --crank " + (free ? "torque" : "speed")));
      const Fmu compiled(std::string(FMU_DIR) + (free ? "/free_running" : "/whole") + "_fmi" + v + ".fmu");
      Unit a(packed);
      Unit b(compiled);
      for (Unit* unit : {&a, &b}) {
        if (free) unit->set("start.speed_rad_s", 0);
        ASSERT_NO_FATAL_FAILURE(unit->start());
        unit->set("load_ratio", 0.7);
        unit->set(free ? "starter" : "speed_rad_s", free ? 1 : 150);
        for (int k = 0; k < 500; ++k) ASSERT_NO_FATAL_FAILURE(unit->step(k * 1e-3, 1e-3));
      }
      ASSERT_NO_FATAL_FAILURE(expect_equal_outputs(packed, a, compiled, b));
      ASSERT_NO_FATAL_FAILURE(expect_equal_outputs(compiled, b, packed, a));
    }
  }
}

TEST_F(EngineFileFmu, PrintsTheRowsOfRun) {
  for (const char* engine : {"diesel_495", "ohc_125"}) {
    SCOPED_TRACE(engine);
    ASSERT_EQ(
        run("run '" + sample(engine) + "' --no-warnings --rpm 1500 --cycles 1 --tick-us 100 --real double --csv '" +
            path("run.csv") + "'")[0],
        '0');
    const Fmu fmu(made(sample(engine), "--tick-us 100"));
    Unit unit(fmu);
    ASSERT_NO_FATAL_FAILURE(unit.start());
    std::ifstream csv(path("run.csv"));
    std::string line;
    std::getline(csv, line);
    ASSERT_EQ(line.compare(0, 7, "time_s,"), 0);
    int rows = 0;
    double seconds = 0;
    unit.set("speed_rad_s", 1500 * 0.10471975511965977);
    // `run` records after a cycle to settle: 0.08 s, in which the valves' records of a cycle are filled.
    while (std::getline(csv, line)) {
      double row[6];
      char speed[40];
      ASSERT_EQ(
          std::sscanf(line.c_str(), "%lf,%lf,%39[^,],%lf,%lf,%lf", row, row + 1, speed, row + 2, row + 3, row + 4), 6);
      if (rows++ == 0) {
        for (; seconds < 0.08 - 1e-9; seconds += 1e-4) ASSERT_NO_FATAL_FAILURE(unit.step(seconds, 1e-4));
      }
      ASSERT_NO_FATAL_FAILURE(unit.step(seconds, 1e-4));
      seconds += 1e-4;
      // 12 digits of the CSV; torque passes through zero, to the largest's 12th
      ASSERT_NEAR(unit.get("crank_deg"), row[1], 1e-8) << "row " << rows;
      ASSERT_NEAR(unit.get("torque_Nm"), row[2], 1e-8) << "row " << rows;
      ASSERT_NEAR(unit.get("mean_torque_Nm"), row[3], 1e-8) << "row " << rows;
      ASSERT_NEAR(unit.get("cylinder[1].pressure_Pa") / 1e3, row[4], 1e-7) << "row " << rows;
    }
    EXPECT_EQ(rows, 800);
  }
}

/// A row of inputs over time, as how_to.md describes the file; read here by a few lines of its own.
struct InputRows {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;  ///< time first

  explicit InputRows(const std::string& text) {
    std::istringstream lines(text);
    std::string line, cell;
    std::getline(lines, line);
    for (std::istringstream header(line); std::getline(header, cell, ',');) names.push_back(cell);
    while (std::getline(lines, line)) {
      rows.emplace_back();
      for (std::istringstream cells(line); std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
    }
  }
  /// Of a column other than the time; a switch keeps its value until the next row.
  [[nodiscard]] double at(std::size_t column, double time_s) const {
    std::size_t i = 0;
    while (i + 1 < rows.size() && rows[i + 1][0] <= time_s) ++i;
    const bool is_switch = names[column] == "starter" || names[column] == "cut_cylinders";
    if (is_switch || i + 1 == rows.size() || time_s < rows[i][0]) return rows[i][column];
    const double share = (time_s - rows[i][0]) / (rows[i + 1][0] - rows[i][0]);
    return rows[i][column] + (rows[i + 1][column] - rows[i][column]) * share;
  }
};

TEST_F(EngineFileFmu, IsDrivenByTheInputFileOfAFreeRun) {
  const std::string text =
      "time_s,load_ratio,starter,external_torque_Nm,cut_cylinders\n"
      "0,0.3,1,0,0\n0.2,0.5,0,10,0\n0.35,0.5,0,30,2\n0.5,0.1,0,-20,0\n";
  std::ofstream(path("inputs.csv")) << text;
  ASSERT_EQ(run("run '" + sample("diesel_495") +
                "' --free --from-rpm 900 --seconds 0.6 --tick-us 100 --real double --inputs '" + path("inputs.csv") +
                "' --csv '" + path("run.csv") + "'")[0],
            '0');
  const InputRows inputs(text);
  const Fmu fmu(made(sample("diesel_495"), "--crank torque --tick-us 100 --real double"));
  Unit unit(fmu);
  unit.set("start.speed_rad_s", 900 * std::acos(-1.0) / 30);
  ASSERT_NO_FATAL_FAILURE(unit.start());
  std::ifstream csv(path("run.csv"));
  std::string line;
  std::getline(csv, line);
  ASSERT_EQ(line.compare(0, 59, "time_s,crank_deg,speed_rpm,acceleration_rad_s2,torque_Nm,me"), 0);
  int ticks = 0;
  for (; std::getline(csv, line); ++ticks) {
    for (std::size_t column = 1; column < inputs.names.size(); ++column)
      unit.set(inputs.names[column], inputs.at(column, ticks * 1e-4));
    ASSERT_NO_FATAL_FAILURE(unit.step(ticks * 1e-4, 1e-4));
    double row[5];
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", row, row + 1, row + 2, row + 3, row + 4), 5);
    ASSERT_NEAR(unit.get("speed_rad_s") * 30 / std::acos(-1.0), row[2], 1e-7) << "tick " << ticks;
    ASSERT_NEAR(unit.get("torque_Nm"), row[4], 1e-6) << "tick " << ticks;
  }
  EXPECT_EQ(ticks, 6000);
}

/// The rated speed in the file, by hand, and what `run --free` tells of the same start. These files' [machine] takes
/// the rated torque at the rated speed.
TEST_F(EngineFileFmu, ShowsAnEngineThatRunsInASimulationThatSetsNothing) {
  const std::map<std::string, double> rated_rpm{{"diesel_495", 2000}, {"ohc_125", 7000}, {"diesel_495_gas", 2000}};
  const auto start_of = [](const Fmu& fmu, const char* name) {
    return std::stod(fmu.model.variables.at(fmu.model.by_name.at(name)).start);
  };
  for (const auto& [engine, rpm] : rated_rpm) {
    SCOPED_TRACE(engine);
    const double rad_s = rpm * std::acos(-1.0) / 30;
    const Fmu given(made(sample(engine), "--crank speed"));
    EXPECT_NEAR(start_of(given, "speed_rad_s"), rad_s, 1e-9 * rad_s);
    Unit turned(given);
    ASSERT_NO_FATAL_FAILURE(turned.start());
    double torque_Nm = 0;
    for (int k = 0; k < 600; ++k) {
      ASSERT_NO_FATAL_FAILURE(turned.step(k * 1e-3, 1e-3));
      torque_Nm += turned.get("mean_torque_Nm") / 600;
    }
    EXPECT_GT(torque_Nm, 5) << "it is fired";

    const Fmu free(made(sample(engine), "--crank torque"));
    EXPECT_NEAR(start_of(free, "start.speed_rad_s"), rad_s, 1e-9 * rad_s);
    Unit unit(free);
    ASSERT_NO_FATAL_FAILURE(unit.start());
    for (int k = 0; k < 1000; ++k) ASSERT_NO_FATAL_FAILURE(unit.step(k * 1e-3, 1e-3));
    const double end_rpm = unit.get("speed_rad_s") * 30 / std::acos(-1.0);
    EXPECT_NEAR(end_rpm, rpm, 0.1 * rpm) << "fuel and load hold it near its rated speed";
    const std::string said = run("run '" + sample(engine) + "' --free --from-rpm " + std::to_string(rpm) +
                                 " --seconds 1 --tick-us 100 --real double");
    const auto at = said.find("speed_at_end = ");
    ASSERT_NE(at, std::string::npos) << said;
    EXPECT_NEAR(end_rpm, std::stod(said.substr(at + 15)), 1e-5 * rpm);
    EXPECT_EQ(unit.get("fault_ticks"), 0);
  }
  const std::string said =
      run("fmu '" + sample("four_2000") + "' --crank torque -o '" + path("without_machine.fmu") + "'");
  EXPECT_NE(said.find("four_2000.ini: warning: there is no [machine]"), std::string::npos) << said;
  EXPECT_EQ(said[0], '0');
}

TEST_F(EngineFileFmu, OfAnEngineThatBreathesHasTheCycleThatRunTellsOf) {
  const Fmu fmu(made(sample("four_2000"), "--tick-us 100 --real double"));
  Unit unit(fmu);
  unit.set("speed_rad_s", 2000 * 0.10471975511965977);
  unit.set("throttle_ratio", 0.1);
  for (int k = 1; k <= 4; ++k) {
    const std::string of = "[" + std::to_string(k) + "]";
    unit.set("fuel_kg" + of, 12e-6);
    unit.set("excess_air_ratio" + of, 0);
    unit.set("burn_start_deg" + of, -18);
    unit.set("burn_duration_deg" + of, 50);
  }
  ASSERT_NO_FATAL_FAILURE(unit.start());
  for (int k = 0; k < 30; ++k) ASSERT_NO_FATAL_FAILURE(unit.step(k * 0.06, 0.06));  // a cycle each
  const std::string said =
      run("run '" + sample("four_2000") + "' --rpm 2000 --throttle 0.1 --fuel-mg 12 --tick-us 100 --real double");
  const auto told = [&said](const std::string& name) {
    const auto at = said.find("\n" + name + " = ");
    EXPECT_NE(at, std::string::npos) << name;
    return std::stod(said.substr(at + name.size() + 4));
  };
  // Both have settled, each from a beginning of its own.
  constexpr double kSettled = 2e-3;
  const auto mean = [&unit](const std::string& name) {
    double sum = 0;
    for (int k = 1; k <= 4; ++k) sum += unit.get("gas_cycle[" + std::to_string(k) + "]." + name) / 4;
    return sum;
  };
  EXPECT_NEAR(mean("net_mep_Pa") / 1e3, told("net_mep"), kSettled * told("net_mep"));
  EXPECT_NEAR(mean("trapped_air_kg") * 1e6, told("trapped_air"), kSettled * told("trapped_air"));
  EXPECT_NEAR(mean("residual_ratio"), told("residual_ratio"), kSettled * told("residual_ratio"));
  EXPECT_NEAR(unit.get("intake.pressure_Pa") / 1e3, told("intake_pressure"), 0.2 * told("intake_pressure"));
  EXPECT_EQ(unit.get("fault_ticks"), 0);
}

TEST_F(EngineFileFmu, TakesTheFilesNumbersAsParameters) {
  const Fmu fmu(made(sample("diesel_495"), "--real float"));
  Unit wider(fmu);
  ASSERT_EQ(unit_setup(wider.unit, 0), UNIT_OK);
  wider.set("engine.crank.bore_mm", 97.25);
  ASSERT_EQ(unit_begin(wider.unit), UNIT_OK);
  wider.set("engine.valve.intake.spring_preload_N", 260);
  ASSERT_EQ(unit_start(wider.unit), UNIT_OK) << importer_message();
  Unit as_in_file(fmu);
  ASSERT_NO_FATAL_FAILURE(as_in_file.start());
  const auto wide = after_a_turn(wider, 200);
  EXPECT_NE(wide, after_a_turn(as_in_file, 200));

  // The engine whose file says so.
  std::ofstream(path("wide.ini")) << [&] {
    std::ifstream in(changed("diesel_495", "bore_mm", "bore_mm = 97.25"));
    std::string text;
    bool intake = false;
    for (std::string line; std::getline(in, line);) {
      if (line.compare(0, 1, "[") == 0) intake = line == "[valve intake]";
      if (intake && line.compare(0, 16, "spring_preload_N") == 0) line = "spring_preload_N = 260";
      text += line + "\n";
    }
    return text;
  }();
  if (run("show '" + path("wide.ini") + "'")[0] != '0') GTEST_FAIL() << run("show '" + path("wide.ini") + "'");
  const Fmu written(made(path("wide.ini"), "--real float"));
  Unit from_file(written);
  ASSERT_NO_FATAL_FAILURE(from_file.start());
  EXPECT_EQ(wide, after_a_turn(from_file, 200));

  // A state goes with its parameters, into an instance that has the file's.
  Unit other(fmu);
  ASSERT_EQ(other.restore(wider.saved()), UNIT_OK) << importer_message();
  EXPECT_EQ(other.get("engine.crank.bore_mm"), 97.25);
  ASSERT_NO_FATAL_FAILURE(other.step(0.0613, 0.02));
  ASSERT_NO_FATAL_FAILURE(wider.step(0.0613, 0.02));
  EXPECT_EQ(other.all(), wider.all());
}

TEST_F(EngineFileFmu, SaysThatSpringsWhichSurgeByTheFileFollowTheirValves) {
  const std::string surging =
      changed("diesel_495", "spring_preload_N", "spring_preload_N = 320\nsurge_modes = 2\nsurge_damping_ratio = 0.02");
  const std::string fmu_path = path("surging.fmu");
  EXPECT_EQ(run("fmu '" + surging + "' --no-warnings -o '" + fmu_path + "'"), "0 ");
  EXPECT_NE(run("fmu '" + surging + "' -o '" + fmu_path + "'").find("surge_modes: springs follow"), std::string::npos);
  const Fmu fmu(fmu_path);
  const fmu::Archive archive(fmu_path);
  EXPECT_NE(archive.files.at("documentation/index.html").find("Not stepped: surge of the valve springs"),
            std::string::npos);
  EXPECT_NE(fmu.model.root["description"].find("surge of the valve springs"), std::string::npos);
  EXPECT_EQ(fmu.model.by_name.count("engine.valve.intake.surge_damping_ratio"), 0u) << "it would change nothing";
  EXPECT_EQ(fmu.model.by_name.count("engine.valve.intake.spring_preload_N"), 1u);
  Unit unit(fmu);
  ASSERT_NO_FATAL_FAILURE(unit.start());
}

TEST_F(EngineFileFmu, RefusesAtTheStartWhatTheFileMustNotSay) {
  const Fmu fmu(made(sample("diesel_495"), ""));
  Unit unit(fmu);
  unit.set("engine.crank.rod_length_mm", 40);
  ASSERT_EQ(unit_begin(unit.unit), UNIT_OK);
  EXPECT_EQ(unit_start(unit.unit), UNIT_ERROR);
  const std::string said = importer_message();
  EXPECT_NE(said.find("engine.ini:"), std::string::npos) << said;
  EXPECT_NE(said.find("rod_length_mm"), std::string::npos) << said;
  for (const double bad : {std::nan(""), HUGE_VAL, -1.0, 1e9}) {
    unit.set("engine.crank.rod_length_mm", bad);
    EXPECT_EQ(unit_start(unit.unit), UNIT_ERROR) << bad;
  }
  unit.set("engine.crank.rod_length_mm", 210);
  EXPECT_EQ(unit_start(unit.unit), UNIT_OK) << importer_message();
  const std::uint32_t bore = fmu.model.by_name.at("engine.crank.bore_mm");
  const double bore_mm = 90;
  EXPECT_EQ(unit_set_real(unit.unit, &bore, 1, &bore_mm), UNIT_ERROR) << "too late";
}

TEST_F(EngineFileFmu, RefusesResourcesThatAreNotItsOwn) {
  const Fmu fmu(made(sample("ohc_125"), ""));
  std::ofstream(fmu.unpacked.folder / "resources/tick_us.txt") << "50\n";
  EXPECT_EQ(Unit(fmu).unit, nullptr);
  EXPECT_NE(std::string(importer_message()).find("token"), std::string::npos);
  std::filesystem::remove(fmu.unpacked.folder / "resources/engine.ini");
  EXPECT_EQ(Unit(fmu).unit, nullptr);
  EXPECT_NE(std::string(importer_message()).find("engine.ini"), std::string::npos);
}

TEST_F(EngineFileFmu, BringsItsTablesAlong) {
  std::ofstream cam(path("lift.csv"));
  cam << "cam_deg,lift_mm\n";
  for (int deg = 0; deg <= 140; ++deg)
    cam << deg << "," << 1.5 - 1.5 * std::cos(deg * 2 * std::acos(-1.0) / 140) << "\n";
  cam.close();
  std::ifstream in(sample("ohc_125"));
  std::string text;
  bool in_cam = false;
  for (std::string line; std::getline(in, line);) {
    if (line.compare(0, 1, "[") == 0) in_cam = line == "[cam intake]";
    const std::string key = line.substr(0, line.find(' '));
    if (in_cam && key == "source") line = "source = table\nfile = lift.csv\nsmoothing_um = 50";
    if (in_cam && (key == "max_lift_mm" || key == "half_angle_deg" || key == "exponents")) continue;
    text += line + "\n";
  }
  std::ofstream(path("table.ini")) << text;
  const std::string archive = made(path("table.ini"), "--tick-us 20");
  std::filesystem::remove(path("lift.csv"));
  const Fmu fmu(archive);
  EXPECT_EQ(fmu.archive.files.count("resources/table_1.csv"), 1u);
  Unit unit(fmu);
  ASSERT_NO_FATAL_FAILURE(unit.start());
  unit.set("speed_rad_s", 300);
  ASSERT_NO_FATAL_FAILURE(unit.step(0, 0.1));
  EXPECT_GT(unit.get("valve_cycle[1,1].largest_lift_m"), 2e-3);
}

TEST_F(EngineFileFmu, HasTheSameBytesEveryTime) {
  const auto bytes = [&] {
    std::ifstream in(made(sample("diesel_495"), "--crank torque"), std::ios::binary);
    std::stringstream all;
    all << in.rdbuf();
    return all.str();
  };
  const std::string first = bytes();
  ::setenv("TZ", "Pacific/Auckland", 1);
  EXPECT_TRUE(bytes() == first);
  ::unsetenv("TZ");
}

TEST_F(EngineFileFmu, SaysWhatItCannotDo) {
  const std::string fmu = path("x.fmu");
  EXPECT_EQ(run("fmu '" + sample("diesel_495") + "'")[0], '2');
  EXPECT_EQ(run("fmu '" + sample("diesel_495") + "' --fmi 1 -o '" + fmu + "'")[0], '2');
  EXPECT_EQ(run("fmu '" + path("none.ini") + "' -o '" + fmu + "'")[0], '2');
  EXPECT_EQ(run("pack '" + path("none") + "' -o '" + fmu + "'")[0], '2');
  EXPECT_FALSE(std::filesystem::exists(fmu)) << "nothing is half written";
}

}  // namespace

// What docs/separation_and_bounce.md and docs/gas_exchange.md tell beside outputs, which figures/printed.sh compares:
// their pictures, and figures in their sentences and tables. The fault bits of docs/safety.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <crankloop/faults.hpp>

#include "crankloop/commands/redline/redline_search.hpp"
#include "crankloop/loops/surge_force.hpp"
#include "crankloop/loops/valve_loop.hpp"
#include "support/columns.hpp"
#include "support/files.hpp"
#include "support/markup.hpp"
#include "support/units.hpp"

namespace crankloop::program::documents_test {
namespace {

const std::filesystem::path kSource = CRANKLOOP_SOURCE_DIR;

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream stream(line.substr(0, line.find('#')));
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::string rounded(const char* format, double value) {
  std::array<char, 40> digits{};
  std::snprintf(digits.data(), digits.size(), format, value);
  return digits.data();
}

/// The commands that a document shows.
std::vector<std::string> commands_in(const std::string& document) {
  std::vector<std::string> commands;
  for (const std::string& line : lines_of(document)) {
    if (line.rfind("$ crankloop ", 0) == 0) commands.push_back(line.substr(2));
  }
  return commands;
}

/// A page, and a folder with the sample engines.
class Page : public testing::Test {
 protected:
  explicit Page(const char* name) : path_{std::string("docs/") + name}, document_{contents(kSource / path_)} {
    std::filesystem::copy(kSource / "tools/engines", folder_.path());
  }

  /// What a command of the document prints, run beside the sample engine.
  std::string output_of(const std::string& command) const {
    const std::string line = "cd '" + folder_.path() + "' && '" CRANKLOOP_PROGRAM "'" + command.substr(9);
    std::FILE* pipe = ::popen(line.c_str(), "r");
    if (pipe == nullptr) return "";
    std::string text;
    std::array<char, 4096> buffer{};
    for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) text.append(buffer.data(), n);
    EXPECT_EQ(::pclose(pipe), 0) << line;
    return text;
  }

  /// The document says these words, wherever its lines break.
  void expect_told(const std::string& words) const {
    std::string one_line;
    std::istringstream stream(document_);
    for (std::string word; stream >> word;) one_line += (one_line.empty() ? "" : " ") + word;
    EXPECT_NE(one_line.find(words), std::string::npos) << path_ << " does not say: " << words;
  }

  void expect_pictures(int count, const std::string& option = "--plot") const;

  support::TemporaryFolder folder_;
  std::string path_;
  std::string document_;
};

/// Of each command with this option the page shows the picture, as it is drawn now.
void Page::expect_pictures(int count, const std::string& option) const {
  const auto words_in = [](const std::string& svg) {
    std::vector<std::string> words;
    const support::Markup markup = support::read(svg);
    EXPECT_EQ(markup.fault, "");
    for (const char* kind : {"sheet-title", "remark", "plot-name", "name", "legend"}) {
      for (const support::Element& element : markup.of_class(kind)) words.push_back(element.text);
    }
    return words;
  };
  int pictures = 0;
  for (const std::string& command : commands_in(document_)) {
    const std::size_t at = command.find(option + " ");
    if (at == std::string::npos) continue;
    ++pictures;
    const std::string name = words_of(command.substr(at))[1];
    EXPECT_NE(document_.find("](images/" + name + ")"), std::string::npos) << name << " is not shown";
    output_of(command);
    EXPECT_EQ(words_in(contents(kSource / "docs/images" / name)), words_in(contents(folder_ / name)))
        << "docs/images/" << name << " is no longer what this draws; in tools/engines, and copy it:\n  " << command;
  }
  EXPECT_EQ(pictures, count);
}

class SeparationAndBounce : public Page {
 protected:
  SeparationAndBounce() : Page("separation_and_bounce.md") {}
};
class FeedAController : public Page {
 protected:
  FeedAController() : Page("feed_a_controller.md") {}
};
class GasExchange : public Page {
 protected:
  GasExchange() : Page("gas_exchange.md") {}
};

TEST_F(SeparationAndBounce, ShowsThePicturesThatItsCommandsDraw) { expect_pictures(2); }
TEST_F(GasExchange, ShowsThePicturesThatItsCommandsDraw) { expect_pictures(1); }
TEST_F(FeedAController, ShowsThePictureThatItsCommandDraws) { expect_pictures(1, "--cranking"); }

/// The column "model" of the table beside the measured trace, which is not part of the repository.
TEST_F(GasExchange, HasThePressuresOfTheMotoredSample) {
  const auto row = [&](const std::string& start) -> std::string {
    for (const std::string& line : lines_of(document_)) {
      if (line.rfind("| " + start + " |", 0) == 0) return line;
    }
    ADD_FAILURE() << "no row " << start;
    return "";
  };
  const std::string command = "crankloop run diesel_435_motored.ini --rpm 1800 --tick-us 20 --cycles 1 --csv run.csv";
  const std::string summary = output_of(command);
  const auto of_summary = [&](const std::string& name) {
    const std::size_t at = summary.find("\n" + name + " = ");
    return at == std::string::npos ? 0 : std::stod(summary.substr(at + name.size() + 4));
  };
  EXPECT_NE(row("max_pressure, kPa").find("| " + rounded("%.0f", of_summary("max_pressure")) + " |"),
            std::string::npos);
  EXPECT_NE(row("gross work of the closed 360 deg, kPa")
                .find("| " + rounded("%.0f", of_summary("net_mep") - of_summary("pumping_mep")) + " |"),
            std::string::npos);
  const support::Columns ticks(folder_ / "run.csv");
  const std::vector<double> deg = ticks.column("crank_deg");
  const std::vector<double> kPa = ticks.column("c1_pressure_kPa");
  for (const auto& [start, at_deg] : {std::pair("pressure at -90 deg, kPa", -90),
                                      {"at -60 deg", -60},
                                      {"at -30 deg", -30},
                                      {"at 0 deg", 0},
                                      {"at 30 deg", 30},
                                      {"at 60 deg", 60},
                                      {"at 90 deg", 90},
                                      {"pressure in the exhaust stroke, at 300 deg, kPa", 300}}) {
    std::size_t before = deg.size() - 1;  // of the two ticks around it, over the cycle's end too
    for (std::size_t i = 0; i + 1 < deg.size(); ++i) {
      if (deg[i] <= std::fmod(at_deg + 720, 720) && deg[i + 1] > std::fmod(at_deg + 720, 720)) before = i;
    }
    const std::size_t after = (before + 1) % deg.size();
    const double share = std::remainder(at_deg - deg[before], 720) / std::remainder(deg[after] - deg[before], 720);
    const double at_kPa = kPa[before] + share * (kPa[after] - kPa[before]);
    EXPECT_NE(row(start).find("| " + rounded("%.0f", at_kPa) + " |"), std::string::npos)
        << row(start) << ": " << at_kPa;
  }
}

/// What the page reads off the picture at 7000 rpm, from the ticks.
TEST_F(SeparationAndBounce, TellsTheForcesOfTheTrain) {
  const EngineFile file = read_engine_file(folder_ / "ohc_125.ini", {});
  const LoneValve valve(file, "intake");
  ValveLoop<double> loop(valve, 5e-6, {});
  ValveTickOutput<double> lowest{};
  ValveTickOutput<double> at_full_lift{};
  double compression_m = 0;
  lowest.forces.train_N = 1e9;
  run_cycles<double>(loop, valve, 7000, 4, [&](const ValveTickOutput<double>& out) {
    compression_m = std::max(compression_m, out.forces.train_compression_m);
    if (out.cam_deg > 0 && out.cam_deg < 45 && out.forces.train_N < lowest.forces.train_N) lowest = out;
    if (std::abs(out.cam_deg) < std::abs(at_full_lift.cam_deg) || at_full_lift.forces.train_N == 0) at_full_lift = out;
  });
  const double full_N = at_full_lift.forces.train_N;
  expect_told("falls to " + rounded("%.0f", lowest.forces.train_N) + " N at " + rounded("%.0f", lowest.cam_deg) +
              " deg");
  expect_told(rounded("%.0f", full_N) + " N / 11765 N/mm = " + rounded("%.3f", full_N / 11765) + " mm");
  expect_told("it is " + rounded("%.2f", compression_m * 1e3) + " mm of compression");
}

TEST_F(SeparationAndBounce, TellsHowFarTheSpringSurges) {
  const EngineFile file = read_engine_file(folder_ / "ohc_125.ini", {});
  const LoneValve valve(file, "intake");
  const auto surge = [&](double rpm) {
    return surge_over_cycle(LiftSlopes(valve.lift()), valve.valve(), rpm * support::kPi / 60);
  };
  EXPECT_NEAR(surge(7000).frequency_Hz * 120 / 7000, 7, 0.01);
  expect_told("lift's seventh harmonic meets the spring's own " + rounded("%.0f", surge(7000).frequency_Hz) + " Hz");
  expect_told("swing by " + rounded("%.0f", surge(7000).largest_N) + " N, more than the 132 N");
  expect_told("at 5000 rpm by " + rounded("%.0f", surge(5000).largest_N) + " N");
}

/// M abs(Y'') = P_s0 + k_s Y, by hand, for the speed at which a rigid train would float.
TEST_F(SeparationAndBounce, TellsWhereARigidTrainWouldFloat) {
  using support::kPi;
  const EngineFile file = read_engine_file(folder_ / "ohc_125.ini", {});
  const LoneValve valve(file, "intake");
  const Valve& v = valve.valve();
  const double lever_m = valve.lift().lever_m();
  const double mass_kg = v.valve_kg + v.spring_kg / 3 + v.rocker_inertia_kg_m2 / (lever_m * lever_m);
  double onset_rpm = 1e9;
  double onset_deg = 0;
  for (double deg = -90; deg < 90; deg += 0.01) {
    const LiftPose pose = valve.lift().at(deg * kPi / 180);
    if (!(pose.lift_m > 0 && pose.per_rad2_m < 0)) continue;
    const double cam_rad_s =
        std::sqrt((v.spring_preload_N + v.spring_N_m * pose.lift_m) / (mass_kg * -pose.per_rad2_m));
    const double engine_rpm = 2 * cam_rad_s * 30 / kPi;
    if (engine_rpm < onset_rpm) onset_rpm = engine_rpm, onset_deg = deg;
  }
  expect_told("that is at " + rounded("%.0f", onset_rpm) + " rpm and " + rounded("%.1f", onset_deg) + " deg here");
  const StaticRedline redline = valve.static_redline();
  EXPECT_NEAR(redline.crank_rad_s * 30 / kPi, onset_rpm, 0.01);
  expect_told("is " + rounded("%.2f", redline.margin(7000 * kPi / 30)) + " times what slows rigid parts down");
}

TEST_F(SeparationAndBounce, TellsWhatTheGuidesDampingTakesOffTheOnset) {
  const EngineFile file = read_engine_file(folder_ / "ohc_125.ini", {});
  const LoneValve valve(file, "intake");
  Valve free = valve.valve();
  free.guide_damping_ratio = 0;
  const auto onset_rpm = [](const LoneValve& of) {
    return sweep_speeds(of, speed_range(8500, 9060), 1, {}).separation.speed_rpm;
  };
  const double below = 1 - onset_rpm(valve) / (valve.static_redline().crank_rad_s * 30 / support::kPi);
  expect_told(rounded("%.1f", 100 * below) + " % below it");
  const std::string without = std::to_string(onset_rpm(valve.with(free))) + " rpm";
  expect_told("without it the onset is " + without);
  EXPECT_NE(contents(kSource / "docs/model.md").find("the guide's damping, " + without + " without it;"),
            std::string::npos)
      << without;
}

TEST_F(SeparationAndBounce, TellsHowFarATrainThatRingsIsBelowItsStaticRedline) {
  const EngineFile file = read_engine_file(kSource / "tools/engines/diesel_495.ini", {});
  const LoneValve valve(file, "intake");
  const int onset_rpm = sweep_speeds(valve, speed_range(2000, 2500), 1, {}).separation.speed_rpm;
  expect_told("at " + std::to_string(onset_rpm) + " rpm of " +
              rounded("%.0f", valve.static_redline().crank_rad_s * 30 / support::kPi));
  Valve damped = valve.valve();
  damped.train_damping_ratio = 0.5;
  const int damped_rpm = sweep_speeds(valve.with(damped), speed_range(3700, 4100), 1, {}).separation.speed_rpm;
  EXPECT_NE(contents(kSource / "docs/model.md").find(std::to_string(damped_rpm) + " rpm with a damping ratio of 0.5"),
            std::string::npos)
      << damped_rpm;
}

/// M y'' = k (Y - y) + b (Y' - y') + F_seat - k_s y - P_s0 - c y' with a train that pulls as well as it pushes, by
/// Runge-Kutta steps of 0.5 us over the lobe, from rest.
double largest_lift_of_a_pulling_train_mm(const LoneValve& valve, double speed_rpm) {
  const detail::ValveBody<double> body = valve.body();
  const double cam_rad_s = speed_rpm * support::kPi / 60;
  const auto slopes = [&](double cam_rad, double y, double v) {
    const LiftPose pose = valve.lift().at(cam_rad);
    const double train_N = body.train_N_m * (pose.lift_m - y) + body.train_Ns_m * (pose.per_rad_m * cam_rad_s - v);
    const double sink_m = body.preload_N / body.seat_N_m - y;
    const double seat_N = sink_m > 0 ? std::max(0.0, body.seat_N_m * sink_m - body.seat_Ns_m * v) : 0.0;
    return std::array<double, 2>{
        v, (train_N + seat_N - body.spring_N_m * y - body.preload_N - body.guide_Ns_m * v) / body.mass_kg};
  };
  constexpr double kStep_s = 0.5e-6;
  double y = 0, v = 0, most_m = 0;
  for (double t = -2.2 / cam_rad_s; t < 1.0 / cam_rad_s; t += kStep_s) {
    const auto at = [&](double later_s, const std::array<double, 2>& slope) {
      return slopes((t + later_s) * cam_rad_s, y + later_s * slope[0], v + later_s * slope[1]);
    };
    const std::array<double, 2> k1 = slopes(t * cam_rad_s, y, v);
    const std::array<double, 2> k2 = at(kStep_s / 2, k1);
    const std::array<double, 2> k3 = at(kStep_s / 2, k2);
    const std::array<double, 2> k4 = at(kStep_s, k3);
    y += kStep_s / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0]);
    v += kStep_s / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1]);
    most_m = std::max(most_m, y);
  }
  return most_m * 1e3;
}

TEST_F(SeparationAndBounce, TellsTheLiftOfATrainThatCanPull) {
  const EngineFile file = read_engine_file(folder_ / "ohc_125.ini", {});
  const LoneValve valve(file, "intake");
  expect_told("gives " + rounded("%.4f", largest_lift_of_a_pulling_train_mm(valve, 7000)) + " mm at 7000 rpm and " +
              rounded("%.4f", largest_lift_of_a_pulling_train_mm(valve, 12000)) + " mm at 12000 rpm");
}

/// 20.85 m/s over the cam's speed, and the lobe's width at that slope.
TEST_F(SeparationAndBounce, TellsWhatThePublishedSpeedWouldMean) {
  const EngineFile file = read_engine_file(folder_ / "ohc_125.ini", {});
  const LoneValve valve(file, "intake");
  const double mm_per_rad = 20.85 / (12000 * support::kPi / 60) * 1e3;
  const double lobe_deg = (valve.lift().closes_rad() - valve.lift().opens_rad()) * 180 / support::kPi;
  expect_told("is " + rounded("%.0f", mm_per_rad) + " mm per radian of the cam");
  expect_told("within " + rounded("%.0f", 7.815 / mm_per_rad * 180 / support::kPi) + " of the " +
              rounded("%.0f", lobe_deg) + " degrees");
}

/// The table's figures are those that the commands above it print.
TEST_F(SeparationAndBounce, TellsItsFiguresBesideTheThesis) {
  const auto printed = [&](int rpm, const std::string& name) {
    const std::string text =
        output_of("crankloop valve ohc_125.ini --train intake --tick-us 5 --rpm " + std::to_string(rpm));
    const std::size_t at = text.find("\n" + name + " = ");
    EXPECT_NE(at, std::string::npos) << name;
    return std::stod(text.substr(at + name.size() + 4));
  };
  for (const auto& [name, sign] : {std::pair<const char*, double>{"opening_velocity", 1}, {"closing_velocity", -1}}) {
    expect_told("| " + rounded("%.2f", sign * printed(7000, name)) + " m/s at 7000 rpm, " +
                rounded("%.2f", sign * printed(12000, name)) + " m/s at 12000 rpm |");
  }
  expect_told("| " + rounded("%.4f", printed(7000, "max_lift")) + " mm |");
  expect_told("| " + rounded("%.4f", printed(12000, "max_lift")) + " mm |");
  expect_told("| " + rounded("%.3f", printed(7000, "opening_delay")) + " and " +
              rounded("%.3f", printed(12000, "opening_delay")) + " cam deg late |");
}

class SafetyPage : public Page {
 protected:
  SafetyPage() : Page("safety.md") {}
};

/// "load ratio" is kFaultLoadRatio; empty where no fault has the bit.
std::string enumerator_of(std::uint32_t bit) {
  const char* const words = name_of(static_cast<Fault>(bit));
  if (words == nullptr) return "";
  std::string name = "kFault";
  bool starts_word = true;
  for (const char* c = words; *c != '\0'; ++c) {
    if (*c != ' ') name += starts_word ? static_cast<char>(std::toupper(*c)) : *c;
    starts_word = *c == ' ';
  }
  return name;
}

TEST_F(SafetyPage, HasAWholeRowForEachFaultBit) {
  std::vector<std::string> bits;
  for (std::uint32_t bit = 1; bit != 0; bit <<= 1) {
    if (const std::string name = enumerator_of(bit); !name.empty()) bits.push_back(name);
  }
  std::vector<std::string> rows;
  for (const std::string& line : lines_of(document_)) {
    if (line.rfind("| `kFault", 0) != 0) continue;
    rows.push_back(line.substr(3, line.find('`', 3) - 3));
    int cells = 0;
    for (std::size_t at = 0, end; (end = line.find(" |", at + 1)) != std::string::npos; at = end + 1) {
      EXPECT_GT(end - at, 2u) << "an empty cell of " << rows.back();
      ++cells;
    }
    EXPECT_EQ(cells, 5) << rows.back() << ": bit, cause, effect, told, what the application should do";
  }
  EXPECT_EQ(rows, bits);
}

}  // namespace
}  // namespace crankloop::program::documents_test

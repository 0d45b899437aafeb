// The documents' figures: every command that docs/separation_and_bounce.md shows is run, and what stands below it
// compared.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "crankloop/valve/valve_loop.hpp"
#include "support/markup.hpp"
#include "support/temporary_folder.hpp"
#include "support/units.hpp"

namespace crankloop::program {
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

/// A command of a document, and the lines that it shows of its output.
struct Quoted {
  std::string command;
  std::vector<std::string> lines;
};

std::vector<Quoted> quoted_in(const std::string& document) {
  std::vector<Quoted> quoted;
  bool fenced = false;
  for (const std::string& indented : lines_of(document)) {
    const std::string line = indented.substr(std::min(indented.find_first_not_of(' '), indented.size()));
    if (line.rfind("```", 0) == 0) {
      fenced = !fenced;
    } else if (fenced && line.rfind("$ crankloop ", 0) == 0) {
      quoted.push_back({line.substr(2), {}});
    } else if (fenced && !quoted.empty()) {
      quoted.back().lines.push_back(line);
    }
  }
  return quoted;
}

/// A word of a document is one of the program's: the same, or a number that is the program's rounded to fewer digits.
bool is_rounded(const std::string& shown, const std::string& computed) {
  if (shown == computed) return true;
  char* end = nullptr;
  const double value = std::strtod(shown.c_str(), &end);
  if (end == shown.c_str() || *end != '\0') return false;
  const double exact = std::strtod(computed.c_str(), &end);
  if (end == computed.c_str() || *end != '\0') return false;
  const std::size_t point = shown.find('.');
  const double last_digit =
      point == std::string::npos ? 1 : std::pow(10.0, -static_cast<double>(shown.size() - point - 1));
  return std::abs(value - exact) <= 0.5 * last_digit * (1 + 1e-9);
}

TEST(Rounded, IsToHalfOfTheLastDigitShown) {
  EXPECT_TRUE(is_rounded("7.785", "7.78509050968"));
  EXPECT_TRUE(is_rounded("1.20", "1.20390106201"));
  EXPECT_TRUE(is_rounded("deg", "deg"));
  EXPECT_FALSE(is_rounded("7.784", "7.78509050968"));
  EXPECT_FALSE(is_rounded("8557", "8556"));
  EXPECT_FALSE(is_rounded("mm", "um"));
  EXPECT_FALSE(is_rounded("7.8mm", "7.8"));
}

/// Words of a line are the first of another's.
bool begins(const std::vector<std::string>& shown, const std::vector<std::string>& computed) {
  return shown.size() <= computed.size() && std::equal(shown.begin(), shown.end(), computed.begin(), is_rounded);
}

class SeparationAndBounce : public testing::Test {
 protected:
  SeparationAndBounce() { std::filesystem::copy(kSource / "tools/engines/ohc_125.ini", folder_.path()); }

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
    EXPECT_NE(one_line.find(words), std::string::npos) << "docs/separation_and_bounce.md does not say: " << words;
  }

  support::TemporaryFolder folder_;
  std::string document_ = contents(kSource / "docs/separation_and_bounce.md");
};

TEST_F(SeparationAndBounce, ShowsWhatTheProgramPrints) {
  const std::vector<Quoted> all = quoted_in(document_);
  ASSERT_GE(all.size(), 5u);
  for (const Quoted& quoted : all) {
    EXPECT_FALSE(quoted.lines.empty()) << quoted.command;
    const std::vector<std::string> printed = lines_of(output_of(quoted.command));
    for (const std::string& line : quoted.lines) {
      const bool found = std::any_of(printed.begin(), printed.end(),
                                     [&](const std::string& other) { return begins(words_of(line), words_of(other)); });
      EXPECT_TRUE(found) << "docs/separation_and_bounce.md shows\n  " << line << "\nwhich is not what this prints:\n  "
                         << quoted.command;
    }
  }
}

TEST_F(SeparationAndBounce, ShowsThePicturesThatItsCommandsDraw) {
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
  for (const Quoted& quoted : quoted_in(document_)) {
    const std::size_t at = quoted.command.find("--plot ");
    if (at == std::string::npos) continue;
    ++pictures;
    const std::string name = words_of(quoted.command.substr(at))[1];
    EXPECT_NE(document_.find("](images/" + name + ")"), std::string::npos) << name << " is not shown";
    output_of(quoted.command);
    EXPECT_EQ(words_in(contents(kSource / "docs/images" / name)), words_in(contents(folder_ / name)))
        << "docs/images/" << name << " is no longer what this draws; in tools/engines, and copy it:\n  "
        << quoted.command;
  }
  EXPECT_EQ(pictures, 2);
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
}

}  // namespace
}  // namespace crankloop::program

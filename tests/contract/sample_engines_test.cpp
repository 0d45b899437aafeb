// The example that each command's help shows, on every sample engine: what a new user tries first.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

#include "crankloop/command_line/commands.hpp"
#include "support/files.hpp"

namespace crankloop::program::sample_engines_test {

void PrintTo(const Command* command, std::ostream* out) { *out << command->name; }

namespace {

const std::filesystem::path kEngines = CRANKLOOP_SOURCE_DIR "/tools/engines";

std::vector<std::string> sample_engines() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kEngines)) {
    if (entry.path().extension() == ".ini") names.push_back(entry.path().filename());
  }
  return names;
}

/// `crankloop COMMAND one.ini ...` with another engine, by the program under test.
std::string with_engine(std::string example, const std::string& engine) {
  for (const std::string& name : sample_engines()) {
    if (const std::size_t at = example.find(name); at != std::string::npos) {
      example.replace(at, name.size(), engine);
      break;
    }
  }
  return std::string("'") + CRANKLOOP_PROGRAM + "'" + example.substr(example.find(' '));
}

/// An engine with a diagram has no throttle to map, one that breathes no diagram to take forces from.
bool is_for(const Command& command, const std::string& engine) {
  std::ifstream file(kEngines / engine);
  bool breathes = false;
  for (std::string line; std::getline(file, line);) breathes = breathes || line == "source = gas";
  return command.name == kMap.name ? breathes : command.name != kForces.name || !breathes;
}

class SampleEngines : public testing::TestWithParam<const Command*> {
 protected:
  SampleEngines() { std::filesystem::copy(kEngines, folder_.path(), std::filesystem::copy_options::recursive); }

  support::TemporaryFolder folder_;
};

TEST_P(SampleEngines, GoThroughTheExampleOf) {
  ASSERT_GE(sample_engines().size(), 5U);
  for (const std::string& engine : sample_engines()) {
    std::string command = with_engine(GetParam()->example, engine);
    const std::size_t speeds = command.find("--rpm 1000:6000:6");
    if (engine.find("diesel") == 0 && speeds != std::string::npos)  // its max_rpm is 3000
      command.replace(speeds, 17, "--rpm 1000:3000:3");
    const std::string output = folder_ / "output";
    const int status = std::system(("cd '" + folder_.path() + "' && " + command + " >>'" + output + "' 2>&1").c_str());
    std::ifstream file(output);
    EXPECT_EQ(WEXITSTATUS(status), is_for(*GetParam(), engine) ? 0 : 2) << command << "\n" << file.rdbuf();
  }
}

// Those that take an engine and end by themselves; `live` has its own test.
INSTANTIATE_TEST_SUITE_P(Command, SampleEngines,
                         testing::Values(&kBalance, &kForces, &kKinematics, &kLift, &kMap, &kRedline, &kRun, &kShow,
                                         &kTables, &kValve),
                         [](const auto& command) { return std::string(command.param->name); });

}  // namespace
}  // namespace crankloop::program::sample_engines_test

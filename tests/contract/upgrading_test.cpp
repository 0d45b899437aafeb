// Engine files of 0.2.0, as docs/upgrading.md has them: its samples are read, and every key of it is a key.
//
// tests/contract/upgrading has the samples (engines/), what `crankloop show` of 0.2.0 printed of each without comments
// (shown/), and the keys of 0.2.0 (keys.txt).
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "crankloop/engine_file/engine_file.hpp"
#include "crankloop/engine_file/engine_file_keys.hpp"

namespace crankloop::program::upgrading_test {
namespace {

const std::filesystem::path kOld = CRANKLOOP_SOURCE_DIR "/tests/contract/upgrading";

/// "[cam intake] max_lift_mm" and the value.
std::map<std::string, std::string> values_in(std::istream& text) {
  std::map<std::string, std::string> values;
  std::string section;
  for (std::string line; std::getline(text, line);) {
    line = line.substr(0, line.find(" #"));
    line.erase(line.find_last_not_of(' ') + 1);
    const std::size_t equals = line.find(" = ");
    if (!line.empty() && line.front() == '[') section = line;
    if (equals != std::string::npos) values[section + " " + line.substr(0, equals)] = line.substr(equals + 3);
  }
  return values;
}

TEST(EngineFilesOf02, KeepTheValueOfEachKey) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kOld / "shown")) {
    const std::string name = entry.path().filename();
    SCOPED_TRACE(name);
    ++files;
    std::ifstream shown(entry.path());
    std::istringstream shows(show(read_engine_file(kOld / "engines" / name, {})));
    const auto today = values_in(shows);
    const auto then = values_in(shown);
    EXPECT_GT(then.size(), 60u);
    for (const auto& [key, value] : then) {
      const auto found = today.find(key);
      ASSERT_NE(found, today.end()) << key;
      EXPECT_EQ(found->second, value) << key;
    }
  }
  EXPECT_EQ(files, 5);
}

TEST(EngineFilesOf02, HaveNoKeyThatIsUnknownToday) {
  std::ifstream list(kOld / "keys.txt");
  int keys = 0;
  for (std::string section, key; list >> section >> key; ++keys)
    EXPECT_NE(find_key(section, key), nullptr) << '[' << section << "] " << key;
  EXPECT_EQ(keys, 110);
}

}  // namespace
}  // namespace crankloop::program::upgrading_test

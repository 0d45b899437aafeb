// docs/fmi.md: its table of variables is the FMU's.
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "fmu.hpp"

namespace {

TEST(FmiDocument, ListsTheVariablesThatAnFmuHas) {
  const std::string fmu_path = (std::filesystem::temp_directory_path() / "crankloop documented.fmu").string();
  const std::string make =
      "'" CRANKLOOP_PROGRAM "' fmu '" ENGINE_DIR "/diesel_495.ini' --crank torque -o '" + fmu_path + "'";
  ASSERT_EQ(std::system(make.c_str()), 0);
  const fmu::Fmu fmu(fmu_path);
  std::filesystem::remove(fmu_path);
  std::ifstream document(DOCUMENT);
  ASSERT_TRUE(document) << DOCUMENT;
  std::set<std::string> listed;
  std::string text;
  for (std::string line; std::getline(document, line); text += line + " ") {
    if (line.compare(0, 3, "| `") != 0) continue;
    std::istringstream row(line.substr(3));
    std::string name, unit, causality;
    std::getline(row, name, '`');
    std::getline(row, unit, '|');
    std::getline(row, unit, '|');
    std::getline(row, causality, '|');
    const auto trimmed = [](const std::string& cell) {
      const auto from = cell.find_first_not_of(' ');
      return from == std::string::npos ? "" : cell.substr(from, cell.find_last_not_of(' ') + 1 - from);
    };
    ASSERT_EQ(fmu.model.by_name.count(name), 1u) << name;
    const auto& variable = fmu.model.variables[fmu.model.by_name.at(name)];
    EXPECT_EQ(trimmed(unit), variable.unit) << name;
    EXPECT_EQ(trimmed(causality), variable.causality) << name;
    listed.insert(name);
  }
  std::size_t numbers = 0;
  for (const auto& variable : fmu.model.variables) {
    const bool of_file = variable.name.compare(0, 7, "engine.") == 0;
    numbers += of_file ? 1 : 0;
    const auto of_many = [&variable](const std::string& group) { return variable.name.rfind(group + "[", 0) == 0; };
    if (of_file || of_many("trigger") || of_many("faulty_trigger") || of_many("misfire")) continue;
    EXPECT_EQ(listed.count(variable.name), 1u) << variable.name << " is not in the document";
  }
  EXPECT_NE(text.find("the engine file's " + std::to_string(numbers) + " numbers"), std::string::npos) << numbers;
}

}  // namespace

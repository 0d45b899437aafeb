// Parameters of an engine file's FMU: the unit that each one states is that of its key.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "crankloop/commands/fmu/engine_source.hpp"
#include "crankloop/engine_file/engine_file.hpp"

namespace crankloop::program::fmu_parameters_test {
namespace {

const std::string kEngines = CRANKLOOP_SOURCE_DIR "/tools/engines/";

/// Of each unit of a key, one of it in SI base units; "_W_per_K" once was "_K", so that importers took a conductance
/// for a temperature.
TEST(FmuParameters, StateTheUnitsOfTheirKeys) {
  const std::map<std::string, std::pair<const char*, double>> expected = {
      {"C", {"degC", 1}},      {"cm3", {"cm3", 1e-6}},  {"mg", {"mg", 1e-6}},
      {"J_per_K", {"J/K", 1}}, {"W_per_K", {"W/K", 1}}, {"MJ_per_kg", {"MJ/kg", 1e6}},
      {"mm", {"mm", 1e-3}},    {"kPa", {"kPa", 1e3}},   {"K", {"K", 1}},
      {"g", {"g", 1e-3}}};
  std::map<std::string, int> seen;
  for (const char* engine : {"four_2000_everything.ini", "diesel_495.ini", "ohc_125.ini", "diesel_495_gas.ini"}) {
    const EngineSource source(read_engine_file(kEngines + engine, {"engine", "crank", "masses"}), 100);
    for (const EngineNumber& number : source.numbers()) {
      const std::string unit(number.key->unit.name);
      if (unit.empty()) continue;
      EXPECT_STRNE(number.unit->written, "1") << number.name << " has no unit, its key has " << unit;
      const auto known = expected.find(unit);
      if (known == expected.end()) continue;
      ++seen[unit];
      EXPECT_STREQ(number.unit->written, known->second.first) << number.name;
      EXPECT_EQ(number.unit->factor, known->second.second) << number.name;
    }
  }
  for (const char* unit : {"C", "cm3", "J_per_K", "W_per_K", "MJ_per_kg", "mm", "kPa", "g"})
    EXPECT_GT(seen[unit], 0) << unit;
}

}  // namespace
}  // namespace crankloop::program::fmu_parameters_test

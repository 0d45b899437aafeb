// What an FMU says of itself: the rules of FMI 2.0 and 3.0 that importers check, each of which has cost somebody a
// rejected FMU.
#include <cmath>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "fmu.hpp"

namespace {

using fmu::Archive;
using fmu::Element;
using fmu::Fmu;
using fmu::Model;
using fmu::VariableOfFmu;

/// A number in the metre, kilogram and second of its unit's name, worked out from the name alone.
std::map<std::string, int> exponents_by_name(const std::string& unit) {
  static const std::map<std::string, std::map<std::string, int>> kKnown = {
      {"m", {{"m", 1}}},
      {"s", {{"s", 1}}},
      {"kg", {{"kg", 1}}},
      {"K", {{"K", 1}}},
      {"rad", {{"rad", 1}}},
      {"deg", {{"rad", 1}}},
      {"mm", {{"m", 1}}},
      {"um", {{"m", 1}}},
      {"g", {{"kg", 1}}},
      {"N", {{"kg", 1}, {"m", 1}, {"s", -2}}},
      {"J", {{"kg", 1}, {"m", 2}, {"s", -2}}},
      {"W", {{"kg", 1}, {"m", 2}, {"s", -3}}},
      {"Pa", {{"kg", 1}, {"m", -1}, {"s", -2}}},
      {"kPa", {{"kg", 1}, {"m", -1}, {"s", -2}}},
      {"rpm", {{"rad", 1}, {"s", -1}}},
      {"krpm", {{"rad", 1}, {"s", -1}}},
      {"1", {}},
  };
  std::map<std::string, int> sum;
  int sign = 1;
  std::string part;
  for (std::size_t i = 0; i <= unit.size(); ++i) {
    if (i < unit.size() && unit[i] != '/' && unit[i] != '.') {
      part += unit[i];
      continue;
    }
    int power = 1;
    if (part.size() > 1 && std::isdigit(static_cast<unsigned char>(part.back())) != 0) {
      power = part.back() - '0';
      part.pop_back();
    }
    for (const auto& [base, exponent] : kKnown.at(part)) sum[base] += sign * power * exponent;
    part.clear();
    if (i < unit.size() && unit[i] == '/') sign = -1;
  }
  for (auto it = sum.begin(); it != sum.end();) it = it->second == 0 ? sum.erase(it) : std::next(it);
  return sum;
}

bool is_structured_name(const std::string& name) {
  // letters, digits and _, parts joined by dots, each with [i] or [i,j] behind it
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t from = i;
    while (i < name.size() && std::isdigit(static_cast<unsigned char>(name[i])) != 0) ++i;
    return i > from && name[from] != '0';
  };
  for (;;) {
    if (i >= name.size() || (std::isalpha(static_cast<unsigned char>(name[i])) == 0 && name[i] != '_')) return false;
    while (i < name.size() && (std::isalnum(static_cast<unsigned char>(name[i])) != 0 || name[i] == '_')) ++i;
    if (i < name.size() && name[i] == '[') {
      do {
        ++i;
        if (!digits()) return false;
      } while (i < name.size() && name[i] == ',');
      if (i >= name.size() || name[i++] != ']') return false;
    }
    if (i == name.size()) return true;
    if (name[i++] != '.') return false;
  }
}

class DescriptionOf : public testing::TestWithParam<std::tuple<const char*, int>> {
 protected:
  DescriptionOf()
      : archive_(std::string(FMU_DIR) + "/" + std::get<0>(GetParam()) + "_fmi" +
                 std::to_string(std::get<1>(GetParam())) + ".fmu"),
        model_(archive_) {}
  Archive archive_;
  Model model_;
};

TEST_P(DescriptionOf, EveryVariableSaysWhatItsKindMustSay) {
  const std::set<std::string> types = model_.version == 2 ? std::set<std::string>{"Real", "Integer", "Boolean"}
                                                          : std::set<std::string>{"Float64", "UInt32", "Boolean"};
  std::set<std::string> names;
  std::uint32_t next = 0;
  for (const VariableOfFmu& v : model_.variables) {
    SCOPED_TRACE(v.name);
    EXPECT_TRUE(types.count(v.type) == 1) << v.type;
    EXPECT_TRUE(is_structured_name(v.name));
    EXPECT_TRUE(names.insert(v.name).second) << "twice";
    EXPECT_EQ(v.reference, next++);
    EXPECT_FALSE(v.attributes.at("description").empty());
    const bool real = fmu::Unit::is_real(v);
    // The default, continuous, is not allowed for what is no Real: it is always written.
    ASSERT_FALSE(v.variability.empty());
    if (!real) {
      EXPECT_NE(v.variability, "continuous");
    }
    const bool has_start = v.attributes.count("start") != 0;
    if (v.causality == "independent") {
      EXPECT_EQ(std::tie(v.name, v.variability, v.initial), std::make_tuple("time", "continuous", ""));
      EXPECT_FALSE(has_start);
    } else if (v.causality == "input") {
      EXPECT_EQ(std::tie(v.initial, v.variability), std::make_tuple("", real ? "continuous" : "discrete"));
      EXPECT_TRUE(has_start);
    } else if (v.causality == "parameter") {
      EXPECT_EQ(std::tie(v.initial, v.variability), std::make_tuple("exact", "fixed"));
      EXPECT_TRUE(has_start);
    } else if (v.causality == "output") {
      EXPECT_EQ(v.initial, "calculated");
      EXPECT_FALSE(has_start) << "what is calculated has no start";
    } else {
      EXPECT_EQ(std::tie(v.causality, v.initial, v.variability), std::make_tuple("local", "exact", "constant"));
      EXPECT_TRUE(has_start);
    }
    if (has_start && real) {
      const double start = std::stod(v.start);
      if (v.attributes.count("min") != 0) {
        EXPECT_LE(std::stod(v.attributes.at("min")), start);
        EXPECT_LE(start, std::stod(v.attributes.at("max")));
      }
    }
    EXPECT_EQ(v.attributes.count("unit"), real ? 1u : 0u) << "every Real has a unit, nothing else has one";
  }
}

TEST_P(DescriptionOf, UnitsAreDeclaredWithTheExponentsOfTheirNames) {
  std::map<std::string, const Element*> declared;
  for (const Element& unit : model_.root.child("UnitDefinitions").children) {
    SCOPED_TRACE(unit["name"]);
    EXPECT_TRUE(declared.emplace(unit["name"], &unit).second) << "twice";
    std::map<std::string, int> exponents;
    for (const auto& [key, value] : unit.child("BaseUnit").attributes) {
      if (key != "factor") exponents[key] = std::stoi(value);
    }
    EXPECT_EQ(exponents, exponents_by_name(unit["name"]));
  }
  std::set<std::string> used;
  for (const VariableOfFmu& v : model_.variables) {
    if (!fmu::Unit::is_real(v)) continue;
    used.insert(v.unit);
    ASSERT_EQ(declared.count(v.unit), 1u) << v.name << " in " << v.unit;
    const auto display = v.attributes.find("displayUnit");
    if (display != v.attributes.end()) {
      EXPECT_EQ(declared[v.unit]->child("DisplayUnit")["name"], display->second) << v.name;
    }
  }
  EXPECT_EQ(used.size(), declared.size()) << "a unit that nothing has";
}

TEST_P(DescriptionOf, TheStructureNamesEveryOutputAndNothingElse) {
  std::vector<std::string> outputs;
  for (std::size_t i = 0; i < model_.variables.size(); ++i) {
    if (model_.variables[i].causality == "output") outputs.push_back(std::to_string(model_.version == 2 ? i + 1 : i));
  }
  ASSERT_FALSE(outputs.empty());
  const Element& structure = model_.root.child("ModelStructure");
  const auto listed = [&](const std::vector<Element>& from, const std::string& name) {
    std::vector<std::string> found;
    for (const Element& e : from) {
      if (e.name != name) continue;
      found.push_back(e[model_.version == 2 ? "index" : "valueReference"]);
      EXPECT_TRUE(e.has("dependencies") && e["dependencies"].empty()) << "an output depends on no input of its step";
    }
    return found;
  };
  if (model_.version == 2) {
    EXPECT_EQ(listed(structure.child("Outputs").children, "Unknown"), outputs);
    EXPECT_EQ(listed(structure.child("InitialUnknowns").children, "Unknown"), outputs);
  } else {
    EXPECT_EQ(listed(structure.children, "Output"), outputs);
    EXPECT_EQ(listed(structure.children, "InitialUnknown"), outputs);
  }
}

TEST_P(DescriptionOf, ItsHeadIsThatOfItsVersion) {
  const Element& root = model_.root;
  const bool two = model_.version == 2;
  EXPECT_EQ(root.name, "fmiModelDescription");
  EXPECT_EQ(root["variableNamingConvention"], "structured");
  EXPECT_FALSE(root.has("generationDateAndTime")) << "two builds would differ";
  std::vector<std::string> order;
  for (const Element& e : root.children) order.push_back(e.name);
  EXPECT_EQ(order, (std::vector<std::string>{"CoSimulation", "UnitDefinitions", "LogCategories", "DefaultExperiment",
                                             "ModelVariables", "ModelStructure"}));
  const Element& simulation = root.child("CoSimulation");
  for (const char* key :
       {"canHandleVariableCommunicationStepSize", two ? "canGetAndSetFMUstate" : "canGetAndSetFMUState",
        two ? "canSerializeFMUstate" : "canSerializeFMUState"}) {
    EXPECT_EQ(simulation[key], "true") << key;
  }
  EXPECT_EQ(simulation["canNotUseMemoryManagementFunctions"], two ? "true" : "");
  const double tick_s = std::stod(model_.variables.at(model_.by_name.at("tick_s")).start);
  if (!two) {
    EXPECT_EQ(std::stod(simulation["fixedInternalStepSize"]), tick_s);
  }
  const double steps = std::stod(root.child("DefaultExperiment")["stepSize"]) / tick_s;
  EXPECT_NEAR(steps, std::round(steps), 1e-9) << "the default step is whole ticks";
  ASSERT_EQ(model_.token.size(), 38u);
  for (const std::size_t dash : {9u, 14u, 19u, 24u}) EXPECT_EQ(model_.token[dash], '-');
  EXPECT_EQ(model_.token.front(), '{');
  EXPECT_EQ(model_.token.back(), '}');
}

TEST_P(DescriptionOf, TheArchiveHoldsWhatTheVersionAsksFor) {
  EXPECT_EQ(archive_.names.front(), "modelDescription.xml");
  EXPECT_TRUE(std::is_sorted(archive_.names.begin() + 1, archive_.names.end()));
  const std::string folder = model_.version == 2 ? "linux64/" : "x86_64-linux/";
  for (const std::string& name :
       {"binaries/" + folder + model_.identifier + ".so", std::string("sources/all.cpp"),
        std::string("documentation/index.html"), std::string("documentation/licenses/license.txt")}) {
    EXPECT_EQ(archive_.files.count(name), 1u) << name;
  }
  EXPECT_EQ(archive_.files.count("sources/buildDescription.xml"), model_.version == 3 ? 1u : 0u);
  for (const auto& [name, content] : archive_.files) {
    EXPECT_EQ(name.find('\\'), std::string::npos);
    for (const char* place : {CRANKLOOP_SOURCE_DIR, FMU_DIR})
      EXPECT_EQ(content.find(place), std::string::npos) << name << " names a place of the building machine";
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, DescriptionOf,
                         testing::Combine(testing::Values("whole", "free_running", "breathing_free", "measured_motion",
                                                          "torque_by_table", "torque_by_pressure", "four_pistons",
                                                          "trigger_wheels", "bouncing_valve"),
                                          testing::Values(2, 3)),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param)) + "_fmi" +
                                  std::to_string(std::get<1>(info.param));
                         });

}  // namespace

// What an FMU says of itself: the rules of FMI 2.0 and 3.0 that importers check, each of which has cost somebody a
// rejected FMU.
#include <cmath>
#include <cstring>
#include <set>
#include <tuple>

#include "described.hpp"

namespace {

using fmu::Element;
using fmu::VariableOfFmu;

/// A unit in metre, kilogram, second and radian, worked out from its name alone.
struct BaseUnits {
  std::map<std::string, int> exponents;
  double factor = 1;
};
BaseUnits by_name(const std::string& unit) {
  constexpr double kRpm = 3.14159265358979323846 / 30;
  static const std::map<std::string, BaseUnits> kKnown = {
      {"m", {{{"m", 1}}, 1}},
      {"s", {{{"s", 1}}, 1}},
      {"kg", {{{"kg", 1}}, 1}},
      {"K", {{{"K", 1}}, 1}},
      {"degC", {{{"K", 1}}, 1}},
      {"rad", {{{"rad", 1}}, 1}},
      {"deg", {{{"rad", 1}}, kRpm / 6}},
      {"cm", {{{"m", 1}}, 1e-2}},
      {"mm", {{{"m", 1}}, 1e-3}},
      {"um", {{{"m", 1}}, 1e-6}},
      {"g", {{{"kg", 1}}, 1e-3}},
      {"mg", {{{"kg", 1}}, 1e-6}},
      {"N", {{{"kg", 1}, {"m", 1}, {"s", -2}}, 1}},
      {"J", {{{"kg", 1}, {"m", 2}, {"s", -2}}, 1}},
      {"MJ", {{{"kg", 1}, {"m", 2}, {"s", -2}}, 1e6}},
      {"W", {{{"kg", 1}, {"m", 2}, {"s", -3}}, 1}},
      {"Pa", {{{"kg", 1}, {"m", -1}, {"s", -2}}, 1}},
      {"kPa", {{{"kg", 1}, {"m", -1}, {"s", -2}}, 1e3}},
      {"bar", {{{"kg", 1}, {"m", -1}, {"s", -2}}, 1e5}},
      {"rpm", {{{"rad", 1}, {"s", -1}}, kRpm}},
      {"krpm", {{{"rad", 1}, {"s", -1}}, kRpm * 1e3}},
      {"1", {{}, 1}},
  };
  BaseUnits sum;
  int sign = 1;
  std::string part;
  for (std::size_t i = 0; i <= unit.size(); ++i) {
    if (i < unit.size() && unit[i] != '/' && unit[i] != '.') {
      part += unit[i];
      continue;
    }
    int power = sign;
    if (part.size() > 1 && std::isdigit(static_cast<unsigned char>(part.back())) != 0) {
      power *= part.back() - '0';
      part.pop_back();
    }
    const BaseUnits& known = kKnown.at(part);
    for (const auto& [base, exponent] : known.exponents) sum.exponents[base] += power * exponent;
    sum.factor *= std::pow(known.factor, power);
    part.clear();
    if (i < unit.size() && unit[i] == '/') sign = -1;
  }
  for (auto it = sum.exponents.begin(); it != sum.exponents.end();)
    it = it->second == 0 ? sum.exponents.erase(it) : std::next(it);
  return sum;
}
/// The factor of a unit or display unit: 1 where none is written.
double factor_of(const Element& e) { return e.has("factor") ? std::stod(e["factor"]) : 1; }

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

class DescriptionOf : public fmu::Described {};

TEST_P(DescriptionOf, EveryVariableSaysWhatItsKindMustSay) {
  const std::set<std::string> types = model_.version == 2 ? std::set<std::string>{"Real", "Integer", "Boolean"}
                                                          : std::set<std::string>{"Float64", "UInt32", "Boolean"};
  std::set<std::string> names;
  std::uint32_t next = 0;
  int independent = 0;
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
      ++independent;
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
    ASSERT_EQ(v.attributes.count("min"), v.attributes.count("max"));
    if (v.attributes.count("min") != 0) {
      const double least = std::stod(v.attributes.at("min"));
      const double most = std::stod(v.attributes.at("max"));
      EXPECT_LT(least, most);
      const double start = has_start ? std::stod(v.start) : least;
      EXPECT_TRUE(least <= start && start <= most) << start;
    }
    for (const char* none : {"derivative", "reinit", "declaredType", "previous", "clocks", "nominal"})
      EXPECT_EQ(v.attributes.count(none), 0u) << none;
    EXPECT_EQ(v.attributes.count("unit"), real ? 1u : 0u) << "every Real has a unit, nothing else has one";
  }
  EXPECT_EQ(independent, 1);
}

TEST_P(DescriptionOf, UnitsAreDeclaredAsTheirNamesSay) {
  std::map<std::string, const Element*> declared;
  for (const Element& unit : model_.root.child("UnitDefinitions").children) {
    SCOPED_TRACE(unit["name"]);
    EXPECT_TRUE(declared.emplace(unit["name"], &unit).second) << "twice";
    std::map<std::string, int> exponents;
    for (const auto& [key, value] : unit.child("BaseUnit").attributes) {
      if (key != "factor" && key != "offset") exponents[key] = std::stoi(value);
    }
    EXPECT_EQ(unit.child("BaseUnit")["offset"], std::string(unit["name"] == "degC" ? "273.15" : ""));
    const BaseUnits expected = by_name(unit["name"]);
    EXPECT_EQ(exponents, expected.exponents);
    EXPECT_NEAR(factor_of(unit.child("BaseUnit")) / expected.factor, 1, 1e-14);
    std::set<std::string> displayed;
    for (const Element& display : unit.children) {
      if (display.name != "DisplayUnit") continue;
      EXPECT_TRUE(displayed.insert(display["name"]).second) << display["name"] << " twice";
      const BaseUnits shown = by_name(display["name"]);
      EXPECT_EQ(shown.exponents, expected.exponents) << display["name"];
      EXPECT_NEAR(factor_of(display) * shown.factor / expected.factor, 1, 1e-14) << display["name"];
    }
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
  const Element& experiment = root.child("DefaultExperiment");
  const double steps = std::stod(experiment["stepSize"]) / tick_s;
  EXPECT_NEAR(steps, std::round(steps), 1e-9) << "the default step is whole ticks";
  EXPECT_GE(steps * tick_s, 1e-3 * (1 - 1e-9)) << "and the shortest of a millisecond";
  EXPECT_LT(steps * tick_s, 1e-3 + tick_s * (1 - 1e-9));
  EXPECT_LT(std::stod(experiment["startTime"]), std::stod(experiment["stopTime"]));
  std::vector<std::string> categories;
  for (const Element& e : root.child("LogCategories").children) categories.push_back(e["name"]);
  EXPECT_EQ(categories, (std::vector<std::string>{"logStatusError", "logFaults"}));
  EXPECT_FALSE(root.has("numberOfEventIndicators")) << "of model exchange";
}

TEST(DefaultStep, IsTheFirstWholeNumberOfTicksFromAMillisecondOn) {
  namespace fmi = crankloop::fmi;
  for (const auto& [tick_s, step_s] : {std::pair{300e-6, 1.2e-3}, {250e-6, 1e-3}, {1.5e-3, 1.5e-3}}) {
    const std::string model = fmi::Description(fmi::Shown{tick_s, "", {}}, {"engine", ""}).model(fmi::Version::three);
    const auto at = model.find("stepSize=\"");
    ASSERT_NE(at, std::string::npos);
    EXPECT_NEAR(std::stod(model.substr(at + 10)), step_s, 1e-12) << tick_s;
  }
}

TEST_P(DescriptionOf, TheArchiveHoldsWhatTheVersionAsksFor) {
  EXPECT_EQ(archive_.names.front(), "modelDescription.xml");
  EXPECT_TRUE(std::is_sorted(archive_.names.begin() + 1, archive_.names.end()));
  const std::string folder = model_.version == 2 ? "linux64/" : "x86_64-linux/";
  for (const std::string& name :
       {"binaries/" + folder + model_.identifier + ".so", std::string("sources/README.txt"),
        std::string("documentation/index.html"), std::string("documentation/licenses/license.txt")}) {
    EXPECT_EQ(archive_.files.count(name), 1u) << name;
  }
  EXPECT_EQ(archive_.files.count("sources/buildDescription.xml"), model_.version == 3 ? 1u : 0u);
  for (const auto& [name, content] : archive_.files) {
    const std::string top = name.substr(0, name.find('/'));
    EXPECT_TRUE(std::set<std::string>({"modelDescription.xml", "binaries", "sources", "documentation", "resources"})
                    .count(top) == 1)
        << name << " is no place of FMI's";
    EXPECT_EQ(name.find('\\'), std::string::npos);
    for (const char* place : {CRANKLOOP_SOURCE_DIR, FMU_DIR})
      EXPECT_EQ(content.find(place), std::string::npos) << name << " names a place of the building machine";
  }
}

/// HTML's entities as what they stand for.
std::string unescaped(std::string text) {
  const std::pair<const char*, const char*> entities[] = {
      {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}};
  for (const auto& [entity, letter] : entities) {
    for (std::size_t at = 0; (at = text.find(entity, at)) != std::string::npos; ++at)
      text.replace(at, std::strlen(entity), letter);
  }
  return text;
}

TEST_P(DescriptionOf, ItsPageHasARowForEveryVariableAndEveryFault) {
  const std::string page = unescaped(archive_.files.at("documentation/index.html"));
  std::size_t at = 0;
  for (const VariableOfFmu& v : model_.variables) {
    const bool ranged = v.attributes.count("min") != 0;
    const std::string range = ranged ? v.attributes.at("min") + " to " + v.attributes.at("max") : "";
    const std::string row = "<tr><td>" + v.name + "</td><td>" + v.unit + "</td><td>" + v.causality + "</td><td>" +
                            range + "</td><td>" + v.attributes.at("description") + "</td></tr>";
    at = page.find(row, at);
    ASSERT_NE(at, std::string::npos) << row << " is not there, or not in its order";
  }
  const std::pair<std::uint32_t, const char*> faults[] = {
      {crankloop::kFaultNotReady, "not ready"}, {crankloop::kFaultSpeed, "speed"}, {crankloop::kFaultGas, "gas"}};
  for (const auto& [bit, name] : faults) {
    const std::string row = "<tr><td>" + std::to_string(bit) + "</td><td>" + name + "</td></tr>";
    EXPECT_NE(page.find(row, at), std::string::npos) << row;
  }
  EXPECT_EQ(page.find("<td>0</td>", at), std::string::npos) << "a fault has a bit";
}

// Both say how the sources are compiled: a file for people, and one for importers.
TEST_P(DescriptionOf, ItsReadMeCompilesWhatItsBuildDescriptionNames) {
  const std::string& command = archive_.files.at("sources/README.txt");
  EXPECT_NE(command.find("    g++ "), std::string::npos);
  EXPECT_NE(command.find(" -shared -fPIC"), std::string::npos);
  EXPECT_NE(command.find(" -o " + model_.identifier + ".so\n"), std::string::npos);
  EXPECT_NE(command.find(model_.identifier + ".dll"), std::string::npos);
  if (model_.version == 2) return;
  const Element root = fmu::XmlReader(archive_.files.at("sources/buildDescription.xml")).document();
  const Element& build = root.child("BuildConfiguration");
  EXPECT_EQ(root["fmiVersion"], "3.0");
  EXPECT_EQ(build["modelIdentifier"], model_.identifier);
  const Element& set = build.child("SourceFileSet");
  EXPECT_EQ(set["language"], "C++17");
  EXPECT_NE(command.find("g++ " + set["compilerOptions"] + " "), std::string::npos);
  std::size_t files = 0;
  for (const Element& e : set.children) {
    const std::string name = e["name"];
    if (e.name == "SourceFile") {
      ++files;
      EXPECT_EQ(archive_.files.count("sources/" + name), 1u) << name;
      EXPECT_NE(command.find(" " + name + " "), std::string::npos) << name;
    } else if (e.name == "PreprocessorDefinition") {
      EXPECT_NE(command.find(" -D" + name + "=" + e["value"] + " "), std::string::npos) << name;
    } else {
      EXPECT_EQ(e.name, "IncludeDirectory");
      EXPECT_NE(command.find(" -I" + name + " "), std::string::npos) << name;
    }
  }
  EXPECT_GT(files, 0u);
}

FMU_INSTANTIATE_DESCRIBED(DescriptionOf);

}  // namespace

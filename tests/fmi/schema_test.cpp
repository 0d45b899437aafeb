// The XML of an FMU against what the XML schemas of FMI 2.0.5 and 3.0.2 allow: elements in their order, attributes with
// their types. Of the schemas, those elements are here that an FMU has; another one is a problem until its row is
// added.
#include <regex>
#include <set>
#include <sstream>

#include "described.hpp"

namespace {

using fmu::Element;

/// attributes: "name:type", with ! where it must be there. children, in their order: "Name" once, "Name?" at most once,
/// "Name*", "Name+"; "A|B+" is either.
struct Rule {
  std::string attributes, children;
};
using Rules = std::map<std::string, Rule>;

std::vector<std::string> split(const std::string& words, char at) {
  std::vector<std::string> parts;
  std::istringstream in(words);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

/// The types of XML Schema, as far as they are used; any other word lists the values, with | between them.
bool is_of_type(const std::string& value, const std::string& type) {
  static const std::map<std::string, std::regex> kTypes = {
      {"text", std::regex("[^\n\r\t]*")},
      {"name", std::regex("[^\n\r\t]+")},
      {"bool", std::regex("true|false")},
      {"int", std::regex("[-+]?[0-9]{1,9}")},
      {"uint", std::regex("[0-9]{1,9}")},
      {"uints", std::regex("([0-9]{1,9}( [0-9]{1,9})*)?")},
      {"double", std::regex("[-+]?([0-9]+([.][0-9]*)?|[.][0-9]+)([eE][-+]?[0-9]+)?")},  // NaN and INF: of no use here
      {"date", std::regex("[0-9]{4}-[01][0-9]-[0-3][0-9]T[0-2][0-9]:[0-5][0-9]:[0-5][0-9]Z")},
      {"identifier", std::regex("[A-Za-z_][A-Za-z0-9_]*")},
      {"guid", std::regex("[{][0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}[}]")},
  };
  const auto known = kTypes.find(type);
  if (known != kTypes.end()) return std::regex_match(value, known->second);
  const std::vector<std::string> values = split(type, '|');
  return std::find(values.begin(), values.end(), value) != values.end();
}

void check_attributes(const Element& e, const Rule& rule, std::vector<std::string>& problems) {
  std::set<std::string> allowed;
  for (const std::string& one : split(rule.attributes, ' ')) {
    const std::size_t colon = one.find(':');
    const bool needed = one.back() == '!';
    const std::string name = one.substr(0, colon);
    allowed.insert(name);
    if (needed && !e.has(name)) problems.push_back("<" + e.name + "> lacks " + name);
    if (e.has(name) && !is_of_type(e[name], one.substr(colon + 1, one.size() - colon - 1 - (needed ? 1 : 0))))
      problems.push_back("<" + e.name + " " + name + "=\"" + e[name] + "\">");
  }
  for (const auto& [name, value] : e.attributes) {
    if (allowed.count(name) == 0) problems.push_back("<" + e.name + "> with " + name);
  }
}

void check_children(const Element& e, const Rule& rule, std::vector<std::string>& problems) {
  std::size_t next = 0;
  for (std::string names : split(rule.children, ' ')) {
    const char times = std::string("?*+").find(names.back()) == std::string::npos ? '1' : names.back();
    if (times != '1') names.pop_back();
    std::size_t count = 0;
    while (next < e.children.size() && is_of_type(e.children[next].name, names)) ++next, ++count;
    if ((count == 0 && (times == '1' || times == '+')) || (count > 1 && (times == '1' || times == '?')))
      problems.push_back("<" + e.name + "> with " + std::to_string(count) + " " + names);
  }
  if (next < e.children.size()) problems.push_back("<" + e.name + "> with <" + e.children[next].name + "> there");
}

std::vector<std::string> problems_of(const Element& e, const Rules& rules) {
  const auto rule = rules.find(e.name);
  if (rule == rules.end()) return {"<" + e.name + ">"};
  std::vector<std::string> problems;
  check_attributes(e, rule->second, problems);
  check_children(e, rule->second, problems);
  for (const Element& child : e.children) {
    for (const std::string& problem : problems_of(child, rules)) problems.push_back(problem);
  }
  return problems;
}

const char* const kHead =
    " modelName:name! description:text author:text version:name copyright:text license:text generationTool:name"
    " generationDateAndTime:date variableNamingConvention:flat|structured";
const char* const kVariable =
    "name:name! valueReference:uint! description:text canHandleMultipleSetPerTimeInstant:bool"
    " causality:parameter|calculatedParameter|input|output|local|independent"
    " variability:constant|fixed|tunable|discrete|continuous initial:exact|approx|calculated";
const char* const kReal =
    " declaredType:name quantity:name unit:name displayUnit:name relativeQuantity:bool min:double max:double"
    " nominal:double unbounded:bool start:double derivative:uint reinit:bool";

/// What both versions have alike.
Rules common_rules() {
  return {
      {"UnitDefinitions", {"", "Unit+"}},
      {"Unit", {"name:name!", "BaseUnit? DisplayUnit*"}},
      {"BaseUnit", {"kg:int m:int s:int A:int K:int mol:int cd:int rad:int factor:double offset:double", ""}},
      {"LogCategories", {"", "Category+"}},
      {"Category", {"name:name! description:text", ""}},
      {"DefaultExperiment", {"startTime:double stopTime:double tolerance:double stepSize:double", ""}},
  };
}
Rules rules_of_2() {
  const std::string unknown = "dependencies:uints dependenciesKind:name ";
  Rules rules = common_rules();
  rules["fmiModelDescription"] = {"fmiVersion:2.0! guid:guid! numberOfEventIndicators:0" + std::string(kHead),
                                  "ModelExchange? CoSimulation? UnitDefinitions? TypeDefinitions? LogCategories? "
                                  "DefaultExperiment? VendorAnnotations? ModelVariables ModelStructure"};
  rules["CoSimulation"] = {
      "modelIdentifier:identifier! needsExecutionTool:bool canHandleVariableCommunicationStepSize:bool "
      "canInterpolateInputs:bool maxOutputDerivativeOrder:uint canRunAsynchronuously:bool "
      "canBeInstantiatedOnlyOncePerProcess:bool canNotUseMemoryManagementFunctions:bool canGetAndSetFMUstate:bool "
      "canSerializeFMUstate:bool providesDirectionalDerivative:bool",
      "SourceFiles?"};
  rules["DisplayUnit"] = {"name:name! factor:double offset:double", ""};
  rules["ModelVariables"] = {"", "ScalarVariable+"};
  rules["ScalarVariable"] = {kVariable, "Real|Integer|Boolean|String|Enumeration Annotations?"};
  rules["Real"] = {kReal + 1, ""};
  rules["Integer"] = {"declaredType:name quantity:name min:int max:int start:int", ""};
  rules["Boolean"] = {"declaredType:name start:bool", ""};
  rules["ModelStructure"] = {"", "Outputs? Derivatives? InitialUnknowns?"};
  rules["Outputs"] = rules["InitialUnknowns"] = {"", "Unknown+"};
  rules["Unknown"] = {unknown + "index:uint!", ""};
  return rules;
}
Rules rules_of_3() {
  const std::string variable = std::string(kVariable) + " intermediateUpdate:bool previous:uint clocks:uints";
  const std::string unknown = "dependencies:uints dependenciesKind:name valueReference:uint!";
  Rules rules = common_rules();
  rules["fmiModelDescription"] = {"fmiVersion:3.0! instantiationToken:guid!" + std::string(kHead),
                                  "ModelExchange? CoSimulation? ScheduledExecution? UnitDefinitions? TypeDefinitions? "
                                  "LogCategories? DefaultExperiment? ModelVariables ModelStructure Annotations?"};
  rules["CoSimulation"] = {
      "modelIdentifier:identifier! needsExecutionTool:bool canBeInstantiatedOnlyOncePerProcess:bool "
      "canGetAndSetFMUState:bool canSerializeFMUState:bool providesDirectionalDerivatives:bool "
      "providesAdjointDerivatives:bool providesPerElementDependencies:bool canHandleVariableCommunicationStepSize:bool "
      "fixedInternalStepSize:double maxOutputDerivativeOrder:uint recommendedIntermediateInputSmoothness:int "
      "providesIntermediateUpdate:bool mightReturnEarlyFromDoStep:bool canReturnEarlyAfterIntermediateUpdate:bool "
      "hasEventMode:bool providesEvaluateDiscreteStates:bool",
      "Annotations?"};
  rules["DisplayUnit"] = {"name:name! factor:double offset:double inverse:bool", ""};
  rules["ModelVariables"] = {"", "Float64|UInt32|Boolean+"};
  rules["Float64"] = {variable + kReal, ""};
  rules["UInt32"] = {variable + " declaredType:name quantity:name min:uint max:uint start:uint", ""};
  rules["Boolean"] = {variable + " declaredType:name start:bool", ""};
  rules["ModelStructure"] = {"", "Output* ContinuousStateDerivative* ClockedState* InitialUnknown* EventIndicator*"};
  rules["Output"] = rules["InitialUnknown"] = {unknown, ""};

  rules["fmiBuildDescription"] = {"fmiVersion:3.0!", "BuildConfiguration+"};
  rules["BuildConfiguration"] = {"modelIdentifier:identifier! platform:name description:text",
                                 "SourceFileSet* Library*"};
  rules["SourceFileSet"] = {"name:name language:C++17 compiler:name compilerOptions:text",
                            "SourceFile+ PreprocessorDefinition* IncludeDirectory*"};
  rules["SourceFile"] = rules["IncludeDirectory"] = {"name:name!", ""};
  rules["PreprocessorDefinition"] = {"name:identifier! optional:bool value:name description:text", "Option*"};
  return rules;
}
Rules rules_of(int version) { return version == 2 ? rules_of_2() : rules_of_3(); }

class SchemaOf : public fmu::Described {};

TEST_P(SchemaOf, AllowsTheModelDescription) {
  EXPECT_EQ(problems_of(model_.root, rules_of(model_.version)), std::vector<std::string>());
}

TEST_P(SchemaOf, AllowsTheBuildDescriptionWhoseFilesAreThere) {
  const auto found = archive_.files.find("sources/buildDescription.xml");
  ASSERT_EQ(found != archive_.files.end(), model_.version == 3);
  if (model_.version != 3) return;
  const Element root = fmu::XmlReader(found->second).document();
  EXPECT_EQ(problems_of(root, rules_of_3()), std::vector<std::string>());
  const Element& build = root.child("BuildConfiguration");
  EXPECT_EQ(build["modelIdentifier"], model_.identifier);
  for (const Element& e : build.child("SourceFileSet").children) {
    const std::string place = "sources/" + e["name"];
    const auto at = archive_.files.lower_bound(place);
    if (e.name == "SourceFile") {
      EXPECT_EQ(archive_.files.count(place), 1u) << place;
    } else if (e.name == "IncludeDirectory") {
      EXPECT_TRUE(at != archive_.files.end() && at->first.compare(0, place.size() + 1, place + "/") == 0) << place;
    }
  }
}

FMU_INSTANTIATE_DESCRIBED(SchemaOf);

// The rules themselves: each of these mistakes is seen.
TEST(Schema, RefusesAnotherDescription) {
  const std::vector<std::tuple<int, std::string, std::string>> mistakes = {
      {2, " guid=", " instantiationToken="},
      {2, "fmiVersion=\"2.0\"", "fmiVersion=\"2.0.4\""},
      {2, "<Real unit", "<Float64 unit"},
      {2, " modelName=\"free_running\"", ""},
      {2, "canGetAndSetFMUstate", "canGetAndSetFMUState"},
      {2, "<Integer start=\"0\"", "<Integer start=\"0.5\""},
      {2, "valueReference=\"1\"", "valueReference=\"-1\""},
      {2, "<Outputs>", "<Output>"},
      {2, "variableNamingConvention=\"structured\"", "variableNamingConvention=\"dotted\""},
      {2, "modelIdentifier=\"free_running\"", "modelIdentifier=\"free running\""},
      {3, "instantiationToken=\"{", "instantiationToken=\""},
      {3, "causality=\"input\"", "causality=\"in\""},
      {3, "start=\"0\"", "start=\"inf\""},
      {3, "canSerializeFMUState=\"true\"", "canSerializeFMUState=\"yes\""},
      {3, "fixedInternalStepSize=\"1e-04\"", "fixedInternalStepSize=\"0,0001\""},
      {3, "generationTool", "generationTime"},
      {3, "    <InitialUnknown valueReference=\"8\"", "    <InitialUnknown index=\"8\""},
  };
  for (const auto& [version, from, to] : mistakes) {
    std::string xml = fmu::described("free_running", version).files.at("modelDescription.xml");
    const std::size_t at = xml.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    xml.replace(at, from.size(), to);
    if (from[0] == '<' && to.find("Output>") != std::string::npos) xml.replace(xml.find("</Outputs>"), 10, "</Output>");
    EXPECT_NE(problems_of(fmu::XmlReader(xml).document(), rules_of(version)), std::vector<std::string>()) << to;
  }
  for (const auto& [first, second] : {std::pair<const char*, const char*>{"UnitDefinitions", "LogCategories"},
                                      {"DefaultExperiment", "ModelVariables"}}) {
    Element root = fmu::XmlReader(fmu::described("free_running", 3).files.at("modelDescription.xml")).document();
    const auto place = [&root](const std::string& name) {
      return std::find_if(root.children.begin(), root.children.end(), [&](const Element& e) { return e.name == name; });
    };
    std::iter_swap(place(first), place(second));
    EXPECT_NE(problems_of(root, rules_of_3()), std::vector<std::string>()) << second << " before " << first;
  }
}

}  // namespace

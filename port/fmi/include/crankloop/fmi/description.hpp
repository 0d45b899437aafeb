// The files that describe an FMU: modelDescription.xml of FMI 2.0 and 3.0, buildDescription.xml, and a page for
// people. Made from the variables of an instance, so that they cannot differ from what get and set do.
//
// What belongs here: how the formats spell a variable. What does not: which there are (variables.hpp,
// fmi/instance.hpp). For programs that make FMUs: not for real time.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <crankloop/faults.hpp>
#include <crankloop/fmi/instance.hpp>
#include <crankloop/fmi/name.hpp>

namespace crankloop::fmi {

enum class Version : int { two = 2, three = 3 };

/// What an FMU is called.
struct Title {
  std::string identifier;  ///< a C identifier: the binary's name
  std::string engine;      ///< what it is, free text
  std::string without;     ///< what the engine has and the FMU does not step, a phrase; empty: nothing
};

/// Text in XML and HTML, in attributes too: all that is not ASCII becomes a question mark.
[[nodiscard]] inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c >= ' ' && c <= '~' ? c : '?';
    }
  }
  return out;
}

/// The fewest digits that read back as the same number, whatever the locale.
[[nodiscard]] inline std::string digits(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return std::string(text, end);
}

[[nodiscard]] inline std::string attribute(const std::string& name, const std::string& value) {
  return " " + name + "=\"" + escaped(value) + "\"";
}

/// How sources/ is compiled into the FMU's binary.
struct SourceBuild {
  std::string identifier;  ///< as Title's
  std::string flags;       ///< that the engine's bits rest on
  std::vector<std::string> include_folders;
  std::vector<std::pair<std::string, std::string>> definitions;
  std::vector<std::string> files;

  /// README.txt: the command, of GCC's.
  [[nodiscard]] std::string read_me() const {
    std::string command = "g++ " + flags + " -shared -fPIC";
    for (const auto& [name, value] : definitions) command += " -D" + name + "=" + value;
    for (const std::string& folder : include_folders) command += " -I" + folder;
    for (const std::string& file : files) command += " " + file;
    return "From source, in this folder:\n\n    " + command + " -o " + identifier + ".so\n\nFor Windows: -static and " +
           identifier + ".dll.\n";
  }

  /// buildDescription.xml, of FMI 3.
  [[nodiscard]] std::string description() const {
    std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription fmiVersion=\"3.0\">\n";
    xml += "  <BuildConfiguration" + attribute("modelIdentifier", identifier) + ">\n";
    xml += "    <SourceFileSet language=\"C++17\"" + attribute("compilerOptions", flags) + ">\n";
    for (const std::string& file : files) xml += "      <SourceFile" + attribute("name", file) + "/>\n";
    for (const auto& [name, value] : definitions)
      xml += "      <PreprocessorDefinition" + attribute("name", name) + attribute("value", value) + "/>\n";
    for (const std::string& folder : include_folders)
      xml += "      <IncludeDirectory" + attribute("name", folder) + "/>\n";
    return xml + "    </SourceFileSet>\n  </BuildConfiguration>\n</fmiBuildDescription>\n";
  }
};

/// A variable, and its value as a number.
struct ShownVariable {
  Role role;
  Variable variable;
  double value;
};

/// What the files tell of an instance: collected once, so that their text is made by the same code for every scene.
struct Shown {
  double tick_s;
  std::string token;
  std::vector<ShownVariable> variables;  ///< by value reference
};

template <class Supply>
[[nodiscard]] Shown shown(Instance<Supply>& instance) {
  Shown all{instance.tick_s(), TokenText(instance.token()).text, {}};
  instance.each([&all](Role role, const Variable& variable, auto&) { all.variables.push_back({role, variable, 0}); });
  for (std::uint32_t i = 0; i < all.variables.size(); ++i) all.variables[i].value = instance.number(i);
  return all;
}

/// The files that describe the variables, one function each.
class Description {
 public:
  Description(Shown shown, Title title) : shown_{std::move(shown)}, title_{std::move(title)} {}

  [[nodiscard]] std::string model(Version version) {
    const bool three = version == Version::three;
    const std::string state = three ? "FMUState" : "FMUstate";
    std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription";
    xml += attribute("fmiVersion", three ? "3.0" : "2.0") + attribute("modelName", title_.identifier);
    xml += attribute(three ? "instantiationToken" : "guid", shown_.token);
    xml += attribute("description", title_.engine + (title_.without.empty() ? "" : "; " + title_.without)) +
           attribute("generationTool", "crankloop " + version_text());
    xml += attribute("variableNamingConvention", "structured") + ">\n";
    xml += "  <CoSimulation" + attribute("modelIdentifier", title_.identifier);
    if (!three) xml += attribute("canNotUseMemoryManagementFunctions", "true");
    xml += attribute("canGetAndSet" + state, "true") + attribute("canSerialize" + state, "true");
    xml += attribute("canHandleVariableCommunicationStepSize", "true");
    if (three) xml += attribute("fixedInternalStepSize", digits(shown_.tick_s));
    xml += "/>\n" + units();
    xml += "  <LogCategories>\n";
    xml += "    <Category name=\"logStatusError\" description=\"Refused calls, and why\"/>\n";
    xml += "    <Category name=\"logFaults\" description=\"Steps with fault bits\"/>\n  </LogCategories>\n";
    xml += "  <DefaultExperiment startTime=\"0\" stopTime=\"1\"" + attribute("stepSize", digits(step_s())) + "/>\n";
    xml += "  <ModelVariables>\n";
    std::string unknowns;
    for (std::uint32_t reference = 0; reference < shown_.variables.size(); ++reference) {
      const auto& [role, variable, value] = shown_.variables[reference];
      xml += three ? variable_3(reference, role, variable, value) : variable_2(reference, role, variable, value);
      if (!is_output(role)) continue;
      // FMI 2 counts variables from 1, FMI 3 takes value references.
      unknowns += three ? "@" + attribute("valueReference", std::to_string(reference))
                        : "@" + attribute("index", std::to_string(reference + 1));
      unknowns += " dependencies=\"\"/>\n";
    }
    xml += "  </ModelVariables>\n  <ModelStructure>\n";
    if (three) {
      xml += replaced(unknowns, "    <Output") + replaced(unknowns, "    <InitialUnknown");
    } else {
      const std::string list = replaced(unknowns, "      <Unknown");
      xml += "    <Outputs>\n" + list + "    </Outputs>\n    <InitialUnknowns>\n" + list + "    </InitialUnknowns>\n";
    }
    return xml + "  </ModelStructure>\n</fmiModelDescription>\n";
  }

  /// documentation/index.html.
  [[nodiscard]] std::string page() {
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + escaped(title_.engine) +
        "</title>\n<style>body{font-family:sans-serif;margin:2em}td,th{text-align:left;padding:0 1em 0 0}</style>\n"
        "</head>\n<body>\n<h1>" +
        escaped(title_.engine) + "</h1>\n<p>An engine of crankloop " + version_text() + ", stepped every " +
        digits(shown_.tick_s * 1e6) +
        " &micro;s. A communication step runs the whole ticks that end in it: its inputs hold over the step, its "
        "outputs are those of the last tick, and are 0 before the first. The start values take effect when "
        "initialization ends.</p>\n" +
        (title_.without.empty() ? std::string() : "<p>Not stepped: " + escaped(title_.without) + ".</p>\n") +
        "<h2>Variables</h2>\n<table>\n<tr><th>name</th><th>unit</th><th></th><th>range</th><th>meaning</th></tr>\n";
    for (const auto& [role, variable, value] : shown_.variables) {
      html += "<tr><td>" + escaped(name_of(variable)) + "</td><td>" + written_unit(variable) + "</td><td>" +
              causality(role) + "</td><td>" +
              (has_range(variable) ? digits(variable.least) + " to " + digits(variable.most) : std::string()) +
              "</td><td>" + escaped(variable.meaning) + "</td></tr>\n";
    }
    html +=
        "</table>\n<h2>Bits of faults</h2>\n<p>Of an input: it was not finite or out of its range, and its last good "
        "value was used.</p>\n<table>\n";
    for (std::uint32_t bit = 1; bit != 0; bit <<= 1) {
      if (const char* name = crankloop::name_of(static_cast<Fault>(bit)); name != nullptr)
        html += "<tr><td>" + std::to_string(bit) + "</td><td>" + name + "</td></tr>\n";
    }
    return html + "</table>\n</body>\n</html>\n";
  }

 private:
  [[nodiscard]] static std::string version_text() {
    return std::to_string(CRANKLOOP_VERSION_MAJOR) + "." + std::to_string(CRANKLOOP_VERSION_MINOR) + "." +
           std::to_string(CRANKLOOP_VERSION_PATCH);
  }
  [[nodiscard]] static std::string replaced(const std::string& lines, const std::string& begin) {
    std::string out;
    for (const char c : lines) {
      if (c == '@') {
        out += begin;
      } else {
        out += c;
      }
    }
    return out;
  }
  [[nodiscard]] static bool has_range(const Variable& variable) noexcept { return variable.least < variable.most; }
  [[nodiscard]] static std::string written_unit(const Variable& variable) {
    return variable.kind == VariableKind::real ? unit_of(variable).written : "";
  }
  [[nodiscard]] static bool is_output(Role role) noexcept { return role == Role::output || role == Role::event; }
  [[nodiscard]] static const char* causality(Role role) noexcept {
    static constexpr const char* kNames[] = {"independent", "input", "parameter", "output", "output", "local"};
    return kNames[static_cast<int>(role)];
  }
  [[nodiscard]] static const char* variability(Role role, const Variable& variable) noexcept {
    if (role == Role::parameter) return "fixed";
    if (role == Role::constant) return "constant";
    const bool continuous = variable.kind == VariableKind::real && role != Role::event;
    return continuous ? "continuous" : "discrete";
  }

  /// 1 ms, or the first whole number of ticks that is as long.
  [[nodiscard]] double step_s() const {
    const double tick_us = shown_.tick_s * 1e6;
    return std::ceil(1000 / tick_us - 1e-6) * tick_us / 1e6;
  }

  [[nodiscard]] std::string units() {
    std::vector<const UnitOfName*> used;
    for (const ShownVariable& shown : shown_.variables) {
      if (shown.variable.kind != VariableKind::real) continue;
      const UnitOfName& unit = unit_of(shown.variable);
      const auto is_unit = [&unit](const UnitOfName* known) {
        return std::string_view(known->written) == unit.written;
      };
      if (std::none_of(used.begin(), used.end(), is_unit)) used.push_back(&unit);
    }
    std::string xml = "  <UnitDefinitions>\n";
    for (const UnitOfName* unit : used) {
      xml += "    <Unit" + attribute("name", unit->written) + ">\n      <BaseUnit";
      const auto exponent = [&xml](const char* name, int power) {
        if (power != 0) xml += attribute(name, std::to_string(power));
      };
      exponent("kg", unit->kg);
      exponent("m", unit->m);
      exponent("s", unit->s);
      exponent("K", unit->K);
      exponent("rad", unit->rad);
      if (unit->written[0] == 'V') exponent("A", -1);
      if (unit->factor != 1) xml += attribute("factor", digits(unit->factor));
      if (std::string_view(unit->written) == "degC") xml += attribute("offset", digits(273.15));
      xml += "/>\n";
      if (unit->displayed[0] != '\0') {
        xml += "      <DisplayUnit" + attribute("name", unit->displayed) +
               attribute("factor", digits(unit->displayed_per_written)) + "/>\n";
      }
      xml += "    </Unit>\n";
    }
    return xml + "  </UnitDefinitions>\n";
  }

  /// What both versions write about a variable in the same words.
  [[nodiscard]] static std::string common(std::uint32_t reference, Role role, const Variable& variable) {
    std::string xml = attribute("name", name_of(variable)) + attribute("valueReference", std::to_string(reference)) +
                      attribute("description", variable.meaning) + attribute("causality", causality(role)) +
                      attribute("variability", variability(role, variable));
    // An input and the independent variable have none: the importer gives them.
    if (role == Role::parameter || role == Role::constant) xml += attribute("initial", "exact");
    if (is_output(role)) xml += attribute("initial", "calculated");
    return xml;
  }
  /// Unit, range and start. What is calculated has no start.
  [[nodiscard]] static std::string values(Role role, const Variable& variable, double value) {
    std::string xml;
    if (variable.kind == VariableKind::real) {
      const UnitOfName& unit = unit_of(variable);
      xml += attribute("unit", unit.written);
      if (unit.displayed[0] != '\0') xml += attribute("displayUnit", unit.displayed);
      if (has_range(variable))
        xml += attribute("min", digits(variable.least)) + attribute("max", digits(variable.most));
    }
    if (is_output(role) || role == Role::independent) return xml;
    if (variable.kind == VariableKind::truth) return xml + attribute("start", value != 0 ? "true" : "false");
    return xml + attribute("start", digits(value));
  }
  [[nodiscard]] static std::string variable_2(std::uint32_t reference, Role role, const Variable& variable,
                                              double value) {
    static constexpr const char* kTypes[] = {"Real", "Integer", "Boolean"};
    return "    <ScalarVariable" + common(reference, role, variable) + ">\n      <" +
           kTypes[static_cast<int>(variable.kind)] + values(role, variable, value) + "/>\n    </ScalarVariable>\n";
  }
  [[nodiscard]] static std::string variable_3(std::uint32_t reference, Role role, const Variable& variable,
                                              double value) {
    static constexpr const char* kTypes[] = {"Float64", "UInt32", "Boolean"};
    return "    <" + std::string(kTypes[static_cast<int>(variable.kind)]) + common(reference, role, variable) +
           values(role, variable, value) + "/>\n";
  }

  Shown shown_;
  Title title_;
};

}  // namespace crankloop::fmi

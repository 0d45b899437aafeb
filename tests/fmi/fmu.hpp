// An FMU as tests use it: its variables by name, its shared object loaded, an instance of it.
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "archive.hpp"
#include "importer.h"

namespace fmu {

struct VariableOfFmu {
  std::string name, type, causality, variability, initial, start, unit;
  std::uint32_t reference = 0;
  std::map<std::string, std::string> attributes;  ///< all, the type's included
};

/// The model description, as far as an importer needs it.
class Model {
 public:
  explicit Model(const Archive& archive) : root(XmlReader(archive.files.at("modelDescription.xml")).document()) {
    version = root["fmiVersion"] == "2.0" ? 2 : 3;
    token = root[version == 2 ? "guid" : "instantiationToken"];
    identifier = root.child("CoSimulation")["modelIdentifier"];
    for (const Element& e : root.child("ModelVariables").children) {
      Element all = e;
      if (version == 2) {
        demand(e.name == "ScalarVariable" && e.children.size() == 1, "a variable of one type");
        all.name = e.children[0].name;
        all.attributes.insert(e.children[0].attributes.begin(), e.children[0].attributes.end());
      }
      const auto reference = static_cast<std::uint32_t>(std::stoul(all["valueReference"]));
      variables.push_back({all["name"], all.name, all["causality"], all["variability"], all["initial"], all["start"],
                           all["unit"], reference, all.attributes});
      by_name[all["name"]] = reference;
    }
  }

  Element root;
  int version = 0;
  std::string token, identifier;
  std::vector<VariableOfFmu> variables;  ///< in their order
  std::map<std::string, std::uint32_t> by_name;
};

/// Where this platform's binary lies in an archive.
#if defined(_WIN32)
inline constexpr const char* kFolderOf2 = "win64";
inline constexpr const char* kFolderOf3 = "x86_64-windows";
inline constexpr const char* kSuffix = ".dll";
#else
inline constexpr const char* kFolderOf2 = "linux64";
inline constexpr const char* kFolderOf3 = "x86_64-linux";
inline constexpr const char* kSuffix = ".so";
#endif

/// The folder of an unpacked archive, gone with it. Its name has a blank and a letter beyond ASCII: users' folders do.
class Unpacked {
 public:
  explicit Unpacked(const Archive& archive) {
    static int count = 0;
    folder =
        std::filesystem::temp_directory_path() /
        std::filesystem::u8path("crankloop f\xC3\xBCr " + std::to_string(::getpid()) + " " + std::to_string(count++));
    for (const auto& [name, content] : archive.files) {
      const std::filesystem::path path = folder / name;
      std::filesystem::create_directories(path.parent_path());
      std::ofstream(path, std::ios::binary) << content;
    }
  }
  ~Unpacked() { std::filesystem::remove_all(folder); }
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;

  std::filesystem::path folder;
};

/// An FMU: archive, description, shared object.
class Fmu {
 public:
  explicit Fmu(const std::string& path) : archive(path), model(archive), unpacked(archive) {
    const std::string folder = model.version == 2 ? kFolderOf2 : kFolderOf3;
    const auto object = unpacked.folder / "binaries" / folder / (model.identifier + kSuffix);
    importer = importer_load(object.u8string().c_str(), model.version);
    demand(importer != nullptr, path + " cannot be loaded");
  }
  ~Fmu() {
    if (importer != nullptr) importer_unload(importer);
  }
  Fmu(const Fmu&) = delete;
  Fmu& operator=(const Fmu&) = delete;

  [[nodiscard]] std::string resources() const { return (unpacked.folder / "resources" / "").u8string(); }

  Archive archive;
  Model model;
  Unpacked unpacked;
  ::importer* importer = nullptr;
};

/// An instance. Setters and getters by name: they fail the test where the FMU refuses.
class Unit {
 public:
  explicit Unit(const Fmu& fmu, const std::string& token = "") : fmu_{fmu} {
    const std::string& right = token.empty() ? fmu.model.token : token;
    unit = unit_create(fmu.importer, "a unit", right.c_str(), fmu.resources().c_str());
  }
  ~Unit() {
    if (unit != nullptr) unit_free(unit);
  }
  Unit(const Unit&) = delete;
  Unit& operator=(const Unit&) = delete;

  /// Through initialization.
  void start(double start_s = 0) {
    ASSERT_NE(unit, nullptr) << importer_message();
    ASSERT_EQ(unit_setup(unit, start_s), UNIT_OK);
    ASSERT_EQ(unit_begin(unit), UNIT_OK);
    ASSERT_EQ(unit_start(unit), UNIT_OK) << importer_message();
  }
  void step(double time_s, double step_s) { ASSERT_EQ(unit_step(unit, time_s, step_s), UNIT_OK) << importer_message(); }

  void set(const std::string& name, double value) const {
    const std::uint32_t which = fmu_.model.by_name.at(name);
    const VariableOfFmu& variable = fmu_.model.variables.at(which);
    const auto whole = static_cast<std::uint32_t>(value >= 0 && value < 4e9 ? value : 0);
    const int truth = value != 0 ? 1 : 0;
    const int status = is_real(variable)    ? unit_set_real(unit, &which, 1, &value)
                       : is_truth(variable) ? unit_set_truth(unit, &which, 1, &truth)
                                            : unit_set_whole(unit, &which, 1, &whole);
    ASSERT_EQ(status, UNIT_OK) << name << ": " << importer_message();
  }
  [[nodiscard]] double get(const std::string& name) const {
    const std::uint32_t which = fmu_.model.by_name.at(name);
    return all(which, which + 1).at(0);
  }
  /// The values of all variables, or of some in a row.
  [[nodiscard]] std::vector<double> all(std::uint32_t from = 0, std::uint32_t to = ~0u) const {
    std::vector<double> values;
    const std::uint32_t end = std::min(to, static_cast<std::uint32_t>(fmu_.model.variables.size()));
    for (std::uint32_t which = from; which < end; ++which) {
      const VariableOfFmu& variable = fmu_.model.variables[which];
      double real = 0;
      std::uint32_t whole = 0;
      int truth = 0;
      const int status = is_real(variable)    ? unit_get_real(unit, &which, 1, &real)
                         : is_truth(variable) ? unit_get_truth(unit, &which, 1, &truth)
                                              : unit_get_whole(unit, &which, 1, &whole);
      EXPECT_EQ(status, UNIT_OK) << variable.name << ": " << importer_message();
      values.push_back(is_real(variable) ? real : is_truth(variable) ? truth : whole);
    }
    return values;
  }
  [[nodiscard]] std::vector<unsigned char> saved() const {
    void* state = nullptr;
    std::size_t size = 0;
    EXPECT_EQ(unit_get_state(unit, &state), UNIT_OK) << importer_message();
    EXPECT_EQ(unit_state_size(unit, state, &size), UNIT_OK);
    std::vector<unsigned char> bytes(size);
    EXPECT_EQ(unit_write_state(unit, state, bytes.data(), size), UNIT_OK);
    EXPECT_EQ(unit_free_state(unit, &state), UNIT_OK);
    EXPECT_EQ(state, nullptr);
    return bytes;
  }
  /// The answer of the first call that refuses them.
  [[nodiscard]] int restore(const std::vector<unsigned char>& bytes) const {
    void* state = nullptr;
    if (const int read = unit_read_state(unit, bytes.data(), bytes.size(), &state); read != UNIT_OK) return read;
    const int set = unit_set_state(unit, state);
    EXPECT_EQ(unit_free_state(unit, &state), UNIT_OK);
    return set;
  }

  [[nodiscard]] const std::map<std::string, std::uint32_t>& names() const { return fmu_.model.by_name; }

  [[nodiscard]] static bool is_real(const VariableOfFmu& v) { return v.type == "Real" || v.type == "Float64"; }
  [[nodiscard]] static bool is_truth(const VariableOfFmu& v) { return v.type == "Boolean"; }

  ::unit* unit = nullptr;

 private:
  const Fmu& fmu_;
};

}  // namespace fmu

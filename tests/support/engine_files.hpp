// Engine files that tests write, read and compare.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdio>
#include <fstream>
#include <string>
#include <type_traits>

#include <crankloop/define/engine_definition.hpp>

#include "crankloop/engine_file/engine_file.hpp"
#include "crankloop/files/error.hpp"
#include "support/files.hpp"

namespace crankloop::program {

using support::kSample;

using support::contents;

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto place = text.find(what);
  EXPECT_NE(place, std::string::npos) << what;
  return place == std::string::npos ? text : text.replace(place, what.size(), by);
}

inline std::string angle_table() {
  std::string table = "# measured\ncrank_deg, pressure_kPa\r\n\n";
  for (int angle = -360; angle < 360; angle += 2)
    table += std::to_string(angle) + " , " + std::to_string(100 + angle % 7) + "\n";
  return table;
}

class EngineFileTest : public testing::Test {
 protected:
  /// A file of that name is removed first: ext4 waits for its disk where one is written over.
  std::string write(const std::string& name, const std::string& text) const {
    const std::string path = folder_ / name;
    std::remove(path.c_str());
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  EngineFile read(const std::string& text) const { return read_engine_file(write("engine.ini", text), {}); }
  std::string refusal(const std::string& text) const {
    try {
      static_cast<void>(read(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  support::TemporaryFolder folder_;
};

inline constexpr const char* kOneCylinder =
    "[engine]\nname = single\nrated_rpm = 3000\n"
    "[crank]\nbore_mm = 95\nstroke_mm = 115\nrod_length_mm = 210\ncompression_ratio = 19\n";

/// Every field of two definitions, with the rows that tables have.
struct ExpectSame {
  template <class Field>
  void operator()(const ListedField& listed, const Field& a, const Field& b) const {
    if constexpr (std::is_same_v<Field, const DiagramPoint*> || std::is_same_v<Field, const CamPoint*>) {
      for (int i = 0; i < listed.read; ++i) {
        const auto& [a_at, a_value] = a[i];
        const auto& [b_at, b_value] = b[i];
        EXPECT_EQ(a_at, b_at) << listed.name << " row " << i;
        EXPECT_EQ(a_value, b_value) << listed.name << " row " << i;
      }
    } else if constexpr (std::is_array_v<Field>) {
      for (std::size_t i = 0; i < std::extent_v<Field>; ++i) (*this)(listed, a[i], b[i]);
    } else if constexpr (kHasFields<Field>) {
      Field::each_field(*this, a, b);
    } else {
      EXPECT_EQ(a, b) << listed.name;
    }
  }
};
inline void expect_same(const EngineDefinition& a, const EngineDefinition& b) { ExpectSame{}({1, ""}, a, b); }

}  // namespace crankloop::program

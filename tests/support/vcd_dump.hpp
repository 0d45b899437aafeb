// A small reader of value change dumps, written from the standard (IEEE 1364, clause 18) and not from our writer.
//
// What belongs here: what a viewer would know of a file. What does not: what it ought to say.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace crankloop::program {

/// What a viewer would know of a dump.
struct Dump {
  struct Change {
    long long time_ns;
    std::string name;
    double value;
  };
  std::map<std::string, std::string> name_of;  ///< by code
  std::map<std::string, std::string> type_of;  ///< by name
  std::string scope;
  std::string timescale;
  std::vector<Change> changes;
  long long end_ns = -1;
};

inline Dump read_dump(const std::string& path) {
  Dump dump;
  std::ifstream file(path);
  const auto until_end = [&file] {
    std::vector<std::string> words;
    for (std::string word; file >> word && word != "$end";) words.push_back(word);
    return words;
  };
  for (std::string token; file >> token;) {
    if (token == "$timescale") {
      for (const std::string& word : until_end()) dump.timescale += word;
    } else if (token == "$scope") {
      dump.scope = until_end().at(1);
    } else if (token == "$var") {
      const std::vector<std::string> words = until_end();
      EXPECT_EQ(words.size(), 4u);
      EXPECT_EQ(words.at(0) == "wire" ? "1" : "64", words.at(1));
      EXPECT_TRUE(dump.name_of.emplace(words.at(2), words.at(3)).second) << "two variables of one code";
      dump.type_of[words.at(3)] = words.at(0);
    } else if (token[0] == '$') {
      until_end();
    } else if (token[0] == '#') {
      const long long time_ns = std::atoll(token.c_str() + 1);
      EXPECT_GT(time_ns, dump.end_ns) << "times rise";
      dump.end_ns = time_ns;
    } else if (token[0] == 'r') {
      std::string code;
      file >> code;
      dump.changes.push_back({dump.end_ns, dump.name_of.at(code), std::atof(token.c_str() + 1)});
      EXPECT_EQ(dump.type_of.at(dump.changes.back().name), "real");
    } else {
      EXPECT_TRUE(token[0] == '0' || token[0] == '1') << token;
      dump.changes.push_back({dump.end_ns, dump.name_of.at(token.substr(1)), token[0] == '1' ? 1.0 : 0.0});
      EXPECT_EQ(dump.type_of.at(dump.changes.back().name), "wire");
    }
  }
  return dump;
}

}  // namespace crankloop::program

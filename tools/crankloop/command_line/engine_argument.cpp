#include "engine_argument.hpp"

#include <cstdio>
#include <utility>

#include "../engine_file/following_springs.hpp"
#include "../engine_file/plausibility.hpp"
#include "gas_options.hpp"

namespace crankloop::program {

std::vector<std::string> tell_warnings(const Arguments& arguments, std::vector<std::string> warnings) {
  if (arguments.has(kNoWarnings.name)) return {};
  for (const std::string& line : warnings) std::fprintf(stderr, "%s\n", line.c_str());
  return warnings;
}

EngineFile read_engine(const Arguments& arguments, const std::vector<std::string>& needed_sections,
                       std::vector<std::string>* warnings) {
  EngineFile engine = read_engine_file(arguments.file(), needed_sections);
  std::vector<std::string> lines = warnings_about(engine);
  for (std::string& line : warnings_about_gas_options(arguments, engine)) lines.push_back(std::move(line));
  std::vector<std::string> told = tell_warnings(arguments, std::move(lines));
  if (warnings != nullptr) *warnings = std::move(told);
  return engine;
}

EngineFile read_engine_for_scenes(const Arguments& arguments, const std::vector<std::string>& needed_sections,
                                  std::vector<std::string>* warnings) {
  EngineFile engine = read_engine(arguments, needed_sections, warnings);
  const std::vector<std::string> told = tell_warnings(arguments, warnings_about_springs_that_follow(engine));
  if (warnings != nullptr) warnings->insert(warnings->end(), told.begin(), told.end());
  return engine;
}

}  // namespace crankloop::program

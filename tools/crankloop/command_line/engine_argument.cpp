#include "engine_argument.hpp"

#include <cstdio>
#include <utility>

#include "../engine_file/plausibility.hpp"

namespace crankloop::program {

std::vector<std::string> tell_warnings(const Arguments& arguments, std::vector<std::string> warnings) {
  if (arguments.has(kNoWarnings.name)) return {};
  for (const std::string& line : warnings) std::fprintf(stderr, "%s\n", line.c_str());
  return warnings;
}

EngineFile read_engine(const Arguments& arguments, const std::vector<std::string>& needed_sections,
                       std::vector<std::string>* warnings) {
  EngineFile engine = read_engine_file(arguments.file(), needed_sections);
  std::vector<std::string> told = tell_warnings(arguments, warnings_about(engine));
  if (warnings != nullptr) *warnings = std::move(told);
  return engine;
}

EngineFile read_engine_without_surge(const Arguments& arguments, const std::vector<std::string>& needed_sections,
                                     std::vector<std::string>* warnings) {
  EngineFile engine = read_engine(arguments, needed_sections, warnings);
  std::vector<std::string> lines;
  for (const std::string& train : engine.let_springs_follow()) {
    lines.push_back(engine.path() + ": warning: [valve " + train +
                    "] surge_modes: springs follow their valves in this command; `crankloop valve` and `crankloop "
                    "redline` step their surge");
  }
  lines = tell_warnings(arguments, std::move(lines));
  if (warnings != nullptr) warnings->insert(warnings->end(), lines.begin(), lines.end());
  return engine;
}

}  // namespace crankloop::program

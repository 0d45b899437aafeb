#include "results.hpp"

#include <cstdio>

namespace crankloop::program {

Results::Results(const Arguments& arguments, std::initializer_list<const char*> options) {
  for (const char* option : options) {
    if (!arguments.has(option)) continue;
    files_.emplace(option, Output(arguments.text(option)));
    output_taken_ = output_taken_ || arguments.text(option) == "-";
  }
}

Output* Results::operator[](const std::string& option) {
  const auto found = files_.find(option);
  return found == files_.end() ? nullptr : &found->second;
}

void Results::finish(const std::string& summary) {
  for (auto& [option, file] : files_) file.finish();
  if (output_taken_) {
    std::fputs(summary.c_str(), stderr);
  } else {
    print(summary);
  }
}

}  // namespace crankloop::program

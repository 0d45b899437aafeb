#include "results.hpp"

#include <cstdio>

namespace crankloop::program {

Results::Results(const Arguments& arguments, std::initializer_list<const char*> options) {
  for (const char* option : options) {
    if (!arguments.has(option)) continue;
    const Output& file = files_.emplace(option, Output(arguments.text(option))).first->second;
    output_taken_ = output_taken_ || file.is_standard();
  }
}

Output* Results::operator[](const std::string& option) {
  const auto found = files_.find(option);
  return found == files_.end() ? nullptr : &found->second;
}

void Results::finish(const std::string& summary) {
  for (auto& [option, file] : files_) file.finish();
  print_summary(summary, output_taken_);
}

void print_summary(const std::string& summary, bool output_taken) {
  if (output_taken) {
    std::fputs(summary.c_str(), stderr);
  } else {
    print(summary);
  }
}

}  // namespace crankloop::program

// Where a command's results go: files that its options name, and a summary.
//
// What belongs here: opening and finishing them together. What does not: what is written (csv.hpp, report/,
// summary.hpp).
#pragma once

#include <initializer_list>
#include <map>
#include <string>

#include "../files/output_file.hpp"
#include "arguments.hpp"

namespace crankloop::program {

/// Opened before anything is computed: a place that cannot be written to is reported at once, not after minutes.
///
///     Results results(arguments, {"--csv", "--report"});
///     if (Output* csv = results["--csv"]) write(*csv);
///     results.finish(summary);
class Results {
 public:
  Results(const Arguments& arguments, std::initializer_list<const char*> options);

  /// Null where the user did not request it.
  [[nodiscard]] Output* operator[](const std::string& option);

  /// All files appear, and the summary is printed: on standard output, or on stderr where a file has taken that.
  void finish(const std::string& summary);

 private:
  std::map<std::string, Output> files_;
  bool output_taken_ = false;
};

/// On standard output, or on stderr where a file has taken that.
void print_summary(const std::string& summary, bool output_taken);

}  // namespace crankloop::program

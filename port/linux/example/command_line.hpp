// The command line of an example: the path of a block, and options that each have a value.
//
// What belongs here: words and numbers. What does not: what an option means.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace crankloop::port::example {

class BadCommandLine : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws BadCommandLine for what is not understood: nothing is guessed. Of an option given twice the last one counts.
class CommandLine {
 public:
  CommandLine(int count, char** words, std::initializer_list<const char*> options) {
    for (int i = 1; i < count; ++i) {
      const std::string word = words[i];
      if (word.rfind("-", 0) != 0) {
        if (!path_.empty()) throw BadCommandLine(word + ": the path is " + path_ + " already");
        path_ = word;
      } else if (std::find(options.begin(), options.end(), word) == options.end()) {
        throw BadCommandLine(word + ": is no option");
      } else if (++i == count) {
        throw BadCommandLine(word + ": its value is missing");
      } else {
        values_[word] = words[i];
      }
    }
    if (path_.empty()) throw BadCommandLine("the path of a block is missing");
  }

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] bool has(const std::string& option) const { return values_.count(option) > 0; }
  [[nodiscard]] std::string text(const std::string& option) const { return has(option) ? values_.at(option) : ""; }

  [[nodiscard]] double number(const std::string& option, double fallback, double least, double most) const {
    return has(option) ? parse(option, text(option), least, most) : fallback;
  }
  [[nodiscard]] int whole_number(const std::string& option, int fallback, double most) const {
    return has(option) ? static_cast<int>(parse_whole(option, text(option), most)) : fallback;
  }
  /// None where the option was not given.
  [[nodiscard]] std::vector<std::uint32_t> whole_numbers(const std::string& option, char separator, double most) const {
    std::vector<std::uint32_t> numbers;
    const std::string all = text(option);
    for (std::size_t begin = 0, end = 0; has(option) && end < all.size(); begin = end + 1) {
      end = std::min(all.find(separator, begin), all.size());
      numbers.push_back(static_cast<std::uint32_t>(parse_whole(option, all.substr(begin, end - begin), most)));
    }
    return numbers;
  }

 private:
  static double parse(const std::string& option, const std::string& text, double least, double most) {
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || *end != '\0' || !(number >= least && number <= most)) {
      char range[64];
      std::snprintf(range, sizeof range, "%.10g to %.10g", least, most);
      throw BadCommandLine(option + ": '" + text + "' is no number from " + range);
    }
    return number;
  }
  static double parse_whole(const std::string& option, const std::string& text, double most) {
    const double number = parse(option, text, 0, most);
    if (number != std::floor(number)) throw BadCommandLine(option + ": '" + text + "' is no whole number");
    return number;
  }

  std::string path_;
  std::map<std::string, std::string> values_;
};

}  // namespace crankloop::port::example

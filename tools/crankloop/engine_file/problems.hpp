// Independent errors of an engine file, reported together.
//
//     Problems problems;
//     for (const Line& line : lines) problems.of([&] { read(line); });
//     problems.refuse(path);
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "../files/error.hpp"
#include "../files/words.hpp"

namespace crankloop::program {

/// Of lines that begin with `path`, without the line numbers behind it: of a text that the user does not have.
[[nodiscard]] inline std::string without_line_numbers(std::string text, const std::string& path) {
  for (std::size_t at = 0; (at = text.find(path + ":", at)) != std::string::npos;) {
    at += path.size();
    const std::size_t end = text.find_first_not_of("0123456789", at + 1);
    if (end < text.size() && text[end] == ':') text.erase(at, end - at);
  }
  return text;
}

class Problems {
 public:
  /// Runs it; false if it throws an InputError, which is recorded, also one of several lines.
  template <class Work>
  bool of(Work&& work) {
    try {
      work();
      return true;
    } catch (const InputError& error) {
      for (const std::string_view line : split(error.what(), '\n')) lines_.emplace_back(line);
    }
    return false;
  }

  /// Throws the recorded errors, if there are any.
  void refuse(const std::string& path) {
    if (lines_.empty()) return;
    if (lines_.size() > kMaxLines) {
      const std::size_t left_out = lines_.size() - (kMaxLines - 1);
      lines_.resize(kMaxLines - 1);
      lines_.push_back(path + ": " + std::to_string(left_out) + " errors more");
    }
    throw InputError(join(lines_, "\n"));
  }

 private:
  static constexpr std::size_t kMaxLines = 20;
  std::vector<std::string> lines_;
};

}  // namespace crankloop::program

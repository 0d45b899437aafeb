// The command line of one subcommand: declared as data, checked before the command runs.
//
// What belongs here: options and their values. What does not: their effect.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "../files/number.hpp"

namespace crankloop::program {

/// One option as a command declares it; make it with one of the functions below.
struct Option {
  enum class Kind { flag, number, whole_number, choice, text, words };

  const char* name;  ///< "--rpm"
  Kind kind;
  const char* value;               ///< name of the value in the usage line, "N"; for a choice "table|exact|approx"
  const char* meaning;             ///< half a line, with the unit
  const char* fallback = nullptr;  ///< the value if the option is not given; nullptr: none
  Range range{};
  bool is_required = false;  ///< the command cannot run without it
};

[[nodiscard]] constexpr Option flag(const char* name, const char* meaning) noexcept {
  return {name, Option::Kind::flag, nullptr, meaning};
}
[[nodiscard]] constexpr Option number(const char* name, const char* value, Range range, const char* meaning,
                                      const char* fallback = nullptr) noexcept {
  return {name, Option::Kind::number, value, meaning, fallback, range};
}
[[nodiscard]] constexpr Option whole_number(const char* name, const char* value, Range range, const char* meaning,
                                            const char* fallback = nullptr) noexcept {
  return {name, Option::Kind::whole_number, value, meaning, fallback, range};
}
[[nodiscard]] constexpr Option choice(const char* name, const char* choices, const char* meaning,
                                      const char* fallback = nullptr) noexcept {
  return {name, Option::Kind::choice, choices, meaning, fallback};
}
[[nodiscard]] constexpr Option text(const char* name, const char* value, const char* meaning,
                                    const char* fallback = nullptr) noexcept {
  return {name, Option::Kind::text, value, meaning, fallback};
}

/// One word or more, up to the next option; may be given again for more.
[[nodiscard]] constexpr Option words(const char* name, const char* value, const char* meaning) noexcept {
  return {name, Option::Kind::words, value, meaning};
}

[[nodiscard]] constexpr Option required(Option option) noexcept {
  option.is_required = true;
  return option;
}

/// Common options of all commands that take an engine file.
inline constexpr Option kNoWarnings = flag("--no-warnings", "suppress plausibility warnings");

class Arguments;
class EngineFile;
class Summary;

/// A command's options, from an array or none.
struct Options {
  const Option* first = nullptr;
  std::size_t count = 0;

  constexpr Options() noexcept = default;
  template <std::size_t N>
  constexpr Options(const Option (&options)[N]) noexcept
      : first{options}, count{N} {}  // NOLINT: converts from any array of options

  [[nodiscard]] constexpr const Option* begin() const noexcept { return first; }
  [[nodiscard]] constexpr const Option* end() const noexcept { return first + count; }
};

struct Command {
  const char* name;
  const char* summary;  ///< one line, shown in the list of commands
  const char* usage;    ///< what follows the name: "FILE --rpm N [--csv F]"
  const char* example;  ///< a complete command line that works in the folder of the sample engines
  std::size_t files;    ///< how many file names it takes
  Options options;
  int (*run)(const Arguments&);  ///< returns an ExitStatus; throws the types of error.hpp
  bool for_developers = false;   ///< of crankloop: listed last

  /// What the command prints of an engine, without any output; null: nothing that `study` could read. May be called by
  /// several threads at once; throws as `run` does. The file is that of the arguments, perhaps with other values.
  Summary (*figures)(const Arguments&, const EngineFile&) = nullptr;
};

/// The command's own options and the common ones.
[[nodiscard]] std::vector<Option> options_of(const Command& command);

/// What the user asked for, as `--name value`, `--name=value`, `--flag`, and files in between; `--` ends the options,
/// `-o` is --output, which is --out too.
class Arguments {
 public:
  /// Throws UsageError for an option that is unknown, doubled, without its value, with a value out of its range, for
  /// files that are missing or too many, and for all required options that are missing.
  Arguments(const Command& command, const std::vector<std::string>& words);

  [[nodiscard]] const std::string& file(std::size_t index = 0) const { return files_.at(index); }
  [[nodiscard]] bool has(std::string_view option) const;  ///< given by the user; a fallback does not count

  /// Throws UsageError where the user gave `option` without `other`, without which it would do nothing.
  void require_with(std::string_view option, std::string_view other) const;

  /// Throws UsageError where the user gave `option` and one of `others`.
  void refuse_with(std::string_view option, std::initializer_list<std::string_view> others) const;

  /// Given or fallback value. An option that has neither is reported to the user as missing.
  [[nodiscard]] double number(std::string_view option) const;
  [[nodiscard]] int whole_number(std::string_view option) const;
  [[nodiscard]] const std::string& text(std::string_view option) const;         ///< also choices
  [[nodiscard]] std::vector<std::string> words(std::string_view option) const;  ///< none where it was not given

  /// text(option), or "" if it was not given: what Output wants for an optional --csv.
  [[nodiscard]] std::string text_or_empty(std::string_view option) const;

 private:
  struct Given {
    const Option* option = nullptr;
    std::string text;
    double number = 0;
    bool by_user = false;
    std::vector<std::string> words{};
  };
  void set(const Option& option, std::string_view value, bool by_user);
  void require(const Command& command) const;
  [[nodiscard]] const Given& get(std::string_view option) const;

  std::vector<std::string> files_;
  std::map<std::string, Given, std::less<>> given_;
};

}  // namespace crankloop::program

#include "arguments.hpp"

#include <cmath>
#include <limits>

#include "../files/error.hpp"
#include "../files/words.hpp"

namespace crankloop::program {
namespace {

/// What one command lists as --output and another as --out may be written either way.
bool is_output(std::string_view name) { return name == "--output" || name == "--out"; }

const Option& known_option(const Command& command, std::string_view typed) {
  const std::string_view name = typed == "-o" ? "--output" : typed;
  for (const Option& option : command.options) {
    if (name == option.name || (is_output(name) && is_output(option.name))) return option;
  }
  if (command.files > 0 && name == kNoWarnings.name) return kNoWarnings;
  std::vector<std::string> names;
  for (const Option& option : options_of(command)) names.emplace_back(option.name);
  const std::string guess = suggestion(name, names);
  const std::string all = names.empty() ? "; this command has none" : "; options: " + join(names);
  throw UsageError("unknown option " + in_quotes(typed) + (guess.empty() ? all : guess));
}

}  // namespace

std::vector<Option> options_of(const Command& command) {
  std::vector<Option> options(command.options.begin(), command.options.end());
  if (command.files > 0) options.push_back(kNoWarnings);
  return options;
}

Arguments::Arguments(const Command& command, const std::vector<std::string>& words) {
  bool options_ended = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (options_ended || word.size() < 2 || word[0] != '-') {
      files_.emplace_back(word);
      continue;
    }
    if (word == "--") {
      options_ended = true;
      continue;
    }
    const auto equals = word.find('=');
    const Option& option = known_option(command, word.substr(0, equals));
    const bool is_flag = option.kind == Option::Kind::flag;
    const auto value_follows_at = [&](std::size_t at) {
      return at + 1 < words.size() && words[at + 1].compare(0, 2, "--") != 0;
    };
    const bool value_follows = value_follows_at(i);
    if (is_flag && equals != std::string_view::npos) throw UsageError(std::string(option.name) + " takes no value");
    if (!is_flag && equals == std::string_view::npos && !value_follows) {
      throw UsageError(std::string(option.name) + " needs a value: " + option.name + " " + option.value + " (" +
                       option.meaning + ")");
    }
    if (option.kind == Option::Kind::words) {
      if (equals != std::string_view::npos) set(option, word.substr(equals + 1), true);
      for (bool first = equals == std::string_view::npos; first || value_follows_at(i); first = false)
        set(option, words[++i], true);
      continue;
    }
    if (has(option.name)) throw UsageError(std::string(option.name) + " is given twice; once is allowed");
    if (is_flag) {
      set(option, "", true);
    } else {
      set(option, equals != std::string_view::npos ? word.substr(equals + 1) : std::string_view(words[++i]), true);
    }
  }
  for (const Option& option : command.options) {
    if (option.fallback != nullptr && !has(option.name)) set(option, option.fallback, false);
  }
  if (files_.size() < command.files) throw UsageError("a file name is missing");
  if (files_.size() > command.files) throw UsageError("unexpected argument " + in_quotes(files_[command.files]));
  require(command);
}

void Arguments::require(const Command& command) const {
  std::vector<std::string> missing;
  for (const Option& option : command.options) {
    if (option.is_required && !has(option.name)) missing.emplace_back(option.name);
  }
  if (!missing.empty()) throw UsageError(join(missing) + (missing.size() == 1 ? " is missing" : " are missing"));
}

void Arguments::set(const Option& option, std::string_view value, bool by_user) {
  Given given{&option, std::string(value), 0, by_user};
  const std::string prefix = std::string(option.name) + ": ";
  switch (option.kind) {
    case Option::Kind::flag:
      break;
    case Option::Kind::number:
    case Option::Kind::whole_number: {
      const ParsedNumber parsed = parse_number(value, option.range, "");
      if (!parsed.ok()) throw UsageError(prefix + parsed.problem);
      const bool is_int =
          parsed.value == std::floor(parsed.value) && std::abs(parsed.value) <= std::numeric_limits<int>::max();
      if (option.kind == Option::Kind::whole_number && !is_int)
        throw UsageError(prefix + in_quotes(value) + " is not a whole number");
      given.number = parsed.value;
      break;
    }
    case Option::Kind::choice: {
      std::vector<std::string> choices;
      bool known = false;
      for (const std::string_view one : split(option.value, '|')) {
        choices.emplace_back(one);
        known = known || one == value;
      }
      if (!known)
        throw UsageError(prefix + in_quotes(value) + " is not one of " + join(choices) + suggestion(value, choices));
      break;
    }
    case Option::Kind::text:
    case Option::Kind::words:
      if (value.empty()) throw UsageError(prefix + "the value is missing");
      break;
  }
  if (option.kind == Option::Kind::words) {
    given.words = this->words(option.name);
    given.words.emplace_back(value);
  }
  given_[option.name] = given;
}

bool Arguments::has(std::string_view option) const {
  const auto found = given_.find(option);
  return found != given_.end() && found->second.by_user;
}

void Arguments::require_with(std::string_view option, std::string_view other) const {
  if (has(option) && !has(other)) {
    throw UsageError(std::string(option) + " has no effect without " + std::string(other) + "; give both");
  }
}

void Arguments::refuse_with(std::string_view option, std::initializer_list<std::string_view> others) const {
  for (const std::string_view other : others) {
    if (has(option) && has(other)) {
      throw UsageError(std::string(option) + " and " + std::string(other) + " exclude each other; give one");
    }
  }
}

const Arguments::Given& Arguments::get(std::string_view option) const {
  const auto found = given_.find(option);
  if (found == given_.end()) throw UsageError(std::string(option) + " is missing");
  return found->second;
}

double Arguments::number(std::string_view option) const { return get(option).number; }
int Arguments::whole_number(std::string_view option) const { return static_cast<int>(get(option).number); }
const std::string& Arguments::text(std::string_view option) const { return get(option).text; }
std::vector<std::string> Arguments::words(std::string_view option) const {
  return has(option) ? get(option).words : std::vector<std::string>{};
}
std::string Arguments::text_or_empty(std::string_view option) const { return has(option) ? get(option).text : ""; }

}  // namespace crankloop::program

// The command-line program: finds the subcommand, gives help, turns exceptions into a line and an exit status.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "command_line/commands.hpp"
#include "engine_file/engine_file_keys.hpp"
#include "engine_file/trigger_patterns.hpp"
#include "files/error.hpp"
#include "files/files_in_use.hpp"
#include "files/output_file.hpp"
#include "files/words.hpp"

#ifndef CRANKLOOP_VERSION
#define CRANKLOOP_VERSION "0.0.0"
#endif

namespace crankloop::program {
namespace {

constexpr std::size_t kNameColumn = 18;

std::string in_column(std::string name, std::size_t width = kNameColumn) {
  name.resize(std::max(width, name.size() + 2), ' ');
  return "  " + name;
}

std::string with_value(const Option& option) {
  return option.value == nullptr ? option.name : std::string(option.name) + " " + option.value;
}

std::string usage_of(const Command& command) {
  return "usage: crankloop " + std::string(command.name) + " " + command.usage + "\n";
}

std::string help_of(const Command& command) {
  std::string text = "crankloop " + std::string(command.name) + ": " + command.summary + "\n\n" + usage_of(command);
  const std::vector<Option> options = options_of(command);
  if (!options.empty()) text += "\n";
  std::size_t width = 0;
  for (const Option& option : options) width = std::max(width, with_value(option).size() + 2);
  for (const Option& option : options) {
    text += in_column(with_value(option), width) + option.meaning;
    if (const std::string allowed = describe(option.range, ""); !allowed.empty()) text += "; " + allowed;
    if (option.is_required) text += "; required";
    if (option.fallback != nullptr) text += std::string("; default ") + option.fallback;
    text += "\n";
  }
  text += "\nexample: " + std::string(command.example) + "\n";
  return text;
}

std::string help() {
  std::string text =
      "crankloop: an engine's mechanics at a fixed time step\n\nusage: crankloop COMMAND [FILE] [--option "
      "value]...\n\n";
  const auto list = [&text](bool for_developers) {
    for (const Command* command : commands()) {
      if (command->for_developers == for_developers) text += in_column(command->name) + command->summary + "\n";
    }
  };
  list(false);
  text += in_column("help COMMAND") + "usage, options and an example of a command\n";
  text += in_column("help engine-file") + "sections, keys, units and ranges of an engine file\n";
  text += in_column("help patterns") + "trigger wheels in use, by name, with their sources\n";
  text += in_column("--version") + "prints the version\n";
  text += "\nfor developers:\n";
  list(true);
  text += "\nexample: " + std::string(commands().front()->example) + "\n";
  text +=
      "\nBad input stops the program before it writes anything, with exit status 2 and on stderr:\n"
      "  FILE:LINE: what is wrong, what is allowed         for each error of an engine file, up to 20; for the first "
      "one of a table\n"
      "  crankloop COMMAND: what is wrong, what is allowed  for an option, with the command's usage below\n"
      "An output must be neither a file that the command reads nor the file of another output, under any name.\n"
      "If output cannot be written, or on any other failure: a line crankloop: ... and exit status 1.\n";
  return text;
}

std::string engine_file_help() {
  return "An engine file is plain text: [section] headers, key = value lines, # comments. Keys include their units.\n"
         "Angles are crank degrees, 0 at cylinder 1's firing TDC. At most 1 MiB; ASCII or UTF-8.\n\n" +
         describe_all_keys();
}

const Command& find_command(const std::string& name) {
  std::vector<std::string> names;
  for (const Command* command : commands()) {
    if (name == command->name) return *command;
    names.emplace_back(command->name);
  }
  const std::string guess = suggestion(name, names);
  throw InputError("crankloop: unknown command " + in_quotes(name) +
                   (guess.empty() ? "; commands: " + join(names) : guess));
}

int tell(const std::string& text) {
  print(text);
  return kSuccess;
}

/// Throws InputError for words behind the first `count`, which would be ignored.
void refuse_more_words(const std::vector<std::string>& words, std::size_t count, const std::string& usage) {
  if (words.size() > count)
    throw InputError("crankloop " + words[0] + ": unexpected argument " + in_quotes(words[count]) +
                     "\nusage: crankloop " + usage);
}

int run_help(const std::vector<std::string>& words) {
  refuse_more_words(words, 2, words[0] + " [COMMAND]");
  if (words.size() < 2 || words[1] == "help") return tell(help());
  if (words[1] == "engine-file") return tell(engine_file_help());
  if (words[1] == "patterns") return tell(describe_patterns());
  return tell(help_of(find_command(words[1])));
}

/// Messages quote words of the command line: none may carry control codes to a terminal, or make two lines of one.
void refuse_control_codes(const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool bad =
        std::any_of(words[i].begin(), words[i].end(), [](unsigned char c) { return c < ' ' || c == 0x7F; });
    if (bad)
      throw InputError("crankloop: word " + std::to_string(i + 1) + " of the command line has a control character");
  }
}

int run(const std::vector<std::string>& words) {
  refuse_control_codes(words);
  if (words.empty()) throw InputError("crankloop: a command is missing; `crankloop --help` lists them");
  if (words[0] == "--help" || words[0] == "-h" || words[0] == "help") return run_help(words);
  if (words[0] == "--version") {
    refuse_more_words(words, 1, words[0]);
    return tell("crankloop " CRANKLOOP_VERSION "\n");
  }
  const Command& command = find_command(words[0]);
  const std::vector<std::string> rest(words.begin() + 1, words.end());
  for (const std::string& word : rest) {
    if (word == "--") break;
    if (word == "--help" || word == "-h") return tell(help_of(command));
  }
  try {
    return command.run(Arguments(command, rest));
  } catch (const UsageError& error) {
    throw InputError("crankloop " + std::string(command.name) + ": " + error.what() + "\n" + usage_of(command));
  }
}

/// With stdin, stdout or stderr closed, the next file opened would take their place, and be written as if it were them.
void occupy_closed_standard_files() {
  int file = ::open("/dev/null", O_RDONLY);
  while (file >= 0 && file <= STDERR_FILENO) file = ::open("/dev/null", O_RDONLY);
  if (file >= 0) ::close(file);
}

void complain(const std::string& message) {
  const bool ends = !message.empty() && message.back() == '\n';
  std::fprintf(stderr, "%s%s", message.c_str(), ends ? "" : "\n");
}

}  // namespace
}  // namespace crankloop::program

int main(int count, char** words) {
  using namespace crankloop::program;
  // A closed pipe and a file beyond its limit become errors of write(), and unfinished files are removed.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  Output::remove_unfinished_at_signals();
  watch_files_in_use();
  occupy_closed_standard_files();
  try {
    return run(std::vector<std::string>(words + (count > 0 ? 1 : 0), words + count));
  } catch (const InputError& error) {
    complain(error.what());
    return kBadInput;
  } catch (const ReaderGone&) {
    return kFailure;
  } catch (const std::exception& error) {
    complain(std::string("crankloop: ") + error.what());
    return kFailure;
  }
}

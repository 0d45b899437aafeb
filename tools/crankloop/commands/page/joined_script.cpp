#include "joined_script.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <vector>

#include "../../files/words.hpp"

namespace crankloop::program {
namespace {

[[noreturn]] void refuse(const std::string& module, const std::string& why) {
  throw std::logic_error("module " + module + ": " + why);
}

bool begins(std::string_view text, std::string_view with) { return text.substr(0, with.size()) == with; }

std::string identifier_of(const std::string& module) {
  std::string name = "m_";
  for (const char c : module) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

/// The word at the begin of a text.
std::string_view first_word(std::string_view text) {
  std::size_t size = 0;
  while (size < text.size() && (std::isalnum(static_cast<unsigned char>(text[size])) != 0 || text[size] == '_')) ++size;
  return text.substr(0, size);
}

/// Of `export WHAT NAME...`: the name.
std::string exported_name(const std::string& module, std::string_view declaration) {
  for (const std::string_view word : {"async ", "function* ", "function ", "class ", "const ", "let "}) {
    if (begins(declaration, word)) declaration.remove_prefix(word.size());
  }
  const std::string name(first_word(declaration));
  if (name.empty() || name == "default") refuse(module, "an export without a name");
  return name;
}

class Joiner {
 public:
  explicit Joiner(const ModuleText& text_of) : text_of_{text_of} {}

  std::string script(const std::string& entry) {
    visit(entry);
    return "(() => {\n'use strict';\n" + script_ + "})();\n";
  }

 private:
  enum class Progress { begun, done };

  void visit(const std::string& module) {
    const auto [found, is_new] = progress_.emplace(module, Progress::begun);
    if (!is_new && found->second == Progress::begun) refuse(module, "needs itself by way of its imports");
    if (!is_new) return;
    std::string head, body;
    std::vector<std::string> exported;
    for (std::string_view rest = text_of_(module); !rest.empty();) {
      if (begins(rest, "import ")) {
        head += import_line(module, rest);
        continue;
      }
      const std::size_t end = std::min(rest.find('\n'), rest.size() - 1) + 1;
      std::string_view line = rest.substr(0, end);
      rest.remove_prefix(end);
      if (begins(line, "export ")) {
        line.remove_prefix(std::string_view("export ").size());
        exported.push_back(exported_name(module, line));
      }
      body += line;
    }
    script_ += "const " + identifier_of(module) + " = (() => {\n" + head + body + "return {" + join(exported, ", ") +
               "};\n})();\n";
    progress_[module] = Progress::done;
  }

  /// Takes `import {NAMES} from 'MODULE';` off the text, and answers the line in its place.
  std::string import_line(const std::string& module, std::string_view& rest) {
    const std::size_t open = rest.find('{'), close = rest.find("} from '"), end = rest.find("';\n");
    if (open != std::string_view("import ").size() || close == std::string_view::npos ||
        end == std::string_view::npos || close > end)
      refuse(module, "an import that is not `import {...} from '...';`");
    std::string names;
    for (const char c : rest.substr(open + 1, close - open - 1)) names += c == '\n' ? ' ' : c;
    if (names.find(" as ") != std::string::npos) refuse(module, "an import that renames");
    const std::size_t begin = close + std::string_view("} from '").size();
    std::string_view imported = rest.substr(begin, end - begin);
    if (begins(imported, "./")) imported.remove_prefix(2);
    rest.remove_prefix(end + 3);
    visit(std::string(imported));
    return "const {" + names + "} = " + identifier_of(std::string(imported)) + ";\n";
  }

  const ModuleText& text_of_;
  std::map<std::string, Progress> progress_;
  std::string script_;
};

}  // namespace

std::string joined_script(const std::string& entry, const ModuleText& text_of) { return Joiner(text_of).script(entry); }

}  // namespace crankloop::program

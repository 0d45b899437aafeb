// mutate CHECKOUT OUT SEED COUNT LEFT_OUT AREA=REGEX...
//
// Copies core, port/c and port/fmi of a checkout to the folder OUT, with single-point changes written into them that
// mutant.hpp can switch on: COUNT of each area, drawn from SEED, in files whose paths have the area's regular
// expression. A file belongs to the first area that finds it. Prints
// "NUMBER<TAB>AREA<TAB>FILE:LINE<TAB>CHANGE<TAB>CODE" for each change, the areas by turns, and to stderr
// "AREA<TAB>PLACES". The lines FILE:LINE in the file LEFT_OUT stay as they are, and the others keep their numbers:
// there a change did not compile.
//
// What is changed: comparisons, + - * /, constants (one more, twice, a tenth), conditions, negations, statements that
// are left out. What is not: lanes, port/c but in the area "c", port/fmi but in the area "fmi", the text of C headers,
// which the compiler makes, what templates are made of, assertions, enumerators, and constants that the compiler itself
// needs. A change is drawn by what it changes and where it stands, not by how many there are: an edit of one line
// leaves the others of a sample as they were.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

// Lanes, which are left out of the build; the list of variables, by which others are built; what the compiler alone
// runs.
constexpr const char* kOutside = "(/lanes?[a-z_]*[.]hpp|abreast[.]hpp|crankloop/variables[.]hpp|header_text[.]hpp)$";
// Folders of port that have tests of their own: changed only where the area of this name asks for them.
constexpr const char* kPorts[] = {"c", "fmi"};

/// Replaces `length` characters at a place of a line.
struct Edit {
  std::size_t line;
  std::size_t column;
  std::size_t length;
  std::string text;  ///< "@" stands for the mutant's number
};
struct Mutant {
  std::size_t line;
  std::string change;
  std::vector<Edit> edits;
  std::string file;
  std::uint64_t key = 0;
  std::size_t area = 0;
  std::size_t turn = 0;  ///< how many of its area are before it
};
/// Files that are judged together.
struct Area {
  std::string name;
  std::regex files;
  std::size_t places = 0;
};

[[noreturn]] void fail(const std::string& message) {
  std::fprintf(stderr, "mutate: %s\n", message.c_str());
  std::exit(1);
}

Lines read_lines(const fs::path& path) {
  std::ifstream file(path);
  if (!file) fail("cannot read " + path.string());
  Lines lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// The code of a file at its places, blanks for comments, strings and the preprocessor's lines.
Lines code_of(Lines lines) {
  bool in_comment = false;
  bool in_directive = false;
  for (std::string& line : lines) {
    char quote = 0;
    in_directive = in_directive || (!in_comment && line.find_first_not_of(" \t") != std::string::npos &&
                                    line[line.find_first_not_of(" \t")] == '#');
    const bool goes_on = in_directive && !line.empty() && line.back() == '\\';
    for (std::size_t i = 0; i < line.size(); ++i) {
      const char here = line[i];
      const char next = i + 1 < line.size() ? line[i + 1] : '\0';
      if (in_comment) {
        line[i] = ' ';
        if (here == '*' && next == '/') line[++i] = ' ', in_comment = false;
      } else if (quote != 0) {
        line[i] = ' ';
        if (here == '\\' && next != '\0') line[++i] = ' ';
        if (here == quote) quote = 0;
      } else if (here == '/' && next == '/') {
        line.erase(i);
      } else if (here == '/' && next == '*') {
        line[i] = line[i + 1] = ' ', ++i, in_comment = true;
      } else if (here == '"' || (here == '\'' && (i == 0 || !std::isxdigit(static_cast<unsigned char>(line[i - 1]))))) {
        line[i] = ' ', quote = here;
      }
    }
    if (in_directive) line.assign(line.size(), ' ');
    in_directive = goes_on;
  }
  return lines;
}

/// 64 bits of a text (FNV-1a, then mixed as splitmix64 does).
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  hash = (hash ^ (hash >> 30)) * 0xBF58476D1CE4E5B9u;
  hash = (hash ^ (hash >> 27)) * 0x94D049BB133111EBu;
  return hash ^ (hash >> 31);
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Finds the places of one file.
class Finder {
 public:
  Finder(std::string file, Lines lines, const std::string& all_code, const std::string& seed)
      : file_{std::move(file)}, lines_{std::move(lines)}, code_{code_of(lines_)}, all_code_{all_code}, seed_{seed} {}

  std::vector<Mutant> find() {
    bool in_enum = false;
    bool in_constant = false;  // of several lines
    for (line_ = 0; line_ < code_.size(); ++line_) {
      const std::string& code = code_[line_];
      in_enum = in_enum || std::regex_search(code, std::regex("\\benum\\b"));
      const bool constant = std::regex_search(code, std::regex("\\bconstexpr\\b[^()]*[\\w\\]] ="));
      in_constant = in_constant || (constant && std::regex_search(code, std::regex("[={,]\\s*$")));
      const bool of_compiler = in_enum || in_constant || std::regex_search(code, kNotAtRunTime);
      if (in_enum && code.find('}') != std::string::npos) in_enum = false;
      if (in_constant && code.find(';') != std::string::npos) in_constant = false;
      if (of_compiler || (constant && !variable_constant(code))) continue;
      if (!constant) operators(), negations(), conditions(), statements();
      constants(constant);
    }
    return std::move(found_);
  }

 private:
  static const std::regex kNotAtRunTime;

  /// A constant that may be a variable: the compiler needs it in no array, template, case, assertion or other constant.
  bool variable_constant(const std::string& code) const {
    std::smatch name;
    if (!std::regex_search(code, name,
                           std::regex("^ *(?:inline )?constexpr (double|float|Real|int) (k[A-Z]\\w*) = [^{]*;\\s*$")))
      return false;
    const std::string k = "\\b" + name[2].str() + "\\b";
    const std::regex needed("\\[[^\\]\n]*" + k + "|<[^<>;\n]*" + k + "[^<>;\n]*>|static_assert[^;]*" + k + "|case " +
                            k + "|constexpr[^;\n]*=[^;\n]*" + k + "|std::array[^;\n]*" + k);
    return !std::regex_search(all_code_, needed);
  }

  void add(const std::string& change, std::vector<Edit> edits) {
    // The same change of the same text counts up: its number within the file is its place.
    const std::string what = file_ + "|" + trimmed(lines_[line_]) + "|" + change;
    const std::uint64_t key = hash_of(seed_ + "|" + what + "|" + std::to_string(times_[what]++));
    Mutant mutant;
    mutant.line = line_, mutant.change = change, mutant.edits = std::move(edits), mutant.file = file_, mutant.key = key;
    found_.push_back(std::move(mutant));
  }
  /// One of some, drawn by place.
  std::size_t choice(std::size_t column, std::size_t of) const {
    return hash_of("choice" + seed_ + file_ + lines_[line_] + std::to_string(column)) % of;
  }

  void operators() {
    struct Other {
      const char* op;
      const char* name;
    };
    static const std::map<std::string, std::vector<Other>> kOthers = {
        {"<", {{"<=", "less_equal"}, {">=", "greater_equal"}}},
        {"<=", {{"<", "less"}, {">", "greater"}}},
        {">", {{">=", "greater_equal"}, {"<=", "less_equal"}}},
        {">=", {{">", "greater"}, {"<", "less"}}},
        {"==", {{"!=", "unequal"}}},
        {"!=", {{"==", "equal"}}},
        {"+", {{"-", "minus"}}},
        {"-", {{"+", "plus"}}},
        {"*", {{"/", "over"}}},
        {"/", {{"*", "times"}}}};
    const std::string& code = code_[line_];
    static const std::regex kOperator("[\\w)\\]}] ([<>]=?|[=!]=|[-+*/])(?= |$)");
    for (std::sregex_iterator it(code.begin(), code.end(), kOperator), end; it != end; ++it) {
      const std::string op = (*it)[1];
      const auto column = static_cast<std::size_t>(it->position(1));
      const auto& others = kOthers.at(op);
      const Other& other = others[choice(column, others.size())];
      add(op + " -> " + other.op,
          {{line_, column, op.size(), op + " mutant::change<@, mutant::Op::" + other.name + "> " + op}});
    }
  }

  void constants(bool definition) {
    const std::string& code = code_[line_];
    static const std::regex kNumber(
        "(?:^|[^\\w.'])((?:0[xX][0-9a-fA-F'.]+(?:[pP][-+]?\\d+)?|\\d[\\d']*(?:\\.[\\d']*)?(?:[eE][-+]?\\d+)?)[uUlLfF]*)"
        "(?![\\w.'])");
    for (std::sregex_iterator it(code.begin(), code.end(), kNumber), end; it != end; ++it) {
      const std::string number = (*it)[1];
      const auto column = static_cast<std::size_t>(it->position(1));
      const bool zero = number.find_first_not_of("0.uUlLfF") == std::string::npos;
      static const char* const kChanges[][2] = {{"one_more", " + 1"}, {"twice", " x 2"}, {"tenth", " x 0.1"}};
      const auto& change = kChanges[zero ? 0 : choice(column, 3)];
      const std::string changed = std::string("mutant::") + change[0] + "<@>";
      std::vector<Edit> edits = {{line_, column, number.size(), changed + "(" + number + ")"}};
      if (definition) {
        edits[0].text = "mutant::at_start(" + changed + ", " + number + ")";
        edits.push_back({line_, code.find("constexpr"), 9, "const"});
      }
      add(number + change[1], edits);
    }
  }

  void negations() {
    const std::string& code = code_[line_];
    static const std::regex kNot("[ (]!(?=[\\w(])");
    for (std::sregex_iterator it(code.begin(), code.end(), kNot), end; it != end; ++it) {
      add("! left out", {{line_, static_cast<std::size_t>(it->position(0)) + 1, 1, "mutant::no<@> ->* "}});
    }
  }

  void conditions() {
    const std::string& code = code_[line_];
    const std::size_t at = code.find("if (");
    if (at == std::string::npos) return;
    const std::size_t begin = at + 4;
    int open = 1;
    std::size_t end = begin;
    for (; end < code.size() && open > 0; ++end) open += code[end] == '(' ? 1 : code[end] == ')' ? -1 : 0;
    const std::string condition = code.substr(begin, end - begin - 1);
    if (open > 0 || condition.find(';') != std::string::npos || condition.find(" = ") != std::string::npos) return;
    add("if (" + condition + ") turned", {{line_, begin, 0, "mutant::turned<@>("}, {line_, end - 1, 0, ")"}});
  }

  /// Assignments and calls that stand on a line of their own, after the end of another statement.
  void statements() {
    static const std::regex kStatement(
        "^ *((\\+\\+|--)?\\*?[A-Za-z_][\\w.\\[\\]>:-]*(\\([^()]*\\))?(\\+\\+|--| [-+*/|&^]?= .*|\\(.*\\))?;)\\s*$");
    const std::string& code = code_[line_];
    if (!std::regex_match(code, kStatement) ||
        std::regex_search(code, std::regex("^ *(return|break|continue|[A-Z]\\w*\\()")))
      return;
    std::size_t before = line_;
    while (before > 0 && trimmed(code_[before - 1]).empty()) --before;
    if (before == 0) return;
    const char last = trimmed(code_[before - 1]).back();
    if (last != ';' && last != '{' && last != '}') return;
    if (std::count(code.begin(), code.end(), '(') != std::count(code.begin(), code.end(), ')')) return;
    add("left out", {{line_, code.find_first_not_of(' '), 0, "if (mutant::kept<@>()) "}});
  }

  std::string file_;
  Lines lines_;
  Lines code_;
  const std::string& all_code_;
  const std::string& seed_;
  std::size_t line_ = 0;
  std::map<std::string, int> times_;
  std::vector<Mutant> found_;
};
const std::regex Finder::kNotAtRunTime(
    "static_assert|^ *template\\b|\\busing\\b|if constexpr|\\bcase\\b|\\bextern\\b|alignas|\\boperator\\b|\\bconstexpr "
    "bool\\b.*;|CRANKLOOP_C\\(|CRANKLOOP_ASSERT\\(");

/// The file with its edits, each but once (two mutants of one definition both make it a variable), and the last of a
/// line first; what is put before a place, after what replaces it.
std::string edited(Lines lines, std::vector<Edit> edits) {
  const auto order = [](const Edit& a, const Edit& b) {
    return std::tie(a.line, a.column, a.length) < std::tie(b.line, b.column, b.length);
  };
  std::stable_sort(edits.begin(), edits.end(), order);
  for (std::size_t i = edits.size(); i-- > 0;) {
    const Edit& e = edits[i];
    if (i > 0 && edits[i - 1].line == e.line && edits[i - 1].column == e.column && edits[i - 1].text == e.text)
      continue;
    lines[e.line].replace(e.column, e.length, e.text);
  }
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::vector<Area> read_areas(char** first, char** last) {
  std::vector<Area> areas;
  for (; first != last; ++first) {
    const std::string area = *first;
    const std::size_t equals = area.find('=');
    if (equals == std::string::npos) fail("no AREA=REGEX: " + area);
    areas.push_back({area.substr(0, equals), std::regex(area.substr(equals + 1))});
  }
  return areas;
}

/// The first area that finds a file, or their number.
std::size_t area_of(const std::string& file, const std::vector<Area>& areas) {
  if (file.substr(file.size() - 2) == ".h" || std::regex_search(file, std::regex(kOutside))) return areas.size();
  const auto may_change = [&file](const Area& area) {
    for (const std::string port : kPorts) {
      if (file.rfind("port/" + port + "/", 0) == 0 && area.name != port) return false;
    }
    return std::regex_search(file, area.files);
  };
  return static_cast<std::size_t>(std::find_if(areas.begin(), areas.end(), may_change) - areas.begin());
}

/// COUNT of each area, the areas by turns.
std::vector<Mutant> drawn(std::vector<Mutant> mutants, std::size_t count, std::vector<Area>& areas) {
  std::sort(mutants.begin(), mutants.end(), [](const Mutant& a, const Mutant& b) { return a.key < b.key; });
  for (Mutant& mutant : mutants) mutant.turn = areas[mutant.area].places++;
  const auto beyond = [&](const Mutant& mutant) { return mutant.turn >= count; };
  mutants.erase(std::remove_if(mutants.begin(), mutants.end(), beyond), mutants.end());
  std::stable_sort(mutants.begin(), mutants.end(), [](const Mutant& a, const Mutant& b) { return a.turn < b.turn; });
  return mutants;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 7) fail("usage: mutate CHECKOUT OUT SEED COUNT LEFT_OUT AREA=REGEX...");
  const fs::path checkout = argv[1];
  const fs::path out = argv[2];
  const std::string seed = argv[3];
  const auto count = static_cast<std::size_t>(std::strtoul(argv[4], nullptr, 10));
  std::set<std::string> left_out;
  for (const std::string& line : read_lines(argv[5])) left_out.insert(line);
  std::vector<Area> areas = read_areas(argv + 6, argv + argc);

  std::vector<std::string> files;  // what is copied, by their paths in the checkout
  std::string all_code;
  for (const std::string folder : {"core", "port/c", "port/fmi", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(checkout / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".cpp" && extension != ".hpp" && extension != ".inc" && extension != ".h") continue;
      for (const std::string& line : code_of(read_lines(entry.path()))) all_code += line + "\n";
      if (folder != "tests") files.push_back(fs::relative(entry.path(), checkout).generic_string());
    }
  }
  std::sort(files.begin(), files.end());

  std::vector<Mutant> mutants;
  for (const std::string& file : files) {
    const std::size_t area = area_of(file, areas);
    if (area == areas.size()) continue;
    for (Mutant& mutant : Finder(file, read_lines(checkout / file), all_code, seed).find()) {
      mutant.area = area;
      mutants.push_back(std::move(mutant));
    }
  }
  mutants = drawn(std::move(mutants), count, areas);
  for (const Area& area : areas) std::fprintf(stderr, "%s\t%zu\n", area.name.c_str(), area.places);

  std::map<std::string, std::vector<Edit>> edits;
  for (std::size_t number = 0; number < mutants.size(); ++number) {
    const Mutant& mutant = mutants[number];
    if (left_out.count(mutant.file + ":" + std::to_string(mutant.line + 1)) != 0) continue;
    for (Edit edit : mutant.edits) {
      if (const auto at = edit.text.find('@'); at != std::string::npos)
        edit.text.replace(at, 1, std::to_string(number));
      edits[mutant.file].push_back(edit);
    }
    std::printf("%zu\t%s\t%s:%zu\t%s\t%s\n", number, areas[mutant.area].name.c_str(), mutant.file.c_str(),
                mutant.line + 1, mutant.change.c_str(),
                trimmed(read_lines(checkout / mutant.file)[mutant.line]).c_str());
  }
  for (const std::string& file : files) {
    // Files that stay as they are keep their time, so that what is built of them stays built.
    const std::string text = edited(read_lines(checkout / file), edits[file]);
    const fs::path to = out / file;
    std::ifstream before(to);
    if (before && std::string(std::istreambuf_iterator<char>(before), {}) == text) continue;
    fs::create_directories(to.parent_path());
    if (!(std::ofstream(to) << text)) fail("cannot write " + to.string());
  }
}

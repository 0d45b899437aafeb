#include "bounds.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>

namespace worst_tick {
namespace {

[[nodiscard]] std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

[[nodiscard]] std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> all;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, '|');) all.push_back(trimmed(cell));
  return all;
}

/// "WHAT spends NAME" or "WHAT spends N NAME" -> WHAT and what it spends.
[[nodiscard]] std::pair<std::string, Spending> split_spends(const std::string& cell) {
  const std::string word = " spends ";
  const std::size_t at = cell.find(word);
  if (at == std::string::npos) return {cell, {}};
  Spending spends{trimmed(cell.substr(at + word.size()))};
  const std::size_t space = spends.budget.find(' ');
  if (space != std::string::npos && spends.budget.find_first_not_of("0123456789") == space) {
    spends.number = std::stol(spends.budget);
    spends.budget = trimmed(spends.budget.substr(space));
  }
  return {trimmed(cell.substr(0, at)), spends};
}

constexpr std::string_view kEach = " each";

[[nodiscard]] bool ends_in_each(const std::string& rounds) {
  return rounds.size() > kEach.size() && rounds.compare(rounds.size() - kEach.size(), kEach.size(), kEach) == 0;
}

[[nodiscard]] bool is_of(const Place& place, const std::string& file) {
  const std::string& path = place.file;
  return path == file ||
         (path.size() > file.size() && path.compare(path.size() - file.size() - 1, std::string::npos, "/" + file) == 0);
}

/// "vdiv" names vdiv.f32 and vdiv.f64 too.
[[nodiscard]] bool names(const std::string& name, const std::string& mnemonic) {
  return mnemonic.substr(0, mnemonic.find('.')) == name || mnemonic == name;
}

[[nodiscard]] bool says_loop(const std::string& source) {
  return source.find("for (") != std::string::npos || source.find("while (") != std::string::npos ||
         source.find("do {") != std::string::npos;
}

}  // namespace

Bounds::Bounds(std::istream& file, const Numbers& limits, Sources& sources) : sources_{sources} {
  for (std::string line; std::getline(file, line);) {
    if (trimmed(line).empty() || trimmed(line)[0] == '#') continue;
    const std::vector<std::string> cell = cells(line);
    if (cell.size() == 5 && cell[0] == "loop") {
      auto [rounds, spends] = split_spends(cell[3]);
      const bool each = !spends.budget.empty() && ends_in_each(rounds);
      if (each) rounds.resize(rounds.size() - kEach.size());
      loops_.push_back({cell[1], cell[2], number(rounds, limits), spends, each});
    } else if (cell.size() == 5 && cell[0] == "code") {
      const auto [instruction, spends] = split_spends(cell[3]);
      const std::size_t space = std::min(instruction.find(' '), instruction.size());
      expenses_.push_back({cell[1], cell[2], instruction.substr(0, space), trimmed(instruction.substr(space)), spends});
    } else if (cell.size() == 4 && cell[0] == "call") {
      calls_[cell[1]] = number(cell[2], limits);
    } else if (cell.size() == 4 && cell[0] == "budget") {
      budgets_[cell[1]] = number(cell[2], limits);
    } else {
      throw Refusal("the bounds file says: " + line);
    }
  }
  for (const LoopBound& loop : loops_) {
    if (!loop.spends.budget.empty() && budgets_.count(loop.spends.budget) == 0)
      throw Refusal("no budget of " + loop.spends.budget);
  }
  for (const Expense& expense : expenses_) {
    if (budgets_.count(expense.spends.budget) == 0) throw Refusal("no budget of " + expense.spends.budget);
  }
}

/// A number or a limit of the image, or several with + - * between, worked out from the left.
std::int64_t Bounds::number(const std::string& text, const Numbers& limits) const {
  std::istringstream in(text);
  const auto value = [&](const std::string& word) {
    const auto limit = limits.find(word);
    if (limit != limits.end()) return limit->second;
    if (word.empty() || word.find_first_not_of("0123456789") != std::string::npos)
      throw Refusal("a bound says '" + word + "', which the image does not tell");
    return std::int64_t{std::stol(word)};
  };
  std::string word, operation;
  in >> word;
  std::int64_t result = value(word);
  while (in >> operation) {
    std::string operand;
    in >> operand;
    if (operation == "+") {
      result += value(operand);
    } else if (operation == "-") {
      result -= value(operand);
    } else if (operation == "*") {
      result *= value(operand);
    } else {
      throw Refusal("a bound says '" + text + "'");
    }
  }
  return result;
}

/// The bound of the source loop that a branch tests; none where the branch is not a loop's test.
const LoopBound* Bounds::bound_at(const Instruction& branch) const {
  const std::string source = sources_.line(branch.place);
  if (!says_loop(source)) return nullptr;
  const LoopBound* found = nullptr;
  for (const LoopBound& bound : loops_) {
    if (!is_of(branch.place, bound.file) || source.find(bound.text) == std::string::npos) continue;
    if (found != nullptr)
      throw Refusal(branch.place.file + ":" + std::to_string(branch.place.line) + ": two bounds speak of this loop");
    found = &bound;
  }
  if (found == nullptr)
    throw Refusal(branch.place.file + ":" + std::to_string(branch.place.line) +
                  ": a loop without a bound: " + trimmed(source));
  return found;
}

/// Branches that leave a loop and stem from a source loop's own line.
std::vector<Bounds::Test> Bounds::tests(const Function& function, const Graph& graph, std::size_t loop) const {
  std::vector<Test> found;
  const std::vector<bool>& has = graph.loops[loop].has;
  for (std::size_t b = 0; b < graph.blocks.size(); ++b) {
    bool inner = false;
    for (std::size_t other = 0; other < loop; ++other)
      inner = inner || (graph.loops[other].has[b] && has[graph.loops[other].header]);
    if (!has[b] || inner) continue;
    const auto& next = graph.blocks[b].next;
    if (std::all_of(next.begin(), next.end(), [&](std::size_t n) { return has[n]; })) continue;
    if (const LoopBound* bound = bound_at(function.instructions[graph.blocks[b].end - 1])) found.push_back({bound, b});
  }
  return found;
}

/// A machine loop stems from the source loop whose line the branch that leaves it has. Where an outer loop is also left
/// by an inner one's test (the compiler makes a copy of the outer loop for the case that the inner is empty), the
/// outer's own counts.
Bounds::Repeats Bounds::repeats(const Function& function, const Graph& graph, std::size_t loop) const {
  std::vector<Test> own = tests(function, graph, loop);
  const auto is_inner = [&](const Test& test) {
    for (std::size_t other = 0; other < loop; ++other) {
      if (!graph.loops[loop].has[graph.loops[other].header]) continue;
      for (const Test& inner : tests(function, graph, other)) {
        if (inner.bound == test.bound) return true;
      }
    }
    return false;
  };
  own.erase(std::remove_if(own.begin(), own.end(), is_inner), own.end());
  const std::size_t header = graph.loops[loop].header;
  const std::string where =
      function.name + ", loop at " + hex(function.instructions[graph.blocks[header].begin].address);
  if (own.empty()) throw Refusal(where + ": no test of a source loop of its own leaves it");
  for (const Test& test : own) {
    if (test.bound != own[0].bound)
      throw Refusal(where + ": two source loops' tests leave it: " + own[0].bound->text + "; " + test.bound->text);
  }
  // With the test at its head a loop's body runs once for each repeat; elsewhere it has run before the first.
  const auto& ways = graph.blocks[header].next;
  const bool alone = std::find(ways.begin(), ways.end(), header) != ways.end();
  const bool tests_first =
      !alone && std::any_of(own.begin(), own.end(), [&](const Test& test) { return test.block == header; });
  const std::int64_t rounds = own[0].bound->rounds;
  if (tests_first) return {rounds, own[0].bound->spends, false};
  if (rounds == 0) return {std::nullopt, {}, false};
  return {rounds - 1, own[0].bound->spends, own[0].bound->first_too};
}

std::optional<std::int64_t> Bounds::instructions(const std::string& function) const {
  const auto found = calls_.find(function);
  if (found == calls_.end()) return std::nullopt;
  return found->second;
}

Spending Bounds::spends(const Instruction& instruction) const {
  for (const Expense& expense : expenses_) {
    const auto stems_from = [&](const Place& place) {
      return is_of(place, expense.file) && sources_.line(place).find(expense.text) != std::string::npos;
    };
    if (names(expense.mnemonic, instruction.mnemonic) &&
        instruction.operands.find(expense.operands) != std::string::npos &&
        (stems_from(instruction.place) ||
         std::any_of(instruction.calls.begin(), instruction.calls.end(), stems_from))) {
      Spending spends = expense.spends;
      spends.by = &expense;
      return spends;
    }
  }
  return {};
}

}  // namespace worst_tick

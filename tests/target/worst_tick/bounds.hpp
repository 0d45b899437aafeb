// What the tool cannot see in machine code: how often loops run, and what a whole tick has a budget for.
//
// What belongs here: the bounds file, and which of its lines speaks of which loop. What does not: the longest path
// (longest_path.hpp).
//
// A line of the file is one of these; FILE is a source's name without folders, TEXT a piece of the source line, a
// number may be a name that the image tells (a limit of its tables). A reason follows each.
//
//     loop | FILE | TEXT | ROUNDS | why                a loop runs its body at most ROUNDS times
//     loop | FILE | TEXT | ROUNDS spends NAME | why    likewise, and whenever it begins anew it spends one of a budget;
//                                                      "spends N NAME": N of it, here and below
//     loop | FILE | TEXT | ROUNDS each spends NAME | why    likewise, its first round too, where it is sure to have one
//     code | FILE | TEXT | INSTRUCTION spends NAME | why   so does that line's instruction, or what was
//                                                      inlined there: a mnemonic, its type left out or not, then
//                                                      perhaps a piece of its operands
//     budget | NAME | NUMBER | why                     of one tick
//     call | FUNCTION | INSTRUCTIONS | why             what a function without source takes, with all that it calls
#pragma once

#include <cstdint>
#include <istream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "graph.hpp"
#include "listing.hpp"

namespace worst_tick {

using Numbers = std::map<std::string, std::int64_t>;

/// How much of which budget; of none where the name is empty.
struct Spending {
  std::string budget;
  std::int64_t number = 1;
  const void* by = nullptr;  ///< the line of the file that says so, of an instruction
};

struct LoopBound {
  std::string file, text;
  std::int64_t rounds;
  Spending spends;
  bool first_too;  ///< the first round spends as well
};

struct Expense {
  std::string file, text, mnemonic, operands;
  Spending spends;
};

/// Where the text of a source line comes from: the disk, or a test.
class Sources {
 public:
  virtual ~Sources() = default;
  [[nodiscard]] virtual std::string line(const Place& place) = 0;
};

class Bounds {
 public:
  /// Refuses a line that it does not understand. `limits` are the image's.
  Bounds(std::istream& file, const Numbers& limits, Sources& sources);

  /// How often a loop's back edges are taken at most, each time that it is entered; nothing if it is never entered.
  struct Repeats {
    std::optional<std::int64_t> most;
    Spending spends;
    bool first_too;  ///< whoever enters it spends as much besides
  };
  [[nodiscard]] Repeats repeats(const Function& function, const Graph& graph, std::size_t loop) const;

  /// What an instruction spends.
  [[nodiscard]] Spending spends(const Instruction& instruction) const;

  [[nodiscard]] const Numbers& budgets() const { return budgets_; }

  /// What a function takes that is not looked into.
  [[nodiscard]] std::optional<std::int64_t> instructions(const std::string& function) const;

 private:
  struct Test {
    const LoopBound* bound;
    std::size_t block;
  };
  [[nodiscard]] std::vector<Test> tests(const Function& function, const Graph& graph, std::size_t loop) const;
  [[nodiscard]] const LoopBound* bound_at(const Instruction& branch) const;
  [[nodiscard]] std::int64_t number(const std::string& text, const Numbers& limits) const;

  std::vector<LoopBound> loops_;
  std::vector<Expense> expenses_;
  Numbers budgets_;
  Numbers calls_;
  Sources& sources_;
};

}  // namespace worst_tick

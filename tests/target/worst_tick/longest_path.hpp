// The longest path through a function and all that it calls, in instructions or cycles.
//
// What belongs here: the search. What does not: structure (graph.hpp), how often loops run (bounds.hpp).
//
// Budgets of a whole tick are kept by prices: whoever spends one of a budget pays its price, and the tick is credited
// with the whole budget's worth. For any prices that are not negative this is a bound (weak duality: a path within its
// budgets pays no more than the credit); mixture.hpp finds those that make it low.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bounds.hpp"
#include "costs.hpp"
#include "graph.hpp"
#include "listing.hpp"
#include "path.hpp"

namespace worst_tick {

class LongestPath {
 public:
  /// Refuses recursion, calls of what is not in the program, two stores or two calls in a row that spend for the same
  /// line (arguments of a call on it, as a rule, that pay for work which nobody does), and what graph_of() and Bounds
  /// refuse.
  LongestPath(const Program& program, const Bounds& bounds, const Costs& costs, std::uint32_t root);

  /// The most from the root's first instruction to its return, both counted.
  [[nodiscard]] std::int64_t bound();

 private:
  struct Body {
    Graph graph;
    std::vector<Path> blocks;              ///< without what they call, and without leaving them
    std::vector<Bounds::Repeats> repeats;  ///< per loop
  };
  /// Longest ways through a loop, or a whole function, from its first block.
  struct Ways {
    std::map<std::size_t, Path> out;  ///< per block outside, or kReturn
    Path again = Path::none();        ///< back to the first block
  };

  void add(std::uint32_t address, std::vector<std::uint32_t>& callers);
  [[nodiscard]] Path longest(std::uint32_t address, const Prices& prices);
  [[nodiscard]] Ways ways(const Body& body, const std::vector<Path>& blocks, std::size_t start,
                          const std::vector<bool>& within, const std::map<std::size_t, Ways>& inner,
                          const Prices& prices) const;
  [[nodiscard]] std::size_t budget(const std::string& name) const;
  [[nodiscard]] Path given(const Function& function, std::int64_t instructions) const;
  [[nodiscard]] std::int64_t cost(const Function& function, std::size_t index) const;

  const Program& program_;
  const Bounds& bounds_;
  const Costs& costs_;
  std::uint32_t root_;
  std::map<std::uint32_t, Body> bodies_;
  std::map<std::uint32_t, Path> known_;  ///< at the prices asked for
};

}  // namespace worst_tick

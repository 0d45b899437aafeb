// A function's control flow: blocks, the edges between them, its natural loops.
//
// What belongs here: structure. What does not: how often a loop runs (bounds.hpp), what a path costs
// (longest_path.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "listing.hpp"

namespace worst_tick {

/// Instructions that run one after the other, all or none of them. A call is part of its block.
struct Block {
  std::size_t begin, end;         ///< instructions of the function
  std::vector<std::size_t> next;  ///< blocks
  bool returns = false;
  std::vector<std::uint32_t> callees;    ///< their addresses
  std::optional<std::size_t> branch_to;  ///< the instruction of the function to which its last one may branch

  /// Whether it goes to another block by a branch.
  [[nodiscard]] bool branches(const Block& other) const { return branch_to == other.begin; }
};

/// All that can reach the back edges to `header` without passing it.
struct Loop {
  std::size_t header;
  std::vector<bool> has;  ///< per block
};

struct Graph {
  std::vector<Block> blocks;       ///< the first is the entry
  std::vector<std::size_t> order;  ///< blocks that can be reached; each after all that lead to it, but for back edges
  std::vector<Loop> loops;         ///< inner ones before those around them
};

/// Refuses unknown branches and flow into data. What a loop with several ways in runs before its header is copied, so a
/// block may be there twice.
[[nodiscard]] Graph graph_of(const Function& function);

}  // namespace worst_tick

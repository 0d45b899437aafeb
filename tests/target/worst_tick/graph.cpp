#include "graph.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "thumb.hpp"

namespace worst_tick {
namespace {

class Builder {
 public:
  explicit Builder(const Function& function) : function_{function} {
    for (std::size_t i = 0; i < function.instructions.size(); ++i) index_[function.instructions[i].address] = i;
  }

  [[nodiscard]] Graph build() {
    make_blocks();
    prune();
    for (int copies = 0;; ++copies) {
      put_in_order();
      find_dominators();
      const auto [from, to] = second_way();
      if (to == kNowhere) break;
      if (copies == kMostCopies) throw Refusal(where(to) + ": a loop with two ways in");
      copy_for(from, to);
    }
    find_loops();
    return std::move(graph_);
  }

 private:
  [[nodiscard]] bool within(std::uint32_t address) const { return index_.count(address) != 0; }

  void make_blocks() {
    const auto& code = function_.instructions;
    std::set<std::size_t> leaders = {0};
    std::vector<Flow> flows;
    for (std::size_t i = 0; i < code.size(); ++i) {
      flows.push_back(flow_of(code[i]));
      const Flow& flow = flows.back();
      const bool at_end = i + 1 == code.size() || code[i + 1].follows_data;
      if (flow.jumps && within(flow.target)) leaders.insert(index_[flow.target]);
      if ((flow.jumps || flow.returns || at_end) && i + 1 < code.size()) leaders.insert(i + 1);
    }
    std::map<std::size_t, std::size_t> block_of;  // by its first instruction
    for (const std::size_t begin : leaders) block_of.emplace(begin, block_of.size());
    for (auto leader = leaders.begin(); leader != leaders.end(); ++leader) {
      Block block{*leader, std::next(leader) == leaders.end() ? code.size() : *std::next(leader), {}, false, {}};
      for (std::size_t i = block.begin; i < block.end; ++i) {
        if (flows[i].calls) block.callees.push_back(flows[i].target);
      }
      const Flow& last = flows[block.end - 1];
      block.returns = last.returns;
      if (last.jumps && within(last.target)) block.next.push_back(block_of[index_[last.target]]);
      if (last.jumps && !within(last.target))
        block.callees.push_back(last.target), block.returns = true;  // calls as its last act
      const bool into_data = block.end == code.size() || code[block.end].follows_data;
      if (last.goes_on) block.next.push_back(into_data ? kNowhere : block_of[block.end]);
      graph_.blocks.push_back(block);
    }
  }

  [[nodiscard]] std::string where(std::size_t block) const {
    return function_.name + ", " + hex(function_.instructions[graph_.blocks[block].begin].address);
  }

  /// Takes out what can only run into data: what would lead there is undefined, such as a count beyond an array, and the compiler left
  /// away what comes after.
  void prune() {
    auto& blocks = graph_.blocks;
    const auto is_nowhere = [&](std::size_t b) {
      return b == kNowhere || (blocks[b].next.empty() && !blocks[b].returns);
    };
    for (bool changed = true; changed;) {
      changed = false;
      for (Block& block : blocks) {
        const auto end = std::remove_if(block.next.begin(), block.next.end(), is_nowhere);
        changed = changed || end != block.next.end();
        block.next.erase(end, block.next.end());
      }
    }
    if (is_nowhere(0)) throw Refusal(where(0) + ": runs into what is not an instruction");
  }

  void put_in_order() {
    graph_.order.clear();
    std::vector<bool> seen(graph_.blocks.size(), false);
    visit(0, seen);
    std::reverse(graph_.order.begin(), graph_.order.end());
    place_.assign(graph_.blocks.size(), 0);
    for (std::size_t i = 0; i < graph_.order.size(); ++i) place_[graph_.order[i]] = i;
  }

  void visit(std::size_t block, std::vector<bool>& seen) {
    seen[block] = true;
    for (const std::size_t next : graph_.blocks[block].next) {
      if (!seen[next]) visit(next, seen);
    }
    graph_.order.push_back(block);
  }

  /// An edge back to a block past which there is another way: {from, to}, or kNowhere.
  [[nodiscard]] std::pair<std::size_t, std::size_t> second_way() const {
    for (const std::size_t b : graph_.order) {
      for (const std::size_t next : graph_.blocks[b].next) {
        if (place_[next] <= place_[b] && !dominates_[b][next]) return {b, next};
      }
    }
    return {kNowhere, kNowhere};
  }

  /// Gives `from` a copy of `to` of its own: the same paths, and one way less into a loop.
  void copy_for(std::size_t from, std::size_t to) {
    const Block copy = graph_.blocks[to];
    auto& next = graph_.blocks[from].next;
    std::replace(next.begin(), next.end(), to, graph_.blocks.size());
    graph_.blocks.push_back(copy);
  }

  /// dominates_[b][d]: every way to b leads through d.
  void find_dominators() {
    const std::size_t n = graph_.blocks.size();
    dominates_.assign(n, std::vector<bool>(n, true));
    dominates_[0].assign(n, false);
    dominates_[0][0] = true;
    for (bool changed = true; changed;) {
      changed = false;
      for (const std::size_t b : graph_.order) {
        for (const std::size_t next : graph_.blocks[b].next) {
          for (std::size_t d = 0; d < n; ++d) {
            if (d != next && dominates_[next][d] && !dominates_[b][d]) dominates_[next][d] = false, changed = true;
          }
        }
      }
    }
  }

  void find_loops() {
    std::map<std::size_t, std::vector<bool>> body;  // by header
    for (const std::size_t b : graph_.order) {
      for (const std::size_t next : graph_.blocks[b].next) {
        if (place_[next] > place_[b]) continue;
        std::vector<bool>& has = body[next];
        has.resize(graph_.blocks.size());
        add_ways(b, next, has);
      }
    }
    for (auto& [header, has] : body) graph_.loops.push_back({header, has});
    std::stable_sort(graph_.loops.begin(), graph_.loops.end(), [](const Loop& a, const Loop& b) {
      return std::count(a.has.begin(), a.has.end(), true) < std::count(b.has.begin(), b.has.end(), true);
    });
  }

  /// Adds the blocks from which `from` is reached without passing the header.
  void add_ways(std::size_t from, std::size_t header, std::vector<bool>& has) {
    has[header] = true;
    std::vector<std::size_t> todo = {from};
    while (!todo.empty()) {
      const std::size_t b = todo.back();
      todo.pop_back();
      if (has[b]) continue;
      has[b] = true;
      for (const std::size_t p : graph_.order) {
        const auto& next = graph_.blocks[p].next;
        if (std::find(next.begin(), next.end(), b) != next.end()) todo.push_back(p);
      }
    }
  }

  static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);
  static constexpr int kMostCopies = 50;
  const Function& function_;
  Graph graph_;
  std::map<std::uint32_t, std::size_t> index_;
  std::vector<std::size_t> place_;  ///< per block, in the order
  std::vector<std::vector<bool>> dominates_;
};

}  // namespace

Graph graph_of(const Function& function) {
  if (function.instructions.empty()) throw Refusal(function.name + ": no code");
  return Builder(function).build();
}

}  // namespace worst_tick

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
    put_in_order();
    Blocks reached(graph_.blocks.size(), false);
    for (const std::size_t b : graph_.order) reached[b] = true;
    give_single_ways_in(reached);
    put_in_order();
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
      Block block{*leader, std::next(leader) == leaders.end() ? code.size() : *std::next(leader), {}, false, {}, {}};
      for (std::size_t i = block.begin; i < block.end; ++i) {
        if (flows[i].calls) block.callees.push_back(flows[i].target);
      }
      const Flow& last = flows[block.end - 1];
      block.returns = last.returns;
      if (last.jumps && within(last.target)) {
        block.branch_to = index_[last.target];
        block.next.push_back(block_of[*block.branch_to]);
      }
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

  /// Takes out what can only run into data: what would lead there is undefined, such as a count beyond an array, and
  /// the compiler left away what comes after.
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

  using Blocks = std::vector<bool>;  ///< whether each is one of a set

  /// All that `from` leads to within a set, itself included if it is one of it.
  void reach(std::size_t from, const Blocks& within, Blocks& reached) const {
    if (!is_in(from, within) || reached[from]) return;
    reached[from] = true;
    for (const std::size_t next : graph_.blocks[from].next) reach(next, within, reached);
  }

  /// Blocks of which each leads to each, within a set: loops, and what is not a loop yet.
  [[nodiscard]] std::vector<Blocks> knots(const Blocks& within) const {
    const std::size_t n = graph_.blocks.size();
    std::vector<Blocks> after(n, Blocks(n, false));  // one step or more from each
    for (std::size_t b = 0; b < n; ++b) {
      if (!is_in(b, within)) continue;
      for (const std::size_t next : graph_.blocks[b].next) reach(next, within, after[b]);
    }
    std::vector<Blocks> found;
    Blocks done(n, false);
    for (std::size_t b = 0; b < n; ++b) {
      if (done[b] || !after[b][b]) continue;
      found.emplace_back(n, false);
      for (std::size_t other = 0; other < n; ++other) {
        if (after[b][other] && after[other][b]) found.back()[other] = done[other] = true;
      }
    }
    return found;
  }

  /// Makes every knot a loop: a block of it becomes its header, and what can run before that gets a copy outside, from
  /// which the paths are the same. Then likewise what is knotted within, without the header. Each is smaller than the
  /// one before, so that it ends.
  void give_single_ways_in(const Blocks& within) {
    for (const Blocks& knot : knots(within)) {
      const std::vector<std::size_t> entries = ways_into(knot);
      const std::size_t header = best_header(knot, entries);
      const Blocks copies = copy(before(header, knot, entries), knot);
      Blocks inside = knot;
      inside[header] = false;
      give_single_ways_in(inside);
      give_single_ways_in(copies);
    }
  }

  /// Blocks of a knot to which others lead, or at which the function begins.
  [[nodiscard]] std::vector<std::size_t> ways_into(const Blocks& knot) const {
    std::set<std::size_t> found;
    if (knot[0]) found.insert(0);
    for (std::size_t b = 0; b < graph_.blocks.size(); ++b) {
      for (const std::size_t next : graph_.blocks[b].next) {
        if (!is_in(b, knot) && is_in(next, knot)) found.insert(next);
      }
    }
    return {found.begin(), found.end()};
  }

  /// What of a knot can run before its header.
  [[nodiscard]] Blocks before(std::size_t header, const Blocks& knot, const std::vector<std::size_t>& entries) const {
    Blocks rest = knot, found(graph_.blocks.size(), false);
    rest[header] = false;
    for (const std::size_t entry : entries) reach(entry, rest, found);
    return found;
  }

  /// That with the fewest instructions before it: they count besides the loop's rounds.
  [[nodiscard]] std::size_t best_header(const Blocks& knot, const std::vector<std::size_t>& entries) const {
    std::size_t best = kNowhere, fewest = kNowhere;
    for (std::size_t b = 0; b < knot.size(); ++b) {
      if (!knot[b]) continue;
      const Blocks copies = before(b, knot, entries);
      std::size_t instructions = 0;
      for (std::size_t c = 0; c < copies.size(); ++c) {
        if (copies[c]) instructions += graph_.blocks[c].end - graph_.blocks[c].begin;
      }
      if (instructions < fewest) fewest = instructions, best = b;
    }
    return best;
  }

  /// Copies blocks of a knot: whoever comes from outside it comes to the copies, and goes on in them. Returns the
  /// copies.
  [[nodiscard]] Blocks copy(const Blocks& originals, const Blocks& knot) {
    const std::size_t n = graph_.blocks.size();
    std::map<std::size_t, std::size_t> copy_of;
    for (std::size_t b = 0; b < n; ++b) {
      if (is_in(b, originals)) copy_of.emplace(b, n + copy_of.size());
    }
    if (n + copy_of.size() > kMaxBlocks)
      throw Refusal(where(copy_of.begin()->first) + ": a loop with too many ways in");
    for (const auto& [original, unused] : copy_of) graph_.blocks.push_back(Block{graph_.blocks[original]});
    Blocks copies(graph_.blocks.size(), false);
    for (std::size_t b = 0; b < graph_.blocks.size(); ++b) {
      copies[b] = b >= n;
      if (is_in(b, knot)) continue;
      for (std::size_t& next : graph_.blocks[b].next) {
        if (copy_of.count(next) != 0) next = copy_of[next];
      }
    }
    return copies;
  }

  /// Sets do not grow with the graph.
  [[nodiscard]] static bool is_in(std::size_t block, const Blocks& set) { return block < set.size() && set[block]; }

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
  static constexpr std::size_t kMaxBlocks = 5000;
  const Function& function_;
  Graph graph_;
  std::map<std::uint32_t, std::size_t> index_;
  std::vector<std::size_t> place_;  ///< per block, in the order
};

}  // namespace

Graph graph_of(const Function& function) {
  if (function.instructions.empty()) throw Refusal(function.name + ": no code");
  return Builder(function).build();
}

}  // namespace worst_tick

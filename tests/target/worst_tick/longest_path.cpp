#include "longest_path.hpp"

#include <algorithm>
#include <set>

#include "mixture.hpp"
#include "thumb.hpp"

namespace worst_tick {
namespace {

constexpr std::size_t kReturn = static_cast<std::size_t>(-1);

}  // namespace

LongestPath::LongestPath(const Program& program, const Bounds& bounds, const Costs& costs, std::uint32_t root)
    : program_{program}, bounds_{bounds}, costs_{costs}, root_{root} {
  std::vector<std::uint32_t> callers;
  add(root, callers);
}

std::size_t LongestPath::budget(const std::string& name) const {
  return static_cast<std::size_t>(std::distance(bounds_.budgets().begin(), bounds_.budgets().find(name)));
}

/// Of an instruction of a function, with the call if it is one.
std::int64_t LongestPath::cost(const Function& function, std::size_t index) const {
  const auto& code = function.instructions;
  const bool last = index + 1 == code.size() || code[index + 1].follows_data;
  return costs_.going_on(code[index], last ? nullptr : &code[index + 1]) +
         (flow_of(code[index]).calls ? costs_.leaving() : 0);
}

/// A function of which only the number of instructions is known: each as dear as its dearest.
Path LongestPath::given(const Function& function, std::int64_t instructions) const {
  std::int64_t dearest = 1;
  for (std::size_t i = 0; i < function.instructions.size(); ++i) {
    const Flow flow = flow_of(function.instructions[i]);
    const bool leaves = flow.jumps || flow.returns;
    dearest = std::max(dearest, cost(function, i) + (leaves ? costs_.leaving() : 0));
  }
  return {instructions * dearest, {}, true};
}

void LongestPath::add(std::uint32_t address, std::vector<std::uint32_t>& callers) {
  const auto found = program_.find(address);
  if (found == program_.end()) throw Refusal("a call of " + hex(address) + ", where no function begins");
  const Function& function = found->second;
  if (std::find(callers.begin(), callers.end(), address) != callers.end()) throw Refusal("recursion: " + function.name);
  if (bodies_.count(address) != 0 || bounds_.instructions(function.name)) return;
  callers.push_back(address);
  Body body{graph_of(function), {}, {}};
  for (const Block& block : body.graph.blocks) {
    Path path;
    std::set<const void*> paid;
    for (std::size_t i = block.begin; i < block.end; ++i) {
      const Instruction& instruction = function.instructions[i];
      path.length += cost(function, i);
      const Spending spends = bounds_.spends(instruction);
      if (spends.budget.empty()) continue;
      path.spend(budget(spends.budget), spends.number);
      const bool of_any_kind = instruction.mnemonic == "str" || flow_of(instruction).calls;
      if (of_any_kind && !paid.insert(spends.by).second)
        throw Refusal(hex(instruction.address) + ": a second " + instruction.mnemonic + " that spends " +
                      spends.budget);
    }
    body.blocks.push_back(path);
  }
  for (std::size_t loop = 0; loop < body.graph.loops.size(); ++loop) {
    if (body.graph.loops[loop].header == 0) throw Refusal(function.name + ": a loop at its very entry");
    body.repeats.push_back(bounds_.repeats(function, body.graph, loop));
  }
  for (const std::size_t b : body.graph.order) {
    for (const std::uint32_t callee : body.graph.blocks[b].callees) add(callee, callers);
  }
  bodies_.emplace(address, std::move(body));
  callers.pop_back();
}

/// Blocks in their order, each after all that lead to it; a loop inside is passed as a whole.
LongestPath::Ways LongestPath::ways(const Body& body, const std::vector<Path>& blocks, std::size_t start,
                                    const std::vector<bool>& within, const std::map<std::size_t, Ways>& inner,
                                    const Prices& prices) const {
  Ways all;
  std::vector<Path> before(blocks.size(), Path::none());
  before[start] = {};
  const auto reach = [&](std::size_t block, const Path& path) {
    Path& longest = block == start                       ? all.again
                    : block == kReturn || !within[block] ? all.out.emplace(block, Path::none()).first->second
                                                         : before[block];
    longest = longer(longest, path, prices);
  };
  for (const std::size_t b : body.graph.order) {
    if (!before[b].exists) continue;
    const auto loop = b == start ? inner.end() : inner.find(b);
    if (loop != inner.end()) {
      for (const auto& [block, path] : loop->second.out) reach(block, before[b].then(path));
      continue;
    }
    const Path after = before[b].then(blocks[b]);
    const Path left = after.longer_by(costs_.leaving());
    const Block& block = body.graph.blocks[b];
    for (const std::size_t next : block.next) reach(next, block.branches(body.graph.blocks[next]) ? left : after);
    if (block.returns) reach(kReturn, left);
  }
  return all;
}

Path LongestPath::longest(std::uint32_t address, const Prices& prices) {
  const Function& function = program_.at(address);
  if (const auto instructions = bounds_.instructions(function.name)) return given(function, *instructions);
  const auto known = known_.find(address);
  if (known != known_.end()) return known->second;
  const Body& body = bodies_.at(address);
  std::vector<Path> blocks = body.blocks;
  for (const std::size_t b : body.graph.order) {
    for (const std::uint32_t callee : body.graph.blocks[b].callees) blocks[b] = blocks[b].then(longest(callee, prices));
  }
  std::map<std::size_t, Ways> loops;  // by header
  for (std::size_t i = 0; i < body.graph.loops.size(); ++i) {
    const Loop& loop = body.graph.loops[i];
    const Bounds::Repeats& repeats = body.repeats[i];
    Ways through = ways(body, blocks, loop.header, loop.has, loops, prices);
    if (!repeats.most) {
      through.out.clear();  // never entered
    } else if (through.again.exists) {
      Path round = through.again;
      if (!repeats.spends.budget.empty()) round.spend(budget(repeats.spends.budget), repeats.spends.number);
      if (round.worth(prices) > 0) {
        for (auto& [block, path] : through.out) path = path.then(round, *repeats.most);
      }
    }
    if (repeats.first_too) {
      for (auto& [block, path] : through.out) path.spend(budget(repeats.spends.budget), repeats.spends.number);
    }
    loops[loop.header] = through;
  }
  const std::vector<bool> everywhere(blocks.size(), true);
  const Ways whole = ways(body, blocks, 0, everywhere, loops, prices);
  const auto returns = whole.out.find(kReturn);
  if (returns == whole.out.end()) throw Refusal(program_.at(address).name + ": does not return");
  return known_[address] = returns->second;
}

std::int64_t LongestPath::bound() {
  constexpr int kRounds = 500;  // some tens are enough; what is found by then is a bound in any case
  std::vector<std::int64_t> budgets;
  for (const auto& [name, number] : bounds_.budgets()) budgets.push_back(number);
  Mixture mixture(budgets);
  std::int64_t best = -1;
  for (int i = 0; i < kRounds; ++i) {
    const Prices prices = mixture.prices();
    known_.clear();
    const Path path = longest(root_, prices);
    std::int64_t bound = path.worth(prices);
    for (std::size_t b = 0; b < budgets.size(); ++b) bound += budgets[b] * prices[b];
    if (best < 0 || bound < best) best = bound;
    if (!mixture.add(path)) break;
  }
  return best / kPriceUnit;  // a path's length is whole
}

}  // namespace worst_tick

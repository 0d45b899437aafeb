// worst_tick LISTING PLACES LIMITS BOUNDS ROOT [cortex-m4]: the most instructions that the functions whose names match
// ROOT take, with all that they call, whatever their input. With cortex-m4, after that, the most cycles at zero wait
// states and at 5 (costs.hpp). It reads machine code, so it holds for this image only, but for every path through it.
//
//   LISTING   objdump -d --no-show-raw-insn of the image
//   PLACES    addr2line -a -i of the listing's addresses
//   LIMITS    what the image tells of its tables: lines "limit NAME NUMBER"
//   BOUNDS    how often loops run: bounds.hpp
//
// What a bound rests on besides the machine code: the bounds file; the line table, where it names the branch that
// leaves a loop, and the instructions that spend; and that the compiler neither computes in float where the source does
// not (it may not: -ftrapping-math) nor shares such an instruction between two lines. A loop's test is one comparison,
// and no loop's body is empty. Whatever else the tool does not know it refuses, with the place; exit status 1.
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "bounds.hpp"
#include "costs.hpp"
#include "listing.hpp"
#include "longest_path.hpp"

namespace worst_tick {
namespace {

class SourceFiles : public Sources {
 public:
  std::string line(const Place& place) override {
    if (place.line <= 0) return "";
    const auto [found, is_new] = files_.try_emplace(place.file);
    if (is_new) {
      std::ifstream in(place.file);
      for (std::string line; std::getline(in, line);) found->second.push_back(line);
    }
    const auto index = static_cast<std::size_t>(place.line) - 1;
    return index < found->second.size() ? found->second[index] : "";
  }

 private:
  std::map<std::string, std::vector<std::string>> files_;
};

[[nodiscard]] std::ifstream opened(const char* path) {
  std::ifstream in(path);
  if (!in) throw Refusal(std::string("cannot read ") + path);
  return in;
}

[[nodiscard]] Numbers limits_in(std::istream& in) {
  Numbers limits;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string word, name;
    std::int64_t number = 0;
    if (words >> word >> name >> number && word == "limit") limits[name] = number;
  }
  return limits;
}

/// The most of any function whose name matches.
[[nodiscard]] std::int64_t worst(const Program& program, const Bounds& bounds, const Costs& costs,
                                 const std::string& pattern) {
  std::int64_t most = 0;
  for (const auto& [address, function] : program) {
    if (matches(function.name, pattern)) most = std::max(most, LongestPath(program, bounds, costs, address).bound());
  }
  if (most == 0) throw Refusal("no function matches " + pattern);
  return most;
}

int run(int count, char** argument) {
  std::ifstream listing = opened(argument[1]), places = opened(argument[2]), limits = opened(argument[3]),
                bounds_file = opened(argument[4]);
  Program program = read_listing(listing);
  read_places(places, program);
  SourceFiles sources;
  const Bounds bounds(bounds_file, limits_in(limits), sources);
  std::cout << worst(program, bounds, InstructionCosts(), argument[5]);
  if (count > 6) {
    if (std::string(argument[6]) != "cortex-m4") throw Refusal(std::string("no cycles are known of ") + argument[6]);
    for (const std::int64_t wait_states : {std::int64_t{0}, kCortexM4FlashWaitStates})
      std::cout << ' ' << worst(program, bounds, CortexM4Costs(wait_states), argument[5]);
  }
  std::cout << '\n';
  return 0;
}

}  // namespace
}  // namespace worst_tick

int main(int count, char** argument) {
  if (count != 6 && count != 7) {
    std::cerr << "worst_tick LISTING PLACES LIMITS BOUNDS ROOT [cortex-m4]\n";
    return 2;
  }
  try {
    return worst_tick::run(count, argument);
  } catch (const worst_tick::Refusal& refusal) {
    std::cerr << "worst_tick: " << refusal.what() << '\n';
    return 1;
  }
}

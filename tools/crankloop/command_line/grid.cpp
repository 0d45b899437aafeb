#include "grid.hpp"

#include <cmath>

#include "../files/error.hpp"
#include "../files/words.hpp"

namespace crankloop::program {

std::vector<double> Grid::values() const {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(at(i));
  return values;
}

Grid parse_grid(const std::string& name, std::string_view text, const Range& range, int max_count,
                const char* example) {
  const auto parts = split(text, ':');
  if (parts.size() != 3) throw UsageError(name + ": give FROM:TO:N, like " + example);
  constexpr const char* kNames[] = {"FROM", "TO", "N, the number of values"};
  double numbers[3] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const ParsedNumber number = parse_number(parts[i], i < 2 ? range : from(1).up_to(max_count), "");
    if (!number.ok()) throw UsageError(name + ": " + kNames[i] + ": " + number.problem);
    numbers[i] = number.value;
  }
  if (numbers[2] != std::floor(numbers[2]))
    throw UsageError(name + ": " + kNames[2] + ": " + in_quotes(parts[2]) + " is not a whole number");
  if (numbers[2] == 1 ? numbers[0] != numbers[1] : numbers[0] >= numbers[1])
    throw UsageError(name + ": FROM must be less than TO, or the same with N = 1");
  return {numbers[0], numbers[1], static_cast<int>(numbers[2])};
}

}  // namespace crankloop::program

// A way through code: how long it is, in instructions or cycles, and what it spends of a tick's budgets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace worst_tick {

/// What one spends of each budget costs, in 1/1024 of the unit of length: whole numbers, so that no rounding weakens a
/// bound.
using Prices = std::vector<std::int64_t>;
inline constexpr std::int64_t kPriceUnit = 1024;

struct Path {
  std::int64_t length = 0;
  std::vector<std::int64_t> spent;  ///< per budget
  bool exists = true;

  [[nodiscard]] static Path none() { return {0, {}, false}; }

  /// What is left of its length once it has paid.
  [[nodiscard]] std::int64_t worth(const Prices& prices) const {
    std::int64_t sum = length * kPriceUnit;
    for (std::size_t i = 0; i < spent.size(); ++i) sum -= spent[i] * prices[i];
    return sum;
  }

  /// This, and `times` times the other after it.
  [[nodiscard]] Path then(const Path& other, std::int64_t times = 1) const {
    if (!exists || !other.exists) return none();
    Path both = *this;
    both.length += times * other.length;
    for (std::size_t i = 0; i < other.spent.size(); ++i) both.spend(i, times * other.spent[i]);
    return both;
  }

  [[nodiscard]] Path longer_by(std::int64_t more) const {
    Path path = *this;
    path.length += more;
    return path;
  }

  void spend(std::size_t budget, std::int64_t number = 1) {
    if (spent.size() <= budget) spent.resize(budget + 1, 0);
    spent[budget] += number;
  }
};

/// The one that is worth more.
[[nodiscard]] inline const Path& longer(const Path& a, const Path& b, const Prices& prices) {
  if (!a.exists || !b.exists) return a.exists ? a : b;
  return b.worth(prices) > a.worth(prices) ? b : a;
}

}  // namespace worst_tick

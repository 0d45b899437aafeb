// Evenly spaced numbers, as "FROM:TO:N" on a command line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "../files/number.hpp"

namespace crankloop::program {

/// `count` numbers from `from` to `to`, evenly spaced.
struct Grid {
  double from = 0;
  double to = 0;
  int count = 1;

  [[nodiscard]] double at(int i) const noexcept { return count > 1 ? from + (to - from) * i / (count - 1) : from; }
  [[nodiscard]] std::vector<double> values() const;
};

/// Throws UsageError, which begins with `name`: for a number that is no number or out of the range, and for more than
/// `max_count` of them. `example`: "800:6000:14".
[[nodiscard]] Grid parse_grid(const std::string& name, std::string_view text, const Range& range, int max_count,
                              const char* example);

}  // namespace crankloop::program

#include "race.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>

#include "port/linux/stopwatch.hpp"

namespace crankloop::program::bench {

double quantile(std::vector<double>& sample, double part) {
  std::sort(sample.begin(), sample.end());
  const double place = part * static_cast<double>(sample.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sample.size() - 1);
  return sample[below] + (place - static_cast<double>(below)) * (sample[above] - sample[below]);
}

Timing timing_of(std::vector<double>& sample) {
  return {quantile(sample, 0.5), quantile(sample, 0.75) - quantile(sample, 0.25)};
}

double middle_mean(std::vector<double>& sample) {
  std::sort(sample.begin(), sample.end());
  const auto quarter = static_cast<std::ptrdiff_t>(sample.size() / 4);
  const auto first = sample.begin() + quarter;
  const auto last = sample.end() - quarter;
  return std::accumulate(first, last, 0.0) / static_cast<double>(last - first);
}

double clock_cost_ns(Clock& clock) {
  std::vector<double> readings(2001);
  for (double& reading : readings) {
    const std::int64_t begin = clock();
    reading = static_cast<double>(clock() - begin);
  }
  return middle_mean(readings);
}

std::vector<Timing> race(const std::vector<Contestant>& contestants, const Effort& effort) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (effort.rounds == 0) return std::vector<Timing>(contestants.size(), {kNone, kNone});
  const double clock_ns = clock_cost_ns(port::thread_ns);
  const auto turn_ns = [&](const Contestant& one, int batches) {
    const std::int64_t begin = port::thread_ns();
    for (int i = 0; i < batches; ++i) one.batch();
    return std::max(0.0, static_cast<double>(port::thread_ns() - begin) - clock_ns);
  };

  // The warm-up fills caches and measures how many batches fill a turn.
  std::vector<int> batches;
  for (const Contestant& one : contestants) {
    turn_ns(one, 1);
    batches.push_back(
        static_cast<int>(std::clamp(std::ceil(effort.round_ns / std::max(1.0, turn_ns(one, 1))), 1.0, 1e6)));
  }

  const std::size_t count = contestants.size();
  std::vector<std::vector<double>> samples(count);
  for (int round = 0; round < effort.rounds; ++round) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t which = (i + static_cast<std::size_t>(round)) % count;
      samples[which].push_back(turn_ns(contestants[which], batches[which]) /
                               (batches[which] * contestants[which].operations));
    }
    if (effort.progress != nullptr) effort.progress->long_step();
  }
  std::vector<Timing> timings;
  for (std::vector<double>& sample : samples) timings.push_back(timing_of(sample));
  return timings;
}

}  // namespace crankloop::program::bench

// The edges of a tick, of all wheels in the order of time.
//
// What belongs here: sorting them without allocating. What does not: where they go (live_loop.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <crankloop/limits.hpp>

#include "../../signals/signal_dump.hpp"

namespace crankloop::program {

/// Calls visit(time_ns, wheel, level) for each edge that the scene listed of the wheels' signals; times are since the
/// start of the tick, 0 to its length, rounded to the nanosecond. Edges of equal time go by wheel. Returns how many
/// were not listed: more in a tick than a scene has room for. O(edges * wheels).
template <class Signal, class Visit>
std::uint64_t each_edge_by_time(const Signal* signal, std::uint32_t wheels, std::int64_t tick_ns, const Visit& visit) {
  std::array<std::uint32_t, kMaxTriggerWheels> next{};
  std::uint64_t unlisted = 0;
  for (std::uint32_t w = 0; w < wheels; ++w) unlisted += signal[w].edge_count - listed_edges(signal[w]);
  for (;;) {
    std::uint32_t first = wheels;
    for (std::uint32_t w = 0; w < wheels; ++w) {
      if (next[w] == listed_edges(signal[w])) continue;
      if (first == wheels || signal[w].edge[next[w]].time_s < signal[first].edge[next[first]].time_s) first = w;
    }
    if (first == wheels) return unlisted;
    const auto& edge = signal[first].edge[next[first]++];
    const std::int64_t time_ns = std::llround(static_cast<double>(edge.time_s) * 1e9);
    visit(std::clamp<std::int64_t>(time_ns, 0, tick_ns), first, edge.level);
  }
}

}  // namespace crankloop::program

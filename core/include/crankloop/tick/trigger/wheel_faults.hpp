// What a controller sees of trigger wheels with faults.
//
// What belongs here: which faults are on, and what each makes of its wheel's signal. What does not: the changed wheels,
// which are tracks of their own (tables/trigger_tables.hpp), and the edges of a track (trigger_wheel.hpp).
//
//     track of the fault, or the healthy signal -> inverted, stuck -> pulse of noise -> edge where a fault comes or
//     goes
#pragma once

#include <cstdint>
#include <cstring>

#include <crankloop/faults.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/random.hpp>
#include <crankloop/tick/trigger/trigger_wheel.hpp>

namespace crankloop::detail {

/// At the start of the tick: each edge changes the level.
template <class Real, class S>
[[nodiscard]] std::uint32_t level_before(const TriggerSignal<Real, S>& signal) noexcept {
  return (signal.level ^ signal.edge_count) & 1u;
}

template <class Real, class S>
[[gnu::noinline]] void copy_edges(const TriggerSignal<Real, S>& from, TriggerSignal<Real, S>& to) noexcept {
  for (std::uint32_t e = 0; e < from.edge_count && e < S::trigger_edges; ++e) to.edge[e] = from.edge[e];
}
/// Most ticks have no edge: one word then.
template <class Real, class S>
[[gnu::always_inline]] inline void copy_signal(const TriggerSignal<Real, S>& from,
                                               TriggerSignal<Real, S>& to) noexcept {
  std::memcpy(&to, &from, sizeof from.level + sizeof from.edge_count);
  if (__builtin_expect(from.edge_count != 0, 0)) copy_edges(from, to);
}

/// A signal's edges in one tick, changed in place. O(edges listed).
template <class Real, class S>
class SignalEdges {
 public:
  explicit SignalEdges(TriggerSignal<Real, S>& signal) noexcept : signal_{signal} {}

  [[nodiscard]] std::uint32_t listed() const noexcept {
    return signal_.edge_count < S::trigger_edges ? signal_.edge_count : S::trigger_edges;
  }
  [[nodiscard]] std::uint32_t level() const noexcept { return signal_.level; }
  [[nodiscard]] std::uint32_t level_before() const noexcept { return detail::level_before(signal_); }

  void invert() noexcept { invert_from(0); }
  void hold(std::uint32_t level) noexcept { signal_.level = level, signal_.edge_count = 0; }

  /// From a time on the signal is inverted: one edge more there. Of more edges than are listed the place of a late one
  /// is not known: it is counted.
  void invert_from_time(Real time_s) noexcept {
    std::uint32_t place = 0;
    while (place < listed() && !(signal_.edge[place].time_s > time_s)) ++place;
    const std::uint32_t before = place == 0 ? level_before() : signal_.edge[place - 1].level;
    invert_from(place);
    insert(place, {time_s, before ^ 1u});
  }
  /// An edge at the start of the tick, to the level that the signal has there.
  void begin_with_edge() noexcept { insert(0, {Real{0}, level_before()}); }

  [[nodiscard]] bool out_of_room() const noexcept { return signal_.edge_count > S::trigger_edges; }

 private:
  void invert_from(std::uint32_t place) noexcept {
    for (std::uint32_t e = place; e < listed(); ++e) signal_.edge[e].level ^= 1u;
    signal_.level ^= 1u;
  }
  void insert(std::uint32_t place, const TriggerEdge<Real>& edge) noexcept {
    const std::uint32_t was_listed = listed();
    ++signal_.edge_count;
    if (place >= S::trigger_edges) return;
    for (std::uint32_t e = was_listed < S::trigger_edges ? was_listed : S::trigger_edges - 1; e > place; --e)
      signal_.edge[e] = signal_.edge[e - 1];
    signal_.edge[place] = edge;
  }

  TriggerSignal<Real, S>& signal_;
};

/// Whether a fault is on in the tick that the state has counted.
template <class Real, class S>
[[nodiscard]] inline bool is_on(const WheelFaultRule<Real>& fault, const State<Real, S>& state,
                                std::uint32_t input) noexcept {
  const std::uint64_t tick = state.ticks - 1;
  return (tick >= fault.from_tick && tick < fault.until_tick) || (input & fault.input_mask) != 0;
}

/// Bit i: fault i is on; and in `first` the first of each wheel, or the number of faults.
template <class Real, class S>
[[nodiscard]] inline std::uint32_t faults_on(const WheelFaultRules<Real>& rules, const State<Real, S>& state,
                                             std::uint32_t input,
                                             std::uint8_t (&first)[S::triggers.capacity]) noexcept {
  std::uint32_t on = 0;
  for (std::uint8_t& one : first) one = static_cast<std::uint8_t>(kMaxWheelFaults);
  for (std::uint32_t i = rules.count; i-- > 0;) {
    const WheelFaultRule<Real>& fault = rules.fault[i];
    if (!is_on(fault, state, input)) continue;
    on |= 1u << i;
    CRANKLOOP_ASSERT(fault.wheel < S::triggers.capacity);
    first[fault.wheel] = static_cast<std::uint8_t>(i);
  }
  return on;
}

/// What the fault does to the signal of its track; `random` is the fault's.
template <class Real, class S>
[[gnu::noinline]] void spoil(const WheelFaultRule<Real>& fault, Real tick_s, std::uint32_t& random,
                             SignalEdges<Real, S>& edges) noexcept {
  if (fault.inverted != 0) edges.invert();
  if (fault.stuck != 0) edges.hold(fault.stuck - 1);
  if (fault.noise_below == 0) return;
  if (next_random(random) - 1 >= fault.noise_below) return;
  constexpr Real kTwoToMinus24 = static_cast<Real>(1.0 / 16777216.0);
  const Real place = static_cast<Real>(static_cast<std::int32_t>(next_random(random) >> 8)) * kTwoToMinus24;
  const Real start_s = place * (Real{1} - fault.pulse) * tick_s;
  edges.invert_from_time(start_s);
  edges.invert_from_time(start_s + fault.pulse * tick_s);
}

/// An edge where the level changes between two ticks, unless the crank jumped, which shows none.
template <class Real, class S>
inline void join_ticks(State<Real, S>& state, std::uint32_t wheel, bool jumped, const TriggerSignal<Real, S>& healthy,
                       SignalEdges<Real, S>& edges) noexcept {
  const std::uint32_t last = level_before(healthy) ^ (state.wires_differ >> wheel & 1u);
  const bool first_tick = state.ticks == 1;
  if (!first_tick && !jumped && edges.level_before() != last) edges.begin_with_edge();
  const std::uint32_t differs = edges.level() ^ healthy.level;
  state.wires_differ = (state.wires_differ & ~(1u << wheel)) | differs << wheel;
}

}  // namespace crankloop::detail

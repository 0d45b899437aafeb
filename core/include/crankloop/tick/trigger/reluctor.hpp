// The voltage of a variable reluctance sensor within a tick, and the comparator that makes edges of it: docs/model.md
// "Analogue crank signal".
//
// What belongs here: samples and their comparison. What does not: the table (tables/reluctor_tables.hpp), where the
// crank is within a tick (trigger_wheel.hpp).
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/faults.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/trigger/trigger_wheel.hpp>

namespace crankloop::detail {

/// Samples are at whole 32nds of a tick, so that those of fewer are some of those of more, bit by bit.
inline constexpr std::uint32_t kSamplePlaces = 32;

/// Where the crank is, and how fast, at a 32nd of a tick: 1 to 32.
template <class Real>
struct CrankSample {
  const CrankPath<Real>& path;
  Real begin_rad_s;
  Real gain_rad_s;  ///< over the tick

  [[nodiscard]] static constexpr Real ratio(std::uint32_t place) noexcept {
    return static_cast<Real>(static_cast<std::int32_t>(place)) * static_cast<Real>(1.0 / kSamplePlaces);
  }
  [[nodiscard]] Real speed_rad_s(std::uint32_t place) const noexcept { return begin_rad_s + gain_rad_s * ratio(place); }
  [[nodiscard]] std::uint64_t phase(std::uint32_t place) const noexcept {
    const Real s = ratio(place);
    const auto part = static_cast<std::int64_t>(path.turned.units()) / std::int64_t{kSamplePlaces};
    const Phase bent = Phase::from_cycles(path.bend_cycles * (s * (s - 1)));
    return path.begin.units() + static_cast<std::uint64_t>(part * std::int64_t{place}) + bent.units();
  }
};

/// At an angle on the sensor's wheel from the centre of its first tooth, in units of 2^-64 turns.
template <class Real>
[[nodiscard]] inline Real reluctor_V(const ReluctorTable<Real>& table, std::uint64_t angle, Real speed_rad_s) noexcept {
  constexpr Real kTwoToMinus20 = static_cast<Real>(1.0 / 1048576.0);
  const std::uint64_t place = (angle >> 32) * table.cells;  // cell and, in its low word, where in the cell
  CRANKLOOP_ASSERT(place >> 32 < std::uint64_t{kReluctorCells});
  const ReluctorCell<Real>& cell = table.at[place >> 32];
  const Real u = static_cast<Real>(static_cast<std::int32_t>(static_cast<std::uint32_t>(place) >> 12)) * kTwoToMinus20;
  return speed_rad_s * (cell.c[0] + u * (cell.c[1] + u * cell.c[2]));
}

/// Makes edges of samples: up where an armed voltage falls through 0 (or the hysteresis below), down where the next
/// tooth arms it.
template <class Real, class S>
class Comparator {
 public:
  Comparator(const ReluctorTable<Real>& table, Real tick_s, group::ComparatorState<Real, S>& state,
             TriggerSignal<Real, S>& out) noexcept
      : table_{table}, tick_s_{tick_s}, state_{state}, out_{out} {
    const std::uint32_t late = state_.late_edges;
    out_.edge_count = 0;
    out_.level = (state_.comparator_level ^ late) & 1u;
    state_.late_edges = 0;
    for (std::uint32_t e = 0; e < late; ++e) show(state_.late_edge_s[e]);
    if (state_.comparator_quiet_ticks >= table.watchdog_ticks) state_.sensor_last_peak_V = Real{0};
    if (state_.comparator_quiet_ticks != ~std::uint32_t{0}) ++state_.comparator_quiet_ticks;
  }

  /// Between the sample before and this one, which come at these times.
  void take(Real voltage_V, Real before_s, Real spacing_s) noexcept {
    const Real before_V = state_.sensor_V;
    if (state_.comparator_armed == 0) {
      const Real by_peak_V = table_.arm_ratio * state_.sensor_last_peak_V;
      const Real arms_V = by_peak_V > table_.least_V ? by_peak_V : table_.least_V;
      if (voltage_V > arms_V) {
        state_.comparator_armed = 1;
        if (state_.comparator_level != 0) add(0, before_s + spacing_s * share(before_V, voltage_V, arms_V));
      }
    } else if (voltage_V <= -table_.hysteresis_V) {
      state_.comparator_armed = 0;
      state_.sensor_last_peak_V = state_.sensor_peak_V;
      state_.sensor_peak_V = Real{0};
      state_.comparator_quiet_ticks = 0;
      if (state_.comparator_level == 0) add(1, before_s + spacing_s * share(before_V, voltage_V, -table_.hysteresis_V));
    }
    if (voltage_V > state_.sensor_peak_V) state_.sensor_peak_V = voltage_V;
    state_.sensor_V = voltage_V;
  }

  /// Where nobody knows how the crank came here.
  void disarm() noexcept {
    state_.sensor_V = Real{0}, state_.comparator_armed = 0;
    out_.edge_count = 0, out_.level = state_.comparator_level;
  }

  /// Whether there were more edges than are listed.
  [[nodiscard]] bool finish() noexcept { return out_.edge_count > S::trigger_edges; }

 private:
  /// Of the way from one voltage to the other, where `at_V` is passed: 0 to 1.
  [[nodiscard]] static Real share(Real from_V, Real to_V, Real at_V) noexcept {
    const Real whole_V = to_V - from_V, part_V = at_V - from_V;
    if (whole_V == Real{0}) return Real{1};
    const Real ratio = part_V / whole_V;
    return ratio > 0 ? (ratio < 1 ? ratio : Real{1}) : Real{0};
  }
  void add(std::uint32_t level, Real time_s) noexcept {
    state_.comparator_level = level;
    const Real comes_s = time_s + table_.delay_s;
    if (comes_s < tick_s_ || !(table_.delay_s > 0) || state_.late_edges == S::reluctor_samples) return show(comes_s);
    state_.late_edge_s[state_.late_edges++] = comes_s - tick_s_;
  }
  /// In this tick.
  void show(Real time_s) noexcept {
    out_.level ^= 1u;
    if (out_.edge_count < S::trigger_edges) out_.edge[out_.edge_count] = {time_s, out_.level};
    ++out_.edge_count;
  }

  const ReluctorTable<Real>& table_;
  Real tick_s_;
  group::ComparatorState<Real, S>& state_;
  TriggerSignal<Real, S>& out_;
};

/// The samples of a tick and their edges. O(samples). Answers fault bits.
template <class Real, class S>
[[nodiscard]] std::uint32_t read_reluctor(const ReluctorTable<Real>& table, Real tick_s, State<Real, S>& state,
                                          Output<Real, S>& out, const CrankSample<Real>& crank) noexcept {
  constexpr std::uint32_t kStep = kSamplePlaces / S::reluctor_samples;
  const Real spacing_s = tick_s * CrankSample<Real>::ratio(kStep);
  Comparator<Real, S> comparator(table, tick_s, state, out.comparator);
  if (table.in_use == 0 || crank.path.jumped) {
    for (Real& voltage_V : out.reluctor_V) voltage_V = Real{0};
    comparator.disarm();
    return comparator.finish() ? std::uint32_t{kFaultTriggerEdges} : 0;
  }
  for (std::uint32_t i = 0; i < S::reluctor_samples; ++i) {
    const std::uint32_t place = (i + 1) * kStep;
    const std::uint64_t phase = crank.phase(place) - table.starts;
    out.reluctor_V[i] = reluctor_V(table, table.on_crank != 0 ? phase + phase : phase, crank.speed_rad_s(place));
    comparator.take(out.reluctor_V[i], tick_s * CrankSample<Real>::ratio(place - kStep), spacing_s);
  }
  return comparator.finish() ? std::uint32_t{kFaultTriggerEdges} : 0;
}

}  // namespace crankloop::detail

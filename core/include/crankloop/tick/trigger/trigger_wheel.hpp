// The edges of one trigger wheel in one tick, from the angle turned. Nothing is stored between ticks. The level follows
// from the phase. An edge at angle e belongs to the tick in which the wheel turns from below e to e or beyond, or back
// to below e. Phases and edges are integers, so no sequence of ticks loses an edge or counts it twice.
//
// What belongs here: one wheel. What does not: the loop over all wheels (triggers_step.hpp).
//
//                 bottom            top
//     ---|----------o------|---------o--------->  angle      forward: bottom < e <= top rise and fall as drawn;
//        e0                e1                                backward the same ones, the other way, from the top
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/phase.hpp>
#include <crankloop/scene.hpp>
#include <crankloop/tables/trigger_tables.hpp>
#include <crankloop/tick/one_instruction.hpp>
#include <crankloop/tick/trigger/trigger_output.hpp>

namespace crankloop::detail {

/// With s = 0 at the start of the tick and 1 at its end,
///
///     angle(s) = begin + turned s + bend s (s - 1)
///
/// At a constant speed the bend is 0. If the speed changes linearly from w0 to w1, the bend is (w1 - w0) tick / 2 as an
/// angle, and the crank may reverse in the tick: at s = (1 - turned/bend) / 2.
template <class Real>
struct CrankPath {
  Phase begin;
  Phase turned;      ///< signed: less than a crank revolution either way
  bool jumped;       ///< a measured phase jumped: the path is unknown
  Real bend_cycles;  ///< in cycles of 720 deg
};

/// The last edge at or before an angle. At most 10 comparisons; one or two for evenly spaced teeth.
[[nodiscard]] inline std::uint32_t edge_behind(const TriggerTrack& wheel, std::uint32_t angle) noexcept {
  static_assert(kTriggerParts == 1 << 7);
  CRANKLOOP_ASSERT(wheel.edge_count >= 2 && wheel.edges[0] == 0);
  const std::uint16_t* part = &wheel.edges_before[angle >> 25];
  std::uint32_t low = part[0];
  std::uint32_t high = part[1];
  while (low < high) {
    const std::uint32_t middle = (low + high) / 2;
    if (wheel.edges[middle] <= angle) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  CRANKLOOP_ASSERT(low >= 1 && low <= wheel.edge_count && wheel.edges[low - 1] <= angle);
  return low - 1;  // the first edge is at 0, so there always is one
}

/// Level of the signal after an edge in forward rotation.
[[nodiscard]] inline std::uint32_t level_beyond(const TriggerTrack& wheel, std::uint32_t edge) noexcept {
  return (~edge & 1u) ^ wheel.inverted;
}

/// Converts units (2^64 = 1) to a ratio; drops their last two bits.
template <class Real>
[[nodiscard]] constexpr Real ratio_of(std::uint64_t units) noexcept {
  constexpr Real two_to_minus_31 = static_cast<Real>(1.0 / 2147483648.0);
  const auto high = static_cast<std::int32_t>(static_cast<std::uint32_t>(units >> 33));
  const auto low = static_cast<std::int32_t>(static_cast<std::uint32_t>(units >> 2) & 0x7FFF'FFFFu);
  return (static_cast<Real>(high) + static_cast<Real>(low) * two_to_minus_31) * two_to_minus_31;
}

/// Part of a tick in which the wheel turns in one direction: start and span (less than a turn) in units of 2^-64 turns.
struct Sweep {
  std::uint64_t from;
  std::uint64_t span;
  bool forward;

  [[nodiscard]] std::uint64_t to() const noexcept { return forward ? from + span : from - span; }
};

/// Time at which a wheel has turned by a distance d = slope (s - since) + bend (s - since)^2 in turns. Only the bend
/// may be negative.
template <class Real>
struct BentPace {
  Real since;
  Real slope;
  Real bend;

  void prepare(std::uint64_t) const noexcept {}

  /// The form of the root without cancellation. After a reversal the slope is 0.
  [[nodiscard]] Real ratio_at(Real distance) const noexcept {
    const Real square = slope * slope + 4 * bend * distance;  // square of the speed at the edge
    const Real speeds = slope + (square > 0 ? square_root(square) : Real{0});
    return speeds > 0 ? since + 2 * distance / speeds : since;
  }
};

/// The time at a constant speed. Divides only when there is an edge.
template <class Real>
struct EvenPace {
  Real per_span{};

  void prepare(std::uint64_t span) noexcept {
    const Real whole = ratio_of<Real>(span);
    per_span = whole > 0 ? Real{1} / whole : Real{0};
  }
  [[nodiscard]] Real ratio_at(Real distance) const noexcept { return distance * per_span; }
};

/// Computes one wheel's signal.
template <class Real, class S>
class TriggerTick {
 public:
  TriggerTick(const TriggerTrack& wheel, Real tick_s, TriggerSignal<Real, S>& out) noexcept
      : wheel_{wheel}, tick_s_{tick_s}, out_{out} {
    out_.edge_count = 0;
  }

  /// Whether there were more edges than it lists.
  [[nodiscard]] bool out_of_room() const noexcept { return out_of_room_; }

  /// After a jump of the phase: sets the level and lists no edges.
  void leap(std::uint64_t to) noexcept { stand_at(edge_behind(wheel_, angle(to))); }

  /// Turns the wheel at a constant speed.
  void turn(const Sweep& sweep) noexcept { pass(sweep, EvenPace<Real>{}); }

  /// Turns the wheel at a linearly changing speed. `bend` as in CrankPath, but in turns of this wheel.
  void turn(const Sweep& sweep, Real bend) noexcept {
    const Real turned = sweep.forward ? ratio_of<Real>(sweep.span) : -ratio_of<Real>(sweep.span);
    const Real slope = turned - bend;
    const Real slope_at_end = turned + bend;
    const bool turns_round = (slope > 0 && slope_at_end < 0) || (slope < 0 && slope_at_end > 0);
    if (turns_round) {
      turn_round(sweep, slope, bend);
    } else {
      pass(sweep, BentPace<Real>{Real{0}, magnitude(slope), sweep.forward ? bend : -bend});
    }
  }

 private:
  [[nodiscard]] static std::uint32_t angle(std::uint64_t at) noexcept { return static_cast<std::uint32_t>(at >> 32); }

  void stand_at(std::uint32_t edge) noexcept { out_.level = level_beyond(wheel_, edge); }

  /// Two sweeps: to the point of reversal and back. Both use the same rounded point.
  void turn_round(const Sweep& tick, Real slope, Real bend) noexcept {
    constexpr Real kMax = static_cast<Real>(0.999);  // turns; at the speed limit it is half a turn
    CRANKLOOP_ASSERT(bend != 0);
    const Real since = slope / (-2 * bend);
    CRANKLOOP_ASSERT(since >= 0 && since <= 1);  // 1 included: it is rounded
    const Real reach = magnitude(slope) * since / 2;
    const bool outward = slope > 0;
    const bool ends_beyond = tick.forward == outward;  // beyond the start, in the direction of the first sweep
    std::uint64_t out = Phase::from_cycles(reach < kMax ? reach : kMax).units();
    if (ends_beyond && out < tick.span) out = tick.span;
    const Sweep there{tick.from, out, outward};
    const Sweep back{there.to(), ends_beyond ? out - tick.span : out + tick.span, !outward};
    pass(there, BentPace<Real>{Real{0}, magnitude(slope), -magnitude(bend)});
    pass(back, BentPace<Real>{since, Real{0}, magnitude(bend)});
  }

  /// Most sweeps pass no edge: one search and a comparison.
  template <class Pace>
  void pass(const Sweep& sweep, const Pace& pace) noexcept {
    const std::uint64_t top = sweep.forward ? sweep.to() : sweep.from;
    const std::uint32_t last = edge_behind(wheel_, angle(top));
    if (top - at(last) < sweep.span) {
      list(sweep, last, pace);
    } else {  // the edge lies at the bottom or below
      stand_at(last);
    }
  }

  /// Counts the edges of a sweep up to `last`, lists as many as there is room for, and sets the level at the sweep's
  /// end. Not inlined, so that a sweep without edges does not save its registers.
  template <class Pace>
  [[gnu::noinline]] void list(const Sweep& sweep, std::uint32_t last, Pace pace) noexcept {
    const std::uint64_t bottom = sweep.forward ? sweep.from : sweep.to();
    const std::uint32_t before_first = edge_behind(wheel_, angle(bottom));
    const std::uint32_t passed = last > before_first ? last - before_first : last + wheel_.edge_count - before_first;
    CRANKLOOP_ASSERT(passed >= 1 && passed <= wheel_.edge_count);
    pace.prepare(sweep.span);
    const std::uint32_t step = sweep.forward ? 1 : wheel_.edge_count - 1;  // to the next edge, modulo their number
    std::uint32_t edge = sweep.forward ? wrapped(before_first + 1) : last;
    const std::uint32_t most = max_listed();
    const std::uint32_t room = out_.edge_count < most ? most - out_.edge_count : 0;
    const std::uint32_t listed = passed < room ? passed : room;
    TriggerEdge<Real>* entry = out_.edge + (most - room);  // at the end if an earlier sweep has filled the list
    CRANKLOOP_ASSERT(entry + listed <= out_.edge + S::trigger_edges);
    for (std::uint32_t i = 0; i < listed; ++i, ++entry, edge = wrapped(edge + step)) {
      const std::uint64_t distance = sweep.forward ? at(edge) - sweep.from : sweep.from - at(edge);
      later(pace.ratio_at(ratio_of<Real>(distance)));
      entry->time_s = latest_ * tick_s_;
      entry->level = level_beyond(wheel_, edge) ^ (sweep.forward ? 0u : 1u);
    }
    out_.edge_count += passed;
    if (passed > room) out_of_room_ = true;
    stand_at(sweep.forward ? last : before_first);
  }

  /// Per tick; a crank that reverses may pass its edges twice.
  [[nodiscard]] std::uint32_t max_listed() const noexcept {
    const std::uint32_t passed = Needs<S>::crank_dynamics ? 2 * wheel_.max_edges : wheel_.max_edges;
    return passed < S::trigger_edges ? passed : S::trigger_edges;
  }

  [[nodiscard]] std::uint64_t at(std::uint32_t edge) const noexcept { return std::uint64_t{wheel_.edges[edge]} << 32; }
  [[nodiscard]] std::uint32_t wrapped(std::uint32_t edge) const noexcept {
    return edge < wheel_.edge_count ? edge : edge - wheel_.edge_count;
  }

  /// Limits the time, so that rounding neither swaps two edges nor puts one beyond the tick.
  void later(Real ratio) noexcept {
    CRANKLOOP_ASSERT(latest_ >= 0 && latest_ <= 1);
    if (ratio > latest_) latest_ = ratio < 1 ? ratio : Real{1};
  }

  const TriggerTrack& wheel_;
  Real tick_s_;
  TriggerSignal<Real, S>& out_;
  Real latest_{0};  ///< time of the edge listed last, as a fraction of the tick
  bool out_of_room_ = false;
};

}  // namespace crankloop::detail

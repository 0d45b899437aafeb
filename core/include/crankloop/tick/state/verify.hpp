// A check of an engine's state where it stands in memory, between two steps.
//
// What belongs here: whether a step could have left the state. What does not: the fields and their ranges
// (state_fields.hpp), a state as bytes (saved_state.hpp).
#pragma once

#include <crankloop/engine.hpp>
#include <crankloop/tick/state/field_ranges.hpp>
#include <crankloop/tick/state/gas_agrees.hpp>
#include <crankloop/tick/state/misfire_counts.hpp>
#include <crankloop/tick/state/state_fields.hpp>

namespace crankloop {
namespace detail {

/// Of a state whose fields are in their ranges: whether the tables' engine could have it.
template <class Real, class S>
[[nodiscard]] Status fits(const State<Real, S>& state, const Tables<Real, S>& tables) noexcept {
  const Real limit_rad_s = tables.drive->speed_limit_rad_s;
  if (!within(state.speed_rad_s, -limit_rad_s, limit_rad_s)) return refuse("state.drive", Reason::out_of_range);
  if constexpr (Needs<S>::gas) {
    if (!gas_agrees(state, tables)) return refuse("state.gas", Reason::inconsistent);
  }
  return {};
}

}  // namespace detail

/// Looks for memory faults: refuses a state that no step leaves, with a number that is not finite or out of its range
/// or that contradicts another, as load_state() refuses its bytes; without a buffer, and the engine stays as it is.
/// What it cannot see is a wrong number that an engine could have. Not while a step runs. O(state).
///
/// What an engine with elastic valves keeps beside its state is not looked at: restore(engine.state()) makes it anew.
template <class Real, class S>
Status verify(const Engine<Real, S>& engine) noexcept {
  if (engine.tables() == nullptr) return refuse("tables", Reason::missing_table);
  const State<Real, S>& state = engine.state();
  if (state.fingerprint != engine.tables()->drive->fingerprint)
    return refuse("state.fingerprint", Reason::other_tables);
  detail::FieldRanges ranges;
  detail::StateFields<Real, S>::visit(state, ranges);
  if (!ranges.status().ok()) return ranges.status();
  if constexpr (S::misfire) {
    for (const MisfireRecord& record : state.misfire) {
      MisfireRecord counted = record;
      detail::recount(counted);
      if (counted.in_200_turns != record.in_200_turns || counted.in_1000_turns != record.in_1000_turns)
        return refuse("state.misfire", Reason::inconsistent);
    }
  }
  return detail::fits(state, *engine.tables());
}

}  // namespace crankloop

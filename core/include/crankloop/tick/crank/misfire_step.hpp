// Where cycles under a pressure diagram begin: which of them misfire.
//
// What belongs here: all cylinders of an engine over one tick. What does not: the rules (misfire.hpp), cycles of gas,
// which begin where they take their fuel (gas/gas_cycle.hpp).
#pragma once

#include <cstdint>

#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/crank/cycle_way.hpp>
#include <crankloop/tick/crank/misfire.hpp>

namespace crankloop::detail {

/// Where a diagram's cycle begins: 90 deg before its firing top dead centre, ahead of any heat.
inline constexpr std::uint64_t kCycleBegins = std::uint64_t{7} << 61;

/// Notes what a tick need not ask each cylinder: which of them lack heat, and the part of the turn about the phase in
/// which no cycle begins or ends. Begins and ends lie at multiples of 90 deg of a cylinder's own angle. O(cylinders).
template <class Real, class S>
[[gnu::noinline]] void note_cycles(const Tables<Real, S>& tables, State<Real, S>& state) noexcept {
  constexpr std::uint64_t kLast = (std::uint64_t{1} << 61) - 1;  // unit of a quarter turn
  const Drive<Real>& drive = *tables.drive;
  std::uint64_t behind = kLast, ahead = kLast;
  for (std::uint32_t m = 0; m < drive.mechanisms; ++m) {
    const std::uint64_t in_quarter = (state.phase.units() - drive.firing_phase[m]) & kLast;
    if (in_quarter < behind) behind = in_quarter;
    if (kLast - in_quarter < ahead) ahead = kLast - in_quarter;
  }
  state.cycles_go_on_from = state.phase.units() - behind;
  state.cycles_go_on = behind + ahead + 1;
  state.lacking_heat = 0;
  for (std::uint32_t k = 0; k < count<S>(drive.cylinders); ++k)
    state.lacking_heat |= std::uint32_t{state.burning_ratio[k] < 1} << k;
}

template <class Real, class S>
[[gnu::cold]] void start_misfires(const Tables<Real, S>& tables, State<Real, S>& state) noexcept {
  for (std::uint32_t k = 0; k < count<S>(tables.drive->cylinders); ++k)
    state.misfire[k].random = tables.misfires[k].seed;
  if constexpr (Needs<S>::misfire_of_table) {
    for (Real& ratio : state.burning_ratio) ratio = Real{1};
    note_cycles(tables, state);
  }
}

/// One cylinder, whose `way` may pass its cycle's end, its begin or neither. A crank that turns back over a cycle's end
/// and forward again has begun another; one that turns back over its begin alone has not.
template <class Real, class S>
void pass_cycle(const Tables<Real, S>& tables, State<Real, S>& state, std::uint32_t k, const CycleWay& way) noexcept {
  MisfireRecord& record = state.misfire[k];
  if (way.passes_end()) record.taken = 0;
  if (record.taken != 0 || !way.passes_forward(kCycleBegins)) return;
  record.taken = 1;
  state.burning_ratio[k] = begin_cycle(tables.misfires[k], record);
}

template <class Real, class S>
[[gnu::noinline]] void pass_all_cycles(const Tables<Real, S>& tables, State<Real, S>& state, Phase turned) noexcept {
  const Drive<Real>& drive = *tables.drive;
  for (std::uint32_t k = 0; k < count<S>(drive.cylinders); ++k) {
    const std::uint64_t own = state.phase.units() - drive.firing_phase[drive.mechanism_of[k]];
    const auto way = static_cast<std::int64_t>(turned.units());
    pass_cycle(tables, state, k, {own + (std::uint64_t{drive.turn_of[k]} << 63), way});
  }
  note_cycles(tables, state);
}

/// All cylinders, once the crank has turned by `turned`, less than a turn: most ticks pass nothing. O(1) in those.
template <class Real, class S>
[[gnu::always_inline]] inline void pass_cycles(const Tables<Real, S>& tables, State<Real, S>& state,
                                               Phase turned) noexcept {
  if (__builtin_expect(state.phase.units() - state.cycles_go_on_from >= state.cycles_go_on, 0))
    pass_all_cycles(tables, state, turned);
}

}  // namespace crankloop::detail

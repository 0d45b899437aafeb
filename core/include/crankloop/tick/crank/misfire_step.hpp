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

template <class Real, class S>
[[gnu::cold]] void start_misfires(const Tables<Real, S>& tables, State<Real, S>& state) noexcept {
  for (std::uint32_t k = 0; k < count<S>(tables.drive->cylinders); ++k)
    state.misfire[k].random = tables.misfires[k].seed;
  if constexpr (Needs<S>::misfire_of_table) {
    for (Real& ratio : state.burning_ratio) ratio = Real{1};
  }
}

/// One cylinder, whose `way` may pass its cycle's end, its begin or neither. A crank that turns back over a cycle's end
/// and forward again has begun another; one that turns back over its begin alone has not.
template <class Real, class S>
void pass_cycles(const Tables<Real, S>& tables, State<Real, S>& state, std::uint32_t k, const CycleWay& way) noexcept {
  MisfireRecord& record = state.misfire[k];
  if (way.passes_end()) record.taken = 0;
  if (record.taken != 0 || !way.passes_forward(kCycleBegins)) return;
  record.taken = 1;
  state.burning_ratio[k] = begin_cycle(tables.misfires[k], record);
}

/// The cylinders of one mechanism.
template <class Real, class S>
[[gnu::noinline]] void pass_cycles_of_mechanism(const Tables<Real, S>& tables, State<Real, S>& state, std::uint32_t m,
                                                const CycleWay& own) noexcept {
  const Drive<Real>& drive = *tables.drive;
  for (std::uint32_t k = 0; k < count<S>(drive.cylinders); ++k) {
    if (drive.mechanism_of[k] != m) continue;
    pass_cycles(tables, state, k, {own.to + (std::uint64_t{drive.turn_of[k]} << 63), own.turned});
  }
}

/// All cylinders, once the crank has turned by `turned`. Begins and ends of cycles lie at multiples of 90 deg, of which
/// most ticks pass none. O(mechanisms).
template <class Real, class S>
[[gnu::always_inline]] inline void pass_cycles(const Tables<Real, S>& tables, State<Real, S>& state,
                                               Phase turned) noexcept {
  const Drive<Real>& drive = *tables.drive;
  const std::uint32_t mechanisms = S::cylinders.capacity == 1 ? 1 : drive.mechanisms;
  for (std::uint32_t m = 0; m < mechanisms; ++m) {
    const CycleWay own{(state.phase.units() - drive.firing_phase[m]), static_cast<std::int64_t>(turned.units())};
    if (__builtin_expect((own.from() ^ own.to) >> 61 != 0, 0)) pass_cycles_of_mechanism(tables, state, m, own);
  }
}

}  // namespace crankloop::detail

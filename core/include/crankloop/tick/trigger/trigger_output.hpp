// The signals of trigger wheels during a tick.
//
// What belongs here: the output group. What does not: how edges are found (trigger_wheel.hpp).
#pragma once

#include <cstdint>

#include <crankloop/scene.hpp>

namespace crankloop {

template <class Real>
struct TriggerEdge {
  Real time_s;          ///< since the tick's start, 0 to the tick's length; never before the edge listed before it
  std::uint32_t level;  ///< of the signal after the edge: 1 = rising edge, 0 = falling edge
};

/// One wheel.
template <class Real, class S>
struct TriggerSignal {
  std::uint32_t level;       ///< 0 or 1, at the end of the tick
  std::uint32_t edge_count;  ///< in this tick; with more than S::trigger_edges the first of them are listed, and
                             ///< kFaultTriggerEdges is set
  TriggerEdge<Real> edge[S::trigger_edges];  ///< in order of time; entries beyond edge_count are undefined
};

namespace group {
template <class Real, class S>
struct Triggers {
  TriggerSignal<Real, S> trigger[S::triggers.capacity];
};
/// What a controller sees: each wheel's signal with the first of its faults that is on, else the healthy one. Where a
/// fault comes or goes and the level changes with it, an edge at time 0 shows it.
template <class Real, class S>
struct FaultyTriggers {
  TriggerSignal<Real, S> faulty_trigger[S::triggers.capacity];
};
/// The definition's variable reluctance sensor; 0 without one.
template <class Real, class S>
struct ReluctorSignal {
  Real reluctor_V[S::reluctor_samples];  ///< sample i, from 0, at (i + 1) / reluctor_samples of the tick; 0 where a
                                         ///< measured phase jumped
  TriggerSignal<Real, S> comparator;     ///< rises where the voltage falls through 0 at a tooth's centre
};
struct WheelFaultsOn {
  std::uint32_t wheel_faults_on;  ///< bit i: fault i of the definition is on
};
}  // namespace group

}  // namespace crankloop

// The scenes that `live` runs: the ready-made free ones, and what the block shows and takes beside.
//
// What belongs here: those requests. A scene that asks for more gives the same bits in what it has in common with one
// that asks for less, so `live` runs as `run --free` and the FMUs do.
#pragma once

#include <crankloop/scenes.hpp>

namespace crankloop::program {

/// With the pressure of each cylinder, the lift of its valves as their cams have it, and phasers.
struct LiveRunning : scenes::FreeRunning {
  static constexpr bool forces = true;
  static constexpr ValveModel valves = ValveModel::following;
  static constexpr Count trains = up_to<kMaxTrains>;
  static constexpr bool cam_phasing = true;
};

struct LiveBreathing : scenes::BreathingFree {
  static constexpr bool cam_phasing = true;
};

}  // namespace crankloop::program

namespace crankloop {

extern template class Engine<float, program::LiveRunning>;
extern template class Engine<double, program::LiveRunning>;
extern template class Engine<float, program::LiveBreathing>;
extern template class Engine<double, program::LiveBreathing>;

}  // namespace crankloop

// The scenes that a page runs: the ready-made ones of `run` and `run --free`, and what a page shows and takes beside.
//
// What belongs here: those requests. A scene that asks for more gives the same bits in what it has in common with one
// that asks for less, so a page runs as the program does.
#pragma once

#include <crankloop/scenes.hpp>

namespace crankloop::page {

/// As `run` does, with trigger wheels, and cylinders that may be cut.
template <class Base>
struct HeldOf : Base {
  using Shown = Base;  ///< what `run` has
  static constexpr bool cylinder_cut = true;
  static constexpr Count triggers = up_to<kMaxTriggerWheels>;
  static constexpr std::uint32_t wheel_faults = 8;
  static constexpr std::uint32_t trigger_edges = 32;
};
/// The same with its crank free.
template <class Base>
struct FreeOf : HeldOf<Base> {
  using Shown = FreeOf;
  static constexpr CrankGiven crank = CrankGiven::torque;
  static constexpr bool starter = true;
  static constexpr bool misfire = true;
};

using Held = HeldOf<scenes::Whole>;
using HeldBreathing = HeldOf<scenes::Breathing>;
using Free = FreeOf<scenes::Whole>;
using FreeBreathing = FreeOf<scenes::Breathing>;

}  // namespace crankloop::page

namespace crankloop {

extern template class Engine<float, page::Held>;
extern template class Engine<double, page::Held>;
extern template class Engine<float, page::HeldBreathing>;
extern template class Engine<double, page::HeldBreathing>;
extern template class Engine<float, page::Free>;
extern template class Engine<double, page::Free>;
extern template class Engine<float, page::FreeBreathing>;
extern template class Engine<double, page::FreeBreathing>;

}  // namespace crankloop

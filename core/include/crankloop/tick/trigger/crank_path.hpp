// How the crank turned during a tick.
//
// What belongs here: the angle over the time within one tick. What does not: where it comes from (tick/step.hpp).
#pragma once

#include <cstdint>

#include <crankloop/phase.hpp>

namespace crankloop::detail {

/// With s = 0 at the tick's start and 1 at its end,
///
///     angle(s) = begin + turned s + bend s (s - 1)
///
/// At a constant speed the bend is 0. Where the speed changes evenly from w0 to w1 it is (w1 - w0) tick / 2 as an
/// angle, and the crank may turn round on the way: at s = (1 - turned/bend) / 2.
template <class Real>
struct CrankPath {
  Phase begin;
  Phase turned;      ///< signed: less than a crank revolution either way
  bool jumped;       ///< nobody knows how it got there: a measured phase leapt
  Real bend_cycles;  ///< in cycles of 720 deg
};

}  // namespace crankloop::detail

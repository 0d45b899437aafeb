// What a valve train's motion reads, made at set-up.
//
// What belongs here: constants, step lengths, matrices. What does not: how they are made (tabulate/valve_motion.hpp), the lift
// (lift_curve.hpp).
#pragma once

#include <cstdint>

#include <crankloop/tick/valve.hpp>

namespace crankloop {

/// All that one valve train's motion reads.
template <class Real>
struct ValveMotion {
  ValveBody<Real> body;
  std::uint32_t steps;          ///< whole steps per tick
  std::uint32_t fine_per_step;
  std::uint32_t per_steps_32;   ///< 2^32 / steps; unused for 1
  std::uint32_t per_fine_32;    ///< 2^32 / fine_per_step; unused for 1
  Real per_steps;               ///< 1 / steps
  Real per_fine;                ///< 1 / fine_per_step
  Real step_s;                  ///< tick / steps
  Real fine_s;
  Real per_step_s;
  Real per_fine_s;
  Real short_step_deg;          ///< cam degrees up to which the lift over a step is a cubic,
  Real widest_step_deg;         ///< and, over a whole step, the quintic through its middle
  Real force_lag;               ///< b / (k step): the train's force is k (gap + force_lag step gap')
  Real rest_m;                  ///< nearer than this to its rest, and slower than rest_m_s, a closed valve sleeps
  Real rest_m_s;
  Real quiet_m;                 ///< |y| + |v| / seat rate below this cannot lift a valve off its seat
  Real per_seat_rate_s;         ///< 1 / frequency on the seat alone
  Real per_seat_N_m;            ///< 1 / (k_z + k_s): what the gas presses a closed valve into its seat
  StepMatrix<Real> whole[4];    ///< per regime
  StepMatrix<Real> fine[4];
};

}  // namespace crankloop

// What a valve train's motion reads, made at set-up.
//
// What belongs here: constants, step lengths, matrices. What does not: how they are made (tabulate/valve_motion.hpp), the lift
// (lift_curve.hpp).
#pragma once

#include <cstdint>

#include <crankloop/tick/valve.hpp>

namespace crankloop {

/// Steps of one length.
template <class Real>
struct StepLevel {
  std::uint32_t parts;         ///< steps in a tick, or in a whole step
  std::uint32_t per_parts_32;  ///< 2^32 / parts; unused for 1
  Real per_parts;              ///< 1 / parts
  Real step_s;
  Real per_step_s;
  Real force_lag;              ///< b / (k step): the train's force is k (gap + force_lag step gap')
  StepMatrix<Real> matrix[4];  ///< per regime
};

/// All that one valve train's motion reads.
template <class Real>
struct ValveMotion {
  ValveBody<Real> body;
  StepLevel<Real> whole;        ///< where no contact is near changing
  StepLevel<Real> fine;         ///< where one may
  Real short_step_deg;          ///< cam degrees up to which the lift over a step is a cubic,
  Real widest_step_deg;         ///< and the quintic through its middle
  Real clear_m;                 ///< above it, slopes apart, a valve is off its seat
  Real rest_m;                  ///< nearer than this to its rest, and slower than rest_m_s, a closed valve sleeps
  Real rest_m_s;
  Real quiet_m;                 ///< |y| + |v| / seat rate below this cannot lift a valve off its seat
  Real per_seat_rate_s;         ///< 1 / frequency on the seat alone
  Real per_seat_N_m;            ///< 1 / (k_z + k_s): what the gas presses a closed valve into its seat
};

}  // namespace crankloop

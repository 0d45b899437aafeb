// Faults of a controller's sensors, filled at set-up.
//
// What belongs here: what a tick reads. What does not: how it comes about (tabulate/sensor_faults.cpp), the step
// (tick/sensor_faults.hpp).
#pragma once

#include <cstdint>

#include <crankloop/limits.hpp>

namespace crankloop::detail {

inline constexpr std::uint32_t kDelayedSamples = 32;  ///< of a sensor's value

/// A fault of a sensor.
template <class Real>
struct SensorFaultRule {
  std::uint64_t from_tick;  ///< on in ticks from_tick to before until_tick, the engine's first being 0
  std::uint64_t until_tick;
  std::uint32_t sensor;
  std::uint32_t input_mask;    ///< and while a bit of these is set; 0: none
  std::uint32_t wire;          ///< as SensorWire
  std::uint32_t noise_seed;    ///< never 0
  std::uint32_t samples;       ///< of the delay, 0 to kDelayedSamples; 0: none
  std::uint32_t sample_ticks;  ///< from one to the next, at least 1
  Real follows;                ///< of the lag, in a tick: 1 - exp(-tick / lag)
  Real offset, noise;
  Real least, most;  ///< least above most: no range
  Real step, per_step;
  Real spare;
};

/// The faults of an engine's sensors.
template <class Real>
struct SensorFaultRules {
  SensorFaultRule<Real> fault[kMaxSensorFaults];
  std::uint32_t count;
  std::uint32_t spare;
};

}  // namespace crankloop::detail

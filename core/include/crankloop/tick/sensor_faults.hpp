// What a controller reads of sensors with faults.
//
// What belongs here: which faults are on, and what each makes of its sensor's value. What does not: the healthy values,
// which stand among the outputs already.
//
//     delay -> lag -> offset -> noise -> wire -> range -> steps
#pragma once

#include <cstdint>

#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/gas_properties.hpp>
#include <crankloop/tick/random.hpp>

namespace crankloop::detail {

inline constexpr std::uint32_t kNoSensorFault = kMaxSensorFaults;

/// The healthy value of each, by ControllerSensor; 0 where the scene has none.
template <class Real, class S>
[[gnu::always_inline]] inline void read_sensors(const State<Real, S>& state, const Output<Real, S>& out,
                                                Real (&value)[kControllerSensors]) noexcept {
  value[0] = out.manifold[kIntake].pressure_Pa, value[1] = out.manifold[kIntake].temperature_K;
  value[2] = state.throttle_ratio;
  value[3] = value[4] = Real{0};
  if constexpr (Needs<S>::lambda) value[3] = out.sensor_excess_air_ratio;
  if constexpr (S::walls) value[4] = out.coolant_K;
}

/// A fault that comes on: as if the value had always been this.
template <class Real>
inline void begin_fault(SensorState<Real>& sensor, const SensorFaultRule<Real>& fault, Real value) noexcept {
  sensor.held = sensor.lagged = sensor.late = value;
  sensor.lagged_rest = Real{0};
  for (Real& sample : sensor.sample) sample = value;
  sensor.oldest = sensor.ticks_left = 0;
  sensor.random = fault.noise_seed;
}

/// What a fault that is on makes of the value. O(1).
template <class Real>
[[nodiscard]] inline Real spoil(SensorState<Real>& sensor, const SensorFaultRule<Real>& fault, Real value) noexcept {
  if (fault.samples > 0) {
    if (sensor.ticks_left == 0) {
      Real& oldest = sensor.sample[sensor.oldest];
      sensor.late = oldest, oldest = value;
      sensor.oldest = sensor.oldest + 1 < fault.samples ? sensor.oldest + 1 : 0;
      sensor.ticks_left = fault.sample_ticks;
    }
    --sensor.ticks_left;
    value = sensor.late;
  }
  add_carried(sensor.lagged, sensor.lagged_rest, fault.follows * (value - sensor.lagged));
  value = sensor.lagged + fault.offset;
  if (fault.noise > 0) {
    constexpr Real kTwoToMinus31 = static_cast<Real>(1.0 / 2147483648.0);
    value += fault.noise * (static_cast<Real>(static_cast<std::int32_t>(next_random(sensor.random))) * kTwoToMinus31);
  }
  if (fault.wire == 1) value = sensor.held;
  if (fault.wire == 2) value = fault.most;
  if (fault.wire == 3) value = fault.least;
  if (fault.least <= fault.most) {
    value = value < fault.most ? (value > fault.least ? value : fault.least) : fault.most;
    if (fault.step > 0) {
      const Real steps = (value - fault.least) * fault.per_step + static_cast<Real>(0.5);
      value = fault.least + fault.step * static_cast<Real>(static_cast<std::int32_t>(steps));
    }
  }
  return value;
}

/// O(faults and sensors).
template <class Real, class S>
[[gnu::noinline]] void spoil_sensors(const SensorFaultRules<Real>& rules, State<Real, S>& state, Output<Real, S>& out,
                                     std::uint32_t input) noexcept {
  const std::uint64_t tick = state.ticks - 1;
  std::uint32_t first[kControllerSensors];
  for (std::uint32_t& one : first) one = kNoSensorFault;
  for (std::uint32_t i = rules.count; i-- > 0;) {
    const SensorFaultRule<Real>& fault = rules.fault[i];
    if (!(tick >= fault.from_tick && tick < fault.until_tick) && (input & fault.input_mask) == 0) continue;
    out.sensor_faults_on |= 1u << i;
    CRANKLOOP_ASSERT(fault.sensor < std::uint32_t{kControllerSensors});
    first[fault.sensor] = i;
  }
  for (int i = 0; i < kControllerSensors; ++i) {
    SensorState<Real>& sensor = state.sensor[i];
    const bool comes = first[i] != kNoSensorFault && sensor.fault != first[i];
    sensor.fault = first[i];
    if (first[i] == kNoSensorFault) continue;
    const SensorFaultRule<Real>& fault = rules.fault[first[i]];
    if (comes) begin_fault(sensor, fault, out.faulty_sensor[i]);
    out.faulty_sensor[i] = spoil(sensor, fault, out.faulty_sensor[i]);
  }
}

/// An engine without faults has copies of the healthy values and one comparison.
template <class Real, class S>
[[gnu::always_inline]] inline void read_faulty_sensors(const Tables<Real, S>& tables, State<Real, S>& state,
                                                       Output<Real, S>& out, std::uint32_t input) noexcept {
  read_sensors(state, out, out.faulty_sensor);
  out.sensor_faults_on = 0;
  if (__builtin_expect(tables.sensor_faults->count != 0, 0)) spoil_sensors(*tables.sensor_faults, state, out, input);
}

}  // namespace crankloop::detail

// What is wrong with a sensor that a controller reads, and what a healthy one does to its value: a wire, an offset,
// noise, a delay, a lag, a converter's steps and range.
//
// What belongs here: the value's way from the engine to the controller, and when it is wrong. What does not: wheels
// and their signals (define/wheel_fault.hpp), the lambda sensor's own pipe and lag (define/lambda_sensor.hpp).
#pragma once

#include <cstdint>

#include <crankloop/define/field.hpp>
#include <crankloop/limits.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

/// The values that a controller's names have: MAP in Pa, IAT in K, TPS as a ratio, lambda at the sensor, CLT in K.
enum class ControllerSensor : std::uint8_t { map, intake_air, tps, lambda, coolant };
static_assert(static_cast<int>(ControllerSensor::coolant) + 1 == kControllerSensors);

enum class SensorWire : std::uint8_t {
  good,
  stuck,    ///< the value stays where it was when the fault came
  open,     ///< reads the largest value of its range
  shorted,  ///< reads the least
};

/// All that is wrong at once with one sensor. Of several of a sensor that are on together the first one counts. The
/// value goes through delay, lag, offset, noise, wire, range and steps, in this order.
struct SensorFault {
  ControllerSensor sensor = ControllerSensor::map;

  // When: from start_s to before end_s, and while the bit is set; at least one of the two.
  double start_s = 0;  ///< since the engine's start, rounded to a tick
  double end_s = 0;    ///< 0: none
  int input_bit = -1;  ///< of Input::sensor_faults, 0 to 31; -1: none

  // In the unit of the sensor's value: Pa, K or 1.
  SensorWire wire = SensorWire::good;
  double offset = 0;
  double noise = 0;  ///< a number of each tick, evenly from -noise to noise
  int noise_seed = 1;
  double delay_s = 0;  ///< within 1/32 of it
  double lag_s = 0;    ///< time constant of first order
  double least = 0;    ///< range; none where most is not above least
  double most = 0;
  double step = 0;  ///< of a converter that counts from least, at most 65536 of them; 0: none

  [[nodiscard]] bool timed() const noexcept { return end_s > start_s; }
  [[nodiscard]] bool has_range() const noexcept { return most > least; }

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const int noise = self.noise > 0 ? 1 : 0;
    CRANKLOOP_FIELD(1, sensor_fault, sensor);
    CRANKLOOP_NUMBER(1, sensor_fault, start_s, from(0).up_to(1e9));
    CRANKLOOP_NUMBER(1, sensor_fault, end_s, from(0).up_to(1e9));
    CRANKLOOP_NUMBER(1, sensor_fault, input_bit, from(-1).below(32));
    CRANKLOOP_FIELD(1, sensor_fault, wire);
    CRANKLOOP_NUMBER(1, sensor_fault, offset, from(-1e9).up_to(1e9));
    CRANKLOOP_NUMBER(1, sensor_fault, noise, from(0).up_to(1e9));
    CRANKLOOP_NUMBER(noise, sensor_fault, noise_seed, from(0).up_to(2147483647));
    CRANKLOOP_NUMBER(1, sensor_fault, delay_s, from(0).up_to(10));
    CRANKLOOP_NUMBER(1, sensor_fault, lag_s, from(0).up_to(100));
    CRANKLOOP_NUMBER(1, sensor_fault, least, from(-1e9).up_to(1e9));
    CRANKLOOP_NUMBER(1, sensor_fault, most, from(-1e9).up_to(1e9));
    CRANKLOOP_NUMBER(1, sensor_fault, step, from(0).up_to(1e9));
  }
};

/// Field names "sensor_fault.*", as in the engine file.
Status validate(const SensorFault& fault) noexcept;

}  // namespace crankloop

// A lambda sensor in the exhaust pipe of an engine with gas exchange: docs/model.md "Exhaust lambda".
//
// What belongs here: where the sensor is and how slowly it follows. What does not: the exhaust manifold before it
// (define/gas.hpp).
#pragma once

#include <crankloop/define/field.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

/// Read where pressure.source is gas.
struct LambdaSensor {
  bool in_use = false;
  double pipe_m3 = 500e-6;  ///< volume of the pipe from the exhaust manifold to the sensor; 0: the sensor is there
  double lag_s = 0.05;      ///< time constant of the sensor's first order; 0: none

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const int read = self.in_use ? 1 : 0;
    CRANKLOOP_FIELD(1, lambda_sensor, in_use);
    CRANKLOOP_NUMBER(read, lambda_sensor, pipe_m3, from(0).up_to(1));
    CRANKLOOP_NUMBER(read, lambda_sensor, lag_s, from(0).up_to(100));
  }
};

/// Field names "lambda_sensor.*".
Status validate(const LambdaSensor& sensor) noexcept;

}  // namespace crankloop

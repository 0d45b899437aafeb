// A variable reluctance sensor at a trigger wheel, and the comparator that makes edges of its voltage: docs/model.md
// "Analogue crank signal".
//
// What belongs here: the sensor, its wheel's run-out, the comparator. What does not: the wheel's teeth
// (define/trigger_wheel.hpp), faults of a digital signal (define/wheel_fault.hpp).
#pragma once

#include <crankloop/define/field.hpp>
#include <crankloop/limits.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

inline constexpr int kMaxReluctorPlaces = 120;  ///< teeth and missing ones of its wheel

/// The voltage is positive where a tooth comes near, and falls through 0 at the tooth's centre.
struct Reluctor {
  int wheel = -1;               ///< counted from 0; -1: no sensor. Of evenly spaced teeth, none moved by a phaser
  double gain_V_s = 0;          ///< peak voltage at a tooth by the wheel's speed in rad/s
  double reach_ratio = 0.9;     ///< where a tooth's lobes end, from its centre to the middle of the space behind it: a
                                ///< small air gap has short ones
  double gap_lobe_ratio = 1.4;  ///< of lobes beside a gap to the others
  double runout_ratio = 0;      ///< r: the flux swings by 1 + r cos(a - runout_at) over a turn
  double runout_at_deg = 0;     ///< of the wheel's turn, from the first rising edge: a full turn is 360
  bool reversed = false;        ///< its wires are: the voltage has the other sign
  double arm_ratio = 1.0 / 3;   ///< comparator: armed beyond this share of the last peak
  double least_V = 0.05;        ///< and beyond this voltage
  double hysteresis_V = 0;      ///< its edge is where the voltage falls through this, below 0
  double watchdog_s = 0.085;    ///< after so long without an edge the last peak is forgotten
  double delay_s = 0;           ///< its edges come so much later; at most a tick

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const int there = self.wheel >= 0 ? 1 : 0;
    CRANKLOOP_NUMBER(1, reluctor, wheel, from(-1).below(kMaxTriggerWheels));
    CRANKLOOP_NUMBER(there, reluctor, gain_V_s, above(0).up_to(10));
    CRANKLOOP_NUMBER(there, reluctor, reach_ratio, from(0.6).up_to(1));
    CRANKLOOP_NUMBER(there, reluctor, gap_lobe_ratio, from(1).up_to(2));
    CRANKLOOP_NUMBER(there, reluctor, runout_ratio, from(0).up_to(0.5));
    CRANKLOOP_NUMBER(there, reluctor, runout_at_deg, from(-360).up_to(360));
    CRANKLOOP_FIELD(there, reluctor, reversed);
    CRANKLOOP_NUMBER(there, reluctor, arm_ratio, from(0).below(1));
    CRANKLOOP_NUMBER(there, reluctor, least_V, above(0).up_to(100));
    CRANKLOOP_NUMBER(there, reluctor, hysteresis_V, from(0).up_to(10));
    CRANKLOOP_NUMBER(there, reluctor, watchdog_s, above(0).up_to(100));
    CRANKLOOP_NUMBER(there, reluctor, delay_s, from(0).up_to(2e-3));
  }
};

/// Field names "reluctor.*", as in the engine file without unit.
Status validate(const Reluctor& reluctor) noexcept;

}  // namespace crankloop

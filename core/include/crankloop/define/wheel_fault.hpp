// A fault of a trigger wheel, its sensor or its wire: what a controller must find and live with.
//
// What belongs here: what is wrong, and when. What does not: the wheel (define/trigger_wheel.hpp).
#pragma once

#include <cstdint>

#include <crankloop/define/field.hpp>
#include <crankloop/define/trigger_wheel.hpp>
#include <crankloop/limits.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

enum class StuckSignal : std::uint8_t { no, low, high };

/// All that is wrong at once with one wheel. Of several faults of a wheel that are on together the first one shows.
struct WheelFault {
  int wheel = 0;  ///< counted from 0

  // When: from start_s to before end_s, and while the bit is set; at least one of the two.
  double start_s = 0;  ///< since the engine's start, rounded to a tick
  double end_s = 0;    ///< 0: none
  int input_bit = -1;  ///< of Input::wheel_faults, 0 to 31; -1: none

  // The wheel. Teeth are counted from 1, which begins with the first rising edge; angles are crank degrees.
  int missing_tooth = 0;       ///< 0: none
  int moved_tooth = 0;         ///< 0: none
  double moved_deg = 0;        ///< in the sense of rotation its edges come later
  double extra_tooth_deg = 0;  ///< of its rising edge, after that of tooth 1
  double extra_width_deg = 0;  ///< 0: no extra tooth
  double runout_deg = 0;       ///< r: an edge at angle a of the wheel comes r sin(a - runout_at) later
  double runout_at_deg = 0;    ///< of the wheel: a full turn is 360, on a camshaft too
  double late_deg = 0;         ///< all edges come later: a stretched chain; negative: earlier

  // The signal.
  bool inverted = false;  ///< against the healthy one
  StuckSignal stuck = StuckSignal::no;
  double noise_Hz = 0;       ///< mean rate of pulses that invert the signal, at most one in a tick; 0: none
  double noise_pulse_s = 0;  ///< their length, at most half a tick
  int noise_seed = 1;

  [[nodiscard]] bool changes_wheel() const noexcept {
    return missing_tooth != 0 || moved_tooth != 0 || extra_width_deg != 0 || runout_deg != 0 || late_deg != 0;
  }
  [[nodiscard]] bool timed() const noexcept { return end_s > start_s; }

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const int noise = self.noise_Hz > 0 ? 1 : 0;
    CRANKLOOP_NUMBER(1, fault, wheel, from(0).below(kMaxTriggerWheels));
    CRANKLOOP_NUMBER(1, fault, start_s, from(0).up_to(1e9));
    CRANKLOOP_NUMBER(1, fault, end_s, from(0).up_to(1e9));
    CRANKLOOP_NUMBER(1, fault, input_bit, from(-1).below(32));
    CRANKLOOP_NUMBER(1, fault, missing_tooth, from(0).up_to(kMaxTriggerEdges / 2));
    CRANKLOOP_NUMBER(1, fault, moved_tooth, from(0).up_to(kMaxTriggerEdges / 2));
    CRANKLOOP_NUMBER(1, fault, moved_deg, from(-360).up_to(360));
    CRANKLOOP_NUMBER(1, fault, extra_tooth_deg, from(0).below(720));
    CRANKLOOP_NUMBER(1, fault, extra_width_deg, from(0).below(720));
    CRANKLOOP_NUMBER(1, fault, runout_deg, from(-90).up_to(90));
    CRANKLOOP_NUMBER(1, fault, runout_at_deg, from(-360).up_to(360));
    CRANKLOOP_NUMBER(1, fault, late_deg, from(-360).up_to(360));
    CRANKLOOP_FIELD(1, fault, inverted);
    CRANKLOOP_FIELD(1, fault, stuck);
    CRANKLOOP_NUMBER(1, fault, noise_Hz, from(0).up_to(1e6));
    CRANKLOOP_NUMBER(noise, fault, noise_pulse_s, above(0).up_to(1e-3));
    CRANKLOOP_NUMBER(noise, fault, noise_seed, from(0).up_to(2147483647));
  }
};

/// Field names "fault.*", as in the engine file without unit.
Status validate(const WheelFault& fault) noexcept;

}  // namespace crankloop

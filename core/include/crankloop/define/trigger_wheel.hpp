// One trigger wheel: the toothed disc on the crankshaft or on a camshaft whose edges a controller decodes.
//
// What belongs here: teeth, gaps and where they stand. What does not: names such as 36-2-2-2 (the program turns them
// into teeth and gaps), the sensor and its delay, the wheel's edges as the tick reads them (tables/trigger_tables.hpp).
#pragma once

#include <cstdint>

#include <crankloop/define/field.hpp>
#include <crankloop/limits.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

enum class TriggerShaft : std::uint8_t {
  crank,  ///< turns once in 360 crank deg
  cam,    ///< turns once in 720
};

enum class TriggerPattern : std::uint8_t {
  teeth,  ///< evenly spaced places, some of them without a tooth
  edges,  ///< any angles
};

/// A gap and the teeth before it, counted from tooth 1 or from the gap before.
struct ToothGap {
  int teeth;    ///< 1 or more
  int missing;  ///< 1 or more

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_FIELD(1, trigger, teeth);
    CRANKLOOP_FIELD(1, trigger, missing);
  }
};

inline constexpr int kMaxToothGaps = 8;
inline constexpr int kMaxToothPlaces = 360;

/// The signal is 1 while a tooth is at the sensor. A tooth begins at its rising edge, as the shaft turns forward.
///
///     60-2             {60 places, gaps {{58, 2}}}
///     36-2-2-2         {36 places, gaps {{13, 2}, {16, 2}, {1, 2}}}
///     half-moon        {1 place} on a cam, tooth_ratio 0.5
struct TriggerWheel {
  TriggerShaft shaft = TriggerShaft::crank;
  int train = -1;  ///< cam: the valve train whose phaser moves the wheel too, counted from 0; -1 = none does
  TriggerPattern pattern = TriggerPattern::teeth;
  // teeth
  int places = 0;     ///< teeth and missing ones in a turn of the shaft
  int gap_count = 0;  ///< the places that are left after the last gap have teeth
  ToothGap gaps[kMaxToothGaps] = {};
  double first_tooth_deg = 0;  ///< crank angle after cylinder 1's firing top dead centre of tooth 1's rising edge
  double tooth_ratio = 0.5;    ///< width of a tooth per distance from place to place
  // edges
  const double* edges_deg =
      nullptr;  ///< rise, fall, rise, ... in crank degrees after cylinder 1's firing top dead centre: the first 0 to
                ///< below 720, rising, within one turn of the shaft; the caller keeps them alive while tabulating
  int edge_count = 0;  ///< even, 2 to kMaxTriggerEdges

  bool inverted = false;  ///< the signal is 0 where the rules above give 1

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const bool teeth = self.pattern == TriggerPattern::teeth;
    CRANKLOOP_FIELD(1, trigger, shaft);
    CRANKLOOP_NUMBER(1, trigger, train, from(-1).below(kMaxTrains));
    CRANKLOOP_FIELD(1, trigger, pattern);
    CRANKLOOP_NUMBER(teeth ? 1 : 0, trigger, places, from(1).up_to(kMaxToothPlaces));
    CRANKLOOP_NUMBER(teeth ? 1 : 0, trigger, gap_count, from(0).up_to(kMaxToothGaps));
    CRANKLOOP_FIELD(teeth ? self.gap_count : 0, trigger, gaps);
    CRANKLOOP_NUMBER(teeth ? 1 : 0, trigger, first_tooth_deg, from(0).below(720));
    CRANKLOOP_NUMBER(teeth ? 1 : 0, trigger, tooth_ratio, from(0.01).up_to(0.99));
    CRANKLOOP_FIELD(teeth ? 0 : self.edge_count, trigger, edges_deg);
    CRANKLOOP_FIELD(teeth ? 0 : 1, trigger, edge_count);
    CRANKLOOP_FIELD(1, trigger, inverted);
  }
};

/// Field names "trigger.*", as in the engine file without unit; `index` is the gap or the edge.
Status validate(const TriggerWheel& wheel) noexcept;

}  // namespace crankloop

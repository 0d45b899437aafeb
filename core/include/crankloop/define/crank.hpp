// The geometry of one crank mechanism: bore, crank, rod, offset.
//
// What belongs here: lengths that a drawing gives. What does not: motion (tabulate/mechanism.hpp) and masses
// (define/masses.hpp).
#pragma once

#include <crankloop/define/field.hpp>
#include <crankloop/limits.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

/// Slider-crank of one cylinder; all cylinders of an engine are the same.
///
///              |  head                  a: crank angle, 0 with the throw parallel to the cylinder axis to the head
///         _____|_____                   b: rod angle from the cylinder axis
///        |  piston   |                  x: displacement from top dead centre, positive toward the crankshaft
///        |_____o_____|
///             /|                        pin offset e > 0: the cylinder axis lies on the side to which
///        rod / |                        the crank pin moves after a = 0
///           / b|
///          o   |          sin b = (r sin a - e) / l
///           \ a|
///        r   \ |
///             \|
struct Crank {
  double bore_m = 0;
  double crank_radius_m = 0;     ///< r, half the nominal stroke
  double rod_length_m = 0;       ///< l > least_rod_length_m()
  double pin_offset_m = 0;       ///< e
  double compression_ratio = 2;  ///< (V_c + V_d) / V_c; only pressure sources that know the volume use it
  double max_speed_rad_s = 0;    ///< the highest speed the engine can have, either way; 0: the limit of the tick alone

  [[nodiscard]] constexpr double rod_ratio() const noexcept {
    return crank_radius_m / rod_length_m;
  }  ///< lambda = r / l

  /// What the rod must be longer than: r + |e|, with which the rod would lie square to the cylinder axis once a turn,
  /// cos b = 0, and a billionth of that, which keeps cos b above 4e-5 whatever rounding does to sin b.
  [[nodiscard]] constexpr double least_rod_length_m() const noexcept {
    return (crank_radius_m + (pin_offset_m < 0 ? -pin_offset_m : pin_offset_m)) * (1 + 1e-9);
  }

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_NUMBER(1, crank, bore_m, above(0).up_to(2));
    CRANKLOOP_NUMBER(1, crank, crank_radius_m, above(0).up_to(2));
    CRANKLOOP_NUMBER(1, crank, rod_length_m, above(0).up_to(10));
    CRANKLOOP_NUMBER(1, crank, pin_offset_m, from(-2).up_to(2));
    CRANKLOOP_NUMBER(1, crank, compression_ratio, above(1).up_to(100));
    CRANKLOOP_NUMBER(1, crank, max_speed_rad_s, from(0).up_to(kMaxSpeed_rad_s));
  }
};

/// Field names "crank.*". It also refuses a mechanism that cannot turn.
Status validate(const Crank& crank) noexcept;

}  // namespace crankloop

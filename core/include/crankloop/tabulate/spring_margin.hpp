// How far a valve's spring is from letting its train go, for rigid parts: docs/model.md "Spring margin".
//
// What belongs here: figures of theoretical lift, spring and mass. What does not: the elastic valve, which leaves its
// train at another speed (tick/valve).
#pragma once

#include <crankloop/tabulate/valve_lift.hpp>
#include <crankloop/tick/valve/valve.hpp>

namespace crankloop {

/// The crank's speed at which the least spring margin of a train is 1, and where.
struct StaticRedline {
  double crank_rad_s = 0;  ///< 0: none, the train never slows its valve down
  double cam_deg = 0;      ///< cam degrees from full lift, negative while opening

  /// Least spring margin over the lobe at a speed of the crank, of either sign: spring force over the force that slows
  /// the valve down. Infinite at standstill and where there is no static redline.
  [[nodiscard]] double margin(double speed_rad_s) const noexcept;
};

/// Spring margin at one place of the lobe and a speed of the crank, of either sign. Infinite where nothing slows the
/// valve down: at standstill, with its lash open, and where its lift does not curve down.
[[nodiscard]] double spring_margin(const LiftPose& pose, const detail::ValveBody<double>& body,
                                   double crank_rad_s) noexcept;

/// Of equal margins full lift counts, then the first as the cam turns. None for a lift that was not accepted and for a
/// body with a number that is not finite. Takes about as long as ValveLift::init.
[[nodiscard]] StaticRedline static_redline(const ValveLift& lift, const detail::ValveBody<double>& body) noexcept;

}  // namespace crankloop

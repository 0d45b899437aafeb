// How the crank turns, and what turns it.
#pragma once

namespace crankloop::detail {

/// How the crank turns where its speed changes.
template <class Real>
struct CrankRate {
  Real speed_rad_s;
  Real acceleration_rad_s2;
};

/// What a tick has come to.
template <class Real>
struct CrankArrival {
  Real gas_work_J;           ///< over the angle turned
  Real gas_Nm;               ///< at its end, as are the next two
  Real inertia_kg_m2;        ///< J_eff
  Real inertia_slope_kg_m2;  ///< torque of masses per w^2
};

}  // namespace crankloop::detail

// How the crank turns.
#pragma once

namespace crankloop {

/// How the crank turns where its speed changes.
template <class Real>
struct CrankRate {
  Real speed_rad_s;
  Real acceleration_rad_s2;
};

}  // namespace crankloop

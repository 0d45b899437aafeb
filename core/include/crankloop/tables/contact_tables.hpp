// Tables of the contact of cam and follower, in the cells of the lift's curve (lift_curve.hpp): one segment per cam
// degree of the lobe, and one for the base circle.
//
// What belongs here: the records and their meaning. What does not: how they are filled (tabulate/), how a tick uses
// them (tick/valve/cam_contact.hpp).
#pragma once

#include <crankloop/tables/curve.hpp>

namespace crankloop::detail {

template <class Real>
struct CamContactSegment {
  Segment<Real> stress;         ///< sqrt(E* / (pi R b)), Pa per root of the cam's force in N: p_max = stress sqrt(F)
  Segment<Real> entrainment_m;  ///< per unit of the cam's speed
};

/// Where a scene shows the contact of a train's cams.
template <class Real>
struct CamContactCurve {
  const CamContactSegment<Real>* at;
  const Segment<Real>* sliding_m;  ///< per unit of the cam's speed
  Real per_width_m;                ///< 2 / (pi b): half width = this F / p_max; 0: the width is not known
};

/// What a train's cams take beside the power of its valves.
template <class Real>
struct CamTorqueTable {
  const Segment<Real>* sliding_m;  ///< null without friction
  Real friction_ratio;             ///< mu
  Real cams;                       ///< alike in each cylinder
};

}  // namespace crankloop::detail

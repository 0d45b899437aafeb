// What a tick shows of cams: their contacts, their torque, the largest stress of a cycle.
//
// What belongs here: the outputs and their meaning. What does not: how they come about (cam_contact.hpp).
#pragma once

#include <cstdint>

#include <crankloop/scene.hpp>

namespace crankloop {

/// The contact of cam and follower at the end of the tick; all 0 where no force is in it.
template <class Real>
struct CamContactOutput {
  Real stress_Pa;        ///< p_max: largest pressure, by Hertz
  Real half_width_m;     ///< a: of the strip of contact
  Real sliding_m_s;      ///< the cam's surface less the follower's, positive with forward rotation
  Real entrainment_m_s;  ///< mean of both surfaces relative to the contact, positive with forward rotation
};

/// One cycle of one cam, from the middle of the base circle to the next, over the ends of its ticks: a force that jumps
/// within a tick, as a damper's does where contact begins, counts from the tick's end.
template <class Real>
struct CamContactCycle {
  Real largest_Pa;
  Real largest_deg;  ///< where: cam degrees since the start of the lobe
};

/// Torque that one cam takes at the end of the tick, positive against forward rotation: that of the valve's train, by
/// power, and of friction.
template <class Real>
struct CamTorqueOutput {
  Real torque_Nm;
  Real friction_Nm;  ///< its part of friction between cam and follower
};

namespace group {

/// [train][cylinder]
template <class Real, class S>
struct CamContacts {
  CamContactOutput<Real> cam_contact[S::trains.capacity][S::cylinders.capacity];
  CamContactCycle<Real> cam_contact_cycle[S::trains.capacity][S::cylinders.capacity];  ///< of the last whole cycle
};
template <class Real, class S>
struct CamTorques {
  CamTorqueOutput<Real> cam_torque[S::trains.capacity][S::cylinders.capacity];
  Real camshaft_Nm;  ///< of all cams of the engine, also where several shafts carry them
};

/// The largest stress so far in each cam's cycle.
template <class Real, class S>
struct CamContactRecords {
  CamContactCycle<Real> contact_record[S::trains.capacity][S::cylinders.capacity] = {};
};
/// What the cams took at the end of the last tick, on the crank.
template <class Real>
struct CamDragState {
  Real cam_drag_Nm = 0;
  Real spare_of_cam_drag = 0;  ///< keeps the size a multiple of eight: no padding
};

}  // namespace group
}  // namespace crankloop

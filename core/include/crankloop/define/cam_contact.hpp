// The contact of cam and follower of one valve train: what stress and friction need beside its geometry.
//
// What belongs here: width, materials, friction. What does not: the geometry (valve_train.hpp), stress and speeds
// (tabulate/cam_contact.hpp).
#pragma once

#include <crankloop/define/field.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

/// Read by scenes with cam_contact or cam_torque alone; defaults: both bodies of steel, no friction.
struct CamContact {
  double width_m = 0;         ///< b, of the line of contact; 0: not known, and a scene with cam_contact is refused
  double friction_ratio = 0;  ///< mu, friction force over normal force at any speed; 0: none
  double cam_Pa = 206e9;      ///< E, Young's modulus of the cam
  double cam_poisson_ratio = 0.3;
  double follower_Pa = 206e9;  ///< of the pad, or of the flat follower
  double follower_poisson_ratio = 0.3;

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_NUMBER(1, cam, width_m, from(0).up_to(1));
    CRANKLOOP_NUMBER(1, cam, friction_ratio, from(0).up_to(1));
    CRANKLOOP_NUMBER(1, material, cam_Pa, from(1e6).up_to(1e13));
    CRANKLOOP_NUMBER(1, material, cam_poisson_ratio, from(0).up_to(0.5));
    CRANKLOOP_NUMBER(1, material, follower_Pa, from(1e6).up_to(1e13));
    CRANKLOOP_NUMBER(1, material, follower_poisson_ratio, from(0).up_to(0.5));
  }
};

Status validate(const CamContact& contact) noexcept;

}  // namespace crankloop

// Theoretical valve lift over the cam angle, from cam and rocker, exactly as defined: docs/model.md "Rocker".
//
// What belongs here: kinematics at set-up time, in double. What does not: its table for the tick, and the valve's
// motion.
#pragma once

#include <crankloop/define/valve_train.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tables/valve_tables.hpp>
#include <crankloop/tabulate/cam_profile.hpp>

namespace crankloop {

/// The train at one cam angle phi_r; derivatives by phi_r.
struct LiftPose {
  double lift_m;        ///< Y, unclipped: negative while the lash is open
  double per_rad_m;     ///< dY/dphi_r
  double per_rad2_m;    ///< d2Y/dphi_r2
  double rocker_ratio;  ///< i, cam force per valve force and valve speed per contact-normal speed
  double rocker_rad;    ///< W, 0 for a constant ratio
};

/// Where cam and follower touch at one cam angle phi_r: docs/model.md "Cam contact". Speeds are per unit of the cam's
/// speed, positive with the cam's surface.
struct ContactPose {
  double curvature_per_m;  ///< 1/R = 1/rho + 1/r_s, of cam and pad; of a flat follower 1/rho
  double lever_m;          ///< y', of the contact's normal about the cam's axis; negative while closing
  double sliding_m;        ///< speed of the cam's surface less that of the follower's
  double entrainment_m;    ///< mean of both surfaces' speeds relative to the contact, which moves
};

/// phi_r is the cam's rotation from full lift, negative while opening. Cam drawings use the flat follower's angle phi.
/// The pad makes the difference between the two: equal steps of one are not equal steps of the other.
class ValveLift {
 public:
  /// Refuses what validate() and CamProfile refuse, and with Reason::inconsistent and the angle in failed_at_deg()
  ///   "rocker.base_circle_m"       the cam is undercut: r_0 + y + y'' <= 0
  ///   "rocker.pivot_to_pad_m"      pivot, pad centre and cam centre form no triangle
  ///   "rocker.pivot_to_cam_m"      the contact's normal meets the pivot, so that phi_r turns back and the train jams
  ///   "rocker.pivot_to_screw_m"    the screw's ball would stand more than 90 deg above or below the pivot
  Status init(const Cam& cam, const Rocker& rocker) noexcept;

  /// Flat follower's cam angle at which init found the worst geometry.
  [[nodiscard]] double failed_at_deg() const noexcept { return failed_at_deg_; }

  /// At cam angle phi_r, any value (wrapped). Exact to rounding: phi is found by Newton's method, derivatives are
  /// formulas.
  [[nodiscard]] LiftPose at(double cam_rad) const noexcept;

  /// The contact at cam angle phi_r, as if the train were closed; outside the lobe that of the base circle. As exact as
  /// at(). A pad's contact is that of a circle; a constant ratio has a flat follower that moves along its normal.
  [[nodiscard]] ContactPose contact_at(double cam_rad) const noexcept;

  /// Ends of the lobe in phi_r, -2 pi to 2 pi, less than a turn apart; outside them the lift is minus the clearance,
  /// exactly.
  [[nodiscard]] double opens_rad() const noexcept { return opens_rad_; }
  [[nodiscard]] double closes_rad() const noexcept { return closes_rad_; }

  [[nodiscard]] double largest_lift_m() const noexcept { return at(0).lift_m; }

  /// l_v, the rocker's lever at the valve: the rocker adds the mass I_rocker / l_v^2 to the valve. 0 for a constant
  /// ratio without `pivot_to_screw`.
  [[nodiscard]] double lever_m() const noexcept { return lever_m_; }

  /// The contour's smallest radius of curvature over the lobe, and its flat follower's cam angle.
  [[nodiscard]] double smallest_radius_m() const noexcept { return smallest_radius_m_; }
  [[nodiscard]] double smallest_radius_at_deg() const noexcept { return smallest_radius_at_deg_; }

  [[nodiscard]] const CamProfile& cam() const noexcept { return cam_; }

 private:
  /// Cam, pad and rocker in contact at the flat follower's angle phi.
  struct Contact {
    double cam_rad;       ///< phi_r
    double cam_per_phi;   ///< dphi_r/dphi
    double radius_m;      ///< of the contour's curvature, r_0 + y + y''
    double triangle;      ///< 4 area of pivot, pad centre, cam centre, squared, per (l_a l_c)^2; <= 0: no triangle
    double sin_pressure;  ///< sin J', of the angle between rocker arm and contact normal
    double cos_pressure;
    double cos_screw;  ///< cos psi
    LiftPose pose;
  };

  [[nodiscard]] Contact contact(double phi_rad) const noexcept;
  [[nodiscard]] Contact pad_contact(const CamLift& y, double phi_rad) const noexcept;
  [[nodiscard]] bool is_on_lobe(double cam_rad, double& since_opening_rad) const noexcept;
  [[nodiscard]] double phi_at(double since_opening_rad, Contact& c) const noexcept;
  template <class Quantity>
  [[nodiscard]] bool stays_positive(const Quantity& quantity, double& smallest) noexcept;
  Status check_contacts() noexcept;

  CamProfile cam_;
  Rocker rocker_;
  double opens_rad_ = 0;
  double closes_rad_ = 0;
  double lever_m_ = 0;
  double cam_angle_at_full_lift_rad_ = 0;  ///< K_d
  double rocker_at_rest_rad_ = 0;          ///< W_0
  double screw_at_rest_rad_ = 0;           ///< psi_0
  LiftPose outside_{};
  double failed_at_deg_ = 0;
  double smallest_radius_m_ = 0;
  double smallest_radius_at_deg_ = 0;
};

/// Constants of the single-mass model (docs/model.md "Valve") with the rocker's lever of an accepted lift; without a
/// lever the valve has no rocker's inertia.
[[nodiscard]] detail::ValveBody<double> valve_body(const Valve& valve, const ValveLift& lift) noexcept;

}  // namespace crankloop

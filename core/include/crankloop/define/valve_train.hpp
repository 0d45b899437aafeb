// One valve train: cam, rocker, valve with its spring and seat. All cylinders have the same trains.
//
// What belongs here: what a drawing and a scale give. What does not: lift over the cam angle (tabulate/valve_lift.hpp)
// and motion (tick/).
#pragma once

#include <cstdint>

#include <crankloop/define/field.hpp>
#include <crankloop/limits.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

enum class CamSource : std::uint8_t { polynomial, table };

/// One row of a measured cam: angle of the flat follower in cam degrees, 0 at full lift, and its lift.
struct CamPoint {
  double cam_deg;
  double lift_m;
};

inline constexpr int kMaxCamExponents = 8;
inline constexpr int kMaxCamPoints = 2000;

/// The cam as the lift of a flat follower.
struct Cam {
  CamSource source = CamSource::polynomial;
  // polynomial: y = max_lift (1 + sum C_i u^p_i), u = |phi| / half_angle; the C_i follow from y = y' = ... = 0 at u = 1
  double max_lift_m = 0;
  double half_angle_deg = 0;                ///< cam degrees
  int exponent_count = 0;                   ///< 2 to 8
  double exponents[kMaxCamExponents] = {};  ///< rising by at least 0.1
  // table
  const CamPoint* points =
      nullptr;  ///< rising angles, -360 to 360 and within one turn; the caller keeps them alive while tabulating
  int point_count = 0;     ///< 8 to 2000
  double smoothing_m = 0;  ///< largest residual allowed in smoothing
  // place in the cycle
  double full_lift_deg = 0;     ///< engine crank angle of full theoretical lift in the cylinder's own cycle
  double phase_rate_deg_s = 0;  ///< how fast a cam phaser may move, crank degrees per second; 0 = fixed cam

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const bool polynomial = self.source == CamSource::polynomial;
    CRANKLOOP_FIELD(1, cam, source);
    CRANKLOOP_NUMBER(1, cam, full_lift_deg, from(0).below(720));
    CRANKLOOP_NUMBER(1, cam, phase_rate_deg_s, from(0).up_to(1e5));
    CRANKLOOP_NUMBER(polynomial ? 1 : 0, cam, max_lift_m, above(0).up_to(0.1));
    CRANKLOOP_NUMBER(polynomial ? 1 : 0, cam, half_angle_deg, from(10).up_to(180));
    CRANKLOOP_FIELD(polynomial ? 1 : 0, cam, exponent_count);
    CRANKLOOP_NUMBER(polynomial ? self.exponent_count : 0, cam, exponents, from(2).up_to(100));
    CRANKLOOP_NUMBER(polynomial ? 0 : 1, cam, smoothing_m, above(0).up_to(1e-3));
    CRANKLOOP_FIELD(polynomial ? 0 : 1, cam, point_count);
    CRANKLOOP_FIELD(polynomial ? 0 : self.point_count, cam, points);
  }
};

enum class RockerKind : std::uint8_t {
  circular_pad,  ///< cam - rocker with a circular pad - adjusting screw - valve: docs/model.md "Rocker"
  ratio,         ///< direct or constant-ratio train: lift = ratio * y
};
enum class CamTurns : std::uint8_t { toward_pivot, away_from_pivot };

struct Rocker {
  RockerKind kind = RockerKind::circular_pad;
  double base_circle_m = 0;  ///< r_0, radius
  double clearance_m = 0;    ///< lash at the base circle
  double ratio = 1;          ///< kind ratio: valve lift per follower lift
  // circular pad
  double pivot_to_pad_m = 0;      ///< l_a
  double pivot_to_cam_m = 0;      ///< l_c
  double pad_radius_m = 0;        ///< r_s
  double pivot_to_screw_m = 0;    ///< l_b; kind ratio: 0, or the rocker's lever on the valve where it has an inertia
  double screw_ball_m = 0;        ///< rho, radius
  double stem_above_pivot_m = 0;  ///< z
  CamTurns cam_turns = CamTurns::toward_pivot;

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const int of_ratio = self.kind == RockerKind::ratio ? 1 : 0;
    const Range lever = of_ratio == 1 ? from(0).up_to(1) : above(0).up_to(1);
    CRANKLOOP_FIELD(1, rocker, kind);
    CRANKLOOP_FIELD(1 - of_ratio, rocker, cam_turns);
    CRANKLOOP_NUMBER(1, rocker, base_circle_m, above(0).up_to(1));
    CRANKLOOP_NUMBER(1, rocker, clearance_m, from(0).up_to(0.01));
    CRANKLOOP_NUMBER(of_ratio, rocker, ratio, above(0).up_to(10));
    CRANKLOOP_NUMBER(1 - of_ratio, rocker, pivot_to_pad_m, above(0).up_to(1));
    CRANKLOOP_NUMBER(1 - of_ratio, rocker, pivot_to_cam_m, above(0).up_to(1));
    CRANKLOOP_NUMBER(1 - of_ratio, rocker, pad_radius_m, above(0).up_to(10));
    CRANKLOOP_NUMBER(1, rocker, pivot_to_screw_m, lever);
    CRANKLOOP_NUMBER(1 - of_ratio, rocker, screw_ball_m, from(0).up_to(1));
    CRANKLOOP_NUMBER(1 - of_ratio, rocker, stem_above_pivot_m, from(-1).up_to(1));
  }
};

/// The moving parts of one valve as a single mass.
struct Valve {
  int per_cylinder = 1;             ///< alike and computed once; 1 to 8
  double valve_kg = 0;              ///< with retainer and collets
  double spring_kg = 0;             ///< a third of it moves
  double rocker_inertia_kg_m2 = 0;  ///< about its pivot; 0 for kind ratio without a lever
  double spring_N_m = 0;            ///< k_s
  double spring_preload_N = 0;      ///< P_s0
  double train_N_m = 0;             ///< k
  double train_damping_ratio = 0;   ///< b = 2 zeta sqrt(k M)
  double guide_damping_ratio = 0;   ///< c = 2 zeta sqrt(k M)
  double seat_N_m = 0;              ///< k_z
  double seat_damping_ratio = 0;    ///< b_z = 2 zeta sqrt(k_z M)
  double head_area_m2 = 0;          ///< cylinder pressure on it closes the valve; 0 = none
  // Surge: the spring's coils oscillate by themselves (docs/model.md "Spring surge"). A scene says by its spring_modes
  // that it steps them; one that does not refuses such a train.
  int surge_modes = 0;                ///< of each spring, 0 to kMaxSpringModes; 0 = all coils follow the valve
  double surge_damping_ratio = 0.01;  ///< of each mode
  double spring_active_kg = 0;        ///< mass of the active coils; 0 = all of spring_kg, less the inner spring's
  double inner_spring_N_m = 0;        ///< of two nested springs, what the inner one has of spring_N_m; 0 = one spring
  double inner_spring_kg = 0;         ///< and what its active coils have of spring_kg

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_FIELD(0, valve, per_cylinder);
    CRANKLOOP_NUMBER(1, valve, valve_kg, above(0).up_to(100));
    CRANKLOOP_NUMBER(1, valve, spring_kg, from(0).up_to(100));
    CRANKLOOP_NUMBER(1, valve, rocker_inertia_kg_m2, from(0).up_to(100));
    CRANKLOOP_NUMBER(1, valve, spring_N_m, from(0).up_to(1e9));
    CRANKLOOP_NUMBER(1, valve, spring_preload_N, above(0).up_to(1e6));
    CRANKLOOP_NUMBER(1, valve, train_N_m, above(0).up_to(1e12));
    CRANKLOOP_NUMBER(1, valve, train_damping_ratio, from(0).up_to(10));
    CRANKLOOP_NUMBER(1, valve, guide_damping_ratio, from(0).up_to(10));
    CRANKLOOP_NUMBER(1, valve, seat_N_m, above(0).up_to(1e12));
    CRANKLOOP_NUMBER(1, valve, seat_damping_ratio, from(0).up_to(10));
    CRANKLOOP_NUMBER(1, valve, head_area_m2, from(0).up_to(1));
    const int surges = self.surge_modes > 0 ? 1 : 0;
    CRANKLOOP_FIELD(1, valve, surge_modes);
    CRANKLOOP_NUMBER(surges, valve, surge_damping_ratio, from(0).below(1));
    CRANKLOOP_NUMBER(surges, valve, spring_active_kg, from(0).up_to(100));
    CRANKLOOP_NUMBER(surges, valve, inner_spring_N_m, from(0).up_to(1e9));
    CRANKLOOP_NUMBER(surges, valve, inner_spring_kg, from(0).up_to(100));
  }
};

struct ValveTrain {
  Cam cam;
  Rocker rocker;
  Valve valve;

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_PART(1, cam);
    CRANKLOOP_PART(1, rocker);
    CRANKLOOP_PART(1, valve);
  }
};

/// Field names "cam.*", "rocker.*", "valve.*", as in the engine file without unit (valve.spring_rate is its
/// spring_N_per_mm); `index` is the row or the exponent. That the geometry closes over the whole cam is
/// checked where the lift is worked out.
Status validate(const Cam& cam) noexcept;
Status validate(const Rocker& rocker) noexcept;
Status validate(const Valve& valve) noexcept;
Status validate(const ValveTrain& train) noexcept;

}  // namespace crankloop

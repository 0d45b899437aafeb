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
  double max_lift_m = 0;                    ///< > 0, at most 0.1
  double half_angle_deg = 0;                ///< cam degrees, 10 to 180
  int exponent_count = 0;                   ///< 2 to 8
  double exponents[kMaxCamExponents] = {};  ///< 2 to 100, rising by at least 0.1
  // table
  const CamPoint* points =
      nullptr;  ///< rising angles, -360 to 360 and within one turn; the caller keeps them alive while tabulating
  int point_count = 0;     ///< 8 to 2000
  double smoothing_m = 0;  ///< largest residual allowed in smoothing, > 0, at most 1e-3
  // place in the cycle
  double full_lift_deg =
      0;  ///< engine crank angle of full theoretical lift in the cylinder's own cycle, 0 to below 720
  double phase_rate_deg_s = 0;  ///< how fast a cam phaser may move, crank degrees per second; 0 = fixed cam; 0 to 1e5

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const bool polynomial = self.source == CamSource::polynomial;
    CRANKLOOP_FIELD(1, cam, source);
    CRANKLOOP_FIELD(1, cam, full_lift_deg);
    CRANKLOOP_FIELD(1, cam, phase_rate_deg_s);
    CRANKLOOP_FIELD(polynomial ? 1 : 0, cam, max_lift_m);
    CRANKLOOP_FIELD(polynomial ? 1 : 0, cam, half_angle_deg);
    CRANKLOOP_FIELD(polynomial ? 1 : 0, cam, exponent_count);
    CRANKLOOP_FIELD(polynomial ? self.exponent_count : 0, cam, exponents);
    CRANKLOOP_FIELD(polynomial ? 0 : 1, cam, smoothing_m);
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
  double base_circle_m = 0;  ///< r_0, radius; > 0, at most 1
  double clearance_m = 0;    ///< lash at the base circle; 0 to 0.01
  double ratio = 1;          ///< kind ratio: valve lift per follower lift; > 0, at most 10
  // circular pad
  double pivot_to_pad_m = 0;  ///< l_a; > 0, at most 1
  double pivot_to_cam_m = 0;  ///< l_c; > 0, at most 1
  double pad_radius_m = 0;    ///< r_s; > 0, at most 10
  double pivot_to_screw_m =
      0;  ///< l_b; kind ratio: 0, or the rocker's lever on the valve where it has an inertia; > 0, at most 1
  double screw_ball_m = 0;        ///< rho, radius; 0 to 1
  double stem_above_pivot_m = 0;  ///< z; -1 to 1
  CamTurns cam_turns = CamTurns::toward_pivot;

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const int of_ratio = self.kind == RockerKind::ratio ? 1 : 0;
    CRANKLOOP_FIELD(1, rocker, kind);
    CRANKLOOP_FIELD(1 - of_ratio, rocker, cam_turns);
    CRANKLOOP_FIELD(1, rocker, base_circle_m);
    CRANKLOOP_FIELD(1, rocker, clearance_m);
    CRANKLOOP_FIELD(of_ratio, rocker, ratio);
    CRANKLOOP_FIELD(1 - of_ratio, rocker, pivot_to_pad_m);
    CRANKLOOP_FIELD(1 - of_ratio, rocker, pivot_to_cam_m);
    CRANKLOOP_FIELD(1 - of_ratio, rocker, pad_radius_m);
    CRANKLOOP_FIELD(1, rocker, pivot_to_screw_m);
    CRANKLOOP_FIELD(1 - of_ratio, rocker, screw_ball_m);
    CRANKLOOP_FIELD(1 - of_ratio, rocker, stem_above_pivot_m);
  }
};

/// The moving parts of one valve as a single mass.
struct Valve {
  int per_cylinder = 1;             ///< alike and computed once; 1 to 8
  double valve_kg = 0;              ///< with retainer and collets; > 0, at most 100
  double spring_kg = 0;             ///< a third of it moves; 0 to 100
  double rocker_inertia_kg_m2 = 0;  ///< about its pivot; 0 for kind ratio without a lever; 0 to 100
  double spring_N_m = 0;            ///< k_s; 0 to 1e9
  double spring_preload_N = 0;      ///< P_s0; > 0, at most 1e6
  double train_N_m = 0;             ///< k; > 0, at most 1e12
  double train_damping_ratio = 0;   ///< b = 2 zeta sqrt(k M); 0 to 10
  double guide_damping_ratio = 0;   ///< c = 2 zeta sqrt(k M); 0 to 10
  double seat_N_m = 0;              ///< k_z; > 0, at most 1e12
  double seat_damping_ratio = 0;    ///< b_z = 2 zeta sqrt(k_z M); 0 to 10
  double head_area_m2 = 0;          ///< cylinder pressure on it closes the valve; 0 = none; 0 to 1

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_FIELD(0, valve, per_cylinder);
    CRANKLOOP_FIELD(1, valve, valve_kg);
    CRANKLOOP_FIELD(1, valve, spring_kg);
    CRANKLOOP_FIELD(1, valve, rocker_inertia_kg_m2);
    CRANKLOOP_FIELD(1, valve, spring_N_m);
    CRANKLOOP_FIELD(1, valve, spring_preload_N);
    CRANKLOOP_FIELD(1, valve, train_N_m);
    CRANKLOOP_FIELD(1, valve, train_damping_ratio);
    CRANKLOOP_FIELD(1, valve, guide_damping_ratio);
    CRANKLOOP_FIELD(1, valve, seat_N_m);
    CRANKLOOP_FIELD(1, valve, seat_damping_ratio);
    CRANKLOOP_FIELD(1, valve, head_area_m2);
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
/// spring_N_per_mm); `index` is the row or the exponent. Ranges as the comments state; that the geometry
/// closes over the whole cam is checked where the lift is worked out.
Status validate(const Cam& cam) noexcept;
Status validate(const Rocker& rocker) noexcept;
Status validate(const Valve& valve) noexcept;
Status validate(const ValveTrain& train) noexcept;

}  // namespace crankloop

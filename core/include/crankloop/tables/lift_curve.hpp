// Theoretical valve lift over the cam angle: one quintic per cam degree of the lobe, a constant outside.
//
// What belongs here: how the lift is stored and read. What does not: how it is computed (tabulate/), the valve's motion
// (valve.hpp).
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/limits.hpp>
#include <crankloop/tables/angle.hpp>
#include <crankloop/tables/curve.hpp>

namespace crankloop::detail {

/// Lift of the train, not clipped (negative while the lash is open), and its derivative by the cam angle in degrees.
template <class Real>
struct Lift {
  Real lift_m;
  Real per_deg_m;
};

/// Lash in m beyond which the train cannot touch a closed valve, however the valve oscillates on its seat.
inline constexpr double kLeastLash = 1e-6;

/// Y(u) = c[0] + u (c[1] + ...), u = fraction of the cam degree. Through lift, slope and curvature at both ends, so all
/// three are continuous.
template <class Real>
struct LiftSegment {
  Real c[6];
};

/// The first segment begins exactly where the lobe opens, so a kink of the higher derivatives can only lie inside the
/// last one.
template <class Real>
struct LiftCurve {
  const LiftSegment<Real>* at;
  const Segment<Real>* rocker_ratio;   ///< cam force per valve force, in the cells of `at`
  std::uint64_t opens[kMaxCylinders];  ///< per cylinder: engine phase at which its lobe starts; 2^64 = 360 cam deg
  std::uint64_t most_phase_per_tick;   ///< largest movement of the phaser in a tick, phase units; 0 = fixed cam
  std::uint32_t segments;              ///< cam degrees of the lobe
  std::uint32_t touch_from;  ///< first degree of the lobe in which the train may touch a closed valve: its lash is less
                             ///< than kLeastLash
  std::uint32_t touch_degrees;  ///< number of such degrees
  Real skip_deg;   ///< cam travel at which one tick may skip all of them; more than a turn if there are none
  Real outside_m;  ///< lift outside the lobe: minus the clearance

  /// Rows of `at` and of `rocker_ratio`: one per degree of the lobe, and one for the base circle if there is any.
  [[nodiscard]] constexpr std::uint32_t rows() const noexcept {
    return segments < std::uint32_t{kDegreesPerTurn} ? segments + 1 : segments;
  }

  /// Cam angle, counted from the start of the lobe.
  [[nodiscard]] static constexpr Cell cell(std::uint64_t since_opening) noexcept {
    return cell_of<Real>(since_opening, 360);
  }
  /// Angle of a cylinder's cam at the train's phase.
  [[nodiscard]] constexpr Cell cell(std::uint64_t phase, std::uint32_t cylinder) const noexcept {
    CRANKLOOP_ASSERT(cylinder < std::uint32_t{kMaxCylinders});
    return cell(detail::units_from<Real>(phase, opens[cylinder]));
  }

  [[nodiscard]] constexpr Lift<Real> read(Cell cell) const noexcept {
    CRANKLOOP_ASSERT(cell.degree < std::uint32_t{kDegreesPerTurn});
    if (cell.degree >= segments) return {outside_m, Real{0}};
    const Real u = fraction<Real>(cell);
    const Real(&c)[6] = at[cell.degree].c;
    // Horner's scheme for value and slope at once.
    Real slope = c[5];
    Real value = c[4] + u * c[5];
    for (int i = 3; i >= 0; --i) {
      slope = value + u * slope;
      value = c[i] + u * value;
    }
    return {value, slope};
  }

  /// Cam force per valve force, on the base circle too: a closed valve may be pressed onto its train.
  [[nodiscard]] constexpr Real rocker_ratio_at(Cell cell) const noexcept {
    const bool on_lobe = cell.degree < segments;
    return value(rocker_ratio[on_lobe ? cell.degree : segments], fraction<Real>(cell));
  }

  /// Second derivative by the cam angle in m/deg^2.
  [[nodiscard]] constexpr Real curvature(Cell cell) const noexcept {
    if (cell.degree >= segments) return Real{0};
    const Real u = fraction<Real>(cell);
    const Real(&c)[6] = at[cell.degree].c;
    return 2 * c[2] + u * (6 * c[3] + u * (12 * c[4] + u * (20 * c[5])));
  }

  /// Cam degrees since the start of the lobe; negative in the half of the base circle before it.
  [[nodiscard]] constexpr Real degrees(std::uint64_t since_opening) const noexcept {
    const Cell place = cell(since_opening);
    const auto degree = static_cast<std::int32_t>(place.degree);
    const bool before = 2 * degree > static_cast<std::int32_t>(segments) + kDegreesPerTurn;
    return static_cast<Real>(before ? degree - kDegreesPerTurn : degree) + fraction<Real>(place);
  }

  /// The middle of the base circle, counted from the start of the lobe.
  [[nodiscard]] constexpr std::uint64_t base_middle() const noexcept {
    CRANKLOOP_ASSERT(segments <= std::uint32_t{kDegreesPerTurn});
    return (std::uint64_t{segments} + kDegreesPerTurn) * (~std::uint64_t{0} / (std::uint64_t{2} * kDegreesPerTurn));
  }

  /// Whether the cam passes the middle of its base circle, where a cycle ends, between two phases.
  [[nodiscard]] constexpr bool passes_base_circle(std::uint64_t from, std::uint64_t to) const noexcept {
    const auto before = static_cast<std::int64_t>(from - base_middle());
    const auto after = static_cast<std::int64_t>(to - base_middle());
    constexpr std::int64_t kNear = std::int64_t{1} << 62;  // crossing zero there, not half a turn away
    return (before < 0) != (after < 0) && after < kNear && after > -kNear;
  }
};

/// A property of a train's valves over the cam angle: for each degree of the train's cam turn, one bit per cylinder.
struct CamDegrees {
  std::uint16_t cylinders[kDegreesPerTurn];
};
static_assert(kMaxCylinders <= 16);

/// A tick that turns the cams by at most this angle can end a valve's cycle only in degrees that `cycle_ends` marks.
inline constexpr int kCycleEndMargin_deg = 4;

}  // namespace crankloop::detail

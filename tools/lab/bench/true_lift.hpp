// A valve's true lift over the cycles that follow a start at rest in the middle of the cam's base circle.
//
// What belongs here: the reference's motion, stored densely enough to evaluate it at any angle. What does not: how it
// is integrated (../reference/valve_reference.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include <crankloop/define/valve_train.hpp>
#include <crankloop/phase.hpp>

#include "../reference/valve_reference.hpp"

namespace crankloop::program::bench {

inline constexpr double kCamDegPerUnit = 360.0 / 18446744073709551616.0;  ///< 2^64 phase units are 360 cam deg

/// Cam angle of a train from its full lift, -180 to 180 deg, at an engine phase counted from its cylinder's firing top
/// dead centre.
[[nodiscard]] double cam_deg_from_full_lift(std::uint64_t phase, double full_lift_deg) noexcept;

/// The engine phase at which that cam angle is reached.
[[nodiscard]] Phase phase_at_cam_deg(double cam_deg, double full_lift_deg) noexcept;

class TrueLift {
 public:
  TrueLift(const ValveTrain& train, double engine_rpm);

  /// At a cam angle from the first full lift, -180 deg to half a turn after the last. The quintic through neighbouring
  /// points of the reference has an error of 1e-6 um.
  [[nodiscard]] double lift_m(double cam_deg) const noexcept;

  /// 1 if the valve comes to rest before its next lobe: then all cycles are equal to the first. Else kCyclesToSettle: a
  /// valve off its seat starts its cycle with the error of the cycle before, which grows until bounces remove as much
  /// of it as they add.
  [[nodiscard]] int cycles() const noexcept { return cycles_; }
  static constexpr int kCyclesToSettle = 12;

  [[nodiscard]] int contact_changes() const noexcept { return changes_; }

 private:
  std::vector<valve_reference::Moment> moments_;
  int cycles_ = 1;
  int changes_ = 0;
  double deg_per_s_ = 0;
};

/// The motion of the 125's intake train (engines.hpp), computed once for each speed. Trains that differ only in phase
/// have the same.
[[nodiscard]] const TrueLift& true_lift_of_ohc_125(double engine_rpm);

}  // namespace crankloop::program::bench

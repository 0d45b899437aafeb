// How a valve spring surges at a constant speed where its end follows the theoretical lift: docs/model.md "Spring
// surge".
//
// What belongs here: the steady oscillation of its modes over a cycle. What does not: a mode's step
// (tabulate/spring_surge.hpp); what surge does to the valve's own motion (valve_loop.hpp).
#pragma once

#include <vector>

#include <crankloop/define/valve_train.hpp>
#include <crankloop/tabulate/valve_lift.hpp>

namespace crankloop::program {

/// What a valve's springs do beyond their static force.
struct SpringSurgeCycle {
  double frequency_Hz = 0;  ///< first natural frequency between fixed ends, of the slower spring; 0: without mass
  double largest_N = 0;  ///< magnitude, at the valve, over a cycle after all that was left of the start has decayed; 0
                         ///< where it oscillates over a thousand times while the cam turns once: too slow for surge
};

/// Slope of the theoretical lift over a turn of the cam, 0 where the valve is seated. One table serves any number of
/// speeds: each point of the exact lift takes an iteration.
class LiftSlopes {
 public:
  explicit LiftSlopes(const ValveLift& lift);
  /// In m/rad, between the table's points linear; `turn` from 0 to 1, 0.5 at full lift.
  [[nodiscard]] double at(double turn) const noexcept;

 private:
  static constexpr int kPerTurn = 18'000;
  struct Point {
    double lift_m;  ///< below 0 where the valve is seated: it opens and closes between two points
    double per_rad_m;
  };
  std::vector<Point> points_;
};

/// kMaxSpringModes modes of each spring, whatever surge_modes says; a damping ratio below 1e-4 counts as that, for
/// there is no steady state without. The valve must have passed validate().
[[nodiscard]] SpringSurgeCycle surge_over_cycle(const LiftSlopes& slopes, const Valve& valve, double cam_rad_s);

}  // namespace crankloop::program

// A free run's speed and torque over the crank angle, and what a cycle of it amounts to: mean speed, irregularity,
// harmonics, torque.
//
// What belongs here: whole cycles of 720 deg from one firing top dead centre of cylinder 1 to the next, turned forward
// without a stop. What does not: the run from its beginning (free_overview.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "free_loop.hpp"

namespace crankloop::program {

inline constexpr int kSamplesPerCycle = 1440;  ///< one each half degree
inline constexpr int kSpeedHarmonics = 24;

/// A cycle's samples at 0, 0.5, 1 ... 720 deg: the last is the next cycle's first.
struct FreeCycle {
  std::vector<FreeState> samples;

  /// A signal's edge.
  struct Edge {
    double time_s;
    double angle_deg;
    bool level;
  };
  std::vector<std::vector<Edge>> edges;  ///< per trigger wheel
  std::vector<bool> levels;              ///< per trigger wheel, as the cycle begins

  [[nodiscard]] double mean_speed_rad_s() const;  ///< angle over time
  [[nodiscard]] double largest_speed_rad_s() const;
  [[nodiscard]] double smallest_speed_rad_s() const;
  [[nodiscard]] double irregularity_ratio() const;  ///< (largest - smallest) / mean
  [[nodiscard]] double mean_torque_Nm() const;      ///< of gas and masses: work over angle
  [[nodiscard]] double external_torque_Nm() const;  ///< mean, against the rotation

  /// Amplitudes of the speed over the angle, of orders 0.5, 1, 1.5 ... per crank turn, in rad/s.
  [[nodiscard]] std::vector<double> harmonics_rad_s() const;
};

/// Takes ticks, keeps the last cycles. Memory does not grow with the run.
class CycleRecorder {
 public:
  static constexpr std::size_t kKept = 3;

  explicit CycleRecorder(std::size_t wheels) : level_(wheels) {}

  /// A tick from one state to the next. Within it the angle is the cubic over time that has speed and angle of both
  /// ends.
  void take(const FreeState& before, const FreeState& after);

  /// An edge of the tick that is taken next, `ratio` of it after its begin.
  void edge(std::size_t wheel, double ratio, bool level);
  /// The level before the first edge.
  void begin_at(std::size_t wheel, bool level) { level_[wheel] = level; }

  [[nodiscard]] const std::deque<FreeCycle>& cycles() const noexcept {
    return cycles_;
  }  ///< whole ones, the last at the back

 private:
  struct NewEdge {
    std::size_t wheel;
    double ratio;
    bool level;
  };
  void begin(const FreeState& at);

  bool recording_ = false;  ///< since a firing top dead centre, and forward ever since
  FreeCycle now_;
  std::vector<bool> level_;
  std::vector<NewEdge> new_edges_;
  std::deque<FreeCycle> cycles_;
};

}  // namespace crankloop::program

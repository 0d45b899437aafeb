// What the examples that hold an idle speed share: smoothing, the PI law, the starter, the loop.
//
// What belongs here: the controller. What does not: where the speed comes from (idle_control.cpp: the outputs;
// edge_counter.cpp: edges).
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "follow_block.hpp"

namespace crankloop::port::example {

inline constexpr double kRpmPerRad_s = 30 / 3.14159265358979323846;

/// Speed seen through a low-pass filter: an engine of four cylinders pulses 27 times a second at 800 rpm, and a
/// controller is not to answer that.
class SmoothSpeed {
 public:
  void take(double speed_rad_s, double period_s) noexcept {
    value_rad_s_ += (speed_rad_s - value_rad_s_) * period_s / (kTime_s + period_s);
  }
  [[nodiscard]] double rad_s() const noexcept { return value_rad_s_; }

 private:
  static constexpr double kTime_s = 0.03;
  double value_rad_s_ = 0;
};

struct Gains {
  double per_rad_s;  ///< of the error in rad/s
  double per_rad;    ///< of its integral in rad
  double most;
  double begin;  ///< of the integral, about what idling takes
};
/// Of the load ratio, for the 495 diesel: 210 Nm at load ratio 1 on about 0.6 kg m^2. The proportional part alone would
/// close an error within 0.2 s.
inline constexpr Gains kLoadGains{0.015, 0.03, 0.5, 0};
/// Of the throttle, for the two-litre engine: torque follows some 0.3 s after it, as the intake manifold fills, so the
/// controller is slower than that.
inline constexpr Gains kThrottleGains{0.00015, 0.0001, 0.1, 0.008};

/// Proportional and integral.
class IdleControl {
 public:
  IdleControl(double target_rad_s, const Gains& gains) noexcept : target_rad_s_{target_rad_s}, gains_{gains} {}

  /// The load ratio, or throttle, for the next period.
  [[nodiscard]] double ratio(double speed_rad_s, double period_s) noexcept {
    const double error_rad_s = target_rad_s_ - speed_rad_s;
    const double wanted = gains_.per_rad_s * error_rad_s + integral_;
    const double allowed = std::clamp(wanted, 0.0, gains_.most);
    if (wanted == allowed) integral_ += gains_.per_rad * error_rad_s * period_s;  // at a limit it would only wind up
    return allowed;
  }

 private:
  double target_rad_s_;
  Gains gains_;
  double integral_ = gains_.begin;
};

/// Fuel by the air in each cylinder. Late spark: the engine makes less of its air, so that the throttle stands where it
/// can move both ways.
inline void feed(LiveInputs& in) noexcept {
  in.excess_air_ratio = 1;
  in.burn_start_deg = 10;
}

/// Engaged from rest to half the target, and again where the engine stalls.
inline bool starter_needed(bool engaged, double speed_rad_s, double target_rad_s) noexcept {
  return speed_rad_s < (engaged ? 0.5 : 0.1) * target_rad_s;
}

/// What the second half of the run was like.
class Record {
 public:
  void take(double raw_rad_s, double smooth_rad_s, double target_rad_s) noexcept {
    ++count_;
    sum_rad_s_ += smooth_rad_s;
    peak_error_rad_s_ = std::max(peak_error_rad_s_, std::abs(smooth_rad_s - target_rad_s));
    lowest_rad_s_ = std::min(lowest_rad_s_, raw_rad_s);
    highest_rad_s_ = std::max(highest_rad_s_, raw_rad_s);
  }
  void print(double target_rad_s) const {
    const double mean_rad_s = count_ == 0 ? 0 : sum_rad_s_ / count_;
    std::printf("target = %.1f rpm\n", target_rad_s * kRpmPerRad_s);
    std::printf("mean_speed = %.2f rpm\n", mean_rad_s * kRpmPerRad_s);
    std::printf("mean_error = %.2f rpm\n", (mean_rad_s - target_rad_s) * kRpmPerRad_s);
    std::printf("peak_error = %.2f rpm  # of the smoothed speed\n", peak_error_rad_s_ * kRpmPerRad_s);
    std::printf("lowest_speed = %.1f rpm  # within the engine's cycle\n", lowest_rad_s_ * kRpmPerRad_s);
    std::printf("highest_speed = %.1f rpm\n", highest_rad_s_ * kRpmPerRad_s);
  }

 private:
  int count_ = 0;
  double sum_rad_s_ = 0;
  double peak_error_rad_s_ = 0;
  double lowest_rad_s_ = 1e9;
  double highest_rad_s_ = -1e9;
};

/// Starts the engine and holds its speed for some seconds by `speed`, whose rad_s(now_ns) is asked every 5 ms. Returns
/// an exit status; prints how well the speed was held in the second half.
template <class Speed>
int hold_idle(const char* program, const SharedBlock& block, Speed& speed, double target_rad_s, double seconds) {
  constexpr auto kPeriod = std::chrono::milliseconds(5);
  constexpr double kPeriod_s = 5e-3;
  SmoothSpeed smooth;
  const bool breathes = block->breathes != 0;
  IdleControl idle(target_rad_s, breathes ? kThrottleGains : kLoadGains);
  Record record;
  LiveInputs in;
  Pulse pulse(block);
  Pulse::Found found = Pulse::Found::runs;
  bool engaged = true;
  double running_after_s = -1;
  const auto periods = static_cast<int>(seconds / kPeriod_s);
  auto next = Clock::now();
  for (int period = 0; period < periods && (found = pulse.feel()) == Pulse::Found::runs; ++period) {
    const double speed_rad_s = speed.rad_s(now_ns());
    smooth.take(speed_rad_s, kPeriod_s);
    engaged = starter_needed(engaged, smooth.rad_s(), target_rad_s);
    in.starter = engaged ? 1 : 0;
    const double ratio = idle.ratio(smooth.rad_s(), kPeriod_s);
    (breathes ? in.throttle_ratio : in.load_ratio) = ratio;
    if (breathes) feed(in);
    block->inputs.write(in);  // every period, changed or not: the sign of life

    if (running_after_s < 0 && smooth.rad_s() > 0.9 * target_rad_s) running_after_s = period * kPeriod_s;
    if (period >= periods / 2) record.take(speed_rad_s, smooth.rad_s(), target_rad_s);
    next += kPeriod;
    std::this_thread::sleep_until(next);
  }
  block->inputs.write(LiveInputs{});
  const std::string problem = Pulse::in_words(found);
  if (!problem.empty()) {
    std::fprintf(stderr, "%s: %s\n", program, problem.c_str());
    return EXIT_FAILURE;
  }
  if (running_after_s < 0) {
    std::fprintf(stderr, "%s: the engine did not start\n", program);
    return EXIT_FAILURE;
  }
  std::printf("running_after = %.2f s  # 90 %% of the target\n", running_after_s);
  record.print(target_rad_s);
  return EXIT_SUCCESS;
}

}  // namespace crankloop::port::example

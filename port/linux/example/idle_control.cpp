// A controller for `crankloop live`: starts the engine and holds its idle speed, by the load ratio alone; by the
// throttle, with gas exchange. An example to start from.
//
//   crankloop live diesel_495.ini --shared /dev/shm/engine --seconds 12 &
//   idle_control /dev/shm/engine --seconds 10
//
//   crankloop live four_2000.ini --shared /dev/shm/engine --seconds 12 &
//   idle_control /dev/shm/engine --seconds 10 --target-rpm 1200
//
//   --target-rpm N   idle speed, default 800          --seconds S   how long, default 10
//
// Prints how well the speed was held in the second half of its time. docs/live.md walks through it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

#include "port/linux/shared_block.hpp"

namespace {

using crankloop::port::LiveInputs;
using crankloop::port::LiveOutputs;
using crankloop::port::LiveState;
using crankloop::port::SharedBlock;
using crankloop::port::SharedBlockError;
using Clock = std::chrono::steady_clock;

constexpr double kRpmPerRad_s = 30 / 3.14159265358979323846;

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
constexpr Gains kLoadGains{0.015, 0.03, 0.5, 0};
/// Of the throttle, for the two-litre engine: torque follows some 0.3 s after it, as the intake manifold fills, so the
/// controller is slower than that.
constexpr Gains kThrottleGains{0.00015, 0.0001, 0.1, 0.008};

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
void feed(LiveInputs& in) noexcept {
  in.excess_air_ratio = 1;
  in.burn_start_deg = 10;
}

/// Engaged from rest to half the target, and again where the engine stalls.
bool starter_needed(bool engaged, double speed_rad_s, double target_rad_s) noexcept {
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

/// Waits for `live` to run. Throws where it does not within the patience.
SharedBlock wait_for(const std::string& path, std::chrono::seconds patience) {
  for (const auto deadline = Clock::now() + patience;;) {
    const bool last_try = Clock::now() > deadline;
    try {
      SharedBlock block = SharedBlock::open(path);
      if (block->state == LiveState::running) return block;
      if (last_try) throw SharedBlockError(path + ": does not run");
    } catch (const SharedBlockError&) {
      if (last_try) throw;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

int control(const SharedBlock& block, double target_rad_s, double seconds) {
  constexpr auto kPeriod = std::chrono::milliseconds(5);
  constexpr double kPeriod_s = 5e-3;
  SmoothSpeed smooth;
  const bool breathes = block->breathes != 0;
  IdleControl idle(target_rad_s, breathes ? kThrottleGains : kLoadGains);
  Record record;
  LiveInputs in;
  LiveOutputs out;
  bool engaged = true;
  double running_after_s = -1;
  const auto periods = static_cast<int>(seconds / kPeriod_s);
  auto next = Clock::now();
  for (int period = 0; period < periods && block->state == LiveState::running; ++period) {
    std::uint32_t sequence = 0;
    static_cast<void>(
        block->outputs.read(out, sequence));  // caught half written: the ones of the period before will do
    smooth.take(out.speed_rad_s, kPeriod_s);
    engaged = starter_needed(engaged, smooth.rad_s(), target_rad_s);
    in.starter = engaged ? 1 : 0;
    const double ratio = idle.ratio(smooth.rad_s(), kPeriod_s);
    (breathes ? in.throttle_ratio : in.load_ratio) = ratio;
    if (breathes) feed(in);
    block->inputs.write(in);  // every period, changed or not: the sign of life

    if (running_after_s < 0 && smooth.rad_s() > 0.9 * target_rad_s) running_after_s = period * kPeriod_s;
    if (period >= periods / 2) record.take(out.speed_rad_s, smooth.rad_s(), target_rad_s);
    next += kPeriod;
    std::this_thread::sleep_until(next);
  }
  block->inputs.write(LiveInputs{});
  if (running_after_s < 0) {
    std::fprintf(stderr, "idle_control: the engine did not start\n");
    return EXIT_FAILURE;
  }
  std::printf("running_after = %.2f s  # 90 %% of the target\n", running_after_s);
  record.print(target_rad_s);
  return EXIT_SUCCESS;
}

}  // namespace

int main(int count, char** words) {
  const char* path = nullptr;
  double target_rpm = 800;
  double seconds = 10;
  for (int i = 1; i < count; ++i) {
    const bool has_value = i + 1 < count;
    if (has_value && std::strcmp(words[i], "--target-rpm") == 0) {
      target_rpm = std::atof(words[++i]);
    } else if (has_value && std::strcmp(words[i], "--seconds") == 0) {
      seconds = std::atof(words[++i]);
    } else {
      path = words[i];
    }
  }
  if (path == nullptr || !(target_rpm > 0) || !(seconds > 0 && seconds <= 1e6)) {  // so many periods are an int
    std::fprintf(stderr, "usage: idle_control PATH [--target-rpm N] [--seconds S]\n");
    return EXIT_FAILURE;
  }
  try {
    return control(wait_for(path, std::chrono::seconds(10)), target_rpm / kRpmPerRad_s, seconds);
  } catch (const SharedBlockError& error) {
    std::fprintf(stderr, "idle_control: %s\n", error.what());
    return EXIT_FAILURE;
  }
}

// Over which speeds a valve keeps to its cam: a sweep, and the speeds at which float and bounce begin.
//
// What belongs here: the search and its results. What does not: how they are shown (redline_text.cpp,
// redline_report.cpp).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "../../loops/valve_loop.hpp"

namespace crankloop::program {

/// How every speed is run: in double, from rest, the last of kRedlineCycles counts.
inline constexpr double kRedlineTick_s = 20e-6;
inline constexpr int kRedlineCycles = 4;

/// A whole number of rpm each; the sweep has at most 61 speeds.
struct SpeedRange {
  int from_rpm;
  int to_rpm;
  int step_rpm;
};
[[nodiscard]] SpeedRange speed_range(int from_rpm, int to_rpm) noexcept;

/// What an engineer allows a valve.
struct RedlineLimits {
  double bounce_m = 50e-6;   ///< the least that counts as a bounce
  double seating_m_s = 0.5;  ///< seats and heads are made for less
  double lift_m = 0;         ///< where the spring binds; 0: kMaxLiftRatio times the theoretical lift
};
inline constexpr double kMaxLiftRatio = 1.5;  ///< no spring has room for more

/// What the valve does in a cycle at one speed; forces are the largest of the ticks.
struct SpeedResult {
  int speed_rpm;
  ValveCycle<double> cycle;
  double train_N;
  double cam_N;
  double spring_margin;  ///< least of rigid parts; infinite where the valve never opens
  bool is_possible;      ///< false: the valve flies further than its spring has room, which the model does not know
};

/// The lowest speed of the sweep's range at which something happens, to 1 rpm.
struct Onset {
  bool found = false;
  bool at_the_start = false;  ///< it happens at the range's lowest speed already
  int speed_rpm = 0;
};

struct Sweep {
  double factor = 1;     ///< or value, of the quantity that is varied
  std::string value{};   ///< the same as text
  bool as_given = true;  ///< the train as the file has it
  double tick_s = 0;
  std::vector<SpeedResult> at;
  double max_lift_m = 0;  ///< of what is possible
  StaticRedline rigid;
  Onset separation;
  Onset bounce;
  Onset seating;  ///< faster than the limit
};

/// Sweeps the range and narrows the onsets down: between the first speed of the sweep that has a separation of at least
/// 1 um (a bounce of at least limits.bounce_m, a seating speed above limits.seating_m_s) and the one before. What comes
/// and goes between two speeds of the sweep is not seen. A speed at a time, for those who show it while they wait.
class SpeedSearch {
 public:
  enum class Part : std::uint8_t { sweep, separation, bounce, seating, ended };

  /// The valve must outlive it.
  SpeedSearch(const LoneValve& valve, const SpeedRange& range, double factor, const RedlineLimits& limits = {});

  [[nodiscard]] Part part() const noexcept { return part_; }  ///< of the next speed
  SpeedResult step();                                         ///< runs it; not when ended

  [[nodiscard]] const Sweep& sweep() const noexcept { return sweep_; }  ///< whole when ended

 private:
  [[nodiscard]] SpeedResult run(int speed_rpm);
  [[nodiscard]] bool happens(const SpeedResult& result) const noexcept;
  [[nodiscard]] Onset& onset() noexcept;
  void begin_part(Part part);

  const LoneValve& valve_;
  SpeedRange range_;
  RedlineLimits limits_;
  Sweep sweep_;
  ValveLoop<double> loop_;
  Part part_ = Part::sweep;
  int next_rpm_;
  int without_rpm_ = 0;  ///< the onset is above this
};

/// The search from its begin to its end. `after_speed` is called after each speed that was run.
[[nodiscard]] Sweep sweep_speeds(const LoneValve& valve, const SpeedRange& range, double factor,
                                 const std::function<void()>& after_speed, const RedlineLimits& limits = {});

/// What may be varied: its name as an option, and the keys that are multiplied.
struct Influence {
  const char* option;
  const char* title;
  const char* keys;
};
inline constexpr Influence kInfluences[] = {
    {"train", "Train stiffness", "train_N_per_mm"},
    {"mass", "Moving mass", "valve_g, spring_g and rocker_inertia_kg_mm2"},
    {"spring", "Spring rate", "spring_N_per_mm"},
    {"preload", "Spring preload", "spring_preload_N"},
    {"damping", "Damping", "train_damping_ratio, guide_damping_ratio and seat_damping_ratio"},
};
inline constexpr double kInfluenceFactors[] = {0.5, 0.7, 0.85, 1, 1.2, 1.5, 2};

/// The valve with the quantity multiplied. All else of the definition stays, damping ratios included.
[[nodiscard]] Valve varied(const Valve& valve, const std::string& option, double factor);

}  // namespace crankloop::program

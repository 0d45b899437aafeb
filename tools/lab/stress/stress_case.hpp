// One random valve train and its operating point: a function of a seed and a number, so that any case can be repeated
// alone.
//
// What belongs here: the random values and their ranges. What does not: running a case (stress_trial.hpp).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <crankloop/define/valve_train.hpp>
#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::program {

/// splitmix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
class Draws {
 public:
  explicit Draws(std::uint64_t seed) noexcept : state_{seed} {}

  std::uint64_t bits() noexcept;
  double between(double low, double high) noexcept;
  double logarithmic(double low, double high) noexcept;  ///< 0 < low < high; every octave is equally likely
  bool one_in(std::uint64_t n) noexcept { return bits() % n == 0; }

 private:
  std::uint64_t state_;
};

/// Which cases are drawn: all of the table below, or only smooth ones, whose error is that of the steps alone. Their
/// cams have derivatives of every order over the lobe, train and seat are damped, the speed is 0.2 to 0.8 of that at
/// which a rigid train would separate, and they begin before the lobe. So no kink of the lift and no bounce amplifies
/// an error.
enum class StressKind : std::uint8_t { any, smooth };

enum class CamShape : std::uint8_t { sample, polynomial, dwell };

/// | what                            | from   | to        |                                                   |
/// | ------------------------------- | ------ | --------- | ------------------------------------------------- |
/// | train and seat stiffness, N/mm  | 1e3    | 1e6       | logarithmic, each by itself                       |
/// | valve and spring, kg            | 0.01   | 0.5       | logarithmic                                       |
/// | spring rate, N/mm; preload, N   | 5; 50  | 200; 1000 | logarithmic                                       |
/// | damping ratio of train and seat | 0      | 2         | each: one in five is 0                            |
/// | of the guide                    | 0.001  | 0.1       | logarithmic; one in five is 0                     |
/// | clearance, mm                   | 0      | 1         | one in ten is 0                                   |
/// | tick, us                        | 1      | 2000      | logarithmic                                       |
/// | accuracy asked for, um          | 0.01   | 10        | logarithmic                                       |
/// | speed, rpm                      | 1e-6   | 30 000    | logarithmic, two in three from 100; one in 50 is 0 or -0 |
///
/// A third each has the 125's cam and rocker, a random polynomial with a constant ratio, a table with a dwell at full
/// lift. One in two each: float or double, either integrator, forwards or backwards.
struct StressCase {
  StressCase(std::uint64_t seed, std::uint64_t number, StressKind drawn = StressKind::any);
  StressCase(const StressCase&) = delete;  // the train points to the rows
  StressCase& operator=(const StressCase&) = delete;

  CamShape shape = CamShape::sample;
  std::vector<CamPoint> rows;  ///< of a dwell
  ValveTrain train;
  TickOptions options;
  bool in_float = false;
  double speed_rpm = 0;
  double start_deg = 0;             ///< of the engine: anywhere, or shortly before contact with train or seat
  std::uint64_t own_seed = 0;       ///< seed of the random numbers in the trial
  double reference_mass_ratio = 1;  ///< other than 1: the reference has another mass, to test that the rule detects it

  [[nodiscard]] double speed_rad_s() const noexcept;

  /// Smallest radius of curvature of the cam's contour, by formulas independent of the library: a cam with 0 or less
  /// cannot be ground.
  [[nodiscard]] double smallest_radius_m() const;

  /// The case in one line.
  [[nodiscard]] std::string text() const;

 private:
  void draw_cam(Draws& draw);
  void draw_valve(Draws& draw);
  void draw_operation(Draws& draw);
  void make_smooth(Draws& draw);
  void make_calm(Draws& draw);
  [[nodiscard]] double follower_lift_m(double from_full_lift_deg) const;

  double flank_deg_ = 0;  ///< of a dwell
  double dwell_deg_ = 0;
};

}  // namespace crankloop::program

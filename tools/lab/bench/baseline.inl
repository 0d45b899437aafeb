// The plain engine's code: included by baseline.cpp and baseline_usual_flags.cpp, which differ in their flags.
//
// What belongs here: piston motion by the mathematics library or by linear tables, torque, and every valve by one
// textbook Runge-Kutta step per tick with the cam's lift from a linear table. Written plainly and well: the angle is
// counted in an integer, the table look-ups are one multiplication, what a step needs of the one before is kept, and
// nothing is computed twice.
#include "baseline.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "../../crankloop/files/units.hpp"  // constants only

namespace crankloop::program::bench {
namespace {

/// As textbooks print it, in double: derivatives by the crank angle.
class LibmPistons {
 public:
  explicit LibmPistons(const PlainEngineData& d) : r_{d.crank_radius_m}, l_{d.rod_length_m}, lambda_{r_ / l_} {}

  template <class Real>
  BENCH_INLINE PlainPiston<Real> at(std::uint64_t phase) const noexcept {
    const double a = static_cast<double>(static_cast<std::int64_t>(phase << 1)) * (kPi / 0x1p63);
    const double sin_a = std::sin(a);
    const double cos_a = std::cos(a);
    const double b = std::asin(lambda_ * sin_a);
    const double cos_b = std::cos(b);
    return {static_cast<Real>(r_ * (1 - cos_a) + l_ * (1 - cos_b)), static_cast<Real>(r_ * std::sin(a + b) / cos_b),
            static_cast<Real>(r_ * (std::cos(a + b) / cos_b + lambda_ * cos_a * cos_a / (cos_b * cos_b * cos_b)))};
  }

 private:
  double r_, l_, lambda_;
};

template <class Real>
class LinearPistons {
 public:
  explicit LinearPistons(const PlainEngineData& d) {
    const LibmPistons exact(d);
    for (std::size_t i = 0; i <= 360; ++i) {
      const auto degree = static_cast<std::uint64_t>(static_cast<double>(i % 360) / 720 * 0x1p64);
      const PlainPiston<double> p = exact.at<double>(degree);
      at_[i] = {static_cast<Real>(p.displacement_m), static_cast<Real>(p.velocity_m_s),
                static_cast<Real>(p.acceleration_m_s2)};
    }
  }

  template <class>
  BENCH_INLINE PlainPiston<Real> at(std::uint64_t phase) const noexcept {
    const std::uint64_t product = std::uint64_t{static_cast<std::uint32_t>(phase >> 31)} * 360;
    const PlainPiston<Real>& from = at_[product >> 32];
    const PlainPiston<Real>& to = at_[(product >> 32) + 1];
    const Real u = static_cast<Real>(static_cast<std::int32_t>(static_cast<std::uint32_t>(product) >> 8)) *
                   static_cast<Real>(0x1p-24);
    return {from.displacement_m + u * (to.displacement_m - from.displacement_m),
            from.velocity_m_s + u * (to.velocity_m_s - from.velocity_m_s),
            from.acceleration_m_s2 + u * (to.acceleration_m_s2 - from.acceleration_m_s2)};
  }

 private:
  std::array<PlainPiston<Real>, 361> at_{};
};

template <class Real>
class LinearLift {
 public:
  explicit LinearLift(const PlainEngineData& d) {
    for (std::size_t i = 0; i <= 360; ++i)
      at_[i] = {static_cast<Real>(d.lift_m[i]), static_cast<Real>(d.lift_per_deg_m[i])};
  }

  BENCH_INLINE PlainCam<Real> at(std::uint64_t since_opening, Real deg_per_s) const noexcept {
    const std::uint64_t product = (since_opening >> 32) * 360;
    const PlainCam<Real>& from = at_[product >> 32];
    const PlainCam<Real>& to = at_[(product >> 32) + 1];
    const Real u = static_cast<Real>(static_cast<std::int32_t>(static_cast<std::uint32_t>(product) >> 8)) *
                   static_cast<Real>(0x1p-24);
    return {from.lift_m + u * (to.lift_m - from.lift_m),
            (from.speed_m_s + u * (to.speed_m_s - from.speed_m_s)) * deg_per_s};
  }

 private:
  std::array<PlainCam<Real>, 361> at_{};  // speed per degree per second
};

template <class Real, class Pistons>
class PlainEngineOf final : public PlainEngine<Real> {
 public:
  explicit PlainEngineOf(const PlainEngineData& d)
      : pistons_at_{d},
        lift_{d},
        valve_{d.valve.rounded<Real>()},
        per_mass_{1 / valve_.mass_kg},
        tick_s_{static_cast<Real>(d.tick_s)},
        speed_rad_s_{static_cast<Real>(d.speed_rad_s)},
        cam_deg_per_s_{static_cast<Real>(d.speed_rad_s / 2 * 180 / kPi)},
        area_m2_{static_cast<Real>(d.bore_area_m2)},
        crankcase_Pa_{static_cast<Real>(d.crankcase_Pa)},
        reciprocating_kg_{static_cast<Real>(d.reciprocating_kg)},
        increment_{static_cast<std::uint64_t>(d.speed_rad_s * d.tick_s / (4 * kPi) * 0x1p64)} {
    this->phase = units(d.start_deg);
    for (const double firing_deg : d.firing_deg) firing_.push_back(units(firing_deg));
    for (const double opens_deg : d.lobe_opens_deg) opens_.push_back(units(opens_deg));
    this->pistons.resize(firing_.size());
    this->valves.resize(firing_.size() * opens_.size());
    states_.resize(this->valves.size());
    for (std::size_t k = 0; k < firing_.size(); ++k) {
      for (std::size_t t = 0; t < opens_.size(); ++t) {
        Moving& moving = states_[k * opens_.size() + t];
        const PlainCam<Real> cam = lift_.at(this->phase - firing_[k] - opens_[t], cam_deg_per_s_);
        moving.valve = {cam.lift_m > 0 ? cam.lift_m : Real{0}, cam.lift_m > 0 ? cam.speed_m_s : Real{0}};
        moving.acceleration_m_s2 =
            plain_acceleration(valve_, per_mass_, moving.valve.lift_m, moving.valve.velocity_m_s, cam);
      }
    }
  }

  void step(const Real* pressure_Pa) noexcept override {
    const std::uint64_t before = this->phase;
    const std::uint64_t now = before + increment_;
    this->phase = now;
    const Real speed_squared = speed_rad_s_ * speed_rad_s_;
    const std::size_t trains = opens_.size();
    Real sum_Nm = 0;
    for (std::size_t k = 0; k < firing_.size(); ++k) {
      const PlainPiston<Real> p = pistons_at_.template at<Real>(now - firing_[k]);
      const Real acceleration = p.acceleration_m_s2 * speed_squared;
      this->pistons[k] = {p.displacement_m, p.velocity_m_s * speed_rad_s_, acceleration};
      sum_Nm += ((pressure_Pa[k] - crankcase_Pa_) * area_m2_ - reciprocating_kg_ * acceleration) * p.velocity_m_s;
      for (std::size_t t = 0; t < trains; ++t) {
        step_valve(before - firing_[k] - opens_[t], states_[k * trains + t], this->valves[k * trains + t]);
      }
    }
    this->torque_Nm = sum_Nm;
  }

 private:
  /// What a valve's next step needs of this one.
  struct Moving {
    PlainState<Real> valve;
    Real acceleration_m_s2;  ///< the next step's first stage
  };

  BENCH_INLINE void step_valve(std::uint64_t from, Moving& moving, PlainValve<Real>& out) const noexcept {
    const PlainCam<Real> middle = lift_.at(from + increment_ / 2, cam_deg_per_s_);
    const PlainCam<Real> end = lift_.at(from + increment_, cam_deg_per_s_);
    const auto f = [this](Real y, Real v, PlainCam<Real> cam) {
      return plain_acceleration(valve_, per_mass_, y, v, cam);
    };
    moving.valve = textbook_step(f, tick_s_, moving.valve, moving.acceleration_m_s2, middle, end);
    moving.acceleration_m_s2 = f(moving.valve.lift_m, moving.valve.velocity_m_s, end);
    out = {moving.valve.lift_m, moving.valve.velocity_m_s};
  }

  /// 2^64 units are 720 deg.
  [[nodiscard]] static std::uint64_t units(double deg) noexcept {
    const double cycles = deg / 720 - std::floor(deg / 720);
    return static_cast<std::uint64_t>(cycles * 0x1p63) << 1;  // below 2^63 also where it rounds up
  }

  Pistons pistons_at_;
  LinearLift<Real> lift_;
  PlainBody<Real> valve_;
  Real per_mass_, tick_s_, speed_rad_s_, cam_deg_per_s_, area_m2_, crankcase_Pa_, reciprocating_kg_;
  std::uint64_t increment_;
  std::vector<std::uint64_t> firing_, opens_;
  std::vector<Moving> states_;
};

template <class Real>
[[nodiscard]] std::unique_ptr<PlainEngine<Real>> make_plain_engine(PlainPistons pistons, const PlainEngineData& data) {
  if (pistons == PlainPistons::libm) return std::make_unique<PlainEngineOf<Real, LibmPistons>>(data);
  return std::make_unique<PlainEngineOf<Real, LinearPistons<Real>>>(data);
}

}  // namespace
}  // namespace crankloop::program::bench

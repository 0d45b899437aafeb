// Methods to step one valve over a cam's turn: the textbook's, the same as matrices, and the library's tick.
//
// What belongs here: the contestants, all with the same calls: start(phase), step(), phase(), lift_m(). What does not:
// errors and times (valve.cpp). Every method looks up its cam itself, because that is part of the cost.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "crankloop/files/units.hpp"
#include "engines.hpp"
#include "plain_valve.hpp"
#include "race.hpp"
#include "scenes.hpp"

namespace crankloop::program::bench {

[[nodiscard]] inline double rad_s_of(double rpm) noexcept { return rpm * kPi / 30; }

/// How a valve is run.
struct ValveRun {
  double engine_rpm;
  double step_s;
  ValveStepping stepping{};  ///< the library's

  [[nodiscard]] double cycle_s() const noexcept { return 120 / engine_rpm; }
  [[nodiscard]] int steps_per_cycle() const noexcept { return static_cast<int>(cycle_s() / step_s + 0.5); }
};

/// Tables and engine of a scene with one cylinder of the 125.
template <class Real, class S>
class LibraryValve {
 public:
  explicit LibraryValve(const ValveRun& run) : tables_{std::make_unique<TableStorage<Real, S>>()} {
    if (!tables_->build(one_valve_engine(), {run.step_s, run.stepping}).ok())
      throw std::logic_error("the benchmark's valve was refused");
    input_.speed_rad_s = static_cast<Real>(rad_s_of(run.engine_rpm));
  }
  void start(Phase phase) {
    if (!engine_.init(tables_->tables(), phase).ok()) throw std::logic_error("the benchmark's tables were refused");
  }
  void step() noexcept { keep(engine_.step(input_).valve[0][0]); }

  /// Goes on from where it was.
  [[nodiscard]] typename Engine<Real, S>::State snapshot() const noexcept { return engine_.state(); }
  void restore(const typename Engine<Real, S>::State& state) noexcept { (void)engine_.restore(state); }

  [[nodiscard]] Phase phase() const noexcept { return engine_.state().phase; }
  [[nodiscard]] double lift_m() const noexcept { return static_cast<double>(engine_.output().valve[0][0].lift_m); }
  [[nodiscard]] const Tables<Real, S>& tables() const noexcept { return tables_->tables(); }

 private:
  std::unique_ptr<TableStorage<Real, S>> tables_;
  Engine<Real, S> engine_;
  typename Engine<Real, S>::Input input_;
};

/// The library's lift curve, as exact as the tick's.
template <class Real>
class CurveCam {
 public:
  explicit CurveCam(const detail::LiftCurve<Real>& curve) noexcept : curve_{&curve} {}
  [[nodiscard]] PlainCam<Real> at(std::uint64_t phase, Real deg_per_s) const noexcept {
    const detail::Lift<Real> lift = curve_->read(detail::LiftCurve<Real>::cell(phase - curve_->opens[0]));
    return {lift.lift_m, lift.per_deg_m * deg_per_s};
  }

 private:
  const detail::LiftCurve<Real>* curve_;
};

/// Lift and slope per cam degree, straight lines between.
template <class Real>
class LinearCam {
 public:
  explicit LinearCam(const detail::LiftCurve<Real>& curve) : opens_{curve.opens[0]}, at_(361) {
    for (std::uint32_t i = 0; i <= 360; ++i) {
      const detail::Lift<Real> lift = curve.read(detail::Cell{i % 360, 0, 0});
      at_[i] = {lift.lift_m, lift.per_deg_m};
    }
  }
  [[nodiscard]] PlainCam<Real> at(std::uint64_t phase, Real deg_per_s) const noexcept {
    const std::uint64_t product = ((phase - opens_) >> 32) * 360;
    const Knot& from = at_[product >> 32];
    const Knot& to = at_[(product >> 32) + 1];
    const Real u = static_cast<Real>(static_cast<std::int32_t>(static_cast<std::uint32_t>(product) >> 8)) *
                   static_cast<Real>(0x1p-24);
    return {from.lift_m + u * (to.lift_m - from.lift_m),
            (from.per_deg_m + u * (to.per_deg_m - from.per_deg_m)) * deg_per_s};
  }

 private:
  struct Knot {
    Real lift_m, per_deg_m;
  };
  std::uint64_t opens_;
  std::vector<Knot> at_;
};

/// The library's constants of a valve, under the names of the plain code.
[[nodiscard]] inline PlainBody<double> plain_body(const detail::ValveBody<double>& b) noexcept {
  return {b.mass_kg,    b.train_N_m,  b.train_Ns_m, b.seat_N_m,          b.seat_Ns_m,
          b.spring_N_m, b.guide_Ns_m, b.preload_N,  b.seat_compression_m};
}

/// The 125's valve alone, with the data that a plain loop needs.
template <class Real, class Cam>
class PlainLoop {
 public:
  void start(Phase phase) noexcept {
    phase_ = phase;
    state_ = {};
    cam_now_ = cam_.at(phase.units(), deg_per_s_);
  }
  [[nodiscard]] Phase phase() const noexcept { return phase_; }
  [[nodiscard]] double lift_m() const noexcept { return static_cast<double>(state_.lift_m); }

 protected:
  explicit PlainLoop(const ValveRun& run)
      : library_{ValveRun{run.engine_rpm, 10e-6}},
        cam_{library_.tables().lift_curves[0]},
        deg_per_s_{static_cast<Real>(run.engine_rpm * 3)},
        increment_{static_cast<std::uint64_t>(run.step_s / run.cycle_s() * 0x1p64)} {
    const LibraryValve<double, LoneElastic> exact(ValveRun{run.engine_rpm, 10e-6});
    body_ = plain_body(exact.tables().valve_motions[0].body);
  }

  LibraryValve<Real, LoneElastic> library_;  ///< for its tables only
  Cam cam_;
  Real deg_per_s_;
  std::uint64_t increment_;
  PlainBody<double> body_{};
  Phase phase_{};
  PlainState<Real> state_{};
  PlainCam<Real> cam_now_{};
};

/// Textbook Runge-Kutta; the step before provides the first stage.
template <class Real, class Cam>
class TextbookValveLoop : public PlainLoop<Real, Cam> {
 public:
  explicit TextbookValveLoop(const ValveRun& run)
      : PlainLoop<Real, Cam>{run},
        h_{static_cast<Real>(run.step_s)},
        real_body_{this->body_.template rounded<Real>()},
        per_mass_{1 / real_body_.mass_kg} {}

  void start(Phase phase) noexcept {
    PlainLoop<Real, Cam>::start(phase);
    k1_ = plain_acceleration(real_body_, per_mass_, Real{0}, Real{0}, this->cam_now_);
  }
  void step() noexcept {
    const PlainCam<Real> middle = this->cam_.at(this->phase_.units() + this->increment_ / 2, this->deg_per_s_);
    this->phase_ += Phase{this->increment_};
    const PlainCam<Real> end = this->cam_.at(this->phase_.units(), this->deg_per_s_);
    const auto f = [this](Real y, Real v, PlainCam<Real> cam) {
      return plain_acceleration(real_body_, per_mass_, y, v, cam);
    };
    this->state_ = textbook_step(f, h_, this->state_, k1_, middle, end);
    k1_ = f(this->state_.lift_m, this->state_.velocity_m_s, end);
    keep(this->state_);
  }

 private:
  Real h_;
  PlainBody<Real> real_body_;
  Real per_mass_;
  Real k1_ = 0;  ///< of the next step
};

/// One matrix per regime; the regime is that at the step's start.
template <class Real, class Cam>
class MatrixValveLoop : public PlainLoop<Real, Cam> {
 public:
  explicit MatrixValveLoop(const ValveRun& run) : PlainLoop<Real, Cam>{run} {
    for (unsigned regime = 0; regime < 4; ++regime)
      matrix_[regime] = plain_matrix<Real>(this->body_, regime, run.step_s);
    real_body_ = this->body_.template rounded<Real>();
  }

  void step() noexcept {
    this->phase_ += Phase{this->increment_};
    const PlainCam<Real> end = this->cam_.at(this->phase_.units(), this->deg_per_s_);
    const unsigned regime = plain_regime(real_body_, this->state_, this->cam_now_);
    this->state_ = matrix_[regime].step(this->state_, this->cam_now_, end);
    this->cam_now_ = end;
    keep(this->state_);
  }

 private:
  PlainBody<Real> real_body_{};
  PlainMatrix<Real> matrix_[4];
};

}  // namespace crankloop::program::bench

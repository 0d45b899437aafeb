// A valve in plain code, written from the equations for speed, which the library is compared with.
//
// What belongs here: the single mass, its textbook step and the same step as one matrix. What does not: cams and loops
// (valve_methods.hpp, baseline.inl). It includes no header of crankloop: this file is also compiled with other flags
// than the library's. Every function is inlined, so that the linker cannot mix the versions.
#pragma once

namespace crankloop::program::bench {

#define BENCH_INLINE [[gnu::always_inline]] inline

/// The equation's constants (docs/model.md "Valve").
template <class Real>
struct PlainBody {
  Real mass_kg;
  Real train_N_m, train_Ns_m;
  Real seat_N_m, seat_Ns_m;
  Real spring_N_m, guide_Ns_m, preload_N;
  Real seat_compression_m;

  template <class Other>
  [[nodiscard]] PlainBody<Other> rounded() const noexcept {
    const auto to = [](Real x) { return static_cast<Other>(x); };
    return {to(mass_kg),    to(train_N_m),  to(train_Ns_m), to(seat_N_m),          to(seat_Ns_m),
            to(spring_N_m), to(guide_Ns_m), to(preload_N),  to(seat_compression_m)};
  }
};

template <class Real>
struct PlainState {
  Real lift_m;
  Real velocity_m_s;
};

/// Theoretical lift and its speed at a moment.
template <class Real>
struct PlainCam {
  Real lift_m;
  Real speed_m_s;
};

inline constexpr unsigned kPlainTrain = 1;  ///< bits of a contact regime
inline constexpr unsigned kPlainSeat = 2;

/// A contact carries force while its gap and its force are positive.
template <class Real>
BENCH_INLINE unsigned plain_regime(const PlainBody<Real>& b, PlainState<Real> s, PlainCam<Real> cam) noexcept {
  const Real gap = cam.lift_m - s.lift_m;
  const Real sink = b.seat_compression_m - s.lift_m;
  const bool train = gap > 0 && b.train_N_m * gap + b.train_Ns_m * (cam.speed_m_s - s.velocity_m_s) > 0;
  const bool seat = sink > 0 && b.seat_N_m * sink - b.seat_Ns_m * s.velocity_m_s > 0;
  return (train ? kPlainTrain : 0u) | (seat ? kPlainSeat : 0u);
}

/// y'' with the current contacts.
template <class Real>
BENCH_INLINE Real plain_acceleration(const PlainBody<Real>& b, Real per_mass, Real y, Real v,
                                     PlainCam<Real> cam) noexcept {
  Real force_N = -b.preload_N - b.spring_N_m * y - b.guide_Ns_m * v;
  const Real gap = cam.lift_m - y;
  if (gap > 0) {
    const Real train_N = b.train_N_m * gap + b.train_Ns_m * (cam.speed_m_s - v);
    if (train_N > 0) force_N += train_N;
  }
  const Real sink = b.seat_compression_m - y;
  if (sink > 0) {
    const Real seat_N = b.seat_N_m * sink - b.seat_Ns_m * v;
    if (seat_N > 0) force_N += seat_N;
  }
  return force_N * per_mass;
}

/// Classical four-stage Runge-Kutta, the second of two in this repository (the other:
/// crankloop/valve/textbook_valve.hpp); contacts are tested in each stage. k1 is f at the start, which a caller may
/// know from the step before.
template <class Real, class Acceleration>
BENCH_INLINE PlainState<Real> textbook_step(const Acceleration& f, Real h, PlainState<Real> s, Real k1,
                                            PlainCam<Real> middle, PlainCam<Real> end) noexcept {
  const Real y = s.lift_m;
  const Real v = s.velocity_m_s;
  const Real half = h / 2;
  const Real v2 = v + half * k1;
  const Real k2 = f(y + half * v, v2, middle);
  const Real v3 = v + half * k2;
  const Real k3 = f(y + half * v2, v3, middle);
  const Real v4 = v + h * k3;
  const Real k4 = f(y + h * v3, v4, end);
  return {y + h / 6 * (v + 2 * (v2 + v3) + v4), v + h / 6 * (k1 + 2 * (k2 + k3) + k4)};
}

/// The same step in a constant regime, multiplied out: a matrix on the state, on the lift and its slope over the step
/// at both ends, and on 1. The lift in the middle is that of the cubic through the ends.
template <class Real>
struct PlainMatrix {
  Real y[7];
  Real v[7];

  BENCH_INLINE PlainState<Real> step(PlainState<Real> s, PlainCam<Real> from, PlainCam<Real> to) const noexcept {
    const auto row = [&](const Real(&m)[7]) {
      return m[0] * s.lift_m + m[1] * s.velocity_m_s + m[2] * from.lift_m + m[3] * from.speed_m_s + m[4] * to.lift_m +
             m[5] * to.speed_m_s + m[6];
    };
    return {row(y), row(v)};
  }
};

/// Column by column from the textbook step of unit vectors, then rounded to Real.
template <class Real>
[[nodiscard]] inline PlainMatrix<Real> plain_matrix(const PlainBody<double>& b, unsigned regime, double h) noexcept {
  const auto column = [&](PlainState<double> s, PlainCam<double> from, PlainCam<double> to, double constant) {
    const PlainCam<double> middle{(from.lift_m + to.lift_m) / 2 + (from.speed_m_s - to.speed_m_s) * h / 8,
                                  1.5 * (to.lift_m - from.lift_m) / h - (from.speed_m_s + to.speed_m_s) / 4};
    const auto f = [&](double y, double v, PlainCam<double> cam) {
      double force = -b.spring_N_m * y - b.guide_Ns_m * v - b.preload_N * constant;
      if ((regime & kPlainTrain) != 0) force += b.train_N_m * (cam.lift_m - y) + b.train_Ns_m * (cam.speed_m_s - v);
      if ((regime & kPlainSeat) != 0) force += b.seat_N_m * (b.seat_compression_m * constant - y) - b.seat_Ns_m * v;
      return force / b.mass_kg;
    };
    return textbook_step<double>(f, h, s, f(s.lift_m, s.velocity_m_s, from), middle, to);
  };
  PlainMatrix<Real> matrix{};
  for (int i = 0; i < 7; ++i) {
    const auto one = [i](int j) { return i == j ? 1.0 : 0.0; };
    const PlainState<double> answer = column({one(0), one(1)}, {one(2), one(3)}, {one(4), one(5)}, one(6));
    matrix.y[i] = static_cast<Real>(answer.lift_m);
    matrix.v[i] = static_cast<Real>(answer.velocity_m_s);
  }
  return matrix;
}

}  // namespace crankloop::program::bench

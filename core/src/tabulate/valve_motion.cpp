#include <crankloop/tabulate/valve_motion.hpp>

#include <cstring>

#include <crankloop/tick/one_instruction.hpp>

namespace crankloop {
namespace {

/// Fastest rate of a regime: its frequency, or beyond critical damping the faster of its two decay rates.
[[nodiscard]] double rate_per_s(double stiffness_N_m, double damping_Ns_m, double mass_kg) noexcept {
  const double frequency = square_root(stiffness_N_m / mass_kg);
  const double ratio = damping_Ns_m / (2 * mass_kg * frequency);
  return ratio <= 1 ? frequency : frequency * (ratio + square_root(ratio * ratio - 1));
}

[[nodiscard]] double fastest_rate_per_s(const ValveBody<double>& b) noexcept {
  const double both = rate_per_s(b.spring_N_m + b.train_N_m + b.seat_N_m, b.guide_Ns_m + b.train_Ns_m + b.seat_Ns_m, b.mass_kg);
  const double seat = rate_per_s(b.spring_N_m + b.seat_N_m, b.guide_Ns_m + b.seat_Ns_m, b.mass_kg);
  return both > seat ? both : seat;
}

[[nodiscard]] double open_rate_per_s(const ValveBody<double>& b) noexcept {
  return rate_per_s(b.spring_N_m + b.train_N_m, b.guide_Ns_m + b.train_Ns_m, b.mass_kg);
}

/// Rate times fine step for an accuracy class: 0.3 gives 0.1 um (docs/decisions/0007-valve-steps.md); the methods are of fourth order.
[[nodiscard]] double fine_step_rate(double accuracy_m) noexcept {
  const double rate = 0.3 * square_root(square_root(accuracy_m / 0.1e-6));
  return rate < 0.9 ? rate : 0.9;
}

/// Rate of the open valve times whole step: beyond it the cubic between its ends says too little about the motion between.
constexpr double kWholeStepRate = 1.5;
/// A valve so far above the place where its seat begins to act is off it for sure: more than a step's cubic errs.
constexpr double kClearOfSeat_m = 2e-6;
/// Cam degrees over which the lift is the quintic through a step's ends and middle, to 0.1 um.
constexpr double kWidestStepDeg = 4;

/// A rocker's inertia over the square of a lever that hardly is one may be any mass.
constexpr double kHeaviest_kg = 1e9;

/// 1, 2, 3 ... parts so that each is at most `longest`.
[[nodiscard]] int parts(double whole, double longest) noexcept {
  const double ratio = whole / longest;
  if (!(ratio < 1e6)) return 1000000;
  const int floor = static_cast<int>(ratio);
  return ratio > floor ? floor + 1 : (floor < 1 ? 1 : floor);
}

/// 2^32 / n for part_of(); a whole has no parts.
[[nodiscard]] std::uint32_t per_n_32(int n) noexcept { return n == 1 ? 0 : static_cast<std::uint32_t>(0x1p32 / n + 0.5); }

struct Steps {
  int whole;
  int fine_per_whole;
};
[[nodiscard]] Steps steps_for(const ValveBody<double>& body, double tick_s, const ValveStepping& stepping) noexcept {
  const int whole = parts(tick_s, kWholeStepRate / open_rate_per_s(body));
  return {whole, parts(tick_s / whole, fine_step_rate(stepping.accuracy_m) / fastest_rate_per_s(body))};
}

/// The matrix of a linear step: its columns are what the step adds to unit vectors. The diagonal is lowered by a rounding, so that no
/// error of the last bit makes an undamped valve's energy grow. propagate(state, lift, N of force) gives the state after.
template <class Propagate>
[[nodiscard]] StepMatrix<double> matrix_of(const Propagate& propagate, double rest_N) noexcept {
  const LiftWithin<double> level(LiftStep<double>{});
  StepMatrix<double> m{};
  const ValveState<double> by_y = propagate({1, 0}, level, 0.0);
  const ValveState<double> by_v = propagate({0, 1}, level, 0.0);
  const ValveState<double> by_force = propagate({0, 0}, level, 1.0);
  constexpr double kRounding = 0x1p-52;
  m.y.y = by_y.lift_m - 1 - kRounding, m.v.y = by_y.velocity_m_s;
  m.y.v = by_v.lift_m, m.v.v = by_v.velocity_m_s - 1 - kRounding;
  m.y.rest = rest_N * by_force.lift_m, m.v.rest = rest_N * by_force.velocity_m_s;
  m.y.gas = by_force.lift_m, m.v.gas = by_force.velocity_m_s;
  // A level lift, then the polynomials that begin at 0, one for each of their numbers.
  const ValveState<double> by_level = propagate({0, 0}, LiftWithin<double>(LiftStep<double>{1, 1, 0, 0}), 0.0);
  m.y.gap = by_level.lift_m, m.v.gap = by_level.velocity_m_s;
  m.y.y += m.y.gap, m.v.y += m.v.gap;  // lift = gap + y
  const auto one = [](int i, int j) { return i == j ? 1.0 : 0.0; };
  for (int i = 0; i < 3; ++i) {
    const ValveState<double> by_lift = propagate({0, 0}, LiftWithin<double>(LiftStep<double>{0, one(i, 0), one(i, 1), one(i, 2)}), 0.0);
    m.y.lift[i] = by_lift.lift_m;
    m.v.lift[i] = by_lift.velocity_m_s;
  }
  for (int i = 0; i < 5; ++i) {
    const LiftWithin<double> lift(LiftStep<double>{0, one(i, 0), one(i, 1), one(i, 2)}, {one(i, 3), one(i, 4)});
    const ValveState<double> by_lift = propagate({0, 0}, lift, 0.0);
    m.y.wide[i] = by_lift.lift_m;
    m.v.wide[i] = by_lift.velocity_m_s;
  }
  return m;
}

/// The exact solution to rounding, by Runge-Kutta steps so short that their error is below it: (0.3 / 64)^4 / 120 of a step.
constexpr int kExactDivisions = 64;

/// The largest float that is not above x.
[[nodiscard]] float rounded_down(double x) noexcept {
  const float nearest = static_cast<float>(x);
  if (static_cast<double>(nearest) <= x) return nearest;
  std::uint32_t bits;
  std::memcpy(&bits, &nearest, sizeof bits);
  bits = nearest > 0 ? bits - 1 : bits + 1;  // the neighbour toward minus infinity; x = 0 is itself a float
  float below;
  std::memcpy(&below, &bits, sizeof below);
  return below;
}

[[nodiscard]] float rounded_up(double x) noexcept { return -rounded_down(-x); }

/// The float next to x toward zero.
[[nodiscard]] float rounded_in(double x) noexcept { return x < 0 ? rounded_up(x) : rounded_down(x); }

/// What a step makes of y is y.y - y.gap, and v.y - v.gap of its speed. Determinant (1 + yy)(1 + vv) - yv vy, with yv > 0 > vy: rounded so
/// that it does not grow, and with it no undamped valve's energy.
[[nodiscard]] StepMatrix<float> rounded(const StepMatrix<double>& m) noexcept {
  const auto drives = [](const StepMatrix<double>::Row& r) {
    StepMatrix<float>::Row f{};
    f.rest = static_cast<float>(r.rest);
    f.gas = static_cast<float>(r.gas);
    for (int i = 0; i < 3; ++i) f.lift[i] = static_cast<float>(r.lift[i]);
    for (int i = 0; i < 5; ++i) f.wide[i] = static_cast<float>(r.wide[i]);
    return f;
  };
  StepMatrix<float> f{drives(m.y), drives(m.v)};
  f.y.y = rounded_down(m.y.y);
  f.y.gap = rounded_up(m.y.gap);
  f.y.v = rounded_in(m.y.v);
  f.v.y = rounded_up(m.v.y);
  f.v.gap = rounded_down(m.v.gap);
  f.v.v = rounded_down(m.v.v);
  return f;
}

[[nodiscard]] StepLevel<float> rounded(const StepLevel<double>& level) noexcept {
  const auto real = [](double x) { return static_cast<float>(x); };
  StepLevel<float> f{level.parts, level.per_parts_32, real(level.per_parts), real(level.step_s), real(level.per_step_s), real(level.force_lag), {}};
  for (int regime = 0; regime < 4; ++regime) f.matrix[regime] = rounded(level.matrix[regime]);
  return f;
}

}  // namespace

ValveBody<double> valve_body(const Valve& valve, double lever_m) noexcept {
  ValveBody<double> b{};
  b.rocker_mass_kg = valve.rocker_inertia_kg_m2 / (lever_m * lever_m);
  b.mass_kg = valve.valve_kg + valve.spring_kg / 3 + b.rocker_mass_kg;
  b.train_N_m = valve.train_N_m;
  b.seat_N_m = valve.seat_N_m;
  b.spring_N_m = valve.spring_N_m;
  b.train_Ns_m = 2 * valve.train_damping_ratio * square_root(b.train_N_m * b.mass_kg);
  b.guide_Ns_m = 2 * valve.guide_damping_ratio * square_root(b.train_N_m * b.mass_kg);
  b.seat_Ns_m = 2 * valve.seat_damping_ratio * square_root(b.seat_N_m * b.mass_kg);
  b.preload_N = valve.spring_preload_N;
  b.seat_sink_m = valve.spring_preload_N / valve.seat_N_m;
  b.head_area_m2 = valve.head_area_m2;
  b.per_mass = 1 / b.mass_kg;
  return b;
}

double open_frequency_rad_s(const ValveBody<double>& body) noexcept {
  return square_root((body.train_N_m + body.spring_N_m) / body.mass_kg);
}

double seated_frequency_rad_s(const ValveBody<double>& body) noexcept {
  return square_root((body.train_N_m + body.seat_N_m + body.spring_N_m) / body.mass_kg);
}

double longest_tick_s(const ValveBody<double>& body, const ValveStepping& stepping) noexcept {
  // whole * fine <= tick / fine step + tick / whole step + 1: a bound that rises with the tick, unlike the product itself.
  const double per_s = fastest_rate_per_s(body) / fine_step_rate(stepping.accuracy_m) + open_rate_per_s(body) / kWholeStepRate;
  return (kMostFineSteps - 1) / per_s;
}

ValveState<double> runge_kutta(const ValveBody<double>& body, std::uint32_t regime, double d_s, int n, ValveState<double> state,
                               const LiftWithin<double>& lift, double force_N) noexcept {
  const bool train = (regime & kTrainOn) != 0;
  const bool seat = (regime & kSeatOn) != 0;
  const auto acceleration = [&](double part, double y, double v) {
    double force = force_N - body.spring_N_m * y - body.guide_Ns_m * v;
    if (train) force += body.train_N_m * (lift.value(part) - y) + body.train_Ns_m * (lift.slope(part) / d_s - v);
    if (seat) force -= body.seat_N_m * y + body.seat_Ns_m * v;
    return force / body.mass_kg;
  };
  const double d = d_s / n;
  double y = state.lift_m;
  double v = state.velocity_m_s;
  for (int i = 0; i < n; ++i) {
    const double start = static_cast<double>(i) / n;
    const double middle = (i + 0.5) / n;
    const double end = (i + 1.0) / n;
    const double k1 = acceleration(start, y, v);
    const double k2 = acceleration(middle, y + d / 2 * v, v + d / 2 * k1);
    const double k3 = acceleration(middle, y + d / 2 * v + d * d / 4 * k1, v + d / 2 * k2);
    const double k4 = acceleration(end, y + d * v + d * d / 2 * k2, v + d * k3);
    y += d * v + d * d / 6 * (k1 + k2 + k3);
    v += d / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return {y, v};
}

Status motion_of(const ValveBody<double>& body, double tick_s, const ValveStepping& stepping, ValveMotion<double>& motion) noexcept {
  if (!(stepping.accuracy_m >= 0.01e-6 && stepping.accuracy_m <= 10e-6)) return {Reason::out_of_range, -1, "tick.accuracy"};
  if (stepping.integrator != Integrator::rk4 && stepping.integrator != Integrator::exponential) {
    return {Reason::out_of_range, -1, "tick.integrator"};  // a number that names no integrator
  }
  if (!(body.mass_kg <= kHeaviest_kg)) return {Reason::out_of_range, -1, "valve.rocker_inertia"};
  if (!(tick_s > 0 && tick_s <= longest_tick_s(body, stepping))) return {Reason::out_of_range, -1, "tick.tick"};
  const Steps steps = steps_for(body, tick_s, stepping);
  motion = {};
  motion.body = body;
  motion.short_step_deg = kWidestStepDeg;
  motion.widest_step_deg = kWidestStepDeg;
  motion.clear_m = body.seat_sink_m + kClearOfSeat_m;
  motion.rest_m = 1e-9;
  motion.rest_m_s = motion.rest_m * seated_frequency_rad_s(body);
  // A vibration of amplitude A on the seat presses with at least k_z (delta_0 - A) - b_z A w > 0 while A (1 + 2 zeta) < delta_0.
  const double seat_rate = square_root((body.seat_N_m + body.spring_N_m) / body.mass_kg);
  const double twice_ratio = body.seat_Ns_m / square_root(body.seat_N_m * body.mass_kg);
  motion.per_seat_rate_s = 1 / seat_rate;
  motion.per_seat_N_m = 1 / (body.seat_N_m + body.spring_N_m);
  motion.quiet_m = 0.8 * body.seat_sink_m / (1 + twice_ratio);
  const int divisions = stepping.integrator == Integrator::exponential ? kExactDivisions : 1;
  const auto fill = [&](StepLevel<double>& level, double above_s, int parts, int fine_steps) {
    level.parts = static_cast<std::uint32_t>(parts);
    level.per_parts_32 = per_n_32(parts);
    level.per_parts = 1.0 / parts;
    level.step_s = above_s / parts;
    level.per_step_s = 1 / level.step_s;
    level.force_lag = body.train_Ns_m / (body.train_N_m * level.step_s);
    for (std::uint32_t regime = 0; regime < 4; ++regime) {
      const auto propagate = [&](ValveState<double> state, const LiftWithin<double>& lift, double force_N) {
        return runge_kutta(body, regime, level.step_s, fine_steps * divisions, state, lift, force_N);
      };
      level.matrix[regime] = matrix_of(propagate, (regime & kSeatOn) != 0 ? 0 : -body.preload_N);  // a preloaded seat carries the preload
    }
  };
  fill(motion.whole, tick_s, steps.whole, steps.fine_per_whole);
  fill(motion.fine, motion.whole.step_s, steps.fine_per_whole, 1);
  return {};
}

ValveMotion<float> rounded(const ValveMotion<double>& m) noexcept {
  const auto real = [](double x) { return static_cast<float>(x); };
  const ValveBody<double>& b = m.body;
  ValveMotion<float> f{};
  f.body = {real(b.mass_kg),    real(b.train_N_m),  real(b.train_Ns_m), real(b.seat_N_m),     real(b.seat_Ns_m),     real(b.spring_N_m),
            real(b.guide_Ns_m), real(b.preload_N),  real(b.seat_sink_m), real(b.head_area_m2), real(b.rocker_mass_kg),
            real(b.per_mass)};
  f.whole = rounded(m.whole);
  f.fine = rounded(m.fine);
  f.short_step_deg = real(m.short_step_deg);
  f.widest_step_deg = real(m.widest_step_deg);
  f.clear_m = real(m.clear_m);
  f.rest_m = real(m.rest_m);
  f.rest_m_s = real(m.rest_m_s);
  f.quiet_m = real(m.quiet_m);
  f.per_seat_rate_s = real(m.per_seat_rate_s);
  f.per_seat_N_m = real(m.per_seat_N_m);
  return f;
}

}  // namespace crankloop

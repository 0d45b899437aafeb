#include <crankloop/assert.hpp>
#include <crankloop/tabulate/valve_motion.hpp>

#include <cstring>
#include <initializer_list>

#include <crankloop/tick/one_instruction.hpp>

#include "rounding.hpp"

namespace crankloop {

using namespace detail;
namespace {

/// Fastest rate of a regime: its natural frequency, or above critical damping the faster of its two decay rates.
[[nodiscard]] double rate_per_s(double stiffness_N_m, double damping_Ns_m, double mass_kg) noexcept {
  const double frequency = square_root(stiffness_N_m / mass_kg);
  const double ratio = damping_Ns_m / (2 * mass_kg * frequency);
  return ratio <= 1 ? frequency : frequency * (ratio + square_root(ratio * ratio - 1));
}

[[nodiscard]] double open_rate_per_s(const ValveBody<double>& b) noexcept {
  return rate_per_s(b.spring_N_m + b.train_N_m, b.guide_Ns_m + b.train_Ns_m, b.mass_kg);
}

[[nodiscard]] double fastest_rate_per_s(const ValveBody<double>& b) noexcept {
  double fastest = open_rate_per_s(b);
  for (const double rate :
       {rate_per_s(b.spring_N_m + b.train_N_m + b.seat_N_m, b.guide_Ns_m + b.train_Ns_m + b.seat_Ns_m, b.mass_kg),
        rate_per_s(b.spring_N_m + b.seat_N_m, b.guide_Ns_m + b.seat_Ns_m, b.mass_kg)}) {
    if (rate > fastest) fastest = rate;
  }
  return fastest;
}

/// Limit of fastest rate times fine step. Up to it the quintic through a step's ends locates a contact change to 0.1
/// um, in sixth order. For a finer class the step shrinks with the fourth root of the class, as the error of
/// Runge-Kutta's method requires too.
[[nodiscard]] double fine_step_rate(double accuracy_m) noexcept {
  const double ratio = square_root(square_root(accuracy_m / 0.1e-6));
  return ratio < 1 ? ratio : 1;
}
/// Limit of fastest rate times Runge-Kutta step, relative to fine_step_rate(): at 0.1 the method's error, 0.1^4 / 120
/// of an amplitude per radian, is far below the class.
constexpr double kRungeKuttaRate = 0.1;
/// Limit of the open valve's rate times tick: above it the cubic between a tick's ends does not represent the motion.
constexpr double kWholeStepRate = 1.5;
/// Limit of rate times part of an exact step: the first dropped term of its series is 0.5^21 / 21!.
constexpr double kExactRate = 0.5;
constexpr int kExactOrder = 20;

/// Limit of the mass: a rocker's inertia divided by the square of a tiny lever may be any number.
constexpr double kHeaviest_kg = 1e9;

constexpr double kOffMargin_m = 1e-8;    ///< an open contact whose distance stays above this stays open
constexpr double kTrainMargin_m = 1e-6;  ///< of a closed train contact: error of the cubic
constexpr double kNever_m = 1e30;        ///< no distance exceeds this: the guard fails in every tick
constexpr double kRest_m = 1e-9;
constexpr double kMaxCalm_m = 1e-5;       ///< a larger oscillation has results to record
constexpr double kDecoupledMargin = 0.9;  ///< for rounding

/// Number of equal parts of which none is longer than `longest`; at most 1000000.
[[nodiscard]] int parts_of(double whole, double longest) noexcept {
  CRANKLOOP_ASSERT(whole > 0 && longest > 0);
  const double ratio = whole / longest * (1 - 1e-12);  // a ratio that rounding lifted above a whole number needs no
                                                       // additional part
  if (!(ratio < 1e6)) return 1000000;
  return static_cast<int>(ratio) + 1;
}

/// 2^32 / n for part_of(); 0 for n = 1, where it is not used.
[[nodiscard]] std::uint32_t per_n_32(int n) noexcept {
  CRANKLOOP_ASSERT(n >= 1);
  return n == 1 ? 0 : static_cast<std::uint32_t>(0x1p32 / n + 0.5);
}

[[nodiscard]] bool train_is_on(std::uint32_t regime) noexcept { return (regime & kTrainOn) != 0; }
[[nodiscard]] bool seat_is_on(std::uint32_t regime) noexcept { return (regime & kSeatOn) != 0; }

/// M y'' = force + k lift + b lift' - stiffness y - damping y' in a regime.
struct Linear {
  double stiffness_N_m, damping_Ns_m, train_N_m, train_Ns_m;

  Linear(const ValveBody<double>& b, std::uint32_t regime) noexcept
      : stiffness_N_m{b.spring_N_m + (train_is_on(regime) ? b.train_N_m : 0) + (seat_is_on(regime) ? b.seat_N_m : 0)},
        damping_Ns_m{b.guide_Ns_m + (train_is_on(regime) ? b.train_Ns_m : 0) + (seat_is_on(regime) ? b.seat_Ns_m : 0)},
        train_N_m{train_is_on(regime) ? b.train_N_m : 0},
        train_Ns_m{train_is_on(regime) ? b.train_Ns_m : 0} {}
};

/// The spring's preload, unless the seat carries it.
[[nodiscard]] double rest_N(const ValveBody<double>& body, std::uint32_t regime) noexcept {
  return seat_is_on(regime) ? 0 : -body.preload_N;
}

/// Computes both rows of a step in a regime from the steps of unit vectors. Lowers the diagonal by one rounding, so
/// that no error in the last bit increases an undamped valve's energy. propagate(state, drive) returns the state after
/// the step.
template <class Propagate>
void fill_rows(const Propagate& propagate, double rest_N, RegimeStep<double>& step) noexcept {
  using State = ValveState<double>;
  constexpr double kRounding = 0x1p-52;
  const State by_lift = propagate(State{1, 0}, StepDrive{});
  const State by_velocity = propagate(State{0, 1}, StepDrive{});
  const State by_level = propagate(State{0, 0}, StepDrive{1, 0, 0, 0, 0, 0});
  const State by_rise = propagate(State{0, 0}, StepDrive{0, 1, 0, 0, 0, 0});
  const State by_from = propagate(State{0, 0}, StepDrive{0, 0, 1, 0, 0, 0});
  const State by_to = propagate(State{0, 0}, StepDrive{0, 0, 0, 1, 0, 0});
  const State by_force = propagate(State{0, 0}, StepDrive{0, 0, 0, 0, 1, 0});
  const State by_force_rise = propagate(State{0, 0}, StepDrive{0, 0, 0, 0, 0, 1});
  const auto row = [&](double State::*of, double lift, double velocity) {
    return StepRow<double>{
        rest_N * by_force.*of, -(by_force.*of), -(by_force_rise.*of), by_level.*of, by_rise.*of,
        by_from.*of,           by_to.*of,       lift + by_level.*of,  velocity};  // the cam's level = gap + y
  };
  step.lift = row(&State::lift_m, by_lift.lift_m - 1 - kRounding, by_velocity.lift_m);
  step.velocity = row(&State::velocity_m_s, by_lift.velocity_m_s, by_velocity.velocity_m_s - 1 - kRounding);
}

[[nodiscard]] ForceRow<double> force_row(const ValveBody<double>& b, std::uint32_t regime) noexcept {
  const double seat_N_m = seat_is_on(regime) ? b.seat_N_m : 0;
  const double seat_Ns_m = seat_is_on(regime) ? b.seat_Ns_m : 0;
  return {rest_N(b, regime) * b.per_mass,
          -b.per_mass,
          -(b.spring_N_m + seat_N_m) * b.per_mass,
          -(b.guide_Ns_m + seat_Ns_m) * b.per_mass,
          train_is_on(regime) ? b.train_N_m * b.per_mass : 0,
          train_is_on(regime) ? b.train_Ns_m * b.per_mass : 0};
}

/// With time as the fraction of a fine step of h seconds.
[[nodiscard]] RegimeSeries<double> series_of(const ValveBody<double>& b, std::uint32_t regime, double h) noexcept {
  const Linear l(b, regime);
  const double per = h * h / b.mass_kg;
  return {rest_N(b, regime) * per, -per, l.stiffness_N_m * per, l.damping_Ns_m * per / h, l.train_N_m * per,
          l.train_Ns_m * per / h};
}

/// The next float toward minus infinity if `down`, else toward plus infinity.
[[nodiscard]] float neighbour(float x, bool down) noexcept {
  if (x == 0) return down ? -0x1p-149F : 0x1p-149F;
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  bits += (x > 0) == down ? ~std::uint32_t{0} : 1;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

/// Limits the determinant (1 + yy)(1 + vv) - yv vy of a step's matrix on (y, v), yy and vy without the gap's share, to
/// 1: if rounding raised it, an undamped valve's energy would grow.
void never_grow(RegimeStep<float>& step) noexcept {
  for (;;) {
    const double yy = 1 + static_cast<double>(step.lift.lift) - static_cast<double>(step.lift.gap);
    const double vy = static_cast<double>(step.velocity.lift) - static_cast<double>(step.velocity.gap);
    const double vv = 1 + static_cast<double>(step.velocity.velocity);
    const double above = yy * vv - static_cast<double>(step.lift.velocity) * vy - 1;
    if (above <= 0) return;
    const bool by_velocity = magnitude(yy) > magnitude(vv);
    float& term = by_velocity ? step.velocity.velocity : step.lift.lift;
    const double slope = by_velocity ? yy : vv;
    // At once to where the determinant would be 1, which is thousands of millions of floats away where the term is next
    // to 0; by one float at least.
    const bool down = slope > 0;
    const float next = neighbour(term, down), there = static_cast<float>(static_cast<double>(term) - above / slope);
    term = (down ? there < next : there > next) ? there : next;
  }
}

}  // namespace

double longest_tick_s(const ValveBody<double>& body, const ValveStepping& stepping) noexcept {
  return kMaxFineSteps * fine_step_rate(stepping.accuracy_m) / fastest_rate_per_s(body);
}

ValveState<double> runge_kutta(const ValveBody<double>& body, std::uint32_t regime, double d_s, int n,
                               ValveState<double> state, const StepDrive& drive) noexcept {
  const Linear l(body, regime);
  const auto acceleration = [&](double part, double y, double v) {
    const StepDrive::Piece lift = drive.about(part);
    const double force_N =
        drive.force_N + drive.force_rise_N * part + l.train_N_m * lift.c[0] + l.train_Ns_m * lift.c[1] / d_s;
    return (force_N - l.stiffness_N_m * y - l.damping_Ns_m * v) / body.mass_kg;
  };
  CRANKLOOP_ASSERT(regime < kQuiet && n >= 1 && d_s > 0);
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

ValveState<double> exact_motion(const ValveBody<double>& body, std::uint32_t regime, double d_s,
                                ValveState<double> state, const StepDrive& drive) noexcept {
  const Linear l(body, regime);
  CRANKLOOP_ASSERT(regime < kQuiet);
  const int n = parts_of(d_s, kExactRate / fastest_rate_per_s(body));
  const double w = 1.0 / n;
  const double h = d_s * w;
  const double per_force = h * h / body.mass_kg;
  for (int i = 0; i < n; ++i) {
    // Lift and force as polynomials in the fraction of this part.
    const double x = i * w;
    StepDrive::Piece lift = drive.about(x);
    double scale = 1;
    for (double& c : lift.c) c *= scale, scale *= w;
    const double force[] = {drive.force_N + drive.force_rise_N * x, drive.force_rise_N * w};
    double y[kExactOrder + 1] = {state.lift_m, state.velocity_m_s * h};
    double sum = y[0] + y[1];
    double slope = y[1];
    for (int k = 0; k + 2 <= kExactOrder; ++k) {
      double push_N = k < 2 ? force[k] : 0;
      if (k < 5) push_N += l.train_N_m * lift.c[k];
      if (k < 4) push_N += l.train_Ns_m / h * (k + 1) * lift.c[k + 1];
      const double pull_N = l.stiffness_N_m * y[k] + l.damping_Ns_m / h * (k + 1) * y[k + 1];
      y[k + 2] = (push_N - pull_N) * per_force / ((k + 1) * (k + 2));
      sum += y[k + 2];
      slope += (k + 2) * y[k + 2];
    }
    state = {sum, slope / h};
  }
  return state;
}

Status validate(const ValveStepping& stepping) noexcept {
  if (!(stepping.accuracy_m >= 0.01e-6 && stepping.accuracy_m <= 10e-6))
    return refuse("options.valves.accuracy_m", Reason::out_of_range);
  if (!(stepping.event_budget >= 0 && stepping.event_budget <= kMaxEventBudget))
    return refuse("options.valves.event_budget", Reason::out_of_range);
  if (stepping.integrator != Integrator::rk4 && stepping.integrator != Integrator::exponential)
    return refuse("options.valves.integrator", Reason::out_of_range);  // an undefined integrator
  return {};
}

Status motion_of(const ValveBody<double>& body, double tick_s, const ValveStepping& stepping,
                 ValveMotion<double>& motion) noexcept {
  if (const Status refused = validate(stepping); !refused.ok()) return refused;
  if (!(body.mass_kg <= kHeaviest_kg)) return refuse("valve.rocker_inertia_kg_m2", Reason::out_of_range);
  if (!(tick_s > 0 && tick_s <= longest_tick_s(body, stepping))) return refuse("options.tick_s", Reason::out_of_range);
  const double fastest = fastest_rate_per_s(body);
  const double fine_rate = fine_step_rate(stepping.accuracy_m);
  const int parts = parts_of(tick_s, fine_rate / fastest);
  motion = {};
  motion.body = body;
  motion.tick_s = tick_s;
  motion.fine_step_s = tick_s / parts;
  motion.per_fine_step_s = 1 / motion.fine_step_s;
  motion.per_parts = 1.0 / parts;
  motion.parts = static_cast<std::uint32_t>(parts);
  motion.per_parts_32 = per_n_32(parts);
  motion.event_budget = usual_event_budget(parts, 1);
  motion.cubic_deg = motion.widest_step_deg = kDegreesPerTurn;
  motion.train_lag_s = body.train_Ns_m / body.train_N_m;
  motion.seat_lag_s = body.seat_Ns_m / body.seat_N_m;
  motion.per_seat_N_m = 1 / (body.seat_N_m + body.spring_N_m);
  // An oscillation of amplitude A on the seat keeps a force of at least k_z (delta_0 - A) - b_z A w, positive for A (1
  // + 2 zeta) < delta_0.
  motion.quiet_m = 0.8 * body.seat_compression_m / (1 + body.seat_Ns_m / square_root(body.seat_N_m * body.mass_kg));
  motion.per_seat_rate_s = 1 / square_root((body.seat_N_m + body.spring_N_m) / body.mass_kg);

  const auto propagator = [&](std::uint32_t contacts, double step_s) {
    const int n = parts_of(step_s, fine_rate * kRungeKuttaRate / fastest);
    return [&body, &stepping, contacts, step_s, n](ValveState<double> state, const StepDrive& drive) {
      if (stepping.integrator == Integrator::exponential) return exact_motion(body, contacts, step_s, state, drive);
      return runge_kutta(body, contacts, step_s, n, state, drive);
    };
  };
  const auto regime_step = [&](std::uint32_t contacts, double step_s) {
    RegimeStep<double> step{};
    fill_rows(propagator(contacts, step_s), rest_N(body, contacts), step);
    step.acceleration = force_row(body, contacts);
    const double third_s = step_s / 3;
    step.train = {-1, third_s, kOffMargin_m};
    step.seat = {1, third_s, kOffMargin_m + body.seat_compression_m};
    if (train_is_on(contacts)) step.train = {1, motion.train_lag_s + third_s, kTrainMargin_m};
    if (seat_is_on(contacts)) step.seat = {-1, motion.seat_lag_s + third_s, -body.seat_compression_m};
    if (train_is_on(contacts)) {
      const ValveState<double> by_middle = propagator(contacts, step_s)({0, 0}, StepDrive{0, 0, 0, 0, 0, 0, 1});
      step.middle = {by_middle.lift_m, by_middle.velocity_m_s};
    }
    return step;
  };
  const auto may_rest = [&](RegimeStep<double>& step) {
    step.rest_m = kRest_m;
    step.rest_m_s = kRest_m * seated_frequency_rad_s(body);
  };
  for (std::uint32_t regime = 0; regime < 4; ++regime) {
    motion.fine[regime] = regime_step(regime, motion.fine_step_s);
    motion.series[regime] = series_of(body, regime, motion.fine_step_s);
  }
  may_rest(motion.fine[kSeatOn]);
  motion.fine[kQuiet] = motion.fine[kSeatOn];
  for (std::uint32_t regime = 0; regime < 4; ++regime) {
    motion.whole[regime] = parts == 1 ? motion.fine[regime] : regime_step(regime, tick_s);
    // With a vibration on seat or train faster than the tick, the ends of the tick say nothing about the path between.
    const bool may_pass = !seat_is_on(regime) && (regime == 0 || tick_s * open_rate_per_s(body) <= kWholeStepRate);
    if (parts > 1 && !may_pass) motion.whole[regime].seat.least_m = kNever_m;
  }
  RegimeStep<double>& quiet = motion.whole[kQuiet];
  quiet = regime_step(kSeatOn, tick_s);
  quiet.train.least_m = 2 * motion.quiet_m;
  quiet.seat = {-1, 0, -motion.quiet_m};
  may_rest(quiet);
  return {};
}

void find_decoupled(ValveMotion<double>& motion, double lash_m) noexcept {
  const double per_s = 1 / motion.per_seat_rate_s;
  for (const std::uint32_t regime : {kSeatOn, kQuiet}) {
    RegimeStep<double>& step = motion.whole[regime];
    // An oscillation of amplitude A is never further from rest than A, nor faster than A times its rate.
    const auto most = [per_s](const ContactGuard<double>& guard, double depth_m) {
      return (depth_m - guard.least_m) / (1 + guard.lag_s * per_s);
    };
    double decoupled_m = motion.quiet_m / 2;  // gas force moves the rest position too
    for (const double limit_m : {most(step.train, lash_m), most(step.seat, 0), kMaxCalm_m}) {
      if (limit_m < decoupled_m) decoupled_m = limit_m;
    }
    step.decoupled_m = decoupled_m > 0 ? kDecoupledMargin * decoupled_m : 0;
  }
}

ValveMotion<float> rounded(const ValveMotion<double>& m) noexcept {
  ValveMotion<float> f{};
  detail::round_into(m, f);
  for (RegimeStep<float>& step : f.whole) never_grow(step);
  for (RegimeStep<float>& step : f.fine) never_grow(step);
  return f;
}

}  // namespace crankloop

#include <crankloop/tabulate/valve_springs.hpp>

#include <crankloop/assert.hpp>
#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop {

using namespace detail;
namespace {

constexpr int kMostStates = 3 + 2 * kMaxValveModes;

/// A square matrix of the states that a tick changes.
struct Matrix {
  int size;
  double at[kMostStates][kMostStates];
};

/// Valve and modes at a tick's end, with what the tick remembers of the valve's acceleration.
struct Together {
  double lift_m, velocity_m_s, mean_m_s2;
  double q_m[kMaxValveModes], q_m_s[kMaxValveModes];
};

/// A tick of valve and modes in one regime, its cam and preload at 0: as tick/valve/spring_step.hpp.
template <class Real>
[[nodiscard]] Together ticked(const RegimeStep<Real>& regime, const ValveSprings<Real>& springs, double per_tick_s,
                              const Together& from) noexcept {
  const auto more = [](const ModeRow<Real>& row, double q, double v, double mean_m_s2) {
    return static_cast<double>(row.q) * q + static_cast<double>(row.v) * v + static_cast<double>(row.drive) * mean_m_s2;
  };
  const int modes = static_cast<int>(springs.modes);
  double from_N = 0, to_N = 0;
  for (int n = 0; n < modes; ++n) {
    const ModeStep<Real>& mode = springs.mode[n];
    const auto per_m = static_cast<double>(mode.valve_N_m);
    from_N += per_m * from.q_m[n];
    to_N += per_m * (from.q_m[n] + more(mode.of_q, from.q_m[n], from.q_m_s[n], from.mean_m_s2));
  }
  const auto of_valve = [&](const StepRow<Real>& row) {
    return static_cast<double>(row.gas) * from_N + static_cast<double>(row.gas_rise) * (to_N - from_N) +
           (static_cast<double>(row.lift) - static_cast<double>(row.gap)) * from.lift_m +
           static_cast<double>(row.velocity) * from.velocity_m_s;
  };
  Together to{};
  to.lift_m = from.lift_m + of_valve(regime.lift);
  to.velocity_m_s = from.velocity_m_s + of_valve(regime.velocity);
  to.mean_m_s2 = (to.velocity_m_s - from.velocity_m_s) * per_tick_s;
  for (int n = 0; n < modes; ++n) {
    const ModeStep<Real>& mode = springs.mode[n];
    to.q_m[n] = from.q_m[n] + more(mode.of_q, from.q_m[n], from.q_m_s[n], to.mean_m_s2);
    to.q_m_s[n] = from.q_m_s[n] + more(mode.of_v, from.q_m[n], from.q_m_s[n], to.mean_m_s2);
  }
  return to;
}

/// The states as numbers of one size, so that squares of the matrix lose nothing: lengths, and speeds over a tick.
template <class AState, class Visit>
void each_state(AState& s, int modes, double tick_s, const Visit& visit) noexcept {
  visit(s.lift_m, 1.0), visit(s.velocity_m_s, tick_s), visit(s.mean_m_s2, tick_s * tick_s);
  for (int n = 0; n < modes; ++n) visit(s.q_m[n], 1.0), visit(s.q_m_s[n], tick_s);
}

template <class Real>
[[nodiscard]] Matrix matrix_of(const RegimeStep<Real>& regime, const ValveSprings<Real>& springs,
                               double tick_s) noexcept {
  const int modes = static_cast<int>(springs.modes);
  Matrix m{3 + 2 * modes, {}};
  for (int column = 0; column < m.size; ++column) {
    Together unit{};
    int i = 0;
    each_state(unit, modes, tick_s, [&](double& x, double scale) { x = i++ == column ? 1 / scale : 0; });
    const Together to = ticked(regime, springs, 1 / tick_s, unit);
    int row = 0;
    each_state(to, modes, tick_s, [&](double x, double scale) { m.at[row++][column] = x * scale; });
  }
  return m;
}

[[nodiscard]] Matrix squared(const Matrix& m) noexcept {
  Matrix s{m.size, {}};
  for (int i = 0; i < m.size; ++i)
    for (int k = 0; k < m.size; ++k)
      for (int j = 0; j < m.size; ++j) s.at[i][j] += m.at[i][k] * m.at[k][j];
  return s;
}

/// Takes a matrix's largest entry out of it; its logarithm.
[[nodiscard]] double normalised(Matrix& m) noexcept {
  double largest = 0;
  for (int i = 0; i < m.size; ++i)
    for (int j = 0; j < m.size; ++j)
      if (magnitude(m.at[i][j]) > largest) largest = magnitude(m.at[i][j]);
  if (!(largest > 0)) return 0;
  for (int i = 0; i < m.size; ++i)
    for (int j = 0; j < m.size; ++j) m.at[i][j] /= largest;
  return elementary::log(largest);
}

/// ln of the spectral radius: of a power 2^40, whose largest entry is that of the fastest growth.
[[nodiscard]] double log_radius(Matrix m) noexcept {
  constexpr int kSquares = 40;
  double log = 0;
  for (int i = 0; i < kSquares; ++i) log = 2 * (log + normalised(m)), m = squared(m);
  log += normalised(m);
  for (int i = 0; i < kSquares; ++i) log /= 2;
  return log;
}

}  // namespace

int springs_of(const Valve& valve, SurgingSpring (&springs)[2]) noexcept {
  const double outer_kg = valve.spring_active_kg > 0 ? valve.spring_active_kg : valve.spring_kg - valve.inner_spring_kg;
  springs[0] = {valve.spring_N_m - valve.inner_spring_N_m, outer_kg, valve.surge_damping_ratio, valve.surge_modes};
  springs[1] = {valve.inner_spring_N_m, valve.inner_spring_kg, valve.surge_damping_ratio, valve.surge_modes};
  return valve.inner_spring_N_m > 0 ? 2 : 1;
}

Status surge_of(const Valve& valve, double tick_s, SurgeOfValve& surge) noexcept {
  SurgeOfValve all;
  SurgingSpring springs[2];
  const int count = valve.surge_modes > 0 ? springs_of(valve, springs) : 0;
  for (int i = 0; i < count; ++i) {
    SpringSurge one;
    if (!surge_of(springs[i], tick_s, one).ok()) return refuse("valve.surge_modes", Reason::unstable);
    for (int n = 0; n < one.modes; ++n) {
      all.springs.mode[all.springs.modes++] = one.mode[n].step;
      if (one.mode[n].rate_rad_s > all.highest_rad_s) all.highest_rad_s = one.mode[n].rate_rad_s;
    }
    all.moving_kg += one.moving_kg;
  }
  surge = all;
  return {};
}

ValveBody<double> beside_modes(ValveBody<double> body, const SurgeOfValve& surge) noexcept {
  CRANKLOOP_ASSERT(surge.moving_kg < body.mass_kg);
  body.mass_kg -= surge.moving_kg;
  body.per_mass = 1 / body.mass_kg;
  return body;
}

template <class Real>
double surge_growth(const ValveMotion<Real>& motion, const ValveSprings<Real>& springs) noexcept {
  if (springs.modes == 0) return 0;
  double largest = 0;
  for (const RegimeStep<Real>& regime : motion.whole) {
    const double log = log_radius(matrix_of(regime, springs, static_cast<double>(motion.tick_s)));
    if (log > largest) largest = log;
  }
  return largest;
}
template double surge_growth(const ValveMotion<float>&, const ValveSprings<float>&) noexcept;
template double surge_growth(const ValveMotion<double>&, const ValveSprings<double>&) noexcept;

double surge_error_ratio(const SurgeOfValve& surge, double tick_s) noexcept {
  const double turned = surge.highest_rad_s * tick_s;
  return turned * turned / 4;
}

}  // namespace crankloop

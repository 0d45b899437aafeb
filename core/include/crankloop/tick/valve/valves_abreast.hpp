// The plain step of several valves at once, one in each lane.
//
// What belongs here: what lanes need side by side, and their step. What does not: the arithmetic of a step (valve.hpp),
// lanes whose guards fail (valve_changes.hpp), which valves an engine has (elastic_valves.hpp).
//
// A resting valve is zeros under its regime's constants: it stays at rest, and needs no exception.
#pragma once

#include <cstddef>
#include <initializer_list>

#include <crankloop/tick/valve/cam_ticks.hpp>
#include <crankloop/tick/valve/valves_work.hpp>
#include <crankloop/tick/valve/lanes.hpp>
#include <crankloop/tick/valve/valve.hpp>

#if CRANKLOOP_ABREAST
namespace crankloop::detail {

/// A number of each lane, read where it is used: a regime's would not all find a register.
template <class Lanes, bool Aligned>
struct InMemory {
  const float* at;

  [[gnu::always_inline]] operator Lanes() const noexcept { return Aligned ? load_aligned<Lanes>(at) : load<Lanes>(at); }
  friend Lanes operator*(const InMemory& a, const Lanes& b) noexcept { return Lanes(a) * b; }
  friend Lanes operator+(const InMemory& a, const Lanes& b) noexcept { return Lanes(a) + b; }
  friend auto operator>(const Lanes& a, const InMemory& b) noexcept { return a > Lanes(b); }
  friend auto operator<(const Lanes& a, const InMemory& b) noexcept { return a < Lanes(b); }
};

/// The regimes of a block of lanes.
template <class Lanes, class Work>
[[nodiscard, gnu::always_inline]] inline auto regimes_at(const Work& w, std::size_t first) noexcept {
  using Held = InMemory<Lanes, Work::kBlocksAligned>;
  int number = 0;
  const auto next = [&] { return Held{&w.regime[number++][first]}; };
  RegimeStep<Held> r;
  for (StepRow<Held>* row : {&r.lift, &r.velocity}) {
    row->rest = next(), row->gas = next(), row->gas_rise = next(), row->gap = next(), row->rise = next();
    row->from = next(), row->to = next(), row->lift = next(), row->velocity = next();
  }
  ForceRow<Held>& a = r.acceleration;
  a.rest = next(), a.gas = next(), a.lift = next(), a.velocity = next(), a.gap = next(), a.gap_speed = next();
  for (ContactGuard<Held>* guard : {&r.train, &r.seat})
    guard->sign = next(), guard->lag_s = next(), guard->least_m = next();
  r.rest_m = next(), r.rest_m_s = next();
  return r;
}

/// A lane is in this regime from now on.
template <class Work>
inline void set_lane(Work& w, std::size_t lane, const RegimeStep<float>& regime) noexcept {
  float numbers[sizeof w.regime / sizeof w.regime[0]];
  static_assert(sizeof numbers == offsetof(RegimeStep<float>, calm_m));
  std::memcpy(numbers, &regime, sizeof numbers);
  for (std::size_t i = 0; i < sizeof numbers / sizeof(float); ++i) w.regime[i][lane] = numbers[i];
}

/// What a lane has of its cam.
template <class Work>
inline void set_cam_of_lane(Work& w, std::size_t lane, const LiftCurve<float>& curve, std::uint32_t opens) noexcept {
  const Cell cell = LiftCurve<float>::cell(std::uint64_t{opens} << 32);
  w.curve[lane] = curve.at;
  w.degrees[lane] = static_cast<std::int32_t>(curve.segments);
  w.opens_degree[lane] = static_cast<std::int32_t>(cell.degree);
  w.opens_into[lane] = cell.into;
}

/// How the lanes' cams turn in a tick: all alike, or each by itself where phasers turn them.
template <class S>
struct LanesTick {
  static constexpr std::size_t kRoom = S::cam_phasing ? AbreastWork<S>::kRoom : 1;
  float deg[kRoom], deg_per_s[kRoom];
  std::uint32_t degree[kRoom], into[kRoom];  ///< where the train's cams stand, as AbreastWork has the lobes' beginnings

  void set(std::size_t lane, const CamTick<float>& tick) noexcept {
    const std::size_t i = S::cam_phasing ? lane : 0;
    const Cell cell = LiftCurve<float>::cell(tick.phase);
    deg[i] = tick.cam.deg, deg_per_s[i] = tick.cam.deg_per_s;
    degree[i] = cell.degree, into[i] = cell.into;
  }
  template <class Lanes>
  [[nodiscard, gnu::always_inline]] static Lanes of(const float (&x)[kRoom], std::size_t first) noexcept {
    if constexpr (S::cam_phasing) return load<Lanes>(x + first);
    (void)first;
    return Lanes{} + x[0];
  }
  template <class Lanes>
  [[nodiscard, gnu::always_inline]] static typename Words<Lanes>::Bits words(const std::uint32_t (&x)[kRoom],
                                                                             std::size_t first) noexcept {
    if constexpr (S::cam_phasing) return load_words<Lanes>(x + first);
    (void)first;
    return typename Words<Lanes>::Bits{} + x[0];
  }
};

/// The lift of each lane's cam: bit for bit that of LiftCurve::read at LiftCurve::cell. Its angle is the cams' less
/// that of the lobe's beginning, so its place among the degrees is too, but for a borrow and for a turn.
template <class Lanes, class S>
[[nodiscard, gnu::always_inline]] inline Lift<Lanes> read_lanes(const AbreastWork<S>& w, std::size_t first,
                                                                const LanesTick<S>& tick) noexcept {
  using Words32 = typename Words<Lanes>::Bits;
  using Signed = decltype(Lanes{} < Lanes{});
  const auto load_signed = [first](const std::int32_t* from) {
    Signed x;
    std::memcpy(&x, from + first, sizeof x);
    return x;
  };
  const Words32 cams_into = tick.template words<Lanes>(tick.into, first);
  const Words32 opens_into = load_words<Lanes>(&w.opens_into[first]);
  const Words32 into = cams_into - opens_into;
  Signed degree = reinterpret_cast<Signed>(tick.template words<Lanes>(tick.degree, first)) -
                  load_signed(w.opens_degree) + reinterpret_cast<Signed>(cams_into < opens_into);
  degree += (degree < 0) & kDegreesPerTurn;
  const Signed last = load_signed(w.degrees);
  degree = degree < last ? degree : last;
  std::uint32_t segment[kLanesOf<Lanes>];
  std::memcpy(segment, &degree, sizeof segment);
  const float* from[kLanesOf<Lanes>];
  for (int i = 0; i < kLanesOf<Lanes>; ++i) from[i] = w.curve[first + static_cast<std::size_t>(i)][segment[i]].c;
  Lanes c[6];
  load_lanes(from, c);
  const Lanes u = __builtin_convertvector(reinterpret_cast<Signed>(into >> 8), Lanes) * 0x1p-24F;
  Lanes slope = c[5];
  Lanes value = c[4] + u * slope;
  for (int i = 3; i >= 0; --i) {  // as LiftCurve::read
    slope = value + u * slope;
    value = c[i] + u * value;
  }
  return {value, slope};
}

/// The plain step of a block of lanes. State and output are left as if all were sure; answers a bit for each that is
/// not. `look`: some lane is looked at whatever its guards say.
template <class Lanes, class S, class Work, class State, class Before>
[[nodiscard, gnu::always_inline]] inline std::uint32_t step_block(Work& w, State& state, std::size_t first,
                                                                  const LanesTick<S>& tick, bool look, Before& before,
                                                                  float* shown) noexcept {
  const auto regime = regimes_at<Lanes>(w, first);
  const ValveState<Lanes> start{load<Lanes>(&state.valve_lift_m[first]), load<Lanes>(&state.valve_velocity_m_s[first])};
  const Lift<Lanes> from{load<Lanes>(&w.cam_lift_m[first]), load<Lanes>(&w.cam_per_deg_m[first])};
  const Lanes deg_per_s = tick.template of<Lanes>(tick.deg_per_s, first);
  const Lift<Lanes> to = read_lanes<Lanes>(w, first, tick);
  const Stepped<Lanes> step =
      stepped(regime, start, from, to, tick.template of<Lanes>(tick.deg, first), NoGasForce<Lanes>{});
  const Lanes gap = to.lift_m - step.state.lift_m;
  const Lanes gap_speed = deg_per_s * to.per_deg_m - step.state.velocity_m_s;
  const auto sure =
      holds(regime.train, gap, gap_speed) & holds(regime.seat, step.state.lift_m, step.state.velocity_m_s);
  const auto still =
      (magnitude(step.state.lift_m) < regime.rest_m) & (magnitude(step.state.velocity_m_s) < regime.rest_m_s);
  const ValveState<Lanes> end{still ? Lanes{} : step.state.lift_m, still ? Lanes{} : step.state.velocity_m_s};
  const Lanes accelerates = acceleration(regime.acceleration, end, to.lift_m - end.lift_m,
                                         deg_per_s * to.per_deg_m - end.velocity_m_s, NoGasForce<Lanes>{});
  store<Lanes>(&state.valve_lift_m[first], end.lift_m);
  store<Lanes>(&state.valve_velocity_m_s[first], end.velocity_m_s);
  store<Lanes>(&w.cam_lift_m[first], to.lift_m);
  store<Lanes>(&w.cam_per_deg_m[first], to.per_deg_m);
  store_lanes(to.lift_m > Lanes{} ? to.lift_m : Lanes{}, end.lift_m, end.velocity_m_s, accelerates, shown);
  const std::uint32_t doubtful = failing(sure);
  if (!look && doubtful == 0) return 0;
  store<Lanes>(&before.lift_m[first], start.lift_m);
  store<Lanes>(&before.velocity_m_s[first], start.velocity_m_s);
  store<Lanes>(&before.rise_m[first], step.rise_m);
  store<Lanes>(&before.cam_lift_m[first], from.lift_m);
  store<Lanes>(&before.cam_per_deg_m[first], from.per_deg_m);
  return doubtful;
}

/// Blocks of this width from lane `first` on, as far as they fill `lanes` of them; `done` so far. `far`: lanes that are
/// looked at in any case.
template <class Lanes, class S, class Work, class State, class Before, class Bits>
[[nodiscard, gnu::always_inline]] inline Bits step_blocks(Work& w, State& state, const LanesTick<S>& tick,
                                                          std::uint32_t first, std::uint32_t lanes, Bits far,
                                                          Before& before, float* shown, std::uint32_t& done) noexcept {
  constexpr auto kWidth = static_cast<std::uint32_t>(kLanesOf<Lanes>);
  Bits doubtful = 0;
  for (; done + kWidth <= lanes; done += kWidth) {
    const std::uint32_t at = first + done;
    const bool look = (far >> at & ((1u << kWidth) - 1)) != 0;
    doubtful |= Bits{step_block<Lanes>(w, state, at, tick, look, before, shown + 4 * at)} << at;
  }
  return doubtful;
}

}  // namespace crankloop::detail
#endif

// Access to each elastic valve in a tick: its tables, its state, where its cam stood, its output, its record, its lane.
//
// What belongs here: where things lie, and which valves are active. What does not: what is done with valves
// (plain_steps.hpp, event_location.hpp), and when (elastic_valves.hpp).
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/assert.hpp>
#include <crankloop/output.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/head_pressure.hpp>
#include <crankloop/tick/valve/cam_ticks.hpp>
#include <crankloop/tick/valve/event_location.hpp>
#include <crankloop/tick/valve/valve_lanes.hpp>
#include <crankloop/tick/valve/valves_work.hpp>

namespace crankloop::detail {

/// A valve's cam, train and acceleration at a tick's end.
template <class Real>
struct Moment {
  Real cam_lift_m, compression_m, compression_speed_m_s, acceleration_m_s2;
};

template <class Real, class S>
[[gnu::always_inline]] inline void write_motion(ValveMotionOutput<Real, S>& shown, const ValveState<Real>& s,
                                                const Moment<Real>& at) noexcept {
  if constexpr (S::theoretical_lift) shown.theoretical_lift_m = at.cam_lift_m > 0 ? at.cam_lift_m : Real{0};
  shown.lift_m = s.lift_m;
  shown.velocity_m_s = s.velocity_m_s;
  if constexpr (S::valve_acceleration) shown.acceleration_m_s2 = at.acceleration_m_s2;
}

template <class Real>
[[nodiscard, gnu::always_inline]] inline Real seat_force_N(const ValveBody<Real>& b,
                                                           const ValveState<Real>& s) noexcept {
  return b.preload_N - (b.seat_N_m * s.lift_m + b.seat_Ns_m * s.velocity_m_s);
}

template <class Real>
[[gnu::always_inline]] inline void write_forces(ValveForcesOutput<Real>& shown, const ValveBody<Real>& b,
                                                const LiftCurve<Real>& curve, const ValveInRegime<Real>& valve,
                                                const Cell& cell, const Moment<Real>& at) noexcept {
  const std::uint32_t contacts = contacts_of(valve.regime);
  shown.train_N = train_force_N(b, contacts, at.compression_m, at.compression_speed_m_s);
  const Real seat_N = seat_force_N(b, valve.state);
  shown.seat_N = (contacts & kSeatOn) != 0 && seat_N > 0 ? seat_N : Real{0};
  shown.tip_N = shown.train_N - b.rocker_mass_kg * at.acceleration_m_s2;
  shown.cam_N = shown.train_N > 0 ? shown.train_N * curve.rocker_ratio_at(cell) : Real{0};
  shown.train_compression_m = at.compression_m;
  shown.regime = contacts;
}

/// The same of a valve on its seat without its train.
template <class Real>
[[gnu::always_inline]] inline void write_seat_forces(ValveForcesOutput<Real>& shown, const ValveBody<Real>& b,
                                                     const ValveState<Real>& s, const Moment<Real>& at) noexcept {
  const Real seat_N = seat_force_N(b, s);
  shown = {Real{0},
           seat_N > 0 ? seat_N : Real{0},
           Real{0} - b.rocker_mass_kg * at.acceleration_m_s2,
           Real{0},
           at.compression_m,
           kSeatOn};
}

/// How springs that surge push each valve in the tick, beyond preload and rate, and how fast it starts.
template <class Real, class S>
struct SpringPush {
  static constexpr std::size_t kLanes = group::ValvesState<Real, S>::kLanes;
  Real from_N[kLanes], to_N[kLanes], started_m_s[kLanes];
};

/// Valves are numbered train by train: v = train times the scene's cylinders + cylinder.
template <class Real, class S>
struct ValveAccess : If<Needs<S>::surge, SpringPush<Real, S>> {
  using Gas = std::conditional_t<Needs<S>::valve_push, GasForce<Real>, NoGasForce<Real>>;
  using Record = std::conditional_t<S::valve_results, ValveRecord<Real>, NoRecord<Real>>;
  using Locator = EventLocator<Real, Gas, Record>;
  using Bits = ValveBits<S>;
  static constexpr bool kInLanes = CRANKLOOP_ABREAST != 0 && kLaneLayout<Real, S>;
  static constexpr bool kActiveFirst = kInLanes && !Needs<S>::valve_push;
  static constexpr bool kKeepsGas = Needs<S>::valve_gas_held && !Needs<S>::surge;  ///< after a valve's own step
  static constexpr std::uint32_t kPerTrain = S::cylinders.capacity;
  static constexpr std::uint32_t kMaxValves = S::trains.capacity * kPerTrain;

  const Tables<Real, S>& tables;
  State<Real, S>& state;
  ValvesWork<Real, S>& work;
  Output<Real, S>& out;
  const Real* pressure_Pa;     ///< of each cylinder, where the scene has valve_gas; none at the start
  bool wide = false;           ///< the cams turn so far in this tick that the lift in its middle counts,
  bool beyond_guards = false;  ///< or even beyond some guards' range
  NoRecord<Real> no_record{};

  /// For a call of a function of its own: made anew there, so that those of the tick can stay in registers. Not with
  /// springs' pushes, which are many numbers; nor with a word of 64 bits for valves, of whose place in calls GCC warns.
  using Apart = std::conditional_t<Needs<S>::surge || sizeof(Bits) == 8, ValveAccess&, ValveAccess>;
  [[nodiscard, gnu::always_inline]] Apart apart() noexcept {
    if constexpr (std::is_reference_v<Apart>) {
      return *this;
    } else {
      return {{}, tables, state, work, out, pressure_Pa, wide, beyond_guards};
    }
  }

  [[nodiscard]] static constexpr std::uint32_t train(std::uint32_t v) noexcept { return v / kPerTrain; }
  [[nodiscard]] static constexpr std::uint32_t cylinder(std::uint32_t v) noexcept { return v % kPerTrain; }
  /// The lane of a valve, in all arrays by lane.
  [[nodiscard]] std::uint32_t lane_of(std::uint32_t v) const noexcept {
    if constexpr (kActiveFirst) return work.lane[v];
    return v;
  }
  [[nodiscard]] std::uint32_t valve_in(std::size_t lane) const noexcept {
    if constexpr (kActiveFirst) return work.valve[lane];
    return static_cast<std::uint32_t>(lane);
  }
  /// Calls for the valve of each of some lanes, if it is active: others only fill a block, and stay at rest in it.
  template <class Call>
  void for_active(Bits lanes, const Call& call) const noexcept {
    for (Bits left = lanes; left != 0; left &= left - 1) {
      const std::uint32_t lane = trailing_zeros(left);
      if constexpr (kActiveFirst) {
        if (lane >= work.active_lanes) return;
      }
      call(valve_in(lane));
    }
  }
  /// Lanes' bits as bits of the valves in them.
  [[nodiscard]] Bits valves_in(Bits lanes) const noexcept {
    if constexpr (!kActiveFirst) return lanes;
    Bits valves = 0;
    for (Bits left = lanes; left != 0; left &= left - 1) valves |= Bits{1} << valve_in(trailing_zeros(left));
    return valves;
  }
  [[nodiscard]] const ValveMotion<Real>& motion(std::uint32_t v) const noexcept {
    return tables.valve_motions[train(v)];
  }
  [[nodiscard]] const LiftCurve<Real>& curve(std::uint32_t v) const noexcept { return *work.curve[lane_of(v)]; }
  /// Where a valve's cam stands.
  [[nodiscard]] Cell cell(std::uint32_t v, std::uint64_t phase) const noexcept {
    return curve(v).cell(phase, cylinder(v));
  }
  [[nodiscard]] std::uint32_t trains() const noexcept {
    return S::trains.exact ? S::trains.capacity : tables.drive->trains;
  }
  [[nodiscard]] std::uint32_t cam_groups() const noexcept { return S::cam_phasing ? trains() : 1; }

  /// Valves of all trains.
  template <class Call>
  void for_each(const Call& call) const noexcept {
    for (std::uint32_t t = 0; t < trains(); ++t) {
      for (std::uint32_t k = 0; k < count<S>(tables.drive->cylinders); ++k) call(t * kPerTrain + k);
    }
  }
  /// Bits of those whose cams turn alike.
  [[nodiscard]] static constexpr Bits of_group(std::uint32_t group) noexcept {
    return S::cam_phasing ? ((Bits{1} << kPerTrain) - 1) << group * kPerTrain : ~Bits{0};
  }

  [[nodiscard]] Lift<Real> cam(std::uint32_t v) const noexcept {
    return {work.cam_lift_m[lane_of(v)], work.cam_per_deg_m[lane_of(v)]};
  }
  void set_cam(std::uint32_t v, const Lift<Real>& lift) noexcept {
    work.cam_lift_m[lane_of(v)] = lift.lift_m, work.cam_per_deg_m[lane_of(v)] = lift.per_deg_m;
  }
  /// Adds what the lift in the middle of a wide tick contributes. By values: else the steps of all ticks would go
  /// through memory.
  [[nodiscard, gnu::noinline]] Stepped<Real> with_middle_of_tick(std::uint32_t v, const CamTick<Real>& tick,
                                                                 Stepped<Real> step, Lift<Real> to) const noexcept {
    const Real middle_m = curve(v).read(cell(v, tick.phase_in_middle())).lift_m;
    return with_middle(step, regime_of(v).middle, cam(v), middle_m, to, tick.cam.deg);
  }
  [[nodiscard]] ValveState<Real> state_of(std::uint32_t v) const noexcept {
    return {state.valve_lift_m[v], state.valve_velocity_m_s[v]};
  }
  void set_state(std::uint32_t v, const ValveState<Real>& s) noexcept {
    state.valve_lift_m[v] = s.lift_m, state.valve_velocity_m_s[v] = s.velocity_m_s;
    if constexpr (kActiveFirst) work.lift_m[lane_of(v)] = s.lift_m, work.velocity_m_s[lane_of(v)] = s.velocity_m_s;
  }
  void set_regime(std::uint32_t v, std::uint32_t regime) noexcept {
    CRANKLOOP_ASSERT(v < kMaxValves && regime < std::uint32_t{kRegimes});
    state.valve_regime[v] = regime;
    const RegimeStep<Real>& step = motion(v).whole[regime];
    work.regime[lane_of(v)] = &step;
#if CRANKLOOP_ABREAST
    if constexpr (kInLanes) set_lane(work, lane_of(v), step);
#endif
    load_record(v);
  }
  /// Loads what its lane needs of a valve's record.
  void load_record([[maybe_unused]] std::uint32_t v) noexcept {
    if constexpr (kInLanes && S::valve_results) {
      const detail::ValveRecord<Real>& record = state.record[train(v)][cylinder(v)];
      const auto maxima = record.maxima();
      const std::uint32_t lane = lane_of(v);
      work.max_lift_m[lane] = maxima.lift_m, work.max_speed_m_s[lane] = maxima.speed_m_s;
      work.max_acceleration_m_s2[lane] = maxima.acceleration_m_s2;
      work.only_maxima_below_m[lane] = record.only_maxima_below_m(contacts_of(state.valve_regime[v]));
    }
  }
  /// Stores a lane's maxima in its valve's record.
  void store_maxima(std::uint32_t v) noexcept {
    const std::uint32_t lane = lane_of(v);
    state.record[train(v)][cylinder(v)].set_maxima(
        {work.max_lift_m[lane], work.max_speed_m_s[lane], work.max_acceleration_m_s2[lane]});
  }
  [[nodiscard]] const RegimeStep<Real>& regime_of(std::uint32_t v) const noexcept { return *work.regime[lane_of(v)]; }

  /// The pressure behind the head.
  [[nodiscard]] Real behind_head_Pa([[maybe_unused]] std::uint32_t v) const noexcept {
    if constexpr (Needs<S>::gas) {
      return port_pressure_Pa(tables, state, train(v), cylinder(v));
    } else {
      return tables.body->crankcase_Pa;
    }
  }
  [[nodiscard]] Real gas_now_N(std::uint32_t v) const noexcept {
    if constexpr (S::valve_gas) {
      if (pressure_Pa != nullptr) return (pressure_Pa[cylinder(v)] - behind_head_Pa(v)) * motion(v).body.head_area_m2;
    }
    (void)v;
    return Real{0};
  }
  /// Of the gas alone.
  [[nodiscard]] Real gas_before_N(std::uint32_t v) const noexcept {
    if constexpr (Needs<S>::valve_gas_held) return state.valve_gas_N[v];
    if constexpr (Needs<S>::gas && S::valve_gas)
      return (state.cylinder_gas.pressure_Pa[cylinder(v)] - behind_head_Pa(v)) * motion(v).body.head_area_m2;
    (void)v;
    return Real{0};
  }
  /// Of the gas, and of springs that surge: these push as gas does.
  [[nodiscard]] Gas gas_on(std::uint32_t v) const noexcept {
    if constexpr (Needs<S>::surge) {
      return {gas_before_N(v) + this->from_N[v], gas_now_N(v) + this->to_N[v]};
    } else if constexpr (S::valve_gas) {
      return {gas_before_N(v), gas_now_N(v)};
    }
    (void)v;
    return {};
  }

  /// `Seated`: without its train.
  template <bool Seated = false>
  [[gnu::always_inline]] void write_output(std::uint32_t v, const ValveState<Real>& end, const Cell& cell,
                                           const Moment<Real>& at, const Gas& gas) noexcept {
    if constexpr (kKeepsGas) state.valve_gas_N[v] = gas.to_N;
    write_motion((&out.valve[0][0])[v], end, at);
    if constexpr (S::valve_forces && Seated)
      write_seat_forces((&out.valve_forces[0][0])[v], motion(v).body, end, at);
    else if constexpr (S::valve_forces)
      write_forces((&out.valve_forces[0][0])[v], motion(v).body, curve(v), {end, state.valve_regime[v]}, cell, at);
    (void)cell, (void)gas;
  }

  /// Records a plain step in the valve's cycle.
  [[gnu::always_inline]] void record(std::uint32_t v, const ValveState<Real>& start, const ValveState<Real>& end,
                                     const Lift<Real>& from, const Lift<Real>& to, const CamTick<Real>& tick,
                                     const Gas& gas, Real acceleration_m_s2) noexcept {
    const Real from_m_s = tick.cam.deg_per_s * from.per_deg_m;
    const Real started_m_s2 = acceleration(regime_of(v).acceleration, start, from.lift_m - start.lift_m,
                                           from_m_s - start.velocity_m_s, gas.before());
    address(&state.record[train(v)][cylinder(v)])
        ->step({start, end, from.lift_m, to.lift_m, from_m_s, tick.cam.deg_per_s * to.per_deg_m, started_m_s2,
                acceleration_m_s2, motion(v).tick_s, contacts_of(state.valve_regime[v])},
               motion(v).body.seat_compression_m, [this, v, &tick](Real part) {
                 return deg_in(curve(v), cylinder(v), tick.phase_before(), tick.cam.deg, part);
               });
  }
  /// Cam degrees since the start of its lobe, after a part of the tick.
  [[nodiscard, gnu::cold, gnu::noinline]] static Real deg_in(const LiftCurve<Real>& curve, std::uint32_t cylinder,
                                                             std::uint64_t phase_before, Real tick_deg,
                                                             Real part) noexcept {
    return curve.degrees(phase_before - curve.opens[cylinder]) + part * tick_deg;
  }

  [[nodiscard]] Locator event_locator(std::uint32_t v, EventBudget& budget) noexcept {
    if constexpr (S::valve_results) {
      return Locator(motion(v), curve(v), budget, state.record[train(v)][cylinder(v)]);
    } else {
      return Locator(motion(v), curve(v), budget, no_record);
    }
  }
  [[nodiscard]] Span<Real, Gas> span(std::uint32_t v, const CamTick<Real>& tick, const Lift<Real>& from,
                                     const Lift<Real>& to, const Gas& gas) const noexcept {
    return {from, to, tick.cam, gas, tick.phase_before() - curve(v).opens[cylinder(v)], Real{0}};
  }
};

// ---- lanes: active valves have the first ones, so that blocks hold no others -------------------------------------

/// Gives a valve a lane and loads what it needs there from tables and state, except its cam's lift.
template <class Real, class S>
[[gnu::cold]] void place(ValveAccess<Real, S>& valves, std::uint32_t v, std::uint32_t lane) noexcept {
  const LiftCurve<Real>& curve = valves.tables.lift_curves[valves.train(v)];
  valves.work.curve[lane] = &curve;
#if CRANKLOOP_ABREAST
  if constexpr (ValveAccess<Real, S>::kInLanes) {
    CRANKLOOP_ASSERT(lane < kLaneRoom<S>);
    if constexpr (!Needs<S>::valve_push) valves.work.valve[lane] = v, valves.work.lane[v] = lane;
    set_cam_of_lane(valves.work, lane, curve, valves.cylinder(v)),
        set_body_of_lane(valves.work, lane, valves.motion(v));
  }
#endif
  valves.set_regime(v, valves.state.valve_regime[v]);
  valves.set_state(v, valves.state_of(v));
}

template <class Real, class S>
[[gnu::cold]] void place_all(ValveAccess<Real, S>& valves) noexcept {
  std::uint32_t next = 0;
  valves.for_each([&](std::uint32_t v) { place(valves, v, ValveAccess<Real, S>::kActiveFirst ? next++ : v); });
}

/// Exchanges the valves of two lanes.
template <class Real, class S>
[[gnu::noinline]] void swap_lanes(ValveAccess<Real, S>& valves, std::uint32_t a, std::uint32_t b) noexcept {
  if (a == b) return;
  const std::uint32_t in_a = valves.valve_in(a), in_b = valves.valve_in(b);
  const Lift<Real> cam_a = valves.cam(in_a), cam_b = valves.cam(in_b);
  place(valves, in_a, b), place(valves, in_b, a);
  valves.set_cam(in_a, cam_a), valves.set_cam(in_b, cam_b);
}

/// A valve takes part from now on.
template <class Real, class S>
void activate(ValveAccess<Real, S>& valves, std::uint32_t v) noexcept {
  CRANKLOOP_ASSERT((valves.work.active >> v & 1) == 0);
  valves.work.active |= ValveBits<S>{1} << v;
  if constexpr (ValveAccess<Real, S>::kActiveFirst) swap_lanes(valves, valves.lane_of(v), valves.work.active_lanes++);
}

/// Valves at rest whose cams are away take part no longer.
template <class Real, class S>
void deactivate(ValveAccess<Real, S>& valves, ValveBits<S> which) noexcept {
  CRANKLOOP_ASSERT((valves.work.active & which) == which);
  valves.work.active &= ~which;
  if constexpr (ValveAccess<Real, S>::kActiveFirst) {
    for (ValveBits<S> left = which; left != 0; left &= left - 1)
      swap_lanes(valves, valves.lane_of(trailing_zeros(left)), --valves.work.active_lanes);
  }
}

}  // namespace crankloop::detail

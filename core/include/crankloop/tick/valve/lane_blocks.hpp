// The plain step of an engine's valves in blocks of lanes.
//
// What belongs here: a block's step, its forces, which of its lanes need more than that. What does not: what lanes have
// side by side (valve_lanes.hpp), the arithmetic of a step (valve.hpp), lanes whose guards fail (event_location.hpp),
// which valves an engine has (elastic_valves.hpp).
//
// A valve at rest is all zeros under its regime's constants: it stays at rest without an exception.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#include <crankloop/assert.hpp>
#include <crankloop/tick/valve/valve_access.hpp>
#include <crankloop/tick/valve/valve_lanes.hpp>

#if CRANKLOOP_ABREAST
namespace crankloop::detail {

/// `Wide`: the lift in the tick's middle counts. Its own class, for it needs registers that the other uses.
template <class S, bool Wide>
class LaneBlocks : If<Needs<S>::valve_push && !kGasInBlocks<S>, GasOfLanes<S>>, If<Wide, MiddleOfLanes<S>> {
  using Valves = ValveAccess<float, S>;
  using Bits = typename Valves::Bits;

 public:
  using Before = BeforeStep<float, group::ValvesState<float, S>::kLanes>;

  /// `beyond_guards`: lanes whose guards do not count.
  LaneBlocks(Valves& valves, const CamTicks<float, S>& cams, Bits beyond_guards, Before& before) noexcept
      : valves_{valves},
        work_{valves.work},
        state_{valves.state},
        out_{valves.out},
        before_{before},
        beyond_guards_{beyond_guards} {
    if constexpr (S::cam_phasing) {
      for (std::uint32_t lane = 0; lane < valves_.trains() * Valves::kPerTrain; ++lane)
        set_tick(lane, cams[Valves::train(valves_.valve_in(lane))]);
    } else {
      set_tick(0, cams[0]);
    }
    if constexpr (Needs<S>::valve_push && !kGasInBlocks<S>) {
      valves_.for_each([&](std::uint32_t v) {
        const GasForce<float> gas = valves_.gas_on(v);
        this->from_N[v] = gas.from_N, this->to_N[v] = gas.to_N;
      });
    }
  }

  /// Steps blocks from lane `first` on, of which `lanes` are active. A block that is worth it includes inactive lanes,
  /// as far as there is `room`. Returns how many lanes it has stepped. State and output are as if all guards passed.
  [[nodiscard, gnu::always_inline]] std::uint32_t step(std::uint32_t first, std::uint32_t lanes,
                                                       std::uint32_t room) noexcept {
    std::uint32_t done = 0;
    step_as<WidestLanes>(first, lanes, room, done);
    if constexpr (!std::is_same_v<WidestLanes, Four>) step_as<Four>(first, lanes, room, done);
    return done;
  }

  /// Bits of lanes whose guards fail,
  [[nodiscard]] Bits failed() const noexcept { return failed_; }
  /// of lanes whose record needs more of the step than its maxima,
  [[nodiscard]] Bits to_record() const noexcept { return to_record_; }
  /// of lanes that raised a maximum,
  [[nodiscard]] Bits raised() const noexcept { return raised_; }
  /// and of lanes at rest, where valves come to rest.
  [[nodiscard]] Bits at_rest() const noexcept { return at_rest_; }

 private:
  void set_tick(std::uint32_t lane, const CamTick<float>& tick) noexcept {
    tick_.set(lane, tick);
    if constexpr (Wide) this->middle.set(lane, {tick.phase_in_middle(), tick.turned, tick.cam});
  }

  template <class Lanes>
  [[gnu::always_inline]] void step_as(std::uint32_t first, std::uint32_t lanes, std::uint32_t room,
                                      std::uint32_t& done) noexcept {
    constexpr auto kWidth = static_cast<std::uint32_t>(kLanesOf<Lanes>);
    constexpr std::uint32_t kWorth = kWidth == 8 ? 6 : 2;  // active lanes that are worth a block
    for (; done + kWorth <= lanes && done + kWidth <= room; done += kWidth) step_block<Lanes>(first + done);
  }

  /// A number of each lane.
  template <class Lanes>
  [[nodiscard, gnu::always_inline]] static Lanes held(const float* from) noexcept {
    return VectorLanes<S>::kBlocksAligned ? load_aligned<Lanes>(from) : load<Lanes>(from);
  }

  template <class Lanes>
  [[nodiscard, gnu::always_inline]] ValveState<Lanes> states_at(std::uint32_t first) const noexcept {
    if constexpr (Valves::kActiveFirst)
      return {held<Lanes>(&work_.lift_m[first]), held<Lanes>(&work_.velocity_m_s[first])};
    else
      return {load<Lanes>(&state_.valve_lift_m[first]), load<Lanes>(&state_.valve_velocity_m_s[first])};
  }
  template <class Lanes>
  [[gnu::always_inline]] void keep_states(std::uint32_t first, const ValvesOf<Lanes>& valves,
                                          const ValveState<Lanes>& s) noexcept {
    if constexpr (Valves::kActiveFirst) {
      store<Lanes>(&work_.lift_m[first], s.lift_m), store<Lanes>(&work_.velocity_m_s[first], s.velocity_m_s);
      valves.store(s.lift_m, state_.valve_lift_m), valves.store(s.velocity_m_s, state_.valve_velocity_m_s);
    } else {
      store<Lanes>(&state_.valve_lift_m[first], s.lift_m);
      store<Lanes>(&state_.valve_velocity_m_s[first], s.velocity_m_s);
      static_cast<void>(valves);
    }
  }

  template <class Lanes>
  [[nodiscard, gnu::always_inline]] auto gas_at(std::uint32_t first) const noexcept {
    if constexpr (kGasInBlocks<S>) {
      const Lanes pressure_Pa = load<Lanes>(valves_.pressure_Pa + first % Valves::kPerTrain);
      return GasForce<Lanes>{load<Lanes>(&state_.valve_gas_N[first]),
                             (pressure_Pa - valves_.behind_head_Pa(first)) * load<Lanes>(&work_.head_area_m2[first])};
    } else if constexpr (Needs<S>::valve_push) {
      return GasForce<Lanes>{load<Lanes>(this->from_N + first), load<Lanes>(this->to_N + first)};
    } else {
      return static_cast<void>(first), NoGasForce<Lanes>{};
    }
  }
  template <class Lanes, class Gas>
  [[nodiscard, gnu::always_inline]] Lanes resting_m(const Gas& gas, std::uint32_t first) const noexcept {
    if constexpr (Needs<S>::valve_push) return gas.resting_m(load<Lanes>(&work_.per_seat_N_m[first]));
    return static_cast<void>(gas), static_cast<void>(first), Lanes{};
  }

  template <class Lanes>
  [[gnu::always_inline]] void step_block(std::uint32_t first) noexcept {
    CRANKLOOP_ASSERT(first + kLanesOf<Lanes> <= kLaneRoom<S>);
    const auto regime = regimes_at<Lanes>(work_, first);
    const auto gas = gas_at<Lanes>(first);
    const ValvesOf<Lanes> valves(valves_, first);
    const ValveState<Lanes> start = states_at<Lanes>(first);
    const Lift<Lanes> from{held<Lanes>(&work_.cam_lift_m[first]), held<Lanes>(&work_.cam_per_deg_m[first])};
    const Lanes deg_per_s = tick_.template of<Lanes>(tick_.deg_per_s, first);
    LanesPlace<Lanes> place;
    const Lift<Lanes> to = read_lanes<Lanes>(work_, first, tick_, place);
    const Lanes deg = tick_.template of<Lanes>(tick_.deg, first);
    Stepped<Lanes> step = stepped(regime, start, from, to, deg, gas);
    if constexpr (Wide) {
      LanesPlace<Lanes> there;
      const Lanes middle_m = read_lanes<Lanes>(work_, first, this->middle, there).lift_m;
      step = with_middle(step, regime.middle, from, middle_m, to, deg);
    }
    const Contacting<Lanes> stepped_to{to.lift_m - step.state.lift_m,
                                       deg_per_s * to.per_deg_m - step.state.velocity_m_s};
    const auto pass = passes(regime.train, stepped_to.compression_m, stepped_to.compression_speed_m_s) &
                      passes(regime.seat, step.state.lift_m, step.state.velocity_m_s);
    const Lanes rest = resting_m<Lanes>(gas, first);
    const auto at_rest =
        (magnitude(step.state.lift_m - rest) < regime.rest_m) & (magnitude(step.state.velocity_m_s) < regime.rest_m_s);
    const ValveState<Lanes> end{at_rest ? rest : step.state.lift_m, at_rest ? Lanes{} : step.state.velocity_m_s};
    const Contacting<Lanes> at{to.lift_m - end.lift_m, deg_per_s * to.per_deg_m - end.velocity_m_s};
    const Lanes accelerates = acceleration(regime.acceleration, end, at.compression_m, at.compression_speed_m_s, gas);
    keep_states(first, valves, end);
    store<Lanes>(&work_.cam_lift_m[first], to.lift_m);
    store<Lanes>(&work_.cam_per_deg_m[first], to.per_deg_m);
    const Lanes theory = larger(to.lift_m, Lanes{});
    write_motion(valves, end, theory, accelerates);
    if constexpr (S::valve_forces) write_forces(first, valves, end, at, accelerates, place);
    if constexpr (Valves::kActiveFirst) at_rest_ |= Bits{holding(at_rest)} << first;
    std::uint32_t failed = failing(pass);
    if (beyond_guards_ != 0)
      failed |= static_cast<std::uint32_t>(beyond_guards_ >> first) & ((1u << kLanesOf<Lanes>)-1);
    std::uint32_t unfinished = failed;
    if constexpr (S::valve_results) {
      const Lanes from_m_s = deg_per_s * from.per_deg_m;
      const Lanes began = acceleration(regime.acceleration, start, from.lift_m - start.lift_m,
                                       from_m_s - start.velocity_m_s, gas.before());
      const auto closing = (from_m_s > Lanes{}) & (deg_per_s * to.per_deg_m <= Lanes{});
      const auto peaks = (start.velocity_m_s > Lanes{}) & (end.velocity_m_s < Lanes{});
      const auto lifted = larger(theory, end.lift_m) >= load<Lanes>(&work_.only_maxima_below_m[first]);
      const auto raised = raise(&work_.max_lift_m[first], larger(start.lift_m, end.lift_m)) |
                          raise(&work_.max_speed_m_s[first], magnitude(end.velocity_m_s)) |
                          raise(&work_.max_acceleration_m_s2[first], larger(magnitude(began), magnitude(accelerates)));
      // The start of a decoupled valve's step does not count: record() sees to that.
      const std::uint32_t to_record = holding(closing | peaks | lifted | (raised & outside_lobe<Lanes>(first, place)));
      to_record_ |= Bits{to_record} << first;
      raised_ |= Bits{holding(raised)} << first;
      unfinished |= to_record;
    }
    if constexpr (Valves::kKeepsGas) keep_gas(first, gas.to_N, unfinished);
    if (unfinished == 0) return;
    failed_ |= Bits{failed} << first;
    store<Lanes>(&before_.of[first], start.lift_m);
    store<Lanes>(&before_.of[Before::kVelocity + first], start.velocity_m_s);
    store<Lanes>(&before_.of[Before::kIncrement + first], step.increment_m);
    store<Lanes>(&before_.of[Before::kCamLift + first], from.lift_m);
    store<Lanes>(&before_.of[Before::kCamPerDeg + first], from.per_deg_m);
  }

  template <class Lanes>
  [[nodiscard, gnu::always_inline]] auto outside_lobe(std::uint32_t first,
                                                      const LanesPlace<Lanes>& place) const noexcept {
    BitsOf<Lanes> degrees;
    std::memcpy(&degrees, &work_.degrees[first], sizeof degrees);
    return load_words<Lanes>(place.segment) == degrees;
  }
  /// Compression of the train, and its speed.
  template <class Lanes>
  struct Contacting {
    Lanes compression_m, compression_speed_m_s;
  };

  /// The gas force at the start of the next tick. Lanes that are `unfinished` still need that of this one.
  template <class Lanes>
  [[gnu::always_inline]] void keep_gas(std::uint32_t first, const Lanes& force_N, std::uint32_t unfinished) noexcept {
    float* const held = &state_.valve_gas_N[first];
    if (unfinished == 0) {
      store<Lanes>(held, force_N);
      return;
    }
    for (std::uint32_t i = 0; i < kLanesOf<Lanes>; ++i) {
      if ((unfinished >> i & 1) == 0) held[i] = force_N[i];
    }
  }

  /// As write_motion() of one valve.
  template <class Lanes>
  [[gnu::always_inline]] void write_motion(const ValvesOf<Lanes>& valves, const ValveState<Lanes>& end,
                                           [[maybe_unused]] const Lanes& theory,
                                           [[maybe_unused]] const Lanes& accelerates) noexcept {
    ValveMotionOutput<float, S>* const shown = &out_.valve[0][0];
    constexpr std::size_t kFloats = 2 + (S::theoretical_lift ? 1 : 0) + (S::valve_acceleration ? 1 : 0);
    static_assert(sizeof *shown == kFloats * sizeof(float));
    if constexpr (kFloats == 4) {
      store_lanes(theory, end.lift_m, end.velocity_m_s, accelerates,
                  RowsOf<4, Lanes>(valves, &shown->theoretical_lift_m).at);
    } else {
      store_lanes(end.lift_m, end.velocity_m_s, RowsOf<kFloats, Lanes>(valves, &shown->lift_m).at);
      for (int i = 0; i < kLanesOf<Lanes>; ++i) {
        if constexpr (S::theoretical_lift) shown[valves.valve[i]].theoretical_lift_m = theory[i];
        if constexpr (S::valve_acceleration) shown[valves.valve[i]].acceleration_m_s2 = accelerates[i];
      }
    }
  }

  /// As write_forces() of one valve.
  template <class Lanes>
  [[gnu::always_inline]] void write_forces(std::uint32_t first, const ValvesOf<Lanes>& valves,
                                           const ValveState<Lanes>& end, const Contacting<Lanes>& at,
                                           const Lanes& accelerates, const LanesPlace<Lanes>& place) noexcept {
    using Words32 = BitsOf<Lanes>;
    Words32 regime;
    for (std::uint32_t i = 0; i < kLanesOf<Lanes>; ++i) regime[i] = state_.valve_regime[valves.valve[i]];
    const auto pushing = [](auto on, const Lanes& force_N) { return (on & (force_N > Lanes{})) ? force_N : Lanes{}; };
    const Lanes train_N =
        pushing((regime & kTrainOn) != 0, load<Lanes>(&work_.train_N_m[first]) * at.compression_m +
                                              load<Lanes>(&work_.train_Ns_m[first]) * at.compression_speed_m_s);
    const Lanes seat_N =
        pushing((regime & (kSeatOn | kQuiet)) != 0,
                load<Lanes>(&work_.preload_N[first]) - (load<Lanes>(&work_.seat_N_m[first]) * end.lift_m +
                                                        load<Lanes>(&work_.seat_Ns_m[first]) * end.velocity_m_s));
    const Lanes tip_N = train_N - load<Lanes>(&work_.rocker_mass_kg[first]) * accelerates;
    Lanes cam_N{};
    for (std::uint32_t left = holding(train_N > Lanes{}); left != 0; left &= left - 1) {
      const std::uint32_t i = trailing_zeros(left);
      const LiftCurve<float>& curve = valves_.curve(static_cast<std::uint32_t>(valves.valve[i]));
      cam_N[i] = train_N[i] * value(curve.rocker_ratio[place.segment[i]], static_cast<float>(place.u[i]));
    }
    const Words32 contacts = (regime & (kTrainOn | kSeatOn)) | (regime >> 1 & kSeatOn);  // kQuiet is on its seat
    static_assert(sizeof out_.valve_forces[0][0] == 6 * sizeof(float));
    store_lanes({train_N, seat_N, tip_N, cam_N, at.compression_m, reinterpret_cast<Lanes>(contacts)},
                RowsOf<6, Lanes>(valves, &out_.valve_forces[0][0].train_N).at);
  }

  Valves& valves_;
  ValvesWorkOf<float, S>& work_;
  State<float, S>& state_;
  Output<float, S>& out_;
  Before& before_;
  Bits beyond_guards_;
  LanesTick<S> tick_;
  Bits failed_ = 0;
  Bits to_record_ = 0, raised_ = 0, at_rest_ = 0;
};

}  // namespace crankloop::detail
#endif

// The plain step of an engine's valves in blocks of lanes.
//
// What belongs here: a block's step, what it shows of forces, which of its lanes ask for more. What does not: what
// lanes have side by side (valves_abreast.hpp), the arithmetic of a step (valve.hpp), lanes whose guards fail
// (valve_changes.hpp), which valves an engine has (elastic_valves.hpp).
//
// A resting valve is zeros under its regime's constants: it stays at rest, and needs no exception.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#include <crankloop/assert.hpp>
#include <crankloop/tick/valve/lane_records.hpp>
#include <crankloop/tick/valve/valves_at_hand.hpp>

#if CRANKLOOP_ABREAST
namespace crankloop::detail {

/// `Wide`: the lift in the tick's middle counts. A class of its own, for it needs registers that the other uses.
template <class S, bool Wide>
class LaneBlocks : If<S::valve_gas && !kGasInBlocks<S>, GasOfLanes<S>>, If<Wide, MiddleOfLanes<S>> {
  using Valves = ValvesAtHand<float, S>;
  using Bits = typename Valves::Bits;

 public:
  using Before = BeforeStep<float, group::ValvesState<float, S>::kLanes>;

  /// `far`: lanes that are looked at whatever their guards say.
  LaneBlocks(Valves& valves, const CamTicks<float, S>& cams, Bits far, Before& before) noexcept
      : valves_{valves}, work_{valves.work}, state_{valves.state}, out_{valves.out}, before_{before}, far_{far} {
    if constexpr (S::cam_phasing) {
      for (std::uint32_t lane = 0; lane < valves_.trains() * Valves::kPerTrain; ++lane)
        set_tick(lane, cams[Valves::train(valves_.valve_in(lane))]);
    } else {
      set_tick(0, cams[0]);
    }
    if constexpr (S::valve_gas && !kGasInBlocks<S>) {
      valves_.for_each([&](std::uint32_t v) {
        const GasForce<float> gas = valves_.gas_on(v);
        this->from_N[v] = gas.from_N, this->to_N[v] = gas.to_N;
      });
    }
  }

  /// Steps blocks from lane `first` on, for `lanes` that move; a block that is worth it takes lanes at rest in, of
  /// which there are so many that all have `room`. Answers how many lanes it has stepped. State and output are left as
  /// if all were sure.
  [[nodiscard, gnu::always_inline]] std::uint32_t step(std::uint32_t first, std::uint32_t lanes,
                                                       std::uint32_t room) noexcept {
    std::uint32_t done = 0;
    step_as<WidestLanes>(first, lanes, room, done);
    if constexpr (!std::is_same_v<WidestLanes, Four>) step_as<Four>(first, lanes, room, done);
    return done;
  }

  /// A bit for each lane stepped whose guards fail.
  [[nodiscard]] Bits doubtful() const noexcept { return doubtful_; }
  /// One for each whose record may have more of the step than its largest values,
  [[nodiscard]] Bits eventful() const noexcept { return eventful_; }
  /// and one for each that enlarged some of those.
  [[nodiscard]] Bits enlarged() const noexcept { return enlarged_; }
  /// A bit for each that is at rest, where such are left alone.
  [[nodiscard]] Bits still() const noexcept { return still_; }

 private:
  void set_tick(std::uint32_t lane, const CamTick<float>& tick) noexcept {
    tick_.set(lane, tick);
    if constexpr (Wide) this->middle.set(lane, {tick.phase_in_middle(), tick.turned, tick.cam});
  }

  template <class Lanes>
  [[gnu::always_inline]] void step_as(std::uint32_t first, std::uint32_t lanes, std::uint32_t room,
                                      std::uint32_t& done) noexcept {
    constexpr auto kWidth = static_cast<std::uint32_t>(kLanesOf<Lanes>);
    constexpr std::uint32_t kWorth = kWidth == 8 ? 6 : 2;  // movers: fewer take longer abreast than in other ways
    for (; done + kWorth <= lanes && done + kWidth <= room; done += kWidth) step_block<Lanes>(first + done);
  }

  /// Of the lanes' own numbers.
  template <class Lanes>
  [[nodiscard, gnu::always_inline]] static Lanes held(const float* from) noexcept {
    return AbreastWork<S>::kBlocksAligned ? load_aligned<Lanes>(from) : load<Lanes>(from);
  }

  template <class Lanes>
  [[nodiscard, gnu::always_inline]] ValveState<Lanes> states_at(std::uint32_t first) const noexcept {
    if constexpr (Valves::kMoversFirst)
      return {held<Lanes>(&work_.lift_m[first]), held<Lanes>(&work_.velocity_m_s[first])};
    else
      return {load<Lanes>(&state_.valve_lift_m[first]), load<Lanes>(&state_.valve_velocity_m_s[first])};
  }
  template <class Lanes>
  [[gnu::always_inline]] void keep_states(std::uint32_t first, const ValvesOf<Lanes>& valves,
                                          const ValveState<Lanes>& s) noexcept {
    if constexpr (Valves::kMoversFirst) {
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
    } else if constexpr (S::valve_gas) {
      return GasForce<Lanes>{load<Lanes>(this->from_N + first), load<Lanes>(this->to_N + first)};
    } else {
      return static_cast<void>(first), NoGasForce<Lanes>{};
    }
  }
  template <class Lanes, class Gas>
  [[nodiscard, gnu::always_inline]] Lanes resting_m(const Gas& gas, std::uint32_t first) const noexcept {
    if constexpr (S::valve_gas) return gas.resting_m(load<Lanes>(&work_.per_seat_N_m[first]));
    return static_cast<void>(gas), static_cast<void>(first), Lanes{};
  }

  template <class Lanes>
  [[gnu::always_inline]] void step_block(std::uint32_t first) noexcept {
    CRANKLOOP_ASSERT(first + kLanesOf<Lanes> <= AbreastWork<S>::kRoom);
    const auto regime = regimes_at<Lanes>(work_, first);
    const auto gas = gas_at<Lanes>(first);
    static_assert(sizeof out_.valve[0][0] == 4 * sizeof(float));
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
    const auto sure = holds(regime.train, stepped_to.compression_m, stepped_to.compression_speed_m_s) &
                      holds(regime.seat, step.state.lift_m, step.state.velocity_m_s);
    const Lanes rest = resting_m<Lanes>(gas, first);
    const auto still =
        (magnitude(step.state.lift_m - rest) < regime.rest_m) & (magnitude(step.state.velocity_m_s) < regime.rest_m_s);
    const ValveState<Lanes> end{still ? rest : step.state.lift_m, still ? Lanes{} : step.state.velocity_m_s};
    const Contacting<Lanes> at{to.lift_m - end.lift_m, deg_per_s * to.per_deg_m - end.velocity_m_s};
    const Lanes accelerates = acceleration(regime.acceleration, end, at.compression_m, at.compression_speed_m_s, gas);
    keep_states(first, valves, end);
    store<Lanes>(&work_.cam_lift_m[first], to.lift_m);
    store<Lanes>(&work_.cam_per_deg_m[first], to.per_deg_m);
    const Lanes theory = larger(to.lift_m, Lanes{});
    store_lanes(theory, end.lift_m, end.velocity_m_s, accelerates,
                RowsOf<4, Lanes>(valves, &out_.valve[0][0].theoretical_lift_m).at);
    if constexpr (S::valve_forces) show_forces(first, valves, end, at, accelerates, place);
    if constexpr (Valves::kMoversFirst) still_ |= Bits{holding(still)} << first;
    std::uint32_t looked_at = failing(sure);
    if (far_ != 0) looked_at |= static_cast<std::uint32_t>(far_ >> first) & ((1u << kLanesOf<Lanes>)-1);
    std::uint32_t asking = looked_at;
    if constexpr (S::valve_results) {
      const Lanes from_m_s = deg_per_s * from.per_deg_m;
      const Lanes began = acceleration(regime.acceleration, start, from.lift_m - start.lift_m,
                                       from_m_s - start.velocity_m_s, gas.before());
      const auto closing = (from_m_s > Lanes{}) & (deg_per_s * to.per_deg_m <= Lanes{});
      const auto peaks = (start.velocity_m_s > Lanes{}) & (end.velocity_m_s < Lanes{});
      const auto lifted = larger(theory, end.lift_m) >= load<Lanes>(&work_.eventless_to_m[first]);
      const auto grows =
          enlarges(&work_.largest_lift_m[first], larger(start.lift_m, end.lift_m)) |
          enlarges(&work_.largest_speed_m_s[first], magnitude(end.velocity_m_s)) |
          enlarges(&work_.largest_acceleration_m_s2[first], larger(magnitude(began), magnitude(accelerates)));
      // Of one that swings on its seat alone, the step's start counts for nothing: not told apart here.
      const std::uint32_t eventful = holding(closing | peaks | lifted | (grows & outside_lobe<Lanes>(first, place)));
      eventful_ |= Bits{eventful} << first;
      enlarged_ |= Bits{holding(grows)} << first;
      asking |= eventful;
    }
    if constexpr (Needs<S>::valve_gas_held) keep_gas(first, gas.to_N, asking);
    if (asking == 0) return;
    doubtful_ |= Bits{looked_at} << first;
    store<Lanes>(&before_.lift_m[first], start.lift_m);
    store<Lanes>(&before_.velocity_m_s[first], start.velocity_m_s);
    store<Lanes>(&before_.increment_m[first], step.increment_m);
    store<Lanes>(&before_.cam_lift_m[first], from.lift_m);
    store<Lanes>(&before_.cam_per_deg_m[first], from.per_deg_m);
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

  /// The force with which the next tick begins; lanes that `ask` for more than this step still need it as it was.
  template <class Lanes>
  [[gnu::always_inline]] void keep_gas(std::uint32_t first, const Lanes& force_N, std::uint32_t ask) noexcept {
    float* const held = &state_.valve_gas_N[first];
    if (ask == 0) {
      store<Lanes>(held, force_N);
      return;
    }
    for (std::uint32_t i = 0; i < kLanesOf<Lanes>; ++i) {
      if ((ask >> i & 1) == 0) held[i] = force_N[i];
    }
  }

  /// As show_forces() of one valve does.
  template <class Lanes>
  [[gnu::always_inline]] void show_forces(std::uint32_t first, const ValvesOf<Lanes>& valves,
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
      if (place.segment[i] < curve.segments)
        cam_N[i] = train_N[i] * value(curve.rocker_ratio[place.segment[i]], static_cast<float>(place.u[i]));
    }
    const Words32 contacts = (regime & (kTrainOn | kSeatOn)) | (regime >> 1 & kSeatOn);  // kQuiet is on its seat
    static_assert(sizeof out_.valve_forces[0][0] == 6 * sizeof(float));
    store_lanes({train_N, seat_N, tip_N, cam_N, at.compression_m, reinterpret_cast<Lanes>(contacts)},
                RowsOf<6, Lanes>(valves, &out_.valve_forces[0][0].train_N).at);
  }

  Valves& valves_;
  ValvesWorkOf<float, S>& work_;  ///< of the valves, as are the next two
  State<float, S>& state_;
  Output<float, S>& out_;
  Before& before_;
  Bits far_;
  LanesTick<S> tick_;
  Bits doubtful_ = 0;
  Bits eventful_ = 0, enlarged_ = 0, still_ = 0;
};

}  // namespace crankloop::detail
#endif

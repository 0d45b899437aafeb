// The elastic valves of an engine over one tick.
//
// What belongs here: which valves are active, which may spend the event budget, when a cycle ends. What does not: the
// plain steps (plain_steps.hpp), steps with events (event_location.hpp).
//
//     activate valves whose cams come near -> plain step of each active valve, with its guards
//     -> event location where a guard fails
//     (springs that surge push before, and step after: spring_step.hpp)
//
// An active valve takes one step in its contact regime; the regime's record of constants makes the difference. If both
// guards pass, no contact can have changed meanwhile, and that is its tick. A valve at rest whose cam is away is not
// active, and costs nothing.
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/tick/valve/cam_contact.hpp>
#include <crankloop/tick/valve/plain_steps.hpp>
#include <crankloop/tick/valve/spring_step.hpp>

namespace crankloop::detail {

/// The cam's speed may change by this ratio from tick to tick before the dampers' forces require a check of the
/// contacts.
inline constexpr double kSpeedJump = 0.02;

template <class Real, class S>
class ElasticValves {
  using Valves = ValveAccess<Real, S>;
  using Steps = PlainSteps<Real, S>;
  using Before = typename Steps::Before;
  using Bits = typename Valves::Bits;
  using Apart = typename Valves::Apart;

 public:
  /// Pressures are those of each cylinder, where the scene has valve_gas; none at the start.
  ElasticValves(const Tables<Real, S>& tables, State<Real, S>& state, ValvesWork<Real, S>& work, Output<Real, S>& out,
                const Real* pressure_Pa = nullptr) noexcept
      : valves_{{}, tables, state, work, out, pressure_Pa} {}

  /// Puts every valve where its cam stands, at rest. The gas comes with the first tick.
  [[gnu::cold]] void start() noexcept {
    place_all(valves_);
    if constexpr (Needs<S>::surge) SpringStep<Real, S>(valves_).start();
    valves_.for_each([&](std::uint32_t v) {
      const std::uint64_t since_opening =
          cam_phase(valves_.state, valves_.train(v)) - valves_.curve(v).opens[valves_.cylinder(v)];
      const ValveInRegime<Real> placed = in_equilibrium(
          valves_.motion(v), valves_.curve(v).read(valves_.curve(v).cell(since_opening)).lift_m, valves_.gas_now_N(v));
      valves_.set_state(v, placed.state);
      valves_.set_regime(v, placed.regime);
      if constexpr (Needs<S>::valve_gas_held) valves_.state.valve_gas_N[v] = valves_.gas_now_N(v);
    });
    remember();
  }

  /// Derives again what a tick remembers beside the state.
  [[gnu::cold, gnu::noinline]] void remember() noexcept {
    place_all(valves_);
    valves_.work.active = 0;
    if constexpr (Valves::kActiveFirst) valves_.work.active_lanes = 0;
    valves_.work.skip_deg = valves_.work.guard_range_deg = valves_.work.wide_deg = Real{kDegreesPerTurn + 1};
    for (std::uint32_t& degree : valves_.work.degree) degree = kDegreesPerTurn;  // none: the next tick enters one
    valves_.for_each([&](std::uint32_t v) {
      valves_.set_cam(v, valves_.curve(v).read(valves_.curve(v).cell(cam_phase(valves_.state, valves_.train(v)) -
                                                                     valves_.curve(v).opens[valves_.cylinder(v)])));
      activate(valves_, v);
      if (valves_.curve(v).skip_deg < valves_.work.skip_deg) valves_.work.skip_deg = valves_.curve(v).skip_deg;
      if (valves_.motion(v).widest_step_deg < valves_.work.guard_range_deg)
        valves_.work.guard_range_deg = valves_.motion(v).widest_step_deg;
      if (valves_.motion(v).cubic_deg < valves_.work.wide_deg) valves_.work.wide_deg = valves_.motion(v).cubic_deg;
    });
    if (valves_.work.skip_deg < valves_.work.guard_range_deg) valves_.work.guard_range_deg = valves_.work.skip_deg;
    if (valves_.work.guard_range_deg < valves_.work.wide_deg) valves_.work.wide_deg = valves_.work.guard_range_deg;
  }

  /// For a crank that turns before its first tick: valves that their cams carry move with them. Another speed before
  /// the first tick starts the valves again.
  [[gnu::cold, gnu::noinline]] void start_turning() noexcept {
    State<Real, S>& state = valves_.state;
    if (state.ticks != 0) return;
    const Drive<Real>& drive = *valves_.tables.drive;
    const Real deg = state.speed_rad_s * drive.cycles_per_tick_per_rad_s * Real{kDegreesPerTurn};
    if (state.cam_turned_deg[0] == deg) return;
    if (state.cam_turned_deg[0] != 0) start();
    for (std::uint32_t g = 0; g < valves_.cam_groups(); ++g) state.cam_turned_deg[g] = deg;
    valves_.for_each([&](std::uint32_t v) {
      const Cell cell = valves_.cell(v, cam_phase(state, valves_.train(v)));
      const ValveInRegime<Real> carried =
          carried_along(valves_.motion(v), {valves_.state_of(v), state.valve_regime[v]}, valves_.cam(v),
                        valves_.curve(v).curvature(cell), deg * drive.per_tick_s);
      valves_.set_state(v, carried.state);
      valves_.set_regime(v, carried.regime);
    });
  }

  /// Returns fault bits.
  [[nodiscard, gnu::always_inline]] std::uint32_t run(const CamTicks<Real, S>& cams, bool jumped) noexcept {
    if (jumped) start();
    bool entered = false;
    for (std::uint32_t g = 0; g < valves_.cam_groups(); ++g) entered |= begin_tick(cams[g], g);
    for (std::uint32_t g = 0; g < valves_.cam_groups(); ++g) check_speed(cams[g], g);
    if (kByDegree && entered) enter_degrees(cams);
    if constexpr (Needs<S>::surge) SpringStep<Real, S>(valves_).push();
    Before before;
    Steps steps(valves_);
    const Bits failed = steps.run(cams, before);
    const bool exceeded = failed != 0 && locate_events_in_turn(valves_.apart(), failed, cams.apart(), before);
    if constexpr (Needs<S>::cam_loads) CamsUnderLoad<Real, S>(valves_, cams).run();
    steps.deactivate_resting();
    if constexpr (Needs<S>::surge) SpringStep<Real, S>(valves_).step();
    if constexpr (Needs<S>::cycle_ends) {
      end_cycles(cams);
    }
    return exceeded ? std::uint32_t{kFaultEventBudget} : 0;
  }

 private:
  static constexpr bool kByDegree = Needs<S>::valves_rest || Needs<S>::cycle_ends;

  /// Whether cams enter another degree of their turn.
  [[nodiscard]] bool begin_tick(const CamTick<Real>& tick, std::uint32_t group) noexcept {
    CRANKLOOP_ASSERT(group < kCamGroups<S>);
    CRANKLOOP_ASSERT(valves_.work.wide_deg <= valves_.work.guard_range_deg &&
                     valves_.work.guard_range_deg <= valves_.work.skip_deg);
    const Real deg = magnitude(tick.cam.deg);
    CRANKLOOP_ASSERT(deg <= Real{kDegreesPerTurn / 2});
    if (deg >= valves_.work.wide_deg)
      valves_.wide = true, valves_.beyond_guards = valves_.beyond_guards || deg >= valves_.work.guard_range_deg;
    const std::uint32_t before = valves_.work.degree[group], now = tick.degree();
    valves_.work.degree[group] = now;
    return now != before;
  }

  /// Looks up which cams are near and whose cycles may end, and activates valves whose cams have come near. In a tick
  /// that turns the cams too far for the tables, all are and may.
  [[gnu::always_inline]] void enter_degrees(const CamTicks<Real, S>& cams) noexcept {
    if constexpr (Needs<S>::valves_rest) {
      const bool may_skip = valves_.beyond_guards && turns_by(cams, valves_.work.skip_deg);
      const Bits near = may_skip ? all_valves(valves_.apart()) : valves_at(near_degrees(), cams);
      valves_.work.near = near;
      const Bits newly_near = near & ~valves_.work.active;
      if (newly_near != 0) activate_all(valves_.apart(), newly_near, cams.apart());
    }
    if constexpr (Needs<S>::cycle_ends)
      valves_.work.ending = turns_by(cams, Real{kCycleEndMargin_deg}) ? all_valves(valves_.apart())
                                                                      : valves_at(valves_.tables.cycle_ends, cams);
  }
  [[nodiscard]] bool turns_by(const CamTicks<Real, S>& cams, Real deg) const noexcept {
    for (std::uint32_t g = 0; g < valves_.cam_groups(); ++g)
      if (magnitude(cams[g].cam.deg) >= deg) return true;
    return false;
  }

  /// Whether the cams' speed jumps.
  void check_speed(const CamTick<Real>& tick, std::uint32_t group) noexcept {
    CRANKLOOP_ASSERT(group < kCamGroups<S>);
    Real& before_deg = valves_.state.cam_turned_deg[group];
    if (tick.cam.deg == before_deg) return;
    const bool jumps = magnitude(tick.cam.deg - before_deg) > static_cast<Real>(kSpeedJump) * magnitude(tick.cam.deg);
    before_deg = tick.cam.deg;
    if (jumps) recheck_contacts(valves_.apart(), tick.apart(), group);
  }

  /// Valves that have their bit at the degrees where their cams stand.
  [[nodiscard]] Bits valves_at(const CamDegrees* of_train, const CamTicks<Real, S>& cams) const noexcept {
    Bits valves = 0;
    for (std::uint32_t t = 0; t < valves_.trains(); ++t)
      valves |= Bits{of_train[t].cylinders[S::cam_phasing ? cams[t].degree() : valves_.work.degree[0]]}
                << t * Valves::kPerTrain;
    return valves;
  }
  [[nodiscard, gnu::cold, gnu::noinline]] static Bits all_valves(Apart valves) noexcept {
    Bits all = 0;
    valves.for_each([&](std::uint32_t v) { all |= Bits{1} << v; });
    return all;
  }
  [[nodiscard]] const CamDegrees* near_degrees() const noexcept {
    if constexpr (S::valve_forces)
      return valves_.tables.near_lobes;
    else
      return valves_.tables.near_cams;
  }

  /// Activates valves, from where their cams stood before the tick.
  [[gnu::noinline]] static void activate_all(Apart valves, Bits which,
                                             typename CamTicks<Real, S>::Apart cams) noexcept {
    for (Bits left = which; left != 0; left &= left - 1) {
      const std::uint32_t v = trailing_zeros(left);
      valves.set_cam(v, valves.curve(v).read(valves.cell(v, cams[valves.train(v)].phase_before())));
      activate(valves, v);
    }
  }

  /// The cams' speed has jumped, and with it the forces of the trains' dampers. Seats know nothing of it.
  [[gnu::noinline]] static void recheck_contacts(Apart valves, const CamTick<Real> tick, std::uint32_t group) noexcept {
    for (Bits left = valves.work.active & valves.of_group(group); left != 0; left &= left - 1) {
      const std::uint32_t v = trailing_zeros(left);
      const ValveState<Real> s = valves.state_of(v);
      const std::uint32_t before = contacts_of(valves.state.valve_regime[v]);
      const bool train = requires_train(valves.motion(v), s, valves.cam(v), tick.cam.deg_per_s);
      if (train == ((before & kTrainOn) != 0)) continue;
      const std::uint32_t regime = before ^ kTrainOn;
      valves.set_regime(v, regime);
      if constexpr (S::valve_results) {
        const Real deg = valves.curve(v).degrees(tick.phase_before() - valves.curve(v).opens[valves.cylinder(v)]);
        valves.state.record[valves.train(v)][valves.cylinder(v)].event(before, regime, s.velocity_m_s, deg);
        valves.load_record(v);
      }
    }
  }

  // ---- event location ---------------------------------------------------------------------------------------------

  /// Another valve comes first in every tick: the first may spend the budget.
  [[nodiscard, gnu::noinline]] static bool locate_events_in_turn(Apart valves, Bits failed,
                                                                 typename CamTicks<Real, S>::Apart cams,
                                                                 const Before& before) noexcept {
    EventBudget budget{valves.tables.valve_motions[0].event_budget, false};
    const std::uint32_t first = static_cast<std::uint32_t>(valves.state.ticks) % Valves::kMaxValves;
    constexpr Bits kAll = (Bits{1} << (Valves::kMaxValves - 1) << 1) - 1;
    const Bits from_first = failed >> first | (failed << (Valves::kMaxValves - 1 - first) << 1 & kAll);
    for (Bits left = from_first; left != 0; left &= left - 1) {
      const std::uint32_t v = first + trailing_zeros(left);
      const std::uint32_t valve = v < Valves::kMaxValves ? v : v - Valves::kMaxValves;
      CRANKLOOP_ASSERT((failed >> valve & 1) != 0);
      locate_events(valves, valve, cams[valves.train(valve)], before, budget);
    }
    CRANKLOOP_ASSERT(budget.left <= valves.tables.valve_motions[0].event_budget);
    return budget.exceeded;
  }

  static void locate_events(Valves& valves, std::uint32_t v, const CamTick<Real>& tick, const Before& before,
                            EventBudget& budget) noexcept {
    const typename Valves::Gas gas = valves.gas_on(v);
    const std::uint32_t lane = valves.lane_of(v);
    const Lift<Real> to = valves.cam(v);
    const ValveInRegime<Real> start{before.state(lane), valves.state.valve_regime[v]};
    const std::uint32_t parts = valves.motion(v).parts;
    const bool may_rest = parts > 1 || valves.wide;
    ValveInRegime<Real> end = start;
    if (!(may_rest && rests(start, valves.curve(v), before.cam(lane).lift_m, to.lift_m, tick.cam.deg, gas))) {
      // On lines of their own: tests/target/loop_bounds.conf names those that pay.
      const bool within = budget.left >= (parts > 1 ? parts : 1 + kUnitsOfLook);
      if (within) budget.take(parts);
      end = within ? locate_within_budget(valves, v, tick, before, gas, budget)
                   : step_beyond_budget(valves, v, tick, before, gas, budget);
    }
    CRANKLOOP_ASSERT(is_finite(end.state.lift_m) && is_finite(end.state.velocity_m_s));
    valves.set_state(v, end.state);
    if (end.regime != start.regime) valves.set_regime(v, end.regime);
    valves.load_record(v);
    const Real compression_m = to.lift_m - end.state.lift_m;
    const Real compression_speed_m_s = tick.cam.deg_per_s * to.per_deg_m - end.state.velocity_m_s;
    const ForceRow<Real>& force = valves.motion(v).whole[end.regime].acceleration;
    valves.write_output(v, end.state, valves.cell(v, tick.phase),
                        {to.lift_m, compression_m, compression_speed_m_s,
                         acceleration(force, end.state, compression_m, compression_speed_m_s, gas)},
                        gas);
  }

  /// Its fine steps are paid for, and what is sure to follow them is there.
  [[nodiscard, gnu::noinline]] static ValveInRegime<Real> locate_within_budget(Valves& valves, std::uint32_t v,
                                                                               const CamTick<Real>& tick,
                                                                               const Before& before,
                                                                               const typename Valves::Gas& gas,
                                                                               EventBudget& budget) noexcept {
    const std::uint32_t lane = valves.lane_of(v);
    const Lift<Real> from = before.cam(lane);
    const ValveInRegime<Real> start{before.state(lane), valves.state.valve_regime[v]};
    const Stepped<Real> step{valves.state_of(v), before.increment_m(lane)};
    const std::uint64_t at = tick.phase - valves.curve(v).opens[valves.cylinder(v)];
    return valves.event_locator(v, budget).run(start, step, valves.span(v, tick, from, valves.cam(v), gas), at,
                                               tick.turned);
  }

  /// The tick in one step, for want of budget.
  [[nodiscard, gnu::always_inline]] static ValveInRegime<Real> step_beyond_budget(
      Valves& valves, std::uint32_t v, const CamTick<Real>& tick, [[maybe_unused]] const Before& before,
      [[maybe_unused]] const typename Valves::Gas& gas, EventBudget& budget) noexcept {
    budget.exceeded = true;
    const ValveMotion<Real>& motion = valves.motion(v);
    const ValveState<Real> s = valves.state_of(v);
    if (is_too_far(s)) return put_back(motion, valves.cam(v).lift_m);
    const ValveInRegime<Real> end =
        beyond_budget(motion, valves.state.valve_regime[v], s, valves.cam(v), tick.cam.deg_per_s);
    if constexpr (S::valve_results) {
      const std::uint32_t lane = valves.lane_of(v);
      const Lift<Real> from = before.cam(lane);
      const ValveInRegime<Real> start{before.state(lane), valves.state.valve_regime[v]};
      valves.event_locator(v, budget).record_unlocated(start, end, valves.span(v, tick, from, valves.cam(v), gas));
    }
    return end;
  }

  // ---- after the steps --------------------------------------------------------------------------------------------

  /// A valve's cycle ends where its cam passes the middle of the base circle.
  void end_cycles(const CamTicks<Real, S>& cams) noexcept {
    for (Bits left = valves_.work.ending; left != 0; left &= left - 1) {
      const std::uint32_t v = trailing_zeros(left);
      const CamTick<Real>& tick = cams[valves_.train(v)];
      const LiftCurve<Real>& lift = valves_.curve(v);
      const std::uint64_t opens = lift.opens[valves_.cylinder(v)];
      if (!lift.passes_base_circle(tick.phase_before() - opens, tick.phase - opens)) continue;
      if constexpr (S::valve_results) end_record(v, tick, lift);
      if constexpr (S::cam_contact) {
        (&valves_.out.cam_contact_cycle[0][0])[v] = (&valves_.state.contact_record[0][0])[v];
        (&valves_.state.contact_record[0][0])[v] = {};
      }
    }
  }
  void end_record(std::uint32_t v, const CamTick<Real>& tick, const LiftCurve<Real>& lift) noexcept {
    // In cam degrees since the start of the lobe: after it, or before it when turning backwards.
    const auto lobe_deg = static_cast<Real>(static_cast<std::int32_t>(lift.segments));
    const Real end_deg = (tick.cam.deg < 0 ? lobe_deg - Real{kDegreesPerTurn} : lobe_deg + Real{kDegreesPerTurn}) / 2;
    valves_.out.valve_cycle[valves_.train(v)][valves_.cylinder(v)] =
        valves_.state.record[valves_.train(v)][valves_.cylinder(v)].finish(end_deg,
                                                                           contacts_of(valves_.state.valve_regime[v]));
    valves_.load_record(v);
  }

  Valves valves_;
};

}  // namespace crankloop::detail

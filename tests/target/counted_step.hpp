// One engine, and what its steps cost by the emulator's counter: for images that measure. Needs COSTS_ENGINE and
// COSTS_ENGINE_HEADER defined.
//
// What belongs here: the engine under test, counting one step, what bounds its loops. What does not: operating
// speeds and stack (costs.cpp), the search for the dearest tick (worst_search.hpp).
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/tick/gas/gas_places.hpp>
#include <crankloop/tick/valve/valves_step.hpp>

#include "port/common/machine.hpp"
#include "port/common/text.hpp"

#include COSTS_ENGINE_HEADER

namespace {

namespace port = crankloop::port;
namespace under_test = COSTS_ENGINE;
using under_test::Engine;
using under_test::Input;
using under_test::Real;

Engine engine;
Input input;

/// One step by the counter, with the call and without the reading of the counter.
std::uint32_t cost_of_step() noexcept {
  const std::uint32_t before = port::counter();
  engine.step(input);
  return port::instructions_between(before, port::counter());
}

std::uint32_t cost_of_counting() noexcept {
  const std::uint32_t before = port::counter();
  asm volatile("" ::: "memory");
  return port::instructions_between(before, port::counter());
}

/// Called where the ticks begin whose cycles worst_tick/step_cycles.cpp counts, and where they end.
extern "C" [[gnu::noinline]] void crankloop_measures() noexcept { asm volatile("" ::: "memory"); }

/// What a tick turns a train's cams by at most, with what rounding adds.
template <class Tables>
Real widest_cam_turn_deg(const Tables& tables, std::uint32_t train) noexcept {
  constexpr auto kDegreesPerRadian = static_cast<Real>(57.29577951308232);
  constexpr auto kDegreesPerUnit = static_cast<Real>(360 / 18446744073709551616.0);
  const Real by_crank_deg = tables.drive->speed_limit_rad_s * tables.drive->tick_s * kDegreesPerRadian / 2;
  const Real by_phaser_deg = under_test::Scene::cam_phasing
                                 ? static_cast<Real>(tables.lift_curves[train].most_phase_per_tick) * kDegreesPerUnit
                                 : Real{0};
  return (by_crank_deg + by_phaser_deg) * static_cast<Real>(1 + 1e-5);
}

/// Valves whose cams come near in one tick, at most: those that the degree at its end has and that at its start has
/// not. Valves whose cams are near are active.
template <class Tables>
std::uint32_t most_activations(const Tables& tables) noexcept {
  constexpr bool kOfLobes = under_test::Scene::valve_forces;
  std::uint32_t all = 0;
  for (std::uint32_t t = 0; t < tables.drive->trains; ++t) {
    const Real turn_deg = widest_cam_turn_deg(tables, t);
    std::uint32_t most = turn_deg < tables.lift_curves[t].skip_deg ? 0 : tables.drive->cylinders;
    const int degrees = turn_deg < Real{crankloop::kDegreesPerTurn} ? static_cast<int>(turn_deg) + 1 : 0;
    const auto near = [&](int degree) {
      const int wrapped = (degree + crankloop::kDegreesPerTurn) % crankloop::kDegreesPerTurn;
      if constexpr (kOfLobes)
        return std::uint32_t{tables.near_lobes[t].cylinders[wrapped]};
      else
        return std::uint32_t{tables.near_cams[t].cylinders[wrapped]};
    };
    for (int degree = 0; degree < crankloop::kDegreesPerTurn; ++degree) {
      for (int turned = -degrees; turned <= degrees; ++turned) {
        std::uint32_t come = 0;
        for (std::uint32_t left = near(degree + turned) & ~near(degree); left != 0; left &= left - 1) ++come;
        if (come > most) most = come;
      }
    }
    all += most;
  }
  return all;
}

/// Cams that come to the same angle of theirs in one tick, turning one way, at most.
template <class Tables>
std::uint32_t most_cam_openings(const Tables& tables) noexcept {
  std::uint32_t all = 0;
  for (std::uint32_t t = 0; t < tables.drive->trains; ++t) {
    const Real turn_cycles = widest_cam_turn_deg(tables, t) * static_cast<Real>(1.0 / crankloop::kDegreesPerTurn);
    if (turn_cycles >= static_cast<Real>(0.5)) return tables.drive->trains * tables.drive->cylinders;
    const std::uint64_t turn = crankloop::Phase::from_cycles(turn_cycles).units();
    const auto& opens = tables.lift_curves[t].opens;
    std::uint32_t most = 0;
    for (std::uint32_t first = 0; first < tables.drive->cylinders; ++first) {
      std::uint32_t count = 0;
      for (std::uint32_t k = 0; k < tables.drive->cylinders; ++k) count += opens[k] - opens[first] <= turn ? 1u : 0u;
      if (count > most) most = count;
    }
    all += most;
  }
  return all;
}

/// Valves whose cams are on their lobes at a tick's end, at most.
template <class Tables>
std::uint32_t most_on_lobes(const Tables& tables) noexcept {
  std::uint32_t all = 0;
  for (std::uint32_t t = 0; t < tables.drive->trains; ++t) {
    const auto& curve = tables.lift_curves[t];
    std::uint32_t most = 0;  // where one opens: only there does their number rise
    for (std::uint32_t first = 0; first < tables.drive->cylinders; ++first) {
      std::uint32_t on = 0;
      for (std::uint32_t k = 0; k < tables.drive->cylinders; ++k)
        on += curve.cell(curve.opens[first], k).degree < curve.segments ? 1u : 0u;
      if (on > most) most = on;
    }
    all += most;
  }
  return all;
}

/// Valves whose cycles may end in one tick, at most.
template <class Tables>
std::uint32_t most_endings(const Tables& tables) noexcept {
  std::uint32_t all = 0;
  for (std::uint32_t t = 0; t < tables.drive->trains; ++t) {
    if (widest_cam_turn_deg(tables, t) >= Real{crankloop::detail::kCycleEndMargin_deg})
      return tables.drive->trains * tables.drive->cylinders;
    std::uint32_t most = 0;
    for (const std::uint32_t cylinders : tables.cycle_ends[t].cylinders) {
      std::uint32_t end = 0;
      for (std::uint32_t left = cylinders; left != 0; left &= left - 1) ++end;
      if (end > most) most = end;
    }
    all += most;
  }
  return all;
}

/// Cylinders that have a valve open anywhere in one tick at most, and both ports: all, unless valves follow their cams.
struct OpenCylinders {
  std::uint32_t breathing, overlaps;
};
template <class Tables>
OpenCylinders most_open(const Tables& tables) noexcept {
  constexpr int kTurn = crankloop::kDegreesPerTurn;
  constexpr int kSamples = 8;  // of a degree: a ramp leaves the base circle in one
  using crankloop::detail::kClosedLift_m;
  const std::uint32_t cylinders = tables.drive->cylinders;
  OpenCylinders most{0, 0};
  for (int degree = 0; degree < kTurn; ++degree) {
    OpenCylinders open{0, 0};
    for (std::uint32_t k = 0; k < cylinders; ++k) {
      std::uint32_t ports = 0;
      for (std::uint32_t t = 0; t < tables.drive->trains; ++t) {
        const Real turn_deg = widest_cam_turn_deg(tables, t);
        if (crankloop::detail::Needs<under_test::Scene>::elastic_valves || under_test::Scene::cam_phasing ||
            turn_deg >= 90)
          return {cylinders, cylinders};
        const auto& curve = tables.lift_curves[t];
        for (int at = 0; at <= (static_cast<int>(turn_deg) + 2) * kSamples; ++at) {
          const int sample = (degree * kSamples + at) % (kTurn * kSamples);
          const Real cycles = static_cast<Real>(sample) / static_cast<Real>(kTurn * kSamples);
          const std::uint64_t phase = crankloop::Phase::from_cycles(cycles).units();
          if (curve.read(curve.cell(phase, k)).lift_m > static_cast<Real>(kClosedLift_m / 2))
            ports |= 1u << tables.gas_ports[t].port;
        }
      }
      open.breathing += ports != 0 ? 1 : 0;
      open.overlaps += ports == 3 ? 1 : 0;
    }
    if (open.breathing > most.breathing) most.breathing = open.breathing;
    if (open.overlaps > most.overlaps) most.overlaps = open.overlaps;
  }
  return most;
}

/// How many cylinders come to the same angle of their cycles in one tick at most.
template <class Drive>
std::uint32_t cycles_at_once(const Drive& drive) noexcept {
  const std::uint64_t turn =
      crankloop::Phase::from_cycles(drive.speed_limit_rad_s * drive.cycles_per_tick_per_rad_s).units();
  const auto fires = [&drive](std::uint32_t k) {
    return drive.firing_phase[drive.mechanism_of[k]] + (std::uint64_t{drive.turn_of[k]} << 63);
  };
  std::uint32_t most = 0;
  for (std::uint32_t first = 0; first < drive.cylinders; ++first) {
    std::uint32_t count = 0;
    for (std::uint32_t k = 0; k < drive.cylinders; ++k) {
      if (fires(k) - fires(first) <= turn) ++count;
    }
    if (count > most) most = count;
  }
  return most;
}

/// What bounds the loops of a tick, for worst_tick: counts of the engine, from its tables, and the tick's budget of
/// events.
template <class Tables>
void print_limits(const Tables& tables) noexcept {
  using Needs = crankloop::detail::Needs<under_test::Scene>;
  port::Line() << "limit cylinders " << tables.drive->cylinders;
  port::Line() << "limit mechanisms " << tables.drive->mechanisms;
  const std::uint32_t trains = Needs::any_valves ? tables.drive->trains : 0;
  port::Line() << "limit trains " << trains;
  port::Line() << "limit valves " << trains * tables.drive->cylinders;
  std::uint32_t pins = 0;
  std::uint32_t fine_steps = 0;  // 0: a tick is one, and none goes by several
  std::uint32_t events = 0;
  std::uint32_t wide_ticks = 0;   // 1: a tick may turn the cams further than the cubic through its ends can follow,
  std::uint32_t wide_steps = 0;   // or even a fine step of one
  std::uint32_t guard_ticks = 0;  // 1: or further than some guards reach
  std::uint32_t rest_ticks = 0;   // 1: a valve whose guards fail may be at rest
  if constexpr (under_test::Scene::bearing_loads) pins = tables.bearings->pins;
  if constexpr (Needs::elastic_valves) {
    for (std::uint32_t t = 0; t < tables.drive->trains; ++t) {
      const std::uint32_t parts = tables.valve_motions[t].parts;
      if (parts > 1 && parts > fine_steps) fine_steps = parts;
      const Real turn_deg = widest_cam_turn_deg(tables, t);
      if (turn_deg >= tables.valve_motions[t].cubic_deg) wide_ticks = 1;
      if (turn_deg >= tables.valve_motions[t].widest_step_deg || turn_deg >= tables.lift_curves[t].skip_deg)
        guard_ticks = wide_ticks = 1;
      if (turn_deg * tables.valve_motions[t].per_parts >= tables.valve_motions[t].cubic_deg) wide_steps = 1;
    }
    rest_ticks = fine_steps != 0 || wide_ticks != 0 ? 1 : 0;
    events = tables.valve_motions[0].event_budget;
  }
  port::Line() << "limit spring_modes " << tables.drive->spring_modes;
  std::uint32_t wheels = 0;
  std::uint32_t edges = 0;          // of a wheel in a tick
  std::uint32_t edge_searches = 0;  // rounds of a bisection
  if constexpr (Needs::any_triggers) {
    wheels = tables.triggers->count;
    for (std::uint32_t i = 0; i < wheels; ++i) {
      const crankloop::detail::TriggerTrack& wheel = tables.triggers->wheel[i];
      const std::uint32_t passed = Needs::crank_dynamics ? 2 * wheel.max_edges : wheel.max_edges;
      if (passed > edges) edges = passed;
      for (int part = 0; part < crankloop::detail::kTriggerParts; ++part)
        while ((wheel.edges_before[part + 1] - wheel.edges_before[part]) >> edge_searches != 0) ++edge_searches;
    }
    if (edges > under_test::Scene::trigger_edges) edges = under_test::Scene::trigger_edges;
  }
  port::Line() << "limit wheels " << wheels;
  port::Line() << "limit edges " << edges;
  port::Line() << "limit edge_searches " << edge_searches;
  port::Line() << "limit pins " << pins;
  port::Line() << "limit fine_steps " << fine_steps;
  port::Line() << "limit events " << events;
  std::uint32_t activations = 0;
  if constexpr (Needs::valves_rest) activations = most_activations(tables);
  port::Line() << "limit activations " << activations;
  std::uint32_t endings = 0;
  if constexpr (Needs::cycle_ends) endings = most_endings(tables);
  port::Line() << "limit endings " << endings;
  port::Line() << "limit wide_ticks " << wide_ticks;
  port::Line() << "limit wide_steps " << wide_steps;
  port::Line() << "limit guard_ticks " << guard_ticks;
  port::Line() << "limit rest_ticks " << rest_ticks;
  std::uint32_t on_lobes = 0, cam_openings = 0;
  if constexpr (Needs::any_valves) on_lobes = most_on_lobes(tables), cam_openings = most_cam_openings(tables);
  port::Line() << "limit cam_openings " << cam_openings;
  port::Line() << "limit on_lobes " << on_lobes;
  std::uint32_t gas_steps = 1;
  if constexpr (Needs::gas) gas_steps = tables.gas_cylinders->max_steps;
  OpenCylinders open{0, 0};
  if constexpr (Needs::gas) open = most_open(tables);
  port::Line() << "limit breathing " << open.breathing;
  port::Line() << "limit overlaps " << open.overlaps;
  port::Line() << "limit gas_steps " << gas_steps;
  port::Line() << "limit split_ticks " << (gas_steps > 1 ? 1u : 0u);
  port::Line() << "limit cycles_at_once " << cycles_at_once(*tables.drive);
}

}  // namespace

#include "trigger_tracks.hpp"

#include <cstddef>

#include "crank_dynamics.hpp"
#include "phase_units.hpp"

namespace crankloop::detail {
namespace {

/// A fraction of a turn, 0 to below 1, rounded to the nearest of 2^32 equal parts. Validated edges are so far apart
/// that no two become equal and the last does not become a whole turn.
[[nodiscard]] std::uint32_t turn_units(double turns) noexcept {
  CRANKLOOP_ASSERT(turns >= 0 && turns * 4294967296.0 + 0.5 < 4294967296.0);
  return static_cast<std::uint32_t>(turns * 4294967296.0 + 0.5);
}

void fill_parts(TriggerTrack& track) noexcept {
  constexpr std::uint32_t kPart = std::uint32_t{1} << 25;
  static_assert(kTriggerParts * std::uint64_t{kPart} == std::uint64_t{1} << 32);
  CRANKLOOP_ASSERT(track.edges[0] == 0);
  std::uint32_t edge = 0;
  for (std::uint32_t part = 0; part < std::uint32_t{kTriggerParts}; ++part) {
    while (edge < track.edge_count && track.edges[edge] < part * kPart) ++edge;
    track.edges_before[part] = static_cast<std::uint16_t>(edge);
  }
  track.edges_before[kTriggerParts] = static_cast<std::uint16_t>(track.edge_count);
}

/// Maximum number of edges that the wheel passes when it turns by `turns`, one end excluded.
[[nodiscard]] std::uint32_t max_edges_in(const TriggerTrack& track, double turns) noexcept {
  if (turns >= 1) return track.edge_count;
  const double units = turns * 4294967296.0;
  std::uint32_t most = 1;
  std::uint32_t behind =
      0;  // the first edge less than `units` behind the last; an index of edge_count or more is one turn later
  for (std::uint32_t last = 0; last < 2 * track.edge_count; ++last) {
    const auto place = [&track](std::uint32_t edge) {
      const bool next_turn = edge >= track.edge_count;
      return static_cast<double>(track.edges[next_turn ? edge - track.edge_count : edge]) +
             (next_turn ? 4294967296.0 : 0);
    };
    while (place(last) - place(behind) >= units) ++behind;
    if (last - behind + 1 > most) most = last - behind + 1;
  }
  return most;
}

/// Largest rotation of a wheel in a tick, in turns of the wheel: crank and phaser together.
[[nodiscard]] double widest_turns(const EngineDefinition& engine, const TickOptions& options,
                                  const TriggerWheel& wheel) noexcept {
  const double crank_deg = widest_turn_deg(engine, options);
  const bool phased = wheel.train >= 0 && wheel.train < engine.train_count;
  const double phaser_deg = phased ? engine.trains[wheel.train].cam.phase_rate_deg_s * options.tick_s : 0;
  return wheel.shaft == TriggerShaft::crank ? crank_deg / kDegreesPerTurn : (crank_deg + phaser_deg) / kDegreesPerCycle;
}

}  // namespace

std::uint32_t fill_edges(const TriggerWheel& wheel, std::uint32_t* edges) noexcept {
  std::uint32_t count = 0;
  if (wheel.pattern == TriggerPattern::edges) {
    const double turn_deg = wheel.shaft == TriggerShaft::crank ? 360 : 720;
    for (int i = 0; i < wheel.edge_count; ++i)
      edges[count++] = turn_units((wheel.edges_deg[i] - wheel.edges_deg[0]) / turn_deg);
    return count;
  }
  int place = 0;
  const auto add_teeth = [&](int until) {
    for (; place < until; ++place) {
      edges[count++] = turn_units(static_cast<double>(place) / wheel.places);
      edges[count++] = turn_units((place + wheel.tooth_ratio) / wheel.places);
    }
  };
  for (int i = 0; i < wheel.gap_count; ++i) {
    add_teeth(place + wheel.gaps[i].teeth);
    place += wheel.gaps[i].missing;
  }
  add_teeth(wheel.places);
  return count;
}

TriggerTrack track_of(const EngineDefinition& engine, const TickOptions& options, const TriggerWheel& wheel,
                      const std::uint32_t* edges, std::uint32_t count) noexcept {
  TriggerTrack track{};
  track.edges = edges;
  track.edge_count = count;
  CRANKLOOP_ASSERT(track.edge_count >= 2 && track.edge_count <= std::uint32_t{kMaxTriggerEdges});
  track.on_crank = wheel.shaft == TriggerShaft::crank ? 1 : 0;
  track.starts = phase_units(wheel.pattern == TriggerPattern::teeth ? wheel.first_tooth_deg : wheel.edges_deg[0]);
  track.train = wheel.train >= 0 ? static_cast<std::uint32_t>(wheel.train) : kNoTrain;
  track.inverted = wheel.inverted ? 1 : 0;
  fill_parts(track);
  track.max_edges = max_edges_in(track, widest_turns(engine, options, wheel));
  return track;
}

template <class Real>
void fill_triggers(const EngineDefinition& engine, const TickOptions& options,
                   const TableTargets<Real>& targets) noexcept {
  if (targets.triggers == nullptr) return;
  const auto count = static_cast<std::uint32_t>(engine.trigger_count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const TriggerWheel& wheel = engine.triggers[i];
    std::uint32_t* edges = targets.trigger_edges + i * std::size_t{kMaxTriggerEdges};
    targets.trigger_tracks[i] = track_of(engine, options, wheel, edges, fill_edges(wheel, edges));
  }
  *targets.triggers = {targets.trigger_tracks, count};
}

template void fill_triggers(const EngineDefinition&, const TickOptions&, const TableTargets<float>&) noexcept;
template void fill_triggers(const EngineDefinition&, const TickOptions&, const TableTargets<double>&) noexcept;

}  // namespace crankloop::detail

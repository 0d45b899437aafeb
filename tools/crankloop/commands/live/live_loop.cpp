#include "live_loop.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string>

#include "../../files/error.hpp"
#include "../../files/units.hpp"
#include "live_edges.hpp"
#include "live_engine.hpp"
#include "live_inputs.hpp"
#include "port/linux/stop_signal.hpp"
#include "port/linux/stopwatch.hpp"

namespace crankloop::program {
namespace {

using port::LiveOutputs;

/// The kernel's counters of this thread.
struct ThreadCounts {
  std::int64_t page_faults = 0;
  std::int64_t preemptions = 0;

  static ThreadCounts now() noexcept {
    rusage usage{};
    ::getrusage(RUSAGE_THREAD, &usage);
    return {usage.ru_minflt + usage.ru_majflt, usage.ru_nivcsw};
  }
};

/// Sums over the ticks.
struct LiveSums {
  double speed_rad_s = 0;
  double torque_Nm = 0;
};

/// One run: what a tick takes and gives, in the order of the tick.
template <class Real, class S>
class LiveRun {
 public:
  LiveRun(const EngineFile& file, const LiveRequest& request, const LiveEnds& ends, LiveFigures& figures)
      : request_{request},
        ends_{ends},
        figures_{figures},
        block_{ends.shared != nullptr ? **ends.shared : alone_},
        engine_{file, request},
        wheels_{engine_.shape().wheels},
        signals_{ends.shared != nullptr ? ends.shared->signals() : port::LockedNumbers{}},
        ring_{ends.shared != nullptr ? ends.shared->edges() : port::EdgeRing{}},
        inputs_{block_.inputs, inputs_at_start(), engine_, request.patience_ns, ends.schedule} {}

  void run() {
    const port::StopSignal stop;
    const port::RealTime real_time(request_.real_time);
    if (real_time.cpu_error() != 0) {
      const int error = real_time.cpu_error();
      throw UsageError("--cpu " + std::to_string(request_.real_time.cpu) + ": " +
                       (error == EINVAL ? "this process may not use such a processor" : std::strerror(error)));
    }
    figures_.memory_error = real_time.memory_error();
    figures_.priority_error = real_time.priority_error();

    block_.state.store(port::LiveState::running, std::memory_order_release);
    port::Periodic periodic(request_.tick_ns);
    const ThreadCounts counts_before = ThreadCounts::now();  // after the first reading of the clock, so that its page
                                                             // is mapped
    const std::int64_t start_ns = periodic.due_ns();
    while (periodic.tally().ticks < request_.ticks && !stop.received() && is_ours(periodic.tally().ticks))
      tick(periodic);
    const ThreadCounts counts_after = ThreadCounts::now();
    figures_.page_faults = counts_after.page_faults - counts_before.page_faults;
    figures_.preemptions = counts_after.preemptions - counts_before.preemptions;
    figures_.wall_s = static_cast<double>(port::now_ns() - start_ns) * 1e-9;
    finish(periodic.tally());
  }

 private:
  /// The section of inputs by name shows a controller what there is to begin with.
  port::LockedNumbers inputs_at_start() {
    engine_.set(request_.at_start);
    port::LockedNumbers by_name = ends_.shared != nullptr ? ends_.shared->inputs_by_name() : port::LockedNumbers{};
    by_name.write(engine_.inputs());
    return by_name;
  }

  [[nodiscard]] bool is_ours(std::uint64_t ticks) const {
    if (ends_.shared == nullptr) return true;
    return ends_.shared->has_magic() && (ticks % ticks_per_ms_ != 0 || ends_.shared->is_whole());
  }

  void tick(port::Periodic& periodic) {
    const port::PeriodicTally& tally = periodic.tally();
    figures_.begin.add(periodic.begin());
    inputs_.give(periodic.begun_ns(), static_cast<double>(tally.ticks) * request_.tick_s);
    const std::int64_t step_ns = port::now_ns();
    engine_.step();
    figures_.model.add(port::now_ns() - step_ns);

    if (tally.ticks == 0) begin_trace();
    publish_edges(periodic.due_ns(), static_cast<std::int64_t>(tally.ticks) * request_.tick_ns);
    publish(tally);
    sums_.speed_rad_s += published_.speed_rad_s;
    sums_.torque_Nm += published_.mean_torque_Nm;
    figures_.faulty_ticks += published_.faults != 0 ? 1 : 0;
    figures_.faults |= published_.faults;
    figures_.wheel_faults |= engine_.output().wheel_faults_on;
    figures_.work.add(periodic.done());
  }

  /// What was so before the first tick.
  void begin_trace() {
    if (ends_.trace == nullptr) return;
    ends_.trace->speed(0, request_.start_rad_s * kRpmPerRad_s);
    for (std::uint32_t w = 0; w < wheels_; ++w)
      ends_.trace->level(0, w, level_before(engine_.output().faulty_trigger[w]));
  }

  /// As a controller sees them, with their faults. Of a tick that is due at `due_ns` and begins at `begin_ns` of the
  /// model's time.
  void publish_edges(std::int64_t due_ns, std::int64_t begin_ns) {
    const std::int64_t ring_ns = due_ns + request_.lead_ticks * request_.tick_ns;
    figures_.unlisted_edges +=
        each_edge_by_time(engine_.output().faulty_trigger, wheels_, request_.tick_ns,
                          [&](std::int64_t time_ns, std::uint32_t wheel, std::uint32_t level) {
                            ring_.write(static_cast<std::uint64_t>(ring_ns + time_ns), wheel, level);
                            if (ends_.trace != nullptr) ends_.trace->level(begin_ns + time_ns, wheel, level != 0);
                            ++figures_.edges;
                          });
  }

  void publish(const port::PeriodicTally& tally) {
    published_.ticks = tally.ticks + 1;
    published_.time_s = static_cast<double>(published_.ticks) * request_.tick_s;
    engine_.tell(published_);
    published_.flags = inputs_.flags();
    published_.inputs_sequence = inputs_.sequence();
    published_.torn_inputs = inputs_.torn();
    published_.late_ticks = tally.late;
    published_.missed_deadlines = tally.missed;
    if (signals_.count() > 0) {
      engine_.tell(shown_);
      signals_.write(shown_);
    }
    block_.outputs.write(published_);
    if (ends_.trace == nullptr) return;
    const auto end_ns = static_cast<std::int64_t>(published_.ticks) * request_.tick_ns;
    ends_.trace->speed(end_ns, published_.speed_rad_s * kRpmPerRad_s);
    ends_.trace->torque(end_ns, published_.torque_Nm);
  }

  void finish(const port::PeriodicTally& tally) {
    figures_.tally = tally;
    figures_.lost_block = ends_.shared != nullptr && !ends_.shared->is_whole();
    figures_.stopped = tally.ticks < request_.ticks && !figures_.lost_block;
    figures_.speed_rad_s = published_.speed_rad_s;
    if (tally.ticks > 0) {
      figures_.mean_speed_rad_s = sums_.speed_rad_s / static_cast<double>(tally.ticks);
      figures_.mean_torque_Nm = sums_.torque_Nm / static_cast<double>(tally.ticks);
    }
    figures_.controller_seen = (inputs_.flags() & port::kControllerSeen) != 0;
    figures_.inputs_by_name = inputs_.by_name_is_used();
    figures_.fixed_is_ignored = inputs_.fixed_is_ignored();
    figures_.controller_silences = inputs_.silences();
    figures_.torn_inputs = inputs_.torn();
    figures_.intake_Pa = published_.intake_Pa;
    figures_.trapped_air_kg = published_.trapped_air_kg;
  }

  const LiveRequest& request_;
  const LiveEnds& ends_;
  LiveFigures& figures_;
  port::LiveBlock alone_;
  port::LiveBlock& block_;
  LiveEngine<Real, S> engine_;
  std::uint32_t wheels_;
  port::LockedNumbers signals_;
  port::EdgeRing ring_;
  LiveInputSources<LiveEngine<Real, S>> inputs_;
  LiveOutputs published_;
  port::LiveNumbers shown_{};
  LiveSums sums_;
  std::uint64_t ticks_per_ms_ = static_cast<std::uint64_t>(std::max<std::int64_t>(1, 1000000 / request_.tick_ns));
};

/// The engine's shape, before there are tables.
detail::EngineShape shape_of_file(const EngineFile& file) {
  const EngineDefinition& engine = file.definition();
  detail::EngineShape shape;
  shape.cylinders = static_cast<std::uint32_t>(engine.layout.cylinders);
  for (const TrainOfFile& train : file.trains()) shape.trains += train.complete() ? 1u : 0u;
  shape.wheels = static_cast<std::uint32_t>(file.triggers().size());
  return shape;
}

/// Edges in a turn of the crank.
double edges_per_turn(const TriggerWheel& wheel) {
  int edges = wheel.edge_count;
  if (wheel.pattern == TriggerPattern::teeth) {
    edges = 2 * wheel.places;
    for (int i = 0; i < wheel.gap_count; ++i) edges -= 2 * wheel.gaps[i].missing;
  }
  return wheel.shaft == TriggerShaft::cam ? edges / 2.0 : edges;
}

/// Calls `work` with a scene of this engine.
template <class Work>
auto with_live_scene(const EngineFile& file, const Work& work) {
  return breathes(file.definition()) ? work(LiveBreathing{}) : work(LiveRunning{});
}

}  // namespace

std::vector<SceneInput> live_inputs(const EngineFile& file) {
  return with_live_scene(file, [&](auto scene) { return scene_inputs<decltype(scene)>(shape_of_file(file)); });
}

std::uint32_t usual_ring_edges(const EngineDefinition& engine, std::size_t wheels, double tick_s, double lead_s) {
  if (wheels == 0) return 0;
  double turns_per_s = std::min(1 / tick_s, kMaxSpeed_rad_s * kTurnsPerRad);  // a tick turns the crank once at most
  if (engine.crank.max_speed_rad_s > 0)
    turns_per_s = std::min(turns_per_s, engine.crank.max_speed_rad_s * kTurnsPerRad);
  double edges_per_s = 0;
  for (std::size_t w = 0; w < wheels; ++w) edges_per_s += edges_per_turn(engine.triggers[w]) * turns_per_s;
  std::uint32_t depth = 16;
  while (depth < edges_per_s * (1 + lead_s) && depth < port::kMaxRingEdges) depth *= 2;
  return depth;
}

port::LiveContents live_contents(const EngineFile& file, double tick_s, std::uint32_t ring_edges) {
  port::LiveContents contents;
  const detail::EngineShape shape = shape_of_file(file);
  contents.tick_s = tick_s;
  contents.cylinders = shape.cylinders;
  contents.breathes = breathes(file.definition());
  contents.signals = with_live_scene(file, [&](auto scene) { return signal_names<double, decltype(scene)>(shape); });
  for (const SceneInput& input : live_inputs(file)) contents.inputs.push_back(input.name);
  contents.wheels = names_of_triggers(file);
  contents.ring_edges = ring_edges;
  return contents;
}

template <class Real>
void run_live(const EngineFile& file, const LiveRequest& request, const LiveEnds& ends, LiveFigures& figures) {
  with_live_scene(file, [&](auto scene) { LiveRun<Real, decltype(scene)>(file, request, ends, figures).run(); });
}

template void run_live<float>(const EngineFile&, const LiveRequest&, const LiveEnds&, LiveFigures&);
template void run_live<double>(const EngineFile&, const LiveRequest&, const LiveEnds&, LiveFigures&);

}  // namespace crankloop::program

#include "live_loop.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>

#include <crankloop/crankloop.hpp>
#include <crankloop/scenes.hpp>

#include "../../engine_file/following_springs.hpp"
#include "../../files/error.hpp"
#include "../../files/number.hpp"
#include "../../files/units.hpp"
#include "../../loops/run_limits.hpp"
#include "../../loops/valve_tick_limit.hpp"
#include "port/linux/stop_signal.hpp"
#include "port/linux/stopwatch.hpp"
#include "port/linux/watched_inputs.hpp"

namespace crankloop::program {
namespace {

using port::LiveInputs;
using port::LiveOutputs;

/// A controller may write any number: one beyond the type's range becomes infinite, which the engine refuses.
template <class Real>
Real as(double value) noexcept {
  constexpr auto kMax = static_cast<double>(std::numeric_limits<Real>::max());
  constexpr Real kInfinite = std::numeric_limits<Real>::infinity();
  if (value > kMax) return kInfinite;
  if (value < -kMax) return -kInfinite;
  return static_cast<Real>(value);
}

double crank_deg(Phase phase) noexcept {
  const double deg = static_cast<double>(phase.units()) * kDegPerUnit;
  return deg < 720 ? deg : 0;  // the last 2^10 units round up to 720
}

/// The engine at rest or turning, and its tables.
template <class Real, class S>
class FreeEngine {
 public:
  using Engine = crankloop::Engine<Real, S>;

  FreeEngine(const EngineFile& file, const LiveRequest& request)
      : cylinders_{static_cast<std::size_t>(file.definition().layout.cylinders)},
        burn_duration_deg_{request.burn_duration_deg} {
    const Status built = tables_->build(with_springs_that_follow(file.definition()), {request.tick_s});
    if (!built.ok()) throw explain_tabulate(file, built, request.tick_s, {});
    const Status ready = engine_.init(tables_->tables());
    if (!ready.ok()) throw file.explain(ready);
    require_speed(request.start_rad_s * kRpmPerRad_s, static_cast<double>(tables_->tables().drive->speed_limit_rad_s),
                  request.tick_s, file.definition().crank);
    const Status turning = engine_.restore(turning_at(engine_.state(), static_cast<Real>(request.start_rad_s)));
    if (!turning.ok()) throw file.explain(turning);
  }

  void step(const LiveInputs& in) noexcept {
    typename Engine::Input input;
    if constexpr (detail::Needs<S>::gas) {
      input.throttle_ratio = as<Real>(in.throttle_ratio);
      for (std::size_t k = 0; k < cylinders_; ++k) {
        input.fuel_kg[k] = as<Real>(in.fuel_kg);
        input.excess_air_ratio[k] = as<Real>(in.excess_air_ratio);
        input.burn_start_deg[k] = as<Real>(in.burn_start_deg);
        input.burn_duration_deg[k] = static_cast<Real>(burn_duration_deg_);
      }
    } else {
      input.load_ratio = as<Real>(in.load_ratio);
    }
    input.external_torque_Nm = as<Real>(in.external_torque_Nm);
    input.starter = in.starter;
    input.cut_cylinders = in.cut_cylinders;
    engine_.step(input);
  }

  void tell(LiveOutputs& told) const noexcept {
    const typename Engine::Output& out = engine_.output();
    told.speed_rad_s = static_cast<double>(out.speed_rad_s);
    told.acceleration_rad_s2 = static_cast<double>(out.acceleration_rad_s2);
    told.crank_deg = crank_deg(out.crank);
    told.torque_Nm = static_cast<double>(out.torque_Nm);
    told.mean_torque_Nm = static_cast<double>(out.mean_torque_Nm);
    told.friction_Nm = static_cast<double>(out.friction_Nm);
    told.starter_Nm = static_cast<double>(out.starter_Nm);
    told.faults = out.faults;
    if constexpr (detail::Needs<S>::gas) {
      told.intake_Pa = static_cast<double>(out.manifold[kIntake].pressure_Pa);
      told.trapped_air_kg = 0;
      for (std::size_t k = 0; k < cylinders_; ++k)
        told.trapped_air_kg += static_cast<double>(out.gas_cycle[k].trapped_air_kg) / static_cast<double>(cylinders_);
    }
  }

 private:
  using Tables = TableStorage<Real, S, kMaxGasSegments>;  // room for the finest gas grid there is

  std::size_t cylinders_;
  double burn_duration_deg_;
  std::unique_ptr<Tables> tables_ = std::make_unique<Tables>();
  Engine engine_;
};

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

}  // namespace

namespace {

template <class Real, class S>
void run_scene(const EngineFile& file, const LiveRequest& request, port::SharedBlock* shared, LiveFigures& figures) {
  port::LiveBlock alone;
  port::LiveBlock& block = shared != nullptr ? **shared : alone;
  const port::StopSignal stop;
  FreeEngine<Real, S> engine(file, request);
  port::WatchedInputs inputs(block.inputs, request.at_start, request.patience_ns);
  LiveOutputs published;
  double speed_sum_rad_s = 0;
  double torque_sum_Nm = 0;

  const port::RealTime real_time(request.real_time);
  if (real_time.cpu_error() != 0) {
    throw UsageError("--cpu " + std::to_string(request.real_time.cpu) + ": " + std::strerror(real_time.cpu_error()));
  }
  figures.memory_error = real_time.memory_error();
  figures.priority_error = real_time.priority_error();

  block.state.store(port::LiveState::running, std::memory_order_release);
  port::Periodic periodic(request.tick_ns);
  const ThreadCounts counts_before = ThreadCounts::now();  // after the first reading of the clock, so that its page is
                                                           // mapped
  const std::int64_t start_ns = periodic.due_ns();
  const port::PeriodicTally& tally = periodic.tally();
  const auto ticks_per_ms = static_cast<std::uint64_t>(std::max<std::int64_t>(1, 1000000 / request.tick_ns));
  const auto is_ours = [&] {
    if (shared == nullptr) return true;
    return shared->has_magic() && (tally.ticks % ticks_per_ms != 0 || shared->is_whole());
  };
  while (tally.ticks < request.ticks && !stop.received() && is_ours()) {
    figures.begin.add(periodic.begin());
    const LiveInputs in = inputs.at(periodic.begun_ns());
    const std::int64_t step_ns = port::now_ns();
    engine.step(in);
    figures.model.add(port::now_ns() - step_ns);

    published.ticks = tally.ticks + 1;
    published.time_s = static_cast<double>(published.ticks) * request.tick_s;
    engine.tell(published);
    published.flags = inputs.flags();
    published.inputs_sequence = inputs.sequence();
    published.torn_inputs = inputs.torn();
    published.late_ticks = tally.late;
    published.missed_deadlines = tally.missed;
    block.outputs.write(published);

    speed_sum_rad_s += published.speed_rad_s;
    torque_sum_Nm += published.mean_torque_Nm;
    figures.faulty_ticks += published.faults != 0 ? 1 : 0;
    figures.faults |= published.faults;
    figures.work.add(periodic.done());
  }
  const ThreadCounts counts_after = ThreadCounts::now();

  figures.tally = tally;
  figures.wall_s = static_cast<double>(port::now_ns() - start_ns) * 1e-9;
  figures.lost_block = shared != nullptr && !shared->is_whole();
  figures.stopped = tally.ticks < request.ticks && !figures.lost_block;
  figures.page_faults = counts_after.page_faults - counts_before.page_faults;
  figures.preemptions = counts_after.preemptions - counts_before.preemptions;
  figures.speed_rad_s = published.speed_rad_s;
  if (tally.ticks > 0) {
    figures.mean_speed_rad_s = speed_sum_rad_s / static_cast<double>(tally.ticks);
    figures.mean_torque_Nm = torque_sum_Nm / static_cast<double>(tally.ticks);
  }
  figures.controller_seen = (inputs.flags() & port::kControllerSeen) != 0;
  figures.controller_silences = inputs.silences();
  figures.torn_inputs = inputs.torn();
  figures.intake_Pa = published.intake_Pa;
  figures.trapped_air_kg = published.trapped_air_kg;
}

}  // namespace

template <class Real>
void run_live(const EngineFile& file, const LiveRequest& request, port::SharedBlock* shared, LiveFigures& figures) {
  if (breathes(file.definition())) {
    run_scene<Real, scenes::BreathingFree>(file, request, shared, figures);
  } else {
    run_scene<Real, scenes::FreeRunning>(file, request, shared, figures);
  }
}

template void run_live<float>(const EngineFile&, const LiveRequest&, port::SharedBlock*, LiveFigures&);
template void run_live<double>(const EngineFile&, const LiveRequest&, port::SharedBlock*, LiveFigures&);

}  // namespace crankloop::program

// The engine in real time against the machine's clock, with free crank and an optional controller.
//
// What belongs here: one run and its measurements. What does not: timing of the ticks (port/linux/periodic.hpp),
// messages and files (live.cpp).
#pragma once

#include <cstdint>

#include <crankloop/variable.hpp>

#include "../../engine_file/engine_file.hpp"
#include "../../engine_file/gas_order.hpp"
#include "../../loops/input_schedule.hpp"
#include "live_trace.hpp"
#include "port/linux/latency.hpp"
#include "port/linux/periodic.hpp"
#include "port/linux/real_time.hpp"
#include "port/linux/shared_block.hpp"

namespace crankloop::program {

struct LiveRequest {
  double tick_s = 0;
  std::int64_t tick_ns = 0;  ///< the same
  std::uint64_t ticks = 0;
  double start_rad_s = 0;
  port::LiveInputs at_start;       ///< until a controller writes inputs
  double burn_duration_deg = 0;    ///< of an engine with gas exchange; no input
  std::uint32_t wheel_faults = 0;  ///< input of that name; no input of the block's fixed part
  std::int64_t patience_ns = 0;    ///< timeout of the controller
  std::int64_t lead_ticks = 1;     ///< by which edges are due after their time in the tick
  port::RealTimeWish real_time;
};

/// Where a run's inputs come from and its outputs go to; each may be null.
struct LiveEnds {
  port::SharedBlock* shared = nullptr;
  InputSchedule* schedule = nullptr;  ///< until a controller writes inputs
  LiveTrace* trace = nullptr;
};

/// About 60 kB: do not put it on a stack.
struct LiveFigures {
  port::PeriodicTally tally;
  port::LatencyHistogram begin;  ///< delay of a tick's start: wake-up latency, and overrun of the ticks before
  port::LatencyHistogram model;  ///< the engine's step alone
  port::LatencyHistogram work;  ///< from the beginning to the end: inputs, step, outputs, and the clock's four readings
  double wall_s = 0;            ///< from the first tick's time to the last one's end
  bool stopped = false;         ///< by a signal, before the last tick
  bool lost_block = false;      ///< another process truncated or overwrote it: the run ended there

  std::int64_t page_faults = 0;  ///< in the loop, of this thread
  std::int64_t preemptions = 0;  ///< in the loop: how often the processor was taken from it
  int memory_error = 0;          ///< errno; 0: locked
  int priority_error = 0;        ///< errno; 0: as requested

  double speed_rad_s = 0;       ///< at the end
  double mean_speed_rad_s = 0;  ///< over the ticks, as the two below
  double mean_torque_Nm = 0;    ///< of gas and masses
  std::uint64_t faulty_ticks = 0;
  std::uint32_t faults = 0;        ///< all fault bits that occurred
  std::uint32_t wheel_faults = 0;  ///< bit i: fault i of the wheels was on

  double intake_Pa = 0;       ///< at the end, of an engine with gas exchange
  double trapped_air_kg = 0;  ///< likewise

  std::uint64_t edges = 0;           ///< of all trigger wheels
  std::uint64_t unlisted_edges = 0;  ///< beside them, more in a tick than a wheel has room for

  bool controller_seen = false;
  bool inputs_by_name = false;    ///< the controller wrote that section
  bool fixed_is_ignored = false;  ///< and it, or another, the fixed part too
  std::uint32_t controller_silences = 0;
  std::uint32_t torn_inputs = 0;
};

/// Builds the engine, runs it and fills `figures`, which is all zero before. Inputs come from the block and outputs go
/// there, each tick; without a block the inputs stay those of the request and the schedule. SIGINT, SIGTERM and SIGHUP
/// end the run early, and so does a block that is no longer whole: its magic is checked before each tick, its file's
/// size every millisecond and at the end. The loop allocates and prints nothing and waits only for the clock.
///
/// The definition is valid. Before the first tick, throws InputError for an engine that cannot turn freely, and
/// UsageError if the start is beyond the tick's speed limit or the requested processor is not available.
template <class Real>
void run_live(const EngineFile& file, const LiveRequest& request, const LiveEnds& ends, LiveFigures& figures);

/// The block of a run of this engine. `ring_edges` as in port::LiveContents.
[[nodiscard]] port::LiveContents live_contents(const EngineFile& file, double tick_s, std::uint32_t ring_edges);

/// What an input file of this engine may drive.
[[nodiscard]] std::vector<SceneInput> live_inputs(const EngineFile& file);

/// A ring for all its wheels at its fastest over a second and the lead, for which a player leaves edges there: a power
/// of two; 0: it has no wheel.
[[nodiscard]] std::uint32_t usual_ring_edges(const EngineDefinition& engine, std::size_t wheels, double tick_s,
                                             double lead_s);

}  // namespace crankloop::program

// The engine against the machine's clock, turned by its own torque, with a controller at its side if there is one.
//
// What belongs here: one run, and what it measures. What does not: when a tick is due (port/linux/periodic.hpp), words
// and files (live.cpp).
#pragma once

#include <cstdint>

#include "../../engine_file/engine_file.hpp"
#include "../../engine_file/gas_order.hpp"
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
  port::LiveInputs at_start;     ///< until a controller writes its own
  double burn_duration_deg = 0;  ///< of an engine with gas exchange; no input
  std::int64_t patience_ns = 0;  ///< a controller that does not write for so long has fallen silent
  port::RealTimeWish real_time;
};

/// Some 60 KB: not for a stack.
struct LiveFigures {
  port::PeriodicTally tally;
  port::LatencyHistogram
      begin;  ///< how long after it was due a tick began: wake-up, and what ticks before it left behind
  port::LatencyHistogram model;  ///< the engine's step alone
  port::LatencyHistogram work;  ///< from the beginning to the end: inputs, step, outputs, and the clock's four readings
  double wall_s = 0;            ///< from the first tick's time to the last one's end
  bool stopped = false;         ///< by a signal, before the last tick
  bool lost_block = false;      ///< another process truncated or overwrote it: the run ended there

  std::int64_t page_faults = 0;  ///< in the loop, of this thread
  std::int64_t preemptions = 0;  ///< in the loop: how often the processor was taken from it
  int memory_error = 0;          ///< errno's; 0: locked
  int priority_error = 0;        ///< errno's; 0: as wished

  double speed_rad_s = 0;       ///< at the end
  double mean_speed_rad_s = 0;  ///< over the ticks, as the two below
  double mean_torque_Nm = 0;    ///< of gas and masses
  std::uint64_t faulty_ticks = 0;
  std::uint32_t faults = 0;  ///< all fault bits that occurred

  double intake_Pa = 0;       ///< at the end, of an engine with gas exchange
  double trapped_air_kg = 0;  ///< likewise

  bool controller_seen = false;
  std::uint32_t controller_silences = 0;
  std::uint32_t torn_inputs = 0;
};

/// Builds the engine, runs it and fills `figures`, which is all zero before. Inputs come from the block and outputs go
/// there, each tick; without a block the inputs stay those of the request. SIGINT, SIGTERM and SIGHUP end the run
/// early, and so does a block that is no longer whole: its magic is looked at before each tick, its file's size every
/// millisecond and at the end. In the loop nothing is allocated, printed or waited for but the clock.
///
/// The definition is valid. Throws InputError where it is no engine that can turn freely, and UsageError where the
/// start is beyond the tick's speed limit or the processor asked for is not to be had; before the first tick, both.
template <class Real>
void run_live(const EngineFile& file, const LiveRequest& request, port::SharedBlock* shared, LiveFigures& figures);

}  // namespace crankloop::program

// The block of memory that `crankloop live` shares with a controller: inputs in; outputs, signals and edges out.
// docs/live.md has the same as a table, live_block.h in C99.
//
// What belongs here: the layout, and how a process gets hold of the block. What does not: what the engine makes of it.
// This header, those that it includes and shared_block.cpp need nothing else of crankloop: a controller may copy them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "edge_ring.hpp"
#include "live_block.h"
#include "locked_numbers.hpp"
#include "sequence_lock.hpp"

namespace crankloop::port {

/// What the controller wants. Written as a whole, each of its periods, also where nothing changed: that is its sign of
/// life. As it stands here it is the safe one: no fuel, no load, no starter, throttle closed.
struct LiveInputs {
  double load_ratio = 0;            ///< 0 = motored, 1 = the pressure diagram as it is; of an engine that has one
  double external_torque_Nm = 0;    ///< brake torque on the crankshaft, positive against forward rotation
  std::uint32_t starter = 0;        ///< not 0: engaged
  std::uint32_t cut_cylinders = 0;  ///< bit k: cylinder k, counted from 0, does not fire
  // of an engine with gas exchange
  double throttle_ratio = 0;    ///< 0 = closed, 1 = wide open
  double fuel_kg = 0;           ///< per cylinder and cycle
  double burn_start_deg = 0;    ///< after firing top dead centre
  double excess_air_ratio = 0;  ///< lambda; above 0, the air in each cylinder sets the fuel, not fuel_kg
};

/// Bits of LiveOutputs::flags.
enum LiveFlag : std::uint32_t {
  kControllerSeen = 1u << 0,    ///< inputs of a controller were used, in this tick or an earlier one
  kControllerSilent = 1u << 1,  ///< none came for too long: the safe inputs are used until one comes
};

/// What the engine did in the latest tick; numbers are those of its end.
struct LiveOutputs {
  std::uint64_t ticks = 0;  ///< done since the start; the model's time is ticks * tick_s
  double time_s = 0;
  double speed_rad_s = 0;
  double acceleration_rad_s2 = 0;
  double crank_deg = 0;                ///< 0 to below 720, from cylinder 1's firing dead centre
  double torque_Nm = 0;                ///< of gas and masses, at the tick's end
  double mean_torque_Nm = 0;           ///< the same, averaged over the tick
  double friction_Nm = 0;              ///< of friction and brake, at the tick's end
  double starter_Nm = 0;               ///< of the starter, at the tick's end
  std::uint32_t faults = 0;            ///< the engine's fault bits of the tick, docs/contract.md
  std::uint32_t flags = 0;             ///< LiveFlag
  std::uint32_t inputs_sequence = 0;   ///< of the controller's inputs that were used: the controller's write, answered
  std::uint32_t torn_inputs = 0;       ///< ticks that found inputs half written and used the last whole ones
  std::uint64_t late_ticks = 0;        ///< ticks that began a whole tick or more after their time
  std::uint64_t missed_deadlines = 0;  ///< ticks that were not done when the next one was due
  double intake_Pa = 0;                ///< in the manifold of an engine with gas exchange
  double trapped_air_kg = 0;           ///< of its cylinders' last whole cycles, mean
};

enum class LiveState : std::uint32_t { starting = 0, running = 1, ended = 2 };

/// The fixed part of the block, in the byte order and with the floating-point numbers (IEEE 754) of the machine. Words
/// not named are 0. The sections follow it.
struct alignas(64) LiveBlock {
  std::atomic<std::uint32_t> magic{0};  ///< kLiveMagic, written last: before that nothing in the block is valid
  std::uint32_t version = 0;
  std::uint32_t size_bytes = 0;
  std::atomic<LiveState> state{LiveState::starting};
  double tick_s = 0;
  std::uint32_t cylinders = 0;
  std::uint32_t breathes = 0;       ///< 1: throttle, fuel and burn start count, and the load ratio does not
  std::uint32_t section_count = 0;  ///< entries of the list
  std::uint32_t section_list = 0;   ///< offset of the list: crankloop_live_section
  alignas(64) SequenceLocked<LiveInputs> inputs;    ///< written by the controller, one only
  alignas(64) SequenceLocked<LiveOutputs> outputs;  ///< written by live
};

inline constexpr std::uint32_t kLiveMagic = CRANKLOOP_LIVE_MAGIC;
inline constexpr std::uint32_t kLiveVersion = CRANKLOOP_LIVE_VERSION;
inline constexpr std::size_t kLiveFixedBytes = CRANKLOOP_LIVE_FIXED_BYTES;
inline constexpr std::size_t kMaxRingEdges = std::size_t{1} << 22;  ///< 64 MiB

static_assert(sizeof(double) == 8 && sizeof(LiveBlock) == kLiveFixedBytes);
static_assert(offsetof(LiveBlock, version) == 4 && offsetof(LiveBlock, size_bytes) == 8 &&
              offsetof(LiveBlock, state) == 12);
static_assert(offsetof(LiveBlock, tick_s) == 16 && offsetof(LiveBlock, cylinders) == 24 &&
              offsetof(LiveBlock, breathes) == 28);
static_assert(offsetof(LiveBlock, section_count) == 32 && offsetof(LiveBlock, section_list) == 36);
static_assert(offsetof(LiveBlock, inputs) == 64 && offsetof(LiveBlock, outputs) == 128);
static_assert(sizeof(SequenceLocked<LiveInputs>) == 8 + sizeof(LiveInputs),
              "the words follow 8 bytes after the sequence number");
static_assert(offsetof(LiveInputs, external_torque_Nm) == 8 && offsetof(LiveInputs, starter) == 16 &&
              offsetof(LiveInputs, cut_cylinders) == 20);
static_assert(offsetof(LiveInputs, throttle_ratio) == 24 && offsetof(LiveInputs, fuel_kg) == 32 &&
              offsetof(LiveInputs, burn_start_deg) == 40 && offsetof(LiveInputs, excess_air_ratio) == 48);
static_assert(sizeof(LiveInputs) == 56 && sizeof(LiveOutputs) == 120);
static_assert(offsetof(LiveOutputs, time_s) == 8 && offsetof(LiveOutputs, speed_rad_s) == 16);
static_assert(offsetof(LiveOutputs, acceleration_rad_s2) == 24 && offsetof(LiveOutputs, crank_deg) == 32);
static_assert(offsetof(LiveOutputs, torque_Nm) == 40 && offsetof(LiveOutputs, mean_torque_Nm) == 48);
static_assert(offsetof(LiveOutputs, friction_Nm) == 56 && offsetof(LiveOutputs, starter_Nm) == 64);
static_assert(offsetof(LiveOutputs, faults) == 72 && offsetof(LiveOutputs, flags) == 76);
static_assert(offsetof(LiveOutputs, inputs_sequence) == 80 && offsetof(LiveOutputs, torn_inputs) == 84);
static_assert(offsetof(LiveOutputs, late_ticks) == 88 && offsetof(LiveOutputs, missed_deadlines) == 96);
static_assert(offsetof(LiveOutputs, intake_Pa) == 104 && offsetof(LiveOutputs, trapped_air_kg) == 112);

/// A block that cannot be had: one line, "PATH: why".
class SharedBlockError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The system's refusal: "PATH: cannot be created: No such file or directory".
class SharedBlockSystemError : public SharedBlockError {
 public:
  using SharedBlockError::SharedBlockError;
};

/// What a block is made for. Names of more than 47 bytes are cut.
struct LiveContents {
  double tick_s = 0;
  std::uint32_t cylinders = 0;
  bool breathes = false;
  std::vector<std::string> signals{};  ///< names of the section's numbers, at most kMaxLiveNumbers
  std::vector<std::string> inputs{};   ///< likewise
  std::vector<std::string> wheels{};
  std::uint32_t ring_edges = 0;  ///< a power of two up to kMaxRingEdges; 0: no ring
};

/// A block mapped into this process, for as long as the object lives.
///
/// Anybody who may write to the file may truncate it. Whoever touches a page that is gone gets SIGBUS: the whole block
/// then becomes memory of this process alone, all zero, and its magic is gone, which tells both sides that they have
/// lost it. Truncated within a page, the page stays, zeros in the place of what is gone: is_whole() sees that. The
/// signal's handler stays for the life of the process; a SIGBUS from elsewhere ends the process as ever.
///
/// Where the sections are is read once, checked, and kept: who overwrites the list later moves nothing.
class SharedBlock {
 public:
  /// Live's side: a new file, mode 0660 less the umask, removed at the end. A block that a killed run left behind is
  /// replaced, whole or half made; any other file at that path, and a block that another process runs on, is refused
  /// and left alone.
  [[nodiscard]] static SharedBlock create(const std::string& path, const LiveContents& contents);

  /// The controller's side: the block of a running `live`. Refused: no such file, not ready yet, another version.
  [[nodiscard]] static SharedBlock open(const std::string& path);

  SharedBlock(SharedBlock&& other) noexcept;
  SharedBlock& operator=(SharedBlock&&) = delete;
  SharedBlock(const SharedBlock&) = delete;
  SharedBlock& operator=(const SharedBlock&) = delete;

  /// The creator reports that it has ended, and removes the file.
  ~SharedBlock();

  /// Whether nobody has overwritten the block, by its first word: a load. False too of one truncated to nothing.
  [[nodiscard]] bool has_magic() const noexcept { return block_->magic.load(std::memory_order_acquire) == kLiveMagic; }
  /// And whether its file is as large as ever: a system call, which waits for nothing.
  [[nodiscard]] bool is_whole() const noexcept;

  [[nodiscard]] LiveBlock& operator*() const noexcept { return *block_; }
  [[nodiscard]] LiveBlock* operator->() const noexcept { return block_; }

  /// The sections: one writer each, the creator of signals and edges, the controller of inputs.
  [[nodiscard]] LockedNumbers signals() const noexcept { return numbers(CRANKLOOP_LIVE_SIGNALS); }
  [[nodiscard]] LockedNumbers inputs_by_name() const noexcept { return numbers(CRANKLOOP_LIVE_INPUTS); }
  [[nodiscard]] EdgeRing edges() const noexcept;  ///< to write; begins at edge 0
  /// The mapped file, for the functions of live_block.h.
  [[nodiscard]] const void* data() const noexcept { return block_; }
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

 private:
  using Section = crankloop_live_section;

  SharedBlock(std::string path, int file, std::size_t bytes, bool creator);
  [[nodiscard]] void* at(const Section& section) const noexcept;
  [[nodiscard]] const Section* find(std::uint32_t kind) const noexcept;
  [[nodiscard]] LockedNumbers numbers(std::uint32_t kind) const noexcept;

  std::string path_;
  int file_ = -1;
  std::size_t bytes_ = 0;
  bool creator_;
  LiveBlock* block_ = nullptr;
  std::vector<Section> sections_;
};

}  // namespace crankloop::port

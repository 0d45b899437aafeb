// A plugin of QEMU that counts the cycles of a Cortex-M4 (costs.hpp) which an image's steps take, each from its first
// instruction to its return.
//
//   qemu-system-arm ... -plugin step_cycles.so,listing=LISTING,root=ROOT
//
// LISTING is objdump's of the image, ROOT names the step as for worst_tick. The image calls crankloop_measures() where
// the steps to be counted begin, and again where they end; one without that function has all its steps counted until it
// ends. Then follows a line
//
//   cycles MEAN WORST MEAN_5 WORST_5 STEPS INSTRUCTIONS
//
// with mean and worst at zero wait states and at 5, how many steps there were, and the most instructions of one. Loads
// count as from flash where their address says so. What the model does not know ends the emulator with status 1.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <map>
#include <string>

#include "costs.hpp"
#include "listing.hpp"

// Of QEMU's qemu-plugin.h, which distributions do not package. Version 2 of the interface, since QEMU 9, has these
// functions as version 1 does.
extern "C" {
struct qemu_plugin_tb;
struct qemu_plugin_insn;
using Translated = void (*)(std::uint64_t id, qemu_plugin_tb* block);
using Executed = void (*)(unsigned processor, void* data);
using Accessed = void (*)(unsigned processor, std::uint32_t info, std::uint64_t address, void* data);
using Ended = void (*)(std::uint64_t id, void* data);
void qemu_plugin_register_atexit_cb(std::uint64_t id, Ended callback, void* data);
void qemu_plugin_register_vcpu_tb_trans_cb(std::uint64_t id, Translated callback);
void qemu_plugin_register_vcpu_tb_exec_cb(qemu_plugin_tb* block, Executed callback, int flags, void* data);
void qemu_plugin_register_vcpu_mem_cb(qemu_plugin_insn* insn, Accessed callback, int flags, int which, void* data);
std::size_t qemu_plugin_tb_n_insns(const qemu_plugin_tb* block);
qemu_plugin_insn* qemu_plugin_tb_get_insn(const qemu_plugin_tb* block, std::size_t index);
std::uint64_t qemu_plugin_insn_vaddr(const qemu_plugin_insn* insn);
unsigned qemu_plugin_mem_size_shift(std::uint32_t info);

[[gnu::weak]] int qemu_plugin_num_vcpus();  // since version 2

[[gnu::visibility("default")]] int qemu_plugin_version = qemu_plugin_num_vcpus != nullptr ? 2 : 1;
[[gnu::visibility("default")]] int qemu_plugin_install(std::uint64_t id, const void* info, int count, char** argument);
}

namespace worst_tick {
namespace {

constexpr std::uint64_t kRam = 0x20000000;  // Armv7-M's memory map: code below it
constexpr const char* kMeasures = "crankloop_measures";
constexpr int kNoRegisters = 0, kReads = 1;

/// Instructions that QEMU translated in one piece: all of them run, or none.
struct Piece {
  std::uint32_t begin = 0, end = 0;
  std::int64_t instructions = 0, cycles = 0, fetched = 0;
  bool steps = false, measures = false;  ///< begins a step, is crankloop_measures()
  std::string refusal;
};

struct Sum {
  std::int64_t cycles = 0, flash_words = 0, instructions = 0;
};

class Counter {
 public:
  Counter(Program program, std::string root) : program_{std::move(program)}, root_{std::move(root)} {
    measuring_ = true;
    for (const auto& [begin, function] : program_) {
      if (function.name == kMeasures) measuring_ = false;
      const auto& code = function.instructions;
      for (std::size_t i = 0; i < code.size(); ++i) {
        const bool last = i + 1 == code.size() || code[i + 1].follows_data;
        places_[code[i].address] = {&code[i], last ? nullptr : &code[i + 1]};
      }
    }
  }

  Piece* translate(const qemu_plugin_tb* block) {
    Piece piece;
    const std::size_t n = qemu_plugin_tb_n_insns(block);
    piece.begin = static_cast<std::uint32_t>(qemu_plugin_insn_vaddr(qemu_plugin_tb_get_insn(block, 0)));
    const auto function = program_.find(piece.begin);
    if (function != program_.end()) {
      piece.steps = matches(function->second.name, root_);
      piece.measures = function->second.name == kMeasures;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const auto address = static_cast<std::uint32_t>(qemu_plugin_insn_vaddr(qemu_plugin_tb_get_insn(block, i)));
      try {
        add(address, piece);
      } catch (const Refusal& refusal) {
        piece.refusal = refusal.what();
      }
    }
    pieces_.push_back(piece);
    return &pieces_.back();
  }

  void run(const Piece& piece) {
    if (stepping_) {
      if (piece.begin != end_) {
        step_.cycles += kCortexM4Refill;
        step_.flash_words += kCortexM4RefillFetches;
      }
      if (piece.begin == return_) finish_step();
    } else if (piece.steps) {
      stepping_ = true;
      return_ = end_;
      step_ = {};
    }
    if (piece.measures) toggle();
    if (stepping_) {
      if (!piece.refusal.empty()) give_up(piece.refusal);
      step_.cycles += piece.cycles;
      step_.flash_words += piece.fetched;
      step_.instructions += piece.instructions;
    }
    end_ = piece.end;
  }

  void load(std::uint64_t address, std::uint64_t size) {
    if (!stepping_) return;
    const std::uint64_t unit = size > 4 ? 4 : size;
    if (address % unit != 0) give_up("a load from " + hex(static_cast<std::uint32_t>(address)) + ", not aligned");
    if (address < kRam) step_.flash_words += static_cast<std::int64_t>((size + 3) / 4);
  }

  /// What was measured, if anything.
  void tell() const {
    if (measuring_ && steps_ > 0)
      std::fprintf(stderr, "cycles %lld %lld %lld %lld %lld %lld\n", mean(sum_), static_cast<long long>(worst_),
                   mean(sum_waiting_), static_cast<long long>(worst_waiting_), static_cast<long long>(steps_),
                   static_cast<long long>(instructions_));
  }

  [[noreturn]] static void give_up(const std::string& why) {
    std::fprintf(stderr, "step_cycles: %s\n", why.c_str());
    std::_Exit(1);
  }

 private:
  struct Place {
    const Instruction *instruction, *next;
  };

  void add(std::uint32_t address, Piece& piece) {
    ++piece.instructions;
    const auto found = places_.find(address);
    if (found == places_.end()) throw Refusal(hex(address) + ": not in the listing");
    piece.end = address + found->second.instruction->size;
    const CortexM4Time time = cortex_m4_time(*found->second.instruction, found->second.next);
    piece.cycles += time.cycles;
    piece.fetched += time.fetched;
  }

  void finish_step() {
    stepping_ = false;
    if (!measuring_) return;
    const std::int64_t waiting = step_.cycles + kCortexM4FlashWaitStates * step_.flash_words;
    ++steps_;
    sum_ += step_.cycles;
    sum_waiting_ += waiting;
    worst_ = std::max(worst_, step_.cycles);
    worst_waiting_ = std::max(worst_waiting_, waiting);
    instructions_ = std::max(instructions_, step_.instructions);
  }

  void toggle() {
    tell();
    measuring_ = !measuring_;
    steps_ = sum_ = sum_waiting_ = worst_ = worst_waiting_ = instructions_ = 0;
  }

  [[nodiscard]] long long mean(std::int64_t sum) const { return (sum + steps_ / 2) / steps_; }

  Program program_;
  std::string root_;
  std::map<std::uint32_t, Place> places_;
  std::deque<Piece> pieces_;
  bool stepping_ = false, measuring_ = false;
  std::uint32_t end_ = 0, return_ = 0;  ///< of the last piece; where the step returns to
  Sum step_;
  std::int64_t steps_ = 0, sum_ = 0, sum_waiting_ = 0, worst_ = 0, worst_waiting_ = 0, instructions_ = 0;
};

Counter* counter = nullptr;

void on_execution(unsigned, void* piece) { counter->run(*static_cast<const Piece*>(piece)); }

void on_load(unsigned, std::uint32_t info, std::uint64_t address, void*) {
  counter->load(address, std::uint64_t{1} << qemu_plugin_mem_size_shift(info));
}

void on_translation(std::uint64_t, qemu_plugin_tb* block) {
  Piece* piece = counter->translate(block);
  qemu_plugin_register_vcpu_tb_exec_cb(block, on_execution, kNoRegisters, piece);
  for (std::size_t i = 0; i < qemu_plugin_tb_n_insns(block); ++i)
    qemu_plugin_register_vcpu_mem_cb(qemu_plugin_tb_get_insn(block, i), on_load, kNoRegisters, kReads, nullptr);
}

}  // namespace
}  // namespace worst_tick

int qemu_plugin_install(std::uint64_t id, const void*, int count, char** argument) {
  std::string listing, root;
  for (int i = 0; i < count; ++i) {
    const std::string text = argument[i];
    if (text.compare(0, 8, "listing=") == 0) listing = text.substr(8);
    if (text.compare(0, 5, "root=") == 0) root = text.substr(5);
  }
  std::ifstream in(listing);
  if (!in || root.empty()) worst_tick::Counter::give_up("needs listing=FILE,root=NAME");
  worst_tick::counter = new worst_tick::Counter(worst_tick::read_listing(in), root);
  qemu_plugin_register_atexit_cb(
      id, [](std::uint64_t, void*) { worst_tick::counter->tell(); }, nullptr);
  qemu_plugin_register_vcpu_tb_trans_cb(id, worst_tick::on_translation);
  return 0;
}

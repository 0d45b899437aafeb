// The engine in real time: tables + state + input -> output, once per fixed tick.
//
// What belongs here: the declaration, all that a user's code needs. The implementation is compiled in one translation
// unit per scene (tick/step.hpp, crankloop_add_scene), so that the user's compiler flags cannot change a bit or break a
// promise.
#pragma once

#include <crankloop/build_check.hpp>
#include <crankloop/faults.hpp>
#include <crankloop/input.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/valve/valves_work.hpp>

namespace crankloop {

/// One engine. No heap, no clock, no I/O, no globals; several may run side by side, each used by one thread at a time.
///
/// Its base is what a tick remembers of the state, if the scene has elastic valves.
///
/// Invariant: either not ready (no tables, every step answers zeros and kFaultNotReady), or the tables are complete for
/// the scene and the state is finite and belongs to them.
template <class Real, class S>
class Engine : detail::ValvesWorkOf<Real, S> {
  static_assert(detail::CheckedScene<S>::value);

 public:
  using Scene = S;
  using Input = crankloop::Input<Real, S>;
  using Output = crankloop::Output<Real, S>;
  using State = crankloop::State<Real, S>;
  using Tables = crankloop::Tables<Real, S>;

  constexpr Engine() noexcept = default;

  /// Starts at rest at the given phase. The tables must outlive the engine. Refuses tables that lack a section or have
  /// more cylinders or trains than the scene, a rod inertia or gas on valve heads that the scene leaves out, and a
  /// build that contracts. O(cylinders trains).
  Status init(const Tables& tables, Phase start = Phase{}) noexcept;
  Status init(const Tables&& tables, Phase start = Phase{}) = delete;

  /// Advances by one tick. Total: any input bits give a defined, finite output and fault bits. O(cylinders), with
  /// elastic valves O(cylinders trains fine steps): bounded by the tables (docs/contract.md "Complexity and memory").
  const Output& step(const Input& input) noexcept;

  [[nodiscard]] const Output& output() const noexcept { return output_; }
  [[nodiscard]] const State& state() const noexcept { return state_; }
  [[nodiscard]] const Tables* tables() const noexcept { return tables_; }  ///< null: not ready

  /// Goes on from a snapshot, with the same bits. Refuses a state of other tables, or with a contact regime that is
  /// none. The output is that of the last step until the next. For a state that was written to bytes:
  /// tick/state/saved_state.hpp.
  Status restore(const State& state) noexcept;
  /// The same, and shows the output that belonged to it: what a cycle's end alone writes is there at once. A template,
  /// so that only a program which calls it has it.
  template <class AnOutput>
  Status restore(const State& state, const AnOutput& output) noexcept {
    const Status status = restore(state);
    if (status.ok()) output_ = output;
    return status;
  }

 private:
  const Tables* tables_ = nullptr;
  State state_{};
  Output output_{};
};

}  // namespace crankloop

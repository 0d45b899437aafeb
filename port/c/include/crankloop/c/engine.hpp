// The C interface of one engine: what each of its calls does, whatever the scene and the arithmetic are. The functions
// themselves, and the header that declares them, are made from port/c/engine_c.cpp.in and engine_c.h.in.
//
// What belongs here: checks, copies, step_many(). What does not: which inputs and outputs there are (variables.hpp),
// where tables come from, which is the Form's:
//
//     using Real, Scene
//     struct Object          what the caller's memory holds: `engine`, and
//       Object(Source)                                not live yet
//       static bool live_in(const void* memory)       whether it holds a live one
//       void set_live(bool)
//       Status find(const Tables*& tables) const      those that it was created on
//     using Source           what create() has them from
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>

#include <crankloop/c/arguments.hpp>
#include <crankloop/engine.hpp>
#include <crankloop/tick/state/saved_state.hpp>
#include <crankloop/variable_values.hpp>
#include <crankloop/variables.hpp>

namespace crankloop::c {

/// Of crankloop_add_scene: the tables are constant data, AnEngine::compiled_in().
template <class AReal, class AnEngine>
struct CompiledIn {
  using Real = AReal;
  using Scene = typename AnEngine::Scene;
  static constexpr std::size_t kTablesBytes = 0;  ///< in the caller's memory

  struct Source {};
  struct Object {
    Engine<Real, Scene> engine{};

    explicit Object(Source) noexcept {}
    [[nodiscard]] static bool live_in(const void* memory) noexcept {
      return static_cast<const Object*>(memory)->engine.tables() == &AnEngine::compiled_in();
    }
    void set_live(bool live) noexcept {
      if (!live) new (static_cast<void*>(&engine)) Engine<Real, Scene>{};
    }
    [[nodiscard]] Status find(const Tables<Real, Scene>*& tables) const noexcept {
      tables = &AnEngine::compiled_in();
      return {};
    }
  };
};

/// The variables of a scene of full capacity, as C has them: first those that the state alone knows, then the output
/// from its first variable on, up to the faults, which a step answers.
template <class Real, class S>
struct OutputInC {
  static constexpr detail::EngineShape kLargest{S::cylinders.capacity, S::trains.capacity, S::triggers.capacity, 1.0};
  /// A crank that is turned by forces has its phase in the output too: there it is left out.
  static constexpr std::size_t kFirst = detail::Needs<S>::crank_dynamics ? sizeof(Phase) : 0;

  /// Visits what the state alone knows: those variables are constant.
  template <class Visit>
  static constexpr void each_of_state(const State<Real, S>& state, Visit&& visit) {
    Output<Real, S> unused{};
    detail::each_output<S>(
        [&visit](const detail::Variable&, auto& value) {
          if constexpr (std::is_const_v<std::remove_reference_t<decltype(value)>>) visit(value);
        },
        state, unused, kLargest);
  }
};

template <class Form, class CEngine>
struct Calls {
  using Real = typename Form::Real;
  using S = typename Form::Scene;
  using Object = typename Form::Object;
  using Memory = Held<Object>;
  static_assert(sizeof(Object) <= sizeof(CEngine) && alignof(Object) <= alignof(CEngine));

  static crankloop_status create(CEngine* engine, std::size_t size, typename Form::Source source,
                                 std::uint64_t start_phase) noexcept {
    if (const Status refused = Memory::room_in(engine, size, "engine"); !refused.ok()) return as_c(refused);
    Object& made = *new (static_cast<void*>(engine)) Object(source);
    if (const Status refused = start(made, start_phase); !refused.ok()) return as_c(refused);
    made.set_live(true);
    return as_c(Status{});
  }
  static crankloop_status discard(CEngine* engine) noexcept {
    if (const Status refused = Memory::in(engine, "engine"); !refused.ok()) return as_c(refused);
    Memory::of(engine).set_live(false);
    return as_c(Status{});
  }
  static crankloop_status reset(CEngine* engine, std::uint64_t start_phase) noexcept {
    if (const Status refused = Memory::in(engine, "engine"); !refused.ok()) return as_c(refused);
    return as_c(start(Memory::of(engine), start_phase));
  }

  static crankloop_status turn_at(CEngine* engine, Real speed_rad_s) noexcept {
    if (const Status refused = in_use(engine); !refused.ok()) return as_c(refused);
    Engine<Real, S>& e = Memory::of(engine).engine;
    const Real limit_rad_s = e.tables()->drive->speed_limit_rad_s;
    if (!detail::within(speed_rad_s, -limit_rad_s, limit_rad_s))
      return as_c(refuse("speed_rad_s", Reason::out_of_range));
    return as_c(e.restore(turning_at<Real, S>(e.state(), speed_rad_s)));
  }

  template <class CInput>
  static crankloop_status input_defaults(CInput* input, std::size_t size) noexcept {
    static_assert(sizeof(CInput) == sizeof(Input<Real, S>));
    if (input == nullptr) return as_c(refuse("input", Reason::null_pointer));
    const Input<Real, S> defaults;
    Give(input, size).bytes(&defaults, sizeof defaults);
    return as_c(Status{});
  }

  template <class CInput>
  static std::uint32_t step(CEngine* engine, const CInput* input, std::size_t size) noexcept {
    Input<Real, S> in;
    if (!in_use(engine).ok() || !take(in, input, size, "input").ok()) return kFaultNotReady;
    return Memory::of(engine).engine.step(in).faults;
  }

  template <class COutput>
  static crankloop_status read(const CEngine* engine, COutput* out, std::size_t size) noexcept {
    using InC = OutputInC<Real, S>;
    constexpr std::size_t kEnd = offset_of_faults();
    constexpr std::size_t kOfState = bytes_of_state();
    static_assert((kOfState - InC::kFirst) % alignof(Output<Real, S>) == 0 &&
                      (kOfState + kEnd - InC::kFirst + alignof(COutput) - 1) / alignof(COutput) * alignof(COutput) ==
                          sizeof(COutput),
                  "variables.hpp does not list the members of Output, each in its place");
    if (const Status refused = in_use(engine); !refused.ok()) return as_c(refused);
    if (out == nullptr) return as_c(refuse("out", Reason::null_pointer));
    const Engine<Real, S>& e = Memory::of(engine).engine;
    Give give(out, size);
    InC::each_of_state(e.state(), [&give](const auto& value) { give.bytes(&value, sizeof value); });
    give.bytes(reinterpret_cast<const unsigned char*>(&e.output()) + InC::kFirst, kEnd - InC::kFirst);
    return as_c(Status{});
  }

  static crankloop_status save(const CEngine* engine, unsigned char* bytes, std::size_t size) noexcept {
    if (const Status refused = in_use(engine); !refused.ok()) return as_c(refused);
    if (bytes == nullptr) return as_c(refuse("bytes", Reason::null_pointer));
    return as_c(save_state(Memory::of(engine).engine, bytes, size));
  }
  static crankloop_status load(CEngine* engine, const unsigned char* bytes, std::size_t size) noexcept {
    if (const Status refused = in_use(engine); !refused.ok()) return as_c(refused);
    if (bytes == nullptr) return as_c(refuse("bytes", Reason::null_pointer));
    return as_c(load_state(bytes, size, Memory::of(engine).engine));
  }

  static crankloop_status step_many(CEngine* engine, std::size_t ticks, crankloop_column* columns, std::size_t count,
                                    std::uint32_t* faults) noexcept {
    if (const Status refused = in_use(engine); !refused.ok()) return as_c(refused);
    if (faults == nullptr) return as_c(refuse("faults", Reason::null_pointer));
    if (columns == nullptr && count > 0) return as_c(refuse("columns", Reason::null_pointer));
    Engine<Real, S>& e = Memory::of(engine).engine;
    Input<Real, S> in;
    for (std::size_t i = 0; i < count; ++i) {
      if (const Status refused = find(e, in, ticks, columns[i], static_cast<std::int32_t>(i)); !refused.ok())
        return as_c(refused);
    }
    *faults = 0;
    for (std::size_t tick = 0; tick < ticks; ++tick) {
      for (std::size_t i = 0; i < count; ++i) {
        const crankloop_column& column = columns[i];
        if (!column.is_input) continue;
        const double number = column.values[tick * column.stride];
        with_value(storage(column), column.at, [number](auto& value) { detail::assign(value, number); });
      }
      *faults |= e.step(in).faults;
      for (std::size_t i = 0; i < count; ++i) {
        const crankloop_column& column = columns[i];
        if (column.is_input) continue;
        double& number = column.values[tick * column.stride];
        with_value(storage(column), column.at, [&number](auto& value) { number = detail::as_number(value); });
      }
    }
    return as_c(Status{});
  }

 private:
  [[nodiscard]] static Status start(Object& object, std::uint64_t start_phase) noexcept {
    const Tables<Real, S>* tables = nullptr;
    if (const Status refused = object.find(tables); !refused.ok()) return refused;
    return object.engine.init(*tables, Phase{start_phase});
  }
  /// An engine, and under it the tables that its state belongs to.
  [[nodiscard]] static Status in_use(const CEngine* engine) noexcept {
    if (const Status refused = Memory::in(engine, "engine"); !refused.ok()) return refused;
    const Object& object = Memory::of(engine);
    const Tables<Real, S>* tables = nullptr;
    if (const Status refused = object.find(tables); !refused.ok()) return refused;
    const bool same = tables->drive->fingerprint == object.engine.state().fingerprint;
    return same ? Status{} : refuse("tables", Reason::other_tables);
  }

  [[nodiscard]] static detail::Storage storage(const crankloop_column& column) noexcept {
    return static_cast<detail::Storage>(column.storage);
  }
  /// Where the column's variable is: in the input, the output or the state.
  [[nodiscard]] static Status find(const Engine<Real, S>& e, Input<Real, S>& in, std::size_t ticks,
                                   crankloop_column& column, std::int32_t index) noexcept {
    if (column.name == nullptr) return refuse("columns.name", Reason::null_pointer, index);
    if (column.values == nullptr) return refuse("columns.values", Reason::null_pointer, index);
    const std::size_t most = static_cast<std::size_t>(-1);
    if (ticks > 0 && (column.count == 0 || (column.stride > 0 && (ticks - 1 > most / column.stride ||
                                                                  (ticks - 1) * column.stride >= column.count))))
      return refuse("columns.count", Reason::wrong_size, index);
    column.at = nullptr;
    const auto look = [&column](bool is_input) {
      return [&column, is_input](const detail::Variable& variable, auto& value) {
        using Value = std::remove_cv_t<std::remove_reference_t<decltype(value)>>;
        if (!is_named(variable, column.name)) return;
        column.at = const_cast<Value*>(&value);
        column.storage = static_cast<std::int32_t>(detail::kStorageOf<Value>);
        column.is_input = is_input;
      };
    };
    const detail::EngineShape shape = detail::shape_of<Real, S>(*e.tables());
    detail::each_input<S>(look(true), in, shape);
    detail::each_output<S>(look(false), e.state(), e.output(), shape);
    detail::each_event<S>(look(false), e.output(), shape);
    look(false)(detail::whole("faults", "Fault bits of the tick"), e.output().faults);
    return column.at != nullptr ? Status{} : refuse("columns.name", Reason::unknown_name, index);
  }

  [[nodiscard]] static constexpr std::size_t bytes_of_state() noexcept {
    std::size_t bytes = 0;
    OutputInC<Real, S>::each_of_state({}, [&bytes](const auto& value) { bytes += sizeof value; });
    return bytes;
  }
  [[nodiscard]] static constexpr std::size_t offset_of_faults() noexcept {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"
    return offsetof(CppOutput, faults);  // no base is virtual, so GCC and Clang know it
#pragma GCC diagnostic pop
  }
  using CppOutput = Output<Real, S>;
};

}  // namespace crankloop::c

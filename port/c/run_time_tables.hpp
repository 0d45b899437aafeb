// Ready-made engines of the C interface: their tables are made at run time, in the caller's memory.
#pragma once

#include <crankloop/c/engine.hpp>
#include <crankloop/scenes.hpp>
#include <crankloop/tabulate/tabulate.hpp>

#include "definition.hpp"

namespace crankloop::c {

/// A Form of c/engine.hpp.
template <class AReal, class AScene>
struct RunTimeTables {
  using Real = AReal;
  using Scene = AScene;

  struct TablesInUse {
    LiveWord live;
    TableStorage<Real, Scene> storage;
    [[nodiscard]] static bool live_in(const void* memory) noexcept { return LiveWord::in(memory); }
  };
  using HeldTables = Held<TablesInUse>;
  static constexpr std::size_t kTablesBytes = sizeof(TablesInUse);

  using Source = const void*;  ///< the caller's memory, whatever is in it
  struct Object {
    LiveWord live;
    Source source;
    Engine<Real, Scene> engine{};

    explicit Object(Source from) noexcept : source{from} {}
    [[nodiscard]] static bool live_in(const void* memory) noexcept { return LiveWord::in(memory); }
    void set_live(bool is) noexcept { live.word = is ? LiveWord::kLive : 0; }
    [[nodiscard]] Status find(const Tables<Real, Scene>*& tables) const noexcept {
      const Status status = HeldTables::in(source, "tables");
      if (status.ok()) tables = &HeldTables::of(source).storage.tables();
      return status;
    }
  };

  static crankloop_status tables_create(void* tables, std::size_t size, const crankloop_definition* definition,
                                        std::size_t definition_size, const crankloop_options* options,
                                        std::size_t options_size) noexcept {
    if (const Status refused = HeldTables::room_in(tables, size, "tables"); !refused.ok()) return as_c(refused);
    EngineDefinition engine;
    if (const Status refused = take(engine, definition, definition_size); !refused.ok()) return as_c(refused);
    if (!detail::Needs<Scene>::gas && engine.pressure.source == PressureSource::gas)
      return as_c(refuse("pressure.source", Reason::inconsistent));
    TickOptions tick;
    if (const Status refused = take(tick, options, options_size); !refused.ok()) return as_c(refused);
    auto* made = new (tables) TablesInUse;
    const Status status = made->storage.build(engine, tick);
    if (status.ok()) made->live.word = LiveWord::kLive;
    return as_c(status);
  }
  static crankloop_status tables_discard(void* tables) noexcept {
    if (const Status refused = HeldTables::in(tables, "tables"); !refused.ok()) return as_c(refused);
    HeldTables::of(tables).live.word = 0;
    return as_c(Status{});
  }
};

}  // namespace crankloop::c

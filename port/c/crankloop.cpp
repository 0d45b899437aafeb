// What all engines of the C interface share: version, definitions. Answers in words: port/c/engine_c_words.cpp.
#include <crankloop/crankloop.h>

#include <cstddef>
#include <cstdint>

#include "definition.hpp"

using namespace crankloop;

static_assert(CRANKLOOP_VERSION_MAJOR == CRANKLOOP_PROJECT_MAJOR &&
                  CRANKLOOP_VERSION_MINOR == CRANKLOOP_PROJECT_MINOR &&
                  CRANKLOOP_VERSION_PATCH == CRANKLOOP_PROJECT_PATCH,
              "version.h: the version is not the project's");

namespace {

/// Lets `change` work on the layout of the caller's definition.
template <class Change>
[[nodiscard]] crankloop_status change_layout(crankloop_definition* definition, std::size_t size,
                                             const Change& change) noexcept {
  crankloop_definition full = c::as_c(EngineDefinition{});
  if (const Status refused = c::take(full, definition, size, "definition"); !refused.ok()) return c::as_c(refused);
  crankloop_definition only_layout = c::as_c(EngineDefinition{});
  only_layout.layout = full.layout;
  EngineDefinition engine;
  if (const Status refused = c::from_c(only_layout, engine); !refused.ok()) return c::as_c(refused);
  if (const Status refused = change(engine.layout); !refused.ok()) return c::as_c(refused);
  full.layout = c::as_c(engine).layout;
  return c::as_c(c::give(definition, size, full));
}

}  // namespace

std::uint32_t crankloop_version() { return CRANKLOOP_VERSION; }

crankloop_status crankloop_definition_defaults(crankloop_definition* definition, std::size_t size) {
  return c::as_c(c::give(definition, size, c::as_c(EngineDefinition{})));
}
crankloop_status crankloop_options_defaults(crankloop_options* options, std::size_t size) {
  return c::as_c(c::give(options, size, c::as_c(TickOptions{})));
}

crankloop_status crankloop_set_firing_order(crankloop_definition* definition, std::size_t size,
                                            const std::int32_t* order, std::int32_t cylinders) {
  if (order == nullptr) return c::as_c(refuse("order", Reason::null_pointer));
  int numbers[kMaxCylinders] = {};  // where int32_t is not int
  for (int k = 0; k < cylinders && k < kMaxCylinders; ++k) numbers[k] = static_cast<int>(order[k]);
  return change_layout(definition, size,
                       [&](Layout& layout) { return set_firing_order(numbers, static_cast<int>(cylinders), layout); });
}
crankloop_status crankloop_share_pins_by_position(crankloop_definition* definition, std::size_t size) {
  return change_layout(definition, size, [](Layout& layout) { return share_pins_by_position(layout), Status{}; });
}

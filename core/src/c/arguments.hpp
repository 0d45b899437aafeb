// What every call of the C interface does with its arguments: structs of any version in and out, Status as C has it.
//
// What belongs here: sizes and pointers. What does not: what the structs mean.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <crankloop/crankloop.h>
#include <crankloop/define/engine_definition.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::c {

[[nodiscard]] inline crankloop_status as_c(const Status& status) noexcept {
  return {static_cast<std::int32_t>(status.reason), status.index, status.field};
}
[[nodiscard]] inline crankloop_status refusal(Reason reason, const char* field) noexcept { return as_c({reason, -1, field}); }

/// The caller's struct of `size` bytes over the defaults in `full`. One that is larger than ours is a newer version's: what we do not know of
/// must be zero.
template <class Struct>
[[nodiscard]] Status take(Struct& full, const Struct* from, std::size_t size, const char* name) noexcept {
  static_assert(std::is_trivially_copyable_v<Struct>);
  if (from == nullptr) return {Reason::null_pointer, -1, name};
  const auto* bytes = reinterpret_cast<const unsigned char*>(from);
  for (std::size_t i = sizeof full; i < size; ++i) {
    if (bytes[i] != 0) return {Reason::wrong_size, -1, name};
  }
  std::memcpy(&full, from, size < sizeof full ? size : sizeof full);
  return {};
}

/// As much of `full` as the caller's struct has room for; what that has beyond it is zeroed.
template <class Struct>
[[nodiscard]] Status give(Struct* to, std::size_t size, const Struct& full) noexcept {
  if (to == nullptr) return {Reason::null_pointer, -1, "out"};
  std::memcpy(to, &full, size < sizeof full ? size : sizeof full);
  if (size > sizeof full) std::memset(reinterpret_cast<unsigned char*>(to) + sizeof full, 0, size - sizeof full);
  return {};
}

/// `Object` in the caller's `Storage`: fits, and is told from memory that holds none by a first word that no memory has by chance.
template <class Object, class Storage>
struct Held {
  static_assert(sizeof(Object) <= sizeof(Storage), "crankloop.h: the storage has too few words");
  static_assert(alignof(Object) <= alignof(Storage), "crankloop.h: the storage is aligned too loosely");
  static constexpr std::uint64_t kLive = 0x6C6F'6F70'6372'616Eu;

  [[nodiscard]] static Status in(const Storage* storage, const char* name) noexcept {
    if (storage == nullptr) return {Reason::null_pointer, -1, name};
    if (reinterpret_cast<std::uintptr_t>(storage) % alignof(Object) != 0) return {Reason::misaligned, -1, name};
    if (!live(storage)) return {Reason::not_created, -1, name};
    return {};
  }
  [[nodiscard]] static Status room_in(const Storage* storage, std::size_t size, const char* name) noexcept {
    if (const Status refused = copy_in(storage, size, name); !refused.ok()) return refused;
    if (live(storage)) return {Reason::already_created, -1, name};
    return {};
  }
  /// Plain memory that is to take, or holds, a copy of an object.
  [[nodiscard]] static Status copy_in(const Storage* storage, std::size_t size, const char* name) noexcept {
    if (storage == nullptr) return {Reason::null_pointer, -1, name};
    if (reinterpret_cast<std::uintptr_t>(storage) % alignof(Object) != 0) return {Reason::misaligned, -1, name};
    if (size < sizeof(Object)) return {Reason::wrong_size, -1, name};
    return {};
  }
  /// After in() was ok.
  [[nodiscard]] static Object& of(Storage* storage) noexcept { return *reinterpret_cast<Object*>(storage); }
  [[nodiscard]] static const Object& of(const Storage* storage) noexcept { return *reinterpret_cast<const Object*>(storage); }

 private:
  [[nodiscard]] static bool live(const Storage* storage) noexcept {
    std::uint64_t word = 0;
    std::memcpy(&word, storage, sizeof word);
    return word == kLive;
  }
};

/// The definition's and the options' C form, and back; refused where an enumerator is none.
[[nodiscard]] crankloop_definition as_c(const EngineDefinition& definition) noexcept;
Status from_c(const crankloop_definition& c, EngineDefinition& definition) noexcept;
[[nodiscard]] crankloop_options as_c(const TickOptions& options) noexcept;
Status from_c(const crankloop_options& c, TickOptions& options) noexcept;

/// Both at once, of any version.
Status take(EngineDefinition& definition, const crankloop_definition* from, std::size_t size) noexcept;
Status take(TickOptions& options, const crankloop_options* from, std::size_t size) noexcept;

}  // namespace crankloop::c

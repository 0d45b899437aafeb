// What every call of the C interface does with its arguments: structs of any version in and out, objects in the
// caller's memory, Status as C has it.
//
// What belongs here: sizes and pointers. What does not: what the structs mean.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <crankloop/crankloop.h>

#include <crankloop/status.hpp>

namespace crankloop::c {

[[nodiscard]] inline crankloop_status as_c(const Status& status) noexcept {
  return {static_cast<std::int32_t>(status.reason), status.index, status.field};
}

/// The caller's struct of `size` bytes over the defaults in `full`, the struct that C++ or C has with these bytes. One
/// that is larger than ours is a newer version's: what we do not know of must be zero.
template <class Full, class Struct>
[[nodiscard]] Status take(Full& full, const Struct* from, std::size_t size, const char* name) noexcept {
  static_assert(std::is_trivially_copyable_v<Full>);
  static_assert(sizeof(Full) == sizeof(Struct) && alignof(Full) == alignof(Struct), "C has another struct than C++");
  if (from == nullptr) return refuse(name, Reason::null_pointer);
  const auto* bytes = reinterpret_cast<const unsigned char*>(from);
  for (std::size_t i = sizeof full; i < size; ++i) {
    if (bytes[i] != 0) return refuse(name, Reason::wrong_size);
  }
  std::memcpy(static_cast<void*>(&full), from, size < sizeof full ? size : sizeof full);
  return {};
}

/// Writes the caller's struct piece after piece, as much as it has room for.
class Give {
 public:
  Give(void* to, std::size_t size) noexcept : to_{static_cast<unsigned char*>(to)}, room_{size} {}
  ~Give() {
    if (room_ > 0) std::memset(to_, 0, room_);  // what a newer program's struct has beyond ours
  }
  Give(const Give&) = delete;
  Give& operator=(const Give&) = delete;

  void bytes(const void* from, std::size_t count) noexcept {
    const std::size_t fit = count < room_ ? count : room_;
    std::memcpy(to_, from, fit);
    to_ += fit;
    room_ -= fit;
  }

 private:
  unsigned char* to_;
  std::size_t room_;
};
template <class Struct>
[[nodiscard]] Status give(Struct* to, std::size_t size, const Struct& full) noexcept {
  if (to == nullptr) return refuse("out", Reason::null_pointer);
  Give(to, size).bytes(&full, sizeof full);
  return {};
}

/// Marks memory that holds an object by a word that no memory has by chance.
struct LiveWord {
  static constexpr std::uint64_t kLive = 0x6C6F'6F70'6372'616Eu;
  std::uint64_t word = 0;

  /// Of memory that may hold anything; the word is its object's first member.
  [[nodiscard]] static bool in(const void* memory) noexcept {
    std::uint64_t word = 0;
    std::memcpy(&word, memory, sizeof word);
    return word == kLive;
  }
};

/// An Object in the caller's memory. Object::live_in(memory): whether there is one.
template <class Object>
struct Held {
  [[nodiscard]] static Status in(const void* memory, const char* name) noexcept {
    if (const Status refused = address(memory, name); !refused.ok()) return refused;
    return Object::live_in(memory) ? Status{} : refuse(name, Reason::not_created);
  }
  [[nodiscard]] static Status room_in(const void* memory, std::size_t size, const char* name) noexcept {
    if (const Status refused = address(memory, name); !refused.ok()) return refused;
    if (size < sizeof(Object)) return refuse(name, Reason::wrong_size);
    return Object::live_in(memory) ? refuse(name, Reason::already_created) : Status{};
  }
  /// After in() was ok.
  [[nodiscard]] static Object& of(void* memory) noexcept { return *static_cast<Object*>(memory); }
  [[nodiscard]] static const Object& of(const void* memory) noexcept { return *static_cast<const Object*>(memory); }

 private:
  [[nodiscard]] static Status address(const void* memory, const char* name) noexcept {
    if (memory == nullptr) return refuse(name, Reason::null_pointer);
    const bool askew = reinterpret_cast<std::uintptr_t>(memory) % alignof(Object) != 0;
    return askew ? refuse(name, Reason::misaligned) : Status{};
  }
};

}  // namespace crankloop::c

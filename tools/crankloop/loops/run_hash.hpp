// The hash of every bit that comes out of a run: two machines that print the same one computed the same.
//
// What belongs here: how a run is hashed. What does not: which run (fixed_step_loop.hpp).
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

#include <crankloop/scenes.hpp>
#include <crankloop/variables.hpp>

namespace crankloop::program {

/// FNV-1a over the bytes of numbers, the least significant first, whatever the machine's order.
class BitHash {
 public:
  template <class Number>
  void add(const Number& x) noexcept {
    if constexpr (std::is_same_v<Number, Phase>) {
      add(x.units());
    } else {
      using Bits = std::conditional_t<sizeof(Number) == 4, std::uint32_t, std::uint64_t>;
      static_assert(sizeof(Number) == sizeof(Bits));
      Bits bits;
      std::memcpy(&bits, &x, sizeof bits);
      for (std::size_t i = 0; i < sizeof bits; ++i) {
        hash_ = (hash_ ^ (static_cast<std::uint64_t>(bits) & 0xFFu)) * 0x100000001B3u;
        bits = static_cast<Bits>(bits >> 8);
      }
    }
  }

  /// "0x0123456789ABCDEF"
  [[nodiscard]] std::string text() const {
    std::string digits = "0x";
    for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789ABCDEF"[hash_ >> shift & 15u];
    return digits;
  }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

/// Adds all that a tick shows of the scene `Shown`: the ready-made one of `run`, whose variables S has too.
template <class Shown, class Real, class S>
void add_tick(BitHash& hash, const Engine<Real, S>& engine, const detail::EngineShape& shape) noexcept {
  detail::each_output<Shown>([&hash](const detail::Variable&, const auto& value) { hash.add(value); }, engine.state(),
                             engine.output(), shape);
}

/// The ready-made scene of `run --free` without a controller's names, which say some of its numbers once more, and
/// without the faults of its sensors.
template <class S>
struct FreeShown : std::conditional_t<detail::Needs<S>::gas, scenes::BreathingFree, scenes::FreeRunning> {
  static constexpr bool controller_names = false;
  static constexpr bool sensor_faults = false;
};

}  // namespace crankloop::program

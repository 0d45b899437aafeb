// The value of a variable of the list (variables.hpp) as a number, and back: one double for every kind.
//
// What belongs here: how a value is kept and converted. What does not: which variables there are.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include <crankloop/phase.hpp>
#include <crankloop/tick/checked.hpp>

namespace crankloop::detail {

/// How a variable is kept.
enum class Storage : std::uint8_t { real, single_real, phase, word };

template <class Value>
inline constexpr Storage kStorageOf = std::is_same_v<Value, double>  ? Storage::real
                                      : std::is_same_v<Value, float> ? Storage::single_real
                                      : std::is_same_v<Value, Phase> ? Storage::phase
                                                                     : Storage::word;

/// Degrees of a cycle as a phase: to 2^-52 of it. What is not finite, or beyond 10^9 cycles, is 0.
[[nodiscard]] inline Phase phase_of(double crank_deg) noexcept {
  double cycles = crank_deg / kDegreesPerCycle;
  if (!within(cycles, -1e9, 1e9)) return Phase{};
  cycles -= static_cast<double>(static_cast<std::int64_t>(cycles));
  return Phase::from_cycles(cycles);
}
/// 0 to below 720.
[[nodiscard]] inline double degrees_of(Phase phase) noexcept {
  const Cell cell = phase.cell<double>();
  return static_cast<double>(cell.degree) + fraction<double>(cell);
}

/// To the scene's arithmetic; what float cannot hold is not finite, and the tick says so.
template <class Real>
[[nodiscard]] Real narrowed(double x) noexcept {
  if constexpr (sizeof(Real) == sizeof(double)) return x;
  constexpr double kLargest = static_cast<double>(std::numeric_limits<Real>::max());
  return within(x, -kLargest, kLargest) ? static_cast<Real>(x) : std::numeric_limits<Real>::quiet_NaN();
}

template <class Value>
[[nodiscard]] double as_number(const Value& value) noexcept {
  if constexpr (std::is_same_v<Value, Phase>) {
    return degrees_of(value);
  } else {
    return static_cast<double>(value);
  }
}
/// Of a whole number or truth, what a word does not hold is 0.
template <class Value>
void assign(Value& value, double number) noexcept {
  if constexpr (std::is_same_v<Value, Phase>) {
    value = phase_of(number);
  } else if constexpr (std::is_same_v<Value, std::uint32_t>) {
    value = within(number, 0.0, 4294967295.0) ? static_cast<std::uint32_t>(number) : 0;
  } else {
    value = narrowed<Value>(number);
  }
}

/// Calls visit with the value at an address, whatever it is kept as.
template <class Visit>
void with_value(Storage storage, void* at, const Visit& visit) noexcept {
  switch (storage) {
    case Storage::real:
      return visit(*static_cast<double*>(at));
    case Storage::single_real:
      return visit(*static_cast<float*>(at));
    case Storage::phase:
      return visit(*static_cast<Phase*>(at));
    case Storage::word:
      return visit(*static_cast<std::uint32_t*>(at));
  }
}

}  // namespace crankloop::detail

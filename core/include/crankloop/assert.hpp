// CRANKLOOP_ASSERT: what the code takes for granted at a place, whatever comes in; checked where a build asks for it.
//
// What belongs here: the check, and what becomes of one that fails. What does not: a user's bad input, which gets a
// Status or a fault bit, never an assertion.
//
// Off in firmware and in installed libraries, where a check costs nothing: its condition is compiled, not run. On in
// the project's tests, fuzz targets and stress trials (CMake option CRANKLOOP_ASSERTS).
#pragma once

#ifndef CRANKLOOP_ASSERTS
#define CRANKLOOP_ASSERTS 0
#endif

// One value in all of a binary, or its inline functions would not be one each: an absolute symbol that says which.
// Linkers let it stand where all its definitions are equal, and refuse two different ones.
#if defined(__ELF__) && CRANKLOOP_ASSERTS
__asm__(".globl crankloop_asserts\n.hidden crankloop_asserts\n.set crankloop_asserts, 1");
#elif defined(__ELF__)
__asm__(".globl crankloop_asserts\n.hidden crankloop_asserts\n.set crankloop_asserts, 0");
#endif

#if CRANKLOOP_ASSERTS

#include <cstdio>

namespace crankloop {

/// Told the condition that does not hold, and where. The program ends by a trap when it returns.
using AssertionHandler = void (*)(const char* condition, const char* file, int line);

namespace detail {

inline void print_assertion(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: does not hold: %s\n", file, line, condition);
}

}  // namespace detail

/// To be replaced before the first step.
inline AssertionHandler assertion_handler = detail::print_assertion;

namespace detail {

[[noreturn, gnu::cold, gnu::noinline]] inline void assertion_failed(const char* condition, const char* file, int line) {
  assertion_handler(condition, file, line);
  __builtin_trap();
}

}  // namespace detail
}  // namespace crankloop

#define CRANKLOOP_ASSERT(condition) \
  ((condition) ? static_cast<void>(0) : ::crankloop::detail::assertion_failed(#condition, __FILE__, __LINE__))

#else

#define CRANKLOOP_ASSERT(condition) static_cast<void>(sizeof(!(condition)))

#endif

namespace crankloop::detail {

/// Neither infinite nor NaN.
template <class Real>
[[nodiscard]] constexpr bool is_finite(Real x) noexcept {
  return x - x == Real{0};
}

}  // namespace crankloop::detail

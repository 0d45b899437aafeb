// Refuses builds that could not keep the promise of the same bits everywhere.
//
// What belongs here: checks of compiler settings, at compile time and, for contraction, at run time.
#pragma once

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "crankloop needs IEEE arithmetic: compile without -ffast-math and -ffinite-math-only (docs/contract.md)"
#endif

// 0: as declared; 16: the same for float and double (AArch64 with half precision).
#if defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ != 0 && __FLT_EVAL_METHOD__ != 16
#error "crankloop needs float and double arithmetic in their own precision: on 32-bit x86 add -msse2 -mfpmath=sse"
#endif

namespace crankloop {

/// True where the compiler fuses a*b - c into one rounding in the translation unit that asks.
///
/// (1 + 2^-k)^2 rounds to 1 + 2^-(k-1) when k exceeds half the precision, so a separate multiply leaves exactly 0 and a
/// fused one 2^-2k. The operands are volatile so that the answer comes from the instruction the compiler chose, not
/// from its constant folding. Always inlined: a copy that units share through the linker would answer for whichever of
/// them it came from.
template <class Real>
[[nodiscard, gnu::always_inline]] inline bool build_contracts() noexcept {
  constexpr Real small = sizeof(Real) == 4 ? static_cast<Real>(1.0 / 16384.0) : static_cast<Real>(1.0 / 1073741824.0);
  volatile Real one_and_a_bit = Real{1} + small;
  volatile Real rounded_square = Real{1} + (small + small);
  const Real a = one_and_a_bit;
  const Real c = rounded_square;
  return a * a - c != Real{0};
}

}  // namespace crankloop

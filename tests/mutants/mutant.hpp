// What tests/mutants/mutate.cpp writes into core: places that compute as they stand, but for the one whose number
// CRANKLOOP_MUTANT names. One build then has all mutants, and a run chooses. What the compiler computes itself is never
// changed, and never counts as reached.
//
//     a < b          a < mutant::change<7, mutant::Op::less_equal> < b      keeps the precedence of its operator
//     2.5            mutant::twice<7>(2.5)          in a constant's definition mutant::at_start(mutant::twice<7>, 2.5)
//     !good          mutant::no<7> ->* good
//     if (good)      if (mutant::turned<7>(good))
//     x = y;         if (mutant::kept<7>()) x = y;
#pragma once

#include <cstdio>
#include <cstdlib>

namespace mutant {

inline constexpr int kMax = 20000;
inline bool reached[kMax];
inline const int chosen = std::getenv("CRANKLOOP_MUTANT") != nullptr ? std::atoi(std::getenv("CRANKLOOP_MUTANT")) : -1;

/// A shared object has places of its own, which the tests that load it do not see: when it is unloaded it appends them
/// to the file that CRANKLOOP_MUTANT_REACH_OF_OBJECTS names.
struct WriteWhenUnloaded {
  ~WriteWhenUnloaded() {
    const char* const path = std::getenv("CRANKLOOP_MUTANT_REACH_OF_OBJECTS");
    std::FILE* const file = path != nullptr ? std::fopen(path, "a") : nullptr;
    if (file == nullptr) return;
    for (int number = 0; number < kMax; ++number) {
      if (reached[number]) std::fprintf(file, "%d\n", number);
    }
    std::fclose(file);
  }
};
inline const WriteWhenUnloaded write_when_unloaded;

inline bool reach(int number) noexcept {
  reached[number] = true;
  return number == chosen;
}
/// Whether this place is changed in this run.
template <int Number>
[[nodiscard]] constexpr bool here() noexcept {
  if (__builtin_is_constant_evaluated()) return false;
  return reach(Number);
}

enum class Op { less, less_equal, greater, greater_equal, equal, unequal, plus, minus, times, over };

template <Op Other, class A, class B>
[[nodiscard]] constexpr auto apply(const A& a, const B& b) noexcept {
  if constexpr (Other == Op::less) return a < b;
  if constexpr (Other == Op::less_equal) return a <= b;
  if constexpr (Other == Op::greater) return a > b;
  if constexpr (Other == Op::greater_equal) return a >= b;
  if constexpr (Other == Op::equal) return a == b;
  if constexpr (Other == Op::unequal) return a != b;
  if constexpr (Other == Op::plus) return a + b;
  if constexpr (Other == Op::minus) return a - b;
  if constexpr (Other == Op::times) return a * b;
  if constexpr (Other == Op::over) return a / b;
}

/// To the right of an operator the change that it may suffer, together with its left side until the right one comes.
template <int Number, Op Other>
struct Change {};
template <int Number, Op Other>
inline constexpr Change<Number, Other> change{};
template <class A, int Number, Op Other>
struct Left {
  const A& a;
};

#define MUTANT_OPERATOR(op)                                                                                           \
  template <class A, int Number, Op Other>                                                                            \
  [[nodiscard]] constexpr Left<A, Number, Other> operator op(const A& a, Change<Number, Other>) noexcept {            \
    return {a};                                                                                                       \
  }                                                                                                                   \
  template <class A, int Number, Op Other, class B>                                                                   \
  [[nodiscard]] constexpr auto operator op(Left<A, Number, Other> left, const B& b) noexcept->decltype(left.a op b) { \
    if (here<Number>()) return apply<Other>(left.a, b);                                                               \
    return left.a op b;                                                                                               \
  }
MUTANT_OPERATOR(<)
MUTANT_OPERATOR(<=)
MUTANT_OPERATOR(>)
MUTANT_OPERATOR(>=)
MUTANT_OPERATOR(==)
MUTANT_OPERATOR(!=)
MUTANT_OPERATOR(+)
MUTANT_OPERATOR(-)
MUTANT_OPERATOR(*)
MUTANT_OPERATOR(/)
#undef MUTANT_OPERATOR

template <int Number, class T>
[[nodiscard]] constexpr T one_more(T x) noexcept {
  return here<Number>() ? static_cast<T>(x + 1) : x;
}
template <int Number, class T>
[[nodiscard]] constexpr T twice(T x) noexcept {
  return here<Number>() ? static_cast<T>(x * 2) : x;
}
template <int Number, class T>
[[nodiscard]] constexpr T tenth(T x) noexcept {
  return here<Number>() ? static_cast<T>(x / 10) : x;
}
/// Of a constant's definition, computed when the program starts and not by the compiler.
template <class T>
[[nodiscard]] T at_start(T (*change)(T) noexcept, T x) noexcept {
  return change(x);
}

template <int Number>
struct No {
  template <class T>
  [[nodiscard]] constexpr bool operator->*(const T& x) const noexcept {
    return here<Number>() ? static_cast<bool>(x) : !x;
  }
};
template <int Number>
inline constexpr No<Number> no{};

template <int Number, class T>
[[nodiscard]] constexpr bool turned(const T& x) noexcept {
  return here<Number>() != static_cast<bool>(x);
}
template <int Number>
[[nodiscard]] constexpr bool kept() noexcept {
  return !here<Number>();
}

}  // namespace mutant

// Whether the list beside a struct of the definition has all of its fields, and a range for each number.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>

#include <crankloop/define/field.hpp>

namespace crankloop::detail {

/// Initialises any field; a C array takes one per entry.
struct Anything {
  template <class Field>
  constexpr operator Field() const noexcept;
};

template <class Struct, class Values, class = void>
inline constexpr bool kTakes = false;
template <class Struct, std::size_t... I>
inline constexpr bool
    kTakes<Struct, std::index_sequence<I...>, std::void_t<decltype(Struct{(void(I), Anything{})...})>> = true;

/// Number of initialisers that an aggregate takes: its fields, and every entry of its C arrays.
template <class Struct, std::size_t N = 0>
[[nodiscard]] constexpr std::size_t values_taken() noexcept {
  if constexpr (kTakes<Struct, std::make_index_sequence<N + 1>>) {
    return values_taken<Struct, N + 1>();
  } else {
    return N;
  }
}

template <class Struct>
[[nodiscard]] constexpr std::size_t values_listed() noexcept {
  std::size_t count = 0;
  const Struct example{};
  Struct::each_field(
      [&count](const ListedField&, const auto& field) {
        using Field = std::remove_reference_t<decltype(field)>;
        count += std::is_array_v<Field> ? std::extent_v<Field> : 1;
      },
      example);
  return count;
}

template <class Field>
inline constexpr bool kIsNumber = std::is_same_v<std::remove_all_extents_t<Field>, const double>;
template <std::size_t N>
inline constexpr bool kIsNumber<const std::array<double, N>> = true;

template <class Struct>
[[nodiscard]] constexpr bool bounds_every_number() noexcept {
  bool bounded = true;
  const Struct example{};
  Struct::each_field(
      [&bounded](const ListedField& listed, const auto& field) {
        if constexpr (kIsNumber<std::remove_reference_t<decltype(field)>>)
          bounded = bounded && listed.range.most < std::numeric_limits<double>::infinity();
      },
      example);
  return bounded;
}

template <class Struct>
inline constexpr bool kListsEveryField =
    values_listed<Struct>() == values_taken<Struct>() && bounds_every_number<Struct>();

}  // namespace crankloop::detail

// Conversion of a table record from double to the tick's scalar.
#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include <crankloop/tabulate/table_members.hpp>

namespace crankloop::detail {

template <class From, class To>
void round_into(const From& from, To& to) noexcept;

/// Member by member. Not by std::apply, which leaves functions of the standard library in the archive.
template <class From, class To, std::size_t... I>
void round_members(const From& from, const To& to, std::index_sequence<I...>) noexcept {
  (round_into(std::get<I>(from), std::get<I>(to)), ...);
}

/// Rounds every member; copies integers.
template <class From, class To>
void round_into(const From& from, To& to) noexcept {
  if constexpr (std::is_arithmetic_v<From>) {
    to = static_cast<To>(from);
  } else if constexpr (std::is_array_v<From>) {
    static_assert(std::extent_v<From> == std::extent_v<To>,
                  "a segment has another degree in float: it is fitted, not rounded");
    for (std::size_t i = 0; i < std::extent_v<From>; ++i) round_into(from[i], to[i]);
  } else {
    const auto members_of_from = members(from);
    round_members(members_of_from, members(to),
                  std::make_index_sequence<std::tuple_size_v<decltype(members_of_from)>>{});
  }
}

}  // namespace crankloop::detail

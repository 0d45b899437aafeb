// A record of the tables from double to the tick's scalar.
#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>

#include <crankloop/tabulate/table_members.hpp>

namespace crankloop::detail {

/// Every member rounded; integers as they are.
template <class From, class To>
void round_into(const From& from, To& to) noexcept {
  if constexpr (std::is_arithmetic_v<From>) {
    to = static_cast<To>(from);
  } else if constexpr (std::is_array_v<From>) {
    static_assert(std::extent_v<From> == std::extent_v<To>, "a segment has another degree in float: it is fitted, not rounded");
    for (std::size_t i = 0; i < std::extent_v<From>; ++i) round_into(from[i], to[i]);
  } else {
    std::apply([&to](const auto&... a) { std::apply([&](auto&... b) { (round_into(a, b), ...); }, members(to)); }, members(from));
  }
}

}  // namespace crankloop::detail

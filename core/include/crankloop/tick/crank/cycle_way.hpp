// Which angles of its own cycle a cylinder passes in a step.
//
// What belongs here: the cycle's end, dead centres, any angle. What does not: what happens there (gas/combustion.hpp,
// crank/misfire_step.hpp).
#pragma once

#include <cstdint>

#include <crankloop/phase.hpp>
#include <crankloop/tables/curve.hpp>

namespace crankloop::detail {

/// A cylinder's way in its own cycle over one step; 0 = its firing top dead centre.
struct CycleWay {
  std::uint64_t to;
  std::int64_t turned;

  [[nodiscard]] constexpr std::uint64_t from() const noexcept { return to - static_cast<std::uint64_t>(turned); }
  [[nodiscard]] constexpr bool forward() const noexcept { return turned > 0; }
  [[nodiscard]] constexpr bool passes_forward(std::uint64_t place) const noexcept {
    return turned > 0 && static_cast<std::int64_t>(to - place) >= 0 && static_cast<std::int64_t>(from() - place) < 0;
  }
  /// Over the top dead centre of gas exchange, where a cycle ends, either way: in the middle of all numbers, where the
  /// top bit changes; it changes at firing top dead centre too.
  [[nodiscard]] constexpr bool passes_end() const noexcept {
    return passes_dead_centre() && (to >> 63 != 0) == (turned > 0);
  }
  /// The one or the other.
  [[nodiscard]] constexpr bool passes_dead_centre() const noexcept {
    return static_cast<std::int64_t>(from() ^ to) < 0;
  }
  /// Whether it ends in the half of the cycle about gas exchange: 180 to 540 deg.
  [[nodiscard]] constexpr bool in_gas_exchange() const noexcept {
    constexpr std::uint64_t kQuarter = std::uint64_t{1} << 62;
    return static_cast<std::int64_t>(to - kQuarter) >= 0;
  }
  /// Of the end, from -360 to 360.
  template <class Real>
  [[nodiscard]] constexpr Real deg() const noexcept {
    return Phase{to}.template signed_cycles<Real>() * Real{kDegreesPerCycle};
  }
  template <class Real>
  [[nodiscard]] constexpr Real turned_deg() const noexcept {
    return Phase{static_cast<std::uint64_t>(turned)}.template signed_cycles<Real>() * Real{kDegreesPerCycle};
  }
};

}  // namespace crankloop::detail

// Whether the fields of a state are in their ranges.
//
// What belongs here: how a field is checked. What does not: which fields there are, and their ranges
// (state_fields.hpp).
#pragma once

#include <cstdint>
#include <limits>

#include <crankloop/phase.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tick/checked.hpp>

namespace crankloop::detail {

/// A visitor of the list of fields; status() is that of the first field out of its range.
class FieldRanges {
 public:
  [[nodiscard]] Status status() const noexcept { return status_; }

  void group(const char* name) noexcept { group_ = name; }
  template <class Real>
  void number(const Real& x, Real least, Real most) noexcept {
    if (within(x, least, most)) return;
    constexpr Real kLargest = std::numeric_limits<Real>::max();
    refuse(within(x, -kLargest, kLargest) ? Reason::out_of_range : Reason::not_finite);
  }
  template <class Base>
  void sum(const Base& x, double most) noexcept {
    if constexpr (sizeof(Base) == 8) number(x, -most, most);
    (void)x, (void)most;
  }
  void wide(const std::uint64_t&) noexcept {}
  void phase(const Phase&) noexcept {}
  void signed_wide(const std::uint64_t& x, std::uint64_t most) noexcept {
    if (x + most > 2 * most) refuse(Reason::out_of_range);  // wraps where x is negative
  }
  template <class Word>
  void word(const Word& x, std::uint32_t most) noexcept {
    if (static_cast<std::uint32_t>(x) > most) refuse(Reason::out_of_range);
  }
  template <class T>
  void spare(const T&) noexcept {}

 private:
  void refuse(Reason reason) noexcept {
    if (status_.ok()) status_ = {reason, -1, group_};
  }

  const char* group_ = "state";
  Status status_{};
};

}  // namespace crankloop::detail

// What a call that may refuse answers: fine, or which field and why.
//
// What belongs here: the answer itself. What does not: message texts with file names and lines (they belong to the
// program).
#pragma once

#include <cstdint>

namespace crankloop {

/// Why a definition, a table or a restored state was refused.
enum class Reason : std::uint8_t {
  ok = 0,
  not_finite,         ///< a NaN or an infinity
  not_positive,       ///< must be > 0
  negative,           ///< must be >= 0
  out_of_range,       ///< outside the range that the field's comment states
  rod_too_short,      ///< the rod must be longer than crank radius + |pin offset|, by a billionth of that, or the crank
                      ///< cannot turn
  inconsistent,       ///< contradicts another field
  not_a_permutation,  ///< a firing order must name every cylinder once
  too_few_points,     ///< a table needs more rows
  too_many_points,    ///< a table has more rows than there is room for
  not_increasing,     ///< table rows must be in rising order
  not_one_period,     ///< rows must span one 720 deg period (a closing row may stand at its end)
  not_a_cycle,        ///< volumes must rise, fall, rise and fall between the dead-centre volumes
  no_solution,        ///< what was asked for cannot be met
  pressure_too_high,  ///< the diagram that follows from it exceeds kMaxPressure_Pa
  missing_table,      ///< the scene needs a table that is not there
  other_tables,       ///< a state belongs to other tables
  contracting_build,  ///< the build fuses a*b+c and so could not keep its bits
  wrong_size,         ///< fewer or more bytes than it must have
  damaged,            ///< bytes that are no saved state, or not as they were written
  other_version,      ///< written by a version of the library that saves states in another form
  other_scene,        ///< a state of another scene or scalar
  // of the C interface
  null_pointer,     ///< an argument that must be there is not
  misaligned,       ///< memory at an address that its object cannot have
  not_created,      ///< memory that holds no object
  already_created,  ///< memory that holds one
  unknown_name,     ///< no input or output of the engine has this name
};

/// The answer of init, tabulate and validate. Trivially copyable; `field` points to a string literal.
///
/// A definition's fields are named as the engine file names them without unit, e.g. "crank.rod_length_m".
struct [[nodiscard]] Status {
  Reason reason = Reason::ok;
  std::int32_t index = -1;  ///< cylinder or row counted from 0; -1 where the field is not a list
  const char* field = "";

  [[nodiscard]] constexpr bool ok() const noexcept { return reason == Reason::ok; }
};

[[nodiscard]] constexpr Status refuse(const char* field, Reason reason, int index = -1) noexcept {
  return {reason, index, field};
}

/// A short English phrase for the reason, e.g. "must be greater than zero".
[[nodiscard]] const char* describe(Reason reason) noexcept;

}  // namespace crankloop

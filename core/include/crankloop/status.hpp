// The result of a call that may refuse: ok, or the field and the reason.
//
// What belongs here: field and reason. What does not: messages with file names and lines (they belong to the program).
#pragma once

#include <cstdint>

namespace crankloop {

/// Why a definition, a table or a restored state was refused.
enum class Reason : std::uint8_t {
  ok = 0,
  not_finite,         ///< a NaN or an infinity
  not_positive,       ///< must be > 0
  negative,           ///< must be >= 0
  out_of_range,       ///< outside the range that the list of fields states
  rod_too_short,      ///< the rod must be longer than crank radius + |pin offset|, by a billionth of that, or the crank
                      ///< cannot turn
  inconsistent,       ///< contradicts another field
  not_a_permutation,  ///< a firing order must name every cylinder once
  too_few_points,     ///< a table needs more rows
  too_many_points,    ///< a table has more rows than there is room for
  not_increasing,     ///< table rows must be in rising order
  not_one_period,     ///< rows must span one 720 deg period (a closing row may stand at its end)
  not_a_cycle,        ///< volumes must rise, fall, rise and fall between the dead-centre volumes
  no_solution,        ///< the requested value cannot be reached
  pressure_too_high,  ///< the diagram that follows from it exceeds kMaxPressure_Pa
  missing_table,      ///< the scene needs a table that is missing
  other_tables,       ///< a state belongs to other tables
  contracting_build,  ///< the build fuses a*b+c and so could not keep its bits
  wrong_size,         ///< fewer or more bytes than it must have
  damaged,            ///< bytes that are not a saved state, or were changed
  other_version,      ///< written by a version of the library with another format of saved states
  other_scene,        ///< a state of another scene or scalar
  // of the C interface
  null_pointer,     ///< a required argument is null
  misaligned,       ///< memory that is not aligned for its object
  not_created,      ///< memory that holds no object
  already_created,  ///< memory that holds an object already
  unknown_name,     ///< no input or output of the engine has this name
  // of definitions again; numbers keep their meaning from version to version
  too_much_heat,  ///< more heat per kilogram of mixture than any fuel releases
  unstable,       ///< would oscillate ever more from tick to tick
};

/// The result of init, tabulate and validate. Trivially copyable; `field` points to a string literal.
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

/// A short English phrase for the reason, e.g. "must be greater than zero". Defined here, so that firmware which links
/// only a scene's library has it too; firmware that does not call it contains none of its text.
[[nodiscard]] inline const char* describe(Reason reason) noexcept {
  switch (reason) {
    case Reason::ok:
      return "ok";
    case Reason::not_finite:
      return "must be a finite number";
    case Reason::not_positive:
      return "must be greater than zero";
    case Reason::negative:
      return "must not be negative";
    case Reason::out_of_range:
      return "is out of range";
    case Reason::rod_too_short:
      return "must be longer than crank radius plus pin offset, by more than a billionth of them, or the crank cannot "
             "turn";
    case Reason::inconsistent:
      return "contradicts another value";
    case Reason::not_a_permutation:
      return "must name every cylinder once";
    case Reason::too_few_points:
      return "has too few points";
    case Reason::too_many_points:
      return "has too many points";
    case Reason::not_increasing:
      return "must rise from row to row";
    case Reason::not_one_period:
      return "must span one period of 720 deg";
    case Reason::not_a_cycle:
      return "must rise, fall, rise and fall between the dead-centre volumes";
    case Reason::no_solution:
      return "cannot be met";
    case Reason::pressure_too_high:
      return "makes a cylinder pressure above 1000 bar";
    case Reason::missing_table:
      return "is missing";
    case Reason::other_tables:
      return "belongs to other tables";
    case Reason::contracting_build:
      return "fuses multiply and add: compile the scene with -ffp-contract=off";
    case Reason::wrong_size:
      return "has the wrong size";
    case Reason::damaged:
      return "is damaged";
    case Reason::other_version:
      return "is of another version";
    case Reason::other_scene:
      return "belongs to another scene or scalar";
    case Reason::null_pointer:
      return "is null";
    case Reason::misaligned:
      return "is not aligned";
    case Reason::not_created:
      return "was not created";
    case Reason::already_created:
      return "was created already";
    case Reason::unknown_name:
      return "names no input or output of this engine";
    case Reason::too_much_heat:
      return "releases more heat per kilogram of mixture than any fuel does";
    case Reason::unstable:
      return "would oscillate ever more from tick to tick: take a shorter tick or more damping";
  }
  return "unknown reason";
}

}  // namespace crankloop

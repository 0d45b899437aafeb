// The usual range of each key of the engine file, in the file's unit: a value in a wrong unit lies outside.
//
// What belongs here: the table and its reference quantities. What does not: checks of several keys (plausibility),
// permitted ranges (engine_file_key_list.hpp).
#pragma once

#include <optional>
#include <string>

#include <crankloop/tabulate/first_design.hpp>

#include "engine_file.hpp"

namespace crankloop::program {

/// Reference quantity of a range: the ratio to it is similar in engines of all sizes.
enum class Per {
  one,
  piston_speed,      ///< rpm at a mean piston speed of 1 m/s
  bore,              ///< mm
  bore2,             ///< cm^2
  bore3,             ///< cm^3
  bore5,             ///< cm^5
  stroke,            ///< mm
  stroke2,           ///< mm^2
  rod,               ///< its length in mm
  cylinder,          ///< its displacement in cm^3
  displacement,      ///< of all cylinders, in cm^3
  litre,             ///< of all cylinders
  inertia,           ///< displacement in litres to the power of 4/3
  litre_per_speed,   ///< displacement in litres / rated speed in 1000 rpm
  litre_per_speed2,  ///< displacement in litres / its square
};

struct UsualRange {
  const char* section;
  const char* key;
  Per per;
  Interval usual;
  bool zero = false;  ///< 0 means "none" and is usual too
};

/// nullptr: any value is usual.
[[nodiscard]] const UsualRange* usual_range_of(const Key& key) noexcept;

/// Sizes of the engine. A missing or unusual size has no value, so that one wrong length causes only one warning.
struct EngineSize {
  std::optional<double> bore_mm;
  std::optional<double> stroke_mm;
  std::optional<double> rod_mm;
  std::optional<double> rated_krpm;
  int cylinders = 1;

  [[nodiscard]] std::optional<double> of(Per per) const;
};

/// " for this bore"; "" if the range is the same for all engines.
[[nodiscard]] const char* in_words(Per per) noexcept;

}  // namespace crankloop::program

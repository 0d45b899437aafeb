// The usual range of each key of the engine file, in the unit of the file: what a value in another unit falls out of.
//
// What belongs here: the table, and what its ranges are measured by. What does not: what follows from several keys
// (plausibility.cpp); what is possible at all (engine_file_keys.cpp).
#pragma once

#include <optional>
#include <string>

#include <crankloop/tabulate/first_design.hpp>

#include "engine_file.hpp"

namespace crankloop::program {

/// What engines of all sizes have in common is a value by one of these.
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
  litre_per_speed,   ///< displacement in litres by rated speed in 1000 rpm
  litre_per_speed2,  ///< by its square
};

struct UsualRange {
  const char* section;
  const char* key;
  Per per;
  Interval usual;
  bool zero = false;  ///< says "none", and is usual
};

/// nullptr: any value is usual.
[[nodiscard]] const UsualRange* usual_range_of(const Key& key) noexcept;

/// What the engine has of it; nothing where its own size is missing or unusual, so that one wrong length is told once.
struct EngineSize {
  std::optional<double> bore_mm;
  std::optional<double> stroke_mm;
  std::optional<double> rod_mm;
  std::optional<double> rated_krpm;
  int cylinders = 1;

  [[nodiscard]] std::optional<double> of(Per per) const;
};

/// " for this bore"; "" where the range is one for all.
[[nodiscard]] const char* in_words(Per per) noexcept;

}  // namespace crankloop::program

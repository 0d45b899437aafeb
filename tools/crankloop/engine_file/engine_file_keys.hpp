// Every key of the engine file: one table that drives reading, checking, `show` and `help engine-file`.
//
// What belongs here: the contents of an engine file. What does not: conversion to an EngineDefinition
// (engine_file_parts.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "../files/number.hpp"

namespace crankloop::program {

enum class Kind {
  number,
  whole_number,
  numbers,       ///< 0,540,180,360
  pairs,         ///< 0:0, 0.5:0.3, 1:1: rows of a curve
  choice,        ///< one of Key::choices
  text,          ///< free text
  path,          ///< free text that names a file
  firing_order,  ///< 1-3-4-2
  pin_groups,    ///< 1-2,3-4
};

/// Conversion of a value in the file to SI: value * times / over. One of the two is 1, so that 95 mm is the double
/// nearest to 0.095 m.
struct Unit {
  const char* name = "";  ///< suffix of the key, "mm"; empty if the key has none
  double times = 1;
  double over = 1;
};

enum class Presence { required, optional, with_default };

/// One key. A row of the table: section, key, kind of value, whether it is required, when it is used, meaning.
struct Key {
  const char* section;
  const char* name;
  Kind kind;
  Unit unit;
  const char*
      field;  ///< the field of the definition that differs from it only by a unit: "crank.bore_m"; "" if there is none
  Range range;
  const char* choices;  ///< "wiebe|angle_table"; of a Kind::number, a word that may replace it: "auto"
  Presence presence;
  const char* fallback;  ///< as in a file; only Presence::with_default
  const char* only_if;   ///< "source=wiebe": with another source the key is checked, but not used; "" always
  const char* form;      ///< "rod:ends": one of two forms, of which exactly one must be given; "" no other form
  const char* meaning;
  const char* usual = "";  ///< "0.7 to 3"; only for help

  [[nodiscard]] std::string allowed() const;  ///< "above 0, at most 2000 mm"
};

/// A kind of section: [crank], or [cam NAME] where named.
struct SectionKind {
  const char* name;
  bool named;
  const char* meaning;
};

[[nodiscard]] const std::vector<SectionKind>& section_kinds();
[[nodiscard]] const SectionKind* find_section_kind(const std::string& name);

/// In the order of `show`. The table is a constant array; the vectors only point into it.
[[nodiscard]] std::vector<const Key*> keys_of(const std::string& section);
/// The keys of one form, "rod_small_end_g and rod_big_end_g": those that must be there, else those that may.
[[nodiscard]] std::string required_keys(const std::string& section, std::string_view form);
[[nodiscard]] const Key* find_key(const std::string& section, const std::string& name);

/// The key of a Status's field, or the key from which the field is computed: stroke_mm for "crank.crank_radius_m";
/// nullptr: none.
[[nodiscard]] const Key* key_of_field(std::string_view field);

/// Sections that have a key of this name: "bore_mm belongs to [crank]".
[[nodiscard]] std::vector<std::string> sections_with_key(const std::string& name);

/// The reference that `crankloop help engine-file` prints.
[[nodiscard]] std::string describe_all_keys();

}  // namespace crankloop::program

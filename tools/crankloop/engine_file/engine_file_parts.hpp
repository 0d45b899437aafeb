// Conversion of a section's values to the parts of an EngineDefinition; used only by engine_file.cpp.
//
// What belongs here: rules that need more than one key, but no other file. What does not: single keys
// (engine_file_section.cpp).
#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <crankloop/define/engine_definition.hpp>

#include "engine_file_values.hpp"

namespace crankloop::program {

/// Copies values into the fields of this part that have a key; other fields stay unchanged.
template <class Part>
void fill(const SectionValues& values, Part& part) {
  Part::each_field(
      [&values](const ListedField& listed, auto& field) {
        using Field = std::remove_reference_t<decltype(field)>;
        if constexpr (kHasFields<Field>) {
          fill(values, field);
        } else if constexpr (std::is_same_v<Field, double> || std::is_same_v<Field, int>) {
          if (const Value* value = values.of_field(listed.name); value != nullptr && !value->is_open())
            field = static_cast<Field>(value->si());
        }
      },
      part);
}

/// Throws InputError for a rod_length_mm with which the crank cannot turn, and for a rod_ratio that contradicts it.
[[nodiscard]] Crank build_crank(const SectionValues& values, const std::string& path);

[[nodiscard]] Masses build_masses(const SectionValues& values, const Crank& crank, const std::string& path);

/// Fills in, in `values` too, the spacing, bank angles, throws and shared pins that the file leaves out.
[[nodiscard]] Layout build_layout(SectionValues& values, double bore_mm, const std::string& path);

/// All but the rows of a table source.
[[nodiscard]] Pressure build_pressure(const SectionValues& values);

/// All but the ports of trains.
[[nodiscard]] Gas build_gas(const SectionValues& values, const std::string& path);
[[nodiscard]] PortOfTrain build_port(const SectionValues& valve, const std::string& path);

/// All but the rows of a table.
[[nodiscard]] Cam build_cam(const SectionValues& values, const std::string& path);
[[nodiscard]] Rocker build_rocker(const SectionValues& values);

/// All but the train whose phaser moves it and the list of edges, which is put into `edges_deg`; empty where the wheel
/// has teeth and gaps. Throws InputError for an unknown pattern.
[[nodiscard]] TriggerWheel build_trigger(const SectionValues& values, const std::string& path,
                                         std::vector<double>& edges_deg);

/// The part of build_layout() that stands in engine_file_pins.cpp: positions along the crankshaft, and pins. Needs
/// firing and bank angles.
void place_cylinders(SectionValues& values, double bore_mm, const std::string& path, Layout& layout);

/// Throws "KEY: MESSAGE" at the key's line.
[[noreturn]] void refuse(const SectionValues& values, std::string_view key, const std::string& message,
                         const std::string& path);

/// "bore_mm: 95 must be greater than zero": a refusal about a key of a section, which may have no value for it.
[[nodiscard]] std::string in_words(const SectionValues& home, const Key& key, Reason reason,
                                   const std::string& refusal);

/// A list with as many entries as there are cylinders.
[[nodiscard]] const std::vector<double>& one_per_cylinder(const SectionValues& values, std::string_view key,
                                                          const std::string& path);

/// "1 cylinder", "4 cylinders".
[[nodiscard]] std::string cylinders_text(int count);

/// An angle in degrees, 0 to below 720.
[[nodiscard]] double into_cycle_deg(double crank_deg);

/// An angle in degrees, 0 to below 360.
[[nodiscard]] double full_turn(double angle_deg);

/// Between two directions, 0 to 180 deg.
[[nodiscard]] double apart_deg(double a_deg, double b_deg);

}  // namespace crankloop::program

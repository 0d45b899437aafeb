// A study: figures of commands over one or two varied quantities of an engine.
//
// What belongs here: the request, a point and its result. What does not: options, CSV and summary (study.cpp), drawings
// (study_report.cpp), parts of many machines (command_line/shards.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../../command_line/summary.hpp"
#include "../../command_line/variation.hpp"
#include "../../report/page.hpp"
#include "../../report/sheet.hpp"

namespace crankloop::program {

inline constexpr double kMaxStudyPoints = 1e6;

/// A number that a command prints.
struct StudiedFigure {
  std::size_t command;  ///< index in Study::commands
  std::string name;     ///< "max_lift"
  std::string unit{};   ///< as printed, "mm"

  [[nodiscard]] std::string title() const;  ///< "max lift"
};

/// Numbers of the figures, in their order.
struct StudyResult {
  std::vector<std::optional<double>> values;
  std::string refused;  ///< why a number is missing; empty where none is

  [[nodiscard]] std::string text() const;  ///< of one line, for a part; parse_result() returns the same, bit for bit
};
[[nodiscard]] StudyResult parse_result(const std::string& text);

struct Study {
  const EngineFile& file;  ///< with the constant settings
  std::string text;        ///< of the engine file
  std::vector<Setting> settings;
  std::vector<Constant> options;
  std::vector<const Command*> commands;
  std::vector<StudiedFigure> figures;
  std::vector<Variation> axes{};  ///< one or two; the first varies slowest
  std::string command_line{};
  std::vector<StudyResult> results{};  ///< by point
  StudyResult own{};                   ///< of the file's own values; refused where it has none

  [[nodiscard]] std::size_t points() const;
  [[nodiscard]] std::size_t index(std::size_t point, std::size_t axis) const;  ///< of a value
  [[nodiscard]] std::string place_of(std::size_t point) const;                 ///< "rpm = 3000, crank.bore_mm = 95"
  [[nodiscard]] std::string column_of(const StudiedFigure& figure) const;      ///< "valve.max_lift_mm"
  [[nodiscard]] std::string title_of(const StudiedFigure& figure) const;       ///< "valve: max lift"
  [[nodiscard]] bool is_field() const;  ///< over a lattice of rising numbers, five or more each way
};

/// Finds the units of the figures, and the result of the file's own values. Throws InputError for a figure that its
/// command does not print, and where every point is refused.
void survey(Study& study);

/// Computes a point; may be called by several threads at once. A refusal is part of the result.
[[nodiscard]] StudyResult run_point(const Study& study, std::size_t point);

[[nodiscard]] report::Page study_page(const Study& study);
[[nodiscard]] report::Sheet study_sheet(const Study& study);

}  // namespace crankloop::program

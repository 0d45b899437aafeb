// Results of the benchmark: one row per contestant and setting, with its time and its error.
//
// What belongs here: rows and their output formats. What does not: measuring (race.hpp), contestants (the groups).
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "crankloop/files/output_file.hpp"

namespace crankloop::program::bench {

struct Row {
  std::string group;  ///< "kinematics", "valve", ...
  std::string contestant;
  std::string real;     ///< "float" or "double"
  std::string setting;  ///< "12000 rpm, 10 us"
  std::string per;      ///< what the time is of: "evaluation", "cam cycle", "tick"
  double ns_median = 0;
  double ns_spread = 0;                                     ///< between the quartiles of the rounds
  double error = std::numeric_limits<double>::quiet_NaN();  ///< largest; NaN: not measured, or the motion diverged
  std::string error_unit{};
  std::optional<double> ratio{};  ///< of a row of "ratios", whose time and error are the library's
};

/// An array of objects. NaN is null; only rows of "ratios" have "ratio".
[[nodiscard]] std::string to_json(const std::vector<Row>& rows);

/// For people: a table per group, in lines of plain text.
[[nodiscard]] std::string to_text(const std::vector<Row>& rows);

/// A line for each, below a header. Commas within a cell become semicolons. The caller finishes the Output.
void write_csv(Output& out, const std::vector<Row>& rows);

/// The row of this name, which must be there (std::logic_error).
[[nodiscard]] const Row& find(const std::vector<Row>& rows, std::string_view group, std::string_view contestant,
                              std::string_view real, std::string_view setting);

}  // namespace crankloop::program::bench

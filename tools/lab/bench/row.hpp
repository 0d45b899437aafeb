// What the benchmark says: one row per contestant and setting, its time and its error side by side.
//
// What belongs here: rows and how they are written. What does not: measuring (race.hpp), what is compared (the groups).
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
  double ns_spread = 0;  ///< between the quartiles of the rounds
  double error =
      std::numeric_limits<double>::quiet_NaN();  ///< largest; not a number: none was measured, or the motion blew up
  std::string error_unit{};
  std::optional<double> ratio{};  ///< of a row of "ratios"; its time and error are the library's
};

/// An array of objects. What is no number is null; "ratio" stands only in ratios.
[[nodiscard]] std::string to_json(const std::vector<Row>& rows);

/// For people: a table per group, in lines of plain text.
[[nodiscard]] std::string to_text(const std::vector<Row>& rows);

/// A line for each, below a header. Commas within a cell become semicolons. The caller finishes the Output.
void write_csv(Output& out, const std::vector<Row>& rows);

/// The row of this name, which must be there (std::logic_error).
[[nodiscard]] const Row& find(const std::vector<Row>& rows, std::string_view group, std::string_view contestant,
                              std::string_view real, std::string_view setting);

}  // namespace crankloop::program::bench

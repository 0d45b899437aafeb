// Two columns of numbers from a CSV file: a pressure diagram, a cam.
//
// What belongs here: rows with their line numbers. What does not: requirements of a diagram (core's validate()).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "number.hpp"

namespace crankloop::program {

inline constexpr std::size_t kMaxTableBytes = std::size_t{8} << 20;

struct TableRow {
  double at;
  double value;
  int line;
};

/// Header row and permitted numbers of a table.
struct TableFormat {
  const char* first;   ///< "crank_deg"
  const char* second;  ///< "pressure_kPa"
  Range range_first;
  Range range_second;
};

/// Rows of `first,second` under that header; blank lines and lines that start with # are skipped. At most
/// kMaxTableBytes, some 500 000 rows: a cycle every 0.0015 deg.
///
/// A file that cannot be read is reported at the line that names it (named_in:named_at), errors in it at their own
/// line. Messages do not quote its text: an engine file from an untrusted source could name a confidential file.
[[nodiscard]] std::vector<TableRow> read_table(const std::string& path, const TableFormat& format,
                                               const std::string& named_in, int named_at);

/// Of a table that the command line names.
[[nodiscard]] std::vector<TableRow> read_table(const std::string& path, const TableFormat& format);

}  // namespace crankloop::program

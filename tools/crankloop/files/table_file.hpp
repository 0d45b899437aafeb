// Two columns of numbers from a CSV file: a pressure diagram, a cam.
//
// What belongs here: rows with their line numbers. What does not: what a diagram demands of them (core's validate()).
#pragma once

#include <string>
#include <vector>

#include "number.hpp"

namespace crankloop::program {

struct TableRow {
  double at;
  double value;
  int line;
};

/// What a table's header row must say, and what its numbers may be.
struct TableFormat {
  const char* first;   ///< "crank_deg"
  const char* second;  ///< "pressure_kPa"
  Range range_first;
  Range range_second;
};

/// Rows of `first,second` under that header; blank lines and lines that start with # are skipped. At most 8 MiB, some
/// 500 000 rows: a cycle every 0.0015 deg.
///
/// A file that cannot be read is reported where it is named (named_in:named_at), what stands in it at its own line. Its
/// text is not quoted: the path comes from an engine file, which may come from anybody, and what it leads to may be
/// nobody else's business.
[[nodiscard]] std::vector<TableRow> read_table(const std::string& path, const TableFormat& format,
                                               const std::string& named_in, int named_at);

}  // namespace crankloop::program

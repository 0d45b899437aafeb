// Tables for spreadsheets and scripts: a header row, commas, points, '\n'; 12 digits for double, 9 for float cells.
//
// What belongs here: rows and cells. What does not: where they go (output.hpp) and how a number looks (number.hpp).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "output_file.hpp"

namespace crankloop::program {

/// Writes the header at once. The caller finishes the Output, after the last row.
///
///     CsvWriter csv(out, {"crank_deg", "velocity_m_s"});
///     csv.row(angle_deg, motion.velocity_m_s);
class CsvWriter {
 public:
  CsvWriter(Output& out, const std::vector<std::string>& header);

  template <class... Cells>
  void row(const Cells&... cells) {
    (cell(cells), ...);
    end_row();
  }

  /// Cell by cell, where the number of columns is only known at run time.
  void cell(double value);
  void cell(float value);
  void cell(int value);
  void cell(std::string_view text);         ///< must hold no comma, quote or line end
  void quoted_cell(std::string_view text);  ///< any text: in double quotes where it needs them
  void end_row();  ///< refuses (std::logic_error) a row that is shorter or longer than the header

 private:
  void append(std::string_view text);
  void put(std::string_view text);

  Output& out_;
  std::size_t columns_;
  std::size_t filled_ = 0;
  std::string line_;
};

}  // namespace crankloop::program

// Inputs over time from a CSV file: `run --free --inputs` and `live --inputs`.
//
//     time_s,throttle_ratio,starter,fuel_kg
//     0,0.05,1,1e-5
//     1.5,0.05,0,2e-5
//
// What belongs here: reading and checking the file, and its values at a time. What does not: which inputs a scene has
// (scene_inputs.hpp).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene_inputs.hpp"

namespace crankloop::program {

/// A column is an input by its name in the list of variables, in that list's units; without its index it is all of
/// them: fuel_kg those of all cylinders. Inputs without a column stay as they are. Real numbers are straight lines from
/// row to row, switches and whole numbers keep their value until the next row; before the first row and after the last
/// the nearest row holds.
class InputSchedule {
 public:
  /// Reads the whole file, at most 64 MiB. Throws InputError with the line and the column of the first mistake: an
  /// unknown or doubled name, a number out of its range, times that do not grow.
  InputSchedule(const std::string& path, const std::vector<SceneInput>& inputs);

  /// Overwrites the inputs that have a column; `numbers` are all of the scene's. Times must not go back. Allocates
  /// nothing; amortised O(columns).
  void at(double time_s, double* numbers) noexcept;

  /// Whether an input has a column; by its name in the file.
  [[nodiscard]] bool drives(const std::string& name) const noexcept;
  /// The same of an input of each cylinder: of all, or of one like fuel_kg[2].
  [[nodiscard]] bool drives_any(const std::string& name) const noexcept;
  /// The largest value of a column, or 0.
  [[nodiscard]] double largest(const std::string& name) const noexcept;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] std::size_t rows() const noexcept { return times_s_.size(); }
  [[nodiscard]] std::string columns() const;  ///< "throttle_ratio, starter"
  [[nodiscard]] double end_s() const noexcept { return times_s_.back(); }

 private:
  struct Column {
    std::string name;
    detail::VariableKind kind;
    Range range;
    std::vector<std::size_t> inputs;  ///< those that it drives
    std::vector<double> values;
  };

  void read_header(const std::string& text, int line, const std::vector<SceneInput>& inputs);
  void read_row(const std::string& text, int line);
  [[nodiscard]] Column column_of(const std::string& name, int place, int line,
                                 const std::vector<SceneInput>& inputs) const;
  [[noreturn]] void refuse(int line, std::size_t place, const std::string& name, const std::string& why) const;

  std::string path_;
  std::vector<Column> columns_;
  std::vector<double> times_s_;
  std::size_t row_ = 0;  ///< the last one that is not after the time asked for last
};

}  // namespace crankloop::program

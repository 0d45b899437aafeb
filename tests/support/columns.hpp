// A CSV file by its columns.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace crankloop::support {

class Columns {
 public:
  explicit Columns(const std::string& path) {
    std::ifstream file(path);
    EXPECT_TRUE(file) << path;
    std::string line;
    for (bool first = true; std::getline(file, line); first = false) {
      std::istringstream text(line);
      std::vector<std::string> cells;
      for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
      if (!first) cells.resize(names_.size());  // empty cells at the end
      if (first) names_ = cells;
      if (!first) rows_.push_back(cells);
    }
  }
  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  [[nodiscard]] const std::string& text(std::size_t row, const std::string& name) const {
    return rows_.at(row).at(place(name));
  }
  [[nodiscard]] double number(std::size_t row, const std::string& name) const { return std::stod(text(row, name)); }
  [[nodiscard]] std::vector<double> column(const std::string& name) const {
    std::vector<double> values;
    for (const auto& row : rows_) values.push_back(std::stod(row[place(name)]));
    return values;
  }

 private:
  [[nodiscard]] std::size_t place(const std::string& name) const {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i] == name) return i;
    }
    throw std::out_of_range("no column " + name);
  }

  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace crankloop::support

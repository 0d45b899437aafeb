// Which prices make the lowest bound: the linear programme behind longest_path.hpp.
//
// What belongs here: the mixture of known paths that is longest on average within the budgets on average, and the
// prices that go with it, by the simplex method (Dantzig and Wolfe, Decomposition principle for linear programs, 1960:
// a path is a column). No bound rests on its arithmetic: any prices give one.
#pragma once

#include <vector>

#include "path.hpp"

namespace worst_tick {

class Mixture {
 public:
  explicit Mixture(const std::vector<std::int64_t>& budgets);

  /// Takes in a path that was the longest at prices(). False if the mixture gains nothing: then the prices are the
  /// best.
  bool add(const Path& path);

  /// Of the budgets; none is negative.
  [[nodiscard]] Prices prices() const;

 private:
  /// A column of the programme: what it adds to the mean length, and its entries in the rows, one per budget and one
  /// for the shares' sum.
  struct Column {
    double length;
    std::vector<double> entries;
  };
  [[nodiscard]] double dual(std::size_t row) const;
  [[nodiscard]] double gain(const Column& column) const;
  void enter(const Column& column);

  std::size_t rows_;
  std::vector<std::vector<double>> inverse_;  ///< of the basis
  std::vector<double> shares_;                ///< of the basis' columns
  std::vector<double> lengths_;               ///< likewise
};

}  // namespace worst_tick

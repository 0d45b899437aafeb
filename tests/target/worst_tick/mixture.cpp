#include "mixture.hpp"

#include <cmath>

namespace worst_tick {
namespace {

constexpr double kNothing = 1e-7;

}  // namespace

/// It begins with nothing spent, and a path of no length.
Mixture::Mixture(const std::vector<std::int64_t>& budgets)
    : rows_{budgets.size() + 1}, inverse_(rows_, std::vector<double>(rows_, 0)), shares_(rows_, 1), lengths_(rows_, 0) {
  for (std::size_t row = 0; row < rows_; ++row) inverse_[row][row] = 1;
  for (std::size_t budget = 0; budget < budgets.size(); ++budget)
    shares_[budget] = static_cast<double>(budgets[budget]);
}

double Mixture::dual(std::size_t row) const {
  double sum = 0;
  for (std::size_t i = 0; i < rows_; ++i) sum += lengths_[i] * inverse_[i][row];
  return sum;
}

double Mixture::gain(const Column& column) const {
  double sum = column.length;
  for (std::size_t row = 0; row < rows_; ++row) sum -= dual(row) * column.entries[row];
  return sum;
}

/// The simplex step: the column takes the place of the one whose share it uses up first.
void Mixture::enter(const Column& column) {
  std::vector<double> change(rows_, 0);
  for (std::size_t i = 0; i < rows_; ++i) {
    for (std::size_t row = 0; row < rows_; ++row) change[i] += inverse_[i][row] * column.entries[row];
  }
  std::size_t leaves = rows_;
  for (std::size_t i = 0; i < rows_; ++i) {
    if (change[i] > kNothing && (leaves == rows_ || shares_[i] * change[leaves] < shares_[leaves] * change[i]))
      leaves = i;
  }
  if (leaves == rows_) return;
  const double share = shares_[leaves] / change[leaves];
  for (std::size_t row = 0; row < rows_; ++row) inverse_[leaves][row] /= change[leaves];
  for (std::size_t i = 0; i < rows_; ++i) {
    if (i == leaves) continue;
    shares_[i] -= share * change[i];
    for (std::size_t row = 0; row < rows_; ++row) inverse_[i][row] -= change[i] * inverse_[leaves][row];
  }
  shares_[leaves] = share;
  lengths_[leaves] = column.length;
}

bool Mixture::add(const Path& path) {
  Column column{static_cast<double>(path.length), std::vector<double>(rows_, 0)};
  for (std::size_t i = 0; i < path.spent.size(); ++i) column.entries[i] = static_cast<double>(path.spent[i]);
  column.entries[rows_ - 1] = 1;
  if (gain(column) < kNothing * column.length) return false;
  enter(column);
  // A price below zero: leaving some of that budget unspent pays.
  for (int steps = 0; steps < 100; ++steps) {
    std::size_t lowest = 0;
    for (std::size_t row = 1; row + 1 < rows_; ++row) lowest = dual(row) < dual(lowest) ? row : lowest;
    if (rows_ == 1 || dual(lowest) >= -kNothing) break;
    Column unspent{0, std::vector<double>(rows_, 0)};
    unspent.entries[lowest] = 1;
    enter(unspent);
  }
  return true;
}

Prices Mixture::prices() const {
  Prices prices;
  for (std::size_t row = 0; row + 1 < rows_; ++row) {
    prices.push_back(static_cast<std::int64_t>(std::fmax(0, std::round(dual(row) * static_cast<double>(kPriceUnit)))));
  }
  return prices;
}

}  // namespace worst_tick

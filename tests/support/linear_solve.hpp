// Linear equations by Gaussian elimination with row exchange.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace crankloop::support {

template <std::size_t N>
struct LinearSystem {
  std::array<std::array<long double, N>, N> matrix{};
  std::array<long double, N> right{};
};

/// Solves in place; the matrix must be regular.
template <std::size_t N>
[[nodiscard]] std::array<long double, N> solve(LinearSystem<N> s) {
  for (std::size_t column = 0; column < N; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < N; ++row) {
      if (std::fabs(s.matrix[row][column]) > std::fabs(s.matrix[pivot][column])) pivot = row;
    }
    std::swap(s.matrix[column], s.matrix[pivot]);
    std::swap(s.right[column], s.right[pivot]);
    for (std::size_t row = column + 1; row < N; ++row) {
      const long double factor = s.matrix[row][column] / s.matrix[column][column];
      for (std::size_t i = column; i < N; ++i) s.matrix[row][i] -= factor * s.matrix[column][i];
      s.right[row] -= factor * s.right[column];
    }
  }
  std::array<long double, N> x{};
  for (std::size_t i = N; i-- > 0;) {
    long double sum = s.right[i];
    for (std::size_t j = i + 1; j < N; ++j) sum -= s.matrix[i][j] * x[j];
    x[i] = sum / s.matrix[i][i];
  }
  return x;
}

}  // namespace crankloop::support

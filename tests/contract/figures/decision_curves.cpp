// Polynomials of a degree: how many coefficients, and through which points (docs/decisions/0003-curves.md).
//
// Errors and steps at the borders of r, r w, r w^2 or of the rod's angle; the worst of all curves of the mechanism,
// lambda 0.15 to 0.45, offset 0 and 0.2 r.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <crankloop/tabulate/mechanism.hpp>

#include "tabulate/curve_fit.hpp"

namespace {

using namespace crankloop;

struct Quality {
  double error = 0;
  double step = 0;
};

/// A polynomial of N coefficients through N nodes of every degree, coefficients and evaluation in Real.
template <class Real, std::size_t N>
class Fit {
 public:
  Fit(const Crank& crank, PoseMember quantity, double scale, const double (&nodes)[N])
      : crank_{crank}, quantity_{quantity}, scale_{scale} {
    for (std::size_t i = 0; i < N; ++i) u_[i] = 0.5 + 0.5 * nodes[i];
  }

  void measure(Quality& worst) const {
    double last = at(359, 1);
    for (int degree = 0; degree < 360; ++degree) {
      const detail::Polynomial<N> p = fitted(degree);
      worst.step = std::max(worst.step, std::fabs(value(p, 0) - last));
      last = value(p, 1);
      for (int i = 0; i <= 50; ++i) {
        const double u = i / 50.0;
        worst.error = std::max(worst.error, std::fabs(value(p, u) - exact(degree + u)));
      }
    }
  }

 private:
  [[nodiscard]] double exact(double deg) const {
    return exact_pose(crank_, deg * detail::kRadPerDegree).*quantity_ / scale_;
  }
  [[nodiscard]] detail::Polynomial<N> fitted(int degree) const {
    double y[N];
    for (std::size_t i = 0; i < N; ++i) y[i] = exact(degree + u_[i]);
    return detail::through(u_, y);
  }
  [[nodiscard]] static double value(const detail::Polynomial<N>& p, double u) {
    Real sum = static_cast<Real>(p.c[N - 1]);
    for (std::size_t i = N - 1; i-- > 0;) sum = static_cast<Real>(p.c[i]) + static_cast<Real>(u) * sum;
    return static_cast<double>(sum);
  }
  [[nodiscard]] double at(int degree, double u) const { return value(fitted(degree), u); }

  Crank crank_;
  PoseMember quantity_;
  double scale_;
  double u_[N] = {};
};

template <class Real, std::size_t N>
void report(const char* what, const double (&nodes)[N]) {
  Quality worst;
  for (const double lambda : {0.15, 0.2738, 0.32, 0.45}) {
    for (const double offset_ratio : {0.0, 0.2}) {
      const Crank crank{0.095, 0.0575, 0.0575 / lambda, offset_ratio * 0.0575, 19};
      for (const PoseMember length : {&Pose<double>::slope_m, &Pose<double>::acceleration_m}) {
        Fit<Real, N>(crank, length, crank.crank_radius_m, nodes).measure(worst);
      }
      for (const PoseMember ratio :
           {&Pose<double>::rod_tilt, &Pose<double>::radial, &Pose<double>::rod_slope, &Pose<double>::rod_curvature}) {
        Fit<Real, N>(crank, ratio, 1, nodes).measure(worst);
      }
    }
  }
  std::printf("| %s | %zu | %.1e | %.1e |\n", what, 360 * N * sizeof(Real), worst.error, worst.step);
}

}  // namespace

int main() {
  constexpr double kEnds[] = {-1, 1};
  constexpr double kLine[] = {-0.70710678118654752, 0.70710678118654752};
  constexpr double kChebyshev3[] = {-0.86602540378443865, 0, 0.86602540378443865};
  constexpr double kThroughEnds[] = {-1, 0, 1};
  std::printf("| curve of one degree | bytes | largest error | largest step |\n| --- | --- | --- | --- |\n");
  report<float>("float, line through the ends", kEnds);
  report<float>("float, line, Chebyshev nodes", kLine);
  report<double>("quadratic before rounding, Chebyshev nodes +-0.866", kChebyshev3);
  report<double>("quadratic before rounding, nodes +-0.922", detail::Nodes<float>::at);
  report<double>("quadratic before rounding, through the ends", kThroughEnds);
  report<float>("float, quadratic, Chebyshev nodes +-0.866", kChebyshev3);
  report<float>("float, quadratic, nodes +-0.922: the library's", detail::Nodes<float>::at);
  report<float>("float, quadratic, through the ends", kThroughEnds);
  report<float>("float, cubic, Chebyshev nodes", detail::Nodes<double>::at);
  report<double>("double, cubic, Chebyshev nodes: the library's", detail::Nodes<double>::at);
  return 0;
}

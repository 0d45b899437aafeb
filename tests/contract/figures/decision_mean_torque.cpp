// Torque over a tick as a difference of work: against sampling, with integer and with float bases, and where it stops
// being the better way (docs/decisions/0005-mean-torque.md, 0003-curves.md). Errors are of the engine's largest torque.
//
//     decision_mean_torque ENGINE_FILE
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <type_traits>
#include <vector>

#include <crankloop/tabulate/summary.hpp>
#include <crankloop/tabulate/tabulate.hpp>

#include "crankloop/engine_file/engine_file.hpp"
#include "support/units.hpp"
#include "tabulate/quadrature.hpp"

namespace {

using namespace crankloop;
using namespace crankloop::detail;

using crankloop::support::kRadPerDeg;

/// Gas torque of cylinder 1 by the library's tables, at steady speed 0: what one cylinder's work counts.
template <class Real>
class GasWork {
 public:
  explicit GasWork(const EngineDefinition& engine) : segments_(kMaxGasSegments) {
    TableTargets<Real> targets;
    targets.torque_grid = &grid_;
    targets.gas_capacity = static_cast<int>(kMaxGasSegments);
    targets.gas_torque_full = &curve_;
    targets.gas_full = segments_.data();
    EngineDefinition one = engine;  // the tables are those of all cylinders
    one.layout.cylinders = 1;
    if (!tabulate(one, {}, targets).ok()) std::exit(1);
  }

  [[nodiscard]] Real torque_Nm(Phase phase) const {
    const auto [segment, u] = at(phase);
    return value(segment.slope, u);
  }
  [[nodiscard]] Integral<Real> work(Phase phase) const {
    const auto [segment, u] = at(phase);
    return {segment.base, integral(segment.slope, u, curve_.mean_Nm)};
  }
  /// Difference of the bases first, as the library does it.
  [[nodiscard]] double mean_Nm(Phase from, Phase to) const {
    return per_angle(difference(work(from), work(to), curve_.quantum), to - from);
  }
  /// Each work as one number, then their difference.
  [[nodiscard]] double mean_by_plain_difference_Nm(Phase from, Phase to) const {
    const auto whole = [this](const Integral<Real>& w) { return signed_value<Real>(w.base) * curve_.quantum + w.part; };
    return per_angle(whole(work(to)) - whole(work(from)), to - from);
  }
  [[nodiscard]] double mean_of_ends_Nm(Phase from, Phase to) const {
    return static_cast<double>((torque_Nm(from) + torque_Nm(to)) / 2);
  }

 private:
  struct At {
    const IntegratedSegment<Real>& segment;
    Real u;
  };
  [[nodiscard]] At at(Phase phase) const {
    const Cell cell = phase.cell<Real>();
    return {segments_[grid_.segment(cell)], fraction<Real>(cell)};
  }
  [[nodiscard]] double per_angle(Real work_J, Phase turned) const {
    const Real angle_rad = turned.signed_cycles<Real>() * static_cast<Real>(0x1.921fb54442d18p+3);
    return static_cast<double>(work_J / angle_rad + curve_.mean_Nm);
  }

  GasGrid grid_{};
  GasTorque<Real> curve_{};
  std::vector<IntegratedSegment<Real>> segments_;
};

/// Exact gas torque of cylinder 1.
class Exact {
 public:
  explicit Exact(const EngineDefinition& definition) {
    if (!engine_.init(definition).ok()) std::exit(1);
    for (int i = 0; i < 7200; ++i) largest_Nm_ = std::max(largest_Nm_, std::fabs(torque_Nm(i / 10.0)));
  }
  [[nodiscard]] double torque_Nm(double deg) const { return engine_.forces(0, deg, 0).torque_Nm; }
  [[nodiscard]] double mean_Nm(double from_deg, double to_deg) const {
    const int panels = 1 + static_cast<int>((to_deg - from_deg) * 10);
    return detail::integrate(from_deg, to_deg, panels, [this](double deg) { return torque_Nm(deg); }) /
           (to_deg - from_deg);
  }
  [[nodiscard]] double largest_Nm() const { return largest_Nm_; }
  [[nodiscard]] const ExactEngine& engine() const { return engine_; }

 private:
  ExactEngine engine_;
  double largest_Nm_ = 0;
};

[[nodiscard]] double deg_of(Phase phase) {
  return static_cast<double>(phase.units()) * (720.0 / 18446744073709551616.0);
}

/// Mean torque of the whole engine over one cycle from torques sampled every `step_deg`, wherever the first sample
/// falls: the worst.
void compare_with_sampling(const Exact& exact, double speed_rad_s, double step_deg, const char* tick) {
  const double mean = summarise(exact.engine(), speed_rad_s).mean_torque_Nm;
  const int samples = static_cast<int>(720 / step_deg + 0.5);
  double worst = 0;
  for (int start = 0; start < 100; ++start) {
    double sum = 0;
    for (int i = 0; i < samples; ++i) sum += exact.engine().torque_Nm((start / 100.0 + i) * step_deg, speed_rad_s);
    worst = std::max(worst, std::fabs(sum / samples - mean) / mean);
  }
  std::printf("torque sampled at %s: its mean over a cycle is off by up to %.2g %%\n", tick, 100 * worst);
}

template <class Real>
void compare_over_angles(const EngineDefinition& definition, const Exact& exact, const char* real) {
  const auto gas = std::make_unique<GasWork<Real>>(definition);
  std::printf(
      "\n| %s, degrees turned in a tick | difference of work | plain difference | mean of both ends | torque at the "
      "end |\n"
      "| --- | --- | --- | --- | --- |\n",
      real);
  for (const int log2_deg : {1, 0, -2, -3, -4, -5, -6, -8, -12, -16, -20, -24}) {
    if (sizeof(Real) == 4 && log2_deg < -12) continue;
    const double turned_deg = std::ldexp(1.0, log2_deg);
    const Phase turned = Phase::from_cycles(turned_deg / 720);
    double by_work = 0;
    double by_plain = 0;
    double by_ends = 0;
    double at_end = 0;
    for (int i = 0; i < 2000; ++i) {
      const Phase from{static_cast<std::uint64_t>(i) * (~std::uint64_t{0} / 2000)};
      const double from_deg = deg_of(from);
      const double want = exact.mean_Nm(from_deg, from_deg + turned_deg);
      by_work = std::max(by_work, std::fabs(gas->mean_Nm(from, from + turned) - want));
      by_plain = std::max(by_plain, std::fabs(gas->mean_by_plain_difference_Nm(from, from + turned) - want));
      by_ends = std::max(by_ends, std::fabs(gas->mean_of_ends_Nm(from, from + turned) - want));
      at_end = std::max(at_end, std::fabs(static_cast<double>(gas->torque_Nm(from + turned)) - want));
    }
    const double scale = exact.largest_Nm();
    std::printf("| %g | %.1e | %.1e | %.1e | %.1e |\n", turned_deg, by_work / scale, by_plain / scale, by_ends / scale,
                at_end / scale);
  }
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) return 2;
  const auto file = program::read_engine_file(words[1], {"crank", "masses"});
  const Exact exact(file.definition());
  compare_with_sampling(exact, 6000 * 6 * kRadPerDeg, 36, "1 ms, 6000 rpm");
  compare_with_sampling(exact, 3000 * 6 * kRadPerDeg, 18, "1 ms, 3000 rpm");
  compare_with_sampling(exact, 2000 * 6 * kRadPerDeg, 1.2, "100 us, 2000 rpm");
  compare_over_angles<float>(file.definition(), exact, "float");
  compare_over_angles<double>(file.definition(), exact, "double");
  return 0;
}

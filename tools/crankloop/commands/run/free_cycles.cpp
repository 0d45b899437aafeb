#include "free_cycles.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../files/units.hpp"
#include "../../loops/harmonics.hpp"

namespace crankloop::program {
namespace {

constexpr double kDegPerSample = 720.0 / kSamplesPerCycle;

/// The cubic over s from 0 to 1 with given values and slopes at both ends.
double cubic(double begin, double end, double slope_begin, double slope_end, double s) {
  const double t = 1 - s;
  return t * t * ((1 + 2 * s) * begin + s * slope_begin) + s * s * ((1 + 2 * t) * end - t * slope_end);
}

/// A tick of the crank, at any part of it.
class Within {
 public:
  Within(const FreeState& before, const FreeState& after)
      : a_{before}, b_{after}, tick_s_{after.time_s - before.time_s} {}

  [[nodiscard]] double angle_deg(double s) const {
    const double scale = tick_s_ * 180 / kPi;
    return cubic(a_.angle_deg, b_.angle_deg, a_.speed_rad_s * scale, b_.speed_rad_s * scale, s);
  }
  /// The part of the tick after which it has reached an angle, turning forward.
  [[nodiscard]] double part_at(double angle_deg_wanted) const {
    double low = 0;
    double high = 1;
    for (int i = 0; i < 52; ++i) {
      const double middle = (low + high) / 2;
      (angle_deg(middle) < angle_deg_wanted ? low : high) = middle;
    }
    return high;
  }
  [[nodiscard]] FreeState at(double s) const {
    FreeState state;
    state.time_s = a_.time_s + s * tick_s_;
    state.angle_deg = angle_deg(s);
    state.speed_rad_s =
        cubic(a_.speed_rad_s, b_.speed_rad_s, a_.acceleration_rad_s2 * tick_s_, b_.acceleration_rad_s2 * tick_s_, s);
    state.torque_Nm = a_.torque_Nm + (b_.torque_Nm - a_.torque_Nm) * s;
    state.work_J = cubic(a_.work_J, b_.work_J, a_.torque_Nm * a_.speed_rad_s * tick_s_,
                         b_.torque_Nm * b_.speed_rad_s * tick_s_, s);
    state.external_J = a_.external_J + (b_.external_J - a_.external_J) * s;
    return state;
  }

 private:
  const FreeState& a_;
  const FreeState& b_;
  double tick_s_;
};

}  // namespace

double FreeCycle::mean_speed_rad_s() const { return kCycle_rad / (samples.back().time_s - samples.front().time_s); }

double FreeCycle::largest_speed_rad_s() const {
  double largest = samples.front().speed_rad_s;
  for (const FreeState& sample : samples) largest = std::max(largest, sample.speed_rad_s);
  return largest;
}

double FreeCycle::smallest_speed_rad_s() const {
  double smallest = samples.front().speed_rad_s;
  for (const FreeState& sample : samples) smallest = std::min(smallest, sample.speed_rad_s);
  return smallest;
}

double FreeCycle::irregularity_ratio() const {
  return (largest_speed_rad_s() - smallest_speed_rad_s()) / mean_speed_rad_s();
}

double FreeCycle::mean_torque_Nm() const { return (samples.back().work_J - samples.front().work_J) / kCycle_rad; }

double FreeCycle::external_torque_Nm() const {
  return (samples.back().external_J - samples.front().external_J) / kCycle_rad;
}

std::vector<double> FreeCycle::harmonics_rad_s() const {
  // A speed that drifts over the cycle is no harmonic: the straight line through both ends is taken off.
  const double drift = samples.back().speed_rad_s - samples.front().speed_rad_s;
  std::vector<double> speeds;
  for (std::size_t i = 0; i < kSamplesPerCycle; ++i)
    speeds.push_back(samples[i].speed_rad_s - drift * static_cast<double>(i) / kSamplesPerCycle);
  return harmonic_amplitudes(speeds, kSpeedHarmonics);
}

void CycleRecorder::begin(const FreeState& at) {
  recording_ = true;
  now_ = FreeCycle{};
  now_.samples.reserve(kSamplesPerCycle + 1);
  now_.samples.push_back(at);
  now_.edges.resize(level_.size());
  now_.levels = level_;
}

void CycleRecorder::edge(std::size_t wheel, double ratio, bool level) { new_edges_.push_back({wheel, ratio, level}); }

void CycleRecorder::take(const FreeState& before, const FreeState& after) {
  std::stable_sort(new_edges_.begin(), new_edges_.end(),
                   [](const NewEdge& a, const NewEdge& b) { return a.ratio < b.ratio; });
  const Within tick(before, after);
  auto next_edge = new_edges_.begin();
  const auto edges_until = [&](double part) {
    for (; next_edge != new_edges_.end() && next_edge->ratio <= part; ++next_edge) {
      const FreeState at = tick.at(next_edge->ratio);
      level_[next_edge->wheel] = next_edge->level;
      if (recording_) now_.edges[next_edge->wheel].push_back({at.time_s, at.angle_deg, next_edge->level});
    }
  };
  if (!(before.speed_rad_s > 0) || !(after.speed_rad_s > 0)) {
    recording_ = false;
  } else {
    const auto first = static_cast<std::int64_t>(std::floor(before.angle_deg / kDegPerSample)) + 1;
    const auto last = static_cast<std::int64_t>(std::floor(after.angle_deg / kDegPerSample));
    for (std::int64_t n = first; n <= last; ++n) {
      const double part = tick.part_at(static_cast<double>(n) * kDegPerSample);
      const FreeState here = tick.at(part);
      edges_until(part);
      if (recording_) now_.samples.push_back(here);
      if (n % kSamplesPerCycle != 0) continue;
      if (recording_) {
        cycles_.push_back(std::move(now_));
        if (cycles_.size() > kKept) cycles_.pop_front();
      }
      begin(here);
    }
  }
  edges_until(1);
  new_edges_.clear();
}

}  // namespace crankloop::program

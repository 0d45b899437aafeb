#include "wheel_fault_tracks.hpp"

#include <cstddef>
#include <cstdint>

#include <crankloop/tabulate/elementary.hpp>

#include "phase_units.hpp"
#include "seeds.hpp"
#include "trigger_tracks.hpp"

namespace crankloop::detail {
namespace {

constexpr std::int64_t kTurn = std::int64_t{1} << 32;
constexpr double kLeastApartDeg = 1e-3;  // as between the edges of a wheel that is given by them

[[nodiscard]] double turn_deg(const TriggerWheel& wheel) noexcept {
  return wheel.shaft == TriggerShaft::crank ? kDegreesPerTurn : kDegreesPerCycle;
}
/// Crank degrees as units of the wheel's turn, to the nearest.
[[nodiscard]] std::int64_t units_of(double deg, const TriggerWheel& wheel) noexcept {
  const double units = deg / turn_deg(wheel) * 4294967296.0;
  return static_cast<std::int64_t>(units < 0 ? units - 0.5 : units + 0.5);
}

struct Tooth {
  std::int64_t rise;
  std::int64_t fall;  ///< after it
};

/// The teeth of a wheel, in units of its turn from its own first rising edge. Edges that no fault moves keep their
/// place to the unit.
class Teeth {
 public:
  explicit Teeth(const TriggerWheel& wheel) noexcept : wheel_{wheel} {
    std::uint32_t edges[kMaxTriggerEdges];
    const std::uint32_t edge_count = fill_edges(wheel, edges);
    for (std::uint32_t e = 0; e < edge_count; e += 2) tooth_[count_++] = {edges[e], edges[e + 1]};
  }

  [[nodiscard]] Status change(const WheelFault& fault) noexcept {
    if (fault.missing_tooth > count_) return refuse("fault.missing_tooth", Reason::out_of_range);
    if (fault.moved_tooth > count_) return refuse("fault.moved_tooth", Reason::out_of_range);
    if (fault.moved_tooth > 0) move(tooth_[fault.moved_tooth - 1], units_of(fault.moved_deg, wheel_));
    if (fault.missing_tooth > 0) remove(fault.missing_tooth - 1);
    if (fault.extra_width_deg > 0) {
      if (count_ == kMaxTriggerEdges / 2) return refuse("fault.extra_tooth_deg", Reason::too_many_points);
      const std::int64_t rise = units_of(fault.extra_tooth_deg, wheel_);
      tooth_[count_++] = {rise, rise + units_of(fault.extra_width_deg, wheel_)};
    }
    if (count_ == 0) return refuse("fault.missing_tooth", Reason::too_few_points);
    if (fault.runout_deg != 0) run_out(fault);
    put_in_order();
    return leaves_room() ? Status{} : refuse(to_blame(fault), Reason::inconsistent);
  }

  /// Angles from the first rising edge on; returns their number.
  std::uint32_t fill(std::uint32_t* edges) const noexcept {
    std::uint32_t count = 0;
    for (int i = 0; i < count_; ++i) {
      edges[count++] = static_cast<std::uint32_t>(tooth_[i].rise - first());
      edges[count++] = static_cast<std::uint32_t>(tooth_[i].fall - first());
    }
    return count;
  }
  [[nodiscard]] std::int64_t first() const noexcept { return tooth_[0].rise; }

 private:
  static void move(Tooth& tooth, std::int64_t by) noexcept { tooth.rise += by, tooth.fall += by; }
  void remove(int which) noexcept {
    for (int i = which; i + 1 < count_; ++i) tooth_[i] = tooth_[i + 1];
    --count_;
  }
  void run_out(const WheelFault& fault) noexcept {
    const auto later = [&](std::int64_t at) {
      const double angle = static_cast<double>(at) / static_cast<double>(kTurn) * 2 * elementary::kPi;
      const double from = fault.runout_at_deg * kRadPerDegree;
      return at + units_of(fault.runout_deg * elementary::sin(angle - from), wheel_);
    };
    for (int i = 0; i < count_; ++i) tooth_[i] = {later(tooth_[i].rise), later(tooth_[i].fall)};
  }
  /// By their rising edges, which lie in one turn.
  void put_in_order() noexcept {
    for (int i = 0; i < count_; ++i) {
      const std::int64_t turns_back = tooth_[i].rise & ~(kTurn - 1);
      move(tooth_[i], -turns_back);
    }
    for (int i = 1; i < count_; ++i) {
      const Tooth one = tooth_[i];
      int place = i;
      for (; place > 0 && tooth_[place - 1].rise > one.rise; --place) tooth_[place] = tooth_[place - 1];
      tooth_[place] = one;
    }
  }
  [[nodiscard]] bool leaves_room() const noexcept {
    const std::int64_t apart = units_of(kLeastApartDeg, wheel_);
    for (int i = 0; i < count_; ++i) {
      const std::int64_t next = i + 1 < count_ ? tooth_[i + 1].rise : tooth_[0].rise + kTurn;
      if (tooth_[i].fall - tooth_[i].rise < apart || next - tooth_[i].fall < apart) return false;
    }
    return true;
  }
  [[nodiscard]] static const char* to_blame(const WheelFault& fault) noexcept {
    if (fault.extra_width_deg > 0) return "fault.extra_width_deg";
    return fault.moved_tooth > 0 ? "fault.moved_deg" : "fault.runout_deg";
  }

  const TriggerWheel& wheel_;
  Tooth tooth_[kMaxTriggerEdges / 2] = {};
  int count_ = 0;
};

[[nodiscard]] std::uint64_t tick_at(double time_s, const TickOptions& options) noexcept {
  return static_cast<std::uint64_t>(time_s / options.tick_s + 0.5);
}

template <class Real>
[[nodiscard]] WheelFaultRule<Real> rule_of(const WheelFault& fault, const TickOptions& options,
                                           std::uint32_t number) noexcept {
  WheelFaultRule<Real> rule{};
  if (fault.timed()) rule.from_tick = tick_at(fault.start_s, options), rule.until_tick = tick_at(fault.end_s, options);
  rule.wheel = static_cast<std::uint32_t>(fault.wheel);
  rule.input_mask = fault.input_bit >= 0 ? std::uint32_t{1} << fault.input_bit : 0;
  rule.inverted = fault.inverted ? 1 : 0;
  rule.stuck = static_cast<std::uint32_t>(fault.stuck);
  rule.noise_below = chance_of(fault.noise_Hz * options.tick_s);
  rule.noise_seed = seed_of(fault.noise_seed, number);
  rule.pulse = static_cast<Real>(fault.noise_Hz > 0 ? fault.noise_pulse_s / options.tick_s : 0);
  return rule;
}

}  // namespace

Status validate_wheel_faults(const EngineDefinition& engine, const TickOptions& options) noexcept {
  for (int i = 0; i < engine.wheel_fault_count; ++i) {
    const WheelFault& fault = engine.wheel_faults[i];
    Teeth teeth(engine.triggers[fault.wheel]);
    if (const Status refused = teeth.change(fault); !refused.ok()) return refuse(refused.field, refused.reason, i);
    if (fault.noise_Hz * options.tick_s > 1) return refuse("fault.noise_Hz", Reason::out_of_range, i);
    if (fault.noise_Hz > 0 && fault.noise_pulse_s > options.tick_s / 2)
      return refuse("fault.noise_pulse_s", Reason::out_of_range, i);
  }
  return {};
}

template <class Real>
void fill_wheel_faults(const EngineDefinition& engine, const TickOptions& options,
                       const TableTargets<Real>& targets) noexcept {
  if (targets.wheel_faults == nullptr) return;
  const auto count = static_cast<std::uint32_t>(engine.wheel_fault_count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const WheelFault& fault = engine.wheel_faults[i];
    const TriggerWheel& wheel = engine.triggers[fault.wheel];
    Teeth teeth(wheel);
    (void)teeth.change(fault);  // validated
    std::uint32_t* edges = targets.fault_edges + i * std::size_t{kMaxTriggerEdges};
    TriggerTrack& track = targets.fault_tracks[i];
    track = track_of(engine, options, wheel, edges, teeth.fill(edges));
    const std::uint64_t per_unit = std::uint64_t{1} << (wheel.shaft == TriggerShaft::crank ? 31 : 32);
    track.starts += static_cast<std::uint64_t>(teeth.first()) * per_unit;
    track.starts += phase_units(fault.late_deg < 0 ? fault.late_deg + kDegreesPerCycle : fault.late_deg);
    targets.wheel_fault_rules[i] = rule_of<Real>(fault, options, i);
    targets.wheel_fault_rules[i].track = &track;
  }
  *targets.wheel_faults = {targets.wheel_fault_rules, count};
}

template void fill_wheel_faults(const EngineDefinition&, const TickOptions&, const TableTargets<float>&) noexcept;
template void fill_wheel_faults(const EngineDefinition&, const TickOptions&, const TableTargets<double>&) noexcept;

}  // namespace crankloop::detail

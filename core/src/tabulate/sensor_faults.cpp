#include "sensor_faults.hpp"

#include <cstdint>

#include <crankloop/tabulate/elementary.hpp>

#include "seeds.hpp"

namespace crankloop::detail {
namespace {

template <class Real>
[[nodiscard]] SensorFaultRule<Real> rule_of(const SensorFault& fault, double tick_s, std::uint32_t number) noexcept {
  const auto real = [](double x) { return static_cast<Real>(x); };
  const auto ticks = [tick_s](double time_s) { return static_cast<std::uint64_t>(time_s / tick_s + 0.5); };
  SensorFaultRule<Real> rule{};
  if (fault.timed()) rule.from_tick = ticks(fault.start_s), rule.until_tick = ticks(fault.end_s);
  rule.sensor = static_cast<std::uint32_t>(fault.sensor);
  rule.input_mask = fault.input_bit >= 0 ? std::uint32_t{1} << fault.input_bit : 0;
  rule.wire = static_cast<std::uint32_t>(fault.wire);
  rule.noise_seed = seed_of(fault.noise_seed, number);
  const auto delay = static_cast<std::uint32_t>(ticks(fault.delay_s));
  rule.sample_ticks = delay > 0 ? (delay + kDelayedSamples - 1) / kDelayedSamples : 1;
  rule.samples = (delay + rule.sample_ticks / 2) / rule.sample_ticks;
  rule.follows = real(fault.lag_s > 0 ? 1 - elementary::exp(-tick_s / fault.lag_s) : 1);
  rule.offset = real(fault.offset), rule.noise = real(fault.noise);
  rule.least = real(fault.has_range() ? fault.least : 1), rule.most = real(fault.has_range() ? fault.most : 0);
  if (fault.step > 0) rule.step = real(fault.step), rule.per_step = real(1 / fault.step);
  return rule;
}

}  // namespace

template <class Real>
void fill_sensor_faults(const EngineDefinition& engine, const TickOptions& options,
                        const TableTargets<Real>& targets) noexcept {
  if (targets.sensor_faults == nullptr) return;
  SensorFaultRules<Real>& rules = *targets.sensor_faults = {};
  rules.count = static_cast<std::uint32_t>(engine.sensor_fault_count);
  for (std::uint32_t i = 0; i < rules.count; ++i)
    rules.fault[i] = rule_of<Real>(engine.sensor_faults[i], options.tick_s, i);
}

template void fill_sensor_faults(const EngineDefinition&, const TickOptions&, const TableTargets<float>&) noexcept;
template void fill_sensor_faults(const EngineDefinition&, const TickOptions&, const TableTargets<double>&) noexcept;

}  // namespace crankloop::detail

#include "run_loop.hpp"

#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tabulate/summary.hpp>

#include "port/linux/stopwatch.hpp"

namespace crankloop::program {
namespace {

/// Integral over the first part (0 to 1) of a tick, of the parabola that has the tick's torque at both ends and its
/// mean.
double part_of_tick(double start_Nm, double end_Nm, double mean_Nm, double part) {
  const double bulge_Nm = 6 * (mean_Nm - (start_Nm + end_Nm) / 2);  // torque = line + bulge u (1 - u)
  const double squared = part * part;
  return start_Nm * (part - squared / 2) + end_Nm * squared / 2 + bulge_Nm * (squared / 2 - squared * part / 3);
}

}  // namespace

template <class Real, class S>
double FixedStepLoop<Real, S>::wall_time_per_tick_ns() noexcept {
  std::array<double, kBatches> batch{};
  for (double& per_tick_ns : batch) {
    const port::Stopwatch stopwatch;
    for (int i = 0; i < kBatchTicks; ++i) engine_.step(input_);
    per_tick_ns = static_cast<double>(stopwatch.elapsed_ns()) / kBatchTicks;
  }
  std::nth_element(batch.begin(), batch.begin() + kBatches / 2, batch.end());
  return batch[kBatches / 2];
}

template <class Real, class S>
RunFigures run_cycles(FixedStepLoop<Real, S>& loop, const EngineDefinition& definition, const Operation& operation,
                      int cycles, const OnTick<Real, S>& on_tick) {
  const Layout& layout = definition.layout;
  const auto cylinders = static_cast<std::size_t>(layout.cylinders);
  const std::uint32_t journals = bearings_of(definition).pins + 1;
  const double span = cycles * loop.ticks_per_cycle();
  require_ticks(span, operation.tick_s, kFewerTicks);

  RunFigures f;
  f.cycles = cycles;
  f.ticks = static_cast<std::uint64_t>(std::max(1.0, std::ceil(span - kHairOfATick)));
  f.settling_ticks = loop.settling_ticks();
  f.unsettled_Pa = loop.unsettled_Pa();
  f.deg_per_tick = loop.deg_per_tick();
  f.tables = loop.tables();
  f.valves.resize(static_cast<std::size_t>(definition.train_count));
  const double last_part = span - static_cast<double>(f.ticks - 1);
  double torque_sum_Nm = 0;
  auto torque_before_Nm = static_cast<double>(loop.output().torque_Nm);
  for (std::uint64_t tick = 1; tick <= f.ticks; ++tick) {
    const WholeOutput<Real, S>& out = loop.step();
    const double engine_deg = loop.crank_deg();
    const auto torque_Nm = static_cast<double>(out.torque_Nm);
    const auto mean_torque_Nm = static_cast<double>(out.mean_torque_Nm);
    torque_sum_Nm +=
        tick < f.ticks ? mean_torque_Nm : part_of_tick(torque_before_Nm, torque_Nm, mean_torque_Nm, last_part);
    torque_before_Nm = torque_Nm;
    f.torque.take(torque_Nm, engine_deg);
    for (std::size_t k = 0; k < cylinders; ++k) {
      const double from_firing_deg = engine_deg - layout.firing_deg[k];
      const double own_deg = from_firing_deg < 0 ? from_firing_deg + 720 : from_firing_deg;
      const QuantityValues<Real> values = values_of(out, layout, k);
      for (std::size_t i = 0; i < kQuantities; ++i) f.of[i].take(static_cast<double>(values[i]), own_deg);
      for (std::size_t t = 0; t < f.valves.size(); ++t) {
        const auto of_valve = values_of(out, t, k);
        for (std::size_t i = 0; i < kValveQuantities; ++i)
          f.valves[t].of[i].take(static_cast<double>(of_valve[i]), own_deg);
      }
    }
    for (std::size_t j = 0; j < journals; ++j)
      f.journal_load.take(static_cast<double>(out.journal_load_N[j]), engine_deg);
    f.faulty_ticks += out.faults != 0 ? 1 : 0;
    f.faults |= out.faults;
    if constexpr (detail::Needs<S>::gas) {
      f.gas.intake_Pa += static_cast<double>(out.manifold[kIntake].pressure_Pa) / static_cast<double>(f.ticks);
      f.gas.exhaust_Pa += static_cast<double>(out.manifold[kExhaust].pressure_Pa) / static_cast<double>(f.ticks);
      f.gas.exhaust_manifold_K +=
          static_cast<double>(out.manifold[kExhaust].temperature_K) / static_cast<double>(f.ticks);
    }
    if (on_tick) on_tick(tick, engine_deg, out);
  }
  if constexpr (detail::Needs<S>::gas) take_cycles(loop.output(), cylinders, operation.speed_rad_s(), f.gas);
  for (std::size_t t = 0; t < f.valves.size(); ++t) {
    for (std::size_t k = 0; k < cylinders; ++k) {
      f.valves[t].last_cycle = worse_of(f.valves[t].last_cycle, in_double(loop.output().valve_cycle[t][k]));
    }
  }
  f.mean_torque_Nm = torque_sum_Nm / span;
  f.power_W = f.mean_torque_Nm * operation.speed_rad_s();
  f.net_mep_Pa = f.mean_torque_Nm * kCycle_rad / (layout.cylinders * swept_volume_m3(definition.crank));
  return f;
}

template class FixedStepLoop<float, scenes::Whole>;
template class FixedStepLoop<double, scenes::Whole>;
template class FixedStepLoop<float, scenes::Breathing>;
template class FixedStepLoop<double, scenes::Breathing>;
template RunFigures run_cycles(FixedStepLoop<float, scenes::Whole>&, const EngineDefinition&, const Operation&, int,
                               const OnTick<float, scenes::Whole>&);
template RunFigures run_cycles(FixedStepLoop<double, scenes::Whole>&, const EngineDefinition&, const Operation&, int,
                               const OnTick<double, scenes::Whole>&);
template RunFigures run_cycles(FixedStepLoop<float, scenes::Breathing>&, const EngineDefinition&, const Operation&, int,
                               const OnTick<float, scenes::Breathing>&);
template RunFigures run_cycles(FixedStepLoop<double, scenes::Breathing>&, const EngineDefinition&, const Operation&,
                               int, const OnTick<double, scenes::Breathing>&);

}  // namespace crankloop::program

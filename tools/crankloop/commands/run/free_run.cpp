#include "free_run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "../../command_line/progress.hpp"
#include "../../command_line/results.hpp"
#include "../../command_line/summary.hpp"
#include "../../command_line/with_real.hpp"
#include "../../engine_file/pressure_words.hpp"
#include "../../files/csv.hpp"
#include "../../files/number.hpp"
#include "../../loops/analogue_log.hpp"
#include "../../loops/run_hash.hpp"
#include "../../signals/signal_dump.hpp"
#include "cranking_sheet.hpp"

namespace crankloop::program {
namespace {

template <class Real, class S>
using FreeOutput = typename FreeLoop<Real, S>::Output;

/// Those with a rule by which cycles misfire, from 0.
std::vector<std::size_t> misfiring_cylinders(const EngineDefinition& engine) {
  std::vector<std::size_t> cylinders;
  for (std::size_t k = 0; k < static_cast<std::size_t>(engine.layout.cylinders); ++k)
    if (engine.misfires[k].pattern != MisfirePattern::none) cylinders.push_back(k);
  return cylinders;
}

/// A row per tick. Edges stand in one cell: their times since the run's start, blanks between.
template <class Real, class S>
class TickTable {
 public:
  TickTable(Output& out, const std::vector<std::string>& signals, const EngineDefinition& engine)
      : csv_{out, header(signals, engine)},
        wheels_{static_cast<std::size_t>(engine.trigger_count)},
        signals_{signals.size()},
        engine_{engine} {}

  void row(const FreeLoop<Real, S>& loop, double tick_s, const FreeOutput<Real, S>& out) {
    const FreeState& state = loop.state();
    csv_.cell(state.time_s);
    csv_.cell(in_cycle_deg(state.angle_deg));
    csv_.cell(out.speed_rad_s * static_cast<Real>(kRpmPerRad_s));
    for (const Real value :
         {out.acceleration_rad_s2, out.torque_Nm, out.mean_torque_Nm, out.friction_Nm, out.starter_Nm})
      csv_.cell(value);
    for (std::size_t w = 0; w < signals_; ++w) {
      const auto& signal = signal_of(out, w, wheels_);
      csv_.cell(static_cast<int>(signal.level));
      csv_.cell(static_cast<int>(signal.edge_count));
      std::string times;
      for (std::uint32_t e = 0; e < listed_edges(signal); ++e) {
        times += (e == 0 ? "" : " ") + significant(state.time_s - tick_s + static_cast<double>(signal.edge[e].time_s));
      }
      csv_.cell(std::string_view(times));
    }
    for (const std::size_t k : misfiring_cylinders(engine_)) {
      csv_.cell(static_cast<double>(loop.misfires_of(k).cycles));
      csv_.cell(static_cast<double>(loop.misfires_of(k).misfires));
    }
    if constexpr (detail::Needs<S>::gas) write_gas(csv_, out, engine_);
    csv_.end_row();
  }

 private:
  static std::vector<std::string> header(const std::vector<std::string>& signals, const EngineDefinition& engine) {
    std::vector<std::string> columns{"time_s",    "crank_deg",      "speed_rpm",   "acceleration_rad_s2",
                                     "torque_Nm", "mean_torque_Nm", "friction_Nm", "starter_Nm"};
    for (const std::string& signal : signals) {
      for (const char* what : {"_level", "_edges", "_edge_times_s"}) columns.push_back(signal + what);
    }
    for (const std::size_t k : misfiring_cylinders(engine)) {
      columns.push_back("cycles_" + std::to_string(k + 1));
      columns.push_back("misfires_" + std::to_string(k + 1));
    }
    if (detail::Needs<S>::gas) add_gas_columns(columns, engine);
    return columns;
  }

  CsvWriter csv_;
  std::size_t wheels_;
  std::size_t signals_;  ///< those, and with faults the faulty ones
  const EngineDefinition& engine_;
};

/// The edges of a tick, for the cycles and the count.
template <class Real, class S>
void take_signals(const FreeOutput<Real, S>& out, double tick_s, bool first, std::size_t wheels,
                  CycleRecorder& recorder, std::vector<SignalFigures>& figures) {
  for (std::size_t w = 0; w < figures.size(); ++w) {
    const auto& signal = signal_of(out, w, wheels);
    const std::uint32_t listed = listed_edges(signal);
    if (first) recorder.begin_at(w, level_before(signal));
    for (std::uint32_t e = 0; e < listed; ++e)
      recorder.edge(w, static_cast<double>(signal.edge[e].time_s) / tick_s, signal.edge[e].level != 0);
    figures[w].edges += signal.edge_count;
    figures[w].lost += signal.edge_count - listed;
  }
}

template <class Real, class S>
FreeFigures run_ticks(const EngineFile& file, const EngineDefinition& definition, const FreeRequest& request,
                      TickTable<Real, S>* table, SignalDump* dump, AnalogueLog<Real>* analogue) {
  const FreeOperation& operation = request.operation;
  ExactEngine exact;
  if (const Status refused = exact.init(definition); !refused.ok()) throw file.explain(refused);
  FreeLoop<Real, S> loop(file, definition, operation);
  EnergyBooks books(exact, operation, loop.state());
  FreeFigures figures;
  figures.ticks = operation.ticks();
  figures.speed_rpm = Overview(figures.ticks);
  figures.intake_kPa = Overview(figures.ticks);
  for (const std::string& name : names_of_signals(file)) figures.signals.push_back({name});
  CycleRecorder recorder(figures.signals.size());
  Progress progress("running", static_cast<double>(figures.ticks));
  Phase crank{};
  BitHash hash;
  if (dump != nullptr) dump->number(0, 0, operation.from_rpm);
  for (std::uint64_t tick = 0; tick < figures.ticks; ++tick) {
    const FreeOutput<Real, S>& out = loop.step();
    const FreeState& now = loop.state();
    const double before_rad_s = loop.before().speed_rad_s;
    take_signals<Real, S>(out, operation.tick_s, tick == 0, file.triggers().size(), recorder, figures.signals);
    recorder.take(loop.before(), now);
    books.take(loop.before(), now, static_cast<double>(out.starter_Nm));
    figures.speed_rpm.take(now.time_s, now.speed_rpm());
    figures.largest_speed_rad_s = std::max(figures.largest_speed_rad_s, std::fabs(now.speed_rad_s));
    figures.reversals += before_rad_s * now.speed_rad_s < 0 ? 1 : 0;
    figures.faulty_ticks += out.faults != 0 ? 1 : 0;
    figures.faults |= out.faults;
    if constexpr (detail::Needs<S>::gas) {
      figures.gas.intake_Pa = static_cast<double>(out.manifold[kIntake].pressure_Pa);
      figures.gas.exhaust_Pa = static_cast<double>(out.manifold[kExhaust].pressure_Pa);
      figures.intake_kPa.take(now.time_s, figures.gas.intake_Pa / 1e3);
    }
    if (analogue != nullptr) {
      analogue->take(loop.before().time_s, crank, out.crank, static_cast<Real>(before_rad_s), out.speed_rad_s);
      crank = out.crank;
    }
    if (table != nullptr) table->row(loop, operation.tick_s, out);
    if (request.is_hashed) add_tick<FreeShown<S>>(hash, loop.engine(), loop.shape());
    if (dump != nullptr) {
      dump->number(0, now.time_s, now.speed_rpm());
      dump->number(1, now.time_s, now.torque_Nm);
      dump->tick(now.time_s, operation.tick_s, out);
    }
    progress.step();
  }
  if constexpr (detail::Needs<S>::gas)
    take_cycles(loop.output(), static_cast<std::size_t>(definition.layout.cylinders),
                std::fabs(loop.state().speed_rad_s), figures.gas);
  for (const std::size_t k : misfiring_cylinders(definition)) figures.misfires.push_back({k, loop.misfires_of(k)});
  figures.end = loop.state();
  if (request.is_hashed) figures.hash = hash.text();
  figures.energy = books.balance(figures.end);
  figures.cycles.assign(recorder.cycles().begin(), recorder.cycles().end());
  if (!figures.cycles.empty()) {
    const FreeCycle& last = figures.cycles.back();
    figures.friction_Nm = books.friction_Nm(last.mean_speed_rad_s());
    figures.load_Nm = books.load_Nm(last.mean_speed_rad_s()) + last.external_torque_Nm();
  }
  return figures;
}

void add_cycle(Summary& s, const FreeFigures& f, bool is_started) {
  if (f.cycles.empty()) {
    s.remark("no whole cycle of 720 deg was turned forward: no irregularity, no harmonics");
    constexpr double kStarts_s = 0.2;
    constexpr double kStands_rad_s = 2;
    if (is_started && f.end.time_s >= kStarts_s && std::fabs(f.end.speed_rad_s) < kStands_rad_s)
      s.remark(
          "the starter does not turn the engine over: [starter] stall_Nm is too small for compression and friction");
    return;
  }
  const FreeCycle& cycle = f.cycles.back();
  s.line("cycle_ended", cycle.samples.back().time_s, "s",
         "the last whole cycle, from one firing TDC of cylinder 1 to the next");
  s.line("cycle_speed", cycle.mean_speed_rad_s() * kRpmPerRad_s, "rpm");
  s.line("cycle_irregularity", cycle.irregularity_ratio(), "", "(largest - smallest speed) / mean");
  s.line("cycle_torque", cycle.mean_torque_Nm(), "Nm", "mean, of gas and masses");
  s.line("cycle_friction", f.friction_Nm, "Nm", "at the mean speed, as is the load");
  s.line("cycle_load", f.load_Nm, "Nm");
  const std::vector<double> harmonics = cycle.harmonics_rad_s();
  for (std::size_t i = 0; i < harmonics.size() / 2; ++i) {
    s.line("speed_order_" + shortest(static_cast<double>(i + 1) / 2), harmonics[i], "rad/s",
           i == 0 ? "amplitude, per crank turn" : "");
  }
}

std::string summary_text(const EngineFile& file, const FreeRequest& request, const FreeFigures& f) {
  const FreeOperation& operation = request.operation;
  Summary s;
  s.remark(file.name() + ", turned by its gas, fixed-step loop in " + request.real +
           (file.definition().pressure.source != PressureSource::none ? "" : ", no pressure source: no gas"));
  s.remark(pressure_in_short(file));
  s.line("tick", operation.tick_s * 1e6, "us");
  s.line("time", f.end.time_s, "s");
  s.line("ticks", f.ticks);
  if (operation.schedule) s.line("inputs_from_file", operation.schedule->columns());
  // An input with a column of its own has no one value to tell.
  const auto is_given = [&](const char* input) { return !operation.schedule || !operation.schedule->drives(input); };
  if (breathes(file.definition())) {
    add_order(s, operation.gas, is_given);
  } else if (is_given("load_ratio")) {
    s.line("load_ratio", operation.load_ratio);
  }
  s.line("turned", f.end.angle_deg / 360, "rev");
  s.line("speed_at_end", f.end.speed_rpm(), "rpm");
  s.line("max_speed", f.largest_speed_rad_s * kRpmPerRad_s, "rpm",
         beyond_steps_of_gas(file.definition(), f.largest_speed_rad_s * kRpmPerRad_s, operation.tick_s));
  s.line("reversals", f.reversals);
  add_cycle(s, f, operation.starter || f.energy.starter_J != 0);
  if (breathes(file.definition())) {
    s.remark("the gas, of the cylinders' last whole cycles");
    s.line("net_mep", f.gas.cycle.net_mep_Pa / 1e3, "kPa");
    if (!f.misfires.empty()) s.remark("fuel of misfires is in no figure");
    add_gas(s, file.definition(), f.gas);
    s.line("intake_pressure", f.gas.intake_Pa / 1e3, "kPa", "in the manifold, at the end");
  }
  s.line("work_of_gas", f.energy.gas_J, "J");
  s.line("work_of_starter", f.energy.starter_J, "J");
  s.line("lost_to_friction", f.energy.friction_J, "J");
  s.line("taken_by_load", f.energy.load_J, "J");
  s.line("change_of_kinetic_energy", f.energy.kinetic_J, "J");
  s.line("energy_defect", f.energy.missing_ratio(), "",
         f.speed_was_limited()
             ? "of the largest of these: what the speed limit took, since gas outweighs friction and load"
             : "of the largest of these");
  const bool may_be_cut = operation.cut_cylinders != 0 || !is_given("cut_cylinders");
  const char* const by_rule = may_be_cut ? "by the rule: cycles that were cut count too" : "";
  for (const MisfireFigures& misfire : f.misfires) {
    const std::string whose = "cylinder_" + std::to_string(misfire.cylinder + 1);
    s.line(whose + "_cycles", std::uint64_t{misfire.counts.cycles});
    s.line(whose + "_misfires", std::uint64_t{misfire.counts.misfires}, "", by_rule);
    s.line(whose + "_misfires_in_200_turns", std::uint64_t{misfire.counts.in_200_turns}, "", "its last 100 cycles");
    s.line(whose + "_misfires_in_1000_turns", std::uint64_t{misfire.counts.in_1000_turns}, "", "its last 500 cycles");
  }
  for (const SignalFigures& signal : f.signals) {
    s.line(signal.name + "_edges", signal.edges);
    s.line(signal.name + "_edges_lost", signal.lost, "",
           signal.lost > 0 ? "more edges in a tick than it can record: use a shorter --tick-us" : "");
  }
  s.faulty_ticks(f.faulty_ticks, f.faults);
  if (request.is_hashed) s.line("hash", f.hash, "", "of every bit that the ticks show");
  return s.text();
}

template <class Real, class S>
void run_and_write(const EngineFile& file, const EngineDefinition& definition, const FreeRequest& request,
                   Results& results) {
  std::optional<TickTable<Real, S>> table;
  std::optional<SignalDump> dump;
  if (Output* vcd = results["--vcd"]) dump.emplace(SignalDump::with_faults(file, *vcd, {"speed_rpm", "torque_Nm"}));
  if (Output* csv = results["--csv"]) table.emplace(*csv, names_of_signals(file), definition);
  std::optional<AnalogueLog<Real>> analogue;
  AnalogueTrace cranking;
  Output* const samples = results["--analogue"];
  Output* const drawing = results["--cranking"];
  if (samples != nullptr || drawing != nullptr)
    analogue.emplace(samples, drawing != nullptr ? &cranking : nullptr, file, definition, request.operation.tick_s);
  const FreeFigures figures = run_ticks<Real, S>(file, definition, request, table ? &*table : nullptr,
                                                 dump ? &*dump : nullptr, analogue ? &*analogue : nullptr);
  if (dump) dump->finish(figures.end.time_s);
  if (drawing != nullptr) drawing->write(report::to_svg_file(cranking_sheet(cranking, file.name() + ": a start")));
  if (Output* page = results["--report"])
    page->write(report::to_html(free_run_report({file, definition, request, figures})));
  results.finish(summary_text(file, request, figures));
}

}  // namespace

void run_free(const EngineFile& file, const EngineDefinition& definition, const FreeRequest& request,
              Results& results) {
  with_real(request.real, [&](auto zero) {
    using Real = decltype(zero);
    if (breathes(definition)) {
      run_and_write<Real, scenes::BreathingFree>(file, definition, request, results);
    } else {
      run_and_write<Real, scenes::FreeRunning>(file, definition, request, results);
    }
  });
}

}  // namespace crankloop::program

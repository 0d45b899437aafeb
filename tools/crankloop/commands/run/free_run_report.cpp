// The page of `crankloop run --free`: speed, ripple and its harmonics, torque, the books of energy; trigger signals:
// free_run_report_signals.cpp.
#include <algorithm>
#include <cmath>
#include <string>

#include "../../engine_file/pressure_words.hpp"
#include "../../files/number.hpp"
#include "../../report/page.hpp"
#include "free_run.hpp"

namespace crankloop::program {
namespace {

using report::Axis;
using report::axis_of;
using report::Paragraph;
using report::Plot;
using report::plot_of;
using report::Section;
using report::Series;

Axis cycle_axis(double cycles) {
  Axis one = axis_of("Crank angle", "deg");
  one.tick_step = cycles > 1 ? 360 : 90;
  one.range = report::Range{0, 720 * cycles};
  return one;
}

const FreeCycle& last_cycle(const FreeReportInput& input) { return input.figures.cycles.back(); }

using Value = double (*)(const FreeState&);
double rpm(const FreeState& state) { return state.speed_rpm(); }
double torque_Nm(const FreeState& state) { return state.torque_Nm; }

/// One after the other from 0 deg.
Series over_cycles(const std::vector<FreeCycle>& cycles, std::size_t first, Value value) {
  Series series;
  for (std::size_t c = first; c < cycles.size(); ++c) {
    for (std::size_t i = 0; i < cycles[c].samples.size(); ++i) {
      series.x.push_back(720.0 * (static_cast<double>(c - first) + static_cast<double>(i) / kSamplesPerCycle));
      series.y.push_back(value(cycles[c].samples[i]));
    }
  }
  return series;
}

Series level_line(const char* name, double value, bool dashed) {
  Series series;
  series.name = name;
  series.x = {0, 720};
  series.y = {value, value};
  series.style.dashed = dashed;
  return series;
}

/// The smallest and largest of each part of the run.
Series over_run(const Overview& overview) {
  Series series;
  for (const Overview::Part& part : overview.parts()) {
    for (const double value : {part.smallest, part.largest}) {
      series.x.push_back(part.begin_s);
      series.y.push_back(value);
      if (part.smallest == part.largest) break;
    }
  }
  return series;
}

Plot intake_plot(const FreeFigures& figures) {
  Plot plot = plot_of("Pressure in the intake manifold", axis_of("Time", "s"), axis_of("Pressure, absolute", "kPa"));
  plot.y.include_zero = true;
  plot.series.push_back(over_run(figures.intake_kPa));
  return plot;
}

Section speed_section(const FreeReportInput& input) {
  Section section{"speed", "Speed", {}};
  Plot whole = plot_of("Over the run", axis_of("Time", "s"), axis_of("Speed", "rpm"));
  whole.y.include_zero = true;
  whole.series.push_back(over_run(input.figures.speed_rpm));
  section.blocks.push_back(std::move(whole));
  if (breathes(input.definition)) section.blocks.push_back(intake_plot(input.figures));
  const std::vector<FreeCycle>& cycles = input.figures.cycles;
  if (cycles.empty()) {
    section.blocks.push_back(
        Paragraph{"No whole cycle of 720 deg was turned forward without a stop: there is no ripple to show.", true});
    return section;
  }
  Plot ripple =
      plot_of("Over the last cycles", cycle_axis(static_cast<double>(cycles.size())), axis_of("Speed", "rpm"));
  ripple.caption =
      "Each firing stroke speeds the crank up, each compression slows it down. Multiples of 720: firing top dead "
      "centre of cylinder 1.";
  ripple.series.push_back(over_cycles(cycles, 0, rpm));
  section.blocks.push_back(std::move(ripple));
  return section;
}

Section harmonic_section(const FreeReportInput& input) {
  Section section{"harmonics", "Ripple and torque of the last cycle", {}};
  Plot bars = plot_of("Harmonics of the speed", axis_of("Order per crank turn", ""), axis_of("Amplitude", "rad/s"));
  bars.x.tick_step = 1;
  Series series;
  series.style.draw = report::Draw::bar;
  report::Table table{"Harmonics of the speed", {{"Order", ""}, {"Amplitude", "rad/s"}}, {}, true};
  const std::vector<double> harmonics = last_cycle(input).harmonics_rad_s();
  for (std::size_t i = 0; i < harmonics.size(); ++i) {
    const double order = static_cast<double>(i + 1) / 2;
    series.x.push_back(order);
    series.y.push_back(harmonics[i]);
    table.rows.push_back({shortest(order), report::format_number(harmonics[i], 4)});
  }
  bars.series.push_back(std::move(series));
  section.blocks.push_back(std::move(bars));
  Plot torque = plot_of("Torque", cycle_axis(1), axis_of("Torque", "Nm"));
  torque.series.push_back(over_cycles(input.figures.cycles, input.figures.cycles.size() - 1, torque_Nm));
  torque.series.back().name = "gas and masses";
  torque.series.push_back(level_line("mean", last_cycle(input).mean_torque_Nm(), false));
  torque.series.push_back(level_line("friction and load", input.figures.friction_Nm + input.figures.load_Nm, true));
  torque.caption =
      "Friction and load at the cycle's mean speed. Their difference from the mean torque changes the speed from "
      "cycle to cycle.";
  section.blocks.push_back(std::move(torque));
  section.blocks.push_back(std::move(table));
  return section;
}

Section energy_section(const FreeReportInput& input) {
  const EnergyBalance& energy = input.figures.energy;
  Section section{"energy", "Energy over the run", {}};
  report::Table table{"", {{"", "", false}, {"In", "J"}, {"Out", "J"}}, {}, false};
  const auto number = [](double value) { return report::format_number(value, 6); };
  table.rows.push_back({"Gas", number(energy.gas_J), ""});
  table.rows.push_back({"Starter", number(energy.starter_J), ""});
  table.rows.push_back({"Friction", "", number(energy.friction_J)});
  table.rows.push_back({"Load", "", number(energy.load_J)});
  table.rows.push_back({"Change in kinetic energy", "", number(energy.kinetic_J)});
  section.blocks.push_back(std::move(table));
  section.blocks.push_back(Paragraph{
      "Energy balance error: " + report::format_number(energy.missing_ratio(), 2) +
      " of the largest energy. The work of the gas is " +
      (energy.gas_by_torque ? "the torque of the loop integrated over the angle, less the part of the masses"
                            : "the exact engine's torque integrated over the angle") +
      "; the kinetic energy follows from the geometry, the energies of starter, friction and load from their power at "
      "the ticks" +
      (energy.gas_by_torque ? "." : ". All are computed independently of the simulation loop.") +
      (input.figures.speed_was_limited() ? " The crank reached its speed limit, which took the energy that is missing."
                                         : "")});
  return section;
}

Section method_section(const FreeReportInput& input) {
  Section section{"method", "Method", {}};
  section.blocks.push_back(Paragraph{"Command: " + input.request.command_line});
  report::List list;
  list.items.push_back("Gas, masses, friction, load and starter turn the crank in ticks of " +
                       shortest(input.request.operation.tick_s * 1e6) + " \u00B5s, in " + input.request.real + ".");
  list.items.push_back(
      "Between ticks the angle is a cubic over time through angle and speed of both ticks; the ripple is read from "
      "it every half degree.");
  list.items.push_back(
      "Harmonics are amplitudes of the speed over the crank angle, without its drift from the start to the end of "
      "the cycle.");
  section.blocks.push_back(std::move(list));
  return section;
}

Section assumption_section(const FreeReportInput& input) {
  const EngineDefinition& d = input.definition;
  Section section{"assumptions", "Assumptions", {}};
  const auto number = [](double value) { return report::format_number(value, 4); };
  report::List list;
  list.items.push_back("Piston, rod and crankshaft are rigid and without clearance. " +
                       number(d.masses.crank_inertia_kg_m2 + d.machine.inertia_kg_m2) +
                       " kg m\u00B2 turn with the crank, pistons and rods move with it.");
  list.items.push_back(d.friction.any() ? "Friction is a mean effective pressure over the speed, even over the cycle."
                                        : "There is no friction: the file has no [friction].");
  list.items.push_back(breathes(d) ? "All cylinders are alike; cranking and warming up have no combustion of their own."
                                   : "All cylinders are alike and every cycle has the same diagram at any speed, "
                                     "scaled by the load ratio; cranking and warming up have no combustion of their "
                                     "own.");
  if (input.request.operation.starter) {
    list.items.push_back("The starter's torque falls in a straight line from " + number(d.starter.stall_Nm) +
                         " Nm at rest to none at " + number(d.starter.no_load_rad_s * kRpmPerRad_s) +
                         " rpm, and it free-wheels where the engine is faster.");
  }
  list.items.push_back(
      "The driven machine turns rigidly with the crank; its torque at the end was that of the file's [machine] or "
      "--machine-Nm, " +
      number(input.figures.load_Nm) + " Nm.");
  section.blocks.push_back(std::move(list));
  return section;
}

std::vector<report::Fact> facts(const FreeReportInput& input) {
  const FreeFigures& f = input.figures;
  const auto number = [](double value) { return report::format_number(value, 4); };
  std::vector<report::Fact> list;
  list.push_back({"Speed at the end", number(f.end.speed_rpm()), "rpm",
                  "after " + shortest(input.request.operation.seconds) + " s"});
  if (!f.cycles.empty()) {
    const FreeCycle& cycle = last_cycle(input);
    list.insert(list.begin(),
                {"Mean speed", number(cycle.mean_speed_rad_s() * kRpmPerRad_s), "rpm", "of the last cycle"});
    list.push_back({"Irregularity", number(cycle.irregularity_ratio() * 100), "%",
                    "of the last cycle, (largest - smallest) / mean"});
    list.push_back({"Mean torque", number(cycle.mean_torque_Nm()), "Nm", "of the last cycle, indicated"});
    list.push_back({"Friction", number(f.friction_Nm), "Nm", "load " + number(f.load_Nm) + " Nm"});
  }
  list.push_back({"Energy balance error", report::format_number(std::fabs(f.energy.missing_ratio()), 2), "",
                  f.speed_was_limited() ? "taken by the speed limit" : "of the largest energy"});
  for (const SignalFigures& signal : f.signals) {
    list.push_back({"Edges of " + signal.name, report::format_fixed(static_cast<double>(signal.edges), 0), "",
                    std::to_string(signal.lost) + " lost"});
  }
  return list;
}

std::string subtitle(const FreeReportInput& input) {
  const FreeOperation& operation = input.request.operation;
  std::string text = "Running free from " + report::format_number(operation.from_rpm, 4) + " rpm, " +
                     (breathes(input.definition) ? "throttle " + shortest(operation.gas.throttle_ratio)
                                                 : "load ratio " + shortest(operation.load_ratio));
  if (operation.starter) text += ", with the starter";
  if (operation.cut_cylinders != 0) {
    std::string cut;
    for (int k = 0; k < input.definition.layout.cylinders; ++k) {
      if ((operation.cut_cylinders >> k & 1u) != 0) cut += (cut.empty() ? "" : ", ") + std::to_string(k + 1);
    }
    text += ", without cylinder " + cut;
  }
  return text + ".";
}

}  // namespace

report::Page free_run_report(const FreeReportInput& input) {
  report::Page page;
  page.title = input.file.name() + (input.request.operation.starter ? ", started and running free" : ", running free");
  page.subtitle = subtitle(input);
  page.facts = facts(input);
  page.sections.push_back(speed_section(input));
  if (!input.figures.cycles.empty()) {
    page.sections.push_back(harmonic_section(input));
    if (!input.figures.signals.empty()) page.sections.push_back(trigger_signal_section(input));
  }
  page.sections.push_back(energy_section(input));
  page.sections.push_back(method_section(input));
  page.sections.push_back(assumption_section(input));
  report::put_first(page,
                    {pressure_in_words(input.file, input.request.operation.load_ratio, input.request.operation.gas)});
  std::vector<std::string> warnings = input.request.warnings;
  const std::string steps = beyond_steps_of_gas(input.definition, input.figures.largest_speed_rad_s * kRpmPerRad_s,
                                                input.request.operation.tick_s);
  if (!steps.empty()) warnings.push_back(input.file.path() + ": warning: " + steps);
  report::put_first(page, warnings);
  page.footer = "Made by crankloop from " + input.file.path() + ".";
  return page;
}

}  // namespace crankloop::program

// `crankloop tables FILE --tick-us T`: the tables as a C++ header of constexpr data, one object per section.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/tabulate/tabulate.hpp>

#include "commands.hpp"
#include "engine_file/engine_file.hpp"
#include "error.hpp"
#include "output.hpp"
#include "valve/valve_tick_limit.hpp"

namespace crankloop::program {
namespace {

/// All sections, on the heap.
template <class Real>
struct AllSections {
  Drive<Real> drive{};
  Body<Real> body{};
  IntegratedCurve<Real> stroke{}, inertia_torque{};
  Revolution<MotionSegment<Real>> motion{};
  Revolution<LeanSegment<Real>> lean{};
  Revolution<RodSegment<Real>> rod{};
  Curve<Real> rod_curvature{};
  Bearings<Real> bearings{};
  Balance<Real> balance{};
  GasGrid gas_grid{}, torque_grid{}, cut_grid{};
  std::vector<Segment<Real>> pressure_full, pressure_motored, pressure_heat;
  GasTorque<Real> gas_torque_full{}, gas_torque_motored{}, gas_torque_heat{}, cut_torque{};
  std::vector<IntegratedSegment<Real>> gas_full, gas_motored, gas_heat, cut_heat;
  CrankDynamics<Real> crank_dynamics{};
  LiftCurve<Real> lift_curves[kMaxTrains] = {};
  std::vector<LiftSegment<Real>> lift_segments;
  std::vector<Segment<Real>> rocker_ratios;
  ValveMotion<Real> valve_motions[kMaxTrains] = {};
  TriggerWheels triggers{};
  TriggerTrack trigger_tracks[kMaxTriggerWheels] = {};
  std::vector<std::uint32_t> trigger_edges;

  AllSections()
      : pressure_full(kMostGasSegments), pressure_motored(kMostGasSegments), pressure_heat(kMostGasSegments), gas_full(kMostGasSegments),
        gas_motored(kMostGasSegments), gas_heat(kMostGasSegments), cut_heat(kMostGasSegments), lift_segments(kMaxTrains * kDegreesPerTurn),
        rocker_ratios(kMaxTrains * kDegreesPerTurn), trigger_edges(kMaxTriggerWheels * kMaxTriggerEdges) {}

  TableTargets<Real> targets() {
    TableTargets<Real> t;
    t.drive = &drive, t.body = &body, t.stroke = &stroke, t.motion = &motion, t.lean = &lean, t.rod = &rod;
    t.rod_curvature = &rod_curvature, t.inertia_torque = &inertia_torque, t.bearings = &bearings;
    t.balance = &balance, t.gas_grid = &gas_grid, t.torque_grid = &torque_grid, t.gas_capacity = static_cast<int>(kMostGasSegments);
    t.pressure_full = pressure_full.data(), t.pressure_motored = pressure_motored.data(), t.pressure_heat = pressure_heat.data();
    t.gas_torque_full = &gas_torque_full, t.gas_torque_motored = &gas_torque_motored, t.gas_torque_heat = &gas_torque_heat;
    t.gas_full = gas_full.data(), t.gas_motored = gas_motored.data(), t.gas_heat = gas_heat.data();
    t.cut_grid = &cut_grid, t.cut_torque = &cut_torque, t.cut_heat = cut_heat.data(), t.crank_dynamics = &crank_dynamics;
    t.lift_curves = lift_curves, t.lift_segments = lift_segments.data(), t.rocker_ratios = rocker_ratios.data();
    t.valve_motions = valve_motions;
    t.triggers = &triggers, t.trigger_tracks = trigger_tracks, t.trigger_edges = trigger_edges.data();
    return t;
  }
};

/// Prints initialisers. Floating-point numbers are hexadecimal, so that the compiler reads back the same bits.
class Printer {
 public:
  explicit Printer(Output& out) : out_{out} {}

  void text(const std::string& s) { out_.write(s); }

  void number(float x) { hex(static_cast<double>(x), "F"); }
  void number(double x) { hex(x, ""); }
  void number(std::uint64_t x) { integer(x, "ULL"); }
  void number(std::uint32_t x) { integer(x, "U"); }
  void number(std::uint16_t x) { integer(x, ""); }
  void number(std::uint8_t x) { integer(x, ""); }

  template <class... Numbers>
  void list(const Numbers&... numbers) {
    bool first = true;
    text("{");
    ((text(first ? "" : ", "), first = false, print(numbers)), ...);
    text("}");
  }

  template <class Real>
  void print(const Segment<Real>& s) { array(s.c); }
  template <class Real>
  void print(const IntegratedSegment<Real>& s) { list(s.base, s.slope); }
  template <class Real>
  void print(const Turning<Real>& t) {
    list(t.up_cos, t.up_sin, t.lateral_cos, t.lateral_sin, t.pitch_cos, t.pitch_sin, t.yaw_cos, t.yaw_sin);
  }
  template <class Real>
  void print(const LiftSegment<Real>& s) { array(s.c); }
  // By structured binding, so that a member that is added cannot be forgotten here: it does not compile.
  template <class Real>
  void print(const ValveBody<Real>& body) {
    const auto& [mass, train, train_damping, seat, seat_damping, spring, guide, preload, sink, head_area, rocker, per_mass] = body;
    list(mass, train, train_damping, seat, seat_damping, spring, guide, preload, sink, head_area, rocker, per_mass);
  }
  template <class Real>
  void print(const StepRow<Real>& r) {
    const auto& [rest, gas, gas_rise, gap, rise, from, to, lift, velocity] = r;
    list(rest, gas, gas_rise, gap, rise, from, to, lift, velocity);
  }
  template <class Real>
  void print(const ForceRow<Real>& f) {
    const auto& [rest, gas, lift, velocity, gap, gap_speed] = f;
    list(rest, gas, lift, velocity, gap, gap_speed);
  }
  template <class Real>
  void print(const ContactGuard<Real>& g) {
    const auto& [sign, lag, least] = g;
    list(sign, lag, least);
  }
  template <class Real>
  void print(const RegimeStep<Real>& s) {
    const auto& [lift, velocity, acceleration, train, seat, rest, rest_speed, calm] = s;
    list(lift, velocity, acceleration, train, seat, rest, rest_speed, calm);
  }
  template <class Real>
  void print(const RegimeSeries<Real>& s) {
    const auto& [rest, gas, stiffness, damping, lift, lift_speed] = s;
    list(rest, gas, stiffness, damping, lift, lift_speed);
  }
  template <class Real>
  void print(const MiddleStep<Real>& s) {
    const auto& [lift_by_lift, lift_by_slope, velocity_by_lift, velocity_by_slope] = s;
    list(lift_by_lift, lift_by_slope, velocity_by_lift, velocity_by_slope);
  }
  template <class Real>
  void print(const ValveMotion<Real>& m) {
    const auto& [body, tick, fine, per_fine, per_parts, parts, per_parts_32, changes, widest, train_lag, seat_lag, per_seat, quiet, seat_rate,
                 whole_steps, fine_steps, series, middle] = m;
    list(body, tick, fine, per_fine, per_parts, parts, per_parts_32, changes, widest, train_lag, seat_lag, per_seat, quiet, seat_rate, whole_steps,
         fine_steps, series, middle);
  }
  template <class Real>
  void print(const IntegralSegment<Real>& s) { array(s.c); }
  template <class Real>
  void print(const MotionSegment<Real>& s) {
    const auto& [displacement, slope, acceleration] = s;
    list(displacement, slope, acceleration);
  }
  template <class Real>
  void print(const LeanSegment<Real>& s) {
    const auto& [tilt, radial] = s;
    list(tilt, radial);
  }
  template <class Real>
  void print(const RodSegment<Real>& s) {
    const auto& [angle, slope] = s;
    list(angle, slope);
  }
  void print(const CylinderGroups& g) {
    const auto& [cylinder, end] = g;
    list(cylinder, end);
  }
  template <class Real>
  void print(const CrankDynamics<Real>& c) {
    const auto& [turning, least, drag, drag_linear, drag_quadratic, stall, slope, most] = c;
    list(turning, least, drag, drag_linear, drag_quadratic, stall, slope, most);
  }
  template <class Record>
  void print(const Revolution<Record>& c) { braced([&] { rows(c.at, kDegreesPerTurn); }); }
  template <class Item, std::size_t N>
  void print(const Item (&items)[N]) { array(items); }
  template <class Number>
  void print(const Number& x) { number(x); }

  /// One object per line.
  template <class Item>
  void rows(const Item* items, std::size_t count) {
    text("{\n");
    for (std::size_t i = 0; i < count; ++i) {
      text("  ");
      print(items[i]);
      text(",\n");
    }
    text("}");
  }

  /// Numbers, twelve to a line.
  void lines(const std::uint32_t* numbers, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      text(i % 12 == 0 ? "  " : " ");
      number(numbers[i]);
      text(i % 12 == 11 || i + 1 == count ? ",\n" : ",");
    }
  }

  template <class Inside>
  void braced(const Inside& inside) {
    text("{");
    inside();
    text("}");
  }

 private:
  template <class Item, std::size_t N>
  void array(const Item (&items)[N]) {
    text("{");
    for (std::size_t i = 0; i < N; ++i) {
      if (i > 0) text(", ");
      print(items[i]);
    }
    text("}");
  }
  void hex(double x, const char* suffix) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%a%s", x, suffix);
    text(digits);
  }
  void integer(std::uint64_t x, const char* suffix) { text(std::to_string(x) + suffix); }

  Output& out_;
};

/// `constexpr TYPE name = ...;` around what print_value prints.
template <class PrintValue>
void section(Printer& p, const std::string& type, const std::string& name, const PrintValue& print_value) {
  p.text("\nconstexpr " + type + " " + name + " = ");
  print_value();
  p.text(";\n");
}

/// Lift and motion of the valve trains. Segments of all trains stand in one object, one train after the other, without the room that
/// tabulate leaves between them.
template <class Real>
void print_trains(Printer& p, const AllSections<Real>& s, const std::string& of_real) {
  const auto segments = [&](const std::string& type, const char* name, const auto& all) {
    section(p, type + of_real, std::string(name) + "[]", [&] {
      p.text("{\n");
      for (std::uint32_t t = 0; t < s.drive.trains; ++t) {
        for (std::uint32_t i = 0; i < s.lift_curves[t].rows(); ++i) {
          p.text("  ");
          p.print(all[t * std::size_t{kDegreesPerTurn} + i]);
          p.text(",\n");
        }
      }
      p.text("}");
    });
  };
  segments("crankloop::LiftSegment", "lift_segments", s.lift_segments);
  segments("crankloop::Segment", "rocker_ratios", s.rocker_ratios);
  section(p, "crankloop::LiftCurve" + of_real, "lift_curves[]", [&] {
    p.text("{\n");
    std::uint32_t first = 0;
    for (std::uint32_t t = 0; t < s.drive.trains; ++t) {
      const auto& [at, rocker_ratio, opens, most_phase_per_tick, count, touch_from, touch_degrees, leap_deg, outside] = s.lift_curves[t];
      p.text("  {lift_segments + " + std::to_string(first) + ", rocker_ratios + " + std::to_string(first) + ", ");
      p.print(opens);
      p.text(", ");
      p.number(most_phase_per_tick);
      for (const std::uint32_t number : {count, touch_from, touch_degrees}) {
        p.text(", ");
        p.number(number);
      }
      p.text(", ");
      p.number(leap_deg);
      p.text(", ");
      p.number(outside);
      p.text("},\n");
      first += s.lift_curves[t].rows();
      static_cast<void>(at);
      static_cast<void>(rocker_ratio);
    }
    p.text("}");
  });
  section(p, "crankloop::ValveMotion" + of_real, "valve_motions[]", [&] { p.rows(s.valve_motions, s.drive.trains); });
}

/// Trigger wheels. Edges of all wheels stand in one object, one wheel after the other.
void print_triggers(Printer& p, const TriggerWheels& triggers) {
  section(p, "std::uint32_t", "trigger_edges[]", [&] {
    p.text("{\n");
    for (std::uint32_t w = 0; w < triggers.count; ++w) p.lines(triggers.wheel[w].edges, triggers.wheel[w].edge_count);
    p.text("}");
  });
  section(p, "crankloop::TriggerTrack", "trigger_tracks[]", [&] {
    p.text("{\n");
    std::uint32_t first = 0;
    for (std::uint32_t w = 0; w < triggers.count; ++w) {
      const auto& [edges, edge_count, on_crank, starts, train, inverted, edges_before] = triggers.wheel[w];
      p.text("  {trigger_edges + " + std::to_string(first));
      const auto next = [&p](const auto& x) {
        p.text(", ");
        p.print(x);
      };
      next(edge_count), next(on_crank), next(starts), next(train), next(inverted), next(edges_before);
      p.text("},\n");
      first += edge_count;
      static_cast<void>(edges);
    }
    p.text("}");
  });
  section(p, "crankloop::TriggerWheels", "triggers", [&] { p.text("{trigger_tracks, " + std::to_string(triggers.count) + "}"); });
}

template <class Real>
void print_sections(Printer& p, const AllSections<Real>& s, const std::string& real, const TableReport& report) {
  const std::string of_real = "<" + real + ">";
  const auto type = [&](const char* name) { return "crankloop::" + std::string(name) + of_real; };
  const Drive<Real>& d = s.drive;
  section(p, type("Drive"), "drive", [&] {
    p.list(d.fingerprint, d.tick_s, d.per_tick_s, d.cycles_per_tick_per_rad_s, d.rad_s_per_cycle_per_tick, d.speed_limit_rad_s, d.cylinders, d.mechanisms,
           d.firing_phase, d.mechanism_of, d.turn_of, d.by_mechanism, d.trains);
  });
  const Body<Real>& b = s.body;
  section(p, type("Body"), "body", [&] {
    p.list(b.crank_radius_m, b.per_crank_radius, b.per_rod_length, b.pin_offset_m, b.height_at_tdc_m, b.bore_area_m2, b.crankcase_Pa,
           b.reciprocating_kg, b.rod_inertia_correction_kg_m2);
  });
  const auto integrated = [&](const char* name, const IntegratedCurve<Real>& curve) {
    section(p, type("IntegratedCurve"), name, [&] {
      p.braced([&] {
        p.number(curve.quantum);
        p.text(", ");
        p.rows(curve.at, kDegreesPerTurn);
      });
    });
  };
  integrated("stroke", s.stroke);
  section(p, "crankloop::Revolution<" + type("MotionSegment") + ">", "motion", [&] { p.print(s.motion); });
  section(p, "crankloop::Revolution<" + type("LeanSegment") + ">", "lean", [&] { p.print(s.lean); });
  section(p, "crankloop::Revolution<" + type("RodSegment") + ">", "rod", [&] { p.print(s.rod); });
  section(p, type("Curve"), "rod_curvature", [&] { p.print(s.rod_curvature); });
  integrated("inertia_torque", s.inertia_torque);
  const Bearings<Real>& g = s.bearings;
  section(p, type("Bearings"), "bearings", [&] { p.list(g.pins, g.pin_of, g.by_pin, g.rods_kg_m, g.throw_kg_m, g.throw_cos, g.throw_sin); });
  section(p, type("Balance"), "balance", [&] { p.list(s.balance.first, s.balance.second, s.balance.rotating, s.balance.cosine); });
  const auto grid = [&](const char* name, const GasGrid& of) { section(p, "crankloop::GasGrid", name, [&] { p.braced([&] { p.print(of.first); }); }); };
  grid("gas_grid", s.gas_grid);
  grid("torque_grid", s.torque_grid);
  grid("cut_grid", s.cut_grid);
  const auto pressure = [&](const char* name, const std::vector<Segment<Real>>& segments) {
    section(p, type("Segment"), std::string(name) + "[]", [&] { p.rows(segments.data(), static_cast<std::size_t>(report.gas_segments)); });
  };
  pressure("pressure_full", s.pressure_full);
  pressure("pressure_motored", s.pressure_motored);
  pressure("pressure_heat", s.pressure_heat);
  const auto torque = [&](const std::string& name, const GasTorque<Real>& curve, const std::vector<IntegratedSegment<Real>>& segments, int count) {
    section(p, type("IntegratedSegment"), name + "_segments[]", [&] { p.rows(segments.data(), static_cast<std::size_t>(count)); });
    section(p, type("GasTorque"), name, [&] {
      p.text("{" + name + "_segments, ");
      p.number(curve.quantum);
      p.text(", ");
      p.number(curve.mean_Nm);
      p.text("}");
    });
  };
  torque("gas_torque_full", s.gas_torque_full, s.gas_full, report.torque_segments);
  torque("gas_torque_motored", s.gas_torque_motored, s.gas_motored, report.torque_segments);
  torque("gas_torque_heat", s.gas_torque_heat, s.gas_heat, report.torque_segments);
  torque("cut_torque", s.cut_torque, s.cut_heat, report.cut_segments);
  section(p, type("CrankDynamics"), "crank_dynamics", [&] { p.print(s.crank_dynamics); });
  if (d.trains > 0) print_trains(p, s, of_real);
  if (s.triggers.count > 0) print_triggers(p, s.triggers);

  p.text("\nconstexpr crankloop::Sections" + of_real + " sections = [] {\n  crankloop::Sections" + of_real + " s;\n");
  for (const char* name : {"drive", "body", "stroke", "motion", "lean", "rod", "rod_curvature", "inertia_torque",
                           "bearings", "balance", "gas_grid", "torque_grid", "gas_torque_full", "gas_torque_motored", "gas_torque_heat",
                           "cut_grid", "cut_torque", "crank_dynamics"}) {
    p.text(std::string("  s.") + name + " = &" + name + ";\n");
  }
  for (const char* name : {"pressure_full", "pressure_motored", "pressure_heat"}) {
    p.text(std::string("  s.") + name + " = " + name + ";\n");
  }
  if (d.trains > 0) p.text("  s.lift_curves = lift_curves;\n  s.valve_motions = valve_motions;\n");
  if (s.triggers.count > 0) p.text("  s.triggers = &triggers;\n");
  p.text("  return s;\n}();\n");
}

template <class Real>
void print_header(Output& out, const EngineFile& engine, const Arguments& arguments) {
  const std::string& real = arguments.text("--real");
  const auto sections = std::make_unique<AllSections<Real>>();
  TableReport report;
  const TickOptions options{millionths(arguments.number("--tick-us")),
                            {arguments.text("--integrator") == "exponential" ? Integrator::exponential : Integrator::rk4,
                             millionths(arguments.number("--accuracy-um"))}};
  const Status status = tabulate(engine.definition(), options, sections->targets(), &report);
  if (!status.ok()) throw explain_tabulate(engine, status, options.tick_s, options.valves);
  const std::string& name_space = arguments.text("--namespace");
  Printer p(out);
  const bool has_valves = engine.definition().train_count > 0;
  p.text("// Tables of the engine \"" + engine.name() + "\" for a tick of " + shortest(arguments.number("--tick-us")) + " us, " + real +
         (has_valves ? "; valves: " + arguments.text("--integrator") + ", " + shortest(arguments.number("--accuracy-um")) + " um" : "") +
         ".\n// Made by `crankloop tables`; do not edit. Each section is an object of its own: what a scene does not read is not linked.\n"
         "#pragma once\n\n#include <crankloop/tick/tables.hpp>\n\nnamespace " + name_space + " {\n");
  print_sections(p, *sections, real, report);
  p.text("\n}  // namespace " + name_space + "\n");
}

bool is_identifier(const std::string& s) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  for (const char c : s) {
    if (!letter(c) && !(c >= '0' && c <= '9')) return false;
  }
  return !s.empty() && letter(s[0]);
}

int run_tables(const Arguments& arguments) {
  if (!is_identifier(arguments.text("--namespace"))) throw UsageError("--namespace must be a C++ identifier");
  const EngineFile engine = read_engine_file(arguments.file(), {"engine", "crank", "masses"});
  Output out(arguments.text_or_empty("--output"));
  if (arguments.text("--real") == "float") {
    print_header<float>(out, engine, arguments);
  } else {
    print_header<double>(out, engine, arguments);
  }
  out.finish();
  return kSuccess;
}

constexpr Option kOptions[] = {
    number("--tick-us", "T", from(1).up_to(2000), "tick length in microseconds"),
    choice("--real", "float|double", "arithmetic of the tick", "float"),
    choice("--integrator", "rk4|exponential", "of elastic valves", "rk4"),
    number("--accuracy-um", "A", from(0.01).up_to(10), "class of valve lift error: sets the sub-steps", "0.1"),
    {"--namespace", Option::Kind::text, "NAME", "C++ namespace of the tables", "crankloop_tables"},
    text("--output", "F", "file for the header; else standard output"),
};

}  // namespace

const Command kTables{"tables",
                      "the tables as a C++ header, for firmware",
                      "FILE --tick-us T [--real R] [--integrator I] [--accuracy-um A] [--namespace NAME] [--output F]",
                      "crankloop tables diesel_495.ini --tick-us 100 --real float > diesel_495_tables.hpp",
                      1,
                      kOptions,
                      run_tables};

}  // namespace crankloop::program

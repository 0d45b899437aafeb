// `crankloop tables FILE`: the tables as a C++ header of constexpr data, one object per section.
#include <cstddef>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include <crankloop/tabulate/table_members.hpp>
#include <crankloop/tabulate/tabulate.hpp>

#include "../command_line/commands.hpp"
#include "../command_line/engine_argument.hpp"
#include "../command_line/operating_point.hpp"
#include "../files/error.hpp"
#include "../files/output_file.hpp"
#include "../files/units.hpp"
#include "../loops/valve_tick_limit.hpp"

namespace crankloop::program {
namespace {

template <class Real>
using Stores = detail::part::Stores<Real, detail::part::RoomForAll>;

/// Prints initialisers. Floating-point numbers are hexadecimal, so that the compiler reads back the same bits.
class Printer {
 public:
  explicit Printer(Output& out) : out_{out} {}

  void text(const std::string& s) { out_.write(s); }

  /// A number, an array, a pointer to data printed before, or a record member by member.
  template <class Item>
  void print(const Item& item) {
    if constexpr (std::is_floating_point_v<Item>) {
      hex(static_cast<double>(item), sizeof item == sizeof(float) ? "F" : "");
    } else if constexpr (std::is_arithmetic_v<Item>) {
      text(std::to_string(item) + (sizeof item == 8 ? "ULL" : sizeof item == 4 ? "U" : ""));
    } else if constexpr (std::is_pointer_v<Item>) {
      text(item == nullptr ? "nullptr" : places_.at(item));
    } else if constexpr (std::is_array_v<Item>) {
      text("{");
      rows(item, std::extent_v<Item>);
      text("}");
    } else {
      text("{");
      std::apply([this](const auto&... member) { this->list(member...); }, members(item));
      text("}");
    }
  }

  /// Numbers twelve to a line, a record on each.
  template <class Item>
  void rows(const Item* items, std::size_t count) {
    constexpr std::size_t kPerLine = std::is_arithmetic_v<Item> ? 12 : 1;
    for (std::size_t i = 0; i < count; ++i) {
      if (count > 12) text(i % kPerLine == 0 ? "\n  " : " ");
      print(items[i]);
      if (i + 1 < count) text(count > 12 ? "," : ", ");
    }
  }

  /// From now on pointers to `item` are printed as `place`.
  void remember(const void* item, const std::string& place) { places_[item] = place; }

 private:
  template <class First, class... Others>
  void list(const First& first, const Others&... others) {
    print(first);
    ((text(", "), print(others)), ...);
  }
  void hex(double x, const char* suffix) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%a%s", x, suffix);
    text(digits);
  }

  Output& out_;
  std::map<const void*, std::string> places_;
};

/// Consecutive rows that are in use.
template <class Record>
struct Piece {
  const Record* first;
  std::size_t count;
};

/// The rows in use of a section that has several: in one piece, or in one per train or wheel without the unused rows
/// between them.
template <class Section, class Real, class Record>
std::vector<Piece<Record>> pieces_of(const Stores<Real>& s, const TableReport& report, const Record* rows) {
  const auto segments = [rows](int count) {
    return std::vector<Piece<Record>>{{rows, static_cast<std::size_t>(count)}};
  };
  std::vector<Piece<Record>> pieces;
  switch (Section::kRows) {
    case detail::SectionRows::one:
      return {{rows, 1}};
    case detail::SectionRows::gas_grid:
      return segments(report.gas_segments);
    case detail::SectionRows::torque_grid:
      return segments(report.torque_segments);
    case detail::SectionRows::cut_grid:
      return segments(report.cut_segments);
    case detail::SectionRows::cylinders:
      return {{rows, s.drive.cylinders}};
    case detail::SectionRows::trains:
      return {{rows, s.drive.trains}};
    case detail::SectionRows::wheels:
      return {{rows, s.triggers.count}};
    case detail::SectionRows::wheel_faults:
      for (std::uint32_t i = 0; i < s.wheel_faults.count; ++i) pieces.push_back({rows + i, 1});  // rules point to each
      return pieces;
    case detail::SectionRows::fault_edges:
      for (std::uint32_t i = 0; i < s.wheel_faults.count; ++i)
        pieces.push_back({rows + i * std::size_t{kMaxTriggerEdges}, s.fault_tracks[i].edge_count});
      return pieces;
    case detail::SectionRows::lobes:
      for (std::uint32_t t = 0; t < s.drive.trains; ++t)
        pieces.push_back({rows + t * std::size_t{kDegreesPerTurn}, s.lift_curves[t].rows()});
      return pieces;
    case detail::SectionRows::edges:
      for (std::uint32_t w = 0; w < s.triggers.count; ++w)
        pieces.push_back({rows + w * std::size_t{kMaxTriggerEdges}, s.trigger_tracks[w].edge_count});
      return pieces;
  }
  return pieces;
}

/// Whether an engine has what the sections of its cams' contacts need: a width, or for their sliding friction.
template <class Section, class Real>
bool lacks_contact(const Stores<Real>& s) {
  constexpr bool kOfStress = std::is_same_v<Section, detail::section::cam_contacts> ||
                             std::is_same_v<Section, detail::section::cam_contact_segments>;
  constexpr bool kOfSliding = std::is_same_v<Section, detail::section::cam_sliding>;
  if (!kOfStress && !kOfSliding) return false;
  for (std::uint32_t t = 0; t < s.drive.trains; ++t) {
    if (s.cam_contacts[t].per_width_m > 0) return false;
    if (kOfSliding && s.cam_torques[t].sliding_m != nullptr) return false;
  }
  return true;
}

/// Prints a section as an object or array of its name. If the engine has no trains, wheels or sensor, prints one of
/// zeros that no tick reads, so that scenes with room for them compile. False if a section has no rows.
template <class Section, class Real>
bool print_section(Printer& p, const Stores<Real>& s, const TableReport& report, const std::string& real) {
  constexpr bool kOne = Section::kRows == detail::SectionRows::one;
  constexpr bool kOfGas =
      std::is_same_v<Section, detail::section::gas_cylinders> || std::is_same_v<Section, detail::section::gas_ports> ||
      std::is_same_v<Section, detail::section::gas_manifolds> || std::is_same_v<Section, detail::section::burn>;
  if (kOfGas && !(s.gas_cylinders.clearance_m3 > 0)) return false;  // an engine without gas exchange
  if (lacks_contact<Section>(s)) return false;
  const std::string name = Section::kName;
  const std::string object = "\nconstexpr crankloop::detail::section::" + name + "::Record<" + real + "> " + name;
  const bool none = (std::is_same_v<Section, detail::section::triggers> && s.triggers.count == 0) ||
                    (std::is_same_v<Section, detail::section::wheel_faults> && s.wheel_faults.count == 0) ||
                    (std::is_same_v<Section, detail::section::reluctor> && s.reluctor.in_use == 0);
  if (none) {
    p.text(object + " = {}");
  } else if constexpr (kOne) {
    p.text(object + " = ");
    p.print(Section::in(s));
  } else {
    std::size_t printed = 0;
    for (const auto& piece : pieces_of<Section>(s, report, Section::in(s))) {
      if (piece.count == 0) continue;
      p.text(printed == 0 ? object + "[] = {" : ",");
      p.remember(piece.first, name + " + " + std::to_string(printed));
      p.rows(piece.first, piece.count);
      printed += piece.count;
    }
    if (printed == 0 && Section::kRows != detail::SectionRows::trains) return false;
    p.text(printed == 0 ? object + "[1] = {}" : "\n}");
  }
  p.text(";\n");
  return true;
}

template <class Real>
void print_sections(Printer& p, const Stores<Real>& s, const std::string& real, const TableReport& report) {
  std::string all;
  detail::sections([&](auto section) {
    if (!print_section<decltype(section)>(p, s, report, real) || !section.kRead) return;
    all += std::string("  s.") + section.kName + " = " + (section.kRows == detail::SectionRows::one ? "&" : "") +
           section.kName + ";\n";
  });
  const std::string type = "crankloop::Sections<" + real + ">";
  p.text("\nconstexpr " + type + " sections = [] {\n  " + type + " s;\n" + all + "  return s;\n}();\n");
}

template <class Real>
void print_header(Output& out, const EngineFile& engine, const Arguments& arguments) {
  const std::string& real = arguments.text("--real");
  const auto stores = std::make_unique<Stores<Real>>();
  TableReport report;
  const TickOptions options{
      millionths(arguments.number("--tick-us")),
      {arguments.text("--integrator") == "exponential" ? Integrator::exponential : Integrator::rk4,
       millionths(arguments.number("--accuracy-um")),
       arguments.has("--event-budget") ? arguments.whole_number("--event-budget") : 0},
      arguments.has("--max-rpm") ? arguments.number("--max-rpm") / kRpmPerRad_s : 0};
  const Status status = tabulate(engine.definition(), options, stores->targets(), &report);
  if (!status.ok()) throw explain_tabulate(engine, status, options.tick_s, options.valves);
  const std::string& name_space = arguments.text("--namespace");
  Printer p(out);
  const bool has_valves = engine.definition().train_count > 0;
  p.text("// Tables of the engine \"" + engine.name() + "\" for a tick of " + shortest(arguments.number("--tick-us")) +
         " us, " + real +
         (has_valves ? "; valves: " + arguments.text("--integrator") + ", " +
                           shortest(arguments.number("--accuracy-um")) + " um"
                     : "") +
         ".\n// Made by `crankloop tables`; do not edit. Each section is a separate object: sections that a scene "
         "does not read are not linked.\n"
         "#pragma once\n\n#include <crankloop/tables/tables.hpp>\n\nnamespace " +
         name_space + " {\n");
  print_sections(p, *stores, real, report);
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
  const EngineFile engine = read_engine(arguments, {"engine", "crank", "masses"});
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
    kTick,
    choice("--real", "float|double", "arithmetic of the tick", "float"),
    choice("--integrator", "rk4|exponential", "of elastic valves", "rk4"),
    number("--accuracy-um", "A", from(0.01).up_to(10), "class of valve lift error: sets the sub-steps", "0.1"),
    whole_number("--event-budget", "N", from(3).up_to(kMaxEventBudget),
                 "work for valve events in a tick, else by the engine"),
    number("--max-rpm", "N", above(0).up_to(100000), "the highest speed the engine can have, else the file's max_rpm"),
    {"--namespace", Option::Kind::text, "NAME", "C++ namespace of the tables", "crankloop_tables"},
    text("--output", "F", "file for the header, -o for short; else standard output"),
};

}  // namespace

const Command kTables{"tables",
                      "the tables as a C++ header, for firmware",
                      "FILE [--tick-us T] [--real R] [--integrator I] [--accuracy-um A] [--event-budget N] [--max-rpm "
                      "N] [--namespace NAME] [--output F]",
                      "crankloop tables diesel_495.ini --tick-us 100 --real float > diesel_495_tables.hpp",
                      1,
                      kOptions,
                      run_tables};

}  // namespace crankloop::program

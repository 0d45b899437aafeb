// `crankloop tables FILE`: the tables as a C++ header of constexpr data, one object per section.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <string_view>
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

  void text(std::string_view s) { out_.write(s); }

  /// A number, an array, a pointer to data printed before, or a record member by member.
  template <class Item>
  void print(const Item& item) {
    if constexpr (std::is_floating_point_v<Item>) {
      hex(static_cast<double>(item), sizeof item == sizeof(float) ? "F" : "");
    } else if constexpr (std::is_arithmetic_v<Item>) {
      static_assert(std::is_unsigned_v<Item>);
      whole(item, sizeof item);
    } else if constexpr (std::is_pointer_v<Item>) {
      place(item);
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

  // Not inline: print() is instantiated for every record, and compiled in seconds instead of most of a minute.
  void hex(double x, const char* suffix);
  void whole(std::uint64_t n, std::size_t bytes);
  void place(const void* item);

  Output& out_;
  std::map<const void*, std::string> places_;
};

void Printer::hex(double x, const char* suffix) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%a%s", x, suffix);
  text(digits);
}

void Printer::whole(std::uint64_t n, std::size_t bytes) {
  text(std::to_string(n) + (bytes == 8 ? "ULL" : bytes == 4 ? "U" : ""));
}

void Printer::place(const void* item) { text(item == nullptr ? "nullptr" : places_.at(item)); }

/// Consecutive rows that are in use.
struct Piece {
  std::size_t first;
  std::size_t count;
};

/// The rows in use of a section that has several: in one piece, or in one per train or wheel without the unused rows
/// between them.
template <class Real>
std::vector<Piece> pieces_of(detail::SectionRows rows, const Stores<Real>& s, const TableReport& report) {
  const auto from_first = [](std::size_t count) { return std::vector<Piece>{{0, count}}; };
  const auto each = [](std::size_t count, std::size_t stride, auto in_use) {
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < count; ++i) pieces.push_back({i * stride, in_use(i)});
    return pieces;
  };
  switch (rows) {
    case detail::SectionRows::one:
      return from_first(1);
    case detail::SectionRows::gas_grid:
      return from_first(static_cast<std::size_t>(report.gas_segments));
    case detail::SectionRows::torque_grid:
      return from_first(static_cast<std::size_t>(report.torque_segments));
    case detail::SectionRows::cut_grid:
      return from_first(static_cast<std::size_t>(report.cut_segments));
    case detail::SectionRows::cylinders:
      return from_first(s.drive.cylinders);
    case detail::SectionRows::trains:
      return from_first(s.drive.trains);
    case detail::SectionRows::wheels:
      return from_first(s.triggers.count);
    case detail::SectionRows::wheel_faults:  // one each, for rules point to each
      return each(s.wheel_faults.count, 1, [](std::size_t) { return std::size_t{1}; });
    case detail::SectionRows::fault_edges:
      return each(s.wheel_faults.count, kMaxTriggerEdges, [&](std::size_t i) { return s.fault_tracks[i].edge_count; });
    case detail::SectionRows::lobes:
      return each(s.drive.trains, kDegreesPerTurn, [&](std::size_t t) { return s.lift_curves[t].rows(); });
    case detail::SectionRows::edges:
      return each(s.triggers.count, kMaxTriggerEdges, [&](std::size_t w) { return s.trigger_tracks[w].edge_count; });
  }
  return {};
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

std::string declaration_of(const char* section, const std::string& real) {
  const std::string name = section;
  return "\nconstexpr crankloop::detail::section::" + name + "::Record<" + real + "> " + name;
}
std::string place_in(const char* section, std::size_t row) {
  return std::string(section) + " + " + std::to_string(row);
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
  const std::string object = declaration_of(Section::kName, real);
  const bool none = (std::is_same_v<Section, detail::section::triggers> && s.triggers.count == 0) ||
                    (std::is_same_v<Section, detail::section::wheel_faults> && s.wheel_faults.count == 0) ||
                    (std::is_same_v<Section, detail::section::reluctor> && s.reluctor.in_use == 0) ||
                    (std::is_same_v<Section, detail::section::sensor_faults> && s.sensor_faults.count == 0);
  if (none) {
    p.text(object);
    p.text(" = {}");
  } else if constexpr (kOne) {
    p.text(object);
    p.text(" = ");
    p.print(Section::in(s));
  } else {
    const auto* const rows = Section::in(s);
    std::size_t printed = 0;
    for (const Piece& piece : pieces_of(Section::kRows, s, report)) {
      if (piece.count == 0) continue;
      if (printed == 0) p.text(object);
      p.text(printed == 0 ? "[] = {" : ",");
      p.remember(rows + piece.first, place_in(Section::kName, printed));
      p.rows(rows + piece.first, piece.count);
      printed += piece.count;
    }
    if (printed == 0) {
      if (Section::kRows != detail::SectionRows::trains) return false;
      p.text(object);
    }
    p.text(printed == 0 ? "[1] = {}" : "\n}");
  }
  p.text(";\n");
  return true;
}

std::string set_pointer(const char* section, bool one) {
  const std::string name = section;
  return "  s." + name + " = " + (one ? "&" : "") + name + ";\n";
}

template <class Real>
void print_sections(Printer& p, const Stores<Real>& s, const std::string& real, const TableReport& report) {
  std::string all;
  detail::sections([&](auto section) {
    if (!print_section<decltype(section)>(p, s, report, real) || !section.kRead) return;
    all += set_pointer(section.kName, section.kRows == detail::SectionRows::one);
  });
  const std::string type = "crankloop::Sections<" + real + ">";
  p.text("\nconstexpr " + type + " sections = [] {\n  " + type + " s;\n" + all + "  return s;\n}();\n");
}

/// Of an --event-budget below what tabulate takes: the fine steps of any valve in a tick, and an event.
[[noreturn]] void refuse_event_budget(const EngineFile& engine, TickOptions options) {
  const int budget = options.valves.event_budget;
  options.valves.event_budget = 0;
  detail::ValveMotion<double> motions[kMaxTrains];
  TableTargets<double> targets;
  targets.valve_motions = motions;
  const Status status = tabulate(engine.definition(), options, targets);
  if (!status.ok()) throw explain_tabulate(engine, status, options.tick_s, options.valves);
  std::uint32_t parts = 0;
  for (int t = 0; t < engine.definition().train_count; ++t) parts = std::max(parts, motions[t].parts);
  const std::string least = std::to_string(parts + detail::kUnitsOfEvent);
  throw UsageError("--event-budget: " + std::to_string(budget) + " is too small: a valve needs " + least +
                   " here; allowed: " + least + " to " + std::to_string(kMaxEventBudget));
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
  if (status.field == std::string_view("options.valves.event_budget")) refuse_event_budget(engine, options);
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

/// Of C++20, and with it of any C++ that the library is compiled as.
constexpr std::string_view kKeywords[] = {
    "alignas",     "alignof",  "and",        "and_eq",    "asm",       "auto",         "bitand",
    "bitor",       "bool",     "break",      "case",      "catch",     "char",         "char16_t",
    "char32_t",    "char8_t",  "class",      "co_await",  "co_return", "co_yield",     "compl",
    "concept",     "const",    "const_cast", "consteval", "constexpr", "constinit",    "continue",
    "decltype",    "default",  "delete",     "do",        "double",    "dynamic_cast", "else",
    "enum",        "explicit", "export",     "extern",    "false",     "float",        "for",
    "friend",      "goto",     "if",         "inline",    "int",       "long",         "mutable",
    "namespace",   "new",      "noexcept",   "not",       "not_eq",    "nullptr",      "operator",
    "or",          "or_eq",    "private",    "protected", "public",    "register",     "reinterpret_cast",
    "requires",    "return",   "short",      "signed",    "sizeof",    "static",       "static_assert",
    "static_cast", "struct",   "switch",     "template",  "this",      "thread_local", "throw",
    "true",        "try",      "typedef",    "typeid",    "typename",  "union",        "unsigned",
    "using",       "virtual",  "void",       "volatile",  "wchar_t",   "while",        "xor",
    "xor_eq"};

bool is_identifier(const std::string& s) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  for (const char c : s) {
    if (!letter(c) && !(c >= '0' && c <= '9')) return false;
  }
  return !s.empty() && letter(s[0]) && std::find(std::begin(kKeywords), std::end(kKeywords), s) == std::end(kKeywords);
}

int run_tables(const Arguments& arguments) {
  if (!is_identifier(arguments.text("--namespace")))
    throw UsageError("--namespace must be a C++ identifier, and no keyword");
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

constexpr Option kTablesOptions[] = {
    kTick,
    choice("--real", "float|double", "arithmetic of the tick", "float"),
    choice("--integrator", "rk4|exponential", "of elastic valves", "rk4"),
    number("--accuracy-um", "A", from(0.01).up_to(10), "class of valve lift error: sets the sub-steps", "0.1"),
    whole_number("--event-budget", "N", from(3).up_to(kMaxEventBudget),
                 "work for valve events in a tick; default by the engine"),
    number("--max-rpm", "N", above(0).up_to(100000), "highest engine speed in rpm; default the file's max_rpm"),
    {"--namespace", Option::Kind::text, "NAME", "C++ namespace of the tables", "crankloop_tables"},
    text("--output", "F", "file for the header, -o for short; default standard output"),
};

}  // namespace

const Command kTables{"tables",
                      "the tables as a C++ header, for firmware",
                      "FILE [--tick-us T] [--real R] [--integrator I] [--accuracy-um A] [--event-budget N] [--max-rpm "
                      "N] [--namespace NAME] [--output F]",
                      "crankloop tables diesel_495.ini --tick-us 100 --real float > diesel_495_tables.hpp",
                      1,
                      kTablesOptions,
                      run_tables};

}  // namespace crankloop::program

// `crankloop study FILE --vary NAME=VALUES --of COMMAND.NAME`: figures of commands over one or two varied quantities.
#include "study.hpp"

#include <algorithm>
#include <string>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/results.hpp"
#include "../../command_line/shards.hpp"
#include "../../engine_file/following_springs.hpp"
#include "../../engine_file/plausibility.hpp"
#include "../../files/csv.hpp"
#include "../../files/error.hpp"
#include "../../files/text_file.hpp"
#include "../../files/words.hpp"

namespace crankloop::program {
namespace {

/// A command that has figures.
const Command& command_of(const std::string& figure) {
  const std::string name = figure.substr(0, figure.find('.'));
  std::vector<std::string> names;
  for (const Command* command : commands()) {
    if (command->figures == nullptr) continue;
    if (name == command->name) return *command;
    names.emplace_back(command->name);
  }
  throw UsageError("--of " + in_quotes(figure) + ": write COMMAND.NAME, like valve.max_lift; commands: " + join(names) +
                   suggestion(name, names));
}

void add_figure(Study& study, const std::string& text) {
  const Command& command = command_of(text);
  const std::size_t point = text.find('.');
  if (point == std::string::npos || point + 1 == text.size())
    throw UsageError("--of " + in_quotes(text) + ": write COMMAND.NAME, like valve.max_lift");
  const auto found = std::find(study.commands.begin(), study.commands.end(), &command);
  const auto index = static_cast<std::size_t>(found - study.commands.begin());
  if (found == study.commands.end()) study.commands.push_back(&command);
  const std::string name = text.substr(point + 1);
  for (const StudiedFigure& other : study.figures) {
    if (other.command == index && other.name == name) throw UsageError("--of " + text + " is given twice");
  }
  study.figures.push_back({index, name});
}

/// Numbers, choices and names; not flags and files.
std::vector<const Option*> options_to_vary(const std::vector<const Command*>& commands) {
  std::vector<const Option*> options;
  for (const Command* command : commands) {
    for (const Option& option : command->options) {
      const bool is_name = option.kind == Option::Kind::text && std::string_view(option.value) == "NAME";
      if (is_name || option.kind == Option::Kind::number || option.kind == Option::Kind::whole_number ||
          option.kind == Option::Kind::choice)
        options.push_back(&option);
    }
  }
  return options;
}

std::string read_text(const std::string& path) {
  FileBytes file = read_file(path, kMaxEngineFileBytes);
  if (!file.ok()) throw InputError(path + ": " + file.problem);
  return std::move(file.bytes);
}

/// What the results depend on: the engine, its tables, what is asked.
Identity identity_of(const Study& study, const Arguments& arguments) {
  Identity identity;
  identity.add_engine(study.file);
  for (const Variation& axis : study.axes) {
    if (!axis.target.key || axis.target.key->key->kind != Kind::path) continue;
    for (const std::string& name : axis.values) identity.add_file(study.file, name);
  }
  for (const char* option : {"--vary", "--of", "--set"}) {
    identity.add(option);
    for (const std::string& word : arguments.words(option)) identity.add(word);
  }
  return identity;
}

std::string command_line(const Arguments& arguments) {
  std::string text = "crankloop study " + shell_word(arguments.file());
  for (const char* option : {"--vary", "--set", "--of"}) {
    if (!arguments.has(option)) continue;
    text += std::string(" ") + option;
    for (const std::string& word : arguments.words(option)) text += " " + shell_word(word);
  }
  return text;
}

/// Whether both are names of one quantity, of which only one can have its value.
bool are_one(const Target& a, const Target& b) {
  return a.name() == b.name() || (a.key && b.key && undoes(*a.key, *b.key));
}

void add_axes(Study& study, const Arguments& arguments, const std::vector<const Option*>& options) {
  for (const std::string& text : arguments.words("--vary")) {
    study.axes.push_back(parse_variation(text, study.file, options));
    const Target& varied = study.axes.back().target;
    for (std::size_t a = 0; a + 1 < study.axes.size(); ++a) {
      const Target& other = study.axes[a].target;
      if (other.name() == varied.name()) throw UsageError("--vary: " + varied.name() + " is varied twice");
      if (are_one(other, varied))
        throw UsageError("--vary: " + other.name() + " and " + varied.name() + " are one quantity; vary one of them");
    }
    for (const Constant& constant : study.options) {
      if (constant.target.name() == varied.name())
        throw UsageError("--set: " + varied.name() + " is varied; give it once");
    }
    // A key may be in both: --set then makes the file of the engine whole.
    for (const Setting& setting : study.settings) {
      if (varied.key && setting.place.key != varied.key->key && are_one({setting.place}, varied))
        throw UsageError("--set: " + setting.place.text() + " and the varied " + varied.name() +
                         " are one quantity; give one of them");
    }
  }
  if (study.axes.size() > 2) throw UsageError("--vary: at most two quantities are varied at once");
  double count = 1;
  for (const Variation& axis : study.axes) count *= static_cast<double>(axis.values.size());
  if (count > kMaxStudyPoints)
    throw UsageError("a study of " + brief(count) + " points; at most " + brief(kMaxStudyPoints) + " are allowed");
}

/// Warns where figures of ready-made scenes are asked for of springs that surge: there they follow their valves.
void warn_of_springs_that_follow(const Study& study, const Arguments& arguments) {
  const auto steps_surge = [](const Command* command) { return command == &kValve || command == &kRedline; };
  if (std::all_of(study.commands.begin(), study.commands.end(), steps_surge)) return;
  std::vector<std::string> lines = warnings_about_springs_that_follow(study.file);
  for (const Variation& axis : study.axes) {
    if (axis.target.key && std::string_view(axis.target.key->key->name) == "surge_modes")
      lines.push_back(study.file.path() + ": warning: --vary " + axis.target.name() +
                      " changes nothing that run, balance or kinematics print: springs follow their valves there");
  }
  (void)tell_warnings(arguments, lines);
}

/// Refuses a study of nothing but gaps.
void require_a_number(const Study& study) {
  for (const StudyResult& result : study.results) {
    for (const std::optional<double>& value : result.values) {
      if (value) return;
    }
  }
  throw InputError("no point has a number; the first, " + study.place_of(0) + ": " + study.results[0].refused);
}

void write_csv(Output& out, const Study& study) {
  std::vector<std::string> header;
  for (const Variation& axis : study.axes) header.push_back(axis.target.name());
  for (const StudiedFigure& figure : study.figures) header.push_back(study.column_of(figure));
  header.emplace_back("refused");
  CsvWriter csv(out, header);
  for (std::size_t point = 0; point < study.results.size(); ++point) {
    for (std::size_t a = 0; a < study.axes.size(); ++a) {
      const Variation& axis = study.axes[a];
      const std::size_t i = study.index(point, a);
      if (axis.is_of_words()) {
        csv.quoted_cell(axis.values[i]);
      } else {
        csv.cell(axis.numbers[i]);
      }
    }
    for (const std::optional<double>& value : study.results[point].values) {
      if (value) {
        csv.cell(*value);
      } else {
        csv.cell("");
      }
    }
    csv.quoted_cell(study.results[point].refused);
    csv.end_row();
  }
}

/// Where a figure is smallest and largest.
std::string range_in_words(const Study& study, std::size_t figure) {
  std::optional<std::size_t> least, most;
  const auto at = [&](std::size_t point) { return *study.results[point].values[figure]; };
  for (std::size_t point = 0; point < study.results.size(); ++point) {
    if (!study.results[point].values[figure]) continue;
    if (!least || at(point) < at(*least)) least = point;
    if (!most || at(point) > at(*most)) most = point;
  }
  if (!least) return "no point has it";
  return "from " + brief(at(*least)) + " at " + study.place_of(*least) + " to " + brief(at(*most)) + " at " +
         study.place_of(*most);
}

std::string summary(const Study& study) {
  Summary s;
  std::vector<std::string> names;
  for (const Variation& axis : study.axes) names.push_back(axis.target.name());
  s.remark("study over " + join(names, " and ") + ": " + study.file.path() +
           "; values as the file and defaults have them, then the range of the points");
  s.line("points", study.results.size());
  std::size_t refused = 0;
  std::string first;
  for (std::size_t point = 0; point < study.results.size(); ++point) {
    if (study.results[point].refused.empty()) continue;
    if (refused++ == 0) first = "the first at " + study.place_of(point) + ": " + study.results[point].refused;
  }
  s.line("points_with_gaps", refused, "", first);
  for (std::size_t i = 0; i < study.figures.size(); ++i) {
    const StudiedFigure& figure = study.figures[i];
    const std::string name = std::string(study.commands[figure.command]->name) + "." + figure.name;
    if (study.own.values[i]) {
      s.line(name, *study.own.values[i], figure.unit, range_in_words(study, i));
    } else {
      s.none(name, figure.unit, range_in_words(study, i));
    }
  }
  return s.text();
}

/// What --set asks for.
void add_constants(Study& study, const Arguments& arguments, const std::vector<const Option*>& options) {
  std::vector<Target> set;
  for (const std::string& one : arguments.words("--set")) {
    const Constant constant = parse_constant(one, study.file, options);
    for (const Target& other : set) {
      if (other.name() == constant.target.name()) throw UsageError("--set: " + other.name() + " is set twice");
      if (are_one(other, constant.target))
        throw UsageError("--set: " + other.name() + " and " + constant.target.name() + " are one quantity; give one");
    }
    set.push_back(constant.target);
    if (constant.target.key) {
      study.settings.push_back({*constant.target.key, constant.value});
    } else {
      study.options.push_back(constant);
    }
  }
}

/// The CSV on standard output where no file is asked for.
void write(const Study& study, const Arguments& arguments, Results& results) {
  if (!arguments.has("--csv") && !arguments.has("--report") && !arguments.has("--plot")) {
    Output out("");
    write_csv(out, study);
    out.finish();
    return;
  }
  if (Output* csv = results["--csv"]) write_csv(*csv, study);
  if (Output* page = results["--report"]) page->write(report::to_html(study_page(study)));
  if (Output* plot = results["--plot"]) plot->write(report::to_svg_file(study_sheet(study)));
  results.finish(summary(study));
}

int run_study(const Arguments& arguments) {
  const std::string text = read_text(arguments.file());
  const EngineFile as_is = read_engine_text(text, arguments.file(), {});
  Study request{as_is, text, {}, {}, {}, {}};
  for (const std::string& figure : arguments.words("--of")) add_figure(request, figure);
  const std::vector<const Option*> options = options_to_vary(request.commands);
  add_constants(request, arguments, options);
  const EngineFile file = read_engine_text(text, arguments.file(), {}, request.settings);
  for (const Setting& setting : request.settings) require_used(file, setting.place);
  (void)tell_warnings(arguments, warnings_about(file));
  Study study{file, text, request.settings, request.options, request.commands, request.figures};
  add_axes(study, arguments, options);
  warn_of_springs_that_follow(study, arguments);
  study.command_line = command_line(arguments);
  survey(study);
  Results results(arguments, {"--csv", "--report", "--plot"});
  const Points points{"study", "studying", study.points(), identity_of(study, arguments)};
  const auto texts = results_of(arguments, points, {"--csv", "--report", "--plot"},
                                [&study](std::size_t point) { return run_point(study, point).text(); });
  if (!texts) return kSuccess;
  for (const std::string& one : *texts) study.results.push_back(parse_result(one));
  require_a_number(study);
  write(study, arguments, results);
  return kSuccess;
}

constexpr Option kStudyOptions[] = {
    required(
        words("--vary", "NAME=VALUES...",
              "one or two of: SECTION.KEY of the engine file, SECTION.NAME.KEY, KEY.3 for an entry of a list, or an "
              "option like rpm; VALUES: FROM:TO:N, or A,B,C")),
    required(words("--of", "COMMAND.NAME...",
                   "numbers that kinematics, balance, valve, redline or run prints: valve.max_lift, balance.power_kW")),
    words("--set", "NAME=VALUE...", "keys and options with another value than the file's or the default one"),
    kThreads,
    kShard,
    kPart,
    kJoin,
    text("--csv", "F",
         "file for a row per point, with the reason where a number is missing; without it, --report and "
         "--plot standard output"),
    text("--report", "F.html", "HTML file with curves, or heat maps of two quantities; opens in any browser"),
    text("--plot", "F.svg", "SVG file with the same drawings"),
};

}  // namespace

const Command kStudy{"study",
                     "numbers of kinematics, balance, valve, redline or run over one or two keys or options",
                     "FILE --vary NAME=VALUES [NAME=VALUES] --of COMMAND.NAME... [--set NAME=VALUE...] [--threads N]\n"
                     "       [--csv F] [--report F.html] [--plot F.svg] [--shard K/N --part F | --join F...]",
                     "crankloop study ohc_125.ini --vary rocker.intake.clearance_mm=0.02:0.2:10 rpm=6000:9000:7 --set "
                     "train=intake --of valve.seating_speed valve.bounces --report study.html",
                     1,
                     kStudyOptions,
                     run_study};

}  // namespace crankloop::program

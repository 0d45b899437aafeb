// The points of a study: commands run in this process, without output, with other values of the engine file.
#include <algorithm>
#include <cmath>

#include "../../files/error.hpp"
#include "../../files/words.hpp"
#include "study.hpp"

namespace crankloop::program {
namespace {

/// What a command prints at a point, or why nothing.
struct Outcome {
  Summary summary{};
  std::string refused{};
};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// The values of a point: of its axes, none for the file's own.
struct Values {
  std::vector<Setting> settings;
  std::vector<std::pair<const Option*, std::string>> options;
};

void add(Values& values, const Target& target, const std::string& value) {
  if (target.key) {
    values.settings.push_back({*target.key, value});
  } else {
    values.options.emplace_back(target.option, value);
  }
}

Values values_of(const Study& study, const std::optional<std::size_t>& point) {
  Values values{study.settings, {}};
  for (const Constant& constant : study.options) add(values, constant.target, constant.value);
  for (std::size_t a = 0; point && a < study.axes.size(); ++a)
    add(values, study.axes[a].target, study.axes[a].values[study.index(*point, a)]);
  return values;
}

Arguments arguments_of(const Command& command, const Values& values, const std::string& path) {
  std::vector<std::string> words;
  for (const auto& [option, value] : values.options) {
    const std::string_view name = option->name;
    const bool has = std::any_of(command.options.begin(), command.options.end(),
                                 [name](const Option& own) { return name == own.name; });
    if (has) words.push_back(option->name + ("=" + value));
  }
  words.insert(words.end(), {"--", path});
  return {command, words};
}

std::vector<Outcome> outcomes(const Study& study, const Values& values, const EngineFile& file) {
  std::vector<Outcome> outcomes;
  for (const Command* command : study.commands) {
    Outcome outcome;
    try {
      outcome.summary = command->figures(arguments_of(*command, values, file.path()), file);
    } catch (const InputError& refused) {
      outcome.refused = std::string(command->name) + ": " + first_line(refused.what());
    }
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

std::vector<Outcome> outcomes_at(const Study& study, const std::optional<std::size_t>& point) {
  const Values values = values_of(study, point);
  if (values.settings.size() == study.settings.size()) return outcomes(study, values, study.file);
  try {
    const EngineFile file = read_engine_text(study.text, study.file.path(), {}, values.settings);
    for (const Setting& setting : values.settings) require_used(file, setting.place);
    return outcomes(study, values, file);
  } catch (const InputError& refused) {
    return {study.commands.size(), {{}, first_line(refused.what())}};
  }
}

const Figure* find(const Summary& summary, const std::string& name) {
  for (const Figure& figure : summary.figures()) {
    if (figure.name == name) return &figure;
  }
  return nullptr;
}

StudyResult result_of(const Study& study, const std::vector<Outcome>& outcomes) {
  StudyResult result;
  std::vector<std::string> reasons;
  const auto lacks = [&](const std::string& reason) {
    if (std::find(reasons.begin(), reasons.end(), reason) == reasons.end()) reasons.push_back(reason);
    result.values.emplace_back();
  };
  for (const StudiedFigure& studied : study.figures) {
    const Outcome& outcome = outcomes[studied.command];
    const std::string name = std::string(study.commands[studied.command]->name) + "." + studied.name;
    const Figure* figure = find(outcome.summary, studied.name);
    if (!outcome.refused.empty()) {
      lacks(outcome.refused);
    } else if (figure == nullptr) {
      lacks(name + " is not there");
    } else if (!figure->number) {
      lacks(name + " is " + figure->word);
    } else if (!std::isfinite(*figure->number)) {
      lacks(name + " is not finite");
    } else {
      result.values.push_back(figure->number);
    }
  }
  result.refused = join(reasons, "; ");
  return result;
}

/// The figure as a command prints it; refuses a misspelt one, and one that is a word.
const Figure& known_figure(const Study& study, const StudiedFigure& studied, const Summary& summary) {
  const std::string command = study.commands[studied.command]->name;
  const Figure* figure = find(summary, studied.name);
  if (figure != nullptr && !figure->number && figure->word != "none")
    throw UsageError("--of " + command + "." + studied.name + " is no number but a word: " + figure->word);
  if (figure != nullptr) return *figure;
  std::vector<std::string> names;
  for (const Figure& one : summary.figures()) names.push_back(one.name);
  std::string help = suggestion(studied.name, names);
  if (help.empty()) {
    const std::vector<std::string> few = nearest(studied.name, names, 5);
    help = (few.empty() ? "" : "; nearest are " + join(few)) + "; `crankloop " + command + " FILE` lists all " +
           std::to_string(names.size());
  }
  throw UsageError("--of: `crankloop " + command + "` prints no " + in_quotes(studied.name) + " here" + help);
}

/// `own`, or where it lacks the figure that of the first or last point, which may have what the file has not.
Summary summary_with(const Study& study, const StudiedFigure& studied, const Summary& own) {
  if (find(own, studied.name) != nullptr) return own;
  for (const std::size_t point : {std::size_t{0}, study.points() - 1}) {
    Outcome outcome = outcomes_at(study, point)[studied.command];
    if (find(outcome.summary, studied.name) != nullptr) return outcome.summary;
  }
  return own;
}

/// The units of a command's figures, by the first point at which it prints them, the file's own before all.
void find_units(Study& study, std::size_t command, const std::vector<Outcome>& own) {
  std::string refused = own[command].refused;
  Summary summary = own[command].summary;
  for (std::size_t point = 0; !refused.empty() && point < study.points(); ++point) {
    Outcome outcome = outcomes_at(study, point)[command];
    if (outcome.refused.empty()) summary = std::move(outcome.summary);
    if (outcome.refused.empty()) refused.clear();
  }
  if (!refused.empty()) throw InputError("no point has a result; the file as it is: " + own[command].refused);
  for (StudiedFigure& studied : study.figures) {
    if (studied.command == command)
      studied.unit = known_figure(study, studied, summary_with(study, studied, summary)).unit;
  }
}

}  // namespace

std::string StudyResult::text() const {
  std::string text;
  for (const std::optional<double>& value : values) text += (value ? shortest(*value) : "-") + " ";
  return text + "\t" + refused;
}

StudyResult parse_result(const std::string& text) {
  StudyResult result;
  const std::size_t tab = text.find('\t');
  for (const std::string_view word : split(std::string_view(text).substr(0, tab), ' ')) {
    if (word.empty()) continue;
    const ParsedNumber number = parse_number(word);
    result.values.push_back(number.ok() ? std::optional<double>(number.value) : std::nullopt);
  }
  if (tab != std::string::npos) result.refused = text.substr(tab + 1);
  return result;
}

std::size_t Study::points() const {
  std::size_t count = 1;
  for (const Variation& axis : axes) count *= axis.values.size();
  return count;
}

std::size_t Study::index(std::size_t point, std::size_t axis) const {
  for (std::size_t a = axes.size() - 1; a > axis; --a) point /= axes[a].values.size();
  return point % axes[axis].values.size();
}

std::string Study::place_of(std::size_t point) const {
  std::vector<std::string> words;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const std::size_t i = index(point, a);
    words.push_back(axes[a].target.name() + " = " +
                    (axes[a].is_of_words() ? axes[a].values[i] : brief(axes[a].numbers[i])));
  }
  return join(words);
}

void survey(Study& study) {
  const std::vector<Outcome> own = outcomes_at(study, {});
  for (std::size_t command = 0; command < study.commands.size(); ++command) find_units(study, command, own);
  study.own = result_of(study, own);
}

StudyResult run_point(const Study& study, std::size_t point) { return result_of(study, outcomes_at(study, point)); }

}  // namespace crankloop::program
